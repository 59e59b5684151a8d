"""Ports with a meaning of their own are declared by their class, also by custom classes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, ClassVar

import numpy as np

import deodar as dd
from deodar.compiler.body import Body
from deodar.compiler.build import Build
from deodar.compiler.plan import plan
from deodar.model.document_graph import graph
from deodar.model.sketch import caption
from tests.deodar.compiler.programs import executable

x = dd.Axis("x", 0, 10, samples=11)
y = dd.Axis("y", 0, 4, samples=5)


@dataclass(frozen=True)
class Reading(dd.Element):
    """The input from outside the model, plus 1."""

    name: str = ""
    axes: Sequence[dd.Axis] = ()

    inputs: ClassVar[tuple[str, ...]] = ()
    external: ClassVar[str] = "seen"
    direct: ClassVar[Mapping[str, tuple[str, ...]]] = {"output": ()}

    def outputs(self, ins: Mapping[str, dd.Axes]) -> Mapping[str, dd.Axes]:
        return {"output": tuple(self.axes)}

    def output(self, at: dd.Setting) -> dd.Arrays:
        return {"output": at.inputs["seen"] + 1.0}


@dataclass(frozen=True)
class Mask(dd.Coupling):
    """The input where a mask is above 0."""

    inputs: ClassVar[tuple[str, ...]] = ("input", "mask")
    follows: ClassVar[Mapping[str, str]] = {"mask": "input"}
    direct: ClassVar[Mapping[str, tuple[str, ...]]] = {"output": ("input", "mask")}

    def output(self, at: dd.Setting) -> dd.Arrays:
        return {"output": at.inputs["input"] * (at.inputs["mask"] > 0)}


@dataclass(frozen=True)
class Strength(dd.Coupling):
    """A gain by another name."""

    weight: Annotated[float, dd.Live()] = 2.0

    linear: ClassVar[bool] = True
    scaled_by: ClassVar[str] = "weight"

    def output(self, at: dd.Setting) -> dd.Arrays:
        return {"output": self.weight * at.inputs["input"]}


def readings() -> dd.Model:
    model = dd.Model("readings")
    for name in "ab":
        model.add(Reading(name, [x]))
    return model


def test_elements_with_an_external_input_are_fed_by_their_ids() -> None:
    model = readings()
    program = executable(model)
    assert [g.rows for g in program.plan.groups] == [1, 1]
    assert set(program.blind()) == {e.id for e in model.document.entries}
    assert np.array_equal(dd.Session(model).read("a.output"), np.ones(11))


def test_an_external_input_changes_when_the_world_is_inside_the_step() -> None:
    document = readings().document
    assert all(g.still for g in plan(Build(document)).groups)
    assert not any(g.still for g in plan(Build(document, body=Body(dd.Arena("blocks"), {}, {}))).groups)


def masked(source: Sequence[dd.Axis], mask: Sequence[dd.Axis]) -> dd.Model:
    model = dd.Model("masked")
    port = model.add(Mask(name="m"))
    model.add(dd.Boost("s", source, 3.0)) >> port
    model.add(dd.Boost("b", mask, 1.0)) >> port["mask"]
    return model


def test_a_port_that_follows_another_takes_its_axes() -> None:
    node = next(n for n in graph(masked([x], []).document).nodes if n.path == "m")
    assert node.ins["mask"] == node.ins["input"] == (x,)


def test_a_port_that_follows_another_refuses_more_axes_and_names_it() -> None:
    problems = graph(masked([x], [x, y]).document).problems
    assert len(problems) == 1 and "it has more axes" in problems[0].what
    assert "the port 'input' takes the larger one" in problems[0].fix


def test_pictures_show_the_factor_of_any_multiple() -> None:
    assert caption(Strength()) == "× 2" and caption(dd.Gain(0.5)) == "× 0.5"
