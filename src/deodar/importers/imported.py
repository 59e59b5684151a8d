"""What an importer gives."""

from __future__ import annotations

import dataclasses as dc

from deodar.importers.report import ImportReport
from deodar.model.model import Model


@dc.dataclass(frozen=True)
class Imported:
    """A model made from a file of another tool, and what became of everything in it."""

    model: Model
    report: ImportReport
