"""Who may talk to the studio."""

from __future__ import annotations

import http.client
import json
import socket
from pathlib import Path
from urllib.parse import urlsplit

import pytest
import websockets
from websockets.sync.client import connect

from deodar.server.guard import Guard, is_local
from deodar.server.serve import bind
from tests.server.page import studio


def get(address: str, path: str = "/", **headers: str) -> tuple[int, str, dict[str, str]]:
    """Status, body and headers of a request to a studio."""
    there = urlsplit(address)
    connection = http.client.HTTPConnection(there.hostname or "", there.port, timeout=30)
    connection.request("GET", path, headers=headers)
    answer = connection.getresponse()
    body = answer.read().decode(errors="replace")
    connection.close()
    return answer.status, body, {k.lower(): v for k, v in answer.getheaders()}


def socket_status(address: str, path: str = "/ws", **headers: str) -> int:
    """101 where the socket opens, else the status of the refusal."""
    there = urlsplit(address)
    origin = headers.pop("Origin", None)
    try:
        with connect(f"ws://{there.netloc}{path}", additional_headers=headers, origin=origin) as socket:  # type: ignore[arg-type]
            assert json.loads(socket.recv(timeout=30))["type"] == "welcome"
            return 101
    except websockets.InvalidStatus as error:
        return error.response.status_code


def test_local_hosts() -> None:
    assert all(is_local(h) for h in ("localhost", "127.0.0.1", "127.8.0.1", "::1"))
    assert not any(is_local(h) for h in ("0.0.0.0", "192.168.0.2", "example.org", "localhost.example.org", ""))


def test_foreign_hosts_and_origins_are_refused(root: Path) -> None:
    with studio(root) as address:
        netloc = urlsplit(address).netloc
        port = netloc.split(":")[1]
        assert get(address, Host="evil.example")[0] == 403
        assert get(address, Host=f"evil.example:{port}")[0] == 403
        assert get(address, Host=f"localhost:{int(port) + 1}")[0] == 403
        assert get(address, Origin="http://evil.example")[0] == 403
        assert get(address, Origin="null")[0] == 403
        assert get(address, Host=f"localhost:{port}")[0] != 403
        assert socket_status(address) == 101
        assert socket_status(address, Origin=f"http://{netloc}") == 101
        assert socket_status(address, Origin="http://evil.example") == 403
        assert socket_status(address, Origin=f"http://localhost:{port}") == 403, "another origin than the one it was called by"


def test_beyond_this_machine_every_request_needs_the_token(root: Path) -> None:
    with studio(root, host="0.0.0.0") as address:
        token = urlsplit(address).query.removeprefix("token=")
        local = f"http://127.0.0.1:{urlsplit(address).port}/"
        assert len(token) > 24
        for path in ("/", "/ws", "/examples/selection.png", "/assets/index.js", "/favicon.svg"):
            assert get(local, path)[0] == 401, path
            assert get(local, f"{path}?token=wrong")[0] == 401
        assert socket_status(local) in (401, 403)
        assert socket_status(local, f"/ws?token={token}") == 101
        status, _, headers = get(local, f"/?token={token}")
        assert status == 303 and headers["location"] == "/", "the token does not stay in the address"
        cookie = headers["set-cookie"].split(";")[0]
        assert "httponly" in headers["set-cookie"].lower() and "samesite=strict" in headers["set-cookie"].lower()
        assert get(local, "/examples/selection.png", Cookie=cookie)[0] == 200
        assert socket_status(local, Cookie=cookie) == 101
        assert get(local, Host="evil.example", Cookie=cookie)[0] == 403


def test_answers_forbid_frames_and_foreign_scripts(root: Path) -> None:
    with studio(root) as address:
        _, _, headers = get(address, "/examples/selection.png")
        assert "default-src 'self'" in headers["content-security-policy"] and headers["x-content-type-options"] == "nosniff"


@pytest.mark.parametrize("path", ["/../pyproject.toml", "/..%2f..%2fapp.py", "/assets/../../app.py", "/examples/..%2fmake.py", "/app.py"])
def test_only_the_page_is_served(root: Path, path: str) -> None:
    with studio(root) as address:
        assert get(address, path)[0] == 404


def test_a_broken_host_header_is_refused() -> None:
    guard = Guard(None, "127.0.0.1", 80, "")  # type: ignore[arg-type]
    for host in ("", "[", "a:b:c", "127.0.0.1:notaport"):
        assert guard._wrong({"host": host})  # pyright: ignore[reportPrivateUsage]


def test_small_packets_do_not_wait_for_each_other() -> None:
    """The event loop switches Nagle's algorithm off only for sockets that say they are TCP; with it every frame takes 40 ms."""
    with bind("127.0.0.1", 0) as bound:
        assert bound.proto == socket.IPPROTO_TCP
