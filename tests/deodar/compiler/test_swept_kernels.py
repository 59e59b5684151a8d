"""Sweeps over parameters of kernels: which copies have matrices of their own, and how many run at once."""

from __future__ import annotations

import json

import numpy as np
import pytest

import deodar as dd
from deodar.compiler.build import Build
from deodar.compiler.copy_batch import Batch
from deodar.compiler.plan import plan
from deodar.model.document_graph import graph
from deodar.numerics import interaction
from deodar.recording.provenance import KEY
from deodar.session import memory

AMPLITUDE, WIDTH = "kernel.0.amplitude", "kernel.0.sigma"


def selection(shape: tuple[int, ...] = (40,)) -> dd.Model:
    axes = [dd.Axis(name, 0, n - 1, samples=n) for name, n in zip("xy", shape, strict=False)]
    model = dd.Model("selection")
    kernel = [dd.Gaussian(6.0, 3, normalized=True), dd.Gaussian(-2.0, 6, normalized=True)]
    u = model.add(dd.Field("u", axes, kernel=kernel, global_inhibition=0.2, noise=0.2))
    for name, place in (("left", 0.25), ("right", 0.75)):
        center = [place * n for n in shape]
        model.add(dd.GaussianStimulus(name, axes, center=center, sigma=3, amplitude=6)) >> u
    return model


@pytest.mark.parametrize(
    ("swept", "copies", "trials", "apart"),
    [
        ([AMPLITUDE], 20, 1, True),
        ([AMPLITUDE, "resting_level"], 20, 1, True),
        ([AMPLITUDE], 5, 1, False),  # too few to gain
        ([AMPLITUDE], 200, 10, False),  # the trials of a point share its sum of kernels
        ([AMPLITUDE, WIDTH], 20, 1, False),  # matrices differ anyway
        (["resting_level"], 20, 1, False),
    ],
)
def test_copies_that_differ_by_amplitudes_alone_share_matrices(
    swept: list[str], copies: int, trials: int, apart: bool
) -> None:
    document = selection().document
    (u,) = [e.id for e in document.entries if e.path == "u"]
    batch = Batch(copies // trials, trials, tuple(((u, path),) for path in swept))
    compiled = plan(Build(document, batch=batch))
    assert compiled.groups[compiled.row[u][0]].strategy.apart is apart


@pytest.mark.parametrize("shape", [(40,), (12, 14)])
def test_kernels_that_stay_apart_have_the_sum_of_the_mixed_ones(shape: tuple[int, ...]) -> None:
    u = selection(shape)["u"].element
    axes, y = tuple(u.axes), np.random.default_rng(1).random(shape)
    weights = interaction.prepare(u.kernel, axes, np.float32)
    mixed = interaction.mix(u.kernel, axes, weights)
    apart = interaction.mix(u.kernel, axes, weights, apart=True)
    assert "gain" not in apart
    assert apart["amplitudes"] == [6.0, -2.0] and apart["terms"][0][0] is weights[0]["matrices"][0][0]
    output = interaction.apply(apart, axes, y)
    np.testing.assert_allclose(output, interaction.apply(mixed, axes, y), rtol=1e-4, atol=1e-4)


@pytest.mark.parametrize("shape", [(40,), (200,), (12, 14)])
@pytest.mark.parametrize("path", [AMPLITUDE, WIDTH])
def test_a_sweep_over_a_kernel_gives_the_run_of_every_value(shape: tuple[int, ...], path: str) -> None:
    model, values = selection(shape), list(np.linspace(2.0, 5.0, 12))
    for precision, tolerance in (("float64", 1e-10), ("float32", 2e-4)):
        swept = dd.simulate(model, 60, sweep={f"u.{path}": values}, precision=precision)["u.activation"]
        for setting in (values[0], values[7]):
            single = selection(shape)
            single.set(f"u.{path}", setting)
            alone = dd.simulate(single, 60, precision=precision)["u.activation"].values
            point = swept.sel({f"u.{path}": setting}).values
            assert np.abs(point - alone).max() < tolerance
            assert np.ptp(alone) > 1


def test_matrices_of_each_copy_count_in_the_size_of_a_piece() -> None:
    document = selection((200,)).document
    nodes = graph(document).nodes
    (u,) = [e.id for e in document.entries if e.path == "u"]
    ports = memory.copy_bytes(nodes, "float32")
    assert ports < 10_000
    bytes_of_plan = memory.copy_bytes(nodes, "float32", {u})
    assert bytes_of_plan - ports >= 4 * 200**2
    assert memory.copy_bytes(nodes, "float32", {u}, trials=10) - ports == (bytes_of_plan - ports) // 10
    assert memory.copy_bytes(nodes, "float64", {u}) == 2 * bytes_of_plan
    few = dd.simulate(selection((200,)), 2, sweep={f"u.{WIDTH}": list(np.linspace(2, 4, 100))})
    many = dd.simulate(selection((200,)), 2, sweep={f"u.{AMPLITUDE}": list(np.linspace(2, 4, 100))})
    assert batch(few) < 20 and batch(many) == 100


def batch(record: object) -> int:

    return json.loads(record.attrs[KEY])["batch"]  # type: ignore[attr-defined]
