"""The file of a cosivina simulator as plain data: labels, classes, parameters and inputs."""

from __future__ import annotations

import dataclasses as dc
import functools
import math
from collections.abc import Mapping
from typing import Any, cast

import numpy as np

from deodar import codec
from deodar.errors import DocumentError
from deodar.importers.report import Line
from deodar.parameters import show
from deodar_interop.importers._foreign import Foreign, Source, plain_text, repeated_keys

MOST_ELEMENTS = 4000
"""Largest number of elements; more are refused (a guess: ten times the largest published)."""

MOST_INPUTS = 20000
"""Largest number of connections, by the same rule."""

WORDS = {
    "_Inf_": math.inf,
    "-_Inf_": -math.inf,
    "_NaN_": math.nan,
    "Inf": math.inf,
    "-Inf": -math.inf,
    "NaN": math.nan,
}


@dc.dataclass(frozen=True)
class Simulator:
    """The content of a file: the step, the time at the start, the elements in order, and the report lines of
    reading.
    """

    step: float
    start: float
    elements: tuple[Foreign, ...]
    lines: tuple[Line, ...]

    @functools.cached_property
    def by_label(self) -> Mapping[str, Foreign]:
        """Return the elements by their labels."""
        return {e.label: e for e in self.elements}


def parse(content: bytes) -> Simulator:
    """Parse the content of a file of a simulator.

    Raises:
        DocumentError: the content is not JSON, is nested too deeply, or does not describe a simulator.
    """
    parsed = codec.foreign(content)
    root = cast("dict[str, Any]", parsed) if isinstance(parsed, dict) else {}
    inside = root.get("simulator", root)
    if not isinstance(inside, dict) or not {"elements", "elementLabels", "nElements"} & set(
        cast(Any, inside)
    ):
        raise DocumentError(
            "holds no simulator of cosivina",
            fix='It is an object {"simulator": {"deltaT": ..., "elements": [...]}}',
        )
    body = cast("dict[str, Any]", inside)
    lines = repeated_keys(parsed, _label)
    step, start = _time(body, "deltaT", 1.0, lines), _time(body, "tZero", 0.0, lines)
    entries = _entries(body.get("elements"))
    count = _counted(body)
    if not entries and not (count == 0 and empty(body.get("elements"))):
        fault = (
            f"its elements are {show(body['elements'])}"
            if "elements" in body
            else "it has no list of elements"
        )
        stated_count = f", and nElements is {show(body['nElements'])}" if "nElements" in body else ""
        raise DocumentError(
            f"holds no elements: {fault}{stated_count}", fix="Save the simulator again with saveSettings"
        )
    lines += _census(body, entries, count)
    if len(entries) > MOST_ELEMENTS:
        raise DocumentError(f"holds {len(entries)} elements; at most {MOST_ELEMENTS} are read")
    elements = tuple(
        e for place, entry in enumerate(entries) if (e := _element(place, entry, lines)) is not None
    )
    if sum(len(e.sources) for e in elements) > MOST_INPUTS:
        raise DocumentError(f"holds more than {MOST_INPUTS} connections")
    return Simulator(step, start, _unique(elements, lines), tuple(lines))


def array(value: Any) -> np.ndarray | None:
    """Return the numbers of a value in any notation; None without numbers, and for ragged lists."""
    try:
        numbers = np.array(_plain(value), dtype=np.float64)
    except (TypeError, ValueError, OverflowError):
        return None
    return numbers if numbers.ndim <= 4 else None


def empty(value: Any) -> bool:
    """Return whether a value is one of the notations of an empty value."""
    if value is None or value == [] or value == {} or value == "":
        return True
    numbers = array(value) if isinstance(value, (dict, list)) else None
    return numbers is not None and numbers.size == 0


# ------------------------------------------------------------------------------------------ parts of the file


def _label(entry: dict[str, Any]) -> str | None:
    """Return the label of a JSON object that is an element, else None."""
    return plain_text(entry.get("label")) if "class" in entry else None


def _time(body: dict[str, Any], key: str, default: float, lines: list[Line]) -> float:
    if key not in body:
        return default
    numbers = array(body[key])
    time = float(numbers.reshape(-1)[0]) if numbers is not None and numbers.size == 1 else math.nan
    if not math.isfinite(time) or abs(time) > 1e12 or (key == "deltaT" and not time > 0):
        lines.append(Line("", "file", key, "approximated", f"it is {show(body[key])}; {default:g} is used"))
        return default
    lines.append(Line("", "file", key, "carried"))
    return time


def _counted(body: dict[str, Any]) -> int | None:
    """Return the number of elements that nElements states; None if it states none."""
    numbers = array(body.get("nElements"))
    return (
        int(numbers.reshape(-1)[0])
        if numbers is not None and numbers.size == 1 and 0 <= numbers.reshape(-1)[0] < 1e9
        else None
    )


