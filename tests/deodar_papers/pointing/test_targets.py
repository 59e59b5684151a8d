"""Every required claim fails on a row that has its fault, and is undecided without rows."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from types import SimpleNamespace
from typing import Any, cast

import pytest

from deodar.architectures.pointing import CUES
from deodar_papers.pointing import targets, trials
from deodar_papers.pointing.cycle import EVENTS, PointingCycle, run_cycle
from deodar_papers.pointing.sensitivity import changes
from deodar_papers.pointing.table import HuePeak, Moment, Table
from deodar_papers.pointing.targets import claims
from deodar_papers.pointing.trials import CASES, VARIANTS

DISC = {"name": "red 1", "colour": "red", "radius": 0.04}
EVENT_TIMES = {name: float(k) for k, name in enumerate(EVENTS)}
CONTROL = {"peaks": 0, "highest": -1.0, "moved": 0.0}
CYCLE: dict[str, Any] = {
    "peaks": 1,
    "highest": 3.0,
    "moved": 0.2,
    "events": EVENT_TIMES,
    "ordered": True,
    "two": 0.0,
    "right": True,
    "object": DISC,
    "radius": 0.04,
    "peak": [0.1, 0.2, 0.0, 0.11],
    "miss": 0.02,
    "miss_after": 0.01,
}
NOTHING = {**CONTROL, "events": {}, "ordered": False, "two": 0.0, "right": False, "peak": None}
EXTRA = {
    "moved": {"way": 0.1},
    "jumped": {"way": 0.12},
    "pushed": {"pushed": True},
    "removed": {"gone": 0.3, "drift": 0.001, "cues on": 2},
}


def rows() -> dict[str, dict[str, Any]]:
    """Return rows of 40 scenes and 50 trials of each case, without any fault."""
    out: dict[str, dict[str, Any]] = {}

    def add(condition: str, trial: int, name: str, row: dict[str, Any]) -> None:
        key = f"{condition}/{trial} {name}".strip()
        out[key] = {"key": key, "condition": condition, "trial": trial, **row}

    for condition in ("scene", "beyond", *VARIANTS):
        for k in range(40):
            for name in ("camera", "red", "green", "left", "right"):
                add(condition, k, name, CONTROL)
            add(condition, k, "red left", {"matches": 1, "hidden": 0, **CYCLE})
            add(condition, k, "red right", {"matches": 2, "hidden": 0, **CYCLE})
            add(condition, k, "green left", {"matches": 0, "hidden": 0, **NOTHING})
            add(condition, k, "green right", {"matches": 0, "hidden": 1, **CYCLE})
    for condition in changes():
        add(condition, 0, "camera", CONTROL)
        add(condition, 0, "red left", {"matches": 1, "hidden": 0, **CYCLE})
    for k in range(40):
        add("photograph", k, "red left", {"match": k % 4 == 0, "inside": k % 4 == 0, "highest": 1.0})
    for case in CASES:
        for k in range(50):
            add(case, k, "", {**CYCLE, **EXTRA.get(case, {})})
    return out


def failing(by_key: dict[str, dict[str, Any]]) -> list[str]:
    return [c.name for c in claims(by_key, False) if c.kind == "required" and c.holds is False]


def test_rows_without_fault_hold_and_no_rows_decide_nothing():
    by_key = [c for c in claims(rows(), False) if c.kind == "required"]
    assert by_key and all(c.holds for c in by_key) and all(c.interval for c in by_key)
    assert all(c.holds is None and c.value is None for c in claims({}, False))


FAULTS = [
    ("scene/{} camera", {"peaks": 1}, 3, "the camera alone"),
    ("scene/{} left", {"peaks": 1}, 3, "one cue alone"),
    ("scene/{} green left", {"peaks": 1, "peak": [0, 0, 0, 0.1]}, 3, "no match"),
    ("scene/{} red left", {"right": False}, 3, "one match"),
    ("scene/{} red left", {"ordered": False}, 3, "one match"),
    ("scene/{} red right", {"peaks": 2}, 3, "several matches"),
    ("scene/{} red left", {"miss": 0.05}, 3, "the tool is inside the rim at satisfaction"),
    ("scene/{} red left", {"miss_after": None}, 3, "the tool is inside the rim 1 s later"),
    ("scene/{} red left", {"events": {}}, 3, "everything is below threshold afterwards"),
    ("equal/{}", {"peaks": 2}, 1, targets.WORDS["equal"]),
    ("same/{}", {"ordered": False}, 3, targets.WORDS["same"]),
    ("moved/{}", {"way": None}, 3, targets.WORDS["moved"]),
    ("jumped/{}", {"miss_after": 0.12}, 3, targets.WORDS["jumped"]),
    ("removed/{}", {"gone": None}, 3, targets.WORDS["removed"]),
    ("removed/{}", {"drift": 0.02}, 3, targets.WORDS["removed"]),
    ("removed/{}", {"cues on": 1}, 3, targets.WORDS["removed"]),
    ("pushed/{}", {"pushed": False}, 3, targets.WORDS["pushed"]),
    ("noisy/{}", {"right": False}, 3, targets.WORDS["noisy"]),
    ("photograph/{} red left", {"inside": None}, 2, "photographs"),
    ("dim/{}", {"right": False}, 3, targets.WORDS["dim"]),
    *[(name + "/{} camera", {"peaks": 1}, 5, name) for name in VARIANTS],
    *[(name + "/{} red left", {"miss": 0.05}, 5, name) for name in VARIANTS],
]


@pytest.mark.parametrize(("key", "fault", "count", "name"), FAULTS)
def test_a_fault_in_a_few_rows_fails_its_claim(key: str, fault: dict[str, Any], count: int, name: str):
    by_key = rows()
    for k in range(count):
        by_key[key.format(k)] |= fault
    assert [c for c in failing(by_key) if c.startswith(name)]


@pytest.mark.parametrize("name", [name for name in EVENTS if name != "movement"])
def test_an_event_that_is_missing_or_out_of_order_is_noticed(name: str):
    assert PointingCycle(events=dict(EVENT_TIMES)).ordered
    assert not PointingCycle(events={k: v for k, v in EVENT_TIMES.items() if k != name}).ordered
    late = "rest" if name != "rest" else "cues"
    swapped = {**EVENT_TIMES, name: EVENT_TIMES[late], late: EVENT_TIMES[name]}
    assert not PointingCycle(events=swapped).ordered
    assert PointingCycle(events={k: v for k, v in EVENT_TIMES.items() if k != "movement"}).ordered


class ToldTable:
    """A table whose steps are listed: each activation and the place of the tool from its step on.

    Attributes:
        changes: values by the number of the step from which on they hold.
        seen: the peaks.
    """

    session, discs = SimpleNamespace(dt=10.0, set=lambda path, factor: None), {}
    world = SimpleNamespace(tool=lambda: (0.0, 0.0, 0.1))

    def __init__(self, changes: dict[int, dict[str, Any]], seen: Sequence[HuePeak] = ()) -> None:
        self.changes, self.seen, self.number = changes, seen, 0
        self.moment = Moment(0.0, -1.0, -1.0, -1.0, (-1.0,) * len(CUES), (0.0, 0.0))

    def step(self) -> Moment:
        self.number += 1
        self.moment = replace(self.moment, **self.changes.get(self.number, {}))
        return self.moment

    def peaks(self) -> Sequence[HuePeak]:
        return self.seen

    def nearest(self, peak: HuePeak) -> None: ...

    def say(self, cues: Any) -> None: ...


def test_an_event_is_when_an_activation_crosses_its_threshold_after_the_event_before():
    low = (-1.0,) * (len(CUES) - 1)
    table = ToldTable(
        {
            1: {"satisfied": 0.5},  # not an event before detection
            2: {"satisfied": -0.5, "nodes": (0.5, *low)},
            3: {"perceptual": 0.5},
            4: {"perceptual": 1.5},
            5: {"tool": (0.001, 0.0)},
            6: {"satisfied": 0.5},
            7: {"perceptual": -0.5},
            8: {"nodes": (-0.5, *low)},
            9: {"satisfied": -0.5},
        }
    )
    done = run_cycle(cast("Table", table), [CUES[0]])
    times = {"cues": 2, "detection": 4, "movement": 5, "satisfaction": 6, "field off": 7, "nodes off": 8}
    assert done.ordered and done.events == {
        name: step / 100 for name, step in {**times, "satisfaction off": 9, "rest": 9}.items()
    }


def test_two_peaks_without_satisfaction_are_counted_until_two_seconds_after_detection():
    seen = [HuePeak(x, 0.3, 0.0, 0.1) for x in (-0.2, 0.2)]
    table = ToldTable({4: {"perceptual": 1.5}}, seen)
    done = trials._held(cast("Table", table), trials.PAIRS[0])
    assert (done.events, done.peaks, done.peak) == ({"detection": 0.03}, 2, seen[0])
    # every fifth step, first when the peaks have settled
    assert done.two == pytest.approx(0.05 * len(range(15, 206, 5))) and table.number == 206


def test_the_table_of_changed_parameters_begins_with_the_largest_effect():
    by_key = rows()
    by_key["cue.tau +20 %/0 red left"] |= {"ordered": False}
    lines = targets.sensitivity_table(by_key).splitlines()
    assert lines[2] == "| `cue.tau` | 1 of 1 | 1 of 1 | 1 of 1 | 0 of 1 |"
    assert len(lines) == 2 + len(changes()) / 2
    assert targets.sensitivity_table({}) == targets.NOT_RUN
