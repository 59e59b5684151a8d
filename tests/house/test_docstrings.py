"""Docstrings of registered kinds are complete: equation, symbols in field order, ports, shapes, units,
source.
"""

from __future__ import annotations

import dataclasses as dc
import inspect
import re
from typing import Any

import pytest

from deodar import docstring, registry
from deodar.docstring import Docstring
from deodar.element import Coupling, Element
from deodar.parameters import Part, parameters

KINDS = {name: cls for name, cls in registry.kinds().items() if registry.own(cls)}
ELEMENTS = {name: cls for name, cls in KINDS.items() if issubclass(cls, Element)}

# The words that the description of a parameter needs for its declared unit. Activation has no unit of its own
# and needs none.
UNIT_WORDS = {
    "time": ("time",),
    "axis": ("axis", "axes"),
    "activation": (),
    "1/activation": ("per unit of activation",),
    "hue": ("hue",),
    "motor": ("motor", "phi"),
    "motor/axis": ("motor units per axis unit",),
    "axis/time": ("axis units per unit of the document's time",),
    "motor/time": ("per unit of the document's time",),
    "1/time": ("per unit of the document's time",),
    "time x input": ("document time times",),
    "input x axis": ("N ", "integral"),
}


def read(cls: type[Any]) -> Docstring:
    """Return the parsed docstring of the source."""
    return docstring.parse(docstring.source(cls))


def fields(cls: type[Any]) -> list[str]:
    """Return the parameters in their order of declaration, positional ones first, without `name`, which
    every element has.
    """
    if not dc.is_dataclass(cls):
        return [p for p in inspect.signature(cls.__init__).parameters if p != "self"]
    found = dc.fields(cls)
    ordered = [f.name for f in found if not f.kw_only] + [f.name for f in found if f.kw_only]
    return [f for f in ordered if f != "name"]


@pytest.mark.parametrize("name", KINDS)
def test_a_docstring_has_a_sentence_and_an_equation(name: str) -> None:
    found = read(KINDS[name])
    first = found.summary
    assert first.endswith(".") and len(first) < 150, "begin with one sentence in a paragraph of its own"
    assert found.sections.get("Equation"), "write a section Equation:"


@pytest.mark.parametrize("name", KINDS)
def test_parameters_are_named_in_field_order(name: str) -> None:
    found = read(KINDS[name])
    if fields(KINDS[name]):
        assert list(found.entries("Parameters")) == fields(KINDS[name])
        assert all(found.entries("Parameters").values())
    else:
        assert found.sections.get("Parameters") == "none."


@pytest.mark.parametrize("name", ELEMENTS)
def test_every_port_is_named_with_its_axes(name: str) -> None:
    cls = ELEMENTS[name]
    element = cls.example()
    axes = {port: element.input_axes(port, ()) or () for port in element.ports()}
    outputs = list(element.outputs(axes))
    listed = read(cls).entries("Ports")
    # a parameter of the function element names its inputs
    wanted = {*outputs, *(() if "ports_in" in fields(cls) else element.ports())}
    assert set(listed) == wanted
    for port, says in listed.items():
        assert re.search(r"\baxes\b|\baxis\b|one number|picture", says), f"{port}: say over which axes"


@pytest.mark.parametrize("name", [n for n in KINDS if n not in ELEMENTS])
def test_the_docstring_states_shapes(name: str) -> None:
    assert read(KINDS[name]).sections.get("Shapes")


@pytest.mark.parametrize(
    "name",
    [
        n
        for n, cls in KINDS.items()
        if issubclass(cls, Part) and any(p.form == "array" for p in parameters(cls))
    ],
)
def test_the_docstring_states_the_shape_of_arrays(name: str) -> None:
    shapes = read(KINDS[name]).entries("Shapes")
    assert {p.name for p in parameters(KINDS[name]) if p.form == "array"} <= set(shapes)


@pytest.mark.parametrize("name", [n for n, cls in KINDS.items() if issubclass(cls, Part)])
def test_the_docstring_states_declared_units(name: str) -> None:
    cls = KINDS[name]
    listed = read(cls).entries("Parameters")
    for p in parameters(cls):
        if p.unit:
            assert p.unit in UNIT_WORDS, (
                f"{p.name}: the unit {p.unit!r} is new; say here how a description names it"
            )
            words = UNIT_WORDS[p.unit]
            assert not words or any(w in listed[p.name] for w in words), (
                f"{p.name}: the unit is {p.unit}, the description says: {listed[p.name]}"
            )


@pytest.mark.parametrize("name", [n for n, cls in KINDS.items() if issubclass(cls, Part)])
def test_every_parameter_has_a_meaning(name: str) -> None:
    """The declaration also has the meaning, which forms and the JSON Schema show."""
    silent = [p.name for p in parameters(KINDS[name]) if not p.meaning]
    assert not silent


@pytest.mark.parametrize("name", KINDS)
def test_the_docstring_has_a_source_or_states_no_reference(name: str) -> None:
    says = read(KINDS[name]).sections.get("Reference", "")
    assert says == "no reference" or re.search(r"\((19|20)\d\d\)", says), (
        f"give authors, year and place, or: no reference ({says!r})"
    )


@pytest.mark.parametrize("name", [n for n, cls in ELEMENTS.items() if issubclass(cls, Coupling)])
def test_couplings_declare_direct_outputs(name: str) -> None:
    assert any(ELEMENTS[name].direct.values())
