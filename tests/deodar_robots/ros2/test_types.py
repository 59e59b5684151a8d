"""The numbers of each type of message; the messages are bytes that the test writes by itself."""

from __future__ import annotations

import io
import math
import struct

import numpy as np
import pytest
from PIL import Image

import deodar as dd
from deodar.errors import WorldError
from deodar_robots.ros2 import example_node
from deodar_robots.ros2.message_types import Unreadable, from_bytes, to_bytes
from deodar_robots.ros2.motor_types import commands
from deodar_robots.ros2.sensor_types import SENSOR_TYPES, readings
from deodar_robots.ros2.topic_inbox import TopicInbox
from tests.deodar_robots.ros2.fake import Cdr, distance, scan

COLOURS = np.arange(24, dtype=np.uint8).reshape(2, 4, 3) * 10
GRID = [dd.Axis("x", 0, 3, 4), dd.Axis("y", 0, 1, 2), dd.Axis("channel", 0, 2, 3)]


def read(raw: bytes, type: str, **settings) -> np.ndarray:
    """Return what a sensor takes of a message."""
    ((_, name, reading),) = readings({"a": {"topic": "/a", "type": type, **settings}}).values()
    return reading.read(from_bytes(raw, name))


def picture(content: bytes, encoding: str, step: int, width: int = 4, height: int = 2, big: int = 0) -> bytes:
    cdr = Cdr().header().number("I", height, width).text(encoding).number("B", big)
    cdr.number("I", step, len(content)).raw.extend(content)
    return bytes(cdr.raw)


def joints(names=("pan", "tilt"), positions=(0.1, -0.2), velocities=(), efforts=()) -> bytes:
    cdr = Cdr().header().number("I", len(names))
    for name in names:
        cdr.text(name)
    for values in (positions, velocities, efforts):
        cdr.number("I", len(values)).number("d", *values)
    return bytes(cdr.raw)


def turned(yaw: float) -> tuple[float, ...]:
    return (0.0, 0.0, math.sin(yaw / 2), math.cos(yaw / 2))


def odometry(orientation) -> bytes:
    cdr = Cdr().header().text("base").number("d", 1.0, 2.0, 3.0, *orientation).number("d", *[0] * 36)
    return bytes(cdr.number("d", 0.5, 0, 0, 0, 0, -0.25).number("d", *[0] * 36).raw)


def inertia() -> bytes:
    cdr = Cdr().header().number("d", *turned(math.pi / 2)).number("d", *[0] * 9)
    return bytes(cdr.number("d", 1, 2, 3).number("d", *[0] * 9).number("d", 4, 5, 9.8, *[0] * 9).raw)


def array(code: str, values, *sizes: int) -> bytes:
    cdr = Cdr().number("I", len(sizes))
    for k, size in enumerate(sizes):
        cdr.text("axis").number("I", size, math.prod(sizes[k:]))
    return bytes(cdr.number("I", 0, len(values)).number(code, *values).raw)


# --------------------------------------------------------------------------------------------------- pictures


@pytest.mark.parametrize(
    ("encoding", "pixels"),
    [
        ("rgb8", COLOURS),
        ("bgr8", COLOURS[:, :, ::-1]),
        ("rgba8", np.dstack([COLOURS, np.full((2, 4), 7, np.uint8)])),
        ("bgra8", np.dstack([COLOURS[:, :, ::-1], np.full((2, 4), 7, np.uint8)])),
    ],
)
def test_colours_of_an_image_are_those_of_its_pixels(encoding, pixels):
    rows = b"".join(row.tobytes() + b"\xff\xfe\xfd" for row in pixels)  # a step longer than a row
    raw = picture(rows, encoding, step=pixels[0].nbytes + 3)
    assert np.array_equal(read(raw, "sensor_msgs/Image"), COLOURS)
    ((_, _, reading),) = readings({"a": {"topic": "/a", "type": "sensor_msgs/Image"}}).values()
    assert reading.signal.shape is None
    seen = reading.sampled(COLOURS, tuple(GRID), "a")
    np.testing.assert_allclose(seen, COLOURS.transpose(1, 0, 2) / 255, atol=1e-6)


def test_a_grey_image_has_three_equal_colours():
    grey = COLOURS[:, :, 0]
    assert np.array_equal(
        read(picture(grey.tobytes(), "mono8", 4), "sensor_msgs/Image"), np.dstack([grey] * 3)
    )


