"""Every example runs, stays finite, and agrees with its notes."""

from __future__ import annotations

import itertools
import re
from pathlib import Path

import numpy as np
import pytest
import xarray

import deodar as dd
from deodar.analysis.peaks import peaks
from deodar.worlds.arena.arena import Arena
from deodar_papers.saliency.scenes import photographs
from deodar_robots.mujoco.mujoco import MuJoCo
from tests.docs.source import EXAMPLES, module

make = module(EXAMPLES / "make.py")
NAMES = [f.__name__ for f in make.EXAMPLES]


def run(name: str, record: list[str], trials: int | None = None) -> xarray.Dataset:
    """Run an example with the step of its document, for the duration of its notes."""
    model = dd.load(EXAMPLES / f"{name}.json")
    stated = re.search(r"(\d+) ms\.$", model.document.notes)
    assert stated, "the notes end with how long to run it"
    recording = dd.simulate(model, float(stated[1]), record=record, every=10, trials=trials)
    assert all(np.isfinite(v.values).all() for v in recording.data_vars.values())
    return recording


def places(u: xarray.DataArray, t: float, trial: int | None = None) -> list[float]:
    """Return the positions of the peaks of a one-dimensional field at a time."""
    now = u.sel(time=t) if trial is None else u.sel(time=t, trial=trial)
    return sorted(p.position[0] for p in peaks(now))


# ---------------------------------------------------------------------------------------------- the documents


def test_documents_are_those_that_the_script_writes(tmp_path: Path) -> None:
    make.main(tmp_path)
    made = {p.name: p.read_bytes() for p in tmp_path.iterdir()}
    kept = {p.name: p.read_bytes() for ending in ("json", "npz") for p in EXAMPLES.glob(f"*.{ending}")}
    assert kept == made, "the documents are not what examples/make.py makes: python tools/generate.py"


def test_a_document_has_no_problems_and_has_notes() -> None:
    models = {name: dd.load(EXAMPLES / f"{name}.json") for name in NAMES}
    assert models and not {n: m.check() for n, m in models.items() if m.check()}
    assert not [name for name, m in models.items() if len(m.document.notes) <= 100]


# ------------------------------------------------------------------------------------------------ their notes


def test_detection_forms_one_peak_that_ends_with_its_input() -> None:
    u = run("detection", ["u.activation"])["u.activation"]
    assert places(u, 390) == [] and len(places(u, 690)) == len(places(u, 990)) == 1
    assert places(u, 690) == pytest.approx([50], abs=1)
    assert places(u, 1300) == []


def test_selection_leaves_one_of_two_peaks() -> None:
    u = run("selection", ["u.activation"], trials=100)["u.activation"]
    peak_places = [places(u, 600, k) for k in range(100)]
    assert all(len(p) == 1 for p in peak_places)
    left = sum(p[0] < 50 for p in peak_places)
    assert 30 <= left <= 70, left


def test_working_memory_keeps_its_peak_without_input() -> None:
    record = run("working_memory", ["u.activation", "cue.output"])
    assert float(record["cue.output"].sel(time=310).max()) == 0
    assert places(record["u.activation"], 1500) == pytest.approx([35], abs=5)


def test_forgetting_erases_the_peak() -> None:
    u = run("forgetting", ["u.activation"])["u.activation"]
    assert len(places(u, 900)) == 1
    assert all(places(u, t) == [] for t in (1100, 1300, 1500))


def test_boost_creates_a_peak_at_the_stronger_preshape() -> None:
    u = run("boost", ["u.activation"])["u.activation"]
    assert places(u, 290) == [] and places(u, 1200) == []
    assert places(u, 890) == pytest.approx([65], abs=1)
    before = u.sel(time=290)
    assert before.sel(x=30) > before.sel(x=10) + 1, "the weaker preshape is there too"


