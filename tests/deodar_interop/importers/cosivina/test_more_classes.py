"""Classes that no published file uses, against direct sums."""

from __future__ import annotations

import numpy as np
import pytest

import deodar as dd
from deodar.importers.opening import read
from deodar.model.check import problems
from tests.deodar_interop.importers.cosivina.files import element, written
from tests.deodar_interop.importers.cosivina.oracle import gauss, line

SOLID = [4, 5, 6]
CORNER = np.zeros(SOLID)
CORNER[0, 4, 2] = 1.0
RANDOM = np.random.default_rng(2).normal(size=(1, 9))
ENDS = {"circularY": 1, "circularX": 0, "circularZ": 1, "normalized": 1, "cutoffFactor": 2}


def output_of(folder, kind, param, pattern, bugs=False, component="output"):
    """Return the output for a pattern."""
    pattern = np.asarray(pattern, float)
    size = list(pattern.shape)
    flat = {
        "size": size,
        "pattern": {
            "_ArrayType_": "double",
            "_ArraySize_": size,
            "_ArrayData_": pattern.ravel(order="F").tolist(),
        },
    }
    parts = [element("s", "CustomStimulus", flat), element("it", kind, param, [("s", "output")])]
    done = read(written(folder, parts), bugs)
    assert problems(done.model.document) == [] and not done.report.losses
    return dd.simulate(done.model, 1, every=1, record=["it.output"], precision="float64")["it.output"].values[
        0
    ], done.report


def solid(pattern, sigmas, amplitude, flags, cutoff=2):
    for d, (s, c) in enumerate(zip(sigmas, flags, strict=True)):
        m = line(pattern.shape[d], s, c, True, int(np.ceil(cutoff * s)))
        pattern = np.moveaxis(np.tensordot(m, pattern, axes=(1, d)), 0, d)
    return amplitude * pattern


@pytest.mark.parametrize("bugs", [False, True])
def test_a_kernel_over_three_axes_and_its_known_error_agree_with_the_oracle(bugs, tmp_path):
    output, report = output_of(
        tmp_path,
        "GaussKernel3D",
        {"size": SOLID, "sigmaY": 1, "sigmaX": 1.5, "sigmaZ": 0.8, "amplitude": 3, **ENDS},
        CORNER,
        bugs,
    )
    assert np.allclose(output, solid(CORNER, (1, 1.5, 0.8), 3, (True, bugs, True)), rtol=0, atol=1e-12)
    assert len(report.bugs) == 1 and report.bugs[0].endswith("reproduced" if bugs else "corrected")


def test_differences_of_gaussians_over_three_axes_agree_with_the_oracle(tmp_path):
    widths = {
        f"sigma{a}{c}": v
        for a, values in (("Exc", (1, 1.5, 0.8)), ("Inh", (2, 1, 1.2)))
        for c, v in zip("YXZ", values, strict=True)
    }
    param = {"size": SOLID, **widths, "amplitudeExc": 3, "amplitudeInh": 2, **ENDS}
    expected = solid(CORNER, (1, 1.5, 0.8), 3, (True, False, True)) - solid(
        CORNER, (2, 1, 1.2), 2, (True, False, True)
    )
    assert np.allclose(
        output_of(tmp_path, "MexicanHatKernel3D", param, CORNER)[0], expected, rtol=0, atol=1e-12
    )
    output = output_of(tmp_path, "LateralInteractions3D", {**param, "amplitudeGlobal": -0.25}, CORNER)[0]
    assert np.allclose(output, expected - 0.25, rtol=0, atol=1e-12)


def test_a_shifted_interaction_agrees_with_the_oracle(tmp_path):
    param = {
        "size": [1, 9],
        "sigmaExc": 1,
        "amplitudeExc": 2,
        "sigmaInh": 1,
        "amplitudeInh": 0,
        "amplitudeGlobal": -0.1,
        "shift": 2,
    }
    param |= {"circular": 1, "normalized": 1, "cutoffFactor": 2}
    output = output_of(tmp_path, "LateralInteractionsShifted1D", param, RANDOM)[0]
    expected = np.roll(2 * line(9, 1, True, True, 2) @ RANDOM[0], 2) - 0.1 * RANDOM.sum()
    assert np.allclose(output, expected, rtol=0, atol=1e-12)


def test_a_discrete_interaction_agrees_with_the_oracle(tmp_path):
    output = output_of(
        tmp_path,
        "LateralInteractionsDiscrete",
        {"size": [1, 9], "amplitudeExc": 2, "amplitudeGlobal": -0.1},
        RANDOM,
    )[0]
    assert np.allclose(output, 2 * RANDOM[0] - 0.1 * RANDOM.sum(), rtol=0, atol=1e-12)


