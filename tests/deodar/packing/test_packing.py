"""What is packed comes back, with what it names and what made it, and is run only where it is trusted."""

from __future__ import annotations

import json
import sys
import zipfile
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import deodar as dd
from deodar.errors import DeodarError, DocumentError, OutputExists
from deodar.figures._file import FigureFile
from deodar.packing.packing import opened

LAMP = '''
import numpy as np
import bulb_of_test
import deodar as dd

class LampOfTest(dd.World):
    """A lamp."""
    sensors = {"light": dd.Signal("brightness", (), "lux")}
    motors = {}
    period = 10.0

    def reset(self, seed, trials=(0,), precision="float32"):
        pass

    def sense(self, sensor, axes, time):
        return np.asarray(bulb_of_test.LIGHT)

    def act(self, motors, time):
        pass
'''


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A working folder, whose modules are forgotten afterwards."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "path", [str(tmp_path), *sys.path])
    yield tmp_path
    forget()


def forget() -> None:
    for name in ("lamp_of_test", "bulb_of_test"):
        sys.modules.pop(name, None)


def lit() -> dd.Model:
    model = dd.Model("lit")
    model.add(dd.Sensor("eye", sensor="light"))
    return model


def recorded(folder: Path) -> Path:
    """Write a record of a run in a world of two modules in a folder."""
    (folder / "lamp_of_test.py").write_text(LAMP)
    (folder / "bulb_of_test.py").write_text("LIGHT = 3.0\n")
    world = __import__("lamp_of_test").LampOfTest()
    dd.save_record(dd.simulate(lit(), 20, record="eye.output", world=world), "lit.nc")
    return folder / "lit.nc"


def selection_plan(name: str, **settings: object) -> dd.Experiment:
    place = dd.Measure("place", "u.activation", "place", threshold=-2.5)
    events = [dd.Appears("detected", "u")]
    plan = dd.TrialPlan(200, events=events, measures=[place], watch=["u.activation"], every=20)
    return dd.Experiment(name, "model.json", plan, trials=2, **settings)


# ------------------------------------------------------------------------------------------ back and forth


def test_a_record_comes_back_with_what_made_it(folder: Path) -> None:
    record = dd.simulate(dd.load("example:node"), 20, record="u.activation")
    dd.save_record(record, "node.zarr")
    packed = dd.pack("node.zarr")
    contents = dd.contents(packed)
    assert (contents.kind, contents.path, contents.about["run"]) == (
        "record",
        "node.zarr",
        "duration 20, dt 1, seed 0",
    )
    assert contents.about["made by"].startswith(f"deodar {dd.__version__}, jax ")
    assert contents == dd.contents("node.zarr")
    inner = dd.unpack(packed, "apart")
    assert inner == Path("apart", "node.zarr") and dd.load_record(inner).identical(record)


@pytest.mark.parametrize(
    ("sweep", "line"),
    [
        ({"u.tau": [10.0, 20.0]}, "u.tau"),
        (dd.Points([{"u.tau": 10.0}, {"u.tau": 20.0}]), "u.tau at 2 points"),
    ],
)
def test_a_swept_record_says_what_was_swept(folder: Path, sweep: dict[str, list[float]], line: str) -> None:
    model = dd.Model("one")
    model.add(dd.Field("u", []))
    dd.save_record(dd.simulate(model, 5, sweep=sweep, record="u"), "record.nc")
    assert dd.contents("record.nc").about["sweep"] == line


def test_equal_contents_give_equal_packages(folder: Path) -> None:
    dd.save_record(dd.simulate(dd.load("example:node"), 5, record="u.activation"), "node.nc")
    assert dd.pack("node.nc", "a.deodar").read_bytes() == dd.pack("node.nc", "b.deodar").read_bytes()


def test_the_photograph_of_a_record_comes_with_it(folder: Path) -> None:
    Image.fromarray(np.full((4, 6, 3), 90, np.uint8)).save("photo.png")
    model = dd.Model("seen")
    model.add(
        dd.Sensor(
            "eye", [dd.Axis("x", 0, 5, 6), dd.Axis("y", 0, 3, 4), dd.Axis("c", 0, 2, 3)], sensor="picture"
        )
    )
    world = dd.Picture(str(folder / "photo.png"))
    dd.save_record(dd.simulate(model, 5, record="eye.output", world=world), "seen.nc")
    packed = dd.pack("seen.nc")
    (folder / "photo.png").unlink()
    assert (dd.unpack(packed, "apart").parent / "photo.png").is_file()
    assert dd.repeat(dd.load_record("apart/seen.nc")).same_bits
    with pytest.raises(dd.errors.WorldError, match="cannot be opened"):
        dd.repeat(dd.load_record("seen.nc"))


