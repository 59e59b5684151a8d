"""Readers that use an output as a number between 0 and 1 get means over cells that stay in that range."""

from __future__ import annotations

import functools
import re

import numpy as np
import pytest

import deodar as dd
from deodar.model.document_graph import graph
from deodar.numerics.sigmoids import Absolute
from deodar.registry import kinds

LENGTH = {1: 100.0, 2: 60.0}
KERNEL, INHIBITION = {1: 12.0, 2: 14.0}, {1: 0.3, 2: 0.01}
PLACES = {1: ((0.0,), (0.3,), (0.5,)), 2: ((0.0, 0.0), (0.5, 0.5), (0.3, 0.15))}
STEP = 2.0
"""Distance of the samples of a grid of 2.5 samples a kernel width."""


def peak(dimensions: int, width: float, sigmoid: object, offset: tuple[float, ...]) -> dd.Model:
    """Return a field with a peak beside a sample, and two traces of it: of all, and of active samples."""
    length = LENGTH[dimensions]
    axes = [
        dd.Axis(n, 0, length, samples=round(length / 5 * width), periodic=True) for n in "xy"[:dimensions]
    ]
    model = dd.Model("peak", dt=4)
    u = model.add(
        dd.Field(
            "u",
            axes,
            sigmoid=sigmoid,  # type: ignore[arg-type]
            kernel=[dd.Gaussian(KERNEL[dimensions], 5, normalized=True)],
            global_inhibition=INHIBITION[dimensions],
            quadrature="cell",
        )
    )
    center = [length / 2 + STEP * o for o in offset]
    model.add(dd.GaussianStimulus("input", axes, center=center, sigma=5, amplitude=10)) >> u
    for name, threshold in (("whole", -1.0), ("active", 0.5)):
        u >> model.add(dd.MemoryTrace(name, axes, tau_build=50, threshold=threshold))
    return model


def axes_of(model: dd.Model) -> list[dd.Axis]:
    """Return the axes of the field."""
    field = model["u"].element
    assert isinstance(field, dd.Field)
    return list(field.axes)


@functools.cache
def integrals(
    dimensions: int, width: float, sigmoid: object, offset: tuple[float, ...]
) -> dict[str, tuple[float, float, float]]:
    """Return the smallest and largest value and the integral at the end, by port."""
    ports = ["u.output", "whole.output", "active.output"]
    record = dd.simulate(
        peak(dimensions, width, sigmoid, offset),
        1200,
        record=ports,
        every=1200,
        on=dd.Resources(progress=False),
    )
    at_the_end = [(port, record[port].values[-1].astype(float)) for port in ports]
    cell = (5 / width) ** dimensions
    return {port: (float(v.min()), float(v.max()), float(v.sum() * cell)) for port, v in at_the_end}


@pytest.mark.parametrize("sigmoid", [dd.Logistic(4.0), Absolute(100.0)], ids=["logistic", "steep"])
@pytest.mark.parametrize(("dimensions", "whole", "active"), [(1, 0.1, (-8, 4)), (2, 0.8, (-14, 0))])
def test_a_trace_of_a_peak_with_edges_stays_in_0_to_1_and_keeps_its_integral(
    dimensions: int, whole: float, active: tuple[float, float], sigmoid: object
) -> None:
    """Percent of a grid of 20 samples a kernel width, of 6 over two axes; `active` counts whole samples."""
    fine = {1: 20.0, 2: 6.0}[dimensions]
    beyond = 0.0
    for offset in PLACES[dimensions]:
        coarse, exact = (integrals(dimensions, w, sigmoid, offset) for w in (2.5, fine))
        low, high, _ = coarse["u.output"]
        beyond = max(beyond, -low, high - 1)
        for name in ("whole.output", "active.output"):
            assert coarse[name][0] >= 0 and coarse[name][1] <= 1 + 1e-6
        error = {p: 100 * (coarse[p][2] / exact["u.output"][2] - 1) for p in coarse}
        assert abs(error["whole.output"]) < whole
        assert active[0] < error["active.output"] < active[1]
    assert beyond > 0.03, "the output itself leaves the range"


def test_learned_weights_stay_in_0_to_1_where_the_output_is_below_0() -> None:
    model = peak(1, 2.5, dd.Logistic(10.0), (0.3,))
    weights = model.add(dd.AdaptiveWeights(axes_of(model), rate=0.2, name="weights"))
    model["u"] >> weights
    model["u"] >> weights["post"]
    learned = dd.simulate(model, 2000, record="weights.weights", every=2000)["weights.weights"].values[-1]
    assert learned.max() > 0.99
    assert learned.min() > -1e-6 and learned.max() < 1 + 1e-6


def read_by(model: dd.Model, path: str, port: str) -> list[str]:
    """Return the ports of other elements that a port reads, through implicit projections and delays."""
    nodes = {n.id: n for n in graph(model.document).nodes}
    slots = next(n for n in nodes.values() if n.path == path).reads[port]
    while not all(nodes[i].declared for i, _, _ in slots):
        slots = [
            s for i, p, t in slots for s in ([(i, p, t)] if nodes[i].declared else nodes[i].reads["input"])
        ]
    return [f"{nodes[i].path}.{p}" for i, p, _ in slots]


