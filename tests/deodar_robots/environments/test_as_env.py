"""Closed loops as environments: episodes, copies in one step, rewards and ends, and what is refused."""

from __future__ import annotations

import sys
import warnings
from dataclasses import replace
from typing import Any

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.wrappers import FlattenObservation
from gymnasium.wrappers.vector import RecordEpisodeStatistics

import deodar as dd
from deodar.compiler.program import BEGUN
from deodar.errors import MissingExtra, NotFinite, ParameterError, WorldError

WHEELS = {"left.amplitude": (-400.0, 400.0), "right.amplitude": (-400.0, 400.0)}


def driving() -> dd.Model:
    """Return a model that drives an e-puck by two boosts, and reads its sensors and a noisy field."""
    model = dd.Model("driving", dt=16.0)
    for side in ("left", "right"):
        model.add(dd.Boost(side, amplitude=0.0)) >> model.add(dd.Motor(f"{side} wheel", motor=side))
    eyes = model.add(dd.Sensor("eyes", [dd.Axis("sensor", 0, 7, 8)], sensor="infrared"))
    model.add(dd.Sensor("pose", [dd.Axis("of", 0, 2, 3)], sensor="pose"))
    field = model.add(dd.Field("seen", [dd.Axis("sensor", 0, 7, 8)], tau=100.0, noise=0.3))
    eyes >> dd.Gain(0.01) >> field
    return model


def arena() -> dd.Arena:
    return dd.Arena("blocks", unit="cm", start=(20, 30, 0.4))


def moved(before: Any, now: Any) -> np.ndarray:
    return np.hypot(*(now["pose"] - before["pose"])[:, :2].T)


FAR = dd.Leaves("far", 12.0, of="pose", ends=True)


def wheels(copies: int | None = None, world: dd.World | None = None, **options: Any) -> Any:
    return dd.as_env(
        driving(),
        WHEELS,
        ["eyes", "pose", "seen"],
        moved,
        options.get("until", FAR),
        arena() if world is None else world,
        copies,
    )


def timed(copies: int | None = None, noise: float = 0.0, limit: float = 100.0) -> Any:
    """Return an environment without a world: a node that a boost drives, and a stimulus from 30 to 60 ms."""
    model = dd.Model("timed", dt=5.0)
    node = model.add(dd.Field("u", (), tau=20.0, resting_level=0.0, noise=noise))
    model.add(dd.Boost("given", amplitude=1.0)) >> node
    model.add(dd.Boost("cue", amplitude=5.0, windows=[(30, 60)])) >> node
    experiment = dd.Experiment(
        "timed", model, dd.TrialPlan(limit, events=[dd.Crosses("high", "u", level=6.0)], every=10.0)
    )
    return dd.as_env(experiment, {"given.amplitude": (-8.0, 8.0)}, ["u"], "u", copies=copies)


def checked(env: Any) -> None:
    with warnings.catch_warnings():
        # spaces without bounds
        warnings.simplefilter("ignore", UserWarning)
        check_env(env, skip_render_check=True)


@pytest.mark.parametrize("make", [wheels, timed])
def test_gymnasium_finds_no_mistake(make):
    checked(make())


def test_gymnasium_finds_no_mistake_in_an_environment_around_another():
    model, of = dd.Model("hand", dt=20.0), dd.Axis("of", 0, 1, 2)
    model.add(dd.Boost("hand", amplitude=0.0)) >> model.add(dd.Motor("push", motor="action"))
    model.add(dd.Sensor("state", [of], sensor="observation"))
    model.add(dd.Sensor("reward", sensor="reward"))
    world = dd.Gymnasium("MountainCarContinuous-v0")
    env = dd.as_env(model, {"hand.amplitude": (-1, 1)}, ["state"], "reward", world=world)
    checked(env)
    state, _ = env.reset(seed=1)
    before = state[1]
    state, reward, *_ = env.step([1.0])
    assert state[1] > before and reward == pytest.approx(-0.1)


def test_copies_in_one_step_take_the_steps_of_single_environments():
    copies, actions = 3, np.random.default_rng(0).uniform(-300, 400, (40, 3, 2))
    vector, single = wheels(copies, until=()), wheels(until=())
    begun, _ = vector.reset(seed=5)
    together = [begun] + [vector.step(action)[0] for action in actions]
    for k in range(copies):
        seen, _ = single.reset(seed=5, options={"trial": k})
        alone = [seen] + [single.step(action[k])[0] for action in actions]
        for one, many in zip(alone, together, strict=True):
            for path, values in one.items():
                np.testing.assert_allclose(values, many[path][k], rtol=1e-4, atol=1e-4)


