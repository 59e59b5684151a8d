"""A position is read out over the axis of the source, or over the stated axis."""

from __future__ import annotations

import numpy as np
import pytest

import deodar as dd

X, Y, RING = (
    dd.Axis("x", 0, 20, samples=21),
    dd.Axis("y", 0, 8, samples=9),
    dd.Axis("phi", 0, 360, samples=36, periodic=True),
)


def model(axes: list[dd.Axis], **axis: dd.Axis) -> dd.Model:
    model = dd.Model("place")
    center = [a.lower + 0.5 * a.range for a in axes]
    model.add(
        dd.GaussianStimulus("s", axes, center=center, sigma=[a.range / 10 for a in axes], amplitude=3.0)
    ) >> model.add(dd.PeakPosition(name="p", **axis))
    return model


@pytest.mark.parametrize("axis", [X, RING], ids=["line", "ring"])
def test_the_axis_of_the_source_is_read_out(axis: dd.Axis) -> None:
    inferred, stated = (
        dd.simulate(model([axis], **options), 1, record=["p.output", "p.strength"])
        for options in ({}, {"axis": axis})
    )
    assert inferred["p.output"].values[-1] == pytest.approx(axis.lower + axis.range / 2, abs=1e-3)
    for port in ("p.output", "p.strength"):
        assert np.array_equal(inferred[port].values, stated[port].values)


def test_a_source_with_two_axes_requires_the_axis() -> None:
    [problem] = model([X, Y]).check()
    assert (
        problem.what == "the source has 2 axes, so the axis of the input must be stated"
        and problem.fix == "Set its axis: x or y"
    )
    assert not [p for p in model([X, Y], axis=Y).check() if p.severity == "problem"]


def test_a_source_without_an_axis_has_no_position() -> None:
    model = dd.Model("place")
    model.add(dd.Boost("b", [], 1.0)) >> model.add(dd.PeakPosition(name="p"))
    [problem] = [p for p in model.check() if p.severity == "problem"]
    assert problem.what == "the source has no axis, so it has no positions"


def test_a_document_keeps_that_the_axis_is_inferred() -> None:
    placed = model([X])
    placed["p"].axis = X
    assert placed.undo() and placed["p"].axis is None
    loaded = dd.Model(document=placed.document)
    assert '"axis": null' in loaded.to_json() and not loaded.check()
