"""What cosivina does not have is reported, and what is left is a file that it reads."""

from __future__ import annotations

import numpy as np
import pytest

import deodar as dd
from deodar.errors import ModelError, OutputExists, UnknownName
from deodar_interop.exporters.cosivina import write
from tests.deodar_interop.exporters.cosivina.files import elements

X = dd.Axis("x", 0, 20, samples=21)


def lost(model):
    """Return (where, part, what, verdict) of what is not carried."""
    report = write(model, "file.json").report
    return {(line.where, line.part, line.what, line.verdict) for line in report.losses}


def model_of(*parts):
    m = dd.Model("m")
    for part in parts:
        m.add(part)
    return m


@pytest.mark.parametrize(
    ("element", "parameter", "verdict"),
    [
        (dd.Field("u", [X], sigmoid=dd.Absolute(2)), "sigmoid", "approximated"),
        (dd.Field("u", [X], sigmoid=dd.Step()), "sigmoid", "approximated"),
        (dd.Field("u", [X], sigmoid=dd.Linear()), "sigmoid", "dropped"),
        (dd.Field("u", [X], quadrature="cell"), "quadrature", "dropped"),
        (dd.Field("u", [X, dd.Axis("y", 0, 9, samples=10)], kernel=[dd.Box(1, 3)]), "kernel", "dropped"),
        (dd.MemoryTrace("u", [X], fades=True), "fades", "dropped"),
        (dd.MemoryTrace("u", [X], start=np.ones(21)), "start", "dropped"),
    ],
)
def test_a_parameter_that_cosivina_does_not_have_is_reported(element, parameter, verdict):
    m = model_of(element)
    if isinstance(element, dd.MemoryTrace):
        m.add(dd.Boost("b", [X])) >> m["u"]
    losses = lost(m)
    assert ("u", "parameter", parameter, verdict) in losses
    assert ("u", "element", type(element).__name__, "approximated") in losses
    assert "u" in [label for label, *_ in elements(write(m, "file.json").content)]


@pytest.mark.parametrize("quadrature", ["cell", "point"])
def test_the_bounded_output_is_that_at_the_sample(quadrature):
    m = model_of(dd.Field("u", [X], quadrature=quadrature), dd.Field("v", [X]))
    m.connect("u.bounded", "v")
    assert ("v", "connection", "u.bounded", "dropped") not in lost(m)
    written = {label: links for label, *_, links in elements(write(m, "file.json").content)}
    assert ("u", "output") in [tuple(link[:2]) for link in written["v"]]


def test_a_logistic_with_the_slope_of_the_absolute_sigmoid_replaces_it():
    (_, _, param, _), *_ = elements(write(model_of(dd.Field("u", [X], sigmoid=dd.Absolute(2))), "f").content)
    at = np.array([-1e-3, 1e-3])
    slope = np.diff(np.asarray(dd.Absolute(2)(at)))
    assert np.diff(1 / (1 + np.exp(-param["beta"] * at))) == pytest.approx(slope, rel=1e-2)


@pytest.mark.parametrize(
    "element",
    [
        dd.Sensor("e", [X]),
        dd.MovingGaussian("e", [X], velocity=3),
        dd.Weights(np.ones((21, 21, 21)), [X, dd.Axis("y", 0, 20, samples=21)], name="e"),
        dd.Sigmoid(dd.Linear(), name="e"),
        dd.Project([], "max", name="e"),
    ],
)
def test_an_element_that_cosivina_does_not_have_is_left_out_with_its_connections(element):
    m = dd.Model("m")
    u, v = (
        m.add(dd.Field("u", [X])),
        m.add(
            dd.Field(
                "v", [X] if not isinstance(element, dd.Weights) else [X, dd.Axis("y", 0, 20, samples=21)]
            )
        ),
    )
    e = m.add(element)
    if element.ports():
        u >> e
    e >> v
    losses = lost(m)
    assert ("e", "element", type(element).__name__, "dropped") in losses
    assert ("v", "connection", "e", "dropped") in losses
    assert [label for label, *_ in elements(write(m, "file.json").content)] == ["u", "v"]


