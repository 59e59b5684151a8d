"""The file of a simulation of dnf-composer as plain data: names, labels, parameters and inputs; and forms of
older versions, which today's dnf-composer refuses or drops.
"""

from __future__ import annotations

import dataclasses as dc
import functools
import math
from collections.abc import Mapping
from typing import Any, cast

from deodar import codec
from deodar.errors import DocumentError
from deodar.importers.report import Line
from deodar.parameters import show
from deodar_interop.importers._foreign import Foreign, FreeNames, Source, plain_text, repeated_keys

MOST_ELEMENTS = 4000
"""Largest number of elements; more are refused (a guess: a hundred times the largest published)."""

MOST_INPUTS = 20000
"""Largest number of connections, by the same rule."""

STEP = 1.0
"""Euler step of a file that states none."""

COMMON = ("uniqueName", "label", "inputs")
"""Keys of an element that are not parameters."""


@dc.dataclass(frozen=True)
class StoredSimulation:
    """The content of a file: the name, the step, the elements in order, and the report lines of reading."""

    name: str
    step: float
    elements: tuple[Foreign, ...]
    lines: tuple[Line, ...]

    @functools.cached_property
    def by_label(self) -> Mapping[str, Foreign]:
        """Return the elements by their labels."""
        return {e.label: e for e in self.elements}


def parse(content: bytes) -> StoredSimulation:
    """Parse the content of a file: an object with `elements`, or the bare list of elements of older versions.

    Raises:
        DocumentError: the content is not JSON, is nested too deeply, or does not describe a simulation.
    """
    parsed = codec.foreign(content, leading=True)
    body: dict[str, Any] = (
        {"elements": parsed}
        if isinstance(parsed, list)
        else cast("dict[str, Any]", parsed)
        if isinstance(parsed, dict)
        else {}
    )
    entries = body.get("elements")
    if not isinstance(entries, list):
        fault = f"its elements are {show(entries)}" if "elements" in body else "it has no list of elements"
        raise DocumentError(
            f"holds no simulation of dnf-composer: {fault}",
            fix='It is an object {"identifier": ..., "deltaT": ..., "elements": [...]}, or the list alone',
        )
    listed = cast("list[Any]", entries)
    if len(listed) > MOST_ELEMENTS:
        raise DocumentError(f"holds {len(listed)} elements; at most {MOST_ELEMENTS} are read")
    if listed and not any(
        isinstance(e, dict) and {"uniqueName", "label"} & set(cast(Any, e)) for e in listed
    ):
        raise DocumentError("holds no simulation of dnf-composer: no entry of its list is an element")
    lines = repeated_keys(parsed, _label)
    name, step = _name(body, lines), _step(body, isinstance(parsed, list), lines)
    lines += [
        Line("", "file", plain_text(key) or "a key without a name", "dropped", "dnf-composer has no such key")
        for key in body
        if key not in ("identifier", "deltaT", "elements")
    ]
    return StoredSimulation(name, step, _elements(listed, lines), tuple(lines))


# ------------------------------------------------------------------------------------------ parts of the file


def _label(entry: dict[str, Any]) -> str | None:
    """Return the name of a JSON object that is an element, else None."""
    return plain_text(entry.get("uniqueName")) if "uniqueName" in entry else None


def _name(body: dict[str, Any], lines: list[Line]) -> str:
    """Return the name of the simulation; "" if the file states none."""
    if "identifier" not in body:
        return ""
    name = body["identifier"]
    if not isinstance(name, str):
        lines.append(Line("", "file", "identifier", "approximated", f"it is {show(name)}, not a name"))
        return ""
    lines.append(Line("", "file", "identifier", "carried"))
    return plain_text(name)


def _step(body: dict[str, Any], bare: bool, lines: list[Line]) -> float:
    if "deltaT" not in body:
        why = "the bare list of elements states none" if bare else "it is not in the file"
        lines.append(
            Line("", "file", "deltaT", "approximated", f"{why}; dnf-composer's default {STEP:g} is used")
        )
        return STEP
    step = number(body["deltaT"])
    if step is None or not 0 < step <= 1e12:
        lines.append(
            Line("", "file", "deltaT", "approximated", f"it is {show(body['deltaT'])}; {STEP:g} is used")
        )
        return STEP
    lines.append(Line("", "file", "deltaT", "carried"))
    return step


