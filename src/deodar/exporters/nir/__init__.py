"""NIR, the neuromorphic intermediate representation: HDF5 files of networks of spiking neurons."""

from __future__ import annotations

from deodar.exporters.exported import Exported
from deodar.model.model import Model
from deodar.neuromorphic.mismatch import chip
from deodar.neuromorphic.nir_file import write_nir
from deodar.neuromorphic.prepare import SpikingOptions, prepare

NAME = "nir"
ENDING = ".nir"


def write(model: Model, name: str, options: SpikingOptions | None = None) -> Exported:
    """Return the file of one chip, and the report.

    Args:
        model: the model.
        name: name of the file, for the report.
        options: neurons, step, chip, mismatch and tonic neurons.

    Raises:
        MissingExtra: the package nir is not installed.
    """
    given = options or SpikingOptions()
    made = prepare(model, name, given)
    return Exported(write_nir(chip(made.fitted.graph, made.spread, given.seed)), made.report)
