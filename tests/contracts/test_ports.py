"""A process without the keys of the user tries every port that a command opens, and gets nothing."""

from __future__ import annotations

import contextlib
import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Generator
from pathlib import Path

import psutil
import pytest

from deodar.compiler.proven_link import MARK, NONCE, PROOF
from tests import host_devices
from tests.deodar.compiler.meeting import free_port

STRANGER = """
import encodings.idna, http.client, json, os, sys  # a user without these folders cannot import later
import zenoh

if sys.argv[2] != "0":
    os.setgroups([])
    os.setuid(int(sys.argv[2]))
port = int(sys.argv[1])
heard = []
for mode in ("peer", "client"):
    for login in ({}, {"user": "deodar", "password": "x" * 32}):
        settings = {"mode": mode, "connect/endpoints": [f"tcp/127.0.0.1:{port}"], "listen/endpoints": []}
        settings |= {"scouting/multicast/enabled": False, "connect/timeout_ms": 700}
        settings |= {"connect/exit_on_failure": True}
        settings |= {f"transport/auth/usrpwd/{name}": text for name, text in login.items()}
        config = zenoh.Config()
        for name, value in settings.items():
            config.insert_json5(name, json.dumps(value))
        try:
            with zenoh.open(config) as session:
                replies = session.get("**", timeout=0.5)
                heard.append("zenoh " + str([bytes(r.ok.payload) for r in replies if r.ok]))
        except zenoh.ZError:
            pass
upgrade = {"Upgrade": "websocket", "Connection": "Upgrade", "Sec-WebSocket-Version": "13"}
upgrade["Sec-WebSocket-Key"] = "dGhlIHNhbXBsZSBub25jZQ=="
for path, headers in (("/", {}), ("/ws", upgrade), ("/ws?token=" + "x" * 32, upgrade), ("/favicon.svg", {})):
    link = http.client.HTTPConnection("127.0.0.1", port, timeout=5)
    try:
        link.request("GET", path, headers=headers)
        status = link.getresponse().status
        if status not in (401, 403):
            heard.append(f"{path} {status}")
    except (OSError, http.client.HTTPException):
        pass
    link.close()
print(heard)
"""

STRANGER_OF_HOSTS = """
import encodings.idna, json, os, socket, struct, sys
from jax._src.lib import _jax

if sys.argv[2] != "0":
    os.setgroups([])
    os.setuid(int(sys.argv[2]))
place = ("127.0.0.1", int(sys.argv[1]))
hello = {"host": 1, "about": {"hosts": 2}}
first_messages = [b"", json.dumps(hello).encode() + b"\\n", struct.pack(">I", 1) + b"x" * 64]
first_messages.append(struct.pack("<q", 1))
heard = []
for said in first_messages:
    words = b""
    try:
        with socket.create_connection(place, 1.0) as link:
            link.sendall(said)
            while part := link.recv(1000):
                words += part
    except OSError:
        pass
    heard.append(words.hex())
try:
    place = "127.0.0.1:" + sys.argv[1]
    ignored = {"missed_heartbeat_callback": lambda *_: None}  # else JAX ends this process
    client = _jax.get_distributed_runtime_client(place, 1, init_timeout=2, **ignored)
    client.connect()
    heard.append("JAX")
except Exception:
    heard.append("")
print(json.dumps(heard))
"""

JOINED = """
import sys, deodar as dd
dd.join_hosts("127.0.0.1:" + sys.argv[2], 2, int(sys.argv[1]), timeout=200)
print("joined", flush=True)
sys.stdin.readline()
data = dd.simulate(dd.load("example:selection"), 5, trials=2, on=dd.Resources(devices="all"))
print(float(data["u.activation"].sum()) if "u.activation" in data else sorted(data.data_vars))
"""

USERS = [0, 65534] if sys.platform != "win32" and os.geteuid() == 0 else [0]
"""Users that a stranger is: this one with an empty home folder, and another one where that can be."""

COMMANDS = {
    "serve": ["serve", "arena:blocks", "--at", "tcp/127.0.0.1:0", "--clock", "live"],
    "studio": ["studio", "--no-browser", "--port", "0"],
}


