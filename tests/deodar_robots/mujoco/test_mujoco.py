"""A scene with physics: names of its file, objects, cameras, state, records, and what is refused."""

from __future__ import annotations

import base64
import subprocess
import sys
from contextlib import closing
from pathlib import Path

import jax.numpy as jnp
import numpy as np
import pytest

import deodar as dd
from deodar.errors import MissingExtra, UnknownName, WorldError
from deodar.numerics import homography
from deodar.numerics.axes import Axis
from deodar.worlds._scene import SceneBody
from deodar_robots.mujoco.mujoco import MuJoCo
from deodar_studio.world.embodiment import Embodiment

FINE = Axis("column", 0, 159, 160), Axis("row", 0, 119, 120), Axis("channel", 0, 2, 3)

CART = """
<mujoco>
  <option timestep="0.002"/>
  <worldbody>
    <camera name="eye" pos="0 -2 0.5" xyaxes="1 0 0 0 0 1"/>
    <body name="cart" pos="0 0 0.1">
      <joint name="rail" type="slide" axis="1 0 0"/>
      <geom type="box" size="0.1 0.1 0.1" rgba="1 0 0 1" mass="2"/>
      <site name="middle"/>
    </body>
  </worldbody>
  <actuator><motor name="push" joint="rail" gear="1" ctrlrange="-5 5"/></actuator>
  <sensor>
    <jointpos name="where" joint="rail"/>
    <framepos name="place" objtype="site" objname="middle"/>
  </sensor>
</mujoco>
"""


@pytest.fixture
def cart(tmp_path: Path) -> Path:
    file = tmp_path / "cart.xml"
    file.write_text(CART)
    return file


def seen(world: MuJoCo, axes=FINE, sensor: str = "camera") -> np.ndarray:
    return world.sense(sensor, axes, 0.0)[0]


def test_sensors_cameras_and_actuators_of_a_file_have_their_names(cart: Path):
    world = MuJoCo(cart)
    assert set(world.sensors) == {"where", "place", "joint_angles", "joint_velocities", "eye"}
    assert set(world.motors) == {"push"} and world.motors["push"].bounds == ((-5.0, 5.0),)
    assert world.sensors["where"].shape == () and world.sensors["place"].shape == (3,)
    world.reset(0)
    for _ in range(100):
        world.act({"push": np.array([4.0])}, 0.0)
    # 2 m/s2 for 1 s; the Euler step of MuJoCo advances the velocity first
    assert world.sense("where", (), 0.0)[0] == pytest.approx(0.5 * 2.0 * 1.0**2, rel=0.01)
    np.testing.assert_allclose(world.sense("place", (), 0.0)[0], [1.0, 0.0, 0.1], rtol=0.01)
    assert world.sense("joint_velocities", (), 0.0)[0] == pytest.approx([2.0], rel=1e-3)


def test_a_model_drives_an_actuator_and_reads_a_sensor_of_the_file(cart: Path):
    model = dd.Model("cart")
    model.add(dd.Boost("force", [], 4.0)) >> model.add(dd.Motor("push", [], "push"))
    model.add(dd.Sensor("where", [], "where"))
    record = dd.simulate(model, 1000, dt=10, record="where", world=dd.MuJoCo(cart))
    np.testing.assert_allclose(record["where.output"].values[-1], 1.0, rtol=0.03)


def test_a_camera_shows_colours_at_the_places_where_objects_are():
    world = MuJoCo("table")
    world.reset(0)
    plain = seen(world)
    world.place("red", (0.2, 0.3), (0.1, 0.1), (0.9, 0.1, 0.1))
    mask = seen(world)[..., 0] - seen(world)[..., 1] > 0.3
    columns, rows = np.nonzero(mask)
    assert 50 < mask.sum() < 1000 and columns.mean() < 80, "the camera is opposite: its left is x > 0"
    world.move("red", (-0.2, 0.5))
    moved = np.nonzero(seen(world)[..., 0] - seen(world)[..., 1] > 0.3)
    assert moved[0].mean() > 80 and moved[1].mean() > rows.mean()
    world.remove("red")
    np.testing.assert_array_equal(seen(world), plain)
    dark = MuJoCo("table", cameras=dd.MuJoCoCameras(light=0.5))
    np.testing.assert_allclose(seen(dark), plain / 2, atol=1e-6)


