"""Folded transforms are those by whole bases."""

from __future__ import annotations

import functools
import itertools
import math

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from jax import Array

from deodar.numerics.axes import Axis
from deodar.numerics.choice import Shards, by_waves, together
from deodar.numerics.transforms import from_waves, to_waves
from deodar.numerics.waves import Waves

RING, BORDER = Waves("periodic", 6, 6, 2), Waves("zero", 5, 9, 3, by_symmetry=True)


def waves(boundary: str, samples: int, parity: bool, symmetry: bool, highest: int | None = None) -> Waves:
    length = {"periodic": samples, "zero": samples + 5, "reflect": 2 * samples}[boundary]
    most = samples - 1 if boundary == "reflect" else length // 2
    return Waves(boundary, samples, length, most if highest is None else highest, parity, symmetry)


AXES = [
    waves(boundary, samples, parity, symmetry, highest)
    for boundary, samples, parity, symmetry, highest in itertools.product(
        ("periodic", "zero", "reflect"), (7, 8, 9, 10, 12), (False, True), (False, True), (None, 3)
    )
    if (parity or symmetry) and (not parity or (boundary == "periodic" and samples % 2 == 0))
]
"""Folded axes with each kind of boundaries, all modes or the slowest, and quarters and halves of even and odd
size.
"""


def whole(tables: list[np.ndarray], y: np.ndarray) -> np.ndarray:
    """Apply one matrix along each axis."""
    for d, table in enumerate(tables):
        y = np.moveaxis(np.tensordot(table, y, (1, d)), 0, d)
    return y


@functools.partial(jax.jit, static_argnums=0)
def there_and_back(axes: tuple[Waves, ...], y: Array) -> tuple[Array, Array]:
    """Return the modes of an array and the array of these modes, by one program: each operation alone would
    be compiled by itself.
    """
    modes = to_waves(axes, y)
    return modes, from_waves(axes, modes)


@pytest.mark.parametrize("w", AXES, ids=repr)
def test_folded_modes_span_the_same_functions_as_modes_in_one_class(w: Waves) -> None:
    waves = Waves(w.boundary, w.samples, w.length, w.highest)
    np.testing.assert_allclose(w.basis() @ w.basis().T, waves.basis() @ waves.basis().T, atol=1e-12)
    present = np.abs(w.basis()).max(axis=0) > 0
    assert sorted(w.turns[present]) == sorted(waves.turns)


BESIDE = [((), ()), ((), (RING,)), ((BORDER,), ()), ((), (RING, BORDER)), ((RING,), (BORDER,))]
"""Axes before and after a folded one."""


@pytest.mark.parametrize(
    ("w", "before", "after"),
    [(w, *BESIDE[(k + turn) % len(BESIDE)]) for k, w in enumerate(AXES) for turn in (0, 2)],
    ids=repr,
)
def test_folded_transforms_are_products_with_whole_bases(
    w: Waves, before: tuple[Waves, ...], after: tuple[Waves, ...]
) -> None:
    """To rounding in double precision, over one to three axes in any order; each folded axis has two of the
    five orders.
    """
    axes = (*before, w, *after)
    y = np.random.default_rng(1).normal(size=[axis_waves.samples for axis_waves in axes])
    with jax.enable_x64(True):
        modes, back = map(np.asarray, there_and_back(axes, jnp.asarray(y)))
    np.testing.assert_allclose(modes, whole([axis_waves.basis().T for axis_waves in axes], y), atol=1e-12)
    np.testing.assert_allclose(back, whole([axis_waves.basis() for axis_waves in axes], modes), atol=1e-12)


@pytest.mark.parametrize("w", [w for w in AXES if w.samples in (7, 10)], ids=repr)
def test_folded_transforms_keep_single_precision(w: Waves) -> None:
    y = np.random.default_rng(1).normal(size=(w.samples, 50)).astype(np.float32)
    axes = (w, Waves("periodic", 50, 50, 14, by_parity=True))
    modes, back = there_and_back(axes, jnp.asarray(y))
    assert modes.dtype == np.float32 and back.dtype == np.float32
    exact = whole([axis_waves.basis() @ axis_waves.basis().T for axis_waves in axes], y.astype(float))
    assert np.abs(back - exact).max() < 3e-6


@pytest.mark.parametrize("axes", [(RING, RING), (AXES[0], BORDER), (AXES[5], AXES[-1], BORDER)])
def test_copies_are_transformed_as_one_is(axes: tuple[Waves, ...]) -> None:
    """Copies in two nested batches, as trials of a group have them."""

    @functools.partial(jax.vmap, in_axes=1)
    @jax.vmap
    def filtered(y: Array) -> Array:
        return from_waves(axes, to_waves(axes, y))

    y = np.random.default_rng(1).normal(size=(2, 3, *(w.samples for w in axes)))
    with jax.enable_x64(True):
        output = np.asarray(jax.jit(filtered)(jnp.asarray(y)))
    projections = [w.basis() @ w.basis().T for w in axes]
    for j, k in itertools.product(range(3), range(2)):
        np.testing.assert_allclose(output[j, k], whole(projections, y[k, j]), atol=1e-12)


def test_only_the_cpu_folds() -> None:
    """On other devices a transform is one product for each axis."""
    axes = (AXES[-1], BORDER)
    y = jax.ShapeDtypeStruct((axes[0].samples, axes[1].samples), np.float32)
    traced = jax.jit(lambda y: to_waves(axes, y)).trace(y)
    reversals, products = {}, {}
    for platform in ("cpu", "cuda"):
        text = traced.lower(lowering_platforms=(platform,)).as_text()
        reversals[platform], products[platform] = text.count("reverse"), text.count("dot_general")
    assert reversals["cpu"] > 0 == reversals["cuda"]
    assert products["cuda"] == len(axes)


def folds(*axes: Waves, copies: int = 1) -> list[tuple[bool, bool]]:
    return [(w.by_parity, w.by_symmetry) for w in by_waves(axes, copies)[-1].waves]


def test_large_planes_fold_more_than_small_ones() -> None:
    """Halves of a ring are folded about their middles too if they are long enough."""

    def plane(samples: int, boundary: str = "periodic") -> list[tuple[bool, bool]]:
        w = waves(boundary, samples, False, False, samples // (2 if boundary == "reflect" else 4))
        return folds(w, w)

    no, symmetry, parity, both = (False, False), (False, True), (True, False), (True, True)
    assert plane(30) == [no, no]
    assert plane(50) == [parity, no]
    assert plane(100) == [both, parity]
    assert plane(101) == [symmetry, symmetry], "an odd ring has no opposite samples"
    assert plane(100, "zero") == plane(100, "reflect") == [symmetry, symmetry]
    assert plane(200) == [both, both]


def test_lines_fold_in_batches_and_volumes_along_their_first_axis() -> None:
    ring, small = waves("periodic", 200, False, False, 31), waves("periodic", 50, False, False, 13)
    assert folds(ring) == [(False, False)]
    assert folds(ring, copies=100) == [(True, True)]
    assert folds(small, small, small) == [(True, False), (False, False), (False, False)]


def test_shared_modes_are_folded() -> None:
    axes = tuple(Axis(name, 0, 99, 100) for name in "xy")
    widths = (2.0, 5.0), (2.0, 5.0)
    choice = together(axes, ("periodic", "periodic"), widths, 16)
    assert choice.method == "waves" and [w.classes for w in choice.waves] == [4, 1]
    divided = together(axes, ("periodic", "periodic"), widths, 16, Shards("y", 100, 2))
    assert divided.method == "waves" and choice.nanoseconds < divided.nanoseconds < math.inf