def test_results_are_repeated_row_by_row(folder: Path) -> None:
    dd.save(dd.load("example:selection"), "model.json")
    before = selection_plan("choice").run("results")
    packed = dd.pack("results")
    lines = dd.contents(packed).about
    assert (lines["experiment"], lines["trials"]) == ("choice", "2 of 2")
    inner = dd.unpack(packed, "apart")
    assert dd.load_results(inner).equals(before) and len(list((inner / "records").iterdir())) == 2
    dd.Experiment.load(inner / "experiment.json").run("again")
    compared = dd.compare_results(inner, "again")
    assert (compared.compared, compared.changed, compared.faithful) == (2, (), True)
    assert str(compared) == "The repetition has the same rows, in 2 trials"


def test_the_table_of_an_experiment_says_what_made_it(folder: Path) -> None:
    dd.save(dd.load("example:selection"), "model.json")
    selection_plan("choice").run("results")
    assert dd.contents("results/trials.nc") == dd.contents("results")
    moved = dd.contents(Path("results/trials.nc").rename("alone.nc"))
    assert (moved.kind, moved.about["experiment"], moved.about["trials"]) == ("table", "choice", "2")
    assert moved.about["made by"].startswith(f"deodar {dd.__version__}, jax ")


def test_results_of_another_seed_are_told_apart(folder: Path) -> None:
    dd.save(dd.load("example:selection"), "model.json")
    for seed in (0, 1):
        selection_plan("choice", seed=seed).run(f"seed-{seed}")
    compared = dd.compare_results("seed-0", "seed-1")
    assert compared.changed and not compared.faithful
    assert "Nothing explains it" in str(compared)


def test_an_experiment_comes_with_its_model(folder: Path) -> None:
    (folder / "models").mkdir()
    dd.save(dd.load("example:spa"), "models/spa.json")
    Path("models/spa.json").rename("models/model.json")  # its arrays keep their name
    (folder / "plans").mkdir()
    text = json.dumps({"experiment": 3, "name": "far", "model": "../models/model.json", "limit": 60})
    (folder / "plans" / "far.json").write_text(text)
    packed = dd.pack("plans/far.json")
    assert sorted(name.split(".")[0] for name in dd.contents(packed).files) == [
        "models/model",
        "models/spa",
        "plans/far",
    ]
    inner = dd.unpack(packed, "apart")
    assert inner == Path("apart/plans/far.json")
    assert dd.load(str(dd.Experiment.load(inner).model)).document == dd.load("example:spa").document


def test_a_figure_comes_with_its_records(folder: Path) -> None:
    dd.save_record(dd.simulate(dd.load("example:node"), 5, record="u.activation"), "node.nc")
    (folder / "figures").mkdir()
    (folder / "figures" / "f.toml").write_text(
        'record = "../node.nc"\n\n[[panel]]\nvariable = "u.activation"\n'
    )
    inner = dd.unpack(dd.pack("figures/f.toml"), "apart")
    assert inner == Path("apart/figures/f.toml")
    figures = [FigureFile.read(path).draw() for path in (folder / "figures" / "f.toml", inner)]
    assert len({tuple(figure.axes[0].lines[0].get_ydata()) for figure in figures}) == 1


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("f.toml", 'record = "{folder}/node.nc"\n\n[[panel]]\nvariable = "u.activation"\n'),
        ("e.json", '{{"experiment": 3, "name": "e", "model": "{folder}/model.json", "limit": 10}}'),
    ],
)
def test_what_names_a_file_by_its_full_path_is_refused(folder: Path, name: str, text: str) -> None:
    dd.save(dd.load("example:node"), "model.json")
    dd.save_record(dd.simulate(dd.load("example:node"), 5, record="u.activation"), "node.nc")
    Path(name).write_text(text.format(folder=folder))
    with pytest.raises(DocumentError, match="another computer does not have"):
        dd.pack(name)


# ------------------------------------------------------------------------------------------------- modules


def test_a_package_names_the_modules_that_it_needs_and_runs_them_only_with_trust(folder: Path) -> None:
    packed = dd.pack(recorded(folder), with_code=True)
    [module] = dd.contents(packed).modules
    assert (module.name, module.defines) == ("lamp_of_test", ("LampOfTest",))
    assert module.files == ("code/bulb_of_test.py", "code/lamp_of_test.py")
    for name in ("lamp_of_test.py", "bulb_of_test.py"):
        (folder / name).unlink()
    forget()
    with pytest.raises(DocumentError, match="not run unasked"), opened(packed, trust=False):
        pass
    assert "lamp_of_test" not in sys.modules
    dd.unpack(packed, "seen")
    assert "lamp_of_test" not in sys.modules
    with opened(packed, trust=True) as inner:
        assert dd.repeat(dd.load_record(inner)).same_bits


def test_a_package_without_its_module_says_which_is_missing(folder: Path) -> None:
    packed = dd.pack(recorded(folder))
    forget()
    with pytest.raises(DocumentError) as missing, opened(packed, trust=True):
        pass
    assert "needs lamp_of_test (LampOfTest), which the package does not include" in str(missing.value)
    assert "deodar --import lamp_of_test" in missing.value.at("shell")
    with opened(packed, trust=False, runs=False) as inner:  # to draw it nothing of the module is needed
        assert dd.load_record(inner)["eye.output"].values.max() == 3.0


