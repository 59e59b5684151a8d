"""Separate rounding: set before JAX starts; two halves of a model then give the bits of the whole."""

from __future__ import annotations

import json
import os
import platform
import subprocess
import sys

import pytest

import deodar as dd
from deodar.batch import separate_rounding
from deodar.compiler import device as devices
from deodar.recording import provenance

HALVES = """
import json, sys
import deodar as dd
from deodar.session.model_world import ModelWorld
from deodar_robots.zenoh.served_world import ServedWorld
from tests.deodar_robots.zenoh.test_model_world import halves, whole

separate, remote = sys.argv[1] == "separate", sys.argv[2] == "remote"
if separate:
    dd.use_separate_rounding()
largest = {}
for precision in ("float64", "float32"):
    first, second = halves()
    inside = ModelWorld(second)
    served = ServedWorld(inside, "second") if remote else None
    world = dd.Zenoh(at=served.endpoint) if served else inside
    session = dd.Session(first, world=world, seed=7, precision=precision)
    expected = dd.Session(whole(), seed=7, precision=precision)
    largest[precision] = 0.0
    for _ in range(300):
        session.step()
        expected.step()
        for name, found in (("a", session), ("b", inside.session)):
            gap = abs(found.read(name).astype(float) - expected.read(name).astype(float)).max()
            largest[precision] = max(largest[precision], float(gap))
    assert expected.read("b").max() > 1, "the second field has a peak, which the first one caused"
    if served:
        world.close()
        served.close()
print("LARGEST", json.dumps(largest))
"""

x86 = platform.machine().lower() in ("x86_64", "amd64")


def told(code: str, *arguments: str) -> str:
    """Return what a new process prints, with the programs that a user gets."""
    environment = {k: v for k, v in os.environ.items() if k != "XLA_FLAGS"}
    done = subprocess.run(
        [sys.executable, "-c", code, *arguments], capture_output=True, text=True, env=environment
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def largest(*arguments: str) -> dict[str, float]:
    """Return the largest difference between two halves and the whole, by precision."""
    (line,) = [line for line in told(HALVES, *arguments).splitlines() if line.startswith("LARGEST ")]
    return json.loads(line.removeprefix("LARGEST "))


if x86:

    @pytest.mark.parametrize("place", ["here", "remote"])
    def test_two_halves_give_the_bits_of_the_whole(place: str) -> None:
        assert largest("separate", place) == {"float64": 0.0, "float32": 0.0}

    def test_it_is_refused_after_jax_has_started_and_stated_in_a_record() -> None:
        code = """
import deodar as dd
model = dd.Model("m")
model.add(dd.Field("n"))
{before}
data = dd.simulate(model, 5)
print('"rounding":"separate"' in data.attrs["deodar"].replace(" ", ""))
try:
    dd.use_separate_rounding()
except dd.errors.DeviceError as error:
    print(error)
"""
        assert told(code.format(before="dd.use_separate_rounding()")).strip() == "True"
        refused = told(code.format(before=""))
        assert refused.startswith("False") and "JAX has already started" in refused
        assert "XLA_FLAGS=--xla_cpu_max_isa=AVX" in refused


def test_other_processors_have_no_separate_rounding(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("XLA_FLAGS", raising=False)
    monkeypatch.setattr(platform, "machine", lambda: "aarch64")
    with pytest.raises(dd.errors.DeviceError, match="aarch64 has no separate rounding"):
        dd.use_separate_rounding()


def test_the_option_is_added_to_those_of_xla(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XLA_FLAGS", "--xla_dump_to=here")
    monkeypatch.setattr(platform, "machine", lambda: "x86_64")
    monkeypatch.setattr(separate_rounding, "started", lambda: False)
    assert not provenance.separate_rounding()
    for _ in range(2):
        dd.use_separate_rounding()
        assert os.environ["XLA_FLAGS"] == "--xla_dump_to=here --xla_cpu_max_isa=AVX"
    settings = {"made_by": provenance.made_by(devices.find())}
    assert provenance.rounds_separately(settings)
    monkeypatch.setenv("XLA_FLAGS", "")
    assert not provenance.rounds_separately({"made_by": {}})
