"""Handlers of requests about the streams that a page watches."""

from __future__ import annotations

import asyncio

from deodar.errors import ParameterError
from deodar_studio.live.section import Section
from deodar_studio.live.trace import TraceRequest
from deodar_studio.messages import to_server
from deodar_studio.pages.hub import Hub
from deodar_studio.pages.page import Page
from deodar_studio.requests.handlers import handles
from deodar_studio.streams.kernel_stream import KernelStream
from deodar_studio.streams.stream import Stream
from deodar_studio.streams.weights_stream import WeightsStream

MOST_STREAMS = 2000
"""Largest number of streams of one page."""


@handles(to_server.Watch)
async def _watch(hub: Hub, page: Page, m: to_server.Watch) -> None:
    _require_room(hub, page, m.stream)
    section = Section(tuple(m.drawn), tuple(m.at.items()))
    page.streams[m.stream] = Stream(m.stream, (m.element, m.port), m.most, other=m.other, section=section)
    hub.watch()


@handles(to_server.WatchTrace)
async def _trace(hub: Hub, page: Page, m: to_server.WatchTrace) -> None:
    _require_room(hub, page, m.stream)
    place = (m.element, m.port)
    page.streams[m.stream] = Stream(
        m.stream, place, request=TraceRequest(place, m.reduce, tuple(m.at)), other=m.other
    )
    hub.watch()


@handles(to_server.WatchRows)
async def _rows(hub: Hub, page: Page, m: to_server.WatchRows) -> None:
    _require_room(hub, page, m.stream)
    place = (m.element, m.port)
    section = Section((m.drawn,) if m.drawn else (), tuple(m.at.items()), most=1)
    request = TraceRequest(place, section=section)
    page.streams[m.stream] = Stream(m.stream, place, m.most, request, m.other)
    hub.watch()


@handles(to_server.WatchKernel)
async def _kernel(hub: Hub, page: Page, m: to_server.WatchKernel) -> None:
    _require_room(hub, page, m.stream)
    stream, source = KernelStream(m.stream, m.element, m.most, m.other), hub.source(page)
    # the first shape compiles the formula of the kernel, for up to seconds
    await asyncio.to_thread(stream.compute, source)
    page.streams[m.stream] = stream
    hub.watch()


@handles(to_server.WatchWeights)
async def _weights(hub: Hub, page: Page, m: to_server.WatchWeights) -> None:
    _require_room(hub, page, m.stream)
    section = Section(tuple(m.drawn), tuple(m.at.items()))
    page.streams[m.stream] = WeightsStream(m.stream, m.element, m.parameter, section, m.most, m.other)
    hub.watch()


@handles(to_server.Unwatch)
async def _unwatch(hub: Hub, page: Page, m: to_server.Unwatch) -> None:
    if page.streams.pop(m.stream, None) is not None:
        hub.watch()


def _require_room(hub: Hub, page: Page, stream: int) -> None:
    if stream not in page.streams and len(page.streams) >= MOST_STREAMS:
        raise ParameterError(f"a page watches at most {MOST_STREAMS} streams")
