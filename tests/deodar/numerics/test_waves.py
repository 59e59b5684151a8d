"""Waves and Fourier transforms in place of matrices: the same convolution, cheaper, and only where it may
be.
"""

from __future__ import annotations

import dataclasses as dc
import functools
import itertools
import json
from collections.abc import Callable, Sequence
from typing import Any

import jax
import numpy as np
import pytest

import deodar as dd
from deodar.errors import ParameterError
from deodar.numerics import interaction
from deodar.numerics.axes import Axis
from deodar.numerics.choice import Choice, bounds, bucket, candidates, choose
from deodar.numerics.kernels.separable import MexicanHat
from deodar.numerics.waves import Waves
from tests.deodar.compiler.programs import executable

BOUNDARIES = ("periodic", "zero", "reflect")


@pytest.mark.parametrize(("boundary", "samples"), list(itertools.product(BOUNDARIES, (7, 8))))
def test_the_waves_are_an_orthonormal_basis(boundary: str, samples: int) -> None:
    length = {"periodic": samples, "zero": samples + 5, "reflect": 2 * samples}[boundary]
    waves = Waves(boundary, samples, length, samples - 1 if boundary == "reflect" else length // 2)
    table = waves.basis()
    assert table.shape == (samples, waves.count)
    np.testing.assert_allclose(table @ table.T, np.eye(samples), atol=1e-12)


def convolution(
    kernels: list[dd.Gaussian], axes: tuple[Axis, ...], planned: bool
) -> Callable[[np.ndarray], np.ndarray]:
    """Return a function that convolves, in double precision, by one program: each operation alone would be
    compiled by itself.
    """
    chosen = interaction.choices(kernels, axes) if planned else {}

    @jax.jit
    def convolved(y: jax.Array) -> jax.Array:
        weights = interaction.prepare(kernels, axes, np.dtype("float64"), chosen)
        return interaction.apply(interaction.mix(kernels, axes, weights), axes, y, chosen)

    def applied(y: np.ndarray) -> np.ndarray:
        with jax.enable_x64(True):
            return np.asarray(convolved(jax.numpy.asarray(y)))

    return applied


RECTANGLE = Axis("x", 0, 39, 40), Axis("y", -1, 1, 33)


def two_gaussians(first: str, second: str) -> list[dd.Gaussian]:
    """Return kernels of different widths, one of them anisotropic."""
    return [
        dd.Gaussian(7, (3.0, 0.2), boundary=[first, second]),
        dd.Gaussian(-4, (5.0, 0.3), boundary=[first, second], normalized=True),
    ]


@functools.cache
def by_matrices(first: str, second: str) -> tuple[np.ndarray, float]:
    """Return a pattern on a rectangle that is convolved by matrices, and the largest sum of weights."""
    exact = convolution(two_gaussians(first, second), RECTANGLE, False)
    return exact(np.random.default_rng(1).random((40, 33))), np.abs(exact(np.ones((40, 33)))).max()


@pytest.mark.parametrize(
    ("first", "second", "way"),
    [
        (first, second, method)
        for first, second in itertools.product(BOUNDARIES, repeat=2)
        for method in ("waves", "folded", "fourier")
        if method != "fourier" or "reflect" not in (first, second)
    ],
)
def test_every_strategy_agrees_with_matrices(
    first: str, second: str, way: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """To 1e-5 of the sum of absolute weights, for kernels of different widths, one of them anisotropic, on a
    rectangle.
    """
    if way == "folded":

        def chosen(*arguments: Any) -> Choice:
            return Choice("waves", tuple(dc.replace(w, by_symmetry=True) for w in choose_waves(*arguments)))

    else:

        def chosen(*arguments: Any) -> Choice:
            return Choice(way, choose_waves(*arguments))

    monkeypatch.setattr(interaction, "choose", chosen)
    exact, total = by_matrices(first, second)
    convolved = convolution(two_gaussians(first, second), RECTANGLE, True)
    difference = convolved(np.random.default_rng(1).random((40, 33))) - exact
    assert np.abs(difference).max() < 1e-4 * total


def test_a_mirror_has_waves_and_no_fourier_transform() -> None:
    axes, widths = (Axis("x", 0, 399, 400), Axis("y", 0, 399, 400)), ((1.0, 2.0), (1.0, 2.0))
    for pair in itertools.product(BOUNDARIES, repeat=2):
        methods = {choice.method for choice in candidates(axes, pair, widths, 2)}
        assert "waves" in methods and ("fourier" in methods) == ("reflect" not in pair), pair


def choose_waves(
    axes: tuple[Axis, ...], boundaries: tuple[str, ...], widths: tuple[tuple[float, float], ...], *others: int
) -> tuple[Waves, ...]:
    from deodar.numerics.choice import _waves  # pyright: ignore[reportPrivateUsage]

    return tuple(
        _waves(a.samples, b, low / a.step, high / a.step)
        for a, b, (low, high) in zip(axes, boundaries, widths, strict=True)
    )


@pytest.mark.parametrize("boundary", BOUNDARIES)
def test_taps_agree_with_matrices(boundary: str) -> None:
    axes = (Axis("x", 0, 199, 200),)
    kernels = [
        dd.Gaussian(7, 3.0, boundary=[boundary]),
        dd.Gaussian(-4, 6.0, boundary=[boundary], normalized=True),
    ]
    assert [c.method for c in interaction.choices(kernels, axes).values()] == ["taps"]
    y = np.random.default_rng(1).random(200)
    exact, taps = (convolution(kernels, axes, planned) for planned in (False, True))
    assert np.abs(taps(y) - exact(y)).max() < 1e-5 * np.abs(exact(np.ones(200))).max()


@pytest.mark.parametrize(("first", "second"), list(itertools.product(BOUNDARIES, repeat=2)))
def test_taps_over_a_plane_agree_with_matrices(
    first: str, second: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    def taps(*arguments: Any) -> Choice:
        return next(c for c in candidates(*arguments[:5]) if c.method == "taps")

    monkeypatch.setattr(interaction, "choose", taps)
    axes = (Axis("x", 0, 39, 40), Axis("y", 0, 58, 30))
    kernels = [
        dd.Gaussian(7, (1.0, 2.0), boundary=[first, second]),
        dd.Gaussian(-4, 1.1, boundary=[first, second], normalized=True),
    ]
    [choice] = interaction.choices(kernels, axes).values()
    assert choice.reaches == (6, 6), "five widths of the upper bound of the widest bucket, in samples"
    y = np.random.default_rng(1).random((40, 30))
    exact, planned = (convolution(kernels, axes, by_plan) for by_plan in (False, True))
    assert np.abs(planned(y) - exact(y)).max() < 1e-5 * np.abs(exact(np.ones((40, 30)))).max()


def test_a_bucket_contains_its_width() -> None:
    for width in (1e-3, 0.7, 1.0, 3.0, 1000.0):
        low, high = bounds(bucket(width))
        assert low <= width * (1 + 1e-9) and width < high * (1 + 1e-9) and high / low < 1.2


def test_the_strategy_with_the_lowest_cost_is_chosen() -> None:
    line = (Axis("x", 0, 99, 100),)
    square, large = (
        tuple(Axis(a, 0, 49, 50, periodic=True) for a in "xy"),
        tuple(Axis(a, 0, 399, 400, periodic=True) for a in "xy"),
    )
    assert choose(line, ("zero",), ((3.0, 6.0),), 2).method == "matrices", "a small field takes its matrix"
    longer = (Axis("x", 0, 499, 500),)
    assert choose(longer, ("zero",), ((3.0, 12.0),), 2).method == "taps"
    assert choose(longer, ("zero",), ((30.0, 90.0),), 2).method == "waves", (
        "wide kernels have many taps and few waves"
    )
    assert choose(square, ("periodic",) * 2, ((3.0, 6.0),) * 2, 2).method == "waves"
    assert choose(large, ("periodic",) * 2, ((1.0, 2.0),) * 2, 3).method == "fourier", (
        "narrow kernels need many waves"
    )
    assert choose(square, ("periodic",) * 2, ((0.2, 0.3),) * 2, 1).method == "taps", (
        "one narrow kernel has few taps"
    )
    volume = tuple(Axis(a, 0, 39, 40, periodic=True) for a in "xyz")
    assert choose(volume, ("periodic",) * 3, ((0.2, 0.3),) * 3, 1).method == "matrices"


SQUARE = [dd.Axis("x", 0, 60, samples=61), dd.Axis("y", 0, 50, samples=51)]
TORUS = [dd.Axis(name, 0, 100, samples=100, periodic=True) for name in "xy"]


def model(sigma: float = 4.0, axes: Sequence[dd.Axis] = SQUARE) -> dd.Model:
    model = dd.Model("plane")
    kernel = [
        dd.Gaussian(15, sigma, normalized=True),
        MexicanHat(4, 4, 2, 8, normalized=True, boundary=["reflect"]),
        dd.Gaussian(-0.1, 9.0),
    ]
    u = model.add(dd.Field("u", axes, kernel=kernel, global_inhibition=0.001))
    model.add(dd.GaussianStimulus("s", axes, center=[20, 48], sigma=4, amplitude=8)) >> u
    model.add(dd.GaussianStimulus("t", axes, center=[59, 10], sigma=3, amplitude=7)) >> u
    return model


@pytest.mark.parametrize(("sigma", "axes", "classes"), [(4.0, SQUARE, [2, 1]), (3.0, TORUS, [4, 2])])
def test_default_strategies_are_within_1e_4_of_exact_ones(
    sigma: float, axes: list[dd.Axis], classes: list[int]
) -> None:
    """1e-4 in activation after 400 steps without noise, with peaks at the borders and folded transforms."""
    coupled = model(sigma, axes)
    field = coupled["u"].element
    choice = next(iter(interaction.choices(field.kernel, tuple(field.axes)).values()))
    assert choice.method == "waves" and [w.classes for w in choice.waves] == classes
    exact = dd.simulate(coupled, 400, precision="float64")["u.activation"].values
    default = dd.simulate(coupled, 400)["u.activation"].values
    assert exact.max() > 3 and np.abs(default - exact).max() < 1e-4


def test_exact_accuracy_uses_matrices_and_is_stated_in_the_record() -> None:
    coupled = model()
    exact = dd.simulate(coupled, 100, precision="float64")["u.activation"].values
    asked = dd.simulate(coupled, 100, precision="float32-exact")
    assert np.abs(asked["u.activation"].values - exact).max() < 2e-5
    assert (
        executable(coupled, accuracy="exact").plan.describe().count("waves")
        == 0
        < executable(coupled).plan.describe().count("waves")
    )
    assert json.loads(asked.attrs["deodar"])["accuracy"] == "exact"
    session = dd.Session(coupled, precision="float32-exact")
    assert session.set("u.kernel.0.sigma", 2.0) == "rebuild", "matrices hold at any width"
    with pytest.raises(ParameterError, match="float32, float32-exact, float64"):
        dd.simulate(coupled, 1, precision="high")


def test_only_widths_outside_of_the_bucket_recompile() -> None:
    coupled = model(4.2)
    session = dd.Session(coupled)
    session.step(50)
    low, high = bounds(bucket(4.2))
    assert session.set("u.kernel.0.sigma", 0.5 * (4.2 + high)) == "rebuild"
    assert session.set("u.kernel.0.sigma", 2.0) == "recompile"
    session.step(350)
    double = dd.Session(coupled, precision="float64")
    double.step(50)
    double.set("u.kernel.0.sigma", 2.0)
    double.step(350)
    assert low < 4.2 and np.abs(session.read("u.activation") - double.read("u.activation")).max() < 1e-3


def test_a_sweep_over_widths_is_valid_for_all_of_them() -> None:
    coupled = model()
    widths = [1.0, 4.0, 12.0]
    swept = dd.simulate(coupled, 100, sweep={"u.kernel.0.sigma": widths})["u.activation"]
    for k, width in enumerate(widths):
        coupled.set("u.kernel.0.sigma", width)
        alone = dd.simulate(coupled, 100, precision="float64")["u.activation"].values
        assert np.abs(swept.values[k] - alone).max() < 1e-3
