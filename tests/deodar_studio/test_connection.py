"""One page, without a socket."""

from __future__ import annotations

import asyncio
from types import SimpleNamespace
from typing import Any, cast

import pytest

from deodar.errors import DocumentError
from deodar_studio.messages.message import Message
from deodar_studio.messages.to_page import Answer, ListedProblem
from deodar_studio.pages.page import Page
from deodar_studio.project.confirmation import ConfirmationRequired
from deodar_studio.requests.request import Request
from deodar_studio.web.connection import PageConnection


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


class Said:
    """A socket with messages of a page that then disconnects."""

    def __init__(self, *texts: str) -> None:
        self.left = [{"type": "websocket.receive", "text": text} for text in texts]

    async def receive(self) -> dict[str, str]:
        return self.left.pop(0) if self.left else {"type": "websocket.disconnect"}


def test_the_next_frames_follow_when_the_page_has_drawn_the_last_ones() -> None:
    requests: list[bool] = []
    hub = SimpleNamespace(
        new_page=lambda: Page(1), engine=SimpleNamespace(want=lambda: requests.append(True))
    )

    async def ready_after(frame: int) -> bool:
        connection = PageConnection(
            cast("Any", Said(f'{{"type": "drawn", "frame": {frame}}}')), cast("Any", hub)
        )
        connection._exchange, connection._ready = 3, False
        await connection._receive()
        return connection._ready

    assert not asyncio.run(ready_after(2)) and not requests
    assert asyncio.run(ready_after(3)) and requests == [True]


@pytest.mark.parametrize(
    ("outcome", "expected"),
    [
        ([Answer(request=7)], Answer(request=7)),
        (ConfirmationRequired("replace"), Answer(request=7, ask="replace")),
        (
            DocumentError("is broken", where="a", fix="Write it again"),
            Answer(request=7, problems=[ListedProblem(what="is broken", where="a", fix="Write it again")]),
        ),
        (
            FileNotFoundError(2, "No such file", "x.json"),
            Answer(request=7, problems=[ListedProblem(what="No such file: x.json")]),
        ),
        (OSError("full"), Answer(request=7, problems=[ListedProblem(what="full")])),
    ],
    ids=["answer", "question", "error", "file", "disk"],
)
def test_a_request_with_a_number_is_answered_and_one_without_is_not(
    outcome: list[Answer] | Exception, expected: Answer, monkeypatch: pytest.MonkeyPatch
) -> None:
    async def answers(request: Request, hub: object, page: object) -> list[Answer]:
        if isinstance(outcome, Exception):
            raise outcome
        return outcome

    async def main() -> list[Any]:
        socket = Said(
            '{"type": "pause", "request": 7}', '{"type": "pause"}', '{"type": "nonsense", "request": 9}'
        )
        hub = SimpleNamespace(
            new_page=lambda: Page(1), project=SimpleNamespace(history=SimpleNamespace(model=None))
        )
        one = PageConnection(cast("Any", socket), cast("Any", hub))
        await one._receive()
        return list(one._answers)

    monkeypatch.setattr(Request, "answers", answers)
    first, *rest, last = asyncio.run(main())
    assert first == expected and not rest
    assert last.request == 9 and "is not understood" in last.problems[0].what


class Failing(PageConnection):
    """A connection that cannot make its messages."""

    async def _say(self) -> None:
        raise NotImplementedError("no axes")

    async def sending(self) -> None:
        """Send until the page disconnects."""
        await self._send()


def failing(error: Exception | None) -> Failing:
    """Return a connection whose socket raises an error."""

    async def send_text(text: str) -> None:
        if error is not None:
            raise error

    hub = SimpleNamespace(new_page=lambda: Page(1), welcome=Answer(request=1))
    return Failing(cast("Any", SimpleNamespace(send_text=send_text)), cast("Any", hub))


@pytest.mark.parametrize("error", [RuntimeError("closed"), OSError("reset")])
def test_an_error_of_the_socket_means_that_the_page_has_disconnected(error: Exception) -> None:
    assert asyncio.run(failing(error).sending()) is None


def test_an_error_of_a_message_is_not_taken_for_a_page_that_has_disconnected() -> None:
    """A page whose messages cannot be made would wait without an end if their errors were hidden."""
    with pytest.raises(NotImplementedError, match="no axes"):
        asyncio.run(failing(None).sending())
