"""The lines of text between hosts that compute one model together: each is linked with the first one.

A message is a line of JSON. Links also carry signs of life, so that a host whose process, computer or network
has ended is known after `SILENT` seconds, and one whose process has ended at once.
"""

from __future__ import annotations

import contextlib
import importlib.metadata
import os
import queue
import socket
import sys
import threading
import time
from collections.abc import Collection, Mapping, Sequence
from typing import Any

from deodar import codec
from deodar.errors import HostsError, show

BEAT = 1.0
"""Seconds between two signs of life of a host."""

SILENT = 15.0
"""Seconds without a sign of life after which a host counts as ended."""

STUCK = 5.0
"""Seconds in a program without one of its hosts after which the process ends, because nothing else ends the
program.
"""

PARTING = 5.0
"""Most seconds that the first host waits for the others before it ends, after an error."""

GRACE = 2.0
"""Seconds that the other hosts wait for an answer of the first one beyond the time limit."""

HELLO_SECONDS = 2.0
"""Seconds in which who connects to the first host must say which host it is."""

RETRY = 0.2
"""Seconds between two attempts to reach the first host."""

REACH = 10.0
"""Seconds in which the other hosts must reach the port of the first one that JAX uses."""

ALIKE = "Install the same versions and start all hosts alike"
"""What to do if hosts differ."""

EVERYWHERE = "Start the same script on every host, with its own number"
"""What to do if a host does not come."""

CAUSE = "Its output has the cause. Start the run again on all hosts"
"""What to do if a host has ended."""

FIREWALL = "JAX needs this port, which the system chooses: let the firewall of host 0 pass all ports"
"""What to do if a port of the first host cannot be reached."""

HERE = ("localhost", "127.0.0.1", "[::1]")
"""Hosts that are this machine."""

HostMessage = dict[str, Any]


