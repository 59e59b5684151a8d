"""Encrypted connections: the run is the same, and certificates that do not fit are named."""

from __future__ import annotations

import json
import shutil
import socket
from pathlib import Path

import numpy as np
import pytest

import deodar as dd
from deodar.errors import WorldError
from deodar.recording.opened import again
from deodar_robots.robot.robot import Robot
from deodar_robots.zenoh import link
from deodar_robots.zenoh.link import TlsFiles
from deodar_robots.zenoh.served_world import ServedWorld, free_endpoint
from deodar_robots.zenoh.zenoh import Zenoh
from tests.command_line import typed
from tests.deodar_robots.zenoh.relay import Relay
from tests.deodar_robots.zenoh.wheel import Wheel

FILES = Path(__file__).parent / "certificates"
AUTHORITY = str(FILES / "authority.pem")


def pair(name: str) -> dict[str, str]:
    """Return the certificate and the private key of a name."""
    return {"certificate": str(FILES / f"{name}.pem"), "private_key": str(FILES / f"{name}.key")}


SERVER = TlsFiles(**pair("robot"))
MUTUAL = TlsFiles(AUTHORITY, **pair("robot"))


@pytest.fixture
def served():
    """Return a function that serves a wheel until the test ends."""
    begun: list[ServedWorld] = []

    def serve(files: TlsFiles = SERVER, scheme: str = "tls") -> str:
        begun.append(ServedWorld(Wheel(), "robot", "step", free_endpoint(scheme), files, scheme == "tcp"))
        return begun[-1].endpoint

    yield serve
    for each in begun:
        each.close()


def angles(world: dd.World) -> np.ndarray:
    model = dd.Model("turning", dt=10)
    model.add(dd.Sensor("see", sensor="angle"))
    model.add(dd.Boost("go", amplitude=2.0)) >> model.add(dd.Motor("turn", motor="speed"))
    session = dd.Session(model, world=world)
    shown: list[float] = []
    for _ in range(20):
        session.run(10)
        shown.append(float(session.read("see")))
    return np.array(shown)


def test_the_run_over_tls_is_that_of_the_world_itself(served):
    world = Zenoh(at=served(), authority=AUTHORITY, patience=5.0)
    np.testing.assert_array_equal(angles(world), angles(Wheel()))
    world.close()


def test_messages_are_not_readable_on_the_way(served):
    """Two sessions over a relay: the bytes of a plain one contain the name of the robot, others do not."""
    for scheme, readable in (("tcp", True), ("tls", False)):
        files = SERVER if scheme == "tls" else link.NO_FILES
        relay = Relay(served(files, scheme))
        secure = {"authority": AUTHORITY} if scheme == "tls" else {}
        # a relay is at another port, which has another key
        Zenoh("robot", f"{scheme}/127.0.0.1:{relay.port}", 5.0, scheme == "tcp", **secure).close()
        relay.close()
        assert (b"robot" in bytes(relay.seen)) == readable and len(relay.seen) > 500


def test_mutual_tls_accepts_a_model_with_a_certificate(served):
    world = Zenoh(at=served(MUTUAL), patience=5.0, authority=AUTHORITY, **pair("model"))
    description = world.describe()
    assert description["certificate"] == str(FILES / "model.pem") and "KEY" not in json.dumps(description)
    world.reset(0)
    world.close()
    opened = again(Zenoh, description)
    assert opened.describe() == description
    opened.close()


@pytest.mark.parametrize(
    ("server", "model", "says"),
    [
        (
            TlsFiles(**pair("robot")),
            {"authority": str(FILES / "other.pem")},
            r"is not signed by .*other\.pem",
        ),
        (TlsFiles(**pair("elsewhere")), {"authority": AUTHORITY}, "is for another name"),
        (SERVER, {}, "needs the authority"),
        (MUTUAL, {"authority": AUTHORITY}, r"asks for a certificate.*certificate=.* and private_key="),
        (MUTUAL, {"authority": AUTHORITY, **pair("stranger")}, r"does not accept the .*stranger\.pem"),
    ],
)
def test_certificates_that_do_not_fit_are_named(served, server, model, says):
    with pytest.raises(WorldError, match=says):
        Zenoh(at=served(server), patience=2.0, **model)


