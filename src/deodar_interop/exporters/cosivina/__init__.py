"""cosivina, the MATLAB toolbox and its Python port: JSON files of simulators."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from deodar.exporters.exported import Exported
    from deodar.model.model import Model

NAME = "cosivina"
ENDING = ".json"
HELP = "a simulator of cosivina"


def write(model: Model, name: str) -> Exported:
    """Return the file of a simulator, and the report."""
    # start-up time: this brings JAX
    from deodar_interop.exporters.cosivina import simulator_file

    return simulator_file.write(model, name)
