"""The folder or the record that `deodar run` writes."""

from __future__ import annotations

import argparse
import dataclasses as dc
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from deodar.cli import _rescue
from deodar.errors import OutputError, OutputExists, RecordError
from deodar.recording import files, folder, places

if TYPE_CHECKING:
    import xarray

    from deodar.model.document import Document


class WrittenRun(NamedTuple):
    """The path of a run and of the record in it; `failure` says why they are not what was requested."""

    out: Path
    record: Path
    failure: str


class RunFolder:
    """The output of a run: its path is checked before the run.

    Attributes:
        requested: `--out`; None: the first free name, which is looked up when the run is written.
        name: name of the model or of the record.
        format: format of the record.
        force: whether an earlier run is replaced.
    """

    def __init__(self, args: argparse.Namespace, name: str) -> None:
        self.requested: Path | None = args.out
        self.name = name
        self.format: str = args.format
        self.force: bool = args.force
        if self.requested is not None and folder.growing(self.requested) == self.requested:
            if self.format != "zarr":
                args.wrong(f"--out names a .zarr, so --format {self.format} cannot be given")
            folder.claim_growing(self.requested, self.force)
        else:
            folder.claim(self.path(), self.format, self.force)

    def path(self) -> Path:
        """Return the path of the run."""
        return self.requested or places.free(Path(), self.name)

    @property
    def label(self) -> str:
        """The path that was requested, else the name that numbers are added to."""
        return str(self.requested or self.name)

    def write(self, data: xarray.Dataset, doc: Document, ask: bool) -> WrittenRun:
        """Write the run, or to another folder on failure."""
        out = self.path()
        try:
            return WrittenRun(out, folder.write(data, doc, out, self.format, self.force), "")
        except (OutputError, OutputExists, RecordError) as error:
            # the disk has space, but not enough for this record
            format, first = (self.format, []) if isinstance(error, OutputError) else ("zarr", [out.parent])

            def write(parent: Path) -> tuple[Path, Path]:
                second = places.free(parent, self.name if self.requested is None else self.requested.name)
                return second, folder.write(data, doc, second, format)

            return WrittenRun(*_rescue.rescue(error, write, first, ask), error.at("shell"))


@dc.dataclass(frozen=True)
class GrownRecord:
    """The output of a run that was written during the run.

    Attributes:
        path: the folder or the record.
        format: format of the record that is requested.
    """

    path: Path
    format: str = "zarr"

    @property
    def label(self) -> str:
        """The path."""
        return str(self.path)

    def write(self, data: xarray.Dataset, doc: Document, ask: bool) -> WrittenRun:
        """Convert the record to the requested format, if that is another one."""
        record = files.locate(self.path)[0]
        if self.format == "zarr":
            return WrittenRun(self.path, record, "")
        try:
            return WrittenRun(self.path, folder.convert(self.path, self.format), "")
        except (OutputError, RecordError) as error:
            return WrittenRun(self.path, record, error.at("shell"))