@pytest.mark.parametrize("kind", ["PNG", "JPEG"])
def test_a_compressed_image_is_decoded(kind):
    whole = np.full((16, 16, 3), (200, 100, 50), np.uint8)
    file = io.BytesIO()
    Image.fromarray(whole).save(file, kind)
    cdr = Cdr().header().text(kind.lower()).number("I", len(file.getvalue()))
    raw = bytes(cdr.raw) + file.getvalue()
    assert np.abs(read(raw, "sensor_msgs/CompressedImage").astype(int) - whole).max() < 6
    with pytest.raises(Unreadable, match="no JPEG or PNG file"):
        read(bytes(cdr.raw) + bytes(len(file.getvalue())), "sensor_msgs/CompressedImage")


def test_depths_are_in_metres_over_columns_and_rows():
    depths = np.array([[1, 2, 3, 4], [5, 6, 7, 8]], np.float32)
    settings = {"type": "sensor_msgs/Image", "fields": "depth"}
    whole = read(picture(depths.tobytes(), "32FC1", 16), shape=[4, 2], **settings)
    assert np.array_equal(whole, depths.T)
    mean = read(picture(depths.tobytes(), "32FC1", 16), shape=[2, 1], **settings)
    assert mean.tolist() == [[3.5], [5.5]]
    for big, order in ((0, "<u2"), (1, ">u2")):
        raw = picture((depths * 1000).astype(order).tobytes(), "16UC1", 8, big=big)
        np.testing.assert_allclose(read(raw, shape=[4, 2], **settings), depths.T, rtol=1e-6)


def test_a_depth_that_is_not_defined_is_refused_or_replaced():
    raw = picture(np.array([1, np.nan, 0, 4] * 2, np.float32).tobytes(), "32FC1", 16)
    settings = {"type": "sensor_msgs/Image", "fields": "depth", "shape": [4, 2]}
    with pytest.raises(Unreadable, match="4 of its depths are undefined"):
        read(raw, **settings)
    assert read(raw, undefined=9, **settings)[:, 0].tolist() == [1, 9, 9, 4]


@pytest.mark.parametrize(
    ("raw", "message"),
    [
        (picture(bytes(24), "yuv422", 12), "its encoding is 'yuv422'"),
        (picture(bytes(23), "rgb8", 12), "it has 23 bytes, not 2 rows of 12"),
        (picture(bytes(22), "rgb8", 11), "rows of 11 bytes"),
        (picture(b"", "rgb8", 0, 0, 0), "it has 0 x 0 pixels"),
        (picture(bytes(24), "rgb8", 2**31, 2**30, 2**30), "pixels in rows of"),
        (picture(bytes(32), "32FC1", 16), "The field colour has the encodings"),
    ],
)
def test_a_strange_image_is_refused(raw, message):
    with pytest.raises(Unreadable) as caught:
        read(raw, "sensor_msgs/Image")
    assert message in f"{caught.value} {caught.value.fix}"


# ----------------------------------------------------------------------------------------------------- states


def test_joints_are_read_by_name():
    raw = joints(velocities=(1.0, 2.0), efforts=(3.0, 4.0))
    settings = {"type": "sensor_msgs/JointState", "joints": ["tilt", "pan"]}
    np.testing.assert_allclose(read(raw, **settings), [-0.2, 0.1])
    assert read(raw, fields="velocity", **settings).tolist() == [2, 1]
    assert read(raw, fields="effort", **settings).tolist() == [4, 3]
    assert np.allclose(read(raw, "sensor_msgs/JointState", shape=[2]), [0.1, -0.2])


@pytest.mark.parametrize(
    ("raw", "settings", "message"),
    [
        (joints(), {"joints": ["pan", "roll"]}, "it has no joint 'roll'"),
        (joints(), {"joints": ["pan"], "fields": "velocity"}, "it has 2 joints and 0 of velocity"),
        (joints(), {"shape": [3]}, "it has 2 of position, not 3"),
        (joints(positions=(0.0, float("nan"))), {"shape": [2]}, "its position is not finite"),
    ],
)
def test_joints_that_are_missing_are_named(raw, settings, message):
    with pytest.raises(Unreadable, match=message):
        read(raw, "sensor_msgs/JointState", **settings)


