"""What files of all generations hold: projections, legacy names, groups, links, stored values, positions."""

from __future__ import annotations

import itertools
import json
import re
from pathlib import Path

import numpy as np
import pytest

import deodar as dd
from deodar.importers.opening import read, tool_of
from deodar_interop.importers.cedar.classes import CLASSES
from deodar_interop.importers.cedar.classes.missing import UNDOCUMENTED, WORLDS
from tests.deodar_interop.importers.cedar.models import Many, written

DATA = Path(__file__).parent / "data"
PROJECTIONS = sorted((DATA / "projection").glob("*.json"))
FIELD, GAIN = "cedar.dynamics.NeuralField", "cedar.processing.StaticGain"
LINE = {"dimensionality": "1", "sizes": ["20"]}


def opened(data, tmp_path, name="file.json"):
    """Write a file with `Many` for repeated keys, and open it."""
    (tmp_path / name).write_text(data if isinstance(data, str) else json.dumps(data))
    return read(tmp_path / name)


def why(done, where, part="element"):
    return [line.why for line in done.report.lines if line.where == where and line.part == part]


@pytest.mark.parametrize("path", PROJECTIONS, ids=lambda p: p.stem)
def test_a_projection_is_valid_as_its_name_says(path):
    assert tool_of(path) is not None
    done = read(path)
    refused = [line for line in done.report.lines if "cedar does not run it" in line.why]
    if path.stem.endswith("_invalid"):
        assert {line.where for line in refused} == {"new Projection", "new NeuralField 1"}
        record = dd.simulate(done.model, 200, dt=10, record=['"new NeuralField 1".activation'], every=200)
        assert np.all(record["new NeuralField 1.activation"].values == -5)
    else:
        assert not refused
        assert any(c.target_port == "input" for c in done.model.document.connections)


def test_very_old_names_of_parameters_and_types_are_read(tmp_path):
    field = {
        **LINE,
        "name": "u",
        "restingLevel": "-3",
        "tau": "40",
        "globalInhibition": "-0.2",
        "inputNoiseGain": "0",
        "numberOfKernels": "2",
        "lateralKernel0": {"amplitude": "4", "sigmas": ["2"]},
        "lateralKernel1": {"amplitude": "-1", "sigmas": ["4"]},
        "sigmoid": {"beta": "20", "threshold": "0.5"},
    }
    noise = {**LINE, "name": "n", "mean": "0", "standard deviation": "0.5"}
    text = {"steps": {FIELD: field, "cedar.dynamics.Noise": noise}, "networks": {"g": {"steps": ""}}}
    done = opened(text, tmp_path)
    u = done.model["u"]
    assert (u.tau, u.resting_level, u.global_inhibition, u.noise) == (40, -3, 0.2, 0)
    assert [k.amplitude for k in done.model.document.by_names()[("u",)].element.kernel] == [4, -1]
    assert done.model.document.by_names()[("u",)].element.sigmoid == dd.Absolute(20.0, 0.5)
    assert done.model["n"].amplitude == pytest.approx(0.5 * np.sqrt(20))
    assert ("g",) in done.model.document.groups


def test_a_renamed_type_and_an_unknown_one(tmp_path):
    steps = {
        "cedar.processing.steps.LinearDynamics": {"name": "old", "slope": "3"},
        "my.own.Step": {"name": "own"},
        "cedar.processing.sources.Boost": {"name": "b", "active": "true", "strength": "2"},
    }
    wires = [{"source": "b.boost", "target": "old.input"}, {"source": "b.boost", "target": "own.in"}]
    done = opened({"steps": steps, "connections": wires}, tmp_path)
    assert done.model["old"].factor == 3
    assert why(done, "own") == ["Placeholder: has no counterpart"]
    assert why(done, "own", "connection") == [""]


TRANSLATED = {kind.rpartition(".")[2] for kind in CLASSES}


