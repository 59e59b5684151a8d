"""Frames by time: what pages watch, at present and in the past."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Protocol

from deodar.element import Element
from deodar.errors import ModelError, Problem
from deodar.model import find
from deodar.model.document import Document
from deodar.numerics.axes import Axes
from deodar.session.port_reader import PortKey
from deodar_studio.live.engine import Engine
from deodar_studio.live.published import PublishedState
from deodar_studio.live.ring import TimeSpan
from deodar_studio.live.trace import Trace, TraceRequest

FoundFrame = tuple[int, PublishedState]
"""The number of a moment, from 0 on, and the state at that moment."""


class FrameSource(Protocol):
    """Frames of all ports by time.

    Attributes:
        identity: differs between sources whose times have nothing to do with each other.
        ready: whether the axes of ports are known.
    """

    @property
    def identity(self) -> object: ...

    @property
    def ready(self) -> bool: ...

    @property
    def time_unit(self) -> tuple[str, float]:
        """Unit of the times, and the smallest difference of two moments."""
        ...

    def axes(self, place: PortKey) -> Axes:
        """Return the axes of a port, or raise DeodarError: the port has no frames."""
        ...

    def document_axes(self, place: PortKey) -> Axes:
        """Return the axes of a port, also where it has no frames, or raise DeodarError: they are unknown."""
        ...

    def element(self, ident: str) -> Element:
        """Return an element with its parameters as they are now, or raise DeodarError: it does not exist."""
        ...

    def absent(self, place: PortKey) -> Problem:
        """Return why a port has no frame at the moment found last."""
        ...

    def present(self) -> PublishedState | None:
        """Return the present state; None: the source has a past only."""
        ...

    def span(self) -> TimeSpan | None:
        """Return the moments that can be shown; None: none."""
        ...

    async def at(self, time: float, further: int, places: Iterable[PortKey]) -> FoundFrame | None:
        """Return the last frame up to a time, or that `further` frames later; None: there are none."""
        ...

    def trace(self, request: TraceRequest) -> Trace | None:
        """Return a time course; None: it has no samples yet."""
        ...


def element_of(document: Document, ident: str) -> Element:
    """Return an element of a document.

    Raises:
        ModelError: the document has no element of this id.
    """
    entry = document.by_id().get(ident)
    if entry is None:
        raise ModelError("the element does not exist")
    return entry.element


class RunFrames:
    """Frames of the run: of the present, and of its last minute."""

    def __init__(self, engine: Engine) -> None:
        self._engine = engine
        self._ring = engine.ring

    @property
    def identity(self) -> object:
        return self._ring

    @property
    def ready(self) -> bool:
        return self._engine.session is not None

    @property
    def time_unit(self) -> tuple[str, float]:
        session = self._engine.session
        return ("ms", 1.0) if session is None else (session.document.time_unit, session.dt)

    def axes(self, place: PortKey) -> Axes:
        session = self._engine.session
        if session is None:
            raise ModelError("no model runs yet")
        ident, port = place
        program = session.program
        entry = session.document.by_id().get(ident)
        if entry is None or ident not in program.plan.row:
            raise ModelError("the element does not exist")
        find.port(session.document, f"{entry.path}.{port}")
        try:
            return program.axes(program.port(ident, port))
        except KeyError:
            raise ModelError(f"has no port {port!r}", where=ident) from None

    def document_axes(self, place: PortKey) -> Axes:
        return self.axes(place)

    def element(self, ident: str) -> Element:
        session = self._engine.session
        if session is None:
            raise ModelError("no model runs yet")
        return element_of(session.document, ident)

    def absent(self, place: PortKey) -> Problem:
        return Problem("", "has no values at this moment, because no page watched the port")

    def present(self) -> PublishedState | None:
        return self._engine.published

    def span(self) -> TimeSpan | None:
        return self._ring.span()

    async def at(self, time: float, further: int, places: Iterable[PortKey]) -> FoundFrame | None:
        return self._ring.at(time, further)

    def trace(self, request: TraceRequest) -> Trace | None:
        return self._engine.traces.get(request)
