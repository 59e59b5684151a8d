"""State of one connected page."""

from __future__ import annotations

import asyncio
import dataclasses as dc
import math

from deodar_studio.live.published import PublishedState
from deodar_studio.streams.parameter_stream import ParameterStream
from deodar_studio.streams.record_frames import RecordFrames
from deodar_studio.streams.stream import Stream
from deodar_studio.world.scene import SentBodies


@dc.dataclass(frozen=True)
class MomentRequest:
    """The moment that a page asks for: the frame up to `time`, or that `further` frames later.

    None: the present.
    """

    time: float | None
    further: int = 0


class Page:
    """State of one connected page, for requests and for the hub.

    Attributes:
        number: unique among all pages of this studio, also those that have left.
        streams: the streams that the page watches, by the numbers that the page chose.
        pushes: whether this page made the present injection of input.
        pushed: bodies of the world that this page pushes.
        sent_bodies: the bodies of the world that the page has received; None: the page does not show them.
        identity: the source of frames that `asked` and `moment` refer to.
        asked: the moment that the page asked for since the last exchange.
        moment: the state that the page shows; None: the present.
        frames: the frames of the open record, for this page; None: no record is open.
        others: the frames of the record that it is compared with.
        news: set when there may be something to send.
    """

    def __init__(self, number: int) -> None:
        self.number = number
        self.streams: dict[int, Stream | ParameterStream] = {}
        self.pushes = False
        self.pushed: set[str] = set()
        self.sent_bodies: SentBodies | None = None
        self.identity: object = None
        self.asked: MomentRequest | None = None
        self.moment: PublishedState | None = None
        self.frames: RecordFrames | None = None
        self.others: RecordFrames | None = None
        self.news = asyncio.Event()

    def wake(self) -> None:
        """Make the connection check whether there is something to send."""
        self.news.set()

    def seek(self, time: float | None, further: int = 0) -> None:
        """Ask for the frame up to a time, or that `further` frames later; None: for the present."""
        self.asked = MomentRequest(time, further)
        self.wake()

    def seek_further(self, frames: int) -> None:
        """Ask for the moment that is this number of frames later than the one shown or asked for."""
        at = self.asked or MomentRequest(None if self.moment is None else self.moment.time)
        self.seek(math.inf if at.time is None else at.time, at.further + frames)