def test_a_placeholder_says_what_to_use_or_what_is_not_documented(tmp_path):
    kinds = {*WORLDS, *UNDOCUMENTED} - TRANSLATED
    steps = {f"cedar.processing.steps.{kind}": {"name": kind} for kind in kinds}
    done = opened({"steps": steps}, tmp_path)
    own = ("element of your own", "reads='delayed'", "deodar export", "not documented")
    assert kinds
    for kind in kinds:
        message = why(done, kind)[0]
        used = re.findall(r"\bdd\.(\w+)|\b(Homography|ObstacleRepulsion|TimeSeries|Function)\b", message)
        assert all(hasattr(dd, first or second) for first, second in used), message
        assert message.startswith("Placeholder: ") and (used or any(words in message for words in own)), (
            message
        )


@pytest.mark.parametrize(
    ("values", "world"),
    [
        ({"component": "hardware epuck.drive"}, "dd.Arena as world in place of 'hardware epuck.drive'"),
        ({"component": "new robot.arm"}, "dd.MuJoCo as world in place of 'new robot.arm'"),
        ({"Command Subset": "differential drive interface"}, "open dd.Arena as world"),
        ({"component": []}, "dd.Arena for a vehicle or dd.MuJoCo for an arm"),
    ],
)
def test_a_part_of_a_robot_names_the_world_and_its_signals(values, world, tmp_path):
    part = {"name": "s", **values}
    steps = {"cedar.processing.steps.Component": part, FIELD: {**LINE, "name": "u"}}
    wires = [{"source": "s.Joint Angles", "target": "u.input"}]
    message = why(opened({"steps": steps, "connections": wires}, tmp_path), "s")[0]
    assert world in message and "(Joint Angles: sensor joint_angles)" in message


def test_repeated_keys_times_with_units_and_text_lists(tmp_path):
    text = written(
        {
            "steps": Many(
                [(FIELD, {**LINE, "name": n, "time scale": t}) for n, t in (("a", "0.05 s"), ("b", "70 ms"))]
            )
        }
    )
    done = opened(text, tmp_path)
    assert (done.model["a"].tau, done.model["b"].tau) == (50, 70)


def linked_fields(tmp_path, *links, **options):
    """Return two fields whose parameters are linked, with the first value stated."""
    steps = Many([(FIELD, {**LINE, "name": n, "time scale": "50", **options}) for n in ("a", "b")])
    return opened(written({"steps": steps, "parameter links": list(links)}), tmp_path)


def link(source, target, equation=""):
    direct = "cedar.aux.DirectParameterLink"
    return {
        "type": "cedar.aux.EquationParameterLink" if equation else direct,
        "source element": "a",
        "target element": "b",
        "source parameter": source,
        "target parameter": target,
        "configuration": {"equation": equation},
    }


def test_direct_links_become_document_parameters(tmp_path):
    done = linked_fields(
        tmp_path, link("time scale", "time scale"), link("global inhibition", "global inhibition")
    )
    done.model.set("a time scale", 90)
    done.model.set("a global inhibition", 0.4)
    assert (done.model["a"].tau, done.model["b"].tau) == (90, 90)
    assert (done.model["a"].global_inhibition, done.model["b"].global_inhibition) == (0.4, 0.4)
    assert not [line for line in done.report.losses if "->" in line.what]


@pytest.mark.parametrize(
    ("equation", "found"),
    [("target = 2 * source", -6), ("-(source - 1) / 4 + 0.5 - 3", -1.5), ("target=source*source - 1e1", -1)],
)
def test_links_by_an_equation_give_the_target_its_value(equation, found, tmp_path):
    settings = {"resting level": "-3"}
    done = linked_fields(tmp_path, link("resting level", "resting level", equation), **settings)
    assert (done.model["a"].resting_level, done.model["b"].resting_level) == (-3, found)
    line = next(line for line in done.report.losses if "->" in line.what)
    assert line.verdict == "approximated" and f"as the value {found}" in line.why


def test_an_equation_of_equality_is_a_direct_link_and_a_sign_follows(tmp_path):
    links = (
        link("resting level", "resting level", "target = 1 * source"),
        link("global inhibition", "time scale", "target = 10 - 20 * source"),
    )
    done = linked_fields(tmp_path, *links, **{"global inhibition": "-0.5"})
    done.model.set("a resting level", -2)
    assert (done.model["b"].resting_level, done.model["b"].tau) == (-2, 20)


