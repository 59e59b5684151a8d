"""Kernels of cedar's convolutions, and what lies beyond the ends of an array.

A Gauss kernel has ceil(limit sigma) samples, made odd; each of its factors is truncated and, if normalised,
divided by its own sum. Those whose samples lie within the field are `TruncatedGaussian`; shifted ones, even
boxes, and kernels longer than the field are arrays.
"""

from __future__ import annotations

import dataclasses as dc
import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from deodar.numerics.axes import Axis
from deodar.numerics.kernels._base import Kernel
from deodar.numerics.kernels.custom import Custom
from deodar.numerics.kernels.separable import Box, Gaussian, Shifted, TruncatedGaussian
from deodar_interop.importers.cedar.file import members, text
from deodar_interop.importers.cedar.values import StepValues

BORDERS = ("Zero", "Cyclic", "Replicate", "Reflect")
ENDS = {"Zero": "zero", "Cyclic": "periodic", "Reflect": "reflect", "Replicate": "replicate"}
FASTEST = "cedar.aux.conv.FFTW"


@dc.dataclass(frozen=True)
class CedarBorder:
    """What lies beyond the ends of a convolved array, and cedar's centre of a kernel of even size."""

    type: str = "Zero"
    fourier: bool = False
    later: bool = False

    @classmethod
    def of(cls, body: Any, dimensions: int) -> CedarBorder:
        """Return the border of a convolution object; FFTW is cyclic whatever the object states."""
        values = members(body)
        fourier = text(members(values.get("engine")).get("type")) == FASTEST or dimensions > 2
        stated = text(values.get("borderType"))
        kind = "Cyclic" if fourier else stated if stated in BORDERS else "Zero"
        later = fourier or text(values.get("alternate even kernel center")) == "true"
        return cls(kind, fourier, later)

    def ends(self, axes: Sequence[Axis]) -> list[str] | None:
        """Return the boundary of each axis; None if it is that of the axes themselves."""
        axis_ends = ["periodic" if a.periodic else "zero" for a in axes]
        kernel_ends = [ENDS[self.type]] * len(axes)
        return None if axis_ends == kernel_ends else kernel_ends


def border(values: StepValues, name: str, dimensions: int) -> CedarBorder:
    """Read a convolution object, with report lines."""
    convolution = CedarBorder.of(values.body.get(name), dimensions)
    if name not in values.body:
        return convolution
    inside = values.inside(name)
    stated = inside.word("borderType", "Zero", BORDERS)
    if convolution.type != stated:
        who = "FFTW" if dimensions <= 2 else "FFTW, which cedar takes from three dimensions on,"
        inside.say("borderType", "carried", f"{who} is always cyclic")
    inside.word("mode", "Same", ("Same",))
    inside.say("engine")
    if "alternate even kernel center" in inside.body:
        inside.flag("alternate even kernel center", False)
    values.say(name)
    return convolution


NARROWEST = 0.01
"""Smallest width of a kernel in cedar."""

PATCH = 101
"""Samples along each side of cedar's rotated Gauss kernel."""

MOST_WEIGHTS = 1_000_000
"""Largest number of samples of a kernel that is stored as an array (a guess)."""


def kernels(
    listed: Sequence[tuple[str, StepValues]], axes: Sequence[Axis], border: CedarBorder
) -> list[Kernel]:
    """Return the kernels of a list for the axes of an array."""
    return [k for kind, values in listed if (k := kernel(kind, values, axes, border)) is not None]


def too_long(listed: Sequence[tuple[str, StepValues]], axes: Sequence[Axis], border: CedarBorder) -> str:
    """Return why FFTW refuses the kernels of a list; "" if it does not.

    It raises an exception for a kernel with more samples than the array along any axis.
    """
    if not border.fourier:
        return ""
    for kind, values in listed:
        quiet = StepValues(values.body, values.where)
        if kind.endswith("Gauss"):
            limit = quiet.number("limit", 5.0, 1e-6, 1e3)
            sizes = [2 * h + 1 for h in _halves(quiet.numbers("sigmas", 3.0, len(axes), NARROWEST), limit)]
        else:
            sizes = [int(w) for w in quiet.numbers("widths", 5.0, len(axes), 1.0, 5000.0)]
        if any(n > a.samples for n, a in zip(sizes, axes, strict=True)):
            return f"FFTW raises an exception for a kernel of {sizes} samples, more than the array has"
    return ""


