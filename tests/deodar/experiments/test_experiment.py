"""Experiments as data: files, designs, batches and single trials with the same rows, and errors before the
first trial.
"""

from __future__ import annotations

import dataclasses as dc
import hashlib
import json
import warnings

import numpy as np
import pytest

import deodar as dd
from deodar.errors import DocumentError, OutputExists, ParameterError, RunWarning, UnknownName
from deodar.experiments import experiment as module
from deodar.experiments import row_line
from deodar.experiments.actions import End, Move, Place, Push, Ramp, Record, Remove, Reset, Set, Snapshot
from deodar.experiments.events import All, AnyOf, Appears, Crosses, Leaves, Reached, Vanishes, Within
from deodar.experiments.experiment import Experiment
from deodar.experiments.experiment_migrations import VERSION
from deodar.experiments.factor import Factor, assign
from deodar.experiments.measures import Measure
from deodar.experiments.results import ROWS, load_results
from deodar.model.document import VERSION as DOCUMENT_VERSION
from deodar.recording import files
from tests.deodar.experiments.calls import changed, run_alone
from tests.deodar.experiments.robots import decider, room, straight


def line():
    """Return a field in which two inputs, from 20 ms on, create one peak."""
    x = dd.Axis("x", 0, 100, 51)
    model = dd.Model("choice")
    u = model.add(
        dd.Field(
            "u", [x], tau=10, resting_level=-5, kernel=[dd.Gaussian(1.2, 5)], global_inhibition=0.6, noise=1.0
        )
    )
    for name, center in (("left", 30), ("right", 70)):
        (
            model.add(dd.GaussianStimulus(name, [x], center=center, sigma=5, amplitude=6, windows=[(20, 80)]))
            >> u
        )
    return model


def choice(**changes):
    """Return an experiment with this field."""
    parts = {
        "events": [
            Appears("detected", "u", threshold=1.0, ends=False),
            Appears("left up", "u", near=30, radius=8, ends=False),
            Vanishes("gone", "u"),
        ],
        "factors": [
            Factor("strength", [6.0, 7.0], "left.amplitude"),
            Factor("place", {"a": {"right.center": 70}, "b": {"right.center": 60}}),
        ],
        "measures": [
            Measure("where", "u.activation", "place", "detected"),
            Measure("end", "u.activation", "mean"),
        ],
    }
    plain = Experiment("choice", line(), dd.TrialPlan(150), 4, precision="float64")
    return changed(plain, **(parts | changes))


def test_a_saved_experiment_is_equal_when_loaded(tmp_path):
    full = choice(
        actions=[
            Push(10, "u", 1.0, 5),
            Set(50, "u.resting_level", -6, when="detected"),
            Snapshot(30, "middle", ["u.activation"]),
            Reset(70, keep_learned=True),
        ],
        watch=["u.activation"],
        every=5,
        seed=3,
        design="shuffled",
    )
    full.save(tmp_path / "e.json")
    loaded = Experiment.load(tmp_path / "e.json")
    assert dc.replace(loaded, model=full.model) == full
    assert loaded.model == str(tmp_path / "e.model.json") and not loaded.check()
    with pytest.raises(OutputExists):
        full.save(tmp_path / "e.json")


def test_the_schema_contains_every_kind():
    schema = Experiment.schema()
    kinds = [
        part["properties"]["kind"]["const"] for part in schema["properties"]["actions"]["items"]["oneOf"]
    ]
    assert {"Set", "Ramp", "Push", "Place", "Move", "Remove", "Record", "Snapshot", "Reset", "End"} == set(
        kinds
    )
    assert (
        schema["properties"]["conditions"]["additionalProperties"]["oneOf"][0]["properties"]["level"]["type"]
        == "number"
    )
    json.dumps(schema)


