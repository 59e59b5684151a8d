"""The programs that benchmarks time: the reference in C and the model follow one equation, its noise is
normal, and the models agree with their names.
"""

from __future__ import annotations

import math
import subprocess
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
import pytest

import deodar as dd
from deodar.compiler.build import Build
from deodar.compiler.plan import plan
from deodar.couplings.convolutions import Convolve

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
import steps
import workloads

SHAPES = [
    ((100,), (5, 10), 2),
    ((37,), (2, 4), 1),
    ((50, 50), (3, 6), 1),
    ((20, 33), (3, 6), 2),
    ((9, 130), (3, 2), 1),
    ((12, 20, 30), (3, 6), 1),
]


def reference(shape: Sequence[int], sigmas: Sequence[int], count: int) -> np.ndarray:
    """The activation after `count` steps without noise; kernels cut at 2.5 sigma, convolution by Fourier
    transform, double precision.
    """
    stimulus, spectrum = np.array(6.0), np.zeros(shape, complex)
    for n in shape:
        stimulus = np.multiply.outer(stimulus, np.exp(-0.5 * ((np.arange(n) - n // 2) / 3) ** 2))
    for amplitude, sigma in zip((15, -8), sigmas, strict=True):
        product = np.array(amplitude, complex)
        for n in shape:
            radius = min(math.ceil(2.5 * sigma), (n - 1) // 2)
            x = np.arange(-radius, radius + 1)
            taps = np.exp(-0.5 * (x / sigma) ** 2)
            ring = np.zeros(n)
            np.add.at(ring, x % n, taps / taps.sum())
            product = np.multiply.outer(product, np.fft.fft(ring))
        spectrum += product
    u = np.full(shape, -5.0)
    for _ in range(count):
        g = 1 / (1 + np.exp(-4 * u))
        u = u + (-u - 5 + stimulus + np.fft.ifftn(np.fft.fftn(g) * spectrum).real - 0.1 * g.sum()) / 20
    return u


def answer(program: Path, what: str, count: int) -> np.ndarray:
    return np.frombuffer(
        subprocess.run([program, what, str(count)], check=True, capture_output=True).stdout, np.float32
    )


JUDGED = pytest.mark.parametrize("cc", [cc for cc in [steps.compiler()] if cc], ids=lambda cc: Path(cc).name)
"""No case without a C compiler, which pytest shows as skipped."""


@JUDGED
def test_the_yardstick_follows_its_equation(cc: str, tmp_path: Path) -> None:
    for shape, sigmas, trials in SHAPES:
        program = steps.build(cc, tmp_path, "field", shape, sigmas, trials)
        expected = reference(shape, sigmas, 200)
        assert expected.max() > 0.3  # a peak has formed, kernels count
        state = answer(program, "state", 200).reshape(trials, *shape)
        assert np.abs(state - expected).max() <= 1e-4, shape


@JUDGED
def test_the_noise_of_the_yardstick_is_normal(cc: str, tmp_path: Path) -> None:
    program = steps.build(cc, tmp_path, "noise", (512,), (5, 10), 1)
    z = answer(program, "normals", 2000).astype(float)
    root = math.sqrt(z.size)
    assert abs(z.mean()) < 4 / root and abs(z.var() - 1) < 4 * math.sqrt(2) / root
    assert abs((z**3).mean()) < 4 * math.sqrt(15) / root and abs((z**4).mean() - 3) < 4 * math.sqrt(96) / root
    assert (np.abs(z) > 3).mean() == pytest.approx(0.0027, rel=0.1)
    both = z.reshape(-1, 2, 16)
    assert abs((both[:, 0] * both[:, 1]).mean()) < 4 * math.sqrt(2) / root


def test_the_model_and_the_yardstick_compute_the_same_values(tmp_path: Path) -> None:
    """They differ only by the ends of the kernels, which shift a peak of 3 to 7 by less than 0.15."""
    for shape, sigmas in (((100,), (5, 10)), ((50, 50), (3, 6))):
        model = workloads.single(shape, sigmas)
        model.set("u.noise", 0.0)
        ours = dd.simulate(model, 200)["u.activation"].values[0]
        assert np.abs(ours - reference(shape, sigmas, 200)).max() < 0.15


@pytest.mark.parametrize(("name", "fields", "nodes", "couplings"), [("W4a", 20, 20, 20), ("W4b", 16, 0, 16)])
def test_shuffled_architectures_have_the_size_of_the_originals(
    name: str, fields: int, nodes: int, couplings: int
) -> None:
    sizes, edges = [], []
    for which in (name, name + "_shuffled"):
        model = workloads.WORKLOADS[which].model()
        elements = [handle.element for handle in model]
        model.require()
        assert sum(isinstance(e, dd.Field) and len(e.axes) > 0 for e in elements) == fields
        assert sum(isinstance(e, dd.Field) and not e.axes for e in elements) == nodes
        assert sum(isinstance(e, Convolve) for e in elements) == couplings
        sizes.append(
            (len(elements), len(model.document.connections), len(plan(Build(model.document)).groups))
        )
        edges.append({(c.source, c.target) for c in model.document.connections})
    assert sizes[0] == sizes[1] and edges[0] != edges[1]


def test_shuffled_targets_are_a_permutation_with_few_neighbours_of_the_ring() -> None:
    for count, seed in ((20, 1), (16, 1), (5, None)):
        to = workloads.targets(count, seed)
        assert sum(target == (k + 1) % count for k, target in enumerate(to)) < 4 or seed is None
        assert sorted(to) == list(range(count)) and all(k != target for k, target in enumerate(to))


class Ramp(dd.World):
    """A world whose reading is its time; it notes when it was read."""

    sensors: Mapping[str, dd.Signal] = {"ramp": dd.Signal("ramp", ())}
    motors: Mapping[str, dd.Signal] = {}
    period = 1.0

    def __init__(self) -> None:
        self.read: list[float] = []

    def reset(self, seed: int, trials: Sequence[int] = (0,), precision: str = "float32") -> None:
        self.read = []

    def sense(self, sensor: str, axes: Sequence[dd.Axis], time: float) -> np.ndarray:
        self.read.append(time)
        return np.array(time)

    def act(self, motors: Mapping[str, np.ndarray], time: float) -> None:
        pass


def watched() -> dd.Model:
    model = dd.Model("watched")
    model.add(dd.Sensor("s", [], "ramp")) >> model.add(dd.Field("u", tau=20, resting_level=-5))
    return model


@pytest.mark.parametrize(("session", "expected"), [(False, [13, 13]), (True, [16, 28])])
def test_a_workload_with_a_world_steps_beside_it(
    session: bool, expected: list[int], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each call of `dd.simulate` is a new run, which reads once more at its end; a session continues."""
    worlds: list[Ramp] = []

    def world() -> Ramp:
        worlds.append(Ramp())
        return worlds[-1]

    workload = workloads.Workload(watched, "a field and a ramp", None, world=world, session=session)
    monkeypatch.setitem(workloads.WORKLOADS, "ramp", workload)
    timed = steps.Timed()
    steps_taken = []
    for _ in range(2):
        assert timed.run("ramp", 12) >= 0
        steps_taken.append(len(worlds[-1].read))
    assert steps_taken == expected and len(worlds) == (1 if session else 2)


def test_without_a_compiler_the_ratio_is_left_out(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(steps, "compiler", lambda: None)
    (row,) = steps.measure(["W1_100"], 1, 0.001, tmp_path)
    assert row.ratio is None and row.earlier is None and row.c_us is None and math.isfinite(row.us)
