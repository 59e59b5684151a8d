"""Devices: programs run on the named device, in full precision, and a missing device is an error."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import jax
import pytest

import deodar as dd
from deodar.compiler import cache, device
from deodar.errors import DeviceError
from deodar.recording.record import about
from deodar.recording.repeat import repeat
from tests import host_devices


def model() -> dd.Model:
    model = dd.Model("small")
    axes = [dd.Axis("x", 0, 30, samples=31), dd.Axis("y", 0, 30, samples=31)]
    model.add(dd.Field("u", axes, kernel=[dd.Gaussian(2.0, 4, normalized=True)], noise=0.3))
    return model


SECOND = """
import jax, numpy as np, deodar as dd
from tests.deodar.batch.test_device import model
from deodar.recording.record import about
from deodar.compiler import device
assert device.names() == ["cpu:0", "cpu:1"], device.names()
seen = {}
for name in (None, "cpu", "cpu:1"):
    data = dd.simulate(model(), 50, trials=2, on=dd.Resources(device=name))
    seen[name] = data["u.activation"].values
    session = dd.Session(model(), on=dd.Resources(device=name))
    session.step(50)
    places = {d for leaf in jax.tree.leaves(session._run.state) for d in leaf.devices()}
    assert places == {jax.devices()[1 if name == "cpu:1" else 0]}, (name, places)
    session.set("u.kernel.0.sigma", 9.0)  # compiles again, on the same device
    session.step(1)
    assert {d for leaf in jax.tree.leaves(session._run.state) for d in leaf.devices()} == places
assert np.array_equal(seen[None], seen["cpu:1"]) and np.array_equal(seen[None], seen["cpu"])
assert about(data)["device"] == "cpu:1"
print("good")
"""


def test_a_program_runs_on_the_device_that_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    """In a process whose CPU counts as two devices; the second run loads the programs from the disk."""
    monkeypatch.setenv("XLA_FLAGS", host_devices.flags(2))
    for _ in range(2):
        done = subprocess.run([sys.executable, "-c", SECOND], capture_output=True, text=True, timeout=600)
        assert done.stdout == "good\n", done.stderr


DIVIDED = """
import re, jax, numpy as np, deodar as dd
from deodar.errors import DeodarError
from tests.deodar.batch.test_device import model
from tests.deodar.worlds.arena.test_arena import avoiding
from deodar.recording.record import about
def bits(one, other):
    assert one.sizes == other.sizes, (one.sizes, other.sizes)
    return np.array_equal(one["u.activation"].values, other["u.activation"].values)
def run(made, device=None, devices=None, workers=None, batch=None, **given):
    on = dd.Resources(device, devices, workers, batch=batch)
    return dd.simulate(made, 30, record=["u"], every=10, on=on, **given)
values = [1.0, 1.5, 2.0, 2.5, 3.0]
ways = dict(devices=4), dict(batch=4)
for precision in ("float64", "float32"):
    made = model()
    whole = run(made, trials=16, precision=precision)
    divided = run(made, trials=16, precision=precision, devices=8)
    assert bits(divided, run(made, trials=16, precision=precision, batch=2))
    assert abs(whole - divided)["u.activation"].max() < (1e-10 if precision == "float64" else 1e-4)
    assert np.array_equal(whole["u.activation"] > -5, divided["u.activation"] > -5)
    assert bits(run(made, trials=13, precision=precision, devices="all"), divided.isel(trial=slice(13)))
# sweeps, in single precision
grid = {"u.kernel.0.sigma": values, "u.tau": [20.0, 30.0, 40.0]}
few = {name: some[:2] for name, some in grid.items()}
swept = run(made, trials=2, sweep=grid, devices=8)
two = run(made, trials=2, sweep=few, batch=4)
chosen = swept.isel({"u.kernel.0.sigma": [0, 1], "u.tau": [0, 1]})
assert bits(chosen, two), float(abs(chosen - two)["u.activation"].max())
few = {"u.tau": [20.0, 30.0]}
one, two = (run(made, trials=8, sweep=few, **given) for given in ways)
assert bits(one, two)
programs = [p for p in made.programs.values() if p.distribution is not None]
assert {p.distribution.along for p in programs} == {"trials", "points"}
for p in programs:
    for compiled in (p.chunk(())[0], p.reader([p.port(model().document.entries[0].id, "output")])):
        text = compiled.as_text()
        used = {len(s.device_set) for s in jax.tree.leaves(compiled.input_shardings)}
        assert used == {len(p.distribution.devices)}
        assert not re.search("all-reduce|all-gather|all-to-all|collective-permute|reduce-scatter", text)
