"""What a setting says of a motor that is a topic of ROS 2."""

from __future__ import annotations

from typing import Annotated

import msgspec
from msgspec import UNSET, Meta, UnsetType

from deodar.worlds._motor_rule import STOPS_AFTER
from deodar_robots.ros2.topic_sensor import ArraySamples

Above0 = Annotated[float, Meta(gt=0)]


class TopicMotor(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A motor whose commands go to a topic. Several motors may command parts of one message.

    Attributes:
        topic: name of the topic.
        type: type of its messages, such as geometry_msgs/Twist.
        shape: number of values, where the type leaves it open.
        fields: which numbers of a message the command is; a single name instead of a list is one number.
        joints: names of the joints, in the order of the command.
        limits: smallest and largest value of each sample.
        slew: largest change of each sample per second.
        rest: value of each sample at rest; null: nothing is sent, and the robot keeps the last command.
        stops_after: time without a command after which the command at rest is sent, ms.
        duration: time in which joints reach the commanded point, ms; by default two exchanges.
    """

    topic: str
    type: str
    shape: ArraySamples | None = None
    fields: str | list[str] | None = None
    joints: list[str] | None = None
    limits: tuple[float, float] | None = None
    slew: Above0 | None = None
    rest: float | UnsetType | None = UNSET
    stops_after: Above0 = STOPS_AFTER
    duration: Above0 | None = None
