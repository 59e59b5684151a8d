"""A soft winner-take-all of 30 cells, trials of two inputs, bistable fields, and two blinking targets."""

from __future__ import annotations

import dataclasses as dc
import math

import numpy as np
from numpy.typing import NDArray

import deodar as dd
from deodar.architectures.looking import retina

CELLS = 30
X = dd.Axis("x", 0, CELLS - 1, samples=CELLS)


def winner_take_all(inputs: NDArray[np.float64], inhibition: float = 1.0) -> dd.Model:
    """A pool that selects the stronger of two inputs."""
    model = dd.Model("winner-take-all", dt=0.5)
    pool = model.add(
        dd.SoftWinnerTakeAll(
            "pool",
            [X],
            tau=20,
            tau_inhibition=5,
            self_excitation=0,
            kernel=[dd.Gaussian(1.7, 1.5, normalized=True)],
            inhibition=inhibition,
            drive=0.3,
            threshold=1,
        )
    )
    model.add(dd.Pattern("s", [X], inputs)) >> pool
    return model


@dc.dataclass(frozen=True)
class Pairs:
    """Trials of two inputs: the place of the stronger one, and the input over x."""

    places: NDArray[np.intp]
    inputs: NDArray[np.float32]


def pairs(trials: int, least: float = 0.05, most: float = 0.3, seed: int = 7) -> Pairs:
    """Pairs of inputs at a distance of 8 cells or more, whose strengths differ by a share of the stronger."""
    rng = np.random.default_rng(seed)
    found: list[tuple[int, NDArray[np.float64]]] = []
    while len(found) < trials:
        a, b = rng.integers(3, CELLS - 3, 2)
        if abs(a - b) >= 8:
            weaker = 4 * (1 - rng.uniform(least, most))
            points = np.arange(CELLS)
            s = 4 * np.exp(-((points - a) ** 2) / 8) + weaker * np.exp(-((points - b) ** 2) / 8)
            found.append((int(a), s))
    return Pairs(np.array([p for p, _ in found]), np.array([s for _, s in found], np.float32))


@dc.dataclass(frozen=True)
class Bistable:
    """A field of 31 cells: excitation, global inhibition, steepness of the output."""

    excitation: float
    inhibition: float
    beta: float = 4.0


DETECTOR = Bistable(9.0, 0.2)
"""A peak needs less input than its detection, but some."""

GRADED = Bistable(6.0, 0.2, beta=1.0)
"""A peak whose cells have many different outputs."""

MEMORY = Bistable(16.0, 0.5)
"""A peak stays without input."""


def bistable(kind: Bistable, inputs: NDArray[np.float64] | NDArray[np.float32]) -> dd.Model:
    """A field whose input takes the rows of `inputs` one after another: the first for 200 ms, the second for
    the rest.
    """
    x = dd.Axis("x", 0, 30, samples=31)
    model = dd.Model("bistable", dt=0.5)
    kernel = [dd.Gaussian(kind.excitation, 2, normalized=True)]
    field = dd.Field(
        "u", [x], 20, -5.0, dd.Logistic(kind.beta), kernel=kernel, global_inhibition=kind.inhibition
    )
    u = model.add(field)
    windows = [None] if len(inputs) == 1 else [[(0, 200)], [(200, 1e9)]]
    for name, values, when in zip("ab", inputs, windows, strict=False):
        model.add(dd.Pattern(name, [x], values, windows=when)) >> u
    return model


RADIUS, NEAR = 6.0, 12.0
"""Radius of the targets, and distance of a peak up to which it is that of a target, pixels."""


@dc.dataclass(frozen=True)
class Targets:
    """Trials of two targets that blink in front of the event camera: column and row of the one with more
    contrast and of the other one, trials x 2, and the world.
    """

    places: NDArray[np.float64]
    others: NDArray[np.float64]
    world: dd.Eye


def targets(trials: int, share: float, seed: int = 7) -> Targets:
    """Targets whose columns are 40 pixels apart or more, the first one in turn on the left and on the right.

    Args:
        trials: number of trials.
        share: contrast of the other target, as a share.
        seed: seed of the places.
    """
    rng = np.random.default_rng(seed)
    found: list[NDArray[np.float64]] = []
    while len(found) < trials:
        pair = rng.uniform(24, 103, (2, 2))
        on_the_left = pair[0, 0] < pair[1, 0]
        if abs(pair[0, 0] - pair[1, 0]) >= 40 and on_the_left == (len(found) % 2 == 0):
            found.append(pair)
    places, others = np.moveaxis(np.array(found), 1, 0)
    rival = np.column_stack([others, np.full(trials, share)])
    screen = dd.EyeScreen(radius=RADIUS, endless=False)
    return Targets(places, others, dd.Eye(screen=screen, first=places, rival=rival))


def chosen(outputs: NDArray[np.float32], given: Targets) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Return whether there is a peak at the target and at the other one, for each trial.

    Args:
        outputs: output of the field over columns and rows, trials x cells.
        given: the trials.
    """
    side = math.isqrt(outputs.shape[-1])
    points = retina(side)[0].points
    active = outputs.reshape(-1, side, side) > 0.5
    near = [
        (np.abs(points - p[:, :1])[:, :, None] <= NEAR) & (np.abs(points - p[:, 1:])[:, None, :] <= NEAR)
        for p in (given.places, given.others)
    ]
    one, other = (np.asarray((active & n).any((1, 2))) for n in near)
    return one, other
