"""Executables shared among the models of a process: the same model built again compiles nothing, and
another model never receives them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest

import deodar as dd
from deodar.compiler import executable as module
from deodar.couplings.weights import Weights
from deodar.leaves import structure
from deodar.numerics.sigmoids import Logistic, SigmoidFunction
from tests.deodar.compiler.programs import executable

x = dd.Axis("x", 0, 10, samples=11)


def model(resting_level: float = -5.0, kernel: Sequence[Any] = (), name: str = "u") -> dd.Model:
    model = dd.Model("shared")
    model.add(dd.Field(name, [x], resting_level=resting_level, kernel=kernel))
    return model


def test_a_model_built_again_uses_the_compiled_program() -> None:
    assert executable(model()) is executable(model())
    assert executable(model(resting_level=-3.0)) is executable(model()), "a live parameter is an argument"
    assert executable(model(), precision="float64") is not executable(model())


def test_another_structure_is_another_executable() -> None:
    assert executable(model(kernel=[dd.Gaussian(sigma=2.0)])) is not executable(model())
    assert executable(model(name="v")) is not executable(model()), "another id has other noise"


def test_values_are_those_of_the_model_that_asks() -> None:
    first, second = dd.Session(model()), dd.Session(model(resting_level=-3.0))
    for session in (first, second):
        session.step(2000)
    assert first.program is second.program
    assert np.allclose(first.read("u.activation"), -5.0) and np.allclose(second.read("u.activation"), -3.0)


def test_a_class_defined_again_under_the_same_name_is_another_structure() -> None:
    """A cell of a notebook that defines a kind may be edited and run again."""

    def ramp() -> SigmoidFunction:
        @dataclass(frozen=True)
        class Ramp(Logistic):
            """A custom sigmoid."""

        return Ramp()

    assert structure(dd.Field("u", [x], sigmoid=ramp())) != structure(dd.Field("u", [x], sigmoid=ramp()))


def test_large_parameters_belong_to_their_model_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    def weighted() -> dd.Model:
        built = model()
        built["u"] >> Weights(np.eye(11), [x]) >> built.add(dd.Field("v", [x]))
        return built

    assert executable(weighted()) is executable(weighted())
    monkeypatch.setattr(module, "SHARED_BYTES", 11 * 11)
    assert executable(weighted()) is not executable(weighted())