def test_an_episode_is_a_run_of_its_trial():
    model = driving()
    model.set({"left.amplitude": 250.0, "right.amplitude": 300.0})
    run = dd.simulate(model, 64 * 30, trials=[2], record=["pose", "seen"], every=64.0, seed=4, world=arena())
    env = dd.as_env(model, WHEELS, ["pose", "seen"], world=arena())
    seen = [env.reset(seed=4, options={"trial": 2})[0]]
    seen += [env.step([250, 300])[0] for _ in range(30)]
    np.testing.assert_allclose([s["pose"] for s in seen], run["pose.output"].values[0], atol=1e-4)
    np.testing.assert_allclose([s["seen"] for s in seen], run["seen.activation"].values[0], atol=1e-4)


def test_a_world_on_the_host_takes_the_same_steps():
    outside = arena()
    outside.inside = False
    actions = np.random.default_rng(1).uniform(100, 400, (60, 2))
    found = []
    for world in (arena(), outside):
        env, seen = wheels(world=world), []
        state, _ = env.reset(seed=2)
        for action in actions:
            state, reward, ended, _, info = env.step(action)
            seen.append([*state["pose"], *state["seen"], reward, ended])
            if ended:
                assert info["outcome"] == "far"
                env.reset()
        found.append(seen)
    np.testing.assert_allclose(*found, rtol=1e-4, atol=1e-4)
    assert np.array(found[0])[:, -1].sum() >= 1, "an episode ends"


def test_a_copy_begins_another_episode_at_its_own_time():
    """The stimulus is on from 30 to 60 ms of each episode, whenever it begins."""
    env, alone = timed(2), timed()
    env.reset(seed=0)
    assert env.metadata["autoreset_mode"] == AutoresetMode.SAME_STEP
    actions, seen, infos = np.array([[1.0], [4.0]]), [], []
    for _ in range(25):
        state, rewards, ended, truncated, info = env.step(actions)
        seen.append((state, rewards, ended, truncated))
        infos.append(info)
    for k, amplitude in enumerate(actions):
        step = 0
        for _ in range(2):
            alone.reset()
            over = False
            while not over:
                state, reward, ended, truncated, about = alone.step(amplitude)
                over = ended or truncated
                many, rewards, ends, cuts = seen[step]
                info = infos[step]
                assert (rewards[k], ends[k], cuts[k]) == (pytest.approx(reward), ended, truncated)
                last = info["final_obs"][k] if over else many[k]
                assert last == pytest.approx(state, abs=1e-5)
                if over:
                    assert info["_final_obs"][k] and info["final_info"]["outcome"][k] == about["outcome"]
                    assert info["final_info"]["time"][k] == about["time"]
                    assert many[k] == pytest.approx(alone.reset()[0], abs=1e-6) and info["time"][k] == 0
                step += 1
    ends = np.array([s[2] for s in seen])
    assert ends[:, 1].sum() > 2 and not ends[:, 0].any(), "one copy ends by its event, the other by the limit"
    copies = env._episodes._copies
    copies._run.clock = replace(copies._run.clock, tick=2**32 + 7)
    copies.restart(np.array([False, True]), [0, 1])
    assert np.array(copies._run.keys[BEGUN])[1] == 7, "ticks are counted modulo 2**32"


@pytest.mark.parametrize("precision", ["float32", "float64"])
def test_later_episodes_without_noise_have_the_bits_of_the_first(precision: str):
    """Delays, moving stimuli and parts with a step of their own begin again with each copy."""
    model, x = dd.Model("racing", dt=2.0), dd.Axis("x", 0, 50, 51)
    kernel = dd.Gaussian(10, 4, normalized=True)
    u = model.add(dd.Field("u", [x], kernel=[kernel], global_inhibition=0.5))
    model.add(dd.GaussianStimulus("s", [x], center=25, sigma=4, amplitude=3.0)) >> u
    model.add(dd.MovingGaussian("m", [x], center=0, velocity=0.1, sigma=3, amplitude=3.0)) >> u
    v = model.add(dd.Field("v", [x], tau=30), ticks=2)
    u >> dd.DelayLine(delay=20.0, name="late") >> v
    peak = dd.Appears("peak", "u", near=25.0, radius=5.0)
    experiment = dd.Experiment(
        "racing", model, dd.TrialPlan(120.0, events=[peak], every=20.0), precision=precision
    )
    env = dd.as_env(experiment, {"s.amplitude": (0, 10), "u.resting_level": (-8, -2)}, ["u", "v"], copies=2)
    assert env.observation_space["u"].dtype == precision
    env.reset(seed=0)
    episodes: list[list[list[np.ndarray]]] = [[[]], [[]]]
    for _ in range(20):
        seen, _, ended, truncated, info = env.step(np.array([[6.0, -5.0], [0.0, -5.5]]))
        for k, courses in enumerate(episodes):
            over = ended[k] | truncated[k]
            last = info["final_obs"] if over else seen
            courses[-1].append(np.concatenate([last["u"][k], last["v"][k]]))
            if over:
                courses.append([])
    for courses, count in zip(episodes, (10, 3), strict=True):
        assert len(courses) == count + 1
        assert all(np.array_equal(course, courses[0]) for course in courses[1:count])


