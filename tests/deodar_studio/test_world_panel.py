"""The world from above, over a real socket: the messages to the page, and moves by the user."""

from __future__ import annotations

import asyncio
import base64
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest

import deodar as dd
from deodar.elements.stimuli import Boost
from deodar.elements.world_ports import Motor
from deodar.worlds.arena.arena import Arena
from deodar_robots.zenoh.served_world import ServedWorld
from deodar_studio.pages import hub
from tests.deodar_studio.page import WAIT, Page, page, play, studio

LAYOUT: dict[str, Any] = {
    "arena": {"x": [0, 3], "y": [0, 2]},
    "boxes": [{"name": "crate", "center": [0.8, 1.5], "size": [0.2, 0.2], "color": [0.7, 0.5, 0.3]}],
    "start": [0.2, 1.0],
    "goal": [2.5, 0.5],
}


@pytest.fixture
def file(tmp_path: Path) -> Path:
    """Save a model of a robot that drives straight on."""
    model = dd.Model("driving", dt=64)
    for name in ("left", "right"):
        model.add(Boost(f"go {name}", [], 1000.0)) >> model.add(Motor(name, [], name))
    dd.save(model, tmp_path / "driving.json")
    return tmp_path / "driving.json"


def scene(p: Page) -> dict[str, Any]:
    return p.said["scene"]["scene"]


def box(p: Page, name: str) -> dict[str, Any]:
    return next((b for b in scene(p)["boxes"] if b["name"] == name), {})


def path(p: Page) -> list[list[float]]:
    """Return all positions that the page received, as a page stores them."""
    out: list[list[float]] = []
    for message in p.all:
        if message["type"] == "bodies":
            out = ([] if message["fresh"] else out) + message["path"]
    return out


async def shown(p: Page) -> None:
    await p.runs()
    await p.until(lambda: p.said.get("scene", {}).get("scene"))


def test_the_page_receives_the_world_and_the_path_of_the_robot(file: Path) -> None:
    async def story(p: Page) -> None:
        await shown(p)
        assert scene(p)["unit"] == "m" and scene(p)["border"] == [0, 0, 3, 2]
        assert box(p, "crate") == {
            "name": "crate",
            "x": 0.8,
            "y": 1.5,
            "width": 0.2,
            "height": 0.2,
            "color": [0.7, 0.5, 0.3],
            "fixed": False,
        }
        assert scene(p)["marks"] == [{"name": "goal", "x": 2.5, "y": 0.5, "fixed": False}]
        assert p.said["scene"]["camera"], "an e-puck has one"
        assert p.said["scene"]["can_place"] and p.said["scene"]["picture"] is None
        assert "bodies" not in p.said, "it did not ask"
        await p.do("watch_world", on=True)
        await p.do("speed", factor=None)
        await p.do("step", n=60)
        await p.until(lambda: p.clock["tick"] == 60 and p.said["bodies"]["bodies"][0]["x"] > 0.5)
        body = p.said["bodies"]["bodies"][0]
        assert body["name"] == "e-puck" and body["radius"] == pytest.approx(0.037)
        gaps = [math.dist(a, b) for a, b in zip(path(p), path(p)[1:], strict=False)]
        assert (
            path(p)[0] == pytest.approx([0.2, 1.0])
            and len(gaps) > 5
            and math.dist(path(p)[-1], (body["x"], body["y"])) < 0.02
        )
        scenes = [m for m in p.all if m["type"] == "scene" and m["scene"]]
        assert len(scenes) == 1, "a scene without motion is sent once"
        async with page_of(p) as late:
            await late.do("watch_world", on=True)
            await late.until(lambda: path(late) == path(p))
        await p.do("reset")
        await p.until(lambda: path(p) == [pytest.approx([0.2, 1.0])])

    with studio(file.parent, file, world=Arena(LAYOUT)) as address:
        page_of.address = address  # type: ignore[attr-defined]
        play(address, story)


