"""A link proves who is at its other end, and that each message is of that side and the next one."""

from __future__ import annotations

import socket
import struct
import threading
from collections.abc import Generator
from pathlib import Path

import pytest

from deodar.compiler.proven_link import MARK, NONCE, PROOF, OtherKey, ProvenLink, to_first_host, to_other_host
from deodar.user_key import UserKey

Pair = tuple[ProvenLink, ProvenLink, socket.socket, socket.socket]


@pytest.fixture
def key(tmp_path: Path) -> UserKey:
    return UserKey.at(tmp_path / "key")


def ends() -> tuple[socket.socket, socket.socket]:
    """Return both ends of a connection of TCP."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        caller = socket.create_connection(server.getsockname())
        return caller, server.accept()[0]


@pytest.fixture
def pair(key: UserKey) -> Generator[Pair]:
    """The links of the first host and of host 3, and their sockets."""
    first, caller = ends()
    answers = list[tuple[int, ProvenLink]]()
    thread = threading.Thread(target=lambda: answers.append(to_other_host(first, key, 10.0)))
    thread.start()
    link_of_third = to_first_host(caller, key, 3, 10.0)
    thread.join()
    [(number, link_of_first)] = answers
    assert number == 3
    yield link_of_first, link_of_third, first, caller
    first.close()
    caller.close()


def heard(key: UserKey) -> bytes:
    """Return what host 1 says to a first host whose nonce is 0."""
    first, caller = ends()
    with first, caller:
        first.sendall(MARK + bytes(NONCE) + bytes(PROOF))
        with pytest.raises(OtherKey):
            to_first_host(caller, key, 1, 10.0)
        return first.recv(1000)


def refused(words: bytes, key: UserKey) -> bytes:
    """Return the answer of a first host to a proof that it does not accept."""
    first, caller = ends()
    with first, caller:
        caller.sendall(words)
        with pytest.raises(OtherKey, match="host 1"):
            to_other_host(first, key, 10.0)
        return caller.recv(1000)[len(MARK) + NONCE :]


def test_both_sides_hear_each_other_in_order(pair: Pair) -> None:
    link_of_first, link_of_third, _, _ = pair
    for message in (b"a", b"", b"a", bytes(10**6)):
        thread = threading.Thread(target=link_of_first.send, args=(message,))
        thread.start()
        assert link_of_third.receive(10.0) == message
        thread.join()
        link_of_third.send(message[:1000])
        assert link_of_first.receive(10.0) == message[:1000]


def test_a_proof_that_was_heard_before_proves_nothing(key: UserKey) -> None:
    assert refused(heard(key), key) == bytes(PROOF)


@pytest.mark.parametrize("place", [0, 4, 4 + NONCE])
def test_a_proof_with_another_number_nonce_or_bit_is_refused(place: int, key: UserKey) -> None:
    """Each is the answer to the nonce of this very connection, and then changed."""
    first, caller = ends()
    answers = list[bool]()

    def serve() -> None:
        try:
            to_other_host(first, key, 10.0)
        except OtherKey:
            answers.append(True)

    thread = threading.Thread(target=serve)
    thread.start()
    with first, caller:
        opening = caller.recv(len(MARK) + NONCE)
        seen = opening + struct.pack(">I", 1) + bytes(NONCE)
        words = bytearray(seen[len(opening) :] + key.proof(b"other host " + seen))
        words[place] ^= 1
        caller.sendall(words)
        thread.join()
        assert answers == [True] and caller.recv(1000) == bytes(PROOF)


def test_a_proof_of_the_first_host_is_none_of_another_one(key: UserKey) -> None:
    """What the first host answers is not accepted from a program that sends it back."""
    first, caller = ends()
    with first, caller:
        opening = MARK + bytes(NONCE)
        seen = opening + struct.pack(">I", 1) + bytes(NONCE)
        first.sendall(opening + key.proof(b"other host " + seen))
        with pytest.raises(OtherKey):
            to_first_host(caller, key, 1, 10.0)


@pytest.mark.parametrize("change", ["bit", "again", "left out", "turned back"])
def test_a_message_that_was_changed_repeated_or_left_out_ends_the_link(change: str, pair: Pair) -> None:
    link_of_first, link_of_third, first, caller = pair
    link_of_third.send(b"one")
    link_of_third.send(b"two")
    frames = [first.recv(4 + PROOF + 3, socket.MSG_WAITALL) for _ in range(2)]
    if change == "turned back":
        first.sendall(frames[0])
        with pytest.raises(ConnectionAbortedError, match="not of the other side"):
            link_of_third.receive(10.0)
        return
    relayed = {
        "bit": [frames[0][:-1] + b"f"],
        "again": [frames[0], frames[0]],
        "left out": [frames[1]],
    }[change]
    caller.sendall(b"".join(relayed))
    for _ in relayed[1:]:
        assert link_of_first.receive(10.0) == b"one"
    with pytest.raises(ConnectionAbortedError, match="not of the other side"):
        link_of_first.receive(10.0)


def test_what_is_no_first_host_is_refused(key: UserKey) -> None:
    first, caller = ends()
    with first, caller:
        first.sendall(b"HTTP/1.1 400 Bad Request\r\n" + bytes(100))
        with pytest.raises(ConnectionAbortedError, match="not a first host of this version"):
            to_first_host(caller, key, 1, 10.0)


def test_who_says_little_by_little_is_given_up_in_time(key: UserKey) -> None:
    first, caller = ends()
    stop = threading.Event()

    def drip() -> None:
        while not stop.wait(0.05):
            try:
                caller.sendall(b"\0")
            except OSError:
                return

    thread = threading.Thread(target=drip)
    thread.start()
    with first, caller, pytest.raises(TimeoutError):
        to_other_host(first, key, 0.5)
    stop.set()
    thread.join()


def test_a_link_knows_that_the_other_side_has_ended(pair: Pair) -> None:
    link_of_first, link_of_third, _, _ = pair
    assert not link_of_first.ended()
    link_of_third.close()
    with pytest.raises(OSError, match=r"ended|reset"):
        link_of_first.receive(10.0)
    assert link_of_first.ended()
