"""Closed loops as environments of Gymnasium, for agents that learn from them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from deodar.errors import MissingExtra
from deodar.experiments.events import Event
from deodar.experiments.experiment import Experiment
from deodar.model.model import Model
from deodar.worlds._base import World
from deodar_robots.environments.loop import Bounds, RewardFunction, loop, require_copies

if TYPE_CHECKING:
    from deodar_robots.environments.single_and_vector import LoopEnv, LoopVectorEnv


def as_env(
    of: Experiment | Model,
    act: Sequence[str] | Mapping[str, Bounds],
    see: Sequence[str],
    reward: str | RewardFunction | None = None,
    until: Event | Sequence[Event] = (),
    world: World | None = None,
    copies: int | None = None,
) -> LoopEnv | LoopVectorEnv:
    """Return a closed loop of a model and its world as an environment of Gymnasium; needs the extra `gym`.

    In each period an agent sets parameters of the model, and observes ports after it. An action beyond the
    bounds is limited to them. At the start of an episode the parameters have the values of the model. If a
    value becomes infinite or undefined, the step raises `NotFinite`.

    The environment of an experiment has its model, world, `dt`, precision and seed. A period is its `every`
    (by default that of the world), a condition with `ends` terminates an episode, and its `limit` truncates
    it. Episode k is trial k of the seed; with `trials` above 1 in the experiment the episodes repeat these
    trials. A model alone has a period of its world, or a step, and is never truncated.

    Args:
        of: the experiment, or the model.
        act: paths of the parameters that the agent sets, live numbers; a dictionary states the smallest and
            the largest value of each, otherwise they are those that the parameter declares.
        see: paths of the ports that it observes. One path is a Box, several are a Dict by path; the path of a
            field alone means its activation.
        reward: path of a port of one number, the reward of a period being its value at the end; or a function
            of the observations before and after the period (dictionaries by path, of arrays with copies
            first), which returns one number for each copy. None: 0.
        until: further events that terminate an episode.
        world: the world of a model.
        copies: number of copies of a vector environment, all inside one compiled step. None: a single
            environment.

    Returns:
        A `gymnasium.Env`, or a `gymnasium.vector.VectorEnv` that resets a copy in the step in which its
        episode ends.

    Raises:
        MissingExtra: Gymnasium is not installed.
        ParameterError: a parameter cannot be an action, a path is unknown, or the experiment has actions,
            factors, measures or records.
        WorldError: the world lacks a sensor or motor, or copies of it cannot be computed in one step.
    """
    try:
        # an extra
        from deodar_robots.environments.single_and_vector import LoopEnv, LoopVectorEnv
    except ImportError as error:
        if (error.name or "").partition(".")[0] != "gymnasium":
            raise
        raise MissingExtra("gymnasium", "gym", "an environment of Gymnasium") from None
    found = loop(of, world, act, see, reward, until)
    return LoopEnv(found) if copies is None else LoopVectorEnv(found, require_copies(found, copies))
