"""Streams of what follows from parameters of an element, as they are now."""

from __future__ import annotations

from typing import Any

import numpy as np

from deodar.errors import DeodarError
from deodar_studio.live.published import PublishedState
from deodar_studio.live.trace import Trace
from deodar_studio.messages import frames
from deodar_studio.messages.to_page import Announced, Lost
from deodar_studio.streams.planes import Plane, PlaneDrawing
from deodar_studio.streams.source import FrameSource
from deodar_studio.streams.stream import thin, thinned_shape
from deodar_studio.views import converted, view


class ParameterStream:
    """A stream under a number that the page chose; it reads no port.

    Args:
        number: the number.
        element: id of the element.
        plane: what is drawn of it.
        most: largest number of samples along an axis; 0: all.
        other: whether the stream is of the record that the open one is compared with.
    """

    request = None
    place = None

    def __init__(self, number: int, element: str, plane: Plane, most: int = 0, other: bool = False) -> None:
        self.number, self.other = number, other
        self._element, self._plane, self._most = element, plane, most
        self._said: Announced | Lost | None = None
        self._shown: Any = None
        self._drawing = PlaneDrawing(np.zeros(0), ())
        self._due = False

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
            shown, draw = self._plane(
                source.element(self._element), lambda port: source.document_axes((self._element, port))
            )
        except DeodarError as error:
            self._shown = None
            return Lost(stream=self.number, problem=view.problems(error.problems[:1])[0])
        if shown != self._shown:
            self._drawing, self._shown, self._due = draw(), shown, True
        return Announced(
            stream=self.number,
            shape=thinned_shape(self._drawing.values.shape, self._most),
            axes=[converted.axis(a) for a in self._drawing.axes],
            rest=[converted.axis(a) for a in self._drawing.rest],
            folded=list(self._drawing.folded),
            channels=False,
        )
