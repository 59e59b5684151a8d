"""Every translated class, at every position in the list, against the plain simulator."""

from __future__ import annotations

import random

import numpy as np
import pytest

import deodar as dd
from deodar.elements.placeholder import Placeholder
from deodar.importers.opening import read
from deodar.model.check import problems
from deodar_interop.importers.cosivina.classes import CLASSES
from deodar_interop.importers.cosivina.translate import MISSING
from tests.deodar_interop.importers.cosivina.files import element, written
from tests.deodar_interop.importers.cosivina.oracle import Sim

N, M = 12, 7
ROW, PLANE, ONE = [1, N], [M, N], [1, 1]
STEPS = 24
TIMES = [[3, 6], [6, 9], [15, "_Inf_"]]
PLAIN_TIMES = [[3, 6], [6, 9], [15, float("inf")]]
FIELD = {"tau": 6, "h": -1.5, "beta": 2.0}
RANDOM = np.random.default_rng(5)
DOG = {"amplitudeExc": 1.3, "amplitudeInh": 0.7, "normalized": 1, "cutoffFactor": 1.5}
DOG_1D = {**DOG, "size": ROW, "sigmaExc": 1.2, "sigmaInh": 2.7}
DOG_2D = {
    **DOG,
    "size": PLANE,
    "sigmaExcX": 1.2,
    "sigmaExcY": 0.7,
    "sigmaInhX": 2.7,
    "sigmaInhY": 1.9,
    "circularX": 1,
    "circularY": 0,
}
FFT = {
    "amplitudeExc": 1.3,
    "amplitudeInh": 0.7,
    "amplitudeGlobal": -0.02,
    "normalized": 1,
    "paddingFactor": 5,
}
CODE = {"size": ROW, "inputScale": 30.0, "inputOffset": -1.5, "sigma": 1.3, "amplitude": 2.0}
BELL = {"size": ROW, "sigma": 1.7, "amplitude": 2.0, "position": 11.3, "circular": 1, "normalized": 0}
BELL_2D = {
    "size": PLANE,
    "sigmaX": 1.7,
    "sigmaY": 2.0,
    "amplitude": 2.0,
    "positionX": 11.3,
    "positionY": 2,
    "circularX": 1,
    "circularY": 0,
}
U, V, W = ("u", "output"), ("v", "output"), ("w", "output")

