"""Sensors and motors as new elements: what the worlds offer that a document can use, with their axes."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Collection, Iterator, Mapping
from typing import Any

from deodar import registry
from deodar.elements.world_ports import Motor, Sensor
from deodar.errors import AxesError
from deodar.model.document import Document
from deodar.numerics.axes import Axes, Axis, shape
from deodar.worlds._base import Signal, World
from deodar_studio.messages.to_page import SignalView, WorldSignals


class ExampleAxes:
    """The axes of the sensors of examples; each example is asked once."""

    def __init__(self) -> None:
        self._axes: dict[tuple[str, type[World]], Axes | None] = {}

    def of(self, sensor: str, cls: type[World]) -> Axes | None:
        """Return the axes of an example of a class with a sensor, or of another class with that sensor.

        None: no example states axes.
        """
        if (sensor, cls) not in self._axes:
            self._axes[sensor, cls] = _example_axes(sensor, cls)
        return self._axes[sensor, cls]


def world_signals(
    title: str, world: World | type[World], motors: Collection[str], examples: ExampleAxes
) -> WorldSignals:
    """Return what a world offers a document that drives some motors, without these motors, and without
    sensors whose axes nothing states.
    """
    views = [
        view for view in _views(world, examples) if view.kind != Motor.__name__ or view.name not in motors
    ]
    return WorldSignals(world=title, signals=views)


def driven(doc: Document) -> set[str]:
    """Return the names of the motors that a document drives."""
    return {e.element.motor for e in doc.entries if isinstance(e.element, Motor)}


def of_kind(kind: str, world: World | type[World]) -> Mapping[str, Signal]:
    """Return the signals of a world that elements of a kind read or drive, by name; none for other kinds."""
    return {Sensor.__name__: world.sensors, Motor.__name__: world.motors}.get(kind, {})


def values(kind: str, name: str, world: World | type[World], examples: ExampleAxes) -> dict[str, Any] | None:
    """Return the values of an element for a signal of a world, axes by their properties; None: its axes are
    not known.
    """
    its_axes = axes(kind, name, world, examples)
    key = "sensor" if kind == Sensor.__name__ else "motor"
    return None if its_axes is None else {key: name, "axes": [dc.asdict(axis) for axis in its_axes]}


def _views(world: World | type[World], examples: ExampleAxes) -> Iterator[SignalView]:
    for kind in (Sensor.__name__, Motor.__name__):
        for name, signal in of_kind(kind, world).items():
            stated = values(kind, name, world, examples)
            if stated is not None:
                title = _title(name, signal, [axis["samples"] for axis in stated["axes"]])
                yield SignalView(kind=kind, name=name, title=title, meaning=signal.meaning, values=stated)


def _title(name: str, signal: Signal, samples: list[int]) -> str:
    """Return `Infrared, 8 samples`, or for a motor that moves a part of this name `Left wheel`."""
    part = signal.meaning.partition(",")[0].rpartition(" of the ")[2]
    words = part if not samples and name in part.split() else name.replace("_", " ")
    title = words[:1].upper() + words[1:]
    return f"{title}, {' x '.join(map(str, samples))} samples" if samples else title


def axes(kind: str, name: str, world: World | type[World], examples: ExampleAxes) -> Axes | None:
    """Return axes over which a signal can be read or driven: those of an example, or plain ones of its
    shape; None if there are none.
    """
    samples = of_kind(kind, world)[name].shape
    cls = type(world) if isinstance(world, World) else world
    example = examples.of(name, cls) if kind == Sensor.__name__ else None
    if samples is None or (example is not None and shape(example) == samples):
        return example
    names = ["of"] if len(samples) == 1 else [f"of{n}" for n in range(1, len(samples) + 1)]
    pairs = zip(names, samples, strict=True)
    try:
        return tuple(Axis(a, 0, max(n - 1, 1), samples=n, periodic=n == 1) for a, n in pairs)
    except AxesError:
        return None


def _example_axes(sensor: str, cls: type[World]) -> Axes | None:
    for kind in _with_examples(cls):
        if kind.stands_in and sensor in kind.sensors:
            try:
                return kind.example_axes(sensor)
            except Exception:  # a world of a user may raise any, or define none
                return None
    return None


def _with_examples(cls: type[World]) -> Iterator[type[World]]:
    """Yield a class and then all others; these are looked up only if the class does not do."""
    yield cls
    yield from registry.kinds("worlds").values()
