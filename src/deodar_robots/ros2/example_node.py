"""A router and a node whose messages are constant, for examples and tests."""

from __future__ import annotations

import threading
from typing import Any

import numpy as np

from deodar_robots.ros2.message_types import header, make, to_bytes
from deodar_robots.ros2.node import RosNode
from deodar_robots.zenoh import link
from deodar_robots.zenoh.served_world import free_endpoint

SENSORS: dict[str, Any] = {
    "scan": {"topic": "/scan", "type": "sensor_msgs/LaserScan", "shape": [8]},
    "pose": {"topic": "/odom", "type": "nav_msgs/Odometry"},
}
MOTORS: dict[str, Any] = {
    "forward": {"topic": "/cmd_vel", "type": "geometry_msgs/Twist", "fields": "linear.x"},
    "turn": {"topic": "/cmd_vel", "type": "geometry_msgs/Twist", "fields": "angular.z"},
}


class ExampleNode:
    """A robot that does not move and shows the same scan every 20 ms; a thread of this process.

    Attributes:
        at: endpoint of its router.
    """

    def __init__(self) -> None:
        self.at = free_endpoint()
        self._router = link.listen(self.at, router=True)
        self._node = RosNode(self.at, 5.0, 0, "robot")
        self._messages = {
            "/scan": (scan(np.linspace(0.5, 4.0, 8)), "sensor_msgs/msg/LaserScan"),
            "/odom": (odometry(0.3, -0.2), "nav_msgs/msg/Odometry"),
        }
        for topic, (_, type) in self._messages.items():
            self._node.advertise(topic, type)
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._run, name="ros2 example", daemon=True)
        self._thread.start()

    def _run(self) -> None:
        while not self._ended.wait(0.02):
            for topic, (raw, _) in self._messages.items():
                self._node.publish(topic, raw)

    def close(self) -> None:
        """Leave the network."""
        self._ended.set()
        self._thread.join()
        self._node.close()
        self._router.close()


def scan(ranges: np.ndarray) -> bytes:
    """Return a LaserScan of distances up to 5 m, all around."""
    limits = {"range_min": 0.1, "range_max": 5.0, "scan_time": 0.1, "time_increment": 0.0}
    angles = {"angle_min": -np.pi, "angle_max": np.pi, "angle_increment": 2 * np.pi / len(ranges)}
    rows = {"ranges": np.asarray(ranges, np.float32), "intensities": np.zeros(0, np.float32)}
    return to_bytes(make("sensor_msgs/msg/LaserScan", header=header(), **limits, **angles, **rows))


def odometry(x: float, y: float) -> bytes:
    """Return an Odometry at a position, m, without a rotation and at rest."""
    zero = make("geometry_msgs/msg/Vector3", x=0.0, y=0.0, z=0.0)
    place = make("geometry_msgs/msg/Point", x=x, y=y, z=0.0)
    ahead = make("geometry_msgs/msg/Quaternion", x=0.0, y=0.0, z=0.0, w=1.0)
    pose = make("geometry_msgs/msg/Pose", position=place, orientation=ahead)
    twist = make("geometry_msgs/msg/Twist", linear=zero, angular=zero)
    spread = np.zeros(36)
    return to_bytes(
        make(
            "nav_msgs/msg/Odometry",
            header=header(),
            child_frame_id="base",
            pose=make("geometry_msgs/msg/PoseWithCovariance", pose=pose, covariance=spread),
            twist=make("geometry_msgs/msg/TwistWithCovariance", twist=twist, covariance=spread),
        )
    )
