"""Launchers of cosivina: the model, its sliders, switches, menus and presets."""

from __future__ import annotations

import numpy as np
import pytest

import deodar as dd
from deodar.errors import DocumentError
from deodar.importers import opening
from deodar.model.kept_presets import kept_preset, kept_presets, take_preset
from deodar_interop.importers.cosivina import read as read_file
from deodar_interop.importers.cosivina.launchers.launcher import is_launcher
from tests.deodar_interop.importers.cosivina.scripts import (
    PAIR,
    built,
    imported,
    launcher,
    parameters,
    pins,
    told,
)

SLIDER = "ParameterSlider('h', 'line', 'h', [-10, 0], '%0.1f', 1, 'resting level')"


def by_name(done, name):
    return done.model[name].element


def taken(done, name):
    """Return a model of the document with one of its presets."""
    doc, lines = take_preset(done.model.document, kept_preset(done.model.document, name))
    assert not [why for *_, why in lines if why]
    return dd.Model(document=doc)


def test_a_launcher_gives_the_model_that_its_parameter_file_would_give(tmp_path):
    sim, lost = built(PAIR)
    assert not lost
    saved = read_file(parameters(sim), "pair.json").model.document
    done = imported(launcher(SLIDER))
    assert done.model.document.entries == saved.entries
    assert done.model.document.connections == saved.connections
    assert done.model.document.step == 2
    assert [e.path for e in saved.entries][:4] == ["cue left", "cue right", "cues", "line"]


def test_arguments_that_are_left_out_have_the_defaults_of_cosivina():
    sim, _ = built(PAIR)
    assert sim.elements["watcher"].values == {"size": (1, 1), "tau": 10.0, "h": -5.0, "beta": 4.0}
    kernel = sim.elements["line -> line"].values
    assert kernel["circular"] is True and kernel["normalized"] is True and kernel["cutoffFactor"] == 5.0
    assert sim.elements["line"].inputs == [
        ("cues", "output"),
        ("line -> line", "output"),
        ("jitter", "output"),
    ]


def test_a_slider_is_a_pin_with_its_range_and_label():
    done = imported(launcher(SLIDER))
    pin = pins(done)["h"]
    line = done.model["line"]
    assert pin == {
        "element": line.id,
        "parameter": "resting_level",
        "lower": -10.0,
        "upper": 0.0,
        "label": "h",
    }
    assert told(done, "control")["h"] == ("carried", "slider of line.resting_level")


@pytest.mark.parametrize(
    ("control", "leaf", "lower", "upper"),
    [
        (
            "ParameterSlider('k', 'line -> line', 'amplitudeGlobal', [0, 1], '', -1)",
            "global_inhibition",
            0,
            1,
        ),
        ("ParameterSlider('k', 'line -> line', 'amplitudeInh', [0, 40])", "kernel.1.amplitude", -40, 0),
        ("ParameterSlider('k', 'cue left', 'position', [1, n])", "center.0", 1, 60),
        ("ParameterSlider('k', {'line'}, {'tau'}, [5 50], [], 0.5)", "tau", 10, 100),
        ("ParameterSlider('k', 'line', 'tau', [0 50])", "tau", 2, 50),
        ("ParameterSlider('k', 'jitter', 'amplitude', [0, 2])", "amplitude", 0, 2),
        ("ParameterSlider('k', 'level', 'amplitude', [-2, 2])", "factor", -2, 2),
    ],
)
def test_the_range_of_a_pin_is_in_the_numbers_of_deodar(control, leaf, lower, upper):
    pin = pins(imported(launcher(control)))["k"]
    assert (pin["parameter"], pin["lower"], pin["upper"]) == (
        leaf,
        pytest.approx(lower),
        pytest.approx(upper),
    )


def test_a_slider_of_several_equal_parameters_is_a_document_parameter():
    controls = "{'cue left', 'cue right'}, {'amplitude', 'amplitude'}"
    done = imported(launcher(f"ParameterSlider('strength', {controls}, [0, 8])"))
    pin = pins(done)["strength"]
    assert pin == {"element": "", "parameter": "strength", "lower": 0.0, "upper": 8.0}
    (shared,) = done.model.document.parameters
    assert [leaf for _, leaf in shared.links] == ["amplitude", "amplitude"]
    done.model.set("strength", 5)
    assert done.model["cue left"].amplitude == done.model["cue right"].amplitude == 5


