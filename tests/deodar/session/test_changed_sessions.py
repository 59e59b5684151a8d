"""Sessions that were changed in any order: they continue as a fresh session of the same document does."""

from __future__ import annotations

import dataclasses as dc

import numpy as np
from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, invariant, rule

import deodar as dd
from deodar.errors import DeodarError
from deodar.model import edit

SETTINGS: list[dict[str, object]] = [
    {"u.tau": 30.0},
    {"u.tau": 10.0, "v.tau": 15.0},
    {"u.noise": 0.0},
    {"u.noise": 0.5},
    {"u.kernel.0.sigma": 1.2},
    {"u.kernel.0.sigma": 4.0},
    {"u.kernel": []},
    {"u.kernel": [dd.Gaussian(6, 2), dd.Gaussian(-2, 5)]},
    {"s.amplitude": 0.0},
    {"s.windows": [(3.0, 9.0)]},
    {"v.resting_level": -1.0},
]


def resampled(model: dd.Model) -> None:
    axis = model["u"].element.axes[0]
    finer = dc.replace(axis, samples=52 - axis.samples)
    model.commit(edit.replace_axis(model.document, axis, finer))


EDITS = {
    "resample": resampled,
    "rename": lambda model: model.rename("v", "w"),
    "rename back": lambda model: model.rename("w", "v"),
    "add": lambda model: model.add(dd.Field("more", [], noise=0.2)),
    "remove": lambda model: model.remove("more"),
    "undo": lambda model: model.undo(),
    "redo": lambda model: model.redo(),
}


class ChangedSessions(RuleBasedStateMachine):
    """A session of a field that drives a node."""

    def __init__(self) -> None:
        super().__init__()
        x = dd.Axis("x", 0, 20, samples=21)
        self.model = dd.Model("changed")
        u = self.model.add(dd.Field("u", [x], kernel=[dd.Gaussian(6, 2)], noise=0.3, resting_level=-2))
        self.model.add(dd.GaussianStimulus("s", [x], center=8, sigma=2, amplitude=4)) >> u
        u >> self.model.add(dd.Project()) >> self.model.add(dd.Field("v", []))
        self.session = dd.Session(self.model, seed=3)

    @rule(n=st.integers(1, 5))
    def step(self, n: int) -> None:
        self.session.step(n)

    @rule(values=st.sampled_from(SETTINGS))
    def set(self, values: dict[str, object]) -> None:
        try:
            self.session.set(values)
        except DeodarError:
            return
        self.model.commit(self.session.document)

    @rule(kind=st.sampled_from(sorted(EDITS)))
    def change(self, kind: str) -> None:
        try:
            EDITS[kind](self.model)
        except DeodarError:
            return
        self.session.edit(self.model.document)

    @rule(dt=st.sampled_from([0.5, 1.0, 2.0]))
    def pace(self, dt: float) -> None:
        self.session.dt = dt

    @rule()
    def reset(self) -> None:
        self.session.reset()

    @rule()
    def go_back(self) -> None:
        snapshot = self.session.snapshot()
        self.session.step(2)
        self.session.restore(snapshot)

    @invariant()
    def continues_as_a_fresh_one(self) -> None:
        fresh = dd.Session(self.model, dt=self.session.next_dt, seed=3)
        fresh.restore(self.session.snapshot())
        assert fresh.tick == self.session.tick and fresh.time == self.session.time
        for n in (1, 3):
            fresh.step(n)
            self.session.step(n)
            for path in (e.path for e in self.model.document.entries if isinstance(e.element, dd.Field)):
                np.testing.assert_allclose(
                    fresh.read(path), self.session.read(path), rtol=1e-4, atol=1e-4, err_msg=path
                )


TestChangedSessions = ChangedSessions.TestCase
TestChangedSessions.settings = settings(settings(), stateful_step_count=8)
