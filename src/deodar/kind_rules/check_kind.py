"""The rules that every kind keeps, and `dd.check_kind`, which judges one class by them."""

from __future__ import annotations

import contextlib
import dataclasses as dc
import threading
import warnings
from collections.abc import Callable, Generator, Iterator, Sequence
from typing import cast

import jax
import numpy as np

from deodar import codec, registry
from deodar.batch.simulate import simulate
from deodar.element import Element
from deodar.errors import Problem, RunWarning, problems_of, show
from deodar.experiments.measures import BaseMeasure
from deodar.kind_errors import errors_of_kind, misshapen, position
from deodar.kind_rules.example_model import NAME, AnyWorld, another_values, around, holding, node
from deodar.leaves import leaves, resting
from deodar.model import document_files
from deodar.model.kind_contract import one_copy
from deodar.model.model import Model
from deodar.numerics.axes import Axis, shape
from deodar.numerics.kernels._base import Kernel
from deodar.numerics.sigmoids import SigmoidFunction
from deodar.session.session import Session
from deodar.worlds._base import World
from deodar.worlds._pure import PureWorld

STEPS = 1000
"""Steps after which values have to be finite."""

TRIALS = 100
"""Copies of the batch that is compared with a single run."""

PRECISIONS = ("float32", "float64")

KindRule = Callable[[Element], Iterator[str]]
"""Yields what an element, or a part inside it, does against a rule."""


def check_kind(kind: type) -> list[Problem]:
    """Judge a class of your own by the rules that every kind of deodar keeps.

    The rules of elements, couplings, kernels and sigmoids, on the instance that the class method `example`
    returns: it is registered, its methods return the declared shapes in both precisions, values stay finite
    for 1,000 steps, the first of 100 trials equals a single run, a document with it is read as it was
    written, and a changed live parameter compiles nothing and acts as the same value does from the start.
    Readings of a world have the declared shapes, are finite and are repeated after a reset, and its
    description is JSON. A measure returns numbers.

    Args:
        kind: a class derived from `dd.Element`, `dd.Coupling`, `dd.Kernel`, `dd.SigmoidFunction`, `dd.World`
            or `dd.BaseMeasure`.

    Returns:
        The problems; an empty list: the class keeps the rules. Nothing is raised.
    """
    judged: list[Problem] = []
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RunWarning)  # of what becomes a problem
        try:
            with errors_of_kind(kind):
                judged += _judged(kind)
        except Exception as error:  # code of a user may raise any exception
            judged += problems_of(error)
    return [dc.replace(p, where=p.where.replace(NAME, _name(kind), 1) or _name(kind)) for p in judged]


def _name(kind: object) -> str:
    return getattr(kind, "__name__", "check_kind")


def _judged(kind: type) -> Iterator[Problem]:
    families = (Element, Kernel, SigmoidFunction, World, BaseMeasure)
    if not isinstance(kind, type) or not issubclass(kind, families):
        expected = ", ".join(f"dd.{family.__name__}" for family in families)
        yield Problem("", f"expected a class derived from {expected}, got {show(kind)}")
        return
    if not issubclass(kind, BaseMeasure) and not hasattr(kind, "example"):
        fix = "Write: @classmethod, def example(cls), which returns an instance"
        yield Problem("", f"{position(kind)} has no class method example", fix)
        return
    if issubclass(kind, BaseMeasure):
        yield from _all(measured(kind))
        return
    if registry.registered(kind.__name__) is not kind:
        fix = "Write @dd.register above the class, above @dataclass(frozen=True)"
        yield Problem("", f"{position(kind)} is not registered, so that no document can name it", fix)
        return
    if issubclass(kind, World):
        yield from _all(world_readings(kind))
        return
    element = holding(kind.example())
    resolved = node(around(element))
    ports = resolved.ins, resolved.outs
    contract = [p for precision in PRECISIONS for p in one_copy(element, *ports, precision)]
    yield from contract[:1]
    for rule in () if contract else RULES:
        yield from _all(rule(element))