def test_a_batch_gives_the_rows_of_single_trials():
    experiment = choice()
    together = experiment.run()
    assert experiment.setup().batched and len(experiment.setup().pieces()) == 1
    # the action changes nothing, but prevents a batch
    alone = changed(experiment, actions=[Set(149, "u.quadrature", "point")])
    assert not alone.setup().batched
    single = alone.run()
    for name in ("outcome", "strength", "place"):
        assert together[name].values.tolist() == single[name].values.tolist()
    for name in ("detected", "left up", "gone", "where", "end", "duration"):
        np.testing.assert_allclose(together[name].values, single[name].values, atol=1e-9)
    assert len(set(together["detected"].values.tolist())) > 4
    assert all(
        27 < where < 33 or 55 < where < 65
        for where in together["where"].sel(trial=together["place"] == "b").values.tolist()
    )


def test_factors_that_cannot_be_swept_have_separate_batches():
    experiment = choice(
        factors=[Factor("width", [4.0, 6.0], "u.kernel.0.sigma"), Factor("noise", [0.0, 1.0], "u.noise")]
    )
    assert sorted(map(len, experiment.setup().pieces())) == [8, 8] and experiment.setup().swept == ["u.noise"]
    assert experiment.run().sizes["trial"] == 16


def test_factors_are_assigned_to_trials_by_the_design():
    factors = [Factor("a", [1, 2], "x"), Factor("b", [1, 2, 3], "y")]
    crossed = assign(factors, "crossed", 2, 0)
    assert crossed[:3] == [(0, 0), (0, 0), (0, 1)] and len(crossed) == 12
    shuffled = assign(factors, "shuffled", 2, 0)
    assert (
        sorted(shuffled)
        == crossed
        != shuffled
        == assign(factors, "shuffled", 2, 0)
        != assign(factors, "shuffled", 2, 1)
    )
    drawn = assign(factors, "random", 300, 5)
    assert len(drawn) == 300 and min(drawn.count(cell) for cell in set(crossed)) > 25


def test_combined_conditions_are_detected_and_the_missing_one_is_named():
    appearances = [
        Appears("left up", "u", near=30, radius=8, ends=False),
        Appears("right up", "u", near=95, radius=4, ends=False),
    ]
    conditions = [
        All("both", ["left up", "right up"]),
        AnyOf("either", ["left up", "right up"], ends=False),
        *appearances,
        Reached("late", 40, ends=False),
    ]
    table = choice(events=conditions, factors=[], measures=[]).run()
    assert set(table["outcome"].values) == {"time"} and set(table["awaited"].values) == {"both"}
    np.testing.assert_array_equal(table["either"], np.fmin(table["left up"], table["right up"]))
    assert (table["late"] == 40).all() and np.isnan(table["both"]).all()


def test_a_stopped_experiment_resumes_with_the_same_table(tmp_path, monkeypatch):
    monkeypatch.setattr("deodar.experiments.setup.MOST_COPIES", 5)
    experiment = choice()
    whole = experiment.run(tmp_path / "whole")
    assert len(experiment.setup().pieces()) == 4

    def stop(standing):
        if standing >= 8:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        experiment.run(tmp_path / "part", on=dd.Resources(progress=stop))
    file = tmp_path / "part" / ROWS
    file.write_bytes(file.read_bytes()[:-40])  # as if a kill had truncated the last line
    assert 4 <= load_results(tmp_path / "part").sizes["trial"] < 16
    assert experiment.run(tmp_path / "part").identical(whole)
    for name in ("trials.csv", ROWS):
        assert sorted((tmp_path / "part" / name).read_text().splitlines()) == sorted(
            (tmp_path / "whole" / name).read_text().splitlines()
        )
    assert load_results(tmp_path / "whole").identical(whole) and files.load_record(
        tmp_path / "whole" / "trials.nc"
    ).identical(whole)
    with pytest.raises(OutputExists, match="another experiment: trials differ"):
        dc.replace(experiment, trials=5).run(tmp_path / "whole")
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "thesis.txt").write_text("all of it")
    with pytest.raises(OutputExists, match="not the folder of an experiment"):
        experiment.run(tmp_path / "mine")