def test_a_slider_of_parameters_with_different_values_is_one_for_each():
    controls = "{'line', 'watcher'}, {'h', 'h'}"
    done = imported(launcher(f"ParameterSlider('h', {controls}, [-9, 0])"))
    assert list(pins(done)) == ["h (line)", "h (watcher)"]
    assert told(done, "control")["h"][0] == "approximated"
    assert by_name(done, "line").resting_level == -4 and by_name(done, "watcher").resting_level == -5


def test_a_document_parameter_is_not_made_where_a_preset_needs_different_values():
    controls = "{'cue left', 'cue right'}, {'amplitude', 'amplitude'}"
    done = imported(
        launcher(
            f"ParameterSlider('strength', {controls}, [0, 8])",
            f"ParameterSwitchButton('one', {controls}, [0, 0], [7, 2])",
        )
    )
    assert not done.model.document.parameters
    assert list(pins(done)) == ["strength (cue left)", "strength (cue right)"]
    assert told(done, "control")["one"] == ("carried", "2 presets")
    model = taken(done, "one: on")
    assert (model["cue left"].amplitude, model["cue right"].amplitude) == (7, 2)


def test_a_button_gives_two_presets_and_a_switch():
    done = imported(launcher("ParameterSwitchButton('go', 'cue left', 'amplitude', 0, 6, 'show it', true)"))
    assert pins(done)["go"]["switch"] is True
    assert (pins(done)["go"]["lower"], pins(done)["go"]["upper"]) == (0.0, 6.0)
    assert [(p.name, p.group) for p in kept_presets(done.model.document)] == [
        ("go: off", "go"),
        ("go: on", "go"),
    ]
    assert taken(done, "go: on")["cue left"].amplitude == 6
    assert by_name(done, "cue left").amplitude == 0  # `true` presses the button and sets nothing


def test_a_button_of_several_parameters_with_their_own_values_gives_presets():
    done = imported(
        launcher("ParameterSwitchButton('quiet', {'line', 'watcher'}, {'h', 'h'}, {-4, -5}, {-9, -8})")
    )
    assert not pins(done)
    model = taken(done, "quiet: on")
    assert (model["line"].resting_level, model["watcher"].resting_level) == (-9, -8)
    assert told(done, "control")["quiet"] == ("carried", "2 presets")


def test_a_dropdown_menu_gives_a_preset_for_each_choice():
    done = imported(
        launcher(
            "ParameterDropdownSelector('place', {'cue left', 'cue right'}, {'position', 'position'}, ..."
            "\n {[10, 20, 29], [50, 40, 31]}, {'far', 'near', 'close'}, 2, 'distance')"
        )
    )
    assert [p.name for p in kept_presets(done.model.document)] == [
        "place: far",
        "place: near",
        "place: close",
    ]
    model = taken(done, "place: near")
    assert (model["cue left"].center, model["cue right"].center) == ((20,), (40,))
    assert by_name(done, "cue left").center == (15,)  # the choice at the start sets nothing


def test_a_dropdown_menu_without_names_is_named_by_its_values():
    done = imported(launcher("ParameterDropdownSelector('place', 'cue left', 'position', [10, 20.5])"))
    assert [p.name for p in kept_presets(done.model.document)] == ["place: 10", "place: 20.5"]


def test_a_button_that_changes_widths_along_all_dimensions_gives_presets():
    model = PAIR + "sim.addElement(KernelFFT('far', [1, n], 6, 1, 9, 0, 0), 'line', [], 'line');\n"
    done = imported(launcher("ParameterSwitchButton('wide', 'far', 'sigmaExc', {3}, {12})", model=model))
    kernel = taken(done, "wide: on")["far"].element.kernel[0]
    assert np.ravel(kernel.sigma).tolist() == [12]


def test_a_menu_of_parameter_files_gives_presets_of_all_their_values(tmp_path):
    sim, _ = built(PAIR)
    for name, h, tau in (("calm", -8, 40), ("lively", -1, 9)):
        sim.elements["line"].values.update(h=h, tau=tau)
        (tmp_path / f"{name}.json").write_bytes(parameters(sim))
    control = "PresetSelector('Select', gui, '', {'calm.json', 'lively.json'}, {'calm', 'lively'}, 'load')"
    done = imported(launcher(control), tmp_path)
    assert [(p.name, p.group) for p in kept_presets(done.model.document)] == [
        ("calm", "Select"),
        ("lively", "Select"),
    ]
    model = taken(done, "lively")
    model.set("line.sigmoid.beta", 9)
    doc, _ = take_preset(model.document, kept_preset(model.document, "calm"))
    model = dd.Model(document=doc)
    assert (model["line"].resting_level, model["line"].tau) == (-8, 40)
    assert model["line"].element.sigmoid.beta == 3  # a file has all values, also those that are the same
    assert told(done, "control")["Select"][0] == "carried"


