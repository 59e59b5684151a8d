"""Stimuli, timed or not."""

from __future__ import annotations

import dataclasses as dc

import numpy as np

from deodar.couplings.delay import Delay
from deodar.elements.boost import Boost
from deodar.elements.gaussian_stimulus import GaussianStimulus
from deodar.elements.pattern import Pattern
from deodar.importers._piece import Dims, Outlet, Piece, axes
from deodar.importers.dnf_composer import profile
from deodar.importers.dnf_composer.element import StoredElement
from deodar.importers.dnf_composer.file import number
from deodar.importers.dnf_composer.onsets import spans
from deodar.numerics.axes import Axis, shape
from deodar.numerics.windows import Window

EXACT = 1e-12
"""Largest difference, as a share, between the extent of an axis and its samples times its step."""

NOTHING = 1e-12
"""Sum of a pattern below which dnf-composer does not normalise it."""


def gauss_stimulus(b: StoredElement) -> Piece:
    """Translate `gauss stimulus`, whose width is in samples, and its timed form."""
    dims = b.dims()
    count = b.counts[1]
    position = _position(b, "position", "x_max", 50) / b.spacing("d_x")
    width, circular = b.values.width("width", 5), b.values.flag("circular", True)
    amplitude, normalized = b.values.number("amplitude", 15), b.values.flag("normalized", False)
    factor = profile.line(count, position, width, circular)
    start = amplitude * (factor / factor.sum() if normalized and factor.sum() > 0 else factor)
    b.start = start
    if dims[1] is None:
        return _stimulus(b, dims, Boost(b.label, axes(dims), float(start[0])))
    ends = boundary(axes(dims), circular)
    bell = GaussianStimulus(
        b.label, axes(dims), position, width, amplitude, normalized=normalized, boundary=ends
    )
    return _stimulus(b, dims, bell)


def gauss_stimulus_2d(b: StoredElement) -> Piece:
    """Translate `gauss stimulus 2d`, whose width is in units, and its timed form.

    Where a circular axis is no whole number of steps, no stimulus of deodar has its distances, and the
    pattern is stored.
    """
    dims = b.dims()
    width, circular = b.values.width("width", 5), b.values.flag("circular", True)
    amplitude, normalized = b.values.number("amplitude", 15), b.values.flag("normalized", False)
    centers, sigmas, factors, whole = list[float](), list[float](), list[np.ndarray](), True
    for letter, count, axis in zip("yx", b.counts, dims, strict=True):
        step, extent = b.spacing(f"d_{letter}"), number(b.element.values.get(f"{letter}_max")) or 1.0
        position = _position(b, f"position_{letter}", f"{letter}_max", 50)
        points = np.arange(1.0, count + 1) * step
        factors.append(profile.along(points, extent if circular else None, position, width))
        if axis is not None:
            centers.append(position / step)
            sigmas.append(width / step)
        whole = whole and axis is not None and (not circular or abs(count * step - extent) <= EXACT * extent)
    pattern = np.outer(*factors)
    total = float(pattern.sum())
    normalized = normalized and total > NOTHING
    start = (amplitude * (pattern / total if normalized else pattern)).reshape(-1)
    b.start, own = start, axes(dims)
    if whole:
        ends = boundary(own, circular)
        bell = GaussianStimulus(
            b.label, own, centers, sigmas, amplitude, normalized=normalized, boundary=ends
        )
        return _stimulus(b, dims, bell)
    if not own:
        return _stimulus(b, dims, Boost(b.label, own, float(start[0])))
    b.budget.take(pattern.size)
    return _stimulus(b, dims, Pattern(b.label, own, start.reshape(shape(own))))


def boost(b: StoredElement) -> Piece:
    """Translate `boost stimulus` and its form over a plane; one that is not active keeps its amplitude."""
    dims = b.dims()
    amplitude, active = b.values.number("amplitude", 5), b.values.flag("isActive", True)
    b.start = amplitude if active else 0.0
    element = Boost(b.label, axes(dims), amplitude, windows=() if active else [_never()])
    if not active:
        b.values.say("isActive", "carried", "as a window in which it is never on")
    return Piece([element], [], {"output": Outlet(b.label, dims, still=True)}, why="Boost")


# ----------------------------------------------------------------------------------------------------- inside


def _position(b: StoredElement, name: str, extent: str, default: float) -> float:
    value = b.values.number(name, default)
    longest = number(b.element.values.get(extent, 1.0)) or 1.0
    if name in b.element.values and not 0 <= value < longest:
        b.values.say(
            name, "approximated", f"{value:g} is outside 0..{longest:g}, where dnf-composer refuses the file"
        )
    return value


def _stimulus(b: StoredElement, dims: Dims, element: GaussianStimulus | Pattern | Boost) -> Piece:
    """Return a stimulus; one that is timed passes a register, so that its name shows at t what led to t."""
    why = type(element).__name__
    if not b.element.kind.startswith("timed"):
        return Piece([element], [], {"output": Outlet(b.label, dims, still=True)}, why=why)
    b.start = 0.0
    element = dc.replace(element, name=b.named("stimulus"), windows=_windows(b))
    outlet = Outlet(b.label, dims, state=True)
    register = Delay(axes(dims), 0.0, name=b.label)
    return Piece(
        [register, element], [], {"output": outlet}, [(element.name, b.label)], why=f"{why} and Delay"
    )


def boundary(own: tuple[Axis, ...], circular: bool) -> list[str] | None:
    """Return boundaries that differ from those of the axes, else None."""
    ends = ["periodic" if circular else "zero"] * len(own)
    return None if ends == ["periodic" if a.periodic else "zero" for a in own] else ends


def _windows(b: StoredElement) -> list[Window]:
    """Return the windows of a timed stimulus.

    dnf-composer counts the time first, so that the value for t is used in the step that leads to t.
    """
    b.values.optional.add("onTimes")
    periods = [(a, z) for a, z in b.values.rows("onTimes", 2)]
    if periods and b.values.lines["onTimes"].verdict == "carried":
        b.values.say("onTimes", "carried", "moved by one step, since dnf-composer counts the time first")
    found = [Window((a - 1) * b.step, z * b.step) for a, z in spans(periods, b.step)]
    return found or [_never()]


def _never() -> Window:
    return Window(-1.0, -1.0)


CLASSES = {
    "gauss stimulus": gauss_stimulus,
    "gauss stimulus 2d": gauss_stimulus_2d,
    "timed gauss stimulus": gauss_stimulus,
    "timed gauss stimulus 2d": gauss_stimulus_2d,
    "boost stimulus": boost,
    "boost stimulus 2d": boost,
}
