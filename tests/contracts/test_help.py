"""Signatures, help and completion of every kind come from the declarations and leave the methods of the
contract out.
"""

from __future__ import annotations

import inspect
import pydoc
import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Annotated, Any

import pytest

import deodar as dd
from deodar import docstring, registry
from deodar.element import Element
from deodar.experiments import actions, events, experiment, factor, measures
from deodar.parameters import Live, Part, parameters, positional
from deodar.part_type import PartType
from tests.contracts.build import KINDS, PARTS

TRIALS: dict[str, type[Any]] = {
    name: cls
    for module in (actions, events, experiment, factor, measures)
    for name, cls in vars(module).items()
    if isinstance(cls, PartType) and cls.__module__ == module.__name__ and "__dataclass_fields__" in vars(cls)
}
KINDS_AND_PARTS: dict[str, type[Any]] = {**KINDS, **PARTS, "Window": registry.kind("Window")}
ALL: dict[str, type[Any]] = {**KINDS_AND_PARTS, **TRIALS}


def shown(cls: type[Any]) -> str:
    """Return the output of `help(cls)`, without bold letters."""
    return pydoc.plain(pydoc.render_doc(cls))


def test_a_signature_is_printed_as_valid_python() -> None:
    text = str(inspect.signature(dd.Field))
    assert text.startswith(
        "(name: str = '', axes: Sequence[Axis] = (), tau: float = 20.0, resting_level: float = -5.0, sigmoid:"
        " SigmoidFunction = Logistic("
    )
    assert "kernel: Sequence[Kernel] = ()" in text and "noise_length: float | Sequence[float] = 0.0" in text
    assert str(inspect.signature(registry.kind("Pattern"))).startswith(
        "(name: str = '', axes: Sequence[Axis] = required"
    )
    assert str(inspect.signature(dd.Gain)).endswith("*, name: str = '')")
    assert str(inspect.signature(dd.Experiment)).startswith(
        "(name: str, model: object, plan: TrialPlan, trials: int = 1, factors: Sequence[Factor] = (), *, "
    )


def test_a_signature_has_the_declared_parameters_in_their_order() -> None:
    wrong: list[str] = []
    for name, cls in ALL.items():
        found = inspect.signature(cls).parameters
        in_order = [n for n, p in found.items() if p.kind is p.POSITIONAL_OR_KEYWORD] == list(positional(cls))
        if not in_order or set(found) != {p.name for p in parameters(cls)}:
            wrong.append(f"{name}{inspect.signature(cls)}")
        if re.search(r"Annotated|deodar\.numerics|ForwardRef|MISSING", str(inspect.signature(cls))):
            wrong.append(f"{name} shows how it is declared: {inspect.signature(cls)}")
    assert not wrong, wrong


def missing(cls: type[Any], text: str) -> Iterator[str]:
    """Yield the parameters, units, bounds and choices that a text does not show as the help of a class."""
    documented = cls.__doc__ or ""
    yield from (word for word in ("Annotated", "__dataclass_fields__") if word in text)
    if len(parameters(cls)) > 1:
        text = text[text.index("Attributes:" if cls in TRIALS.values() else "Parameters:") :]
    for p in parameters(cls):
        if p.name == "name" and "\n    name: " not in documented:
            continue
        match = re.search(rf"^ \|      {p.name}: (.+(?:\n \|          .+)*)", text, re.MULTILINE)
        says = " ".join(match[1].replace(" |", " ").split()) if match else ""
        bound = "" if p.lower is None else f"{p.lower:g}"
        expected = (f"unit {p.unit}" if p.unit else "", bound, *p.choices)
        yield from (f"{cls.__name__}.{p.name}: {word}" for word in expected if not says or word not in says)


def test_help_lists_every_parameter_with_unit_range_and_meaning() -> None:
    assert not [what for cls in ALL.values() for what in missing(cls, shown(cls))]


def test_what_help_does_not_show_is_found() -> None:
    text = shown(dd.Field).replace("[unit time;", "[")
    assert list(missing(dd.Field, text)) == ["Field.tau: unit time"]


def test_methods_of_the_contract_are_neither_in_help_nor_in_completion() -> None:
    methods = {
        "input_axes",
        "validate",
        "validate_axes",
        "hoist",
        "prepare",
        "advance",
        "output",
        "init",
        "bounds",
        "polarity",
    }
    wrong: list[str] = []
    for name, cls in KINDS_AND_PARTS.items():
        instance = cls.example()
        wrong += [f"{name}.{method} is completed" for method in methods & {*dir(cls), *dir(instance)}]
        wrong += [f"{name}.{p.name} is not completed" for p in parameters(cls) if p.name not in dir(instance)]
        inside = re.search(
            r"Data and other attributes|^ \|  (wants|faults|misfits|advance|__init__|__new__)\(",
            shown(cls),
            re.MULTILINE,
        )
        wrong += [f"help({name}) shows {inside[0]}"] if inside else []
    assert not wrong, wrong


def test_help_of_the_base_classes_shows_the_methods_of_the_contract() -> None:
    assert {"input_axes", "advance", "validate_axes"} <= set(dir(Element))
    text = shown(Element)
    assert "advance(self, at: 'Setting'" in text


def test_a_custom_kind_without_a_docstring_has_generated_help() -> None:
    @dataclass(frozen=True)
    class Mine(Part):
        strength: Annotated[float, Live("activation", lower=0, upper=3)] = 1.0

    assert Mine.__doc__ == "Mine.\n\nParameters:\n    strength: [unit activation; 0 to 3]"
    assert str(inspect.signature(Mine)) == "(strength: float = 1.0)"


def test_the_docstring_of_the_source_is_kept() -> None:
    assert (
        "tau: time constant; in the document's time unit, > 0, and at least one step.\n"
        in docstring.source(dd.Field)
    )
    assert dd.Field.__doc__ is not None and dd.Field.__doc__.startswith("A dynamic neural field")
    assert "at least one step. [unit time; at least 1e-06]" in dd.Field.__doc__


def test_a_class_is_made_without_its_annotations_being_read() -> None:
    @dataclass(frozen=True)
    class Early(Part):
        """A part whose annotation names a later class."""

        level: Defined_Later = 1.0  # noqa: F821

    with pytest.raises(NameError, match="Defined_Later"):
        _ = Early.__doc__
