"""A run of 10^9 steps or more is announced and shows its progress; shorter runs are not announced."""

from __future__ import annotations

import warnings

import pytest

import deodar as dd
from deodar import progress
from deodar.batch import simulate as module
from deodar.errors import Interrupted, RunWarning


def small() -> dd.Model:
    model = dd.Model("small")
    model.add(dd.Field("u", []))
    return model


def stop(done: int) -> None:
    raise KeyboardInterrupt


def test_a_step_that_is_much_too_small_is_announced() -> None:
    with (
        pytest.warns(
            RunWarning,
            match=(
                r"1e\+10 steps of dt = 1e-09: a smaller number may be meant; the noise .* after 4.29e\+09"
                r" steps"
            ),
        ) as warned,
        pytest.raises(Interrupted),
    ):
        dd.simulate(small(), 10, dt=1e-9, on=dd.Resources(progress=stop))
    assert [t.filename for t in warned] == [__file__]


def test_a_run_below_1e9_steps_issues_no_warning() -> None:
    with warnings.catch_warnings(), pytest.raises(Interrupted):
        warnings.simplefilter("error")
        dd.simulate(small(), 10**9 - 1, on=dd.Resources(progress=stop))


def test_progress_without_a_terminal_is_printed_as_lines(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(module, "LONG_STEPS", 500)
    monkeypatch.setattr(progress, "LINE_AFTER", 0.0)
    with pytest.warns(RunWarning, match="500 steps"):
        dd.simulate(small(), 500)
    assert "simulating: " in (complaint := capsys.readouterr().err) and "of 500 steps" in complaint
    with pytest.warns(RunWarning, match="500 steps"):
        dd.simulate(small(), 500, on=dd.Resources(progress=False))
    assert capsys.readouterr().err == ""


def test_intervals_between_lines_of_progress_double(capsys: pytest.CaptureFixture[str]) -> None:
    clock = [0.0]
    shown = progress.lines(lambda: clock[0])
    for second in range(1, 101):
        clock[0] = float(second)
        shown(
            progress.Progress(10 * second, 1000, task="simulating", unit="steps", seconds_left=100.0 - second)
        )
    lines = capsys.readouterr().err.splitlines()
    assert lines[0] == "simulating: 100 of 1000 steps, about 90 s left (after 10 s)"
    assert [line.split("(after ")[1].split(" s)")[0] for line in lines] == ["10", "20", "40", "80"]