def kernel(kind: str, values: StepValues, axes: Sequence[Axis], border: CedarBorder) -> Kernel | None:
    """Return one kernel; None if deodar has none of this type, which is reported."""
    if "dimensionality" in values.body:
        values.say("dimensionality", "carried", "that of the array")
    count = max(len(axes), 1)
    anchor = [int(v) for v in values.numbers("anchor", 0, count)]
    match kind.rpartition(".")[2]:
        case "Gauss":
            return _gauss(values, axes, border, anchor)
        case "Box":
            return _box(values, axes, border, anchor)
        case "RotatedGauss" if len(axes) == 2:
            return _rotated(values, axes, border)
        case name:
            values.say(kind, "dropped", f"{name} is no kernel for {len(axes)} dimensions")
            return None


def _gauss(values: StepValues, axes: Sequence[Axis], border: CedarBorder, anchor: list[int]) -> Kernel:
    count = max(len(axes), 1)
    amplitude = values.number("amplitude", 1.0)
    sigmas = values.numbers("sigmas", 3.0, count, NARROWEST)
    normalize = values.flag("normalize", True)
    shifts = [int(v) for v in values.numbers("shifts", 0.0, count)]
    limit = values.number("limit", 5.0, 1e-6, 1e3)
    halves = _halves(sigmas, limit)
    if not axes:
        return _on_node(values, amplitude, _factor(sigmas[0], halves[0], shifts[0], normalize), border)
    within = [
        (2 * h + 1 <= a.samples if border.type == "Cyclic" else h < a.samples)
        for h, a in zip(halves, axes, strict=True)
    ]
    if any(shifts) or not all(within):
        parts = [_factor(s, h, m, normalize) for s, h, m in zip(sigmas, halves, shifts, strict=True)]
        return _array(values, "sigmas", amplitude, parts, anchor, axes, border)
    same = sigmas[0] if len(set(sigmas)) == 1 else sigmas
    cutoff, least = _reach(sigmas, halves, limit)
    ends = border.ends(axes)
    if not any(anchor):
        return TruncatedGaussian(amplitude, same, cutoff, least, normalize, boundary=ends)
    inner = TruncatedGaussian(amplitude, same, cutoff, least, normalize)
    return Shifted(inner, [float(v) for v in anchor], boundary=ends)


