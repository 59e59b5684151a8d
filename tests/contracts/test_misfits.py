"""Axes that do not fit: the message names both ports, both axes, and the fix."""

from __future__ import annotations

import dataclasses as dc

import pytest

import deodar as dd
from deodar.errors import ModelError
from deodar.model.check import check
from deodar.numerics.axes import Axes, describe
from tests.contracts.build import KINDS, PARTS, any_example, around, node, source


def moved(axes: Axes) -> list[dd.Axis]:
    """Return axes of the same names and samples with other bounds."""
    return [dc.replace(a, lower=a.lower + a.range / 3, upper=a.upper + a.range) for a in axes]


def message(model: dd.Model) -> str:
    with pytest.raises(ModelError) as caught:
        dd.Session(model)
    return str(caught.value)


INTO = [(kind, port) for kind in KINDS for port, axes in node(around(any_example(kind))).ins.items() if axes]
OUT_OF = [
    (kind, port)
    for kind in (*KINDS, *PARTS)
    for port, axes in node(around(any_example(kind))).outs.items()
    if axes
]


@pytest.mark.parametrize(("kind", "port"), INTO)
def test_a_second_source_with_other_axes_is_a_problem(kind, port):
    model = around(any_example(kind))
    axes = node(model).ins[port]
    bad = moved(axes)
    model.connect(model.add(source("wrong", tuple(bad))), model["example"][port])
    text = message(model)
    parts = ("wrong.output", describe(bad), f"example.{port}", describe(axes), "Write: ", "(test_misfits.py:")
    for part in parts:
        assert part in text, f"{part!r} is missing in: {text}"


@pytest.mark.parametrize(("kind", "port"), OUT_OF)
def test_a_target_with_other_axes_is_a_problem(kind, port):
    model = around(any_example(kind))
    axes = node(model).outs[port]
    bad = moved(axes)
    model.connect(model["example"][port], model.add(dd.Field("target", bad)))
    text = message(model)
    for part in (f"example.{port}", describe(axes), "target.input", describe(bad), "Write: "):
        assert part in text, f"{part!r} is missing in: {text}"


def misfit(kind: str, port: str) -> tuple[dd.Model, list[dd.Axis]]:
    """Return the element with one source for each port, one of which has other bounds."""
    element = any_example(kind)
    axes = node(around(element)).ins
    bad = moved(axes[port])
    model = dd.Model("misfit")
    handle = model.add(element)
    for other in element.ports():
        model.connect(
            model.add(
                source(
                    f"wrong {other}" if other == port else other, tuple(bad) if other == port else axes[other]
                )
            ),
            handle[other],
        )
    return model, bad


# ports that accept any axes accept these, unless parameters state axes
ONLY = [(kind, port) for kind, port in INTO if check(misfit(kind, port)[0].document)]


def test_elements_that_declare_their_axes_are_among_the_tested_kinds():
    assert {"Field", "Attractor", "PeakPosition", "Weighting", "Project", "ColorSpace"} <= {
        kind for kind, _ in ONLY
    }


@pytest.mark.parametrize(("kind", "port"), ONLY)
def test_an_only_source_with_other_axes_is_a_problem(kind, port):
    """Also if the port accepts any axes and only the parameters do not fit."""
    model, bad = misfit(kind, port)
    text = message(model)
    others = [other for other in any_example(kind).ports() if other != port]
    # if two ports must fit each other, the message may name either
    assert any(
        f"{name}.output" in text and f"example.{end}" in text
        for name, end in [(f"wrong {port}", port), *zip(others, others, strict=True)]
    )
    for part in (describe(bad), "rite: "):
        assert part in text, f"{part!r} is missing in: {text}"
