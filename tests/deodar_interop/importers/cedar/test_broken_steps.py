"""Steps whose parameters or inputs do not fit: the report states why, and no other step is lost."""

from __future__ import annotations

import json

import numpy as np
import pytest

import deodar as dd
from deodar_interop.importers.cedar import translate
from tests.deodar_interop.importers.cedar import oracle
from tests.deodar_interop.importers.cedar.models import (
    DROP,
    TYPES,
    Model,
    between,
    every_type,
    gauss,
    written,
)
from tests.deodar_interop.importers.cedar.test_oracle import invalid

LINE, PLANE, CUBE = (12,), (8, 7), (6, 5, 7)
BOTH = {"enabled": True, "dimension mapping": {0: 0, 1: 0}, "output dimensionality": 1}
NONE = {"enabled": True, "dimension mapping": {0: DROP, 1: DROP}, "output dimensionality": 1}
LARGE = {"borderType": "Zero", "engine": {"type": "cedar.aux.conv.FFTW"}}
LARGE |= {"kernels": dict([gauss(1, [3.0])])}

REFUSED = [
    ("SynapticConnection", {"projection": BOTH}, {"matrix": PLANE}, "result", "mapped to one"),
    ("SynapticConnection", {"projection": NONE}, {"matrix": PLANE}, "result", "all dimensions are dropped"),
    ("SynapticConnection", {}, {"matrix": [LINE, PLANE]}, "result", "have different sizes"),
    ("SynapticConnection", {}, {}, "result", "nothing is connected to 'matrix'"),
    ("SynapticConnection", {"convolution": LARGE}, {"matrix": LINE}, "result", "FFTW raises an exception"),
    ("RateMatrixToSpaceCode", {}, {"values": PLANE}, "output", "nothing is connected to 'bin map'"),
    ("RateMatrixToSpaceCode", {}, {"bin map": PLANE, "values": (5, 5)}, "output", "its values have the size"),
    ("InnerProduct", {}, {"input": LINE, "input 2": PLANE}, "output", "the sizes [12] and [8, 7] differ"),
    ("Nullspace", {}, {"jacobian": (2, 4), "vector": (3,)}, "nullspace", "its vector has the size [3]"),
    ("SpaceCodeToRateMatrix", {}, {"input": PLANE}, "output", "its input has 2 dimensions"),
]
"""Steps that cedar does not run."""

UNKNOWN = [
    ({"upper limit": 0}, PLANE, "its limits are equal"),
    ({"number of bins": 1}, PLANE, "one bin"),
    ({"number of bins": 0}, PLANE, "one bin"),
    ({}, LINE, "rates of 1 dimensions"),
    ({"number of bins": 10_000}, (60, 60), "3600 rates with 10001 edges"),
]
"""Parameters and inputs of RateMatrixToSpaceCode whose result is not documented, or too large."""


def why_of(text):
    """Return the reasons of the report for the step, and the model."""
    done = translate.read(text.encode(), "file.json")
    lines = [line for line in done.report.losses if (line.where, line.part) == ("step", "element")]
    assert lines and len({entry.names[-1] for entry in done.model.document.entries}) >= 2
    return " ".join(line.why for line in lines), done.model


@pytest.mark.parametrize(("kind", "more", "reads", "puts", "why"), REFUSED)
def test_a_step_that_cedar_does_not_run_states_the_reason(kind, more, reads, puts, why):
    text = between(kind, more, reads, puts, LINE)
    assert why in why_of(text)[0]
    assert "step" in invalid(text)[0]


def test_a_picture_is_converted_from_blue_green_and_red():
    m = Model()
    m.add("ConstMatrix", "picture", {"sizes": [2, 4, 3], "value": 51})
    body = json.loads(m.text())
    body["steps"]["cedar.processing.steps.ColorConversion"] = {"name": "step"}
    body["connections"] = [{"source": "picture.matrix", "target": "step.input image"}]
    done = translate.read(written(body).encode(), "file.json")
    record = dd.simulate(done.model, 10, dt=10, record=["step.output"])
    assert record["step.output"].values[-1, 1, 3].tolist() == pytest.approx([0, 0, 51])


