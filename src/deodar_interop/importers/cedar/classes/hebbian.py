"""HebbianConnection: weights that are learned, and read after they have changed."""

from __future__ import annotations

import dataclasses as dc
import math

import numpy as np

from deodar.couplings.learning import AdaptiveWeights, RewardGate
from deodar.numerics.sigmoids import Linear, SigmoidFunction, Step
from deodar_interop.importers._piece import Unfit
from deodar_interop.importers.cedar.composition import SourceStep, StepSignal, step
from deodar_interop.importers.cedar.grid import Counts
from deodar_interop.importers.cedar.transfer import sigmoid, transferred

MOST_WEIGHTS = 4_000_000

LEARNS = 2
"""Largest number of dimensions of source and target together with which cedar learns by Oja's rule."""

BCM = (
    "the size of the weights of its BCM rule, what they are read by, and the threshold at the start are not"
    " documented"
)


@step("cedar.dynamics.HebbianConnection", sized=True, looped=True)
def hebbian(s: SourceStep) -> None:
    """Translate HebbianConnection with Oja's rule; w are the weights, F a factor of the time scales.

    Source of one number: dw = F rate f(source) g(reward) (h(target) - w), output w f(source). Target of one
    number: source and target exchanged, output sum w f(source). Two lines: dw = F rate (f(source) h(target) -
    w) while rewarded, output sum w source. The weights are read after they have changed.
    """
    if s.values.word("learning rule", "Oja's Rule", ("Oja's Rule", "BCM Rule")) != "Oja's Rule":
        raise Unfit(BCM)
    source, target = _size(s, "source", 1), _size(s, "target", 2)
    if math.prod((*source, *target)) > MOST_WEIGHTS:
        raise Unfit(f"it has more than {MOST_WEIGHTS} weights")
    if source and target and len((*source, *target)) > LEARNS:
        raise Unfit(f"what it gives for {len(source)} by {len(target)} dimensions is not documented")
    _Connection(s, source, target).translate()


def _size(s: SourceStep, side: str, dimensions: int) -> Counts:
    count = s.values.whole(f"{side} dimension", dimensions, 0, 3)
    return tuple(int(n) for n in s.values.numbers(f"{side} sizes", 50, count, 1, 1e6))


