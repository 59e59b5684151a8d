"""What a file leaves without a name has one in the world, and a file states the period of its world."""

from __future__ import annotations

from importlib.util import find_spec
from pathlib import Path

import mujoco
import numpy as np
import pytest

import deodar as dd
from deodar.errors import RunWarning, WorldError
from deodar.recording import stored
from deodar_robots.mujoco.mujoco import MuJoCo

ASSETS = Path(str(find_spec("gymnasium").origin)).parent / "envs" / "mujoco" / "assets"
"""Robots of Gymnasium, most of which name no actuator."""

UNNAMED = """
<mujoco>
  <option timestep="0.003"/>
  <worldbody>
    <camera pos="0 -2 0.5"/>
    <body name="hand" mocap="true" pos="0 0 1"><geom size="0.1" contype="0" conaffinity="0"/></body>
    <body mocap="true" pos="0 1 1"><geom size="0.1" contype="0" conaffinity="0"/></body>
    <body name="arm">
      <joint name="hip" axis="0 1 0"/>
      <geom size="0.1" mass="1"/>
      <site name="tip"/>
      <body pos="0.5 0 0"><joint axis="0 1 0"/><joint axis="0 0 1"/><geom size="0.1" mass="1"/></body>
    </body>
  </worldbody>
  <tendon><fixed name="cord"><joint joint="hip" coef="1"/></fixed></tendon>
  <actuator>
    <motor joint="hip"/>
    <velocity joint="hip" kv="1"/>
    <motor name="hip_2" joint="hip"/>
    <motor tendon="cord"/>
    <motor site="tip"/>
    <adhesion body="arm" ctrlrange="0 1"/>
  </actuator>
  <sensor>
    <gyro site="tip"/>
    <gyro site="tip"/>
    <clock/>
    <jointpos name="joint_angles" joint="hip"/>
    <actuatorfrc name="camera0" actuator="hip_2"/>
  </sensor>
  <keyframe><key name="home" qpos="0.1 0.2 0.3"/></keyframe>
</mujoco>
"""


@pytest.fixture
def unnamed(tmp_path: Path) -> Path:
    file = tmp_path / "unnamed.xml"
    file.write_text(UNNAMED)
    return file


@pytest.mark.parametrize("name", sorted(file.stem for file in ASSETS.glob("*.xml")))
def test_a_robot_of_gymnasium_has_a_motor_for_each_actuator(name: str):
    file = ASSETS / f"{name}.xml"
    model = mujoco.MjModel.from_xml_path(str(file))
    world = MuJoCo(file)
    assert len(world.motors) == model.nu and len(set(world.sensors)) == 2 + model.ncam
    assert all(world.motors) and all(world.sensors)
    for number, motor in enumerate(world.motors):
        world.reset(0)
        world.act({motor: np.array([0.5])}, 0.0)
        assert np.flatnonzero(world._copies[0].ctrl).tolist() == [number]


def test_robots_of_gymnasium_have_the_names_of_their_joints():
    assert list(MuJoCo(ASSETS / "hopper.xml").motors) == ["thigh_joint", "leg_joint", "foot_joint"]
    assert list(MuJoCo(ASSETS / "humanoid.xml").sensors)[2:] == ["track", "camera1"]


def test_objects_without_a_name_have_that_of_what_they_move_or_measure(unnamed: Path):
    world = MuJoCo(unnamed)
    assert list(world.motors) == [
        *("hip", "hip_3", "hip_2", "cord", "tip", "arm"),
        *("hand", "body2", "hand_orientation", "body2_orientation"),
    ]
    assert list(world.sensors) == [
        *("joint_angles", "joint_velocities", "camera0_2"),
        *("tip_gyro", "tip_gyro_2", "clock", "joint_angles_2", "camera0"),
    ]
    assert world.sensors["tip_gyro"].shape == (3,) and world.sensors["clock"].shape == ()


def test_actuators_and_sensors_of_two_objects_do_what_their_names_say(unnamed: Path):
    world = MuJoCo(unnamed)
    world.reset(0)
    world.act({"hip_2": np.array([0.25]), "cord": np.array([0.5])}, 0.0)
    assert world._copies[0].ctrl.tolist() == [0, 0, 0.25, 0.5, 0, 0]
    assert world.sense("camera0", (), 0.0)[0] == pytest.approx(0.25)
    assert world.sense("joint_angles_2", (), 0.0)[0] == world.sense("joint_angles", (), 0.0)[0][0]
    assert world.sense("clock", (), 0.0)[0] == pytest.approx(0.009)