def test_parameter_files_of_a_folder_are_read_beside_the_launcher(tmp_path):
    (tmp_path / "calm.json").write_bytes(parameters(built(PAIR)[0]))
    done = imported(launcher("PresetSelector('Select', gui, 'presets/', {'calm.json'})"), tmp_path)
    assert [p.name for p in kept_presets(done.model.document)] == ["calm.json"]


@pytest.mark.parametrize(
    "name", ["../calm.json", "/etc/calm.json", "C:\\calm.json", "..\\calm.json", "no.json"]
)
def test_parameter_files_elsewhere_are_reported(name, tmp_path):
    (tmp_path / "in").mkdir()
    (tmp_path / "calm.json").write_bytes(parameters(built(PAIR)[0]))
    done = imported(launcher(f"PresetSelector('Select', gui, '', {{'{name}'}})"), tmp_path / "in")
    assert not kept_presets(done.model.document)
    assert told(done, "control")["Select"] == ("dropped", "none of its files was read")


def test_elements_that_a_parameter_file_lacks_are_reported(tmp_path):
    sim, _ = built(PAIR)
    del sim.elements["watcher"]
    (tmp_path / "part.json").write_bytes(parameters(sim))
    done = imported(launcher("PresetSelector('Select', gui, '', 'part.json', 'part')"), tmp_path)
    (line,) = [line for line in done.report.lines if line.part == "preset"]
    assert (line.what, line.verdict) == (
        "part",
        "approximated",
    ) and "'watcher' is not in the file" in line.why


def test_sizes_of_a_parameter_file_are_not_taken_over(tmp_path):
    sim, _ = built(PAIR.replace("n = 60", "n = 40"))
    sim.elements["line"].values["tau"] = 33
    (tmp_path / "small.json").write_bytes(parameters(sim))
    done = imported(launcher("PresetSelector('Select', gui, '', 'small.json', 'small')"), tmp_path)
    (line,) = [line for line in done.report.lines if line.part == "preset"]
    assert "'line' has another size there" in line.why and "'watcher'" not in line.why
    model = taken(done, "small")
    assert model["line"].tau == 33 and model["line"].element.axes[0].samples == 60


def test_the_buttons_of_the_window_have_their_counterparts_in_the_studio():
    done = imported(
        launcher(
            "GlobalControlButton('Pause', gui, 'pauseSimulation', true, false, false, 'pause')",
            "GlobalControlButton('Fast', gui, 'skipFrames', 10, 1, false)",
            "RobotArenaControlPanel('robot', [1 2 3 4])",
        )
    )
    losses = told(done, "control")
    assert losses["Pause"] == ("carried", "Pause in the studio")
    assert losses["Fast"][0] == "dropped" and losses["robot"][0] == "dropped"


@pytest.mark.parametrize(
    ("control", "why"),
    [
        ("ParameterSlider('k', 'lines', 'h', [0, 1])", "no element has the label 'lines'"),
        (
            "ParameterSlider('k', 'line', 'hight', [0, 1])",
            "'line' is a NeuralField without a parameter 'hight'",
        ),
        ("ParameterSlider('k', 'line', 'h', [1, 1])", "its range is a single value"),
        ("ParameterSlider('k', 'line', 'h', [0, inf])", "its range ends at inf"),
        ("ParameterSlider('k', 'line', 'h', 3)", "its range has 1 numbers"),
        ("ParameterSlider('k', 'line', 'h', [0, 1], '', 0)", "its factor is 0"),
        ("ParameterSlider('k', {'line', 'cues'}, 'h', [0, 1])", "2 labels and 1 parameters do not fit"),
        ("ParameterSlider('k', 'line', 'h', [0, rand])", "rand differs from run to run"),
        ("ParameterSlider('k')", "its range has 0 numbers"),
        ("ParameterSlider('k', 'line', 'size', [1, 9])", "no number follows 'size'"),
        ("ParameterSwitchButton('k', 'line', 'h', [1, 2], 3)", "it has 2 values for 1 parameters"),
        ("ParameterSwitchButton('k', 'line', 'h', -4, -4)", "its choices do not differ"),
        ("ParameterDropdownSelector('k', 'line', 'h', {[1 2]}, {'a'})", "it has 1 names for 2 values"),
        ("ParameterDropdownSelector('k', 'line', 'h', {[1 2], 3}, {'a'})", "2 lists of values for 1"),
        ("PresetSelector('k', gui, '', {'a.json'}, {'a', 'b'})", "it has 2 names for 1 files"),
    ],
)
def test_controls_that_fit_nothing_are_reported_with_the_reason(control, why):
    done = imported(launcher(control, SLIDER))
    verdict, reason = told(done, "control")["k"]
    assert verdict == "dropped" and why in reason
    assert list(pins(done)) == ["h"]


