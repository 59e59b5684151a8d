"""Sessions that are recorded while they run: the samples are those that a reader would have seen."""

from __future__ import annotations

import errno
import json
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray

import deodar as dd
from deodar.errors import NotFinite, OutputError, OutputExists, ParameterError, RecordError
from deodar.recording import files, repeat
from deodar.recording.growing import GrowingRecord
from deodar.recording.record import about, time_dimension

x = dd.Axis("x", 0, 20, samples=11)


def model() -> dd.Model:
    model = dd.Model("recorded")
    model.add(dd.Field("u", [x], tau=10, kernel=[dd.Gaussian(2, 3)], noise=0.5))
    model.add(dd.GaussianStimulus("s", [x], center=10, sigma=3, amplitude=9)) >> model["u"]
    model.add(dd.Field("n", [], tau=10, noise=0.2))
    return model


Act = Callable[[dd.Session], object]


def read_along(acts: list[Act]) -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """Take every step alone and read both fields after it; return their times and values."""
    session = dd.Session(model(), seed=3)
    session.step(7)
    seen: list[tuple[float, np.ndarray, np.ndarray]] = []

    def read() -> None:
        seen.append((session.time, session.read("u"), session.read("n")))

    advance = session._advance

    def one_by_one(steps: int) -> None:
        for _ in range(steps):
            advance(1)
            read()

    read()
    inject = session.inject

    def injected(path: Any, amount: Any, n: int = 1) -> None:
        for _ in range(n):
            inject(path, amount)
            seen.pop()
            read()

    session._advance = one_by_one  # type: ignore[method-assign]
    session.inject = injected  # type: ignore[method-assign]
    for act in acts:
        act(session)
    times = np.asarray([time for time, _, _ in seen])
    return {
        "u.activation": (times, np.asarray([u for _, u, _ in seen])),
        "n.activation": (times, np.asarray([n for _, _, n in seen])),
    }


def compare(record: xarray.Dataset, expected: dict[str, tuple[np.ndarray, np.ndarray]]) -> None:
    for name, (times, values) in expected.items():
        variable = record[name]
        dimension = time_dimension(variable)
        assert dimension is not None
        at = variable[dimension].values
        place = np.searchsorted(times, at - 1e-6)
        assert np.allclose(times[place], at, atol=1e-9)
        assert variable.values.tobytes() == values[place].tobytes(), name


ACTS: list[Act] = [
    lambda session: session.step(1),
    lambda session: session.step(0),
    lambda session: session.step(5),
    lambda session: session.set("u.tau", 20.0),
    lambda session: session.run(30),
    lambda session: session.inject("u", 2.0, 3),
    lambda session: session.step(4),
    lambda session: session.set("u.kernel.0.sigma", 2.0),
    lambda session: session.run(30),
]


def test_the_samples_are_the_states_that_a_reader_sees(tmp_path: Path) -> None:
    session = dd.Session(model(), seed=3)
    session.step(7)
    recorder = session.record(tmp_path / "run", ["u", dd.Probe("n", every=6)], every=2)
    for act in ACTS:
        act(session)
    recorder.close()
    record = dd.open_record(tmp_path / "run")
    compare(record, read_along(ACTS))
    assert record["time"].values.tolist() == [7 + 2 * k for k in range(37)]
    assert record["n.activation.time"].values.tolist() == [7 + 6 * k for k in range(13)]
    assert about(record)["complete"] is True and (tmp_path / "run" / "model.json").is_file()


def test_a_new_step_keeps_the_times_of_the_samples(tmp_path: Path) -> None:
    acts: list[Act] = [
        lambda session: session.run(5),
        lambda session: setattr(session, "dt", 0.5),
        lambda session: session.run(9),
    ]
    session = dd.Session(model(), seed=3)
    session.step(7)
    with session.record(tmp_path / "r.zarr", ["u", "n,every=4"], every=2):
        for act in acts:
            act(session)
    record = dd.open_record(tmp_path / "r.zarr")
    compare(record, read_along(acts))
    assert record["time"].values.tolist() == [7, 9, 11, 13, 15, 17, 19, 21]
    assert record["n.activation.time"].values.tolist() == [7, 11, 15, 19]


def test_changes_are_in_the_record_with_their_ticks(tmp_path: Path) -> None:
    session = dd.Session(model())
    session.set("u.tau", 15.0)
    with session.record(tmp_path / "r.zarr", "u"):
        session.step(3)
        session.set("u.tau", 20.0)
        session.inject("u", 2.0)
        session.step()
    changes = json.loads(dd.open_record(tmp_path / "r.zarr").attrs["changes"])
    assert changes == [
        {"tick": 3, "what": "u.tau", "value": 20.0},
        {"tick": 3, "what": "push u", "value": [2.0, 1]},
    ]


def test_a_record_of_a_session_is_not_run_again(tmp_path: Path) -> None:
    session = dd.Session(model())
    with session.record(tmp_path / "r.zarr", "u"):
        session.step(3)
    with pytest.raises(RecordError, match="recorded from a session"):
        repeat.request(dd.open_record(tmp_path / "r.zarr"))