def test_projection_forms_peaks_at_the_crossing_of_ridges() -> None:
    record = run("projection", [f"{name}.activation" for name in ("colour", "scene", "where")])
    for name, place in (("colour", (120,)), ("scene", (36, 120)), ("where", (36,))):
        u = record[f"{name}.activation"]
        assert not peaks(u.sel(time=290)), name
        present = peaks(u.sel(time=900))
        assert len(present) == 1 and present[0].position == pytest.approx(place, abs=2), (name, present)


def test_node_switches_on_and_off() -> None:
    u = run("node", ["u.activation"])["u.activation"]
    for t, value in ((190, -2), (690, 2), (1100, -2)):
        assert float(u.sel(time=t)) == pytest.approx(value, abs=0.2), t


def test_correlated_noise_creates_single_peaks_at_all_positions() -> None:
    u = run("correlated_noise", ["u.activation"], trials=100)["u.activation"]
    peak_places = [places(u, 400, k) for k in range(100)]
    with_peak = [p[0] for p in peak_places if p]
    assert max(map(len, peak_places)) == 1 and 30 <= len(with_peak) <= 70
    assert np.histogram(with_peak, bins=4, range=(0, 100))[0].min() >= 3, "all over the field"


def test_timed_stimuli_create_peaks_in_their_windows() -> None:
    u = run("timed_stimuli", ["u.activation"])["u.activation"]
    for t, expected in ((50, []), (250, [20]), (380, []), (550, [80]), (680, []), (850, [20]), (1150, [80])):
        assert places(u, t) == pytest.approx(expected, abs=1), t


