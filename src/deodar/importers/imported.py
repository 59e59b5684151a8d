"""The result of an importer."""

from __future__ import annotations

import dataclasses as dc

from deodar.importers.report import ImportReport
from deodar.model.model import Model


@dc.dataclass(frozen=True)
class Imported:
    """A model made from a file of another tool, and the report of the conversion."""

    model: Model
    report: ImportReport
