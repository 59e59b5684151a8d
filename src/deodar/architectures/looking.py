"""Looking: an event camera on a pan-tilt unit learns where to turn to have a blinking target in its centre.

Events drive a perceptual field. Its peak is stored by the visual intention field, which drives the motor
intention field through a map of four dimensions, random at the start. The peak there is the attractor of the
servo motors, as a shift of the gaze. Nodes of the condition of satisfaction (CoS) detect the arrival and end
both intentions. In between a match field, pre-shaped at the centre of the retina, detects that the target is
there, and so permits learning.

Two mechanisms of learning:

* `paper`: the map learns the motor intention while the match field has a peak.
* `correcting`, beyond the paper: after the arrival a correction field reads a second map, taught like the
  first, at the place where the target is now. Its peak is the shift by which the gaze missed, as far as the
  map knows it. The sum of the executed shift and the correction is the lesson. In the centre the match field
  inhibits the correction, and the executed shift itself is the lesson.

Reference:
    Sandamirskaya (2014), Dynamic neural fields as a step toward cognitive neuromorphic architectures, Front.
    Neurosci. 7:276, section 3, eqs. 9, 12 and 14 to 16. The paper prints no parameters: all values here are
    deodar's, found with separate prototypes.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from deodar.architectures._noise import strength as strength_of_noise
from deodar.couplings.arithmetic import Envelope, Gain, Pointwise, Product, Sigmoid, Sum
from deodar.couplings.convolutions import Convolve, SteeredShift
from deodar.couplings.hebbian import Hebbian
from deodar.couplings.learning import RewardGate
from deodar.couplings.positions import RateCode
from deodar.couplings.projections import Project
from deodar.couplings.weights import Weights
from deodar.elements.field import Field
from deodar.elements.stimuli import Boost, GaussianStimulus
from deodar.elements.variables import Integrator
from deodar.elements.world_ports import Motor, Sensor
from deodar.errors import ParameterError, did_you_mean
from deodar.model.model import Handle, Model
from deodar.numerics.axes import Axis
from deodar.numerics.kernels.separable import Gaussian
from deodar.numerics.sigmoids import Absolute, Logistic
from deodar.parameters import ArrayLike


@dataclass(frozen=True)
class Mechanism:
    """The parameters of a mechanism of learning that differ between them.

    Attributes:
        reward: rate of learning for each active sample of the match field; `correcting` weights them by a
            Gaussian.
        preshape: width of the pre-shape of the match field, pixels.
        vision: integral and width (pixels) of the kernel of the visual intention.
        wandering: correlation length of the noise that explores, servo units.
        quadrature: quadrature of all fields.
    """

    reward: float
    preshape: float
    vision: tuple[float, float]
    wandering: float
    quadrature: str


MECHANISMS = {
    "correcting": Mechanism(0.6, 4.0, (40.0, 8.0), 64.0, "cell-0.1"),
    "paper": Mechanism(0.15, 6.0, (30.0, 6.0), 40.0, "point"),
}
"""Both mechanisms. With `point` the peaks of steep sigmoids stick to samples, and corrections of less than a
sample are lost. The paper's mechanism learns from rewards alone, and keeps what was rewarded once. Its
pre-shape is wide, so that rewards are frequent, and its visual peak small and sharp, so that fewer neighbours
of a place learn what belongs to it: found with tuning seeds, not derived.
"""

PIXELS = 128
"""Columns and rows of the event camera."""

PIXEL_AREA, SERVO_AREA = 16.0, 900.0
"""Area of a sample of 4 x 4 pixels and of 30 x 30 servo units, for which the parameters were found."""

REACH = 360.0
"""Largest shift of the gaze along pan and tilt, servo units."""

SAMPLES = (32, 25)
"""Samples of the visual and of the motor fields along each axis."""

TAU, STEEP, REST = 40.0, 4.0, -5.0
"""Time constant of the fields, ms, slope of their sigmoid, and resting level."""

STILL = 0.07
"""Standard deviation of the noise of a field without interaction, the same at every resolution."""

EVENTS_TAU, EVENTS_GAIN, MOST_INPUT = 60.0, 0.22, 9.0
"""Leak of the event rate, ms; activation for one event per pixel and second; largest input."""

DRIVE, CORRECTION, HALF_DRIVE = 6.0, 12.0, 0.2
"""Largest input of the map to the motor field and to the correction field, and the reading of the map at
which the input is half of that.
"""

BOOST, EXPLORATION, EXPLORATION_TAU = 4.3, 0.6, 300.0
"""Boost of the motor field by a visual intention; standard deviation and time constant (ms) of the noise that
explores.
"""

APPROACH, MEMORY_OF_POSE = 900.0, 60.0
"""Time constant of the shift for a motor peak of one sample, and of the memory of the pose, ms."""

LEARNING_TAU = 400.0
"""Time constant of learning for a reward or lesson of 1, ms."""

LESSON = 4.0
"""Rate of learning from a lesson."""

MATCHED = 0.5
"""Active samples of the match field above which the paper's mechanism is rewarded."""

