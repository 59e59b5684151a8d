"""The stream of an element's interaction kernel, with its parameters as they are now."""

from __future__ import annotations

import numpy as np

from deodar.errors import DeodarError, ModelError
from deodar.live.published import PublishedState
from deodar.live.trace import Trace
from deodar.numerics.axes import Axes
from deodar.numerics.kernel_shape import kernel_shape
from deodar.numerics.kernels._base import Kernel
from deodar.server import converted, frames, view
from deodar.server.source import FrameSource
from deodar.server.stream import thin, thinned_shape
from deodar.server.to_page import Announced, Lost


class KernelStream:
    """The sum of the kernels of an element, under a number that the page chose; it reads no port."""

    request = None
    place = None

    def __init__(self, number: int, element: str, most: int = 0, other: bool = False) -> None:
        self.number, self.other = number, other
        self._element, self._most = element, most
        self._said: Announced | Lost | None = None
        self._shown: tuple[tuple[Kernel, ...], Axes] | None = None
        self._lags: Axes = ()
        self._weights = np.zeros(0)
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
        """Compute the kernel, so that `news` finds it."""
        if source.ready:
            self._form(source)

    def frame(self, state: PublishedState, trace: Trace | None) -> bytes | None:
        """Return the frame to send, or None if no parameter of the kernels changed."""
        if not isinstance(self._said, Announced) or not self._due:
            return None
        self._due = False
        values = thin(self._weights, self._most, channels=False)
        return frames.pack(self.number, state.number, state.time, values)

    def _form(self, source: FrameSource) -> Announced | Lost:
        try:
            element = source.element(self._element)
            if element.convolution is None or not element.kernels():
                raise ModelError("has no interaction kernel")
            shown = tuple(element.kernels()), source.axes((self._element, element.convolution.of))
        except DeodarError as error:
            self._shown = None
            return Lost(stream=self.number, problem=view.problems(error.problems[:1])[0])
        if shown != self._shown:
            self._lags, self._weights = kernel_shape(*shown)
            self._shown, self._due = shown, True
        return Announced(
            stream=self.number,
            shape=thinned_shape(self._weights.shape, self._most),
            axes=[converted.axis(a) for a in self._lags],
            rest=[converted.axis(a) for a in shown[1][2:]],
            folded=[],
            channels=False,
        )