def test_joints_without_a_name_start_at_the_keyframe_and_stay_when_an_object_is_placed(unnamed: Path):
    world = MuJoCo(unnamed)
    world.reset(0)
    np.testing.assert_allclose(world.sense("joint_angles", (), 0.0)[0], [0.1, 0.2, 0.3])
    for k in range(5):
        world.act({"hip": np.array([3.0]), "body2": np.array([[1.0, 2.0, 3.0]])}, 9.0 * k)
    angles = world.sense("joint_angles", (), 0.0)
    assert np.abs(angles - [0.1, 0.2, 0.3]).max() > 1e-3
    world.place("block", (2.0, 0.4), (0.05, 0.05))
    np.testing.assert_allclose(world.sense("joint_angles", (), 0.0), angles)
    np.testing.assert_allclose(world._copies[0].body("body2").xpos, [1, 2, 3])


def test_a_robot_that_is_attached_keeps_its_start_where_the_scene_too_has_joints_without_a_name(tmp_path):
    joints = '<joint axis="0 1 0"/><joint axis="0 0 1"/><geom size="0.1"/>'
    scene, robot = tmp_path / "scene.xml", tmp_path / "robot.xml"
    scene.write_text(
        f'<mujoco><worldbody><body>{joints}</body><body pos="3 0 0"><site name="robot"/></body>'
        "</worldbody></mujoco>"
    )
    robot.write_text(
        f"<mujoco><worldbody><body>{joints}</body></worldbody>"
        '<keyframe><key name="home" qpos="0.5 0.6"/></keyframe></mujoco>'
    )
    world = MuJoCo(scene, robot)
    np.testing.assert_allclose(world.sense("joint_angles", (), 0.0)[0], [0, 0, 0.5, 0.6])


