"""Sensors and motors as new elements: what the worlds offer that a document can use, with their axes."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Iterator, Mapping
from typing import Any

from deodar import registry
from deodar.elements.world_ports import Motor, Sensor
from deodar.model.document import Document
from deodar.numerics.axes import Axes, Axis, shape
from deodar.worlds._base import Signal, World
from deodar_studio.messages.to_page import SignalView, WorldSignals


def world_signals(title: str, world: World | type[World], doc: Document) -> WorldSignals:
    """Return what a world offers a document, without motors that the document drives already, and without
    sensors whose axes nothing states.
    """
    present = driven(doc)
    views = [view for view in _views(world) if view.kind != Motor.__name__ or view.name not in present]
    return WorldSignals(world=title, signals=views)


def driven(doc: Document) -> set[str]:
    """Return the names of the motors that a document drives."""
    return {e.element.motor for e in doc.entries if isinstance(e.element, Motor)}


def of_kind(kind: str, world: World | type[World]) -> Mapping[str, Signal]:
    """Return the signals of a world that elements of a kind read or drive, by name; none for other kinds."""
    return {Sensor.__name__: world.sensors, Motor.__name__: world.motors}.get(kind, {})


def values(kind: str, name: str, world: World | type[World]) -> dict[str, Any] | None:
    """Return the values of an element for a signal of a world, axes by their properties; None: its axes are
    not known.
    """
    axes = _axes(kind, name, world)
    key = "sensor" if kind == Sensor.__name__ else "motor"
    return None if axes is None else {key: name, "axes": [dc.asdict(axis) for axis in axes]}


def _views(world: World | type[World]) -> Iterator[SignalView]:
    for kind in (Sensor.__name__, Motor.__name__):
        for name, signal in of_kind(kind, world).items():
            stated = values(kind, name, world)
            if stated is not None:
                title = _title(name, signal, [axis["samples"] for axis in stated["axes"]])
                yield SignalView(kind=kind, name=name, title=title, meaning=signal.meaning, values=stated)


def _title(name: str, signal: Signal, samples: list[int]) -> str:
    """Return `Infrared, 8 samples`, or for a motor that moves a part of this name `Left wheel`."""
    part = signal.meaning.partition(",")[0].rpartition(" of the ")[2]
    words = part if not samples and name in part.split() else name.replace("_", " ")
    title = words[:1].upper() + words[1:]
    return f"{title}, {' x '.join(map(str, samples))} samples" if samples else title


def _axes(kind: str, name: str, world: World | type[World]) -> Axes | None:
    """Return axes over which a signal can be read or driven: those of an example, or plain ones of its
    shape.
    """
    samples = of_kind(kind, world)[name].shape
    cls = type(world) if isinstance(world, World) else world
    example = _example_axes(name, cls) if kind == Sensor.__name__ else None
    if samples is None or (example is not None and shape(example) == samples):
        return example
    names = ["of"] if len(samples) == 1 else [f"of{n}" for n in range(1, len(samples) + 1)]
    pairs = zip(names, samples, strict=True)
    return tuple(Axis(a, 0, max(n - 1, 1), samples=n, periodic=n == 1) for a, n in pairs)


def _example_axes(name: str, cls: type[World]) -> Axes | None:
    """Return the axes of an example of a class with a sensor, or of another class with that sensor."""
    kinds: Mapping[str, type[World]] = registry.kinds("worlds")
    for kind in (cls, *kinds.values()):
        if kind.stands_in and name in kind.sensors:
            return kind.example_axes(name)
    return None