def page_of(p: Page) -> Any:
    """Connect a further page to the same studio."""
    return page(page_of.address)  # type: ignore[attr-defined]


def test_an_object_moved_during_the_run_stops_the_robot(file: Path) -> None:
    arena = Arena(LAYOUT)

    async def story(p: Page) -> None:
        await shown(p)
        await p.do("watch_world", on=True)
        await p.do("speed", factor=8)
        await p.do("play")
        await p.do("move_object", name="crate", x=1.2, y=1.0)
        await p.until(lambda: box(p, "crate")["x"] == 1.2)
        await p.until(lambda: p.said["bodies"]["bodies"][0]["x"] > 1.06)
        tick = p.clock["tick"]
        await p.until(lambda: p.clock["tick"] > tick + 30)
        assert p.said["bodies"]["bodies"][0]["x"] == pytest.approx(1.1 - 0.037, abs=2e-3), (
            "it is in front of the crate"
        )
        await p.do("move_object", name="goal", x=2.0, y=0.4)
        await p.until(lambda: scene(p)["marks"][0]["x"] == 2.0)
        await p.do("remove_object", name="crate")
        await p.until(lambda: not scene(p)["boxes"])
        await p.until(lambda: p.said["bodies"]["bodies"][0]["x"] > 1.3)
        await p.do("place_object", name="block", x=1.0, y=0.3, width=0.1, height=0.2, color=[0, 0, 1])
        await p.until(lambda: box(p, "block").get("height") == 0.2)
        assert box(p, "block")["color"] == [0, 0, 1]

    with studio(file.parent, file, world=arena) as address:
        play(address, story)
    assert [t.name for t in arena.objects.permanent()] == ["block"]


def test_a_position_that_does_not_fit_is_refused_and_the_object_does_not_move(file: Path) -> None:
    async def story(p: Page) -> None:
        await shown(p)
        for request, message in [
            ({"type": "move_object", "name": "crate", "x": 0.2, "y": 1.0}, "cover 'e-puck'"),
            ({"type": "move_object", "name": "crate", "x": 9, "y": 1.0}, "outside the border"),
            ({"type": "move_object", "name": "goal", "x": 0.8, "y": 1.5}, "inside 'crate'"),
            ({"type": "move_object", "name": "crat", "x": 1, "y": 1}, "'crat'"),
            ({"type": "remove_object", "name": "goal"}, "is a mark"),
            ({"type": "place_object", "name": "flat", "x": 1, "y": 1, "width": 0.1, "height": 0}, "no area"),
            (
                {"type": "place_object", "name": "b", "x": 1, "y": 1, "width": 1, "height": 1, "color": [2]},
                "red, green and blue",
            ),
        ]:
            (problem,) = (await p.ask(**request))["problems"]
            assert message in problem["what"], problem
        assert box(p, "crate")["x"] == 0.8

    with studio(file.parent, file, world=Arena(LAYOUT)) as address:
        play(address, story)


def test_an_eye_shows_its_events_and_nothing_can_be_placed(file: Path) -> None:
    model = dd.Model("turning", dt=10)
    model.add(Boost("to the right", [], 1200.0)) >> model.add(Motor("pan", [], "pan"))
    dd.save(model, file.parent / "turning.json")

    async def story(p: Page) -> None:
        await shown(p)
        assert p.said["scene"]["picture"] == {"name": "events", "columns": 128, "rows": 128}
        assert not p.said["scene"]["can_place"]
        await p.do("watch_world", on=True)
        await p.until(lambda: "bodies" in p.said)
        before = p.said["bodies"]["picture"]
        assert len(base64.b64decode(before)) == 3 * 128 * 128
        await p.do("step", n=4)
        await p.until(lambda: p.said["bodies"]["picture"] != before)
        (problem,) = (await p.ask("place_object", name="a", x=900, y=900, width=9, height=9))["problems"]
        assert "nothing can be placed in the world Eye" in problem["what"]

    with studio(file.parent, file.parent / "turning.json", world=dd.Eye()) as address:
        play(address, story)


