"""Streams that a page watches: ports as thinned frames, and time courses."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from deodar.errors import DeodarError, Problem
from deodar.live.published import PublishedState
from deodar.live.trace import Trace, TraceRequest
from deodar.numerics.axes import Axes, Axis
from deodar.server import frames, view
from deodar.server.source import FrameSource
from deodar.server.to_page import Announced, Lost
from deodar.session.port_reader import PortKey

CHANNELS = ("channel", 3)
"""Name and number of samples of the last axis of a picture."""


class Stream:
    """A port of an element, or with a `request` its time course, under a number that the page chose.

    `other`: of the record that the open one is compared with.
    """

    def __init__(
        self,
        number: int,
        place: PortKey,
        most: int = 0,
        request: TraceRequest | None = None,
        other: bool = False,
    ) -> None:
        self.number, self.place, self.most, self.request, self.other = number, place, most, request, other
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
        values = thin(fold(array, self._axes), self.most, self._said.channels)
        if list(values.shape) != self._said.shape:
            return None  # a state of the previous program
        return frames.pack(self.number, state.number, state.time, values)

    def _samples(self, trace: Trace | None, number: int) -> bytes | None:
        if trace is not self._trace:
            self._trace, self._taken = trace, 0
        if trace is None or trace.count == self._taken:
            return None
        samples = trace.since(self._taken)
        self._taken = trace.count
        start = float(samples[0, 0])
        return frames.pack(self.number, number, start, samples - [start, 0.0])

    def _form(self, source: FrameSource, past: PublishedState | None) -> Announced | Lost:
        try:
            self._axes = source.axes(self.place)
        except DeodarError as error:
            return _lost(self.number, error.problems[0])
        if past is not None and self.request is None:
            array = past.arrays.get(self.place)
            if array is None or array.shape != tuple(a.samples for a in self._axes):
                return _lost(self.number, source.absent(self.place))
        if self.request is not None:
            return Announced(stream=self.number, shape=[2], axes=[], folded=[], channels=False)
        channels = is_picture(self._axes)
        kept = self._axes if channels else self._axes[:2]
        shape = [_thinned(a.samples, self.most) for a in kept]
        if channels:
            shape[-1] = CHANNELS[1]
        return Announced(
            stream=self.number,
            shape=shape,
            axes=[view.axis(a) for a in kept],
            folded=[a.name for a in self._axes[len(kept) :]],
            channels=channels,
        )


def is_picture(axes: Sequence[Axis]) -> bool:
    """Return whether an array over these axes is a picture with three channels."""
    return len(axes) == 3 and (axes[2].name, axes[2].samples) == CHANNELS


def fold(array: np.ndarray, axes: Sequence[Axis]) -> np.ndarray:
    """Return the maximum over all axes beyond the second; a picture is returned unchanged."""
    if array.ndim <= 2 or is_picture(axes):
        return array
    return array.max(axis=tuple(range(2, array.ndim)))


def thin(array: np.ndarray, most: int, channels: bool) -> np.ndarray:
    """Thin an array to at most `most` samples along each axis (0: all), evenly spaced, including both ends.

    With `channels` the last axis keeps all samples.
    """
    for d in range(array.ndim - channels):
        n = array.shape[d]
        if _thinned(n, most) < n:
            array = array.take(np.linspace(0, n - 1, _thinned(n, most)).round().astype(int), axis=d)
    return array


def _thinned(samples: int, most: int) -> int:
    return samples if most == 0 else min(samples, max(2, most))


def _lost(number: int, problem: Problem) -> Lost:
    return Lost(stream=number, problem=view.problems([problem])[0])
