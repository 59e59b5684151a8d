"""The controls of a script, from the calls of their classes."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from deodar_interop.importers.cosivina.controls import (
    ButtonControl,
    Control,
    DropdownControl,
    FilesControl,
    LostControl,
    SliderControl,
    SwitchControl,
    Targets,
)
from deodar_interop.importers.cosivina.launchers import matlab_values
from deodar_interop.importers.cosivina.launchers.builders import argument
from deodar_interop.importers.cosivina.launchers.expressions import NotRead
from deodar_interop.importers.cosivina.launchers.matlab_functions import shown
from deodar_interop.importers.cosivina.launchers.objects import ClassCall, MissingValue
from deodar_interop.importers.cosivina.plots import PlotRequest

ControlArguments = Sequence[Any]


def control_of(call: ClassCall) -> Control:
    """Return the control of a call of its class."""
    first = call.arguments[0] if call.arguments else None
    label = matlab_values.string(first) if isinstance(first, np.ndarray) and _is_line(first) else call.name
    if call.name not in CONTROLS:
        return LostControl(label, call.name, f"line {call.line}: deodar has no such control")
    try:
        return CONTROLS[call.name](label, call.arguments)
    except NotRead as error:
        return LostControl(label, call.name, f"line {call.line}: {error}")


def plot_of(call: ClassCall) -> PlotRequest:
    """Return the visualization of a call of its class."""
    labels, components = (call.arguments[k] if k < len(call.arguments) else None for k in (0, 1))
    try:
        ports = tuple(zip(matlab_values.names_of(labels), matlab_values.names_of(components), strict=False))
    except NotRead:
        ports = ()
    return PlotRequest(call.name, ports, f"line {call.line}")


def _is_line(value: np.ndarray) -> bool:
    return matlab_values.is_text(value) and value.shape[0] == 1


def _targets(arguments: ControlArguments) -> Targets:
    labels, names = (matlab_values.names_of(argument(arguments, k)) for k in (1, 2))
    if not labels or len(labels) != len(names):
        raise NotRead(f"{len(labels)} labels and {len(names)} parameters do not fit together")
    return tuple(zip(labels, names, strict=True))


def _slider(label: str, arguments: ControlArguments) -> Control:
    ends = matlab_values.numbers(argument(arguments, 3)).reshape(-1)
    if ends.size != 2:
        raise NotRead(f"its range has {ends.size} numbers")
    factor = argument(arguments, 5)
    return SliderControl(
        label,
        _targets(arguments),
        float(ends[0]),
        float(ends[1]),
        matlab_values.real(factor) if factor.size else 1.0,
    )


def _switch(label: str, arguments: ControlArguments) -> Control:
    targets = _targets(arguments)
    off, on = (_values(argument(arguments, k), len(targets)) for k in (3, 4))
    return SwitchControl(label, targets, off, on)


def _values(value: Any, count: int) -> tuple[Any, ...]:
    """Return one value for each parameter; None for one that is not known."""
    if isinstance(value, np.ndarray) and value.size != count:
        raise NotRead(f"it has {value.size} values for {count} parameters")
    if matlab_values.is_cells(value):
        return tuple(_value(cell) for cell in value.reshape(-1, order="F"))
    return tuple(float(v) for v in matlab_values.numbers(value).reshape(-1, order="F"))


def _value(cell: Any) -> Any:
    if isinstance(cell, MissingValue):
        return None
    if matlab_values.is_text(cell):
        return matlab_values.string(cell)
    array = matlab_values.numbers(cell)
    return float(array.reshape(-1)[0]) if array.size == 1 else array.tolist()


def _dropdown(label: str, arguments: ControlArguments) -> Control:
    targets = _targets(arguments)
    lists = argument(arguments, 3)
    value_lists = list(lists.reshape(-1, order="F")) if matlab_values.is_cells(lists) else [lists]
    if len(value_lists) != len(targets):
        raise NotRead(f"it has {len(value_lists)} lists of values for {len(targets)} parameters")
    columns = [_column(values) for values in value_lists]
    if not columns[0] or any(len(column) != len(columns[0]) for column in columns):
        raise NotRead("its lists of values have different lengths")
    labels = argument(arguments, 4)
    choices = matlab_values.names_of(labels) if labels.size else [_shown(v) for v in columns[0]]
    if len(choices) != len(columns[0]):
        raise NotRead(f"it has {len(choices)} names for {len(columns[0])} values")
    return DropdownControl(label, targets, tuple(choices), tuple(zip(*columns, strict=True)))


def _column(values: Any) -> list[Any]:
    if isinstance(values, MissingValue):
        raise NotRead(values.why)
    if matlab_values.is_cells(values):
        return [_value(cell) for cell in values.reshape(-1, order="F")]
    return [float(v) for v in matlab_values.numbers(values).reshape(-1, order="F")]


def _shown(value: Any) -> str:
    return shown(value) if isinstance(value, float) else str(value)


def _files(label: str, arguments: ControlArguments) -> Control:
    folder, files, labels = (argument(arguments, k) for k in (2, 3, 4))
    names = matlab_values.names_of(files)
    choices = matlab_values.names_of(labels) if labels.size else names
    if not names or len(names) != len(choices):
        raise NotRead(f"it has {len(choices)} names for {len(names)} files")
    before = matlab_values.string(folder).rstrip("/\\") if folder.size else ""
    paths = [f"{before}/{name}" if before else name for name in names]
    return FilesControl(label, tuple(choices), tuple(paths))


def _button(label: str, arguments: ControlArguments) -> Control:
    return ButtonControl(label, matlab_values.string(argument(arguments, 2)))


CONTROLS: Mapping[str, Callable[[str, ControlArguments], Control]] = {
    "ParameterSlider": _slider,
    "ParameterSwitchButton": _switch,
    "ParameterDropdownSelector": _dropdown,
    "PresetSelector": _files,
    "GlobalControlButton": _button,
}
"""The controls that are read, by their classes."""
