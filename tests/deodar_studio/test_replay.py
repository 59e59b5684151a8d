"""The past of a run and records over a real socket: each page shows the moment that it asked for."""

from __future__ import annotations

import asyncio
import json
import shutil
import threading
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import deodar as dd
from deodar.progress import Progress
from deodar.recording import folder, writer_lock
from deodar.recording.growing import GrowingRecord
from deodar.worlds.arena.arena import Arena
from deodar_studio.live import branch_states
from deodar_studio.pages import hub
from deodar_studio.project import run
from tests.deodar_studio.page import Page, page, play, studio


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
        async with page(addresses[0]) as visitor:
            await visitor.runs()
            await visitor.do("watch", stream=1, element=p.element("u"), port="activation")
            await visitor.until(lambda: shown(visitor) == 10)
            await p.do("seek", time=4)
            await p.until(lambda: shown(p) == 4)
            await visitor.do("list_folder")
            assert shown(visitor) == 10 and timeline(visitor)["time"] is None
            await visitor.do("seek", time=7)
            await visitor.until(lambda: shown(visitor) == 7)
            await p.do("list_folder")
            assert shown(p) == 4
            await visitor.do("step", n=5)
            await visitor.until(lambda: shown(visitor) == 15)
            await p.until(lambda: p.clock["tick"] == 15)
            assert shown(p) == 4 and timeline(p)["last"] == 15
            await visitor.do("reset")
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


# -------------------------------------------------------------------------------------------------- records


def recorded(root: Path, **options: Any) -> Any:
    """Write a record of an example as `deodar run` does, and return it."""
    model = dd.load(root / "selection.json")
    chosen: dict[str, Any] = {"duration": 60, "record": ["u.activation", "left.output"], "every": 2}
    record = dd.simulate(model, **chosen | options)
    folder.write(record, model.document, root / "selection-001", "zarr")
    return record


def record_view(p: Page) -> dict[str, Any]:
    return p.document["record"]


async def shows(p: Page) -> None:
    await p.until(lambda: p.said.get("opened", {}).get("document") and timeline(p))


