"""Snapshots in files: another process continues from them with the same bits."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import deodar as dd
from deodar.errors import OutputExists, ParameterError, RecordError
from deodar.worlds._base import Signal, World
from tests.deodar.worlds.test_recorded_run import driving


def model() -> dd.Model:
    """Return a model with learned weights, a slow part, noise, and a delay."""
    model = dd.Model("kept")
    x = dd.Axis("x", 0, 10, samples=8)
    model.add(dd.Field("u", [x], tau=10, noise=0.5))
    model.add(dd.Field("v", [x], tau=30, noise=0.2), ticks=3)
    model.add(dd.GaussianStimulus("s", [x], center=5, sigma=2, amplitude=8)) >> model["u"]
    model["u"] >> model.add(dd.Hebbian([x], "oja", rate=0.05, initial=0.1, name="w")) >> model["v"]
    model["s"] >> model.add(dd.DelayLine("late", delay=4.0)) >> model["v"]
    return model


CHILD = """
import sys
import numpy as np
import deodar as dd
from tests.deodar.session.test_snapshot_file import model
session = dd.Session(model(), seed=9)
session.restore(dd.load_snapshot(sys.argv[1]))
session.run(50)
np.savez(sys.argv[2], u=session.read("u"), v=session.read("v"), time=session.time, seed=session.seed)
"""


def test_another_process_continues_with_the_same_bits(tmp_path: Path) -> None:
    session = dd.Session(model(), seed=3)
    session.run(40)
    session.set("u.tau", 12.0)
    dd.save_snapshot(session.snapshot(), tmp_path / "moment.npz")
    session.run(50)
    command = [sys.executable, "-c", CHILD, str(tmp_path / "moment.npz"), str(tmp_path / "out.npz")]
    subprocess.run(command, check=True, cwd=Path(__file__).parents[3])
    with np.load(tmp_path / "out.npz") as arrays:
        assert arrays["u"].tobytes() == session.read("u").tobytes()
        assert arrays["v"].tobytes() == session.read("v").tobytes()
        assert arrays["time"] == session.time == 90 and arrays["seed"] == 3


def test_a_snapshot_is_read_as_it_was_written(tmp_path: Path) -> None:
    session = dd.Session(model(), seed=3)
    session.run(5)
    before = session.snapshot()
    after = dd.load_snapshot(dd.save_snapshot(before, tmp_path / "moment.npz"))
    assert (after.clock, after.seed, after.precision) == (before.clock, before.seed, before.precision)
    assert after.document == before.document and set(after.states) == set(before.states)
    for ident, pair in before.states.items():
        for mine, theirs in zip(pair, after.states[ident], strict=True):
            assert {n: a.tobytes() for n, a in mine.items()} == {n: a.tobytes() for n, a in theirs.items()}


def test_a_world_continues_too(tmp_path: Path) -> None:
    def session() -> dd.Session:
        return dd.Session(driving(), seed=2, world=dd.Arena("blocks"))

    first = session()
    first.run(640)
    dd.save_snapshot(first.snapshot(), tmp_path / "moment.npz")
    restored = session()
    restored.restore(dd.load_snapshot(tmp_path / "moment.npz"))
    for one in (first, restored):
        one.run(640)
    for path in ("eyes", "u", "left.output"):
        assert first.read(path).tobytes() == restored.read(path).tobytes()


class Keeps(World):
    """A world whose state no file can hold."""

    sensors = {"s": Signal(())}
    period = 10.0

    def sense(self, sensor: str, axes: Any, time: float) -> np.ndarray:
        return np.zeros(())

    def keep(self) -> Any:
        return {"socket": object()}


def test_a_state_that_a_file_cannot_hold_names_its_world(tmp_path: Path) -> None:
    model = dd.Model("kept")
    model.add(dd.Sensor("s", [], sensor="s"))
    session = dd.Session(model, world=Keeps())
    with pytest.raises(RecordError, match="the world Keeps"):
        dd.save_snapshot(session.snapshot(), tmp_path / "moment.npz")
    assert list(tmp_path.iterdir()) == []


def test_an_existing_file_is_replaced_only_with_force(tmp_path: Path) -> None:
    snapshot = dd.Session(model()).snapshot()
    dd.save_snapshot(snapshot, tmp_path / "moment.npz")
    with pytest.raises(OutputExists):
        dd.save_snapshot(snapshot, tmp_path / "moment.npz")
    dd.save_snapshot(snapshot, tmp_path / "moment.npz", force=True)


def test_a_snapshot_of_another_document_is_refused(tmp_path: Path) -> None:
    stranger = dd.Model("other")
    stranger.add(dd.Field("z", []))
    dd.save_snapshot(dd.Session(stranger).snapshot(), tmp_path / "moment.npz")
    with pytest.raises(ParameterError, match="another model, 'other'"):
        dd.Session(model()).restore(dd.load_snapshot(tmp_path / "moment.npz"))


@pytest.mark.parametrize("damage", ["absent", "cut", "text", "record"])
def test_a_file_that_is_not_a_sound_snapshot_is_one_error(damage: str, tmp_path: Path) -> None:
    path = dd.save_snapshot(dd.Session(model()).snapshot(), tmp_path / "moment.npz")
    if damage == "absent":
        path.unlink()
    elif damage == "cut":
        path.write_bytes(path.read_bytes()[:-100])
    elif damage == "text":
        path.write_text("no archive")
    else:
        np.savez(path, a=np.zeros(3))
    with pytest.raises(RecordError, match=r"moment\.npz"):
        dd.load_snapshot(path)


def test_a_newer_version_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with monkeypatch.context() as newer:
        newer.setattr("deodar.recording.stored.VERSION", 7)
        path = dd.save_snapshot(dd.Session(model()).snapshot(), tmp_path / "moment.npz")
    with pytest.raises(RecordError, match="of version 7"):
        dd.load_snapshot(path)


def test_a_file_contains_the_objects_of_the_world(tmp_path: Path) -> None:
    def session() -> dd.Session:
        return dd.Session(driving(), seed=2, world=dd.Arena("blocks"))

    first = session()
    first.run(160)
    scene = first.scene()
    assert scene is not None
    first.remove(scene.boxes[0].name)
    first.place("late", (0.9, 0.4), (0.04, 0.04))
    here = first.scene()
    dd.save_snapshot(first.snapshot(), tmp_path / "moment.npz")
    restored = session()
    restored.restore(dd.load_snapshot(tmp_path / "moment.npz"))
    assert restored.scene() == here
    for one in (first, restored):
        one.run(320)
    assert first.read("u").tobytes() == restored.read("u").tobytes()


def test_objects_that_are_no_plain_data_name_their_world(tmp_path: Path) -> None:
    class Odd(dd.Arena):
        def arrangement(self) -> object:
            return {object()}

    session = dd.Session(driving(), world=Odd("blocks"))
    with pytest.raises(RecordError, match="the objects of the world Odd are not plain data"):
        dd.save_snapshot(session.snapshot(), tmp_path / "moment.npz")
