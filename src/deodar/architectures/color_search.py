"""Sequential search for colours: a vehicle is taught a sequence of colours by showing them to its camera, and
then looks for blocks of these colours in an arena, in the learned order.

The chain of ordinal nodes, its action field and its field of the condition of satisfaction are those of
`serial_order`, over hue. A colour-space field over hue and image column connects them to a camera and two
wheels. While the sequence is taught, a colour in view makes a peak in it, which excites the action field; the
node that is active learns this colour. While the sequence is produced, the action field raises a ridge along
its hue; a block of this hue in view makes a peak, towards which the vehicle turns. A block of the hue of the
action field that fills the middle of the picture satisfies the condition of satisfaction.

The unit of time is a millisecond; hue has 180 samples of 2 degrees; columns are those of a picture of 160
pixels, from -80 to 80. Speeds are in pulses per second of the vehicle's wheels, distances in mm.

Reference:
    Sandamirskaya & Schöner (2010), An embodied account of serial order, Neural Networks 23(10), section 5,
    appendices A and B. What the paper leaves open or what does not work as printed is stated at each constant
    below.
"""

from __future__ import annotations

import math

import numpy as np

from deodar.architectures.serial_order import CLEAR, QUADRATURE, START, STEEP, TAU, serial_order
from deodar.couplings.arithmetic import Gain, Product, Sigmoid, Sum
from deodar.couplings.convolutions import Convolve
from deodar.couplings.delays import DelayLine
from deodar.couplings.pictures import ColorHistogram
from deodar.couplings.positions import SpaceCode
from deodar.couplings.projections import Project
from deodar.couplings.steering import ObstacleRepulsion
from deodar.couplings.weights import Weighting
from deodar.elements.field import Field
from deodar.elements.memories import MemoryTrace
from deodar.elements.populations import RateNode
from deodar.elements.stimuli import Boost
from deodar.elements.world_ports import Motor, Sensor
from deodar.model.model import Handle, Model
from deodar.numerics.axes import Axis
from deodar.numerics.kernels.separable import Gaussian
from deodar.numerics.sigmoids import Linear, Logistic, SemiLinear, Step

HUES = 180
COLUMNS, ROWS = 160, 120
"""Samples of hue, and of the picture (table B.1: N and N_sp)."""

COARSE = 2
"""Grid step of the colour-space field in hue and column; with 1 the vehicle behaves the same at four times
the cost.
"""

RESTING, TAUGHT = -3.0, 2.0
"""h_p while a sequence is produced, and what is added to it while it is taught.

The table prints -2 and -1: with -2 the ridge alone (c_A^P = 2.5) lies above threshold.
"""

RIDGE, SEEN = 2.5, 2.0
"""c_A^P and c_vis^P (table B.1)."""

EXCITATION, INHIBITION, WIDTH = 0.015, 0.005, 3.0
"""Kernel of the colour-space field: per sample in steps of 1.

The table prints 0.6 and 0.5, with which a blob of 75 x 12 samples shuts the whole field within a step. With
these strengths a step of 4 ms is too long, too: the peak then oscillates, and colours are learned wrongly.
"""

SHOWN = 2.0
"""c_vis: from the colour-space field to the action field, while a sequence is taught.

The ridge is closed while a sequence is taught and this input while it is produced. The paper leaves both
open, and expects the boost of the colour-space field to reverse the coupling; then the two fields hold each
other's peak after the ordinal node is off, and no transition occurs.
"""

PATCH, LARGE = 1 / 3, 1.0
"""Middle part of the columns that drives the field of the condition of satisfaction (the paper says "a
central portion"), and c_vis^C.
"""

SPREAD, HUE_NOISE = 5.0, 3.0
"""Smoothing of hue, in samples, and the standard deviation of hue in the picture for which a column of a
single colour gives 1. Both are ours: the paper states neither; the share of single hues reaches none of its
thresholds.
"""

WHOLE = math.hypot(SPREAD, HUE_NOISE) / SPREAD
"""Factor with which a column of a single colour gives 1: its maximum is lower where hue scatters."""

