"""Bags of ROS 2 as worlds, and records as bags."""

from __future__ import annotations

import json
import re
import sqlite3
from contextlib import closing
from pathlib import Path

import numpy as np
import pytest
from rosbags.rosbag2 import Reader, StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore

import deodar as dd
from deodar.errors import RecordError, WorldError
from deodar_robots.ros2.message_types import hash_of
from deodar_robots.ros_bag import bag_file
from deodar_robots.ros_bag import bag_file as rosbag
from tests.command_line import typed
from tests.deodar_robots.ros2.fake import distance, scan

TYPES = {
    "/scan": "sensor_msgs/msg/LaserScan",
    "/ir/left": "sensor_msgs/msg/Range",
    "/chatter": "std_msgs/msg/String",
}
BEGAN = 1_700_000_000_123_456_789
WORD = b"\0\1\0\0\2\0\0\0a\0"
BEAMS = (dd.Axis("beam", 0, 3, 4),)


def bag(path: Path, messages, plugin=StoragePlugin.SQLITE3) -> Path:
    """Write a bag as another program does: times in ns after the first, topics, and bytes."""
    with Writer(path, version=8, storage_plugin=plugin) as writer:
        store = get_typestore(Stores.ROS2_JAZZY)
        topics = {topic for _, topic, _ in messages}
        known = {topic: writer.add_connection(topic, TYPES[topic], typestore=store) for topic in topics}
        for time, topic, raw in messages:
            writer.write(known[topic], BEGAN + time, raw)
    return path


def counted(n: int = 20, step: int = 100_000_000) -> list[tuple[int, str, bytes]]:
    return [(k * step, "/scan", scan([1 + 0.1 * k, 2, 3, 4])) for k in range(n)]


@pytest.mark.parametrize("plugin", [StoragePlugin.SQLITE3, StoragePlugin.MCAP])
def test_topics_are_sensors_with_the_newest_message_at_each_time(tmp_path, plugin):
    messages = [
        *counted(3),
        (150_000_000, "/ir/left", distance(0.5)),
        (1, "/chatter", b"\0\1\0\0\2\0\0\0a\0"),
    ]
    world = dd.ROSBag(bag(tmp_path / "lab", messages, plugin))
    assert set(world.sensors) == {"scan", "ir/left"} and world.period == 50
    assert world.sensors["scan"].shape == (4,) and world.duration == 200
    for time, first in ((0, 1.0), (99.999, 1.0), (100, 1.1), (199, 1.1), (200, 1.2), (249, 1.2)):
        assert np.isclose(world.sense("scan", BEAMS, time)[0], first), time
    assert world.sense("ir/left", (), 0.0) == 0.5, "before its first message a sensor shows that"
    with pytest.raises(WorldError, match=r"lab: ends at 200 ms, and the run continues to 250 ms"):
        world.sense("scan", BEAMS, 250)


