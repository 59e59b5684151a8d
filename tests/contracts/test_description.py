"""Descriptions of kinds contain the data of forms, equations and plots, also for kinds of packages."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Annotated, Any

import pytest

from deodar import plugins, registry
from deodar.element import Element
from deodar.kinds.description import Description, describe, descriptions, title
from deodar.kinds.parameter import ParameterDescription
from deodar.model.parts import value_from_json
from deodar.numerics.axes import Axes, Axis
from deodar.numerics.kernels._base import Kernel
from deodar.parameters import Live, Part, Recompile

KINDS = {kind.name: kind for kind in descriptions() if plugins.is_own(kind.module)}
INSIDE = [
    name
    for name in KINDS
    if issubclass(registry.kind(name), Part) and not issubclass(registry.kind(name), Element)
]


@pytest.fixture
def outside() -> Iterator[None]:
    """Restore the registry after the test."""
    before = dict(registry._kinds)
    yield
    registry._kinds.clear()
    registry._kinds.update(before)


def form(kind: Description, name: str) -> ParameterDescription:
    return next(p for p in kind.parameters if p.name == name)


def faults(kind: Description) -> Iterator[str]:
    """Yield what a form of a kind would lack."""
    if not kind.title or not kind.title.split()[0][0].isupper():
        yield "no title"
    if kind.room not in {"elements", "couplings", "kernels", "sigmoids", "windows", "worlds"}:
        yield f"in the room {kind.room}"
    if not kind.equation or not all(kind.equation):
        yield "no equation: write a section Equation:"
    if kind.reference == "no reference":
        yield "words in place of an empty reference"
    if not kind.summary.endswith(".") or len(kind.summary) >= 150:
        yield "begin with one sentence in a paragraph of its own"
    if not kind.text.replace("\n", " ").startswith(kind.summary):
        yield "its text does not begin with its sentence"
    yield from (f"{p.name} has no meaning" for p in kind.parameters if not p.meaning or not p.description)
    for p in kind.parameters:
        if p.name == "name" or bool(p.of) != (p.form in ("part", "parts")):
            yield f"{p.name} is of {p.of}, and is {p.form}"
    function = kind.name == "Function"  # a parameter names its inputs
    yield from (f"{port} says nothing" for port, says in kind.ports.items() if not says and not function)


def test_every_kind_is_described_in_full() -> None:
    wrong = [f"{name}: {fault}" for name, kind in KINDS.items() for fault in faults(kind)]
    assert len(KINDS) > 80 and not wrong, wrong
    assert KINDS["Function"].ports["output"]


def test_what_a_description_lacks_is_found() -> None:
    [tau, *_] = (p for p in KINDS["Field"].parameters if p.name == "tau")
    bare = dc.replace(KINDS["Field"], title="", equation=(), summary="No end", ports={"input": ""})
    assert len(list(faults(bare))) == 5
    assert list(faults(dc.replace(KINDS["Field"], parameters=(dc.replace(tau, meaning=""),)))) == [
        "tau has no meaning"
    ]


def test_every_default_fits() -> None:
    """The value that a form shows first is one that the kind accepts."""
    fitted = 0
    for name, kind in KINDS.items():
        for p in (p for p in kind.parameters if p.form not in ("axes", "axis", "array")):
            example = registry.kind(name).example()
            dc.replace(example, **{p.name: value_from_json(example, p.name, p.default, name, {}, {})})
            fitted += 1
    assert fitted > 150


@pytest.mark.parametrize("name", INSIDE)
def test_parameters_inside_parts_have_an_initial_value(name: str) -> None:
    holder, p = next((kind, p) for kind in KINDS.values() for p in kind.parameters if name in p.of)
    start = KINDS[name].example
    example = registry.kind(holder.name).example()
    made = value_from_json(example, p.name, [start] if p.form == "parts" else start, "here", {}, {})
    assert type(made[0] if p.form == "parts" else made) is registry.kind(name)
    dc.replace(example, **{p.name: made})


def test_elements_and_worlds_have_no_initial_value() -> None:
    assert all(kind.example is None for name, kind in KINDS.items() if name not in INSIDE)


def test_the_description_of_a_field_is_complete() -> None:
    field = KINDS["Field"]
    assert (field.title, field.room) == ("Field", "elements")
    assert field.equation[0].startswith(r"\tau \frac{du}{dt} = -u + h")
    assert "Amari (1977)" in field.reference
    assert list(field.ports) == ["input", "output", "bounded", "activation", "interaction"]
    assert field.levels == {
        "activation": {"threshold": "sigmoid.threshold", "resting level": "resting_level"}
    }
    symbols = {p.name: p.symbol for p in field.parameters}
    assert symbols == {
        "axes": "",
        "tau": r"\tau",
        "resting_level": "h",
        "sigmoid": "g",
        "kernel": "k",
        "global_inhibition": "c",
        "noise": "q",
        "noise_length": "",
        "quadrature": "",
    }
    tau = form(field, "tau")
    assert (tau.form, tau.cost, tau.unit, tau.lower, tau.upper, tau.default) == (
        "number",
        "live",
        "time",
        1e-6,
        None,
        20.0,
    )
    assert form(field, "sigmoid").default == {"kind": "Logistic", "beta": 4.0, "threshold": 0.0}
    assert "Gaussian" in form(field, "kernel").of and "Logistic" not in form(field, "kernel").of
    assert form(field, "axes").default == [] and form(field, "kernel").default == []


def test_parameters_are_in_the_order_of_declaration() -> None:
    assert [p.name for p in KINDS["GaussianStimulus"].parameters] == [
        "axes",
        "center",
        "sigma",
        "amplitude",
        "windows",
        "normalized",
        "boundary",
    ]
    assert [p.name for p in KINDS["Gaussian"].parameters] == ["amplitude", "sigma", "normalized", "boundary"]


def test_sections_follow_from_types_and_roles_or_are_declared() -> None:
    sections = {p.name: p.section for p in KINDS["Field"].parameters}
    assert sections == {
        "axes": "axes",
        "tau": "time course",
        "resting_level": "time course",
        "sigmoid": "interaction",
        "kernel": "interaction",
        "global_inhibition": "interaction",
        "noise": "noise",
        "noise_length": "noise",
        "quadrature": "axes",
    }
    stimulus = {p.name: p.section for p in KINDS["GaussianStimulus"].parameters}
    assert (stimulus["center"], stimulus["windows"], stimulus["axes"]) == ("", "time course", "axes")
    assert {p.section for p in KINDS["Gain"].parameters} == {""}


def test_symbols_are_those_of_the_equation() -> None:
    assert form(KINDS["Step"], "threshold").symbol == r"\theta"
    assert form(KINDS["MexicanHat"], "sigma_excitation").symbol == r"\sigma_{\mathrm{excitation}}"
    assert form(KINDS["Gain"], "factor").symbol == r"\mathrm{factor}"
    assert form(KINDS["Weights"], "weights").symbol == "W"
    assert form(KINDS["Attractor"], "initial").symbol == ""


def test_choices_optional_values_and_arrays_are_described() -> None:
    boundary = form(KINDS["Gaussian"], "boundary")
    assert (
        boundary.optional
        and boundary.default is None
        and boundary.choices == ("periodic", "zero", "reflect", "replicate")
    )
    assert form(KINDS["Project"], "rename").default == {}
    assert form(KINDS["Custom"], "weights").default is None and "weights" not in KINDS["Custom"].example


def test_a_world_names_its_sensors() -> None:
    picture = KINDS["Picture"]
    assert picture.room == "worlds" and list(picture.ports) == ["picture"] and not picture.parameters


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("GaussianStimulus", "Gaussian stimulus"),
        ("DNFNode", "DNF node"),
        ("Field", "Field"),
        ("my_part", "My part"),
        ("K", "K"),
    ],
)
def test_titles_separate_the_words_of_a_name(name: str, words: str) -> None:
    assert title(name) == words


def test_custom_kinds_may_lack_all_descriptions(outside: None) -> None:
    @registry.register
    @dataclass(frozen=True)
    class Silent(Element):
        need: Annotated[float, Live()] = 1.0
        where: Annotated[Axis, Recompile()] = ...  # type: ignore[assignment]

        def outputs(self, ins: Any) -> dict[str, Axes]:
            raise RuntimeError("not now")

    @registry.register
    @dataclass(frozen=True)
    class Hollow(Kernel):
        depth: float

    described = {kind.name: kind for kind in descriptions()}
    silent, hollow = described["Silent"], described["Hollow"]
    assert (silent.room, hollow.room) == ("own", "own")
    assert silent.equation == () and silent.reference == "" and silent.levels == {}
    assert silent.ports == {"input": ""}
    assert [p.name for p in silent.parameters] == ["need", "where"]
    assert hollow.example is None
    assert "Hollow" in form(described["Field"], "kernel").of


def test_range_and_default_of_a_parameter_are_valid_python() -> None:
    field = {p.name: p for p in KINDS["Field"].parameters}
    assert (field["tau"].range, field["tau"].typed) == ("at least 1e-06", "20")
    assert field["sigmoid"].typed == "Logistic(beta=4, threshold=0)"
    assert (field["quadrature"].range, field["quadrature"].typed) == ("cell, cell-0.1, point", "'point'")
    assert (field["axes"].range, field["axes"].typed) == ("", "none")
    assert form(KINDS["Pattern"], "axes").typed == "required"
    assert form(KINDS["Logistic"], "beta").range == "1e-06 to 1000000"


def test_a_world_has_arguments_in_place_of_parameters() -> None:
    assert not KINDS["Picture"].parameters and list(KINDS["Picture"].arguments) == ["file"]
    assert not KINDS["Field"].arguments


def test_one_kind_is_described_as_among_all() -> None:
    assert describe(registry.kind("Field")) == KINDS["Field"]
    assert (KINDS["Field"].public_name, KINDS["Field"].module) == ("dd.Field", "deodar.elements.field")
