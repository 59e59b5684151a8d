"""A robot on this machine obeys its user alone, and numbers that jump are refused and told."""

from __future__ import annotations

import json
import os
import socket
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from deodar.errors import RunWarning, WorldError
from deodar_robots.zenoh import link, port_key
from deodar_robots.zenoh.about import WireMessage, key
from deodar_robots.zenoh.inboxes import AHEAD, CommandInbox
from deodar_robots.zenoh.served_world import ServedWorld
from deodar_robots.zenoh.zenoh import Zenoh
from tests.command_line import typed
from tests.deodar_robots.zenoh.relay import Relay
from tests.deodar_robots.zenoh.wheel import Wheel

STRANGER = """
import json, os, struct, sys
import zenoh

if sys.argv[3] != "0":
    os.setgroups([])
    os.setuid(int(sys.argv[3]))
HEADER = struct.Struct("<4sBBHQdQQQ")
for mode in ("peer", "client"):
    for login in ({}, {"user": "deodar", "password": "x" * 32}):
        settings = {"mode": mode, "connect/endpoints": [sys.argv[1]], "scouting/multicast/enabled": False}
        settings |= {"listen/endpoints": [], "connect/timeout_ms": 700, "connect/exit_on_failure": True}
        settings |= {f"transport/auth/usrpwd/{name}": text for name, text in login.items()}
        config = zenoh.Config()
        for name, value in settings.items():
            config.insert_json5(name, json.dumps(value))
        try:
            session = zenoh.open(config)
        except zenoh.ZError:
            print("refused")
            continue
        print([bytes(reply.ok.payload) for reply in session.get("**", timeout=0.5) if reply.ok])
        for number in (1, 2**63):
            raw = HEADER.pack(b"DDR1", 0, 0, 1, number, 0.0, 0, 0, int(sys.argv[2])) + struct.pack("<f", 9.0)
            session.put("robot/motor/speed", raw)
            session.put("robot/step", raw)
        session.close()
"""


@pytest.fixture
def wheel():
    return Wheel()


@pytest.fixture
def robot(wheel: Wheel):
    served = ServedWorld(wheel, "robot", "live")
    yield served
    served.close()


@pytest.fixture
def world(robot: ServedWorld):
    model_world = Zenoh(at=robot.endpoint, patience=5.0)
    model_world.reset(0)
    yield model_world
    model_world.close()


def file_of(robot: ServedWorld) -> Path:
    return port_key.path_of("127.0.0.1", int(robot.endpoint.rpartition(":")[2]))


@pytest.mark.parametrize("user", [0, 65534] if sys.platform != "win32" and os.geteuid() == 0 else [0])
def test_a_process_without_the_key_gets_nothing_and_moves_nothing(wheel, robot, world, tmp_path, user):
    environment = {name: text for name, text in os.environ.items() if name != "DEODAR_STATE"}
    ran = subprocess.run(
        [sys.executable, "-c", STRANGER, robot.endpoint, str(world._commander), str(user)],
        env=environment | {"HOME": str(tmp_path), "XDG_STATE_HOME": str(tmp_path)},
        capture_output=True,
        text=True,
        timeout=60,
    )
    assert ran.stdout.split("\n") == ["refused"] * 4 + [""], ran.stderr
    assert wheel.angle == 0 and not robot.server.counts


def test_the_key_is_a_file_of_the_user_and_each_port_has_another_one(robot):
    file = file_of(robot)
    assert file.stat().st_mode & 0o777 == 0o600 or sys.platform == "win32"
    port = link.credentials(robot.endpoint)
    assert port.path == file and port.password not in repr(port)
    assert link.credentials(robot.endpoint.replace("127.0.0.1", "localhost")) == port
    assert port_key.path_of("[::1]", 7461) != port_key.path_of("127.0.0.1", 7461)
    assert port_key.path_of("127.0.0.1", 7462) != port_key.path_of("127.0.0.1", 7461)


def test_a_command_prints_the_path_of_the_key_for_a_robot_without_deodar(robot):
    printed = typed("robots key", robot.endpoint)
    assert printed.status == 0 and printed.out == f"{file_of(robot)}\n"
    assert json.loads(typed("robots key", robot.endpoint, "--json").out) == {"key": str(file_of(robot))}
    assert "proves itself by certificates" in typed("robots key tls/127.0.0.1:7461").err
    assert "leads beyond this machine" in typed("robots key tcp/robot.lab:7461").err
    assert typed("robots key").status == 2


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no modes of files")
def test_a_key_that_others_can_read_is_refused(robot):
    file_of(robot).chmod(0o644)
    with pytest.raises(
        WorldError, match=r"cannot be used as the key .*others can access it.*type: chmod 600 "
    ):
        Zenoh(at=robot.endpoint)
    file_of(robot).chmod(0o600)
    file_of(robot).write_text("short")
    with pytest.raises(WorldError, match="does not hold deodar: and a password"):
        Zenoh(at=robot.endpoint)
    file_of(robot).unlink()  # the port may be that of another robot later


