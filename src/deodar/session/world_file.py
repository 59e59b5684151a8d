"""The state of a world, and of its exchange with the model, as text and arrays for a file."""

from __future__ import annotations

from typing import Any

import numpy as np

from deodar import codec, registry
from deodar.errors import RecordError
from deodar.recording import stored
from deodar.session.exchange import StoredLeaves, WorldState


def to_file(kept: WorldState | None) -> tuple[dict[str, Any] | None, list[np.ndarray]]:
    """Return the state of a world as text and arrays.

    Raises:
        RecordError: the world keeps something that a file cannot hold.
    """
    if kept is None:
        return None, []
    if isinstance(kept.world, StoredLeaves):
        leaves = list(kept.world.leaves)
    else:
        leaves = stored.leaves(kept.world, f"the world {kept.kind.__name__}")
    commands = dict(kept.commands or {})
    text = {
        "kind": kept.kind.__name__,
        "leaves": len(leaves),
        "commands": None if kept.commands is None else list(commands),
        "last": kept.last,
        "due": kept.due,
        "origin": kept.origin,
    }
    if kept.objects is not None:
        try:
            text["objects"] = codec.parse(codec.line(kept.objects))
        except (TypeError, ValueError):
            raise RecordError(
                f"the objects of the world {kept.kind.__name__} are not plain data, which a file cannot hold",
                fix="Let its `arrangement` return numbers, text, lists and dictionaries",
            ) from None
    return text, [*leaves, *map(np.asarray, commands.values())]


def from_file(text: dict[str, Any] | None, arrays: list[np.ndarray]) -> WorldState | None:
    """Return the state of a world from what `to_file` returned.

    Raises:
        RecordError: a world of this kind is not known.
    """
    if text is None:
        return None
    kind = registry.kinds("worlds").get(text["kind"])
    if kind is None:
        raise RecordError(f"was taken in a world of the kind {text['kind']}, which is not known here")
    leaves, commands, names = arrays[: text["leaves"]], arrays[text["leaves"] :], text["commands"]
    told = None if names is None else dict(zip(names, commands, strict=True))
    times = text["last"], text["due"], text["origin"]
    return WorldState(kind, StoredLeaves(leaves), *times, told, text.get("objects"))