# class, parameters, inputs, size of the output, component that is read
CASES = {
    "kernel": (
        "GaussKernel1D",
        {"size": ROW, "sigma": 1.4, "amplitude": 2, "circular": 0, "normalized": 1, "cutoffFactor": 3},
        [U],
        ROW,
    ),
    "kernel on a ring": (
        "GaussKernel1D",
        {"size": ROW, "sigma": 3, "amplitude": 2, "circular": 1, "normalized": 1, "cutoffFactor": 5},
        [U],
        ROW,
    ),
    "kernel of its height": (
        "GaussKernel1D",
        {"size": ROW, "sigma": 1.4, "amplitude": 2, "circular": 1, "normalized": 0, "cutoffFactor": 1},
        [U],
        ROW,
    ),
    "kernel of one sample": (
        "GaussKernel1D",
        {"size": ROW, "sigma": 0, "amplitude": 2, "circular": 1, "normalized": 1, "cutoffFactor": 5},
        [U],
        ROW,
    ),
    "plane kernel": (
        "GaussKernel2D",
        {
            "size": PLANE,
            "sigmaX": 1.2,
            "sigmaY": 2,
            "amplitude": -1,
            "circularX": 1,
            "circularY": 0,
            "normalized": 1,
            "cutoffFactor": 2,
        },
        [V],
        PLANE,
    ),
    "mexican hat": ("MexicanHatKernel1D", {**DOG_1D, "circular": 1}, [U], ROW),
    "mexican hat on a line": ("MexicanHatKernel1D", {**DOG_1D, "circular": 0, "normalized": 0}, [U], ROW),
    "plane mexican hat": ("MexicanHatKernel2D", DOG_2D, [V], PLANE),
    "lateral": ("LateralInteractions1D", {**DOG_1D, "circular": 1, "amplitudeGlobal": -0.1}, [U], ROW),
    "lateral without inhibition": (
        "LateralInteractions1D",
        {**DOG_1D, "circular": 1, "amplitudeInh": 0, "amplitudeGlobal": -0.1},
        [U],
        ROW,
    ),
    "lateral sum": (
        "LateralInteractions1D",
        {**DOG_1D, "circular": 1, "amplitudeGlobal": -0.1},
        [U],
        ONE,
        "fullSum",
    ),
    "plane lateral": ("LateralInteractions2D", {**DOG_2D, "amplitudeGlobal": -0.02}, [V], PLANE),
    "plane lateral, horizontal": (
        "LateralInteractions2D",
        {**DOG_2D, "amplitudeGlobal": -0.02},
        [V],
        [1, M],
        "horizontalSum",
    ),
    "plane lateral, vertical": (
        "LateralInteractions2D",
        {**DOG_2D, "amplitudeGlobal": -0.02},
        [V],
        ROW,
        "verticalSum",
    ),
    "fourier": ("KernelFFT", {**FFT, "size": ROW, "sigmaExc": 3, "sigmaInh": 4, "circular": 1}, [U], ROW),
    "fourier on a line": (
        "KernelFFT",
        {**FFT, "size": ROW, "sigmaExc": 2, "sigmaInh": 3, "circular": 0},
        [U],
        ROW,
    ),
    "fourier in a plane": (
        "KernelFFT",
        {**FFT, "size": PLANE, "sigmaExc": [[1], [2]], "sigmaInh": [[2], [3]], "circular": [[1], [1]]},
        [V],
        PLANE,
    ),
    "fourier of heights": (
        "KernelFFT",
        {**FFT, "size": ROW, "sigmaExc": 3, "sigmaInh": 4, "circular": 1, "normalized": 0},
        [U],
        ROW,
    ),
    "transpose": ("Transpose", {"size": [N, 1]}, [U], [N, 1]),
    "sums": ("SumAllDimensions", {"size": PLANE}, [V], ONE, "fullSum"),
    "horizontal sum": ("SumAllDimensions", {"size": PLANE}, [V], [1, M], "horizontalSum"),
    "vertical sum": ("SumAllDimensions", {"size": PLANE}, [V], ROW, "verticalSum"),
    "sum over rows": ("SumDimension", {"sumDimensions": 1, "size": ROW, "amplitude": -0.3}, [V], ROW),
    "sum over columns": (
        "SumDimension",
        {"sumDimensions": 2, "size": [1, M], "amplitude": 0.3, "dimensionOrder": [1, 2]},
        [V],
        [1, M],
    ),
    "sum over columns as a column": (
        "SumDimension",
        {"sumDimensions": 2, "size": [M, 1], "amplitude": 0.3},
        [V],
        [M, 1],
    ),
    "sum over all": ("SumDimension", {"sumDimensions": [1, 2], "size": ONE, "amplitude": 0.3}, [V], ONE),
    "expand along rows": ("ExpandDimension2D", {"expandDimension": 1, "size": [M, N]}, [U], PLANE),
    "expand along columns": ("ExpandDimension2D", {"expandDimension": 2, "size": [N, M]}, [U], [N, M]),
    "sum of inputs": ("SumInputs", {"size": ROW}, [U, ("boost", "output"), ("bell", "output")], ROW),
    "sum of row and column": ("SumInputs", {"size": [N, N]}, [U, ("turned", "output")], [N, N]),
    "the same twice": ("SumInputs", {"size": ROW}, [U, U], ROW),
    "scale": ("ScaleInput", {"size": ROW, "amplitude": -1.5}, [U], ROW),
    "scale of a number": ("ScaleInput", {"size": ROW, "amplitude": -1.5}, [("n", "output")], ROW),
    "product": ("PointwiseProduct", {"size": ROW}, [U, ("bell", "output")], ROW),
    "product with a number": ("PointwiseProduct", {"size": ROW}, [("n", "output"), U], ROW),
    "product of row and column": ("PointwiseProduct", {"size": [N, N]}, [U, ("turned", "output")], [N, N]),
    "square": ("PointwiseProduct", {"size": ROW}, [U, U], ROW),
    "rectification": ("HalfWaveRectification", {"size": ROW}, [("u", "activation")], ROW),
    "sigmoid": ("Sigmoid", {"size": ROW, "beta": 1.5, "threshold": -0.5}, [("u", "activation")], ROW),
    "weights": (
        "WeightMatrix",
        {"size": [N, 5], "weights": RANDOM.normal(size=(N, 5)).tolist()},
        [U],
        [1, 5],
    ),
    "square weights": (
        "WeightMatrix",
        {"size": [N, N], "weights": (0.2 * RANDOM.normal(size=(N, N))).tolist()},
        [U],
        ROW,
    ),
    "weights from a number": (
        "WeightMatrix",
        {"size": [1, 5], "weights": [1, 2, 3, 4, 5]},
        [("n", "output")],
        [1, 5],
    ),
    "learning": ("AdaptiveWeightMatrix", {"size": [N, M], "learningRate": 0.2}, [U, ("w", "output")], [1, M]),
    "gated learning": (
        "AdaptiveWeightMatrix",
        {"size": [N, M], "learningRate": 0.5},
        [U, ("w", "output"), ("n", "output")],
        [1, M],
    ),
    "trace": ("MemoryTrace", {"size": ROW, "tauBuild": 5, "tauDecay": 20, "threshold": 0.3}, [U], ROW),
    "where the trace grows": (
        "MemoryTrace",
        {"size": ROW, "tauBuild": 5, "tauDecay": 20, "threshold": 0.3},
        [U],
        ROW,
        "activeRegions",
    ),
    "variable": (
        "DynamicVariable",
        {"size": ROW, "tau": 7, "initialState": 0.3},
        [U, ("half", "output")],
        ROW,
        "state",
    ),
    "variable from a pattern": (
        "DynamicVariable",
        {"size": ROW, "tau": -4, "initialState": np.linspace(-0.5, 0.5, N)[None].tolist()},
        [("bell", "output")],
        ROW,
        "state",
    ),
    "number to peak": ("ScalarToGaussian", {**CODE, "circular": 1, "normalized": 0}, [("n", "output")], ROW),
    "number to peak on a line": (
        "ScalarToGaussian",
        {**CODE, "circular": 0, "normalized": 0},
        [("n", "activation")],
        ROW,
    ),
    "number to peak of its integral": (
        "ScalarToGaussian",
        {**CODE, "circular": 0, "normalized": 1},
        [("n", "activation")],
        ROW,
    ),
    "number to peak, its place": (
        "ScalarToGaussian",
        {**CODE, "circular": 1, "normalized": 1},
        [("n", "output")],
        ONE,
        "position",
    ),
    "sequence": (
        "CustomStimulusSequence",
        {
            "stimulusSize": ROW,
            "stimulusPatterns": RANDOM.normal(size=(4, N)).tolist(),
            "startTimes": [3.4, 6, 6, 11],
        },
        [],
        ROW,
    ),
    "sequence from the start": (
        "CustomStimulusSequence",
        {
            "stimulusSize": ROW,
            "stimulusPatterns": RANDOM.normal(size=(3, N)).tolist(),
            "startTimes": [-5, 0, 7],
        },
        [],
        ROW,
    ),
    "diagonal sum": (
        "DiagonalSum",
        {"inputSize": [N, N], "amplitude": 0.4},
        [("square plane", "output")],
        [1, 2 * N - 1],
    ),
    "diagonal expansion": (
        "DiagonalExpansion",
        {"inputSize": [1, 2 * N - 1], "amplitude": 1},
        [("long", "output")],
        [N, N],
    ),
    "shift": (
        "ShiftInput",
        {"size": ROW, "shiftValue": [0, 3], "amplitude": 1, "circular": 0, "fillValue": 0},
        [U],
        ROW,
    ),
    "shift back": (
        "ShiftInput",
        {"size": ROW, "shiftValue": [0, 0, -2], "amplitude": 1, "circular": 0, "fillValue": 0.5},
        [U],
        ROW,
    ),
    "shift on a ring": (
        "ShiftInput",
        {"size": ROW, "shiftValue": [0, 5], "amplitude": 1, "circular": 1, "fillValue": 0},
        [U],
        ROW,
    ),
    "node": (
        "SingleNodeDynamics",
        {**FIELD, "selfExcitation": 2.5, "noiseLevel": 0, "range": [-10, 10], "resolution": 0.1},
        [("n", "output")],
        ONE,
    ),
    "rate of a node": (
        "SingleNodeDynamics",
        {**FIELD, "selfExcitation": 2.5, "noiseLevel": 0},
        [("n", "output"), ("boost", "output")],
        ONE,
        "rateOfChange",
    ),
    "level of a field": ("NeuralField", {**FIELD, "size": ROW}, [U], ONE, "h"),
    "stimulus": ("GaussStimulus1D", BELL, [], ROW),
    "stimulus on a line": ("GaussStimulus1D", {**BELL, "circular": 0, "normalized": 1}, [], ROW),
    "stimulus of one sample": ("GaussStimulus1D", {**BELL, "sigma": 0, "position": 4}, [], ROW),
    "plane stimulus": ("GaussStimulus2D", {**BELL_2D, "normalized": 0}, [], PLANE),
    "plane stimulus of its integral": ("GaussStimulus2D", {**BELL_2D, "normalized": 1}, [], PLANE),
    "boost": ("BoostStimulus", {"amplitude": 1.5}, [], ONE),
    "pattern": ("CustomStimulus", {"size": PLANE, "pattern": RANDOM.normal(size=(M, N)).tolist()}, [], PLANE),
    "row pattern": ("CustomStimulus", {"size": ROW, "pattern": RANDOM.normal(size=N).tolist()}, [], ROW),
    "timed stimulus": ("TimedGaussStimulus1D", {**BELL, "onTimes": TIMES}, [], ROW),
    "timed plane stimulus": (
        "TimedGaussStimulus2D",
        {**BELL_2D, "normalized": 0, "onTimes": [2, 5]},
        [],
        PLANE,
    ),
    "timed stimulus from the start": ("TimedGaussStimulus1D", {**BELL, "onTimes": [[0, 0], [0, 3]]}, [], ROW),
    "timed stimulus that is never on": ("TimedGaussStimulus1D", {**BELL, "onTimes": []}, [], ROW),
    "timed pattern": (
        "TimedCustomStimulus",
        {"size": ROW, "stimulusPattern": RANDOM.normal(size=N).tolist(), "onTimes": TIMES},
        [],
        ROW,
    ),
    "timed boost": ("TimedBoost", {"amplitude": 1.5, "onTimes": TIMES}, [], ONE),
    "timed boosts": ("TimedBoost", {"amplitude": [[1.5], [-2], [0.7]], "onTimes": TIMES}, [], ONE),
    "switch": ("TimedSwitch", {"size": ROW, "onTimes": TIMES}, [U], ROW),
}


