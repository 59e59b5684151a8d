"""Pointing: a cue such as "the green object on the left" makes an arm point at this object on a table.

The picture of a camera shows coloured objects. Nodes for two colours and two sides are switched on by the
user and stay on. A perceptual field over the table and hue needs the camera's input, a colour and a side
together to build a peak. Its peak is the attractor of the tool. A field of the condition of satisfaction
(CoS) receives the target and the position of the tool; where they overlap, its peak switches a CoS node on,
which switches cue nodes and perceptual field off, and so the CoS field and itself.

Reference:
    Lomp, Richter, Zibner & Schöner (2016), Developing dynamic field theory architectures for embodied
    cognitive systems with cedar, Front. Neurorobot. 10:14, sections 2.5 and 5, figures 5 to 11, eqs. 11 to
    15. The paper prints no parameters; all values here are deodar's.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from deodar.architectures._noise import strength as strength_of_noise
from deodar.couplings.arithmetic import Gain
from deodar.couplings.convolutions import Convolve
from deodar.couplings.pictures import ColorSpace, Homography
from deodar.couplings.positions import SpaceCode
from deodar.couplings.projections import Project
from deodar.couplings.steering import AttractorVelocity
from deodar.couplings.weights import Weights
from deodar.elements.field import Field
from deodar.elements.stimuli import Boost
from deodar.elements.world_ports import Motor, Sensor
from deodar.model.model import Handle, Model
from deodar.numerics.axes import Axis
from deodar.numerics.kernels.separable import Gaussian
from deodar.numerics.sigmoids import Logistic

COLOURS = {"red": 0.0, "green": 120.0}
"""Hue of each colour that can be named, degrees."""

SIDES = {"left": -1.0, "right": 1.0}
"""Direction of each side along x, as the robot sees the table."""

CUES = (*COLOURS, *SIDES)

TABLE = ((-0.4, 0.4), (0.0, 0.6))
"""Extent of the perceptual field along x and y, m."""

SAMPLES = (40, 30, 30)
PIXELS = (128, 96)
"""Columns and rows of the camera's picture."""

FINER = 2
"""Samples of the picture of the table for one sample of the field, along x and along y."""

CORNERS = ((104.598, 25.68), (22.402, 25.68), (7.003, 81.672), (119.997, 81.672))
"""Column and row of the four corners of the table in the picture of the camera of the scene `table`, in the
order (left, near), (right, near), (right, far), (left, far) as the robot sees them.
"""

PERCEPTUAL_TAU, SATISFACTION_TAU, STEEP = 80.0, 200.0, 15.0
"""Time scales of the perceptual field and of the CoS field, ms, and the slope of their sigmoid. The peak of a
slower perceptual field would remain farther behind an object that moves; a faster CoS field would end the
reach while the tool passes the peak.
"""

INHIBITION = 30.0
"""Global inhibition of the perceptual field: with less of it two small, equal objects may keep two peaks.
"""

NODE_TAU, NODE_STEEP = 50.0, 20.0
STILL = 0.15
"""Standard deviation of the noise of a field or node without interaction, the same at every resolution."""

RAMP = 0.05
"""Half width of the ramp from one side to the other, m."""

CUE = 1.9
"""Input of one cue node to the perceptual field."""

USER = 3.0
"""Input of the user that switches a node on."""

STRENGTHS = {
    "camera": 2.6,
    "target": 0.1,
    "satisfied": 4000.0,
    "release of the field": -2.0,
    "release of the nodes": -6.0,
}
"""Factors of connections. `target` is for each degree of the contracted output, `satisfied` for each m2 of
the CoS field's output. The nodes are inhibited more than the field: all are to be off before the target is.
"""

SATISFIED = 100.0, -1.5, 1.0
"""tau (ms), resting level and self-excitation of the CoS node. It is switched on by a peak of the CoS field
of more than about 3 cm2, a single sample of the coarsest sampling, and off below 1 cm2: it stays on until all
cue nodes are off, while the peak decays with its target.
"""

APPROACH = 12.0
"""tau of eq. 15, ms m2 deg: with a peak of 0.11 m2 deg the tool relaxes in about 0.1 s."""

FASTEST = 0.25e-3
"""Largest speed of the tool, m/ms."""

QUADRATURE = "point"
"""Quadrature of all fields; the parameters were found with `point`."""


def table(samples: Sequence[int] = SAMPLES) -> tuple[Axis, Axis, Axis]:
    """Return the axes of the perceptual field: x and y of the table in m, hue in degrees.

    Samples are in the middle of cells.
    """
    (left, right), (near, far) = TABLE
    x, y = (
        Axis(name, low + (high - low) / n / 2, high - (high - low) / n / 2, n, unit="m")
        for name, low, high, n in (("x", left, right, samples[0]), ("y", near, far, samples[1]))
    )
    return x, y, Axis("hue", 0, 360, samples[2], periodic=True, unit="deg")


