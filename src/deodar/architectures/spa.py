"""Simultaneous planning and action: a wave of motivation spreads from a goal, and a robot follows it through
a maze.

Four elementary behaviours (`_elementary_behaviour`) move north, south, west and east. The goal excites all
motivation fields; obstacles inhibit them. Motivation to go north at a position activates the precondition one
step south of it, which motivates the behaviours that lead there. Where the wave of motivation meets the
robot, the robot's position releases the precondition: an intention becomes active, excites an action field
over turning angles, and the wheels turn. Planning and acting are simultaneous, so a plan can change while the
robot follows it.

The unit of time is a step of the published simulation, 64 ms, and the unit of space is 1 cm, a cell of the
published fields, so the published numbers apply unchanged. Space is that of the arena (x to the east, y to
the north); row r and column c of the published fields are `place(r, c)`.

References:
    Billing, Lowe & Sandamirskaya (2015), Simultaneous planning and action: neural-dynamic sequencing of
    elementary behaviors in robot navigation, Adapt. Behav. 23(5), section 3.2, figure 4, appendix A, table 2.
    Their published simulator (BSD) is followed where paper and code differ: eq. 12 prints pi for tau; eq. 4
    lets satisfaction inhibit motivation, which the code does not; the action field's tau is 3.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from deodar.architectures._elementary_behaviour import QUADRATURE, RESTING, elementary_behaviour
from deodar.couplings.arithmetic import Gain, Logarithm, Sigmoid
from deodar.couplings.convolutions import Convolve
from deodar.couplings.positions import SpaceCode
from deodar.couplings.projections import Project
from deodar.couplings.steering import TurnLimit
from deodar.couplings.weights import Weighting, Weights
from deodar.elements.changing_stimuli import Noise
from deodar.elements.field import Field
from deodar.elements.world_ports import Motor, Sensor
from deodar.errors import ParameterError, did_you_mean
from deodar.model.model import Handle, Model
from deodar.numerics.axes import Axis
from deodar.numerics.kernels.separable import Gaussian
from deodar.numerics.sigmoids import Logistic, Step
from deodar.worlds.arena.arena import Arena
from deodar.worlds.arena.arena_settings import ArenaNoise, ArenaPhysics

STEP_MS = 64.0
STEP = 5.0
"""Displacement by one execution of a behaviour, cm."""

DIRECTIONS = {"north": (0.0, STEP), "south": (0.0, -STEP), "west": (-STEP, 0.0), "east": (STEP, 0.0)}
OPPOSITE = {"north": "south", "south": "north", "west": "east", "east": "west"}

NOISE = {"none": (0.0, 0.0, 1.0), "low": (0.05, 0.5, 1.0), "high": (1.0, 2.0, 1.2)}
"""Levels of noise of section 4: on the map (share of its strength), on the position sensor (cm), and the
factor on the position input (published code only).
"""

BETWEEN = {
    "2c precondition to motivation, perpendicular": 4.5,
    "2d precondition to motivation, opposite": -10.0,
}
"""Strengths between behaviours, as document parameters.

These connections have no shift and no kernel. Connection 2b is not used.
"""

ENDS = "periodic"
"""Kernels in space wrap around the ends, as published.

The outermost cells need inhibition from beyond the ends. With zero padding they receive half of the walls'
inhibition, motivation spreads into them, and intentions become active where no precondition inhibits them.
"""

TOUCHED = 1e-3
"""Covered share from which a cell counts as wall: all cells that a wall touches, as in the published map."""

GOAL, PLACE, MAP = 10.0, 8.0, -15.0
SPOT = 3.0
"""Width of the Gaussians at the goal and at the robot's position, cm."""

BIN = 3.6
"""Width of each of the 100 bins of the action and proximity fields, degrees."""

SENSOR_BINS = (55, 65, 90, 100, 1, 10, 35, 45)
SENSOR_SHARES = (1.0, 1.0, 0.5, 0.5, 0.5, 0.5, 1.0, 1.0)
"""Bins of the infrared sensors 0 to 7 (50 is straight ahead, larger is to the right), and their strengths:
half for the sensors at the sides and the back.
"""

SPEED, TURN = 500.0, 400.0
"""Speed of a wheel for an input of 1, and largest difference between the wheels, motor steps per second."""

MAZES = ("z", "large")

CASE_3 = ((50, 60), (40, 40))
"""Row and column of start and goal of case 3.

The goal is published. The start is inferred: the text does not state it, and from the pose in the world file
the goal is visible; from this start, with a heading to the east, the robot takes the route of the narrative
at the published times.
"""

