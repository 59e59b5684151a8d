"""Values that a function passes through a jump, where a gradient is refused instead of being 0."""

from __future__ import annotations

from typing import Any, NoReturn

import jax
from jax import Array

from deodar.errors import DerivativeError

FIX = (
    "Take a gradual kind for the fit, such as a Logistic sigmoid; or leave out the parameters and the records"
    " that pass through it"
)


def without_derivative(x: Array, why: str) -> Array:
    """Return x; an error is raised where JAX differentiates through it.

    Args:
        x: the values.
        why: which element has no derivative, and by what.
    """

    @jax.custom_jvp
    def same(x: Array) -> Array:
        return x

    @same.defjvp
    def refuse(primals: Any, tangents: Any) -> NoReturn:  # pyright: ignore[reportUnusedFunction] # JAX calls it
        raise DerivativeError(why, fix=FIX)

    return same(x)