DRIVE = [
    ("bell", "GaussStimulus1D", BELL, []),
    ("plane bell", "GaussStimulus2D", {**BELL_2D, "normalized": 0}, []),
    ("half", "BoostStimulus", {"amplitude": 0.4}, []),
    ("n", "NeuralField", {**FIELD, "size": ONE}, [("half", "output"), ("total", "output")]),
    ("total", "SumDimension", {"sumDimensions": [1, 2], "size": ONE, "amplitude": 0.2}, [U]),
    (
        "u",
        "NeuralField",
        {**FIELD, "size": ROW},
        [("bell", "output"), ("scaled", "output"), ("kernel", "output"), ("timed boost", "output")],
    ),
    ("scaled", "ScaleInput", {"size": ROW, "amplitude": 0.7}, [U]),
    (
        "v",
        "NeuralField",
        {**FIELD, "size": PLANE},
        [("plane bell", "output"), U, ("n", "output"), ("plane mexican hat", "output")],
    ),
    ("w", "NeuralField", {**FIELD, "size": [1, M]}, [("n", "output"), ("learning", "output")]),
    ("turned", "Transpose", {"size": [N, 1]}, [U]),
    ("square plane", "SumInputs", {"size": [N, N]}, [U, ("turned", "output")]),
    ("long", "NeuralField", {**FIELD, "size": [1, 2 * N - 1]}, [("n", "output"), ("long bell", "output")]),
    ("long bell", "GaussStimulus1D", {**BELL, "size": [1, 2 * N - 1]}, []),
]
"""Sources of the cases, with some of them in loops."""