MATCH_INHIBITS = 8.0
"""Inhibition of the correction field by each active sample of the match field, up to four of them."""

SHARE, LARGEST = 0.1, 0.15
"""Share of the connected weights at the start, and the largest of them."""


def retina(samples: int = SAMPLES[0]) -> tuple[Axis, Axis]:
    """Return the axes of the visual fields: columns and rows in pixels, samples in the middle of cells."""
    edge = PIXELS / samples / 2 - 0.5
    column, row = (Axis(name, edge, PIXELS - 1 - edge, samples, unit="px") for name in ("column", "row"))
    return column, row


def shifts(samples: int = SAMPLES[1]) -> tuple[Axis, Axis]:
    """Return the axes of the motor fields: shifts of the gaze along pan and tilt, in servo units."""
    pan, tilt = (Axis(name, -REACH, REACH, samples, unit="servo") for name in ("pan", "tilt"))
    return pan, tilt


def looking(
    mechanism: str = "correcting",
    samples: Sequence[int] = SAMPLES,
    seed: int = 0,
    weights: ArrayLike | None = None,
    learns: bool = True,
    reward: bool = True,
    memory: bool = True,
) -> Model:
    """Create the architecture; it needs the world `dd.Eye`.

    Args:
        mechanism: `correcting` or `paper`.
        samples: samples of the visual and of the motor fields along each of their axes.
        seed: seed of the map at the start.
        weights: the map, with samples of pan, tilt, column and row; None: random and sparse.
        learns: whether the map changes; False needs weights.
        reward: whether learning waits for the reward; False, with the mechanism `paper`, learns whatever the
            gaze did, as a control.
        memory: whether the map learns the visual intention, which remembers where the target was; False, with
            the mechanism `paper`, learns what the perceptual field sees at the same time, as a control.
    """
    if mechanism not in MECHANISMS:
        raise ParameterError(f"mechanism is {mechanism!r}", fix=did_you_mean(mechanism, MECHANISMS))
    if not learns and weights is None:
        raise ParameterError("learns is False and weights is None", fix="Give the map: weights=...")
    model = Model("looking", dt=10.0)
    model.describe(notes="Sandamirskaya (2014), section 3: an architecture for looking")
    built = _Looking(model, mechanism, retina(samples[0]), shifts(samples[1]))
    built.visual()
    built.map(weights, learns, seed, memory)
    built.motor()
    built.satisfaction()
    if learns:
        built.match()
        if mechanism == "paper":
            built.paper(reward)
        else:
            built.correcting()
    return model


