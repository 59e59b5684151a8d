"""Requests that the studio accepts or refuses."""

from __future__ import annotations

import http.client
import json
import os
import socket
from pathlib import Path
from urllib.parse import urlsplit

import pytest
import websockets
from websockets.sync.client import connect

from deodar.errors import OutputError
from deodar_studio.access import token
from deodar_studio.access.guard import Guard, is_local
from deodar_studio.web.serve import bind
from tests.deodar_studio.page import studio


def get(address: str, path: str = "/", token: bool = True, **headers: str) -> tuple[int, str, dict[str, str]]:
    """Return status, body and headers of a request to a studio, with the token of its address as a cookie."""
    parts = urlsplit(address)
    if token and parts.query:
        headers = {"Cookie": cookie(address), **headers}
    connection = http.client.HTTPConnection(parts.hostname or "", parts.port, timeout=600)
    connection.request(
        "GET", path, headers={name.replace("_", "-"): value for name, value in headers.items()}
    )
    answer = connection.getresponse()
    body = answer.read().decode(errors="replace")
    connection.close()
    return answer.status, body, {k.lower(): v for k, v in answer.getheaders()}


def cookie(address: str) -> str:
    """Return the cookie that a browser stores for an address."""
    parts = urlsplit(address)
    return f"deodar_token_{parts.port}={parts.query.removeprefix('token=')}"


def socket_status(address: str, path: str = "/ws", token: bool = True, **headers: str) -> int:
    """Return 101 if the socket opens, else the status of the refusal."""
    parts = urlsplit(address)
    if token and parts.query:
        headers = {"Cookie": cookie(address), **headers}
    origin = headers.pop("Origin", None)
    try:
        with connect(f"ws://{parts.netloc}{path}", additional_headers=headers, origin=origin) as socket:  # type: ignore[arg-type]
            assert json.loads(socket.recv(timeout=600))["type"] == "welcome"
            return 101
    except websockets.InvalidStatus as error:
        return error.response.status_code


def test_addresses_of_this_machine_are_local() -> None:
    assert all(is_local(h) for h in ("localhost", "127.0.0.1", "127.8.0.1", "::1"))
    assert not any(
        is_local(h) for h in ("0.0.0.0", "192.168.0.2", "example.org", "localhost.example.org", "")
    )


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
        assert socket_status(address, Origin=f"http://localhost:{port}") == 403, (
            "another origin than the one it was called by"
        )


@pytest.mark.parametrize("host", ["127.0.0.1", "localhost", "0.0.0.0"])
def test_every_request_needs_the_token(root: Path, host: str) -> None:
    """Also on this machine, because other users share it."""
    with studio(root, host=host) as address:
        token = urlsplit(address).query.removeprefix("token=")
        port = urlsplit(address).port
        local = f"http://127.0.0.1:{port}/"
        assert len(token) == 32
        for path in ("/", "/ws", "/examples/selection.png", "/assets/index.js", "/favicon.svg", "/nothing"):
            assert get(local, path)[0] == 401, path
            assert get(local, f"{path}?token=wrong")[0] == 401
            assert get(local, path, Cookie=f"deodar_token_{port}=wrong")[0] == 401
            assert get(local, path, Cookie=f"deodar_token={token}")[0] == 401, (
                "the name without the port is not the cookie of this studio"
            )
        assert socket_status(local) in (401, 403)
        assert socket_status(local, "/ws?token=wrong") in (401, 403)
        assert socket_status(local, f"/ws?token={token}") == 101
        status, _, headers = get(local, f"/?token={token}")
        assert status == 303 and headers["location"] == "./", "the token does not stay in the address"
        assert headers["referrer-policy"] == "no-referrer" and headers["cache-control"] == "no-store"
        given = headers["set-cookie"]
        assert (
            given.startswith(f"deodar_token_{port}={token};")
            and "httponly" in given.lower()
            and "samesite=strict" in given.lower()
        )
        mine = given.split(";")[0]
        assert get(local, "/examples/selection.png", Cookie=mine)[0] == 200
        assert get(local, f"/examples/selection.png?token={token}")[0] == 200
        assert socket_status(local, Cookie=mine) == 101
        assert get(local, Host="evil.example", Cookie=mine)[0] == 403


def test_a_browser_from_another_site_gets_a_page_without_a_redirect(root: Path) -> None:
    """The browser would not send the strict cookie after a redirect."""
    with studio(root) as address:
        path = f"/?{urlsplit(address).query}"
        status, body, headers = get(address, path, token=False, Sec_Fetch_Site="cross-site")
        assert status == 200 and 'url=./"' in body and "deodar_token" in headers["set-cookie"]
        assert get(address, path, token=False, Sec_Fetch_Site="none")[0] == 303


def test_a_user_without_the_token_is_asked_for_it(root: Path) -> None:
    with studio(root) as address:
        status, body, headers = get(address, token=False, Accept="text/html,*/*")
        assert (
            status == 401
            and '<input name="token"' in body
            and "form-action 'self'" in headers["content-security-policy"]
        )
        token = urlsplit(address).query.removeprefix("token=")
        assert token not in body