def test_a_second_control_of_a_parameter_keeps_the_first_slider():
    done = imported(
        launcher(
            SLIDER, "ParameterSwitchButton('off', 'line', 'h', -4, -20)", SLIDER.replace("'h'", "'g'", 1)
        )
    )
    assert list(pins(done)) == ["h"]
    assert told(done, "control")["off"][0] == "carried"
    assert told(done, "control")["g"][0] == "approximated"


def test_equal_labels_of_sliders_name_their_elements():
    done = imported(launcher(SLIDER, "ParameterSlider('h', 'watcher', 'h', [-10, 0])"))
    assert list(pins(done)) == ["h (line)", "h (watcher)"]


def test_sliders_of_placeholders_are_reported():
    model = PAIR + "sim.addElement(MobileRobotArena('robot', n), 'level');\n"
    done = imported(launcher("ParameterSlider('speed', 'robot', 'forwardSpeed', [0, 1])", model=model))
    assert told(done, "control")["speed"] == ("dropped", "'robot' is a placeholder")


def test_visualizations_are_the_plots_that_are_shown_first():
    plots = (
        "gui.addVisualization(MultiPlot({'line', 'line'}, {'output', 'activation'}, [1, 10], ..."
        "\n  'horizontal', {'XTick', [1:5, unknownThing(3)]}, {{'b'}, {'r'}}, 'line'), [1, 1]);\n"
        "gui.addVisualization(ScaledImage('line -> line', 'fullSum', [0, 1]), [1, 2]);\n"
        "gui.addVisualization(SlicePlot('line', 'activation', 1), [1, 2]);\n"
        "gui.addVisualization(KernelPlot('line -> line', 'kernel', 'local'), [1, 3]);\n"
        "gui.addVisualization(MultiPlot('lines', 'activation'), [1, 3]);\n"
        "gui.addVisualization(MultiPlot(rand, 3), [1, 3]);\n"
        "gui.addVisualization(MultiPlot(), [1, 3]);\n"
        "gui.addVisualization(TimeDisplay(), [1, 3]);\n"
    )
    done = imported(launcher(SLIDER, end=plots + "gui.run(inf);\n"))
    assert done.model.document.layout["plots"] == [
        {"element": done.model["line"].id, "port": "activation"},
        {"element": done.model["line -> line"].id, "port": "total"},
    ]
    verdicts = [(line.what, line.verdict) for line in done.report.lines if line.part == "visualization"]
    assert verdicts == [
        ("MultiPlot", "approximated"),
        ("ScaledImage", "approximated"),
        ("SlicePlot", "approximated"),
        ("KernelPlot", "dropped"),
        ("MultiPlot", "dropped"),
        ("MultiPlot", "dropped"),
        ("MultiPlot", "dropped"),
        ("TimeDisplay", "carried"),
    ]
    assert not [line for line in done.report.lines if line.part == "statement"]


def test_a_window_with_many_plots_shows_the_first_of_them():
    model = "sim = Simulator();\nfor k = 1:20\n sim.addElement(NeuralField(sprintf('u%d', k), 5));\nend\n"
    plots = "for k = 1:20\n gui.addVisualization(MultiPlot(sprintf('u%d', k), 'activation'));\nend\n"
    done = imported(launcher(model=model, end=plots))
    assert len(done.model.document.layout["plots"]) == 12
    assert sum(line.part == "visualization" and line.verdict == "dropped" for line in done.report.lines) == 8