def number(value: Any) -> float | None:
    """Return a finite number; None for everything else, and for true and false."""
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        return None
    try:
        finite = float(value)
    except OverflowError:
        return None
    return finite if math.isfinite(finite) else None


def _elements(entries: list[Any], lines: list[Line]) -> tuple[Foreign, ...]:
    """Return the elements with different labels; of several elements of one name the first is kept."""
    labels: dict[str, str] = {}
    names, bodies = FreeNames(()), list[tuple[int, str, dict[str, Any]]]()
    for place, entry in enumerate(entries):
        if not isinstance(entry, dict):
            lines.append(
                Line(f"entry {place + 1}", "element", show(entry), "dropped", "it is not an element")
            )
            continue
        body = cast("dict[str, Any]", entry)
        name = body.get("uniqueName")
        if isinstance(name, str) and name in labels:
            why = "a second element of this name; dnf-composer keeps the first"
            lines.append(Line(labels[name], "element", kind(body), "dropped", why))
            continue
        label = names.new(plain_text(name) or f"element {place + 1}")
        if label != name:
            why = f"this is not a name here; the element is called {label!r}"
            lines.append(Line(label, "element", show(name), "approximated", why))
        if isinstance(name, str):
            labels[name] = label
        bodies.append((place, label, body))
    elements = tuple(
        Foreign(
            place,
            label,
            kind(body),
            {plain_text(key): value for key, value in body.items() if key not in COMMON},
            tuple(_sources(label, body, labels, lines)),
        )
        for place, label, body in bodies
    )
    if sum(len(e.sources) for e in elements) > MOST_INPUTS:
        raise DocumentError(f"holds more than {MOST_INPUTS} connections")
    return elements


def kind(body: dict[str, Any]) -> str:
    """Return the text of a label; its number differs between versions and has no meaning."""
    label = body.get("label")
    pair = cast("list[Any]", label) if isinstance(label, list) else [label]
    text = pair[-1] if len(pair) <= 2 and pair else None
    return (plain_text(text) if isinstance(text, str) else "") or "unknown"


def _sources(label: str, body: dict[str, Any], labels: Mapping[str, str], lines: list[Line]) -> list[Source]:
    inputs = body.get("inputs")
    if inputs is None or inputs == {}:
        return []
    if not isinstance(inputs, list):
        lines.append(Line(label, "connection", "inputs", "dropped", f"it is {show(inputs)}, not a list"))
        return []
    out: list[Source] = []
    for entry in cast("list[Any]", inputs):
        pair = cast("list[Any]", entry) if isinstance(entry, list) else []
        if len(pair) != 2 or not all(isinstance(part, str) for part in pair):
            lines.append(Line(label, "connection", show(entry), "dropped", "it is not [name, component]"))
        elif pair[0] not in labels:
            origin = f"{plain_text(pair[0])}.{plain_text(pair[1])}"
            lines.append(Line(label, "connection", origin, "dropped", "there is no such element"))
        else:
            out.append(Source(labels[pair[0]], plain_text(pair[1])))
    return out


RENAMED = {"sigma": "width", "sigmaExc": "widthExc", "sigmaInh": "widthInh"}
"""Parameters until June 2024, and their names today."""

LABELS = {"lateral interactions": "mexican hat kernel"}
"""Labels until July 2024, and the labels of today with the same equation."""


def modern(e: Foreign) -> tuple[Foreign, list[Line]]:
    """Return an element in the form of today, and the report of what was renamed."""
    lines, values = list[Line](), dict[str, Any]()
    for name, value in e.values.items():
        new = RENAMED.get(name, name)
        if new != name and new in e.values:
            lines.append(Line(e.label, "parameter", name, "dropped", f"{new} is in the file too"))
            continue
        if new != name:
            why = f"as {new}, its name since 2024; today's dnf-composer refuses the file"
            lines.append(Line(e.label, "parameter", name, "approximated", why))
        values[new] = value
    return dc.replace(e, kind=LABELS.get(e.kind, e.kind), values=values), lines
