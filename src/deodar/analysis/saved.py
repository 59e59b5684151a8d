"""Results of an analysis that have a file: writing it, and opening it again."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Self

from deodar import file_version
from deodar.errors import DamagedFile, RecordError, first_line, reading

if TYPE_CHECKING:
    import xarray


class SavedAnalysis(ABC):
    """A result that is saved with the document, the arguments and the versions that made it."""

    KIND: ClassVar[str]
    """Its name in the provenance of its record."""

    PHRASE: ClassVar[str]
    """What it is, in words with an article."""

    @abstractmethod
    def dataset(self) -> xarray.Dataset:
        """Return the result as a Dataset, with the document, its arguments and the versions that made it."""

    @classmethod
    @abstractmethod
    def of_record(cls, record: xarray.Dataset, provenance: Mapping[str, Any]) -> Self:
        """Return the result that `dataset` made a record of.

        Raises:
            RecordError: it is of another version.
        """

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

    @classmethod
    def load(cls, path: str | Path) -> Self:
        """Read a result that `save` wrote.

        The model is that of the document in the file, so that a branch can be left at a branch point, its
        ports can be read, and its folds have sensitivities.

        Args:
            path: the file.

        Raises:
            RecordError: the file does not exist, is damaged, or is another record.
        """
        # start-up time: these bring xarray
        from deodar.recording.files import load_record
        from deodar.recording.record import about

        record = load_record(path)
        with reading(path, RecordError):
            provenance = about(record)
            if cls.KIND not in provenance:
                raise RecordError(f"is a record without {cls.PHRASE}")
            with file_version.naming_later_writer(provenance):
                try:
                    return cls.of_record(record, provenance)
                except (LookupError, TypeError, ValueError, AttributeError, OverflowError) as error:
                    raise DamagedFile(
                        f"is damaged: {cls.PHRASE} cannot be read ({first_line(error)})"
                    ) from None