def test_a_file_that_the_simulator_loads_is_read_beside_the_launcher(tmp_path):
    sim, _ = built(PAIR)
    sim.elements["line"].values["tau"] = 33
    (tmp_path / "pair.json").write_bytes(parameters(sim))
    for text in (
        "sim = Simulator('file', 'pair.json');\n",
        "sim = Simulator(); sim.loadFromFile('pair.json');\n",
        PAIR + "sim.loadSettings('pair.json');\n",
    ):
        done = imported(launcher(SLIDER, model=text), tmp_path)
        assert by_name(done, "line").tau == 33 and len(done.model.document.entries) > 8
        assert list(pins(done)) == ["h"]
    with pytest.raises(DocumentError, match=r"the folder of the script has no file 'pairs\.json'"):
        imported("sim = Simulator('file', 'pairs.json');\n", tmp_path)


@pytest.mark.parametrize(("arguments", "samples"), [("'pair.json'", 60), ("'pair.json', 'all'", 80)])
def test_settings_of_a_file_leave_sizes_as_they_are_unless_all_are_asked_for(arguments, samples, tmp_path):
    sim, _ = built(PAIR.replace("n = 60", "n = 80"))
    sim.elements["line"].values["tau"] = 33
    (tmp_path / "pair.json").write_bytes(parameters(sim))
    done = imported(launcher(SLIDER, model=PAIR + f"sim.loadSettings({arguments});\n"), tmp_path)
    line = by_name(done, "line")
    assert line.tau == 33 and line.axes[0].samples == samples


def test_other_scripts_of_the_folder_are_read_where_they_are_named(tmp_path):
    (tmp_path / "buildPair.m").write_text(PAIR)
    (tmp_path / "addControls.m").write_text(launcher(SLIDER, model="", end="").strip())
    done = imported("buildPair;\naddControls;\ngui.run(inf);\n", tmp_path)
    assert list(pins(done)) == ["h"] and "line" in done.model


def test_functions_of_the_script_and_of_the_folder_are_read(tmp_path):
    (tmp_path / "withLine.m").write_text(
        "function sim = withLine(sim, n)\nsim.addElement(NeuralField('line', n, 20));\nend\n"
    )
    text = "sim = withLine(Simulator(), 40);\nsim = withNode(sim);\ngui = StandardGUI(sim, [0 0 1 1]);\n"
    text += "function s = withNode(s)\ns.addElement(NeuralField('node', 1));\nend\n"
    done = imported(text, tmp_path)
    assert [e.path for e in done.model.document.entries] == ["line", "node"]
    assert done.model["line"].element.axes[0].samples == 40


def test_the_simulator_of_the_window_is_read_where_there_are_several():
    text = PAIR + "other = Simulator();\nother.addElement(NeuralField('lone', 5));\n"
    done = imported(launcher(SLIDER, model=text))
    assert "line" in done.model and "lone" not in done.model
    assert told(done, "file")["Simulator"][0] == "dropped"


def test_a_launcher_opens_by_its_path_and_says_what_was_lost(tmp_path):
    path = tmp_path / "launcherPair.m"
    path.write_text(launcher(SLIDER, end="x = fminsearch(3);\nwhile true\n gui.step();\nend\n"))
    model = dd.load(path)
    assert model.document.name == "launcherPair" and "pins" in model.document.layout
    assert "line 17: dropped, 'fminsearch' is neither a variable nor a function" in model.document.notes
    assert "line 18: dropped, the loop runs the simulation" in model.document.notes
    assert ".m" in opening.endings()
    dd.save(model, tmp_path / "pair.json")
    assert kept_presets(dd.load(tmp_path / "pair.json").document) == kept_presets(model.document)
    dd.simulate(model, 4, every=4)


def test_a_script_without_a_simulator_is_an_error_with_the_first_reasons(tmp_path):
    path = tmp_path / "x.m"
    path.write_text("n = readtable('a');\nsim = Simulator();\nsim.addElement(5);\n")
    with pytest.raises(
        DocumentError, match=r"x\.m: is a script that builds no simulator of cosivina \(line 1: "
    ):
        dd.load(path)


@pytest.mark.parametrize(
    ("head", "expected"),
    [
        ("sim = Simulator();\n", True),
        ("addElement(sim, NeuralField('u', 3));\n", True),
        ("%% run\ncreateModel;\ngui.run(inf);\n", True),
        ("% sim = Simulator();\n", False),
        ('{"a": "Simulator("}', False),
        ("from cosivina.nonumba import *\nsim = Simulator()\n", False),
        ("import numpy\nsim.addElement(NeuralField('u'))\n", False),
        ("<html>Simulator()</html>", False),
        ("x = 3;\n", False),
        ("", False),
    ],
)
def test_scripts_of_cosivina_are_recognised(head, expected):
    assert is_launcher(head.encode()) is expected
