"""A robot that uses ROS 2 as a world, against a node that is written from the specification."""

from __future__ import annotations

import gc
import json
import re
import signal
import struct
import subprocess
import sys
import threading
import time
import weakref

import numpy as np
import psutil
import pytest

import deodar as dd
from deodar.errors import MissingExtra, WorldError
from deodar_robots.ros2 import message_types
from deodar_robots.ros2.motor_types import MOTOR_TYPES
from deodar_robots.ros2.ros2 import ROS2
from deodar_robots.ros2.sensor_types import SENSOR_TYPES
from tests.deodar_robots.ros2.fake import GID, HASHES, Cdr, distance, key, scan
from tests.house.source import ROOT

SCAN = {"topic": "/scan", "type": "sensor_msgs/LaserScan", "shape": [4]}
BEAMS = [dd.Axis("beam", 0, 3, 4)]
DRIVE = {
    "forward": {
        "topic": "/cmd_vel",
        "type": "geometry_msgs/Twist",
        "fields": "linear.x",
        "limits": [-0.3, 0.3],
    },
    "turn": {"topic": "/cmd_vel", "type": "geometry_msgs/Twist", "fields": "angular.z", "limits": [-1, 1]},
}


def begun(robot, sensors=None, motors=None, **settings) -> ROS2:
    world = ROS2(sensors or {}, motors or {}, robot.at, **{"period": 10.0, **settings})
    world.reset(0)
    return world


def wait_for(condition, seconds: float = 20.0) -> None:
    limit = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < limit
        time.sleep(0.01)


def seen(world: ROS2) -> np.ndarray:
    """Return the scan; a machine that other tests use may be late for a short patience."""
    limit = time.monotonic() + 20
    while True:
        try:
            return world.sense("scan", BEAMS, 0.0)
        except WorldError:
            if time.monotonic() > limit:
                raise


def driving() -> dd.Model:
    model = dd.Model("driving", dt=10)
    model.add(dd.Sensor("see", BEAMS, sensor="scan"))
    model.add(dd.Boost("go", amplitude=0.2)) >> model.add(dd.Motor("ahead", motor="forward"))
    model.add(dd.Boost("left", amplitude=5.0)) >> model.add(dd.Motor("round", motor="turn"))
    return model


def test_a_model_sees_a_scan_and_drives_within_its_limits(robot):
    world = ROS2({"scan": SCAN}, DRIVE, robot.at, period=10.0, patience=2.0)
    session = dd.Session(driving(), world=world)
    session.run_live(300)
    assert session.read("see").tolist() == [1, 2, 3, 4]
    robot.ranges = [4.0, 3.0, 2.0, 1.0]
    session.run_live(200)
    assert session.read("see").tolist() == [4, 3, 2, 1]
    wait_for(lambda: len(robot.commands) > 5)
    assert np.allclose(robot.commands[-1], [0.2, 0, 0, 0, 0, 1.0])
    world.close()
    assert robot.commands[-1] == (0,) * 6


def test_commands_have_the_key_and_the_attachment_of_rmw_zenoh(robot):
    world = begun(robot, motors=DRIVE)
    for _ in range(3):
        world.act({"forward": np.array([0.1])}, 0.0)
    wait_for(lambda: len(robot.heard) >= 3)
    numbers, publishers = [], set()
    for _, where, attached in robot.heard[:3]:
        assert where == key("/cmd_vel", "Twist")
        sequence, sent, length = struct.unpack("<qqB", attached[:17])
        assert len(attached) == 33 and length == 16 and abs(sent / 1e9 - time.time()) < 60
        numbers.append(sequence)
        publishers.add(attached[17:])
    assert numbers == [1, 2, 3] and len(publishers) == 1
    world.close()


