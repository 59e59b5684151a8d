"""Each label of dnf-composer gives what plain loops give, in any order of the list."""

from __future__ import annotations

import random

import numpy as np
import pytest

import deodar as dd
from deodar.model.check import problems
from deodar_interop.importers.dnf_composer.classes import CLASSES
from deodar_interop.importers.dnf_composer.sample_values import METHODS, matrix
from tests.deodar_interop.importers.dnf_composer.files import (
    BELL,
    FIELD,
    KERNEL,
    element,
    imported,
    plane,
    written,
)
from tests.deodar_interop.importers.dnf_composer.oracle import Simulation

STEPS = 12
HAT = {**KERNEL, "amplitudeExc": 4.0, "widthExc": 1.0, "amplitudeInh": 2.0, "widthInh": 2.5}
WAVE = {**KERNEL, "amplitude": 0.6, "decay": 0.3, "zeroCrossings": 0.7}
SLOPE = {**KERNEL, "timeShift": 0.8, "timeShift_x": 0.7, "timeShift_y": -0.4}
NOISE = {"amplitude": 0.0, "width": 2.0, "circular": True}
COUPLING = {"input_x_max": 20, "input_d_x": 1.0}


def field(name, inputs, function=None, **values):
    settings = {**FIELD, **({"activationFunction": function} if function else {}), **values}
    return element(name, "neural field", settings, inputs)


def on_a_line(label, values, **options):
    """A stimulus, a field, the element of a label, and a field that reads it."""
    middle = element("k", label, values, ["u"], **options)
    reader = element("v", "neural field", {**FIELD, "restingLevel": -0.5}, ["k"], **options)
    return [element("s", "gauss stimulus", BELL), field("u", ["s"]), middle, reader]


def on_a_plane(label, values, d=1.0):
    bell = {**BELL, "position_x": 5.3 * d, "position_y": 2.2 * d, "width": 1.7}
    return [
        plane("s", "gauss stimulus 2d", bell, d=d),
        plane("u", "neural field 2d", FIELD, ["s"], d=d),
        plane("k", label, values, ["u"], d=d),
        plane("v", "neural field 2d", {**FIELD, "restingLevel": -0.5}, ["k"], d=d),
    ]


def switched(label, values):
    """All combinations of the two switches of a kernel."""
    for circular in (True, False):
        for normalized in (True, False):
            yield label, {**values, "circular": circular, "normalized": normalized}


