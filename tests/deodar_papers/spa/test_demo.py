"""The planning demo: its first 300 steps, and claims computed from the record."""

from __future__ import annotations

import dataclasses as dc
import itertools
import json
from pathlib import Path

import numpy as np
import pytest
import xarray
from PIL import Image

from deodar.architectures.spa import DIRECTIONS, OBSTACLES, STEP_MS, maze
from deodar_papers.figures import plan
from deodar_papers.spa import narrative
from tests.command_line import typed

INFERRED_WAVE = "the wave reaches location 2, in the motivation to go west, at step"


def record(pose: np.ndarray, intention: np.ndarray) -> xarray.Dataset:
    """Return a record like that of a run without noise: north has the given intention, the other
    behaviours none.
    """
    time, x, y = np.arange(len(pose)) * float(narrative.EVERY), np.arange(-104.0, -4), np.arange(5.0, 105)
    settings: dict[str, object] = {"pose.output": (("time", "pose"), pose)}
    for name in DIRECTIONS:
        settings[f"{name}.strongest.output"] = (
            ("time",),
            intention if name == "north" else np.zeros(len(pose)),
        )
        settings[f"{name}.motivation.activation"] = (
            ("time", "x", "y"),
            np.full((len(pose), 100, 100), -5.0, np.float32),
        )
    return xarray.Dataset(settings, {"time": time, "x": x, "y": y})


def way(*corners: tuple[float, float], each: int) -> np.ndarray:
    """Return a path over corners, with `each` records from one to the next."""
    pieces = [np.linspace(a, b, each, endpoint=False) for a, b in itertools.pairwise(corners)]
    line = np.concatenate([*pieces, [corners[-1]]])
    return np.column_stack([line, np.zeros(len(line))])


def test_claims_follow_from_the_record() -> None:
    start, north, back, south, goal = (
        (-45.0, 55.0),
        (-48.0, 90.0),
        (-25.0, 66.0),
        (-25.0, 25.0),
        (-65.0, 65.0),
    )
    pose = np.concatenate([way(start, start, each=110), way(start, north, back, south, goal, each=100)])
    intention = (np.arange(len(pose)) >= 105).astype(float)
    reading = narrative.read(record(pose, intention), maze("z"))
    assert (reading.planned, reading.left) == (210, pytest.approx(236, abs=4))
    assert reading.north is not None and reading.south is not None and reading.arrived is not None
    assert reading.left < reading.north < reading.south < reading.arrived
    assert [c.holds for c in narrative.claims(reading) if c.kind == "required"] == [True] * 3
    assert {c.name.partition(":")[0] for c in narrative.claims(reading) if c.inferred} == {
        "the plan is complete",
        INFERRED_WAVE,
    }
    early = np.concatenate([np.ones(105), np.zeros(len(pose) - 105)])
    for late, straight in (
        (early, pose),
        (intention * 0, pose),
        (intention, pose[:300]),
        (intention, np.concatenate([pose[:110], way(start, goal, each=200)])),
    ):
        wrong = narrative.read(record(straight, late[: len(straight)]), maze("z"))
        assert any(c.holds is False for c in narrative.claims(wrong) if c.kind == "required")
    assert "never planned" in narrative.sentence(narrative.read(record(pose, intention * 0), maze("z")))


@pytest.mark.parametrize(
    ("published", "second"), [(True, "another plan: never"), (False, "at the goal: never")]
)
def test_the_figure_names_its_times_and_those_that_did_not_occur(published: bool, second: str) -> None:
    start = (-45.0, 55.0)
    pose = np.concatenate([way(start, start, each=110), way(start, (-48.0, 60.0), each=100)])
    intention = (np.arange(len(pose)) >= 105).astype(float)
    arena = maze("z")
    if published:
        arena.place("obstacle", *OBSTACLES["full"], windows=(narrative.COMES * STEP_MS, 1e9))
    copied = dc.replace(narrative.read(record(pose, intention), arena), published=published)
    drawn = copied.figure()
    titles = [place.get_suptitle() for half in drawn.subfigs for place in half.subfigs]
    assert [title for title in titles if title] == ["plan complete, step 210", second]
    obstacle = [text for text in drawn.subfigs[0].subfigs[0].axes[0].texts if "from" in text.get_text()]
    assert [text.get_text() for text in obstacle] == ([f"from\n{narrative.COMES}"] if published else [])
    if published:
        assert obstacle[0].get_position() == pytest.approx(OBSTACLES["full"][0])
    grey = [patch for patch in drawn.subfigs[0].subfigs[0].axes[0].patches if patch.get_width() > 0]
    assert len(grey) == len(arena.layout.objects) + published, "walls and obstacle are drawn"