def test_groups_become_active_one_after_the_other() -> None:
    names = ("search", "approach", "grasp", "lift")
    record = run("groups", [f"{name}.intention.activation" for name in names])
    on = np.array([record[f"{name}.intention.activation"].values > 0 for name in names])
    for k, t in enumerate((480, 1080, 1680, 2280)):
        assert on[:, t // 10].tolist() == [i == k for i in range(4)], t
    assert not on[:, 0].any() and not on[:, -1].any()
    model = dd.load(EXAMPLES / "groups.json")
    model.set("tempo", 33)
    assert {model.get(f"{name}.{part}.tau") for name in names for part in ("intention", "satisfied")} == {
        33.0
    }


def test_motor_attractor_turns_to_the_peak_and_stays_without_one() -> None:
    record = run("motor_attractor", ["target.activation", "turn.output"])
    turn = record["turn.output"]
    assert float(turn.sel(time=900)) == pytest.approx(150, abs=2)
    still = turn.sel(time=slice(1000, 1290)).values
    assert np.ptp(still) < 0.5 and places(record["target.activation"], 1200) == []
    values = turn.sel(time=slice(1300, 2000)).values
    assert values[-1] == pytest.approx(-120, abs=2)
    assert (np.abs(values) > 115).all(), "over 180 deg, never near 0"


def test_saliency_selects_the_cued_colour() -> None:
    model = dd.load(EXAMPLES / "saliency.json")
    model.set("cue.center", 5.0)
    coffee = next(s for s in photographs() if s.name == "coffee")
    record = ["perceptual.activation", "spatial.activation", "pan.output", "tilt.output"]
    end = dd.simulate(model, 3500, record=record, every=3500, world=coffee.picture).isel(time=-1)
    choices = peaks(end["spatial.activation"])
    assert len(choices) == 1 and len([p for p in peaks(end["perceptual.activation"]) if p.size > 600]) == 1
    assert (float(end["pan.output"]), float(end["tilt.output"])) == pytest.approx(choices[0].position, abs=2)


# ------------------------------------------------------------------------------------------------ the scripts


def test_choices_follow_the_stronger_input() -> None:
    shares = module(EXAMPLES / "choices.py").shares(100)
    assert 0.3 <= shares[0] <= 0.7 and shares[-1] > 0.9


def test_reaction_time_grows_with_distance_and_falls_with_a_preshape() -> None:
    example = module(EXAMPLES / "reaction_time.py")
    data = example.experiment(24).run()
    alone, expected = (example.reactions(data, preshape) for preshape in (0.0, 1.0))
    medians = [[t for t, _ in rows["time"]] for rows in (alone, expected)]
    assert medians[0][0] < 0.5 * medians[0][3] and all(
        soon < late for soon, late in zip(medians[1], medians[0], strict=True)
    )
    assert alone["time"][-1][1][0] > expected["time"][-1][1][1], "the bands are apart"
    assert alone["left"][-1][1][1] < expected["left"][-1][0]
    made = example.figure(data)
    assert [len(axes.lines) for axes in made.axes] == [2, 3], "one line a condition, and that of chance"


def test_the_symmetric_model_of_reaction_times_chooses_either_side_equally_often(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    example = module(EXAMPLES / "reaction_time.py")
    monkeypatch.setattr(example, "DISTANCES", (4, 8))
    data = example.experiment(400).run()
    alone = data.isel(trial=(data["preshape"] == 0.0).values)
    left, n = example.left_of_middle(alone["place"].values)
    low, high = dd.wilson(left, n)
    assert n == 800 and low < 0.5 < high, f"{left:g} of {n}"
    assert len(set(alone["place"].values.tolist())) > 790, "places are interpolated: hardly two are the same"
    assert example.left_of_middle(np.array([40.0, 50.0, 50.0, 60.0, np.nan])) == (2.0, 4)


def test_live_session_remembers_and_follows_an_injected_input() -> None:
    positions = module(EXAMPLES / "live_session.py").main()
    assert positions["remembered"] == positions["restored"] == pytest.approx([35], abs=1)
    assert positions["pulled along"] == pytest.approx([44], abs=1)


def test_own_function_drives_the_field_periodically() -> None:
    u = dd.simulate(module(EXAMPLES / "own_function.py").model(), 5000, record=["u.activation"], every=10)[
        "u.activation"
    ].values
    ups = int(((u[1:] > 0) & (u[:-1] <= 0)).sum())
    assert 4 <= ups <= 6


def test_no_example_is_without_a_test() -> None:
    names = [name for name in globals() if name.startswith("test_")]
    examples = {p.stem for p in EXAMPLES.iterdir() if p.suffix in (".json", ".py")} - {"make", "pictures"}
    assert not {e for e in examples if not any(name.startswith(f"test_{e}_") for name in names)}


def test_plan_spreads_from_the_goal_and_reaches_it() -> None:
    record = dd.simulate(
        dd.load(EXAMPLES / "plan.json"),
        1200,
        record=["left.motivation.activation", "left.strongest.output", "gone.activation"],
        every=5,
    )
    u, x = record["left.motivation.activation"], record["x"].values
    fronts = [x[u.sel(time=t).values > 0].max() for t in (30, 60, 90, 120)]
    assert all(15 < b - a < 28 for a, b in itertools.pairwise(fronts))
    assert float(record["left.strongest.output"].sel(time=slice(105, 200)).min()) > 0.5
    gone = record["gone.activation"]
    assert (
        abs(float(gone.sel(time=60))) < 3
        and abs(float(gone.sel(time=440)) + 60) < 7
        and abs(float(gone[-1]) - 50) < 8
    )


def test_spa_spreads_its_wave_from_the_goal() -> None:
    """In the first steps, in the arena of the notes, the wave spreads from the goal."""
    record = dd.simulate(
        dd.load(EXAMPLES / "spa.json"), 60, record=["north.motivation.activation"], every=20, world=Arena("z")
    )
    areas = [(u > 0).sum() for u in record["north.motivation.activation"].values]
    assert areas[0] == 0 < areas[1] < areas[2] < areas[3]


def test_color_search_learns_what_is_shown_and_looks_for_it_in_this_order() -> None:
    arena = Arena(
        "search",
        unit="mm",
        vehicle="khepera",
        physics=dd.ArenaPhysics(period=20, camera_every=4),
        noise=dd.ArenaNoise(hue_noise=6),
    )
    session = dd.Session(dd.load(EXAMPLES / "color_search.json"), world=arena)
    blocks = {box.name: box for box in arena.scene().boxes}

    def until(path: str, on: bool) -> None:
        end = session.time + 60_000
        while (float(session.read(path)) > 0) != on:
            session.run(20)
            assert session.time < end, f"{path} is not {'on' if on else 'off'}"

    session.run(500)
    assert float(session.read("item 1.node")) > 0
    for k, (name, hue) in enumerate((("magenta", 152), ("yellow", 28)), 1):
        session.place("shown", (127.3, 0), (45.4, 45.4), blocks[name].color)
        shown = session.time
        until(f"item {k}.node", False)
        assert session.time - shown < 500
        weights = session.read(f"item {k}.meaning.weights")
        assert weights.max() > 0.5 and abs(int(weights.argmax()) - hue) < 6
        session.remove("shown")
        until(f"item {k + 1}.node", True)
    session.set("mode", 1.0)
    until("item 1.node", True)
    for k, name in enumerate(("magenta", "yellow"), 1):
        until(f"item {k + 1}.node", True)
        x, y, _ = session.read("pose.output")
        assert np.hypot(x - blocks[name].center[0], y - blocks[name].center[1]) < 165


def test_pointing_points_at_the_object_that_the_switches_name() -> None:
    world = MuJoCo.example()
    session = dd.Session(dd.load(EXAMPLES / "pointing.json"), world=world)

    def highest(name: str) -> float:
        return float(np.max(session.read(f"{name}.activation")))

    session.run(500)
    assert highest("perceptual") < 0
    for level in (3.0, 0.0):
        for name in ("green", "left"):
            session.set(f"say {name}.amplitude", level)
        session.run(300)
    while highest("satisfaction") < 1:
        session.run(20)
        assert session.time < 10_000
    place = next(box.center for box in world.scene().boxes if box.name == "green left")
    assert np.hypot(*np.subtract(world.tool()[:2], place)) < 0.04
    session.run(2000)
    assert max(highest(n) for n in ("perceptual", "satisfaction", "green", "left")) < 0


def test_looking_turns_somewhere_and_learns_nothing_from_a_miss() -> None:
    """Its first gaze is random: a motor peak, a movement, and the end of both intentions."""
    eye = dd.Eye(screen=dd.EyeScreen(endless=False), first=(30, 85))
    model = dd.load(EXAMPLES / "looking.json")
    fields = ["visual intention", "motor intention"]
    record = [*(f"{name}.output" for name in fields), "pose", "satisfied.activation", "map.weights"]
    recording = dd.simulate(model, 1500, record=record, every=10, world=eye, seed=6)
    done = int((recording["satisfied.activation"] > 0).argmax("time"))
    assert done > 0
    for name in fields:
        highest = recording[f"{name}.output"].values.max(axis=(1, 2))
        assert highest[:done].max() > 0.9 and highest[done + 8] < 0.1
    pose = recording["pose.output"].values
    assert np.abs(pose[done] - pose[0]).max() > 20
    assert np.array_equal(recording["map.weights"].values[0], recording["map.weights"].values[done])


def test_behaviours_obey_their_constraints() -> None:
    names = ("find", "reach", "avoid", "look left", "look right")
    record = run(
        "behaviours",
        [f"{name}.intention.activation" for name in names] + ["reach.satisfaction.activation"],
        trials=20,
    )
    on = {name: record[f"{name}.intention.activation"] > 0 for name in names}

    def during(name: str, start: float, stop: float) -> np.ndarray:
        return on[name].sel(time=slice(start, stop)).values

    assert during("find", 200, 500).all() and not during("find", 560, 2400).any()
    assert not during("reach", 0, 500).any() and during("reach", 600, 900).all(), (
        "the precondition holds it back"
    )
    assert not during("reach", 1000, 1200).any() and during("reach", 1350, 1600).all(), (
        "it continues after the interruption"
    )
    assert (
        not during("reach", 1700, 2400).any()
        and (record["reach.satisfaction.activation"].sel(time=2000).values > 0).all()
    )
    assert (
        not (on["look left"] & on["look right"]).any()
        and (during("look left", 200, 690) | during("look right", 200, 690)).all()
    )
    first = on["look left"].sel(time=600)
    assert 3 <= int(first.sum()) <= 17, "noise decides"
    assert (on["look right"].sel(time=1000) == first).all(), "the other follows"


def test_serial_order_produces_the_sequence() -> None:
    record = run("serial_order", ["action.activation", *(f"item {k}.node.activation" for k in range(1, 5))])
    steps = [
        np.argmax(record[f"item {k}.node.activation"].sel(time=slice(5300, None)).values > 0) * 10 + 5300
        for k in range(1, 5)
    ]
    assert steps[0] > 5300 and all(a < b for a, b in itertools.pairwise(steps))
    assert [places(record["action.activation"], t + 20.0)[0] for t in steps] == pytest.approx(
        [30, 6, 30, 54], abs=3
    )
    assert not any(places(record["action.activation"], t) for t in (5300, 11200))


def test_binding_selects_the_cued_object() -> None:
    record = run("binding", [f"{name}.activation" for name in ("bound", "space", "feature")])
    for t, bound in (
        (190, None),
        (590, (50, 120)),
        (790, (50, 120)),
        (950, None),
        (1390, (80, 240)),
        (1800, None),
    ):
        for name, place in (("space", 0), ("feature", 1)):
            expected = [] if bound is None else [bound[place]]
            assert places(record[f"{name}.activation"], t) == pytest.approx(expected, abs=3), (name, t)
        assert len(peaks(record["bound.activation"].sel(time=t))) == (0 if bound is None else 1)


def test_remapping_gives_positions_relative_to_the_body() -> None:
    record = run(
        "remapping",
        [f"{form}.{name}.activation" for form in ("diagonal", "steered") for name in ("retina", "body")],
    )
    for form in ("diagonal", "steered"):
        retina, body = (record[f"{form}.{name}.activation"] for name in ("retina", "body"))
        for t, there in ((390, [12]), (790, [-3]), (990, [22]), (1400, [-15, 22])):
            assert places(retina, t) == pytest.approx(there, abs=0.5)
            assert places(body, t) == pytest.approx([12] if t < 1000 else [-25, 12], abs=0.5), (form, t)


def test_change_detection_reports_the_changed_item() -> None:
    record = run(
        "change_detection",
        ["contrast.activation", "memory.activation", "different.activation", "same.activation"],
    )
    assert (
        places(record["memory.activation"], 1690) == pytest.approx([40, 130, 250], abs=3)
        and places(record["contrast.activation"], 1690) == []
    )
    assert places(record["contrast.activation"], 1760) == pytest.approx([180], abs=3)
    assert float(record["different.activation"].sel(time=2290)) > 0 > float(record["same.activation"].max())
    model = dd.load(EXAMPLES / "change_detection.json")
    model.set("test 2.center", 130)
    end = dd.simulate(model, 2290, record=["different.activation", "same.activation"], every=2290).isel(
        time=-1
    )
    assert float(end["same.activation"]) > 0 > float(end["different.activation"])


def test_sequences_are_produced_in_every_seed(capsys: pytest.CaptureFixture[str]) -> None:
    successes = module(EXAMPLES / "sequences.py").main(2, range(10, 11))
    assert successes == {10: (2, 20, 20)} and "2 of 2 seeds" in capsys.readouterr().out


def test_learned_kernel_finds_the_free_samples() -> None:
    expected, weights, errors = module(EXAMPLES / "learned_kernel.py").learn(samples=101, most=400)
    assert errors[-1] < 1e-3 * errors[0]
    assert np.abs(weights - expected).max() < 0.1 * np.abs(expected).max()


def test_trained_vision_puts_the_peak_at_the_cross() -> None:
    _, before, after = module(EXAMPLES / "trained_vision.py").train(count=48, most=200)
    assert before < 0.4 and after > 0.8


def test_fitted_time_course_finds_the_parameters() -> None:
    script = module(EXAMPLES / "fitted_time_course.py")
    fitted, _ = script.fit(script.measured(trials=20))
    for path, value in script.TRUE.items():
        assert fitted[path] == pytest.approx(value, rel=0.03)
