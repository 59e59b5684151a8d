"""A plan in one dimension: the wave of motivation of simultaneous planning and action.

Two elementary behaviours move left and right along a corridor with a wall at either end. A goal excites the
motivation of both. Motivation spreads from it at a constant speed, for each behaviour against its direction
of motion, because the start position of a useful step is itself a position to reach. Where the wave meets the
position of the walker, the precondition is released, and an intention moves the walker while it is active.
When the goal is removed, the plan decays; when a goal appears elsewhere, a new plan spreads.

Reference:
    Billing, Lowe & Sandamirskaya (2015), Simultaneous planning and action, Adapt. Behav. 23(5), figure 3,
    with a second behaviour. The walker is deodar's addition: its position is the integral of the
    speed that the intentions command.
"""

from __future__ import annotations

from collections.abc import Sequence

from deodar.architectures._elementary_behaviour import elementary_behaviour
from deodar.couplings.arithmetic import Gain
from deodar.couplings.positions import SpaceCode
from deodar.couplings.projections import Project
from deodar.elements.field import Field
from deodar.elements.stimuli import BoxStimulus, GaussianStimulus
from deodar.model.model import Model
from deodar.numerics.axes import Axis
from deodar.numerics.kernels.separable import Gaussian
from deodar.numerics.sigmoids import Linear
from deodar.numerics.windows import Window

LENGTH, WALL = 200.0, 8.0
"""Length of the corridor with its walls, and of a wall at either end, cm."""

STEP = 5.0
OPPOSITE = -10.0
"""Strength from the precondition of one behaviour to the motivation of the other (connection 2d)."""

SPEED = 0.27
"""Speed of the walker while an intention is active, cm per step of 64 ms: about the speed of the robot in the
paper's mazes.
"""

START = 100.0
GOALS = ((40.0, (0.0, 450.0)), (150.0, (450.0, 1e6)))
"""Positions of the goal, and the time window of each."""


def corridor() -> Axis:
    """Return the axis of all fields, with one sample per cm."""
    return Axis("x", 0.0, LENGTH, int(LENGTH) + 1, unit="cm")


def plan(
    start: float = START, goals: Sequence[tuple[float, tuple[float, float]]] = GOALS, noise: float = 1.0
) -> Model:
    """Create the corridor with a walker. Time is in steps of 64 ms, as in `spa`.

    Args:
        start: position of the walker at the start, cm.
        goals: for each goal its position in cm, and its time window.
        noise: strength of the noise of each field.
    """
    x = corridor()
    model = Model("plan", time_unit="1 = 64 ms", dt=1.0)
    model.describe(notes="Billing, Lowe & Sandamirskaya (2015), figure 3; time is in steps of 64 ms.")
    model.parameter("2d precondition to motivation, opposite", OPPOSITE)
    walls = [
        model.add(BoxStimulus(f"{side} wall", [x], center=at, width=2 * WALL, amplitude=-15.0))
        for side, at in (("left", 0), ("right", LENGTH))
    ]
    spots = [
        model.add(
            GaussianStimulus(f"goal {k}", [x], center=at, sigma=3.0, amplitude=10.0, windows=[Window(*when)])
        )
        for k, (at, when) in enumerate(goals, 1)
    ]
    # a linear node whose self-excitation equals its decay is an integrator
    gone = model.add(Field("gone", [], tau=1.0, resting_level=0.0, sigmoid=Linear(), kernel=[Gaussian(1.0)]))
    here = model.add(SpaceCode([x], 3.0, 8.0, offset=start, name="own place"))
    gone >> here
    for name, way in (("left", -1), ("right", 1)):
        model.insert(elementary_behaviour([x], [way * STEP], noise, boundary="periodic"), name)
        for source in (*walls, *spots):
            source >> model[f"{name}.motivation"]
        here >> model[f"{name}.satisfaction"]
        intended = model.add(Project([], reduce="max", name="strongest"), group=name)
        (
            model[f"{name}.intention"]
            >> intended
            >> model.add(Gain(way * SPEED, name="walk"), group=name)
            >> gone
        )
    for name, other in (("left", "right"), ("right", "left")):
        against = model.add(Gain(OPPOSITE, name="against"), group=name)
        model.link(f"{against.path}.factor", "2d precondition to motivation, opposite")
        model[f"{name}.precondition"] >> against >> model[f"{other}.motivation"]
    return model
