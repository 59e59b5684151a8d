"""The memory of a run grows only with its record."""

from __future__ import annotations

import itertools
import subprocess
import sys

import jax
import numpy as np
import psutil
import pytest

import deodar as dd
from deodar.compiler.strategies import acted_axes
from deodar.errors import TooLarge
from deodar.model.document_graph import graph
from deodar.numerics import interaction
from deodar.session import memory

CODE = """
import psutil, deodar as dd
x = dd.Axis("x", 0, 100, samples=2001)
model = dd.Model("memory")
model.add(dd.Field("u", [x], noise=0.1))
def grown(steps, **record):
    before = psutil.Process().memory_info().rss
    kept = dd.simulate(model, steps, **record)
    return (psutil.Process().memory_info().rss - before) / 2**20, kept.nbytes / 2**20
# what compiling and the first buffers take is not counted: the smallest growth of two like runs;
# buffers of 16 MiB come and go
silent = min(grown(16000)[0] for _ in range(4))
sparse, size = min(grown(16000, record=["u.activation"], every=100) for _ in range(2))
dense, large = min(grown(16000, record=["u.activation"]) for _ in range(2))
print(silent, sparse, size, dense, large)
assert silent < 40, silent
assert sparse < 40 + size, sparse
assert 100 < large and dense < 60 + 2 * large, dense
"""


def test_memory_of_a_long_run_grows_only_with_the_record() -> None:
    done = subprocess.run([sys.executable, "-c", CODE], capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stdout + done.stderr


GRIDS = ((101,), (1001,), (20_000,), (51, 51), (201, 101), (400, 400), (31, 31, 31), (60, 60, 60))
KERNELS = ([dd.Gaussian(5, 1.0)], [dd.Gaussian(5, 5.0), dd.Gaussian(-2, 12.0)])


@pytest.mark.parametrize("grid", GRIDS, ids=str)
def test_kernels_count_as_the_planner_applies_them(grid: tuple[int, ...]) -> None:
    for periodic, kernel in itertools.product((False, True), KERNELS):
        axes = [dd.Axis(f"x{d}", 0, 100, samples, periodic) for d, samples in enumerate(grid)]
        model = dd.Model("m")
        model.add(dd.Field("u", axes, kernel=kernel))
        [node] = graph(model.document).nodes
        kernels, over = node.element.kernels(), acted_axes(node)
        chosen = interaction.choices(kernels, over)

        def arrays(kernels=kernels, over=over, chosen=chosen):  # type: ignore[no-untyped-def]
            weights = interaction.prepare(kernels, over, np.float32, chosen)
            return weights, interaction.mix(kernels, over, weights)

        leaves = jax.tree.leaves(jax.eval_shape(arrays))
        values = sum(int(np.prod(a.shape)) * (2 if a.dtype.kind == "c" else 1) for a in leaves)
        # to modes, and back
        values += sum(
            2 * w.samples * w.count for c in chosen.values() if c.method == "waves" for w in c.waves
        )
        estimate, two = (memory.run_bytes([node], "float32", copies) / 4 for copies in (1, 2))
        states = two - estimate
        assert 0.5 < estimate / (values + states) < 2, (periodic, len(kernel), chosen)


def test_a_large_field_is_refused_only_where_its_kernel_is_a_matrix(monkeypatch: pytest.MonkeyPatch) -> None:
    class Free:
        available = 2 * 2**30

    monkeypatch.setattr(psutil, "virtual_memory", Free)
    model = dd.Model("m")
    model.add(dd.Field("u", [dd.Axis("x", 0, 1e5, samples=100_000)], kernel=[dd.Gaussian(5, 5.0)]))
    s = dd.Session(model)
    s.step(2)
    assert np.isfinite(s.read("u")).all()
    for precision in ("float64", "float32-exact"):
        with pytest.raises(TooLarge, match=r"GiB are free; most of it is u \(x: 100000\)"):
            dd.Session(model, precision=precision)
