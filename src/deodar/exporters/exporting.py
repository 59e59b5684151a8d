"""Write a model as a file of another tool."""

from __future__ import annotations

import inspect
from pathlib import Path
from typing import Any

from deodar.errors import UnknownName, did_you_mean
from deodar.exporters.exported import Exported
from deodar.exporters.tools import EXPORTERS, of_models
from deodar.importers.report import ImportReport
from deodar.model import output
from deodar.model.model import Model


def export(
    model: Model,
    path: str | Path,
    to: str | None = None,
    force: bool = False,
    **options: Any,
) -> ImportReport:
    """Write a model as a file of another tool; the report lists what was not carried.

    The file computes what the model computes, where the report says `carried`. A model that `load` made of a
    file of cosivina is the same model after it was exported and loaded again. A file of NIR is a network of
    spiking neurons, for one step.

    Args:
        model: the model; it must be free of problems.
        path: the file to write, `.json` for cosivina, `.nir` for NIR.
        to: name of the tool; by default the one whose files have the ending of `path`.
        force: whether to replace an existing file.
        options: options of the tool, for example `spiking=dd.SpikingOptions(...)`: neurons, step and chip
        of a
            file of NIR.

    Returns:
        The report: a verdict for each element, parameter and connection of the model.

    Raises:
        UnknownName: deodar has no exporter of that name, or the exporter no such option.
        ModelError: the model has problems; the error lists all.
        OutputExists: the file exists, and `force` is not given.
        OutputError: it cannot be written.
    """
    place = output.claim(path, force)
    content = exported(model, place.name, to, **options)
    output.write(place, content.content)
    return content.report


def exported(model: Model, name: str, to: str | None = None, **options: Any) -> Exported:
    """Return the content of the file that `export` writes, and the report, without writing it.

    Raises:
        UnknownName: deodar has no exporter of that name, or the exporter no such option.
        ModelError: the model has problems; the error lists all.
    """
    exporter = EXPORTERS[_tool(name) if to is None else to]
    if not hasattr(exporter, "write"):
        raise UnknownName(
            f"the exporter {exporter.NAME!r} writes records, not models",
            fix=did_you_mean(exporter.NAME, of_models()),
        )
    accepted = inspect.signature(exporter.write).parameters
    for option in options.keys() - accepted.keys():
        raise UnknownName(
            f"the exporter {exporter.NAME!r} has no option {option!r}",
            fix=did_you_mean(option, list(accepted)[2:]),
        )
    return exporter.write(model, name, **options)


def _tool(name: str) -> str:
    """Return the name of the first tool whose files have the ending of a name."""
    endings = {exporter.ENDING: tool for tool, exporter in reversed(of_models().items())}
    ending = Path(name).suffix.lower()
    if ending not in endings:
        raise UnknownName(
            f"no exporter of models writes files that end in {ending!r}",
            fix=f"Give the name of the tool, to=... ({', '.join(of_models())})",
        )
    return endings[ending]
