"""The window of a script: its controls become pins and presets of a model."""

from __future__ import annotations

import inspect

import numpy as np
import pytest

import deodar as dd
from deodar.errors import ModelError, ParameterError, RunWarning
from deodar.model.kept_presets import kept_presets
from deodar_interop.compat.cosivina import (
    GaussStimulus1D,
    GlobalControlButton,
    LateralInteractions1D,
    MultiPlot,
    NeuralField,
    ParameterDropdownSelector,
    ParameterSlider,
    ParameterSwitchButton,
    PresetSelector,
    Simulator,
    StandardGUI,
    TimeDisplay,
)
from tests.deodar_interop.importers.cosivina.scripts import imported

SCRIPT = """
sim = Simulator();
sim.addElement(GaussStimulus1D('cue 1', 60, 4, 0, 20, true, false));
sim.addElement(GaussStimulus1D('cue 2', 60, 4, 0, 40, true, false));
sim.addElement(NeuralField('u', 60, 20, -5, 4), {'cue 1', 'cue 2'});
sim.addElement(LateralInteractions1D('u -> u', 60, 4, 12, 9, 8, -0.2), 'u', [], 'u');
gui = StandardGUI(sim, [50, 50, 700, 500]);
gui.addVisualization(MultiPlot('u', 'activation', 1, 'horizontal'), [1, 1]);
gui.addControl(ParameterSlider('h', 'u', 'h', [-10, 0], '%0.1f', 1, 'resting level'), [1, 1]);
gui.addControl(ParameterSlider('g', 'u -> u', 'amplitudeGlobal', [0, 2], '%0.2f', -1), [1, 2]);
gui.addControl(ParameterSlider('cues', {'cue 1', 'cue 2'}, {'amplitude', 'amplitude'}, [0, 9]), [2, 1]);
gui.addControl(ParameterSwitchButton('rest', 'u', 'tau', 20, 40, 'slower', false), [2, 2]);
gui.addControl(ParameterDropdownSelector('place', {'cue 1', 'cue 2'}, {'position', 'position'}, ...
  {[10, 25], [50, 35]}, {'far', 'near'}, 1), [3, 1]);
gui.addControl(ParameterDropdownSelector('at', 'cue 1', 'position', [10, 25.5]), [3, 2]);
gui.addControl(GlobalControlButton('Pause', gui, 'pauseSimulation', true, false, false, 'pause'), [4, 1]);
"""


def simulator():
    sim, size = Simulator(), (1, 60)
    sim.addElement(GaussStimulus1D("cue 1", size, 4, 0, 20, True, False))
    sim.addElement(GaussStimulus1D("cue 2", size, 4, 0, 40, True, False))
    sim.addElement(NeuralField("u", size, 20, -5, 4), ["cue 1", "cue 2"])
    sim.addElement(LateralInteractions1D("u -> u", size, 4, 12, 9, 8, -0.2), "u", None, "u")
    return sim


def window():
    gui = StandardGUI(simulator(), [50, 50, 700, 500], 0.01)
    gui.addVisualization(MultiPlot("u", "activation", 1, "horizontal"), [1, 1])
    gui.addControl(ParameterSlider("h", "u", "h", [-10, 0], "%0.1f", 1, "resting level"), [1, 1])
    gui.addControl(ParameterSlider("g", "u -> u", "amplitudeGlobal", (0, 2), "%0.2f", -1), [1, 2])
    gui.addControl(ParameterSlider("cues", ["cue 1", "cue 2"], ["amplitude"] * 2, np.array([0, 9])), [2, 1])
    gui.addControl(ParameterSwitchButton("rest", "u", "tau", 20, 40, toolTip="slower"), [2, 2])
    places = [[10, 25], [50, 35]]
    gui.addControl(
        ParameterDropdownSelector("place", ["cue 1", "cue 2"], ["position"] * 2, places, ["far", "near"], 1)
    )
    gui.addControl(ParameterDropdownSelector("at", "cue 1", "position", [10, 25.5]), [3, 2])
    gui.addControl(GlobalControlButton("Pause", gui, "pauseSimulation", True, False, False), [4, 1])
    return gui


