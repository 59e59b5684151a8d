"""The parameters of a model that are tuned most, as its first sliders.

What a parameter is for follows from declarations: levels on the scale of the activation, kernels, the signs
of sources, the section of a form.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from typing import Any, cast

from deodar.element import Element
from deodar.errors import ModelError
from deodar.model import edit
from deodar.model.document import Document, Leaf
from deodar.model.sketch import form_of, is_coupling
from deodar.model.strength import strength_path
from deodar.numerics.kernels._base import Kernel
from deodar.parameters import Parameter, parameters

PINS = "pins"
"""Key of the layout for pinned parameters: `[{"element": id, "parameter": path}]`; an empty `element` means
a document parameter.
"""

MOST = 5


def with_usual_pins(doc: Document) -> Document:
    """Return a document with sliders for up to five of its parameters, behind those that it has.

    Resting levels, amplitudes of kernels and of stimuli, and global inhibition take turns, each in the order
    of the elements; strengths of couplings follow. A document parameter takes the place of what it drives.

    Raises:
        ModelError: the document has none of these parameters.
    """
    drivers = doc.links()
    by_role = [[(e.id, p) for e in doc.entries for p in role(e.element)] for role in ROLES]
    turns = itertools.chain.from_iterable(itertools.zip_longest(*by_role))
    strengths = ((e.id, strength_path(e.element)) for e in doc.entries)
    leaves = [leaf for leaf in (*turns, *strengths) if leaf is not None and leaf[1]]
    if not leaves:
        raise ModelError(
            "the model has no resting level, amplitude or inhibition",
            fix="Pin a parameter in the menu of its row in the inspector",
        )
    pins = [_pin(leaf, drivers) for leaf in leaves]
    usual = [pin for k, pin in enumerate(pins) if pin not in pins[:k]][:MOST]
    stored = doc.layout.get(PINS)
    first = cast("list[Any]", stored) if isinstance(stored, list) else []
    pinned = [
        {key: pin.get(key) for key in ("element", "parameter")} for pin in first if isinstance(pin, dict)
    ]
    return edit.arrange(doc, {**doc.layout, PINS: [*first, *(pin for pin in usual if pin not in pinned)]})


def _pin(leaf: Leaf, drivers: dict[Leaf, str]) -> dict[str, str]:
    element, parameter = ("", drivers[leaf]) if leaf in drivers else leaf
    return {"element": element, "parameter": parameter}


def _numbers(kind: type[Any]) -> list[Parameter]:
    """Return the parameters of a kind that are one number on the scale of the activation."""
    return [p for p in parameters(kind) if p.form == "number" and p.unit == "activation"]


def _resting_levels(element: Element) -> Iterator[str]:
    yield from (levels["resting level"] for levels in element.levels.values() if "resting level" in levels)


def _amplitudes_of_kernels(element: Element) -> Iterator[str]:
    for p in () if is_coupling(element) else parameters(type(element)):
        for k, kernel in enumerate(getattr(element, p.name) or () if p.form == "parts" else ()):
            if isinstance(kernel, Kernel):
                yield from (f"{p.name}.{k}.{number.name}" for number in _numbers(type(kernel))[:1])


def _amplitudes_of_stimuli(element: Element) -> Iterator[str]:
    if form_of(element) == "source":
        yield from (p.name for p in _numbers(type(element)) if p.name in element.signed_by)


def _inhibitions(element: Element) -> Iterator[str]:
    yield from (p.name for p in _numbers(type(element)) if p.section == "interaction")


ROLES = (_resting_levels, _amplitudes_of_kernels, _amplitudes_of_stimuli, _inhibitions)