def test_a_table_point_is_where_the_homography_of_the_camera_has_it():
    """Four points determine the picture of all others: the camera is a pinhole, without distortion."""

    def place(x: float, y: float) -> tuple[float, float]:
        world = MuJoCo("table")
        world.place("dot", (x, y), (0.04, 0.04), (1, 0, 0), height=0.001)
        picture = seen(world, (Axis("column", 0, 639, 640), Axis("row", 0, 479, 480), FINE[2]))
        columns, rows = np.nonzero(picture[..., 0] - picture[..., 1] > 0.3)
        return columns.mean(), rows.mean()

    corners = [(-0.35, 0.15), (0.35, 0.15), (0.35, 0.55), (-0.35, 0.55)]
    matrix = homography.homography(jnp.array(corners), jnp.array([place(*c) for c in corners]))
    for point in ((0.2, 0.3), (-0.1, 0.5)):
        expected = np.asarray(homography.mapped(matrix, jnp.array([point])))[0]
        np.testing.assert_allclose(expected, place(*point), atol=1.0)


def test_pixel_noise_and_tool_noise_depend_on_seed_and_trial_alone():
    world = MuJoCo("table", tool_noise=0.01, cameras=dd.MuJoCoCameras(pixel_noise=0.05))

    def read(seed: int, trials: list[int]) -> list[np.ndarray]:
        world.reset(seed, trials)
        return [world.sense("camera", FINE, 0.0), world.sense("tool", (), 0.0)]

    reading, alone = read(1, [0, 5]), read(1, [5])
    for many, one in zip(reading, alone, strict=True):
        np.testing.assert_array_equal(many[1], one[0])
        assert np.abs(many[0] - many[1]).max() > 0.005
    assert np.std(read(1, [0])[0] - MuJoCo("table").sense("camera", FINE, 0.0)) == pytest.approx(
        0.05, rel=0.1
    )


def test_a_picture_is_kept_for_its_period():
    world = MuJoCo("table", cameras=dd.MuJoCoCameras(3, pixel_noise=0.05))
    world.reset(0)
    first = seen(world)
    for k in range(1, 7):
        world.act({"tool_plane": np.array([[0.2, 0.0]])}, 0.0)
        assert np.array_equal(seen(world), first) == (k % 3 != 0)
        if k % 3 == 0:
            first = seen(world)
    assert world.sensors["camera"].period == 30.0


def test_the_arm_pushes_an_object_and_a_reset_puts_it_back():
    world = MuJoCo("table")
    world.place("block", (0.0, 0.25), (0.05, 0.05), (0, 0.8, 0), height=0.08, shape="box")
    world.reset(0)
    for _ in range(150):
        world.act({"tool_plane": np.array([[0.0, 0.15]])}, 0.0)
    [block] = world.scene().boxes
    assert block.center[1] > 0.3, "the tool went through its place"
    world.reset(0)
    [block] = world.scene().boxes
    assert block.center == pytest.approx((0.0, 0.25), abs=1e-6)


def test_a_reset_keeps_an_object_where_it_was_moved():
    world = MuJoCo("table")
    world.place("block", (0.0, 0.25), (0.05, 0.05))
    world.move("block", (0.2, 0.4))
    world.reset(0)
    assert world.scene().boxes[0].center == pytest.approx((0.2, 0.4))


def test_a_scene_without_an_arm_shows_its_first_body_and_is_as_large_as_needed(cart: Path):
    world = MuJoCo(cart)
    world.reset(0)
    for _ in range(80):
        world.act({"push": np.array([4.0])}, 0.0)
    scene, x = world.scene(), float(world.sense("where", (), 0.0)[0])
    assert x > 0.5 and scene.bodies == (SceneBody("cart", (x, 0.0), 0.0, 0.05),)
    assert scene.border == (-0.5, -0.5, x, 0.5)


def test_placing_and_removing_keep_the_state_of_all_else():
    world = MuJoCo("table")
    world.place("a", (-0.2, 0.3), (0.06, 0.06))
    world.reset(0)
    for _ in range(60):
        world.act({"tool_plane": np.array([[0.1, 0.1]])}, 0.0)
    angles, tool = world.sense("joint_angles", (), 0.0), world.sense("tool", (), 0.0)
    arrangement = world.arrangement()
    world.place("b", (0.2, 0.3), (0.06, 0.06))
    world.remove("a")
    np.testing.assert_allclose(world.sense("joint_angles", (), 0.0), angles)
    np.testing.assert_allclose(world.sense("tool", (), 0.0), tool)
    world.arrange(arrangement)
    assert [box.name for box in world.scene().boxes] == ["a"]