def test_a_stopped_experiment_whose_model_is_of_an_older_version_is_resumed(tmp_path):
    experiment = choice(trials=1)
    whole = experiment.run(tmp_path / "out")
    model, rows = tmp_path / "out" / "model.json", tmp_path / "out" / ROWS
    old = model.read_text().replace(f'"deodar": {DOCUMENT_VERSION}', '"deodar": 2')
    first, *others = rows.read_bytes().splitlines(keepends=True)
    header = row_line.read(first, True)
    header["about"]["model"] = hashlib.sha256(old.encode()).hexdigest()
    model.write_text(old)
    rows.write_bytes(b"".join([row_line.write(header, True), *others[:-1]]))
    assert experiment.run(tmp_path / "out")["outcome"].identical(whole["outcome"])
    model.write_text(old.replace('"beta": 4.0', '"beta": 5.0'))
    with pytest.raises(OutputExists, match="another experiment: model differ"):
        experiment.run(tmp_path / "out")


def test_the_path_of_a_field_alone_means_its_activation():
    parts = {
        "events": [Crosses("up", "u", ends=False)],
        "measures": [Measure("end", "u")],
        "actions": [Snapshot(10, "then", ["u"])],
    }
    short, full = (choice(watch=[path], factors=[], trials=1, **parts) for path in ("u", "u.activation"))
    assert [
        v.place(short.model.document)[1] for v in (short.plan.events[0].views[0], short.plan.measures[0].view)
    ] == ["activation"] * 2
    assert full.setup().rows([0]) == short.setup().rows([0])


def test_records_of_a_field_alone_hold_its_activation(tmp_path):
    choice(actions=[Snapshot(10, "then", ["u"])], watch=["u"], factors=[], measures=[], trials=1).run(
        tmp_path / "out"
    )
    for name in ("000000.nc", "000000-then.nc"):
        assert list(files.load_record(tmp_path / "out" / "records" / name).data_vars) == ["u.activation"]


def version_1(folder, experiment):
    """Save an experiment, as version 1 wrote it: a path without a port meant the output."""
    experiment.save(folder / "e.json")
    document = json.loads((folder / "e.json").read_text()) | {"experiment": 1, "record": ["u"]}
    document["measures"] = {
        "end": {"of": "u"},
        "pushed": {"of": "left"},
        "high": {"of": "u.activation"},
        "where": {"of": "pose"},
    }
    document["conditions"] = {"up": {"kind": "Crosses", "of": "u"}, "both": {"kind": "All", "of": ["up"]}}
    document["actions"] = [{"kind": "Snapshot", "at": 3, "label": "then", "of": ["u", "u.input"]}]
    (folder / "e.json").write_text(json.dumps(document))
    return folder / "e.json"


def test_a_file_of_version_1_means_the_output_by_the_path_of_a_field_alone(tmp_path):
    loaded = Experiment.load(version_1(tmp_path, choice()))
    assert loaded.plan.watch == ("u.output",) and [m.of for m in loaded.plan.measures] == [
        "u.output",
        "left",
        "u.activation",
        "pose",
    ]
    assert loaded.plan.events[0].of == "u.output" and loaded.plan.events[1].of == ("up",)
    assert loaded.plan.actions[0].of == ("u.output", "u.input")


@pytest.mark.parametrize("version", [1, 2])
def test_a_file_of_an_older_version_calls_the_object_of_an_action_thing(tmp_path, version):
    actions = [Place(2, "box", (50, 20), (4, 30)), Move(3, "box", (60, 20)), Remove(4, "box")]
    choice(actions=actions, world="arena:blocks").save(tmp_path / "e.json")
    document = json.loads((tmp_path / "e.json").read_text())
    assert (
        document["experiment"] == VERSION
        and [action["object"] for action in document["actions"]] == ["box"] * 3
    )
    for action in document["actions"]:
        action["thing"] = action.pop("object")
    (tmp_path / "e.json").write_text(json.dumps(document | {"experiment": version}))
    assert Experiment.load(tmp_path / "e.json").plan.actions == tuple(actions)
    # also without the model, which converts the paths of version 1
    assert Experiment.from_data(
        document | {"experiment": version, "model": "missing.json"}
    ).plan.actions == tuple(actions)
    (tmp_path / "e.json").write_text(json.dumps(document))
    with pytest.raises(DocumentError, match=r"actions\.0\.thing: Place has no such parameter"):
        Experiment.load(tmp_path / "e.json")


