"""Run of figures 10 to 12: a robot plans its way through a maze and drives it; an obstacle appears, and the
robot plans again on the way. Other mazes can be run too.
"""

from __future__ import annotations

import dataclasses as dc
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from deodar.analysis.claims import Claim
from deodar.analysis.robot_paths import path_length, path_until
from deodar.architectures.spa import DIRECTIONS, OBSTACLES, STEP_MS, maze, place, spa
from deodar.batch.simulate import simulate
from deodar.errors import WorldError, option
from deodar.resources import Resources
from deodar.worlds.arena.arena import Arena

if TYPE_CHECKING:
    import xarray
    from matplotlib.figure import Figure

SOURCE = "Billing, Lowe & Sandamirskaya (2015), Adapt. Behav. 23(5), section 5.2"

DURATION = 1400
"""Number of steps of 64 ms."""

EVERY = 2
"""Steps between two records, as between two readings of the robot's position."""

LONGEST = 3000
"""Number of steps in a custom maze; more than any published run takes."""

MEMORY = 400e6
"""Largest size of the recorded motivation fields in bytes; in a large maze records are further apart."""

SOON = 50
"""Steps after the plan is complete within which the robot leaves.

A choice of deodar: in the paper it starts to move when the plan is complete.
"""

START = "the start of case 3, which the paper does not print"
"""The start was inferred from the plan, the wave and the route of this run, so they are no evidence."""

PLACES = f"{START}, and its second location, which was read off a run of deodar"

COMES = 336
"""Step at which the obstacle appears, as in figure 11; it stays."""

PLANNED, ARRIVES = 210, 1250
"""Steps at which the plan is complete and the robot at its goal, as the paper reports of this run (figures 10
to 12).
"""

NEAR = 7.0
"""Distance from the goal at which it counts as reached, cm (published simulator)."""

LEFT = 2.5
"""Distance from the start at which the robot counts as moving, cm: within it, it only turns."""

INTENDED = 0.5
NORTH, SOUTH = place(30, 0)[1], place(50, 0)[1]
"""Values of y, in cm, beyond which it is on the northern and on the southern route (published simulator)."""

RECORDED = [
    "pose.output",
    *(f"{name}.strongest.output" for name in DIRECTIONS),
    *(f"{name}.motivation.activation" for name in DIRECTIONS),
]
SITES = (0, 500, 850, 1250)
"""Steps at which the robot is at the positions that the paper calls location 1 to 4."""


