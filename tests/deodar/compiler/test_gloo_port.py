"""The port of Gloo passes hosts alone: connections come while it is open, and both ends are compared."""

from __future__ import annotations

import os
import socket
import sys
from collections.abc import Generator

import pytest

from deodar.compiler import gloo_port
from deodar.compiler.gloo_port import GlooPort


@pytest.fixture
def listener() -> Generator[socket.socket]:
    with socket.create_server(("127.0.0.1", 0)) as server:
        yield server


def test_nobody_connects_while_the_port_is_shut(listener: socket.socket) -> None:
    """Systems other than Linux have no filters: there the comparison of the ends alone finds others."""
    port, place = GlooPort(listener), listener.getsockname()
    with port.open(), socket.create_connection(place, 5.0) as early:
        of_early, _ = listener.accept()
        port.shut()
        if sys.platform == "linux":
            with pytest.raises(TimeoutError):
                socket.create_connection(place, 0.5)
        early.sendall(b"it stays")
        assert of_early.recv(10) == b"it stays"
        of_early.close()
    with port.open(), socket.create_connection(place, 5.0):
        listener.accept()[0].close()


def test_the_sockets_of_this_process_are_listed_with_both_ends(listener: socket.socket) -> None:
    listening_end = "127.0.0.1 " + str(listener.getsockname()[1])
    assert listener.fileno() in gloo_port.listeners("127.0.0.1")
    with socket.create_connection(listener.getsockname()) as caller:
        calling_end = "127.0.0.1 " + str(caller.getsockname()[1])
        accepted, _ = listener.accept()
        with accepted:
            assert {caller.fileno(), accepted.fileno()} & gloo_port.listeners("127.0.0.1") == set()
            assert {(listening_end, calling_end), (calling_end, listening_end)} <= set(
                gloo_port.connections()
            )
            assert gloo_port.strangers([listening_end], gloo_port.connections()) == []


@pytest.mark.parametrize("answers", [True, False])
def test_listeners_are_found_also_if_the_system_does_not_say_what_listens(
    answers: bool, listener: socket.socket, monkeypatch: pytest.MonkeyPatch
) -> None:
    if not answers:  # as macOS, which does not know this option
        monkeypatch.setattr(socket, "SO_ACCEPTCONN", 9999)
    place = ("127.0.0.2" if sys.platform == "linux" else "127.0.0.1", 0)
    with socket.create_server(place) as second, socket.socket() as idle, socket.socket() as caller:
        caller.connect(listener.getsockname())
        sockets = {end.fileno() for end in (listener, second, idle, caller)}
        listening = gloo_port.listeners("127.0.0.1") & sockets
        assert listening == {listener.fileno(), *([] if place[0] == "127.0.0.2" else [second.fileno()])}


def test_sockets_that_block_do_so_after_they_are_listed(
    listener: socket.socket,
) -> None:
    """Copies of sockets have the mode of the sockets, which the time limit of a script would change."""
    with socket.socket() as asynchronous:
        asynchronous.setblocking(False)
        socket.setdefaulttimeout(3.0)
        try:
            gloo_port.connections()
            gloo_port.listeners("127.0.0.1")
            gloo_port.copy_of(listener.fileno()).close()
        finally:
            socket.setdefaulttimeout(None)
        assert os.get_blocking(listener.fileno())
        assert not os.get_blocking(asynchronous.fileno())


def test_a_connection_whose_other_end_is_of_no_host_is_a_stranger() -> None:
    first = [("a 1", "b 7"), ("a 1", "c 9"), ("a 5", "x 443")]
    second = [("b 7", "a 1"), ("b 2", "b 8"), ("b 8", "b 2")]
    assert gloo_port.strangers(["a 1", "b 2"], [*first, *second]) == [("a 1", "c 9")]
    assert gloo_port.strangers(["a 1", "b 2"], [first[0], *second]) == []
    text = str(gloo_port.error_of([("a 1", "c 9")]))
    assert text.startswith("a program that is no host has connected with Gloo") and "c 9 with a 1" in text


def test_devices_that_have_not_connected_are_an_error_with_the_ports() -> None:
    text = str(gloo_port.unreached(["a 1", "b 2"], 60.0))
    assert "not connected within 60 s: Gloo listens at a 1, b 2; a firewall hides a port, or" in text


def test_a_host_that_has_connected_with_no_host_is_found() -> None:
    assert gloo_port.strangers(["a 1"], [("b 7", "a 1")]) == [("b 7", "a 1")]


def test_the_connection_of_a_stranger_is_ended_and_others_stay(listener: socket.socket) -> None:
    place = listener.getsockname()
    with socket.create_connection(place) as stranger, socket.create_connection(place) as host:
        of_stranger, of_host = listener.accept()[0], listener.accept()[0]
        with of_stranger, of_host:
            listening_end, calling_end = (f"{a} {b}" for a, b in (place, stranger.getsockname()))
            gloo_port.end([(listening_end, calling_end)])
            assert stranger.recv(1) == b""
            of_host.sendall(b"x")
            assert host.recv(1) == b"x"
