"""Right-hand sides of banks of oscillators: the change of a state that NumericalIntegration integrates.

A state has two rows and a column for each oscillator; that of one oscillator has two samples.
"""

from __future__ import annotations

import numpy as np

from deodar.numerics.axes import Axis
from deodar_interop.importers._piece import Unfit
from deodar_interop.importers.cedar.composition import SourceStep, StepSignal, step

MOST = 1000
"""Largest number of oscillators of a bank (a guess)."""

ROW = Axis("row", 0, 1, 1, periodic=True)


class _Bank:
    """A step with the rows of its state, and its parameters as numbers or inputs."""

    def __init__(self, s: SourceStep) -> None:
        self.s = s
        self.count = s.values.whole("bank size", 1, 1, MOST)
        self.is_single = self.count == 1
        self.columns = s.axes(() if self.is_single else (self.count,))
        if "initial state (optional)" in s.ins:
            raise Unfit("what its initial state changes is not documented; connect it to the integration")
        if "initialize on reset" in s.values.body:
            s.values.say("initialize on reset", "carried", "without effect without an initial state")
        self.state = s.slot("state", (2,) if self.is_single else (2, self.count))

    def row(self, k: int, role: str) -> StepSignal:
        """Return a row of the state, a sample for each oscillator."""
        s, chosen = self.s, np.eye(2)[k : k + 1]
        if self.is_single:
            return s.weighted(role, chosen[0], (), self.state)
        alone = s.turned(f"row of {role}", chosen, ROW, self.state, 0)
        return s.projected(role, alone, self.columns, [None, *self.columns])

    def optional(self, slot: str) -> StepSignal | None:
        """Return what arrives at a slot, one number or one for each oscillator; None without it."""
        slot = f"{slot} (optional)"
        signal = self.s.optional(slot)
        if signal is not None and signal.dims not in ((), tuple(axis.samples for axis in self.columns)):
            raise Unfit(f"{slot!r} has the size {list(signal.dims)} for {self.count} oscillators")
        return signal

    def factor(self, name: str, slot: str) -> float | StepSignal:
        """Return a parameter: a number, or what arrives at its slot."""
        number, signal = self.s.values.number(f"bank {name}", 1.0), self.optional(f"{slot} (bank)")
        return number if signal is None else signal

    def times(self, role: str, factor: float | StepSignal, signal: StepSignal, by: float = 1.0) -> StepSignal:
        """Return a multiple of a row."""
        if not isinstance(factor, StepSignal):
            return self.s.gain(role, by * factor, signal)
        product = self.s.product(role, signal, factor)
        return product if by == 1 else self.s.gain(f"{role} by {by:g}", by, product)

    def change(self, *rows: StepSignal) -> StepSignal:
        """Return the state with the change of each row."""
        s, axes, parts = self.s, self.state.axes, list[StepSignal]()
        for k, (signal, row) in enumerate(zip(rows, ("first", "second"), strict=True)):
            if self.is_single:
                parts.append(s.weighted(f"{row} row", np.eye(2)[k], axes, signal))
            else:
                wide = s.projected(f"{row} as a row", signal, (ROW, axes[1]), [axes[1]])
                parts.append(s.turned(f"{row} row", np.eye(2)[:, k : k + 1], axes[0], wide, 0))
        return s.total("", *parts)


ROWS = "Product and Sum of the rows"


@step("cedar.processing.steps.HopfOscillatorRHS", gives="state change", why=ROWS, sized=True)
def hopf(s: SourceStep) -> StepSignal:
    """Translate HopfOscillatorRHS: u' = alpha u - omega v - gamma r^2 u, v' = alpha v + omega u - gamma r^2
    v.
    """
    if s.values.number("shift u by radius fraction", 0.0):
        raise Unfit("the shift of u by a fraction of the radius is not documented")
    bank = _Bank(s)
    u, v = bank.row(0, "u"), bank.row(1, "v")
    alpha, omega, gamma = (bank.factor(name, f"{name}s") for name in ("alpha", "omega", "gamma"))
    squares = s.function("u squared", "square", u), s.function("v squared", "square", v)
    pull = bank.times("pull", gamma, s.total("radius squared", *squares), -1.0)
    grown, turned = bank.times("alpha u", alpha, u), bank.times("omega v", omega, v, -1.0)
    first = s.total("change of u", grown, turned, s.product("pull of u", u, pull))
    grown, turned = bank.times("alpha v", alpha, v), bank.times("omega u", omega, u)
    return bank.change(first, s.total("change of v", grown, turned, s.product("pull of v", v, pull)))


@step("cedar.processing.steps.HarmonicOscillatorRHS", gives="state change", sized=True)
def harmonic(s: SourceStep) -> StepSignal:
    """Translate HarmonicOscillatorRHS: x' = v, v' = -stiffness (x - shift) - damping v."""
    bank = _Bank(s)
    x, v = bank.row(0, "x"), bank.row(1, "v")
    stiffness, shift = bank.factor("stiffness", "stiffnesss"), bank.optional("shift")
    distance = x if shift is None else s.total("distance", x, s.gain("minus shift", -1.0, shift))
    if not s.values.flag("force critically damped", False):
        damping = bank.factor("damping", "damping")
    elif not isinstance(stiffness, StepSignal):
        damping = 2 * max(stiffness, 0.0) ** 0.5
    else:
        damping = s.gain("critical damping", 2.0, s.function("root of stiffness", "root", stiffness))
    doubt = "cedar's equation is not documented, that of a damped spring and a mass of 1 is used"
    s.explain(f"{ROWS}; {doubt}", "approximated")
    pull, drag = bank.times("pull", stiffness, distance, -1.0), bank.times("drag", damping, v, -1.0)
    return bank.change(v, s.total("force", pull, drag))
