"""Errors keep all attributes across processes."""

from __future__ import annotations

import pickle

import pytest

from deodar import errors

MADE = [
    errors.ParameterError("is wrong", where="u.tau", fix="Take another"),
    errors.ModelError([errors.Problem("a", "one"), errors.Problem("b", "two", "Do this")]),
    errors.NotFinite("became infinite", ["u", "v"], fix="Take a smaller dt"),
    errors.MissingExtra("dask", "cluster", "running on many machines"),
]


@pytest.mark.parametrize("error", MADE, ids=lambda e: type(e).__name__)
def test_a_pickled_error_keeps_its_type_text_and_problems(error: errors.DeodarError) -> None:
    copied = pickle.loads(pickle.dumps(error))
    assert (
        type(copied) is type(error)
        and str(copied) == str(error)
        and copied.problems == error.problems
        and vars(copied) == vars(error)
    )


def test_an_interrupted_run_keeps_its_data() -> None:
    copied = pickle.loads(pickle.dumps(errors.Interrupted("stopped", {"kept": 1})))
    assert type(copied) is errors.Interrupted and str(copied) == "stopped" and copied.data == {"kept": 1}
