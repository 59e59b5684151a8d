"""A robot that uses ROS 2, at a free port."""

from __future__ import annotations

import socket
import time

import pytest

from tests.deodar_robots.ros2.fake import FakeRobot


@pytest.fixture(scope="module")
def one_robot():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    found = FakeRobot(port)
    yield found
    found.close()


@pytest.fixture
def robot(one_robot):
    one_robot.ranges = [1.0, 2.0, 3.0, 4.0]
    time.sleep(0.05)  # what the test before has sent is there
    one_robot.commands.clear()
    one_robot.heard.clear()
    return one_robot