def test_odometry_is_the_pose_in_the_plane_or_chosen_fields():
    raw = odometry(turned(0.7))
    np.testing.assert_allclose(read(raw, "nav_msgs/Odometry"), [1, 2, 0.7], rtol=1e-6)
    assert read(raw, "nav_msgs/Odometry", fields="z") == 3
    assert read(raw, "nav_msgs/Odometry", fields=["linear.x", "angular.z"]).tolist() == [0.5, -0.25]
    with pytest.raises(Unreadable, match="its orientation has the length 0, not 1"):
        read(odometry((0, 0, 0, 0)), "nav_msgs/Odometry")


def test_the_example_node_is_at_rest():
    fields = ["x", "y", "z", "yaw", *(f"{of}.{axis}" for of in ("linear", "angular") for axis in "xyz")]
    raw = example_node.odometry(0.5, -0.25)
    assert read(raw, "nav_msgs/Odometry", fields=fields).tolist() == [0.5, -0.25, *[0] * 8]


def test_angles_are_those_of_rotations_about_fixed_axes():
    roll, pitch, yaw = 0.3, -0.5, 1.1
    q = np.array([1.0, 0, 0, 0])  # w, x, y, z
    for axis, angle in ((1, roll), (2, pitch), (3, yaw)):
        r = np.zeros(4)
        r[0], r[axis] = math.cos(angle / 2), math.sin(angle / 2)
        q = np.array([r[0] * q[0] - r[1:] @ q[1:], *(r[0] * q[1:] + q[0] * r[1:] + np.cross(r[1:], q[1:]))])
    raw = odometry((*q[1:], q[0]))
    np.testing.assert_allclose(
        read(raw, "nav_msgs/Odometry", fields=["roll", "pitch", "yaw"]), [roll, pitch, yaw], rtol=1e-5
    )


def test_an_imu_is_angular_velocity_then_acceleration():
    assert np.allclose(read(inertia(), "sensor_msgs/Imu"), [1, 2, 3, 4, 5, 9.8])
    assert np.isclose(read(inertia(), "sensor_msgs/Imu", fields="yaw"), math.pi / 2)


def test_arrays_are_in_c_order():
    wide = read(array("d", [1 / 3, 2], 2), "std_msgs/Float64MultiArray", shape=[2])
    assert wide.dtype == np.float64 and wide.tolist() == [1 / 3, 2]
    flat = array("f", [1, 2, 3, 4, 5, 6], 2, 3)
    assert read(flat, "std_msgs/Float32MultiArray", shape=[2, 3]).tolist() == [[1, 2, 3], [4, 5, 6]]
    with pytest.raises(Unreadable, match="it has 6 numbers, not 4"):
        read(flat, "std_msgs/Float32MultiArray", shape=[2, 2])
    with pytest.raises(Unreadable, match="its numbers are not finite"):
        read(array("f", [math.inf]), "std_msgs/Float32MultiArray", shape=[1])


@pytest.mark.parametrize(
    ("entry", "message"),
    [
        ({"type": "sensor_msgs/Image", "fields": "depth"}, "needs its shape"),
        ({"type": "sensor_msgs/Image", "shape": [4, 2]}, "colours have no shape"),
        ({"type": "sensor_msgs/Image", "fields": "color"}, "there is no field 'color'.*colour"),
        ({"type": "sensor_msgs/JointState"}, "needs its shape"),
        ({"type": "sensor_msgs/JointState", "joints": ["a", "a"]}, "names no joint, or one twice"),
        (
            {"type": "sensor_msgs/JointState", "joints": ["a"], "shape": [2]},
            "is not the number of its 1 joints",
        ),
        ({"type": "nav_msgs/Odometry", "fields": []}, "names no field, or one twice"),
        ({"type": "nav_msgs/Odometry", "fields": ["w"]}, "there is no field 'w'"),
        ({"type": "nav_msgs/Path"}, "the type 'nav_msgs/Path' is not read or written"),
    ],
)
def test_settings_of_sensors_are_checked(entry, message):
    with pytest.raises(WorldError, match=message):
        readings({"a": {"topic": "/a", **entry}})


