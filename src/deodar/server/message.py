"""What every message between the studio's server and its page has in common.

The two unions are `to_server.ToServer` and `to_page.ToPage`. JSON Schema and TypeScript are generated from
them (`python -m deodar.server.protocol`). Arrays do not travel as messages but as binary frames: see
`deodar.server.frames`.
"""

from __future__ import annotations

from typing import Annotated

import msgspec

Id = Annotated[str, msgspec.Meta(max_length=64, description="id of an element; empty: the document itself")]


class Message(msgspec.Struct, frozen=True, kw_only=True, tag_field="type", forbid_unknown_fields=True):
    """What travels; the tag `type` says which."""


class Data(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A part of a message."""