def _all(faults: Iterator[str]) -> Iterator[Problem]:
    yield from (Problem("", fault) for fault in faults)


# -------------------------------------------------------------- elements, couplings, kernels and sigmoids


def finite_alone_and_in_trials(element: Element) -> Iterator[str]:
    """Values are finite for 1,000 steps, alone and in 100 trials, of which the first equals the run alone."""
    model = around(element, noisy=True)
    outs = node(model).outs
    ports = [f"{NAME}.{port}" for port in outs]
    batch, alone = (
        simulate(
            model, STEPS * 0.5, record=ports, trials=trials, every=STEPS * 0.25, dt=0.5, world=AnyWorld()
        )
        for trials in (TRIALS, None)
    )
    for port, axes in zip(ports, outs.values(), strict=True):
        values, single = batch[port].values, alone[port].values
        if values.shape != (TRIALS, 3, *shape(axes)):
            yield f"the record of {port} has the shape {list(values.shape)}"
        if not np.isfinite(values).all() or not np.isfinite(single).all():
            yield f"{port} is not finite in a run of {STEPS} steps"
        # the second of two equal axes has the port's path in its name
        if [str(d).rsplit(".", 1)[-1] for d in batch[port].dims[2:]] != [a.name for a in axes]:
            yield f"the record of {port} has the axes {', '.join(map(str, batch[port].dims[2:]))}"
        elif not all(np.array_equal(batch[axis.name].values, axis.points) for axis in axes):
            yield f"the record of {port} has other positions than its axes"
        # the same noise; other programs add in another order
        elif not np.allclose(values[0], single, rtol=2e-3, atol=2e-3 * max(1.0, abs(single).max())):
            yield f"{port} of trial 0 differs between a run alone and one of {TRIALS} trials"


def read_as_written(element: Element) -> Iterator[str]:
    """A document is equal after it is written and read, with the defaults and with other values."""
    model, other_values = around(element, every=2), around(element)
    for path, number in another_values(element):
        other_values.set(f"{NAME}.{path}", number)
    for document in (model.document, other_values.document):
        text, arrays = document_files.dumps(document, "arrays")
        back = document_files.loads(text.encode(), lambda _, arrays=arrays: arrays)
        if back != document or document_files.dumps(back, "arrays")[0] != text:
            yield "a document with it differs after it is written and read"
            return


def live_without_compiling(element: Element) -> Iterator[str]:
    """A changed parameter has the cost that it declares, and acts as the same value does from the start."""
    model = around(element)
    ports = [f"{NAME}.{port}" for port in node(model).outs]
    running = Session(model, world=AnyWorld())
    for path, number in another_values(element):  # leaving a neutral value makes another program, once
        if path in resting(element):
            running.set(f"{NAME}.{path}", number)
    before = courses(running, ports)
    traced = _traced(model)
    present = next(e.element for e in running.document.entries if e.path == NAME)
    costs = {path: "rebuild" if p.form == "array" else p.cost for path, _, p in leaves(present)}
    with compilations() as events:
        for path, number in another_values(present):
            if (cost := running.set(f"{NAME}.{path}", number)) != costs[path]:
                yield f"a change of {path} is declared {costs[path]}, and is {cost}"
        changed = courses(running, ports)
    if events or _traced(model) != traced:
        yield "a changed live parameter compiles another program"
    if costs and all(np.array_equal(a, b) for a, b in zip(before, changed, strict=True)):
        yield f"no output changes with its parameters ({', '.join(costs)})"
    for path, _ in another_values(element):
        model.set(f"{NAME}.{path}", running.get(f"{NAME}.{path}"))
    fresh = courses(Session(model, world=AnyWorld()), ports)
    if not all(np.array_equal(a, b) for a, b in zip(changed, fresh, strict=True)):
        yield "a parameter that is changed during a run acts otherwise than the same value from the start"