def test_a_stopped_experiment_of_version_1_is_resumed(tmp_path):
    new = choice(trials=1, measures=[Measure("end", "u.output")])
    whole = new.run(tmp_path / "out")
    first, *rows = (tmp_path / "out" / ROWS).read_bytes().splitlines(keepends=True)
    header = row_line.read(first, True)
    header["about"] |= {"experiment": 1, "measures": {"end": {"of": "u"}}}
    (tmp_path / "out" / ROWS).write_bytes(b"".join([row_line.write(header, True), *rows[:-1]]))
    assert new.run(tmp_path / "out").drop_attrs().identical(whole.drop_attrs())
    with pytest.raises(OutputExists, match="another experiment: measures differ"):
        choice(trials=1, measures=[Measure("end", "u")]).run(tmp_path / "out")


def test_actions_switch_records_on_and_off_and_store_snapshots(tmp_path):
    actions = [
        Record(30),
        Record(10, on=False, when="detected"),
        Snapshot(0, "then", ["u.activation"], when="detected"),
    ]
    table = choice(actions=actions, watch=["u.activation"], every=5, factors=[], trials=1).run(
        tmp_path / "out"
    )
    assert table.sizes["trial"] == 1
    record, then = (
        files.load_record(tmp_path / "out" / "records" / name) for name in ("000000.nc", "000000-then.nc")
    )
    at = float(table["detected"][0])
    assert record["time"].values.tolist() == list(np.arange(35, at + 11, 5)) and then[
        "time"
    ].values.tolist() == [at]
    np.testing.assert_array_equal(then["u.activation"][0], record["u.activation"].sel(time=at))


def test_push_ramp_and_reset_change_the_run():
    model = dd.Model("node")
    model.add(dd.Field("u", [], tau=10, resting_level=-1))
    still = {"watch": ["u.activation"], "precision": "float64"}
    pushed = run_alone(model, 60, actions=[Push(10, "u", 3.0, 20)], **still).values["u.activation"]
    assert (
        pushed[10] == -1
        and pushed[30] == pushed.max() == pytest.approx(-1 + 3 * (1 - 0.9**20))
        and pushed[31] < pushed[30]
    )
    up = Crosses("up", "u.activation", 0.5, ends=False)
    after = run_alone(
        model, 60, events=[up], actions=[Push(10, "u", 3.0, 20), Push(4, "u", -9.0, 5, when="up")], **still
    )
    moment = int(after.events["up"])
    below = after.values["u.activation"]
    np.testing.assert_array_equal(below[: moment + 5], pushed[: moment + 5])
    assert below[moment + 9] == pytest.approx(pushed[moment + 9] - 9 * (1 - 0.9**5))
    ramped = run_alone(
        model,
        60,
        actions=[Ramp(10, "u.resting_level", 3.0, 20, start=-1.0), Reset(50), End(55, "enough")],
        **still,
    )
    u, h = [-1.0], [-1.0 + 4.0 * min(max(t - 10, 0), 20) / 20 for t in range(60)]
    for t in range(50):
        u.append(u[-1] + (h[t] - u[-1]) / 10)
    np.testing.assert_allclose(ramped.values["u.activation"][:50], u[:50], atol=1e-12)
    assert (
        ramped.values["u.activation"][51] == pytest.approx(-1 + 4 / 10)
        and ramped.outcome == "enough"
        and ramped.duration == 55
    )


def test_objects_of_a_world_are_moved_after_an_event():
    moved = Experiment(
        "robot",
        straight(),
        dd.TrialPlan(
            300,
            events=[Crosses("far", "pose", 60, ends=False), Crosses("touched", "touching", 0.5)],
            actions=[Move(5, "far", (88, 20), when="far")],
        ),
        world=room(),
    )
    table = moved.run()
    assert not moved.setup().batched and table["outcome"].values.tolist() == ["touched"]
    assert float(table["touched"][0]) < float(changed(moved, actions=[]).run()["touched"][0])


