"""State of one connected page."""

from __future__ import annotations

import asyncio

from deodar.server.scene import SentBodies
from deodar.server.stream import Stream


class Page:
    """State of one connected page, for requests and for the hub.

    Attributes:
        number: unique among all pages of this studio, also those that have left.
        streams: the streams that the page watches, by the numbers that the page chose.
        pushes: whether this page made the present injection of input.
        sent_bodies: the bodies of the world that the page has received; None: the page does not show them.
        news: set when there may be something to send.
    """

    def __init__(self, number: int) -> None:
        self.number = number
        self.streams: dict[int, Stream] = {}
        self.pushes = False
        self.sent_bodies: SentBodies | None = None
        self.news = asyncio.Event()

    def wake(self) -> None:
        """Make the connection check whether there is something to send."""
        self.news.set()
