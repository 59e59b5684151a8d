"""The demonstration from the command line: claims, figure and video; and cues that are none."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest
from PIL import Image

from deodar_papers.pointing import narrative


def demo(folder: Path, *options: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "deodar", "demo", "pointing", *options]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=600)


def test_every_claim_of_the_command_holds_and_the_video_shows_the_arm_move(tmp_path: Path) -> None:
    done = demo(tmp_path)
    assert done.returncode == 0, done.stdout + done.stderr
    out = tmp_path / "demo-pointing-001"
    found = json.loads((out / "results.json").read_text())["claims"]
    assert len(found) == 8 and all(c["holds"] is True for c in found), found
    assert (out / "pointing.png").stat().st_size > 100_000
    with Image.open(out / "pointing.gif") as video:
        assert video.n_frames > 50 and video.size == (240, 180)


def test_an_object_that_is_not_there_and_words_that_are_no_cue(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    left = [d for d in narrative.discs() if d.name != "red 2"]
    monkeypatch.setattr(narrative, "discs", lambda: left)
    result = narrative.run([("red", "right")])
    claim = narrative.claims(result)[-1]
    assert claim.name == "red right: no such object, no peak" and claim.holds
    assert narrative.sentence(result) == "red right: no peak."
    wrong = demo(tmp_path, "--ask", "purple left")
    assert wrong.returncode != 0 and "--ask 'green left'" in wrong.stderr + wrong.stdout