def test_a_document_without_a_world_has_no_scene(root: Path) -> None:
    async def story(p: Page) -> None:
        await p.open("open_file", path="node.json")
        await p.do("watch_world", on=True)
        assert p.said["scene"] == {
            "type": "scene",
            "scene": None,
            "note": "",
            "camera": False,
            "solid": False,
            "can_place": False,
            "picture": None,
        }
        (problem,) = (await p.ask("move_object", name="crate", x=1, y=1))["problems"]
        assert "no world with a view from above" in problem["what"] and "--world" in problem["fix"]

    with studio(root) as address:
        play(address, story)


def test_the_past_of_the_world_is_shown_with_the_path_up_to_that_moment(file: Path) -> None:
    async def story(p: Page) -> None:
        await shown(p)
        await p.do("watch_world", on=True)
        for tick in range(5, 61, 5):
            await p.do("step", n=5)
            await p.until(lambda tick=tick: p.clock["tick"] == tick and p.clock["timeline"])
        await p.until(lambda: p.clock["timeline"]["last"] == 60 * 64)
        there, length = p.said["bodies"]["bodies"][0]["x"], len(path(p))
        await p.do("seek", time=20 * 64)
        await p.until(lambda: p.clock["timeline"]["time"] == 20 * 64)
        then = p.said["bodies"]["bodies"][0]["x"]
        assert 0.2 < then < there - 0.1
        assert 1 < len(path(p)) < length and path(p)[-1][0] == pytest.approx(then, abs=0.02)
        await p.do("seek", time=None)
        await p.until(lambda: p.said["bodies"]["bodies"][0]["x"] == there and len(path(p)) == length)

    with studio(file.parent, file, world=Arena(LAYOUT)) as address:
        play(address, story)


def test_a_world_in_another_unit_of_length_is_refused_and_its_warnings_are_shown(tmp_path: Path) -> None:
    model = dd.Model("planning", dt=64)
    plane = [dd.Axis("x", 0, 120, 25, unit="cm"), dd.Axis("y", 0, 80, 17, unit="cm")]
    place = model.add(dd.Sensor("place", [dd.Axis("of", 0, 1, 2)], sensor="place"))
    place >> model.add(dd.SpaceCode(plane, 5.0, name="own place"))
    model.add(dd.Sensor("map", plane, sensor="obstacles"))
    dd.save(model, tmp_path / "planning.json")

    async def story(one: Page) -> None:
        await one.runs()
        (problem,) = one.document["problems"]
        assert "100 times too small" in problem["what"] and problem["repair"] == "Set its gain", problem
        assert problem["element"], "the box of the element shows it"
        await one.do("use_world", kind="Arena", path="blocks", settings={"unit": "cm"})
        await one.runs()
        await one.until(lambda: not one.document["problems"] and one.said["scene"]["scene"])
        answer = await one.ask("use_world", kind="Arena", path="blocks", settings={"unit": "mm"})
        assert "10 times too large" in answer["problems"][0]["what"]
        assert one.said["scene"]["scene"]["unit"] == "cm", "the world in use stays"
        await one.do("use_world", kind="Arena", path="z", settings={"unit": "cm"})
        await one.until(lambda: "barely overlap" in one.document["problems"][0]["what"])
        assert {p["severity"] for p in one.document["problems"]} == {"warning"}

    with studio(tmp_path, tmp_path / "planning.json", world=Arena("blocks")) as address:
        play(address, story)