@pytest.mark.parametrize(
    "equation",
    ["target = sin(source)", "source = target", "target = 1 / 0", "(" * 9000, "target = 9**9**9", "target ="],
)
def test_other_equations_are_reported_and_leave_the_value(equation, tmp_path):
    done = linked_fields(tmp_path, link("time scale", "time scale", equation))
    assert done.model["b"].tau == 50
    line = next(line for line in done.report.losses if "->" in line.what)
    assert line.verdict == "dropped" and "cannot be read" in line.why


def test_a_number_that_is_another_one_here_is_not_linked(tmp_path):
    boosts = Many(
        [
            ("cedar.processing.sources.Boost", {"name": n, "strength": "2", "active": on})
            for n, on in (("a", "false"), ("b", "true"))
        ]
    )
    done = opened(written({"steps": boosts, "parameter links": [link("strength", "strength")]}), tmp_path)
    assert (done.model["a"].amplitude, done.model["b"].amplitude) == (0, 2)
    assert any("its source has no counterpart" in line.why for line in done.report.losses)


def test_stored_values_beside_the_file_begin_traces_and_weights(tmp_path):
    trace = {**LINE, "name": "p", "time scale build up": "50", "time scale decay": "500"}
    values = np.linspace(0, 1, 20).round(3)
    text = "Mat,CV_32F,20,1\n" + ",".join(map(str, values))
    (tmp_path / "file.json.data").write_text(json.dumps({"p": {"OUTPUT": {"activation": text}}}))
    steps = {"cedar.dynamics.Preshape": trace, FIELD: {**LINE, "name": "u"}}
    wires = [{"source": "u.sigmoided activation", "target": "p.input"}]
    done = opened({"steps": steps, "connections": wires}, tmp_path)
    record = dd.simulate(done.model, 20, record=["p.output"], every=20)
    np.testing.assert_allclose(record["p.output"].values[0], values, atol=1e-6)


def test_a_linked_group_is_copied_from_its_file_with_its_connectors(tmp_path):
    inside = {
        "steps": {GAIN: {"name": "g", "gain factor": "4"}},
        "connectors": {"in": "true", "out": "false"},
        "connections": [
            {"source": "in.output", "target": "g.input"},
            {"source": "g.output", "target": "out.input"},
        ],
    }
    (tmp_path / "library.json").write_text(json.dumps({"steps": "", "groups": {"four": inside}}))
    link = {"linked file": {"path": "library.json", "isRelative": "true"}, "linked group name": "four"}
    steps = {FIELD: {**LINE, "name": "u"}, "cedar.processing.sources.Boost": {"name": "b"}}
    wires = [{"source": "b.boost", "target": "times.in"}, {"source": "times.out", "target": "u.input"}]
    done = opened({"steps": steps, "groups": {"times": link}, "connections": wires}, tmp_path)
    by = done.model.document.by_id()
    ends = {(by[c.source].path, by[c.target].path) for c in done.model.document.connections}
    assert ends == {("b", "times.g"), ("times.g", "u")}
    assert done.model["times.g"].factor == 4


def test_boxes_notes_and_switches_are_kept():
    doc = read(DATA / "first_architecture_step_1.json").model.document
    by = {e.path: e.id for e in doc.entries}
    boxes = doc.layout["boxes"]
    assert set(boxes) <= set(by.values()) and len(boxes) == 12
    assert boxes[by["first input"]]["x"] < boxes[by["association"]]["x"] + 500
    pin = doc.layout["pins"][0]
    assert (pin["element"], pin["lower"], pin["upper"], pin["switch"]) == (by["new Boost"], 0.0, 4.0, True)


