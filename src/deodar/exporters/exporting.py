"""Write a model as a file of another tool."""

from __future__ import annotations

from pathlib import Path

from deodar.errors import UnknownName, did_you_mean
from deodar.exporters import cosivina, nir
from deodar.exporters.exported import Exported
from deodar.importers.report import ImportReport
from deodar.model import output
from deodar.model.model import Model
from deodar.neuromorphic.prepare import SpikingOptions

TOOLS = {cosivina.NAME: cosivina, nir.NAME: nir}
"""The exporters by name: each has `NAME`, `ENDING` and `write(model, name) -> Exported`."""


def export(
    model: Model,
    path: str | Path,
    to: str = "cosivina",
    force: bool = False,
    spiking: SpikingOptions | None = None,
) -> ImportReport:
    """Write a model as a file of another tool (cosivina, nir); the report lists what was not carried.

    The file computes what the model computes, where the report says `carried`. A model that `load` made of a
    file of cosivina is the same model after it was exported and loaded again. A file of NIR is a network of
    spiking neurons, for one step.

    Args:
        model: the model; it must be free of problems.
        path: the file to write, `.json` for cosivina, `.nir` for NIR.
        to: name of the tool.
        force: whether to replace an existing file.
        spiking: neurons, step and chip of a file of NIR.

    Returns:
        The report: a verdict for each element, parameter and connection of the model.

    Raises:
        UnknownName: deodar has no exporter of that name.
        ModelError: the model has problems; the error lists all.
        OutputExists: the file exists, and `force` is not given.
        OutputError: it cannot be written.
    """
    place = output.claim(path, force)
    made = exported(model, place.name, to, spiking)
    output.write(place, made.content)
    return made.report


def exported(
    model: Model, name: str, to: str = "cosivina", spiking: SpikingOptions | None = None
) -> Exported:
    """Return the content of the file of another tool, and the report, without writing it.

    Raises:
        UnknownName: deodar has no exporter of that name.
        ModelError: the model has problems; the error lists all.
    """
    if to not in TOOLS:
        raise UnknownName(f"there is no exporter {to!r}", fix=did_you_mean(to, TOOLS))
    return nir.write(model, name, spiking) if to == nir.NAME else TOOLS[to].write(model, name)
