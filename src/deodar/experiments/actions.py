"""Actions on a running trial, at a stated time or after an event."""

from __future__ import annotations

import contextlib
import inspect
import warnings
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

from deodar.elements.stimuli import Boost
from deodar.errors import DeodarError, ParameterError, RunWarning, UnknownName, WorldError, did_you_mean
from deodar.experiments.running_trial import RunningTrial
from deodar.family import Family
from deodar.model import edit, find
from deodar.model.document import Document
from deodar.model.model import Model
from deodar.parameters import Part, PerAxis, Recompile
from deodar.session.run import whole
from deodar.worlds._base import World

PerTrial = float | Sequence[float]
"""A number for all trials, or a list with one for each."""

At = Annotated[PerTrial, Recompile("time", role="moment", lower=0.0)]
When = Annotated[str, Recompile(names="event")]


class Action(Part):
    """Base of actions on a trial.

    Attributes:
        at: document time of the action, or of its beginning; with `when` the time after that event; or one
            for each trial, by its number.
        when: the event after which the action is carried out, or begins; empty: at a time of its own.
    """

    at: PerTrial
    when: str

    world_method: ClassVar[str] = ""
    """Name of the world's method that `apply` calls: "place", "move" or "remove"; empty: none."""

    @property
    def world_arguments(self) -> tuple[str, ...]:
        """The arguments of that method which `World` does not have, but the action passes."""
        return ()

    @property
    def times(self) -> tuple[float, ...]:
        """The time for all trials, or that of each."""
        return tuple(self.at) if isinstance(self.at, Sequence) else (self.at,)

    def time(self, trial: int) -> float:
        """Return the time for a trial.

        Raises:
            ParameterError: there are times for fewer trials.
        """
        times = self.times if isinstance(self.at, Sequence) else self.times * (trial + 1)
        if trial >= len(times):
            raise ParameterError(
                f"there are {len(times)} times, and trial {trial} is run",
                where=f"{type(self).__name__}.at",
                fix="Give one for all trials, or one for each",
            )
        return times[trial]

    def sets(self) -> Iterator[tuple[str, Any]]:
        """Yield the parameters of the model that the action changes, each with a value that it gets; the
        values between those of one parameter are valid, too.
        """
        return iter(())

    def ports(self) -> Iterator[str]:
        """Yield the ports of the model that the action reads."""
        return iter(())

    def apply(self, running: RunningTrial) -> None:
        """Carry out the action now."""
        raise NotImplementedError


ACTIONS = Family(Action)
"""The kinds of actions; each is registered where it is declared."""


def _plane(action: Action, *names: str) -> Iterator[tuple[str, str]]:
    for name in names:
        if not isinstance(getattr(action, name), tuple) or len(getattr(action, name)) != 2:
            yield name, "needs two numbers, along x and along y"


@ACTIONS.register
@dataclass(frozen=True)
class Place(Action):
    """Put an object into the world, or replace the object of that name.

    A `RunWarning` names blocks of an `Arena` that overlap from then on.

    Attributes:
        object: name of the object in the world.
        center: x and y of its centre, in the unit of the world.
        size: along x and y.
        color: red, green and blue, 0 to 1.
        height: height of the object, above 0, in the unit of the world; None: the default of the world. Only
            a world whose `place` has this argument, such as `Arena`, accepts it.
    """

    at: At
    object: str
    center: PerAxis
    size: PerAxis
    color: Annotated[PerAxis, Recompile(lower=0.0, upper=1.0)] = (0.72, 0.53, 0.3)
    when: When = ""
    height: float | None = None

    world_method: ClassVar[str] = "place"

    @property
    def world_arguments(self) -> tuple[str, ...]:
        return () if self.height is None else ("height",)

    def validate(self) -> Iterator[tuple[str, str]]:
        yield from _plane(self, "center", "size")
        if self.height is not None and not self.height > 0:
            yield "height", f"is {self.height:g}; expected a number above 0"

    def apply(self, running: RunningTrial) -> None:
        placed: Any = self
        world: Any = changed(self, running.world)
        tall = {} if self.height is None else {"height": self.height}
        world.place(self.object, placed.center, placed.size, placed.color, **tall)
        _check(self.object, running)


@ACTIONS.register
@dataclass(frozen=True)
class Move(Action):
    """Move an object of the world, or carry its vehicle.

    A `RunWarning` names blocks of an `Arena` that overlap from then on.

    Attributes:
        object: name of the object in the world, or of the vehicle.
        center: x and y of its new centre, in the unit of the world; of a vehicle also its heading (rad), if
            that changes, too.
    """

    at: At
    object: str
    center: PerAxis
    when: When = ""

    world_method: ClassVar[str] = "move"

    def validate(self) -> Iterator[tuple[str, str]]:
        if not isinstance(self.center, tuple) or len(self.center) != 3:
            yield from _plane(self, "center")

    def apply(self, running: RunningTrial) -> None:
        moved: Any = self
        changed(self, running.world).move(self.object, moved.center)
        _check(self.object, running)