@pytest.mark.parametrize("bugs", [False, True])
def test_a_split_transform_agrees_with_the_oracle(bugs, tmp_path):
    kernel = {
        "size": [1, 9],
        "sigmaExc": 1,
        "amplitudeExc": 0,
        "sigmaInh": 2,
        "amplitudeInh": 0,
        "amplitudeGlobal": -0.1,
        "normalized": 1,
    }
    flat = {"size": [1, 9], "pattern": RANDOM.tolist()}
    for amplitude in (0, 1.5):
        parts = [
            element("s", "CustomStimulus", flat),
            element("t", "FastFourierTransform", {"size": [1, 9]}, [("s", "output")]),
        ]
        parts.append(
            element("k", "KernelInverseFFT", {**kernel, "amplitudeExc": amplitude}, [("t", "output")])
        )
        done = read(written(tmp_path, parts), bugs)
        values = dd.simulate(done.model, 1, every=1, record=["k.output"], precision="float64")[
            "k.output"
        ].values[0]
        overall = 0.0 if bugs and not amplitude else -0.1 * RANDOM.sum()
        assert np.allclose(
            values, amplitude * line(9, 1, True, True, 9) @ RANDOM[0] + overall, rtol=0, atol=1e-12
        )


def test_a_stimulus_over_three_axes_agrees_with_the_oracle(tmp_path):
    param = {"size": SOLID, "amplitude": 2, "normalized": 0}
    for c, sigma, position, circular in (("Y", 1, 2, 1), ("X", 1.5, 6, 1), ("Z", 2, 1, 0)):
        param |= {f"sigma{c}": sigma, f"position{c}": position, f"circular{c}": circular}
    model = dd.load(written(tmp_path, [element("s", "GaussStimulus3D", param)]))
    y, x, z = (
        gauss(np.arange(1, 5) - 2, 1, 4),
        gauss(np.arange(1, 6) - 6, 1.5, 5),
        gauss(np.arange(1, 7) - 1, 2),
    )
    values = dd.simulate(model, 1, every=1, record=["s.output"], precision="float64")["s.output"].values[0]
    assert np.allclose(values, 2 * np.einsum("i,j,k->ijk", y, x, z), rtol=0, atol=1e-12)


def test_a_general_expansion_agrees_with_the_oracle(tmp_path):
    plane = np.arange(12.0).reshape(3, 4)
    param = {"inputSize": [3, 4], "outputSize": [4, 2, 3], "dimensionMapping": [3, 1]}
    output = output_of(tmp_path, "ExpandDimension", param, plane)[0]
    assert np.array_equal(output, np.repeat(plane.T[:, None], 2, axis=1))


@pytest.mark.parametrize("bugs", [False, True])
def test_amplitudes_that_cosivina_ignores_are_applied_unless_bugs_are_reproduced(bugs, tmp_path):
    wide = np.arange(9.0)[None]
    output, report = output_of(
        tmp_path, "DiagonalExpansion", {"inputSize": [1, 9], "amplitude": 3}, wide, bugs
    )
    assert (
        np.array_equal(output, (1 if bugs else 3) * np.add.outer(np.arange(5.0), np.arange(5.0)))
        and len(report.bugs) == 1
    )
    output, report = output_of(
        tmp_path, "DiagonalExpansion", {"inputSize": [1, 9], "amplitude": 0}, wide, bugs
    )
    assert np.array_equal(output, np.add.outer(np.arange(5.0), np.arange(5.0))) and not report.bugs


@pytest.mark.parametrize("bugs", [False, True])
def test_normalised_timed_stimuli_agree_with_the_oracle(bugs, tmp_path):
    param = {
        "size": [1, 9],
        "sigma": 1,
        "amplitude": 3,
        "position": 4,
        "circular": 1,
        "normalized": 1,
        "onTimes": [[0, 9]],
    }
    done = read(written(tmp_path, [element("s", "TimedGaussStimulus1D", param)]), bugs)
    total = (
        dd.simulate(done.model, 1, every=1, record=["s.output"], precision="float64")["s.output"]
        .values[0]
        .sum()
    )
    assert total == pytest.approx(3 * gauss(np.arange(-4, 5), 1).sum() if bugs else 3, rel=1e-4)


@pytest.mark.parametrize("bugs", [False, True])
def test_learning_from_another_component_agrees_with_the_oracle(bugs, tmp_path):
    field = {"size": [1, 3], "tau": 5, "h": 1, "beta": 4}
    parts = [
        element("u", "NeuralField", field),
        element(
            "w",
            "AdaptiveWeightMatrix",
            {"size": [3, 3], "learningRate": 0.1},
            [("u", "output"), ("u", "activation")],
        ),
    ]
    done = read(written(tmp_path, parts), bugs)
    g, w = 1 / (1 + np.exp(-4.0)), 0.0
    for _ in range(3):
        w += 0.1 * (1.0 - w) * (1.0 if bugs else g)
    values = dd.simulate(done.model, 3, every=3, record=["w.output"], precision="float64")["w.output"].values[
        -1
    ]
    assert np.allclose(values, 3 * g * w, rtol=0, atol=1e-12) and len(done.report.bugs) == 1
