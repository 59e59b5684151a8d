"""A robot that uses ROS 2 as a world."""

from __future__ import annotations

import weakref
from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from deodar import codec
from deodar.codec import Json, JsonObject
from deodar.errors import WorldError, option
from deodar.numerics.axes import Axes, Axis
from deodar.parameters import show
from deodar.registry import register
from deodar.worlds._base import Signal
from deodar.worlds._link_state import LinkState
from deodar.worlds._settings import number
from deodar_robots.limited_world import LimitedWorld
from deodar_robots.ros2.example_node import MOTORS, SENSORS, ExampleNode
from deodar_robots.ros2.message_types import hash_of
from deodar_robots.ros2.motor_types import commands
from deodar_robots.ros2.node import RosNode
from deodar_robots.ros2.sender import CommandSender
from deodar_robots.ros2.sensor_types import readings
from deodar_robots.ros2.topic_inbox import TopicInbox, silence
from deodar_robots.ros2.wire import nearest_topic
from deodar_robots.zenoh import link

ROUTER = "tcp/localhost:7447"
"""Endpoint of the router of rmw_zenoh by default."""

FIRST = 3.0
"""Least time that is waited for the first message of a topic, s; nodes find each other meanwhile."""

NODE = "deodar"
"""Name of the node of the model."""

MOST_DOMAIN = 232


