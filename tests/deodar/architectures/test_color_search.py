"""A vehicle learns a colour that it is shown, and then looks for a block of that colour."""

from __future__ import annotations

import numpy as np
import pytest

import deodar as dd
from deodar.architectures.color_search import color_search
from deodar.errors import ParameterError
from tests.deodar.experiments.calls import run_alone

RED, GREEN = (0.9, 0.0, 0.0), (0.0, 0.9, 0.0)
PRODUCED = 2400.0
"""Time at which the mode changes, ms."""


def arena() -> dd.Arena:
    """A green block behind the vehicle, a red one ahead of it; both appear after the lesson."""
    world = dd.Arena(
        {"unit": "mm", "arena": {"x": [-300, 300], "y": [-300, 300]}},
        (0, 0, 0),
        unit="mm",
        vehicle="khepera",
        physics=dd.ArenaPhysics(period=20, camera_every=4),
        noise=dd.ArenaNoise(hue_noise=6.0),
    )
    for name, center, color, begins, ends in (
        ("shown aside", (125, 60), RED, 800, 1200),
        ("shown", (100, 0), RED, 1200, 2000),
        ("red", (230, 60), RED, PRODUCED, 1e7),
        ("green", (-200, 0), GREEN, PRODUCED, 1e7),
    ):
        world.place(name, center, (50, 50), color, (begins, ends), height=70)
    return world


@pytest.fixture(scope="module")
def trial() -> dd.Trial:
    model = color_search(2)
    watch = [
        "item 1.node.activation",
        "item 2.node.activation",
        "action.activation",
        "satisfaction.activation",
        "pose.output",
    ]
    events = [
        dd.Crosses("later", "item 2.node.activation", times=200, ends=False),
        dd.Reached("produced", PRODUCED + 1000, ends=False),
        dd.All("over", ["later", "produced"]),
    ]
    change = [dd.Set(PRODUCED, "mode", 1.0)]
    return run_alone(model, 20_000.0, arena(), watch=watch, events=events, actions=change, every=4.0)


def _at(trial: dd.Trial, path: str, time: float) -> np.ndarray:
    return trial.values[f"{path}.activation"][int(np.searchsorted(trial.times, time))]


def test_a_colour_is_learned_and_its_block_is_found(trial: dd.Trial) -> None:
    pose = trial.values["pose.output"]
    taught = trial.times < PRODUCED
    assert np.ptp(pose[taught], axis=0).max() == 0  # the wheels do not turn during the lesson
    assert trial.outcome == "over"
    block = np.asarray([230.0, 60.0])
    assert np.linalg.norm(pose[-1, :2] - block) < 150 < np.linalg.norm(pose[taught][-1, :2] - block)
    peak = _at(trial, "action", PRODUCED + 600)
    assert peak.max() > 0 and min(int(peak.argmax()), 180 - int(peak.argmax())) <= 3  # red, of the weights


def test_the_condition_of_satisfaction_ends_the_node_and_starts_the_next(trial: dd.Trial) -> None:
    assert _at(trial, "item 1.node", 600.0) > 0
    assert _at(trial, "satisfaction", 1900.0).max() > 0 > _at(trial, "item 1.node", 1900.0)
    assert _at(trial, "item 2.node", 2300.0) > 0


def test_a_change_of_the_mode_starts_with_the_first_node(trial: dd.Trial) -> None:
    assert _at(trial, "item 2.node", PRODUCED + 100) < 0
    assert _at(trial, "item 1.node", PRODUCED + 500) > 0


def test_the_model_has_no_problem_and_a_chain_has_at_least_one_item() -> None:
    assert color_search(3, look_around=False).check() == []
    with pytest.raises(ParameterError, match="1 to 50 items"):
        color_search(0)


def test_a_block_that_is_in_view_at_once_does_not_start_the_chain_again() -> None:
    model, hues = color_search(2), np.arange(180)
    model.set("start.amplitude", 0.0)  # there is no lesson
    for number, hue in ((1, 0), (2, 60)):
        weights = np.exp(-(((hues - hue + 90) % 180 - 90) ** 2) / 8)
        model.set(f"item {number}.meaning.start", weights)
    world = dd.Arena(
        {"unit": "mm", "arena": {"x": [-300, 300], "y": [-300, 300]}},
        (0, 0, 0),
        unit="mm",
        vehicle="khepera",
        physics=dd.ArenaPhysics(period=20, camera_every=4),
    )
    world.place("red", (100, 0), (50, 50), RED, height=70)
    nodes = [f"item {k}.node.activation" for k in (1, 2)]
    [begins, ends] = 100.0, 1200.0
    trial = run_alone(model, ends, world, watch=nodes, actions=[dd.Set(begins, "mode", 1.0)], every=2.0)
    first, second = (trial.values[path] > 0 for path in nodes)
    produced = trial.times > begins + 250
    rises = np.flatnonzero(np.diff((first & produced).astype(int)) == 1)
    assert len(rises) == 1 and second[-1] and not first[-1]
    # the pulse alone would last from 300 to 460 ms after the change of the mode
    fallen = trial.times[np.flatnonzero(first)[-1]]
    assert begins + 300 < fallen < begins + 460


def test_the_mode_opens_and_closes_what_the_documentation_names_and_nothing_else() -> None:
    document = color_search(1, look_around=False).document
    path = {entry.id: entry.path for entry in document.entries}
    [parameter] = [p for p in document.parameters if p.name == "mode"]
    assert [(path[ident], name) for ident, name in parameter.links] == [("producing", "amplitude")]
    opened = {
        f"{path[c.target]}.{c.target_port}"
        for c in document.connections
        if path[c.source] in ("producing", "not teaching") and not path[c.target].startswith("change of mode")
    }
    assert opened == {
        "not teaching.input",
        "item 1.meaning.gate",  # learning
        "shown.factor",  # what the action field reads from the colour-space field
        "read.factor",  # and from the weights
        "ridge.factor",
        "taught.input",  # the resting level of the colour-space field
        "left speed.factor",
        "right speed.factor",
    }
    # a change inhibits nodes and fields for a moment, and starts the first node
    changed = {
        path[c.target]
        for c in document.connections
        if path[c.source] in ("change of mode.clear", "change of mode.start")
    }
    assert changed == {"item 1.node", "item 1.memory", "action", "satisfaction"}