def test_a_side_without_encryption_is_named(served):
    encrypted, plain = served(), served(link.NO_FILES, "tcp")
    with pytest.raises(WorldError, match=r'encrypts what it sends. Write at="tls/127.0.0.1:\d+"'):
        Zenoh(at=encrypted.replace("tls", "tcp"), patience=1.0)
    with pytest.raises(WorldError, match="does not encrypt what it sends"):
        Zenoh(at=plain.replace("tcp", "tls"), authority=AUTHORITY, patience=1.0)
    with socket.create_server(("127.0.0.1", 0)) as silent:
        port = silent.getsockname()[1]
        with pytest.raises(WorldError, match=f"no robot answers at tcp/127.0.0.1:{port}"):
            Zenoh(at=f"tcp/127.0.0.1:{port}")
    with pytest.raises(WorldError, match=r"no robot answers at tls/127.0.0.1:\d+ within 0.5 s"):
        Zenoh(at=free_endpoint("tls"), authority=AUTHORITY)


def test_files_that_are_missing_or_wrong_are_named(tmp_path: Path):
    at = free_endpoint("tls")
    text = tmp_path / "text.pem"
    text.write_text("no certificate")
    with pytest.raises(WorldError, match=r"none\.pem: there is no such file of the authority"):
        Zenoh(at=at, authority="none.pem")
    with pytest.raises(WorldError, match="holds no certificate in PEM form"):
        Zenoh(at=at, authority=text)
    with pytest.raises(WorldError, match=r"uses no certificates. Write tls/127.0.0.1:7461"):
        Zenoh(authority=AUTHORITY)
    with pytest.raises(WorldError, match="the private key is not stated"):
        Zenoh(at=at, authority=AUTHORITY, certificate=FILES / "model.pem")
    key = str(FILES / "robot.key")
    for files, says in (
        (TlsFiles(), "needs a certificate and its private key.*TlsFiles"),
        (TlsFiles(AUTHORITY), "needs a certificate and its private key"),
        (TlsFiles("", str(FILES / "model.pem"), key), r"robot\.key: is not the private key of .*model\.pem"),
        (TlsFiles("", str(text), key), r"is not a private key without a password, for .*text\.pem"),
    ):
        with pytest.raises(WorldError, match=says):
            link.listen(at, files)


def test_another_host_needs_tls_or_trust():
    assert link.require_endpoint("tls/robot.lab:7461", files=TlsFiles(AUTHORITY)) == "tls/robot.lab:7461"
    with pytest.raises(WorldError, match=r"Write tls/robot.lab:7461 and state certificates"):
        link.require_endpoint("tcp/robot.lab:7461")


def test_a_robot_file_names_certificates_in_its_folder(served, tmp_path: Path):
    file = tmp_path / "mine.json"
    shutil.copy(AUTHORITY, tmp_path)
    settings = {"at": served(), "authority": "authority.pem", "patience": 5}
    robot = {"robot": 1, "name": "mine", "kind": "zenoh", "settings": settings}
    file.write_text(json.dumps(robot))
    world = Robot(file)
    world.reset(0)
    world.close()
    file.write_text(json.dumps(robot | {"settings": settings | {"authority": AUTHORITY}}))
    with pytest.raises(WorldError, match="outside the folder of the robot's file"):
        Robot(file)


def test_the_command_line_names_certificates(served):
    world = Zenoh.open(f"robot, at={served()}, patience=5, authority={AUTHORITY}")
    world.close()
    keyless = typed("serve arena:blocks --at tls/127.0.0.1:1 --certificate none.pem")
    assert keyless.status != 0 and "needs a certificate and its private key" in keyless.err
    absent = typed("serve arena:blocks --at tls/0.0.0.0:1 --certificate none.pem --key none.key")
    assert absent.status != 0 and "none.pem: there is no such file of the certificate" in absent.err
