"""The formats of files that deodar reads: sound files of each, and what reads them."""

from __future__ import annotations

import contextlib
import dataclasses as dc
import tempfile
from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np

import deodar as dd
from deodar import codec
from deodar.analysis.tuning.tuning_file import tuning_file
from deodar.batch import points_file
from deodar.errors import DeodarError
from deodar.figures import analysis_file
from deodar.importers import opening
from tests.attacks.seeds import CORPUS, ROOT, Format, Seed


def _single_files(*patterns: str, beside: str = "", most: int = 60_000) -> list[Seed]:
    """Return a seed for each file of the repository, with the files beside it that a pattern names."""
    paths = sorted(path for pattern in patterns for path in ROOT.glob(pattern) if path.stat().st_size <= most)
    seeds: list[Seed] = []
    for path in paths:
        others = sorted(path.parent.glob(beside.format(stem=path.stem))) if beside else []
        files = {sibling.name: sibling for sibling in (*others, path)}
        seeds.append(Seed(files, path.name, tuple(files)))
    return seeds


def _folder(place: str, entry: str, *attacked: str) -> Seed:
    """Return the seed of a folder of the repository, and of the patterns of the attacked files."""
    folder = ROOT / place
    files = {
        path.relative_to(folder).as_posix(): path for path in sorted(folder.rglob("*")) if path.is_file()
    }
    patterns = attacked or (entry,)
    chosen = [name for name in files if any(Path(name).match(pattern) for pattern in patterns)]
    return Seed(files, entry, tuple(chosen))


# ---------------------------------------------------------------------------------------------------- readers


def _document(path: Path) -> None:
    dd.load(path).check()
    dd.contents(path)


def _imported(path: Path) -> None:
    done = dd.read(path)
    done.report.text()
    done.model.check()
    done.model.to_json()


def _preset(path: Path) -> None:
    model = dd.load(ROOT / "examples" / "detection.json")
    dd.apply_preset(model, path)


def _cedar_experiment(path: Path) -> None:
    dd.load_cedar_experiment(path, path.with_name("architecture.json")).experiment.check()


def _experiment(path: Path) -> None:
    stated = dd.Experiment.load(path, opening.load)
    setup = dc.replace(stated, model=dd.load(str(stated.model))).setup()
    assert len(setup.pieces()) > 0
    dd.contents(path)


def _package(path: Path) -> None:
    dd.contents(path)
    with tempfile.TemporaryDirectory() as place:
        dd.unpack(path, Path(place) / "unpacked")
    with contextlib.suppress(DeodarError):  # it may hold something else
        dd.load(path).check()


def _result_folder(path: Path) -> None:
    dd.load_results(path)
    dd.contents(path)


def _figure(path: Path) -> None:
    from matplotlib import pyplot

    from deodar.figures._file import FigureFile

    try:
        FigureFile.read(path).draw()
    finally:
        pyplot.close("all")
    dd.contents(path)


def _analysis(path: Path) -> None:
    from matplotlib import pyplot

    kind = analysis_file.kind_of(dd.open_record(path))
    try:
        analysis_file.analysis_figure([(path, kind)])
    finally:
        pyplot.close("all")


def _record(path: Path) -> None:
    dd.load_record(path)
    dd.open_record(path).load()
    dd.contents(path)


def _tuning(path: Path) -> None:
    tuning_file(codec.read(path.read_bytes(), codec.FEW_VALUES), path.name)


def _matlab(path: Path) -> None:
    for name in ("cells", "results.sizes"):
        with contextlib.suppress(DeodarError):
            dd.load_mat(path, name)
    dd.load_mat(path, "weights")


def _world(kind: Callable[[str], dd.World]) -> Callable[[Path], None]:
    """Return a reader that opens a world, and reads its small sensors at the start."""

    def read(path: Path) -> None:
        world = kind(str(path))
        try:
            world.reset(0)
            for name, signal in world.sensors.items():
                shape = signal.shape
                if shape is not None and np.prod(shape, dtype=object) <= 1000 and 1 not in shape:
                    axes = tuple(dd.Axis(f"a{k}", 0, n - 1, n) for k, n in enumerate(shape))
                    world.sense(name, axes, 0.0)
        finally:
            world.close()

    return read


def _picture(path: Path) -> None:
    dd.Picture(path).sense("picture", dd.Picture.example_axes("picture"), 0.0)


def _video(path: Path) -> None:
    video = dd.Video(path)
    for time_ in (0.0, 400.0, 80.0):
        video.picture(time_)


OWN = CORPUS.relative_to(ROOT).as_posix()
COSIVINA, CEDAR, COMPOSER = (
    f"tests/deodar_interop/importers/{tool}" for tool in ("cosivina", "cedar/data", "dnf_composer")
)
OLD = "tests/old_files/version_1"
BAGS = ("lab", "lab_mcap", "record")