class HostLinks:
    """The links of this host: with all others on the first host, with the first one on the others.

    Args:
        links: the sockets by the number of the other host.
        index: number of this host.
        count: number of hosts.
        timeout: seconds after which a host that does not answer is given up.

    Attributes:
        lost: the hosts that have ended.
        inside: since when this process waits in a program of several hosts; 0: it does not.
        failed: whether the run has ended with an error.
    """

    def __init__(self, links: Mapping[int, socket.socket], index: int, count: int, timeout: float) -> None:
        self.index, self.count, self.timeout = index, count, timeout
        self.lost: set[int] = set()
        self.inside = 0.0
        self.failed = False
        self._links = dict(links)
        self._number = 0
        self._inbox = {k: queue.SimpleQueue[HostMessage | None]() for k in links}
        self._heard = dict.fromkeys(links, time.monotonic())
        self._sending = threading.Lock()
        self._closed = threading.Event()

    def begin(self) -> None:
        """Read what the others send from now on, and give signs of life."""
        for k in self._links:
            threading.Thread(target=self._read, args=(k,), daemon=True, name=f"deodar-host-{k}").start()
        threading.Thread(target=self._live, daemon=True, name="deodar-hosts").start()

    def end(self) -> None:
        """Let the first host end last: JAX would end the others with an error."""
        until = time.monotonic() + (PARTING if self.failed else self.timeout)
        while self.index == 0 and len(self.lost) < self.count - 1 and time.monotonic() < until:
            time.sleep(0.01)

    def close(self) -> None:
        """Close the links; the others find that this host has ended."""
        self._closed.set()
        for link in self._links.values():
            with contextlib.suppress(OSError):
                link.shutdown(socket.SHUT_RDWR)
            link.close()

    # ---------------------------------------------------------------------------------------------- exchanges

    def exchange(self, subject: str, words: Any) -> list[Any]:
        """Return what every host says about `subject` (plain data), in order of the hosts.

        Raises:
            HostsError: one does not answer, is somewhere else in its script, or has ended its run.
        """
        self._number += 1
        message: HostMessage = {"n": self._number, "what": subject, "said": words}
        try:
            if self.index:
                self._send(0, message)
                messages = self._answer(subject)
            else:
                messages = [message, *self._answers(subject)]
                self._send_all({"n": self._number, "all": messages})
        except HostsError:
            self.failed = True
            raise
        for k, answer in enumerate(messages):
            if "left" in answer:
                self.failed = True
                raise HostsError(
                    f"host {k} has ended the run: {answer['left']}",
                    fix="The output of that host has the cause",
                )
            if answer["what"] != subject:
                self.failed = True
                raise HostsError(
                    f"host {k} is at {answer['what']!r} of its script, host {self.index} at {subject!r}",
                    fix="Run the same script with the same arguments on all hosts",
                )
        return [answer["said"] for answer in messages]

    def leave(self, reason: str) -> None:
        """Tell the others, at their next exchange, that the run has ended here."""
        self._number += 1
        message: HostMessage = {"n": self._number, "left": reason}
        if self.index:
            self._send(0, message)
        else:
            self._send_all({"n": self._number, "all": [message]})

    def lost_soon(self) -> None:
        """Wait a moment for the message that a host has ended, after an error of a program."""
        until = time.monotonic() + 2 * BEAT
        while not self.lost and time.monotonic() < until:
            time.sleep(0.01)

    def _answers(self, subject: str) -> list[HostMessage]:
        """Return on the first host what the others say."""
        until = time.monotonic() + self.timeout
        heard = {k: self._hear(k, until) for k in range(1, self.count)}
        late = [k for k, message in heard.items() if message is None]
        if late:
            self._send_all({"n": self._number, "late": late})
            raise self._late(late, subject)
        return [message for message in heard.values() if message is not None]

    def _answer(self, subject: str) -> list[HostMessage]:
        """Return on another host what all say, as the first one answers."""
        # longer than the first host waits, so that it is the one that says which host is late
        answer = self._hear(0, time.monotonic() + self.timeout + GRACE)
        if answer is None:
            raise self._late([0], subject)
        if "late" in answer:
            raise self._late(answer["late"], subject)
        return answer["all"]

    def _late(self, late: Sequence[int], subject: str) -> HostsError:
        named, verb = ", ".join(map(str, late)), "has" if len(late) == 1 else "have"
        return HostsError(
            f"{'host' if len(late) == 1 else 'the hosts'} {named} {verb} not answered for {self.timeout:g} s",
            where=subject,
            fix="Its script may do something else; or give join_hosts a longer timeout",
        )

    def _hear(self, k: int, until: float) -> HostMessage | None:
        """Return what a host says in the present exchange; none if it does not in time.

        Raises:
            HostsError: it has ended.
        """
        while True:
            try:
                message = self._inbox[k].get(timeout=max(0.0, until - time.monotonic()))
            except queue.Empty:
                return None
            if message is None:
                self._inbox[k].put(None)  # also for the next one who asks
                raise HostsError(lost_hosts(self.lost) or f"host {k} has ended", fix=CAUSE)
            if message["n"] >= self._number:  # else it belongs to a run that has ended here
                return message

    def _send(self, k: int, message: HostMessage) -> None:
        with contextlib.suppress(OSError), self._sending:  # its reader finds that it has ended
            self._links[k].sendall(f"{codec.line(message)}\n".encode())

    def _send_all(self, message: HostMessage) -> None:
        for k in self._links:
            self._send(k, message)

    # ------------------------------------------------------------------------------------------ signs of life

    def _read(self, k: int) -> None:
        with contextlib.suppress(OSError, ValueError), self._links[k].makefile("r", encoding="utf-8") as file:
            for line in file:
                message = codec.parse(line)
                assert isinstance(message, dict)
                self._heard[k] = time.monotonic()
                if "lost" in message:
                    self._lose(int(str(message["lost"])))
                elif "n" in message:
                    self._inbox[k].put(message)
        self._lose(k)

    def _live(self) -> None:
        while not self._closed.wait(BEAT):
            self._send_all({"beat": self.index})
            now = time.monotonic()
            for k in [k for k, heard in self._heard.items() if now - heard > SILENT]:
                self._lose(k)
            since = self.inside
            if self.lost and since and now - since > STUCK:
                sys.stderr.write(f"deodar: {lost_hosts(self.lost)}, so this process ends\n")
                sys.stderr.flush()
                os._exit(1)

    def _lose(self, k: int) -> None:
        if k in self.lost:
            return
        self.lost.add(k)
        if self.index == 0:
            self._send_all({"lost": k})
        for inbox in self._inbox.values() if self.index else [self._inbox[k]]:
            inbox.put(None)


