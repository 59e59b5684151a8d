"""Where values are recorded or read, the path of a field alone means its activation; of other elements the
default output.
"""

from __future__ import annotations

import numpy as np
import pytest

import deodar as dd
from deodar.recording.record import about
from tests.deodar.experiments.calls import run_alone, run_together

X = dd.Axis("x", 0, 10, samples=11)


@pytest.fixture(scope="module")
def model() -> dd.Model:
    model = dd.Model("paths")
    u = model.add(dd.Field("u", [X], resting_level=-1.0), group="g")
    (
        model.add(dd.GaussianStimulus("s", [X], center=5.0, sigma=2.0, amplitude=3.0))
        >> u
        >> model.add(dd.RateNode("n"))
    )
    return model


def test_record_by_the_path_of_a_field_contains_its_activation(model: dd.Model) -> None:
    record = dd.simulate(model, 3, record=[model["g.u"], "s", "n"])
    assert list(record.data_vars) == ["g.u.activation", "s.output", "n.activation"]
    assert about(record)["record"] == ["g.u.activation", "s.output", "n.activation"]
    assert dd.simulate(model, 3, record="g.u").equals(dd.simulate(model, 3, record="g.u.activation"))


def test_a_session_reads_the_activation_by_the_path_of_a_field(model: dd.Model) -> None:
    session = dd.Session(model)
    session.step(3)
    for path in ("g.u", model["g.u"]):
        np.testing.assert_array_equal(session.read(path), session.read("g.u.activation"))
    assert session.read("g.u").min() < 0 < session.read("g.u.output").min()


@pytest.mark.parametrize(
    "run", [run_alone, lambda *a, **k: run_together(*a, numbers=[0], **k)[0]], ids=["trial", "batch"]
)
def test_trials_by_the_path_of_a_field_read_its_activation(model: dd.Model, run) -> None:
    course = run(model, 3, watch=["g.u", "g.u.activation"], measures=[dd.Measure("end", "g.u", "min")])
    np.testing.assert_array_equal(course.values["g.u"], course.values["g.u.activation"])
    assert course.measures["end"] == course.values["g.u"][-1].min()


def test_options_of_the_command_line_accept_the_path_of_a_field(
    model: dd.Model, tmp_path, monkeypatch
) -> None:
    from deodar import cli

    monkeypatch.chdir(tmp_path)
    dd.save(model, "m.json")
    assert (
        cli.main(["run", "m.json", "--duration", "3", "--record", "g.u", "--out", "out", "--no-progress"])
        == 0
    )
    assert list(dd.load_record(next((tmp_path / "out").glob("*.zarr"))).data_vars) == ["g.u.activation"]


def test_a_connection_by_the_path_of_a_field_reads_its_output(model: dd.Model) -> None:
    assert {c.source_port for c in model.document.connections} == {"output"}
