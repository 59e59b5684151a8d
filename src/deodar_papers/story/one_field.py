"""The first act: a field whose input grows, that selects one of two inputs, remembers it, and forgets it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from deodar.batch.simulate import simulate
from deodar.elements.changing_stimuli import TimeSeries
from deodar.elements.field import Field
from deodar.elements.stimuli import GaussianStimulus
from deodar.model.model import Model
from deodar.numerics.axes import Axis
from deodar.numerics.kernels.separable import Gaussian
from deodar.resources import Resources

AXIS = Axis("x", 0, 100, samples=101, unit="deg")
RESTING_LEVEL = -5.0
WIDTH = 5.0
"""Standard deviation of an input."""

MIDDLE, LEFT, RIGHT = 50.0, 28.0, 72.0
"""Centres of the single input and of the two that compete."""

STRENGTH = 5.0
"""Amplitude of the two inputs that compete."""

EVERY = 4.0
"""Time between two samples of the record, ms."""

HIDDEN = (768.0, 1008.0)
"""Time in which a negative input resets the field to rest, ms. No picture shows it: with a peak that
outlives its input, two further inputs could not compete fairly.
"""

END = 2200.0
"""Duration of the run, ms."""

Knots = tuple[tuple[float, float], ...]
"""Times in ms and values, with lines between them."""

GROWING: Knots = ((48, 0), (400, 4.0), (592, 4.6), (776, 4.6), (784, 0))
"""Amplitude of the single input. It crosses the threshold of detection slowly, because the peak appears 90 ms
later.
"""

COMPETING: Knots = ((1048, 0), (1208, STRENGTH), (1528, STRENGTH), (1608, 0))
LOWERED: Knots = (
    (784, 0),
    (792, -9),
    (920, -9),
    (928, 0),
    (1808, 0),
    (1904, -1),
    (2000, -1.5),
    (2064, -1.5),
    (2120, 0),
)


@dataclass(frozen=True)
class FieldRun:
    """What the run was, without the hidden time.

    Attributes:
        activation: samples over time and space.
        input: the localised input, of the same shape.
        lowered: the homogeneous input, at each time; 0 or less.
        again: the number of the first sample after the hidden time.
    """

    activation: np.ndarray
    input: np.ndarray
    lowered: np.ndarray
    second: int


def field() -> Field:
    """Return the field of both scenes: one peak outlives its input, and two inputs make one peak."""
    return Field(
        "u",
        [AXIS],
        tau=20.0,
        resting_level=RESTING_LEVEL,
        kernel=[Gaussian(22.0, WIDTH, normalized=True)],
        global_inhibition=0.5,
        noise=0.7,
    )


def selection() -> Model:
    """Return the second scene without its schedule: the field with two equal inputs, for scripts and the
    studio.
    """
    model = Model("selection")
    model.describe(notes="Two equal inputs, one peak. Set an amplitude to 0: the peak stays.")
    u = model.add(field())
    for name, center in (("left", LEFT), ("right", RIGHT)):
        stimulus = GaussianStimulus(name, [AXIS], center=center, sigma=WIDTH, amplitude=STRENGTH)
        model.add(stimulus) >> u
    return model


def run(seed: int) -> FieldRun:
    """Run both scenes as one simulation.

    Args:
        seed: seed of the noise, which decides the winner.
    """
    times = np.arange(0, END + EVERY / 2, EVERY)
    localised = _course(times, GROWING) * _bump(MIDDLE) + _course(times, COMPETING) * (
        _bump(LEFT) + _bump(RIGHT)
    )
    lowered = _course(times, LOWERED) * np.ones(AXIS.samples)
    model = Model("story")
    u = model.add(field())
    for name, values in (("input", localised), ("lowered", lowered)):
        model.add(TimeSeries(name, [AXIS], times=times, values=values)) >> u
    paths = ["u.activation", "input.output", "lowered.output"]
    record = simulate(model, END, record=paths, every=EVERY, seed=seed, on=Resources(progress=False))
    at = record["time"].values
    visible = (at < HIDDEN[0]) | (at >= HIDDEN[1])
    activation, inputs, pushed = (record[name].values[visible] for name in paths)
    return FieldRun(activation, inputs, pushed[:, 0], int((at < HIDDEN[0]).sum()))


def _course(times: np.ndarray, knots: Knots) -> np.ndarray:
    """Return a column of the values at some times."""
    at, values = np.array(knots).T
    return np.interp(times, at, values)[:, None]


def _bump(center: float) -> np.ndarray:
    return np.exp(-((AXIS.points - center) ** 2) / (2 * WIDTH**2))
