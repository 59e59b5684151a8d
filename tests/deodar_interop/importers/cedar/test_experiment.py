"""Experiments of cedar run as experiments here."""

from __future__ import annotations

import json
import random

import pytest

import deodar as dd
from deodar.errors import DeodarError, DocumentError
from tests.deodar_interop.importers import hostile

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
        "cedar.processing.ConstVector": {
            "name": "vector",
            "number of vector entries": "5",
            "entries": ["1", "2", "2", "3", "4"],
        },
        "cedar.dynamics.Preshape": {"name": "trace", "dimensionality": "0", "sizes": ""},
        "cedar.processing.sources.GaussInput": {"name": "off", "sizes": ["5"], "dimensionality": "1"},
    }
    wires = [
        {"source": "boost.boost", "target": "u.input"},
        {"source": "u.sigmoided activation", "target": "trace.input"},
    ]
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
                (END, {"Reset type": "Reload", "Success": "true"}),
            ),
        )
    )
    assert done.report.faithful
    table = done.experiment.run()
    assert table["outcome"].values.tolist() == ["detected", "detected"]
    assert 200 < float(table["detected"][0]) < 400
    first = done.experiment.plan.actions[0]
    assert (first.at, first.path, first.value) == (200, "boost.amplitude", 8)
    assert done.experiment.plan.actions[1].value == 0.5


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
    assert (factor.path, list(factor.levels)) == ("u.resting_level", [-4.5, -4, -3.5])
    assert done.experiment.plan.limit == 420
    assert [line.what for line in done.report.losses] == ["WriteMessage"]
    table = done.experiment.run()
    assert table["outcome"].values.tolist() == ["stop ends", "odd ends", "stop ends"]
    assert table["duration"].values.tolist()[1] < 100


def both(first, second):
    return condition("And", **{"Condition 1": first, "Condition 2": second})


def at(time):
    return condition("AtTime", Time=time)


def trial(number):
    return condition("OnTrialNumber", **{"on trial": number})


def data(path, compare, level, count=None):
    some = {} if count is None else {"check full matrix": "false", "number of elements": count}
    return condition(
        "OnMatrixValue", **{"Step Data": path, "compare operator": compare, "value": level, **some}
    )


END_AT_500 = sequence("end", at("0.5 s"), (END, {"Reset type": "Reload"}))


def test_actions_of_one_trial_are_carried_out_in_it(files):
    done = dd.load_cedar_experiment(
        *files(
            sequence("second", both(trial(2), at("0.1 s")), (SET, value("boost", "strength", "9"))),
            sequence("peak", both(trial("2"), data("u.activation", ">", "0")), (END, {})),
            sequence("never", trial(7), (SET, value("boost", "strength", "1"))),
            END_AT_500,
            repetitions="3",
        )
    )
    assert done.report.faithful
    table = done.experiment.run()
    assert table["outcome"].values.tolist() == ["end ends", "peak ends", "end ends"]
    assert 100 < table["duration"].values[1] < 400


def test_both_conditions_hold_at_the_same_time(files):
    rising = both(both(data("u.activation", ">", "-4"), data("u.activation", "<", "8")), at("0.31 s"))
    strong = sequence("strong", condition("OnEachTrial"), (SET, value("boost", "strength", "9")))
    done = dd.load_cedar_experiment(*files(strong, sequence("rising", rising, (END, {})), END_AT_500))
    assert done.report.faithful
    assert done.experiment.run()["duration"].values.tolist() == [320, 320]  # steps of 20 ms


@pytest.mark.parametrize(
    ("compare", "level", "count", "holds"),
    [
        (">", 1.5, 4, True),
        (">", 1.5, 5, False),
        (">", 0.5, None, True),
        (">", 1, None, False),
        ("<", 2.5, 3, True),
        ("<", 2, 2, False),
        ("<", 4.5, None, True),
        ("=", 2, 2, True),
        ("=", 2, 3, False),
        ("=", 4, 1, True),
        ("=", 2, None, False),
    ],
)
def test_a_number_of_entries_of_data(compare, level, count, holds, files):
    counted = sequence("counted", data("vector.vector", compare, level, count), (END, {}))
    done = dd.load_cedar_experiment(*files(counted, END_AT_500))
    assert done.report.faithful
    outcome = done.experiment.run()["outcome"].values[0]
    assert outcome == ("counted" if holds else "end ends")


