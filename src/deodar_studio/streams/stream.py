"""Streams that a page watches: ports as thinned frames, and time courses."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from deodar.errors import DeodarError, Problem
from deodar.numerics.axes import Axes, Axis
from deodar.session.port_reader import PortKey
from deodar_studio.live.published import PublishedState
from deodar_studio.live.section import Section
from deodar_studio.live.trace import Trace, TraceRequest, farther
from deodar_studio.messages import frames
from deodar_studio.messages.to_page import Announced, Lost
from deodar_studio.streams.source import FrameSource
from deodar_studio.views import converted, view

CHANNELS = ("channel", 3)
"""Name and number of samples of the last axis of a picture."""

MOST_MEDIAN = 4096
"""Largest number of samples from which a median is computed."""


class Stream:
    """A port of an element, or with a `request` its time course, under a number that the page chose.

    Args:
        number: the number.
        place: the port.
        most: largest number of samples along an axis; 0: all.
        request: the time course; None: the newest array.
        other: whether the stream is of the record that the open one is compared with.
        section: the part of the array that the page draws.
    """

    def __init__(
        self,
        number: int,
        place: PortKey,
        most: int = 0,
        request: TraceRequest | None = None,
        other: bool = False,
        section: Section | None = None,
    ) -> None:
        self.number, self.place, self.most, self.request, self.other = number, place, most, request, other
        rows = None if request is None else request.section
        self._rows = rows is not None
        self._section = rows or section or Section()
        self._said: Announced | Lost | None = None
        self._axes: Axes = ()
        self._trace: Trace | None = None
        self._taken = 0

    def news(self, source: FrameSource, past: PublishedState | None) -> Announced | Lost | None:
        """Return the message on the format of the stream if it changed, else None.

        `past` is the state that the page shows, None for the present, whose arrays may still be missing.
        """
        form = self._form(source, past) if source.ready else None
        if form is None or form == self._said:
            return None
        self._said = form
        return form

    def frame(self, state: PublishedState, trace: Trace | None) -> bytes | None:
        """Return the frame to send, or None if there is nothing new; `trace` is the requested time course."""
        if not isinstance(self._said, Announced):
            return None
        if self.request is not None:
            return self._samples(trace, state.number)
        array = state.arrays.get(self.place)
        if array is None:
            return None
        shown = array if self._said.channels else self._section.take(array, self._axes)
        values = thin(shown, self.most, self._said.channels)
        if list(values.shape) != self._said.shape:
            return None  # a state of the previous program
        return frames.pack(self.number, state.number, state.time, values)

    def _samples(self, trace: Trace | None, number: int) -> bytes | None:
        if trace is not self._trace:
            self._trace, self._taken = trace, 0
        # read once: a thread adds samples meanwhile, which the next frame has
        count = 0 if trace is None else trace.count
        if trace is None or count == self._taken:
            return None
        samples = trace.since(self._taken, count)
        self._taken = count
        if not len(samples):
            return None
        start = float(samples[0, 0])
        values = samples[:, 1:]
        if self._rows:
            values = thin_rows(values, self.most)
        if not isinstance(self._said, Announced) or self._said.shape != [1 + values.shape[1]]:
            return None  # samples of the previous program
        return frames.pack(self.number, number, start, np.column_stack([samples[:, 0] - start, values]))

    def _form(self, source: FrameSource, past: PublishedState | None) -> Announced | Lost:
        try:
            self._axes = source.axes(self.place)
        except DeodarError as error:
            return _lost(self.number, error.problems[0])
        if past is not None and self.request is None:
            array = past.arrays.get(self.place)
            if array is None or array.shape != tuple(a.samples for a in self._axes):
                return _lost(self.number, source.absent(self.place))
        if self.request is not None and not self._rows:
            return Announced(stream=self.number, shape=[2], axes=[], rest=[], folded=[], channels=False)
        channels = is_picture(self._axes) and self._section == Section()
        kept, rest = (self._axes, ()) if channels else self._section.split(self._axes)
        shape = [_thinned(a.samples, self.most, 2 if self._rows else len(kept)) for a in kept]
        if channels:
            shape[-1] = CHANNELS[1]
        if self._rows:
            shape = [1 + math.prod(shape)]
        return Announced(
            stream=self.number,
            shape=shape,
            axes=[converted.axis(a) for a in kept],
            rest=[converted.axis(a) for a in rest],
            folded=[] if channels else [a.name for a in self._section.folded(self._axes)],
            channels=channels,
        )


def is_picture(axes: Sequence[Axis]) -> bool:
    """Return whether an array over these axes is a picture with three channels."""
    return len(axes) == 3 and (axes[2].name, axes[2].samples) == CHANNELS


def thin(array: np.ndarray, most: int, channels: bool) -> np.ndarray:
    """Thin an array to at most `most` samples along each axis (0: all), so that narrow peaks remain.

    The samples along an axis are divided into bins. Over one axis each bin gives its minimum and its maximum,
    in the order of their positions. Over two axes each cell gives the value that is farthest from the median
    of the array: a field is at its resting level almost everywhere, and a peak above it is kept as well as a
    trough below it, which the maximum of a cell would hide. With `channels` a cell gives its mean, as when a
    picture is made smaller; the last axis keeps all samples. Values that are NaN count only in bins without
    others.
    """
    if array.ndim == 1:
        n = array.shape[0]
        return array if _thinned(n, most, 1) == n else _extremes(array, _thinned(n, most, 1) // 2)
    bins = [_thinned(n, most, array.ndim) for n in array.shape[: array.ndim - channels]]
    thinned = [d for d, n in enumerate(bins) if n < array.shape[d]]
    usual = median(array) if thinned and not channels else 0.0
    for d in thinned:
        rows = np.moveaxis(array, d, 0)
        rows = _means(rows, bins[d]) if channels else _farthest(rows, bins[d], usual)
        array = np.moveaxis(rows, 0, d)
    return array


def thin_rows(rows: np.ndarray, most: int) -> np.ndarray:
    """Thin rows, one after another in time, to at most `most` values each, as `thin` does planes."""
    bins = _thinned(rows.shape[1], most, 2)
    return rows if bins == rows.shape[1] else _farthest(rows.T, bins, median(rows)).T


def _extremes(array: np.ndarray, bins: int) -> np.ndarray:
    values = array[_bins(array.shape[0], bins)]
    missing = np.isnan(values)
    lowest = np.where(missing, np.inf, values).argmin(axis=1)
    highest = np.where(missing, -np.inf, values).argmax(axis=1)
    order = np.sort(np.stack([lowest, highest], axis=1), axis=1)
    return np.take_along_axis(values, order, axis=1).reshape(-1)


def _farthest(array: np.ndarray, bins: int, usual: float) -> np.ndarray:
    starts = _edges(array.shape[0], bins)
    low, high = (f.reduceat(array, starts, axis=0) for f in (np.fmin, np.fmax))
    return farther(low, high, usual)


def _means(array: np.ndarray, bins: int) -> np.ndarray:
    starts = _edges(array.shape[0], bins)
    counts = np.diff(np.append(starts, array.shape[0]))
    return np.add.reduceat(array, starts, axis=0) / counts.reshape(-1, *[1] * (array.ndim - 1))


def _edges(samples: int, bins: int) -> np.ndarray:
    """Return the first sample of each bin."""
    return np.arange(bins) * samples // bins


def _bins(samples: int, bins: int) -> np.ndarray:
    """Return the samples of each bin, one row for each; shorter bins repeat their last sample."""
    starts = _edges(samples, bins)
    ends = np.append(starts[1:], samples)
    return np.minimum(starts[:, None] + np.arange((ends - starts).max()), ends[:, None] - 1)


def median(array: np.ndarray) -> float:
    """Return the median of at most `MOST_MEDIAN` samples, evenly spaced."""
    flat = array.reshape(-1)
    some = flat[:: max(1, flat.size // MOST_MEDIAN)]
    some = some[~np.isnan(some)]
    return float(np.median(some)) if some.size else 0.0


def thinned_shape(shape: Sequence[int], most: int) -> list[int]:
    """Return the shape of an array that `thin` leaves."""
    return [_thinned(n, most, len(shape)) for n in shape]


def _thinned(samples: int, most: int, dimensions: int) -> int:
    """Return the number of samples that `thin` leaves; over one axis an even one, of pairs."""
    if most == 0 or samples <= max(2, most):
        return samples
    return max(2, most) if dimensions > 1 else 2 * (max(2, most) // 2)


def _lost(number: int, problem: Problem) -> Lost:
    return Lost(stream=number, problem=view.problems([problem])[0])