def test_nodes_of_ros_see_the_node_its_publisher_and_its_subscription(robot):
    world = begun(robot, {"scan": SCAN}, DRIVE)
    # tokens that were declared may still be on their way
    wait_for(lambda: len([t for t in robot.tokens() if "/deodar" in t]) == 3)
    mine = [t for t in robot.tokens() if "/deodar" in t]
    found = {t.split("/")[5]: t.split("/") for t in mine}
    assert set(found) == {"NN", "MP", "MS"} and len(mine) == 3
    assert found["NN"][:2] == ["@ros2_lv", "0"] and found["NN"][3:] == ["0", "0", "NN", "%", "%", "deodar"]
    twist, laser = "geometry_msgs::msg::dds_::Twist_", "sensor_msgs::msg::dds_::LaserScan_"
    assert found["MP"][6:12] == ["%", "%", "deodar", "%cmd_vel", twist, HASHES["Twist"]]
    assert found["MS"][6:12] == ["%", "%", "deodar", "%scan", laser, HASHES["LaserScan"]]
    assert found["MP"][12] == "::,10:,:,:,,"
    assert len({tuple(parts[2:5]) for parts in found.values()}) == 3, "each has a number of its own"
    world.close()
    wait_for(lambda: not any("/deodar" in t for t in robot.tokens()))


def test_motors_go_to_rest_when_no_command_follows(robot):
    world = begun(robot, motors=DRIVE)
    world.act({"forward": np.array([0.2]), "turn": np.array([0.5])}, 0.0)
    wait_for(lambda: robot.commands and robot.commands[-1] == (0,) * 6)
    assert len(robot.commands) == 2 and robot.heard[1][0] - robot.heard[0][0] > 0.15
    world.act({"forward": np.array([0.2])}, 0.0)
    wait_for(lambda: robot.commands[-1][0] == 0.2)
    world.reset(0)
    wait_for(lambda: robot.commands[-1] == (0,) * 6)
    world.close()


def test_motors_go_to_rest_while_commands_of_another_topic_follow(robot):
    entry = {**DRIVE["forward"], "stops_after": 60_000}
    motors = {"arm": {**entry, "topic": "/arm"}, "forward": {**DRIVE["forward"], "stops_after": 50}}
    world = begun(robot, motors=motors)
    world.act({"arm": np.array([0.1])}, 0.0)
    world.act({"forward": np.array([0.2])}, 0.0)
    wait_for(lambda: len(robot.commands) == 2)
    assert [command[0] for command in robot.commands] == [0.2, 0.0]
    world.close()


def test_a_halt_puts_the_motors_to_rest_before_their_time(robot):
    motors = {name: {**entry, "stops_after": 60_000} for name, entry in DRIVE.items()}
    world = begun(robot, motors=motors)
    assert world.wall_clock
    world.act({"forward": np.array([0.2])}, 0.0)
    wait_for(lambda: robot.commands)
    world.halt()
    wait_for(lambda: robot.commands[-1] == (0,) * 6)
    world.act({"forward": np.array([0.1])}, 0.0)
    wait_for(lambda: robot.commands[-1][0] == 0.1)
    world.close()


LEFT = """
import sys, time
import numpy as np
import deodar as dd
world = dd.ROS2(motors={"drive": {"topic": "/cmd_vel", "type": "geometry_msgs/Twist"}}, at=sys.argv[1])
world.reset(0)
world.act({"drive": np.array([[0.25, 0.5]])}, 0.0)
time.sleep(0.05)
"""


@pytest.mark.parametrize("end", ["", "raise SystemExit(3)", "1 / 0"])
def test_a_script_that_ends_leaves_the_motors_at_rest(robot, end):
    code = LEFT.replace('Twist"}', 'Twist", "stops_after": 60000}')
    done = subprocess.run([sys.executable, "-c", code + end, robot.at], capture_output=True, text=True)
    assert done.returncode == {"": 0, "1 / 0": 1}.get(end, 3), done.stderr
    wait_for(lambda: len(robot.commands) == 2)
    assert robot.commands == [(0.25, 0, 0, 0, 0, 0.5), (0,) * 6]


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_a_command_that_is_ended_leaves_the_motors_at_rest(robot, tmp_path, number):
    motors = {name: {**entry, "stops_after": 60000} for name, entry in DRIVE.items()}
    settings = {"sensors": {"scan": SCAN}, "motors": motors, "at": robot.at, "period": 10, "patience": 5}
    file, model = tmp_path / "mine.json", tmp_path / "model.json"
    file.write_text(json.dumps({"robot": 1, "name": "mine", "kind": "ros2", "settings": settings}))
    dd.save(driving(), model)
    command = [sys.executable, "-m", "deodar", "run", model, "--live", "--duration", "600000"]
    with subprocess.Popen([*command, "--world", f"robot:{file}"], stdout=subprocess.PIPE) as process:
        wait_for(lambda: len(robot.commands) > 3, 60)
        process.send_signal(number)
        process.communicate(timeout=60)
    wait_for(lambda: robot.commands[-1] == (0,) * 6)


