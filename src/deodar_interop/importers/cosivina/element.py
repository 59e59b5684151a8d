"""The context in which one element of a file is translated."""

from __future__ import annotations

from collections.abc import Set as AbstractSet

from deodar_interop.importers._axes import LengthAxes
from deodar_interop.importers._element import FileElement
from deodar_interop.importers._foreign import Foreign, FreeNames
from deodar_interop.importers._piece import Dims
from deodar_interop.importers.cosivina.file import Simulator
from deodar_interop.importers.cosivina.values import Values, output_size


class SourceElement(FileElement):
    """The context of the translation of one element: its parameters, and the known errors that it touches."""

    def __init__(
        self,
        simulator: Simulator,
        length_axes: LengthAxes,
        element: Foreign,
        components_read: AbstractSet[str],
        names: FreeNames,
        bugs: bool,
    ) -> None:
        super().__init__(element, simulator.step, length_axes, components_read, names)
        self.simulator = simulator
        self.values = Values(element.values, element.label)
        self.reproduce = bugs

    def dims(self, component: str = "") -> Dims:
        """Return the dimensions of an output."""
        return self.of(output_size(self.element, component))

    def sized(self) -> Dims:
        """Return the dimensions of the output, and report the parameter that states them."""
        self.values.size()
        return self.dims()

    def source(self, k: int) -> Dims | None:
        """Return the dimensions of an input, as its source declares them; None without this input."""
        if k >= len(self.element.sources):
            return None
        s = self.element.sources[k]
        element = self.simulator.by_label.get(s.label)
        passed: set[str] = set()
        while (
            element is not None
            and element.kind == "HebbianConnection"
            and len(element.sources) > 1
            and element.label not in passed
        ):
            passed.add(element.label)  # its size is that of its second input, and is not in the file
            s = element.sources[1]
            element = self.simulator.by_label.get(s.label)
        return None if element is None else self.of(output_size(element, s.component))

    def bug(self, error: str) -> bool:
        """Return whether to reproduce a known error of cosivina that this element touches."""
        self.met.append(f"{self.label}: {error}; {'reproduced' if self.reproduce else 'corrected'}")
        return self.reproduce
