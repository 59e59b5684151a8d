"""The stream of an array parameter that is a map from a source to a target."""

from __future__ import annotations

from deodar.element import Element
from deodar.errors import ModelError
from deodar.numerics.axes import Axes, describe, shape
from deodar.parameters import FrozenArray
from deodar_studio.live.section import Section
from deodar_studio.streams.parameter_stream import ParameterStream, PlaneDrawing
from deodar_studio.streams.source import FrameSource


class WeightsStream(ParameterStream):
    """A section of the array, as it is now.

    Args:
        parameter: the parameter, one of `Element.maps`.
        section: the part of the array that the page draws.
        number, element, most, other: as in `ParameterStream`.
    """

    def __init__(
        self,
        number: int,
        element: str,
        parameter: str,
        section: Section,
        most: int = 0,
        other: bool = False,
    ) -> None:
        super().__init__(number, element, most, other)
        self._parameter, self._section = parameter, section

    def needs(self, element: Element, source: FrameSource) -> tuple[FrozenArray, Axes]:
        ports = element.maps.get(self._parameter, ())
        array = getattr(element, self._parameter, None)
        if not ports or not isinstance(array, FrozenArray):
            raise ModelError(f"has no weights {self._parameter!r}")
        axes = tuple(a for port in ports for a in source.document_axes((self._element, port)))
        if array.shape != shape(axes):
            raise ModelError(
                f"{self._parameter} has shape {list(array.shape)}, which does not fit {describe(axes)}"
            )
        return array, axes

    def draw(self, needs: tuple[FrozenArray, Axes]) -> PlaneDrawing:
        array, axes = needs
        section = self._section
        drawn, rest = section.split(axes)
        folded = tuple(a.name for a in section.folded(axes))
        return PlaneDrawing(section.take(array.data, axes), drawn, rest, folded)