REPULSION, ATTRACTION, TURNING = 1.0, 0.2, 80.0
"""lambda_obs, lambda_tar and tau_nav.

The right side of eq. A.1 has no unit in the paper; here it is a difference between the wheels in pulses per
ms.
"""

ANGLES = (-90.0, -45.0, -9.0, 11.0, 45.0, 90.0)
"""Directions of the infrared sensors, degrees (table B.1)."""

CRUISE, CAUTION, INERTIA = 300.0, 150.0, 30.0
"""Speed without and with an obstacle near, pulses per second, and tau_vel.

The table prints 60 and 30 (5 and 2.5 mm/s); deodar drives five times as fast, which scales all durations.
"""

NEAR = 80.0
"""Distance below which an obstacle counts as near, mm (ours)."""


HABITUATION = {
    "delay": 100.0,
    "tau_build": 10.0,
    "tau_decay": 5_000.0,
    "satisfaction": -3.0,
    "colour space": -3.0,
}
"""Delay and time constants of the trace of the colours that were found, ms, and its strengths (ours): such a
colour attracts again after about 10 s. Without the delay the trace would break the transition off.
"""

HABITUATED = 0.2, 6.0
"""Kernel between the condition of satisfaction and the trace: it is above threshold to 8 samples beside the
peak. A narrower trace leaves the hues beside it, at which the block satisfies the condition at once.
"""

BEFORE = 100.0, 200.0
"""Time constants of the two memories of the mode, ms: after a change all nodes are inhibited for 230 ms, and
the first node gets its pulse from 300 to 460 ms (ours, as the paper does not mention them).
"""

VIEW, SIDEWAYS = 25.0, 45.0
"""Width of the view in the trace of viewed directions (a Gaussian is above 0.5 in the 60 degrees of the
camera), and angle between the heading and the directions whose trace decides about a turn, degrees.
"""

LOOKED, FORGOTTEN = 300.0, 15000.0
"""Time constants with which the trace of a direction grows in view and decays out of view, ms."""

SPIN = 500.0
"""Difference between the wheels while the vehicle looks around, pulses per second: 45 degrees per second of a
Khepera.
"""

TURN = {"resting level": 0.8, "self-excitation": 0.7, "trace": -3.5, "other": -3.0, "peak": -6.0}
"""Strengths of the two nodes of looking around (ours, like the whole search).

An active node is switched off where the trace is above 0.43: after a turn, which takes 8 s, it is at 0.48.
With -2.5 a node could stay active permanently. It is switched on again where the trace is below 0.23, after
11 s.
"""


def hue_axis() -> Axis:
    """Return the axis of hue: a circle of 180 samples, each of 2 degrees."""
    return Axis("hue", 0.0, float(HUES), HUES, periodic=True)