@register
class ROS2(LimitedWorld):
    r"""A robot whose nodes use ROS 2 over rmw_zenoh; no ROS is installed on the side of the model.

    Each sensor shows the newest message of a topic, and each motor is sent to a topic, one message in each
    period. The world follows the wall clock: pace the model to it (`session.run_live`). Such a run cannot be
    repeated; record its sensors, and replay them (`Recording`), or record a bag (`ROSBag`).

    A sensor without a message for `patience` is an error that names the topic. The process of the model
    applies the limits of motors, and sends the command at rest when the run pauses or fails, when it closes
    the world, or when no command came for `stops_after`. A process that is killed sends nothing: the driver
    of the robot needs a limit of time of its own.

    Equation:
        y(t) = y_{\mathrm{topic}}(t - a(t)),\quad a(t) \le \mathrm{patience}

    Parameters:
        sensors: for each sensor its topic, type and settings, as plain data.
        motors: for each motor its topic, type, limits and settings, as plain data.
        at: endpoint of the router, tcp/HOST:PORT.
        period: ms between two exchanges; a whole number of steps of the model.
        patience: time without a message of a topic after which its sensor raises an error, s.
        domain: domain of ROS 2, ROS_DOMAIN_ID of the robot.
        trusted: whether the network between this machine and another host is trusted; messages are not
            encrypted.

    Shapes:
        Those of the messages: the manual has a table of types. Pictures are sampled over columns from the
        left, rows from the top, and channels.

    Reference:
        Macenski, Foote, Gerkey, Lalancette & Woodall (2022), Robot Operating System 2, Science Robotics 7,
        eabm6074; the design of rmw_zenoh (github.com/ros2/rmw_zenoh, docs/design.md).
    """

    # of the example
    sensors: Mapping[str, Signal] = {
        "scan": Signal("ranges of /scan by angle", (8,), "m"),
        "pose": Signal("x, y, yaw of /odom", (3,)),
    }
    motors: Mapping[str, Signal] = {
        "forward": Signal("linear.x of /cmd_vel", (), "m/s"),
        "turn": Signal("angular.z of /cmd_vel", (), "rad/s"),
    }
    stands_in = False
    repeatable = False
    wall_clock = True

    def __init__(
        self,
        sensors: Mapping[str, Any] | None = None,
        motors: Mapping[str, Any] | None = None,
        at: str = ROUTER,
        period: float = 50.0,
        patience: float = 0.5,
        domain: int = 0,
        trusted: bool = False,
    ) -> None:
        self.at = link.require_endpoint(at, trusted)
        self.period = number("period", period, above=0.0)
        self.patience, self.trusted = number("patience", patience, above=0.0), bool(trusted)
        if type(domain) is not int or not 0 <= domain <= MOST_DOMAIN:
            raise WorldError(f"domain is {show(domain)}; expected a whole number from 0 to {MOST_DOMAIN}")
        self.domain = domain
        self._settings = codec.parse(
            codec.line({"sensors": dict(sensors or {}), "motors": dict(motors or {})})
        )
        self._sensors = readings(self._settings["sensors"])
        self._motors = commands(self._settings["motors"], self.period)
        self.sensors = {name: reading.signal for name, (_, _, reading) in self._sensors.items()}
        self.motors = {name: motor.signal for name, (_, _, motor) in self._motors.items()}
        self._declare_rules({name: motor.rule for name, (_, _, motor) in self._motors.items()})
        if not self.sensors and not self.motors:
            raise WorldError("names no topic", fix='State sensors={"scan": {"topic": "/scan", ...}}')
        self._node: RosNode | None = None
        self._close: Any = None
        types = {type for _, type, _ in self._sensors.values()}
        self._inbox = TopicInbox(self._sensors, {type: hash_of(type) for type in types})

    # ------------------------------------------------------------------------------------------- the exchange

    def reset(self, seed: int, trials: Sequence[int] = (0,), precision: str = "float32") -> None:
        if self._node is None:
            self._connect()
        self._sender.rest()
        self._inbox.begin()

    def _connect(self) -> None:
        node = RosNode(self.at, max(self.patience, FIRST), self.domain, NODE)
        try:
            for topic, type in {topic: type for topic, type, _ in self._sensors.values()}.items():
                node.subscribe(topic, type, partial(self._inbox.offer, topic))
            for topic, type in {topic: type for topic, type, _ in self._motors.values()}.items():
                node.advertise(topic, type)
        except BaseException:
            node.close()
            raise
        self._node = node
        self._sender = CommandSender(self._motors, node.publish, self.period or 0.0)
        self._close = weakref.finalize(self, _leave, self._sender, node)

    def sense(self, sensor: str, axes: Axes, time: float) -> np.ndarray:
        return self.sense_all([(sensor, axes)], time)[0]

    def sense_all(self, requests: Sequence[tuple[str, Axes]], time: float) -> list[np.ndarray]:
        for sensor, _ in requests:
            self.require(sensor)
        self._require_begun()
        self._inbox.wait_for([sensor for sensor, _ in requests], max(self.patience, FIRST))
        return [self._read(sensor, axes) for sensor, axes in requests]

    def _read(self, sensor: str, axes: Axes) -> np.ndarray:
        topic, _, reading = self._sensors[sensor]
        found = self._inbox.reading(sensor)
        slow = (reading.signal.period or 0.0) / 1000
        if found is None or found[1] > self.patience + slow:
            why = self._inbox.refused(sensor)
            near = "" if why is not None else self._near(topic)
            raise silence(sensor, topic, self.at, None if found is None else found[1], why, near)
        return reading.sampled(found[0], axes, sensor)

    def _near(self, topic: str) -> str:
        """Return what to type where nothing comes from a topic."""
        node = self._require_begun()
        types = node.topics(max(self.patience, 0.2))
        if topic in types:
            return f"A node publishes it, but sends nothing. Type: ros2 topic hz {topic}"
        return nearest_topic(topic, types)

    def act(self, motors: Mapping[str, np.ndarray], time: float) -> None:
        self._require_begun()
        for motor in motors:
            self.require_motor(motor)
        # a live robot is one, whatever the number of copies
        self._sender.send({name: np.asarray(command)[0] for name, command in motors.items()})

    def halt(self) -> None:
        if self._node is not None:
            self._sender.rest()

    def _require_begun(self) -> RosNode:
        if self._node is None:
            raise WorldError("the world has not begun", self.at, "Type: world.reset(seed)")
        return self._node

    def close(self) -> None:
        """Send the commands at rest, and leave the network. The next `reset` connects again."""
        if self._close is not None:
            self._close()
        self._node = self._close = None

    def narrow(
        self, motor: str, limits: tuple[float, float] | None = None, slew: float | None = None
    ) -> None:
        self.require_motor(motor)
        command = self._motors[motor][2]
        if slew is not None:
            command.require_rest()
        if limits is not None and not command.rests:
            rule = self._rules[motor]  # its rest is never sent, and only has to lie within the limits
            low, high = rule.limits or limits
            low, high = max(low, limits[0]), min(high, limits[1])
            if low < high:
                self._rules[motor] = replace(rule, rest=min(max(rule.rest, low), high))
        super().narrow(motor, limits, slew)
        command.rule = self.rules[motor]

    def link(self) -> LinkState:
        return self._inbox.state(self.at)

    # ------------------------------------------------------------------------------------------------ records

    def describe(self) -> dict[str, Json]:
        said: JsonObject = {"world": "ROS2", "at": self.at, "period": self.period, "domain": self.domain}
        settings = {"patience": self.patience, "trusted": self.trusted, **self._settings}
        return {**said, **settings, **self._narrowing()}

    @classmethod
    def open(cls, argument: str) -> ROS2:
        raise WorldError(
            "topics are stated in a robot file",
            where=f"ros2:{argument}",
            fix=option('Write one of the kind "ros2":', "world", "robot:FILE", "dd.Robot(FILE)"),
        )

    @classmethod
    def again(cls, described: Mapping[str, Json]) -> ROS2:
        given: dict[str, Any] = {k: v for k, v in described.items() if k not in ("world", "narrowed")}
        world = cls(**given)
        world._narrow_as(described)
        return world

    @classmethod
    def example(cls) -> ROS2:
        """Return a robot that does not move; a thread of this process is its node."""
        node = ExampleNode()
        world = cls(SENSORS, MOTORS, node.at, patience=600.0)
        weakref.finalize(world, node.close)
        return world

    @staticmethod
    def example_axes(sensor: str) -> Axes:
        return (Axis("beam", 0, 7, 8),) if sensor == "scan" else (Axis("of", 0, 2, 3),)


def _leave(sender: CommandSender, node: RosNode) -> None:
    """Put all motors to rest, and leave the network."""
    try:
        sender.close()
    finally:
        node.close()
