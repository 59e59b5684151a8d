"""How hosts that compute one model together meet: the first one listens, and the others call it.

Who connects must prove within `HELLO_SECONDS` that it has the key of the first host, which proves the same in
turn (`proven_link.py`). Nothing that a program without the key says, and no silence, changes what hosts do:
each connection is heard in a thread of its own. The port is closed when all hosts have come.
"""

from __future__ import annotations

import importlib.metadata
import queue
import socket
import threading
import time
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field

from deodar import codec
from deodar.codec import Json
from deodar.compiler.host_key import HOSTS_KEY, hosts_key
from deodar.compiler.host_link import HostLinks, message_of
from deodar.compiler.proven_link import OtherKey, ProvenLink, to_first_host, to_other_host
from deodar.errors import HostsError, show
from deodar.user_key import UserKey

HELLO_SECONDS = 2.0
"""Seconds in which who connects to the first host must prove its key, and then say what it runs."""

CALLERS = 64
"""Most connections that may try at once to prove a key; others are closed."""

RETRY = 0.2
"""Seconds between two attempts to reach the first host."""

POLL = 0.05
"""Seconds after which the first host looks who has proven its key."""

ALIKE = "Install the same versions and start all hosts alike"
"""What to do if hosts differ."""

EVERYWHERE = "Start the same script on every host, with its own number"
"""What to do if a host does not come."""

HERE = ("localhost", "127.0.0.1", "[::1]")
"""Hosts that are this machine."""

HostAddress = tuple[str, int]
"""Host and port at which the first host listens."""


@dataclass(frozen=True)
class Hello:
    """What a host brings to the meeting.

    Attributes:
        index: its number.
        key: its key.
        common: what must be equal on all hosts.
    """

    index: int
    key: UserKey
    common: Mapping[str, Json]


@dataclass(frozen=True)
class Arrival:
    """A host that has proven its key.

    Attributes:
        index: its number.
        link: the link with it.
        common: what must be equal on all hosts.
    """

    index: int
    link: ProvenLink
    common: Mapping[str, Json]


@dataclass(frozen=True)
class Reception:
    """Where the first host receives those who connect.

    Attributes:
        key: the key that must be proven.
        count: the number of hosts.
        arrivals: the hosts that have proven it.
        others: the address of the last program without the key, by the number of a host that it states.
    """

    key: UserKey
    count: int
    arrivals: queue.SimpleQueue[Arrival] = field(default_factory=queue.SimpleQueue)
    others: dict[int, str] = field(default_factory=dict[int, str])

    def hear(self, link: socket.socket, address: str) -> None:
        """Let a program prove that it is a host; it is sent away if it does not."""
        try:
            index, proven = to_other_host(link, self.key, HELLO_SECONDS)
            self.arrivals.put(Arrival(index, proven, message_of(proven.receive(HELLO_SECONDS))))
        except OtherKey as error:
            if error.host < self.count:
                self.others[error.host] = address
            link.close()
        except OSError:
            link.close()


def meet(address: str, count: int, index: int, timeout: float) -> HostLinks:
    """Return the links with the other hosts, when all have come and have proven the same key.

    Raises:
        HostsError: one does not come in time, has another key, or differs in the number of hosts or in
            versions.
    """
    host, _, port = address.rpartition(":")
    hello = Hello(index, hosts_key(), {"hosts": count, **_versions()})
    until = time.monotonic() + timeout
    if index:
        # a name may have another address first, at which another program listens
        first_host = (loopback(host) or host).strip("[]")
        links = {0: _call((first_host, int(port)), hello, until, timeout)}
    else:
        links = _welcome((host, int(port)), hello, until, timeout)
    return HostLinks(links, index, count, timeout)


def loopback(host: str) -> str:
    """Return the address at which the first host listens if all hosts are processes of one machine, which
    other machines then do not reach; "" for another host.
    """
    return {"localhost": "127.0.0.1"}.get(host, host) if host in HERE else ""


def _opened(port: int, backlog: int, host: str = "") -> socket.socket:
    """Return a socket that listens at a port, of the loopback alone if `host` is there."""
    if bound := loopback(host):
        family = socket.AF_INET6 if ":" in bound else socket.AF_INET
        return socket.create_server((bound.strip("[]"), port), family=family, backlog=backlog)
    dual = socket.has_dualstack_ipv6()
    family = socket.AF_INET6 if dual else socket.AF_INET
    return socket.create_server(("", port), family=family, backlog=backlog, dualstack_ipv6=dual)


def _versions() -> dict[str, Json]:
    return {name: importlib.metadata.version(name) for name in ("deodar", "jax", "jaxlib", "numpy")}


def _call(place: HostAddress, hello: Hello, until: float, timeout: float) -> ProvenLink:
    """Reach the first host, and wait for its answer, which it gives when all have come.

    Raises:
        HostsError: it does not answer in time, has another key, or refuses this host.
    """
    reason = "no answer"
    while (seconds := until - time.monotonic()) > 0:
        try:
            return _called(place, hello, seconds)
        except OSError as error:
            reason = error.strerror or str(error)
        time.sleep(RETRY)
    raise HostsError(
        f"the first host cannot be reached at {place[0]}:{place[1]} within {timeout:g} s, or not all hosts"
        f" have come ({reason})",
        fix="Start the same script on every host; the address is that of host 0",
    )