class _Connection:
    """The translation of one step: `AdaptiveWeights` over the axes of the source, then those of the target.

    Its input is the activity of the side of one number, or 1 between lines, and its `post` is what the
    weights relax towards.
    """

    def __init__(self, s: SourceStep, source: Counts, target: Counts) -> None:
        self.s = s
        self.source, self.target = source, target
        self.axes = s.axes((*source, *target))
        self.doubts: list[str] = []

    def translate(self) -> None:
        """Add the elements."""
        s, source = self.s, self.slot("source node", self.source)
        f = self.activity("f", "source", source, Step(0.5))
        h = self.activity("h", "target", self.slot("target field", self.target), Linear(1.0))
        g = self.gate(self.activity("g", "reward", self.slot("reward signal", ()), Step(0.5)))
        lines = bool(self.source and self.target)
        if lines:
            f, h = self.along(f, "f over all", 0), self.along(h, "h over all", 1)
            side, goal = s.constant("one", 1.0), s.product("f times h", f, h)
        elif self.source:
            side, goal = h, f
        else:
            side, goal = f, h
        rate, rise, fall = self.speeds()
        initial, start = self.start()
        weights = AdaptiveWeights(self.axes, rate, initial, gated=True, start=start, name=s.label)
        old = dc.replace(s.add(weights), port="weights")
        if rise != fall:
            goal = self.slowed(goal, h, old, rise, fall)
        for port, signal in (("input", side), ("post", goal), ("gate", g)):
            s.connect(signal, old, port)
        seen = self.along(source, "source over all", 0) if lines else f
        read = s.product("weighted", *((seen, old.updated) if self.source else (old.updated, seen)))
        if self.source:
            target_axes = s.axes(self.target)
            read = s.projected("output", read, target_axes, [*(None for _ in self.source), *target_axes])
        s.outlet("learned output", read)
        s.outlet(
            "weighted input",
            read,
            doubt="what cedar gives here is not documented; the learned output is used",
        )
        why = "; ".join(("AdaptiveWeights, read after they have changed", *self.doubts))
        s.explain(why, "approximated" if self.doubts else "carried")

    def slot(self, name: str, dims: Counts) -> StepSignal:
        """Return an input slot; 0 if nothing is connected to it."""
        signal = self.s.optional(name, dims)
        return self.s.constant(f"no {name}", 0.0, self.s.axes(dims)) if signal is None else signal

    def activity(self, letter: str, side: str, signal: StepSignal, default: SigmoidFunction) -> StepSignal:
        """Add a function of a side or of the reward."""
        name = f"{letter} ({side} sigmoid)"
        if letter == "g" and not isinstance(sigmoid(self.s.values, name, default), Step):
            if self.source and self.target:
                self.doubts.append("how a reward between 0 and 1 acts on two lines is not documented")
            elif self.s.values.flag("fixed reward duration", False):
                self.doubts.append("what begins the reward duration is documented for the Heaviside only")
        return transferred(self.s, f"{letter} of {side}", name, default, signal)

    def along(self, signal: StepSignal, role: str, d: int) -> StepSignal:
        """Add the value of one side at all weights."""
        return self.s.projected(role, signal, self.axes, [self.axes[d]])

    def gate(self, reward: StepSignal) -> StepSignal:
        """Return what opens the gate; with a fixed duration the reward's beginning counts as a step of it."""
        s = self.s
        duration = s.values.time("reward duration", 200.0)
        if not s.values.flag("fixed reward duration", False):
            if "reward duration" in s.values.body:
                s.values.say("reward duration", "carried", "without effect")
            return reward
        steps = math.ceil(duration / s.dt - 1e-9) - 1
        if steps < 1:
            return s.constant("no reward window", 0.0)
        return s.add(RewardGate(0.5, steps * s.dt, name=s.named("reward window")), input=reward)

    def speeds(self) -> tuple[float, float, float]:
        """Return the rate of the weights, and the shares of it where the target is 1 and where it is 0."""
        values, dt = self.s.values, self.s.dt
        rate = values.number("learning rate", 0.01, 0.0)
        tau, decay = values.time("time scale", 0.0), values.time("time scale decay", 0.0)
        missing = [s for s in ("source node", "target field", "reward signal") if s not in self.s.ins]
        if missing:
            if "source node" in missing:
                self.doubts.append("what cedar gives without a source is not documented; it is 0 here")
            values.say("learning rate", "carried", f"0: cedar learns nothing without {missing[0]!r}")
            return 0.0, 1.0, 1.0
        if len(self.axes) > LEARNS:
            values.say("learning rate", "carried", f"0: cedar learns up to {LEARNS} dimensions")
            return 0.0, 1.0, 1.0
        if not self.source and not self.target:
            self.doubts.append("which side gates learning between two numbers is not documented")
        if not tau:
            values.say(
                "learning rate", "carried", f"divided by the step of {dt:g} ms, since cedar's is per step"
            )
            if decay:
                values.say(
                    "time scale decay", "carried", "without effect, since there is no other time scale"
                )
            return self.limited(rate / dt), 1.0, 1.0
        if not decay:
            return self.limited(rate / tau), 1.0, 1.0
        if self.source and not self.target:
            self.doubts.append("which side the two time scales follow is documented for the target only")
        fastest = min(tau, decay)
        return self.limited(rate / fastest), fastest / tau, fastest / decay

    def limited(self, rate: float) -> float:
        """Return a rate that is stable, with a report line."""
        most = 1 / self.s.dt
        if rate > most:
            self.s.values.say(
                "learning rate", "approximated", "weights change by all of the difference at most"
            )
        return min(rate, most)

    def slowed(
        self, goal: StepSignal, h: StepSignal, old: StepSignal, rise: float, fall: float
    ) -> StepSignal:
        """Return a goal towards which the weights change as they do with two time scales: w + share (goal -
        w), share = rise h + fall (1 - h).
        """
        s = self.s
        share = s.total("share", s.gain("share of h", rise - fall, h), s.constant("share of the rest", fall))
        difference = s.total("to go", goal, s.gain("minus weights", -1.0, old))
        return s.total("slowed goal", old, s.product("part of the way", difference, share))

    def start(self) -> tuple[float, np.ndarray | None]:
        """Return all weights at the start, or each of them, source samples first."""
        values, shape = self.s.values, (*self.source, *self.target)
        stored = self.s.stored("weights", shape)
        if stored is not None:
            for name in values.body:
                if name.startswith(("weight ", "manual ")):
                    values.say(name, "carried", "without effect beside weights that are stored")
            return 0.0, stored
        if values.flag("manual weights", False):
            for name in ("weight init value", "weight init noise"):
                if name in values.body:
                    values.say(name, "carried", "without effect beside weights that are given")
            count = len(shape)
            centers = values.numbers("weight centers", 3.0, count)
            sigmas = values.numbers("weight sigmas", 3.0, count, 1e-6)
            out = np.full(shape, values.number("weight amplitude", 6.0))
            for d, (n, c, s) in enumerate(zip(shape, centers, sigmas, strict=True)):
                distance = abs(np.arange(n) - c)
                part = np.exp(-0.5 * (np.minimum(distance, n - distance) / s) ** 2)
                out = out * part.reshape([-1 if k == d else 1 for k in range(count)])
            return (0.0, out) if shape else (float(out), None)
        level, noise = values.number("weight init value", 0.0), values.number("weight init noise", 0.001)
        if noise != level and noise:
            why = "weights begin at the initial value, without noise"
            values.say("weight init noise", "approximated", why)
        return level, None
