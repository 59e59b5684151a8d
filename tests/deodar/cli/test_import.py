"""`deodar --import MODULE`: custom elements from the shell."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import deodar as dd

OWN = '''
from dataclasses import dataclass
from deodar.element import Coupling
from deodar.registry import register

@register
@dataclass(frozen=True)
class Doubling(Coupling):
    """Twice the input."""

    def output(self, at):
        return {"output": 2.0 * at.inputs["input"]}
'''
DOCUMENT = """{"deodar": 1, "axes": {"x": {"lower": 0, "upper": 9, "samples": 10}},
 "elements": {"b": {"kind": "Boost", "axes": ["x"], "amplitude": 1.5}, "d": {"kind": "Doubling"}},
 "connections": [{"source": "b.output", "target": "d.input"}]}"""


def call(folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "deodar", *arguments], cwd=folder, capture_output=True, text=True, timeout=600
    )


def test_a_custom_element_runs_from_the_command_line(tmp_path: Path) -> None:
    (tmp_path / "own.py").write_text(OWN)
    (tmp_path / "model.json").write_text(DOCUMENT)
    unknown = call(tmp_path, "check", "model.json")
    assert unknown.returncode == 1 and "--import MODULE" in unknown.stderr + unknown.stdout
    assert call(tmp_path, "--import", "own", "check", "model.json").returncode == 0
    done = call(
        tmp_path,
        "--import",
        "own",
        "run",
        "model.json",
        "--duration",
        "2",
        "--record",
        "d.output",
        "--format",
        "csv",
        "--out",
        "out",
    )
    assert done.returncode == 0, done.stderr
    assert "3.0" in (tmp_path / "out" / "record.csv").read_text()
    assert "Twice the input" in call(tmp_path, "--import", "own", "elements", "Doubling").stdout


WORLD = '''
import numpy as np
import deodar as dd

@dd.register
class Bulb(dd.World):
    """A bulb of constant brightness."""

    sensors = {"light": dd.Signal("brightness", (), "lux")}
    period = 1.0

    def __init__(self, light):
        self.light = float(light)

    @classmethod
    def open(cls, argument):
        return cls(argument)

    def sense(self, sensor, axes, time):
        return np.asarray(self.light)
'''


def test_a_custom_world_is_named_on_the_command_line(tmp_path: Path) -> None:
    (tmp_path / "bulb.py").write_text(WORLD)
    model = dd.Model("seeing")
    model.add(dd.Sensor("eye", sensor="light"))
    dd.save(model, tmp_path / "seeing.json")
    asked = ("run", "seeing.json", "--world", "bulb:7.5", "--duration", "2", "--record", "eye.output")
    unknown = call(tmp_path, *asked)
    assert unknown.returncode != 0 and "there is no world 'bulb'" in unknown.stderr
    done = call(tmp_path, "--import", "bulb", *asked, "--format", "csv", "--out", "out")
    assert done.returncode == 0, done.stderr
    assert "7.5" in (tmp_path / "out" / "record.csv").read_text()


def test_a_module_that_raises_at_import_is_an_error_without_traceback(tmp_path: Path) -> None:
    (tmp_path / "broken.py").write_text("raise ValueError('half done')")
    for name, says in (("broken", "half done"), ("absent", "No module named")):
        done = call(tmp_path, "--import", name, "elements")
        assert done.returncode == 1 and says in done.stderr and "Traceback" not in done.stderr