def test_a_preview_shows_a_world_and_the_sensors_that_the_model_lacks(tmp_path: Path) -> None:
    model = dd.Model("seeing", dt=40)
    plane = [dd.Axis("x", 0, 1, 8), dd.Axis("y", 0, 1, 6), dd.Axis("color", 0, 2, 3)]
    model.add(dd.Sensor("eye", plane, sensor="picture"))
    dd.save(model, tmp_path / "seeing.json")
    video = cv2.VideoWriter(str(tmp_path / "red.avi"), cv2.VideoWriter.fourcc(*"MJPG"), 25, (64, 48))
    for _ in range(3):
        video.write(np.full((48, 64, 3), (0, 0, 255), np.uint8))
    video.release()
    blue = np.full((48, 64, 3), (255, 0, 0), np.uint8)
    cv2.imwrite(str(tmp_path / "blue.png"), blue)
    record = dd.simulate(model, 120, world=dd.Picture(tmp_path / "blue.png"), record=["eye.output"])
    dd.save_record(record, tmp_path / "run.nc")

    async def preview(p: Page, kind: str, path: str, **settings: Any) -> dict[str, Any]:
        answer = await p.ask("preview_world", kind=kind, path=path, settings=settings)
        assert answer["problems"] == [], answer
        return answer["preview"]

    async def story(p: Page) -> None:
        await p.runs()
        before = p.clock["world"]
        for kind, path, color in [("Picture", "blue.png", 2), ("Video", "red.avi", 0)]:
            found = await preview(p, kind, path)
            pixels = np.frombuffer(base64.b64decode(found["pixels"]), np.uint8)
            pixels = pixels.reshape(found["height"], found["width"], 3)
            assert found["sensors"] == ["picture"] and found["missing"] == [] and found["scene"] is None
            assert pixels[..., color].min() > 240 and np.delete(pixels, color, axis=2).max() < 15, kind
        found = await preview(p, "Recording", "run.nc")
        assert found["sensors"] == ["picture"] and found["missing"] == [] and found["motors"] == []
        found = await preview(p, "Arena", "z", unit="cm")
        assert found["scene"]["unit"] == "cm" and found["missing"] == ["picture"]
        for kind, path, message in [
            ("Video", "nothing.avi", "no such video"),
            ("Video", "../red.avi", "outside"),
            ("Recording", "blue.png", "blue.png"),
            ("Nothing", "blue.png", "Nothing"),
        ]:
            (problem,) = (await p.ask("preview_world", kind=kind, path=path, settings={}))["problems"]
            assert message in f"{problem['where']} {problem['what']}", problem
        assert p.clock["world"] == before, "a preview does not change the world"

    with studio(tmp_path, tmp_path / "seeing.json") as address:
        play(address, story)


def test_the_page_shows_the_link_with_a_robot_in_another_process_and_a_pause_stops_it(file: Path) -> None:
    served = ServedWorld(Arena(LAYOUT), "epuck", "live")
    world = dd.Zenoh(at=served.endpoint, patience=5.0)

    async def another_link(p: Page) -> None:
        sent = p.said["robot_link"]
        await p.until(lambda: p.said["robot_link"] != sent)

    async def story(p: Page) -> None:
        await p.runs()
        await p.until(lambda: p.said.get("robot_link", {}).get("robot") == "epuck")
        await p.do("play")
        await p.until(lambda: p.said["robot_link"]["round_trip"] > 0)
        assert p.said["robot_link"]["lost"] == 0 and 0 <= p.said["robot_link"]["age"] < 5000
        await p.until(lambda: served.server.counts["accepted"] > 10)
        await p.do("pause")
        await p.until(lambda: not p.clock["running"])
        await another_link(p)  # commands that were under way have arrived
        accepted = served.server.counts["accepted"]
        await another_link(p)
        assert served.server.counts["accepted"] == accepted, "no command comes while the run is paused"

    try:
        with studio(file.parent, file, world=world) as address:
            play(address, story)
    finally:
        world.close()
        served.close()