def _called(place: HostAddress, hello: Hello, seconds: float) -> ProvenLink:
    """Return the link with the first host, when all have come.

    Raises:
        HostsError: the first host has another key, or refuses this host.
        OSError: it cannot be reached, or does not answer.
    """
    until = time.monotonic() + seconds
    link = socket.create_connection(place, max(0.1, seconds))
    try:
        proven = to_first_host(link, hello.key, hello.index, max(0.1, until - time.monotonic()))
        proven.send(codec.line(hello.common).encode())
        # a little longer than the first host waits, so that it is the one that says who is missing
        answer = message_of(proven.receive(max(0.1, until - time.monotonic()) + 2 * RETRY))
    except OtherKey:
        link.close()
        raise HostsError(
            f"what listens at {place[0]}:{place[1]} does not have the key of host {hello.index}",
            where=str(hello.key.path),
            fix="Copy this file of host 0 to that path, readable by you alone, or state a copy in the"
            f" variable {HOSTS_KEY}. If another program has the port, choose another one",
        ) from None
    except OSError:
        link.close()
        raise
    if "error" in answer:
        proven.close()
        raise HostsError(answer["error"], fix=answer["fix"])
    return proven


def _welcome(place: HostAddress, hello: Hello, until: float, timeout: float) -> dict[int, ProvenLink]:
    """Wait on the first host for all others.

    Raises:
        HostsError: one does not come in time, or differs.
    """
    count = int(str(hello.common["hosts"]))
    links: dict[int, ProvenLink] = {}
    reception, hearing = Reception(hello.key, count), list[threading.Thread]()
    try:
        server = _opened(place[1], CALLERS, place[0])
    except OSError as error:
        raise HostsError(
            f"port {place[1]} cannot be opened on this host ({error.strerror})", fix="Choose another port"
        ) from None
    with server:
        while len(links) < count - 1 and time.monotonic() < until:
            hearing = [thread for thread in hearing if thread.is_alive()]
            if caller := _accepted(server, len(hearing) >= CALLERS):
                hearing.append(threading.Thread(target=reception.hear, args=caller, daemon=True))
                hearing[-1].start()
            while not reception.arrivals.empty():
                _admit(reception.arrivals.get(), links, hello)
    if len(links) < count - 1:
        raise _missing(links, count, reception, timeout)
    _tell(links.values(), {"start": True})
    return links


def _accepted(server: socket.socket, full: bool) -> tuple[socket.socket, str] | None:
    """Return a new connection and its address, if there is one, and room for it."""
    server.settimeout(POLL)
    try:
        link, address = server.accept()
    except OSError:  # none, or one that has ended already
        return None
    if full:
        link.close()
        return None
    return link, f"{address[0]}:{address[1]}"


def _admit(arrival: Arrival, links: dict[int, ProvenLink], hello: Hello) -> None:
    """Add a host to the links.

    Raises:
        HostsError: it differs from the first one.
    """
    count, index = int(str(hello.common["hosts"])), arrival.index
    for ended in [k for k, link in links.items() if link.ended()]:  # it may be started again
        links.pop(ended).close()
    # before its number, which says nothing if the hosts do not agree on how many they are
    if arrival.common != hello.common:
        text = f"host {index} differs from host 0: {dict(arrival.common)} and {dict(hello.common)}"
        _refuse([*links.values(), arrival.link], text, ALIKE)
        raise HostsError(text, fix=ALIKE)
    if not 0 < index < count or index in links:
        _refuse([arrival.link], f"host {show(index)} is not one of {count}, or has come already", ALIKE)
        return
    links[index] = arrival.link


def _missing(links: Mapping[int, ProvenLink], count: int, reception: Reception, timeout: float) -> HostsError:
    """Tell the hosts that have come which ones have not; return the error of the first host."""
    missing = [k for k in range(1, count) if k not in links or links[k].ended()]
    text = f"host {', '.join(map(str, missing))} has not come within {timeout:g} s"
    fix = EVERYWHERE
    if k := next((k for k in missing if k in reception.others), 0):
        text += f"; at {reception.others[k]} is a program that says to be host {k}, and has another key"
        fix = (
            f"If that address is of host {k}, copy {reception.key.path} to it, readable by you alone, or"
            f" state a copy in {HOSTS_KEY}; otherwise another program calls this port, so choose another one"
        )
    _refuse(links.values(), text, fix)
    return HostsError(text, fix=fix)


def _refuse(links: Collection[ProvenLink], reason: str, fix: str) -> None:
    _tell(links, {"error": reason, "fix": fix})
    for link in links:
        link.close()


def _tell(links: Collection[ProvenLink], message: Mapping[str, Json]) -> None:
    for link in links:
        try:
            link.send(codec.line(message).encode())
        except OSError:  # what is read next finds that it has ended
            continue
