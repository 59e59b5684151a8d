"""Documents as text for a clipboard: one JSON object that contains the arrays too.

The text is that of a document file, except that `arrays` also has a `content`: the array file as base64. It
is read with the same checks as a file: nothing that it names is imported or run.
"""

from __future__ import annotations

import base64
import binascii
from typing import Any, cast

from deodar import codec
from deodar.errors import DocumentError
from deodar.model import document_files
from deodar.model.document import KEYS, Document

NAME = "clipboard"


def text(doc: Document) -> str:
    """Return a document with its arrays as text."""
    written, packed = document_files.dumps(doc, NAME)
    if packed is None:
        return written
    document = codec.parse(written)
    document["arrays"]["content"] = base64.b64encode(packed).decode()
    return codec.text({key: document[key] for key in KEYS if key in document}, finite=True) + "\n"


def read(content: str) -> Document:
    """Return the document of a text.

    Raises:
        DocumentError: the text is not a document; the error lists all problems.
    """
    if len(content) > document_files.MOST_BYTES:
        raise DocumentError(f"is larger than {document_files.MOST_BYTES // 2**20} MiB", where=NAME)
    try:
        encoded = content.encode()
    except UnicodeEncodeError:
        raise DocumentError("is not valid text", where=NAME) from None
    document = codec.read(encoded)
    packed = _arrays(document)
    return document_files.of_data(document, lambda name: packed)


def _arrays(document: Any) -> bytes | None:
    """Remove the content of the arrays from the data, and return it; None: the text contains none."""
    entry = cast("dict[str, Any]", document).get("arrays") if isinstance(document, dict) else None
    content = cast("dict[str, Any]", entry).pop("content", None) if isinstance(entry, dict) else None
    if content is None:
        return None
    try:
        packed = base64.b64decode(content, validate=True)
    except (binascii.Error, ValueError, TypeError):
        raise DocumentError("the content is not base64", where="arrays") from None
    document_files.require_room(len(packed), NAME)
    return packed
