"""Forms of older versions, which today's dnf-composer refuses or drops."""

from __future__ import annotations

import dataclasses as dc
from typing import Any

from deodar.importers.report import Line
from deodar_interop.importers._foreign import Foreign

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
