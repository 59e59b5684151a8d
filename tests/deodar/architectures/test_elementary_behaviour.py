"""The template against a plain version of its equations."""

from __future__ import annotations

import numpy as np

import deodar as dd
from deodar.architectures._elementary_behaviour import STRENGTHS, elementary_behaviour
from deodar.elements.stimuli import Pattern

X, Y = dd.Axis("x", 0, 29, 30, unit="cm"), dd.Axis("y", 0, 24, 25, unit="cm")
STEPS = 60


def kernel(samples: int, sigma: float) -> np.ndarray:
    """Return the matrix of a Gaussian of unit sum on a ring."""
    lag = np.arange(samples)[:, None] - np.arange(samples)[None, :]
    weights = sum(np.exp(-0.5 * ((lag + k * samples) / sigma) ** 2) for k in range(-5, 6))
    return np.asarray(weights / weights.sum(1, keepdims=True))


def spread(f: np.ndarray, sigma: float) -> np.ndarray:
    return kernel(f.shape[0], sigma) @ f @ kernel(f.shape[1], sigma).T


def moved(f: np.ndarray, dx: int, dy: int) -> np.ndarray:
    """Return the field shifted by whole cells; zeros enter at the ends."""
    out = np.zeros_like(f)
    nx, ny = f.shape
    out[max(dx, 0) : nx + min(dx, 0), max(dy, 0) : ny + min(dy, 0)] = f[
        max(-dx, 0) : nx + min(-dx, 0), max(-dy, 0) : ny + min(-dy, 0)
    ]
    return out


def test_sixty_steps_of_a_behaviour_agree_with_its_equations() -> None:
    x, y = X.points[:, None], Y.points[None, :]
    goal, place = (
        a * np.exp(-0.5 * (((x - 14) / 3) ** 2 + ((y - at) / 3) ** 2)) for a, at in ((10, 17), (8, 7))
    )
    model = elementary_behaviour([X, Y], (0.0, 5.0), noise=0.0, boundary="periodic")
    model.describe(time_unit="1 = 64 ms", dt=1.0)
    for name, values, target in (("goal", goal, "motivation"), ("place", place, "satisfaction")):
        model.add(Pattern(name, [X, Y], values)) >> model[target]  # type: ignore[arg-type]
    names = ("motivation", "precondition", "intention", "satisfaction")
    record = dd.simulate(
        model, STEPS, record=[f"{n}.activation" for n in names], every=STEPS, precision="float64"
    )

    u = {n: np.full((30, 25), -5.0) for n in names}
    for _ in range(STEPS):
        m, p, i, c = (1 / (1 + np.exp(-4 * u[n])) for n in names)
        north, south = (0, 5), (0, -5)
        rates = {
            "motivation": spread(7 * m, 2) - spread(2 * m, 4) + 5 * moved(p, *south) + goal,
            "precondition": spread(4 * p + 12 * moved(m, *south), 2) - spread(2 * p, 4) - 15 * moved(c, 0, 1),
            "intention": spread(9 * i + 10 * m - 10 * moved(p, *north) - 5 * c, 2),
            "satisfaction": spread(2 * c + 3 * i, 2) - spread(2 * c, 4) + place,
        }
        u = {n: u[n] + (-u[n] - 5 + rates[n]) / 5 for n in names}
    for n in names:
        assert u[n].max() > 0, "the plan has reached the place, and is carried out"
        np.testing.assert_allclose(record[f"{n}.activation"].values[-1], u[n], atol=1e-6)


def test_copies_share_one_document_parameter_for_each_strength() -> None:
    model = dd.Model("two")
    for name, direction in (("left", -1), ("right", 1)):
        model.insert(elementary_behaviour([X], [5.0 * direction]), name)
    for strength, expected in STRENGTHS.items():
        model.set(strength, 2 * expected)
    assert (
        model.get("left.precondition to motivation.factor")
        == model.get("right.precondition to motivation.factor")
        == 10
    )
    assert model.get("right.satisfaction to intention.kernel.0.amplitude") == -10
