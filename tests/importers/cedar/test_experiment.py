"""Experiments of cedar run as experiments here."""

from __future__ import annotations

import json

import pytest

import deodar as dd
from deodar.errors import DocumentError

BOOST, FIELD = "cedar.processing.sources.Boost", "cedar.dynamics.NeuralField"
ACTION = "cedar.proc.experiment.action"
SET, MORE, END = f"{ACTION}.SetParameterValue", f"{ACTION}.IncrementParameter", f"{ACTION}.EndTrial"


def condition(kind, **values):
    return {"type": f"cedar.proc.experiment.condition.{kind}", **values}


def sequence(name, when, *actions):
    """Return the text of a sequence whose set of actions may repeat a type."""
    listed = ", ".join(f"{json.dumps(kind)}: {json.dumps(body)}" for kind, body in actions)
    return f'{{"name": "{name}", "Condition": {json.dumps(when)}, "ActionSet": {{{listed}}}}}'


def value(element, parameter, number):
    place = {"element path": element, "parameter path": parameter, "parameter value": number}
    return {"Step Parameter": place}


@pytest.fixture
def files(tmp_path):
    steps = {
        BOOST: {"name": "boost", "strength": "0", "active": "true"},
        FIELD: {
            "name": "u",
            "dimensionality": "0",
            "sizes": "",
            "input noise gain": "0",
            "lateral kernels": "",
        },
    }
    wires = [{"source": "boost.boost", "target": "u.input"}]
    architecture = tmp_path / "model.json"
    architecture.write_text(json.dumps({"steps": steps, "connections": wires}))

    def write(*sequences, repetitions="2"):
        path = tmp_path / "experiment.json"
        listed = ", ".join(sequences)
        head = f'"name": "detection", "repetitions": "{repetitions}"'
        path.write_text(f'{{{head}, "ActionSequences": [{listed}]}}')
        return path, architecture

    return write


def test_actions_at_times_and_on_data_set_parameters_and_end_the_trial(files):
    done = dd.load_cedar_experiment(
        *files(
            sequence("on", condition("AtTime", Time="0.2 s"), (SET, value("boost", "strength", "8"))),
            sequence(
                "lower", condition("AtTime", Time="0.1 s"), (SET, value("u", "global inhibition", "-0.5"))
            ),
            sequence(
                "detected",
                condition(
                    "CheckData",
                    **{"Step Data": "u[BUFFER].activation", "compare operator": ">", "value": "1"},
                ),
                (END, {}),
            ),
        )
    )
    assert done.report.faithful
    table = done.experiment.run()
    assert table["outcome"].values.tolist() == ["detected", "detected"]
    assert 200 < float(table["detected"][0]) < 400
    first = done.experiment.actions[0]
    assert (first.at, first.path, first.value) == (200, "boost.amplitude", 8)
    assert done.experiment.actions[1].value == 0.5


def test_an_incremented_parameter_is_a_factor_and_what_has_no_counterpart_is_reported(files):
    step = {"StepParameter": {"element path": "u", "parameter path": "resting level"}, "step value": "0.5"}
    done = dd.load_cedar_experiment(
        *files(
            sequence(
                "next", condition("OnInit"), (MORE, step), (f"{ACTION}.WriteMessage", {"Message": "go"})
            ),
            sequence("stop", condition("AtTime", Time="400 ms"), (END, {})),
            sequence("odd", condition("OnTrialNumber", **{"on trial": "2"}), (END, {})),
            repetitions="3",
        )
    )
    factor = done.experiment.factors[0]
    assert (factor.path, list(factor.levels)) == ("u.resting_level", [-5, -4.5, -4])
    assert done.experiment.limit == 420
    assert [line.what for line in done.report.losses] == ["WriteMessage", "OnTrialNumber"]


def test_other_files_are_refused(files, tmp_path):
    _, architecture = files()
    with pytest.raises(DocumentError, match="is no experiment of cedar"):
        dd.load_cedar_experiment(architecture, architecture)
    with pytest.raises(DocumentError, match="there is no such file"):
        dd.load_cedar_experiment(tmp_path / "none.json", architecture)