@pytest.mark.parametrize("command", COMMANDS)
def test_a_process_without_the_keys_gets_nothing_at_any_port(command: str, tmp_path: Path) -> None:
    words = list(COMMANDS[command])
    if command == "serve":
        from deodar_robots.zenoh.served_world import free_endpoint

        words[3] = free_endpoint()
    with subprocess.Popen(
        [sys.executable, "-m", "deodar", *words],
        stdout=subprocess.PIPE,
        text=True,
        cwd=tmp_path,
        env=os.environ | {"DEODAR_STATE": str(tmp_path / "state")},
    ) as process:
        try:
            assert process.stdout is not None and process.stdout.readline()
            places = listening(process.pid)
            assert places and {ip for ip, _ in places} == {"127.0.0.1"}
            for _, port in places:
                for user in USERS:
                    assert heard_at(port, user, tmp_path, STRANGER) == "[]\n"
        finally:
            process.send_signal(signal.SIGTERM)
            process.communicate()


def heard_at(port: int, user: int, folder: Path, script: str) -> str:
    """Return what a stranger heard at a port."""
    home = folder / "empty"
    home.mkdir(exist_ok=True)
    environment = {name: text for name, text in os.environ.items() if not name.startswith("DEODAR")}
    ran = subprocess.run(
        [sys.executable, "-c", script, str(port), str(user)],
        env=environment | {"HOME": str(home), "XDG_STATE_HOME": str(home)},
        capture_output=True,
        text=True,
        timeout=120,
    )
    assert ran.returncode == 0, ran.stderr
    return ran.stdout


def test_a_process_without_the_key_gets_nothing_at_any_port_of_joined_hosts(tmp_path: Path) -> None:
    """Before all hosts have come the first one listens; afterwards only Gloo of each host does, shut."""
    port = free_port()
    with joining(0, port, tmp_path) as first:
        until = time.monotonic() + 120
        while not (waiting := listening(first.pid)) and time.monotonic() < until:
            time.sleep(0.1)
        assert waiting == {("127.0.0.1", int(port))}
        for user in USERS:
            require_nothing(STRANGER_OF_HOSTS, int(port), user, tmp_path)
        with joining(1, port, tmp_path) as second:
            for process in (first, second):
                assert process.stdout is not None and process.stdout.readline() == "joined\n"
                [(ip, gloo)] = listening(process.pid)
                assert ip == "127.0.0.1"
                for user in USERS:
                    require_nothing(STRANGER_OF_HOSTS, gloo, user, tmp_path)
            for process in (first, second):  # both compute together
                assert process.stdin is not None
                process.stdin.write("\n")
                process.stdin.flush()
            texts = [process.communicate(timeout=100)[0] for process in (first, second)]
    assert texts[0] == texts[1] and texts[0], "other programs have changed nothing"


def require_nothing(script: str, port: int, user: int, folder: Path) -> None:
    """Let a stranger try a port: it receives at most a nonce, and that its proof is refused."""
    for words in json.loads(heard_at(port, user, folder, script)):
        heard = bytes.fromhex(words)
        assert not heard or heard.startswith(MARK)
        assert heard[len(MARK) + NONCE :] in (b"", bytes(PROOF))


@contextlib.contextmanager
def joining(host: int, port: str, folder: Path) -> Generator[subprocess.Popen[str]]:
    """Start a host, which joins another one and waits."""
    environment = {"DEODAR_STATE": str(folder / "state"), "XLA_FLAGS": host_devices.flags(1), "NPROC": "1"}
    process = subprocess.Popen(
        [sys.executable, "-c", JOINED, str(host), port],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
        env=os.environ | environment,
    )
    try:
        yield process
    finally:
        process.kill()
        process.communicate()


def listening(pid: int) -> set[tuple[str, int]]:
    """Return where a process and its children listen."""
    seen = psutil.Process(pid)
    return {
        (connection.laddr.ip, connection.laddr.port)
        for member in (seen, *seen.children(recursive=True))
        for connection in member.net_connections("inet")
        if connection.status == "LISTEN"
    }