def lost_hosts(lost: Collection[int]) -> str:
    """Return the sentence that these hosts have ended; "" for none."""
    if not lost:
        return ""
    named = ", ".join(map(str, sorted(lost)))
    return f"host {named} has ended" if len(lost) == 1 else f"the hosts {named} have ended"


def meet(address: str, count: int, index: int, timeout: float) -> tuple[HostLinks, int]:
    """Return the links with the other hosts, and a port of the first host that is free for JAX.

    Raises:
        HostsError: one does not come in time, differs in the number of hosts or in versions, or cannot reach
            the port for JAX.
    """
    host, _, port = address.rpartition(":")
    hello: HostMessage = {"host": index, "about": {"hosts": count, **_versions()}}
    until = time.monotonic() + timeout
    if index:
        place = host.strip("[]"), int(port)
        link, answer = _call(place, hello, until, timeout)
        links = {0: link}
        jax_port = int(_word(answer, "port", link))
        reason = _unreached((place[0], jax_port))
        _tell([link], {"reached": not reason, "reason": reason})
        # longer than the first host waits, so that it is the one that says which host has ended
        _word(_next_words(link, 3 * REACH), "start", link)
    else:
        links = _welcome((host, int(port)), count, hello, until, timeout)
        jax_port = _probed(links, host)
    for link in links.values():
        link.settimeout(None)
        link.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    return HostLinks(links, index, count, timeout), jax_port


def _word(answer: HostMessage, name: str, link: socket.socket) -> Any:
    """Return what the first host says by this name.

    Raises:
        HostsError: it refuses this host, or has ended.
    """
    if name in answer:
        return answer[name]
    link.close()
    raise HostsError(
        answer.get("error", "host 0 has ended, or does not answer"), fix=answer.get("fix", CAUSE)
    )


def _probed(links: dict[int, socket.socket], host: str) -> int:
    """Return a port of the first host that is free, and which all others have reached.

    Raises:
        HostsError: one of them cannot reach it, or has ended.
    """
    with _opened(0, len(links), host) as server:
        free_port = int(server.getsockname()[1])
        _tell(links.values(), {"port": free_port})
        until = time.monotonic() + 2 * REACH
        # all are read: closing a link with words that are not read would also lose those that are sent
        answers = {k: _next_words(link, max(RETRY, until - time.monotonic())) for k, link in links.items()}
    for k, answer in sorted(answers.items()):
        if not answer.get("reached"):
            text, fix = f"host {k} has ended, or does not answer", CAUSE
            if reason := answer.get("reason"):
                text, fix = f"host {k} cannot reach port {free_port} of host 0 ({reason})", FIREWALL
            _refuse(links.values(), text, fix)
            raise HostsError(text, fix=fix)
    # JAX opens the port again at once
    _tell(links.values(), {"start": True})
    return free_port


def _unreached(place: tuple[str, int]) -> str:
    """Return why a port cannot be reached; "" if it can."""
    try:
        socket.create_connection(place, REACH).close()
    except OSError as error:
        return error.strerror or str(error)
    return ""


def _next_words(link: socket.socket, seconds: float) -> HostMessage:
    """Return the next message of a link; empty if it does not come in time, or the link ends."""
    link.settimeout(seconds)
    try:
        return _line(link)
    except OSError:
        return {}


def loopback(host: str) -> str:
    """Return the address at which the first host listens if all hosts are processes of one machine, which
    other machines then do not reach; "" for another host.
    """
    return {"localhost": "127.0.0.1"}.get(host, host) if host in HERE else ""


def _opened(port: int, backlog: int, host: str = "") -> socket.socket:
    """Return a socket that listens at a port, of the loopback alone if `host` is there; 0: a free port."""
    if bound := loopback(host):
        family = socket.AF_INET6 if ":" in bound else socket.AF_INET
        return socket.create_server((bound.strip("[]"), port), family=family, backlog=backlog)
    dual = socket.has_dualstack_ipv6()
    family = socket.AF_INET6 if dual else socket.AF_INET
    return socket.create_server(("", port), family=family, backlog=backlog, dualstack_ipv6=dual)


