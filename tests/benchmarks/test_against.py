"""Two checkouts that are timed in alternation."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))

import against


def test_a_disturbed_call_does_not_change_the_time_of_a_step() -> None:
    calls = []

    def asker(us: float):
        def ask(n: int) -> float:
            calls.append(n)
            return 0.01 + 1e-6 * us * n + (0.5 if len(calls) % 3 == 0 else 0.0)

        return ask

    assert against.compare(asker(2.0), asker(3.0), 1000, 20) == pytest.approx([2e-6, 3e-6])
    assert len(calls) == 80


def test_a_folder_without_workloads_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(sys, "argv", ["against.py", str(tmp_path)])
    with pytest.raises(SystemExit):
        against.main()
    assert "is no checkout with benchmarks/steps.py" in capsys.readouterr().err


def test_times_to_the_first_step_are_medians_in_alternation(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    times = {tmp_path: iter([1.0, 9.0, 2.0]), against.HERE.parent: iter([3.0, 8.0, 1.0])}
    called = []

    def first_step(folder: Path, name: str) -> float:
        called.append(folder == tmp_path)
        return next(times[folder])

    monkeypatch.setattr(against, "first_step", first_step)
    against.compare_first(tmp_path, ["SPA"], 3)
    assert "| SPA          |     2.000 |     3.000 | 1.500 |" in capsys.readouterr().out
    assert called == [False, True, True, False, False, True]