@ACTIONS.register
@dataclass(frozen=True)
class Remove(Action):
    """Remove an object from the world.

    Attributes:
        object: name of the object in the world.
    """

    at: At
    object: str
    when: When = ""

    world_method: ClassVar[str] = "remove"

    def apply(self, running: RunningTrial) -> None:
        changed(self, running.world).remove(self.object)


@ACTIONS.register
@dataclass(frozen=True)
class Set(Action):
    """Set a parameter of the model.

    Attributes:
        path: the parameter, of an element or of the document.
        value: a number, or another valid value of the parameter, which may be None.
    """

    at: At
    path: Annotated[str, Recompile(names="parameter")]
    value: object | None
    when: When = ""

    def sets(self) -> Iterator[tuple[str, Any]]:
        yield self.path, self.value

    def apply(self, running: RunningTrial) -> None:
        running.set(self.path, self.value)


@ACTIONS.register
@dataclass(frozen=True)
class Ramp(Action):
    """Change a parameter of the model linearly from one value to another, at each step.

    Attributes:
        path: the parameter, a number of an element or of the document.
        end: its value at the end and afterwards.
        lasting: duration in document time.
        start: its value at the beginning; none: its present value.
    """

    at: At
    path: Annotated[str, Recompile(names="parameter")]
    end: float
    lasting: Annotated[float, Recompile("time", role="duration", lower=0.0)]
    start: float | None = None
    when: When = ""

    def sets(self) -> Iterator[tuple[str, Any]]:
        yield from ((self.path, amount) for amount in (self.end, self.start) if amount is not None)

    def apply(self, running: RunningTrial) -> None:
        steps = whole(self.lasting, running.dt, "how long a ramp takes")
        start = float(running.get(self.path)) if self.start is None else self.start
        for k in range(steps + 1):
            share = k / steps if steps else 1.0
            amount = start + share * (self.end - start)
            running.later(k, lambda amount=amount: running.set(self.path, amount))


@ACTIONS.register
@dataclass(frozen=True)
class Push(Action):
    """Add a homogeneous input to a field or node for a while.

    For example a boost that brings a field over its detection instability, or one that makes it forget a
    peak.

    Attributes:
        element: path of the field or node.
        amount: value that is added to its input.
        lasting: duration in document time.
    """

    at: At
    element: Annotated[str, Recompile(names="element")]
    amount: Annotated[float, Recompile("activation")]
    lasting: Annotated[float, Recompile("time", role="duration", lower=0.0)]
    when: When = ""

    def apply(self, running: RunningTrial) -> None:
        if self in running.pushes:  # another one is part of the model, with a window
            path = f"{running.pushes[self]}.amplitude"
            running.set(path, self.amount)
            running.later(
                whole(self.lasting, running.dt, "how long a push lasts"), lambda: running.set(path, 0.0)
            )


@ACTIONS.register
@dataclass(frozen=True)
class Record(Action):
    """Start or stop recording, from the next sampling time on.

    A trial with an action that starts recording is not recorded before that action.

    Attributes:
        on: whether values are recorded from then on.
    """

    at: At
    on: bool = True
    when: When = ""

    def apply(self, running: RunningTrial) -> None:
        running.recording = self.on


@ACTIONS.register
@dataclass(frozen=True)
class Snapshot(Action):
    """Record the values of ports at one moment.

    Attributes:
        label: name of the snapshot in the record.
        of: paths of the ports; the path of a field alone means its activation.
    """

    at: At
    label: str
    of: Annotated[Sequence[str], Recompile(names="port")]
    when: When = ""

    def ports(self) -> Iterator[str]:
        yield from self.of

    def validate(self) -> Iterator[tuple[str, str]]:
        if not self.of:
            yield "of", "names no ports, so there is nothing to keep"

    def apply(self, running: RunningTrial) -> None:
        running.snapshots[self.label] = (running.time, {path: running.read(path) for path in self.of})


@ACTIONS.register
@dataclass(frozen=True)
class Reset(Action):
    """Reset the states of all elements to their values at the start of the trial.

    Time, noise, parameters and the world continue. With `keep_learned` the next phase of a trial starts with
    what the elements have learned: weights, gains and memory traces (`Element.learned_parameters`).

    Attributes:
        keep_learned: whether learned states stay.
    """

    at: At
    when: When = ""
    keep_learned: bool = False

    def apply(self, running: RunningTrial) -> None:
        running.restart(self.keep_learned)


