"""Time windows of every kind that has them: None means always, an empty list never."""

from __future__ import annotations

import dataclasses as dc
import json

import numpy as np
import pytest

import deodar as dd
from deodar.errors import DeodarError
from deodar.model import document_files
from deodar.model.model import Model
from deodar.parameters import parameters
from tests.contracts.build import KINDS, around, example

WINDOWED = sorted(kind for kind, cls in KINDS.items() if any(p.name == "windows" for p in parameters(cls)))
"""Kinds with time windows."""

ALL_TIME = [(-1e6, 1e6)]


def model_of(kind: str, windows: object) -> Model:
    """Return the example of a kind with these windows, with a source for each input."""
    return around(dc.replace(example(kind), windows=windows))  # type: ignore[call-arg]


def output(model: Model) -> np.ndarray:
    """Return the output of the example at each of ten steps."""
    return dd.simulate(model, duration=10, record=["example.output"])["example.output"].values


def test_stimuli_have_windows() -> None:
    assert {"Boost", "GaussianStimulus", "MovingGaussian", "TimeSeries"} <= set(WINDOWED)


@pytest.mark.parametrize("kind", WINDOWED)
def test_none_is_always_and_an_empty_list_is_never(kind: str) -> None:
    always = output(model_of(kind, None))
    assert always.any() and next(p for p in parameters(KINDS[kind]) if p.name == "windows").default is None
    np.testing.assert_array_equal(output(model_of(kind, ALL_TIME)), always)
    np.testing.assert_array_equal(output(model_of(kind, [])), np.zeros_like(always))


@pytest.mark.parametrize("kind", WINDOWED)
def test_files_keep_the_difference_between_always_and_never(kind: str) -> None:
    for windows in (None, []):
        model = model_of(kind, windows)
        document, arrays = document_files.to_data(model.document)
        assert document["elements"]["example"]["windows"] == windows
        assert document_files.from_data(json.loads(json.dumps(document)), arrays) == model.document
        older = document | {"deodar": 3}
        assert document_files.from_data(older, arrays) == model_of(kind, None).document


@pytest.mark.parametrize("kind", WINDOWED)
def test_a_running_session_is_switched_to_never_and_always(kind: str) -> None:
    session = dd.Session(model_of(kind, None))
    values = []
    for windows in ([], None, ALL_TIME, []):
        session.set("example.windows", windows)
        session.step()
        values.append(bool(np.any(session.read("example.output"))))
    assert values == [False, True, True, False]


@pytest.mark.parametrize("kind", WINDOWED)
def test_a_stimulus_that_is_never_on_is_no_mistake(kind: str) -> None:
    assert [p for p in model_of(kind, []).check() if "windows" in p.what or "never" in p.what] == []


def test_a_handle_of_windows_is_none_or_a_list() -> None:
    model = dd.Model("m")
    stimulus = model.add(dd.Boost("s", windows=[(1, 2)]))
    windows = stimulus.windows
    assert len(windows) == 1
    stimulus.windows = None
    assert stimulus.windows is None and model.get("s.windows") is None
    with pytest.raises(DeodarError, match=r"s\.windows is None now, no list of parts. Write: model\.set"):
        len(windows)
    with pytest.raises(DeodarError, match="It is None: set it to a list first"):
        model.set("s.windows.0.start", 3.0)
    stimulus.windows = []
    assert stimulus.windows == [] and model.get("s.windows") == ()
    with pytest.raises(DeodarError, match="The list is empty: set it first"):
        model.set("s.windows.0.start", 3.0)
