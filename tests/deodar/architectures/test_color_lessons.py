"""Lessons of a colour search: what the weights keep, lose, and learn in part."""

from __future__ import annotations

import numpy as np

import deodar as dd
from deodar.experiments.trial import Trial
from tests.deodar.experiments.calls import run_alone

RED = (0.9, 0.0, 0.0)
WEIGHTS, NODE = "item 1.meaning.weights", "item 1.node.activation"


def taught(windows: dict[str, tuple[float, float]], limit: float, *changes: dd.Set) -> Trial:
    """Return a trial in which a red block is shown at the side, in the middle, or both."""
    arena = dd.Arena(
        {"unit": "mm", "arena": {"x": [-300, 300], "y": [-300, 300]}},
        start=(0, 0, 0),
        unit="mm",
        vehicle="khepera",
        physics=dd.ArenaPhysics(period=20, camera_every=4),
        noise=dd.ArenaNoise(hue_noise=6),
    )
    place = {"side": (125.0, 60.0), "middle": (100.0, 0.0)}
    for name, window in windows.items():
        arena.place(name, place[name], (50, 50), RED, windows=window, height=70)
    model = dd.architectures.color_search(2)
    return run_alone(model, limit, arena, watch=[WEIGHTS, NODE], actions=list(changes), every=20.0)


def first(trial: Trial, true: np.ndarray, after: float) -> float:
    """Return the first time after another one at which something is true, ms."""
    return float(trial.times[(trial.times > after) & true][0])


def test_a_block_that_appears_at_once_in_the_middle_is_learned_in_part() -> None:
    trial = taught({"middle": (1000.0, 3000.0)}, 3000.0)
    strongest = trial.values[WEIGHTS].max(axis=1)
    assert 0.55 < strongest[-1] < 0.9
    # the node is switched off soon, and the weights stay
    assert first(trial, trial.values[NODE] < 0, 1000.0) < 1500.0
    assert strongest[trial.times > 2000.0].min() == strongest[-1]


def test_a_block_that_comes_in_from_the_side_is_learned_completely() -> None:
    trial = taught({"side": (800.0, 1200.0), "middle": (1200.0, 2000.0)}, 2200.0)
    assert trial.values[WEIGHTS][-1].max() > 0.95


def test_a_node_forgets_a_colour_that_is_taken_away_before_it_was_in_the_middle() -> None:
    trial = taught({"side": (800.0, 1200.0)}, 2000.0)
    strongest, at = trial.values[WEIGHTS].max(axis=1), trial.times
    assert strongest[at <= 1200.0][-1] > 0.9 and (trial.values[NODE][at > 600.0] > 0).all()
    assert strongest[at > 1400.0].max() < 0.05


def test_a_mode_set_back_to_teaching_forgets_the_colour_of_the_first_node() -> None:
    windows = {"side": (800.0, 1200.0), "middle": (1200.0, 2000.0)}
    trial = taught(windows, 4200.0, dd.Set(2400.0, "mode", 1.0), dd.Set(3200.0, "mode", 0.0))
    strongest, at = trial.values[WEIGHTS].max(axis=1), trial.times
    # production changes no weights
    assert strongest[(at > 2300.0) & (at < 3200.0)].min() > 0.9
    on = first(trial, trial.values[NODE] > 0, 3300.0)
    assert first(trial, strongest < 0.05, on) < on + 200.0


def test_one_of_two_colours_in_view_is_selected_and_learned() -> None:
    arena = dd.Arena(
        {"unit": "mm", "arena": {"x": [-300, 300], "y": [-300, 300]}},
        start=(0, 0, 0),
        unit="mm",
        vehicle="khepera",
        physics=dd.ArenaPhysics(period=20, camera_every=4),
        noise=dd.ArenaNoise(hue_noise=6),
    )
    for name, y, color in (("red", 60.0, RED), ("blue", -60.0, (0.0, 0.0, 0.9))):
        arena.place(name, (150.0, y), (50, 50), color, windows=(1000.0, 9000.0), height=70)
    trial = run_alone(dd.architectures.color_search(2), 1600.0, arena, watch=[WEIGHTS], every=20.0)
    learned = trial.values[WEIGHTS][-1]
    red, blue = learned[np.r_[0:10, 170:180]].max(), learned[110:130].max()
    assert max(red, blue) > 0.9 and min(red, blue) < 0.05
