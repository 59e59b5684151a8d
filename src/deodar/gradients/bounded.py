r"""Parameters as numbers without bounds, for methods that move them freely.

Equation:
    p = a + e^z,\qquad p = b - e^z,\qquad p = a + \frac{b - a}{1 + e^{-z}},\qquad p = z

for a parameter with a lower bound a, an upper bound b, both, or none.
"""

from __future__ import annotations

import functools
from collections.abc import Mapping
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array
from jax.core import Tracer

from deodar.compiler.dynamics import ByPath, Dynamics
from deodar.declarations import LIMITING
from deodar.errors import ParameterError
from deodar.leaves import leaves
from deodar.model import find


class ParameterBounds(NamedTuple):
    """The bounds of a parameter; None: none.

    Attributes:
        lower: what it exceeds.
        upper: what exceeds it.
    """

    lower: float | None
    upper: float | None


def bounds(dynamics: Dynamics) -> dict[str, ParameterBounds]:
    """Return the bounds of the parameters: those of their declarations, and for time constants and rates
    those beyond which the Euler step would be too long. What drives several numbers has the tightest.
    """
    bounds_of: dict[str, ParameterBounds] = {}
    for path, driven in dynamics.drives.items():
        lower, upper = list[float](), list[float]()
        for ident, leaf in driven:
            entry = find.entry(dynamics.doc, ident)
            declared = next(p for name, _, p in leaves(entry.element) if name == leaf)
            step = dynamics.dt * entry.every
            lower += [] if declared.lower is None else [declared.lower]
            upper += [] if declared.upper is None else [declared.upper]
            if declared.role == "rate":
                upper.append(1 / step)
            elif declared.role in LIMITING:
                lower.append(step)
        bounds_of[path] = ParameterBounds(max(lower, default=None), min(upper, default=None))
    return bounds_of


def unbounded(dynamics: Dynamics, parameters: ByPath) -> dict[str, Array]:
    """Return the numbers z for parameters; `bounded` is the inverse.

    Args:
        dynamics: what `dd.dynamics` returned.
        parameters: values by path, arrays too; inside their bounds.

    Raises:
        ParameterError: a value lies on its bound or beyond, which no z reaches.
    """
    return _moved(dynamics, parameters, _free)


def bounded(dynamics: Dynamics, numbers: ByPath) -> dict[str, Array]:
    """Return the parameters for numbers z: inside their declared bounds, whatever the numbers.

    A fit that moves z by a gradient keeps a time constant above the step, and an excitation excitatory.

    Args:
        dynamics: what `dd.dynamics` returned.
        numbers: z by path.
    """
    return _moved(dynamics, numbers, _inside)


def _moved(dynamics: Dynamics, values: ByPath, move: Any) -> dict[str, Array]:
    bounds_of: Mapping[str, ParameterBounds] = bounds(dynamics)
    return {path: move(path, bounds_of[path], jnp.asarray(value)) for path, value in values.items()}


def _inside(path: str, bound: ParameterBounds, z: Array) -> Array:
    if bound.lower is not None and bound.upper is not None:
        return bound.lower + (bound.upper - bound.lower) * jax.nn.sigmoid(z)
    if bound.lower is not None:
        return bound.lower + jnp.exp(z)
    return z if bound.upper is None else bound.upper - jnp.exp(z)


def _free(path: str, bound: ParameterBounds, p: Array) -> Array:
    above = None if bound.lower is None else p - bound.lower
    below = None if bound.upper is None else bound.upper - p
    for room in (above, below):
        if room is not None and not isinstance(room, Tracer) and np.any(np.asarray(room) <= 0):
            raise ParameterError(
                f"is not inside its bounds {_text(bound)}, so that no free number gives it",
                where=path,
                fix="Begin inside of them",
            )
    logs = [None if room is None else jnp.log(room) for room in (above, below)]
    if logs[0] is not None and logs[1] is not None:
        return logs[0] - logs[1]
    return functools.reduce(lambda found, new: found if new is None else new, logs, p)


def _text(own: ParameterBounds) -> str:
    low, high = ("" if bound is None else f"{bound:g}" for bound in own)
    return f"{low} to {high}" if low and high else f"above {low}" if low else f"below {high}"