def test_a_window_gives_the_document_of_the_same_launcher():
    gui, done = window(), imported(SCRIPT)
    assert gui.model.document.entries == done.model.document.entries
    assert gui.model.document.layout == done.model.document.layout
    assert gui.model.document.layout["plots"] == [{"element": gui.model["u"].id, "port": "activation"}]
    assert gui.model.document.parameters == done.model.document.parameters
    assert [line for line in gui.report.lines if line.part == "control"] == [
        line for line in done.report.lines if line.part == "control"
    ]


def test_a_model_follows_parameters_that_are_changed_later(tmp_path):
    gui = window()
    gui.init()
    gui.run(5)
    simulated = gui._simulator
    assert simulated.t == 5
    simulated.setElementParameters("u", "h", -3)
    assert gui.model["u"].resting_level == -3
    dd.save(gui.model, tmp_path / "choice.json")
    model = dd.load(tmp_path / "choice.json")
    dd.apply_preset(model, "place: near")
    assert model["cue 2"].center == (35,)


def test_a_window_without_an_end_warns_where_the_model_can_be_run():
    with pytest.warns(RunWarning, match=r"dd\.save\(gui\.model, FILE\)"):
        window().run()


def test_a_window_may_be_connected_later():
    gui = StandardGUI(None, [0, 0, 1, 1])
    gui.addVisualization(TimeDisplay(), [1, 1])
    with pytest.raises(ModelError, match="no simulator"):
        _ = gui.model
    gui.run(2, True, simulator())
    gui.connect(simulator())
    gui.updateVisualizations()
    gui.checkAndUpdateControls()
    assert [e.path for e in gui.model.document.entries] == ["cue 1", "cue 2", "u", "u -> u"]
    assert [line.what for line in gui.report.lines if line.part == "visualization"] == ["TimeDisplay"]


def test_a_simulator_gives_its_model():
    assert simulator().model.document.entries == window().model.document.entries


def test_presets_are_read_from_files_of_a_script(tmp_path):
    sim = simulator()
    sim.setElementParameters("u", "h", -8)
    sim.saveSettings(tmp_path / "calm.json")
    gui = StandardGUI(simulator(), [0, 0, 1, 1])
    gui.addControl(PresetSelector("Select", gui, str(tmp_path), ["calm.json", "no.json"], ["calm", "no"]))
    (tmp_path / "bad.json").write_text("{")
    gui.addControl(PresetSelector("More", gui, "", str(tmp_path / "bad.json")))
    model = gui.model
    assert [p.name for p in kept_presets(model.document)] == ["calm"]
    dd.apply_preset(model, "calm")
    assert model["u"].resting_level == -8
    lost = [str(line) for line in gui.report.losses]
    assert any("no.json cannot be read" in line for line in lost)
    assert any("bad.json is not JSON" in line for line in lost)


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: ParameterSlider("k", "u", "h", [1]), "k: expected a range of two numbers, got 1"),
        (lambda: ParameterSlider("k", ["u", "v"], "h", [0, 1]), "2 labels and 1 parameters"),
        (lambda: ParameterSwitchButton("k", "u", "h", [1, 2], 3), "2 values for 1 parameters"),
        (lambda: ParameterDropdownSelector("k", ["u"], ["h"], [[1], [2]]), "2 lists of values for 1"),
        (lambda: ParameterDropdownSelector("k", "u", "h", [1, 2], ["a"]), "1 names and 2 values"),
        (lambda: PresetSelector("k", None, "", ["a.json"], ["a", "b"]), "2 names and 1 files"),
    ],
)
def test_arguments_that_do_not_fit_together_are_an_error(make, says):
    with pytest.raises(ParameterError, match=says):
        make()


def test_controls_are_called_as_in_the_toolbox():
    names = list(inspect.signature(ParameterSlider).parameters)
    assert names[:6] == [
        *("controlLabel", "elementLabels", "parameterNames", "sliderRange", "valueFormat", "scalingFactor")
    ]
