"""Moments of time that do not depend on how a run was cut into chunks."""

from __future__ import annotations

from typing import Any

import jax.numpy as jnp

NEAR = 0.01
"""Share of a step within which a moment counts as a whole number of steps; far above rounding, far below what a changed step leaves."""


def on_grid(moment: Any, dt: Any) -> Any:
    """The moment, made a whole number of steps exactly where it is one but for rounding.

    The time inside a step is a sum that is rounded otherwise in every chunk. What is a smooth function of time would show it in its last digits.
    """
    whole = jnp.round(moment / dt) * dt
    return jnp.where(jnp.abs(moment - whole) < jnp.maximum(NEAR * dt, 8 * jnp.finfo(whole.dtype).eps * jnp.abs(moment)), whole, moment)