def test_a_rate_of_change_is_kept(robot):
    entry = {**DRIVE["forward"], "slew": 1.0}
    world = begun(robot, motors={"forward": entry})
    for _ in range(3):
        world.act({"forward": np.array([9.0])}, 0.0)
    wait_for(lambda: len(robot.commands) >= 3)
    assert np.allclose([c[0] for c in robot.commands[:3]], [0.01, 0.02, 0.03])
    world.close()


def test_a_connected_robot_is_narrowed_and_stays_so_when_it_is_connected_again(robot):
    world = begun(robot, motors=DRIVE)
    command = {"forward": np.array([9.0]), "turn": np.array([9.0])}
    world.act(command, 0.0)
    wait_for(lambda: robot.commands)
    world.narrow("forward", (-0.1, 0.1))
    world.narrow("turn", (-2.0, 0.5))
    world.act(command, 0.0)
    wait_for(lambda: len(robot.commands) >= 2)
    assert np.allclose([[c[0], c[5]] for c in robot.commands], [[0.3, 1.0], [0.1, 0.5]])
    world.close()
    world.reset(0)
    count = len(robot.commands)
    world.act(command, 0.0)
    wait_for(lambda: len(robot.commands) > count)
    assert np.allclose(robot.commands[-1], [0.1, 0, 0, 0, 0, 0.5])
    opened = ROS2.again(world.describe())
    assert opened.rules == world.rules
    world.close()


def test_a_motor_without_a_rest_gets_no_rate_of_change(robot):
    entry = {"topic": "/arm", "type": "trajectory_msgs/JointTrajectory", "joints": ["a"]}
    world = ROS2({}, {"arm": entry}, robot.at)
    with pytest.raises(WorldError, match="begins at the command at rest"):
        world.narrow("arm", slew=1.0)
    world.narrow("arm", (-1.0, 1.0))
    assert world.rules["arm"].limits == (-1.0, 1.0)


@pytest.mark.parametrize("declared", [{}, {"limits": [-2, 2]}])
def test_a_motor_without_a_rest_is_narrowed_to_a_range_without_zero(robot, declared):
    arm = {"topic": "/arm", "type": "trajectory_msgs/JointTrajectory", "joints": ["a"], **declared}
    world = ROS2({}, {"arm": arm, **DRIVE}, robot.at)
    world.narrow("arm", (0.5, 1.5))
    world.narrow("arm", (-1.0, 1.0))
    assert world.rules["arm"].limits == (0.5, 1.0)
    before = world.rules["arm"]
    with pytest.raises(WorldError, match="arm: no value lies within both"):
        world.narrow("arm", (-3.0, -2.0))
    with pytest.raises(WorldError, match="rest is 0; expected a value within"):
        world.narrow("turn", (0.5, 1.5))
    assert world.rules["arm"] == before and ROS2.again(world.describe()).rules == world.rules


def test_a_command_that_is_not_finite_is_not_sent(robot):
    world = begun(robot, motors=DRIVE)
    with pytest.raises(WorldError, match="motor 'forward': a command for /cmd_vel"):
        world.act({"forward": np.array([np.nan])}, 0.0)
    world.close()
    assert not robot.commands


def test_a_topic_that_falls_silent_is_named(robot):
    world = begun(robot, {"scan": SCAN}, patience=0.2)
    assert seen(world).tolist() == [1, 2, 3, 4]
    robot.ranges = None
    time.sleep(0.5)
    with pytest.raises(
        WorldError, match=r"sensor 'scan': the topic /scan at tcp.* was last read \d\.\d+ s ago"
    ):
        world.sense("scan", BEAMS, 0.0)
    world.close()


def test_a_topic_without_a_publisher_is_named_with_the_nearest_one(robot, monkeypatch):
    monkeypatch.setattr("deodar_robots.ros2.ros2.FIRST", 0.5)
    world = begun(robot, {"scan": {**SCAN, "topic": "/scam"}}, patience=0.2)
    with pytest.raises(WorldError, match=r"the topic /scam at .* has no message that was read.*/scan"):
        world.sense("scan", BEAMS, 0.0)
    world.close()