def test_a_mocap_body_follows_its_motors_and_is_part_of_the_state(unnamed: Path):
    world = MuJoCo(unnamed)
    assert str(world.motors["hand"]) == "position of the mocap body: x, y and z; 3 m"
    world.reset(0, [0, 1])
    turned = np.array([[0.0, 0.0, 0.0, 1.0]] * 2)
    world.act({"hand": np.array([[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]), "hand_orientation": turned}, 0.0)
    state = world.keep()
    for copy, place in zip(world._copies, ([1, 2, 3], [4, 5, 6]), strict=True):
        np.testing.assert_allclose(copy.body("hand").xpos, place)
        np.testing.assert_allclose(copy.body("hand").xquat, turned[0])
        np.testing.assert_allclose(copy.body("body2").xpos, [0, 1, 1])
    world.reset(0, [0, 1])
    np.testing.assert_allclose(world._copies[1].body("hand").xpos, [0, 0, 1])
    world.put(state)
    np.testing.assert_allclose(world._copies[1].body("hand").xpos, [4, 5, 6])


def test_a_state_stored_before_mocap_bodies_were_part_of_it_is_read(tmp_path: Path):
    file = tmp_path / "slide.xml"
    file.write_text(
        '<mujoco><worldbody><body><joint type="slide"/><geom size="0.1"/></body></worldbody></mujoco>'
    )
    world = MuJoCo(file)
    world.reset(0, [0, 1])
    earlier = {
        "tick": np.asarray(3),
        "time": np.array([0.03, 0.03]),
        "qpos": np.array([[0.1], [0.2]]),
        "qvel": np.array([[1.0], [2.0]]),
        "act": np.zeros((2, 0)),
        "warmstart": np.array([[0.0], [0.0]]),
        "pushes": np.zeros((2, 2, 6)),
        "frames": np.array([[0.0], [0.1]]),
    }
    world.put(stored.filled(world.keep(), stored.leaves(earlier, "the world"), "the world"))
    np.testing.assert_array_equal(world.sense("joint_angles", (), 0.0), earlier["qpos"])
    np.testing.assert_array_equal(world.keep()["frames"], earlier["frames"])


def test_a_camera_sees_mocap_bodies_move_with_its_pictures(tmp_path: Path):
    file = tmp_path / "ball.xml"
    geom = 'contype="0" conaffinity="0"'
    file.write_text(
        '<mujoco><worldbody><camera name="eye" pos="0 -2 0.2" xyaxes="1 0 0 0 0 1"/>'
        f'<body name="ball" mocap="true" pos="-0.6 0 0.2"><geom size="0.2" rgba="1 0 0 1" {geom}/></body>'
        f'<body name="bar" mocap="true" pos="0 0 0.2"><geom type="box" size="0.05 0.05 0.4" {geom}/></body>'
        "</worldbody></mujoco>"
    )
    world = MuJoCo(file, cameras=dd.MuJoCoCameras(camera_every=2))
    axes = (dd.Axis("x", 0, 31, 32), dd.Axis("y", 0, 23, 24), dd.Axis("channel", 0, 2, 3))
    world.reset(0, [0, 1])
    first = world.sense("eye", axes, 0.0)
    np.testing.assert_array_equal(first[0], first[1])
    lying = np.array([[0.5**0.5, 0.0, 0.5**0.5, 0.0], [1.0, 0.0, 0.0, 0.0]])
    command = {"ball": np.array([[-0.6, 0.0, 0.2], [0.6, 0.0, 0.2]]), "bar_orientation": lying}
    world.act(command, 0.0)
    np.testing.assert_array_equal(world.sense("eye", axes, 0.0), first)
    between = world.keep()
    world.act(command, 0.0)
    later = world.sense("eye", axes, 0.0)
    red = (later[..., 0] - later[..., 1] > 0.3).sum(axis=2)
    assert red[0, :12].any() and not red[0, 20:].any() and red[1, 20:].any() and not red[1, :12].any()
    assert np.abs(later[0] - first[0]).max() > 0.05, "the bar lies"
    world.put(between)
    np.testing.assert_array_equal(world.sense("eye", axes, 0.0), first)


def test_an_actuator_with_several_commands_is_one_motor(tmp_path: Path):
    file = tmp_path / "ball.xml"
    file.write_text(
        '<mujoco><worldbody><body><joint name="ball" type="ball"/><geom size="0.1"/></body></worldbody>'
        '<actuator><general name="turn" joint="ball" gaintype="so3" biastype="so3" gainprm="5"'
        ' biasprm="0 -5 0" input="expmap"/><motor joint="ball" gear="1 0 0"/></actuator></mujoco>'
    )
    world = MuJoCo(file)
    assert {name: signal.shape for name, signal in world.motors.items()} == {"turn": (3,), "ball": ()}
    world.act({"turn": np.array([[0.1, 0.2, 0.3]]), "ball": np.array([0.4])}, 0.0)
    assert world._copies[0].ctrl.tolist() == [0.1, 0.2, 0.3, 0.4]


@pytest.mark.parametrize(
    ("timestep", "period"), [(0.002, 10.0), (0.01, 10.0), (0.003, 9.0), (0.02, 20.0), (0.0001, 10.0)]
)
def test_the_period_is_the_longest_multiple_of_the_time_step_up_to_10_ms(tmp_path, timestep, period):
    file = tmp_path / "steps.xml"
    file.write_text(UNNAMED.replace("0.003", str(timestep)))
    assert MuJoCo(file).period == period
    assert MuJoCo(file, period=1000 * timestep).period == pytest.approx(1000 * timestep)


def test_a_record_states_the_period_that_the_scene_gave(unnamed: Path):
    described = MuJoCo(unnamed).describe()
    assert described["settings"]["period"] == 9.0
    assert MuJoCo.again(described).period == 9.0
    assert MuJoCo.open(f"{unnamed}, period=3").period == 3.0


URDF = """
<robot name="r">
  <link name="base"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/>
  </inertial></link>
  <link name="arm"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/>
  </inertial></link>
  <joint name="hip" type="revolute"><parent link="base"/><child link="arm"/><axis xyz="0 0 1"/>
    <limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
</robot>
"""


def test_a_urdf_says_that_it_states_no_motors(tmp_path: Path):
    file = tmp_path / "arm.urdf"
    file.write_text(URDF)
    says = r"arm\.urdf: is a URDF file, which states no motors and no sensors.*<actuator>"
    with pytest.warns(RunWarning, match=says):
        world = MuJoCo(file)
    assert list(world.sensors) == ["joint_angles", "joint_velocities"] and not world.motors
    model = dd.Model("m")
    model.add(dd.Motor("move", [], "hip"))
    with pytest.raises(WorldError, match=r"(?s)has no motor 'hip'.*is a URDF file.*<actuator>"):
        dd.Session(model, world=world)
    # the way that the message names
    converted = tmp_path / "arm.xml"
    spec = mujoco.MjSpec.from_file(str(file))
    spec.compile()
    spec.to_file(str(converted))
    converted.write_text(
        converted.read_text().replace("</mujoco>", '<actuator><motor joint="hip"/></actuator></mujoco>')
    )
    assert list(MuJoCo(converted).motors) == ["hip"]


@pytest.mark.parametrize("encoding", ["GB2312", "Shift_JIS", "x-own"])
def test_a_scene_may_state_any_encoding_of_its_xml(encoding: str, tmp_path: Path):
    file = tmp_path / "scene.xml"
    file.write_text(f'<?xml version="1.0" encoding="{encoding}"?>{UNNAMED}'.replace("?>\n", "?>"))
    robot = tmp_path / "robot.xml"
    robot.write_text(f'<?xml version="1.0" encoding="{encoding}"?><mujoco/>')
    assert "hand" in MuJoCo(file).motors
    assert MuJoCo("table", robot).arm is None
