"""Parameter links: parameters that have the value of another one, as document parameters."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

from deodar.errors import DeodarError
from deodar.importers.cedar.file import CedarGroup, StepPath, members, text
from deodar.importers.cedar.values import number
from deodar.importers.report import Line
from deodar.leaves import get
from deodar.model import edit
from deodar.model.document import Document, Entry

NAMES: Mapping[str, Mapping[str, str]] = {
    "NeuralField": {
        "time scale": "tau",
        "resting level": "resting_level",
        "input noise gain": "noise",
        "sigmoid.beta": "sigmoid.beta",
        "sigmoid.threshold": "sigmoid.threshold",
    },
    "StaticGain": {"gain factor": "factor"},
    "GaussInput": {"amplitude": "amplitude"},
    "BoxInput": {"amplitude": "amplitude"},
    "Boost": {"strength": "amplitude"},
    "ConstMatrix": {"value": "amplitude"},
    "Preshape": {"time scale build up": "tau_build", "time scale decay": "tau_decay"},
    "SpaceToRateCode": {"tau": "tau"},
}
"""Parameters of cedar's steps and of deodar's elements that hold the same number."""

KERNEL = re.compile(r"(?:lateral )?kernels\[(\d+)\]\.(amplitude)\Z")

STRUCTURE = ("dimensionality", "sizes", "number of")


def linked(doc: Document, root: CedarGroup, by: Mapping[StepPath, Entry]) -> tuple[Document, list[Line]]:
    """Return a document in which document parameters drive what is linked, and a line for each link."""
    lines: list[Line] = []
    for group in root.all_groups():
        for entry in group.links:
            doc, line = _link(doc, group, entry, by)
            lines.append(line)
    return doc, lines


def _link(
    doc: Document, group: CedarGroup, entry: Mapping[str, Any], by: Mapping[StepPath, Entry]
) -> tuple[Document, Line]:
    source, target = text(entry.get("source element")), text(entry.get("target element"))
    given, taken = text(entry.get("source parameter")), text(entry.get("target parameter"))
    where = ".".join((*group.path, *([target] if target else [])))
    what = f"{'.'.join(w for w in (source, given) if w)} -> {taken}"
    if any(taken.startswith(word) for word in STRUCTURE):
        return doc, Line(where, "parameter", what, "carried", "a link of sizes; they have the file's values")
    if not text(entry.get("type")).endswith("DirectParameterLink"):
        equation = text(members(entry.get("configuration")).get("equation"))
        why = f"a link by an equation, {equation!r}; the parameter has the file's value"
        return doc, Line(where, "parameter", what, "dropped", why)
    leaf = _leaf(group, target, taken, by)
    if leaf is None:
        return doc, Line(where, "parameter", what, "dropped", "the parameter has no counterpart here")
    try:
        if source:
            first = _leaf(group, source, given, by)
            if first is None:
                return doc, Line(where, "parameter", what, "dropped", "its source has no counterpart here")
            value = number(get(doc.by_id()[first[0]].element, first[1]))
            ends = [first, leaf]
        else:
            value, ends = number(group.values.get(given)), [leaf]
        if value is None:
            return doc, Line(where, "parameter", what, "dropped", "its source holds no number")
        driven = next((doc.links()[end] for end in ends if end in doc.links()), None)
        name = driven or " ".join((*group.path, *([source] if source else []), given))
        new = doc if driven else edit.document_parameter(doc, name, value)
        for end in ends:
            if end not in new.links():
                new = edit.link(new, *end, name)
    except DeodarError as error:
        return doc, Line(where, "parameter", what, "dropped", error.problems[0].what)
    return new, Line(where, "parameter", what, "carried", f"the document parameter {name!r}")


def _leaf(
    group: CedarGroup, name: str, parameter: str, by: Mapping[StepPath, Entry]
) -> tuple[str, str] | None:
    """Return the id of an element and the path of its parameter; None without a counterpart."""
    entry, step = by.get((*group.path, name)), group.steps.get(name)
    if entry is None or step is None:
        return None
    kernel = KERNEL.match(parameter)
    leaf = f"kernel.{kernel[1]}.{kernel[2]}" if kernel else NAMES.get(step.short, {}).get(parameter)
    if leaf is None:
        return None
    try:
        get(entry.element, leaf)
    except DeodarError:  # a kernel that the field does not have
        return None
    return entry.id, leaf
