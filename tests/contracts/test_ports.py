"""A process without the keys of the user tries every port that a command opens, and gets nothing."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import psutil
import pytest

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
            seen = psutil.Process(process.pid)
            listening = [
                connection.laddr
                for member in (seen, *seen.children(recursive=True))
                for connection in member.net_connections("inet")
                if connection.status == "LISTEN"
            ]
            assert listening and {place.ip for place in listening} == {"127.0.0.1"}
            for place in listening:
                for user in USERS:
                    assert heard_at(place.port, user, tmp_path) == "[]\n"
        finally:
            process.send_signal(signal.SIGTERM)
            process.communicate()


def heard_at(port: int, user: int, folder: Path) -> str:
    """Return what a stranger heard at a port."""
    home = folder / "empty"
    home.mkdir(exist_ok=True)
    environment = {name: text for name, text in os.environ.items() if not name.startswith("DEODAR")}
    ran = subprocess.run(
        [sys.executable, "-c", STRANGER, str(port), str(user)],
        env=environment | {"HOME": str(home), "XDG_STATE_HOME": str(home)},
        capture_output=True,
        text=True,
        timeout=120,
    )
    assert ran.returncode == 0, ran.stderr
    return ran.stdout