def pointing(
    samples: Sequence[int] = SAMPLES,
    corners: Sequence[Sequence[float]] = CORNERS,
    camera: str = "camera",
    noise: float = STILL,
) -> Model:
    """Create the architecture.

    It needs a world with a camera, the sensor `tool_plane` and the motor `tool_plane`, such as
    `dd.MuJoCo("table")`. The amplitude of `say red`, `say green`, `say left` and `say right` is the user's
    input to the node of this name: 3 for some tenths of a second switches it on, -3 off.

    Args:
        samples: samples of the perceptual field along x, y and hue.
        corners: column and row of the corners of the table in the picture, of 128 x 96 pixels: (left, near),
            (right, near), (right, far), (left, far) as the robot sees them.
        camera: name of the world's sensor that is the camera.
        noise: standard deviation of the noise of fields and nodes without interaction.
    """
    x, y, hue = table(samples)
    plane = [x, y]
    model = Model("pointing", dt=10.0)
    model.describe(notes="Lomp, Richter, Zibner & Schöner (2016), section 5: pointing at a cued object")
    sigmoid = Logistic(beta=STEEP)

    def strength(name: str) -> Handle:
        return model.add(Gain(STRENGTHS[name], name=f"{name} strength"))

    perceptual = model.add(
        Field(
            "perceptual",
            [x, y, hue],
            tau=PERCEPTUAL_TAU,
            resting_level=-5.0,
            sigmoid=sigmoid,
            kernel=[Gaussian(18.0, (0.03, 0.03, 18.0), normalized=True)],
            global_inhibition=INHIBITION,
            noise=strength_of_noise(noise, PERCEPTUAL_TAU, [x, y, hue]),
            quadrature=QUADRATURE,
        )
    )
    satisfaction = model.add(
        Field(
            "satisfaction",
            plane,
            tau=SATISFACTION_TAU,
            resting_level=-5.0,
            sigmoid=sigmoid,
            kernel=[Gaussian(12.0, 0.025, normalized=True)],
            global_inhibition=500.0,
            noise=strength_of_noise(noise, SATISFACTION_TAU, plane),
            quadrature=QUADRATURE,
        )
    )

    # what the camera sees, as a space code over the table and hue
    columns, rows = Axis("column", 0, PIXELS[0] - 1, PIXELS[0]), Axis("row", 0, PIXELS[1] - 1, PIXELS[1])
    eye = model.add(Sensor("camera", [columns, rows, Axis("channel", 0, 2, 3)], sensor=camera))
    fine = table([FINER * samples[0], FINER * samples[1], samples[2]])[:2]
    (left, right), (near, far) = TABLE
    edges = np.array([[left, near], [right, near], [right, far], [left, far]])
    above = model.add(
        Homography(list(fine), picture=np.array(corners, float), plane=edges, name="from above")
    )
    colours = model.add(ColorSpace([x, y, hue], sigma=15.0, name="colours"))
    blur = model.add(Convolve([Gaussian(1.0, (0.01, 0.01, 1e-3), normalized=True)], name="blur"))
    eye >> above >> colours >> blur >> strength("camera") >> perceptual

    # the cues: bistable nodes that the user switches
    nodes = [_cue(model, name, noise) for name in CUES]
    for node, (name, at) in zip(nodes, COLOURS.items(), strict=False):
        away = (hue.points - at + 180) % 360 - 180
        ridge = CUE * np.exp(-0.5 * (away / 25.0) ** 2)
        node >> model.add(Weights(ridge, [hue], name=f"hue of {name}")) >> perceptual
    for node, (name, sign) in zip(nodes[len(COLOURS) :], SIDES.items(), strict=True):
        ramp = CUE * np.clip(0.5 + sign * x.points / (2 * RAMP), 0.0, 1.0)
        node >> model.add(Weights(ramp, [x], name=f"space of {name}")) >> perceptual

    # the tool
    of = [Axis("of", 0, 1, 2)]
    tool = model.add(Sensor("tool", of, sensor="tool_plane"))
    toward = model.add(AttractorVelocity(plane, tau=APPROACH, fastest=FASTEST, name="toward the target"))
    perceptual >> toward
    tool >> toward["position"]
    per_second = model.add(Gain(1000.0, name="per second"))
    toward >> per_second >> model.add(Motor("arm", of, motor="tool_plane"))

    # the condition of satisfaction: the tool is at the target
    where = model.add(Project(plane, name="target"))
    perceptual >> where >> strength("target") >> satisfaction
    tool >> model.add(SpaceCode(plane, sigma=0.02, amplitude=3.0, name="tool place")) >> satisfaction
    satisfied = _node(model, "satisfied", *SATISFIED, noise)
    area = model.add(Project([], name="satisfaction area"))
    satisfaction >> area >> strength("satisfied") >> satisfied
    satisfied >> strength("release of the field") >> perceptual
    stop = strength("release of the nodes")
    satisfied >> stop
    for node in nodes:
        stop >> node
    return model


def _node(
    model: Model, name: str, tau: float, resting_level: float, excitation: float, noise: float
) -> Handle:
    """Add a node with self-excitation."""
    return model.add(
        Field(
            name,
            [],
            tau=tau,
            resting_level=resting_level,
            sigmoid=Logistic(beta=NODE_STEEP),
            kernel=[Gaussian(excitation)],
            noise=strength_of_noise(noise, tau, []),
        )
    )


def _cue(model: Model, name: str, noise: float) -> Handle:
    """Add the node of a cue, and the input of the user to it."""
    node = _node(model, name, NODE_TAU, -1.2, 2.4, noise)
    model.add(Boost(f"say {name}", [], 0.0)) >> node
    return node
