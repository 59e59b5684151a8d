"""The comparison of the cost model of convolutions with this machine: estimated and measured cost of every
strategy.
"""

from __future__ import annotations

import dataclasses as dc
import time
from collections.abc import Callable, Iterator

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array, lax

from deodar.compiler import cache, device
from deodar.numerics import interaction
from deodar.numerics.axes import Axes, Axis, shape
from deodar.numerics.choice import Choice, candidates
from deodar.numerics.kernels.separable import Gaussian

SECONDS = 0.02
"""CPU time of one measurement; the least of `ROUNDS` counts."""

ROUNDS = 5
NAMES = "xyz"


@dc.dataclass(frozen=True)
class Case:
    """A field and its kernels: samples on each axis, the boundary of all, widths in samples, and how many
    copies run at once.
    """

    samples: tuple[int, ...]
    boundary: str = "periodic"
    sigmas: tuple[float, ...] = (5.0, 10.0)
    copies: int = 1

    def __str__(self) -> str:
        many = f"{self.copies} of " if self.copies > 1 else ""
        return (
            f"{many}{' x '.join(map(str, self.samples))} {self.boundary}, sigma"
            f" {', '.join(f'{s:g}' for s in self.sigmas)}"
        )

    @property
    def axes(self) -> Axes:
        """Axes of unit spacing."""
        return tuple(Axis(n, 0, k - 1, k) for n, k in zip(NAMES, self.samples, strict=False))

    @property
    def kernels(self) -> list[Gaussian]:
        """One Gaussian of each width."""
        return [Gaussian(1.0, s, normalized=True, boundary=[self.boundary]) for s in self.sigmas]


CASES = (
    Case((100,)),
    Case((200,)),
    Case((500,)),
    Case((500,), "zero", (30.0, 90.0)),
    Case((200,), copies=100),
    Case((50, 50), sigmas=(3.0, 6.0)),
    Case((50, 50), "zero", (3.0, 6.0)),
    Case((100, 100), sigmas=(3.0, 6.0)),
    Case((100, 100), sigmas=(1.2,)),
    Case((80, 90), "zero", (1.5,), copies=16),
    Case((200, 200), sigmas=(3.0, 6.0)),
    Case((400, 400), sigmas=(2.0, 3.0)),
    Case((50, 50, 30), sigmas=(3.0, 6.0)),
)
"""Typical fields, from one to three dimensions."""


@dc.dataclass(frozen=True)
class Measured:
    """One method of one case ("waves, folded": with folded transforms): what a step of all copies should cost
    and costs, in microseconds; `chosen`: whether it is the one that is taken.
    """

    case: Case
    method: str
    predicted_us: float
    measured_us: float
    chosen: bool


def measure(case: Case) -> Iterator[Measured]:
    """Yield every possible strategy for a case, in ascending order of estimated cost."""
    key = " ".join([case.boundary] * len(case.samples))
    terms = interaction.spans(case.kernels, case.axes)[key]
    choices = candidates(case.axes, tuple(key.split()), interaction.covering(terms), len(terms), case.copies)
    for k, choice in enumerate(sorted(choices, key=lambda c: c.nanoseconds)):
        yield Measured(
            case,
            choice.method + (", folded" if any(w.classes > 1 for w in choice.waves) else ""),
            choice.nanoseconds * case.copies / 1000,
            1e6 * _seconds(case, key, choice),
            k == 0,
        )


def _seconds(case: Case, key: str, choice: Choice) -> float:
    """Return the CPU time in seconds of one application to all copies."""
    axes, kernels, chosen = case.axes, case.kernels, {} if choice.method == "matrices" else {key: choice}
    weights = interaction.mix(kernels, axes, interaction.prepare(kernels, axes, np.dtype("float32"), chosen))

    def run(weights: interaction.Mixture, y: Array, n: Array) -> Array:
        def once(_: Array, y: Array) -> Array:
            return 0.5 * y + 0.25 * jax.vmap(lambda row: interaction.apply(weights, axes, row, chosen))(y)

        return lax.fori_loop(0, n, once, y)

    y = np.random.default_rng(0).random((case.copies, *shape(axes))).astype(np.float32)
    place = device.find()
    weights = jax.tree.map(jnp.asarray, weights)
    compiled, _ = cache.compile(jax.jit(run).lower(weights, y, np.int32(1)), cache.options(place), place)
    return _least(lambda n: jax.block_until_ready(compiled(weights, y, np.int32(n))))


def _least(run: Callable[[int], Array]) -> float:
    """Return the CPU time in seconds of one of many repetitions, without the cost of the call."""

    def cpu(n: int) -> float:
        began = time.process_time()
        run(n)
        return time.process_time() - began

    n = 1
    while cpu(n) < SECONDS:
        n *= 2
    return max(0.0, min((cpu(2 * n) - cpu(n)) / n for _ in range(ROUNDS)))
