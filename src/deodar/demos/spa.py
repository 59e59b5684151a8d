"""`deodar demo spa`: a robot plans its way through a maze and drives it; an obstacle comes, and it plans anew on the way."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from deodar.analysis.claims import Claim
from deodar.analysis.paths import length, until
from deodar.architectures.spa import DIRECTIONS, OBSTACLES, STEP_MS, maze, place, spa
from deodar.runtime.simulate import simulate
from deodar.worlds.arena import Arena

if TYPE_CHECKING:
    import xarray

HELP = "a robot plans its way through a maze and drives it; an obstacle comes, and it plans anew"
SOURCE = "Billing, Lowe & Sandamirskaya (2015), Adapt. Behav. 23(5), section 5.2"

DURATION = 1400
"""Steps of 64 ms that are run."""

EVERY = 2
"""Steps between two records: the robot hears of its place as often."""

COMES = 336
"""Step at which the obstacle comes, as in figure 11; it stays."""

PLANNED, ARRIVES = 210, 1250
"""Steps at which the plan is complete and the robot at its goal, as the paper tells of this run (figures 10 to 12)."""

NEAR = 7.0
"""Distance from the goal at which it counts as reached, cm (published simulator)."""

LEFT = 2.5
"""Distance from the start at which the robot counts as moving, cm: within it, it only turns."""

INTENDED = 0.5
NORTH, SOUTH = place(30, 0)[1], place(50, 0)[1]
"""Beyond which y, cm, it is on the northern and on the southern route (published simulator)."""

SITES = (0, 500, 850, 1250)
"""Steps at which the robot stands at the places that the paper calls location 1 to 4."""


@dataclass(frozen=True)
class Result:
    """One run, and what happened when, in steps; None: it did not.

    Attributes:
        record: pose, what the four behaviours intend, and their motivation fields over time.
        arena: where it was, with the obstacle as it stood at the end.
        planned: from when on there was an intention until the robot moved.
        left: it moved.
        north, south: it was first on either route after it had moved; south after north.
        arrived: it came within NEAR of the goal.
    """

    record: xarray.Dataset
    arena: Arena
    planned: int | None
    left: int | None
    north: int | None
    south: int | None
    arrived: int | None

    @property
    def goal(self) -> np.ndarray:
        """Where the goal is, x and y in cm."""
        assert self.arena.goals is not None
        return self.arena.goals[0] / self.arena.scale

    @property
    def sites(self) -> list[tuple[float, float]]:
        """Locations 1 to 4, as far as the record goes: x and y in cm."""
        poses = self.record["pose.output"]
        return [(float(x), float(y)) for step in SITES if step <= poses["time"].values[-1] for x, y, _ in [poses.sel(time=step).values]]

    @property
    def path(self) -> np.ndarray:
        """x, y and heading over time, until it arrived."""
        pose = np.asarray(self.record["pose.output"].values, float)
        return pose if self.arrived is None else pose[: self.arrived // EVERY + 1]


def go(seed: int = 0, duration: int = DURATION, done: Callable[[int], None] = lambda _: None) -> Result:
    """Case 3 of the paper with the obstacle that closes the northern route, at low noise."""
    arena = maze("z")
    center, size = OBSTACLES["full"]
    arena.place("obstacle", center, size, windows=(COMES * STEP_MS, 1e9))
    paths = ["pose.output", *(f"{name}.strongest.output" for name in DIRECTIONS), *(f"{name}.motivation.activation" for name in DIRECTIONS)]
    record = simulate(spa(arena), duration, seed=seed, record=paths, every=EVERY, world=arena, progress=done)
    return read(record, arena)


def read(record: xarray.Dataset, arena: Arena) -> Result:
    """What happened in a record, and when."""
    pose, times = record["pose.output"].values, record["time"].values
    assert arena.goals is not None
    moved = np.linalg.norm(pose[:, :2] - pose[0, :2], axis=1) > LEFT
    intends = np.max([record[f"{name}.strongest.output"].values for name in DIRECTIONS], axis=0) > INTENDED
    left = _first(moved)
    planned = None
    if left is not None and intends[left - 1]:
        pauses = np.flatnonzero(~intends[:left])
        planned = int(pauses[-1]) + 1 if len(pauses) else 0
    after = np.arange(len(pose)) >= (len(pose) if left is None else left)
    north = _first(after & (pose[:, 1] > NORTH))
    south = _first(after & (pose[:, 1] < SOUTH) & (np.arange(len(pose)) > (0 if north is None else north)))
    arrived = _first(np.linalg.norm(pose[:, :2] - arena.goals[0] / arena.scale, axis=1) <= NEAR)
    steps = (None if k is None else round(float(times[k])) for k in (planned, left, north, south, arrived))
    return Result(record, arena, *steps)


def _first(holds: np.ndarray) -> int | None:
    return int(np.argmax(holds)) if holds.any() else None


def claims(result: Result) -> list[Claim]:
    """What is claimed of the run, computed from it."""
    r = result
    switched = r.north is not None and r.south is not None and r.arrived is not None and r.north < r.south < r.arrived
    gone = until(r.path, r.goal, NEAR)
    at = None
    if len(r.sites) > 1:
        x, y = r.sites[1]
        wave = _first(r.record["west.motivation.activation"].sel(x=x, y=y, method="nearest").values > 0)
        at = None if wave is None else wave * EVERY
    return [
        Claim(
            "the plan is complete: from this step on there is an intention until the robot moves",
            r.planned,
            f"{PLANNED} +- 10 %",
            _within(r.planned, PLANNED, 0.1),
            source=SOURCE,
        ),
        Claim("it leaves after the plan is complete, at step", r.left, "later", _later(r.left, r.planned), source=SOURCE),
        Claim(
            "it takes the north route, and the south route after the obstacle came",
            {"north": r.north, "south": r.south},
            f"north before south, south after {COMES}",
            switched and r.south is not None and r.south > COMES,
            source=SOURCE,
        ),
        Claim(f"it arrives within {NEAR:g} cm of the goal, at step", r.arrived, f"< {DURATION}", r.arrived is not None, source=SOURCE),
        Claim("length of its path, cm", None if gone is None else round(length(gone), 1), "not printed", None, "reported"),
        Claim("the wave reaches location 2, in the motivation to go west, at step", at, "around 150", _within(at, 150, 0.1), "reported", SOURCE),
        Claim("it arrives around step 1250", r.arrived, f"{ARRIVES} +- 10 %", _within(r.arrived, ARRIVES, 0.1), "reported", SOURCE),
    ]


def _within(value: int | None, target: float, share: float) -> bool:
    return value is not None and abs(value - target) <= share * target


def _later(value: int | None, than: int | None) -> bool:
    return value is not None and than is not None and value >= than


def sentence(result: Result) -> str:
    """The outcome in one line of plain words."""
    said: Sequence[tuple[str, int | None]] = (
        ("planned", result.planned),
        ("left", result.left),
        ("on the north route", result.north),
        ("on the south route", result.south),
        ("at the goal", result.arrived),
    )
    return "; ".join(f"{what} at step {k}" if k is not None else f"never {what}" for what, k in said) + f" (one step is {STEP_MS:g} ms)."