def test_a_connected_robot_is_narrowed_and_keeps_its_limits_after_a_reset_and_in_another_page(
    file: Path,
) -> None:
    served = ServedWorld(Arena(LAYOUT), "epuck", "live")
    world = dd.Zenoh(at=served.endpoint, patience=20.0)

    def limits(p: Page) -> dict[str, tuple[Any, Any, Any]]:
        motors = p.said.get("robot_link", {}).get("motors", [])
        return {m["motor"]: (m.get("lower"), m.get("upper"), m.get("slew")) for m in motors}

    async def narrow(p: Page, **stated: Any) -> Any:
        return (await p.ask("narrow_motor", limits=stated))["problems"]

    def newest(motor: str) -> float:
        command = served.server._inbox.commands().get(motor)
        return 0.0 if command is None else float(command.value[0])

    async def story(p: Page) -> None:
        await p.runs()
        await p.until(lambda: limits(p) == {"left": (None, None, None), "right": (None, None, None)})
        assert p.said["robot_link"]["can_narrow"]
        await p.do("play")
        await until(lambda: newest("left") == newest("right") == 1000)
        assert await narrow(p, motor="left", lower=-5, upper=5) == []
        assert await narrow(p, motor="right", lower=-5, upper=50, slew=2000) == []
        assert await narrow(p, motor="right", upper=4) == []
        assert await narrow(p, motor="left", upper=70) == []
        await until(lambda: newest("left") == 5 and newest("right") == 4)
        for stated, message in [
            ({"motor": "left", "lower": 6, "upper": 9}, "no value lies within both -5 to 5 and 6 to 9"),
            ({"motor": "lift", "lower": 6, "upper": 9}, "has no motor 'lift'"),
        ]:
            (problem,) = await narrow(p, **stated)
            assert message in problem["what"], problem
        present = {"left": (-5, 5, None), "right": (-5, 4, 2000)}
        await p.until(lambda: limits(p) == present)
        await p.do("reset")
        await p.do("play")
        await until(lambda: newest("left") == 5 and newest("right") == 4)
        async with page(address) as second:
            await second.until(lambda: limits(second) == present)

    try:
        with studio(file.parent, file, world=world) as address:
            play(address, story)
    finally:
        world.close()
        served.close()


def test_a_robot_is_narrowed_before_it_gets_a_command(file: Path) -> None:
    seen: list[float] = []

    class Watched(Arena):
        def exchange(self, motors: Any, *others: Any) -> Any:
            seen.extend(float(command[0]) for command in motors.values())
            return super().exchange(motors, *others)

    served = ServedWorld(Watched(LAYOUT), "epuck", "live")
    place = {"kind": "Zenoh", "path": f"epuck, at={served.endpoint}, patience=20"}
    wide = {"unit": "", "lower": None, "upper": None, "slew": None}

    async def story(p: Page) -> None:
        await p.runs()
        previewed = await p.ask("preview_world", **place)
        assert previewed["problems"] == []
        preview = previewed["preview"]
        assert [m["motor"] for m in preview["limits"]] == ["left", "right"]
        one_end = [{"motor": "left", "upper": 3}]
        (problem,) = (await p.ask("use_world", **place, limits=one_end))["problems"]
        assert "has one end" in problem["what"]
        narrower = [
            {**wide, "motor": "left", "lower": -3, "upper": 3},
            {"motor": "right", "lower": -2, "upper": 2},
        ]
        await p.do("use_world", **place, limits=narrower)
        await p.do("play")
        await until(lambda: 3 in seen and 2 in seen)
        assert set(seen) <= {0.0, 2.0, 3.0}, "no command was wider"
        assert "is commanded by" in (await p.ask("preview_world", **place))["problems"][0]["what"]
        await p.do("use_world", kind="Arena", path="blocks")
        assert (await p.ask("preview_world", **place))["problems"] == [], "the robot was left"

    try:
        with studio(file.parent, file, world=Arena(LAYOUT)) as address:
            play(address, story)
    finally:
        served.close()