class _Looking:
    """The architecture while it is built: a method for each part, in the order of the signals."""

    def __init__(
        self, model: Model, mechanism: str, plane: tuple[Axis, Axis], motions: tuple[Axis, Axis]
    ) -> None:
        self.model, self.mechanism = model, mechanism
        self.plane, self.motions = list(plane), list(motions)
        self.both = [Axis("component", 0, 1, 2)]
        self.own = MECHANISMS[mechanism]

    # ------------------------------------------------------------------------------------------------ seeing

    def visual(self) -> None:
        """Add the camera, the perceptual field and the visual intention."""
        model = self.model
        camera = model.add(Sensor("events", self.plane, sensor="events"))
        trace = model.add(
            Field("event rate", self.plane, tau=EVENTS_TAU, resting_level=0.0, quadrature=self.own.quadrature)
        )
        blur = model.add(Convolve([Gaussian(EVENTS_GAIN, 4.0, normalized=True)], name="blur"))
        limit = model.add(Envelope("lower", name="limit"))
        self.perceptual = self.field("perceptual", self.plane, 20.0, 6.0, 0.40)
        camera >> trace
        trace["activation"] >> blur >> limit >> self.perceptual
        model.add(Boost("most input", [], MOST_INPUT)) >> limit["other"]
        self.vision = self.field("visual intention", self.plane, *self.own.vision, 0.40)
        self.seen = self.size("visual peak", self.vision, PIXEL_AREA, 6.0, 1.0)

    # ------------------------------------------------------------------------------------------------ moving

    def map(self, weights: ArrayLike | None, learns: bool, seed: int, memory: bool) -> None:
        """Add the map from the visual intention to the motor intention."""
        if learns:
            self.transformation = self.model.add(self.adaptive("map", weights, seed, not memory))
            if not memory:
                self.perceptual >> self.transformation["pre"]
        else:
            assert weights is not None
            self.transformation = self.model.add(Weights(weights, self.motions, name="map"))
        self.given, self.seed = weights, seed

    def motor(self) -> None:
        """Add the motor intention, the exploration, and the dynamics of the gaze (eq. 9)."""
        model = self.model
        self.intention = self.field("motor intention", self.motions, 20.0, 45.0, 0.40)
        self.vision >> self.transformation
        known = self.saturated("known", self.transformation)
        known >> self.gain(DRIVE, "drive") >> self.intention

        # a visual intention brings the motor field near its threshold; noise decides where the map is silent
        noise = EXPLORATION * np.sqrt(2 * EXPLORATION_TAU)
        wandering = model.add(
            Field(
                "exploration",
                self.motions,
                tau=EXPLORATION_TAU,
                resting_level=0.0,
                noise=float(noise),
                noise_length=self.own.wandering,
                quadrature=self.own.quadrature,
            )
        )
        level = model.add(Sum(name="level"))
        model.add(Boost("boost", [], BOOST)) >> level
        if self.mechanism == "correcting":  # no noise where the map knows the answer
            unknown = model.add(Sum(name="unknown"))
            model.add(Boost("one", [], 1.0)) >> unknown
            known >> self.gain(-1.0, "less what is known") >> unknown
            explored = model.add(Product(name="explored"))
            wandering["activation"] >> explored
            unknown >> explored["factor"]
            explored >> level
        else:
            wandering["activation"] >> level
        released = model.add(Product(name="released"))
        level >> released
        self.seen >> released["factor"]
        released >> self.intention

        # eq. 9 for a shift of the gaze; while there is no motor peak, the pose takes the shift over
        self.moving = self.size("motor peak", self.intention, SERVO_AREA, 6.0, 1.0)
        resting = model.add(Sum(name="no motor peak"))
        model.add(Boost("always", [], 1.0)) >> resting
        self.moving >> self.gain(-1.0, "less the motor peak") >> resting
        self.target = model.add(RateCode(self.motions, least=SERVO_AREA / 2, name="peak position"))
        self.intention >> self.target
        pose = model.add(Sensor("pose", self.both, sensor="pose"))
        self.shift = model.add(Integrator("shift", self.both, rate=1.0))
        remembered = model.add(Integrator("remembered pose", self.both, rate=1.0, initial=1000.0))
        ahead = self.difference("ahead", self.target, self.shift)
        towards = model.add(Product(name="towards the peak"))
        ahead >> towards
        self.target["strength"] >> towards["factor"]
        towards >> self.gain(1 / (APPROACH * SERVO_AREA), "approach") >> self.shift
        left = model.add(Product(name="shift that is left"))
        self.shift >> left
        resting >> left["factor"]
        left >> self.gain(-1 / MEMORY_OF_POSE, "release") >> self.shift
        moved = self.difference("moved", pose, remembered)
        adopted = model.add(Product(name="adopted"))
        moved >> adopted
        resting >> adopted["factor"]
        adopted >> self.gain(1 / MEMORY_OF_POSE, "adoption") >> remembered
        command = model.add(Sum(name="command"))
        remembered >> command
        self.shift >> command
        for k, name in enumerate(("pan", "tilt")):
            command >> self.component(k, f"{name} command") >> model.add(Motor(name, [], motor=name))

        # the visual intention gets no input during the movement, in which the target moves on the retina
        still = self.size("movement", self.intention, SERVO_AREA, 4.0, 2.0)
        open_ = model.add(Sum(name="at rest"))
        model.add(Boost("input open", [], 1.0)) >> open_
        still >> self.gain(-1.0, "less the movement") >> open_
        admitted = model.add(Product(name="admitted"))
        self.perceptual >> admitted
        open_ >> admitted["factor"]
        admitted >> self.gain(6.0, "seen") >> self.vision

    def satisfaction(self) -> None:
        """Add the nodes of the condition of satisfaction (eq. 14)."""
        model = self.model
        off = self.difference("off the attractor", self.target, self.shift)
        distance = model.add(Pointwise("abs", name="distance"))
        near = model.add(Sigmoid(Logistic(6.0, threshold=-0.5), name="near"))
        off >> distance >> self.gain(-1 / np.sqrt(SERVO_AREA), "in samples") >> near
        self.satisfied = model.add(
            Field(
                "satisfied",
                [],
                tau=250.0,
                resting_level=REST,
                sigmoid=Logistic(STEEP),
                kernel=[Gaussian(3.0)],
            )
        )
        self.arrived = model.add(Product(name="arrived"))
        for k, name in enumerate(("pan", "tilt")):
            node = model.add(
                Field(
                    f"{name} arrived",
                    [],
                    tau=120.0,
                    resting_level=REST,
                    sigmoid=Logistic(STEEP),
                    kernel=[Gaussian(0.5)],
                )
            )
            self.moving >> self.gain(3.0, f"{name} moves") >> node
            near >> self.component(k, f"{name} near") >> self.gain(3.0, f"{name} is near") >> node
            node >> self.gain(3.5, f"{name} done") >> self.satisfied
            node >> self.arrived["input" if k == 0 else "factor"]
        ends = self.gain(-25.0, "ends")
        self.satisfied >> ends
        ends >> self.vision
        ends >> self.intention

    # ---------------------------------------------------------------------------------------------- learning

    def match(self) -> None:
        """Add the match field (eq. 15)."""
        centre, width = (PIXELS - 1) / 2, self.own.preshape
        self.matching = self.field("match", self.plane, 2.0, 4.0, 0.05)
        self.perceptual >> self.gain(4.0, "match input") >> self.matching
        bell = self.model.add(
            GaussianStimulus("centre", self.plane, center=[centre] * 2, sigma=width, amplitude=1.0)
        )
        expected = self.model.add(Product(name="expected"))
        bell >> expected
        area = self.model.add(Project([], name="visual area"))
        self.vision >> area >> self.gain(0.12 / PIXEL_AREA, "expectation") >> expected["factor"]
        expected >> self.matching

    def paper(self, reward: bool) -> None:
        """Learn the motor intention while the match field has a peak (eqs. 12 and 16)."""
        model = self.model
        self.intention >> self.transformation["post"]
        if not reward:
            self.moving >> self.transformation["gate"]
            return
        gate = model.add(
            RewardGate(
                threshold=MATCHED * PIXEL_AREA,
                strength=self.own.reward / PIXEL_AREA,
                graded=True,
                gated=True,
                name="reward",
            )
        )
        self.matching >> gate
        self.arrived >> gate["gate"]
        gate >> self.transformation["gate"]

    def correcting(self) -> None:
        """Learn the sum of the executed shift and of the correction that the map proposes after it."""
        model = self.model
        # the reward: matches near the centre
        bell = model.add(
            GaussianStimulus(
                "very centre", self.plane, center=[(PIXELS - 1) / 2] * 2, sigma=4.0, amplitude=1.0
            )
        )
        central = model.add(Product(name="central match"))
        self.matching >> central
        bell >> central["factor"]
        reward = model.add(Project([], name="match at the centre"))
        amount = self.gain(1 / PIXEL_AREA, "matching samples")
        central >> reward >> amount

        # the correction
        after = model.add(Product(name="after the movement"))
        self.arrived >> after
        self.moving >> after["factor"]
        again = model.add(self.adaptive("map read again", self.given, self.seed, True))
        self.perceptual >> again
        self.vision >> again["pre"]
        proposal = model.add(Product(name="proposal"))
        self.saturated("proposed", again) >> proposal
        after >> proposal["factor"]
        correction = self.field("correction", self.motions, 20.0, 45.0, 0.40)
        proposal >> self.gain(CORRECTION, "proposal strength") >> correction
        before = model.add(Sum(name="not arrived"))
        model.add(Boost("closed", [], -6.0)) >> before
        after >> self.gain(6.0, "opening") >> before
        before >> correction
        area = model.add(Project([], name="match area"))
        limited = model.add(Envelope("lower", name="largest match"))
        self.matching >> area >> self.gain(1 / PIXEL_AREA, "matches") >> limited
        model.add(Boost("four samples", [], 4.0)) >> limited["other"]
        limited >> self.gain(-MATCH_INHIBITS, "match inhibits") >> correction
        corrects = self.size("correction peak", correction, SERVO_AREA, 4.0, 2.0)

        # the sum of both shifts, or the executed one alone if the target is in the centre
        by = model.add(RateCode(self.motions, least=SERVO_AREA / 2, name="correction position"))
        correction >> by
        moved = model.add(SteeredShift(["pan", "tilt"], name="executed and corrected"))
        self.intention >> moved
        by >> moved["by"]
        summed = model.add(Product(name="corrected"))
        moved >> summed
        corrects >> summed["factor"]
        lesson = self.field("lesson", self.motions, 0.0, 45.0, 0.0, noise=0.0)
        strength = self.gain(9.0, "lesson input")
        summed >> strength >> lesson
        confirmed = model.add(Product(name="confirmed"))
        self.intention >> confirmed
        rewarded = model.add(Sigmoid(Logistic(8.0, threshold=0.3), name="rewarded"))
        amount >> rewarded >> confirmed["factor"]
        confirmed >> strength

        gate = model.add(Product(name="learning"))
        corrects >> self.gain(LESSON, "lesson strength") >> gate
        amount >> self.gain(self.own.reward, "reward strength") >> gate
        after >> gate["factor"]
        for coupling in (self.transformation, again):
            lesson >> coupling["post"]
            gate >> coupling["gate"]

    # ------------------------------------------------------------------------------------------------- parts

    def field(
        self,
        name: str,
        axes: list[Axis],
        excitation: float,
        width: float,
        inhibition: float,
        noise: float = STILL,
    ) -> Handle:
        """Add a field.

        Args:
            name: its name.
            axes: its axes.
            excitation: integral of its kernel.
            width: of its kernel, axis units.
            inhibition: global inhibition for each active sample of the reference sampling.
            noise: standard deviation without interaction.
        """
        area = PIXEL_AREA if axes == self.plane else SERVO_AREA
        return self.model.add(
            Field(
                name,
                axes,
                tau=TAU,
                resting_level=REST,
                sigmoid=Logistic(STEEP),
                kernel=[Gaussian(excitation, width, normalized=True)] if excitation else [],
                global_inhibition=inhibition / area,
                noise=strength_of_noise(noise, TAU, axes),
                quadrature=self.own.quadrature,
            )
        )

    def adaptive(self, name: str, weights: ArrayLike | None, seed: int, apart: bool) -> Hebbian:
        """Return a map that learns (eq. 12); with `apart` it learns another signal than it reads."""
        return Hebbian(
            self.motions,
            rule="association",
            rate=1 / LEARNING_TAU,
            gated=True,
            apart=apart,
            initial=LARGEST,
            random=True,
            share=SHARE,
            patches=25,
            seed=seed,
            start=weights,
            name=name,
        )

    def gain(self, factor: float, name: str) -> Handle:
        return self.model.add(Gain(float(factor), name=name))

    def component(self, k: int, name: str) -> Handle:
        """Add a coupling that picks one of two components."""
        return self.model.add(Weights(np.eye(2)[k], [], name=name))

    def difference(self, name: str, one: Handle, other: Handle) -> Handle:
        """Add the difference of two signals."""
        found = self.model.add(Sum(name=name))
        one >> found
        other >> self.gain(-1.0, f"{name}, less") >> found
        return found

    def size(self, name: str, field: Handle, area: float, threshold: float, steep: float) -> Handle:
        """Add a signal that is 1 while a field's peak covers more than some samples, else 0."""
        whole = self.model.add(Project([], name=f"{name} area"))
        found = self.model.add(Sigmoid(Logistic(steep, threshold=threshold), name=name))
        field >> whole >> self.gain(1 / area, f"{name} in samples") >> found
        return found

    def saturated(self, name: str, source: Handle) -> Handle:
        """Add a saturating reading of a map: I / (I + HALF_DRIVE), I being its mean over 16 samples."""
        found = self.model.add(Sum(name=name))
        curve = self.model.add(Sigmoid(Absolute(1.0 / HALF_DRIVE), name=f"{name}, curve"))
        source >> self.gain(1 / (16 * PIXEL_AREA), f"{name}, mean") >> curve
        curve >> self.gain(2.0, f"{name}, twice") >> found
        self.model.add(Boost(f"{name}, offset", [], -1.0)) >> found
        return found
