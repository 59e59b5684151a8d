"""A closed loop as an environment: what an agent sets and observes, its reward, and the end of an episode."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from deodar.compiler.driven import driven
from deodar.errors import ParameterError, WorldError
from deodar.experiments.events import Event, Reached
from deodar.experiments.experiment import Experiment
from deodar.experiments.levels import swept
from deodar.experiments.observable import Observable
from deodar.experiments.observations import require
from deodar.leaves import leaves
from deodar.model import find
from deodar.model.document_graph import graph
from deodar.model.model import Model
from deodar.model.unit import unit_seconds
from deodar.numerics.axes import shape
from deodar.parameters import real, show
from deodar.session.exchange import embodied, used
from deodar.session.run import require_step, whole
from deodar.session.session import require_model, require_seed
from deodar.worlds._base import World

RewardFunction = Callable[[Mapping[str, np.ndarray], Mapping[str, np.ndarray]], Any]
"""Function of the observations before and after a period, by path, with copies first; it returns one number
for each copy.
"""

Bounds = tuple[float, float]


@dataclass(frozen=True)
class ClosedLoop:
    """A closed loop as an environment.

    Attributes:
        model: the model.
        world: its world, or None.
        act: the parameters that an agent sets, with the smallest and largest value of each.
        see: the ports that it observes: for each path an element by its id and a port, and the shape.
        reward: path of a port in `see` or `hidden`, or a function; None: the reward is always 0.
        until: the events that end an episode.
        steps: steps of a period.
        limit: periods after which an episode is truncated; None: never.
        dt: Euler step.
        seed: seed of all noise, until `reset` gets another.
        trials: number of trials that the episodes repeat; 0: each episode is a new trial.
        precision: float32 or float64.
    """

    model: Model
    world: World | None
    act: Mapping[str, Bounds]
    see: Mapping[str, tuple[str, str, tuple[int, ...]]]
    reward: str | RewardFunction | None
    until: tuple[Event, ...]
    steps: int
    limit: int | None
    dt: float
    seed: int
    trials: int
    precision: str

    @property
    def pure(self) -> bool:
        """Whether copies of it can be computed in one compiled step."""
        doc = self.model.document
        return embodied(doc, self.world) is not None or not any(used(doc, self.world))

    @property
    def views(self) -> list[Observable]:
        """What the events look at, each once."""
        return list(dict.fromkeys(view for event in self.until for view in event.views))

    @property
    def rewarded(self) -> tuple[str, str] | None:
        """The element, by its id, and the port whose value is the reward; None: there is no such port."""
        if not isinstance(self.reward, str):
            return None
        entry, port = find.shown(self.model.document, self.reward)
        return entry.id, port

    def trial(self, episode: int) -> int:
        """Return the trial of an episode of the seed."""
        return episode % self.trials if self.trials else episode % 2**32


def loop(
    of: Experiment | Model,
    world: World | None,
    act: Sequence[str] | Mapping[str, Bounds],
    see: Sequence[str],
    reward: str | RewardFunction | None,
    until: Event | Sequence[Event],
) -> ClosedLoop:
    """Return the loop of an experiment, or of a model in a world.

    Raises:
        ParameterError: a parameter cannot be an action, a path is unknown, the reward is an array, an event
            cannot end an episode, or the experiment has actions or factors.
        WorldError: the world lacks a sensor or motor of the model.
    """
    ends = (until,) if isinstance(until, Event) else tuple(until)
    if isinstance(of, Experiment):
        if world is not None:
            raise ParameterError("the experiment has a world already", fix="Leave world out")
        plan = of.plan
        parts = {
            "actions": plan.actions,
            "factors": of.factors,
            "measures": plan.measures,
            "watch": plan.watch,
        }
        refused = [name for name, values in parts.items() if values]
        if refused:
            raise ParameterError(
                f"an environment has no {' and no '.join(refused)}",
                where=of.name,
                fix="Use an experiment with model and world, and a plan with limit, events and every",
            )
        setup = of.setup()
        model, world, dt = setup.model, setup.world, setup.dt
        ends = (*plan.events, *ends)
        seed, precision, trials = of.seed, of.precision, of.trials if of.trials > 1 else 0
        period = _period(model, world) if plan.every is None else plan.every
        limit = math.ceil(plan.steps(dt) / max(1, whole(period, dt, "every")))
    else:
        model, dt = require_model(of), float(of.document.step)
        model.require()
        require_step(model.document, dt)
        embodied(model.document, world)
        seed, precision, trials, limit, period = 0, "float32", 0, None, _period(model, world)
    steps = whole(period, dt, "the period of the environment")
    if steps < 1:
        raise ParameterError("the period of the environment is 0; expected at least one step")
    _require_period(model, world, steps, dt)
    _require_ends(ends)
    closed_loop = ClosedLoop(
        *(model, world, _bounds(model, act), _seen(model, see), reward, ends, steps, limit, dt),
        *(require_seed(seed), trials, precision),
    )
    for view in closed_loop.views:
        view.place(model.document)
    if isinstance(reward, str):
        entry, port = find.shown(model.document, reward)
        if _shape(model, entry.id, port):
            raise ParameterError("is an array; the reward is one number", where=reward)
    elif reward is not None and not callable(reward):
        raise ParameterError(f"reward is {show(reward)}; expected the path of a port, or a function")
    return closed_loop


def _period(model: Model, world: World | None) -> float:
    """Return the period of the world, or the step of the model, in document time."""
    doc = model.document
    if world is None or world.period is None:
        return doc.step
    return world.period / (unit_seconds(doc.time_unit) * 1e3)


def _require_period(model: Model, world: World | None, steps: int, dt: float) -> None:
    """Refuse a period after which a part of the model or the world is in the middle of a step of its own."""
    multiples = {e.path: e.every for e in model.document.entries}
    if world is not None and world.period is not None:
        multiples["the world"] = whole(_period(model, world), dt, "the world's period")
    for name, every in multiples.items():
        if steps % every:
            raise ParameterError(
                f"the period of the environment is {steps * dt:g}, and {name} has a step of {every * dt:g}",
                fix=f"Use a multiple of {every * dt:g}: dd.TrialPlan(..., every={every * dt:g})",
            )


def _require_ends(events: Sequence[Event]) -> None:
    require(events)
    if not all(isinstance(event, Event) for event in events):
        raise ParameterError(f"until is {show(events)}; expected events, such as dd.Crosses(...)")
    timed = next((e.name for e in events if isinstance(e, Reached)), None)
    if timed is not None:
        raise ParameterError(
            "names a time, which cannot end an episode",
            where=timed,
            fix="Use the limit of the experiment, which truncates it",
        )


def _bounds(model: Model, act: Sequence[str] | Mapping[str, Bounds]) -> dict[str, Bounds]:
    """Return the parameters that an agent sets, with their bounds; by default those that are declared."""
    if isinstance(act, str) or not act:
        raise ParameterError(f"act is {show(act)}; expected the paths of parameters that the agent sets")
    bounds: Mapping[str, Any] = act if isinstance(act, Mapping) else dict.fromkeys(act)
    out: dict[str, Bounds] = {}
    for path, pair in bounds.items():
        low, high = _declared(model, path) if pair is None else _pair(path, pair)
        if not low < high:
            raise ParameterError(
                "has no finite bounds of its own" if pair is None else f"has the bounds {show(pair)}",
                where=path,
                fix=f"Write act={{{path!r}: (-1.0, 1.0)}}, the smallest and the largest value",
            )
        if not swept(model.document, path, [low, high]):
            raise ParameterError(
                "cannot be an action: changing it in a running episode makes another program", where=path
            )
        out[path] = low, high
    return out


def _pair(path: str, pair: Any) -> Bounds:
    numbers = [real(number) for number in pair] if isinstance(pair, Sequence) else []
    if len(numbers) != 2 or any(n is None or not math.isfinite(n) for n in numbers):
        return 0.0, 0.0
    return float(numbers[0] or 0.0), float(numbers[1] or 0.0)


def _declared(model: Model, path: str) -> Bounds:
    """Return the declared bounds of a parameter, or an empty interval if they are not finite."""
    ident, inner = driven(model.document, path)[0]
    element = model.document.by_id()[ident].element
    declared = next(p for leaf, _, p in leaves(element) if leaf == inner)
    return (
        (0.0, 0.0) if declared.lower is None or declared.upper is None else (declared.lower, declared.upper)
    )


def _seen(model: Model, see: Sequence[str]) -> dict[str, tuple[str, str, tuple[int, ...]]]:
    if isinstance(see, str) or not see:
        raise ParameterError(f"see is {show(see)}; expected the paths of ports that the agent observes")
    out: dict[str, tuple[str, str, tuple[int, ...]]] = {}
    for path in see:
        entry, port = find.shown(model.document, path)
        out[path] = entry.id, port, _shape(model, entry.id, port)
    return out


def _shape(model: Model, ident: str, port: str) -> tuple[int, ...]:
    node = next(n for n in graph(model.document).nodes if n.id == ident)
    return shape(node.outs[port] if port in node.outs else node.ins[port])


def require_copies(of: ClosedLoop, copies: int) -> int:
    """Return a number of copies; raise an error for a world that cannot be part of a compiled step."""
    if isinstance(copies, bool) or not isinstance(copies, (int, np.integer)) or copies < 1:
        raise ParameterError(f"copies is {show(copies)}; expected a whole number, at least 1")
    if not of.pure:
        raise WorldError(
            f"the world {type(of.world).__name__} cannot be computed for a batch of copies",
            fix="Leave copies out, and run environments side by side: gymnasium.vector.AsyncVectorEnv",
        )
    return int(copies)