assert about(swept)["devices"] == 8 and about(swept)["made_by"]["devices"] == "8"
robot, loop = avoiding(), dict(record=["pose.output"], every=64, world=dd.Arena("blocks"))
ways = dict(devices=4), dict(batch=2)
one, two = (dd.simulate(robot, 64 * 10, trials=8, **loop, on=dd.Resources(**given)) for given in ways)
assert np.array_equal(one["pose.output"].values, two["pose.output"].values)
three = run(model(), trials=3, devices=8)
assert about(three)["devices"] == 8 and about(three)["made_by"]["devices"] == "3"
for given, text in (
    (dict(devices=9), "9 devices of the kind cpu are asked for, and this computer has 8: cpu:0"),
    (dict(devices=2, device="cpu:1"), "names one device, and devices=2 asks for several"),
    (dict(devices=2, workers=2), "not on 2 devices. Leave out workers, or devices"),
    (dict(devices=2, trials=1), "a batch of one copy cannot be divided among 2 devices"),
):
    try:
        run(model(), **{"trials": 4, **given})
    except DeodarError as error:
        assert text in str(error), error
    else:
        raise AssertionError(given)
print("good")
"""


def test_copies_are_divided_among_devices_without_traffic(monkeypatch: pytest.MonkeyPatch) -> None:
    """On 8 devices of the CPU a copy has the bits that it has in a batch of the size of one part."""
    monkeypatch.setenv("XLA_FLAGS", host_devices.flags(8))
    done = subprocess.run([sys.executable, "-c", DIVIDED], capture_output=True, text=True, timeout=600)
    assert done.stdout == "good\n", done.stderr


INTERRUPTED = """
import sys, numpy as np, deodar as dd
from deodar.errors import Interrupted
from tests.deodar.batch.test_device import model
from deodar.recording.repeat import repeat
def stop(done):
    if done > 30:
        raise KeyboardInterrupt
given = dict(record=["u"], every=1, trials=5)
def on(**more): return dd.Resources(devices=4, **more)
try:
    out = dd.Output(sys.argv[1] + "/run", snapshots=10)
    dd.simulate(model(), 400, out=out, on=on(progress=stop), **given)
except Interrupted:
    pass
else:
    raise AssertionError("not stopped")
whole = dd.simulate(model(), 400, on=on(), **given)
resumed = dd.resume(sys.argv[1] + "/run")
assert np.array_equal(whole["u.activation"].values, resumed["u.activation"].values)
again = repeat(whole, dd.simulate)
assert again.same_bits and not again.differences, again
print("good")
"""


def test_a_divided_run_is_resumed_and_repeated(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("XLA_FLAGS", host_devices.flags(4))
    command = [sys.executable, "-c", INTERRUPTED, str(tmp_path)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=600)
    assert done.stdout == "good\n", done.stderr


@pytest.mark.parametrize(
    ("devices", "text"),
    [
        (0, "devices is 0; expected a number of devices, at least 1, or 'all'"),
        (True, "devices is True"),
        ("many", "devices is 'many'"),
        (999, "999 devices of the kind cpu are asked for, and this computer has 1: cpu:0. Type devices=1"),
    ],
)
def test_an_invalid_number_of_devices_is_an_error(devices: Any, text: str) -> None:
    with pytest.raises(DeviceError, match=re.escape(text)):
        dd.simulate(model(), 10, trials=4, on=dd.Resources(devices=devices))


def test_devices_of_a_kind_that_is_not_there_are_an_error() -> None:
    with pytest.raises(DeviceError, match="this computer has no device 'tpu'"):
        dd.simulate(model(), 10, trials=4, on=dd.Resources(device="tpu", devices=2))


ELSEWHERE = """
import jax, deodar as dd
from deodar.numerics import interaction
jax.config.update("jax_default_device", jax.devices()[1])  # as on a machine with a graphics processor
places, apply = set(), interaction.apply
def seen(mixture, axes, array, *others):
    if not isinstance(array, jax.core.Tracer):
        places.update(array.devices())
    return apply(mixture, axes, array, *others)
