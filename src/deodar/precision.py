"""The precision of a run by its name: the precision of all numbers, and how kernels are applied."""

from __future__ import annotations

from typing import NamedTuple

from deodar.errors import ParameterError, show


class Arithmetic(NamedTuple):
    """The precision of numbers, and the accuracy of kernels, as programs take them and records state them."""

    precision: str
    accuracy: str

    @classmethod
    def of(cls, name: str) -> Arithmetic:
        """Return what a precision means: float32, float64, or float32-exact.

        Raises:
            ParameterError: the name is none of these.
        """
        found = NAMED.get(name) if isinstance(name, str) else None
        if found is None:
            raise ParameterError(f"precision is {show(name)}; expected {', '.join(NAMED)}")
        return found

    @property
    def name(self) -> str:
        """Its name; double precision has one accuracy."""
        return "float32-exact" if self == NAMED["float32-exact"] else self.precision


NAMED = {
    "float32": Arithmetic("float32", "default"),
    "float32-exact": Arithmetic("float32", "exact"),
    "float64": Arithmetic("float64", "default"),
}
"""Precisions by their names."""
