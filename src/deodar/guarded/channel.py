"""Messages of plain data between a process and the child that reads files for it.

A message is a word and its content, as a JSON text, and blocks of bytes: those of arrays and of bytes, for
which the text has an object of one key. This key is a mark that the parent drew by chance, so that no file
can state it.

    length of the text, number of blocks, length of each block (8 bytes each), text, blocks

Nothing is pickled. What has no form here (an object of any other class) raises a TypeError where it is sent.
"""

from __future__ import annotations

import json
import math
import select
import struct
import sys
import time
from collections.abc import Callable, Mapping, Sequence
from io import FileIO
from typing import TYPE_CHECKING, Any, BinaryIO, TypeAlias, cast

from deodar import errors
from deodar.errors import DeodarError, Fix, Problem

if TYPE_CHECKING:
    import numpy as np

PlainScalar: TypeAlias = "bool | int | float | str | bytes | None"

PlainData: TypeAlias = (
    "PlainScalar | np.ndarray | Sequence[PlainData] | Mapping[str, PlainData] | Callable[..., PlainData]"
)
"""What passes: tuples arrive as lists, and numbers of NumPy as those of Python; the child may call functions
of the parent.
"""

ParentFunction: TypeAlias = "Callable[..., PlainData]"

ChildMessage: TypeAlias = "tuple[str, PlainData]"
"""A word, and plain data that depend on it."""


class BrokenChannel(Exception):
    """Raised if the other side has ended, or sends what is no message."""


class LateChannel(BrokenChannel):
    """Raised if the other side does not answer in time."""


class Channel:
    """One end of the pipes between parent and child.

    Attributes:
        longest: largest number of bytes of a message that is received.
        deadline: time of `time.monotonic` until which a message is awaited; Windows has no limit.
        functions: functions that were sent; the child has their numbers. None: this side is the child.
    """

    def __init__(
        self, source: FileIO, sink: BinaryIO, mark: str, functions: list[ParentFunction] | None = None
    ) -> None:
        self._source, self._sink, self._mark = source, sink, mark
        self.longest = self.deadline = math.inf
        self.functions = functions
        self._begun = functions is None

    def send(self, word: str, content: PlainData = None) -> None:
        """Send a message.

        Raises:
            TypeError: something is no plain data.
            BrokenChannel: the other side has ended.
        """
        blocks: list[memoryview] = []

        def marked(special: Any) -> PlainData:
            if isinstance(special, (bytes, bytearray, memoryview)):
                blocks.append(memoryview(special).cast("B"))
                return {self._mark: ["bytes", len(blocks) - 1]}
            if hasattr(special, "dtype") and special.dtype.kind in "biufcSU":
                if not special.shape:
                    return special.item()
                blocks.append(memoryview(special.tobytes()))
                return {self._mark: ["array", len(blocks) - 1, special.dtype.str, special.shape]}
            if callable(special) and self.functions is not None:
                self.functions.append(cast(ParentFunction, special))
                return {self._mark: ["function", len(self.functions) - 1]}
            raise TypeError(f"{type(special).__name__} is no plain data")

        text = json.dumps([word, content], default=marked).encode()
        sizes = [len(text), len(blocks), *map(len, blocks)]
        try:
            for part in (struct.pack(f"<{len(sizes)}Q", *sizes), text, *blocks):
                self._sink.write(part)
            self._sink.flush()
        except (OSError, ValueError):  # the latter if this side has closed it
            raise BrokenChannel from None

    def receive(self) -> ChildMessage:
        """Return the next message.

        Raises:
            BrokenChannel: the other side has ended, is late, or sends what is no message, or one that is too
                long.
        """
        if not self._begun:
            head = b""
            while not head.endswith(self._mark.encode()):
                head = head[-len(self._mark) :] + self._read(1)
            self._begun = True
        length, count = self._numbers(2)
        if 8 * count > self.longest:
            raise BrokenChannel
        sizes = self._numbers(count)
        if length + sum(sizes) > self.longest:
            raise BrokenChannel
        text, blocks = self._read(length), [self._read(size) for size in sizes]

        def unmarked(keyed: dict[str, Any]) -> PlainData:
            if len(keyed) != 1 or self._mark not in keyed:
                return keyed
            form, number, *shape = keyed[self._mark]
            if form == "function" and self.functions is None:
                return self._asking(number)
            return bytes(blocks[number]) if form == "bytes" else _array(blocks[number], *shape)

        try:
            word, content = json.loads(text, object_hook=unmarked)
        except (ValueError, TypeError, LookupError, RecursionError):
            raise BrokenChannel from None
        return word, content

    def _asking(self, number: int) -> ParentFunction:
        """Return a function of the child that calls the parent's function of a number."""

        def ask(*values: PlainData) -> PlainData:
            self.send("ask", [number, values])
            word, content = self.receive()
            if word == "error":
                raise error_of(content)
            return content

        return ask

    def _await(self) -> None:
        """Wait for bytes until the deadline."""
        if self.deadline < math.inf and sys.platform != "win32":
            waiting = select.poll()
            waiting.register(self._source, select.POLLIN)
            if not waiting.poll(1000 * max(0.0, self.deadline - time.monotonic())):
                raise LateChannel

    def _numbers(self, count: int) -> tuple[int, ...]:
        return struct.unpack(f"<{count}Q", self._read(8 * count))

    def _read(self, size: int) -> bytearray:
        block = bytearray(size)
        view, done = memoryview(block), 0
        while done < size:
            try:
                self._await()
                # it reads the bytes that have arrived, not all
                count = self._source.readinto(view[done:])
            except (OSError, ValueError):
                raise BrokenChannel from None
            if not count:
                raise BrokenChannel
            done += count
        return block


def _array(block: bytearray, dtype: str, shape: Sequence[int]) -> np.ndarray:
    # start-up time: only messages with arrays need it
    import numpy as np

    return np.frombuffer(block, dtype).reshape(shape)


def error_data(error: DeodarError) -> PlainData:
    """Return an error as plain data; a class of another module is named by its base in `deodar.errors`."""
    kind = next(c.__name__ for c in type(error).__mro__ if getattr(errors, c.__name__, None) is c)
    problems = [(p.where, p.what, [p.fix_at(m) for m in errors.MEDIA], p.severity) for p in error.problems]
    return [kind, problems]


def error_of(plain: PlainData) -> DeodarError:
    """Return the error that plain data describe."""
    name, problems = cast("tuple[str, list[Any]]", plain)
    kind = getattr(errors, name)
    if not issubclass(kind, DeodarError):
        raise BrokenChannel
    error = kind.__new__(kind)
    DeodarError.__init__(
        error, [Problem(place, text, Fix(*fix), severity) for place, text, fix, severity in problems]
    )
    return error