def test_the_noise_of_an_episode_follows_from_the_seed_and_its_number():
    def course(env: Any, steps: int, **options: Any) -> np.ndarray:
        first = env.reset(**options)[0]
        return np.array([first, *(env.step(np.ones(env.action_space.shape))[0] for _ in range(steps))])

    env = timed(noise=1.0, limit=1000.0)
    first, second = course(env, 9, seed=3), course(env, 9)
    assert not np.array_equal(first, second)
    assert np.array_equal(course(env, 9, seed=3), first) and np.array_equal(course(env, 9), second)
    assert not np.array_equal(course(env, 9, seed=4), first)
    many = timed(3, noise=1.0, limit=50.0)
    runs = course(many, 18, seed=3)
    assert np.array_equal(course(many, 18, seed=3), runs)
    np.testing.assert_allclose(runs[:5, 1], second[:5], atol=1e-5)
    episodes = [runs[a : a + 5, k] for a in (0, 5, 10) for k in range(3)]
    assert len({tuple(e[1:].tolist()) for e in episodes}) == 9, "nine episodes with noise of their own"


@pytest.mark.parametrize("precision", ["float32", "float64"])
@pytest.mark.parametrize("steps", [2, 3])
def test_every_episode_of_a_copy_has_the_noise_of_a_run_of_its_trial(steps: int, precision: str):
    """In blocks of two ticks, which begin at odd ticks of the batch too, and in parts of two ticks."""
    model, x = dd.Model("noisy", dt=5.0), dd.Axis("x", 0, 500, 501)
    u = model.add(dd.Field("u", [x], tau=20.0, noise=1.0))
    model.add(dd.Boost("given", amplitude=1.0)) >> u
    if steps == 2:
        u >> model.add(dd.Field("slow", [x], tau=40.0, noise=1.0), ticks=2)
    experiment = dd.Experiment(
        "noisy", model, dd.TrialPlan(5.0 * 3 * steps, every=5.0 * steps), seed=5, precision=precision
    )
    env = dd.as_env(experiment, {"given.amplitude": (-8.0, 8.0)}, ["u"], copies=3)
    alone = dd.as_env(experiment, {"given.amplitude": (-8.0, 8.0)}, ["u"])
    env.reset()
    for episode in range(3):
        seen = [(s, info) for s, *_, info in (env.step(np.ones((3, 1))) for _ in range(3))]
        many = np.array([seen[0][0], seen[1][0], seen[2][1]["final_obs"]])
        for k in range(3):
            alone.reset(options={"trial": 3 * episode + k})
            one = [alone.step(np.ones(1))[0] for _ in range(3)]
            np.testing.assert_allclose(many[:, k], one, atol=1e-4 if precision == "float32" else 1e-10)


def test_episodes_repeat_the_trials_of_an_experiment():
    model = driving()
    starts = [(20, 30, 0.0), (25, 30, 1.0), (20, 35, 2.0)]
    world = dd.Arena("blocks", unit="cm", start=starts)
    experiment = dd.Experiment("three", model, dd.TrialPlan(6400.0, every=64.0), trials=3, world=world)
    env = dd.as_env(experiment, WHEELS, ["pose"])
    np.testing.assert_allclose([env.reset()[0] for _ in range(4)], [*starts, starts[0]], rtol=1e-6)
    vector = dd.as_env(experiment, WHEELS, ["pose"], copies=4)
    np.testing.assert_allclose(vector.reset()[0], [*starts, starts[0]], rtol=1e-6)


def test_actions_beyond_the_bounds_are_limited():
    env, other = timed(), timed()
    env.reset(), other.reset()
    assert env.step([1e9])[0] == other.step([8.0])[0]


def test_wrappers_of_gymnasium_accept_both():
    flat = FlattenObservation(wheels())
    assert flat.reset(seed=0)[0].shape == (8 + 3 + 8,)
    vector = RecordEpisodeStatistics(timed(2))
    assert isinstance(vector.unwrapped, VectorEnv) and vector.observation_space.shape == (2,)
    vector.reset(seed=0)
    for _ in range(10):
        *_, info = vector.step(np.ones((2, 1)))
    assert info["episode"]["l"].tolist() == [10, 10]


@pytest.mark.parametrize("action", [[np.nan], [1.0, 2.0], ["fast"], 1.0], ids=str)
def test_actions_that_are_none_are_refused(action):
    env = timed()
    env.reset()
    with pytest.raises(ParameterError, match=r"expected finite numbers of shape \[1, 1\]"):
        env.step(action)