def test_values_at_the_start_last_for_the_next_trials_unless_the_file_is_reloaded(files):
    step = {"StepParameter": {"element path": "u", "parameter path": "global inhibition"}, "step value": "-1"}
    changes = (
        sequence("more", condition("OnEachTrial"), (MORE, step)),
        sequence("third", trial(3), (SET, value("u", "time scale", "0.2 s"))),
        sequence("boost", trial(2), (SET, value("boost", "active", "false"))),
        sequence("strength", condition("OnEachTrial"), (SET, value("boost", "strength", "3"))),
    )
    end = sequence("end", at("100 ms"), (END, {}))
    done = dd.load_cedar_experiment(*files(*changes, end, repetitions="3"))
    assert done.report.faithful
    levels = done.experiment.factors[0].levels
    assert [levels[k]["u.global_inhibition"] for k in "123"] == [1.01, 2.01, 3.01]
    assert [levels[k]["u.tau"] for k in "123"] == [100, 100, 200]
    assert [levels[k]["boost.amplitude"] for k in "123"] == [3, 0, 0]
    assert done.experiment.run()["outcome"].size == 3
    again = dd.load_cedar_experiment(*files(*changes, END_AT_500, repetitions="3")).experiment
    levels = again.factors[0].levels
    assert [levels[k]["u.global_inhibition"] for k in "123"] == [1.01, 1.01, 1.01]
    assert [levels[k]["boost.amplitude"] for k in "123"] == [3, 0, 3]


def test_a_value_that_lasts_for_the_next_trial_is_reported(files):
    later = sequence("later", at("0.1 s"), (SET, value("boost", "strength", "3")))
    end = sequence("end", at("0.5 s"), (END, {}))
    late = sequence("late", at("0.6 s"), (SET, value("boost", "strength", "4")))
    done = dd.load_cedar_experiment(*files(later, end, late))
    lines = {line.where: line for line in done.report.lines if line.what == "SetParameterValue"}
    assert lines["later"].verdict == "approximated" and "for the next trial" in lines["later"].why
    assert lines["late"].why == "never: every trial has ended by then"
    assert dd.load_cedar_experiment(*files(later, end, repetitions="1")).report.faithful


def test_stored_data_are_a_snapshot_and_lost_actions_have_a_reason(files):
    store = (f"{ACTION}.StoreSerializableData", {"filename": "C:\\\\data\\\\weights.data"})
    call = (f"{ACTION}.CallElementAction", {"connectable": "trace", "action": "reset memory"})
    done = dd.load_cedar_experiment(*files(sequence("store", at("0.2 s"), store, call), END_AT_500))
    snapshot = done.experiment.plan.actions[0]
    assert (snapshot.label, list(snapshot.of)) == ("weights.data", ["trace.output"])
    assert [line.why for line in done.report.losses] == [
        "deodar resets all elements of a trial together, by Reset"
    ]
    assert done.experiment.check() == []


@pytest.mark.parametrize(
    "when",
    [
        {},
        [],
        condition("And"),
        both(trial("x"), at("0.1 s")),
        both(at("1 parsec"), at("0.1 s")),
        data("nothing.there", ">", 1),
        data("u", ">", 1),
        data("u.activation", "~", 1),
        data({"a": ["u"]}, "=", "nan"),
        condition("OnTrialNumber", **{"on trial": "-3"}),
        condition("own.Condition"),
    ],
)
def test_conditions_without_a_meaning_are_reported(when, files):
    odd = sequence("odd", when, (SET, value("boost", "strength", "3")))
    done = dd.load_cedar_experiment(*files(odd, END_AT_500))
    assert [line.where for line in done.report.losses] == ["odd"]
    assert done.experiment.check() == []


@pytest.mark.parametrize(
    "action",
    [
        (SET, {}),
        (SET, value("boost", "strength", [])),
        (SET, value("boost", "active", "perhaps")),
        (SET, value("u", "lateral kernels[0].amplitude", "3")),
        (SET, value({}, None, "3")),
        (MORE, {"StepParameter": [], "step value": {}}),
        (f"{ACTION}.Own", []),
    ],
)
def test_actions_without_a_meaning_are_reported(action, files):
    done = dd.load_cedar_experiment(*files(sequence("odd", at("0.1 s"), action), END_AT_500))
    assert [line.where for line in done.report.losses] == ["odd"]
    assert done.experiment.check() == []


def test_changed_files_of_experiments_open_or_are_refused(files, tmp_path):
    step = {"StepParameter": {"element path": "u", "parameter path": "resting level"}, "step value": "0.5"}
    path, architecture = files(
        sequence(
            "trial", both(trial(2), data("vector.vector", "=", 2, 2)), (SET, value("u", "time scale", "9"))
        ),
        sequence("more", condition("OnEachTrial"), (MORE, step), (SET, value("boost", "strength", "1"))),
        sequence("store", at("0.1 s"), (f"{ACTION}.StoreSerializableData", {"filename": "a"})),
        END_AT_500,
    )
    text, rng, good = path.read_text(), random.Random(8), 0
    for k in range(300):
        path.write_bytes(hostile.mutations.changed(text, rng))
        try:
            done = dd.load_cedar_experiment(path, architecture)
        except DeodarError as error:
            assert error.problems and all(problem.what for problem in error.problems)
            continue
        good += 1
        assert json.dumps(done.report.data()) and (k % 10 or isinstance(done.experiment.check(), list))
    assert good > 100


def test_other_files_are_refused(files, tmp_path):
    _, architecture = files()
    with pytest.raises(DocumentError, match="is no experiment of cedar"):
        dd.load_cedar_experiment(architecture, architecture)
    with pytest.raises(DocumentError, match="there is no such file"):
        dd.load_cedar_experiment(tmp_path / "none.json", architecture)
