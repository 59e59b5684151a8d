"""The context in which one element is translated, and what stimuli show after the initialisation."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from collections.abc import Set as AbstractSet

import numpy as np

from deodar.importers._beside import Beside
from deodar.importers.report import Line
from deodar.parameters import show
from deodar_interop.importers._axes import LengthAxes
from deodar_interop.importers._element import FileElement
from deodar_interop.importers._foreign import Foreign, FreeNames
from deodar_interop.importers._piece import Dims, Unfit
from deodar_interop.importers.dnf_composer.file import StoredSimulation, number
from deodar_interop.importers.dnf_composer.values import StoredValues, is_plane, samples, size

MOST_VALUES = 20_000_000
"""Largest number of array values in a model, of all elements together (a guess; they take 160 MB)."""


class ValueBudget:
    """The number of array values that a model may still have."""

    def __init__(self) -> None:
        self.values_left = MOST_VALUES

    def take(self, count: int) -> None:
        """Count the values of an array before it is computed.

        Raises:
            Unfit: the arrays of the file have too many values.
        """
        if count > self.values_left:
            raise Unfit(f"its {count} weights exceed the {MOST_VALUES} that are read from a file")
        self.values_left -= count


class StoredElement(FileElement):
    """The context of the translation of one element.

    Attributes:
        simulation: the whole file.
        values: its parameters.
        beside: reads a file in the folder of the simulation.
        budget: limits the arrays of the model.
        start: output after the initialisation: one number, or a function that computes one for each sample.
        levels: values of further components at that time.
        extra: report lines that are not about a parameter.
    """

    def __init__(
        self,
        simulation: StoredSimulation,
        length_axes: LengthAxes,
        element: Foreign,
        components_read: AbstractSet[str],
        names: FreeNames,
        budget: ValueBudget,
        beside: Beside,
    ) -> None:
        super().__init__(element, simulation.step, length_axes, components_read, names)
        self.simulation = simulation
        self.values = StoredValues(element)
        self.budget = budget
        self.beside = beside
        self.start: float | Callable[[], np.ndarray] = 0.0
        self.levels: dict[str, float] = {}
        self.extra: list[Line] = []

    @property
    def plane(self) -> bool:
        """Whether the element has two dimensions."""
        return is_plane(self.element)

    @property
    def counts(self) -> tuple[int, int]:
        """The numbers of samples along y and x."""
        return size(self.element)

    def dims(self) -> Dims:
        """Return the dimensions of the output, and report the parameters that state them.

        Raises:
            Unfit: the file states no valid extent.
        """
        for extent, step in (("x_max", "d_x"), ("y_max", "d_y")):
            has_axis = extent == "x_max" or self.plane
            count = samples(self.element, extent, step)
            if has_axis and count is None:
                extents = [self.element.values.get(name) for name in (extent, step)]
                raise Unfit(f"expected {extent} and {step} above 0, got {show(extents)}")
            self._say_extent(extent, step, count if has_axis else None)
        return self.of(self.counts)

    def source(self) -> Foreign | None:
        """Return the element that the first input reads; None without inputs."""
        return self.simulation.by_label[self.element.sources[0].label] if self.element.sources else None

    def spacing(self, name: str) -> float:
        """Return `d_x` or `d_y`."""
        return number(self.element.values.get(name, 1.0)) or 1.0

    def _say_extent(self, extent: str, step: str, count: int | None) -> None:
        why = "of the second dimension, which a line has not" if count is None else f"as {count} samples"
        length = number(self.element.values.get(extent))
        for name in (extent, step):
            if name not in self.element.values:
                if extent == "x_max":
                    self.values.say(name, "approximated", "it is not in the file; 1 is used")
                continue
            whole = name != extent or length is None or length == int(length)
            self.values.say(
                name,
                "carried" if whole else "approximated",
                why if whole else f"{why}; dnf-composer refuses an extent that is not whole",
            )


ADDING = ("gauss stimulus", "gauss stimulus 2d", "boost stimulus", "boost stimulus 2d")
"""Labels whose inputs are added at the start, and never again."""


def added(elements: Sequence[Foreign], contexts: Mapping[str, StoredElement]) -> dict[str, np.ndarray]:
    """Return for each stimulus with inputs the sum that it adds, one number for each sample.

    All elements are initialised twice, in the order of the file: without inputs, then with them. So a
    stimulus adds the final output of the sources before it, and what those after it show without inputs.
    A sum that exceeds the budget is left out.
    """
    out: dict[str, np.ndarray] = {}
    for e in elements:
        if e.kind not in ADDING or not e.sources:
            continue
        count = math.prod(size(e))
        try:
            contexts[e.label].budget.take(count)
        except Unfit:
            continue
        total = np.zeros(count)
        for s in e.sources:
            b = contexts[s.label]
            level = b.start if s.component == "output" else b.levels.get(s.component, 0.0)
            total += level() if callable(level) else level
            if s.component == "output" and s.label in out:
                total += out[s.label]
        out[e.label] = total
    return out
