"""A script that runs again replaces what it wrote itself, and nothing else."""

from __future__ import annotations

import os
import subprocess
import sys
import types
from collections.abc import Callable
from pathlib import Path

import pytest

import deodar as dd
from deodar.errors import OutputExists
from deodar.model import written


@pytest.fixture
def as_script(tmp_path, monkeypatch) -> Callable[..., None]:
    """Return a function that makes this process that of a script, or of a notebook."""
    monkeypatch.setenv(written.STATES, str(tmp_path / "states"))

    def pretend(name: str, notebook: str = "") -> None:
        main = types.ModuleType("__main__")
        if notebook:
            monkeypatch.setitem(sys.modules, "ipykernel", types.ModuleType("ipykernel"))
            monkeypatch.setenv("JPY_SESSION_NAME", notebook)
        else:
            main.__file__ = str(tmp_path / name)
        monkeypatch.setitem(sys.modules, "__main__", main)

    return pretend


def small() -> dd.Model:
    """Return a model of one field with an input."""
    x = dd.Axis("x", 0, 20, samples=21)
    model = dd.Model("small")
    model.add(dd.GaussianStimulus("s", [x], center=10, amplitude=6)) >> model.add(dd.Field("u", [x]))
    return model


def record():
    """Return a short record."""
    return dd.simulate(small(), 5, record=["u.activation"])


def recorded(path: Path) -> None:
    """Record a session."""
    session = dd.Session(small())
    with session.record(path, ["u.activation"]):
        session.step(3)


def experiment() -> dd.Experiment:
    """Return an experiment of one trial."""
    return dd.Experiment("one", small(), dd.TrialPlan(20.0))


def panels() -> dd.figures.FigureFile:
    """Return the file of a figure of one panel."""
    return dd.figures.FigureFile([dd.figures.FigurePanel("u.activation", kind="snapshot")])


WRITERS: dict[str, Callable[[Path], object]] = {
    "model.json": lambda path: dd.save(small(), path),
    "model.deodar": lambda path: dd.save(small(), path),
    "diagram.svg": lambda path: dd.draw(small()).save(path),
    "figure.svg": lambda path: dd.save_figure(dd.time_course(record()["u.activation"], places=[10]), path),
    "figure.toml": lambda path: panels().save(path),
    "record.nc": lambda path: dd.save_record(record(), path),
    "record.csv": lambda path: dd.save_record(record(), path),
    "record.zarr": lambda path: dd.save_record(record(), path),
    "run": lambda path: dd.simulate(small(), 5, record=["u.activation"], out=path),
    "grown.zarr": lambda path: dd.simulate(small(), 5, record=["u.activation"], out=path),
    "session.zarr": recorded,
    "state.snapshot": lambda path: dd.save_snapshot(dd.Session(small()).snapshot(), path),
    "experiment.json": lambda path: experiment().save(path),
    "video.gif": lambda path: panels().animate(path, record()),
    "frames": lambda path: panels().animate(path, record()),
}


@pytest.mark.parametrize("name", WRITERS)
def test_a_script_replaces_what_it_wrote_and_another_one_does_not(name, as_script, tmp_path) -> None:
    write, path = WRITERS[name], tmp_path / name
    as_script("first.py")
    write(path)
    write(path)
    as_script("second.py")
    with pytest.raises(OutputExists, match="exists already"):
        write(path)
    as_script("first.py")
    write(path)


@pytest.mark.parametrize("name", ["model.json", "record.zarr", "run"])
def test_what_a_person_has_changed_since_is_refused(name, as_script, tmp_path) -> None:
    write, path = WRITERS[name], tmp_path / name
    as_script("first.py")
    write(path)
    edited = next(p for p in (path, *path.rglob("*.json")) if p.is_file())
    edited.write_text(edited.read_text(encoding="utf-8") + "\n", encoding="utf-8")
    with pytest.raises(OutputExists, match="exists already"):
        write(path)


def test_a_file_of_somebody_else_is_refused_also_with_the_same_name_later(as_script, tmp_path) -> None:
    path = tmp_path / "model.json"
    as_script("first.py")
    dd.save(small(), path)
    path.unlink()
    path.write_text("{}", encoding="utf-8")
    with pytest.raises(OutputExists):
        dd.save(small(), path)


def test_an_interrupted_record_is_not_replaced(as_script, tmp_path) -> None:
    as_script("first.py")
    session = dd.Session(small())
    with pytest.raises(ZeroDivisionError), session.record(tmp_path / "part.zarr", ["u.activation"]):
        session.step(3)
        _ = 1 / 0
    with pytest.raises(OutputExists):
        recorded(tmp_path / "part.zarr")


def test_a_notebook_is_known_by_its_path_and_else_by_its_kernel(as_script, tmp_path, monkeypatch) -> None:
    path = tmp_path / "model.json"
    as_script("", notebook="/home/me/one.ipynb")
    dd.save(small(), path)
    dd.save(small(), path)
    as_script("", notebook="/home/me/two.ipynb")
    with pytest.raises(OutputExists):
        dd.save(small(), path)
    monkeypatch.delenv("JPY_SESSION_NAME")
    assert written.script().startswith(f"kernel {os.getpid()} ")
    dd.save(small(), tmp_path / "other.json")
    dd.save(small(), tmp_path / "other.json")


def test_programs_and_consoles_own_nothing(as_script, monkeypatch, tmp_path) -> None:
    as_script("first.py")
    assert written.script() == f"script {tmp_path / 'first.py'}"
    main = sys.modules["__main__"]
    main.__file__ = os.path.join(sys.prefix, "bin", "deodar")
    assert written.script() == ""
    main.__file__ = str(tmp_path / "deodar" / "__main__.py")
    main.__spec__ = types.SimpleNamespace(name="deodar.__main__")  # type: ignore[assignment]
    assert written.script() == ""
    monkeypatch.setitem(sys.modules, "__main__", types.ModuleType("__main__"))
    assert written.script() == "", "a console"


def test_a_script_runs_twice(tmp_path) -> None:
    path = tmp_path / "twice.py"
    path.write_text(
        "import deodar as dd\n"
        "x = dd.Axis('x', 0, 20, samples=21)\n"
        "model = dd.Model('small')\n"
        "model.add(dd.Field('u', [x]))\n"
        "dd.save(model, 'small.json')\n",
        encoding="utf-8",
    )
    copied = path.with_name("other.py")
    copied.write_bytes(path.read_bytes())
    settings = {**os.environ, written.STATES: str(tmp_path / "states")}

    def run(script: Path) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            [sys.executable, str(script)], cwd=tmp_path, env=settings, capture_output=True, text=True
        )

    assert [run(path).returncode for _ in range(2)] == [0, 0]
    refused = run(copied)
    assert refused.returncode == 1 and "exists already" in refused.stderr
