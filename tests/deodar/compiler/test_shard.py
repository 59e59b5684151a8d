"""One field over several devices: values, noise, traffic and errors, on 8 devices of the CPU."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

import deodar as dd
from deodar.compiler.shard import planned
from deodar.compiler.traffic import collectives
from deodar.errors import DeviceError
from tests import host_devices
from tests.deodar.compiler.programs import divided


def volume(samples: int = 32, **options: object) -> dd.Model:
    """Return a field over three axes with two inputs and a narrow kernel."""
    model = dd.Model("volume")
    axes = [dd.Axis(name, 0, samples, samples=samples, periodic=True) for name in "xyz"]
    kernel = [dd.Gaussian(12, samples / 11, normalized=True)]
    u = model.add(dd.Field("u", axes, **{"kernel": kernel, "global_inhibition": 0.003, **options}))
    for name, place in (("left", 0.25), ("right", 0.75)):
        (
            model.add(dd.GaussianStimulus(name, axes, center=place * samples, sigma=samples / 8, amplitude=6))
            >> u
        )
    return model


def plane(sigma: float, boundary: str, size: tuple[int, int] = (96, 40)) -> dd.Model:
    """Return a field over two axes with a narrow kernel."""
    model = dd.Model("plane")
    axes = [dd.Axis(name, 0, n - 1, samples=n) for name, n in zip("xy", size, strict=True)]
    kernel = [dd.Gaussian(9, sigma, normalized=True, boundary=[boundary])]
    u = model.add(dd.Field("u", axes, kernel=kernel, global_inhibition=0.05))
    model.add(dd.GaussianStimulus("place", axes, center=[3, 20], sigma=4, amplitude=7)) >> u
    return model


def linked() -> dd.Model:
    """Return fields over three axes, one axis and none, with a trace and a coupling between the volumes."""
    model = volume(24)
    u = model["u"]
    axes = u.axes
    v = model.add(dd.Field("v", axes, kernel=[dd.Gaussian(5, 3, normalized=True)]))
    line = model.add(dd.Field("line", [axes[1]], kernel=[dd.Gaussian(2, 3, normalized=True)]))
    node = model.add(dd.Field("node", []))
    trace = model.add(dd.MemoryTrace("trace", axes))
    u >> model.add(dd.Convolve([dd.Gaussian(3, 4, normalized=True)])) >> v
    v >> model.add(dd.Gain(-0.2)) >> u
    u >> trace >> v
    u >> line >> v
    u >> node
    return model


def sharing() -> dd.Model:
    """Return a ring of coupled volumes, which share spectral modes."""
    model = volume(24)
    model.set("u.kernel.0.sigma", 3.0)
    fields = [model["u"]]
    kernel = [dd.Gaussian(5, 3, normalized=True)]
    fields += [model.add(dd.Field(name, model["u"].axes, kernel=kernel)) for name in ("v", "w")]
    for one, other in ((0, 1), (1, 0), (1, 2), (2, 0)):
        fields[one] >> model.add(dd.Convolve([dd.Gaussian(3, 3, normalized=True)])) >> fields[other]
    return model


VALUES = """
import numpy as np, deodar as dd
from deodar.compiler.traffic import collectives
from tests.deodar.compiler.test_shard import linked, plane, sharing, volume

def values(made, record=("u",), devices=None):
    data = dd.simulate(made, 40, record=list(record), every=20, on=dd.Resources(devices=devices))
    return {name: data[name].values for name in data.data_vars}

def divided(made):
    return next(p for p in made.programs.values() if p.distribution is not None)

