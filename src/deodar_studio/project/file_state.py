"""What is known about the file of a document, as a value."""

from __future__ import annotations

import dataclasses as dc
from pathlib import Path

from deodar.model.document import Document

LOOKS = ("tiles", "panels", "folded")
"""Keys of the layout whose changes do not count as unsaved edits: plots (`panels`: of 0.1), folded groups."""


@dc.dataclass(frozen=True)
class FileState:
    """The file of a document, and what of the document is written to it.

    Attributes:
        path: the file that the document is saved to; None: it has none.
        saved: the document as saved last, as `plain` returns it; None: all of it counts as unsaved edits.
        digest: the digest of the file as read or written last.
        edits: the name under which unsaved edits are stored.
        stored: the document as stored last under that name.
    """

    path: Path | None = None
    saved: Document | None = None
    digest: str = ""
    edits: str = ""
    stored: Document | None = None

    def differs(self, doc: Document) -> bool:
        """Return whether a document has edits that are not saved to the file."""
        return self.saved is not doc and plain(doc) != self.saved


def plain(doc: Document) -> Document:
    """Return the document without the keys of its layout that do not count as edits."""
    return dc.replace(doc, layout={k: v for k, v in doc.layout.items() if k not in LOOKS})
