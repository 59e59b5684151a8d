"""`deodar demo`: each demonstration has its own options, without running one."""

from __future__ import annotations

from pathlib import Path

import pytest

from deodar.cli import main
from deodar_papers import papers


@pytest.mark.parametrize(
    ("name", "option", "owner"),
    [
        ("spa", [], "spa"),
        ("spa", ["--noise", "low"], "spa"),
        ("saliency", ["--cue", "30"], "saliency"),
        ("serial-order", ["--sequence", "RGB"], "serial-order"),
        ("spa", ["--cue", "30"], "saliency"),
        ("spa", ["--sequence", "RGB"], "serial-order"),
        ("saliency", ["--noise", "low"], "spa"),
    ],
)
def test_a_demo_runs_with_its_own_options_and_refuses_those_of_others(
    name: str,
    option: list[str],
    owner: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    begun = []

    def run(args: object, show: object) -> None:
        begun.append(name)
        raise KeyboardInterrupt

    monkeypatch.chdir(tmp_path)
    for demo in papers.demos().values():
        monkeypatch.setattr(demo, "run", run)
    assert main(["demo", name, *option, "--no-progress"]) != 0
    assert begun == ([name] if owner == name else [])
    refused = f"{option[0]} belongs to the demo {owner}" if option else "belongs to"
    assert (refused in capsys.readouterr().err) == (owner != name)
    assert not list(tmp_path.iterdir())
