"""The stochastic Euler method, deodar's only integrator (Lomp et al. 2016, eq. 17).

References:
    Lomp, Richter, Zibner & Schöner (2016), Developing dynamic field theory architectures for embodied
    cognitive systems with cedar, Front. Neurorobot. 10:14, eqs. 16 and 17. Kloeden & Platen (1992), Numerical
    solution of stochastic differential equations, Springer.
"""

from __future__ import annotations

import jax.numpy as jnp
from jax import Array

from deodar.numerics.scalar import Scalar


def euler(u: Array, rate: Scalar, tau: Scalar, dt: Scalar, noise: Array | None = None) -> Array:
    """Return the state after one step of `tau du = rate dt + noise dW`: drift by dt/tau, noise by
    sqrt(dt)/tau.

    Args:
        u: state at t.
        rate: right-hand side at t.
        tau: time constant, in the document's time unit.
        dt: step, in the document's time unit.
        noise: amplitude times a standard normal deviate for each cell, or None.
    """
    new = u + dt / tau * rate
    return new if noise is None else new + jnp.sqrt(dt) / tau * noise