def test_no_damaged_message_is_read():
    """Bytes are changed or cut at random: readings stay finite, and nothing is raised."""
    raws = {
        "sensor_msgs/msg/LaserScan": (scan([1, 2, 3, 4]), {"shape": [4]}),
        "sensor_msgs/msg/Range": (distance(1.0), {}),
        "sensor_msgs/msg/Image": (picture(COLOURS.tobytes(), "rgb8", 12), {}),
        "sensor_msgs/msg/JointState": (joints(), {"shape": [2]}),
        "nav_msgs/msg/Odometry": (odometry(turned(0.7)), {}),
        "sensor_msgs/msg/Imu": (inertia(), {}),
        "sensor_msgs/msg/CompressedImage": (bytes(Cdr().header().text("png").number("I", 0).raw), {}),
        "std_msgs/msg/Float32MultiArray": (array("f", [1, 2, 3, 4, 5, 6], 2, 3), {"shape": [2, 3]}),
        "std_msgs/msg/Float64MultiArray": (array("d", [1, 2]), {"shape": [2]}),
    }
    assert set(raws) == set(SENSOR_TYPES)
    random = np.random.default_rng(1)
    for name, (raw, settings) in raws.items():
        sensors = readings({"a": {"topic": "/a", "type": name, **settings}})
        inbox = TopicInbox(sensors, {name: "hash"})
        package, _, short = name.split("/")
        key = f"0/a/{package}::msg::dds_::{short}_/hash"
        for k in range(300):
            changed = bytearray(raw)
            for at in random.integers(0, len(raw), random.integers(1, 4)):
                changed[at] = random.choice([0, 1, 127, 128, 255, random.integers(256)])
            cut = bytes(changed[: random.integers(len(raw))]) if k % 3 == 0 else bytes(changed)
            inbox.offer("/a", key, cut, struct.pack("<qqB16s", k + 1, 0, 16, bytes(16)))
            found = inbox.reading("a")
            assert found is None or np.isfinite(found[0]).all()
        assert sum(inbox.counts.values()) == 300 and inbox.counts["refused"] > 50


# ----------------------------------------------------------------------------------------------------- motors


def sent(entry, *values) -> bytes:
    """Return the bytes of a command."""
    ((_, _, motor),) = commands({"a": {"topic": "/a", **entry}}, 50.0).values()
    return to_bytes(motor.message([(motor, np.array(values))]))


def test_a_twist_has_its_numbers_in_their_places():
    raw = sent({"type": "geometry_msgs/Twist"}, 0.5, -1.0)
    assert raw == b"\0\1\0\0" + struct.pack("<6d", 0.5, 0, 0, 0, 0, -1.0)
    raw = sent({"type": "geometry_msgs/Twist", "fields": ["linear.y", "angular.x"]}, 3, 4)
    assert raw[4:] == struct.pack("<6d", 0, 3, 0, 4, 0, 0)


def test_a_twist_with_its_time():
    raw = sent({"type": "geometry_msgs/TwistStamped"}, 0.5, -1.0)
    seconds, nanoseconds, length = struct.unpack("<iII", raw[4:16])
    assert seconds > 1.7e9 and nanoseconds < 1e9 and length == 1
    assert raw[-48:] == struct.pack("<6d", 0.5, 0, 0, 0, 0, -1.0)


def test_an_array_of_numbers():
    raw = sent({"type": "std_msgs/Float64MultiArray", "shape": [2], "rest": 0}, 1.5, 2.5)
    # no dimensions, offset 0, two numbers; then the numbers at a multiple of eight
    assert raw == b"\0\1\0\0" + struct.pack("<III4x2d", 0, 0, 2, 1.5, 2.5)


@pytest.mark.parametrize("field", ["positions", "velocities"])
def test_a_trajectory_is_one_point(field):
    entry = {"type": "trajectory_msgs/JointTrajectory", "joints": ["ab", "cd"], "fields": field}
    cdr = Cdr().number("i", 0).number("I", 0).text("").number("I", 2).text("ab").text("cd").number("I", 1)
    for each in ("positions", "velocities", "accelerations", "effort"):
        cdr.number("I", 2 if each == field else 0)
        if each == field:
            cdr.number("d", 0.1, 0.2)
    cdr.number("i", 0).number("I", 100_000_000)
    assert sent(entry, 0.1, 0.2) == bytes(cdr.raw)


def test_positions_have_no_command_at_rest_unless_one_is_stated():
    arm = {"topic": "/arm", "type": "trajectory_msgs/JointTrajectory", "joints": ["a"], "limits": [1, 2]}
    found = commands(
        {
            "arm": arm,
            "speed": {**arm, "topic": "/b", "fields": "velocities", "limits": [-1, 1]},
            "home": {**arm, "topic": "/c", "rest": 1.5},
        },
        50.0,
    )
    assert [motor.rests for _, _, motor in found.values()] == [False, True, True]
    assert found["home"][2].rule.rest == 1.5