@pytest.mark.parametrize(
    ("act", "reason"),
    [
        (lambda session: session.reset(), "reset"),
        (lambda session: session.restore(session.snapshot()), "restored"),
        (lambda session: session.edit(without(session)), "n.activation was removed"),
        (lambda session: session.edit(finer(session)), "u.activation has other axes"),
        (lambda session: setattr(session, "dt", 0.75), "not a multiple"),
    ],
)
def test_a_record_ends_where_it_cannot_continue_and_the_session_runs_on(
    act: Act, reason: str, tmp_path: Path
) -> None:
    session = dd.Session(model())
    recorder = session.record(tmp_path / "r.zarr", ["u", "n"], every=2)
    session.step(10)
    act(session)
    session.step(10)
    assert not recorder.open and reason in recorder.ended
    record = dd.open_record(tmp_path / "r.zarr")
    assert record.sizes["time"] == 6 and about(record)["complete"] is False
    assert reason in about(record)["ended"]
    session.record(tmp_path / "next.zarr", "u").close()


def without(session: dd.Session) -> Any:
    changed = dd.Model(document=session.document)
    changed.remove("n")
    return changed.document


def finer(session: dd.Session) -> Any:
    changed = dd.Model(document=session.document)
    for path in ("u.axes", "s.axes"):
        changed.set(path, [dd.Axis("x", 0, 20, samples=21)])
    return changed.document


def test_a_full_disk_is_raised_once_and_the_session_runs_on(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    session = dd.Session(model())
    recorder = session.record(tmp_path / "r.zarr", "u")
    session.step(5)
    assert recorder._writer is not None
    recorder._writer.commit()

    def refuse(*_: Any) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(GrowingRecord, "_write", refuse)
    with pytest.raises(OutputError, match="No space left") as caught:
        for _ in range(1000):
            session.step(1000)
    assert "is kept" in str(caught.value)
    session.step(5)
    assert not recorder.open and "No space left" in recorder.ended
    assert dd.open_record(tmp_path / "r.zarr").sizes["time"] == 6


def test_a_session_that_diverges_ends_its_record_and_runs_on(tmp_path: Path) -> None:
    session = dd.Session(model())
    recorder = session.record(tmp_path / "r.zarr", "u")
    session.step(5)
    session.set({"u.sigmoid": dd.Linear(), "u.kernel.0.amplitude": 100.0})
    with pytest.raises(NotFinite):
        session.run(1000)
    assert "infinite or undefined" in recorder.ended
    session.set("u.kernel.0.amplitude", 0.0)
    session.run(5)
    assert dd.open_record(tmp_path / "r.zarr").sizes["time"] >= 6


def test_a_change_after_the_last_step_is_stored(tmp_path: Path) -> None:
    session = dd.Session(model())
    with session.record(tmp_path / "r.zarr", "u"):
        session.step()
        session.set("u.tau", 70.0)
    changes = json.loads(dd.open_record(tmp_path / "r.zarr").attrs["changes"])
    assert changes == [{"tick": 1, "what": "u.tau", "value": 70.0}]


def test_of_several_moves_between_two_steps_the_last_one_is_stored(tmp_path: Path) -> None:
    session = dd.Session(model())
    with session.record(tmp_path / "r.zarr", "u"):
        session._note("move", "block", [1.0, 2.0])
        session.step()
        session._note("move", "block", [3.0, 4.0])
        assert session.recorder is not None
        session.recorder.note()
        session._note("move", "block", [5.0, 6.0])
    changes = json.loads(dd.open_record(tmp_path / "r.zarr").attrs["changes"])
    assert [change["value"] for change in changes] == [[1.0, 2.0], [5.0, 6.0]]


def test_a_session_has_one_recorder_at_a_time(tmp_path: Path) -> None:
    session = dd.Session(model())
    recorder = session.record(tmp_path / "r.zarr", "u")
    with pytest.raises(ParameterError, match="recorded already"):
        session.record(tmp_path / "other.zarr", "u")
    recorder.close()
    recorder.close()
    with pytest.raises(OutputExists):
        session.record(tmp_path / "r.zarr", "u")
    with pytest.raises(ParameterError, match="twice"):
        session.record(tmp_path / "other.zarr", ["u", "u.activation,every=10"])
    assert not (tmp_path / "other.zarr").exists()
    session.record(tmp_path / "r.zarr", "u", force=True).close()
    assert files.load_record(tmp_path / "r.zarr").sizes["time"] == 1


def test_an_exception_in_the_block_ends_the_record_as_incomplete(tmp_path: Path) -> None:
    session = dd.Session(model())
    with pytest.raises(ZeroDivisionError), session.record(tmp_path / "r.zarr", "u"):
        session.step(4)
        _ = 1 / 0
    record = dd.open_record(tmp_path / "r.zarr")
    assert record.sizes["time"] == 5 and about(record)["complete"] is False
    assert "ZeroDivisionError" in about(record)["ended"]


def test_a_live_run_is_recorded(tmp_path: Path) -> None:
    session = dd.Session(model(), seed=3)
    with session.record(tmp_path / "r.zarr", ["u", "n"], every=5):
        session.run_live(200, speed=None)
    expected = dd.simulate(model(), 200, seed=3, record=["u", "n"], every=5)
    record = files.load_record(tmp_path / "r.zarr")
    assert record.drop_attrs().identical(expected.drop_attrs())