OBSTACLES = {"full": ((-65.0, 90.0), (10.0, 20.0)), "partial": ((-65.0, 82.5), (30.0, 15.0))}
"""Middle and size (x and y, cm) of the obstacles of case 3: `full` closes the northern route, `partial`
leaves a lane of 10 cm.
"""


def place(row: float, column: float) -> tuple[float, float]:
    """Return x and y in cm of a cell of the published fields (counted from 1), in the Z-maze and the large
    maze.
    """
    return column - 105.0, 105.0 - row


def space(arena: Arena) -> tuple[Axis, Axis]:
    """Return the axes of the planning fields: the arena and a margin of 5 cm, one sample per cm, as
    published.
    """
    left, low, right, high = (100 * v for v in arena.layout.border)
    x = math.floor(left + 1e-6) - 4, math.ceil(right - 1e-6) + 5
    y = math.floor(low + 1e-6) - 5, math.ceil(high - 1e-6) + 4
    return Axis("x", *x, x[1] - x[0] + 1, unit="cm"), Axis("y", *y, y[1] - y[0] + 1, unit="cm")


def turning() -> Axis:
    """Return the axis of turning angles, positive to the right: 100 bins, the 50th straight ahead."""
    return Axis("turn", -49 * BIN, 51 * BIN, 100, periodic=True, unit="deg")


def maze(
    name: str = "z",
    noise: str = "low",
    start: Sequence[float] | np.ndarray | None = None,
    goal: Sequence[float] | np.ndarray | None = None,
    contact: str = "slide",
    reflection: float = 0.6,
) -> Arena:
    """Create a published maze with the robot, lengths in cm.

    The default start and goal are those of case 3 (in the large maze: those of its file).

    Args:
        name: `z` or `large`, or another arena.
        noise: `none`, `low` or `high`: noise of the position sensor, resampled every second step.
        start: x, y and heading (rad), or a row for each trial.
        goal: x and y, or a row for each trial.
        contact: `slide` along walls, or `stick` to them.
        reflection: infrared reflectance of walls, as in `dd.ArenaPhysics`.
    """
    if name == "z":
        start = (*place(*CASE_3[0]), 0.0) if start is None else start
        goal = place(*CASE_3[1]) if goal is None else goal
    physics = ArenaPhysics(STEP_MS, contact, reflection, place_every=2)
    return Arena(name, start, goal, "cm", physics=physics, noise=ArenaNoise(level(noise)[1]))


def level(noise: str) -> tuple[float, float, float]:
    """Return the numbers of a level of noise."""
    if noise not in NOISE:
        raise ParameterError(f"there is no level of noise {noise!r}", fix=did_you_mean(noise, NOISE))
    return NOISE[noise]


def spa(arena: Arena, noise: str = "low", place_factor: float | None = None) -> Model:
    """Create the architecture for an arena; it can run in this arena or another of the same size and unit.

    Args:
        arena: the arena, which defines the size of the planning fields and the unit of positions; `maze`
            creates the published ones.
        noise: `none`, `low` or `high`: noise on the map, and the default `place_factor`. The noise of the
            position sensor is a parameter of the arena.
        place_factor: factor on the position input. None: the factor of the level of noise, 1.2 with high
            noise, 1 otherwise. The paper does not mention the 1.2; the published code has it.
    """
    on_map, _, by_level = level(noise)
    trust = by_level if place_factor is None else place_factor
    axes = space(arena)
    model = Model("simultaneous planning and action", time_unit="1 = 64 ms", dt=1.0)
    model.describe(
        notes=(
            "Billing, Lowe & Sandamirskaya (2015), figure 4. Run it in an arena with a goal; time is in steps"
            " of 64 ms."
        )
    )
    for name, value in BETWEEN.items():
        model.parameter(name, value)
    walls, goal, here = _planning_inputs(model, axes, on_map, trust, 100 * arena.scale)
    compass = model.add(Sensor("compass", sensor="heading"))
    avoid, alarm = _proximity(model)
    wheels = model.add(TurnLimit(SPEED, TURN, name="wheels"))
    for side in ("left", "right"):
        wheels[f"to_{side}"] >> model.add(Motor(f"{side} wheel", motor=side))
    for name, step in DIRECTIONS.items():
        model.insert(elementary_behaviour(axes, step, boundary=ENDS), name)
        walls >> model[f"{name}.motivation"]
        goal >> model[f"{name}.motivation"]
        here >> model[f"{name}.satisfaction"]
        _action(model, name, compass, [avoid, alarm], wheels)
    for name in DIRECTIONS:
        _compete(model, name)
    # these two are only for records and figures
    model.add(Sensor("pose", [Axis("x, y, heading", 0, 2, 3)], sensor="pose"))
    model.add(Sensor("touching", sensor="touching"))
    return model