def everything(seed):
    """Return all cases in one file, each with a field that reads it, in random order."""
    parts = list(DRIVE)
    for name, (kind, p, inputs, size, *component) in CASES.items():
        parts.append((name, kind, p, inputs))
        parts.append(
            (
                f"reads {name}",
                "NeuralField",
                {**FIELD, "size": size},
                [(name, component[0] if component else "output")],
            )
        )
    if seed == "reversed":
        parts.reverse()
    elif seed:
        random.Random(seed).shuffle(parts)
    return parts


@pytest.mark.parametrize(("seed", "dt", "t0"), [("", 1, 0), ("reversed", 1, 0), ("mixed", 0.5, 2)])
def test_every_class_agrees_with_the_oracle_in_any_order(seed, dt, t0, tmp_path):
    parts = everything(seed)
    done = read(written(tmp_path, [element(a, k, p, i) for a, k, p, i in parts], dt, t0))
    assert problems(done.model.document) == [] and not done.report.losses
    plain = Sim(
        [
            (a, k, p | ({"onTimes": _plain(p["onTimes"])} if "onTimes" in p else {}), i)
            for a, k, p, i in parts
        ],
        dt,
        t0,
    )
    labels = [a for a, k, _, _ in parts if k in ("NeuralField", "SingleNodeDynamics")]
    record = dd.simulate(
        done.model, STEPS * dt, record=[f"{dd.quote(a)}.activation" for a in labels], precision="float64"
    )
    for step in range(1, STEPS + 1):
        plain.step()
        for label in labels:
            expected = plain.out[label]["activation"]
            values = record[f"{label}.activation"].isel(time=step).values
            assert abs(values.reshape(expected.shape) - expected).max() < 1e-9, (label, step)
    still = [
        a
        for a in labels
        if a.startswith("reads") and abs(plain.out[a]["activation"] - FIELD["h"]).max() < 1e-4
    ]
    assert all("never" in a for a in still), still


