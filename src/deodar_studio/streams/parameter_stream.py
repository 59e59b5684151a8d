"""The base of streams of what follows from parameters of an element, as they are now."""

from __future__ import annotations

import dataclasses as dc
from typing import Any

import numpy as np

from deodar.element import Element
from deodar.errors import DeodarError
from deodar.numerics.axes import Axes
from deodar_studio.live.published import PublishedState
from deodar_studio.live.trace import Trace
from deodar_studio.messages import frames
from deodar_studio.messages.to_page import Announced, Lost
from deodar_studio.streams.source import FrameSource
from deodar_studio.streams.stream import thin, thinned_shape
from deodar_studio.views import converted, view


@dc.dataclass(frozen=True)
class PlaneDrawing:
    """An array over at most two axes.

    Attributes:
        values: the array.
        axes: its axes.
        rest: the axes at which it is cut, or over which the maximum is taken.
        folded: names of the axes over which the maximum is taken.
    """

    values: np.ndarray
    axes: Axes
    rest: Axes = ()
    folded: tuple[str, ...] = ()


class ParameterStream:
    """A stream under a number that the page chose; it reads no port.

    Args:
        number: the number.
        element: id of the element.
        most: largest number of samples along an axis; 0: all.
        other: whether the stream is of the record that the open one is compared with.
    """

    request = None
    place = None

    def __init__(self, number: int, element: str, most: int = 0, other: bool = False) -> None:
        self.number, self.other = number, other
        self._element, self._most = element, most
        self._said: Announced | Lost | None = None
        self._shown: tuple[Any, ...] | None = None
        self._drawing = PlaneDrawing(np.zeros(0), ())
        self._due = False

    def needs(self, element: Element, source: FrameSource) -> tuple[Any, ...]:
        """Return all that the drawing follows from, or raise DeodarError: the element has none."""
        raise NotImplementedError

    def draw(self, needs: tuple[Any, ...]) -> PlaneDrawing:
        """Return what follows from `needs`."""
        raise NotImplementedError

    def news(self, source: FrameSource, past: PublishedState | None) -> Announced | Lost | None:
        """Return the message on the format of the stream if it changed, else None."""
        if not source.ready:
            return None
        form = self._form(source)
        if form == self._said:
            return None
        self._said, self._due = form, True
        return form

    def compute(self, source: FrameSource) -> None:
        """Compute the drawing, so that `news` finds it."""
        if source.ready:
            self._form(source)

    def frame(self, state: PublishedState, trace: Trace | None) -> bytes | None:
        """Return the frame to send, or None if no parameter changed."""
        if not isinstance(self._said, Announced) or not self._due:
            return None
        self._due = False
        values = thin(self._drawing.values, self._most, channels=False)
        return frames.pack(self.number, state.number, state.time, values)

    def _form(self, source: FrameSource) -> Announced | Lost:
        try:
            shown = self.needs(source.element(self._element), source)
        except DeodarError as error:
            self._shown = None
            return Lost(stream=self.number, problem=view.problems(error.problems[:1])[0])
        if shown != self._shown:
            self._drawing = self.draw(shown)
            self._shown, self._due = shown, True
        return Announced(
            stream=self.number,
            shape=thinned_shape(self._drawing.values.shape, self._most),
            axes=[converted.axis(a) for a in self._drawing.axes],
            rest=[converted.axis(a) for a in self._drawing.rest],
            folded=list(self._drawing.folded),
            channels=False,
        )
