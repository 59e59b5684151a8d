"""The metadata of a Zarr record, `zarr.json` of its group, with a proof: the SHA-256 of the file.

They state the attributes of the record and the metadata of all its arrays. The proof is an attribute of the
group; it is computed of the file with zeros in place of it.
"""

from __future__ import annotations

import hashlib
import re
from pathlib import Path
from typing import Any

from deodar import codec, regular_file
from deodar.errors import DamagedFile
from deodar.model import output
from deodar.recording import portable
from deodar.recording.portable import NO_PROOF, PROOF

NAME = "zarr.json"
STATED = re.compile(rb'"' + PROOF.encode() + rb'":\s*"([0-9a-f]{64})"')


def content(group: dict[str, Any]) -> bytes:
    """Return the content of the file of a group, with its proof."""
    attributes = {PROOF: NO_PROOF} | {k: v for k, v in group["attributes"].items() if k != PROOF}
    text = codec.line(group | {"attributes": attributes}).encode()
    return text.replace(NO_PROOF.encode(), hashlib.sha256(text).hexdigest().encode(), 1)


def prove(folder: Path) -> dict[str, Any]:
    """Add the proof to the metadata that another program wrote into a folder, and return them."""
    group = codec.parse(regular_file.read_bytes(folder / NAME))
    output.replace(folder / NAME, content(group))
    return group


def read(folder: Path) -> dict[str, Any]:
    """Return the group of a record; the record of an earlier version has no proof.

    Raises:
        DamagedFile: the file is not the one that was written.
        OSError: there is none.
    """
    text = regular_file.read_bytes(folder / NAME)
    stated = STATED.findall(text)
    written = text.replace(stated[0], NO_PROOF.encode(), 1) if stated else text
    if stated and hashlib.sha256(written).hexdigest().encode() != stated[0]:
        raise DamagedFile("is damaged: its metadata are not those that were written", where=str(folder))
    try:
        group = codec.parse(text)
        portable.require_proof(group["attributes"], bool(stated))
    except (LookupError, TypeError, ValueError) as error:
        raise DamagedFile(f"is damaged: its metadata cannot be read ({error})", where=str(folder)) from None
    return group
