"""Launchers of models of their own, written for tests in the manner of MATLAB scripts for cosivina."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from deodar.importers._beside import in_folder
from deodar.importers.imported import Imported
from deodar_interop.importers.cosivina import read
from deodar_interop.importers.cosivina.launchers.launcher import plain, simulator_file
from deodar_interop.importers.cosivina.launchers.objects import BuiltSimulator
from deodar_interop.importers.cosivina.launchers.script_reader import ScriptReader

PAIR = """% two nodes that watch a line
n = 60;
sim = Simulator('deltaT', 2);

sim.addElement(GaussStimulus1D('cue left', n, 3, 0, round(1/4*n), true, false));
sim.addElement(GaussStimulus1D('cue right', n, 3, 0, round(3/4*n), true, false));
sim.addElement(SumInputs('cues', n), {'cue left', 'cue right'});
sim.addElement(NeuralField('line', n, 20, -4, 3), 'cues');
sim.addElement(LateralInteractions1D('line -> line', n, 4, 8, 9, 6, -0.1), ...
  'line', [], 'line');
sim.addElement(SumDimension('level', 2, 1, 0.5), 'line');
sim.addElement(NeuralField('watcher', 1), 'level');
sim.addElement(NormalNoise('jitter', n, 1), [], [], 'line');
"""

WINDOW = """
gui = StandardGUI(sim, [50, 50, 700, 500], 0.01, [0, 1/4, 1, 3/4], [2, 1], 0.06, [0, 0, 1, 1/4], [5, 3]);
"""


def launcher(*controls: str, model: str = PAIR, end: str = "gui.run(inf);\n") -> str:
    """Return a launcher whose window has these controls, each as a call of its class."""
    added = [f"gui.addControl({control}, [{k + 1}, 1]);\n" for k, control in enumerate(controls)]
    return model + WINDOW + "".join(added) + end


def imported(text: str, folder: Path | None = None) -> Imported:
    """Return the model of a launcher in a folder, or in none."""
    beside = (lambda _: None) if folder is None else in_folder(folder)
    return read(text.encode(), "launcherPair.m", beside=beside)


def built(text: str, folder: Path | None = None) -> tuple[BuiltSimulator, list[str]]:
    """Return the last simulator that a script builds, and what is reported."""
    reader = ScriptReader((lambda _: None) if folder is None else in_folder(folder))
    reader.read(text)
    return reader.simulators[-1], [str(line) for line in reader.lines]


def values(text: str, *names: str) -> list[Any]:
    """Return variables of a script, as parameter files hold them."""
    arguments = "".join(f"sim.addElement(Probe('{name}', {name}));\n" for name in names)
    reader = ScriptReader(lambda _: None)
    seen: dict[str, Any] = {}
    original = reader.call

    def call(name: str, given: Any) -> Any:
        if name == "Probe":
            seen[plain(given[0])] = plain(given[1])
        return original(name, given)

    reader.call = call  # type: ignore[method-assign]
    reader.read(f"sim = Simulator();\n{text}\n{arguments}")
    assert not [line for line in reader.lines if line.part == "statement"], reader.lines
    return [seen[name] for name in names]


def pins(done: Imported) -> dict[str, dict[str, Any]]:
    """Return the pins of a document by their labels."""
    pins: Any = done.model.document.layout.get("pins", [])
    return {pin.get("label", pin["parameter"]): pin for pin in pins}


def told(done: Imported, part: str) -> dict[str, tuple[str, str]]:
    """Return verdict and reason of the lines of a report about a part, by what they are about."""
    return {
        line.where or line.what: (line.verdict, line.why) for line in done.report.lines if line.part == part
    }


def parameters(sim: BuiltSimulator) -> bytes:
    """Return a simulator as a parameter file."""
    return simulator_file(sim)
