"""Sessions that continue recorded runs have the bits of undisturbed ones."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import deodar as dd
from deodar.errors import RecordError, TimeError
from tests.deodar.session.models import bits, mixed
from tests.deodar.worlds.test_recorded_run import driving


def test_a_single_run_continues_with_the_bits_of_an_undisturbed_session(tmp_path: Path) -> None:
    dd.simulate(mixed(), 60, seed=4, record=["u", "v"], every=5, out=tmp_path / "run")
    reports: list[tuple[int, int]] = []
    session = dd.session_at(
        tmp_path / "run", 37, on=dd.Resources(progress=lambda at: reports.append((int(at), at.of)))
    )
    script = dd.Session(mixed(), seed=4)
    script.step(37)
    assert bits(session) == bits(script) and reports[-1] == (37, 37)
    session.step(50)
    script.step(50)
    assert bits(session) == bits(script)


def test_a_recorded_session_continues_with_its_changes(tmp_path: Path) -> None:
    script = dd.Session(mixed(), seed=4)
    with script.record(tmp_path / "live", ["u"]):
        script.step(10)
        script.set({"u.resting_level": -3.0, "n.tau": 9.0})
        script.step(5)
        script.inject("u", np.linspace(0, 2, 31), 4)
        script.inject("u", 0.7, 3)
        script.step(8)
        half = bits(script)
        script.set("u.resting_level", -9.0)
        script.step(10)
    early = dd.session_at(tmp_path / "live", 30)
    assert bits(early) == half and early.get("u.resting_level") == -9, "a change at this step is made"
    session = dd.session_at(tmp_path / "live", 40)
    assert bits(session) == bits(script)
    session.step(20)
    script.step(20)
    assert bits(session) == bits(script)


def test_a_recorded_session_continues_in_its_world(tmp_path: Path) -> None:
    script = dd.Session(driving(), seed=4, world=dd.Arena("blocks"))
    with script.record(tmp_path / "live", ["u"]):
        script.step(10)
        script.place("late", (0.9, 0.4), (0.04, 0.04))
        script.step(10)
    session = dd.session_at(tmp_path / "live", script.time)
    session.step(15)
    script.step(15)
    assert bits(session) == bits(script)


def late(place: Path) -> None:
    session = dd.Session(mixed())
    session.step(3)
    with session.record(place, ["u"]):
        session.step(5)


def edited(place: Path) -> None:
    session = dd.Session(mixed())
    with session.record(place, ["u"]):
        session.step(2)
        session.dt = 0.5
        session.step(6)


def trials(place: Path) -> None:
    dd.simulate(mixed(), 6, record=["u"], trials=2, out=place)


@pytest.mark.parametrize(
    ("make", "reason"),
    [
        (late, "began at step 3 of a session"),
        (edited, "the change of 'dt' at step 2 cannot be repeated"),
        (trials, "several trials or points of a sweep"),
    ],
)
def test_a_record_that_cannot_be_continued_states_why(
    tmp_path: Path, make: Callable[[Path], None], reason: str
) -> None:
    make(tmp_path / "run")
    with pytest.raises(RecordError, match=reason):
        dd.session_at(tmp_path / "run", 5)


def test_a_record_with_other_values_is_refused(tmp_path: Path) -> None:
    record = dd.simulate(mixed(), 6, record=["u"], every=1)
    record["u.activation"][4] += 1
    dd.save_record(record, tmp_path / "run.nc")
    assert dd.session_at(tmp_path / "run.nc", 3).tick == 3
    with pytest.raises(RecordError, match=r"other values of u\.activation at 4 than the record"):
        dd.session_at(tmp_path / "run.nc", 4)
    with pytest.raises(TimeError):
        dd.session_at(tmp_path / "run.nc", 3.5)
    with pytest.raises(TimeError):
        dd.session_at(tmp_path / "run.nc", -1)


def test_a_time_between_samples_is_compared_with_the_sample_before_it(tmp_path: Path) -> None:
    record = dd.simulate(mixed(), 40, record=["u"], every=5)
    record["u.activation"][4] += 1
    dd.save_record(record, tmp_path / "run.nc")
    assert dd.session_at(tmp_path / "run.nc", 19).tick == 19
    with pytest.raises(RecordError, match=r"other values of u\.activation at 20 than the record"):
        dd.session_at(tmp_path / "run.nc", 23)


def test_a_time_after_the_end_of_the_record_is_refused(tmp_path: Path) -> None:
    dd.simulate(mixed(), 12, record=["u"], every=5, out=tmp_path / "run")
    assert dd.session_at(tmp_path / "run", 12).tick == 12
    with pytest.raises(TimeError, match="the record ends at 12, before 13"):
        dd.session_at(tmp_path / "run", 13)


def test_a_session_that_is_still_recorded_is_continued_up_to_its_last_stored_sample(tmp_path: Path) -> None:
    script = dd.Session(mixed(), seed=4)
    with script.record(tmp_path / "live", ["u"]) as recorder:
        script.step(200)
        script.set("u.tau", 44.0)
        stored = dd.open_record(tmp_path / "live").time.values
        end = stored[-1] if len(stored) else 0.0
        with pytest.raises(TimeError, match="the record ends at"):
            dd.session_at(tmp_path / "live", end + 1)
        assert recorder.open
