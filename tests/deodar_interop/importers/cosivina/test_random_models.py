"""Random models, with all kinds of loops in random order, against the plain simulator."""

from __future__ import annotations

import random
from typing import Any

import pytest

import deodar as dd
from deodar.importers.opening import read
from deodar.model.check import problems
from tests.deodar_interop.importers.cosivina.files import element, written
from tests.deodar_interop.importers.cosivina.oracle import Sim

N, M = 6, 4
ROW, SHORT, COLUMN, PLANE, ONE = [1, N], [1, M], [M, 1], [M, N], [1, 1]
STEPS = 12
KERNEL = {"circular": 1, "normalized": 1, "cutoffFactor": 2}
PLANE_KERNEL = {"circularX": 0, "circularY": 1, "normalized": 1, "cutoffFactor": 2}
GLOBAL = {"amplitudeExc": 0.5, "amplitudeInh": 0.2, "amplitudeGlobal": -0.03}
SUMS = {"horizontalSum": SHORT, "verticalSum": ROW, "fullSum": ONE}

# class, parameters, possible sizes (None: any), components besides its output
KINDS: list[tuple[str, dict[str, Any], list[list[int]] | None, dict[str, list[int]]]] = [
    ("NeuralField", {"tau": 3, "h": -1, "beta": 4}, None, {}),
    ("NeuralField", {"tau": 8, "h": 0.5, "beta": 1}, None, {}),
    ("NeuralField", {"tau": 5, "h": -0.3, "beta": 2}, None, {}),
    ("ScaleInput", {"amplitude": -0.7}, None, {}),
    ("SumInputs", {}, None, {}),
    ("PointwiseProduct", {}, None, {}),
    ("Sigmoid", {"beta": 2, "threshold": 0.1}, None, {}),
    ("HalfWaveRectification", {}, None, {}),
    ("MemoryTrace", {"tauBuild": 4, "tauDecay": 9, "threshold": 0.3}, None, {}),
    ("TimedSwitch", {"onTimes": [[1, 3], [6, 9]]}, None, {}),
    ("GaussKernel1D", {**KERNEL, "sigma": 1, "amplitude": 0.6}, [ROW], {}),
    ("LateralInteractions1D", {**KERNEL, **GLOBAL, "sigmaExc": 1, "sigmaInh": 2}, [ROW], {"fullSum": ONE}),
    ("GaussKernel2D", {**PLANE_KERNEL, "sigmaX": 1, "sigmaY": 0.7, "amplitude": 0.5}, [PLANE], {}),
    (
        "LateralInteractions2D",
        {**PLANE_KERNEL, **GLOBAL, "sigmaExcX": 1, "sigmaExcY": 0.7, "sigmaInhX": 2, "sigmaInhY": 1},
        [PLANE],
        SUMS,
    ),
    ("SumAllDimensions", {}, [PLANE], SUMS),
    ("SumDimension", {"sumDimensions": 1, "amplitude": 0.2}, [ROW], {}),
    ("SumDimension", {"sumDimensions": 2, "amplitude": 0.2}, [SHORT], {}),
    ("ExpandDimension2D", {"expandDimension": 1}, [PLANE], {}),
    ("Transpose", {}, [COLUMN], {}),
    ("BoostStimulus", {"amplitude": 0.4}, [ONE], {}),
    ("TimedBoost", {"amplitude": 0.8, "onTimes": [[2, 5]]}, [ONE], {}),
]
EXACT = {"SumDimension": PLANE, "ExpandDimension2D": ROW, "Transpose": SHORT}


def model(seed: int, count: int) -> list[tuple[str, str, dict[str, Any], list[tuple[str, str]]]]:
    """Return elements of random kinds and sizes; each reads elements that fit, at any position in the
    list.
    """
    rng = random.Random(seed)
    chosen = [(f"e{k}", rng.choice(KINDS)) for k in range(count)]
    sizes = {
        label: rng.choice(sizes or [ROW, SHORT, COLUMN, PLANE, ONE]) for label, (_, _, sizes, _) in chosen
    }
    given = [
        (label, component, size)
        for label, (kind, _, _, more) in chosen
        for component, size in _given(kind, sizes[label], more).items()
    ]

    def of(size: list[int]) -> list[tuple[str, str]]:
        return [(a, c) for a, c, own in given if own == size]

    def into(size: list[int]) -> list[tuple[str, str]]:
        return [(a, c) for a, c, own in given if all(n in (1, m) for n, m in zip(own, size, strict=True))]

    parts = []
    for label, (kind, param, _, _) in chosen:
        size = sizes[label]
        first, any_ = of(EXACT.get(kind, size)), into(size)
        inputs: list[tuple[str, str]] = []
        if kind == "NeuralField":
            inputs = rng.choices(any_, k=rng.randint(0, 4)) if any_ else []
        elif not kind.endswith(("Stimulus", "Boost")):
            if not first:
                continue
            inputs = [rng.choice(first)]
            inputs += (
                [rng.choice(any_)]
                if kind == "PointwiseProduct"
                else rng.choices(any_, k=rng.randint(0, 2))
                if kind == "SumInputs"
                else []
            )
            rng.shuffle(inputs)
        parts.append(
            (
                label,
                kind,
                {**param, **({} if size == ONE and not inputs and kind != "NeuralField" else {"size": size})},
                inputs,
            )
        )
    there = {label for label, *_ in parts}
    lacking = [p for p in parts if any(a not in there for a, _ in p[3])]
    return parts if not lacking else model(seed + 1000, count)


def _given(kind: str, size: list[int], more: dict[str, list[int]]) -> dict[str, list[int]]:
    return more if kind == "SumAllDimensions" else {"output": size, **more}


@pytest.mark.parametrize("seed", [1, 2])
def test_a_random_model_agrees_with_the_oracle(seed, tmp_path):
    parts = model(seed, 50)
    done = read(written(tmp_path, [element(*part) for part in parts]))
    assert problems(done.model.document) == [] and not done.report.losses
    labels = [label for label, kind, *_ in parts if kind == "NeuralField"]
    assert len(labels) > 3
    record = dd.simulate(
        done.model, STEPS, record=[f"{label}.activation" for label in labels], precision="float64"
    )
    plain = Sim(parts)
    for step in range(1, STEPS + 1):
        plain.step()
        for label in labels:
            expected = plain.out[label]["activation"]
            activations = record[f"{label}.activation"].isel(time=step).values.reshape(expected.shape)
            assert (abs(activations - expected) < 1e-9 * (1 + abs(expected))).all(), (label, step)
