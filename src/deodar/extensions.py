"""The members of a group by name, from deodar and from installed packages.

Measures and figures are such groups (`plugins.GROUPS`). Kinds and worlds, which documents store, are in
`registry.py`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Any, Generic, TypeVar

from deodar import plugins
from deodar.errors import UnknownName, did_you_mean
from deodar.plugins import Plugin

T = TypeVar("T")


def requires(*names: str) -> Callable[[Plugin, Any], str]:
    """Return the check of a member that is a module with attributes of these names."""

    def problem(plugin: Plugin, member: Any) -> str:
        missing = [name for name in names if not hasattr(member, name)]
        return f"has no {', '.join(missing)}" if missing else ""

    return problem


class Extensions(Mapping[str, T], Generic[T]):
    """The members of a group. A lookup imports one package; iteration imports all and skips the broken ones.

    Args:
        group: a key of `plugins.GROUPS`.
        what: the term for a member in messages, for example "measure".
        own: the members in deodar.
        problem: returns the problem of an object from a package, from its entry point and the object; ""
            without a problem.
    """

    def __init__(
        self, group: str, what: str, own: Callable[[], Mapping[str, T]], problem: Callable[[Plugin, Any], str]
    ) -> None:
        self._group, self._what, self._own, self._problem = group, what, own, problem

    def packaged(self) -> list[Plugin]:
        """Return the members from installed packages, without importing them."""
        return plugins.found(self._group, list(self._own()))

    def first_party(self) -> dict[str, T]:
        """Return the members that come with deodar: of the engine, and of the packages beside it."""
        beside = {p.name: p.load()[0] for p in self.packaged() if p.first_party and not self.problem(p)}
        return dict(sorted({**beside, **self._own()}.items()))

    def problem(self, plugin: Plugin) -> str:
        """Import a member of a package and return its problem; "" without a problem."""
        found, problem = plugin.load()
        return problem or self._problem(plugin, found)

    def __getitem__(self, name: str) -> T:
        """Return a member.

        Raises:
            UnknownName: if no member has that name (the nearest is suggested), or its package cannot be used.
        """
        own = self._own()
        if name in own:
            return own[name]
        outside = {p.name: p for p in reversed(self.packaged()) if p.name not in own}
        if name not in outside:
            raise UnknownName(
                f"there is no {self._what} called {name!r}", fix=did_you_mean(name, [*own, *outside])
            )
        plugin = outside[name]
        problem = self.problem(plugin)
        if problem:
            raise UnknownName(
                f"{name!r} cannot be used: the package {plugin.package} {plugin.version} {problem}",
                fix="Type: deodar doctor",
            )
        return plugin.load()[0]

    def package(self, member: T) -> str:
        """Return name and version of the package of a member, in the form of files; "" for one of deodar."""
        name = getattr(member, "__name__", "")
        outside = (p for p in self.packaged() if p.name == name and not p.first_party)
        return next((f"{p.package} {p.version}" for p in outside if p.load()[0] is member), "")

    def __contains__(self, name: object) -> bool:
        """Return whether a member has that name, usable or not, without importing it."""
        return name in self._own() or name in [p.name for p in self.packaged()]

    def __iter__(self) -> Iterator[str]:
        own = self._own()
        return iter([*own, *(p.name for p in self.packaged() if p.name not in own and not self.problem(p))])

    def __len__(self) -> int:
        return sum(1 for _ in self)