def test_a_world_of_the_script_itself_cannot_be_packed(folder: Path) -> None:
    record = dd.simulate(lit(), 20, record="eye.output", world=world_of_main())
    dd.save_record(record, "lit.nc")
    assert dd.contents("lit.nc").modules == ()  # the record names no module: it can only be drawn


def world_of_main() -> dd.World:
    names: dict[str, object] = {"__name__": "__main__"}
    exec(LAMP.replace("import bulb_of_test\n", "").replace("bulb_of_test.LIGHT", "1.0"), names)
    return names["LampOfTest"]()  # type: ignore[operator]


# -------------------------------------------------------------------------------------------------- damage


def packed_record() -> Path:
    dd.save_record(dd.simulate(dd.load("example:node"), 5, record="u.activation"), "node.nc")
    return dd.pack("node.nc")


def rewritten(path: Path, change: dict[str, bytes | None], /, **stated: object) -> Path:
    """Write the package again with other entries and other contents; None: without the entry."""
    with zipfile.ZipFile(path) as z:
        entries: dict[str, bytes | None] = {name: z.read(name) for name in z.namelist()}
    contents = json.loads(entries["contents.json"] or b"")
    entries |= {"contents.json": json.dumps({**contents, **stated}).encode(), **change}
    with zipfile.ZipFile("changed.deodar", "w") as z:
        for name, content in entries.items():
            if content is not None:
                z.writestr(name, content)
    return Path("changed.deodar")


HASH = "0" * 64
ESCAPES = {
    name: {"size": 1, "sha256": HASH} for name in ("../out.txt", "/out.txt", "a/../../out.txt", "C:x", "a\\b")
}


def test_a_file_that_was_exchanged_is_noticed(folder: Path) -> None:
    packed = packed_record()
    size = dd.contents(packed).files["node.nc"].size
    changed = rewritten(packed, {"node.nc": b"x" * size})
    with pytest.raises(DocumentError, match="its hash differs"):
        dd.unpack(changed)
    assert not Path("changed").exists()


@pytest.mark.parametrize(
    ("change", "stated", "says"),
    [
        ({"node.nc": b"short"}, {}, "not as long as"),
        ({"node.nc": None}, {}, "lacks 'node.nc'"),
        ({"more.txt": b"1"}, {}, "does not name"),
        ({}, {"kind": "virus"}, "kind"),
        ({}, {"deodar_package": 2}, "version 2"),
        ({}, {"colour": 1}, "colour"),
        ({}, {"path": "../node.nc"}, "outside the package"),
        ({"contents.json": b"[]"}, {}, "is not a package of deodar"),
        ({"contents.json": b"{"}, {}, "JSON"),
        *(({name: b"1"}, {"files": {name: entry}}, "outside the package") for name, entry in ESCAPES.items()),
    ],
)
def test_a_package_with_other_contents_than_stated_is_refused(
    folder: Path, change: dict[str, bytes | None], stated: dict[str, object], says: str
) -> None:
    changed = rewritten(packed_record(), change, **stated)
    with pytest.raises(DeodarError, match=says):
        dd.unpack(changed)
    assert sorted(p.name for p in folder.iterdir()) == ["changed.deodar", "node.deodar", "node.nc"]
    assert not (folder.parent / "out.txt").exists()


def test_no_flipped_bit_goes_unnoticed(folder: Path) -> None:
    packed = packed_record()
    content, record = packed.read_bytes(), dd.load_record("node.nc")
    draw = np.random.default_rng(0)
    for k in range(60):
        flipped = bytearray(content)
        flipped[int(draw.integers(len(content)))] ^= 1 << int(draw.integers(8))
        Path("flipped.deodar").write_bytes(bytes(flipped))
        try:
            inner = dd.unpack("flipped.deodar", f"flipped-{k}")
        except DeodarError:
            assert not Path(f"flipped-{k}").exists()
        else:
            assert dd.load_record(inner).identical(record)


def test_unpacking_replaces_a_folder_only_with_force(folder: Path) -> None:
    packed = packed_record()
    Path("node").mkdir()
    with pytest.raises(OutputExists):
        dd.unpack(packed)
    assert dd.unpack(packed, force=True) == Path("node", "node.nc")


def test_a_package_of_a_record_is_no_model(folder: Path) -> None:
    with pytest.raises(DocumentError, match="holds a record, not a model") as refused:
        dd.load(packed_record())
    assert "deodar open FILE" in refused.value.at("shell") and "dd.unpack(FILE)" in str(refused.value)


def test_a_package_is_not_packed_again(folder: Path) -> None:
    with pytest.raises(DocumentError, match="is a package already"):
        dd.pack(packed_record(), "twice.deodar")