@pytest.mark.parametrize(
    "file", ["first_architecture_step_1.json", "elementaryBehavior.json", "fieldTemplates.json"]
)
def test_boxes_are_scaled_apart_until_none_overlaps(file: str):
    doc = read(DATA / file).model.document
    ends = [(c.source, c.target) for c in doc.connections]
    on_wires = {
        e.id
        for e in doc.entries
        if isinstance(e.element, dd.Coupling)
        and [sum(pair[side] == e.id for pair in ends) for side in (0, 1)] == [1, 1]
    }
    boxes = [box for ident, box in doc.layout["boxes"].items() if ident not in on_wires]
    pairs = list(itertools.combinations(boxes, 2))
    assert len(pairs) > 10
    assert not [p for p in pairs if abs(p[0]["x"] - p[1]["x"]) < 179 and abs(p[0]["y"] - p[1]["y"]) < 123]


def test_known_errors_of_cedar_are_named():
    assert read(DATA / "projection_steps.json").report.bugs == [
        "2to3 20 short: two dimensions into three with exchanged axes leave slices empty; corrected"
    ]


def test_a_connection_that_cedar_refuses_states_its_reason_and_stops_the_field(tmp_path):
    short = {"name": "s", "dimensionality": "1", "sizes": ["30"]}
    steps = {
        "cedar.processing.sources.GaussInput": short,
        FIELD: {**LINE, "name": "u", "resting level": "-2"},
    }
    done = opened(
        {"steps": steps, "connections": [{"source": "s.Gauss input", "target": "u.input"}]}, tmp_path
    )
    assert why(done, "u", "connection") == ["cedar refuses it: size [30] into [20]"]
    assert any("cedar does not run it" in text for text in why(done, "u"))
    record = dd.simulate(done.model, 100, dt=10, record=["u.activation"], every=100)
    assert np.all(record["u.activation"].values == -2)


def test_a_step_that_cedar_does_not_run_states_all_its_time_scales(tmp_path):
    steps = {
        FIELD: {**LINE, "name": "u"},
        "cedar.dynamics.Preshape": {**LINE, "sizes": ["30"], "name": "trace"},
    }
    wires = [{"source": "u.sigmoided activation", "target": "trace.input"}]
    done = opened({"steps": steps, "connections": wires}, tmp_path)
    assert any("of the file, tau_build is 100, tau_decay is 1000" in text for text in why(done, "trace"))


def test_a_time_scale_of_a_position_that_jumps_is_without_effect(tmp_path):
    steps = {
        FIELD: {**LINE, "name": "u"},
        "cedar.dynamics.SpaceToRateCode": {"name": "rate", "tau": "400 ms", "use cyclic mean": "true"},
    }
    wires = [{"source": "u.sigmoided activation", "target": "rate.input"}]
    done = opened({"steps": steps, "connections": wires}, tmp_path)
    assert "without effect: the output jumps to the position" in why(done, "rate", "parameter")


def test_a_kernel_longer_than_the_field_stops_it_with_fftw_and_its_readers_get_zero(tmp_path):
    fourier = {"engine": {"type": "cedar.aux.conv.FFTW"}}
    small = {"name": "small", "dimensionality": "1", "sizes": ["9"], "lateral kernel convolution": fourier}
    ends = {
        "name": "node",
        "dimensionality": "0",
        "sizes": "",
        "input noise gain": "0",
        "lateral kernels": "",
    }
    area = {"name": "p", "output dimensionality": "0", "dimension mapping": {}}
    small["input noise gain"] = "0"
    steps = Many([(FIELD, small), (FIELD, ends), ("cedar.processing.Projection", area)])
    wires = [
        {"source": "small.sigmoided activation", "target": "p.input"},
        {"source": "p.output", "target": "node.input"},
    ]
    done = opened(written({"steps": steps, "connections": wires}), tmp_path)
    assert any("FFTW raises an exception for a kernel of [15] samples" in text for text in why(done, "small"))
    record = dd.simulate(done.model, 100, dt=10, record=["small.activation", "node.activation"], every=100)
    assert np.all(record["small.activation"].values == -5)
    assert abs(record["node.activation"].values + 5).max() < 0.01


def test_files_without_types_of_cedar_are_recognised(tmp_path):
    done = opened({"required": "", "steps": {"TestModule": {"name": "a"}}}, tmp_path)
    assert done.report.tool == "cedar"
    assert why(done, "a") == ["Placeholder: has no counterpart"]