def _census(body: dict[str, Any], entries: list[Any], count: int | None) -> list[Line]:
    """Report where the list of elements, possibly incomplete, disagrees with nElements and elementLabels."""
    lines: list[Line] = []
    if "nElements" in body and count != len(entries):
        why = f"it is {show(body['nElements'])}, and the list of elements holds {len(entries)}"
        lines.append(Line("", "file", "nElements", "approximated", why))
    listed = body.get("elementLabels")
    labels = (
        [listed] if isinstance(listed, str) else cast("list[Any]", listed) if isinstance(listed, list) else []
    )
    present = {plain_text(cast("dict[str, Any]", e).get("label")) for e in entries if isinstance(e, dict)}
    for label in dict.fromkeys(plain_text(v) for v in labels):
        if label and label not in present:
            lines.append(
                Line(
                    label,
                    "element",
                    "unknown",
                    "dropped",
                    "elementLabels names it, the list of elements does not hold it",
                )
            )
    return lines


def _entries(value: Any) -> list[Any]:
    """Return the elements as one list, from a single object or nested lists."""
    if isinstance(value, dict) and "class" in value:
        return [cast(Any, value)]
    if not isinstance(value, list):
        return []
    out: list[Any] = []
    for entry in cast("list[Any]", value):
        out += _entries(cast(Any, entry)) if isinstance(entry, list) else [entry]
    return out


def _element(place: int, entry: Any, lines: list[Line]) -> Foreign | None:
    if not isinstance(entry, dict):
        lines.append(Line(f"entry {place + 1}", "element", show(entry), "dropped", "it is not an element"))
        return None
    body = cast("dict[str, Any]", entry)
    label, kind = (
        plain_text(body.get("label")) or f"element {place + 1}",
        plain_text(body.get("class")) or "unknown",
    )
    if plain_text(body.get("label")) != body.get("label"):
        lines.append(
            Line(
                label,
                "element",
                show(body.get("label")),
                "approximated",
                f"this is not a label; the element is called {label!r}",
            )
        )
    param = body.get("param")
    param = param[0] if isinstance(param, list) and len(cast(Any, param)) == 1 else param
    values = (
        {plain_text(k): v for k, v in cast("dict[str, Any]", param).items()}
        if isinstance(param, dict) and not empty(param)
        else {}
    )
    if not isinstance(param, dict) and not empty(param):
        lines.append(
            Line(label, "parameter", "param", "dropped", f"it is {show(param)}, not a set of parameters")
        )
    return Foreign(place, label, kind, values, tuple(_sources(label, body.get("input"), lines)))


def _sources(label: str, value: Any, lines: list[Line]) -> list[Source]:
    """Return the inputs from any of their notations."""
    if empty(value):
        return []
    if isinstance(value, list):
        return [s for entry in cast("list[Any]", value) for s in _sources(label, entry, lines)]
    if isinstance(value, str):
        return [Source(plain_text(value))]
    if isinstance(value, dict):
        body = cast("dict[str, Any]", value)
        source, component = body.get("label"), body.get("component")
        if isinstance(source, list):  # a list of structures may be stored as a structure of lists
            several = cast("list[Any]", source)
            parts = (
                cast("list[Any]", component) if isinstance(component, list) else [component] * len(several)
            )
            return [
                Source(plain_text(s), plain_text(c))
                for s, c in zip(several, parts, strict=False)
                if not empty(s)
            ]
        if empty(source):
            return []
        if plain_text(source):
            return [Source(plain_text(source), plain_text(component))]
    lines.append(Line(label, "connection", show(value), "dropped", "it names no source"))
    return []


def _unique(elements: tuple[Foreign, ...], lines: list[Line]) -> tuple[Foreign, ...]:
    """Make every label unique: a label that cosivina would refuse gets a number."""
    taken, out = {e.label for e in elements}, list[Foreign]()
    seen: set[str] = set()
    numbers: dict[str, int] = {}
    for e in elements:
        if e.label in seen:
            label = e.label
            while label in taken:
                numbers[e.label] = numbers.get(e.label, 1) + 1
                label = f"{e.label} ({numbers[e.label]})"
            taken.add(label)
            lines.append(
                Line(
                    label,
                    "element",
                    e.kind,
                    "approximated",
                    f"a second element labelled {e.label!r}; connections lead to the first",
                )
            )
            e = dc.replace(e, label=label)
        seen.add(e.label)
        out.append(e)
    return tuple(out)


# ----------------------------------------------------------------------------------------------------- values


def _plain(value: Any) -> Any:
    """Decode the text and objects by which JSONLab writes what JSON cannot express."""
    if isinstance(value, bool):
        return float(value)
    if isinstance(value, str):
        if value not in WORDS:
            raise ValueError(value)
        return WORDS[value]
    if value is None:
        return []
    if isinstance(value, list):
        items = [_plain(v) for v in cast("list[Any]", value)]
        return items[0] if len(items) == 1 and not isinstance(items[0], list) else items
    if isinstance(value, dict):
        body = cast("dict[str, Any]", value)
        if "_ArrayData_" not in body or body.get("_ArrayIsComplex_") or body.get("_ArrayIsSparse_"):
            raise ValueError("no array")
        numbers = np.array(_plain(body["_ArrayData_"]), dtype=np.float64)
        size = [
            int(n)
            for n in np.atleast_1d(
                np.array(_plain(body.get("_ArraySize_", list(numbers.shape))), dtype=np.float64)
            )
        ]
        if math.prod(size) != numbers.size or any(n < 0 for n in size):
            raise ValueError("an array of another size than it says")
        return numbers.reshape(
            size, order="C" if numbers.ndim == len(size) and numbers.ndim > 1 else "F"
        ).tolist()
    return float(value)
