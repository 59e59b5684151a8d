"""Functions that a child calls in tests: some return, some end it."""

from __future__ import annotations

import os
import signal
import sys
import time
from collections.abc import Callable, Iterator
from typing import TypeVar

from deodar.errors import Fix, MissingExtra, Problem, WorldError

T = TypeVar("T")


class OwnError(WorldError):
    """An error of a module that the parent does not import."""


def same(plain: T) -> T:
    return plain


def process() -> int:
    return os.getpid()


def folder() -> str:
    return os.getcwd()


def busy(seconds: float) -> int:
    time.sleep(seconds)
    return os.getpid()


def crash() -> None:
    os.kill(os.getpid(), signal.SIGSEGV)


def leave() -> None:
    os._exit(3)


def take(size: int) -> int:
    return len(bytearray(size))


def never() -> None:
    while True:
        pass


def fail() -> None:
    raise ValueError("no such\nthing")


def refuse() -> None:
    fix = Fix("Type: a", shell="Type: b", page="Choose c")
    raise OwnError([Problem("here", "is wrong", fix), Problem("", "and this", severity="warning")])


def lack() -> None:
    raise MissingExtra("package", "extra", "reading")


def unplain() -> object:
    return object()


def printed() -> int:
    sys.stdout.write("not a message")
    sys.stdout.flush()
    os.write(1, b"nor this")
    return os.read(0, 1) == b""


def ask(function: Callable[[str], object]) -> list[object]:
    return [function("a"), function("b")]


def count(numbers: int) -> Iterator[int]:
    yield from range(numbers)


def count_and_crash(numbers: int) -> Iterator[int]:
    yield from range(numbers)
    crash()
