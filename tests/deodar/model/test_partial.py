"""What a process that was killed during a save left behind: the next save takes it over."""

from __future__ import annotations

import hashlib
import os
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import deodar as dd
from deodar.errors import OutputError, OutputExists
from deodar.model import document_files, output, partial
from deodar.recording import files, places
from tests.deodar.recording.models import record

HALF = """
import sys, time
from pathlib import Path
from deodar.model import output

def content(beside):
    beside.write_bytes(b"half")
    print(flush=True)
    sys.stdin.read()
    beside.write_bytes(b"child")

output.write(Path(sys.argv[1]), content)
"""


def half(path: Path) -> subprocess.Popen[str]:
    """Return a process that has written half of a file, and writes the rest when its input ends."""
    command = [sys.executable, "-c", HALF, str(path)]
    process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    assert process.stdout is not None
    process.stdout.readline()
    return process


def names(folder: Path) -> list[str]:
    """Return the names in a folder."""
    return sorted(path.name for path in folder.iterdir())


def test_the_file_of_a_killed_process_is_taken_over(tmp_path: Path) -> None:
    process = half(tmp_path / "doc.json")
    assert not list(partial.abandoned(tmp_path)), "its process writes it"
    process.kill()
    process.communicate(timeout=30)
    (leftover,) = partial.abandoned(tmp_path)
    assert leftover.read_bytes() == b"half" and names(tmp_path) == [leftover.name]
    output.write(tmp_path / "doc.json", b"whole")
    assert names(tmp_path) == ["doc.json"] and (tmp_path / "doc.json").read_bytes() == b"whole"
    assert (tmp_path / "doc.json").stat().st_mode & 0o777 == 0o666 & ~output._umask()


def test_two_processes_write_one_file_at_once(tmp_path: Path) -> None:
    process = half(tmp_path / "doc.json")
    output.write(tmp_path / "doc.json", b"whole")
    assert (tmp_path / "doc.json").read_bytes() == b"whole" and len(names(tmp_path)) == 2
    process.communicate("", timeout=30)
    assert process.returncode == 0
    assert names(tmp_path) == ["doc.json"] and (tmp_path / "doc.json").read_bytes() == b"child"


def test_writers_beyond_several_get_names_too(tmp_path: Path) -> None:
    path = tmp_path / "doc.json"

    def nested(depth: int) -> Callable[[Path], None]:
        def content(beside: Path) -> None:
            beside.write_bytes(b"%d" % depth)
            if depth < partial.SEVERAL + 2:
                output.write(path, nested(depth + 1))
                assert len({*names(tmp_path)} - {"doc.json"}) == depth + 1

        return content

    output.write(path, nested(0))
    assert names(tmp_path) == ["doc.json"] and path.read_bytes() == b"0"


@pytest.fixture
def killed(monkeypatch: pytest.MonkeyPatch) -> Callable[[Callable[[], object]], None]:
    """Return a function that ends a save as a kill does, before its file gets its name."""

    class Kill(BaseException):
        """End of a process."""

    def refuse(*_: object) -> None:
        raise Kill

    def release(name: str, handle: int, *_: object, **__: object) -> None:
        os.close(handle)

    def attempt(save: Callable[[], object]) -> None:
        with monkeypatch.context() as patch:
            patch.setattr(Path, "replace", refuse)
            patch.setattr(output, "sync_tree", refuse)
            patch.setattr(partial, "drop", release)
            patch.setattr(partial.shutil, "rmtree", lambda *_, **__: None)
            with pytest.raises(Kill):
                save()

    return attempt


def model(seed: int = 0) -> dd.Model:
    """Return a model with an array file."""
    small = dd.Model("m")
    values = np.random.default_rng(seed).random(3)
    small.add(dd.Pattern("w", [dd.Axis("x", 0, 2, samples=3)], values=values))
    return small


SAVES: dict[str, Callable[[Path], object]] = {
    "document": lambda folder: dd.save(model(), folder / "m.json", force=True),
    "package": lambda folder: dd.save(model(), folder / "m.deodar", force=True),
    "packed": lambda folder: dd.pack("example:selection", folder / "selection.deodar", force=True),
    "NetCDF": lambda folder: dd.save_record(record(), folder / "r.nc", force=True),
    "Zarr": lambda folder: dd.save_record(record(), folder / "r.zarr", force=True),
    "table": lambda folder: dd.save_record(record(), folder / "r.csv", force=True),
    "snapshot": lambda folder: dd.save_snapshot(dd.Session(model()).snapshot(), folder / "s.npz", force=True),
    "experiment": lambda folder: dd.Experiment("e", model(), dd.TrialPlan(10.0)).save(
        folder / "e.json", force=True
    ),
    "figure": lambda folder: dd.save_figure(
        dd.space_time(record()["u.activation"]), folder / "f.png", force=True
    ),
}
"""Each writer of files."""