MODELS = {
    f"{label} {values['circular']} {values['normalized']}": (
        on_a_plane if label.endswith("2d") else on_a_line
    )(label, values)
    for kind, given in (
        ("gauss", KERNEL),
        ("mexican hat", HAT),
        ("oscillatory", WAVE),
        ("asymmetric gauss", SLOPE),
    )
    for end in ("", " 2d")
    for label, values in switched(f"{kind} kernel{end}", given)
}
MODELS |= {
    "wide kernel": on_a_line("gauss kernel", {**KERNEL, "width": 30.0}),
    "wide wave": on_a_line("oscillatory kernel", {**WAVE, "decay": -1.0}),
    "hat of one part": on_a_line("mexican hat kernel", {**HAT, "amplitudeInh": 0.0}),
    "negative slope": on_a_line("asymmetric gauss kernel", {**SLOPE, "amplitude": -2.0}),
    "fine plane": on_a_plane("gauss kernel 2d", KERNEL, d=0.5),
    "memory": on_a_line("memory trace", {"tauBuild": 5.0, "tauDecay": 20.0, "threshold": 0.3}),
    "memory 2d": on_a_plane("memory trace 2d", {"tauBuild": 5.0, "tauDecay": 20.0, "threshold": 0.3}),
    "resize up": on_a_line("resize", {}, x=35),
    "resize nearest": on_a_line("resize", {"method": 1}, x=7),
    "resize cubic": on_a_line("resize", {"method": 2}, x=31, d=0.5),
    "resize to one": on_a_line("resize", {}, x=1),
    "peaks": on_a_line(
        "gauss field coupling",
        {**COUPLING, "circular": False, "normalized": True, "couplings": [[4.0, 9.0, 3.0, 2.0]]},
        x=15,
        d=0.5,
    ),
    "circular peaks": on_a_line(
        "gauss field coupling",
        {
            **COUPLING,
            "circular": True,
            "normalized": False,
            "couplings": [[1.0, 14.0, 1.0, 2.0], [18.0, 3.0, 0.5, 1.0]],
        },
        x=15,
    ),
    "heaviside": [
        element("s", "gauss stimulus", BELL),
        field("u", ["s"], {"type": "heaviside", "x_shift": 0.4}),
        element("k", "gauss kernel", KERNEL, ["u"]),
    ],
    "abs sigmoid": [
        element("s", "gauss stimulus", BELL),
        field("u", ["s"], {"type": "abs_sigmoid", "x_shift": 0.4, "beta": 3.0}),
        element("k", "gauss kernel", KERNEL, ["u"]),
    ],
    "boosts": [
        element("b", "boost stimulus", {"amplitude": 3.0, "isActive": True}),
        element("c", "boost stimulus", {"amplitude": 9.0, "isActive": False}),
        field("u", ["b", "c"]),
        plane("b2", "boost stimulus 2d", {"amplitude": 2.5, "isActive": True}),
        plane("w", "neural field 2d", FIELD, ["b2"]),
    ],
    "normalised bells": [
        element("s", "gauss stimulus", {**BELL, "normalized": True, "circular": False, "amplitude": 30.0}),
        field("u", ["s"]),
        plane("s2", "gauss stimulus 2d", {**BELL, "normalized": True, "position_x": 0.3, "position_y": 5.5}),
        plane("w", "neural field 2d", FIELD, ["s2"]),
    ],
    "timed": [
        element("s", "timed gauss stimulus", {**BELL, "onTimes": [[2.0, 4.0], [7.0, 7.5]]}),
        field("u", ["s"]),
        plane("w", "neural field 2d", FIELD, ["s2"]),
        plane(
            "s2",
            "timed gauss stimulus 2d",
            {**BELL, "position_x": 3.0, "position_y": 2.0, "onTimes": [[0.0, 3.0]]},
        ),
    ],
    "added once": [
        element("s", "gauss stimulus", BELL, ["u", "b"]),
        element("b", "boost stimulus", {"amplitude": 1.5, "isActive": True}),
        element("c", "gauss stimulus", BELL, ["s"]),
        field("u", ["c"], {"type": "abs_sigmoid", "x_shift": 0.0, "beta": 1.0}),
    ],
    "own input": [
        element("s", "gauss stimulus", BELL),
        field("u", ["s", "u", ("v", "activation")]),
        field("v", ["u"]),
    ],
    "expand x": [
        element("s", "gauss stimulus", BELL, x=8),
        element("u", "neural field", FIELD, ["s"], x=8),
        element("k", "expand", {}, ["u"], x=8, y_max=6, d_y=1.0),
        plane("v", "neural field 2d", FIELD, ["k"]),
    ],
    "expand y": [
        element("s", "gauss stimulus", BELL, x=6),
        element("u", "neural field", FIELD, ["s"], x=6),
        element("k", "expand", {"broadcastProfileAxis": 1}, ["u"], x=8, y_max=6, d_y=1.0),
        plane("v", "neural field 2d", FIELD, ["k"]),
    ],
    "line as a plane": [
        element("s", "gauss stimulus", BELL, x=48),
        element("u", "neural field", FIELD, ["s"], x=48),
        plane("v", "neural field 2d", FIELD, ["u"]),
        element("k", "gauss kernel", KERNEL, ["v"], x=48),
    ],
    "samples that do not fill the extent": [
        element("s", "gauss stimulus", BELL, x=10, d=0.3),
        element("u", "neural field", FIELD, ["s"], x=10, d=0.3),
        element(
            "s2",
            "gauss stimulus 2d",
            {**BELL, "position_x": 0.2, "position_y": 1.0},
            x=10,
            d=0.3,
            y_max=2,
            d_y=0.3,
        ),
        element("w", "neural field 2d", FIELD, ["s2"], x=10, d=0.3, y_max=2, d_y=0.3),
    ],
    "one sample": [
        element("s", "gauss stimulus", {**BELL, "position": 0.4, "circular": False}, x=1),
        element("u", "neural field", FIELD, ["s"], x=1),
        element("k", "oscillatory kernel", {**WAVE, "normalized": False}, ["u"], x=1),
        element("v", "neural field", FIELD, ["k"], x=1),
    ],
    "noise": [
        element("n", "normal noise", NOISE),
        element("c", "correlated normal noise", NOISE),
        field("u", ["n", "c"]),
        plane("n2", "normal noise 2d", NOISE),
        plane("c2", "correlated normal noise 2d", NOISE),
        plane("w", "neural field 2d", FIELD, ["n2", "c2"]),
    ],
}
for how in range(4):
    for axis in range(2):
        MODELS[f"collapse {how} {axis}"] = [
            *on_a_plane("gauss kernel 2d", KERNEL)[:2],
            element("k", "collapse", {"compression": how, "keepAxis": axis}, ["u"], x=(8, 6)[axis]),
            element("v", "neural field", FIELD, ["k"], x=(8, 6)[axis]),
        ]
for method in range(3):
    MODELS[f"resize 2d {method}"] = [
        *on_a_plane("gauss kernel 2d", KERNEL)[:2],
        plane("k", "resize 2d", {"method": method}, ["u"], (9, 5)),
        plane("v", "neural field 2d", FIELD, ["k"], (9, 5)),
    ]


def shown(label):
    """The components that show at each time what dnf-composer shows, in any order of the list."""
    if label.startswith("neural field"):
        return ("activation", "output")
    return ("output",) if label.startswith(("memory", "timed")) else ()


