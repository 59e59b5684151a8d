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
