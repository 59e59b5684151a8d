"""The step of a file, and the order in which cedar computes its steps.

Looped steps (those with a state) are called by triggers, in the order of their listeners. Each one computes,
then runs the steps that follow from it, up to the next looped steps; a step runs at most once in an
iteration. So a step that two fields feed runs after the first of them, and reads the previous value of the
other one. Steps that no looped step feeds are computed when the file is loaded.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence

from deodar.importers.report import Line
from deodar_interop.importers.cedar.file import CedarGroup, StepPath
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


FIRST = ("default thread", "default trigger")
"""Names of the trigger that all looped steps belong to at first."""


def sequence(
    root: CedarGroup,
    looped: Collection[StepPath],
    feeds: Mapping[StepPath, Iterable[StepPath]],
) -> tuple[dict[StepPath, int], list[Line]]:
    """Return the place of each step that runs in an iteration, and report lines about the triggers.

    Args:
        root: the root group.
        looped: the looped steps.
        feeds: the steps that read a step.
    """
    lines: list[Line] = []
    steps = {step.path: step for step in root.all_steps()}
    walk = _Iteration({path: path in looped for path in steps}, feeds)
    for name in _listeners(root, looped, lines):
        if name in root.steps:
            walk.run((name,))
        else:
            walk.group(root.groups[name])
    return walk.place, lines


def _listeners(root: CedarGroup, looped: Collection[StepPath], lines: list[Line]) -> list[str]:
    """Return the looped elements of the root in the order in which triggers call them."""
    members = [name for name, step in root.steps.items() if step.path in looped]
    members += [
        name for name, group in root.groups.items() if any(s.path in looped for s in group.all_steps())
    ]
    first = list(members)
    others: list[list[str]] = []
    for trigger in root.triggers:
        called = first if trigger.name in FIRST else list[str]()
        for name in trigger.listeners:
            if name not in members:
                exists = name in root.steps or name in root.groups
                why = "it has no state of its own" if exists else "there is no such element"
                lines.append(Line(trigger.name, "connection", name, "carried" if exists else "dropped", why))
                continue
            for listed in (first, *others):
                if name in listed:
                    listed.remove(name)
            called.append(name)
        if called is not first:
            others.append(called)
    return [*first, *(name for listed in others for name in listed)]


class _Iteration:
    def __init__(self, looped: Mapping[StepPath, bool], feeds: Mapping[StepPath, Iterable[StepPath]]) -> None:
        self.looped = looped
        self.feeds = feeds
        self.place: dict[StepPath, int] = {}

    def group(self, group: CedarGroup) -> None:
        """Run the looped elements of a group: its steps, then the groups inside it."""
        for step in group.steps.values():
            if self.looped[step.path]:
                self.run(step.path)
        for inside in group.groups.values():
            self.group(inside)

    def run(self, path: StepPath) -> None:
        """Run a looped step and the steps that follow from it."""
        self.place[path] = len(self.place)
        for follower in self.following(path):
            if follower not in self.place:
                self.place[follower] = len(self.place)

    def following(self, path: StepPath) -> Sequence[StepPath]:
        """Return the steps that follow, those with the longest way last."""
        reverse: list[StepPath] = []
        seen: set[StepPath] = set()
        stack: list[tuple[StepPath, bool]] = [(path, False)]
        while stack:  # depth first, so that the reverse of leaving is an order by the longest way
            step, leaving = stack.pop()
            if leaving:
                reverse.append(step)
                continue
            if step in seen:
                continue
            seen.add(step)
            stack.append((step, True))
            stack += [(t, False) for t in self.feeds.get(step, ()) if not self.looped.get(t, True)]
        return [follower for follower in reversed(reverse) if follower != path]