def _plain(times):
    return (
        np.array(
            [
                [float(str(v).replace("_Inf_", "inf")) for v in row]
                for row in (times if np.ndim(times[:1]) == 2 else [times])
            ]
        )
        if times
        else []
    )


def test_the_cases_cover_every_translated_class():
    there = {kind for kind, *_ in CASES.values()} | {"NormalNoise"}
    further = {
        "GaussKernel3D",
        "GaussStimulus3D",
        "MexicanHatKernel3D",
        "LateralInteractions3D",
        "LateralInteractionsShifted1D",
    }
    further |= {
        "RunningHistory",
        "History",
        "HebbianConnection",
        "LateralInteractionsDiscrete",
        "KernelInverseFFT",
        "FastFourierTransform",
        "ExpandDimension",
    }
    assert set(CLASSES) == there | further


def test_noise_has_the_strength_of_cosivina(tmp_path):
    """Noise of strength q changes a field by q sqrt(dt) / tau in a step."""
    parts = [
        element("u", "NeuralField", {"size": [1, 2000], "tau": 10, "h": 0, "beta": 4}, [("noise", "output")])
    ]
    model = dd.load(
        written(
            tmp_path, [*parts, element("noise", "NormalNoise", {"size": [1, 2000], "amplitude": 3})], dt=4
        )
    )
    s = dd.Session(model, precision="float64")
    s.step(1)
    assert s.read("u.activation").std() == pytest.approx(3 * 2 / 10, rel=0.05)


