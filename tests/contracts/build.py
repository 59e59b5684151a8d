"""The registered kinds, and models of the contract tests around the example of each."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Sequence
from typing import Any

import deodar as dd
from deodar import registry
from deodar.element import Element
from deodar.kind_rules.example_model import AnyWorld, around, holding, node, source
from deodar.kind_rules.example_model import another_values as changes
from deodar.parameters import parameters

KINDS = {**registry.kinds("elements"), **registry.kinds("couplings")}
PARTS = {**registry.kinds("numerics.kernels"), **registry.kinds("numerics.sigmoids")}


def example(kind: str) -> Element:
    """Return the example of a kind, under the name `example`."""
    return dc.replace(KINDS[kind].example(), name="example")


def any_example(kind: str) -> Element:
    """Return the example of any registered kind, in an element that a model can contain."""
    return example(kind) if kind in KINDS else holding(PARTS[kind].example())


def session(model: dd.Model, **options: Any) -> dd.Session:
    """Return a session in a world that has every sensor and motor."""
    return dd.Session(model, world=AnyWorld(), **options)


def record(model: dd.Model, duration: float, ports: Sequence[str], **options: Any) -> Any:
    """Return a record made in a world that has every sensor and motor."""
    return dd.simulate(model, duration, record=ports, world=AnyWorld(), **options)


__all__ = [
    "KINDS",
    "PARTS",
    "AnyWorld",
    "any_example",
    "around",
    "changes",
    "example",
    "node",
    "parameters",
    "record",
    "session",
    "source",
]
