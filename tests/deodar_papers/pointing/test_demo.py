"""The demonstration from the command line: claims, figure and video; and cues that are none."""

from __future__ import annotations

import json
import math
from pathlib import Path

import pytest
from PIL import Image

from deodar_papers.pointing import narrative
from deodar_papers.pointing.cycle import PointingCycle
from deodar_papers.pointing.table import Moment
from tests.command_line import typed


def test_every_claim_of_the_command_holds_and_the_video_shows_the_arm_move(tmp_path: Path) -> None:
    command = typed("demo pointing --out", out := tmp_path / "out")
    assert command.status == 0, command.words
    claims = json.loads((out / "results.json").read_text())["claims"]
    assert len(claims) == 8 and all(c["holds"] is True for c in claims), claims
    assert (out / "pointing.png").stat().st_size > 100_000
    with Image.open(out / "pointing.gif") as video:
        assert video.n_frames > 50 and video.size == (240, 180)


def test_an_object_that_is_not_there_and_words_that_are_no_cue(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    remaining = [d for d in narrative.discs() if d.name != "red 2"]
    monkeypatch.setattr(narrative, "discs", lambda: remaining)
    record = narrative.run([("red", "right")])
    claim = narrative.claims(record)[-1]
    assert claim.name == "red right: no such object, no peak" and claim.holds
    assert narrative.sentence(record) == "red right: no peak."
    wrong = typed("demo pointing --ask 'purple left'")
    assert wrong.status != 0 and "--ask 'green left'" in wrong.words


def test_the_distance_is_that_from_the_object_of_the_present_cycle() -> None:
    first, second = narrative.discs()[:2]
    cycles = [PointingCycle(object=first), PointingCycle(object=second)]
    moments = [Moment(t, 0, 0, 0, (), (first.x, first.y)) for t in (500.0, 1500.0, 2500.0)]
    between = math.hypot(first.x - second.x, first.y - second.y)
    record = narrative.Pointed([], cycles, [1.0, 2.0], moments=moments)
    assert narrative.distance(record) == pytest.approx([math.nan, 0, between], nan_ok=True)