def test_workers_give_the_same_table(tmp_path, monkeypatch):
    experiment = Experiment("d", decider(), dd.TrialPlan(400, events=[Crosses("decided", "u.activation")]), 6)
    table = experiment.run()
    assert (
        experiment.run(tmp_path / "out", on=dd.Resources(workers=1))
        .drop_attrs()
        .identical(table.drop_attrs())
    )


def test_very_many_steps_in_total_issue_a_warning(monkeypatch):
    experiment = Experiment("d", decider(), dd.TrialPlan(50), 4)
    monkeypatch.setattr(module, "LONG_STEPS", 200)
    with pytest.warns(
        RunWarning,
        match=r"200 steps in total \(4 trials of at most 50 steps of dt = 1\): a smaller number may be meant",
    ) as warned:
        experiment.run()
    assert [t.filename for t in warned] == [__file__]
    monkeypatch.setattr(module, "LONG_STEPS", 201)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        experiment.run()


@pytest.mark.parametrize(
    ("changes", "where", "problem"),
    [
        ({"events": [Appears("a", "v")]}, "conditions.a", "nothing is called 'v'"),
        ({"events": [Appears("a", "u", near=300, radius=2)]}, "conditions.a", "no sample lies within 2"),
        ({"events": [All("a", ["b"])]}, "a", "no event 'b'"),
        ({"events": [All(n, [o]) for n, o in ("ab", "bc", "cb")]}, "b:", "depends on itself"),
        ({"events": [Reached("a", 500)]}, "conditions.a", "can never hold"),
        ({"measures": [Measure("m", "u.activation", when="nothing")]}, "m", "no event 'nothing'"),
        ({"actions": [Set(5, "u.tua", 3)]}, "actions.0", "has no parameter 'tua'"),
        ({"actions": [Set(5, "u.tau", 3, when="found")]}, "actions.0.when", "no condition 'found'"),
        ({"actions": [Set(500, "u.tau", 3)]}, "actions.0", "is never done"),
        ({"actions": [Move(5, "box", (1, 2))]}, "actions.0", "the action Move needs a world"),
        ({"actions": [Record(5)]}, "actions.0", "nothing is recorded"),
        ({"factors": [Factor("f", [1.0], "left.amplitud")]}, "factors.f", "has no parameter 'amplitud'"),
        ({"factors": [Factor("f", [-1.0], "u.tau")]}, "factors.f", "lower bound"),
        ({"factors": [Factor(n, [5.0], "u.tau") for n in "fg"]}, "factors.g", "which the factor f sets too"),
        ({"watch": ["w.output"]}, "record", "nothing is called 'w.output'"),
        ({"world": "arena:nowhere.json"}, "", "nowhere.json"),
        ({"every": 0.5}, "every", "not a multiple"),
        ({"world": "arena:blocks", "events": [Within("a", 7.0)]}, "conditions.a", "so it always holds"),
        ({"world": "arena:blocks", "events": [Leaves("a", 7.0)]}, "conditions.a", "so it never holds"),
    ],
)  # fmt: skip
def test_invalid_experiments_are_refused_before_any_trial_runs(tmp_path, changes, where, problem):
    experiment = choice(**({"events": [], "factors": [], "measures": []} | changes))
    with pytest.raises(dd.errors.DeodarError) as refused:
        experiment.run(tmp_path / "out")
    assert problem in str(refused.value) and where in str(refused.value)
    assert not (tmp_path / "out").exists() and experiment.check()


def test_all_problems_of_a_file_are_reported_at_once(tmp_path):
    file = tmp_path / "e.json"
    document = {
        "experiment": 1,
        "name": "e",
        "model": "m.json",
        "limit": 5,
        "conditions": {"a": {"kind": "Apears", "field": "u"}},
    }
    document |= {
        "actions": [{"kind": "Set", "at": 3, "path": "u.tau"}],
        "factors": {"f": {"levels": []}},
        "measures": {"m": {"off": "u"}},
    }
    file.write_text(json.dumps(document))
    with pytest.raises(DocumentError) as refused:
        Experiment.load(file)
    text = str(refused.value)
    assert (
        "Did you mean 'Appears'" in text
        and "a Set needs 'value'" in text
        and "holds no levels" in text
        and "Did you mean 'of'" in text
    )
    file.write_text(json.dumps(document | {"experiment": VERSION + 1}))
    with pytest.raises(DocumentError, match="of version"):
        Experiment.load(file)
    file.write_text("{}")
    with pytest.raises(DocumentError, match="is not an experiment"):
        Experiment.load(file)
    file.write_text(json.dumps({"experiment": 1, "name": "e", "model": "m.json"}))
    with pytest.raises(DocumentError, match="an Experiment needs 'limit'"):
        Experiment.load(file)


