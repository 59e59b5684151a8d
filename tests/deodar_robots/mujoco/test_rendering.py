"""Cameras by OpenGL show objects where those by rays do; without EGL an error says so."""

from __future__ import annotations

import ctypes
import dataclasses as dc
import threading

import numpy as np
import pytest

from deodar.errors import WorldError
from deodar.numerics.axes import Axis
from deodar_robots.mujoco import cameras
from deodar_robots.mujoco.cameras import MuJoCoCameras
from deodar_robots.mujoco.mujoco import MuJoCo

AXES = (Axis("column", 0, 127, 128), Axis("row", 0, 95, 96), Axis("channel", 0, 2, 3))


def example(**settings: object) -> MuJoCo:
    world = MuJoCo("table", cameras=MuJoCoCameras(render="egl", **settings))
    world.place("green", (-0.2, 0.4), (0.08, 0.08), (0.1, 0.8, 0.1))
    world.place("red", (0.2, 0.25), (0.08, 0.08), (0.8, 0.1, 0.1))
    return world


def has_egl() -> bool:
    try:
        cameras.context()
    except WorldError as error:
        assert 'render="rays"' in str(error)
        return False
    return True


def middle(seen: np.ndarray, channel: int) -> np.ndarray:
    others = np.delete(seen, channel, axis=2).max(axis=2)
    places = np.argwhere(seen[:, :, channel] > 0.2 + 1.5 * others)
    assert len(places) > 15
    return places.mean(axis=0)


def test_objects_are_where_rays_show_them_or_the_error_says_that_egl_is_absent():
    world = example()
    if not has_egl():
        with pytest.raises(WorldError, match="cannot be drawn by EGL"):
            world.sense("camera", AXES, 0.0)
        return
    seen: list[np.ndarray] = []

    def draw() -> None:
        seen.append(world.sense("camera", AXES, 0.0)[0])

    draw()
    world.move("red", (-0.1, 0.2))
    # a session of the studio draws in a thread of its own
    thread = threading.Thread(target=draw)
    thread.start()
    thread.join()
    world.cameras = dc.replace(world.cameras, light=0.5)
    world.reset(0)
    draw()
    for place, now in (((0.2, 0.25), seen[0]), ((-0.1, 0.2), seen[1])):
        rays = MuJoCo("table")
        rays.place("green", (-0.2, 0.4), (0.08, 0.08), (0.1, 0.8, 0.1))
        rays.place("red", place, (0.08, 0.08), (0.8, 0.1, 0.1))
        other = rays.sense("camera", AXES, 0.0)[0]
        for channel in (0, 1):
            np.testing.assert_allclose(middle(now, channel), middle(other, channel), atol=0.7)
    other = np.abs(seen[2] - 0.5 * seen[1]).max(axis=2) > 0.01
    assert other.mean() < 0.01, "an object that was moved lies half a millimetre higher"
    assert seen[0].dtype == np.float32 and seen[0].max() <= 1


def test_without_the_library_the_error_names_it(monkeypatch: pytest.MonkeyPatch):
    def absent(name: str) -> None:
        raise OSError(name)

    monkeypatch.setattr(ctypes, "CDLL", absent)
    with pytest.raises(WorldError, match=r"there is no libEGL\.so\.1"):
        cameras.Context()


def test_the_setting_is_part_of_the_description_and_of_the_command_line():
    world = MuJoCo.open("table, render=egl")
    assert world.cameras.render == "egl" and MuJoCo.again(world.describe()).cameras.render == "egl"
    with pytest.raises(WorldError, match="expected one of rays, egl"):
        MuJoCo("table", cameras=MuJoCoCameras(render="opengl"))