def courses(running: Session, ports: Sequence[str]) -> list[np.ndarray]:
    """Return the values of ports at the start, after five steps, and after the sources are switched off."""
    running.reset()
    seen = [running.read(port) for port in ports]
    running.step(5)
    seen += [running.read(port) for port in ports]
    sources = [f'"{e.path}".amplitude' for e in running.document.entries if e.path.startswith("to ")]
    before = [running.get(path) for path in sources]
    for path in sources:
        running.set(path, 0.0)
    running.step(2)
    seen += [running.read(port) for port in ports]
    for path, amplitude in zip(sources, before, strict=True):
        running.set(path, amplitude)
    return seen


@contextlib.contextmanager
def compilations() -> Generator[list[str]]:
    """Collect the events of JAX in this thread that belong to tracing and compiling."""
    events, thread = list[str](), threading.get_ident()

    def listen(event: str, duration_secs: float, **_: str | int) -> None:
        if threading.get_ident() == thread and any(w in event for w in ("compile", "trace", "lower")):
            events.append(event)

    jax.monitoring.register_event_duration_secs_listener(listen)
    try:
        yield events
    finally:
        jax.monitoring.unregister_event_duration_listener(listen)


def _traced(model: Model) -> int:
    return sum(program.traced for program in model.programs.values())


RULES: tuple[KindRule, ...] = (finite_alone_and_in_trials, read_as_written, live_without_compiling)
"""The rules of elements and of parts inside them."""


# --------------------------------------------------------------------------------------- worlds and measures


def world_readings(kind: type[World]) -> Iterator[str]:
    """Readings have the declared shapes, are finite, and are repeated after a reset; the description is
    JSON.
    """
    world = next(kind.examples())
    for sensor, signal in world.sensors.items():
        if issubclass(kind, PureWorld) and not signal.each:
            yield f"{position(kind)} reads the sensor {sensor!r} for each copy; declare it with each=True"
            continue
        axes = kind.example_axes(sensor)
        world.reset(3, [0, 5])
        reading = world.sense(sensor, axes, 0.0)
        expected = ((2,) if signal.each else ()) + shape(axes)
        if fault := misshapen(np.asarray(reading), expected):
            yield f"{position(kind)} reads {fault} for the sensor {sensor!r}"
        elif not np.isfinite(reading).all():
            yield f"{position(kind)} reads values that are not finite for the sensor {sensor!r}"
        elif world.repeatable:
            world.reset(3, [0, 5])
            if not np.array_equal(world.sense(sensor, axes, 0.0), reading):
                yield f"{position(kind)} reads other values for the sensor {sensor!r} after a reset"
        if signal.shape is not None and shape(axes) != signal.shape:
            yield f"{position(kind)} has axes of another shape in its example for the sensor {sensor!r}"
    description = world.describe()
    try:
        same = codec.parse(codec.text(description)) == description
    except (TypeError, ValueError):
        same = False
    if not same or description.get("world") != kind.__name__:
        yield f"{position(kind, 'describe')} returns no plain data with its name under 'world'"


def measured(kind: type[BaseMeasure]) -> Iterator[str]:
    """The value of a field with one and two axes is a number, several numbers, or None."""
    x, y = Axis("x", 0, 20, samples=21), Axis("y", 0, 8, samples=9)
    for axes in ((x,), (x, y)):
        samples = np.random.default_rng(0).normal(size=shape(axes))
        untouched = samples.copy()
        measure = cast("BaseMeasure", kind(name="measure", of="u.activation"))  # type: ignore[call-arg]
        number = measure.value(samples, axes)
        if number is not None and np.asarray(number).dtype.kind not in "biuf":
            yield f"{position(kind, 'value')} returns {show(number)}; expected a number, several, or None"
        if not np.array_equal(samples, untouched):
            yield f"{position(kind, 'value')} changes the samples that it gets"
