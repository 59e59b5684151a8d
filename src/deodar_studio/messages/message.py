"""Base classes of the messages between the studio's server and its page.

The two families are `requests.request.MESSAGES` and `to_page.MESSAGES`. JSON Schema and TypeScript are
generated from them (`python -m deodar_studio.requests.protocol`). Arrays are not sent as messages but as
binary frames: see `deodar_studio.messages.frames`.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, TypeVar, Union, cast

import msgspec

Id = Annotated[str, msgspec.Meta(max_length=64, description="id of an element; empty: the document itself")]


class Message(msgspec.Struct, frozen=True, kw_only=True, tag_field="type", forbid_unknown_fields=True):
    """Base class of messages; the field `type` has the tag of the class."""


M = TypeVar("M", bound=Message)


def union(messages: Mapping[str, type[M]]) -> type[M]:
    """Return the union of message classes in the order of their names, for a decoder and for the schema."""
    return cast("type[M]", Union[tuple(messages[name] for name in sorted(messages))])  # noqa: UP007


class Data(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A part of a message."""


S = TypeVar("S", bound=Message | Data)


def made_of(kind: type[S], of: object, **others: Any) -> S:
    """Return a message, or a part of one, whose fields are attributes of an object, except those given."""
    same = {name: getattr(of, name) for name in kind.__struct_fields__ if name not in others}
    return kind(**same, **others)
