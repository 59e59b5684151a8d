"""Options of spiking neurons on the command line."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from deodar.cli._options import positive, whole

if TYPE_CHECKING:
    from deodar_spikes.prepare import SpikingOptions

NAMES = ("neurons", "step", "chip", "mismatch", "tonic", "seed")


def add(parser: argparse.ArgumentParser, of: str = "") -> None:
    """Add `--neurons`, `--step`, `--chip`, `--mismatch` and `--tonic`; `of` begins their help."""
    parser.add_argument(
        "--neurons", type=whole, metavar="N", help=f"{of}neurons of each sample of a field (default 20)"
    )
    parser.add_argument(
        "--step", type=positive, metavar="T", help=f"{of}step of the neurons (default: the document's)"
    )
    parser.add_argument(
        "--chip",
        metavar="NAME",
        help=f"{of}limits of a chip: ideal, analog-mismatch or digital-8-bit (default ideal)",
    )
    parser.add_argument(
        "--mismatch",
        type=float,
        metavar="SHARE",
        help=f"{of}relative standard deviation of thresholds and constant currents (default: the chip's)",
    )
    parser.add_argument(
        "--tonic",
        action="store_true",
        default=None,
        help=f"{of}resting levels by neurons that spike in every step, which mismatch does not change",
    )


def read(args: argparse.Namespace) -> SpikingOptions:
    """Return what `add` added, and `--seed` where a command has it."""
    # start-up time: this brings JAX
    from deodar_spikes.prepare import SpikingOptions

    typed = {name: getattr(args, name, None) for name in NAMES}
    return SpikingOptions(**{name: value for name, value in typed.items() if value is not None})
