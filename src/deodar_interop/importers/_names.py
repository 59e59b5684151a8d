"""Names of the elements of an imported file."""

from __future__ import annotations

from collections.abc import Iterable


class FreeNames:
    """The names in use; a repeated name gets a number."""

    def __init__(self, taken: Iterable[str]) -> None:
        self._taken = set(taken)
        self._numbers: dict[str, int] = {}

    def new(self, base: str) -> str:
        """Return an unused name: `base`, else `base 2`, `base 3`, ..."""
        name, n = base, self._numbers.get(base, 1)
        while name in self._taken:
            n += 1
            name = f"{base} {n}"
        self._numbers[base] = n
        self._taken.add(name)
        return name
