"""The step of a file, from the root group or, in older files, from its triggers."""

from __future__ import annotations

from deodar.importers.report import Line
from deodar_interop.importers.cedar.file import CedarGroup
from deodar_interop.importers.cedar.values import milliseconds

DEFAULT = 20.0
"""cedar's step in simulated time, ms."""

ROOT = ("simulation euler step", "time factor", "loop mode", "default CPU step", "min computation time")


def clock(root: CedarGroup) -> tuple[float, list[Line]]:
    """Return the step in ms, and report lines.

    cedar moves all triggers by one step in simulated time: `simulation euler step` of the root, in older
    files the smallest `fake Euler step size` of the triggers, else 20 ms. In real time a step is as long as
    the last one took.
    """
    lines: list[Line] = []
    step: float | None = None
    if "simulation euler step" in root.values:
        step = milliseconds(root.values["simulation euler step"])
        good = step is not None and 0 < step < 1e9
        why = "the step dt" if good else f"is no time; {DEFAULT:g} ms is used"
        lines.append(Line("", "file", "simulation euler step", "carried" if good else "approximated", why))
        step = step if good else DEFAULT
    for trigger in root.triggers:
        for key in trigger.values:
            if key in ("name", "listeners"):
                continue
            if key == "fake Euler step size" and step is None:
                continue
            why = "cedar's threads have no counterpart: all elements take the step of the document"
            lines.append(Line(trigger.name, "parameter", key, "carried", why))
    if step is None:
        fakes = [milliseconds(t.values.get("fake Euler step size")) for t in root.triggers]
        good_ones = [s for s in fakes if s is not None and 0 < s < 1e9]
        step = min(good_ones, default=DEFAULT)
        why = "the smallest step of its triggers" if good_ones else "cedar's default in simulated time"
        lines.append(
            Line("", "file", "step", "carried" if good_ones else "approximated", f"{step:g} ms, {why}")
        )
    for key in ROOT[1:]:
        if key in root.values:
            lines.append(Line("", "file", key, "carried", "of cedar's clock only: deodar runs at any speed"))
    return step, lines
