"""Results of an analysis that have a file: writing it, and opening it again."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from deodar import codec
from deodar.errors import RecordError

if TYPE_CHECKING:
    import xarray


class SavedAnalysis(ABC):
    """A result that is saved with the document, the arguments and the versions that made it."""

    @abstractmethod
    def dataset(self) -> xarray.Dataset:
        """Return the result as a Dataset."""

    def save(self, path: str | Path, force: bool = False) -> Path:
        """Write the result as NetCDF (.nc) or Zarr (.zarr), with the document, arguments and versions.

        Args:
            path: the file; its folder must exist.
            force: whether to replace an existing file.

        Raises:
            OutputExists: the path exists.
        """
        # start-up time: this brings xarray
        from deodar.recording.files import save_record

        return save_record(self.dataset(), path, force=force)


def opened(path: str | Path, kind: str, words: str) -> tuple[xarray.Dataset, Mapping[str, Any]]:
    """Return the record of a result, and its provenance.

    Raises:
        RecordError: the file does not exist, is damaged, or its provenance lacks `kind`; `words` say what it
            should be.
    """
    # start-up time: these bring xarray
    from deodar.recording.files import load_record
    from deodar.recording.provenance import KEY

    record = load_record(path)
    provenance = codec.parse(record.attrs[KEY])
    if kind not in provenance:
        raise RecordError(f"is a record without {words}", where=str(path))
    return record, provenance