def column_axis(samples: int = COLUMNS // COARSE) -> Axis:
    """Return the axis of image columns, from -80 at the left to 80 at the right."""
    half = COLUMNS / 2 * (1 - 1 / samples)
    return Axis("column", -half, half, samples)


def color_search(
    items: int = 5,
    noise: float = 0.22,
    look_around: bool = True,
    habituation: bool = False,
    cues: int = 1,
) -> Model:
    """Create the architecture for a vehicle with a camera, infrared sensors that read distances in mm, and
    two wheels, such as the Khepera of the world `Arena`.

    The document parameter `mode` is 0 while a sequence is taught, and 1 while it is produced. It opens and
    closes: learning, what the action field reads from the colour-space field and from the weights, the ridge,
    the resting level of the colour-space field, and the wheels. A change of the mode inhibits all nodes, the
    action field and the field of the condition of satisfaction for a moment, and then activates the first
    node; the weights stay.

    With more than one cue several sequences are taught and produced; the document parameter `cue` says which
    one, as in `serial_order`. A change of the cue while a sequence is produced leaves the ordinal nodes as
    they are: the vehicle looks for the colour that the other sequence has at the present position. While a
    sequence is taught, it starts again with the first node, like a change of the mode.

    Args:
        items: number of positions, 1 to 50. A sequence may be shorter.
        noise: strength of the noise of all nodes, and of the fields at each of their samples; 0.22 is a
            standard deviation of 0.05 at rest.
        look_around: whether the vehicle looks around while no block of the wanted colour is in view: it turns
            on the spot, towards the side where it has not looked for a while, until it has looked everywhere.
            Without it the vehicle drives straight until an obstacle turns it, as in the paper.
        habituation: whether a colour that was found neither satisfies nor attracts for some seconds. Without
            it, as in the paper's equations, a repeated colour is found again at once if its block is still in
            view.
        cues: number of sequences that can be taught, 1 to 50; with 1 there is no parameter `cue`.

    Reference:
        Sandamirskaya & Schöner (2010), figure 8, eqs. 4 to 8 and A.1 to A.6, table B.1.
    """
    hue = hue_axis()
    model = serial_order(items, hue, noise, cues)
    model.describe(
        name="color search",
        notes=(
            "Sandamirskaya & Schöner (2010), section 5. Run it in an arena with a Khepera; mode 0 teaches,"
            " mode 1 produces."
        ),
    )
    model.parameter("mode", 0.0)
    model.link("producing.amplitude", "mode")
    producing = model["producing"]
    teaching = model.add(Gain(-1.0, name="not teaching"))
    producing >> teaching
    for k in range(1, items + 1):
        model.connect(teaching, f"item {k}.meaning.gate")
    _changes(model, items, producing if cues == 1 else _taught_cue(model))
    searched = _colour_space(model, hue, noise)
    turn, speed = _wheels(model, searched, stops=look_around)
    if habituation:
        _habituate(model, hue)
    if look_around:
        _look_around(model, searched, turn, speed, noise)
    # these two are only for records and figures
    model.add(Sensor("pose", [Axis("x, y, heading", 0, 2, 3)], sensor="pose"))
    model.add(Sensor("touching", sensor="touching"))
    return model


def _taught_cue(model: Model) -> Handle:
    """Create the number of the cue while a sequence is taught, 0 while one is produced.

    It changes with the mode, and with the cue only while a sequence is taught.
    """
    number = model.add(Boost("cue number", []))
    model.link("cue number.amplitude", "cue")
    taught = model.add(Product(name="taught cue"))
    number >> taught
    for factor in ("learning", "not teaching"):
        model.connect(model[factor], "taught cue.factor")
    return taught


def _changes(model: Model, items: int, source: Handle) -> None:
    """Create what a change of the mode does: a pause, then a pulse to the first node.

    `source` is the signal whose changes count.
    """
    model.remove(model["clear"])
    group = "change of mode"
    minus = model.add(Gain(-1.0, name="less"), group=group)
    other = model.add(Gain(-1.0, name="less the slower"), group=group)
    changed: dict[str, Handle] = {}
    for name, tau, through in (("before", BEFORE[0], minus), ("long before", BEFORE[1], other)):
        last = model.add(Field(name, [], tau=tau, resting_level=0.0, sigmoid=Linear()), group=group)
        difference = model.add(Sum(name=f"change from {name}"), group=group)
        square = model.add(Product(name=f"square of {name}"), group=group)
        source >> last >> through >> difference
        source >> difference
        difference >> square
        model.connect(difference, f"{square.path}.factor")
        changed[name] = square
    clear = model.add(Gain(CLEAR, name="clear"), group=group)
    changed["before"] >> model.add(Sigmoid(Step(0.1**2), name="changes"), group=group) >> clear
    for target in [f"item {k}.{name}" for k in range(1, items + 1) for name in ("node", "memory")]:
        clear >> model[target]
    clear >> model["action"]
    clear >> model["satisfaction"]
    # the pulse ends when the memory node is on: a block that is in view at once may satisfy the first node
    # before, and the pulse would activate it again
    start = model.add(Product(name="start"), group=group)
    model["item 1.memory"] >> model.add(Gain(-1.0, name="has begun"), group=group) >> start["factor"]
    model.add(Boost("may begin", [], amplitude=1.0), group=group) >> start["factor"]
    for name, threshold, strength in (("long before", 0.1, START), ("before", 0.05, -START)):
        pulse = model.add(Sigmoid(Step(threshold**2), name=f"not long after {name}"), group=group)
        changed[name] >> pulse >> model.add(Gain(strength, name=f"start {name}"), group=group) >> start
    start >> model["item 1.node"]


def _colour_space(model: Model, hue: Axis, noise: float) -> Handle:
    """Create the colour-space field, its inputs, and what the chain reads of it; return the field."""
    coarse = Axis("hue", 0.0, float(HUES), HUES // COARSE, periodic=True)
    column = column_axis()
    picture = model.add(
        Sensor(
            "camera",
            [column_axis(COLUMNS), Axis("row", 0, ROWS - 1, ROWS), Axis("channel", 0, 2, 3)],
            sensor="camera",
        )
    )
    colours = model.add(ColorHistogram([column, coarse], sigma=SPREAD, name="colours"))
    field = model.add(
        Field(
            "colour space",
            [column, coarse],
            tau=TAU,
            resting_level=RESTING,
            sigmoid=Logistic(beta=STEEP),
            kernel=[Gaussian(EXCITATION, WIDTH)],
            global_inhibition=INHIBITION,
            noise=noise,
            quadrature=QUADRATURE,
        )
    )
    seen = model.add(Gain(SEEN * WHOLE, name="seen"))
    picture >> colours >> seen >> field
    boost = model.add(Gain(TAUGHT, name="taught"))
    model["learning"] >> boost
    model["not teaching"] >> boost
    boost >> field
    ridge = model.add(Product(name="ridge"))
    model["action"] >> model.add(Gain(RIDGE, name="wanted")) >> ridge
    model.connect(model["producing"], "ridge.factor")
    ridge >> field
    shown = model.add(Product(name="shown"))
    (
        field
        >> model.add(Project([hue], reduce="max", name="hue of the peak"))
        >> model.add(Gain(SHOWN, name="strength shown"))
        >> shown
    )
    model.connect(model["learning"], "shown.factor")
    model.connect(model["not teaching"], "shown.factor")
    shown >> model["action"]
    inside = (np.abs(column.points) < PATCH * COLUMNS / 2).astype(float)
    middle = np.repeat((inside / inside.sum())[:, None], coarse.samples, axis=1)
    (
        colours
        >> model.add(Weighting(middle, (column, coarse), name="middle"))  # type: ignore[arg-type]
        >> model.add(Project([hue], reduce="sum", name="large"))
        >> model.add(Gain(LARGE * WHOLE, name="strength of large"))
        >> model["satisfaction"]
    )
    return field


def _habituate(model: Model, hue: Axis) -> None:
    """Create a trace of the colours that were found, which inhibits the field of the condition of
    satisfaction and the colour-space field.
    """
    group, times = "habituation", (HABITUATION["tau_build"], HABITUATION["tau_decay"])
    gate = model.add(Product(name="while producing"), group=group)
    model["satisfaction"] >> gate
    model.connect(model["producing"], f"{gate.path}.factor")
    trace = model.add(
        MemoryTrace("found colours", [hue], tau_build=times[0], tau_decay=times[1], fades=True), group=group
    )
    wider = model.add(Convolve([Gaussian(*HABITUATED)], name="around"), group=group)
    gate >> model.add(DelayLine("later", [hue], HABITUATION["delay"]), group=group) >> wider >> trace
    for target in ("satisfaction", "colour space"):
        trace >> model.add(Gain(HABITUATION[target], name=f"less {target}"), group=group) >> model[target]


def _wheels(model: Model, field: Handle, stops: bool) -> tuple[Handle, Handle]:
    """Create the dynamics of heading and speed; return the inputs of both.

    `stops`: whether its inputs can stop the vehicle, which never drives backwards.
    """
    column = column_axis()
    target = model.add(Project([column], reduce="max", name="columns of the peak"))
    lever = model.add(Weighting(column.points, (column,), name="offset"))  # type: ignore[arg-type]
    pull = model.add(Project([], name="attraction"))
    field >> target >> lever >> pull
    distance = model.add(Sensor("distance", [Axis("sensor", 0, 5, 6)], sensor="infrared"))
    push = model.add(ObstacleRepulsion(ANGLES, name="repulsion"))  # type: ignore[arg-type]
    distance >> push
    near = model.add(Sigmoid(Step(-NEAR), name="near"))
    nearest = model.add(Project([], reduce="min", name="nearest"))
    distance >> nearest >> model.add(Gain(-1.0, name="nearness")) >> near
    forward = SemiLinear() if stops else Linear()
    speed = model.add(RateNode("speed", tau=INERTIA, resting_level=CRUISE, sigmoid=forward))
    near >> model.add(Gain(CAUTION - CRUISE, name="caution")) >> speed
    turn = model.add(Sum(name="turn"))
    for force, strength in ((pull, ATTRACTION), (push, REPULSION)):
        # half of the difference between the wheels, pulses per second
        (
            force
            >> model.add(Gain(strength * 1000.0 / 2 / TURNING, name=f"turn by {force.element.name}"))
            >> turn
        )
    back = model.add(Gain(-1.0, name="back"))
    turn >> back
    for side, turning in (("left", turn), ("right", back)):
        wheel = model.add(Product(name=f"{side} speed"))
        model.connect("speed.output", f"{wheel.path}.input")
        turning >> wheel
        model.connect(model["producing"], f"{wheel.path}.factor")
        wheel >> model.add(Motor(f"{side} wheel", motor=side))
    return turn, speed


def _look_around(model: Model, field: Handle, turn: Handle, speed: Handle, noise: float) -> None:
    """Create the search: a trace of the viewed directions inhibits two nodes, which turn the vehicle to
    the right and to the left.

    They compete. A peak in the colour-space field inhibits both, and so does the trace where it is
    everywhere: the vehicle then drives on, until the trace has decayed.
    """
    group = "search"
    direction = Axis("direction", -180.0, 180.0, 72, periodic=True, unit="deg")
    degrees = 180 / math.pi
    compass = model.add(Sensor("compass", sensor="heading"), group=group)
    trace = model.add(MemoryTrace("viewed", [direction], tau_build=LOOKED, tau_decay=FORGOTTEN), group=group)
    compass >> model.add(SpaceCode([direction], VIEW, 1.0, gain=degrees, name="view"), group=group) >> trace
    peak = model.add(Project([], reduce="max", name="found"), group=group)
    seen = model.add(Gain(TURN["peak"], name="no search"), group=group)
    field >> peak >> seen
    nodes: dict[str, Handle] = {}
    for side, angle in (("right", -SIDEWAYS), ("left", SIDEWAYS)):
        # headings grow counter-clockwise, to the left
        code = SpaceCode(
            [direction], 5.0, 1.0, gain=degrees, offset=angle, normalized=True, name=f"aside {side}"
        )
        viewed = model.add(Product(name=f"viewed {side}"), group=group)
        compass >> model.add(code, group=group) >> viewed
        model.connect(trace, f"{viewed.path}.factor")
        nodes[side] = model.add(
            Field(
                f"turn {side}",
                [],
                tau=TAU,
                resting_level=TURN["resting level"],
                sigmoid=Logistic(beta=STEEP),
                kernel=[Gaussian(TURN["self-excitation"])],
                noise=noise,
            ),
            group=group,
        )
        amount = model.add(Project([], name=f"trace {side}"), group=group)
        viewed >> amount >> model.add(Gain(TURN["trace"], name=f"known {side}"), group=group) >> nodes[side]
        seen >> nodes[side]
        spin = model.add(Gain(SPIN / 2 if side == "right" else -SPIN / 2, name=f"spin {side}"), group=group)
        nodes[side] >> spin
        nodes[side] >> model.add(Gain(-CRUISE, name=f"stop {side}"), group=group) >> speed
        spin >> turn
    for side, other in (("right", "left"), ("left", "right")):
        nodes[side] >> model.add(Gain(TURN["other"], name=f"not {other}"), group=group) >> nodes[other]