def test_a_frame_of_the_video_shows_robot_goal_and_step_at_their_positions() -> None:
    """The robot stands, and its motivation does not change: two frames differ in the printed step alone."""
    robot = (-45.0, 55.0)
    reading = narrative.read(record(way(robot, robot, each=30), np.zeros(31)), maze("z"))
    first, later = (np.asarray(plan._frame(reading, k).convert("RGB"), int) for k in (0, 30))
    height, width, _ = first.shape
    assert (height, width) == (100 * plan.SCALE,) * 2
    rows, columns = np.nonzero(np.abs(first - later).sum(axis=-1) > 60)
    assert len(rows) and rows.max() < 20 and columns.min() >= width - 80
    dark = first.max(axis=-1) < 45
    for (x, y), reach in ((reading.goal, 14), (robot, 26)):
        column, row = (x + 104 + 0.5) * plan.SCALE, (104 + 0.5 - y) * plan.SCALE
        down, across = np.nonzero(dark)
        near = (abs(down - row) < reach) & (abs(across - column) < reach)
        assert near.sum() > 20
        middle = (across[near].min() + across[near].max()) / 2, (down[near].min() + down[near].max()) / 2
        assert middle == pytest.approx((column, row), abs=1.5)


def test_the_command_writes_the_printed_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(narrative, "DURATION", 300)
    out = tmp_path / "planned"
    command = typed("demo spa --no-progress --out", out)
    assert command.status == 1, "in 300 steps it does not arrive, which is a required claim"
    claims = json.loads((out / "results.json").read_text())["claims"]
    plan = next(c for c in claims if c["name"].startswith("the plan is complete"))
    assert (
        plan["holds"] is True
        and abs(plan["value"] - 210) <= 21
        and plan["inferred"]
        and plan["kind"] == "reported"
    )
    assert [c["holds"] for c in claims if "arrives within" in c["name"]] == [False]
    assert "never at the goal" in command.out.splitlines()[-1]
    with Image.open(out / "spa.gif") as film:
        assert film.n_frames == 31 and film.size == (400, 400)
        frame = np.asarray(film.convert("RGB"))
    # the walls of the arena reach the edges of the picture
    assert all(len(np.unique(edge, axis=0)) == 1 for edge in (frame[:, 0], frame[:, -1], frame[-1]))
    with Image.open(out / "spa.png") as picture:
        assert min(picture.size) > 1000 and len(set(picture.convert("L").tobytes())) > 100
    assert (out / "spa.zarr").is_dir()


def test_options_of_another_demo_are_refused() -> None:
    command = typed("demo spa --cue 30")
    assert command.status != 0 and "--cue belongs to the demo saliency" in command.err


MAZE = {
    "unit": "cm",
    "arena": {"x": [0, 60], "y": [0, 50]},
    "walls": [{"name": "divide", "center": [30, 35], "size": [4, 30]}],
    "start": [12, 30],
    "goal": [48, 32],
}


def test_a_maze_of_the_user_is_planned_and_driven(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(narrative, "LONGEST", 500)
    file = tmp_path / "maze.json"
    file.write_text(json.dumps(MAZE))
    out = tmp_path / "out"
    command = typed("demo spa --maze", file, "--goal 48 34 --noise low --no-progress --out", out)
    assert command.status == 0 and sorted(p.name for p in out.iterdir()) == [
        "results.json",
        "spa.gif",
        "spa.png",
        "spa.zarr",
    ]
    report = json.loads((out / "results.json").read_text())
    assert report["settings"]["maze"]["goal"] == [[48, 34]] and "obstacle_at" not in report["settings"]
    arrived = next(c for c in report["claims"] if c["name"].startswith("it arrives"))
    assert arrived["kind"] == "reported" and arrived["holds"] is True
    assert "at the goal at step" in command.out
