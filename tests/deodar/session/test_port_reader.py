"""Readers of many ports, and inputs injected into a running model."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

import deodar as dd
from deodar.session.port_reader import port_reader

X = dd.Axis("x", 0, 100, samples=101)


def ring(n: int) -> dd.Model:
    """Return a ring of fields that differ in their resting levels, and a node of another structure."""
    model = dd.Model("ring")
    fields = [model.add(dd.Field(f"u{k}", [X], resting_level=-k)) for k in range(n)]
    for a, b in itertools.pairwise(fields):
        a >> dd.Gain(0.5) >> b
    fields[-1] >> model.add(dd.Field("node", []))
    return model


def test_a_reader_of_many_ports_agrees_with_single_readings() -> None:
    model = ring(4)
    session = dd.Session(model, precision="float64")
    session.step(20)
    places = [
        (h.id, port) for h in model for port in ("activation", "output", "input") if hasattr(h.element, "tau")
    ]
    seen = session.read_ports(port_reader(session.program, places), places)
    assert set(seen) == set(places)
    for h in model:
        for port in ("activation", "output", "input"):
            if (h.id, port) in seen:
                np.testing.assert_array_equal(seen[h.id, port], session.read(h[port]))


def test_elements_of_equal_structure_are_one_array_of_the_reader() -> None:
    model = ring(6)
    session = dd.Session(model)
    few = port_reader(session.program, [(model["u1"].id, "activation")])
    assert len(few.ports) <= 2, "a field of the ring stands with its kind in one array"
    assert few.fits([(model["u1"].id, "activation")]) and not few.fits([(model["u2"].id, "output")])


def test_unknown_ports_are_omitted() -> None:
    model = ring(2)
    session = dd.Session(model)
    places = [("feedbeef", "activation"), (model["u0"].id, "nonsense")]
    seen = port_reader(session.program, places)
    assert seen.ports == () and session.read_ports(seen, places) == {}


@pytest.mark.parametrize("noise", [0.0, 0.5])
def test_inject_gives_the_trajectory_of_a_connected_input(noise: float) -> None:
    """An injected input gives the trajectory of the same input through a connection, noise included."""
    model = dd.Model("pushed")
    u = model.add(dd.Field("u", [X], noise=noise, kernel=[dd.Gaussian(1, 5)]))
    model.add(dd.GaussianStimulus("s", [X], center=50, sigma=5, amplitude=3)) >> u
    free = dd.Session(model, seed=3, precision="float64")
    free.set("s.amplitude", 0.0)
    bound = dd.Session(model, seed=3, precision="float64")
    amount = 3 * np.exp(-0.5 * ((X.points - 50) / 5) ** 2)
    bound.step(50)
    free.inject("u", amount, 50)
    np.testing.assert_allclose(free.read("u.activation"), bound.read("u.activation"), atol=1e-9)
    assert (free.journal[-1].method, free.journal[-1].arguments[::2]) == ("inject", ("u", 50))


def test_inject_into_an_element_without_input_is_refused() -> None:
    model = dd.Model("m")
    model.add(dd.GaussianStimulus("s", [X]))
    model.add(dd.Field("slow", [X]), ticks=2)
    session = dd.Session(model)
    for path in ("s", "slow"):
        with pytest.raises(dd.errors.ParameterError, match="takes no input"):
            session.inject(path, 1.0)


def test_reset_with_a_seed_changes_the_seed() -> None:
    model = ring(1)
    model.set("u0.noise", 1.0)
    session, other = dd.Session(model, seed=1), dd.Session(model, seed=2)
    session.step(5)
    session.reset(seed=2)
    session.step(5)
    other.step(5)
    np.testing.assert_array_equal(session.read("u0.activation"), other.read("u0.activation"))
    assert session.seed == 2