interaction.apply = seen
dd.phase(dd.Field("n", kernel=[dd.Gaussian(2.0)]))
assert places == {jax.devices()[0]}, ("phase", places)
places.clear()
dd.isolate(dd.Field("u", [dd.Axis("x", 0, 30, samples=31)], kernel=[dd.Gaussian(2.0, 4)]))
assert places == {jax.devices()[0]}, ("isolated", places)
arena = dd.Arena("blocks")
arena.reset(1)
places = {d for leaf in jax.tree.leaves(arena._state) for d in leaf.devices()}
assert places == {jax.devices()[0]}, ("arena", places)
print("good")
"""


def test_values_outside_of_programs_are_computed_on_the_cpu(monkeypatch: pytest.MonkeyPatch) -> None:
    """Also where JAX would compute elsewhere by default, as it does with a graphics processor."""
    monkeypatch.setenv("XLA_FLAGS", host_devices.flags(2))
    done = subprocess.run([sys.executable, "-c", ELSEWHERE], capture_output=True, text=True, timeout=600)
    assert done.stdout == "good\n", done.stderr


@pytest.mark.parametrize("name", ["gpu:99", "cpu:1000", "cpu:x", "cpu:", "quantum", "", 3])
def test_an_unknown_device_is_an_error_that_lists_the_valid_ones(name: str) -> None:
    for call in (
        lambda: dd.simulate(model(), 10, on=dd.Resources(device=name)),
        lambda: dd.Session(model(), on=dd.Resources(device=name)),
    ):
        with pytest.raises(
            dd.errors.DeviceError,
            match=r"valid names: .*cpu:0" if isinstance(name, str) else "named by a text",
        ):
            call()


def test_a_missing_device_is_an_error_that_states_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(device, "_of", lambda kind: jax.devices("cpu") if kind == "cpu" else [])
    with pytest.raises(
        dd.errors.DeviceError,
        match=r"this computer has no device 'gpu'; valid names: cpu:0\. .*pip install 'jax\[cuda12\]'",
    ):
        device.find("gpu")


def test_a_record_names_its_device_and_is_repeated_on_it() -> None:
    old = dd.simulate(model(), 20, on=dd.Resources(device="cpu:0"))
    assert about(old)["device"] == "cpu:0" and about(old)["made_by"]["device"].startswith("cpu")
    assert repeat(old, dd.simulate).same_bits and repeat(old, dd.simulate, on=dd.Resources("cpu")).same_bits


def test_workers_and_another_device_exclude_each_other(monkeypatch: pytest.MonkeyPatch) -> None:
    class Other:
        platform = "gpu"

    monkeypatch.setattr(device, "find", lambda name: Other)
    with pytest.raises(dd.errors.WorkerError, match="cores of the CPU"):
        dd.simulate(model(), 10, trials=2, on=dd.Resources(device="gpu", workers=2))


@pytest.mark.parametrize("precision", ["float32", "float64"])
def test_matrix_products_use_the_full_precision(precision: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Each product of each program states its precision, because the default of a device may be TF32."""
    texts: list[str] = []
    compile_ = cache.compile

    def listen(
        lowered: jax.stages.Lowered, options: cache.CompilerOptions | None, *others: Any
    ) -> tuple[object, bool]:
        texts.append(lowered.as_text())
        return compile_(lowered, options, *others)

    monkeypatch.setattr(cache, "compile", listen)
    dd.simulate(model(), 5, precision=precision, trials=3)
    products = [
        line
        for text in texts
        for line in text.splitlines()
        if "dot_general" in line or "stablehlo.convolution" in line
    ]
    assert products and all("HIGHEST" in line and "DEFAULT" not in line for line in products)
    assert jax.config.jax_default_matmul_precision is None  # stated for the programs of deodar alone
