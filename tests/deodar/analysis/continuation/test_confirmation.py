"""Thresholds by bisection and as folds: both methods agree on every model whose regime is known."""

from __future__ import annotations

import pytest

import deodar as dd
from deodar.analysis.continuation.confirmation import confirmed
from tests.deodar.analysis.continuation.models import line, node, plane

MODELS = {
    "line": line(51),
    "memory": line(51, excitation=22, inhibition=0.4),
    "a node": node(),
    "plane": plane(),
}


@pytest.mark.parametrize("name", MODELS)
def test_every_threshold_of_the_bisection_contains_its_fold(name: str):
    regimes = dd.regimes(MODELS[name], "u")
    folds = confirmed(regimes)
    assert set(folds) == {n for n in regimes.transitions if n != "suppression"}
    for threshold, fold in folds.items():
        if fold.value is None:
            assert (name, threshold) == ("plane", "forgetting")
            assert fold.why == "the input is not in the middle of each axis"
        else:
            assert fold.inside, (threshold, fold, regimes.transitions[threshold].interval)


def test_a_threshold_that_is_no_fold_is_not_confirmed():
    graded = line(excitation=2.0, inhibition=0.0)
    assert confirmed(dd.regimes(graded, "u")) == {}