def test_groups_shared_parameters_rates_and_units_are_reported():
    m = dd.Model("m")
    m.describe(time_unit="s")
    m.group("inside")
    m.add(dd.Field("u", [X]), group="inside")
    m.parameter("rest", -4.0)
    m.link("inside.u.resting_level", "rest")
    m.add(dd.Field("slow", [X]), ticks=4)
    losses = lost(m)
    assert ("inside", "group", "inside", "dropped") in losses
    assert ("", "file", "time_unit", "dropped") in losses
    assert ("rest", "parameter", "rest", "dropped") in losses
    assert ("slow", "element", "Field", "approximated") in losses
    assert [label for label, *_ in elements(write(m, "f").content)] == ["inside.u", "slow"]


def test_learned_weights_are_not_in_a_file():
    m = model_of(dd.Field("u", [X]), dd.Field("v", [X]))
    w = m.add(dd.AdaptiveWeights([X], 0.1, start=np.ones((21, 21)), name="w"))
    m["u"] >> w
    m["v"] >> w["post"]
    w >> m["v"]
    assert ("w", "parameter", "start", "dropped") in lost(m)


def test_a_model_with_problems_is_not_exported(tmp_path):
    m = model_of(dd.Gain(2, name="g"))
    with pytest.raises(ModelError, match="nothing is connected"):
        dd.export(m, tmp_path / "file.json")
    assert not list(tmp_path.iterdir())


def test_a_file_is_written_once_and_loads_again(tmp_path):
    m = model_of(dd.Field("u", [X]))
    report = dd.export(m, tmp_path / "file.json")
    assert report.faithful and report.tool == "cosivina"
    assert dd.load(tmp_path / "file.json")["u"].tau == 20
    with pytest.raises(OutputExists):
        dd.export(m, tmp_path / "file.json")
    dd.export(m, tmp_path / "file.json", force=True)
    with pytest.raises(UnknownName, match="cosivina"):
        dd.export(m, tmp_path / "other.json", to="cosivin")


def test_two_elements_of_one_name_in_different_groups_have_different_labels():
    m = dd.Model("m")
    m.group("a")
    m.add(dd.Field("u", [X]), group="a")
    m.add(dd.Field("u", [X]))
    assert [label for label, *_ in elements(write(m, "f").content)] == ["a.u", "u"]


def test_connections_into_one_input_are_added_up_before_it():
    m = dd.Model("m")
    u, v, n = m.add(dd.Field("u", [X])), m.add(dd.Field("v", [X])), m.add(dd.Field("n"))
    k = m.add(dd.Convolve([dd.Gaussian(1, 2)], name="k"))
    for source in (u, v, n):
        source >> k
    losses = {label: (kind, inputs) for label, kind, _, inputs in elements(write(m, "f").content)}
    assert losses["k"][1] == [("inputs of k", "output")]
    assert losses["inputs of k"][0] == "SumInputs" and len(losses["inputs of k"][1]) == 3


def test_the_gaussians_of_a_field_are_written_without_its_other_kernels():
    plane = [X, dd.Axis("y", 0, 9, samples=10)]
    m = model_of(dd.Field("u", plane, kernel=[dd.Gaussian(1, 2), dd.Box(1, 3)], global_inhibition=0.1))
    losses = {label: (kind, inputs) for label, kind, _, inputs in elements(write(m, "f").content)}
    assert losses["u -> u"] == ("LateralInteractions2D", [("u", "output")])
    assert losses["u"] == ("NeuralField", [("u -> u", "output")])
    assert ("u", "parameter", "kernel", "dropped") in lost(m)


def test_a_field_of_four_dimensions_is_written_without_its_kernel():
    axes = [dd.Axis(name, 0, 2, samples=3) for name in "abcd"]
    m = model_of(dd.Field("u", axes, kernel=[dd.Gaussian(1, 2)]))
    assert [kind for _, kind, _, _ in elements(write(m, "f").content)] == ["NeuralField"]
    assert ("u", "parameter", "kernel", "dropped") in lost(m)


def test_a_factor_behind_a_register_is_a_connection_that_is_listed_twice():
    m = model_of(dd.Field("u", [X]), dd.Field("v", [X]))
    m["u"] >> dd.Delay([X], name="u before") >> dd.Gain(2.0, name="u 2 times to v") >> m["v"]
    inputs = {label: listed for label, _, _, listed in elements(write(m, "file.json").content)}
    assert inputs == {"u": [], "u before": [("u", "output")], "v": [("u before", "output")] * 2}
