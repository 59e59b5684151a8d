"""Gradients of every kind are those of finite differences, or are refused by name."""

from __future__ import annotations

from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import deodar as dd
from deodar.elements.world_ports import Sensor
from deodar.errors import DerivativeError, ParameterError
from deodar.leaves import leaves
from tests.contracts.build import KINDS, PARTS, any_example, around

STEPS, NUDGE = 6, 1e-6


def numbers(model: dd.Model) -> list[str]:
    """Return the paths of all numbers and arrays that drive a program."""
    paths: list[str] = []
    for entry in model.document.entries:
        for leaf, number, parameter in leaves(entry.element):
            if np.size(number) and parameter.role not in ("moment", "duration"):
                paths.append(f"{entry.path}.{leaf}")
    return paths


@pytest.mark.parametrize("kind", [*KINDS, *PARTS])
def test_gradients_are_those_of_finite_differences_or_are_refused(kind: str) -> None:
    element = any_example(kind)
    model = around(element)
    d = differentiated(model)
    entry = next(e for e in model.document.entries if e.path == "example")
    record = [f"example.{port}" for port in entry.element.outputs({p: () for p in entry.element.ports()})]
    assert d.parameters or isinstance(element, Sensor)

    def total(parameters: Any) -> Any:
        seen = dd.rollout(d, STEPS, parameters, record=record).records
        return sum(
            jnp.sum(jnp.nan_to_num(a) * jnp.cos(jnp.arange(a.size)).reshape(a.shape)) for a in seen.values()
        )

    with d.context():
        # beside the present values, where a function may have a kink
        start = {path: jnp.asarray(value + 1e-3 * (1 + abs(value))) for path, value in d.parameters.items()}
        try:
            slopes = jax.jit(jax.grad(total))(start)
        except DerivativeError as error:
            assert "example" in str(error) and type(element).__name__ in str(error)
            return
        value = jax.jit(total)
        for path, slope in slopes.items():
            direction = np.cos(np.arange(slope.size) + 0.5).reshape(slope.shape)
            high, low = (float(value({**start, path: start[path] + e * direction})) for e in (NUDGE, -NUDGE))
            by = float(np.sum(np.asarray(slope) * direction))
            assert by == pytest.approx((high - low) / (2 * NUDGE), rel=1e-6, abs=1e-6), path


def differentiated(model: dd.Model) -> dd.PureDynamics:
    """Return the pure functions of a model, with every number as a parameter that can be one."""
    paths = numbers(model)
    try:
        return dd.dynamics(model, paths)
    except ParameterError:
        return dd.dynamics(model, [path for path in paths if accepted(model, path)])


def accepted(model: dd.Model, path: str) -> bool:
    """Return whether a path is a parameter of the pure functions."""
    try:
        dd.dynamics(model, [path])
    except ParameterError:
        return False
    return True
