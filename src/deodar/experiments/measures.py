"""Measures of a trial: a value at its end, or at an event."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Annotated

import numpy as np

from deodar.experiments.observable import PLACE, REDUCES, Observable, position
from deodar.extensions import Extensions
from deodar.numerics.axes import Axes
from deodar.parameters import Part, PerAxis, Recompile
from deodar.plugins import Plugin


class BaseMeasure(Part):
    """Base of measures: one number per trial, or several.

    A custom measure is a frozen dataclass that declares `name`, `of` and, if it may be taken at an event,
    `when`, and that overrides `value`. All samples of the port are copied each time the trial is sampled, and
    kept at the time of the measure.

    Attributes:
        name: name of its column in the results.
        of: path of a port, or name of a sensor of the world; the path of a field alone means its activation.
        when: the event at whose time it is taken; empty: when the trial ends.
    """

    name: str
    of: str
    when: str = ""

    @property
    def view(self) -> Observable:
        """The sampled values: all samples of `of`."""
        return Observable(self.of)

    def value(self, samples: np.ndarray, axes: Axes | None) -> float | Sequence[float] | np.ndarray | None:
        """Return the measure.

        Args:
            samples: the samples of the view at the time of the measure.
            axes: the axes of the port; None for a sensor.

        Returns:
            A number, several numbers, or None if the value is undefined (NaN in the table).
        """
        return samples


@dataclass(frozen=True)
class Measure(BaseMeasure):
    """One number per trial, or one per axis.

    Attributes:
        reduce: max, min, mean or sum of an array, or `place`: the position of its highest peak in axis units,
            interpolated between samples as `dd.peaks` does. A trial without a peak has no position (NaN in
            the table).
        near: only samples around this position, in axis units, one number or one per axis; none: all.
        radius: distance from that position, along every axis.
        threshold: samples above it belong to the peak, for `place`; 0 fits an activation, 0.5 an output.
    """

    name: str
    of: Annotated[str, Recompile(names="port")]
    reduce: Annotated[str, Recompile(choices=(*REDUCES, PLACE))] = "max"
    when: Annotated[str, Recompile(names="event")] = ""
    near: Annotated[PerAxis | None, Recompile("axis")] = None
    radius: Annotated[float, Recompile("axis", lower=0.0)] = 0.0
    threshold: Annotated[float, Recompile("activation")] = 0.0

    @property
    def view(self) -> Observable:
        """The sampled values, or their reduction."""
        return Observable(self.of, self.reduce, position(self.near), self.radius, threshold=self.threshold)

    def validate(self) -> Iterator[tuple[str, str]]:
        if self.near is not None and self.radius == 0.0:
            yield "radius", "is 0, and a place alone contains no sample; state a radius"
        if self.reduce != PLACE and self.threshold:
            yield "threshold", f"is {self.threshold:g}, and only reduce='place' has a threshold"

    def value(self, samples: np.ndarray, axes: Axes | None) -> np.ndarray | None:
        """Return the sampled reduction; None if it is the position of a peak and no peak exists."""
        return None if self.reduce == PLACE and bool(np.isnan(samples).any()) else samples


def _own() -> dict[str, type[BaseMeasure]]:
    return {"Measure": Measure}


def _problem(plugin: Plugin, plugin_object: object) -> str:
    """Return the problem of an object that a package names as a measure."""
    named = f"names {plugin.entry.value} as {plugin.name!r}, which "
    if not isinstance(plugin_object, type) or plugin_object.__name__ != plugin.name:
        return f"{named}is not a class of that name"
    return "" if issubclass(plugin_object, BaseMeasure) else f"{named}does not derive from dd.BaseMeasure"


MEASURES: Extensions[type[BaseMeasure]] = Extensions("measures", "measure", _own, _problem)
"""The kinds of measures, including those of installed packages."""
