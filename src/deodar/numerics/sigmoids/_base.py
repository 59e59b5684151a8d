"""The contract of a sigmoid: output of a field as a function of its activation."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from deodar.parameters import Part


@dataclass(frozen=True)
class Sigmoid(Part):
    """g(u), applied cell by cell."""

    def __call__(self, u: Any) -> Any:
        """Output for activation u; same shape."""
        raise NotImplementedError