def test_what_belongs_to_the_plan_is_refused_with_its_place():
    for former, place in (("conditions", "events"), ("record", "watch"), ("limit", "limit")):
        with pytest.raises(UnknownName, match=rf"no parameter '{former}'.*dd\.TrialPlan\(.*{place}"):
            Experiment("e", "m.json", dd.TrialPlan(1), **{former: 5})
    with pytest.raises(ParameterError, match=r"plan: needs a TrialPlan, not 400"):
        Experiment("e", "m.json", 400)


def test_problems_of_the_plan_of_a_file_have_its_keys():
    document = {
        "experiment": 3,
        "name": "e",
        "model": "m.json",
        "limit": -1,
        "record": 5,
        "dt": 0,
        "trials": 0,
    }
    with pytest.raises(DocumentError) as refused:
        Experiment.from_data(document | {"conditons": {}})
    assert [p.where for p in refused.value.problems] == ["conditons", "limit", "record", "trials"]
    assert "Did you mean 'conditions'" in str(refused.value)
    with pytest.raises(DocumentError, match=r"dt: is 0.0; expected a number above 0"):
        Experiment.from_data(document | {"limit": 1, "record": ["u"], "trials": 1})


def test_duplicate_names_of_columns_are_refused():
    with pytest.raises(ParameterError, match="'outcome' is a column of every table"):
        choice(events=[Appears("outcome", "u")], measures=[])
    with pytest.raises(ParameterError, match="'a' is the name of two columns"):
        choice(events=[Appears("a", "u")], measures=[Measure("a", "u")])


def test_a_whole_number_of_an_open_parameter_is_written_in_one_way():
    def written(*levels):
        actions, factors = [Set(1, "u.tau", levels[0])], [Factor("f", levels, "u.tau")]
        return json.dumps(
            Experiment("e", "m.json", dd.TrialPlan(1, actions=actions), factors=factors).to_data()
        )

    assert written(1.0, 2.5) == written(1, 2.5)
    assert '"levels": [1, 2.5]' in written(1.0, 2.5) and '"value": 1}' in written(1.0, 2.5)


@pytest.mark.parametrize(
    "changes",
    [
        {"trials": 10**12},
        {"factors": [Factor(f"f{k}", [0.0, 1.0], "left.amplitude") for k in range(30)]},
        {"trials": 10**8, "design": "random"},
    ],
)
def test_more_trials_than_are_run_are_refused_before_they_are_listed(changes):
    with pytest.raises(ParameterError, match=r"gives [\d,]+ trials; at most 10,000,000 are run"):
        choice(**changes)


@pytest.mark.parametrize("name", ["watch", "events", "measures", "actions"])
def test_a_plan_with_more_entries_than_are_checked_is_refused(name):
    entry = {
        "watch": "u.activation",
        "events": dd.Appears("seen", "u"),
        "measures": dd.Measure("m", "u.activation"),
        "actions": dd.Reset(5.0),
    }[name]
    with pytest.raises(ParameterError, match=f"{name}: has 2,001 entries, more than 2,000"):
        dd.TrialPlan(60.0, **{name: [entry] * 2001})


def test_values_of_a_cell_are_compared_once_for_all_its_trials(monkeypatch):
    trials = []
    setup = choice(trials=1000).setup()
    changes = type(setup).changes
    monkeypatch.setattr(type(setup), "changes", lambda self, k: trials.append(k) or changes(self, k))
    assert sum(map(len, setup.pieces())) == 4000 and len(trials) <= 8
