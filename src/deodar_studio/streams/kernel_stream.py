"""The stream of an element's interaction kernel, with its parameters as they are now."""

from __future__ import annotations

from deodar.element import Element
from deodar.errors import ModelError
from deodar.numerics.axes import Axes
from deodar.numerics.kernel_shape import kernel_shape
from deodar.numerics.kernels._base import Kernel
from deodar_studio.streams.parameter_stream import ParameterStream, PlaneDrawing
from deodar_studio.streams.source import FrameSource


class KernelStream(ParameterStream):
    """The sum of the kernels of an element over the lag."""

    def needs(self, element: Element, source: FrameSource) -> tuple[tuple[Kernel, ...], Axes]:
        if element.convolution is None or not element.kernels():
            raise ModelError("has no interaction kernel")
        return tuple(element.kernels()), source.document_axes((self._element, element.convolution.of))

    def draw(self, needs: tuple[tuple[Kernel, ...], Axes]) -> PlaneDrawing:
        kernels, axes = needs
        lags, weights = kernel_shape(kernels, axes)
        return PlaneDrawing(weights, lags, axes[2:])
