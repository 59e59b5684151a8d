"""Public names that packages of others add to `dd`: the entry points `deodar.names`.

The names of the engine and of the packages beside it are in `__init__.pyi`.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from deodar import plugins
from deodar.errors import no_attribute
from deodar.plugins import Plugin


def outside(names: Sequence[str]) -> dict[str, Plugin]:
    """Return the names that packages add to `names`, without importing them."""
    return {p.name: p for p in reversed(plugins.found("names", names)) if p.name not in names}


def packaged(name: str, names: Sequence[str]) -> Any:
    """Return the object that a package adds under a name.

    Args:
        name: the name, as in `dd.NAME`.
        names: the names of deodar.

    Raises:
        AttributeError: no package adds the name (the nearest is suggested), or the package cannot be used.
    """
    added = outside(names)
    if name not in added:
        raise no_attribute("deodar", name, [*names, *added])
    plugin = added[name]
    value, problem = plugin.load()
    if problem:
        what = f"module 'deodar' has no attribute {name!r}: the package {plugin.package} {plugin.version}"
        raise AttributeError(f"{what} {problem}. Type: deodar doctor", name=name, obj=None)
    return value
