"""Which connections dnf-composer makes, and what the report states of the others."""

from __future__ import annotations

import pytest

import deodar as dd
from deodar.importers.opening import read
from tests.deodar_interop.importers.dnf_composer.files import BELL, FIELD, KERNEL, element, plane, written

COUPLING = {"scalar": 1.0, "input_x_max": 20, "input_d_x": 1.0}


def field(name, inputs=None, x=20):
    return element(name, "neural field", FIELD, inputs, x)


def dropped(parts, folder):
    done = read(written(folder, parts))
    return done, {
        (line.where, line.what): line.why for line in done.report.losses if line.part == "connection"
    }


@pytest.mark.parametrize(
    ("parts", "where", "what", "says"),
    [
        ([field("u", ["v"]), field("v", x=30)], "u", "v.output", "30 samples into 20"),
        ([field("u", ["v", ("v", "activation")]), field("v")], "u", "v.activation", "a second connection"),
        ([field("u", ["w"])], "u", "w.output", "there is no such element"),
        ([field("u", [("v", "mind")]), field("v")], "u", "v.mind", "gives no 'mind' here"),
        ([field("u", [["v", 3]]), field("v")], "u", "['v', 3]", "is not [name, component]"),
        (
            [field("u"), element("k", "field coupling", COUPLING, [("u", "target")])],
            "k",
            "u.target",
            "learning",
        ),
        (
            [field("u"), field("v"), element("k", "resize", {}, ["u", "v"])],
            "k",
            "v.output",
            "takes one input",
        ),
        (
            [
                field("u", x=50),
                element(
                    "k", "gauss field coupling", {**COUPLING, "circular": False, "normalized": True}, ["u"]
                ),
            ],
            "k",
            "u.output",
            "50 samples into 20",
        ),
        (
            [field("u", x=3000), plane("w", "neural field 2d", FIELD, ["u"], (50, 60))],
            "w",
            "u.output",
            "does not fit",
        ),
    ],
)
def test_a_connection_that_is_not_made_is_reported(parts, where, what, says, tmp_path):
    done, losses = dropped(parts, tmp_path)
    assert list(losses) == [(where, what)] and says in losses[where, what]
    dd.simulate(done.model, 2, every=2)


def test_inputs_that_are_not_read_have_no_effect(tmp_path):
    timed = element("s", "timed gauss stimulus", {**BELL, "onTimes": []}, ["u"])
    noise = element("n", "normal noise", {"amplitude": 0.0}, ["u"])
    done = read(written(tmp_path, [field("u"), timed, noise]))
    assert done.report.faithful and [c.source_port for c in done.model.document.connections] == ["output"]
    assert sum("does not read its input" in line.why for line in done.report.lines) == 2


@pytest.mark.parametrize("inputs", [None, [], {}])
def test_every_form_of_no_input_is_read(inputs, tmp_path):
    done = read(written(tmp_path, [{**field("u"), "inputs": inputs}]))
    assert done.report.faithful and not done.model.document.connections


def test_a_kernel_without_input_gives_zero(tmp_path):
    done = read(written(tmp_path, [element("k", "gauss kernel", KERNEL), field("u", ["k"])]))
    assert done.report.faithful
    assert "k: connection input: carried, nothing is connected to it; zero arrives" in map(
        str, done.report.lines
    )
    assert (dd.simulate(done.model, 3, every=3)["u.activation"] == -2).all()


@pytest.mark.parametrize("count", [1, 2, 3])
def test_loops_of_kernels_run(count, tmp_path):
    ring = [element(f"k{n}", "gauss kernel", KERNEL, [f"k{(n + 1) % count}"]) for n in range(count)]
    done = read(written(tmp_path, [*ring, field("u", ["k0"])]))
    assert done.report.faithful
    assert (dd.simulate(done.model, 5, every=5)["u.activation"] == -2).all()