NAN = float("nan")
BAD = {
    "short": (dict(raw=scan([1, 2, 3, 4])[:30]), "is not a sensor_msgs/msg/LaserScan"),
    "empty": (dict(raw=b""), "is not a sensor_msgs/msg/LaserScan"),
    "long": (dict(raw=scan([1, 2, 3, 4]) + b"12345678"), "is not a sensor_msgs/msg/LaserScan"),
    "huge": (dict(raw=scan([1, 2, 3, 4])[:52] + b"\xff\xff\xff\x7f"), "is not a sensor_msgs/msg/LaserScan"),
    "not a number": (dict(raw=scan([1, NAN, 3, 4])), '1 of its distances are undefined.*"undefined": 10'),
    "shape": (dict(raw=scan([1, 2, 3])), r'it has 3 ranges, not 4.*"shape": \[3\]'),
    "limits": (dict(raw=scan([1, 2, 3, 4], 5, 3)), "its distances are between 5 and 3 m"),
    "type": (
        dict(raw=b"\0\1\0\0\2\0\0\0a\0", key=f"0/scan/std_msgs::msg::dds_::String_/{HASHES['String']}"),
        "it is a std_msgs/msg/String",
    ),
    "version": (
        dict(raw=scan([1, 2, 3, 4]), key="0/scan/sensor_msgs::msg::dds_::LaserScan_/RIHS01_00"),
        "of another version",
    ),
    "no attachment": (dict(raw=scan([1, 2, 3, 4]), attachment=None), "it has no attachment"),
    "attachment": (dict(raw=scan([1, 2, 3, 4]), attachment=b"12"), "its attachment has 2 bytes, not 33"),
    "old": (
        dict(raw=scan([1, 2, 3, 4]), attachment=struct.pack("<qqB", 0, 0, 16) + GID),
        "its sequence number goes back",
    ),
}


@pytest.mark.parametrize("what", BAD)
def test_a_bad_message_is_counted_named_and_never_read(robot, what):
    changes, said = BAD[what]
    world = begun(robot, {"scan": SCAN}, patience=0.2)
    seen(world)
    robot.ranges = None
    time.sleep(0.05)
    before = world.link()
    robot.send("/scan", "LaserScan", **changes)
    wait_for(lambda: world.link().refused > before.refused)
    assert world.link().received == before.received
    time.sleep(0.3)
    with pytest.raises(WorldError, match=re.compile(f"its last message was refused: .*{said}", re.S)):
        world.sense("scan", BEAMS, 0.0)
    world.close()


def test_beams_without_an_echo_have_the_largest_distance(robot):
    world = begun(robot, {"scan": SCAN, "filled": {**SCAN, "undefined": 9.0}}, patience=5.0)
    robot.ranges = [np.inf, -np.inf, 0.1, 10.0]
    wait_for(lambda: world.sense("scan", BEAMS, 0.0)[1] == np.float32(0.1))
    assert np.allclose(world.sense("scan", BEAMS, 0.0), [10, 0.1, 0.1, 10])
    robot.ranges = [NAN, 0.0, 11.0, 5.0]
    wait_for(lambda: world.sense("filled", BEAMS, 0.0).tolist() == [9, 9, 9, 5])
    world.close()


def test_a_range_is_one_number(robot):
    world = begun(robot, {"near": {"topic": "/ir/left", "type": "sensor_msgs/msg/Range"}}, patience=5.0)
    robot.until("%ir%left")
    robot.send("/ir/left", "Range", distance(0.75))
    assert world.sense("near", [], 0.0) == np.float32(0.75) and world.sensors["near"].unit == "m"
    world.close()


