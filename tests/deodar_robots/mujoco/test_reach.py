"""The tool of an arm: it arrives where it is led, and no command or push breaks a limit of a joint."""

from __future__ import annotations

import numpy as np
import pytest

from deodar_robots.mujoco.mujoco import MuJoCo
from deodar_robots.mujoco.reach import Arm
from deodar_robots.mujoco.scene_file import simulator

CORNERS = [(-0.35, 0.54), (0.35, 0.54), (0.35, 0.06), (-0.35, 0.06), (0.08, 0.06)]


def tool(world: MuJoCo) -> np.ndarray:
    return world.sense("tool", MuJoCo.example_axes("tool"), 0.0)[0]


def joints(world: MuJoCo) -> tuple[np.ndarray, np.ndarray]:
    return world.sense("joint_angles", (), 0.0)[0], world.sense("joint_velocities", (), 0.0)[0]


FINGER = """
<mujoco>
  <worldbody>
    <body>
      <joint name="hinge"/>
      <geom size="0.1"/>
      <site name="%s"/>
    </body>
  </worldbody>
  <actuator>
    <velocity joint="hinge" kv="2"/>
  </actuator>
</mujoco>
"""


@pytest.mark.parametrize("robot", MuJoCo.robots())
def test_the_tool_arrives_at_every_corner_of_the_table_at_its_height(robot):
    world = MuJoCo("table", robot)
    world.reset(0)
    height = tool(world)[2]
    assert height == pytest.approx(0.06, abs=1e-3)
    for goal in CORNERS:
        for _ in range(400):
            away = np.array(goal) - tool(world)[:2]
            expected = 5 * away * min(1.0, 0.25 / max(5 * np.hypot(*away), 1e-9))
            world.act({"tool_plane": expected[None]}, 0.0)
            assert abs(tool(world)[2] - height) < 0.003
        assert np.hypot(*away) < 0.001, goal


@pytest.mark.parametrize("robot", MuJoCo.robots())
def test_the_tool_has_the_velocity_that_is_commanded(robot):
    world = MuJoCo("table", robot)
    world.reset(0)
    command = np.array([0.05, 0.06, 0.08])
    for _ in range(30):
        world.act({"tool_velocity": command[None]}, 0.0)
    start = tool(world)
    for _ in range(50):
        world.act({"tool_velocity": command[None]}, 0.0)
    np.testing.assert_allclose((tool(world) - start) / 0.5, command, atol=0.004)


@pytest.mark.parametrize("robot", MuJoCo.robots())
def test_limits_hold_whatever_is_commanded_and_whatever_pushes(robot):
    world = MuJoCo("table", robot)
    world.reset(0)
    arm, random = world.arm, np.random.default_rng(4)
    assert arm is not None and np.isfinite(arm.fastest).all()
    reached = np.zeros(len(arm.fastest))
    for k in range(600):
        if k % 20 == 0:
            command = {
                "tool_velocity": random.normal(size=(1, 3)) * random.choice([0.2, 5.0]),
                "tool_plane": random.normal(size=(1, 2)) * random.choice([0.0, 3.0]),
                next(iter(world.motors)): random.normal(size=1) * 100,
            }
            pushes = random.normal(size=(world.model.nbody, 6)) * random.choice([0.0, 50.0, 2000.0])
        for data in world._copies:
            data.xfrc_applied[1:] = pushes[1:]
        world.act(command, 0.0)
        q, v = joints(world)
        assert np.all(q >= arm.lower) and np.all(q <= arm.upper)
        assert np.all(np.abs(v) <= arm.fastest * (1 + 1e-9))
        reached = np.maximum(reached, np.abs(v) / arm.fastest)
    assert reached.max() > 0.99, "the commands and pushes reach the limits"


def test_an_arm_is_found_by_its_tool_even_if_that_is_the_first_site():
    read = simulator().MjModel.from_xml_string
    arm = Arm.find(read(FINGER % "tool"), {})
    assert arm is not None and (arm.site, arm.lower.tolist()) == (0, [-np.inf])
    assert Arm.find(read(FINGER % "tip"), {}) is None


def test_a_target_out_of_reach_leaves_the_arm_stretched_and_still_and_it_comes_back():
    world = MuJoCo("table")
    world.reset(0)
    for _ in range(600):
        world.act({"tool_plane": np.array([[0.0, 0.25]])}, 0.0)
    far = tool(world)
    assert 1.0 < np.hypot(far[0], far[1] + 0.33) < 1.07
    for _ in range(100):
        world.act({"tool_plane": np.array([[0.0, 0.25]])}, 0.0)
    assert np.hypot(*(tool(world) - far)[:2]) < 0.02, "it stays there"
    for _ in range(300):
        world.act({"tool_plane": 3 * (np.array([[0.0, 0.3]]) - tool(world)[None, :2])}, 0.0)
    np.testing.assert_allclose(tool(world), [0.0, 0.3, 0.06], atol=0.005)


def test_without_a_command_the_arm_holds_its_posture():
    world = MuJoCo("table")
    world.reset(0)
    before = joints(world)[0]
    for _ in range(200):
        world.act({"tool_plane": np.zeros((1, 2))}, 0.0)
    np.testing.assert_allclose(joints(world)[0], before, atol=0.002)