@pytest.mark.parametrize("kind", SAVES)
def test_each_save_takes_over_what_a_killed_one_left(
    kind: str, tmp_path: Path, killed: Callable[[Callable[[], object]], None]
) -> None:
    (tmp_path / "never").mkdir()
    SAVES[kind](tmp_path / "never")
    (tmp_path / "killed").mkdir()
    killed(lambda: SAVES[kind](tmp_path / "killed"))
    assert list(partial.abandoned(tmp_path / "killed"))
    SAVES[kind](tmp_path / "killed")
    assert names(tmp_path / "killed") == names(tmp_path / "never")


def test_the_record_that_a_killed_process_was_replacing_gets_its_name_again(tmp_path: Path) -> None:
    path, before = tmp_path / "r.zarr", record()
    files.save_record(before, path)
    with partial.folder(path) as beside:
        name = beside.name
    shutil.copytree(path, tmp_path / name / partial.OLD)
    (tmp_path / name / "new").mkdir()
    shutil.rmtree(path)
    with pytest.raises(OutputExists, match="created meanwhile"):
        places.write_folder(path, lambda folder: None)
    assert names(tmp_path) == ["r.zarr"] and files.load_record(path).identical(before)


def test_without_locks_each_name_is_a_new_one(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(partial, "_lock", lambda handle: None)
    seen: list[str] = []
    for _ in range(2):
        output.write(tmp_path / "doc.json", lambda beside: seen.append(beside.name))
        places.write_folder(tmp_path / "r", lambda beside: seen.append(beside.parent.name), True)
    assert len({*seen}) == 4 and all(partial.FORM.fullmatch(name) for name in seen)
    assert names(tmp_path) == ["doc.json", "r"]


@pytest.mark.parametrize("kind", ["link", "second name"])
def test_a_file_that_others_placed_is_not_written(tmp_path: Path, kind: str) -> None:
    with partial.file(tmp_path / "doc.json") as beside:
        name = beside.name
    (tmp_path / "mine").write_bytes(b"precious")
    if kind == "link":
        (tmp_path / name).symlink_to(tmp_path / "mine")
    else:
        (tmp_path / name).hardlink_to(tmp_path / "mine")
    output.write(tmp_path / "doc.json", b"whole")
    assert (tmp_path / "mine").read_bytes() == b"precious"
    assert (tmp_path / "doc.json").read_bytes() == b"whole" and not (tmp_path / "doc.json").is_symlink()


def test_a_save_that_fails_leaves_no_array_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    dd.save(model(), tmp_path / "m.json")
    before, write = names(tmp_path), output.write

    def full(path: Path, *content: Any, **options: Any) -> None:
        if path.suffix == ".json":
            raise output.failed(path, OSError(28, "No space left on device"))
        write(path, *content, **options)

    with monkeypatch.context() as patch:
        patch.setattr(output, "write", full)
        for seed in (0, 1):
            with pytest.raises(OutputError, match="No space left"):
                dd.save(model(seed), tmp_path / "m.json", force=True)
            assert names(tmp_path) == before
    assert dd.load(tmp_path / "m.json").document == model().document


def test_array_files_without_a_document_are_taken_away_by_its_next_save(tmp_path: Path) -> None:
    def array_file_of(stem: str, content: bytes) -> str:
        name = f"{stem}.{hashlib.sha256(content).hexdigest()[:8]}.npz"
        (tmp_path / name).write_bytes(content)
        return name

    unnamed, named, young, others = (
        array_file_of(stem, content)
        for stem, content in (("m", b"1"), ("m", b"2"), ("m", b"3"), ("other", b"4"))
    )
    date = "m.20261128.npz"  # of the user: its name is not that of its content
    (tmp_path / date).write_bytes(b"5")
    (tmp_path / "m.old").write_text(f'{{"arrays": {{"file": "{named}"}}}}')
    for name in (unnamed, named, others, date):
        os.utime(tmp_path / name, (0, 0))
    dd.save(model(), tmp_path / "m.json")
    stay = {named, young, others, date, "m.old", "m.json"}
    (array_file,) = set(names(tmp_path)) - stay
    os.utime(tmp_path / array_file, (0, 0))
    assert names(tmp_path) == sorted([array_file, *stay])
    assert document_files.left_arrays(tmp_path) == [tmp_path / others]
    dd.save(model(1), tmp_path / "m.json", force=True)
    assert array_file not in names(tmp_path) and dd.load(tmp_path / "m.json").document == model(1).document