def test_a_reward_that_is_no_number_for_each_copy_is_refused():
    env = dd.as_env(driving(), WHEELS, ["pose"], lambda before, now: np.zeros(2), world=arena())
    env.reset()
    with pytest.raises(ParameterError, match="expected 1 finite numbers, one for each copy"):
        env.step([0.0, 0.0])


def test_a_value_that_diverges_is_named():
    model = dd.Model("growing", dt=5.0)
    node = model.add(dd.Function("u", function="deodar.elements.function:leaky", values={"rate": 0.0}))
    strength = model.add(dd.Boost("given", amplitude=1.0))
    strength >> node
    grow = model.add(dd.Integrator("x", rate=1.0))
    strength >> grow
    grow >> dd.Gain(1e30, name="more") >> dd.Gain(1e30, name="most") >> model.add(dd.Integrator("y"))
    env = dd.as_env(model, {"given.amplitude": (0.0, 1e3)}, ["x"])
    env.reset()
    with pytest.raises(NotFinite, match="became infinite or undefined"):
        for _ in range(5):
            env.step([1e3])


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"act": []}, "act is .*; expected the paths of parameters"),
        ({"act": ["left.amplitude"]}, r"left.amplitude: has no finite bounds of its own. Write act="),
        ({"act": {"left.amplitude": (1.0, 1.0)}}, r"left.amplitude: has the bounds \(1.0, 1.0\)"),
        ({"act": {"left.amplitude": (0.0, np.inf)}}, "left.amplitude: has the bounds"),
        ({"act": {"left.strength": (0.0, 1.0)}}, "strength"),
        ({"act": {"seen.axes": (0.0, 1.0)}}, "seen.axes: cannot be an action"),
        ({"see": "pose"}, "see is 'pose'; expected the paths of ports"),
        ({"see": ["poze"]}, "Did you mean 'pose'"),
        ({"reward": "pose"}, "pose: is an array; the reward is one number"),
        ({"reward": 5}, "reward is 5; expected the path of a port, or a function"),
        ({"until": dd.Reached("late", at=100.0)}, "late: names a time, which cannot end an episode"),
        ({"until": [dd.Crosses("a", "no such")]}, "no such"),
        ({"copies": 0}, "copies is 0; expected a whole number, at least 1"),
        ({"world": None}, "no world was given that provides it"),
    ],
)
def test_what_cannot_be_an_environment_is_refused(options: dict[str, Any], message: str):
    usual = {"act": WHEELS, "see": ["pose"], "world": arena()}
    with pytest.raises(dd.errors.DeodarError, match=message):
        dd.as_env(driving(), **{**usual, **options})


def test_experiments_that_are_no_environment_are_refused():
    def experiment(**parts: Any) -> dd.Experiment:
        return dd.Experiment("driving", driving(), dd.TrialPlan(640.0, **parts), world=arena())

    with pytest.raises(ParameterError, match="driving: an environment has no actions and no watch"):
        dd.as_env(
            experiment(actions=[dd.Push(64.0, "seen", amount=1.0, lasting=16.0)], watch=["pose"]),
            WHEELS,
            ["pose"],
        )
    with pytest.raises(ParameterError, match="the experiment has a world already"):
        dd.as_env(experiment(), WHEELS, ["pose"], world=arena())
    with pytest.raises(
        ParameterError, match=r"the period of the environment is 16, and the world has a step"
    ):
        dd.as_env(experiment(every=16.0), WHEELS, ["pose"])


def test_copies_of_a_world_on_the_host_are_refused():
    model = dd.Model("hand", dt=20.0)
    model.add(dd.Boost("hand")) >> model.add(dd.Motor("push", motor="action"))
    with pytest.raises(WorldError, match="Gymnasium cannot be computed for a batch of copies"):
        dd.as_env(
            model,
            {"hand.amplitude": (-1.0, 1.0)},
            ["push"],
            world=dd.Gymnasium("MountainCarContinuous-v0"),
            copies=2,
        )


def test_a_list_of_seeds_is_refused():
    with pytest.raises(ParameterError, match=r"seed is \[7, 8\]; expected one seed.*reset\(seed=7\)"):
        timed(2).reset(seed=[7, 8])


def test_without_the_package_the_error_states_what_to_type(monkeypatch: pytest.MonkeyPatch):
    for name in [n for n in sys.modules if n.startswith("deodar_robots.environments.")]:
        if name.endswith(".single_and_vector"):
            monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, "gymnasium", None)
    with pytest.raises(MissingExtra, match=r"pip install 'deodar\[gym\]'"):
        timed()


def test_an_environment_is_one_of_gymnasium():
    assert isinstance(timed(), gymnasium.Env) and isinstance(timed(2), VectorEnv)