def test_the_robot_in_use_stays_where_another_one_refuses(file: Path) -> None:
    first, second = (ServedWorld(Arena(LAYOUT), name, "live") for name in ("first", "second"))
    world = dd.Zenoh(at=first.endpoint, patience=20.0)
    taken = dd.Zenoh(at=second.endpoint, patience=20.0)
    taken.reset(0)
    place = {"kind": "Zenoh", "path": f"second, at={second.endpoint}, patience=20"}

    async def story(p: Page) -> None:
        await p.runs()
        await p.do("play")
        assert "is commanded by" in (await p.ask("use_world", **place))["problems"][0]["what"]
        accepted = first.server.counts["accepted"]
        await until(lambda: first.server.counts["accepted"] > accepted + 10)
        await p.do("reset")
        assert p.said["robot_link"]["robot"] == "first"
        taken.close()
        await p.do("use_world", **place)
        await p.until(lambda: p.said["robot_link"]["robot"] == "second")

    try:
        with studio(file.parent, file, world=world) as address:
            play(address, story)
    finally:
        world.close()
        taken.close()
        first.close()
        second.close()


def test_the_preview_of_a_world_that_is_not_narrowed_has_no_limits(file: Path) -> None:
    async def story(p: Page) -> None:
        await p.runs()
        for kind, path, motors in [("Arena", "blocks", []), ("Robot", "epuck", ["left", "right"])]:
            preview = (await p.ask("preview_world", kind=kind, path=path))["preview"]
            assert [m["motor"] for m in preview["limits"]] == motors
        (problem,) = (await p.ask("narrow_motor", limits={"motor": "left", "lower": -1, "upper": 1}))[
            "problems"
        ]
        assert "the world Arena cannot narrow what its motors allow" in problem["what"]

    with studio(file.parent, file, world=Arena(LAYOUT)) as address:
        play(address, story)


@pytest.mark.parametrize(
    ("clock", "unattended", "pauses"), [("live", False, True), ("live", True, False), ("step", False, False)]
)
def test_a_run_that_moves_a_robot_pauses_when_its_last_page_has_gone(
    file: Path, monkeypatch: pytest.MonkeyPatch, clock: Any, unattended: bool, pauses: bool
) -> None:
    """A page that is loaded again in time changes nothing; a simulated world is not paused."""
    monkeypatch.setattr(hub, "ABSENT_SECONDS", 0.5)
    served = ServedWorld(Arena(LAYOUT), "epuck", clock)
    world = dd.Zenoh(at=served.endpoint, patience=5.0)
    counts = served.server.counts

    async def story(p: Page) -> None:
        await p.runs()
        await p.do("play")
        await p.until(lambda: counts["accepted"] > 10)
        async with page(address) as second:
            await p.socket.close()
            await asyncio.sleep(0.7)
            assert second.clock["running"], "a page is still there"
        await asyncio.sleep(0.1)
        async with page(address) as reloaded:
            await asyncio.sleep(0.7)
            await reloaded.until(lambda: reloaded.clock["running"])
        await asyncio.sleep(0.7)
        await until(lambda: served.server._inbox._newest == {} or not pauses)
        async with page(address) as late:
            await late.until(lambda: late.clock["running"] is not pauses)
            reasons = [problem["what"] for problem in late.clock["failure"]]
            assert any("no page was open" in reason for reason in reasons) is pauses
            await late.do("play")
            accepted = counts["accepted"]
            await late.until(lambda: counts["accepted"] > accepted + 5 and not late.clock["failure"])

    try:
        with studio(file.parent, file, world=world, unattended=unattended) as address:
            play(address, story)
    finally:
        world.close()
        served.close()


async def until(holds: Callable[[], bool]) -> None:
    """Wait until a function returns true."""
    async with asyncio.timeout(WAIT):
        while not holds():
            await asyncio.sleep(0.01)


def test_a_world_in_the_same_process_has_no_link(file: Path) -> None:
    async def story(p: Page) -> None:
        await shown(p)
        await p.do("step", n=5)
        assert "robot_link" not in p.said

    with studio(file.parent, file, world=Arena(LAYOUT)) as address:
        play(address, story)
