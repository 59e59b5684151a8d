"""A wrong measure of a user is an error that names its class, its line, and what it did."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest

import deodar as dd
from deodar.errors import KindError
from tests.deodar.errors.refused import refused


@dataclass(frozen=True)
class Wordy(dd.BaseMeasure):
    name: str
    of: str
    when: str = ""

    def value(self, samples: np.ndarray, axes: dd.Axes | None) -> Any:
        return "wide"


@dataclass(frozen=True)
class Ragged(dd.BaseMeasure):
    name: str
    of: str
    when: str = ""

    def value(self, samples: np.ndarray, axes: dd.Axes | None) -> Any:
        return samples[1000]


@dataclass(frozen=True)
class Unlisted(Wordy):
    def value(self, samples: np.ndarray, axes: dd.Axes | None) -> float:
        return {"left": 1.0}["right"]


@pytest.mark.parametrize(
    ("measure", "says"),
    [
        (Wordy, "Wordy.value in test_wrong_measures.py, line"),
        (Ragged, "Ragged.value in test_wrong_measures.py, line"),
        (Unlisted, "raised KeyError: 'right'"),
    ],
)
def test_a_wrong_measure_is_named(measure: type[Any], says: str) -> None:
    model = dd.Model("m")
    model.add(dd.Field("u", [dd.Axis("x", 0, 20, samples=21)]))
    plan = dd.TrialPlan(3, measures=[measure("size", "u.activation")])
    text = refused(lambda: dd.Trials(model, plan).run([0]), KindError, "measures.size: ", says)
    assert ("returns 'wide'; expected a number" in text) == (measure is Wordy)


@dataclass(frozen=True)
class Partial(Wordy):
    def value(self, samples: np.ndarray, axes: dd.Axes | None) -> list[float | None]:
        return [1.0, None]


def test_an_undefined_number_among_others_is_nan() -> None:
    model = dd.Model("m")
    model.add(dd.Field("u", [dd.Axis("x", 0, 20, samples=21)]))
    plan = dd.TrialPlan(3, measures=[Partial("size", "u.activation")])
    [trial] = dd.Trials(model, plan).run([0])
    np.testing.assert_array_equal(trial.measures["size"], [1.0, np.nan])
