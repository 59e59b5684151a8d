"""The instants that connections read, and elements with steps of their own, against plain loops."""

from __future__ import annotations

import numpy as np
import pytest

import deodar as dd
from deodar.elements.stimuli import Boost
from tests.oracle import fields

STEPS = 200
X = dd.Axis("x", 0, 15, 16)
U = dd.Field("u", [X], tau=10, resting_level=-2, kernel=[dd.Gaussian(0.5, 1.7)])
V = dd.Field("v", [X], tau=6, resting_level=-1, kernel=[dd.Gaussian(0.3, 1.0)])
S = dd.GaussianStimulus("s", [X], center=5, sigma=2, amplitude=5, windows=[(3, 60), (90, 170)])


def run(reads, back, precision="float64"):
    """Run a model in which `u` drives `v` through a gain and `v` inhibits `u`; either connection may read
    another instant.
    """
    model = dd.Model("pair")
    s, u, v = model.add(S), model.add(U), model.add(V)
    model.connect(s, u)
    model.connect(u, v, reads=reads)
    minus = model.add(dd.Gain(-2.0, name="minus"))
    model.connect(v, minus, reads=back)
    model.connect(minus, u)
    return dd.simulate(model, STEPS, record=["u.activation", "v.activation"], precision=precision)


def by_hand(reads, back):
    """Return u and v over time; `held` is the register of a delayed connection, zero at first."""
    u, v = fields.Field(U), fields.Field(V)
    seen = [(u.u, v.u)]
    held_u, held_v = np.zeros(16), np.zeros(16)
    for k in range(STEPS):
        old_u, old_v = u.output, v.output
        s = fields.stimulus(S, k)

        def step_u(inhibition, s=s):
            u.step(s - 2.0 * inhibition, 1.0)

        def step_v(excitation):
            v.step(excitation, 1.0)

        if back == "current":  # then v advances first
            step_v({"": old_u, "previous": old_u, "delayed": held_u}[reads])
            step_u(v.output)
        else:
            step_u({"": old_v, "previous": old_v, "delayed": held_v}[back])
            step_v({"": old_u, "previous": old_u, "delayed": held_u, "current": u.output}[reads])
        held_u, held_v = old_u, old_v
        seen.append((u.u, v.u))
    return np.array(seen)


CASES = [
    ("", ""),
    ("previous", "delayed"),
    ("current", ""),
    ("delayed", "current"),
    ("current", "delayed"),
    ("delayed", "delayed"),
]


@pytest.mark.parametrize(("reads", "back"), CASES)
def test_previous_current_and_delayed_reads_agree_with_the_oracle(reads, back):
    record, reference = run(reads, back), by_hand(reads, back)
    for k, name in enumerate(("u.activation", "v.activation")):
        scale = abs(reference[:, k]).max()
        np.testing.assert_allclose(record[name].values, reference[:, k], rtol=0, atol=1e-9 * scale)


def test_previous_current_and_delayed_reads_differ():
    ends = [by_hand(*case)[30].ravel() for case in CASES[:4]]
    for i in range(4):
        for j in range(i):
            assert abs(ends[i] - ends[j]).max() > 1e-4


@pytest.mark.parametrize(("slow", "fast"), [(3, 1), (2, 5), (4, 1)])
def test_parts_with_other_steps_agree_with_the_oracle(slow, fast):
    """An element with multiple k reads at ticks that are multiples of k; its new state is visible k ticks
    later.
    """
    model = dd.Model("rates")
    s = model.add(S)
    u, v = model.add(U, ticks=slow), model.add(V, ticks=fast)
    s >> u
    u >> v >> dd.Gain(-2.0) >> u
    record = dd.simulate(model, STEPS, dt=0.5, record=["u.activation", "v.activation"], precision="float64")
    parts = {"u": fields.Field(U), "v": fields.Field(V)}
    every, coming = {"u": slow, "v": fast}, {}
    seen = []
    for tick in range(2 * STEPS + 1):
        for name, state in list(coming.items()):
            if tick % every[name] == 0:
                parts[name].u = state
        seen.append((parts["u"].u, parts["v"].u))
        inputs = {"u": fields.stimulus(S, 0.5 * tick) - 2.0 * parts["v"].output, "v": parts["u"].output}
        for name, part in parts.items():
            if tick % every[name] == 0:
                activation = part.u
                part.step(inputs[name], 0.5 * every[name])
                coming[name], part.u = part.u, activation
    for k, name in enumerate(("u.activation", "v.activation")):
        reference = np.array([pair[k] for pair in seen])
        np.testing.assert_allclose(record[name].values, reference, rtol=0, atol=1e-9 * abs(reference).max())


def test_the_state_of_a_slow_part_is_constant_between_its_ticks():
    model = dd.Model("slow")
    model.add(Boost("b", [], 4.0)) >> model.add(dd.Field("n", [], tau=20), ticks=4)
    activation = dd.simulate(model, 40, record="n.activation")["n.activation"].values
    assert np.flatnonzero(np.diff(activation)).tolist() == [3, 7, 11, 15, 19, 23, 27, 31, 35, 39]
