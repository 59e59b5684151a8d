"""Right-hand sides of banks of oscillators: the change of a state that NumericalIntegration integrates.

A state has two rows and a column for each oscillator; that of one oscillator has two samples.
"""

from __future__ import annotations

import numpy as np

from deodar.couplings.axis_weights import AxisWeights
from deodar.couplings.project import Project
from deodar.couplings.weights import Weights
from deodar.numerics.axes import Axis
from deodar_interop.importers._piece import Unfit
from deodar_interop.importers.cedar.composition import Composition, StepSignal
from deodar_interop.importers.cedar.piece import SourceStep, StepPiece

MOST = 1000
"""Largest number of oscillators of a bank (a guess)."""

ROW = Axis("row", 0, 1, 1, periodic=True)


class _Bank:
    """A step with the rows of its state, and its parameters as numbers or inputs."""

    def __init__(self, b: SourceStep) -> None:
        self.b, self.c = b, Composition(b)
        self.count = b.values.whole("bank size", 1, 1, MOST)
        self.is_single = self.count == 1
        self.dims = (2,) if self.is_single else (2, self.count)
        self.columns = () if self.is_single else (self.count,)
        if "initial state (optional)" in b.ins:
            raise Unfit("what its initial state changes is not documented; connect it to the integration")
        if "initialize on reset" in b.values.body:
            b.values.say("initialize on reset", "carried", "without effect without an initial state")
        self.state = self.c.slot("state", self.dims)

    def row(self, k: int, role: str) -> StepSignal:
        """Return a row of the state, a sample for each oscillator."""
        c, axes, chosen = self.c, self.b.axes(self.dims), np.eye(2)[k : k + 1]
        if self.is_single:
            return c.add(Weights(chosen[0], (), name=c.named(role)), input=self.state)
        alone = AxisWeights(chosen, ROW, axes[0].name, name=c.named(f"row of {role}"))
        columns = self.b.axes(self.columns)
        return c.projected(role, c.add(alone, input=self.state), (ROW, axes[1]), columns, [None, columns[0]])

    def factor(self, name: str, slot: str) -> float | StepSignal:
        """Return a parameter: a number, or what arrives at its slot."""
        slot = f"{slot} (optional)"
        number = self.b.values.number(f"bank {name}", 1.0)
        if slot not in self.b.ins:
            return number
        if self.b.first(slot) not in ((), self.columns):
            raise Unfit(f"{slot!r} has the size {list(self.b.first(slot))} for {self.count} oscillators")
        return self.c.slot(slot, optional=True)

    def times(self, role: str, factor: float | StepSignal, signal: StepSignal, by: float = 1.0) -> StepSignal:
        """Return a multiple of a row."""
        if not isinstance(factor, StepSignal):
            return self.c.gain(role, by * factor, signal)
        product = self.c.product(role, signal, factor)
        return product if by == 1 else self.c.gain(f"{role} by {by:g}", by, product)

    def result(self, rows: tuple[StepSignal, StepSignal], why: str, doubt: str = "") -> StepPiece:
        """Return the translation with the change of each row."""
        c, axes, parts = self.c, self.b.axes(self.dims), list[StepSignal]()
        for k, (signal, row) in enumerate(zip(rows, ("first", "second"), strict=True)):
            if self.is_single:
                place = Weights(np.eye(2)[k], axes, name=c.named(f"{row} row"))
            else:
                names = {a.name: t.name for a, t in zip(self.b.axes(self.columns), axes[1:], strict=True)}
                wide = Project((ROW, axes[1]), "sum", names, name=c.named(f"{row} as a row"))
                signal = c.add(wide, input=signal)
                place = AxisWeights(np.eye(2)[:, k : k + 1], axes[0], "row", name=c.named(f"{row} row"))
            parts.append(c.add(place, input=signal))
        c.outlet("state change", c.total("", *parts), self.dims)
        return c.done("; ".join(filter(None, (why, doubt))), "approximated" if doubt else "carried")


def hopf(b: SourceStep) -> StepPiece:
    """Translate HopfOscillatorRHS: u' = alpha u - omega v - gamma r^2 u, v' = alpha v + omega u - gamma r^2
    v.
    """
    if b.values.number("shift u by radius fraction", 0.0):
        raise Unfit("the shift of u by a fraction of the radius is not documented")
    bank = _Bank(b)
    c, u, v = bank.c, bank.row(0, "u"), bank.row(1, "v")
    alpha, omega, gamma = (bank.factor(name, f"{name}s (bank)") for name in ("alpha", "omega", "gamma"))
    squares = c.total(
        "radius squared", c.function("u squared", "square", u), c.function("v squared", "square", v)
    )
    pull = bank.times("pull", gamma, squares, -1.0)
    first = c.total(
        "change of u",
        bank.times("alpha u", alpha, u),
        bank.times("omega v", omega, v, -1.0),
        c.product("pull of u", u, pull),
    )
    second = c.total(
        "change of v",
        bank.times("alpha v", alpha, v),
        bank.times("omega u", omega, u),
        c.product("pull of v", v, pull),
    )
    return bank.result((first, second), "Product and Sum of the rows")


def harmonic(b: SourceStep) -> StepPiece:
    """Translate HarmonicOscillatorRHS: x' = v, v' = -stiffness (x - shift) - damping v."""
    bank = _Bank(b)
    c, x, v = bank.c, bank.row(0, "x"), bank.row(1, "v")
    stiffness = bank.factor("stiffness", "stiffnesss (bank)")
    shift, displacement = "shift (optional)", x
    if shift in b.ins:
        if b.first(shift) not in ((), bank.columns):
            raise Unfit(f"{shift!r} has the size {list(b.first(shift))} for {bank.count} oscillators")
        displacement = c.total("distance", x, c.gain("minus shift", -1.0, c.slot(shift, optional=True)))
    if not b.values.flag("force critically damped", False):
        damping = bank.factor("damping", "damping (bank)")
    elif not isinstance(stiffness, StepSignal):
        damping = 2 * max(stiffness, 0.0) ** 0.5
    else:
        damping = c.gain("critical damping", 2.0, c.function("root of stiffness", "root", stiffness))
    force = c.total(
        "force", bank.times("pull", stiffness, displacement, -1.0), bank.times("drag", damping, v, -1.0)
    )
    doubt = "cedar's equation is not documented, that of a damped spring and a mass of 1 is used"
    return bank.result((v, force), "Product and Sum of the rows", doubt)


CLASSES = {
    "cedar.processing.steps.HopfOscillatorRHS": hopf,
    "cedar.processing.steps.HarmonicOscillatorRHS": harmonic,
}

DECLARED = frozenset(CLASSES)
