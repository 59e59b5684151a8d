"""Small records that several tests share."""

from __future__ import annotations

import xarray

import deodar as dd

x = dd.Axis("x", 0, 20, samples=11, unit="deg")
y = dd.Axis("y", 0, 10, samples=6, periodic=True)


def model(name: str = "small") -> dd.Model:
    model = dd.Model(name)
    model.add(dd.Field("u", [x], tau=10, kernel=[dd.Gaussian(1, 3)], noise=0.5))
    model.add(dd.Field("n", [], tau=10, noise=0.2))
    model.add(dd.Field('odd "name". u -> u (π)', [x, y], tau=10, noise=0.1))
    model.add(dd.GaussianStimulus("s", [x], center=10, sigma=3, amplitude=7)) >> model["u"]
    return model


def record(**settings: object) -> xarray.Dataset:
    paths = ["u.activation", "n.activation", dd.quote('odd "name". u -> u (π)') + ".output"]
    return dd.simulate(model(), 20, **({"record": paths, "every": 5, "seed": 3} | settings))  # type: ignore[arg-type]
