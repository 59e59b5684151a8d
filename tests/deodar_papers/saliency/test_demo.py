"""The saliency demo: its claims on one photograph, and on all of them from the command line."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import deodar as dd
from deodar.architectures.saliency import scene as scene_axes
from deodar.worlds import _capture
from deodar.worlds.camera import Camera
from deodar_papers.saliency import scenes, targets
from deodar_papers.saliency.scenes import Cue, filmed, own, photographs, run_scene, watched
from deodar_papers.saliency.targets import sentence
from tests.command_line import typed


def test_every_claim_of_the_command_holds(tmp_path: Path) -> None:
    command = typed("demo saliency --out", out := tmp_path / "out")
    assert command.status == 0, command.words
    claims = json.loads((out / "results.json").read_text())["claims"]
    assert len(claims) >= 13 and all(
        c["kind"] == "reported" and c["inferred"] and c["assumes"] for c in claims
    ), "no evidence"
    assert all(c["holds"] is True for c in claims), [c for c in claims if not c["holds"]]
    for name in ("coffee", "chelsea", "astronaut"):
        assert (out / f"{name}.png").stat().st_size > 10_000 and (out / f"{name}.zarr").is_dir()
        kinds = {c["name"].split(",")[1].split()[0] for c in claims if c["name"].startswith(name)}
        assert kinds == {"no", "cue"}
    assert "5 of 5" in command.out.splitlines()[-1]


def test_claims_hold_for_another_seed_and_fail_for_a_wrong_mark() -> None:
    """The claim is computed, so it is false with the box at another position."""
    chelsea = next(s for s in photographs() if s.name == "chelsea")
    wrong = Cue(5.0, "red", "present", "the eye", (((0, 0), (100, 0), (100, 100), (0, 100)),))
    scene = scenes.CueScene("chelsea", "", chelsea.picture, (*chelsea.cues, wrong, Cue(5.0, "red", "absent")))
    searched = run_scene(scene, seed=11)
    marks = [c.holds for c in targets.claims(searched)]
    assert marks == [True, True, True, True, True, False, True, False, False]
    assert "1 of 2 cued colours" in sentence([searched])


def test_a_photograph_of_the_user_is_searched(tmp_path: Path) -> None:
    scene = np.full((60, 90, 3), 120, np.uint8)
    scene[20:40, 60:80] = [20, 30, 230]
    Image.fromarray(scene).save(tmp_path / "mine.png")
    searched = run_scene(own(tmp_path / "mine.png", [240.0, 0.0]))
    blue, red = searched.outcomes
    assert len(blue.places) == 1 and 60 <= blue.places[0][0] <= 80 and 20 <= blue.places[0][1] <= 40
    assert not red.places and abs(blue.motor[0] - blue.places[0][0]) < 3
    (peak,), x_and_y = blue.spatial, scene_axes()[:2]
    assert searched.scene.picture.to_pixels(x_and_y, *peak) == pytest.approx(blue.places[0], abs=3)
    assert not red.spatial
    assert all(c.holds is None for c in targets.claims(searched)[1:])


@pytest.mark.parametrize("way", ["film", "camera"])
def test_a_video_and_a_camera_are_searched(way: str) -> None:
    """A red square crosses the video in its first second and then stays at columns 48 to 63."""
    film = _capture.example()
    scene = (
        filmed(film, [0.0, 240.0])
        if way == "film"
        else watched(Camera(str(film), period=scenes.PERIOD, patience=60.0), [0.0, 240.0])
    )
    red, blue = run_scene(scene).outcomes
    assert len(red.places) == 1 and 46 <= red.places[0][0] <= 64 and 14 <= red.places[0][1] <= 34
    assert not blue.places and abs(red.motor[0] - red.places[0][0]) < 4


@pytest.mark.parametrize(
    ("option", "says"),
    [("--video none.mp4", "there is no such video"), ("--camera 77", "there is no camera")],
)
def test_a_missing_video_or_camera_is_an_error(
    option: str, says: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    command = typed(f"demo saliency {option}")
    assert command.status == 1 and says in " ".join(command.err.split()), command.err
    assert not list(tmp_path.iterdir())


def test_invalid_pictures_cues_and_folders_are_refused(tmp_path: Path) -> None:
    with pytest.raises(dd.errors.WorldError, match="no such picture"):
        own(tmp_path / "nothing.jpg", [])
    with pytest.raises(dd.errors.DocumentError, match="0 to 360"):
        own(tmp_path / "nothing.jpg", [400.0])
    (tmp_path / "full").mkdir()
    (tmp_path / "full" / "thesis.txt").write_text("do not lose me")
    for force in ("", "--force"):
        assert typed("demo saliency", force, "--out", tmp_path / "full").status == 1
    assert [p.name for p in (tmp_path / "full").iterdir()] == ["thesis.txt"]
