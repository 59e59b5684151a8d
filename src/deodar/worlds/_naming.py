"""Worlds as text: `KIND:ARGUMENT`, as on the command line."""

from __future__ import annotations

from deodar import registry
from deodar.credentials import masked
from deodar.errors import WorldError, did_you_mean
from deodar.worlds._address import is_address
from deodar.worlds._base import World


def named_kind(text: str, where: str) -> tuple[type[World], str]:
    """Return the class of a world and the argument for its `open`; messages call the place of this text
    `where`.

    Case and hyphens do not count: `event-file` is `EventFile`. A class may have a short name besides. An
    address such as rtsp://HOST/PATH is a camera.

    Raises:
        WorldError: there is no such class, or the text has no argument.
    """
    where = masked(where)
    name, _, argument = ("camera", "", text) if is_address(text) else text.partition(":")
    worlds = registry.kinds("worlds")
    kinds = {cls.short: cls for cls in worlds.values() if cls.short}
    kinds |= {kind.casefold(): cls for kind, cls in worlds.items()}
    world = kinds.get(name.casefold().replace("-", ""))
    if world is None:
        raise WorldError(f"there is no world {name!r}", where=where, fix=did_you_mean(name.casefold(), kinds))
    if not argument:
        raise WorldError(
            "needs an argument",
            where=where,
            fix=f"Write {name.lower()}:ARGUMENT; deodar elements {world.__name__} describes it",
        )
    return world, argument
