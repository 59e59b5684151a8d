"""Thresholds by bisection and as folds: both methods agree on every model whose regime is known."""

from __future__ import annotations

from pathlib import Path

import pytest

import deodar as dd
from deodar.analysis.continuation.confirmation import confirmed
from tests.deodar.analysis.continuation.models import line, node, plane
from tests.house.source import ROOT

EXAMPLES = ("boost", "detection", "node", "selection", "working_memory")


def model_of(name: str) -> dd.Model:
    if name == "memory":
        return line(excitation=22, inhibition=0.4)
    made = {"line": line, "a node": node, "plane": plane}
    return made[name]() if name in made else dd.load(Path(ROOT) / "examples" / f"{name}.json")


@pytest.mark.parametrize("name", ["line", "memory", "a node", "plane", *EXAMPLES])
def test_every_threshold_of_the_bisection_contains_its_fold(name: str):
    found = dd.regimes(model_of(name), "u")
    folds = confirmed(found)
    assert set(folds) == {n for n in found.transitions if n != "suppression"}
    for threshold, fold in folds.items():
        if fold.value is None:
            assert (name, threshold) == ("plane", "forgetting")
            assert fold.why == "the input is not in the middle of each axis"
        else:
            assert fold.inside, (threshold, fold, found.transitions[threshold].interval)


def test_a_threshold_that_is_no_fold_is_not_confirmed():
    graded = line(excitation=2.0, inhibition=0.0)
    assert confirmed(dd.regimes(graded, "u")) == {}