@pytest.mark.parametrize("quadrature", ["cell", "point"])
def test_bounded_readers_get_the_bounded_port_also_delayed_and_resampled(quadrature: str) -> None:
    model = peak(1, 2.5, dd.Logistic(), (0.0,))
    model.set("u.quadrature", quadrature)
    coarse = dd.Axis("x", 0, LENGTH[1], samples=30, periodic=True)
    model["u"] >> model.add(dd.MemoryTrace("resampled", [coarse]))
    model.connect(model["u"], model.add(dd.MemoryTrace("later", axes_of(model))), reads="delayed")
    model["u"] >> model.add(dd.Gain(2.0, name="linear"))
    for path in ("whole", "resampled", "later"):
        assert read_by(model, path, "input") == ["u.bounded"]
    assert read_by(model, "linear", "input") == ["u.output"]
    assert set(dd.simulate(model, 8, record=["u.output", "later.output"])) == {"u.output", "later.output"}


@pytest.mark.parametrize("quadrature", ["point", "cell-0.1"])
@pytest.mark.parametrize("dimensions", [1, 2])
def test_bounded_is_the_output_where_the_output_stays_in_the_range(dimensions: int, quadrature: str) -> None:
    model = peak(dimensions, 2.5, dd.Logistic(10.0), PLACES[dimensions][1])
    model.set("u.quadrature", quadrature)
    session = dd.Session(model)
    session.run(200)
    output = np.asarray(session.read("u.output"))
    assert output.max() > 0.9
    assert np.array_equal(session.read("u.bounded"), output)


@pytest.mark.parametrize("after", ["cell", "cell-0.1", "point"])
@pytest.mark.parametrize("before", ["cell", "cell-0.1", "point"])
def test_bounded_readers_go_on_at_a_change_of_the_quadrature(before: str, after: str) -> None:
    """Of a field with an output of 1 everywhere, which all quadratures agree about."""
    axis = dd.Axis("x", 0, LENGTH[1], samples=50, periodic=True)
    model = dd.Model("switched", dt=4)
    u = model.add(dd.Field("u", [axis], resting_level=5.0, quadrature=before))
    trace = dd.MemoryTrace("trace", [axis], tau_build=8.0, tau_decay=8.0, threshold=-1.0)
    model.connect(u, model.add(trace), reads="delayed")
    model.connect(u["bounded"], model.add(dd.Field("v", [axis])))
    session = dd.Session(model)
    session.run(400)
    session.set("u.quadrature", after)
    for _ in range(3):
        session.step()
        assert np.asarray(session.read("trace.output")) == pytest.approx(1.0, abs=1e-4)
        assert np.asarray(session.read("v.input")) == pytest.approx(1.0, abs=1e-4)
    model.set("u.quadrature", after)
    assert not [problem for problem in model.check() if problem.severity == "error"]


def test_the_port_costs_nothing_where_it_is_the_output(monkeypatch: pytest.MonkeyPatch) -> None:
    def instructions() -> str:
        model = peak(1, 2.5, dd.Logistic(), (0.0,))
        model.set("u.quadrature", "point")
        model.connect(model["u"], model.add(dd.MemoryTrace("later", axes_of(model))), reads="delayed")
        text = dd.Session(model).program.chunk(())[0].as_text() or ""
        return re.sub(r", metadata=\{[^}]*\}", "", text.partition("\n%")[2])

    with_bounded = instructions()
    monkeypatch.setattr(dd.Field, "bounded_port", lambda _, port: port)
    assert len(with_bounded) > 10_000 and with_bounded == instructions()


@pytest.mark.parametrize("reads", ["", "delayed"])
@pytest.mark.parametrize("port", ["output", "bounded"])
@pytest.mark.parametrize("quadrature", ["cell", "point"])
def test_the_fix_of_other_axes_names_the_connected_port(quadrature: str, port: str, reads: str) -> None:
    axes = {name: [dd.Axis(name, 0, LENGTH[1], samples=50)] for name in "xy"}
    model = dd.Model("renamed", dt=4)
    model.add(dd.Field("u", axes["x"], quadrature=quadrature))
    model.add(dd.MemoryTrace("trace", axes["y"]))
    model.connect(f"u.{port}", "trace", reads=reads)
    problem = model.check()[0]
    assert problem.what.startswith(f"u.{port} [x ")
    assert "Project([y]" in problem.fix_at("script")
    assert len(problem.edits) == 1
    model.apply_fix(problem)
    assert not [p for p in model.check() if p.severity == "error"]


def test_bounded_inputs_are_inputs_and_bounded_outputs_stay_in_the_range_of_the_sigmoid() -> None:
    readers = {n: k for n, k in (kinds("elements") | kinds("couplings")).items() if k.bounded_inputs}
    assert {"MemoryTrace", "AdaptiveWeights"} <= set(readers)
    for kind in readers.values():
        assert set(kind.bounded_inputs) <= set(kind.inputs)
    field = peak(1, 2.5, dd.Logistic(), (0.0,))["u"].element
    wide = {"activation": (-50.0, 50.0)}
    bounds = field.bounds({}, {"input": (-50.0, 50.0)}, wide)
    assert bounds["bounded"] == pytest.approx((0.0, 1.0)) and bounds["output"][1] > 1
    assert np.isclose(bounds["output"][0], 1 - bounds["output"][1])
