"""A robot without deodar on Zenoh: its messages are written by hand, as in docs/robots.md."""

from __future__ import annotations

import json
import struct
import threading
import time

import numpy as np
import pytest

import deodar as dd
from deodar.errors import WorldError
from deodar_robots.zenoh import link
from deodar_robots.zenoh.about import About
from deodar_robots.zenoh.served_world import free_endpoint

HEADER = struct.Struct("<4sBBHQdQQQ")
ABOUT = {
    "robot": 1,
    "name": "pan",
    "clock": "live",
    "period": 10,
    "sensors": {"angle": {"meaning": "angle", "shape": [], "unit": "rad"}, "row": {"shape": [4]}},
    "motors": {"speed": {"meaning": "speed", "shape": [], "unit": "rad/s", "limits": [-1, 1]}},
}


class ForeignRobot:
    """A head that turns at the commanded speed, in 30 lines."""

    def __init__(self, at: str, alive: bool = True) -> None:
        key = link.credentials(at)
        self.session = link.listen(at, key)
        self.angle, self.speed, self.count, self.heard = 0.0, 0.0, 0, 0.0
        self.kept = [
            self.session.declare_queryable(
                "pan/about",
                lambda q: q.reply("pan/about", json.dumps(ABOUT), attachment=key.proof(bytes(q.payload))),
            ),
            self.session.declare_subscriber("pan/motor/speed", self.take),
        ]
        if alive:
            self.kept.append(self.session.liveliness().declare_token("pan/alive"))
        self.ended = threading.Event()
        self.thread = threading.Thread(target=self.run)
        self.thread.start()

    def take(self, sample) -> None:
        (self.speed,) = struct.unpack_from("<f", bytes(sample.payload), HEADER.size)
        self.heard = time.monotonic()

    def run(self) -> None:
        while not self.ended.wait(0.01):
            speed = self.speed if time.monotonic() - self.heard < 0.2 else 0.0
            self.angle += 0.01 * speed
            self.count += 1
            head = HEADER.pack(b"DDR1", 0, 0, 1, self.count, 10.0 * self.count, time.monotonic_ns(), 0, 0)
            self.session.put("pan/sensor/angle", head + struct.pack("<f", self.angle))
            row = HEADER.pack(b"DDR1", 0, 1, 1, self.count, 0.0, 0, 0, 0) + struct.pack("<I4f", 4, 1, 2, 3, 4)
            self.session.put("pan/sensor/row", row)

    def close(self) -> None:
        self.ended.set()
        self.thread.join()
        for each in self.kept:
            each.undeclare()
        self.session.close()


@pytest.fixture
def robot():
    at = free_endpoint()
    found = ForeignRobot(at)
    found.at = at
    yield found
    if not found.ended.is_set():
        found.close()


def turning(amplitude: float) -> dd.Model:
    model = dd.Model("turning", dt=10)
    model.add(dd.Sensor("see", sensor="angle"))
    model.add(dd.Sensor("row", [dd.Axis("x", 0, 3, 4)], sensor="row"))
    model.add(dd.Boost("go", amplitude=amplitude)) >> model.add(dd.Motor("turn", motor="speed"))
    return model


def test_a_model_moves_it_within_its_limits_and_sees_it(robot):
    world = dd.Zenoh(at=robot.at)
    session = dd.Session(turning(5.0), world=world)
    session.run_live(500)
    assert 0.1 < float(session.read("see")) < 1.0, "1 rad/s at most, for half a second"
    assert robot.speed == 1.0
    assert session.read("row").tolist() == [1, 2, 3, 4]
    assert world.link().age < 500
    world.close()


def test_it_is_named_when_it_leaves(robot):
    world = dd.Zenoh("pan", robot.at)
    session = dd.Session(turning(1.0), world=world)
    session.run(10)
    robot.close()
    with pytest.raises(WorldError, match="the robot 'pan' has left the network"):
        session.run(10_000)
    world.close()


def test_a_program_that_takes_the_port_of_one_without_a_token_has_to_prove_itself():
    """Only the end of its connection shows that such a robot has left."""
    at = free_endpoint()
    robot = ForeignRobot(at, alive=False)
    world = dd.Zenoh("pan", at, patience=5.0)
    world.reset(0)
    assert world.sense("angle", (), 0.0).shape == ()
    robot.close()
    # with the key, as a listener of its own make that lets everybody in
    thief = link.listen(at, link.credentials(at))
    head = HEADER.pack(b"DDR1", 0, 0, 1, 10**9, 0.0, time.monotonic_ns(), 0, 0)
    for _ in range(100):
        thief.put("pan/sensor/angle", head + struct.pack("<f", 77.0))
        time.sleep(0.01)
    with pytest.raises(WorldError, match="the robot 'pan' has left the network"):
        world.sense("angle", (), 0.0)
    answer = thief.declare_queryable("pan/about", lambda q: q.reply("pan/about", json.dumps(ABOUT)))
    with pytest.raises(WorldError, match="does not prove that it has the key"):
        world.reset(0)
    answer.undeclare()
    thief.close()
    returned = ForeignRobot(at, alive=False)
    world.reset(0)
    assert float(world.sense("angle", (), 0.0)) == 0.0
    world.close()
    returned.close()


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"robot": 2}, "is not version 1"),
        ({"name": ""}, "the name of a robot is ''"),
        ({"clock": "fast"}, "pan: the clock is 'fast'"),
        ({"clock": "step"}, "has to answer `begin` and `read`"),
        ({"period": 0}, "the period is 0"),
        ({"sensors": [1]}, "expected signals by name"),
        ({"sensors": {"a": 3}}, "sensors.a: is 3"),
        ({"sensors": {"a": {"shape": [-1]}}}, r"shape is \[-1\]"),
        ({"sensors": {"a": {"unit": 4}}}, "its meaning and unit are text"),
        ({"motors": {"a": {"limits": [3, 1]}}}, "pan a: limits is"),
    ],
)
def test_what_a_robot_says_of_itself_is_checked(changes, message):
    with pytest.raises(WorldError, match=message):
        About.from_text(json.dumps(ABOUT | changes).encode())
    for content in (b"{", b"[]", b"\xff", b'{"robot": NaN}', b" " * 2_000_000):
        with pytest.raises(WorldError, match=r"what a robot says of itself|describes itself in"):
            About.from_text(content)


def test_a_description_is_read_as_it_is_written():
    about = About.of_world(dd.Arena("blocks"), "any", "step")
    again = About.from_text(about.to_text().encode())
    assert again.sensors == about.sensors and again.motors == about.motors
    assert np.isclose(again.period, about.period) and again.repeatable and again.reads
