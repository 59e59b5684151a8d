"""The warning about readers of numbers between 0 and 1 behind couplings, and its fix."""

from __future__ import annotations

import time

import pytest

import deodar as dd
from deodar.element import Element
from deodar.errors import Problem
from deodar.model.check import check
from deodar.model.proposed import apply

X = [dd.Axis("x", 0, 100, samples=50, periodic=True)]
COUPLINGS = {
    "gain": lambda: [dd.Gain(2.0, name="first")],
    "delay line": lambda: [dd.DelayLine("first", X, delay=20.0)],
    "two": lambda: [dd.Gain(1.0, name="first"), dd.Sum(name="second")],
}


def learning(between: list[Element], quadrature: str = "cell", reader: Element | None = None) -> dd.Model:
    """Return a field whose output reaches weights through couplings, and another reader of the last one."""
    model = dd.Model("learning", dt=4)
    kernel = [dd.Gaussian(12.0, 5, normalized=True)]
    u = model.add(dd.Field("u", X, kernel=kernel, global_inhibition=0.3, quadrature=quadrature))
    model.add(dd.GaussianStimulus("s", X, center=50.6, sigma=5, amplitude=10)) >> u
    weights = model.add(dd.AdaptiveWeights(X, rate=0.2, name="weights"))
    last = u
    for element in between:
        last = last >> model.add(element)
    last >> weights
    u >> weights["post"]
    if reader is not None:
        last >> model.add(reader)
    return model


def warned(model: dd.Model) -> list[Problem]:
    return [p for p in check(model.document) if "needs numbers between 0 and 1" in p.what]


@pytest.mark.parametrize("between", COUPLINGS)
def test_the_fix_connects_the_bounded_means(between: str) -> None:
    model = learning(COUPLINGS[between]())
    (problem,) = warned(model)
    assert problem.where == "weights" and "reads u.output through first" in problem.what
    assert "model.connect('u.bounded', 'first.input')" in problem.fix_at("script")
    assert "connect u.bounded to first.input in place of u.output" in problem.fix_at("page")
    fixed = dd.Model(document=apply(model.document, problem.edits))
    assert warned(fixed) == []
    least = [
        float(dd.simulate(m, 400, record="weights.weights", every=400)["weights.weights"][-1].min())
        for m in (model, fixed)
    ]
    assert least[1] >= 0.0 > least[0], least


def test_a_coupling_that_others_read_keeps_its_input() -> None:
    (problem,) = warned(learning([dd.Gain(1.0, name="first")], reader=dd.Field("v", X)))
    assert not problem.edits and "Connect u.bounded to it" in problem.fix


@pytest.mark.parametrize(
    "model",
    [
        learning([]),
        learning([dd.Gain(1.0, name="first")], quadrature="point"),
        learning([dd.Gain(-1.0, name="first")]),
        learning([dd.Threshold(0.5, name="first")]),
    ],
    ids=["no coupling", "sums over points", "negative anyway", "a threshold"],
)
def test_other_readers_get_no_warning(model: dd.Model) -> None:
    assert warned(model) == []


def test_many_ways_through_couplings_are_walked_once() -> None:
    model = learning([])
    layer = [model["u"]]
    for depth in range(12):
        layer, before = [model.add(dd.Gain(0.5, name=f"g{depth}{side}")) for side in "ab"], layer
        for gain in layer:
            for source in before:
                source >> gain
    trace = model.add(dd.MemoryTrace("trace", X))
    for gain in layer:
        gain >> trace
    began = time.process_time()
    assert {p.where for p in warned(model)} == {"trace"}
    assert time.process_time() - began < 2


def test_a_delayed_connection_to_a_coupling_is_found_and_keeps_its_delay() -> None:
    model = learning([])
    gain = model.add(dd.Gain(1.0, name="gain"))
    model.connect("u.output", "gain.input", reads="delayed")
    gain >> model.add(dd.MemoryTrace("trace", X))
    (problem,) = warned(model)
    assert problem.where == "trace" and "reads='delayed'" in problem.fix_at("script")
    fixed = apply(model.document, problem.edits)
    assert ("bounded", "delayed") in {(c.source_port, c.reads) for c in fixed.connections}
    assert warned(dd.Model(document=fixed)) == []


def test_a_coupling_that_also_reads_the_bounded_means_is_left_to_a_person() -> None:
    model = learning([dd.Gain(1.0, name="first")])
    model.connect("u.bounded", "first.input")
    (problem,) = warned(model)
    assert not problem.edits


def test_a_node_has_no_cells() -> None:
    model = dd.Model("node")
    u = model.add(dd.Field("u", [], quadrature="cell"))
    u >> model.add(dd.Gain(1.0, name="gain")) >> model.add(dd.MemoryTrace("trace", []))
    assert warned(model) == []