@dataclass(frozen=True)
class Narrative:
    """One run and the times of its events, in steps; None: the event did not occur.

    Attributes:
        record: pose, intentions of the four behaviours, and their motivation fields over time.
        arena: the arena, with the obstacle as at the end.
        planned: start of the intention that lasted until the robot moved.
        left: the robot began to move.
        north, south: it was first on either route after it had moved; south after north.
        arrived: it came within NEAR of the goal.
        published: whether it is the run that the paper describes, with the obstacle that appears.
    """

    record: xarray.Dataset
    arena: Arena
    planned: int | None
    left: int | None
    north: int | None
    south: int | None
    arrived: int | None
    published: bool = True

    @property
    def obstacle_at(self) -> int | None:
        """Step at which the obstacle appears; None: no obstacle appears."""
        return COMES if self.published else None

    @property
    def every(self) -> int:
        """Steps between two records."""
        times = self.record["time"].values
        return round(float(times[1] - times[0]))

    @property
    def goal(self) -> np.ndarray:
        """Position of the goal, x and y in cm."""
        assert self.arena.goals is not None
        return self.arena.goals[0] / self.arena.scale

    @property
    def sites(self) -> list[tuple[float, float]]:
        """Locations 1 to 4 that the record contains: x and y in cm."""
        poses = self.record["pose.output"]
        sites = SITES if self.published else ()
        return [
            (float(x), float(y))
            for step in sites
            if step <= poses["time"].values[-1]
            for x, y, _ in [poses.sel(time=step).values]
        ]

    @property
    def path(self) -> np.ndarray:
        """x, y and heading over time, until it arrived."""
        pose = np.asarray(self.record["pose.output"].values, float)
        return pose if self.arrived is None else pose[: self.arrived // self.every + 1]

    def figure(self) -> Figure:
        """Draw the path, the motivation fields at two moments, and activation at the sites over time."""
        from deodar_papers.figures.plan import plan_figure  # start-up time: matplotlib

        return plan_figure(self)


def run(seed: int = 0, duration: int = DURATION, done: Callable[[int], None] = lambda _: None) -> Narrative:
    """Run case 3 of the paper with the obstacle that closes the northern route, at low noise."""
    arena = maze("z")
    center, size = OBSTACLES["full"]
    arena.place("obstacle", center, size, windows=(COMES * STEP_MS, 1e9))
    return read(
        simulate(
            spa(arena),
            duration,
            seed=seed,
            record=RECORDED,
            every=EVERY,
            world=arena,
            on=Resources(progress=done),
        ),
        arena,
    )


def drive(
    arena: Arena,
    noise: str = "low",
    seed: int = 0,
    duration: int = LONGEST,
    done: Callable[[int], None] = lambda _: None,
) -> Narrative:
    """Run any maze made by `dd.architectures.maze`, without obstacles that appear."""
    if arena.goals is None:
        raise WorldError(
            "the maze has no goal",
            where=arena.source,
            fix=option("Give one, in cm:", "goal", "X Y", "(X, Y)"),
        )
    model = spa(arena, noise)
    cells = math.prod(axis.samples for axis in model["north.motivation"].element.axes)  # type: ignore[attr-defined]
    every = EVERY * max(1, math.ceil(duration / EVERY * cells * 4 * len(DIRECTIONS) / MEMORY))
    found = read(
        simulate(
            model, duration, seed=seed, record=RECORDED, every=every, world=arena, on=Resources(progress=done)
        ),
        arena,
    )
    return dc.replace(found, published=False)


def read(record: xarray.Dataset, arena: Arena) -> Narrative:
    """Find the events of a record."""
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
    planned, left, north, south, arrived = (
        None if k is None else round(float(times[k])) for k in (planned, left, north, south, arrived)
    )
    return Narrative(record, arena, planned, left, north, south, arrived)


def _first(holds: np.ndarray) -> int | None:
    return int(np.argmax(holds)) if holds.any() else None


def claims(result: Narrative) -> list[Claim]:
    """Return the claims on the run, computed from it; those on a custom maze are not required."""
    r = result
    if not r.published:
        return _reported(r)
    switched = (
        r.north is not None
        and r.south is not None
        and r.arrived is not None
        and r.north < r.south < r.arrived
    )
    gone = path_until(r.path, r.goal, NEAR)
    at = None
    if len(r.sites) > 1:
        x, y = r.sites[1]
        wave = _first(r.record["west.motivation.activation"].sel(x=x, y=y, method="nearest").values > 0)
        at = None if wave is None else wave * r.every
    waits = None if r.left is None or r.planned is None else r.left - r.planned
    route = {"north": r.north, "south": r.south}
    turned = switched and r.south is not None and r.south > COMES
    ours: dict[str, Any] = {"source": SOURCE, "origin": "ours", "assumes": START}
    printed: dict[str, Any] = {"kind": "reported", "source": SOURCE, "origin": "printed", "assumes": START}
    placed: dict[str, Any] = {**printed, "assumes": PLACES}
    text = "the plan is complete: from this step on there is an intention until the robot moves"
    wave = "the wave reaches location 2, in the motivation to go west, at step"
    path = None if gone is None else round(path_length(gone), 1)
    return [
        Claim(
            "it leaves when the plan is complete: steps from one to the other",
            waits,
            f"0 to {SOON}",
            waits is not None and waits <= SOON,
            **ours,
        ),
        Claim(
            "it takes the north route, and the south route after the obstacle came",
            route,
            f"north first, south after {COMES}",
            turned,
            **ours,
        ),
        Claim(
            f"it arrives within {NEAR:g} cm of the goal, at step",
            r.arrived,
            f"< {DURATION}",
            r.arrived is not None,
            **ours,
        ),
        Claim(
            text, r.planned, f"{PLANNED} +- 10 %", _within(r.planned, PLANNED, 0.1), **printed, inferred=True
        ),
        Claim(wave, at, "150 +- 10 %", _within(at, 150, 0.1), **placed, inferred=True),
        Claim(
            "it arrives around step 1250",
            r.arrived,
            f"{ARRIVES} +- 10 %",
            _within(r.arrived, ARRIVES, 0.1),
            **printed,
        ),
        Claim("length of its path, cm", path, "none", None, "reported", origin="none"),
    ]


def _reported(r: Narrative) -> list[Claim]:
    gone = path_until(r.path, r.goal, NEAR)
    path = None if gone is None else round(path_length(gone), 1)
    arrives = f"it arrives within {NEAR:g} cm of the goal, at step"
    return [
        Claim("the plan is complete at step", r.planned, "none", None, "reported", origin="none"),
        Claim("it leaves at step", r.left, "none", None, "reported", origin="none"),
        Claim(arrives, r.arrived, f"< {LONGEST}", r.arrived is not None, "reported", origin="ours"),
        Claim("length of its path, cm", path, "none", None, "reported", origin="none"),
    ]


def _within(value: int | None, target: float, share: float) -> bool:
    return value is not None and abs(value - target) <= share * target


def sentence(result: Narrative) -> str:
    """Return the outcome in one line of plain words."""
    said: Sequence[tuple[str, int | None]] = (
        ("planned", result.planned),
        ("left", result.left),
        *(
            (("on the north route", result.north), ("on the south route", result.south))
            if result.published
            else ()
        ),
        ("at the goal", result.arrived),
    )
    return (
        "; ".join(f"{what} at step {k}" if k is not None else f"never {what}" for what, k in said)
        + f" (one step is {STEP_MS:g} ms)."
    )