@pytest.mark.parametrize("name", ["selection-001", "selection-001/record.zarr"])
def test_a_record_opens_with_its_document_and_every_frame(root: Path, name: str) -> None:
    record = recorded(root)

    async def scene(p: Page) -> None:
        await shows(p)
        assert record_view(p) == {
            "path": name,
            "growing": False,
            "complete": True,
            "notes": [],
            "copies": [],
            "ports": {p.element("u"): ["activation"], p.element("left"): ["output"]},
        }
        assert (timeline(p)["first"], timeline(p)["last"], timeline(p)["frames"]) == (0, 60, 31)
        assert timeline(p)["time"] == 0 and timeline(p)["second"] == 1000 and timeline(p)["step"] == 2
        await p.do("watch", stream=1, element=p.element("u"), port="activation")
        await p.do("watch", stream=2, element=p.element("u"), port="output")
        await p.until(lambda: 1 in p.frames and 2 in p.lost)
        assert "not recorded" in p.lost[2]["problem"]["what"]
        for time in (0, 31, 60, 12):
            await p.do("seek", time=time)
            await p.until(lambda time=time: timeline(p)["time"] == time // 2 * 2 == shown(p))
            expected = record["u.activation"].sel(time=time // 2 * 2).values
            np.testing.assert_allclose(p.frames[1][1], expected, rtol=1e-6)
        await p.do("seek_frames", frames=-3)
        await p.until(lambda: shown(p) == 6)
        await p.do("trace", stream=3, element=p.element("u"), port="activation", reduce="max")
        await p.until(lambda: len(p.samples.get(3, [])) == 31)
        course = record["u.activation"].max("x").values
        np.testing.assert_allclose([v for _, v in p.samples[3]], course, rtol=1e-6)
        assert [t for t, _ in p.samples[3]] == list(range(0, 61, 2))
        await p.do("rows", stream=4, element=p.element("u"), port="activation")
        await p.until(lambda: p.rows[4] is not None and len(p.rows[4]) == 31)
        rows = p.rows[4]
        assert rows is not None and rows[:, 0].tolist() == list(range(0, 61, 2))
        np.testing.assert_allclose(rows[:, 1:], record["u.activation"], rtol=1e-6)

    with studio(root, root / name) as address:
        play(address, scene)


def test_a_record_neither_runs_nor_changes_and_its_model_can_be_run(root: Path) -> None:
    recorded(root)

    async def scene(p: Page) -> None:
        await p.do("open_file", path="selection-001")
        await shows(p)
        for request in ({"type": "play"}, {"type": "step", "n": 1}, {"type": "undo"}):
            answer = await p.ask(**request)
            assert "a record" in answer["problems"][0]["what"]
        change = {"element": p.element("u"), "parameter": "tau", "value": 5.0}
        assert "a record" in (await p.ask("set", **change))["problems"][0]["what"]
        await p.do("arrange", layout={"panels": {}}, undoable=False)
        assert not p.document["unsaved"]
        await p.open("open_record_model")
        assert p.document["record"] is None and p.document["file"] == ""
        await p.do("step", n=3)
        await p.until(lambda: p.clock["tick"] == 3)
        assert (await p.ask("open_record_model"))["problems"]

    with studio(root) as address:
        play(address, scene)


def test_each_page_chooses_a_trial_and_a_point_of_a_sweep(root: Path) -> None:
    record = recorded(root, trials=3, sweep={"left.amplitude": [2, 6]})

    async def scene(p: Page) -> None:
        await shows(p)
        names = ["left.amplitude", "trial"]
        assert [(c["name"], c["values"]) for c in record_view(p)["copies"]] == [
            (names[0], ["2", "6"]),
            (names[1], ["0", "1", "2"]),
        ]
        await p.do("watch", stream=1, element=p.element("u"), port="activation")
        await p.do("trace", stream=2, element=p.element("u"), port="activation", reduce="max")
        async with page(addresses[0]) as other:
            await other.until(lambda: timeline(other))
            await other.do("watch", stream=1, element=p.element("u"), port="activation")
            await p.do("choose_copy", dimension="trial", index=2)
            await p.do("choose_copy", dimension="left.amplitude", index=1)
            await p.do("seek", time=60)
            await p.until(lambda: shown(p) == 60)
            await other.do("seek", time=60)
            await other.until(lambda: shown(other) == 60)
            for one, where in ((p, {"trial": 2, names[0]: 1}), (other, {"trial": 0, names[0]: 0})):
                expected = record["u.activation"].isel(where).sel(time=60).values
                np.testing.assert_allclose(one.frames[1][1], expected, rtol=1e-6)
        course = record["u.activation"].isel({"trial": 2, names[0]: 1}).max("x").values
        await p.until(lambda: np.allclose([v for _, v in p.samples[2]][-31:], course, rtol=1e-6))
        assert (await p.ask("choose_copy", dimension="noise", index=0))["problems"]

    with studio(root, root / "selection-001") as address:
        addresses = [address]
        play(address, scene)


def test_a_record_that_is_damaged_or_not_one_is_refused_with_one_error(root: Path) -> None:
    recorded(root)
    (root / "empty").mkdir()
    (root / "broken.zarr").mkdir()
    (root / "broken.zarr" / "zarr.json").write_text("{")
    record = dd.load_record(root / "selection-001")
    document = json.loads(record.attrs["deodar"])
    document["document"]["deodar"] = 99
    dd.save_record(record.assign_attrs(deodar=json.dumps(document)), root / "newer.zarr")
    dd.save_record(record.assign_attrs(deodar="{"), root / "torn.zarr")

    async def scene(p: Page) -> None:
        for name, what in (
            ("empty", "without a record"),
            ("broken.zarr", "damaged"),
            ("torn.zarr", "damaged"),
            ("newer.zarr", "version 99"),
        ):
            await p.do("open_file", path=name)
            await p.until(lambda name=name: p.said["file_problems"]["file"].endswith(name))
            problems = p.said["file_problems"]["problems"]
            assert len(problems) == 1 and what in problems[0]["what"], problems
            assert p.document is None

    with studio(root) as address:
        play(address, scene)


def test_a_record_runs_on_from_any_of_its_moments_to_the_bits_of_its_run(root: Path) -> None:
    whole = recorded(root, duration=2000, every=1, record=["u.activation"])["u.activation"]

    async def scene(p: Page) -> None:
        await shows(p)
        await p.do("speed", factor=0.01)
        await p.do("run_record_from", time=20.4)
        await p.until(lambda: p.document and p.document["record"] is None and p.clock["running"])
        await p.do("pause")
        await p.do("watch", stream=1, element=p.element("u"), port="activation")
        await p.until(lambda: not p.clock["running"] and shown(p) == p.clock["time"])
        first = shown(p)
        assert first >= 20
        np.testing.assert_array_equal(p.frames[1][1], whole.sel(time=first).values)
        await p.do("step", n=3)
        await p.until(lambda: shown(p) == first + 3)
        np.testing.assert_array_equal(p.frames[1][1], whole.sel(time=first + 3).values)
        assert not p.document["unsaved"] and p.document["file"] == ""

    with studio(root, root / "selection-001") as address:
        play(address, scene)


def test_a_record_of_trials_does_not_run_on(root: Path) -> None:
    recorded(root, trials=2)

    async def scene(p: Page) -> None:
        await shows(p)
        answer = await p.ask("run_record_from", time=20)
        assert "several trials" in answer["problems"][0]["what"]
        await p.until(lambda: p.clock["busy"] == "")
        assert record_view(p)["complete"]

    with studio(root, root / "selection-001") as address:
        play(address, scene)


def test_another_document_ends_the_repetition_of_a_record(
    root: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    recorded(root)
    begun, go = threading.Event(), threading.Event()

    def session_at(path: Path, time: float, trust: bool, on: dd.Resources) -> None:
        begun.set()
        go.wait(20)
        assert callable(on.progress)
        on.progress(Progress(1, 2))

    monkeypatch.setattr(run, "session_at", session_at)

    async def scene(p: Page) -> None:
        await shows(p)
        waiting = asyncio.create_task(p.ask("run_record_from", time=20))
        await asyncio.to_thread(begun.wait, 20)
        await p.do("open_file", path="selection.json")
        await p.until(lambda: p.document and not record_view(p))
        go.set()
        answer = await waiting
        assert "another request" in answer["problems"][0]["what"]

    with studio(root, root / "selection-001") as address:
        play(address, scene)


def test_a_record_that_grows_is_followed_to_its_end(root: Path) -> None:
    record = recorded(root)
    document = json.loads(record.attrs["deodar"])
    empty = record.isel(time=slice(0, 0)).assign_attrs(deodar=json.dumps({**document, "complete": False}))
    path = root / "growing.zarr"
    growing = GrowingRecord(path, empty)

    def add(first: int, last: int) -> None:
        part = record.isel(time=slice(first, last))
        arrays = {str(name): v.values for name, v in part.data_vars.items()}
        growing.put("time", part["time"].values, arrays)
        growing.commit()

    add(0, 5)

    async def scene(p: Page) -> None:
        await shows(p)
        assert not record_view(p)["complete"] and record_view(p)["growing"]
        assert "still being written" in record_view(p)["notes"][0]
        assert timeline(p)["last"] == 8
        await p.do("watch", stream=1, element=p.element("u"), port="activation")
        await p.do("seek", time=8)
        await p.until(lambda: shown(p) == 8)
        add(5, 20)
        await p.until(lambda: timeline(p)["last"] == 38 == shown(p))
        np.testing.assert_array_equal(p.frames[1][1], record["u.activation"].values[19])
        await p.do("seek", time=20)
        await p.until(lambda: shown(p) == 20)
        add(20, 31)
        await p.until(lambda: timeline(p)["last"] == 60)
        assert shown(p) == timeline(p)["time"] == 20, "a page that is not at the end stays where it is"
        growing.close(True)
        await p.until(lambda: record_view(p)["complete"] and not record_view(p)["notes"])

    with studio(root, path) as address:
        play(address, scene)


def test_a_record_whose_writer_was_killed_is_incomplete(root: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(writer_lock, "CERTAIN_SECONDS", 0.1)
    monkeypatch.setattr(hub, "FOLLOW_SECONDS", 0.1)
    record = recorded(root)
    path = root / "growing.zarr"
    growing = GrowingRecord(path, record.isel(time=slice(0, 0)))
    part = record.isel(time=slice(0, 5))
    growing.put("time", part["time"].values, {str(name): v.values for name, v in part.data_vars.items()})
    growing.commit()

    async def scene(p: Page) -> None:
        await shows(p)
        assert record_view(p)["growing"]
        growing._unlock()  # the system does so when a process is killed
        await p.until(lambda: not record_view(p)["growing"])
        assert "is incomplete" in record_view(p)["notes"][0]

    with studio(root, path) as address:
        play(address, scene)
    growing.abandon()


def test_a_record_with_a_damaged_part_opens_up_to_there_and_says_so(root: Path) -> None:
    record = recorded(root)
    path = root / "growing.zarr"
    growing = GrowingRecord(path, record.isel(time=slice(0, 0)))
    for first in (0, 10, 20):
        part = record.isel(time=slice(first, first + 10))
        arrays = {str(name): v.values for name, v in part.data_vars.items()}
        growing.put("time", part["time"].values, arrays)
        growing.commit()
    growing.close(True)
    for chunk in (path / "u.activation" / "c").rglob("*"):
        if chunk.is_file():
            chunk.write_bytes(b"damaged")

    async def scene(p: Page) -> None:
        await shows(p)
        await p.do("watch", stream=1, element=p.element("u"), port="activation")
        await p.do("watch", stream=2, element=p.element("left"), port="output")
        await p.until(lambda: 1 in p.lost and 2 in p.frames)
        assert "cannot be read at this moment" in p.lost[1]["problem"]["what"]

    with studio(root, path) as address:
        play(address, scene)


def test_a_record_without_the_chunks_of_its_samples_says_so(root: Path) -> None:
    record = recorded(root)
    path = root / "growing.zarr"
    growing = GrowingRecord(path, record.isel(time=slice(0, 0)))
    growing.put("time", record["time"].values, {str(name): v.values for name, v in record.data_vars.items()})
    growing.close(True)
    shutil.rmtree(path / "u.activation" / "c")

    async def scene(p: Page) -> None:
        await p.until(lambda: p.said.get("opened", {}).get("document"))
        assert "31 of 31 samples of time are left out" in record_view(p)["notes"][0]
        await p.do("watch", stream=1, element=p.element("u"), port="activation")
        await p.until(lambda: 1 in p.lost)
        assert timeline(p) is None
        await p.do("seek", time=5)
        await p.do("seek_frames", frames=1)
        await p.until(lambda: timeline(p) is None)

    with studio(root, path) as address:
        play(address, scene)


def test_records_are_listed_beside_folders_and_documents(root: Path) -> None:
    recorded(root)
    (root / "other").mkdir()

    async def scene(p: Page) -> None:
        await p.do("list_folder")
        assert p.said["folder"]["records"] == ["selection-001"] and p.said["folder"]["folders"] == ["other"]
        await p.do("list_folder", path="selection-001")
        assert p.said["folder"]["records"] == ["record.zarr"]
        await p.do("open_file", path="selection-001")
        await shows(p)
        await p.do("close")
        await p.until(lambda: p.said["gallery"]["recent"] == ["selection-001"])

    with studio(root) as address:
        play(address, scene)


def test_two_records_are_compared_and_shown_at_one_moment(root: Path) -> None:
    record = recorded(root)
    other = record.copy(deep=True)
    other["u.activation"].values[20, 30] += 1
    other["u.activation"].values[25:] = np.nan
    dd.save_record(other, root / "other.zarr")
    dd.save_record(record, root / "same.zarr")
    dd.save_record(record.isel(time=slice(10))[["u.activation"]], root / "short.zarr")

    def said(p: Page, path: str) -> bool:
        known = p.said["comparison"]
        return bool(known["path"] == path and known["progress"] == 1)

    async def scene(p: Page) -> None:
        await shows(p)
        assert p.said["comparison"]["path"] == ""
        await p.do("compare_record", path="other.zarr")
        await p.until(lambda: said(p, "other.zarr"))
        found = p.said["comparison"]
        assert found["compared"] == 2 and not found["notes"] and not found["problems"]
        first = record["u.activation"].values[20, 30]
        assert found["differences"] == [
            {
                "element": p.element("u"),
                "path": "u.activation",
                "time": 40,
                "copy": {},
                "at": "x 30 deg",
                "value": pytest.approx(first),
                "other": pytest.approx(first + 1),
            }
        ]
        await p.do("watch", stream=1, element=p.element("u"), port="activation")
        await p.do("watch", stream=2, element=p.element("u"), port="activation", other=True)
        await p.do(
            "trace", stream=3, element=p.element("u"), port="activation", at=[30], reduce="at", other=True
        )
        for time in (38, 40):
            await p.do("seek", time=time)
            await p.until(lambda time=time: shown(p) == shown(p, 2) == time)
            gap = p.frames[2][1] - p.frames[1][1]
            assert np.abs(gap).max() == pytest.approx(float(time == 40), abs=1e-5)
        await p.until(lambda: len(p.samples.get(3, [])) == 31)
        assert p.samples[3][20][1] == pytest.approx(first + 1)
        await p.do("compare_record", path="same.zarr")
        await p.until(lambda: said(p, "same.zarr"))
        assert p.said["comparison"]["differences"] == []
        await p.do("compare_record", path="short.zarr")
        await p.until(lambda: said(p, "short.zarr"))
        alone, moments = p.said["comparison"]["notes"]
        assert alone == "Not compared: 1 ports of the open record, 0 of the other."
        assert moments == "The moments differ (0 to 60 and 0 to 18 ms); those that both have are compared."
        await p.do("end_comparison")
        await p.until(lambda: p.said["comparison"]["path"] == "")
        answer = await p.ask("compare_record", path="selection.json")
        assert "not a record" in answer["problems"][0]["what"]
        await p.open("open_record_model")
        assert "no record is open" in (await p.ask("compare_record", path="same.zarr"))["problems"][0]["what"]

    with studio(root, root / "selection-001") as address:
        play(address, scene)


# ------------------------------------------------------------------------------------- worlds of records


def driven(folder: Path, *ports: str) -> Any:
    """Write a record of a robot that drives in an arena."""
    model = dd.Model("driving", dt=64)
    for name, amplitude in (("left", 1000.0), ("right", 800.0)):
        model.add(dd.Boost(f"go {name}", [], amplitude)) >> model.add(dd.Motor(name, [], name))
    model.add(dd.Sensor("pose", [dd.Axis("of", 0, 2, 3)], "pose"))
    how: dict[str, Any] = {"world": Arena(LAYOUT), "record": list(ports)}
    record = dd.simulate(model, duration=3200, **how)
    dd.save_record(record, folder / "drive.zarr")
    return record


LAYOUT: dict[str, Any] = {
    "arena": {"x": [0, 3], "y": [0, 2]},
    "boxes": [{"name": "crate", "center": [0.8, 1.5], "size": [0.2, 0.2], "color": [0.7, 0.5, 0.3]}],
    "start": [0.2, 1.0],
    "goal": [2.5, 0.5],
}


def test_the_body_of_a_recorded_world_is_where_its_pose_was_recorded(tmp_path: Path) -> None:
    pose = driven(tmp_path, "pose.output")["pose.output"]

    async def scene(p: Page) -> None:
        await shows(p)
        await p.do("watch_world", on=True)
        await p.until(lambda: "bodies" in p.said)
        seen = p.said["scene"]
        assert seen["note"] == "" and seen["scene"]["boxes"][0]["fixed"] and seen["scene"]["border"][2] == 3
        for time in (0, 1280, 3200, 640):
            await p.do("seek", time=time)
            await p.until(lambda time=time: timeline(p)["time"] == time)
            x, y, heading = pose.sel(time=time).values
            body = p.said["bodies"]["bodies"][0]
            assert (body["x"], body["y"], body["heading"]) == pytest.approx((x, y, heading), abs=1e-5)
        path: list[list[float]] = []
        for m in p.all:
            if m["type"] == "bodies":
                path = ([] if m["fresh"] else path) + m["path"]
        assert path == [pytest.approx(list(pose.values[k, :2]), abs=1e-5) for k in range(11)]

    with studio(tmp_path, tmp_path / "drive.zarr") as address:
        play(address, scene)


def test_a_recorded_world_without_a_pose_says_so(tmp_path: Path) -> None:
    driven(tmp_path, "left.input")

    async def scene(p: Page) -> None:
        await shows(p)
        await p.do("watch_world", on=True)
        await p.until(lambda: "scene" in p.said and "bodies" in p.said)
        assert "was not recorded" in p.said["scene"]["note"] and p.said["bodies"]["bodies"] == []
        assert p.said["scene"]["scene"]["boxes"][0]["name"] == "crate"

    with studio(tmp_path, tmp_path / "drive.zarr") as address:
        play(address, scene)


# -------------------------------------------------------------------------------------------------- branches


def test_a_run_continues_from_a_moment_with_the_parameters_of_that_moment(root: Path) -> None:
    async def scene(p: Page) -> None:
        await p.runs()
        u = p.element("u")
        await p.do("watch", stream=1, element=u, port="activation")
        await p.do("trace", stream=2, element=u, port="activation", reduce="max")
        await stepped(p, 20)
        await p.do("set", element=u, parameter="resting_level", value=-9.0)
        await p.do("step", n=10)
        await p.until(lambda: shown(p) == 30)
        await p.do("seek", time=12)
        await p.until(lambda: shown(p) == 12)
        await p.do("speed", factor=None)
        await p.do("run_from", time=12)
        assert next(e for e in p.document["elements"] if e["id"] == u)["values"]["resting_level"] == -5.0
        assert p.document["undo"] == 2, "the change of parameters can be undone"
        await p.until(lambda: p.clock["running"] and timeline(p) and timeline(p)["time"] is None)
        await p.until(lambda: p.clock["tick"] > 40)
        await p.do("pause")
        await p.until(lambda: not p.clock["running"] and shown(p) == p.clock["tick"])
        script = dd.Session(dd.load(root / "selection.json"))
        script.step(p.clock["tick"])
        np.testing.assert_allclose(p.frames[1][1], script.read("u.activation"), atol=1e-6)
        times = [t for t, _ in p.samples[2]]
        assert times.count(12.0) == 2, "the page received the part of the time course before the moment again"
        await p.do("undo")
        assert next(e for e in p.document["elements"] if e["id"] == u)["values"]["resting_level"] == -9.0

    with studio(root, root / "selection.json") as address:
        play(address, scene)


def test_a_run_that_cannot_continue_from_a_moment_states_why(
    root: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(branch_states.BranchStates.__init__, "__defaults__", (1.0, 64))

    async def scene(p: Page) -> None:
        await p.runs()
        await p.do("watch", stream=1, element=p.element("u"), port="activation")
        await stepped(p, 5)
        answer = await p.ask("run_from", time=2)
        assert "a state of it takes" in answer["problems"][0]["what"]
        assert p.clock["tick"] == 5 and not p.clock["running"]

    with studio(root, root / "selection.json") as address:
        play(address, scene)


def test_a_peak_of_one_sample_in_a_long_record_is_in_its_time_course(root: Path) -> None:
    model = dd.Model("pulse")
    pulse = model.add(dd.Boost("pulse", [], amplitude=1.0, windows=[dd.Window(12345.0, 12346.0)]))
    record = dd.simulate(model, 40_000.0, dt=1.0, record=[f"{pulse.path}.output"])
    folder.write(record, model.document, root / "pulse", "zarr")

    async def scene(p: Page) -> None:
        await shows(p)
        await p.do("trace", stream=1, element=p.element("pulse"), port="output", reduce="max")
        await p.until(lambda: bool(p.samples.get(1)) and p.samples[1][-1][0] == 40_000)
        assert len(p.samples[1]) <= 8192
        assert [t for t, value in p.samples[1] if value == 1] == [12345]

    with studio(root, root / "pulse") as address:
        play(address, scene)


def test_a_peak_of_one_sample_in_a_long_record_is_in_its_rows_over_time(root: Path) -> None:
    model = dd.Model("pulse")
    x = dd.Axis("x", 0, 9, 10)
    window = [dd.Window(12345.0, 12346.0)]
    pulse = model.add(dd.GaussianStimulus("pulse", [x], amplitude=9.0, center=3, sigma=0.5, windows=window))
    record = dd.simulate(model, 40_000.0, dt=1.0, record=[f"{pulse.path}.output"])
    folder.write(record, model.document, root / "pulse", "zarr")

    async def scene(p: Page) -> None:
        await shows(p)
        await p.do("rows", stream=1, element=p.element("pulse"), port="output", drawn="x")
        await p.until(lambda: p.rows.get(1) is not None and p.rows[1][-1, 0] > 39_990)
        rows = p.rows[1]
        assert len(rows) <= 8192
        assert [values[3] for values in rows[:, 1:] if max(values) > 1] == [9]

    with studio(root, root / "pulse") as address:
        play(address, scene)