def _planning_inputs(
    model: Model, axes: Sequence[Axis], on_map: float, trust: float, cm: float
) -> tuple[Handle, Handle, Handle]:
    """Create the inputs from walls and goal to the motivation fields, and from the robot's position to the
    satisfaction fields; `cm`: the arena's unit in cm.
    """
    both = Axis("x, y", 0, 1, 2)
    walls = model.add(Convolve([Gaussian(MAP, 2.0, normalized=True, boundary=[ENDS])], name="walls"))
    occupied = model.add(Sigmoid(Step(TOUCHED), name="occupied"))
    model.add(Sensor("map", axes, sensor="obstacles")) >> occupied >> walls
    model.add(Noise("map noise", axes, on_map)) >> walls
    goal = model.add(SpaceCode(axes, SPOT, GOAL, gain=cm, name="goal place"))
    model.add(Sensor("goal", [both], sensor="goal")) >> goal
    here = model.add(SpaceCode(axes, SPOT, PLACE * trust, gain=cm, name="own place"))
    model.add(Sensor("place", [both], sensor="place")) >> here
    return walls, goal, here


def _proximity(model: Model) -> tuple[Handle, Handle]:
    """Create the proximity field: inhibition around each obstacle, and a weak homogeneous input (published
    code).
    """
    turn = turning()
    seen = model.add(Sensor("infrared", [Axis("sensor", 0, 7, 8)], sensor="infrared"))
    bins = np.arange(1, 101)[:, None]
    spots = np.exp(-0.5 * ((bins - np.array(SENSOR_BINS)) / 3.0) ** 2) * SENSOR_SHARES
    around = model.add(Weights(spots, [turn], name="around"))  # type: ignore[arg-type]
    near = model.add(
        Field(
            "proximity",
            [turn],
            tau=5.0,
            resting_level=RESTING,
            sigmoid=Logistic(beta=3.0),
            quadrature=QUADRATURE,
        )
    )
    seen >> model.add(Logarithm(5.0, 50.0, name="loudness")) >> around >> near
    avoid = model.add(Convolve([Gaussian(-16.0, 12 * BIN, normalized=True)], name="avoid"))
    near >> avoid
    alarm = (
        near
        >> model.add(Project([], reduce="sum", name="alarm"))
        >> model.add(Gain(0.01, name="alarm strength"))
    )
    return avoid, alarm


def _action(model: Model, name: str, compass: Handle, biases: Sequence[Handle], wheels: Handle) -> None:
    """Create the action field of a behaviour: below threshold with the heading alone, it turns the wheels
    while an intention is active.
    """
    turn, (east, north) = turning(), DIRECTIONS[name]
    base = math.degrees(math.atan2(north, east))
    action = model.add(
        Field(
            "action",
            [turn],
            tau=3.0,
            resting_level=RESTING,
            sigmoid=Logistic(beta=4.0),
            global_inhibition=0.05 / BIN,
            quadrature=QUADRATURE,
        ),
        group=name,
    )
    (
        compass
        >> model.add(
            SpaceCode([turn], 30 * BIN, 4.0, gain=180 / math.pi, offset=-base, name="heading"), group=name
        )
        >> action
    )
    strongest = model.add(Project([], reduce="max", name="strongest"), group=name)
    model[f"{name}.intention"] >> strongest >> model.add(Gain(2.0, name="go"), group=name) >> action
    for bias in biases:
        bias >> action
    # right is left mirrored at bin 50.5, as published; straight ahead is bin 50, so half a bin to the left
    angles = np.deg2rad(turn.points)
    weights = {
        "left": np.sin(angles - math.radians(BIN) + math.pi / 3),
        "right": np.sin(math.pi / 3 - angles),
    }
    for side, values in weights.items():
        wheel = model.add(Weighting(values, (turn,), name=f"{side} wheel"), group=name)  # type: ignore[arg-type]
        action >> wheel
        for most in ("max", "min"):
            (
                wheel
                >> model.add(Project([], reduce=most, name=f"{side} wheel, {most}"), group=name)
                >> wheels[side]
            )


def _compete(model: Model, name: str) -> None:
    """Connect preconditions: each excites the motivation of both perpendicular behaviours and inhibits that
    of the opposite one.
    """
    asks = model[f"{name}.precondition"]
    aside, against = BETWEEN
    for key, targets in (
        (aside, [n for n in DIRECTIONS if n not in (name, OPPOSITE[name])]),
        (against, [OPPOSITE[name]]),
    ):
        strength = model.add(Gain(BETWEEN[key], name="aside" if key == aside else "against"), group=name)
        model.link(f"{strength.path}.factor", key)
        asks >> strength
        for target in targets:
            strength >> model[f"{target}.motivation"]
