"""Hosts meet if they have one key; a program without it gets nothing, and delays no host."""

from __future__ import annotations

import contextlib
import socket
import struct
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from deodar.compiler import host_meeting
from deodar.compiler.host_key import HOSTS_KEY, hosts_key
from deodar.compiler.host_link import HostLinks
from deodar.compiler.host_meeting import Reception, meet
from deodar.compiler.proven_link import MARK, NONCE, OtherKey, ProvenLink, to_first_host
from deodar.errors import HostsError
from deodar.user_key import UserKey
from tests.deodar.compiler.meeting import free_port, reached, until_end

OPENING = len(MARK) + NONCE
"""Bytes that the first host says to everybody: its nonce."""


@pytest.fixture(autouse=True)
def states(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Let the hosts of a test have a key of their own."""
    monkeypatch.delenv(HOSTS_KEY, raising=False)
    monkeypatch.setenv("DEODAR_STATE", str(tmp_path / "state"))


@pytest.fixture
def address() -> str:
    return f"127.0.0.1:{free_port()}"


class Meeting:
    """Hosts that meet, each in a thread."""

    def __init__(self, address: str, count: int, seconds: float = 20.0) -> None:
        self.address, self.count, self.seconds = address, count, seconds
        self.links = dict[int, HostLinks]()
        self.errors = dict[int, str]()
        self._threads = list[threading.Thread]()

    def start(self, *hosts: int, count: int = 0) -> None:
        """Start hosts; one may suppose another count."""
        for k in hosts:
            thread = threading.Thread(target=self._host, args=(k, count or self.count))
            self._threads.append(thread)
            thread.start()

    def end(self) -> None:
        """Wait until all have met, or have given up."""
        for thread in self._threads:
            thread.join()
        for links in self.links.values():
            links.close()

    def _host(self, k: int, count: int) -> None:
        try:
            self.links[k] = meet(self.address, count, k, self.seconds)
        except HostsError as error:
            self.errors[k] = str(error)


def proven(link: socket.socket, host: int) -> ProvenLink:
    """Return the link of a host that proves the key."""
    return to_first_host(link, hosts_key(), host, 10.0)


def reset(link: socket.socket) -> None:
    """End a connection without a word."""
    link.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
    link.close()


def test_a_host_that_does_not_come_is_named(address: str) -> None:
    with pytest.raises(HostsError, match=r"host 1, 2 has not come within 0.3 s\. Start the same script"):
        meet(address, 3, 0, 0.3)
    with pytest.raises(HostsError, match=f"the first host cannot be reached at {address} within 0.3 s"):
        meet(address, 3, 2, 0.3)


def test_a_host_that_has_come_hears_who_has_not(address: str) -> None:
    meeting = Meeting(address, 3, 3.0)
    meeting.start(0, 1)
    meeting.end()
    assert sorted(meeting.errors) == [0, 1]
    assert all(text.startswith("host 2 has not come within 3 s") for text in meeting.errors.values())


def silent(link: socket.socket) -> None:
    pass


def words(link: socket.socket) -> None:
    link.sendall(b'{"host": 1, "about": {}}\n' * 10)


def zeros(link: socket.socket) -> None:
    link.sendall(bytes(1000))


@pytest.mark.parametrize("says", [silent, words, zeros])
def test_a_stranger_gets_a_nonce_alone_and_the_hosts_meet(
    says: Callable[[socket.socket], None], address: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(host_meeting, "HELLO_SECONDS", 1.0)
    meeting = Meeting(address, 2)
    meeting.start(0)
    with reached(address) as stranger:
        says(stranger)
        heard = until_end(stranger)
    meeting.start(1)
    meeting.end()
    assert sorted(meeting.links) == [0, 1], meeting.errors
    assert heard.startswith(MARK) and heard[OPENING:].strip(b"\0") == b""


def test_programs_that_say_nothing_delay_no_host(address: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(host_meeting, "HELLO_SECONDS", 600.0)
    meeting = Meeting(address, 3, 60.0)
    meeting.start(0)
    with contextlib.ExitStack() as connections:
        for _ in range(host_meeting.CALLERS - 3):
            connections.enter_context(reached(address))
        reset(reached(address))
        meeting.start(1, 2)
        meeting.end()
    assert sorted(meeting.links) == [0, 1, 2], meeting.errors


def test_connections_beyond_the_most_are_closed(address: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(host_meeting, "CALLERS", 1)
    monkeypatch.setattr(host_meeting, "HELLO_SECONDS", 2.0)
    meeting = Meeting(address, 2)
    meeting.start(0)
    with reached(address) as first, reached(address) as second:
        assert first.recv(1000).startswith(MARK)
        assert until_end(second) == b""
    meeting.start(1)
    meeting.end()
    assert sorted(meeting.links) == [0, 1], meeting.errors


def test_a_host_with_another_key_is_told_and_the_first_host_names_it(
    address: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    meeting = Meeting(address, 2, 4.0)
    first_key = hosts_key().path
    meeting.start(0)
    reached(address).close()
    other_key = UserKey.at(tmp_path / "other").path
    monkeypatch.setenv(HOSTS_KEY, str(other_key))
    meeting.start(1)
    meeting.end()
    assert meeting.errors[1].startswith(
        f"{other_key}: what listens at {address} does not have the key of host 1. Copy this file of host 0"
    )
    assert "host 1 has not come within 4 s; at 127.0.0.1:" in meeting.errors[0]
    assert (
        f"host 1, and has another key. If that address is of host 1, copy {first_key} to it, readable by you"
        in meeting.errors[0]
    )
    assert "otherwise another program calls this port" in meeting.errors[0]


def test_who_states_a_number_of_no_host_is_not_stored(tmp_path: Path) -> None:
    reception, other_key = Reception(hosts_key(), 2), UserKey.at(tmp_path / "other")
    for host in (1, 2, 2**32 - 1):
        first, caller = socket.socketpair()
        thread = threading.Thread(target=reception.hear, args=(first, f"node{host}"))
        thread.start()
        with caller, pytest.raises(OtherKey):
            to_first_host(caller, other_key, host, 10.0)
        thread.join()
    assert reception.others == {1: "node1"}


def test_localhost_is_the_address_at_which_the_first_host_listens(
    address: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The name may be that of ::1, too, where another program may have the port."""
    called, look_up = list[object](), socket.getaddrinfo

    def noted(host: str, *port: Any, **options: Any) -> Any:
        called.append(host)
        return look_up(host, *port, **options)

    monkeypatch.setattr(socket, "getaddrinfo", noted)
    meeting = Meeting(address.replace("127.0.0.1", "localhost"), 2)
    meeting.start(0, 1)
    meeting.end()
    assert sorted(meeting.links) == [0, 1], meeting.errors
    assert set(called) == {"127.0.0.1"}


def test_a_program_that_has_taken_the_port_cannot_pose_as_the_first_host(address: str) -> None:
    """It answers the proof of host 1 with what it has heard from it."""
    host, _, port = address.partition(":")
    with socket.create_server((host, int(port))) as server:
        meeting = Meeting(address, 2, 5.0)
        meeting.start(1)
        link, _ = server.accept()
        with link:
            link.sendall(MARK + bytes(NONCE))
            link.sendall(link.recv(1000)[-32:])
            meeting.end()
    assert "does not have the key of host 1" in meeting.errors[1]


@pytest.mark.parametrize("resets", [True, False])
def test_a_host_that_ends_while_it_waits_may_be_started_again(resets: bool, address: str) -> None:
    meeting = Meeting(address, 3)
    meeting.start(0)
    greeting = b'{"hosts": 3, ' + host_meeting.codec.line(host_meeting._versions()).encode()[1:]  # pyright: ignore
    link = reached(address)
    proven(link, 1).send(greeting)
    time.sleep(4 * host_meeting.POLL)
    with reached(address) as second:  # refused, because host 1 still waits
        waiting = proven(second, 1)
        waiting.send(greeting)
        assert b"host 1 is not one of 3, or has come already" in waiting.receive(10.0)
    if resets:
        reset(link)
    link.close()
    meeting.start(1, 2)
    meeting.end()
    assert sorted(meeting.links) == [0, 1, 2], meeting.errors


def test_hosts_that_differ_are_refused(address: str) -> None:
    meeting = Meeting(address, 2, 10.0)
    meeting.start(0)
    meeting.start(1, count=3)
    meeting.end()
    assert len(meeting.errors) == 2
    assert all("host 1 differs from host 0: {'hosts': 3" in text for text in meeting.errors.values())


@pytest.mark.parametrize(
    ("host", "listens"),
    [("127.0.0.1", "127.0.0.1"), ("localhost", "127.0.0.1"), ("[::1]", "::1"), ("node1", "::")],
)
def test_hosts_of_one_machine_listen_where_other_machines_do_not_reach_them(host: str, listens: str) -> None:
    with host_meeting._opened(0, 1, host) as server:  # pyright: ignore[reportPrivateUsage]
        assert server.getsockname()[0] in (listens, {"::": "0.0.0.0"}.get(listens))