FORMATS: Mapping[str, Format] = {
    "document": Format(
        lambda: _single_files("examples/*.json", f"{OWN}/documents/*.json", most=9000),
        _document,
    ),
    "arrays": Format(
        lambda: [
            *_single_files("examples/pointing.json", f"{OLD}/choice.json", beside="{stem}.*.npz"),
            _folder(f"{OWN}/arrays", "model.json", "*.npz", "*.json"),
            *(
                seed.beside(CORPUS / "arrays" / "model.json")
                for seed in _single_files(f"{OWN}/pickled/*.npz")
            ),
        ],
        _document,
    ),
    "package": Format(lambda: _single_files(f"{OWN}/packages/*.deodar", f"{OLD}/*.deodar"), _package),
    "experiment": Format(
        lambda: [
            _folder(f"{OWN}/experiments", "experiment.json"),
            _folder("tests/old_files/experiment_2", "experiment.json"),
            _folder(OLD, "experiment.json"),
        ],
        _experiment,
    ),
    "results": Format(
        lambda: [
            _folder(f"{OLD}/whole", "", "*.json", "*.jsonl", "*.csv", "*.nc"),
            _folder(f"{OLD}/stopped", "", "*.json", "*.jsonl"),
        ],
        _result_folder,
    ),
    "figure": Format(
        lambda: [_folder(f"{OWN}/figures", "figure.toml").beside(ROOT / OLD / "record.nc")], _figure
    ),
    "record": Format(
        lambda: [
            *_single_files(f"{OLD}/record.nc", f"{OLD}/whole/trials.nc"),
            _folder(OLD, "record.zarr", "record.zarr/*", "record.zarr/*/*", "record.zarr/*/*/*"),
        ],
        _record,
    ),
    "analysis": Format(lambda: _single_files(f"{OWN}/analyses/*.nc"), _analysis),
    "snapshot": Format(lambda: _single_files(f"{OWN}/snapshots/*"), lambda path: dd.load_snapshot(path)),
    "points": Format(lambda: _single_files(f"{OWN}/tables/points.*"), lambda path: points_file.read(path)),
    "tuning": Format(lambda: _single_files(f"{OWN}/tables/requirements.json"), _tuning),
    "cedar": Format(
        lambda: [
            *_single_files(f"{CEDAR}/*.json", f"{CEDAR}/projection/*.json", most=9000),
            _folder(f"{OWN}/cedar", "architecture.json", "architecture.json", "*.data"),
        ],
        _imported,
    ),
    "cedar experiment": Format(
        lambda: [_folder(f"{OWN}/cedar", "experiment.json", "experiment.json")], _cedar_experiment
    ),
    "cedar record": Format(
        lambda: [_folder(f"{OWN}/cedar_records", "", "*.csv")], lambda path: dd.load_cedar(path) and None
    ),
    "cosivina": Format(
        lambda: _single_files(f"{COSIVINA}/*.json", f"{OWN}/cosivina/*.json", most=25_000), _imported
    ),
    "launcher": Format(lambda: [_folder(f"{OWN}/launchers", "launcherSmall.m", "*.m", "*.json")], _imported),
    "preset": Format(
        lambda: _single_files(f"{COSIVINA}/*.json", "examples/detection.json", most=7000), _preset
    ),
    "dnf-composer": Format(
        lambda: [
            *_single_files(f"{COMPOSER}/*.dnf", most=9000),
            _folder(f"{OWN}/dnf_composer", "small.dnf", "*.dnf", "*.txt"),
        ],
        _imported,
    ),
    "matlab": Format(lambda: _single_files(f"{OWN}/matlab/*.mat"), _matlab),
    "robot": Format(
        lambda: [
            _folder(f"{OWN}/robots", "own.json", "own.json", "layout.json"),
            *_single_files("src/deodar_robots/robot/robots/*.json"),
        ],
        _world(dd.Robot),
        connects=True,
    ),
    "arena": Format(
        lambda: _single_files(f"{OWN}/robots/layout.json", "src/deodar/worlds/arena/layouts/blocks.json"),
        _world(dd.Arena.open),
    ),
    "mjcf": Format(
        lambda: [
            *(_folder(f"{OWN}/scenes", name, name) for name in ("scene.xml", "included.xml", "robot.urdf")),
            *_single_files("src/deodar_robots/mujoco/scenes/*.xml", "src/deodar_robots/mujoco/robots/*.xml"),
        ],
        _world(dd.MuJoCo),
    ),
    "picture": Format(lambda: _single_files(f"{OWN}/pictures/*", "examples/node.png"), _picture),
    "video": Format(lambda: _single_files(f"{OWN}/videos/*"), _video),
    "events": Format(
        lambda: _single_files(f"{OWN}/events/*", "tests/deodar_robots/event_file/*.aedat4"),
        _world(dd.EventFile),
    ),
    "bag": Format(
        lambda: [
            *(_folder(f"{OWN}/bags/{name}", "", "*.yaml", "*.db3", "*.mcap") for name in BAGS),
            _folder(f"{OWN}/bags/code", "", "*.yaml").beside(CORPUS / "bags" / "lab" / "lab.db3"),
        ],
        _world(dd.ROSBag),
    ),
}
