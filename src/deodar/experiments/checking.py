"""Checks of an experiment before any trial runs."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from deodar.elements.world_ports import Sensor
from deodar.errors import DeodarError, ParameterError, Problem, did_you_mean
from deodar.experiments.actions import Record, changed, targets
from deodar.experiments.design import Design
from deodar.experiments.events import Leaves, Reached, Within
from deodar.experiments.observable import PLACE, Observable, mask
from deodar.experiments.observations import require
from deodar.model import edit, find
from deodar.model.document import Document
from deodar.model.document_graph import graph
from deodar.model.model import Model
from deodar.numerics.sigmoids import SigmoidFunction
from deodar.session.exchange import used
from deodar.session.run import require_step, whole
from deodar.worlds._base import World

if TYPE_CHECKING:
    from jax import Array


def check(experiment: Design, model: Model, world: World | None) -> None:
    """Refuse an experiment with unknown names or invalid values; every problem is listed.

    Raises:
        ParameterError: the experiment has problems; the error lists all.
    """
    problems: list[Problem] = []

    def attempt(where: str, validate: Callable[[], object]) -> bool:
        try:
            validate()
            return True
        except DeodarError as error:
            places = [
                p.where if not p.where or p.where.startswith(where) else f"{where}: {p.where}"
                for p in error.problems
            ]
            problems.extend(
                Problem(w or where, p.what, p.fix) for w, p in zip(places, error.problems, strict=True)
            )
            return False

    doc, plan = model.document, experiment.plan
    if not attempt("model", model.require) or not attempt("world", lambda: used(doc, world)):
        raise ParameterError(problems)
    _times(experiment, doc.step, doc.t0, attempt)
    if attempt("dt", lambda: require_step(doc, doc.step if plan.dt is None else plan.dt)):
        _factors(experiment, model, attempt)
    attempt("conditions", lambda: require(plan.events, plan.measures))
    looks = [(f"conditions.{c.name}", v) for c in plan.events for v in c.views]
    for where, view in [*looks, *((f"measures.{m.name}", m.view) for m in plan.measures)]:
        attempt(where, lambda view=view: _view(view, model, world))
    for condition in plan.events:
        if isinstance(condition, (Within, Leaves)):
            attempt(f"conditions.{condition.name}", lambda c=condition: _radius(c, doc, world))
    names = [c.name for c in plan.events]
    for k, action in enumerate(plan.actions):
        attempt(f"actions.{k}", lambda k=k: targets(k, plan.actions, doc))
        if action.world_method:
            attempt(f"actions.{k}", lambda action=action: changed(action, world))
        if action.when and action.when not in names:
            problem = f"there is no condition {action.when!r}"
            problems.append(Problem(f"actions.{k}.when", problem, did_you_mean(action.when, names)))
        if isinstance(action, Record) and not plan.watch:
            problems.append(
                Problem(
                    f"actions.{k}",
                    "starts or stops recording, but nothing is recorded",
                    "Name ports: watch=[...] of the plan (record in a file)",
                )
            )
    for path in plan.watch:
        attempt("record", lambda path=path: find.shown(doc, path))
    if problems:
        raise ParameterError(problems)


def _times(
    experiment: Design, step: float, t0: float, attempt: Callable[[str, Callable[[], object]], bool]
) -> None:
    plan, limit = experiment.plan, experiment.plan.limit
    dt = step if plan.dt is None else plan.dt

    def within(at: float, name: str) -> None:
        if at - t0 > limit:
            raise ParameterError(
                f"{name}: it is due at {at:g}, and a trial ends after {limit:g} at the latest",
                fix="Use a longer limit",
            )

    attempt("limit", lambda: plan.steps(dt))
    attempt("every", lambda: plan.gap(dt))
    for k, action in enumerate(plan.actions):
        for at in action.times:
            moment = at if action.when else at - t0
            if not attempt(f"actions.{k}", lambda moment=moment: whole(moment, dt, "the time of an action")):
                break
        attempt(f"actions.{k}", lambda action=action: action.time(len(experiment.cells) - 1))
        attempt(
            f"actions.{k}",
            lambda action=action: whole(getattr(action, "lasting", 0.0), dt, "how long it lasts"),
        )
        if not action.when:
            attempt(f"actions.{k}", lambda action=action: within(max(action.times), "is never done"))
    for c in plan.events:
        if isinstance(c, Reached):
            attempt(f"conditions.{c.name}", lambda c=c: within(c.at, "can never hold"))


def _factors(experiment: Design, model: Model, attempt: Callable[[str, Callable[[], object]], bool]) -> None:
    doc, taken = model.document, dict[str, str]()
    step = doc.step if experiment.plan.dt is None else experiment.plan.dt

    def level(path: str, level_value: Any) -> None:
        find.target(doc, path)
        changed = edit.change(doc, path, level_value)
        require_step(changed, step)
        Model(document=changed, trusted=model.trusted).require()

    def once(path: str, name: str) -> None:
        if taken.setdefault(path, name) != name:
            raise ParameterError(
                f"sets {path}, which the factor {taken[path]} sets too", fix="Let one factor set it"
            )

    for factor in experiment.factors:
        where = f"factors.{factor.name}"
        for path in dict.fromkeys(path for sets in factor.sets for path in sets):
            attempt(where, lambda path=path, factor=factor: once(path, factor.name))
            for sets in factor.sets:
                if path in sets and not attempt(
                    where, lambda path=path, value=sets[path]: level(path, value)
                ):
                    break


def _view(view: Observable, model: Model, world: World | None) -> None:
    if world is not None and view.of in world.sensors:
        if view.near or view.reduce == PLACE:
            raise ParameterError(
                f"{view.of} is a sensor of the world, whose samples have no positions",
                fix="Name the port of a Sensor that reads it",
            )
        return
    entry, port = view.place(model.document)
    axes = next(n for n in graph(model.document).nodes if n.id == entry.id).axes(port)
    mask(axes, view.near, view.radius)
    if view.reduce == PLACE and not axes:
        raise ParameterError(f"{view.of} is one number and has no position", fix="Use reduce='max'")
    sigmoid = getattr(entry.element, "sigmoid", None)
    if (
        view.reduce == PLACE
        and port == "output"
        and isinstance(sigmoid, SigmoidFunction)
        and float(sigmoid(cast("Array", np.array(-1.0)))) > view.threshold
    ):
        # the smooth foot of a sigmoid would make the whole field one peak, whose centroid moves towards the
        # middle of the axis
        problem = (
            f"{entry.path}.output is above {view.threshold:g} everywhere, so the whole field would count as"
            " one peak"
        )
        raise ParameterError(problem, fix=f"Measure {entry.path}.activation, or give threshold=0.5")


def _radius(event: Within | Leaves, doc: Document, world: World | None) -> None:
    """Refuse a radius that is longer than the world, which probably has another unit."""
    entries = {e.path: e.element for e in doc.entries}
    element = entries.get(event.of.removesuffix(".output"))
    signal = (
        None
        if world is None
        else world.sensors.get(element.sensor if isinstance(element, Sensor) else event.of)
    )
    if signal is None or signal.bounds is None:
        return
    width, height = (upper - lower for lower, upper in signal.bounds[:2])
    if event.radius >= math.hypot(width, height):
        unit, when = signal.unit.split(",")[0], "always" if isinstance(event, Within) else "never"
        raise ParameterError(
            f"its radius {event.radius:g} is longer than the world, {width:g} x {height:g} {unit}, so it"
            f" {when} holds",
            fix=f"Give the radius in {unit}, or choose another unit of the world",
        )