@pytest.mark.parametrize(
    "kind", ["CameraGrabber", "AttractorDynamics", "MobileRobotArena", "Interpolation1D", "GausKernel1D"]
)
def test_a_class_that_is_not_translated_becomes_a_placeholder(kind, tmp_path):
    parts = [
        element("u", "NeuralField", {**FIELD, "size": ROW}, [("it", "output")]),
        element("it", kind, {"size": ROW, "learningRate": 0.1}, [U]),
    ]
    done = read(written(tmp_path, parts))
    found = done.model["it"].element
    assert isinstance(found, Placeholder) and kind in found.missing and len(found.missing) > len(kind) + 5
    assert {line.where for line in done.report.losses} == {"it"}
    dd.Session(done.model).step(2)


@pytest.mark.parametrize(
    ("times", "verdict", "on"),
    [
        ([[2, 5]], "carried", [(1, 5)]),
        ([[2, 5], [7, 9]], "carried", [(1, 5), (6, 9)]),
        ([], "carried", []),
        ([2], "approximated", []),
        ([[2, 5, 7]], "approximated", []),
        ("soon", "approximated", []),
    ],
)
def test_times_that_are_no_pairs_are_reported(times, verdict, on, tmp_path):
    parts = [
        element("u", "SingleNodeDynamics", {"tau": 10, "h": 0, "beta": 4}, [("b", "output")]),
        element("b", "TimedBoost", {"amplitude": 1.5, "onTimes": times}),
    ]
    done = read(written(tmp_path, parts))
    (line,) = (line for line in done.report.lines if (line.where, line.what) == ("b", "onTimes"))
    assert line.verdict == verdict
    windows = done.model["b"].element.windows
    assert [(w.start, w.stop) for w in windows] == on


NAMES = """
AdaptiveWeightMatrix AttractorDynamics BoostStimulus CameraGrabber ColorExtraction Convolution CustomStimulus
CustomStimulusSequence DiagonalExpansion DiagonalSum DynamicRobotController DynamicVariable ExpandDimension
ExpandDimension2D FastFourierTransform GaussKernel1D GaussKernel2D GaussKernel3D GaussStimulus1D
GaussStimulus2D GaussStimulus3D HalfWaveRectification HebbianConnection History ImageLoader Interpolation1D
KernelFFT KernelInverseFFT LFP LateralInteractions1D LateralInteractions2D LateralInteractions3D
LateralInteractionsDiscrete LateralInteractionsShifted1D MemoryTrace MexicanHatKernel1D MexicanHatKernel2D
MexicanHatKernel3D MobileRobotArena NeuralField NormalNoise PointwiseProduct RunningHistory ScalarToGaussian
ScaleInput ShiftInput Sigmoid SingleNodeDynamics SumAllDimensions SumDimension SumInputs TimedBoost
TimedCustomStimulus TimedGaussStimulus1D TimedGaussStimulus2D TimedSwitch Transpose WeightMatrix
"""
ALL = NAMES.split()


def test_every_class_of_cosivina_is_translated_or_names_what_is_missing(tmp_path):
    """All classes in one file, with a size alone; other parameters have the defaults of cosivina."""
    assert len(ALL) == 58 and set(ALL) == set(CLASSES) | set(MISSING)
    parts = [element(f"a {kind}", kind, {"size": [1, 1]}, [("u", "output")]) for kind in ALL]
    done = read(written(tmp_path, [element("u", "NeuralField", {"size": [1, 1]}), *parts]))
    assert problems(done.model.document) == []
    verdicts = {line.what: (line.verdict, line.why) for line in done.report.lines if line.part == "element"}
    for kind in MISSING:
        assert verdicts[kind] == ("dropped", f"Placeholder: {MISSING[kind]}")
    lost = {kind for kind in CLASSES if verdicts[kind][0] != "carried"}
    # patterns, weights and times must be given
    settings = {"CustomStimulus", "TimedCustomStimulus", "CustomStimulusSequence", "WeightMatrix", "History"}
    # no peak on one sample; learning needs two inputs
    assert lost == settings | {"ScalarToGaussian", "HebbianConnection"}
    assert [done.model[f"a {kind}"].element.amplitude for kind in ("BoostStimulus", "TimedBoost")] == [0, 0]
    assert done.model["a Sigmoid"].element.sigmoid == dd.Logistic(beta=1, threshold=0)
    dd.simulate(done.model, 3, every=3)