def test_a_picture_is_sampled_over_any_axes(robot):
    world = begun(robot, {"eye": {"topic": "/cam/image", "type": "sensor_msgs/Image"}}, patience=5.0)
    pixels = np.zeros((4, 6, 3), np.uint8)
    pixels[:2, 3:] = (255, 51, 0)
    made = Cdr().header().number("I", 4, 6).text("rgb8").number("B", 0).number("I", 18, pixels.nbytes)
    robot.until("%cam%image")
    robot.send("/cam/image", "Image", bytes(made.raw) + pixels.tobytes())
    axes = [dd.Axis("x", 0, 1, 2), dd.Axis("y", 0, 1, 2), dd.Axis("channel", 0, 2, 3)]
    wide = [dd.Axis("x", 0, 2, 3), *axes[1:]]
    np.testing.assert_allclose(world.sense("eye", wide, 0.0)[2], [[1, 0.2, 0], [0, 0, 0]], atol=0.01)
    with pytest.raises(WorldError, match="eye: a picture has two dimensions and three channels"):
        world.sense("eye", axes[:2], 0.0)
    world.close()


def test_a_topic_that_is_rarer_than_the_exchanges_states_its_period(robot):
    robot.ranges = None
    world = begun(robot, {"scan": {**SCAN, "period": 60_000}}, patience=0.1)
    robot.until("/MS/")
    robot.send("/scan", "LaserScan", scan([1, 2, 3, 4]))
    assert world.sense("scan", BEAMS, 0.0).tolist() == [1, 2, 3, 4]
    time.sleep(0.3)
    assert world.sense("scan", BEAMS, 0.0).tolist() == [1, 2, 3, 4]
    world.close()


@pytest.mark.parametrize("make", [lambda: ROS2({"scan": SCAN}), lambda: dd.ROSBag(ROOT)])
def test_a_missing_extra_is_named(monkeypatch, make):
    monkeypatch.setitem(sys.modules, "rosbags", None)
    for name in [n for n in sys.modules if n.startswith("rosbags.")]:
        monkeypatch.setitem(sys.modules, name, None)
    message_types.store.cache_clear()
    with pytest.raises(MissingExtra, match=r"needs the package rosbags.*pip install 'deodar\[network\]'"):
        make()


def test_neither_package_is_imported_before_a_world_is_made():
    code = "import sys, deodar; deodar.ROS2, deodar.ROSBag; print(*sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert not {"zenoh", "rosbags"} & set(done.stdout.split())


def test_messages_that_are_lost_are_counted(robot):
    robot.ranges = None
    world = begun(robot, {"near": {"topic": "/ir", "type": "sensor_msgs/Range"}}, patience=5.0)
    robot.until("%ir")
    robot.send("/ir", "Range", distance(1.0))
    robot.sequence += 3
    robot.send("/ir", "Range", distance(2.0))
    wait_for(lambda: world.link().received == 2)
    assert world.link().lost == 3 and world.link().by_sensor == {"near": 2}
    world.close()


def test_another_domain_hears_nothing(robot, monkeypatch):
    monkeypatch.setattr("deodar_robots.ros2.ros2.FIRST", 0.3)
    world = begun(robot, {"scan": SCAN}, domain=7, patience=0.2)
    with pytest.raises(WorldError, match=r"No node publishes there\. Type: ros2 topic list"):
        world.sense("scan", BEAMS, 0.0)
    world.close()


def test_a_router_that_is_missing_is_named(monkeypatch):
    monkeypatch.setattr("deodar_robots.ros2.ros2.FIRST", 0.2)
    world = ROS2({"scan": SCAN}, at="tcp/127.0.0.1:1", patience=0.2)
    with pytest.raises(
        WorldError, match=r"no router of ROS 2 answers at .*ros2 run rmw_zenoh_cpp rmw_zenohd"
    ):
        world.reset(0)


def test_another_host_needs_trust():
    with pytest.raises(WorldError, match="beyond this machine"):
        ROS2({"scan": SCAN}, at="tcp/10.0.0.2:7447")


def test_nothing_is_left_after_close(robot):
    # what earlier tests closed may still be ending
    threads, sockets = settled()
    world = begun(robot, {"scan": SCAN}, DRIVE)
    world.act({"forward": np.array([0.1])}, 0.0)
    world.close()
    wait_for(lambda: threading.active_count() <= threads and used() <= sockets)
    world.reset(0)
    assert seen(world).tolist() == [1, 2, 3, 4], "it connects again"
    gone = weakref.ref(world)
    del world
    gc.collect()
    assert gone() is None
    wait_for(lambda: threading.active_count() <= threads and used() <= sockets)


