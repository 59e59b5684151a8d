"""Records as files of MATLAB."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import xarray

NAME, ENDING = "mat", ".mat"
HELP = "a file of MATLAB"


def save(data: xarray.Dataset, path: str | Path, force: bool = False) -> Path:
    """Write a record."""
    # start-up time: this brings NumPy
    from deodar_interop.records import mat

    return mat.save(data, path, force)
