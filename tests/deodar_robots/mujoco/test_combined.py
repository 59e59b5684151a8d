"""A world with sensors of other worlds: a camera, a video or a picture takes the place of a simulated one."""

from __future__ import annotations

import time
from pathlib import Path

import cv2
import numpy as np
import pytest

import deodar as dd
from deodar.errors import WorldError
from deodar.numerics.axes import Axis
from deodar.recording.opened import again, named
from deodar.worlds.arena.arena import Arena
from deodar.worlds.camera import Camera
from deodar.worlds.combined import Combined
from deodar.worlds.picture import Picture
from deodar.worlds.video import Video
from deodar_robots.mujoco.mujoco import MuJoCo

AXES = (Axis("column", 0, 127, 128), Axis("row", 0, 95, 96), Axis("channel", 0, 2, 3))


def video(file: Path, worlds: list[MuJoCo], frames: int = 25) -> Path:
    """Write what the camera of tables sees, one second of each."""
    writer = cv2.VideoWriter(str(file), cv2.VideoWriter.fourcc(*"MJPG"), 25, (320, 240))
    axes = (Axis("column", 0, 319, 320), Axis("row", 0, 239, 240), AXES[2])
    for world in worlds:
        [seen] = world.sense("camera", axes, 0.0)
        for _ in range(frames):
            writer.write((255 * seen.transpose(1, 0, 2)[:, :, ::-1]).round().astype(np.uint8))
    writer.release()
    return file


def table(name: str = "", place: tuple[float, float] = (0.0, 0.3), color=(0.1, 0.8, 0.1)) -> MuJoCo:
    world = MuJoCo("table")
    if name:
        world.place(name, place, (0.08, 0.08), color)
    world.reset(0)
    return world


def test_the_arm_points_at_an_object_that_only_the_video_shows(tmp_path: Path):
    place = (-0.2, 0.32)
    file = video(tmp_path / "table.avi", [table("green", place)])
    world = Combined(MuJoCo("table"), {"camera": Video(file)})
    session = dd.Session(dd.architectures.pointing(), world=world, seed=1)
    satisfied = False
    for k in range(600):
        if k in (0, 30):
            for name in ("green", "left"):
                session.set(f"say {name}.amplitude", 3.0 if k == 0 else 0.0)
        session.step()
        satisfied |= float(np.max(session.read("satisfaction.activation"))) > 1
        if satisfied and float(np.max(session.read("perceptual.activation"))) < 0:
            break
    assert satisfied
    assert np.hypot(*(np.subtract(world.world.tool()[:2], place))) < 0.04
    assert world.scene().boxes == (), "the table is empty"


def test_readings_and_times_are_those_of_the_worlds(tmp_path: Path):
    file = video(tmp_path / "table.avi", [table(), table("red", color=(0.9, 0.1, 0.1))])
    world = Combined(table(), {"camera": Video(file, period=40.0)})
    world.reset(0, [0, 1])
    assert world.period == 10 and world.sensors["camera"].period == 40 and not world.sensors["camera"].each
    assert world.sense("tool", (), 0.0).shape == (2, 3)
    first, later = (world.sense("camera", AXES, t) for t in (0.0, 1500.0))
    np.testing.assert_array_equal(later, Video(file).sense("picture", AXES, 1500.0))
    assert np.abs(first - later).max() > 0.4
    assert Combined(table(), {"camera": Video(file, period=33.0)}).sensors["camera"].period is None
    assert [p.what for p in world.validate_axes("camera", AXES)] == []


def test_objects_state_and_descriptions_are_passed_on(tmp_path: Path):
    picture = Picture.example()
    world = Combined(MuJoCo("table"), {"camera": picture})
    world.reset(0)
    world.place("a", (0.2, 0.4), (0.06, 0.06))
    world.move("a", (0.25, 0.4))
    world.push("link 5", (5, 0, 0))
    kept, arranged = world.keep(), world.arrangement()
    world.act({"tool_plane": np.array([[0.1, 0.0]])}, 0.0)
    moved = world.world.tool()
    world.put(kept)
    world.act({"tool_plane": np.array([[0.1, 0.0]])}, 0.0)
    assert world.world.tool() == moved
    world.remove("a")
    world.arrange(arranged)
    assert [box.name for box in world.scene().boxes] == ["a"] and world.repeatable
    file = video(tmp_path / "table.avi", [table()])
    described = Combined(world.world, {"camera": Video(file)}).describe()
    opened = again(Combined, described)
    assert opened.describe() == described


def test_the_command_line_names_all_worlds(tmp_path: Path):
    file = video(tmp_path / "table.avi", [table()])
    world = named(f"combined:mujoco:table,period=20; camera=video:{file}", "--world")
    assert isinstance(world, Combined) and world.period == 20
    assert isinstance(world.others["camera"], Video)
    hyphens = named(f"Com-Bined:mu-joco:table;camera=video:{file}", "--world")
    assert isinstance(hyphens, Combined), "neither case nor hyphens count"
    for text, message in (
        ("mujoco:table", "no sensor is read from another world"),
        ("mujoco:table;video:x", "names no sensor"),
        ("mujoko:table;camera=video:x", "there is no world 'mujoko'"),
        ("mujoco;camera=video:x", "needs an argument"),
        (f"mujoco:table;camera=video:{tmp_path / 'none.avi'}", "none.avi"),
    ):
        with pytest.raises(WorldError, match=message):
            named(f"combined:{text}", "--world")


def test_a_camera_that_stops_ends_the_run_with_its_name_and_the_arm_stays(tmp_path: Path):
    file = video(tmp_path / "table.avi", [table("green", (-0.2, 0.32))], frames=12)
    world = Combined(MuJoCo("table"), {"camera": Camera(str(file), patience=0.2)})
    session = dd.Session(dd.architectures.pointing(), world=world, seed=1)
    with pytest.raises(WorldError, match=r"table\.avi"):
        for _ in range(2000):
            session.step()
            time.sleep(0.005)
    assert np.hypot(*np.subtract(world.world.tool()[:2], (0.0, 0.12))) < 0.02, "it was at rest"
    # the run continues in another world
    session.world = Combined(world.world, {"camera": Video(file, loop=True)})
    session.reset()
    session.step(20)
    assert session.time == 200


def test_a_world_that_does_not_fit_is_refused():
    with pytest.raises(WorldError, match="has motors"):
        Combined(MuJoCo("table"), {"camera": Arena.example()})

    class Two(Picture):
        sensors = {"a": Picture.sensors["picture"], "b": Picture.sensors["picture"]}

    with pytest.raises(WorldError, match="no sensor 'camera', and not one alone: a, b"):
        Combined(MuJoCo("table"), {"camera": Two(np.zeros((4, 4, 3)))})
