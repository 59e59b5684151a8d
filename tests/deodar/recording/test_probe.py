"""Probes: what is recorded, when, and under which condition."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import deodar as dd
from deodar.elements.field import Field
from deodar.errors import ParameterError, TimeError
from deodar.numerics.sigmoids import Logistic
from deodar.recording import files, probe
from deodar.recording.probe import Selector, series


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("u", dd.Probe("u")),
        ("u.output,every=10", dd.Probe("u.output", 10)),
        ("u,when=peak", dd.Probe("u", None, "peak")),
        ("u,when=crossing,every=0.5", dd.Probe("u", 0.5, "crossing")),
        ('"a,b".output', dd.Probe('"a,b".output')),
        ('"a,every=5".output,every=2', dd.Probe('"a,every=5".output', 2)),
    ],
)
def test_a_probe_is_read_from_text_and_written_as_text(text: str, expected: dd.Probe) -> None:
    assert probe.parsed(text) == expected
    assert probe.parsed(str(expected)) == expected


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("u,every=often", "expected a time"),
        ("u,every=0", "expected a time above 0"),
        ("u,every=-1", "expected a time above 0"),
        ("u,every=nan", "expected a time above 0"),
        ("u,when=peaks", "Did you mean 'peak'"),
    ],
)
def test_a_wrong_probe_names_its_path(text: str, message: str) -> None:
    with pytest.raises(ParameterError, match=message) as caught:
        probe.parsed(text)
    assert caught.value.problems[0].where.startswith("u")


def test_variables_with_equal_times_share_a_dimension() -> None:
    grouped = series(["a", "b", "c", "d", "e"], [2, 1, 2, 2, 2], [None, None, None, "peak", "peak"])
    assert [(group.dimension, group.names) for group in grouped] == [
        ("time", ("a", "c")),
        ("b.time", ("b",)),
        ("d.time", ("d",)),
        ("e.time", ("e",)),
    ]


def test_only_conditions_leave_no_main_time() -> None:
    assert [group.dimension for group in series(["a"], [1], ["peak"])] == ["a.time"]


@pytest.mark.parametrize("parts", [[12], [1] * 12, [5, 1, 6], [3, 4, 5]])
def test_the_choice_does_not_depend_on_how_samples_arrive(parts: list[int]) -> None:
    values = np.array([0, 0, 2, 2, 0, 3, 3, 3, 0, 0, 0, 4], np.float32)
    times = np.arange(12) * 0.5
    grouped = series(["a", "b", "c", "d"], [1, 3, 1, 2], [None, None, "peak", "crossing"])
    selector, got = Selector(grouped, dict.fromkeys("abcd", 1.0)), dict[str, list[Any]]()
    first = 0
    for n in parts:
        part = slice(first, first + n)
        for one in selector.choose(first, times[part], dict.fromkeys("abcd", values[part])):
            got.setdefault(one.dimension, []).extend(one.times.tolist())
            for name, chosen in one.values.items():
                got.setdefault(name, []).extend(chosen.tolist())
        first += n
    assert got["time"] == times.tolist() and got["a"] == values.tolist()
    assert got["b.time"] == [0.0, 1.5, 3.0, 4.5] and got["b"] == [0, 2, 3, 0]
    assert got["c.time"] == [1.0, 1.5, 2.5, 3.0, 3.5, 5.5] and got["c"] == [2, 2, 3, 3, 3, 4]
    # every second sample: 0 2 0 3 0 0
    assert got["d.time"] == [1.0, 2.0, 3.0, 4.0] and got["d"] == [2, 0, 3, 0]


def test_thresholds_are_those_of_the_port() -> None:
    field = Field("u", [], sigmoid=Logistic(threshold=0.3))
    assert [probe.threshold(field, port) for port in ("activation", "output", "input")] == [0.3, 0.5, 0.0]
    assert probe.threshold(dd.Boost("b"), "output") == 0.0


def model() -> dd.Model:
    model = dd.Model("probed")
    x = dd.Axis("x", 0, 20, samples=11)
    model.add(dd.Field("u", [x], tau=10, noise=0.3))
    window = [dd.Window(20, 60)]
    model.add(dd.GaussianStimulus("s", [x], center=10, sigma=3, amplitude=20, windows=window)) >> model["u"]
    return model


def test_a_run_records_each_probe_at_its_times(tmp_path: Path) -> None:
    probes = ["u,every=6", dd.Probe("u.output", every=4, when="peak"), "u.input,when=crossing", "s.output"]
    record = dd.simulate(model(), 100, seed=2, record=probes, every=2, out=tmp_path / "run")
    whole = dd.simulate(model(), 100, seed=2, record=["u", "u.output", "u.input", "s.output"])
    assert record["s.output"].values.tolist() == whole["s.output"].values[::2].tolist()
    assert record["u.activation"].values.tolist() == whole["u.activation"].values[::6].tolist()
    output = whole["u.output"].values[::4]
    high = output.max(1) > 0.5
    assert 0 < high.sum() < high.size
    assert record["u.output"].values.tolist() == output[high].tolist()
    assert record["u.output.time"].values.tolist() == (np.arange(26)[high] * 4.0).tolist()
    assert record["u.input.time"].values.tolist() == [20, 60]
    assert files.load_record(tmp_path / "run").identical(record)


@pytest.mark.parametrize("after", [30, 50, 70])
def test_a_resumed_run_has_the_samples_of_a_whole_one(
    after: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    probes = ["u,every=6", "u.output,every=4,when=peak", "u.input,when=crossing", "s.output"]
    whole = dd.simulate(model(), 100, seed=2, record=probes, every=2, out=tmp_path / "whole")
    monkeypatch.setattr("deodar.session.run.CHUNK_SECONDS", 0.0)

    def stop(done: int) -> None:
        if done >= after:
            raise KeyboardInterrupt

    with pytest.raises(dd.errors.Interrupted):
        dd.simulate(
            model(), 100, seed=2, record=probes, every=2, out=tmp_path / "run", on=dd.Resources(progress=stop)
        )
    resumed = dd.resume(tmp_path / "run")
    assert resumed.drop_attrs().load().identical(whole.drop_attrs().load())


def test_times_of_their_own_need_a_file_and_a_single_run(tmp_path: Path) -> None:
    with pytest.raises(ParameterError, match="Give `out`"):
        dd.simulate(model(), 10, record="u,every=2")
    with pytest.raises(ParameterError, match="Leave out trials"):
        dd.simulate(model(), 10, record="u,when=peak", trials=2, out=tmp_path / "run")
    with pytest.raises(ParameterError, match="two intervals"):
        dd.simulate(model(), 10, record=["u", "u.activation,every=2"], out=tmp_path / "run")
    with pytest.raises(TimeError, match="multiple"):
        dd.simulate(model(), 10, record=["u,every=1.5"], out=tmp_path / "run")
    assert not (tmp_path / "run").exists()
