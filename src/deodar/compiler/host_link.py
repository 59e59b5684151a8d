"""The links between hosts that compute one model together: each is linked with the first one.

A message is a line of JSON, or bytes of JAX (`host_stream.py`); each proves that it is of the other host
(`proven_link.py`). Links also carry signs of life, so that a host whose process, computer or network has
ended is known after `SILENT` seconds, and one whose process has ended at once.
"""

from __future__ import annotations

import contextlib
import os
import queue
import shutil
import sys
import threading
import time
from collections.abc import Collection, Generator, Mapping, Sequence
from pathlib import Path
from typing import Any

from deodar import codec
from deodar.compiler.gloo_port import GlooPort
from deodar.compiler.host_stream import HostStream
from deodar.compiler.proven_link import ProvenLink
from deodar.errors import HostsError

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

CAUSE = "Its output has the cause. Start the run again on all hosts"
"""What to do if a host has ended."""

STREAM = b"\0"
"""First byte of a message with bytes of JAX; one of JSON begins otherwise."""

HostMessage = dict[str, Any]


class HostLinks:
    """The links of this host: with all others on the first host, with the first one on the others.

    Args:
        links: the links by the number of the other host.
        index: number of this host.
        count: number of hosts.
        timeout: seconds after which a host that does not answer is given up.

    Attributes:
        lost: the hosts that have ended.
        inside: since when this process waits in a program of several hosts; 0: it does not.
        failed: whether the run has ended with an error.
        gloo: the port of Gloo, when JAX has started.
        connected: the groups of devices of several hosts that are connected, by their numbers.
    """

    def __init__(self, links: Mapping[int, ProvenLink], index: int, count: int, timeout: float) -> None:
        self.index, self.count, self.timeout = index, count, timeout
        self.lost: set[int] = set()
        self.inside = 0.0
        self.failed = False
        self.gloo: GlooPort | None = None
        self.connected = set[tuple[int, ...]]()
        self._links = dict(links)
        self._number = 0
        self._folder: Path | None = None
        self._inbox = {k: queue.SimpleQueue[HostMessage | None]() for k in links}
        self._heard = dict.fromkeys(links, time.monotonic())
        self._streams = {k: HostStream(link, STREAM) for k, link in links.items()}
        self._ready = threading.Event()
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
            link.close()

    @property
    def address(self) -> str:
        """The address of this machine at which the other hosts reach it."""
        return next(iter(self._links.values())).address

    @contextlib.contextmanager
    def carrying(self, path: Path) -> Generator[None]:
        """Carry what JAX sends to a socket of this machine, at a path, to that of the first host, and back.

        JAX must connect while the context is open; what it has connected stays. The folder of the path is
        removed if this process ends in JAX meanwhile.

        Raises:
            HostsError: the first host has ended, or is not ready in time.
        """
        self._folder = path.parent
        try:
            if self.index == 0:
                for k, stream in self._streams.items():
                    run = lambda k=k, stream=stream: self._reach(k, stream, path)  # noqa: E731
                    threading.Thread(target=run, daemon=True, name=f"deodar-jax-{k}").start()
                yield
                return
            if not self._ready.wait(self.timeout) or self.lost:
                raise HostsError(lost_hosts(self.lost) or "host 0 has not started JAX", fix=CAUSE)
            with self._streams[0].listening(path, self.timeout):
                yield
        finally:
            self._folder = None

    def _reach(self, k: int, stream: HostStream, path: Path) -> None:
        """Connect another host with JAX of the first one, which starts meanwhile."""
        if stream.reach(path, self.timeout):
            self._send(k, {"ready": True})
            stream.run()

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
        with contextlib.suppress(OSError):  # its reader finds that it has ended
            self._links[k].send(codec.line(message).encode())

    def _send_all(self, message: HostMessage) -> None:
        for k in self._links:
            self._send(k, message)

    # ------------------------------------------------------------------------------------------ signs of life

    def _read(self, k: int) -> None:
        try:
            with contextlib.suppress(OSError):
                while content := self._links[k].receive():
                    self._deliver(k, content)
        finally:  # also after an error of this program: no thread would read what comes later
            self._lose(k)

    def _deliver(self, k: int, content: bytes) -> None:
        """Give what a host sends to the part of this one that waits for it."""
        self._heard[k] = time.monotonic()
        if content.startswith(STREAM):
            self._streams[k].deliver(content[len(STREAM) :])
            return
        message = message_of(content)
        if "lost" in message:
            self._lose(int(str(message["lost"])))
        elif "ready" in message:
            self._ready.set()
        elif "n" in message:
            self._inbox[k].put(message)

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
                if self._folder is not None:
                    shutil.rmtree(self._folder, ignore_errors=True)
                os._exit(1)

    def _lose(self, k: int) -> None:
        if k in self.lost:
            return
        self.lost.add(k)
        if self.index == 0:
            self._send_all({"lost": k})
        for inbox in self._inbox.values() if self.index else [self._inbox[k]]:
            inbox.put(None)
        if k in self._streams:
            self._streams[k].close()
        self._ready.set()  # who waits for it finds that the host has ended


def lost_hosts(lost: Collection[int]) -> str:
    """Return the sentence that these hosts have ended; "" for none."""
    if not lost:
        return ""
    named = ", ".join(map(str, sorted(lost)))
    return f"host {named} has ended" if len(lost) == 1 else f"the hosts {named} have ended"


def message_of(content: bytes) -> HostMessage:
    """Return the message in the content of a link."""
    message = codec.parse(content.decode())
    assert isinstance(message, dict), "a host that has proven its key says what this version says"
    return message