def compared(parts, folder, dt=1.0, weights=None, steps=STEPS):
    """The largest difference of any activation, output of a field or trace, at any step."""
    done = imported(written(folder, parts, dt))
    assert problems(done.model.document) == [], done.report.text()
    ports = {
        (e["uniqueName"], c): f"{dd.quote(e['uniqueName'])}.{c}" for e in parts for c in shown(e["label"][1])
    }
    record = dd.simulate(done.model, steps * dt, every=dt, record=list(ports.values()), precision="float64")
    plain, worst = Simulation(parts, dt, weights), 0.0
    for step in range(steps + 1):
        for (name, component), port in ports.items():
            samples = record[port].values[step].reshape(-1)
            worst = max(worst, float(abs(samples - plain.out[name][component]).max()))
        plain.step()
    return worst, done


@pytest.mark.parametrize("name", MODELS)
def test_every_label_agrees_with_plain_loops_in_any_order(name, tmp_path):
    parts = MODELS[name]
    shuffled = list(parts)
    random.Random(name).shuffle(shuffled)
    for order in (parts, shuffled):
        worst, done = compared(order, tmp_path)
        assert worst < 1e-12, [e["uniqueName"] for e in order]
        assert all("has no such parameter" in line.why for line in done.report.losses), done.report.losses


def test_all_labels_are_among_the_models():
    used = {e["label"][1] for parts in MODELS.values() for e in parts}
    assert set(CLASSES) - used == {"field coupling"}


@pytest.mark.parametrize("dt", [0.1, 2.5])
def test_another_step_gives_the_same_times_as_repeated_sums(dt, tmp_path):
    """0.1 added three times is above 0.3, so that a period until 0.3 ends after two steps."""
    stimulus = element("s", "timed gauss stimulus", {**BELL, "onTimes": [[0.0, 0.3], [5.0, 9.9]]})
    worst, _ = compared([stimulus, field("u", ["s"])], tmp_path, dt, steps=60 if dt < 1 else 8)
    assert worst < 1e-12


@pytest.mark.parametrize("scalar", [1.0, 0.7])
def test_weights_are_read_from_the_file_beside(scalar, tmp_path):
    weights = np.random.default_rng(1).normal(size=(20, 15)).round(3)
    np.savetxt(tmp_path / "k -> v_weights.txt", weights)
    parts = [
        element("s", "gauss stimulus", BELL),
        field("u", ["s"]),
        element("k -> v", "field coupling", {**COUPLING, "scalar": scalar}, ["u"], x=15),
        element("v", "neural field", FIELD, ["k -> v"], x=15),
    ]
    for order in (parts, parts[::-1]):
        worst, done = compared(order, tmp_path, weights={"k -> v": weights})
        assert worst < 1e-12 and done.report.faithful
    assert "file k -> v_weights.txt: carried" in [
        str(line).split(": ", 1)[1] for line in done.report.lines if line.part == "file" and line.where
    ]


def test_a_plane_too_large_for_one_matrix_is_resampled_along_each_axis(tmp_path, monkeypatch):
    from deodar_interop.importers.dnf_composer.classes import shapes

    monkeypatch.setattr(shapes, "DENSE", 10)
    for method in range(3):
        worst, done = compared(MODELS[f"resize 2d {method}"], tmp_path)
        assert worst < 1e-12
    doc = done.model.document
    assert "Product" in {type(e.element).__name__ for e in doc.entries}
    projections = {e.id for e in doc.entries if isinstance(e.element, dd.Project)}
    assert projections and projections <= {c.source for c in doc.connections}


@pytest.mark.parametrize("method", METHODS)
def test_a_single_sample_is_that_in_the_middle(method):
    assert matrix(method, 5, 1).tolist() == [[0, 0, 1, 0, 0]]
    assert matrix(method, 4, 1).tolist() == [[0, 0, 1, 0]]


def test_components_of_an_element_are_read_by_others(tmp_path):
    parts = [
        element("s", "gauss stimulus", BELL),
        field("u", ["s", "k"]),
        element("k", "gauss kernel", KERNEL, ["u"]),
        field("a", [("u", "input")]),
        field("b", [("u", "resting level")]),
        field("c", [("k", "kernel")]),
    ]
    done = imported(written(tmp_path, parts))
    assert done.report.faithful and problems(done.model.document) == []
    record = dd.simulate(done.model, 40, every=40, precision="float64")
    u = record["u.activation"].values[-1]
    assert abs(record["b.activation"].values[-1] + 4).max() < 0.1
    assert abs(record["a.activation"].values[-1] - u).max() < 0.1
    taps = np.exp(-0.5 * (np.arange(-8, 9) / 1.5) ** 2)
    expected = np.append(3 * taps / taps.sum(), np.zeros(3))
    assert abs(done.model["k kernel"].element.values.data - expected).max() < 1e-12
