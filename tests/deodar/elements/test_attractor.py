"""A motor variable is driven by its input over the axis of the source, or over the stated axis."""

from __future__ import annotations

import numpy as np
import pytest

import deodar as dd

X, Y = dd.Axis("x", 0, 20, samples=21), dd.Axis("y", 0, 8, samples=9)
RING = dd.Axis("phi", 0, 360, samples=36, periodic=True)


def driven(axes: list[dd.Axis], **given: object) -> dd.Model:
    model = dd.Model("motor")
    stimulus = dd.GaussianStimulus(
        "s",
        axes,
        center=[a.lower + 0.6 * a.range for a in axes],
        sigma=[a.range / 10 for a in axes],
        amplitude=3.0,
    )
    model.add(stimulus) >> model.add(dd.Attractor("phi", tau=50.0, **given))  # type: ignore[arg-type]
    return model


@pytest.mark.parametrize("axis", [X, RING], ids=["line", "ring"])
def test_a_motor_variable_without_an_axis_uses_that_of_its_source(axis: dd.Axis) -> None:
    inferred, stated = (
        dd.simulate(driven([axis], **given), 20, record=["phi"])["phi.output"].values
        for given in ({}, {"axis": axis})
    )
    assert np.array_equal(inferred, stated)
    assert inferred[-1] == pytest.approx(axis.lower + 0.6 * axis.range, rel=1e-2)


def test_a_source_with_two_axes_requires_the_axis() -> None:
    [problem] = [p for p in driven([X, Y]).check() if p.severity == "problem"]
    assert problem.what == "the source has 2 axes, so the axis of the input must be stated"
    assert problem.fix == "Set its axis: x or y"
    assert not [p for p in driven([X, Y], axis=Y).check() if p.severity == "problem"]


def test_a_source_without_an_axis_cannot_drive_it() -> None:
    model = dd.Model("motor")
    model.add(dd.Boost("b", [], 1.0)) >> model.add(dd.Attractor("phi"))
    [problem] = [p for p in model.check() if p.severity == "problem"]
    assert problem.what == "the source has no axis, so it has no positions"


def test_gain_and_offset_are_refused_on_the_periodic_axis_of_the_source() -> None:
    [problem] = [p for p in driven([RING], gain=2.0).check() if p.severity == "problem"]
    assert problem.what == "gain and offset have no meaning on the periodic axis 'phi'"


def test_the_document_states_that_the_axis_is_inferred() -> None:
    model = driven([X])
    reopened = dd.Model(document=model.document)
    assert model["phi"].axis is None and '"axis": null' in reopened.to_json()
    assert not [p for p in reopened.check() if p.severity == "problem"]