def test_a_record_opens_the_same_scene_again(cart: Path):
    world = MuJoCo.example()
    again = MuJoCo.again(world.describe())
    assert again.describe() == world.describe()
    own = MuJoCo(cart).describe()
    cart.write_text(CART.replace('mass="2"', 'mass="3"'))
    with pytest.raises(WorldError, match="the scene or the robot has changed since"):
        MuJoCo.again(own)


def test_the_command_line_states_scene_robot_and_settings(cart: Path):
    world = MuJoCo.open("table, robot=four, camera_every=2, light=0.5")
    assert len(world.sense("joint_angles", (), 0.0)[0]) == 4
    assert (world.cameras.camera_every, world.cameras.light) == (2, 0.5)
    assert MuJoCo.open(str(cart)).arm is None and MuJoCo.names() == ["head", "table"]
    for argument, says in (
        ("table, robt=four", "there is no setting 'robt'.*robot"),
        ("table, light=much", "light is 'much'; expected a number"),
        ("table, robot=five", "there is no such robot.*four"),
        ("tabel", "there is no such scene.*table"),
    ):
        with pytest.raises(WorldError, match=says):
            MuJoCo.open(argument)


@pytest.mark.parametrize(
    "asset",
    [
        '<hfield name="large" nrow="100000" ncol="100000" size="1 1 1 1"/>',
        '<texture name="large" type="2d" builtin="flat" width="60000" height="60000"/>',
    ],
)
def test_a_small_file_that_states_a_huge_object_is_an_error(asset: str, tmp_path: Path):
    """MuJoCo does not ask whether 40 GB were there for the height field, and writes to them."""
    file = tmp_path / "large.xml"
    file.write_text(f"<mujoco><asset>{asset}</asset><worldbody/></mujoco>")
    with pytest.raises(WorldError, match=r"large\.xml: "):
        MuJoCo(file)
    assert MuJoCo("table").arm is not None
    with closing(Embodiment()) as embodiment, pytest.raises(WorldError, match=r"^large\.xml: "):
        embodiment.open_content("MuJoCo", file.name, base64.b64encode(file.read_bytes()).decode(), {})


def test_files_and_settings_with_errors_are_refused_by_name(tmp_path: Path, cart: Path):
    broken = tmp_path / "broken.xml"
    broken.write_text("<mujoco><worldbody><geom size='1'")
    with pytest.raises(WorldError, match=r"broken.xml: is not a valid MJCF file"):
        MuJoCo(broken)
    text = '<mujoco><worldbody><geom name="LATIN" size="1"/></worldbody></mujoco>'
    broken.write_bytes(text.encode().replace(b"LATIN", b"\xe5\xe5"))
    with pytest.raises(WorldError, match=r"broken.xml: has a name that is not UTF-8"):
        MuJoCo(broken)
    broken.write_text("<mujoco><option timestep='nan'/><worldbody><geom size='1'/></worldbody></mujoco>")
    with pytest.raises(WorldError, match=r"broken.xml: its time step is nan"):
        MuJoCo(broken)
    broken.write_text("<mujoco><worldbody><geom type='sphere' size='-1'/></worldbody></mujoco>")
    with pytest.raises(WorldError, match=r"broken.xml"):
        MuJoCo(broken)
    with pytest.raises(WorldError, match="has no site called 'robot'"):
        MuJoCo(cart, robot="four")
    with pytest.raises(WorldError, match=r"period 3 ms is not a multiple of the time step.*period=4"):
        MuJoCo(cart, period=3.0)
    with pytest.raises(WorldError, match="pixel_noise is -1"):
        MuJoCo(cart, cameras=dd.MuJoCoCameras(pixel_noise=-1.0))
    model = dd.Model("m")
    model.add(dd.Motor("go", [], "pusch"))
    with pytest.raises(WorldError, match=r"has no motor 'pusch'.*push"):
        dd.Session(model, world=MuJoCo(cart))
    model = dd.Model("m")
    model.add(dd.Sensor("eye", list(FINE), "ear"))
    with pytest.raises(WorldError, match=r"has no sensor 'ear'.*eye"):
        dd.Session(model, world=MuJoCo(cart))


