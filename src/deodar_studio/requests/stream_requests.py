"""Requests about the streams that a page watches."""

from __future__ import annotations

import asyncio
from typing import Literal

from deodar.errors import ParameterError
from deodar_studio.live.section import Section
from deodar_studio.live.trace import TraceRequest
from deodar_studio.messages.message import Id
from deodar_studio.pages.hub import Hub
from deodar_studio.pages.page import Page
from deodar_studio.requests.request import MESSAGES, Count, Request, Text, asks
from deodar_studio.streams import planes
from deodar_studio.streams.parameter_stream import ParameterStream
from deodar_studio.streams.stream import Stream

MOST_STREAMS = 2000
"""Largest number of streams of one page."""


@MESSAGES.register
class Watch(Request, frozen=True, kw_only=True, tag="watch"):
    """Send a port of an element as frames, thinned to at most `most` samples along each axis (0: all).

    The page chooses the number `stream`. `other`: of the record that the open one is compared with. `drawn`
    names the axes to send, at most two (empty: the first ones, or all of a picture); `at` states a position
    on other axes, by name and in axis units. Over the rest the maximum is taken.
    """

    stream: Count
    element: Id
    port: Text
    most: Count = 0
    other: bool = False
    drawn: tuple[Text, ...] = ()
    at: dict[Text, float] = {}

    async def serve(self, hub: Hub, page: Page) -> None:
        section = Section(self.drawn, tuple(self.at.items()))
        place = self.element, self.port
        _show(hub, page, Stream(self.stream, place, self.most, other=self.other, section=section))


@MESSAGES.register
class WatchTrace(Request, frozen=True, kw_only=True, tag="trace"):
    """Send a time course of a port: a node's value, or an array's value at a position, maximum or mean.

    `at` is in axis units; `other` as in `watch`.
    """

    stream: Count
    element: Id
    port: Text
    reduce: Literal["at", "max", "mean"] = "max"
    at: tuple[float, ...] = ()
    other: bool = False

    async def serve(self, hub: Hub, page: Page) -> None:
        request = TraceRequest((self.element, self.port), self.reduce, self.at)
        _show(hub, page, Stream(self.stream, request.place, request=request, other=self.other))


@MESSAGES.register
class WatchRows(Request, frozen=True, kw_only=True, tag="rows"):
    """Send the values of a port along one axis over time, thinned to at most `most` samples (0: all).

    `drawn` names the axis (empty: the first); `at` and `other` as in `watch`.
    """

    stream: Count
    element: Id
    port: Text
    most: Count = 0
    drawn: Text = ""
    at: dict[Text, float] = {}
    other: bool = False

    async def serve(self, hub: Hub, page: Page) -> None:
        section = Section((self.drawn,) if self.drawn else (), tuple(self.at.items()), most=1)
        request = TraceRequest((self.element, self.port), section=section)
        _show(hub, page, Stream(self.stream, request.place, self.most, request, self.other))


@asks(tag="kernel")
async def watch_kernel(
    hub: Hub, page: Page, *, stream: Count, element: Id, most: Count = 0, other: bool = False
) -> None:
    """Send the interaction kernel of an element over the lag, with its parameters as they are now.

    Of more than two axes it is sent at lag 0 on the others. `most` and `other` as in `watch`.
    """
    kernel = ParameterStream(stream, element, planes.kernel, most, other)
    # the first shape compiles the formula of the kernel, for up to seconds
    await asyncio.to_thread(kernel.compute, hub.source(page))
    _show(hub, page, kernel)


@MESSAGES.register
class WatchWeights(Request, frozen=True, kw_only=True, tag="weights"):
    """Send an array parameter that is a map from a source to a target (`Kind.maps`), as it is now.

    `most`, `drawn`, `at` and `other` as in `watch`.
    """

    stream: Count
    element: Id
    parameter: Text
    most: Count = 0
    other: bool = False
    drawn: tuple[Text, ...] = ()
    at: dict[Text, float] = {}

    async def serve(self, hub: Hub, page: Page) -> None:
        plane = planes.weights(self.parameter, Section(self.drawn, tuple(self.at.items())))
        _show(hub, page, ParameterStream(self.stream, self.element, plane, self.most, self.other))


@asks()
async def unwatch(hub: Hub, page: Page, *, stream: Count) -> None:
    """End a stream."""
    if page.streams.pop(stream, None) is not None:
        hub.watch()


def _show(hub: Hub, page: Page, stream: Stream | ParameterStream) -> None:
    """Send a stream to a page, in the place of an earlier one of its number."""
    if stream.number not in page.streams and len(page.streams) >= MOST_STREAMS:
        raise ParameterError(f"a page watches at most {MOST_STREAMS} streams")
    page.streams[stream.number] = stream
    hub.watch()
