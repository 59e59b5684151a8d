"""The result of an exporter."""

from __future__ import annotations

import dataclasses as dc

from deodar.importers.report import ImportReport


@dc.dataclass(frozen=True)
class Exported:
    """The content of a file of another tool, and the report of the conversion."""

    content: bytes
    report: ImportReport
