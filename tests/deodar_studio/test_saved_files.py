"""Snapshots and presets over a real socket: files below the root, which Python opens."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import deodar as dd
from deodar import regular_file
from deodar.errors import DeodarError
from deodar_studio.files.saved_files import SavedFolder
from deodar_studio.files.workspace import Workspace
from tests.deodar.session.models import bits
from tests.deodar_studio.page import Page, play, studio


def kept(p: Page) -> dict[str, Any]:
    return p.said["saved_files"]


def resting(p: Page) -> float:
    return next(e for e in p.document["elements"] if e["path"] == "u")["values"]["resting_level"]


async def stepped(p: Page, n: int, tick: int) -> None:
    await p.do("step", n=n)
    await p.until(lambda: p.clock["tick"] == tick and not p.clock["running"])


def test_a_snapshot_is_saved_listed_returned_to_and_deleted(root: Path) -> None:
    async def scene(p: Page) -> None:
        await p.runs()
        u = p.element("u")
        await stepped(p, 150, 150)
        answer = await p.do("save_snapshot", name="before: the peak")
        assert answer["file"] == "snapshots/selection/before_ the peak.npz"
        (one,) = kept(p)["snapshots"]
        file = root / answer["file"]
        assert (one["name"], one["time"], one["size"]) == ("before_ the peak", 150, file.stat().st_size)
        again = await p.ask("save_snapshot", name="before: the peak")
        assert "of this name already" in again["problems"][0]["what"]

        script = dd.Session(dd.load(root / "selection.json"))
        script.restore(dd.load_snapshot(file))
        fresh = dd.Session(dd.load(root / "selection.json"))
        fresh.step(150)
        np.testing.assert_allclose(script.read("u"), fresh.read("u"), atol=1e-6)

        await p.do("set", element=u, parameter="resting_level", value=-9.0)
        await stepped(p, 50, 200)
        await p.until(lambda: p.document["undo"] == 1)
        await p.do("return_to", name="before_ the peak")
        await p.until(lambda: p.clock["tick"] == 150 and resting(p) == -5.0)
        assert p.document["undo"] == 2, "the return is one step"
        await p.do("save_snapshot", name="again")
        other = dd.Session(dd.load(root / "selection.json"))
        other.restore(dd.load_snapshot(root / "snapshots/selection/again.npz"))
        assert bits(other) == bits(script), "the snapshot after the return has the same bits"
        assert [s["name"] for s in kept(p)["snapshots"]] == ["again", "before_ the peak"]
        for name in ("again", "before_ the peak"):
            await p.do("remove_saved", sort="snapshot", name=name)
        assert kept(p)["snapshots"] == [] and not file.exists()
        gone = await p.ask("return_to", name="again")
        assert "no snapshot is called 'again'" in gone["problems"][0]["what"]

    with studio(root, root / "selection.json") as address:
        play(address, scene)


def test_a_preset_is_saved_listed_applied_and_deleted(root: Path) -> None:
    async def scene(p: Page) -> None:
        await p.runs()
        u = p.element("u")
        await p.do("set", element=u, parameter="resting_level", value=-7.0)
        answer = await p.do("save_preset", name="low")
        assert answer["file"] == "presets/selection/low.json"
        assert [(s["name"], s["path"]) for s in kept(p)["presets"]] == [("low", answer["file"])]
        await p.do("set", element=u, parameter="resting_level", value=-3.0)
        applied = await p.do("apply_preset", path=kept(p)["presets"][0]["path"])
        assert applied["carried"] == 1 and resting(p) == -7.0
        model = dd.load(root / "selection.json")
        dd.apply_preset(model, root / answer["file"])
        assert model["u"].resting_level == -7.0
        await p.do("remove_saved", sort="preset", name="low")
        assert kept(p)["presets"] == [] and not (root / answer["file"]).exists()

    with studio(root, root / "selection.json") as address:
        play(address, scene)


def test_a_deleted_preset_takes_no_arrays_of_another_one(root: Path) -> None:
    x = dd.Axis("x", 0, 1, samples=3)
    model = dd.Model("pattern")
    model.add(dd.Pattern("p", [x], values=np.array([1.0, 2.0, 4.0])))
    folder = SavedFolder(Workspace(root), "pattern")
    for name in ("gain 0", "gain 0.5"):
        folder.save_preset(name, model.document)
    folder.remove("preset", "gain 0")
    assert [path.name for path in root.glob("presets/pattern/gain 0.*")] != []
    assert dd.load(root / "presets/pattern/gain 0.5.json").document == model.document
    folder.remove("preset", "gain 0.5")
    assert list((root / "presets/pattern").iterdir()) == []


def test_a_preset_that_cannot_be_read_is_deleted(root: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = SavedFolder(Workspace(root), "m")
    path = folder.save_preset("locked", dd.Model("m").document)

    def refuse(path: Path) -> bytes:
        raise PermissionError(13, "Permission denied", str(path))

    monkeypatch.setattr(regular_file, "read_bytes", refuse)
    folder.remove("preset", "locked")
    assert not path.exists()


def test_a_snapshot_of_another_model_is_refused_and_the_run_goes_on(root: Path) -> None:
    async def scene(p: Page) -> None:
        await p.runs()
        await stepped(p, 20, 20)
        other = root / "snapshots/selection/odd.npz"
        other.parent.mkdir(parents=True)
        strange = dd.Model("strange")
        strange.add(dd.Field("elsewhere", []))
        dd.save_snapshot(dd.Session(strange).snapshot(), other)
        (other.parent / "broken.npz").write_bytes(b"no archive")
        await p.do("list_saved")
        await p.until(lambda: [s["name"] for s in kept(p)["snapshots"]] == ["odd"])
        answer = await p.ask("return_to", name="odd")
        assert "of another model" in answer["problems"][0]["what"] and p.clock["tick"] == 20
        await stepped(p, 5, 25)

    with studio(root, root / "selection.json") as address:
        play(address, scene)


@pytest.mark.parametrize("name", ["../x", "", ".", "a/b", "..", "\0"])
def test_no_name_leaves_the_folder(tmp_path: Path, name: str) -> None:
    (tmp_path / "x.json").write_text("{}")
    folder = SavedFolder(Workspace(tmp_path), "../../m")
    snapshot = dd.Session(dd.Model("m")).snapshot()
    try:
        path = folder.save_snapshot(name, snapshot)
    except DeodarError as error:
        assert "needs a name" in str(error)
    else:
        assert path.parent == tmp_path.resolve() / "snapshots" / "m"
    with pytest.raises(DeodarError, match="no preset is called"):
        folder.remove("preset", name)
    assert (tmp_path / "x.json").exists()


def test_a_folder_that_is_a_link_to_the_outside_is_refused(tmp_path: Path) -> None:
    outside, root = tmp_path / "outside", tmp_path / "root"
    (outside / "m").mkdir(parents=True)
    root.mkdir()
    (root / "snapshots").symlink_to(outside)
    folder = SavedFolder(Workspace(root), "m")
    with pytest.raises(DeodarError, match="outside the folder"):
        folder.save_snapshot("a", dd.Session(dd.Model("m")).snapshot())
    assert folder.listed().snapshots == [] and not list((outside / "m").iterdir())
