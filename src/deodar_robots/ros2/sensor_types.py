"""The types of messages that sensors read."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from deodar_robots.ros2.arrays import ArrayReading
from deodar_robots.ros2.distances import RangeReading, ScanReading
from deodar_robots.ros2.message_types import full_name
from deodar_robots.ros2.pictures import CompressedReading, PictureReading
from deodar_robots.ros2.reading import Reading
from deodar_robots.ros2.states import ImuReading, JointReading, OdometryReading
from deodar_robots.ros2.topic_sensor import TopicSensor, entries
from deodar_robots.ros2.wire import require_topic

SENSOR_TYPES: Mapping[str, type[Reading]] = {
    "nav_msgs/msg/Odometry": OdometryReading,
    "sensor_msgs/msg/CompressedImage": CompressedReading,
    "sensor_msgs/msg/Image": PictureReading,
    "sensor_msgs/msg/Imu": ImuReading,
    "sensor_msgs/msg/JointState": JointReading,
    "sensor_msgs/msg/LaserScan": ScanReading,
    "sensor_msgs/msg/Range": RangeReading,
    "std_msgs/msg/Float32MultiArray": ArrayReading,
    "std_msgs/msg/Float64MultiArray": ArrayReading,
}


def readings(data: Any) -> dict[str, tuple[str, str, Reading]]:
    """Return topic, type and reading of each sensor, from a setting as plain data.

    Raises:
        WorldError: an entry is not what its type needs.
    """
    found: dict[str, tuple[str, str, Reading]] = {}
    for name, entry in entries(data, TopicSensor, "sensors").items():
        where = f"sensors {name}"
        topic, type = require_topic(entry.topic, where), full_name(entry.type, tuple(SENSOR_TYPES), where)
        found[name] = topic, type, SENSOR_TYPES[type](entry, where)
    return found
