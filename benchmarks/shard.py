"""One field over several devices: `python benchmarks/shard.py [--samples 96 128] [--devices 8]`.

A field over three axes of N samples each, on one device and divided among several. Fails (status 1)
unless activations agree to 1e-4 after 400 steps without noise, noise has the same bits, the compiled program
exchanges at most 1.2 times the planned bytes a step, and a device needs at most its part of the memory of one
device and 25 %. Memory is that of a chunk: the state before and after it, and what is between them. A CPU
counts as several devices, whose times say nothing about speed. With several graphics processors
(`--device gpu`) it also times a field of 512 x 512 x 512 samples on one and on all of them, or on four; the
efficiency is printed, and has no target.
"""

from __future__ import annotations

import argparse
import os
import sys
import time

import numpy as np

import deodar as dd
from deodar.compiler.device import several
from deodar.compiler.executable import Executable
from deodar.compiler.traffic import collectives

FLAG = "--xla_force_host_platform_device_count"
STEPS, NOISY_STEPS, NEAR = 400, 21, 1e-4
AGREEMENT, SPARE = 1.2, 1.25
LARGE, TIMED = 512, 50


def volume(samples: int, noise: float = 0.0, kernel: bool = True) -> dd.Model:
    """A field over three axes, with two inputs of which one is stronger."""
    model = dd.Model("volume")
    axes = [dd.Axis(name, 0, samples, samples=samples, periodic=True) for name in "xyz"]
    kernels = [dd.Gaussian(12, samples / 24, normalized=True)] if kernel else []
    inhibition = 3000 / samples**3 if kernel else 0.0
    u = model.add(dd.Field("u", axes, kernel=kernels, global_inhibition=inhibition, noise=noise))
    for name, place, amplitude in (("left", 0.25, 6.5), ("right", 0.75, 6.0)):
        (
            model.add(
                dd.GaussianStimulus(
                    name, axes, center=place * samples, sigma=samples / 12, amplitude=amplitude
                )
            )
            >> u
        )
    return model


def final(model: dd.Model, steps: int, kind: str, devices: int | None) -> np.ndarray:
    """Activation after a number of steps."""
    data = dd.simulate(model, steps, on=dd.Resources(device=kind, devices=devices, progress=False))
    return data["u.activation"].isel(time=-1).values


def programs(model: dd.Model, kind: str, devices: int) -> list[Executable]:
    """The programs of a step on one device and on several."""
    return [dd.Session(model, on=dd.Resources(device=kind, devices=n)).program for n in (None, devices)]


def memory_parts(program: Executable) -> dict[str, float]:
    """Memory of a chunk on one device, in MiB, by what it holds."""
    found = program.chunk(())[0].memory_analysis()
    assert found is not None
    parts = {
        "before": found.argument_size_in_bytes,
        "after": found.output_size_in_bytes - found.alias_size_in_bytes,
        "between": found.temp_size_in_bytes,
    }
    return {name: size / 2**20 for name, size in parts.items()}


def compare(samples: int, kind: str, devices: int, memories: list[str]) -> bool:
    """Print the figures of one size; return whether all targets are met.

    Two lines about the memory of a device are added to `memories`.
    """
    model = volume(samples)
    seconds: list[float] = []
    found: list[np.ndarray] = []
    for n in (None, devices):
        final(model, 1, kind, n)  # compiles
        began = time.perf_counter()
        found.append(final(model, STEPS, kind, n))
        seconds.append(time.perf_counter() - began)
    difference, peaks = float(np.abs(found[0] - found[1]).max()), [int((u > 0).sum()) for u in found]
    silent = volume(samples, noise=1.0, kernel=False)
    bits = [final(silent, NOISY_STEPS, kind, n).tobytes() for n in (None, devices)]
    one, many = programs(model, kind, devices)
    assert many.fields is not None
    planned = sum(t.bytes for t in many.fields.traffic)
    counted = sum(c.bytes for c in collectives(many.chunk(())[0].as_text() or ""))
    parts = [memory_parts(program) for program in (one, many)]
    memory = [sum(part.values()) for part in parts]
    field = 4 * samples**3
    print(
        f"| {samples}^3 | {field / 2**20:.1f} MiB | {difference:.1e} | {bits[0] == bits[1]} | {counted:,} |"
        f" {counted / planned:.3f} | {counted / field:.3f} | {memory[0]:.1f} MiB | {memory[1]:.2f} MiB |"
        f" {memory[1] * devices / memory[0]:.2f} | {1e3 * seconds[0] / STEPS:.1f} ms |"
        f" {1e3 * seconds[1] / STEPS:.1f} ms |",
        flush=True,
    )
    for part, n in zip(parts, (1, devices), strict=True):
        share = field / 2**20 / n
        each = ", ".join(f"{name} {size:.2f} MiB ({size / share:.2f})" for name, size in part.items())
        memories.append(f"memory of {samples}^3 on {n} (of a device's part of the field): {each}")
    met = {
        "difference": difference <= NEAR and peaks[0] == peaks[1] > 0,
        "bits of the noise": bits[0] == bits[1],
        "traffic": counted <= AGREEMENT * planned,
        "memory": memory[1] <= SPARE * memory[0] / devices,
    }
    for name, good in met.items():
        if not good:
            print(f"missed at {samples}^3: {name} (peaks of {peaks} samples)")
    return all(met.values())


def efficiency(kind: str, devices: int) -> None:
    """Print how much faster a large field is on several graphics processors."""
    took: list[float] = []
    for n in (None, devices):
        session = dd.Session(volume(LARGE, noise=1.0), on=dd.Resources(device=kind, devices=n))
        session.step(TIMED)
        began = time.perf_counter()
        session.step(TIMED)
        session.read("u")
        took.append((time.perf_counter() - began) / TIMED)
    print(
        f"{LARGE}^3: {1e3 * took[0]:.2f} ms a step on one device, {1e3 * took[1]:.2f} ms on {devices};"
        f" efficiency {took[0] / took[1] / devices:.2f}"
    )


def main() -> int:
    parser = argparse.ArgumentParser(description=" ".join((__doc__ or "").split("\n\n")[0].split()))
    parser.add_argument("--samples", type=int, nargs="+", default=[96, 128], metavar="N")
    parser.add_argument("--devices", type=int, default=8, metavar="N")
    parser.add_argument("--device", default="cpu", metavar="KIND")
    given = parser.parse_args()
    if given.device == "cpu" and FLAG not in os.environ.get("XLA_FLAGS", ""):
        # before JAX starts, which reads it once
        os.environ["XLA_FLAGS"] = f"{os.environ.get('XLA_FLAGS', '')} {FLAG}={given.devices}".strip()
    dd.use_cores(1)
    found = several("all", given.device)
    devices = min(given.devices, len(found))
    load = os.getloadavg()[0] if hasattr(os, "getloadavg") else float("nan")
    print(f"{devices} devices of {len(found)}: {found[0].device_kind}; load {load:.1f}; {STEPS} steps")
    if devices < 2:
        print("there is one device, so nothing is divided")
        return 2
    print(
        "| field | size | difference | same noise | bytes a step | of the plan | of the field | memory, one"
        " | each of several | of its part | step, one | step, several |"
    )
    print("|---|---|---|---|---|---|---|---|---|---|---|---|")
    memories: list[str] = []
    good = [compare(samples, given.device, devices, memories) for samples in given.samples]
    print("\n".join(memories))
    if found[0].platform != "cpu":
        efficiency(given.device, min(4, devices))
    return 0 if all(good) else 1


if __name__ == "__main__":
    sys.exit(main())
