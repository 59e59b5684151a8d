"""Runs of deodar with the kernels: equal to runs without them up to rounding, and to themselves in any
division.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import deodar_native
import numpy as np
import pytest
from tests.deodar.compiler.programs import executable

import deodar as dd
from deodar.cli import main
from deodar.numerics import native
from deodar.recording.provenance import KEY

VERSION = f"{deodar_native.__version__} {deodar_native.vectors()}"
RECORD = [f"{name}.activation" for name in ("u", "v", "a", "b", "line")]
ROUNDING = 1e-4


def large() -> dd.Model:
    """Return two fields of a plane, of which one is slow, and two planes and a line for every kernel: the
    planes share spectral modes, one has means over cells, and the line has many lags.
    """
    axes = [dd.Axis("x", 0, 60, samples=60), dd.Axis("y", 0, 50, samples=50)]
    kernel = [dd.Gaussian(5, 3, normalized=True)]
    model = dd.Model("large")
    u = model.add(dd.Field("u", axes, kernel=kernel, noise=1.0))
    v = model.add(dd.Field("v", axes, noise=0.5), ticks=2)
    u >> dd.Gain(0.5) >> v
    ring = [dd.Axis("x", 0, 40, samples=40, periodic=True), dd.Axis("y", 0, 40, samples=40, periodic=True)]
    a, b = (
        model.add(dd.Field(name, ring, resting_level=-1, kernel=kernel, noise=1.0, quadrature=q))
        for name, q in (("a", "cell"), ("b", "point"))
    )
    a >> dd.Convolve([dd.Gaussian(2, 2, normalized=True)]) >> b
    b >> dd.Convolve([dd.Gaussian(-2, 4, normalized=True)]) >> a
    z = dd.Axis("z", 0, 500, samples=500)
    model.add(dd.Field("line", [z], resting_level=-1, kernel=[dd.Gaussian(5, 9, normalized=True)], noise=1.0))
    return model


def test_the_model_calls_every_kernel() -> None:
    text = executable(large()).chunk(())[0].as_text()
    for name in ("noise", "line", "cells", "to_modes", "from_modes"):
        assert f'"deodar_native_{name}_2"' in text


def test_a_run_differs_from_one_without_kernels_by_rounding(monkeypatch: pytest.MonkeyPatch) -> None:
    model = large()
    assert executable(model).kernels is deodar_native
    found = dd.simulate(model, 30, record=RECORD, every=5)
    monkeypatch.setenv(native.SWITCH, "off")
    assert executable(model).kernels is None
    expected = dd.simulate(model, 30, record=RECORD, every=5)
    for path in RECORD:
        np.testing.assert_allclose(found[path], expected[path], rtol=0, atol=ROUNDING)
    assert any(not np.array_equal(found[path], expected[path]) for path in RECORD)


def test_double_precision_has_the_bits_of_a_run_without_kernels(monkeypatch: pytest.MonkeyPatch) -> None:
    model = large()
    assert executable(model, precision="float64").kernels is None
    found = dd.simulate(model, 9, precision="float64", record=RECORD)
    monkeypatch.setenv(native.SWITCH, "off")
    expected = dd.simulate(model, 9, precision="float64", record=RECORD)
    for path in RECORD:
        np.testing.assert_array_equal(found[path], expected[path])


def test_single_steps_odd_pieces_and_one_run_have_the_same_bits() -> None:
    model = large()
    sessions = [dd.Session(model, seed=5) for _ in range(3)]
    for session, pieces in zip(sessions, ([31], [1] * 31, [3, 1, 20, 7]), strict=True):
        for n in pieces:
            session.step(n)
    seen = [[session.read(path) for path in RECORD] for session in sessions]
    for other in seen[1:]:
        for a, b in zip(seen[0], other, strict=True):
            np.testing.assert_array_equal(a, b)


def test_trials_and_points_of_a_sweep_have_the_noise_of_single_runs() -> None:
    model = large()
    settings = {"record": RECORD, "seed": 3}
    batch = dd.simulate(model, 21, trials=3, sweep={"u.resting_level": [-5.0, -4.0]}, **settings)
    alone = dd.simulate(model, 21, trials=[2], **settings)
    single = dd.simulate(model, 21, **settings)
    for path in RECORD:
        there = batch[path].sel({"u.resting_level": -5.0})
        np.testing.assert_allclose(there.sel(trial=2), alone[path].sel(trial=2), rtol=0, atol=ROUNDING)
        np.testing.assert_allclose(there.sel(trial=0), single[path], rtol=0, atol=ROUNDING)


def test_pieces_of_a_batch_have_the_bits_of_each_other() -> None:
    model = large()
    whole = dd.simulate(model, 15, trials=4, on=dd.Resources(batch=2), record=RECORD)
    part = dd.simulate(model, 15, trials=[2, 3], on=dd.Resources(batch=2), record=RECORD)
    for path in RECORD:
        np.testing.assert_array_equal(whole[path].sel(trial=[2, 3]), part[path])


def test_a_new_process_reads_programs_that_call_the_kernels_from_disk(place: Path, tmp_path: Path) -> None:
    model = large()
    path = tmp_path / "model.json"
    dd.save(model, path)
    expected = dd.simulate(model, 20, record=RECORD)["u.activation"].values
    code = (
        "import sys, numpy as np, deodar as dd;"
        "from tests.deodar.compiler.programs import executable;"
        "model = dd.load(sys.argv[1]);"
        "data = dd.simulate(model, 20, record=sys.argv[2:]);"
        "print(executable(model).traced, executable(model).compiled,"
        " data['u.activation'].values.tobytes().hex())"
    )
    done = subprocess.run(
        [sys.executable, "-c", code, str(path), *RECORD],
        cwd=Path(__file__).parents[2],
        capture_output=True,
        text=True,
        check=True,
        env=os.environ,
    )
    traced, compiled, found = done.stdout.split()
    assert int(traced) >= 3 and compiled == "0"
    assert found == expected.tobytes().hex()


def test_programs_with_and_without_kernels_are_distinguished_on_disk(
    place: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    model = large()
    for switch in ("", "off"):
        monkeypatch.setenv(native.SWITCH, switch)
        made = executable(model)
        made.chunk(())
        assert made.compiled == 1


def test_records_name_the_kernels_and_their_vectors(monkeypatch: pytest.MonkeyPatch) -> None:
    model = large()

    def made(**settings: str) -> dict[str, str]:
        return json.loads(dd.simulate(model, 2, **settings).attrs[KEY])["made_by"]

    assert made()["deodar-native"] == VERSION
    assert "deodar-native" not in made(precision="float64")
    monkeypatch.setenv(native.SWITCH, "off")
    assert "deodar-native" not in made()


def test_doctor_names_the_kernels(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    main(["doctor"])
    assert f"kernels    deodar-native {VERSION}" in capsys.readouterr().out
    monkeypatch.setenv(native.SWITCH, "off")
    main(["doctor"])
    assert "kernels    compiled kernels are not used" in capsys.readouterr().out
