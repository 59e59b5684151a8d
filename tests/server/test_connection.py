"""One page, without a socket."""

from __future__ import annotations

import asyncio
from types import SimpleNamespace
from typing import Any, cast

import pytest

from deodar.server.connection import PageConnection
from deodar.server.message import Message
from deodar.server.page import Page


class Silent(PageConnection):
    """A connection that sends nothing."""

    async def _text(self, message: Message) -> None: ...

    async def _say(self) -> None: ...

    def sending(self) -> asyncio.Task[None]:
        """Return the task that sends."""
        return asyncio.create_task(self._send())


@pytest.mark.parametrize("between", range(5))
def test_the_sending_task_ends_if_its_page_disconnects_during_an_update(between: int) -> None:
    """`asyncio.wait_for` of Python 3.11 then loses the cancellation, and the task of a disconnected page
    would never end.
    """

    async def main() -> None:
        one = Silent(cast("Any", None), cast("Any", SimpleNamespace(new_page=lambda: Page(1), welcome=None)))
        task = one.sending()
        for _ in range(5):
            await asyncio.sleep(0)
        one.page.wake()
        for _ in range(between):
            await asyncio.sleep(0)
        task.cancel()
        for _ in range(10):
            await asyncio.sleep(0)
        assert task.cancelled()

    asyncio.run(main())
