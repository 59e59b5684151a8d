"""Forms of older versions open, and the report states what they leave out."""

from __future__ import annotations

import json

import pytest

import deodar as dd
from deodar.elements.placeholder import Placeholder
from deodar.importers.opening import read
from tests.deodar_interop.importers.dnf_composer.files import BELL, FIELD, KERNEL, element, plane, written

OLD_HAT = {
    "sigmaExc": 1.0,
    "amplitudeExc": 4.0,
    "sigmaInh": 2.5,
    "amplitudeInh": 2.0,
    "amplitudeGlobal": -0.05,
}
HAT = {"widthExc": 1.0, "amplitudeExc": 4.0, "widthInh": 2.5, "amplitudeInh": 2.0, "amplitudeGlobal": -0.05}
SWITCHES = {"circular": True, "normalized": True}


def model_of(kernel, bell, folder, bare=False):
    parts = [element("s", "gauss stimulus", bell), element("u", "neural field", FIELD, ["s", "k"]), kernel]
    path = written(folder, parts)
    if bare:
        path.write_text(json.dumps(parts))
    return read(path)


@pytest.mark.parametrize(
    ("label", "old", "now", "values"),
    [
        (
            "gauss kernel",
            {"sigma": 1.5, "amplitude": 3.0},
            "gauss kernel",
            {**KERNEL, "amplitudeGlobal": 0.0},
        ),
        ("lateral interactions", OLD_HAT, "mexican hat kernel", {**HAT, **SWITCHES}),
        ("lateral interactions", HAT, "mexican hat kernel", {**HAT, **SWITCHES}),
        (
            "mexican hat kernel",
            {},
            "mexican hat kernel",
            {
                **{"amplitudeExc": 11.0, "widthExc": 2.5, "amplitudeInh": 15.0, "widthInh": 5.0},
                **{"amplitudeGlobal": 0.0, **SWITCHES},
            },
        ),
        (
            "asymmetric gauss kernel",
            {},
            "asymmetric gauss kernel",
            {"amplitude": 3.0, "width": 3.0, "timeShift": 0.0, "amplitudeGlobal": 0.0, **SWITCHES},
        ),
    ],
)
@pytest.mark.parametrize("bare", [True, False])
def test_an_old_kernel_is_that_of_today_and_the_defaults_are_reported(
    label, old, now, values, bare, tmp_path
):
    bell = {"sigma": 2.0, **{k: v for k, v in BELL.items() if k != "width"}}
    before = model_of(element("k", label, old, ["u"]), bell, tmp_path, bare)
    after = model_of(element("k", now, values, ["u"]), BELL, tmp_path)
    assert [e.element for e in before.model.document.entries] == [
        e.element for e in after.model.document.entries
    ]
    assert after.report.faithful and all(line.verdict == "approximated" for line in before.report.losses)
    problems = {line.what for line in before.report.losses}
    assert {
        "sigma",
        *(set(old) & {"sigma", "sigmaExc", "sigmaInh"}),
        *(set(values) - set(old) - {"width", "widthExc", "widthInh"}),
    } <= problems
    assert ("lateral interactions" in problems) == (label != now) and ("deltaT" in problems) == bare


def test_a_width_in_both_forms_is_read_once(tmp_path):
    done = read(written(tmp_path, [element("s", "gauss stimulus", {**BELL, "sigma": 9.0})]))
    assert [(line.what, line.verdict) for line in done.report.losses] == [("sigma", "dropped")]
    assert done.model["s"].element.sigma == 2


@pytest.mark.parametrize(
    ("values", "samples", "lost"),
    [
        ({"inputFieldSize": 20}, 20, ["inputFieldSize"]),
        ({}, 100, ["input_x_max"]),
        ({"input_x_max": 50}, 100, ["input_x_max"]),
    ],
)
def test_the_input_of_an_old_coupling(values, samples, lost, tmp_path):
    parts = [
        element("u", "neural field", FIELD, x=samples),
        element(
            "k", "gauss field coupling", {**SWITCHES, "couplings": [[5.0, 5.0, 1.0, 2.0]], **values}, ["u"]
        ),
    ]
    done = read(written(tmp_path, parts))
    assert [line.what for line in done.report.losses] == lost
    assert done.model["k"].element.weights.shape == (20, samples)


def test_couplings_of_positions_alone_are_left_out(tmp_path):
    values = {"input_x_max": 20, "input_d_x": 1.0, **SWITCHES, "couplings": [[5.0, 6.0], [7.0, 8.0]]}
    done = read(written(tmp_path, [element("k", "gauss field coupling", values)]))
    assert [(line.what, line.verdict) for line in done.report.losses if line.part == "parameter"] == [
        ("couplings", "dropped")
    ]
    assert not done.model["k"].element.weights.data.any()


@pytest.mark.parametrize("function", [None, {"type": "tanh"}, 3, {}])
def test_an_unknown_activation_function_is_a_sigmoid(function, tmp_path):
    done = read(written(tmp_path, [element("u", "neural field", {**FIELD, "activationFunction": function})]))
    assert done.model["u"].element.sigmoid == dd.Logistic(10.0, 0.0)
    assert [line.what for line in done.report.losses] == ["activationFunction"]


def test_an_activation_function_without_a_value_takes_the_default(tmp_path):
    function = {"type": "abs_sigmoid", "x_shift": 0.5}
    done = read(written(tmp_path, [element("u", "neural field", {**FIELD, "activationFunction": function})]))
    assert done.model["u"].element.sigmoid == dd.Absolute(100.0, 0.5)
    assert "beta 100" in done.report.losses[0].why


def test_a_stimulus_over_a_plane_without_an_amplitude_takes_the_default(tmp_path):
    bell = {**BELL, "position_x": 5.0, "position_y": 2.0}
    del bell["amplitude"]
    done = read(written(tmp_path, [plane("s", "gauss stimulus 2d", bell)]))
    assert done.model["s"].element.amplitude == 15


def test_a_time_constant_below_the_step_is_raised_to_it(tmp_path):
    done = read(written(tmp_path, [element("u", "neural field", {**FIELD, "tau": 0.0})], dt=25.0))
    assert done.model["u"].element.tau == 25 and done.report.losses[0].what == "tau"
    dd.simulate(done.model, 50, every=25)


def test_a_switch_of_zero_or_one_is_read(tmp_path):
    done = read(
        written(tmp_path, [element("s", "gauss stimulus", {**BELL, "circular": 0, "normalized": "no"})])
    )
    assert {line.what: line.why for line in done.report.losses} == {
        "circular": "it is 0, read as False",
        "normalized": "it is 'no'; False is used",
    }
    assert not isinstance(done.model["s"].element, Placeholder)