def test_objects_with_errors_are_refused_and_change_nothing():
    world = MuJoCo("table")
    world.place("a", (0.0, 0.3), (0.06, 0.06))
    arrangement = world.arrangement()
    for given, says in (
        ({"size": (0, 0.1)}, "expected lengths above 0"),
        ({"color": (2, 0, 0)}, "expected red, green and blue"),
        ({"shape": "cone"}, "expected one of cylinder, box"),
        ({"center": (np.nan, 0)}, "expected two finite numbers"),
    ):
        with pytest.raises(WorldError, match=says):
            world.place("b", **{"center": (0.2, 0.3), "size": (0.06, 0.06), **given})
    with pytest.raises(WorldError, match="part of the scene"):
        world.place("table", (0.2, 0.3), (0.06, 0.06))
    with pytest.raises(UnknownName, match="nothing here is called 'c'"):
        world.move("c", (0.0, 0.0))
    with pytest.raises(WorldError, match="cannot be moved by hand"):
        world.move("table", (0.0, 0.0))
    assert world.arrangement() == arrangement


def test_a_simulation_that_diverges_stops_with_motors_at_0_and_a_reset_continues(tmp_path: Path):
    file = tmp_path / "stiff.xml"
    file.write_text(
        CART.replace("<motor", "<general biastype='affine' biasprm='0 1e9 0'").replace("gear", "gear")
    )
    world = MuJoCo(file)
    world.reset(0)
    with pytest.raises(WorldError, match=r"diverged at .* ms; all motors are at 0.*smaller timestep"):
        for k in range(200):
            world.act({"push": np.array([5.0])}, 10.0 * k)
    assert not world._copies[0].ctrl.any()
    world.reset(0)
    assert np.isfinite(world.sense("where", (), 0.0)).all()


def test_without_mujoco_the_error_names_the_extra(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setitem(sys.modules, "mujoco", None)
    with pytest.raises(MissingExtra, match=r"needs the package mujoco-core.*pip install 'deodar\[robots\]'"):
        MuJoCo("table")


def test_nothing_is_written_to_the_working_folder(tmp_path: Path):
    code = "import deodar as dd; dd.MuJoCo('table').reset(0)"
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, check=True
    )
    assert list(tmp_path.iterdir()) == [] and done.stdout == done.stderr == ""


MESH = """
<mujoco><asset><mesh name="wedge" vertex="0 0 0  0.1 0 0  0 0.1 0  0 0 0.1"/></asset><worldbody>
  <geom type="plane" size="0 0 1" pos="0 0 -0.2"/>
  <geom name="hidden" type="box" size="0.1 0.1 0.1" group="3"/>
  <geom name="glass" type="box" size="0.1 0.1 0.1" rgba="1 1 1 0"/>
  <body name="thing" pos="0 0 1" euler="0 0 90"><freejoint/><geom type="mesh" mesh="wedge"
    rgba="1 0 0 0.5"/></body>
</worldbody></mujoco>
"""


def test_solids_are_what_the_scene_shows_and_their_poses_follow_it(tmp_path: Path):
    file = tmp_path / "mesh.xml"
    file.write_text(MESH)
    world = MuJoCo(file)
    seen = world.scene()
    ground, thing = seen.solids
    assert (ground.shape, ground.pushable, ground.size[:2]) == ("plane", False, (0, 0))
    assert (thing.body, thing.shape, thing.pushable, thing.color) == ("thing", "mesh", True, (1, 0, 0, 0.5))
    assert len(thing.mesh.points) == 4 * 3 * 4 and len(thing.mesh.faces) == 4 * 3 * 4
    poses = np.frombuffer(seen.poses, np.float32).reshape(2, 12)
    data = world._copies[0]
    np.testing.assert_allclose(poses[1, :3], data.geom_xpos[3], atol=1e-6)
    np.testing.assert_allclose(poses[1, 3:], data.geom_xmat[3], atol=1e-6)
    world.act({}, 0.0)
    now = world.scene()
    assert now.solids is seen.solids and now.poses != seen.poses, "it falls"
    world.place("block", (0.3, 0.3), (0.1, 0.1))
    assert [s.thing for s in world.scene().solids] == ["", "", "block"]


def test_a_push_is_part_of_the_state_and_stays_when_an_object_is_placed():
    world = MuJoCo("table")

    def moved(n: int = 20) -> float:
        before = world.tool()
        for k in range(n):
            world.act({"tool_plane": np.zeros((1, 2))}, 10.0 * k)
        return float(np.hypot(*(np.subtract(world.tool(), before)[:2])))

    world.push("link 5", (60, 0, 0))
    arrangement = world.keep()
    pushed = moved()
    assert pushed > 0.005
    world.push("link 5", (0, 0, 0))
    world.put(arrangement)
    world.place("block", (0.3, 0.5), (0.05, 0.05))
    assert moved() == pytest.approx(pushed, rel=0.05)
    world.reset(0)
    assert moved() < 1e-4
