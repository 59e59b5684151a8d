"""Where programs call the compiled kernels. A module in JAX takes their place here; `native/tests` tests the
kernels themselves.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType

import jax.numpy as jnp
import numpy as np
import pytest
from jax import Array

import deodar as dd
from deodar.cli import main
from deodar.compiler import executable as executables
from deodar.numerics import convolution, native, noise, transforms
from deodar.numerics.waves import Waves
from deodar.recording.provenance import KEY
from deodar.recording.repeat import repeat
from tests.deodar.compiler.programs import executable


def _noise(key: Array, tick: Array, start: Array, drawn: Array) -> Array:
    """Return the deviates of deodar, each moved by 1e-3, so that a test can tell who drew them."""
    new = noise.block(drawn.shape[-1], key, tick, jnp.float32)
    moved = jnp.stack([jnp.real(new), jnp.imag(new)]) + 1e-3
    return jnp.where((tick % 2 == 0) | (tick == start), moved, drawn)


@pytest.fixture
def installed(monkeypatch: pytest.MonkeyPatch) -> Iterator[ModuleType]:
    """Return a module that takes the place of the distribution."""
    module = ModuleType("deodar_native")
    module.__dict__.update(
        __version__="9.8.7", INTERFACE=native.INTERFACE, vectors=lambda: "wide", noise=_noise
    )
    monkeypatch.setitem(sys.modules, "deodar_native", module)
    monkeypatch.delenv(native.SWITCH)
    native._installed.cache_clear()
    yield module
    native._installed.cache_clear()
    executables._shared.cache_clear()


def model() -> dd.Model:
    """Return a field that is large enough for the kernels."""
    model = dd.Model("noise alone")
    model.add(dd.Field("u", [dd.Axis("x", 0, 1200, samples=1200)], tau=20, resting_level=0, noise=1.0))
    return model


def run(**settings: str) -> np.ndarray:
    return dd.simulate(model(), 3, seed=1, **settings)["u.activation"].values


def test_a_model_in_single_precision_gets_its_noise_from_the_kernels(
    installed: ModuleType, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert executable(model()).kernels is installed
    values = run()
    monkeypatch.setenv(native.SWITCH, "off")
    assert executable(model()).kernels is None
    # u after three steps from 0: each adds the shift 1e-3 / tau, and leaves 19/20 of u
    shift = 1e-3 / 20 * (1 + 0.95 + 0.95**2)
    np.testing.assert_allclose(values - run(), shift, rtol=0, atol=1e-6)


def _line(weights: Array, y: Array, boundary: str) -> Array:
    return 1.5 * convolution.tapped(weights, y, boundary)


@pytest.mark.parametrize(("samples", "factor"), [(400, 1.0), (500, 1.5)])
def test_a_convolution_over_one_axis_is_a_kernel_from_a_number_of_lags_on(
    installed: ModuleType, samples: int, factor: float
) -> None:
    installed.__dict__["line"] = _line
    weights, y = jnp.linspace(1, 0, 31), jnp.linspace(0, 1, samples)
    assert (30 * samples >= native.LEAST_LINE) == (factor > 1)
    output = convolution.tapped(weights, y, "zero", kernels=native.kernels("cpu", "float32"))
    np.testing.assert_allclose(output, factor * convolution.tapped(weights, y, "zero"), rtol=1e-6)


def test_kernels_transform_planes_that_are_not_large(installed: ModuleType) -> None:
    """A kernel that scales modes by 3 and back by 5 shows which of both transforms it replaces."""
    axis = Waves("periodic", 12, 12, 3)
    y = jnp.asarray(np.random.default_rng(0).random((12, 12)), jnp.float32)
    installed.__dict__["to_modes"] = lambda axes, y: 3 * transforms.to_waves(axes, y)
    installed.__dict__["from_modes"] = lambda axes, y: 5 * transforms.from_waves(axes, y)
    kernels = native.kernels("cpu", "float32")
    waves = transforms.to_waves((axis, axis), y, kernels)
    np.testing.assert_allclose(waves, 3 * transforms.to_waves((axis, axis), y), rtol=1e-5, atol=1e-6)
    back = transforms.from_waves((axis, axis), waves, kernels)
    np.testing.assert_allclose(back, 5 * transforms.from_waves((axis, axis), waves), rtol=1e-5, atol=1e-6)
    large = Waves("periodic", 400, 400, 3)
    assert not native.transforms(kernels, (large, large))
    assert not native.transforms(kernels, (axis, axis, axis)) and not native.transforms(kernels, (axis,))
    installed.__dict__["vectors"] = lambda: "plain"
    assert not native.transforms(kernels, (axis, axis))


def test_double_precision_and_other_devices_do_without_the_kernels(installed: ModuleType) -> None:
    assert executable(model(), precision="float64").kernels is None
    assert native.kernels("gpu", "float32") is None
    assert native.kernels("cpu", "float32") is installed


def test_records_name_the_kernels_that_made_them(
    installed: ModuleType, monkeypatch: pytest.MonkeyPatch
) -> None:
    def made_by(**settings: str) -> dict[str, str]:
        return json.loads(dd.simulate(model(), 3, **settings).attrs[KEY])["made_by"]

    assert made_by()["deodar-native"] == "9.8.7 wide"
    assert "deodar-native" not in made_by(precision="float64")
    record = dd.simulate(model(), 3)
    monkeypatch.setenv(native.SWITCH, "off")
    assert "deodar-native" not in made_by()
    done = repeat(record, dd.simulate)
    assert not done.same_bits and [d.what for d in done.differences] == ["deodar-native"]


def test_the_cache_distinguishes_versions_of_the_kernels(
    installed: ModuleType, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv("DEODAR_CACHE", str(tmp_path))
    for version, compiled in (("9.8.7", 1), ("9.8.7", 0), ("9.8.8", 1)):
        installed.__version__ = version
        executables._shared.cache_clear()
        program = executable(model())
        program.reader([])
        assert program.compiled == compiled


@pytest.mark.parametrize(
    ("attributes", "problem"),
    [
        ({"INTERFACE": native.INTERFACE + 1}, f"has interface {native.INTERFACE + 1}; this deodar needs"),
        ({"vectors": lambda: 1 / 0}, "cannot be loaded: division by zero"),
    ],
)
def test_a_distribution_that_does_not_fit_is_not_used_and_doctor_says_why(
    installed: ModuleType, attributes: dict[str, object], problem: str, capsys: pytest.CaptureFixture[str]
) -> None:
    installed.__dict__.update(attributes)
    assert native.kernels("cpu", "float32") is None and problem in native.problem()
    main(["doctor"])
    assert f"PROBLEM: deodar-native {problem}" in capsys.readouterr().out


def test_doctor_names_the_kernels_or_why_there_are_none(
    installed: ModuleType, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def line() -> str:
        main(["doctor"])
        return next(li for li in capsys.readouterr().out.splitlines() if li.startswith("kernels"))

    assert line() == "kernels    deodar-native 9.8.7 wide"
    monkeypatch.setenv(native.SWITCH, "off")
    assert line() == "kernels    compiled kernels are not used (DEODAR_NATIVE=off)"
    monkeypatch.delenv(native.SWITCH)
    monkeypatch.setitem(sys.modules, "deodar_native", None)  # importing it raises ModuleNotFoundError
    native._installed.cache_clear()
    assert line() == "kernels    deodar-native is not installed (docs/speed.md)"
