"""What every message between the studio's server and its page has in common.

The two families are `to_server.MESSAGES` and `to_page.MESSAGES`. JSON Schema and TypeScript are generated
from them (`python -m deodar.server.protocol`). Arrays do not travel as messages but as binary frames: see
`deodar.server.frames`.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, TypeVar, Union, cast

import msgspec

Id = Annotated[str, msgspec.Meta(max_length=64, description="id of an element; empty: the document itself")]


class Message(msgspec.Struct, frozen=True, kw_only=True, tag_field="type", forbid_unknown_fields=True):
    """What travels; the tag `type` says which."""


M = TypeVar("M", bound=Message)


def union(messages: Mapping[str, type[M]]) -> type[M]:
    """Return the union of message classes, as a decoder and the schema take it; it decodes one of them."""
    return cast("type[M]", Union[tuple(messages.values())])  # noqa: UP007


class Data(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A part of a message."""
