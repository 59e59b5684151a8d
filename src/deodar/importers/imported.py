"""The result of an importer."""

from __future__ import annotations

import dataclasses as dc

from deodar.importers.report import ImportReport
from deodar.model.model import Model
from deodar.summary import Summarised, Summary


@dc.dataclass(frozen=True, repr=False)
class Imported(Summarised):
    """A model made from a file of another tool, and the report of the conversion."""

    model: Model
    report: ImportReport

    def _summary(self) -> Summary:
        name = self.model.document.name
        return Summary(f"{name!r} from {self.report.file} ({self.report.tool})", [(self.report.summary(),)])