def _halves(sigmas: Sequence[float], limit: float) -> list[int]:
    """Return the samples on either side of the centre: the whole has ceil(limit sigma), made odd."""
    return [math.ceil(limit * s - 1e-9) // 2 for s in sigmas]


def _reach(sigmas: list[float], halves: list[int], limit: float) -> tuple[float, float | list[float]]:
    """Return a cutoff in widths by which every axis has its number of samples; where no cutoff does, 0 and
    the reaches themselves.
    """
    low = max((h - 1) / s for h, s in zip(halves, sigmas, strict=True))
    high = min(h / s for h, s in zip(halves, sigmas, strict=True))
    if low < limit / 2 < high:
        return limit / 2, 0.0
    if low < high and high > 0:
        return (max(low, 0.0) + high) / 2, 0.0
    return 0.0, float(halves[0]) if len(set(halves)) == 1 else [float(h) for h in halves]


def _factor(sigma: float, half: int, shift: int, normalize: bool) -> np.ndarray:
    """Return one factor of a Gauss kernel: 2 half + 1 samples."""
    lags = np.arange(2 * half + 1) - half - shift
    part = np.exp(-0.5 * (lags / sigma) ** 2)
    whole = part.sum()
    return part / whole if normalize and whole > 0 else part


def _box(values: StepValues, axes: Sequence[Axis], border: CedarBorder, anchor: list[int]) -> Kernel:
    count = max(len(axes), 1)
    amplitude = values.number("amplitude", 1.0)
    widths = [max(int(v), 1) for v in values.numbers("widths", 5.0, count, 1.0, 5000.0)]
    if not axes:
        return _on_node(values, amplitude, np.ones(widths[0]), border)
    if any(w % 2 == 0 for w in widths):
        parts = [_centred(np.ones(w), border.later) for w in widths]
        return _array(values, "widths", amplitude, parts, anchor, axes, border)
    same = float(widths[0]) if len(set(widths)) == 1 else [float(w) for w in widths]
    if not any(anchor):
        return Box(amplitude, same, boundary=border.ends(axes))
    return Shifted(Box(amplitude, same), [float(v) for v in anchor], boundary=border.ends(axes))


def _centred(part: np.ndarray, later: bool) -> np.ndarray:
    """Return a part of even size as one of odd size around its centre: index n / 2 - 1, or n / 2."""
    if part.size % 2:
        return part
    return np.concatenate([part, [0.0]]) if later else np.concatenate([[0.0], part])


def _rotated(values: StepValues, axes: Sequence[Axis], border: CedarBorder) -> Kernel:
    amplitude = values.number("amplitude", 1.0)
    wide, narrow = values.numbers("sigmas", 3.0, 2, NARROWEST)
    alpha = math.radians(values.number("alpha", 0.0, -360.0, 360.0))
    lags = np.arange(PATCH) - PATCH // 2
    rows, columns = np.meshgrid(lags, lags, indexing="ij")
    along = columns * math.cos(alpha) + rows * math.sin(alpha)
    across = -columns * math.sin(alpha) + rows * math.cos(alpha)
    patch = np.exp(-0.5 * ((along / wide) ** 2 + (across / narrow) ** 2))
    if values.flag("normalize", True):
        patch = patch / patch.sum()
    values.say("alpha", "approximated", "as an array; the direction of its rotation is a guess")
    return Custom(patch, amplitude, boundary=border.ends(axes))


def _array(
    values: StepValues,
    name: str,
    amplitude: float,
    parts: Sequence[np.ndarray],
    anchor: Sequence[int],
    axes: Sequence[Axis],
    border: CedarBorder,
) -> Kernel:
    """Return a product of factors as an array."""
    moved = [_moved(part, by) for part, by in zip(parts, anchor, strict=True)]
    if math.prod(part.size for part in moved) > MOST_WEIGHTS:
        values.say(name, "dropped", f"the kernel has more than {MOST_WEIGHTS} weights")
        return Gaussian(0.0)
    out = moved[0]
    for part in moved[1:]:
        out = out[..., None] * part
    values.say(name, "carried", f"as an array of {' x '.join(str(n) for n in out.shape)} weights")
    return Custom(out, amplitude, boundary=border.ends(axes))


def _moved(part: np.ndarray, by: int) -> np.ndarray:
    """Return a part with its centre moved, of odd size."""
    by = max(min(by, 5000), -5000)
    nothing = np.zeros(2 * abs(by))
    return np.concatenate([nothing, part] if by > 0 else [part, nothing]) if by else part


def _on_node(values: StepValues, amplitude: float, part: np.ndarray, border: CedarBorder) -> Kernel:
    """Return the self-excitation of a node: the centre of the kernel, or its sum if it wraps."""
    centre = (
        float(part.sum())
        if border.type in ("Cyclic", "Replicate", "Reflect")
        else float(part[part.size // 2])
    )
    if centre != 1.0:
        where = "the sum of the kernel" if border.type != "Zero" else "the centre of the kernel"
        values.say("amplitude", "carried", f"times {centre:.4g}, {where}: the self-excitation of a node")
    return Gaussian(amplitude * centre, 1.0)