def _versions() -> dict[str, str]:
    return {name: importlib.metadata.version(name) for name in ("deodar", "jax", "jaxlib", "numpy")}


def _call(
    place: tuple[str, int], hello: HostMessage, until: float, timeout: float
) -> tuple[socket.socket, HostMessage]:
    """Reach the first host, and wait for its answer, which it gives when all have come."""
    reason = "no answer"
    while time.monotonic() < until:
        link = None
        try:
            link = socket.create_connection(place, max(0.1, until - time.monotonic()))
            link.sendall(f"{codec.line(hello)}\n".encode())
            # a little longer than the first host waits, so that it is the one that says who is missing
            link.settimeout(max(0.1, until - time.monotonic()) + 2 * RETRY)
            if answer := _line(link):
                return link, answer
        except OSError as error:
            reason = error.strerror or str(error)
        if link is not None:
            link.close()
        time.sleep(RETRY)
    raise HostsError(
        f"the first host cannot be reached at {place[0]}:{place[1]} within {timeout:g} s, or not all hosts"
        f" have come ({reason})",
        fix="Start the same script on every host; the address is that of host 0",
    )


def _welcome(
    place: tuple[str, int], count: int, hello: HostMessage, until: float, timeout: float
) -> dict[int, socket.socket]:
    """Wait on the first host for all others."""
    links: dict[int, socket.socket] = {}
    host, port = place
    try:
        server = _opened(port, count, host)
    except OSError as error:
        raise HostsError(
            f"port {port} cannot be opened on this host ({error.strerror})", fix="Choose another port"
        ) from None
    with server:
        while time.monotonic() < until:
            server.settimeout(max(0.01, until - time.monotonic()))
            with contextlib.suppress(TimeoutError):
                link, _ = server.accept()
                greeting = _next_words(link, HELLO_SECONDS)
                _drop_ended(links)
                if not greeting:  # no host, or one that calls again
                    link.close()
                    continue
                k = greeting.get("host")
                if not isinstance(k, int) or not 0 < k < count or k in links:
                    _refuse([link], f"host {show(k)} is not one of {count}, or has come already", ALIKE)
                    continue
                links[k] = link
                if greeting.get("about") != hello["about"]:
                    text = f"host {k} differs from host 0: {greeting.get('about')} and {hello['about']}"
                    _refuse(links.values(), text, ALIKE)
                    raise HostsError(text, fix=ALIKE)
            if len(links) == count - 1:
                break
    if len(links) < count - 1:
        _drop_ended(links)
        missing = ", ".join(str(k) for k in range(1, count) if k not in links)
        text = f"host {missing} has not come within {timeout:g} s"
        _refuse(links.values(), text, EVERYWHERE)
        raise HostsError(text, fix=EVERYWHERE)
    return links


def _drop_ended(links: dict[int, socket.socket]) -> None:
    """Remove the hosts whose process has ended while they wait, so that they may be started again."""
    for k, link in list(links.items()):
        link.setblocking(False)
        try:
            ended = not link.recv(1, socket.MSG_PEEK)
        except BlockingIOError:  # it waits, and says nothing
            continue
        except OSError:
            ended = True
        if ended:
            link.close()
            del links[k]


def _refuse(links: Collection[socket.socket], reason: str, fix: str) -> None:
    _tell(links, {"error": reason, "fix": fix})
    for link in links:
        link.close()


def _tell(links: Collection[socket.socket], message: HostMessage) -> None:
    for link in links:
        with contextlib.suppress(OSError):  # what is read next finds that it has ended
            link.sendall(f"{codec.line(message)}\n".encode())


def _line(link: socket.socket) -> HostMessage:
    """Return the first message of a link; empty if it is none."""
    text = b""
    while not text.endswith(b"\n") and len(text) < 2**16:
        # byte by byte: what follows belongs to the reader
        byte = link.recv(1)
        if not byte:
            return {}
        text += byte
    try:
        message = codec.parse(text.decode())
    except ValueError:
        return {}
    return message if isinstance(message, dict) else {}
