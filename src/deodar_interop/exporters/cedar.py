"""Records as cedar's recorder writes them."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import xarray

NAME, ENDING = "cedar", ""
HELP = "a folder with one CSV file for each variable, as cedar's recorder writes it"


def save(data: xarray.Dataset, path: str | Path, force: bool = False) -> Path:
    """Write a record."""
    # start-up time: this brings NumPy
    from deodar_interop.records import cedar

    return cedar.save(data, path, force)