models = {
    "waves": volume(), "halo": plane(1.0, "zero"), "ring": plane(1.0, "periodic"),
    "mirror": plane(1.0, "reflect"), "linked": linked(),
    "sharing": sharing(),
}
for name, made in models.items():
    ports = ["u", "v", "line", "node", "trace.output"] if name == "linked" else ["u"]
    one, many = values(made, record=ports), values(made, record=ports, devices=8)
    for port in one:
        assert np.abs(one[port] - many[port]).max() < 1e-4, (name, port)
        assert np.abs(one[port]).max() > 0.01, (name, port)
    program = divided(made)
    text = program.chunk(())[0].as_text()
    planned, counted = (sum(t.bytes for t in found) for found in (program.fields.traffic, collectives(text)))
    assert planned / 1.2 - 64 < counted < planned * 1.2 + 64, (name, planned, counted)
    methods = {t.method for t in program.fields.traffic}
    expected = {"linked": {"waves", "sum"}, "sharing": {"waves"}, "waves": {"waves"}}
    assert methods == expected.get(name, {"taps"}), name
    assert any(g.strategy.shared for g in program.plan.groups) == (name == "sharing"), name

# elements without a kernel have the same bits, so the noise has
made = volume(kernel=[], noise=1.0, global_inhibition=0.0)
one, many = values(made), values(made, devices=8)
assert np.array_equal(one["u.activation"], many["u.activation"]) and one["u.activation"].std() > 0.1
noisy = volume(noise=0.5)
assert np.abs(values(noisy)["u.activation"] - values(noisy, devices=8)["u.activation"]).max() < 1e-3

made = volume(64)
memory = []
for devices in (None, 8):
    session = dd.Session(made, on=dd.Resources(devices=devices))
    found = session.program.chunk(())[0].memory_analysis()
    memory.append(found.argument_size_in_bytes + found.output_size_in_bytes + found.temp_size_in_bytes)
assert memory[1] <= 1.25 * memory[0] / 8, memory
# the state before, the state, the stimuli and the interaction; a step copies no state
assert memory[1] <= 4.8 * 4 * 64**3 / 8, memory
print("good")
"""

SESSION = """
import sys, jax, numpy as np, deodar as dd
from deodar.errors import DeviceError
from deodar.recording.record import about
from tests.deodar.compiler.test_shard import linked, volume

made = linked()
one, many = dd.Session(made, seed=3), dd.Session(made, seed=3, on=dd.Resources(devices="all"))

def near():
    for path in ("u", "v", "line", "node", "trace.output"):
        assert np.abs(one.read(path) - many.read(path)).max() < 1e-4, path

def places():
    return {len(leaf.sharding.device_set) for leaf in jax.tree.leaves(many._run.state)}

for session in (one, many):
    session.step(30)
near()
assert places() == {8}
whole = {name for name, a in ((n, a) for g in many._run.state["groups"] for n, a in g.items())
         if a.ndim == 4 and not a.sharding.is_fully_replicated}
assert whole, "volumes lie in parts"
kept = one.snapshot(), many.snapshot()
costs = {session.set("u.resting_level", -4.0) for session in (one, many)}
costs |= {session.set("u.kernel.0.sigma", 2.2) for session in (one, many)}
assert costs == {"live", "rebuild"}, costs
for session in (one, many):
    session.inject("u", 2.0, 3)
    session.step(10)
    session.dt = 0.5
    session.step(10)
near()
one.restore(kept[0]), many.restore(kept[1])
near()
many.restore(kept[0])
near()
for session in (one, many):
    session.step(10)
near()
assert many.set("u.kernel.0.sigma", 4.0) == "recompile"
one.set("u.kernel.0.sigma", 4.0)
for session in (one, many):
    session.step(10)
near()
one.reset(), many.reset()
with many.record(sys.argv[1] + "/night.zarr", ["u", "node"], every=2.0):
    many.run(10)
one.run(10)
near()
data = dd.open_record(sys.argv[1] + "/night.zarr")
assert about(data)["made_by"]["devices"] == "8"
assert np.abs(data["u.activation"].isel(time=-1).values - one.read("u")).max() < 1e-4
again = dd.Session(made, seed=3, on=dd.Resources(devices=8))
again.set("u.kernel.0.sigma", 4.0)
again.reset()
again.run(10)
assert np.array_equal(again.read("u"), many.read("u")), np.abs(again.read("u") - many.read("u")).max()

back = dd.session_at(sys.argv[1] + "/night.zarr", 10.0)
assert np.array_equal(back.read("u"), many.read("u")) and "devices': '8'" in str(about(data)["made_by"])

