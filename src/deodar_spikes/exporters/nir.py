"""NIR, the neuromorphic intermediate representation: HDF5 files of networks of spiking neurons."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING, Any

from deodar_spikes import options as spiking_options

if TYPE_CHECKING:
    from deodar.exporters.exported import Exported
    from deodar.model.model import Model
    from deodar_spikes.prepare import SpikingOptions

NAME = "nir"
ENDING = ".nir"
HELP = "a network of spiking neurons in NIR (extra neuromorphic)"
ABOUT = "spiking neurons"


def write(model: Model, name: str, spiking: SpikingOptions | None = None) -> Exported:
    """Return the file of one chip, and the report.

    Args:
        model: the model.
        name: name of the file, for the report.
        spiking: neurons, step, chip, mismatch and tonic neurons.

    Raises:
        MissingExtra: the package nir is not installed.
    """
    # start-up time: these bring JAX
    from deodar.exporters.exported import Exported
    from deodar_spikes.mismatch import chip
    from deodar_spikes.nir_file import write_nir
    from deodar_spikes.prepare import SpikingOptions, prepare

    settings = spiking or SpikingOptions()
    network = prepare(model, name, settings)
    return Exported(write_nir(chip(network.fitted.graph, network.spread, settings.seed)), network.report)


def arguments(parser: argparse.ArgumentParser) -> None:
    """Add the options of spiking neurons."""
    spiking_options.add(parser, "of nir: ")


def options(args: argparse.Namespace) -> dict[str, Any]:
    """Return the options of `write`."""
    return {"spiking": spiking_options.read(args)}
