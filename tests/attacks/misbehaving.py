"""Readers that misbehave, each in another way, to show that `formats` notices it."""

from __future__ import annotations

import os
import shutil
import subprocess
import time
from collections.abc import Callable, Mapping
from pathlib import Path

from deodar.errors import DeodarError
from tests.attacks.seeds import MARK, ROOT, Format, Seed

FILE = ROOT / "examples" / "node.json"


def _read(path: Path) -> None:
    path.read_bytes()


def _refuse(path: Path) -> None:
    raise DeodarError("is refused", where=path.name)


def _say_nothing(path: Path) -> None:
    raise DeodarError("")


def _raise_another(path: Path) -> None:
    raise KeyError(path.name)


def _end(path: Path) -> None:
    os.abort()


def _compute_without_end(path: Path) -> None:
    while True:
        pass


def _compute(path: Path) -> None:
    began = time.process_time()
    while time.process_time() < began + 6.0:
        pass


def _take_memory(path: Path) -> None:
    b"1" * (2**30 + 2**26)


def _take_too_much_memory(path: Path) -> None:
    b"1" * 2**33


def _leave_a_file(path: Path) -> None:
    Path(MARK).touch()


def _start_a_program(path: Path) -> None:
    subprocess.run([shutil.which("true") or "true"], check=True)


def _import(path: Path) -> None:
    __import__("payload")


def _format(read: Callable[[Path], None]) -> Format:
    def after_the_first(path: Path) -> None:
        if path != FILE:
            read(path)

    return Format(lambda: [Seed({FILE.name: FILE}, FILE.name, (FILE.name,))], after_the_first)


FORMATS: Mapping[str, Format] = {
    "read": _format(_read),
    "refused": _format(_refuse),
    "foreign": _format(_raise_another),
    "without a message": _format(_say_nothing),
    "crash": _format(_end),
    "hang": _format(_compute_without_end),
    "slow": _format(_compute),
    "memory": _format(_take_memory),
    "more memory": _format(_take_too_much_memory),
    "run": _format(_leave_a_file),
    "program": _format(_start_a_program),
    "import": _format(_import),
}