def settled() -> tuple[int, int]:
    """Return the numbers of threads and connections, once both are the same for a second."""
    found = [(threading.active_count(), used())]
    while len(found) < 5 or len(set(found[-5:])) > 1:
        time.sleep(0.25)
        found.append((threading.active_count(), used()))
        assert len(found) < 200, found[-5:]
    return found[-1]


def used() -> int:
    """Return the number of the connections of this process."""
    return sum(c.status == psutil.CONN_ESTABLISHED for c in psutil.Process().net_connections("inet"))


def test_the_robot_file_of_the_manual_is_one(tmp_path):
    page = (ROOT / "docs" / "ros2.md").read_text(encoding="utf-8")
    file = tmp_path / "turtle.json"
    file.write_text(page.split("```json\n")[1].split("```")[0])
    robot = dd.Robot(file)
    assert list(robot.sensors) == ["scan", "pose", "camera"] and list(robot.motors) == ["forward", "turn"]
    assert robot.rules["turn"].slew == 4 and not robot.repeatable
    types = [*SENSOR_TYPES, *MOTOR_TYPES]
    assert all(f"| `{name.replace('/msg', '')}`" in page for name in types)


def test_a_robot_file_names_the_topics_and_is_checked(robot, tmp_path, capsys):
    from deodar.cli import main

    file = tmp_path / "mine.json"
    settings = {"sensors": {"scan": SCAN}, "motors": DRIVE, "at": robot.at, "period": 10, "patience": 5}
    lab = {"kind": "ros2", "settings": settings}
    fields = {"robot": 1, "name": "mine", "kind": "arena", "settings": {"layout": "blocks"}}
    file.write_text(json.dumps(fields | {"places": {"simulated": {}, "lab": lab}}))
    assert main(["robots", "check", f"{file}@lab"]) == 0
    printed = capsys.readouterr().out
    assert "mine is there: ros2, live" in printed and "sensor scan: ranges of /scan by angle" in printed
    assert re.search(r"motor forward: .*; -0.3 to 0.3; at rest 0 after 200 ms", printed)
    assert float(re.search(r"([\d.]+) Hz counted", printed)[1]) > 5
    assert not robot.commands, "nothing moved"


@pytest.mark.parametrize(
    ("sensors", "motors", "message"),
    [
        ({}, {}, "names no topic"),
        ({"a": 3}, {}, "sensors a: Expected `object`"),
        ({"a": {**SCAN, "shape": None}}, {}, r'needs its shape.*"shape": \[360\]'),
        ({"a": {**SCAN, "joints": ["x"]}}, {}, "has no setting 'joints'"),
        ({"a": {**SCAN, "topic": "/a b"}}, {}, "'/a b' is not the name of a topic"),
        ({"a": {**SCAN, "type": "sensor_msgs/LaserScam"}}, {}, "LaserScan"),
        ({"a": {**SCAN, "fields": "range"}}, {}, "there is no field 'range'.*ranges"),
        ({"a": {**SCAN, "shapes": 1}}, {}, "unknown field `shapes`"),
        ({}, {"m": {**DRIVE["turn"], "fields": ["linear.w"]}}, "there is no field 'linear.w'"),
        ({}, {"m": {**DRIVE["turn"], "limits": [1, -1]}}, r"motors m: limits is \(1"),
        ({}, {"m": DRIVE["turn"], "n": DRIVE["turn"]}, "angular.z of /cmd_vel is commanded by the motor 'm'"),
        (
            {},
            {"m": DRIVE["turn"], "n": {**DRIVE["forward"], "type": "geometry_msgs/TwistStamped"}},
            "has the type geometry_msgs/msg/Twist for another motor",
        ),
        ({}, {"m": {"topic": "/a", "type": "std_msgs/Float64MultiArray"}}, "needs its shape"),
        ({}, {"m": {"topic": "/a", "type": "std_msgs/Float64MultiArray", "shape": [2]}}, '"rest": null'),
        ({}, {"m": {"topic": "/a", "type": "trajectory_msgs/JointTrajectory"}}, "names no joints"),
        (
            {},
            {"m": {"topic": "/a", "type": "trajectory_msgs/JointTrajectory", "joints": ["a"], "slew": 1}},
            "begins at the command at rest",
        ),
    ],
)
def test_settings_are_checked(sensors, motors, message):
    with pytest.raises(WorldError, match=message):
        ROS2(sensors, motors)