def fails(text, call):
    try:
        call()
    except DeviceError as error:
        assert text in str(error), error
    else:
        raise AssertionError(text)

fails("costs are measured on one device, and 8 divide the fields", many.costs)
shifted = volume(24)
shifted["u"] >> shifted.add(dd.Shift(3.0, name="aside")) >> shifted.add(dd.Field("v", shifted["u"].axes))
eight = dd.Resources(devices=8)
fails("aside", lambda: dd.Session(shifted, on=eight))
fails("u: cannot be divided among 8 devices along 'x'",
      lambda: dd.Session(volume(24, quadrature="cell"), on=eight))
fails("by matrices along the axis 'x'", lambda: dd.Session(volume(24), precision="float64", on=eight))
print("good")
"""


@pytest.mark.parametrize("script", [VALUES, SESSION], ids=["values", "session"])
def test_a_field_over_eight_devices_is_that_of_one(
    script: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XLA_FLAGS", host_devices.flags(8))
    command = [sys.executable, "-c", script, str(tmp_path)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=600)
    assert done.stdout == "good\n", done.stderr


def test_the_first_axis_with_equal_parts_is_divided() -> None:
    planned_y = divided(plane(1.0, "zero", (30, 64)), 8)
    assert planned_y.shards is not None and (planned_y.shards.axis, planned_y.shards.samples) == ("y", 64)


def test_an_axis_without_equal_parts_is_an_error_that_names_numbers_which_fit() -> None:
    with pytest.raises(DeviceError, match=r"u: no axis can be divided into 7 equal parts \(x: 32, .* 2, 4"):
        divided(volume(), 7)
    with pytest.raises(DeviceError, match="has no field that 2 devices could divide"):
        lonely = dd.Model("lonely")
        lonely.add(dd.Field("node", []))
        divided(lonely, 2)


def test_traffic_follows_from_the_kernel() -> None:
    """Modes for wide kernels, samples of the neighbours for narrow ones; whole fields are refused."""
    wide = planned(divided(volume(), 8), 4)
    assert [(t.path, t.method) for t in wide] == [("u", "waves")] and wide[0].bytes < 4 * 32**3 / 1.5
    [narrow] = planned(divided(plane(1.0, "zero"), 8), 4)
    assert narrow.method == "taps" and narrow.bytes == 2 * 6 * 40 * 4
    with pytest.raises(DeviceError, match=r"u: its kernel is applied by .* would exchange [\d,]+ bytes"):
        planned(divided(volume(kernel=[dd.Gaussian(12, 0.6)]), 8), 4)


def test_operations_inside_loops_are_counted() -> None:
    text = """HloModule m
%add (a: f32[], b: f32[]) -> f32[] {
  ROOT %sum = f32[] add(f32[] %a, f32[] %b)
}
%body (p: (u32[], f32[4,6])) -> (u32[], f32[4,6]) {
  %r = (f32[], f32[3,2]{1,0}) all-reduce(%x, %y), to_apply=%add, metadata={op_name="while/element-0f3/dot"}
  %s = f32[5]{0} collective-permute(f32[5]{0} %z), channel_id=2
  %t = (f32[5]{0}, f32[5]{0}, u32[], u32[]) collective-permute-start(f32[5]{0} %z), channel_id=3
  %u = f32[5]{0} collective-permute-done(%t)
  %v = (f32[], f32[7]{0}) all-reduce-start(%x, %y), to_apply=%add
}
%cond (p: (u32[], f32[4,6])) -> pred[] {
  ROOT %c = pred[] compare(%i, %n), direction=NE
}
ENTRY %main (q: f32[4,6]) -> f32[4,6] {
  %once = f32[100]{0} all-gather(f32[10]{0} %q), dimensions={0}
  %w = (u32[], f32[4,6]) while(%t), condition=%cond, body=%body
}
"""
    operations = collectives(text)
    assert [(c.kind, c.bytes, c.element) for c in operations] == [
        ("all-reduce", 28, "0f3"),
        ("collective-permute", 20, ""),
        ("collective-permute", 20, ""),
        ("all-reduce", 32, ""),
    ]
