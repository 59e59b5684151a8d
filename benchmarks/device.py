"""Another device beside the CPU: the same noise, the same fields, and what a step takes: `python
benchmarks/device.py [--device gpu]`.

Fails (status 1) unless the words of the noise generator are the same integers on both, and unless without
noise no activation differs by more than 1e-4 after 400 steps. With products in fewer digits (TF32) it would
not hold. Status 2: there is no such device.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Callable
from typing import Any

import jax
import numpy as np

import deodar as dd
import workloads
from deodar.compiler import device
from deodar.errors import DeviceError
from deodar.numerics.noise import bits, element_keys

STEPS, NEAR = 400, 1e-4
NAMES = ("W1_100", "W1_200", "W2_50", "W2_100", "W2_200", "W3", "W4a", "W4b")
TIMED = {
    "W1_200": (None, 64),
    "W2_50": (None, 64),
    "W2_200": (None, 16),
    "W3": (None,),
    "W4a": (None,),
    "W4b": (None,),
}
"""Workloads whose steps are timed, and the number of copies in a batch; None: one copy."""


def same_noise(other: Any) -> bool:
    """Whether the generator gives the same integers on both devices."""

    def words(seed: Any) -> Any:
        keys = element_keys(seed, np.uint32(7), np.arange(5, dtype=np.uint32))
        return [bits(1000, key, np.uint32(block)) for key in keys for block in (0, 1, 12345)]

    seen: list[Any] = []
    for place in (jax.devices("cpu")[0], other):
        with jax.default_device(place):
            seen.append([np.asarray(word) for pair in jax.jit(words)(np.uint32(3)) for word in pair])
    return all(np.array_equal(a, b) and a.dtype == np.uint32 for a, b in zip(*seen, strict=True))


def difference(name: str, where: str, double: bool = False) -> float:
    """The largest difference of any activation after STEPS steps without noise."""
    model = workloads.WORKLOADS[name].model()
    for handle in model:
        if isinstance(handle.element, dd.Field):
            model.set(f"{handle.path}.noise", 0.0)
    precision = "float64" if double else "float32"
    here, there = (
        dd.simulate(model, STEPS, precision=precision, on=dd.Resources(device=d, progress=False))
        for d in ("cpu", where)
    )
    return max(float(np.abs(here[v].values - there[v].values).max()) for v in here.data_vars)


def step(run: Callable[[int], Any], seconds: float = 0.3) -> float:
    """Wall microseconds a step: (T(3n) - T(n)) / 2n, where n steps take about `seconds`."""

    def wall(n: int) -> float:
        before = time.perf_counter()
        run(n)
        return time.perf_counter() - before

    wall(40)
    n = max(40, int(40 * seconds / wall(40)))
    return (wall(3 * n) - wall(n)) / (2 * n) * 1e6


def main() -> int:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--device", default="gpu", help="the device beside the CPU (default gpu)")
    parser.add_argument("--no-times", action="store_true", help="only whether they agree")
    given = parser.parse_args()
    dd.use_cores(1)
    try:
        other = device.find(given.device)
    except DeviceError as error:
        print(f"{error}", file=sys.stderr)
        return 2
    print(f"jax {jax.__version__}, {device.name(other)}: {other.device_kind}")
    good = same_noise(other)
    print(f"the generator's integers: {'the same' if good else 'DIFFERENT'}", flush=True)
    for name in NAMES:
        largest = difference(name, given.device)
        holds = largest <= NEAR
        good = good and holds
        print(
            f"{name:8} after {STEPS} steps without noise: differs by {largest:.2e}"
            f" {'' if holds else f'MORE THAN {NEAR:g}'}",
            flush=True,
        )
    for name, copies in {} if given.no_times else TIMED.items():
        for trials in copies:
            model = workloads.WORKLOADS[name].model()
            us = [
                step(
                    lambda n, m=model, d=d, t=trials: dd.simulate(
                        m, n, trials=t, on=dd.Resources(device=d, progress=False)
                    ),
                    0.3,
                )
                for d in ("cpu", given.device)
            ]
            print(
                f"{name:8} {trials or 1:3} copies: {us[0]:10.1f} us a step on one core, {us[1]:10.1f} us on"
                f" {given.device}",
                flush=True,
            )
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
