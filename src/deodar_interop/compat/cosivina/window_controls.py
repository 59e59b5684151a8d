"""The controls of a window: they compute and draw nothing, and become pins and presets of a document."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, cast

import numpy as np

from deodar.errors import ParameterError
from deodar_interop.importers.cosivina.controls import (
    ButtonControl,
    Control,
    DropdownControl,
    FilesControl,
    SliderControl,
    SwitchControl,
    Targets,
)

Names = str | Sequence[str]
"""A label or a name of a parameter, or several."""


class WindowControl:
    """A control of a window.

    Attributes:
        control: what it sets.
    """

    def __init__(self, control: Control) -> None:
        self.control = control


class ParameterSlider(WindowControl):
    """A slider for one parameter or several.

    Args:
        controlLabel: text beside it.
        elementLabels, parameterNames: labels of elements, and a parameter of each.
        sliderRange: its ends.
        valueFormat: format of the shown value; not used.
        scalingFactor: factor from the value of a parameter to the position.
        others, named: tool tip and position; not used.
    """

    def __init__(
        self,
        controlLabel: str,
        elementLabels: Names,
        parameterNames: Names,
        sliderRange: Sequence[float],
        valueFormat: str = "%0.1f",
        scalingFactor: float = 1.0,
        *others: Any,
        **named: Any,
    ) -> None:
        ends = np.asarray(sliderRange, dtype=float).reshape(-1)
        if ends.size != 2:
            raise ParameterError(f"expected a range of two numbers, got {ends.size}", where=controlLabel)
        targets = _targets(controlLabel, elementLabels, parameterNames)
        slider = SliderControl(controlLabel, targets, float(ends[0]), float(ends[1]), float(scalingFactor))
        super().__init__(slider)


class ParameterSwitchButton(WindowControl):
    """A button that switches between two sets of values.

    Args:
        controlLabel: text on it.
        elementLabels, parameterNames: labels of elements, and a parameter of each.
        offValues, onValues: a value for each parameter.
        others, named: tool tip, whether it is pressed at the start, and position; not used.
    """

    def __init__(
        self,
        controlLabel: str,
        elementLabels: Names,
        parameterNames: Names,
        offValues: Any,
        onValues: Any,
        *others: Any,
        **named: Any,
    ) -> None:
        targets = _targets(controlLabel, elementLabels, parameterNames)
        off, on = (_values(controlLabel, values, len(targets)) for values in (offValues, onValues))
        super().__init__(SwitchControl(controlLabel, targets, off, on))


class ParameterDropdownSelector(WindowControl):
    """A menu of sets of values.

    Args:
        controlLabel: text beside it.
        elementLabels, parameterNames: labels of elements, and a parameter of each.
        dropdownValues: a value for each choice; for several parameters a list of these.
        dropdownLabels: the names of the choices; without them the values of the first parameter.
        others, named: the choice at the start, which sets nothing, tool tip and position; not used.
    """

    def __init__(
        self,
        controlLabel: str,
        elementLabels: Names,
        parameterNames: Names,
        dropdownValues: Any,
        dropdownLabels: Sequence[str] | None = None,
        *others: Any,
        **named: Any,
    ) -> None:
        targets = _targets(controlLabel, elementLabels, parameterNames)
        listed = isinstance(elementLabels, (list, tuple)) and _is_nested(dropdownValues)
        columns = [_plain(v) for v in (dropdownValues if listed else [dropdownValues])]
        counts = {len(column) for column in columns}
        if len(columns) != len(targets) or len(counts) != 1:
            what = f"{len(columns)} lists of values for {len(targets)} parameters do not fit together"
            raise ParameterError(what, where=controlLabel)
        choices = list(dropdownLabels or [f"{v:g}" for v in columns[0]])
        if len(choices) not in counts:
            what = f"{len(choices)} names and {len(columns[0])} values do not fit together"
            raise ParameterError(what, where=controlLabel)
        rows = tuple(zip(*columns, strict=True))
        super().__init__(DropdownControl(controlLabel, targets, tuple(choices), rows))


class PresetSelector(WindowControl):
    """A menu of parameter files.

    Args:
        controlLabel: text on it.
        controlledObject: the window; not used.
        filePath: folder of the files, or "".
        presetFiles: names of the files.
        presetLabels: the names of the choices; without them the names of the files.
        others, named: tool tip and position; not used.
    """

    def __init__(
        self,
        controlLabel: str,
        controlledObject: Any,
        filePath: str,
        presetFiles: Names,
        presetLabels: Names | None = None,
        *others: Any,
        **named: Any,
    ) -> None:
        names = _listed(presetFiles)
        choices = _listed(presetLabels) if presetLabels else names
        if len(choices) != len(names):
            what = f"{len(choices)} names and {len(names)} files do not fit together"
            raise ParameterError(what, where=controlLabel)
        paths = [f"{filePath.rstrip('/')}/{name}" if filePath else name for name in names]
        super().__init__(FilesControl(controlLabel, tuple(choices), tuple(paths)))


class GlobalControlButton(WindowControl):
    """A button that sets a property of the window, such as `pauseSimulation`.

    Args:
        controlLabel: text on it.
        controlledObject: the window; not used.
        propertyName: the property.
        others, named: its values, whether it is reset, tool tip and position; not used.
    """

    def __init__(
        self, controlLabel: str, controlledObject: Any, propertyName: str, *others: Any, **named: Any
    ) -> None:
        super().__init__(ButtonControl(controlLabel, propertyName))


def _listed(names: Names) -> list[str]:
    return [names] if isinstance(names, str) else list(names)


def _targets(where: str, labels: Names, names: Names) -> Targets:
    elements, parameters = _listed(labels), _listed(names)
    if not elements or len(elements) != len(parameters):
        what = f"{len(elements)} labels and {len(parameters)} parameters do not fit together"
        raise ParameterError(what, where=where)
    return tuple(zip(elements, parameters, strict=True))


def _is_nested(values: Any) -> bool:
    return isinstance(values, (list, tuple)) and all(
        isinstance(v, (list, tuple, np.ndarray)) for v in cast("Sequence[Any]", values)
    )


def _values(where: str, values: Any, count: int) -> tuple[Any, ...]:
    """Return one value for each parameter; a list is one of numbers, or of values of several."""
    found = [values] if np.ndim(values) == 0 else list(values)
    if len(found) != count:
        raise ParameterError(f"{len(found)} values for {count} parameters do not fit together", where=where)
    return tuple(_plain(v) for v in found)


def _plain(value: Any) -> Any:
    """Return a value as numbers and lists."""
    found = np.asarray(value, dtype=float)
    return float(found) if found.ndim == 0 else found.tolist()
