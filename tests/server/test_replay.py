"""The past of a run and records over a real socket: each page shows the moment that it asked for."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import deodar as dd
from tests.server.page import Page, page, play, studio


async def stepped(p: Page, steps: int, stride: int = 1) -> None:
    """Step one by one, so that every moment is published."""
    for tick in range(stride, steps + 1, stride):
        await p.do("step", n=stride)
        await p.until(lambda tick=tick: p.clock["tick"] == tick and shown(p) == tick)


def shown(p: Page, stream: int = 1) -> float:
    return p.frames[stream][0] if stream in p.frames else float("nan")


def timeline(p: Page) -> dict[str, Any]:
    return p.clock["timeline"]


def test_a_page_shows_a_moment_of_the_past_with_the_values_of_that_moment(root: Path) -> None:
    async def scene(p: Page) -> None:
        await p.runs()
        await p.do("watch", stream=1, element=p.element("u"), port="activation")
        await p.until(lambda: shown(p) == 0)
        await stepped(p, 30)
        assert timeline(p)["time"] is None and timeline(p)["last"] == 30 and timeline(p)["first"] == 0
        assert timeline(p)["full_from"] == timeline(p)["first"]
        await p.do("seek", time=12.5)
        await p.until(lambda: timeline(p)["time"] == 12)
        assert shown(p) == 12 and p.clock["tick"] == 30, "the run has not moved"
        script = dd.Session(dd.load(root / "selection.json"))
        script.step(12)
        np.testing.assert_allclose(p.frames[1][1], script.read("u.activation"), atol=1e-4)
        number = timeline(p)["frame"]
        await p.do("seek_frames", frames=-2)
        await p.until(lambda: shown(p) == 10 and timeline(p)["frame"] == number - 2)
        await p.do("seek_frames", frames=1)
        await p.until(lambda: shown(p) == 11)
        await p.do("seek_frames", frames=-(2**31))
        await p.until(lambda: shown(p) == timeline(p)["first"] == 0)
        await p.do("seek", time=1e300)
        await p.until(lambda: timeline(p)["time"] == 30)
        await p.do("seek", time=None)
        await p.until(lambda: timeline(p)["time"] is None)

    with studio(root, root / "selection.json") as address:
        play(address, scene)


def test_play_step_and_reset_return_to_the_present(root: Path) -> None:
    async def scene(p: Page) -> None:
        await p.runs()
        await p.do("watch", stream=1, element=p.element("u"), port="activation")
        for request in ({"type": "play"}, {"type": "step", "n": 1}, {"type": "reset"}):
            await p.do("pause")
            await p.do("reset")
            await p.until(lambda: p.clock["tick"] == 0 and shown(p) == 0)
            await stepped(p, 6)
            await p.do("seek", time=2)
            await p.until(lambda: timeline(p)["time"] == 2)
            await p.do(**request)
            await p.until(lambda: timeline(p) and timeline(p)["time"] is None)
            now = {"play": 7, "step": 7, "reset": 0}[str(request["type"])]
            await p.until(lambda now=now: shown(p) >= now if now else shown(p) == 0)
        assert timeline(p)["frames"] == 1, "a reset forgets the past"

    with studio(root, root / "selection.json") as address:
        play(address, scene)


def test_pages_show_moments_of_their_own(root: Path) -> None:
    async def scene(p: Page) -> None:
        await p.runs()
        await p.do("watch", stream=1, element=p.element("u"), port="activation")
        await stepped(p, 10)
        async with page(addresses[0]) as other:
            await other.runs()
            await other.do("watch", stream=1, element=p.element("u"), port="activation")
            await other.until(lambda: shown(other) == 10)
            await p.do("seek", time=4)
            await p.until(lambda: shown(p) == 4)
            await other.do("list_folder")
            assert shown(other) == 10 and timeline(other)["time"] is None
            await other.do("seek", time=7)
            await other.until(lambda: shown(other) == 7)
            await p.do("list_folder")
            assert shown(p) == 4
            await other.do("step", n=5)
            await other.until(lambda: shown(other) == 15)
            await p.until(lambda: p.clock["tick"] == 15)
            assert shown(p) == 4 and timeline(p)["last"] == 15
            await other.do("reset")
            await p.until(lambda: timeline(p) and timeline(p)["time"] is None and shown(p) == 0)

    with studio(root, root / "selection.json") as address:
        addresses = [address]
        play(address, scene)


def test_a_port_that_was_not_watched_has_no_values_at_that_moment(root: Path) -> None:
    async def scene(p: Page) -> None:
        await p.runs()
        await p.do("watch", stream=1, element=p.element("u"), port="activation")
        await stepped(p, 5)
        await p.do("watch", stream=2, element=p.element("u"), port="input")
        await p.until(lambda: shown(p, 2) == 5)
        await p.do("seek", time=3)
        await p.until(lambda: 2 in p.lost)
        assert "no page watched" in p.lost[2]["problem"]["what"] and shown(p) == 3
        p.frames.pop(2)
        await p.do("seek", time=None)
        await p.until(lambda: shown(p, 2) == 5)

    with studio(root, root / "selection.json") as address:
        play(address, scene)


@pytest.mark.parametrize("message", [{"time": "late"}, {}, {"time": [1]}])
def test_a_malformed_moment_is_refused(root: Path, message: dict[str, Any]) -> None:
    async def scene(p: Page) -> None:
        await p.runs()
        answer = await p.ask("seek", **message)
        assert "not understood" in answer["problems"][0]["what"]

    with studio(root, root / "selection.json") as address:
        play(address, scene)
