"""The classes of one family, registered where they are declared: events, actions, messages."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, Generic, TypeVar

from deodar.errors import ModelError

T = TypeVar("T")
C = TypeVar("C", bound=type[Any])


class Family(Mapping[str, type[T]], Generic[T]):
    """The classes of one family by their names, in the order of declaration.

    The decorator `register` adds a class, so that no second list of the classes is needed.

    Args:
        base: the base class of the family.
    """

    def __init__(self, base: type[T]) -> None:
        self._base = base
        self._members: dict[str, type[T]] = {}

    def register(self, cls: C) -> C:
        """Class decorator: add `cls` under its name.

        Raises:
            ModelError: if `cls` does not derive from the base, or the name is taken.
        """
        base = self._base.__name__
        if not issubclass(cls, self._base):
            raise ModelError(f"{cls.__name__} is not a subclass of {base}")
        if cls.__name__ in self._members:
            raise ModelError(
                f"the {base} {cls.__name__!r} is registered twice", fix="Give one of them another class name"
            )
        self._members[cls.__name__] = cls
        return cls

    def __getitem__(self, name: str) -> type[T]:
        return self._members[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._members)

    def __len__(self) -> int:
        return len(self._members)
