"""The controls of a window of cosivina: sliders, switches, dropdown menus, files of presets, buttons."""

from __future__ import annotations

import dataclasses as dc
from typing import Any, TypeAlias

Targets: TypeAlias = tuple[tuple[str, str], ...]
"""Label of an element and name of its parameter, for each parameter that a control sets."""


@dc.dataclass(frozen=True)
class SliderControl:
    """A slider: its position is `factor` times the value of the first parameter.

    Attributes:
        label: text beside it.
        targets: the parameters; all get the same value.
        lower, upper: its range.
        factor: factor from the value of a parameter to the position.
    """

    label: str
    targets: Targets
    lower: float
    upper: float
    factor: float = 1.0

    kind = "ParameterSlider"


@dc.dataclass(frozen=True)
class SwitchControl:
    """A button that switches between two sets of values, one value for each parameter."""

    label: str
    targets: Targets
    off: tuple[Any, ...]
    on: tuple[Any, ...]

    kind = "ParameterSwitchButton"


@dc.dataclass(frozen=True)
class DropdownControl:
    """A menu of sets of values: the names of the choices, and for each a value for each parameter."""

    label: str
    targets: Targets
    choices: tuple[str, ...]
    values: tuple[tuple[Any, ...], ...]

    kind = "ParameterDropdownSelector"


@dc.dataclass(frozen=True)
class FilesControl:
    """A menu of parameter files: the names of the choices, and the file of each."""

    label: str
    choices: tuple[str, ...]
    files: tuple[str, ...]

    kind = "PresetSelector"


@dc.dataclass(frozen=True)
class ButtonControl:
    """A button that sets a property of the window, such as `pauseSimulation`."""

    label: str
    member: str

    kind = "GlobalControlButton"


@dc.dataclass(frozen=True)
class LostControl:
    """A control that is not read, and why."""

    label: str
    kind: str
    why: str


Control: TypeAlias = (
    SliderControl | SwitchControl | DropdownControl | FilesControl | ButtonControl | LostControl
)

BUTTONS = {
    "pauseSimulation": "Pause in the studio",
    "quitSimulation": "the studio is closed as any page",
    "resetSimulation": "Reset in the studio",
    "saveParameters": "Save, and Save preset in the studio",
    "loadParameters": "Apply values of a file in the studio",
    "paramPanelRequest": "the inspector of the studio",
}
"""What the studio has in place of the buttons of a window."""
