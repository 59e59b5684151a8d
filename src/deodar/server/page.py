"""State of one page that is connected to the studio."""

from __future__ import annotations

import asyncio

from deodar.server.scene import Follower
from deodar.server.stream import Stream


class Page:
    """What requests and the hub know of one page.

    Attributes:
        number: unique among all pages of this studio, also those that ended.
        streams: the streams that the page watches, by its numbers.
        pushes: whether the present injection of input is this page's.
        follower: the bodies of the world as the page knows them; None: it does not show them.
        news: set when there may be something to send.
    """

    def __init__(self, number: int) -> None:
        self.number = number
        self.streams: dict[int, Stream] = {}
        self.pushes = False
        self.follower: Follower | None = None
        self.news = asyncio.Event()

    def wake(self) -> None:
        """Check whether there is something to send."""
        self.news.set()