def hebbian(**settings):
    """Return the report lines of the parameters of a step that learns from a node to a cube, by name."""
    settings = {"source dimension": 0, "target dimension": 3, "target sizes": list(CUBE), **settings}
    reads = {"source node": (), "target field": CUBE, "reward signal": ()}
    done = translate.read(
        between("HebbianConnection", settings, reads, "learned output", CUBE).encode(), "f.json"
    )
    return {line.what: line for line in done.report.lines if (line.where, line.part) == ("step", "parameter")}


def test_a_step_of_three_dimensions_learns_nothing():
    line = hebbian(**{"learning rate": 0.5})["learning rate"]
    assert (line.verdict, line.why) == ("carried", "0: cedar learns up to 2 dimensions")


def test_values_of_the_weights_at_the_start_are_without_effect_beside_those_that_are_given():
    bell = {"weight centers": [1, 2, 3], "weight sigmas": [2, 2, 2], "weight amplitude": 2}
    lines = hebbian(**{"manual weights": True, "weight init value": 1, "weight init noise": 1}, **bell)
    for name in ("weight init value", "weight init noise"):
        assert lines[name].why == "without effect beside weights that are given"


def test_limits_that_cross_are_a_placeholder_where_one_has_a_replacement():
    limits = {"lower limit": 0.5, "upper limit": 0.3, "replace lower limit": True}
    reason, model = why_of(between("Clamp", limits, {"input": LINE}, "thresholded input", LINE))
    assert "which of its limits comes first is not documented" in reason
    assert isinstance(model["step"].element, dd.Placeholder)


@pytest.mark.parametrize(("more", "size", "why"), UNKNOWN)
def test_rates_without_a_documented_code_are_a_placeholder(more, size, why):
    reason, model = why_of(between("RateMatrixToSpaceCode", more, {"bin map": size}, "output", CUBE))
    assert why in reason
    assert isinstance(model["step"].element, dd.Placeholder)


@pytest.mark.parametrize(
    ("rate", "at"),
    [(0.1, 0), (0.18, 1), (0.5, 3), (0.97, 5), (0.98, None), (0.03, 0), (0.01, None), (-9, None)],
)
def test_a_rate_between_two_bins_is_in_the_upper_one_and_beyond_the_last_in_none(rate, at):
    m = Model()
    m.add("ConstMatrix", "rates", {"sizes": [2, 3], "value": rate})
    limits = {"number of bins": 6, "lower limit": 0.1, "upper limit": 0.9}
    m.wire("rates.matrix", f"{m.add('RateMatrixToSpaceCode', 'step', limits)}.bin map")
    model = translate.read(m.text().encode(), "file.json").model
    code = dd.simulate(model, 10, dt=10, record=["step.output"])["step.output"].values[-1]
    expected = np.zeros((2, 3, 6))
    if at is not None:
        expected[:, :, at] = 1
    assert np.array_equal(code, expected)


def test_the_null_space_of_a_robot_states_what_takes_its_place():
    steps = {"cedar.processing.steps.Jacobian": {"name": "J"}, TYPES["Nullspace"]: {"name": "step"}}
    wires = [{"source": "J.jacobian", "target": "step.jacobian"}]
    reason, _ = why_of(written({"steps": steps, "connections": wires}))
    assert "its size is that of 'J'" in reason and "tool_velocity of dd.MuJoCo" in reason


def test_the_largest_bins_are_found_in_single_precision():
    text = every_type()[TYPES["SpaceCodeToRateMatrix"]]
    model = translate.read(text.encode(), "file.json").model
    record = dd.simulate(model, 2000, every=10, record=["step.output"], seed=0)
    expected = oracle.run(text, 200, 10)["step.output"][1:]
    assert np.abs(record["step.output"].values[:-1] - expected).max() < 1e-5
