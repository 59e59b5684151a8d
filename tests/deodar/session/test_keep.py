"""Learned values: in snapshots, in the document, in its file, and in later runs."""

from __future__ import annotations

import numpy as np
import pytest

import deodar as dd
from deodar.couplings.hebbian import Hebbian
from deodar.couplings.learning import AdaptiveWeights, GainAdaptation
from deodar.elements.memories import MemoryTrace
from deodar.errors import ParameterError

X, Z = dd.Axis("x", 0, 20, 21), dd.Axis("z", 0, 10, 11)
LEARNED = {"h": "weights", "a": "weights", "p": "trace", "g": "gains"}


def model():
    """Return a model with each learning kind between two fields with peaks."""
    m = dd.Model("learning", dt=1)
    u, v = (
        m.add(dd.Field(n, [a], resting_level=-5, kernel=[dd.Gaussian(1, 2)], noise=0.5))
        for n, a in (("u", X), ("v", Z))
    )
    m.add(dd.GaussianStimulus("to u", [X], center=6, sigma=2, amplitude=8)) >> u
    m.add(dd.GaussianStimulus("to v", [Z], center=4, sigma=2, amplitude=8)) >> v
    for w in (
        Hebbian([Z], rate=0.01, random=True, initial=0.1, name="h"),
        AdaptiveWeights([Z], rate=0.01, name="a"),
    ):
        handle = m.add(w)
        m.connect(u, handle["input"])
        m.connect(v, handle["post"])
    u >> m.add(MemoryTrace("p", [X], tau_build=50.0))
    g = m.add(GainAdaptation(name="g"))
    m.connect(u, g["input"])
    m.connect(v, g["error"])
    return m


def seen(session):
    states, by = session.snapshot().states, session.document.by_names()
    return {name: np.array(states[by[(name,)].id][0][place]) for name, place in LEARNED.items()}


def same(a, b):
    return all(np.array_equal(a[name], b[name]) for name in LEARNED)


@pytest.mark.parametrize("precision", ["float32", "float64"])
def test_snapshots_contain_learned_weights(precision):
    s = dd.Session(model(), precision=precision)
    s.step(100)
    snapshot, before = s.snapshot(), seen(s)
    s.step(50)
    after = seen(s)
    assert not any(np.array_equal(before[name], after[name]) for name in LEARNED)
    s.restore(snapshot)
    assert same(seen(s), before)
    s.step(50)
    assert same(seen(s), after)


@pytest.mark.parametrize("precision", ["float32", "float64"])
def test_kept_weights_are_saved_and_a_run_continues_from_the_file(precision, tmp_path):
    m = model()
    s = dd.Session(m, precision=precision)
    s.step(100)
    weights = s.read("h.weights")
    assert s.keep() == ["h.start", "a.start", "p.start", "g.start"]
    dd.save(m, tmp_path / "learned.json")
    opened = dd.load(tmp_path / "learned.json")
    assert opened.document == m.document
    fresh = dd.Session(opened, precision=precision)
    assert same(seen(fresh), seen(s)) and np.array_equal(fresh.read("h.weights"), weights)
    fresh.step(50)
    assert not same(seen(fresh), seen(s))
    second = fresh.keep()
    assert np.array_equal(opened.get("p.start").data, fresh.read("p.output")) and len(second) == 4


def test_keep_is_one_step_of_the_history_and_does_not_change_the_session():
    m = model()
    before, s = m.document, dd.Session(m)
    s.step(20)
    values, document = seen(s), s.document
    s.keep()
    assert same(seen(s), values) and s.document == document
    assert m.undo() and m.document == before


def test_keep_after_an_element_was_removed_is_an_error_that_names_it():
    m = model()
    s = dd.Session(m)
    s.step(5)
    m.remove("h")
    with pytest.raises(ParameterError, match=r"h: was learned, and is no longer in the model"):
        s.keep()