def test_a_model_with_another_key_is_told_which_file_it_used(robot):
    file_of(robot).unlink()
    with pytest.raises(WorldError, match=r"no robot answers at .* with the key of this port, .*robots"):
        Zenoh(at=robot.endpoint)


def test_a_program_that_took_the_port_cannot_show_readings():
    """It lets everybody in, as a listener of its own make would, and describes itself as a robot."""
    robot = ServedWorld(Wheel(), "robot")
    stolen_port = link.credentials(robot.endpoint)
    robot.close()
    session = link.listen(robot.endpoint, stolen_port)
    description = robot.server.about.to_text()
    for proof in (None, b"x" * 32, stolen_port.proof(b"another challenge")):
        answer = session.declare_queryable(
            "robot/about", lambda q, proof=proof: q.reply("robot/about", description, attachment=proof)
        )
        with pytest.raises(WorldError, match="does not prove that it has the key"):
            Zenoh(at=robot.endpoint)
        answer.undeclare()
    session.close()


def test_every_process_that_is_trusted_needs_no_key():
    served = ServedWorld(Wheel(), "robot", trusted=True)
    world = Zenoh(at=served.endpoint, trusted=True)
    assert world.robot == "robot" and not file_of(served).exists()
    world.close()
    served.close()


def test_forged_replayed_and_jumping_commands_move_no_motor(wheel, robot, world):
    """1,000 tries: bytes of a true link sent again, and messages of a program that has the key."""
    relay = Relay(robot.endpoint)
    with link.connect(f"tcp/127.0.0.1:{relay.port}", 2.0, link.credentials(robot.endpoint)) as stranger:
        motor, number = key("robot", "motor", "speed"), world._commander
        raws = [WireMessage(np.float32(9), n, commander=number + 1).to_bytes() for n in range(200)]
        raws += [WireMessage(np.float32(9), 2**63 + n, commander=number).to_bytes() for n in range(300)]
        raws += [WireMessage(np.float32(9), 10**6 * n, commander=number).to_bytes() for n in range(1, 201)]
        for raw in raws:
            stranger.put(motor, raw)
        stranger.put(key("robot", "halt"), raws[300])
        stranger.put(key("robot", "step"), raws[300])
        until(lambda: robot.server.counts["jump"] == 502)
        assert robot.server.counts == {"foreign": 200, "jump": 502}
    relay.close()
    host, port = "127.0.0.1", int(robot.endpoint.rpartition(":")[2])
    recorded = bytes(relay.seen)
    for _ in range(300):
        with socket.create_connection((host, port)) as connection:
            connection.sendall(recorded)
    assert wheel.angle == 0
    with pytest.warns(RunWarning, match=r"has refused 702 messages so far: 200 of another .*; 502 .* jumps"):
        world.act({"speed": np.ones(1, np.float32)}, 0.0)
    until(lambda: wheel.angle > 0)
    assert robot.server.counts == {"foreign": 200, "jump": 502, "accepted": 1}
    assert world.link().refused == 702


def test_a_number_is_followed_within_a_window_that_grows_while_nothing_comes(monkeypatch):
    moment = [0.0]
    monkeypatch.setattr(time, "monotonic", lambda: moment[0])
    inbox = CommandInbox(Wheel.motors, period=10.0)
    inbox.begin(5)

    def offer(number: int) -> str:
        before = dict(inbox.counts)
        inbox.offer("speed", WireMessage(np.float32(1), number, commander=5).to_bytes())
        (changed,) = (k for k, n in inbox.counts.items() if n != before.get(k, 0))
        return changed

    assert [offer(n) for n in (1, 1 + AHEAD, 2 + 2 * AHEAD)] == ["accepted", "accepted", "jump"]
    assert offer(2 + AHEAD) == "accepted", "what came before is still followed"
    moment[0] = 60.0
    assert offer(6000) == "accepted", "messages of a minute were lost"
    assert inbox.refusals() == {"jump": 1}
    inbox.begin(5)
    assert inbox.refusals() == {}


def until(holds, seconds: float = 10.0) -> None:
    """Wait until a function returns true."""
    limit = time.monotonic() + seconds
    while not holds():
        assert time.monotonic() < limit
        time.sleep(0.005)
