"""The choice of the cheapest convolution strategy for a grid and a set of Gaussian kernels.

Costs were measured on one core of servers (AVX-512, 2.6 and 2.7 GHz); they differ by factors, so the cost
model only needs to rank them. The choice is made before compiling, from bounds on the widths (`bucket`):
widths may change inside a bucket without recompiling.
"""

from __future__ import annotations

import dataclasses
import functools
import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy import fft

from deodar.numerics.axes import Axes, Axis
from deodar.numerics.waves import Waves

BUCKETS_PER_OCTAVE = 4
LEFT_OUT = 3e-5
"""Largest gain of an omitted spectral mode, relative to the kernel's integral."""

REACH = 5.0
"""Number of widths after which a Gaussian counts as 0 (4e-6 of its value at the centre)."""

PRODUCT_NS = 0.0128
"""Time of a multiplication and addition in a product of matrices, ns."""

LINE_NS = {False: 0.035, True: 0.01}
"""The same time in a product with the samples of one axis: for one copy (memory-bound), for many copies."""

TAP_NS, TAP_PLANE_NS = 0.04, 0.06
"""Time of one lag at one sample, ns: over one axis, and over two, whose rows are padded."""

CALL_NS = 450.0
FOLD_NS = 120.0
"""Time of folding or unfolding an array along an axis that is not its last, ns for each class of modes."""

FOLD_ROW_NS = 8.0
"""The same time along the last axis, ns for each row of the array and class of modes."""

FOLD_WORTH = 0.95
"""Largest cost of folded transforms relative to whole ones, as they take longer to compile."""

FOURIER_NS = 0.18
FOURIER_CALL_NS = 5000.0
LONGEST = 4
"""Largest length of a ring relative to the axis; a kernel that needs a longer ring is nearly homogeneous."""

SMALLEST = 128
"""Number of samples below which a field over one axis always uses its matrix, as other strategies save too
little.
"""

MANY = 6
"""Number of copies (rows of a group, trials, points of a sweep) from which products of matrices are faster
including their preparation.
"""


LINK_NS, LINK_CALL_NS = 0.05, 5000.0
"""Time of a byte between two devices, ns, and of an exchange (a guess: 20 GB/s)."""


@dataclass(frozen=True)
class Shards:
    """An axis that several devices divide into equal parts.

    Attributes:
        axis: its name.
        samples: its number of samples; axes of that name with another number are not divided.
        devices: number of devices.
    """

    axis: str
    samples: int
    devices: int

    def index(self, axes: Axes) -> int | None:
        """Return the index of the divided axis among axes; None if it is not there."""
        same = [d for d, a in enumerate(axes) if (a.name, a.samples) == (self.axis, self.samples)]
        return same[0] if same else None


@dataclass(frozen=True)
class Choice:
    """The strategy for a sum of kernels, and its cost: `matrices`, `taps` (with their reach along each axis),
    `waves` or `fourier` (with the spectral modes of each axis).
    """

    method: str
    waves: tuple[Waves, ...] = ()
    reaches: tuple[int, ...] = ()
    nanoseconds: float = 0.0


def bucket(width: float) -> int:
    """Return the bucket of a width, whose bounds differ by a quarter of an octave."""
    return math.floor(BUCKETS_PER_OCTAVE * math.log2(width) + 1e-9)


def bounds(number: int) -> tuple[float, float]:
    """Return the smallest and largest width of a bucket."""
    return 2 ** (number / BUCKETS_PER_OCTAVE), 2 ** ((number + 1) / BUCKETS_PER_OCTAVE)


@functools.cache
def choose(
    axes: Axes,
    boundaries: tuple[str, ...],
    widths: tuple[tuple[float, float], ...],
    terms: int,
    copies: int = 1,
    shards: Shards | None = None,
) -> Choice:
    """Return the cheapest strategy for `terms` kernels and `copies` copies, from bounds on the widths (in
    axis units) along each axis. `shards` is an axis that devices divide.
    """
    if shards is not None and shards.index(axes) is not None:
        choices = between_devices(axes, boundaries, widths, terms, shards)
        return min(choices, key=lambda c: c.nanoseconds, default=by_matrices(axes, terms, copies))
    return min(candidates(axes, boundaries, widths, terms, copies), key=lambda c: c.nanoseconds)


