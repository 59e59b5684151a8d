"""Docstrings of registered kinds are complete: symbols in field order, ports, shapes, units, source. Their
first sentence, equation and meanings are judged as forms show them, in `tests/contracts/test_description.py`.
"""

from __future__ import annotations

import dataclasses as dc
import inspect
import re
from typing import Any

from deodar import docstring, registry
from deodar.docstring import Docstring
from deodar.element import Coupling, Element
from deodar.parameters import Part, parameters

KINDS = {name: cls for name, cls in registry.kinds().items() if registry.own(cls)}
ELEMENTS = {name: cls for name, cls in KINDS.items() if issubclass(cls, Element)}
PARTS = {name: cls for name, cls in KINDS.items() if issubclass(cls, Part)}

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


def test_parameters_are_named_in_field_order() -> None:
    wrong: list[str] = []
    for name, cls in KINDS.items():
        reading = read(cls)
        listed = reading.entries("Parameters")
        if list(listed) != fields(cls) or not all(listed.values()):
            wrong.append(f"{name}: {list(listed)}, declared {fields(cls)}")
        if not fields(cls) and reading.sections.get("Parameters") != "none.":
            wrong.append(f"{name}: write `Parameters: none.`")
    assert not wrong, wrong


def test_every_port_is_named_with_its_axes() -> None:
    wrong: list[str] = []
    for name, cls in ELEMENTS.items():
        element = cls.example()
        axes = {port: element.input_axes(port, ()) or () for port in element.ports()}
        listed = read(cls).entries("Ports")
        # a parameter of the function element names its inputs
        expected = {*element.outputs(axes), *(() if "ports_in" in fields(cls) else element.ports())}
        wrong += [f"{name}.{port}: has no line" for port in expected - set(listed)]
        wrong += [f"{name}.{port}: is no port" for port in set(listed) - expected]
        wrong += [
            f"{name}.{port}: say over which axes"
            for port, says in listed.items()
            if not re.search(r"\baxes\b|\baxis\b|one number|picture", says)
        ]
    assert not wrong, wrong


def test_the_docstring_states_shapes() -> None:
    """Of arrays each by its name; of kernels, sigmoids and worlds at all."""
    wrong = [
        name for name, cls in KINDS.items() if name not in ELEMENTS and not read(cls).sections.get("Shapes")
    ]
    wrong += [
        f"{name}.{p.name}"
        for name, cls in PARTS.items()
        for p in parameters(cls)
        if p.form == "array" and p.name not in read(cls).entries("Shapes")
    ]
    assert not wrong, wrong


def test_the_docstring_states_declared_units() -> None:
    wrong: list[str] = []
    for name, cls in PARTS.items():
        listed = read(cls).entries("Parameters")
        for p in (p for p in parameters(cls) if p.unit):
            if p.unit not in UNIT_WORDS:
                wrong.append(
                    f"{name}.{p.name}: the unit {p.unit!r} is new; say here how a description names it"
                )
            elif UNIT_WORDS[p.unit] and not any(word in listed[p.name] for word in UNIT_WORDS[p.unit]):
                wrong.append(f"{name}.{p.name}: the unit is {p.unit}, the description says: {listed[p.name]}")
    assert not wrong, wrong


def test_the_docstring_has_a_source_or_states_no_reference() -> None:
    says = {name: read(cls).sections.get("Reference", "") for name, cls in KINDS.items()}
    wrong = {n: s for n, s in says.items() if s != "no reference" and not re.search(r"\((19|20)\d\d\)", s)}
    assert not wrong, f"give authors, year and place, or: no reference {wrong}"


def test_couplings_declare_direct_outputs() -> None:
    assert not [
        n for n, cls in ELEMENTS.items() if issubclass(cls, Coupling) and not any(cls.direct.values())
    ]
