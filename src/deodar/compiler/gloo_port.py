"""The port at which a process takes the connections of Gloo, which exchanges numbers of hosts on the CPU.

Gloo connects the devices of a group when the group is first used, and asks no program for a proof: who
connects first with the number of a device would be taken for it. So the port passes connections only while
hosts connect devices (`open`, Linux), and before any number is used the hosts compare both ends of all
connections over their proven links: those with an end that no host has are of another program.
"""

from __future__ import annotations

import contextlib
import ctypes
import os
import socket
import stat
import struct
import sys
from collections.abc import Collection, Generator, Iterable, Iterator, Sequence

from deodar.errors import HostsError

ATTACH_FILTER, DETACH_FILTER = 26, 27
"""Options of a socket of Linux: a filter of its packets."""

DROP_ALL = struct.pack("HBBI", 0x06, 0, 0, 0)
"""Program of a filter that passes no packet: it returns the length 0."""

ConnectionEnds = tuple[str, str]
"""Address of a connection on this host, and on the other one."""


class GlooPort:
    """The port of Gloo of this process.

    Args:
        listener: the socket at which Gloo listens.
    """

    def __init__(self, listener: socket.socket) -> None:
        self._listener = listener
        self.shut()

    @property
    def address(self) -> str:
        """Where Gloo listens."""
        return _text(self._listener.getsockname())

    @contextlib.contextmanager
    def open(self) -> Generator[None]:
        """Let other hosts connect while the context is open."""
        if sys.platform == "linux":
            with contextlib.suppress(OSError):  # the system has refused to attach it
                self._listener.setsockopt(socket.SOL_SOCKET, DETACH_FILTER, 0)
        try:
            yield
        finally:
            self.shut()

    def shut(self) -> None:
        """Refuse further connections; those that exist stay. Systems other than Linux refuse none."""
        if sys.platform == "linux":
            program = ctypes.create_string_buffer(DROP_ALL, len(DROP_ALL))
            # the number of instructions, and where they are
            filter_of_packets = struct.pack("HP", 1, ctypes.addressof(program))
            with contextlib.suppress(OSError):
                self._listener.setsockopt(socket.SOL_SOCKET, ATTACH_FILTER, filter_of_packets)


def listeners(address: str) -> set[int]:
    """Return the numbers of the sockets of TCP of this process that listen at an address of this machine."""
    numbers = set[int]()
    for number, end in _sockets():
        with end:
            if end.getsockname()[0] == address and _listens(end):
                numbers.add(number)
    return numbers


def copy_of(number: int) -> socket.socket:
    """Return a copy of a socket of this process, which stays as it is."""
    blocking = os.get_blocking(number)
    end = socket.socket(fileno=os.dup(number))
    # after socket.setdefaulttimeout in a script a copy does not block, and so neither would the socket
    os.set_blocking(number, blocking)
    return end


def connections() -> list[ConnectionEnds]:
    """Return the ends of all connections of TCP of this process."""
    ends = list[ConnectionEnds]()
    for _, end in _sockets():
        with end, contextlib.suppress(OSError):  # it is not connected
            ends.append((_text(end.getsockname()), _text(end.getpeername())))
    return ends


def strangers(ports: Iterable[str], ends_of_hosts: Iterable[ConnectionEnds]) -> list[ConnectionEnds]:
    """Return the connections with ports of Gloo whose other end is of no host.

    Args:
        ports: where Gloo listens on the hosts.
        ends_of_hosts: the connections of all hosts.
    """
    addresses, ends = set(ports), set(ends_of_hosts)
    return sorted((a, b) for a, b in ends if (a in addresses or b in addresses) and (b, a) not in ends)


def end(others: Collection[ConnectionEnds]) -> None:
    """End those of these connections that this process has: a program that waits for one ends."""
    for _, connection in _sockets():
        with connection, contextlib.suppress(OSError):  # it is not connected
            if (_text(connection.getsockname()), _text(connection.getpeername())) in others:
                connection.shutdown(socket.SHUT_RDWR)


def error_of(others: Sequence[ConnectionEnds]) -> HostsError:
    """Return the error that Gloo has connections with programs that are no hosts."""
    return HostsError(
        "a program that is no host has connected with Gloo, which exchanges the numbers of the hosts:"
        f" {others[0][1]} with {others[0][0]}",
        fix="Look which program that is, and start the run again on all hosts",
    )


def unreached(ports: Sequence[str], seconds: float) -> HostsError:
    """Return the error that Gloo has not connected the devices of the hosts in time.

    Args:
        ports: where it listens on the hosts.
        seconds: the time that it had.
    """
    return HostsError(
        f"the devices of the hosts have not connected within {seconds:g} s: Gloo listens at"
        f" {', '.join(ports)}; a firewall hides a port, or a program that is no host has connected and gone",
        fix="Let a firewall pass connections between the hosts at all ports; start again on all hosts",
    )


def _sockets() -> Iterator[tuple[int, socket.socket]]:
    """Yield a copy of each socket of TCP of this process, with its number."""
    for name in os.listdir("/dev/fd"):
        # another thread may close it meanwhile
        with contextlib.suppress(OSError):
            number = int(name)
            if not stat.S_ISSOCK(os.fstat(number).st_mode):
                continue
            end = copy_of(number)
            if end.family in (socket.AF_INET, socket.AF_INET6) and end.type == socket.SOCK_STREAM:
                yield number, end
            else:
                end.close()


def _listens(end: socket.socket) -> bool:
    """Return whether a socket of TCP listens."""
    with contextlib.suppress(OSError):
        return bool(end.getsockopt(socket.SOL_SOCKET, socket.SO_ACCEPTCONN))
    # macOS does not answer; what listens has a port, and has no peer
    try:
        end.getpeername()
    except OSError:
        return end.getsockname()[1] != 0
    return False


def _text(address: tuple[str | int, ...]) -> str:
    return f"{str(address[0]).removeprefix('::ffff:')} {address[1]}"