def candidates(
    axes: Axes,
    boundaries: tuple[str, ...],
    widths: tuple[tuple[float, float], ...],
    terms: int,
    copies: int = 1,
) -> list[Choice]:
    """Return all possible strategies, each with its estimated cost per copy."""
    few = _few(axes, boundaries, widths)
    if len(axes) == 1:
        return _on_a_line(axes[0], few[0], widths[0][1], copies)
    choices = [by_matrices(axes, terms), *_by_taps(axes, widths, terms)]
    if _fit(few):
        choices += by_waves(few, copies)
    if _fit(few) and "reflect" not in boundaries:
        choices.append(Choice("fourier", few, (), _fourier(few)))
    return choices


def between_devices(
    axes: Axes,
    boundaries: tuple[str, ...],
    widths: tuple[tuple[float, float], ...],
    terms: int,
    shards: Shards,
) -> list[Choice]:
    """Return the strategies for a field whose axis is divided: those that exchange less than the field, each
    with the cost of its operations on one device and of what the devices exchange.
    """
    index = shards.index(axes)
    assert index is not None
    choices: list[Choice] = []
    cells = math.prod(a.samples for a in axes)
    few = _divided(_few(axes, boundaries, widths), index)
    by_modes = Choice("waves", few, (), math.inf)
    if _fit(few) and (modes := exchanged(by_modes, axes, terms, shards)) < cells:
        cost = _transforms(few, MANY) / shards.devices + LINK_NS * 4 * modes + LINK_CALL_NS
        choices.append(dataclasses.replace(by_modes, nanoseconds=cost))
    reaches = tuple(_reach(axis, widest) for axis, (_, widest) in zip(axes, widths, strict=True))
    halo, part = reaches[index], shards.samples // shards.devices
    inside = all(2 * r < a.samples for a, r in zip(axes, reaches, strict=True)) and halo <= part
    if len(axes) <= 2 and inside and 2 * halo * terms < shards.samples:
        by_lags = Choice("taps", (), reaches, math.inf)
        operations = TAP_PLANE_NS * cells * sum(reaches) / shards.devices
        cost = _sums(axes, terms) * (operations + 2 * LINK_CALL_NS)
        cost += LINK_NS * 4 * exchanged(by_lags, axes, terms, shards)
        choices.append(dataclasses.replace(by_lags, nanoseconds=cost))
    return choices


