"""An environment of Gymnasium: its signals, episodes, seeds and state, and what is refused."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest
from gymnasium import spaces

import deodar as dd
from deodar.errors import MissingExtra, WorldError
from deodar.recording.opened import again, named
from deodar_robots.gymnasium.space_parts import SpacePart, parts
from tests.deodar_robots.gymnasium.environments import Counting, Wrong

CAR = "MountainCarContinuous-v0"
NESTED = spaces.Dict(
    {
        "eye": spaces.Box(0, 255, (2, 3), np.uint8),
        "arm": spaces.Dict({"angle": spaces.Box(-1, 9, ()), "on": spaces.Discrete(2)}),
    }
)


def climbing(world: dd.World, seed: int = 0) -> dd.Session:
    """Return a session of a model with two weights, which pushes the car where it already goes."""
    model, of = dd.Model("climbing", dt=20), dd.Axis("of", 0, 1, 2)
    state = model.add(dd.Sensor("state", [of], sensor="observation"))
    state >> dd.Weights(np.array([0.0, 50.0]), axes=()) >> model.add(dd.Motor("push", motor="action"))
    model.add(dd.Sensor("reward", sensor="reward"))
    model.add(dd.Sensor("done", sensor="done"))
    return dd.Session(model, world=world, seed=seed)


def episodes(world: dd.World, trials: tuple[int, ...] = (0,), periods: int = 7) -> list[list[float]]:
    """Return observation, reward and `done` of the first copy in each period."""
    world.reset(3, trials)
    seen = []
    for _ in range(periods):
        seen.append([float(world.sense(name, (), 0.0)[0]) for name in ("observation", "reward", "done")])
        world.act({"action": np.full(len(trials), 5.0)}, 0.0)
    return seen


def test_a_model_of_two_weights_climbs_the_mountain_from_ten_seeds():
    returns = []
    for seed in range(10):
        session, total = climbing(dd.Gymnasium(CAR, at_end="hold"), seed), 0.0
        while not session.read("done") and session.tick < 999:
            session.run(20)
            total += float(session.read("reward"))
        returns.append(total)
    assert min(returns) >= 90, "solved is a return of 90"


def test_the_world_takes_the_same_steps_as_the_environment_alone():
    import gymnasium

    world = dd.Gymnasium(CAR)
    world.reset(4, [2])
    env = gymnasium.make(CAR)
    env.reset(seed=int(np.random.SeedSequence([4, 2, 0]).generate_state(1)[0]))
    for action in np.random.default_rng(0).uniform(-2, 2, 50):
        world.act({"action": np.array([action])}, 0.0)
        seen, reward, *_ = env.step(np.clip([action], -1, 1).astype(np.float32))
        assert np.array_equal(world.sense("observation", (), 0.0)[0], seen)
        assert world.sense("reward", (), 0.0)[0] == reward


def test_the_next_episode_begins_at_once():
    seen = episodes(dd.Gymnasium(Counting))
    first = seen[0][0]
    assert [s[0] - first for s in seen[:3]] == [0, 1, 2]
    assert [s[1:] for s in seen] == [[0, 0], [10, 0], [20, 0], [30, 1], [10, 0], [20, 0], [30, 1]]
    assert seen[3][0] not in (first, first + 3), "the first observation of another seed"
    assert [s[0] - seen[3][0] for s in seen[3:6]] == [0, 1, 2]


def test_an_episode_that_ended_is_held():
    seen = episodes(dd.Gymnasium(Counting, at_end="hold"))
    assert [s[0] - seen[0][0] for s in seen] == [0, 1, 2, 3, 3, 3, 3]
    assert [s[1:] for s in seen] == [[0, 0], [10, 0], [20, 0], [30, 1], [0, 1], [0, 1], [0, 1]]


def test_trials_have_environments_and_seeds_of_their_own():
    world = dd.Gymnasium(CAR)
    world.reset(0, [0, 1, 2])
    places = world.sense("observation", (), 0.0)[:, 0]
    assert len(set(places)) == 3
    world.reset(0, [2])
    assert world.sense("observation", (), 0.0)[0, 0] == places[2]
    world.reset(1, [2])
    assert world.sense("observation", (), 0.0)[0, 0] != places[2]


def test_trials_of_an_experiment_run_one_by_one_and_a_batch_is_refused():
    model = climbing(dd.Gymnasium(CAR)).document
    top = dd.Crosses("top", "done.output", level=0.5)
    world = dd.Gymnasium(CAR, at_end="hold")
    trials = dd.Experiment(
        "car",
        dd.Model(document=model),
        dd.TrialPlan(20.0 * 999, events=[top], every=20),
        trials=3,
        world=world,
    )
    table = trials.run()
    assert list(table["outcome"].values) == ["top"] * 3 and len(set(table["duration"].values)) > 1
    with pytest.raises(WorldError, match=r"dd\.Trials"):
        dd.simulate(dd.Model(document=model), 40, record="reward", trials=2, world=world)


def test_a_dictionary_has_a_sensor_for_each_key():
    world = dd.Gymnasium(lambda: Counting(NESTED))
    assert set(world.sensors) == {"eye", "arm.angle", "arm.on", "reward", "done"}
    assert world.sensors["eye"].shape == (2, 3) and world.sensors["arm.angle"].shape == ()
    assert world.sensors["arm.angle"].bounds == ((-1.0, 9.0),)
    world.reset(0)
    world.act({"action": np.array([5.0])}, 0.0)
    assert world.sense("eye", (), 0.0)[0].tolist() == [[1, 1, 1], [1, 1, 1]]
    assert (world.sense("arm.angle", (), 0.0)[0], world.sense("arm.on", (), 0.0)[0]) == (1, 1)


def test_a_dictionary_of_actions_has_a_motor_for_each_key():
    made = []

    def environment():
        made.append(
            Counting(action=spaces.Dict({"left": spaces.Box(-1, 1, (1,)), "gear": spaces.Discrete(4)}))
        )
        return made[-1]

    world = dd.Gymnasium(environment)
    assert {name: signal.shape for name, signal in world.motors.items()} == {"left": (), "gear": ()}
    world.reset(0)
    world.act({"left": np.array([0.25])}, 0.0)
    assert made[0].given[0]["left"].tolist() == [0.25] and made[0].given[0]["gear"] == 0


@pytest.mark.parametrize(
    ("space", "values", "action"),
    [
        (spaces.Discrete(2), 0.4, 0),
        (spaces.Discrete(2), 0.6, 1),
        (spaces.Discrete(3, start=5), 0.0, 5),
        (spaces.Discrete(3, start=5), 99.0, 7),
        (spaces.Box(-1, 1, (1,)), 3.0, [1.0]),
        (spaces.Box(-1, 1, (2,)), [0.5, -7.0], [0.5, -1.0]),
        (spaces.Box(0, 255, (2,), np.uint8), [1.6, 300.0], [2, 255]),
        (spaces.Box(-np.inf, np.inf, (1,)), -1e6, [-1e6]),
        (spaces.MultiDiscrete([2, 3]), [5.0, 1.2], [1, 1]),
        (spaces.MultiBinary(3), [0.4, 0.6, 9.0], [0, 1, 1]),
    ],
    ids=str,
)
def test_values_of_a_motor_become_an_action_of_the_space(space, values, action):
    found = SpacePart((), space, "x").action(np.asarray(values))
    assert space.contains(found) and np.asarray(found).tolist() == action


def test_a_state_repeats_the_episode(tmp_path: Path):
    session = climbing(dd.Gymnasium(CAR))
    session.run(20 * 150)
    snapshot = session.snapshot()
    dd.save_snapshot(snapshot, tmp_path / "state.npz")
    paths = ("state", "reward", "done")

    def onward():
        seen = []
        for _ in range(150):
            session.run(20)
            seen.append([session.read(path).tolist() for path in paths])
        return seen

    first = onward()
    assert any(done for *_, done in first), "an episode ends"
    session.restore(snapshot)
    assert onward() == first
    session.restore(dd.load_snapshot(tmp_path / "state.npz"))
    assert onward() == first


def test_names_and_settings_on_the_command_line():
    world = named("gym:MountainCarContinuous-v0, period=10, at_end=hold, goal_velocity=0.02", "--world")
    assert isinstance(world, dd.Gymnasium) and (world.period, world.at_end) == (10.0, "hold")
    assert world._copies[0].env.unwrapped.goal_velocity == 0.02
    assert again(dd.Gymnasium, world.describe()).describe() == world.describe()
    assert isinstance(named("gymnasium:CartPole-v1", "--world"), dd.Gymnasium)


@pytest.mark.parametrize(
    ("argument", "message"),
    [
        ("CartPole-v9", "CartPole-v9: there is no such environment: .*v9.*Did you mean 'CartPole-v1'"),
        ("CartPol-v1", "Did you mean 'CartPole-v1'"),
        ("CartPole-v1,foo=1", "could not be made: TypeError: .*'foo'"),
        ("CartPole-v1,foo", "'foo' is no setting. Write NAME=VALUE"),
        ("CartPole-v1,at_end=never", "at_end is 'never'; expected reset or hold"),
        ("CartPole-v1,period=0", "period is 0; expected a finite number, above 0"),
        ("os:X-v0", "names a module, which is not imported from text"),
        (",period=1", "needs the name of an environment"),
        ("Blackjack-v1", "the space of 'observation' is Tuple, which cannot be a signal"),
    ],
)
def test_what_cannot_be_opened_is_refused(argument: str, message: str):
    with pytest.raises(WorldError, match=message):
        named(f"gym:{argument}", "--world")


def test_environments_of_functions_that_cannot_be_worlds_are_refused():
    with pytest.raises(WorldError, match=r"the function returned 5; expected a gymnasium\.Env"):
        dd.Gymnasium(lambda: 5)
    with pytest.raises(WorldError, match="expected a name, or a function without settings"):
        dd.Gymnasium(Counting, settings={"a": 1})
    with pytest.raises(WorldError, match="raised ZeroDivisionError in its function: division by zero"):
        dd.Gymnasium(lambda: 1 / 0)
    with pytest.raises(WorldError, match="the space of 'action' is Text"):
        dd.Gymnasium(lambda: Counting(action=spaces.Text(3)))
    with pytest.raises(WorldError, match="has the key 'reward', the name of another sensor"):
        dd.Gymnasium(lambda: Counting(spaces.Dict({"reward": spaces.Discrete(2)})))
    with pytest.raises(WorldError, match=r"has two parts called 'a\.b'"):
        parts(spaces.Dict({"a.b": spaces.Discrete(2), "a": spaces.Dict({"b": spaces.Discrete(2)})}), "", "x")
    with pytest.raises(WorldError, match="names a module"):
        again(dd.Gymnasium, dd.Gymnasium(Counting).describe())


def test_an_environment_that_fails_is_named():
    world = dd.Gymnasium(Wrong)
    world.reset(0)
    with pytest.raises(WorldError, match=r"Wrong: the environment raised RuntimeError in step: broken"):
        world.act({"action": np.array([6.0])}, 0.0)
    world.act({"action": np.array([5.0])}, 0.0)
    with pytest.raises(WorldError, match=r"the observation has the shape \[4\]; its space has \[1\]"):
        world.sense("observation", (), 0.0)


def test_another_shape_than_that_of_the_space_is_refused():
    with pytest.raises(WorldError, match=r"'observation' has axes of 2 samples; the model gives it \[3\]"):
        model = dd.Model("wrong", dt=20)
        model.add(dd.Sensor("state", [dd.Axis("of", 0, 2, 3)], sensor="observation"))
        dd.Session(model, world=dd.Gymnasium(CAR))


def test_without_the_package_the_error_states_what_to_type(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setitem(sys.modules, "gymnasium", None)
    with pytest.raises(MissingExtra, match=r"pip install 'deodar\[gym\]'"):
        dd.Gymnasium(CAR)
