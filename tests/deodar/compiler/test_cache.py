"""Compiled programs on disk: they are found again and never confused, and a broken cache does no harm."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import deodar as dd
from deodar.compiler import cache
from deodar.compiler.executable import Executable
from tests.deodar.compiler.programs import executable

x = dd.Axis("x", 0, 10, samples=11)


def pair() -> dd.Model:
    """Return two fields of different groups, whose readers lower to the same text."""
    model = dd.Model("pair")
    model.add(dd.Field("u", [x], resting_level=-1))
    model.add(dd.Field("v", [x], resting_level=-2, kernel=[dd.Gaussian()]))
    return model


def built() -> Executable:
    """Return an executable that has compiled its step."""
    program = executable(pair())
    program.chunk(())
    return program


@pytest.fixture(autouse=True)
def alone(monkeypatch: pytest.MonkeyPatch) -> None:
    """Make models share no compiled programs, as between processes."""
    monkeypatch.setattr("deodar.compiler.executable.SHARED_BYTES", -1)


@pytest.fixture
def place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("DEODAR_CACHE", str(tmp_path / "programs"))
    return tmp_path / "programs"


def test_a_second_process_reads_the_program_from_the_cache(place: Path) -> None:
    first = built()
    assert first.compiled == len(list(place.iterdir())) == 1, "the start is evaluated, not compiled"
    second = built()
    assert second.compiled == 0 and second.traced == first.traced == 3
    fresh, cached = dd.Session(pair()), dd.Session(pair())
    fresh.step(20)
    cached.step(20)
    assert np.array_equal(fresh.read("v.activation"), cached.read("v.activation"))


def test_programs_that_read_different_elements_are_distinguished(place: Path) -> None:
    s = dd.Session(pair())
    assert (s.read("u.activation") == -1).all() and (s.read("v.activation") == -2).all()
    session = dd.Session(pair())
    assert (session.read("v.activation") == -2).all() and (session.read("u.activation") == -1).all()


def test_damaged_files_are_replaced(place: Path) -> None:
    built()
    for path in place.iterdir():
        path.write_bytes(b"nonsense")
    assert built().compiled == 1
    assert built().compiled == 0


def test_a_program_with_one_other_bit_is_not_loaded(place: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    built()
    [path] = place.iterdir()
    content, loaded = path.read_bytes(), []
    load = cache.serialize_executable.deserialize_and_load
    monkeypatch.setattr(
        cache.serialize_executable, "deserialize_and_load", lambda *args: loaded.append(args) or load(*args)
    )
    for bit in np.random.default_rng(0).integers(0, 8 * len(content), 4):
        flipped = bytearray(content)
        flipped[bit // 8] ^= 1 << (bit % 8)
        path.write_bytes(flipped)
        assert built().compiled == 1 and not loaded, bit
    assert built().compiled == 0 and len(loaded) == 1


def test_the_cache_can_be_off_and_an_unusable_folder_is_ignored(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("DEODAR_CACHE", "off")
    assert cache.folder() is None and built().compiled == 1
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("DEODAR_CACHE", str(tmp_path / "file" / "programs"))
    assert built().compiled == 1


def test_the_oldest_programs_are_removed_from_a_full_cache(
    place: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    built()
    old = sorted(place.iterdir())
    for path in old:
        os.utime(path, (1, 1))
    monkeypatch.setattr(cache, "LISTED", 1)
    monkeypatch.setattr(cache, "MOST_BYTES", sum(p.stat().st_size for p in old) + 1)
    s = dd.Session(pair(), precision="float64")
    s.step(1)
    assert not set(old) <= set(place.iterdir())


def test_the_cache_is_in_the_cache_folder_of_the_user() -> None:
    code = "from deodar.compiler.cache import folder; print(folder())"
    environment = {k: v for k, v in os.environ.items() if k != "DEODAR_CACHE"} | {
        "XDG_CACHE_HOME": "/somewhere/else"
    }
    done = subprocess.run(
        [sys.executable, "-c", code], env=environment, capture_output=True, text=True, timeout=600
    )
    assert done.returncode == 0 and "deodar" in done.stdout and str(Path.cwd()) not in done.stdout