@ACTIONS.register
@dataclass(frozen=True)
class End(Action):
    """End the trial.

    Attributes:
        outcome: the outcome in the row of the trial.
    """

    at: At
    outcome: str
    when: When = ""

    def validate(self) -> Iterator[tuple[str, str]]:
        if not self.outcome:
            yield "outcome", "is empty, which is the outcome of a trial that has not ended"

    def apply(self, running: RunningTrial) -> None:
        running.outcome = self.outcome


def require(actions: Sequence[Action], events: Sequence[str], doc: Document, world: World | None) -> None:
    """Refuse actions that call a method that the world lacks, on elements that the document lacks, or that
    wait for an event that cannot be reported.
    """
    for k, action in enumerate(actions):
        if action.world_method:
            changed(action, world)
        targets(k, actions, doc)
        if action.when and action.when not in events:
            raise UnknownName(
                f"an action waits for the event {action.when!r}, which the experiment does not have",
                fix=did_you_mean(action.when, events),
            )


def targets(number: int, actions: Sequence[Action], doc: Document) -> None:
    """Refuse an action that names an element, port or parameter that the document lacks, or a value that the
    parameter cannot have.

    An earlier action may set the list or the part that holds the parameter. Where the order of the two is not
    known before a trial, the value is not checked.

    Args:
        number: number of the action, from 0.
        actions: all actions of the plan.
        doc: the document before any action.
    """
    action = actions[number]
    for path, value in action.sets():
        around = {k: a for k, a in enumerate(actions) if isinstance(a, Set) and path.startswith(f"{a.path}.")}
        if around and any(a.when or isinstance(a.at, Sequence) for a in (action, *around.values())):
            find.target(doc, path)
            continue
        changed = doc
        for at, k in sorted((a.times[0], k) for k, a in around.items()):
            if (at, k) < (action.times[0], number):
                with contextlib.suppress(DeodarError):  # the problem of that action, not of this one
                    changed = edit.change(changed, around[k].path, around[k].value)
        edit.change(changed, path, value)
    for path in action.ports():
        find.shown(doc, path)
    if isinstance(action, Push):
        find.element(doc, action.element)


def with_pushes(model: Model, actions: Sequence[Action]) -> tuple[Model, dict[Push, str]]:
    """Return the model with a boost for each push, which acts without an intervention in the run, and the
    paths of those whose time is not the same in all trials; without pushes the model itself.
    """
    pushes = list(dict.fromkeys(a for a in actions if isinstance(a, Push)))
    if not pushes:
        return model, {}
    doc, waiting, number = model.document, dict[Push, str](), 0
    for push in pushes:
        target = find.element(doc, push.element)
        while (f"push{number}",) in doc.by_names():
            number += 1
        waits = bool(push.when) or isinstance(push.at, Sequence)
        windows = None if waits else ((push.times[0], push.times[0] + push.lasting),)
        boost = Boost(f"push{number}", amplitude=0.0 if waits else push.amount, windows=windows)  # pyright: ignore[reportArgumentType]
        doc, entry = edit.add(doc, boost)
        doc = edit.connect(doc, entry, "", target, "")
        if waits:
            waiting[push] = entry.path
    staged = Model(document=doc, trusted=model.trusted)
    staged.programs = model.programs  # so that the next trial uses the programs that this one compiles
    return staged, waiting


def _check(name: str, running: RunningTrial) -> None:
    """Warn of an object at a doubtful place, once all actions of this moment are carried out."""

    def check() -> None:
        for problem in () if running.world is None else running.world.validate_object(name):
            warnings.warn(str(problem), RunWarning, stacklevel=2)

    running.later(0, check)


def changed(action: Action, world: World | None) -> World:
    """Return the world that an action changes.

    Raises:
        WorldError: the model has no world, the world lacks the method or an argument of it, or it cannot be
            restored after the trial.
    """
    name = type(action).__name__
    if world is None:
        raise WorldError(
            f"the action {name} needs a world, and none is given",
            fix="Give one, such as world=dd.Arena('blocks')",
        )
    needs = {
        action.world_method: "calls World.{}",
        **dict.fromkeys(("arrangement", "arrange"), "needs World.{}, to restore objects after a trial"),
    }
    stage = type(world.stage)
    kind = stage.__name__
    for method, need in needs.items():
        if getattr(stage, method) is getattr(World, method):
            raise WorldError(
                f"the action {name} {need.format(method)}, which the world {kind} does not have",
                fix="Use a world that has it, such as dd.Arena",
            )
    for argument in action.world_arguments:
        if argument not in inspect.signature(getattr(stage, action.world_method)).parameters:
            raise WorldError(
                f"the action {name} has a {argument}, and {kind}.{action.world_method} has no"
                f" argument {argument!r}",
                fix=f"Leave {argument} out, or use a world that has it, such as dd.Arena",
            )
    return world
