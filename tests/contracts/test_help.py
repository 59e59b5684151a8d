"""Signatures, help and completion of every kind come from the declarations and leave the methods of the
contract out.
"""

from __future__ import annotations

import inspect
import pydoc
import re
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
        "(name: str, model: object, limit: float, trials: int = 1, conditions: Sequence[Event] = (), "
    )


@pytest.mark.parametrize("cls", ALL.values(), ids=ALL)
def test_a_signature_has_the_declared_parameters_in_their_order(cls: type[Any]) -> None:
    found = inspect.signature(cls).parameters
    assert [n for n, p in found.items() if p.kind is p.POSITIONAL_OR_KEYWORD] == list(positional(cls))
    assert set(found) == {p.name for p in parameters(cls)}
    assert not re.search(r"Annotated|deodar\.numerics|ForwardRef|MISSING", str(inspect.signature(cls)))


@pytest.mark.parametrize("cls", ALL.values(), ids=ALL)
def test_help_lists_every_parameter_with_unit_range_and_meaning(cls: type[Any]) -> None:
    text, documented = shown(cls), cls.__doc__ or ""
    assert "Annotated" not in text and "__dataclass_fields__" not in text
    listed = (
        text[text.index("Attributes:" if cls in TRIALS.values() else "Parameters:") :]
        if len(parameters(cls)) > 1
        else text
    )
    for p in parameters(cls):
        if p.name == "name" and "\n    name: " not in documented:
            continue
        found = re.search(rf"^ \|      {p.name}: (.+(?:\n \|          .+)*)", listed, re.MULTILINE)
        assert found, f"{cls.__name__}.{p.name} is not in its help"
        if p.unit:
            assert f"unit {p.unit}" in " ".join(found[1].replace(" |", " ").split())
        if p.lower is not None:
            assert f"{p.lower:g}" in found[1]
        for choice in p.choices:
            assert choice in found[1]


@pytest.mark.parametrize("cls", KINDS_AND_PARTS.values(), ids=KINDS_AND_PARTS)
def test_methods_of_the_contract_are_neither_in_help_nor_in_completion(cls: type[Any]) -> None:
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
    instance = cls.example()
    assert not methods & set(dir(cls)) and not methods & set(dir(instance))
    assert {p.name for p in parameters(cls)} <= set(dir(instance))
    assert "Data and other attributes" not in shown(cls)
    assert not re.search(r"^ \|  (wants|faults|misfits|advance|__init__|__new__)\(", shown(cls), re.MULTILINE)


def test_help_of_the_base_classes_shows_the_methods_of_the_contract() -> None:
    assert {"input_axes", "advance", "validate_axes"} <= set(dir(Element))
    text = shown(Element)
    assert "advance(self, at: 'Setting'" in text


def test_a_custom_kind_without_a_docstring_has_generated_help() -> None:
    @dataclass(frozen=True)
    class Mine(Part):
        strength: Annotated[float, Live("activation", lower=0, upper=3, meaning="how strong it is")] = 1.0

    assert Mine.__doc__ == "Mine.\n\nParameters:\n    strength: how strong it is. [unit activation; 0 to 3]"
    assert str(inspect.signature(Mine)) == "(strength: float = 1.0)"


def test_the_docstring_of_the_source_is_kept() -> None:
    assert (
        "tau: time constant, in the document's time unit; > 0, and at least one step.\n"
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