def test_a_run_is_repeatable_and_returns(tmp_path):
    world = dd.ROSBag(bag(tmp_path / "lab", counted()))
    model = dd.Model("replay", dt=10)
    model.add(dd.Sensor("see", BEAMS, sensor="scan"))
    first, again = (dd.simulate(model, 1500, record=["see.output"], world=world) for _ in range(2))
    assert first["see.output"].equals(again["see.output"])
    values = first["see.output"].values[:, 0]
    assert np.allclose(values, 1 + 0.1 * (first["time"].values // 100))


def test_messages_are_held_in_parts_in_any_order(tmp_path, monkeypatch):
    path = bag(tmp_path / "lab", [(t // 2, *rest) for t, *rest in counted(60, 20_000_000)])
    monkeypatch.setattr(bag_file, "MOST_MESSAGES", 7)
    world = dd.ROSBag(path, period=10)
    times = [0, 590, 100, 95, 300, 10, 585, *np.random.default_rng(0).integers(0, 599, 40)]
    for time in times:
        assert np.isclose(world.sense("scan", BEAMS, float(time))[0], 1 + 0.1 * (time // 10)), time
    (messages,) = world._messages.values()
    assert len(messages._times) <= 8


def test_many_messages_of_one_time_are_passed(tmp_path, monkeypatch):
    monkeypatch.setattr(bag_file, "MOST_MESSAGES", 3)
    messages = [
        (t, "/scan", scan([k + 1, 2, 3, 4])) for k, t in enumerate([0, 0, 0, 0, 0, 10, 10, 10, 10, 30])
    ]
    world = dd.ROSBag(bag(tmp_path / "lab", messages))
    assert world.sense("scan", BEAMS, 1.0)[0] == 10 and world.sense("scan", BEAMS, 0.0)[0] == 5


def test_settings_choose_topics_and_types(tmp_path):
    path = bag(tmp_path / "lab", [*counted(3), (0, "/ir/left", distance(0.5))])
    world = dd.ROSBag(path, {"near": {"topic": "/ir/left", "type": "sensor_msgs/Range"}}, period=20)
    assert list(world.sensors) == ["near"] and world.period == 20
    again = dd.ROSBag.again(json.loads(json.dumps(world.describe())))
    assert again.describe() == world.describe()
    assert dd.ROSBag.open(f"{path}, period=25").period == 25
    entry = {"type": "sensor_msgs/LaserScan", "shape": [4]}
    with pytest.raises(WorldError, match=r'/ir/left has the type sensor_msgs/msg/Range.*"sensor_msgs/Range"'):
        dd.ROSBag(path, {"a": {"topic": "/ir/left", **entry}})
    with pytest.raises(WorldError, match=r"has no message on /scam.*/scan"):
        dd.ROSBag(path, {"a": {"topic": "/scam", **entry}})


def test_another_version_of_a_type_is_refused(tmp_path):
    """A bag says it by the hash of the type; one without hashes is trusted."""
    jazzy = hash_of(TYPES["/scan"])
    for name, version in (("same", jazzy), ("unsaid", ""), ("other", f"RIHS01_{0:064}")):
        path = bag(tmp_path / name, counted(3))
        metadata = path / "metadata.yaml"
        metadata.write_text(metadata.read_text().replace(jazzy, version or "''"))
        with closing(sqlite3.connect(path / f"{name}.db3")) as topics, topics:
            topics.execute("update topics set type_description_hash = ?", (version,))
        assert jazzy not in metadata.read_text() or version == jazzy
    assert [dd.ROSBag(tmp_path / name).sense("scan", BEAMS, 0)[0] for name in ("same", "unsaid")] == [1, 1]
    with pytest.raises(WorldError, match=r"/scan has another version of sensor_msgs/msg/LaserScan than"):
        dd.ROSBag(tmp_path / "other")


def test_motors_of_a_robot_are_accepted_without_effect(tmp_path):
    path = bag(tmp_path / "lab", counted())
    twist = {"topic": "/cmd_vel", "type": "geometry_msgs/Twist"}
    world = dd.ROSBag(path, motors={"drive": twist})
    assert world.motors["drive"].shape == (2,) and not dd.ROSBag(path).motors
    model = dd.Model("driving", dt=10)
    axes = [dd.Axis("of", 0, 1, 2)]
    model.add(dd.Boost("go", axes, amplitude=1.0)) >> model.add(dd.Motor("drive", axes, motor="drive"))
    dd.simulate(model, 100, record=["go.output"], world=world)
    assert dd.ROSBag.again(world.describe()).motors == world.motors


def test_a_message_that_is_refused_is_named_with_its_time(tmp_path):
    messages = [*counted(2), (200_000_000, "/scan", scan([1, float("nan"), 3, 4]))]
    path = bag(tmp_path / "lab", messages)
    world = dd.ROSBag(path)
    assert world.sense("scan", BEAMS, 150).shape == (4,)
    with pytest.raises(WorldError, match=r'of /scan at 200 ms is refused: 1 of .*"undefined": 10'):
        world.sense("scan", BEAMS, 200)
    filled = {"topic": "/scan", "type": "sensor_msgs/LaserScan", "shape": [4], "undefined": 10}
    assert dd.ROSBag(path, {"scan": filled}).sense("scan", BEAMS, 200).tolist() == [1, 10, 3, 4]


def test_what_is_not_a_bag_is_named(tmp_path):
    with pytest.raises(WorldError, match=r"there is no such bag.*metadata\.yaml"):
        dd.ROSBag(tmp_path / "none")
    with pytest.raises(WorldError, match="cannot be read as a bag"):
        dd.ROSBag(tmp_path)
    path = bag(tmp_path / "lab", counted(3))
    file = next(path.glob("*.db3"))
    file.write_bytes(file.read_bytes()[:5000])
    with pytest.raises(WorldError, match="cannot be read as a bag"):
        dd.ROSBag(path)
    long = bag(tmp_path / "long", counted(3))
    with (long / "metadata.yaml").open("a") as metadata:
        metadata.write("# \n" * 400_000)
    with pytest.raises(WorldError, match=r"its metadata\.yaml has 1,200,\d+ bytes, more than 1,000,000"):
        dd.ROSBag(long)
    late = bag(tmp_path / "late", counted(3)) / "metadata.yaml"
    late.write_text(re.sub(r"nanoseconds: \d+", "nanoseconds: " + 400 * "9", late.read_text()))
    with pytest.raises(WorldError, match=r"its metadata\.yaml states times that no clock has"):
        dd.ROSBag(late.parent)
    only = bag(tmp_path / "words", [(0, "/chatter", WORD)])
    with pytest.raises(WorldError, match=r"no topic that a sensor reads.*/chatter \(std_msgs/msg/String\)"):
        dd.ROSBag(only)


# ---------------------------------------------------------------------------------------------------- records


@pytest.fixture
def seen():
    """Return the record of a robot: readings of two sensors, and a field."""
    model = dd.Model("seeing", dt=16)
    model.add(dd.Sensor("eyes", [dd.Axis("sensor", 0, 7, 8)], sensor="infrared"))
    model.add(dd.Sensor("at", sensor="heading"))
    model.add(dd.Boost("go", amplitude=300.0)) >> model.add(dd.Motor("wheel", motor="left"))
    arena = dd.Arena("blocks", unit="cm", start=(20, 30, 0.4))
    return dd.simulate(model, 640, record=["eyes.output", "at.output", "go.output"], every=64, world=arena)


@pytest.mark.parametrize("precision", [np.float32, np.float64])
def test_a_record_is_a_bag_and_the_bag_a_world_with_the_same_readings(tmp_path, seen, precision):
    seen = seen.astype(precision)
    rosbag.save(seen, tmp_path / "bag")
    world, recording = dd.ROSBag(tmp_path / "bag"), dd.Recording(seen)
    assert set(world.sensors) == {"infrared", "heading", "go.output"}
    assert world.period == recording.period == 64
    for sensor in ("infrared", "heading"):
        assert world.sensors[sensor].shape == recording.sensors[sensor].shape
        for time in np.arange(0, 641, 16.0):
            shown, expected = (w.sense(sensor, (), time) for w in (world, recording))
            assert shown.dtype == precision and np.array_equal(shown, expected), (sensor, time)


def test_a_replay_of_the_bag_repeats_the_run(tmp_path, seen):
    rosbag.save(seen, tmp_path / "bag")
    model = dd.Model("seeing", dt=16)
    model.add(dd.Sensor("eyes", [dd.Axis("sensor", 0, 7, 8)], sensor="infrared"))
    model.add(dd.Boost("go", amplitude=300.0)) >> model.add(dd.Motor("wheel", motor="left"))
    record = dd.simulate(model, 640, record=["eyes.output"], every=64, world=dd.ROSBag(tmp_path / "bag"))
    assert np.array_equal(record["eyes.output"].values, seen["eyes.output"].values)


def test_other_programs_read_topics_types_times_and_shapes(tmp_path, seen):
    rosbag.save(seen, tmp_path / "bag")
    store = get_typestore(Stores.ROS2_JAZZY)
    with Reader(tmp_path / "bag") as reader:
        types = {topic: about.msgtype for topic, about in reader.topics.items()}
        assert types == dict.fromkeys(
            ["/eyes/output", "/at/output", "/go/output"], "std_msgs/msg/Float32MultiArray"
        )
        eyes = [c for c in reader.connections if c.topic == "/eyes/output"]
        found = list(reader.messages(eyes))
    assert [time for _, time, _ in found] == [64_000_000 * k for k in range(11)]
    message = store.deserialize_cdr(found[3][2], "std_msgs/msg/Float32MultiArray")
    assert [(d.label, d.size, d.stride) for d in message.layout.dim] == [("sensor", 8, 8)]
    assert np.array_equal(message.data, seen["eyes.output"].values[3])


def test_the_command_writes_a_bag(tmp_path, seen, monkeypatch):
    monkeypatch.chdir(tmp_path)
    dd.save_record(seen, "run.zarr")
    command = typed("export run.zarr eyes.output --to rosbag --out bag")
    assert command.status == 0 and "Wrote eyes.output to bag" in command.out
    assert sorted(p.name for p in Path("bag").iterdir()) == ["bag.db3", "metadata.yaml"]
    assert typed("export run.zarr --to rosbag --out bag").status == 1
    assert list(dd.ROSBag("bag").sensors) == ["infrared"]
    file = Path("replay.json")
    file.write_text(json.dumps({"robot": 1, "name": "old", "kind": "rosbag", "settings": {"file": "bag"}}))
    monkeypatch.chdir("/")
    assert list(dd.Robot(tmp_path / file).sensors) == ["infrared"]


def test_a_record_with_trials_or_without_times_is_refused(tmp_path, seen):
    with pytest.raises(RecordError, match=r"is over trial, and a bag holds one run.*record.sel"):
        rosbag.save(seen.expand_dims(trial=[0, 1]), tmp_path / "bag")
    with pytest.raises(RecordError, match="has no times"):
        rosbag.save(seen.isel(time=0, drop=True), tmp_path / "bag")
    abstract = seen.copy()
    abstract["time"].attrs["units"] = "abstract"
    with pytest.raises(RecordError, match="has abstract times"):
        rosbag.save(abstract, tmp_path / "bag")
    assert not list(tmp_path.iterdir())


def test_names_that_no_topic_holds_become_different_ones(tmp_path, seen):
    data = seen[["go.output"]].rename({"go.output": "a b.output"})
    data["a_b.output"] = data["a b.output"]
    data["2nd.output"] = data["a b.output"]
    rosbag.save(data, tmp_path / "bag")
    with Reader(tmp_path / "bag") as reader:
        assert set(reader.topics) == {"/a_b/output", "/a_b/output_2", "/_2nd/output"}
    assert set(dd.ROSBag(tmp_path / "bag").sensors) == set(data.data_vars)
