"""One contract for every kind of robot file: it is read, reset, moved, halted, described and opened again."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import cv2
import numpy as np
import pytest

import deodar as dd
from deodar import registry
from deodar.cli import main
from deodar.numerics.axes import Axis, shape
from deodar_robots.robot.robot import NOT_DATA, Robot
from deodar_robots.ros2.example_node import MOTORS, SENSORS, ExampleNode
from deodar_robots.zenoh.served_world import ServedWorld

PICTURES = {"picture": [Axis("x", 0, 7, 8), Axis("y", 0, 5, 6), Axis("channel", 0, 2, 3)]}


@pytest.fixture
def peers():
    """Return a list of what serves a robot until the test ends."""
    begun: list = []
    yield begun
    for each in begun:
        each.close()


def video(folder: Path) -> str:
    writer = cv2.VideoWriter(str(folder / "film.avi"), cv2.VideoWriter.fourcc(*"MJPG"), 25, (64, 48))
    for k in range(50):
        writer.write(np.full((48, 64, 3), 5 * k, np.uint8))
    writer.release()
    return "film.avi"


def arena(folder, peers):
    return {"kind": "arena", "settings": {"layout": "blocks", "unit": "cm"}}


def mujoco(folder, peers):
    return {"kind": "mujoco", "settings": {"scene": "head"}, "period": 20}


def gymnasium(folder, peers):
    return {"kind": "gymnasium", "settings": {"environment": "MountainCarContinuous-v0"}}


def zenoh(folder, peers):
    peers.append(ServedWorld(dd.Arena("blocks", unit="cm"), "behind"))
    return {"kind": "zenoh", "settings": {"robot": "behind", "at": peers[-1].endpoint, "patience": 5}}


def ros2(folder, peers):
    peers.append(ExampleNode())
    settings = {"sensors": SENSORS, "motors": MOTORS, "at": peers[-1].at, "patience": 60}
    return {"kind": "ros2", "settings": settings}


def rosbag(folder, peers):
    # files of a robot lie in its folder
    shutil.copytree(dd.ROSBag.example().name, folder / "bag")
    return {"kind": "rosbag", "settings": {"file": "bag"}}


def camera(folder, peers):
    return {"kind": "camera", "settings": {"source": video(folder), "rate": 30, "patience": 60}}


def film(folder, peers):
    return {"kind": "video", "settings": {"file": video(folder)}}


KINDS = {made.__name__: made for made in (arena, mujoco, gymnasium, zenoh, ros2, rosbag, camera, film)}


@pytest.mark.parametrize("kind", KINDS)
def test_a_robot_of_every_kind_keeps_the_contract(kind, peers, tmp_path, capsys):
    file = tmp_path / "mine.json"
    file.write_text(json.dumps({"robot": 1, "name": "mine", **KINDS[kind](tmp_path, peers)}))
    robot = Robot(file)
    robot.reset(0)
    expected = [(name, axes_of(robot, name)) for name in robot.sensors if axes_of(robot, name) is not None]
    assert expected, "it reads something"
    readings = robot.sense_all(expected, 0.0)
    for (name, axes), reading in zip(expected, readings, strict=True):
        given = np.asarray(reading)
        each = robot.sensors[name].each and given.ndim == len(axes) + 1
        assert (given[0] if each else given).shape == shape(axes) and np.isfinite(given).all()
    still = {name: np.zeros((1, *(signal.shape or ())), np.float32) for name, signal in robot.motors.items()}
    robot.act(still, 0.0)
    robot.halt()
    described = robot.describe()
    assert described["robot"] == "mine" and json.loads(json.dumps(described)) == described
    robot.close()
    same = Robot.again(described)
    assert isinstance(same, Robot) and set(same.sensors) == set(robot.sensors)
    same.close()
    assert main(["robots", "check", str(file)]) == 0
    printed = capsys.readouterr().out
    assert printed.startswith("mine is there") and all(name in printed for name in robot.sensors)


def axes_of(robot: Robot, name: str):
    """Return axes over which a sensor is read; None for one whose axes a model has to state."""
    if name in PICTURES and robot.sensors[name].shape is None:
        return tuple(PICTURES[name])
    of = robot.sensors[name].shape
    return None if of is None else tuple(Axis(f"a{k}", 0, n, n, periodic=True) for k, n in enumerate(of))


def test_every_kind_of_world_that_a_file_may_state_is_tested_here_or_needs_no_settings():
    tested = {"film": "video"}
    known = {name.casefold() for name in registry.kinds("worlds")} - set(NOT_DATA)
    left = known - {tested.get(kind, kind) for kind in KINDS}
    # worlds without motors, from one file or a screen
    assert left == {"picture", "eventfile", "eye"}