def test_the_environment_states_the_token(root: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    token = "a-Token_of_32_letters_and_digits"
    monkeypatch.setenv("DEODAR_TOKEN", token)
    for host in ("127.0.0.1", "0.0.0.0"):
        with studio(root, host=host) as address:
            assert urlsplit(address).query == f"token={token}"
    monkeypatch.setenv("DEODAR_TOKEN", "short")
    with pytest.raises(OutputError, match="DEODAR_TOKEN is no token of 32 letters"), studio(root):
        pass


def test_no_token_accepts_every_connection(root: Path) -> None:
    with studio(root, token=False) as address:
        assert not urlsplit(address).query
        assert get(address, "/examples/selection.png")[0] == 200 and socket_status(address) == 101
        assert get(address, "/examples/selection.png", Host="evil.example")[0] == 403


def test_studios_at_different_ports_have_different_cookies(root: Path) -> None:
    with studio(root) as one, studio(root) as other:
        both = f"{cookie(one)}; {cookie(other)}"
        for address in (one, other):
            assert get(address, "/examples/selection.png", Cookie=both)[0] == 200
        assert get(one, "/examples/selection.png", Cookie=cookie(other))[0] == 401


def test_a_restart_at_the_same_port_keeps_the_token_on_this_machine_only(root: Path, own_state: Path) -> None:
    with studio(root) as first:
        port = urlsplit(first).port or 0
    file = own_state / "tokens" / str(port)
    assert file.stat().st_mode & 0o777 == 0o600
    with studio(root, port=port) as second:
        assert second == first
    with studio(root, host="0.0.0.0", port=port) as third:
        assert urlsplit(third).query != urlsplit(first).query


@pytest.mark.parametrize("spoilt", ["readable", "link", "pipe", "short", "folder"])
def test_a_token_file_that_others_can_read_is_not_used(tmp_path: Path, spoilt: str) -> None:
    first = token.kept(tmp_path, 8430)
    assert token.kept(tmp_path, 8430) == first != token.kept(tmp_path, 8431)
    file = tmp_path / "tokens" / "8430"
    match spoilt:
        case "readable":
            file.chmod(0o644)
        case "short":
            file.write_text("short")
        case "link":
            file.rename(tmp_path / "elsewhere")
            file.symlink_to(tmp_path / "elsewhere")
        case "pipe":
            file.unlink()
            os.mkfifo(file)
        case _:
            file.unlink()
            file.mkdir()
    second = token.kept(tmp_path, 8430)
    assert second != first and len(second) == 32
    if spoilt != "folder":
        assert token.kept(tmp_path, 8430) == second


def test_tokens_of_ports_that_are_no_longer_used_are_removed(tmp_path: Path) -> None:
    token.kept(tmp_path, 1)
    os.utime(tmp_path / "tokens" / "1", (0, 0))
    token.kept(tmp_path, 2)
    assert [path.name for path in (tmp_path / "tokens").iterdir()] == ["2"]


def test_answers_forbid_frames_and_foreign_scripts(root: Path) -> None:
    with studio(root) as address:
        _, _, headers = get(address, "/examples/selection.png")
        assert (
            "default-src 'self'" in headers["content-security-policy"]
            and headers["x-content-type-options"] == "nosniff"
        )


@pytest.mark.parametrize(
    "path",
    ["/../pyproject.toml", "/..%2f..%2fapp.py", "/assets/../../app.py", "/examples/..%2fmake.py", "/app.py"],
)
def test_only_files_of_the_page_are_served(root: Path, path: str) -> None:
    with studio(root) as address:
        assert get(address, path)[0] == 404


def test_an_invalid_host_header_is_refused() -> None:
    guard = Guard(None, "127.0.0.1", 80, "")  # type: ignore[arg-type]
    for host in ("", "[", "a:b:c", "127.0.0.1:notaport"):
        assert guard._wrong({"host": host})[0] == 403  # pyright: ignore[reportPrivateUsage]


def test_an_unknown_path_is_status_404_without_a_redirect(root: Path) -> None:
    """It is not an error of the server, nor a redirect to another host."""
    with studio(root) as address:
        for folder in ("/", "/assets/", "/examples/", "//"):
            for name in ("a" * 5000, "%00", "evil.example", "evil.example/", "%ff", "%2f%2fevil.example"):
                status, _, headers = get(address, folder + name)
                assert status == 404 and "location" not in headers, folder + name[:20]
                assert get(address, f"{folder}{name}?{urlsplit(address).query}", token=False)[0] == 404


def test_an_invalid_origin_is_refused(root: Path) -> None:
    with studio(root) as address:
        for origin in (
            "http://[",
            "http://[::1",
            "null",
            "",
            "http://a b",
            "\xff",
            "http://127.0.0.1:99999999",
            "://",
            "javascript:0",
        ):
            assert get(address, Origin=origin)[0] in (400, 403), origin


def test_small_packets_are_sent_without_delay() -> None:
    """The event loop disables Nagle's algorithm only for sockets declared as TCP; with it every frame
    takes 40 ms.
    """
    with bind("127.0.0.1", 0) as bound:
        assert bound.proto == socket.IPPROTO_TCP
