"""The order in which cedar computes the steps of a file.

Looped steps (those with a state) are called by triggers, in the order of their listeners. Each one computes,
then runs the steps that follow from it, up to the next looped steps; a step runs at most once in an
iteration. So a step that two fields feed runs after the first of them, and reads the previous value of the
other one. Steps that no looped step feeds are computed when the file is loaded.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence

from deodar.importers.report import Line
from deodar_interop.importers.cedar.file import CedarGroup, StepPath

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
