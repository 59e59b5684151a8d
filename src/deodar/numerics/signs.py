"""Signs of weights: "+" for excitation, "-" for inhibition, "±" where both occur."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Literal

import numpy as np

from deodar.numerics.scalar import Scalar
from deodar.parameters import ArrayLike

Sign = Literal["+", "-", "±"]


def sign_of(*values: ArrayLike | Scalar | None) -> Sign:
    """Return the common sign of numbers and arrays; zeros and empty arrays count as excitation."""
    arrays = [np.asarray(getattr(v, "data", v), float) for v in values if v is not None]
    above, below = any((a > 0).any() for a in arrays), any((a < 0).any() for a in arrays)
    return "±" if above and below else "-" if below else "+"


def product(first: Sign, second: Sign) -> Sign:
    """Return the sign of a product of weights."""
    if "±" in (first, second):
        return "±"
    return "+" if first == second else "-"


def together(signs: Iterable[Sign]) -> Sign:
    """Return the sign of a sum of weights."""
    distinct = set(signs)
    if len(distinct) > 1:
        return "±"
    return distinct.pop() if distinct else "+"