def exchanged(choice: Choice, axes: Axes, terms: int, shards: Shards) -> int:
    """Return how many numbers pass between devices where `terms` kernels are applied by spectral modes or by
    lags over a divided axis.
    """
    if choice.method == "waves":
        return math.prod(w.count for w in choice.waves)
    index = shards.index(axes)
    assert index is not None
    cells = math.prod(a.samples for a in axes)
    return _sums(axes, terms) * (2 * choice.reaches[index] * cells // shards.samples)


def _sums(axes: Axes, terms: int) -> int:
    """Return how many sums by lags `terms` kernels need: over one axis they are one row of weights."""
    return terms if len(axes) > 1 else 1


def together(
    axes: Axes,
    boundaries: tuple[str, ...],
    widths: tuple[tuple[float, float], ...],
    copies: int,
    shards: Shards | None = None,
) -> Choice:
    """Return the spectral modes in which kernels between these widths are summed, with the cost of both
    transforms per copy.
    """
    few = _few(axes, boundaries, widths)
    index = None if shards is None else shards.index(axes)
    if index is not None:
        few = _divided(few, index)
        return Choice("waves", few, (), _transforms(few, MANY) if _fit(few) else math.inf)
    return by_waves(few, copies)[-1] if _fit(few) else Choice("waves", few, (), math.inf)


def by_waves(waves: tuple[Waves, ...], copies: int = 1) -> list[Choice]:
    """Return the transforms by whole bases, then the fastest folded ones if they are faster.

    A line is folded if there are many copies, a volume along its first axis only. So are many copies of a
    plane: folding the last axis too would save 2 % of the transforms, and double what folding adds to the
    time of compiling.
    """
    strategies = [Choice("waves", waves, (), _transforms(waves, copies))]
    if len(waves) > 1 or copies >= MANY:
        folds = [_folds(w) for w in waves]
        if len(waves) == 2 and copies >= MANY:
            folds = [folds[0], [waves[1]]]
        elif len(waves) > 2:
            folds = [[w for w in folds[0] if w.classes <= 2], *([w] for w in waves[1:])]
        choices = [
            Choice("waves", folded, (), _transforms(folded, copies)) for folded in itertools.product(*folds)
        ]
        best = min(choices, key=lambda c: c.nanoseconds)
        strategies += [best] if best.nanoseconds < FOLD_WORTH * strategies[0].nanoseconds else []
    return strategies


def _folds(w: Waves) -> list[Waves]:
    """Return the modes of an axis with every selection of its symmetries."""
    ring = w.boundary == "periodic" and w.samples % 2 == 0
    return [
        dataclasses.replace(w, by_parity=parity, by_symmetry=symmetry)
        for symmetry in (False, True)
        for parity in ((False, True) if ring else (False,))
    ]


def by_matrices(axes: Axes, terms: int, copies: int = 1) -> Choice:
    """Return the exact strategy: one matrix for each axis and kernel."""
    if len(axes) == 1:
        return Choice("matrices", (), (), LINE_NS[copies >= MANY] * axes[0].samples ** 2)
    return Choice("matrices", (), (), _matrices(axes, terms))


def _on_a_line(axis: Axis, waves: Waves, widest: float, copies: int) -> list[Choice]:
    """Return the strategy for one axis, on which all kernels are one matrix or one row of taps."""
    n = axis.samples
    choices = [by_matrices((axis,), 1, copies)]
    if n >= SMALLEST and _fit([waves]):
        choices += by_waves((waves,), copies)
    reach = _reach(axis, widest)
    if n >= SMALLEST and 2 * reach < n:
        choices.append(Choice("taps", (), (reach,), TAP_NS * n * reach))
    return choices


def _by_taps(axes: Axes, widths: Sequence[tuple[float, float]], terms: int) -> list[Choice]:
    """Return the sum of shifted copies along both axes of a plane in turn, if no kernel reaches across half
    an axis. Over more axes waves are faster, even for narrow kernels.
    """
    if len(axes) != 2:
        return []
    reaches = tuple(_reach(axis, widest) for axis, (_, widest) in zip(axes, widths, strict=True))
    if any(2 * reach >= axis.samples for axis, reach in zip(axes, reaches, strict=True)):
        return []
    cells = math.prod(a.samples for a in axes)
    padded = [cells * (1 + 2 * r / a.samples) * r for a, r in zip(axes, reaches, strict=True)]
    return [Choice("taps", (), reaches, terms * sum(CALL_NS + TAP_PLANE_NS * n for n in padded))]


def _divided(waves: tuple[Waves, ...], index: int) -> tuple[Waves, ...]:
    """Return the modes with one axis divided among devices."""
    return tuple(dataclasses.replace(w, divided=d == index) for d, w in enumerate(waves))


def _reach(axis: Axis, widest: float) -> int:
    """Return the number of samples to which a kernel extends on either side."""
    return math.ceil(REACH * widest / axis.step)


def _few(axes: Axes, boundaries: Sequence[str], widths: Sequence[tuple[float, float]]) -> tuple[Waves, ...]:
    return tuple(
        _waves(a.samples, b, low / a.step, high / a.step)
        for a, b, (low, high) in zip(axes, boundaries, widths, strict=True)
    )


def _fit(waves: Sequence[Waves]) -> bool:
    return all(w.length <= LONGEST * w.samples for w in waves)


def _waves(samples: int, boundary: str, narrow: float, wide: float) -> Waves:
    """Return the spectral modes that kernels between two widths (in samples) need."""
    length = samples
    if boundary == "reflect":
        length = 2 * samples
    elif boundary == "zero":
        length = fft.next_fast_len(samples + math.ceil(REACH * wide), real=True) or samples
    highest = math.ceil(length * math.sqrt(2 * math.log(1 / LEFT_OUT)) / (2 * math.pi * narrow))
    most = samples - 1 if boundary == "reflect" else length // 2
    return Waves(boundary, samples, length, min(highest, most))


def _matrices(axes: Axes, terms: int) -> float:
    cells = math.prod(a.samples for a in axes)
    return terms * sum(CALL_NS + PRODUCT_NS * cells * a.samples for a in axes)


def _transforms(waves: Sequence[Waves], copies: int) -> float:
    sizes, last = [w.samples for w in waves], len(waves) - 1
    product, call = (PRODUCT_NS, CALL_NS) if last else (LINE_NS[copies >= MANY], 0.0)
    total = 0.0
    for d, w in enumerate(waves):
        cells = math.prod(sizes)
        total += product * cells * w.count / w.classes + call * (w.classes if d == last else 1)
        if w.classes > 1:
            total += w.classes * (FOLD_ROW_NS * cells / w.samples if d == last else FOLD_NS)
        sizes[d] = w.count
    return 2 * total


def _fourier(waves: Sequence[Waves]) -> float:
    cells = int(np.prod([w.length for w in waves]))
    return FOURIER_CALL_NS + FOURIER_NS * cells * math.log2(cells)
