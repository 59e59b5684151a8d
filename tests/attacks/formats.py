"""Mutated files of every format that deodar reads: each is read, or refused with an error of deodar.

Every other exception is a failure, and so are the end of the process, more than 10 s, more than 1 GiB of
memory, and anything of a file that is run: files hold code that would leave a file called `executed`.

A process of its own reads. Mutation `number` follows from the seed and the number alone.
"""

from __future__ import annotations

import collections
import contextlib
import dataclasses as dc
import faulthandler
import importlib
import json
import multiprocessing
import os
import random
import resource
import shutil
import sys
import time
import traceback
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any

import psutil

from deodar import codec, sealed
from deodar.errors import DeodarError
from tests.attacks import damage
from tests.attacks.seeds import MARK, Format, Seed

LONGEST = 10.0
"""Seconds of CPU time after which a reader counts as one that does not end."""

WAITING = 60.0
"""Seconds of wall time after which a reader that computes nothing counts as one that does not end."""

MOST_MEMORY = 2**30
"""Bytes that reading a file may add to the memory of the process, and that another process of it may take."""

MOST_ADDRESSES = 3 * 2**30
"""Bytes of addresses that a process may take while it reads."""

READS = 1500
"""Number of files after which a new process reads."""

GOOD = ("read", "refused")

FORMATS = "tests.attacks.readers"
"""Module that defines the formats, FORMATS."""


def formats(module: str = FORMATS) -> Mapping[str, Format]:
    """Return the formats that a module defines; it imports what reads them."""
    return importlib.import_module(module).FORMATS


# --------------------------------------------------------------------------------------------- in the process


FOREIGN_CALLS = ("os.system", "os.exec", "os.spawn", "os.posix_spawn", "subprocess.Popen")
CONNECTIONS = ("socket.connect", "socket.getaddrinfo")


class _Watch:
    """What files cause beyond being read: programs that are started, addresses that are connected."""

    def __init__(self) -> None:
        self.seen: list[str] = []
        self.on = False
        self.connects = False
        sys.addaudithook(self._note)

    def _note(self, event: str, arguments: tuple[Any, ...]) -> None:
        if not self.on:
            return
        by_python = event == "subprocess.Popen" and str(arguments[0]) == sys.executable
        local = event == "socket.connect" and isinstance(arguments[1], str)
        connects = event in CONNECTIONS and not local and not self.connects
        if (event in FOREIGN_CALLS and not by_python) or connects:
            self.seen.append(f"{event}{arguments!r}"[:200])


def _status(pid: int | str, name: str) -> int:
    """Return a size of a process in bytes, 0 where the system does not tell."""
    try:
        lines = Path(f"/proc/{pid}/status").read_text().splitlines()
    except OSError:
        return 0
    return next((1024 * int(line.split()[1]) for line in lines if line.startswith(name)), 0)


class _Memory:
    """The largest memory of this process since the start of a reading, and of the processes of it."""

    def __init__(self) -> None:
        with contextlib.suppress(OSError):
            Path("/proc/self/clear_refs").write_text("5")  # begins the largest size again
        self._start = self._largest()

    @staticmethod
    def _largest() -> int:
        unit = 1 if sys.platform == "darwin" else 1024
        return _status("self", "VmHWM") or resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * unit

    def grown(self) -> int:
        """Return the bytes that were added, or those of the largest other process."""
        children = psutil.Process().children(recursive=True)
        return max([self._largest() - self._start, *(_status(child.pid, "VmHWM") for child in children)])


def _remaining_marks(root: Path) -> list[str]:
    """Return the marks that something left which was run, and remove them."""
    marks = [p for p in (Path("/tmp", MARK), *root.glob(f"**/{MARK}")) if p.exists()]
    for path in marks:
        with contextlib.suppress(OSError):
            path.unlink()
    return [str(path) for path in marks]


def _limit_addresses() -> None:
    used = _status("self", "VmSize")
    if used:
        resource.setrlimit(resource.RLIMIT_AS, (used + MOST_ADDRESSES, resource.RLIM_INFINITY))


def _answer(read: Callable[[Path], object], path: Path) -> tuple[str, str]:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            read(path)
        except DeodarError as error:
            message = str(error).strip()
            return (
                ("refused", message[:200])
                if message and "Traceback" not in message
                else ("foreign", "no message")
            )
        except (Exception, SystemExit) as error:
            frames = [
                f"{f.filename.rpartition('src/')[2]}:{f.lineno}"
                for f in traceback.extract_tb(error.__traceback__)
                if "/src/" in f.filename
            ]
            return "foreign", f"{type(error).__name__}: {str(error)[:200]} [{' '.join(frames[-4:])}]"
    return "read", ""


@dc.dataclass(frozen=True)
class Reading:
    """How files are read.

    Attributes:
        module: what defines the formats.
        longest: seconds of CPU time after which a reader counts as one that does not end.
    """

    module: str = FORMATS
    longest: float = LONGEST


def _child(home: str, reading: Reading, connection: Connection) -> None:
    """Read the files that the parent names, each with the reader of its format."""
    root, readers = Path(home), formats(reading.module)
    os.chdir(root / "a" / "b" / "work")
    sys.path.insert(0, str(root / "modules"))
    stacks = (root / "stacks").open("w")
    faulthandler.enable(stacks)
    for file_format in readers.values():  # what is imported for the first file is no memory of another one
        for seed in file_format.seeds()[:1]:
            with contextlib.suppress(DeodarError):
                file_format.read(seed.place)
    _limit_addresses()
    watch = _Watch()
    connection.send("ready")
    while (request := connection.recv()) is not None:
        kind, path = request
        memory, began = _Memory(), time.process_time()
        faulthandler.dump_traceback_later(reading.longest, file=stacks)
        watch.on, watch.connects = True, readers[kind].connects
        state, text = _answer(readers[kind].read, Path(path))
        watch.on = False
        faulthandler.cancel_dump_traceback_later()
        seconds, grown = time.process_time() - began, memory.grown()
        marks = _remaining_marks(root)
        if marks or watch.seen:
            state, text = "run", "; ".join([*marks, *watch.seen])
            watch.seen.clear()
        elif state in GOOD and grown >= MOST_MEMORY:
            state = "memory"
        elif state in GOOD and seconds > reading.longest:
            state = "slow"
        connection.send((state, text, seconds, grown))


class _Reader:
    """The process that reads; another one is started after it ended, and after `READS` files."""

    def __init__(self, home: Path, reading: Reading) -> None:
        self._home, self._reading = home, reading
        (home / "a" / "b" / "work").mkdir(parents=True)
        (home / "modules").mkdir()
        (home / "temporary").mkdir()
        (home / "modules" / "payload.py").write_text(
            f"from pathlib import Path\nPath({MARK!r}).touch()\ndef run(*_, **__): ...\n"
        )
        self._process: Any = None

    def _begin(self) -> Any:
        """Return a new process, when it is ready."""
        context = multiprocessing.get_context("spawn")
        self._connection, far_end = context.Pipe()
        process = context.Process(target=_child, args=(str(self._home), self._reading, far_end))
        before = {name: os.environ.get(name) for name in ("TMPDIR", "DEODAR_STATE")}
        os.environ |= {"TMPDIR": str(self._home / "temporary"), "DEODAR_STATE": str(self._home / "state")}
        try:
            process.start()
        finally:
            for name, text in before.items():
                os.environ.pop(name) if text is None else os.environ.update({name: text})
        far_end.close()
        assert self._connection.recv() == "ready"
        self._reads_until_restart = READS
        return process

    def read(self, kind: str, path: Path) -> tuple[str, str, float, int]:
        """Return what became of a file, the CPU seconds, and the bytes that were added."""
        if self._process is None:
            self._process = self._begin()
        began, spent = time.monotonic(), self._spent()
        longest = self._reading.longest
        self._reads_until_restart -= 1
        try:
            self._connection.send((kind, str(path)))
            while not self._connection.poll(1.0):
                waited, computed = time.monotonic() - began, self._spent() - spent
                if min(waited, computed) > longest or waited > WAITING:
                    self.close(kill=True)
                    return "hang", self._stack(), max(computed, 0.0), 0
            answer = self._connection.recv()
        except (EOFError, ConnectionError):
            ended = self._process
            ended.join()
            self.close(kill=True)
            return f"crash ({ended.exitcode})", self._stack(), 0.0, 0
        if answer[0] == "memory" or not self._reads_until_restart:
            self.close()
        return answer

    def _spent(self) -> float:
        try:
            process = psutil.Process(self._process.pid)
            times = [running.cpu_times() for running in (process, *process.children(recursive=True))]
        except psutil.Error:
            return 0.0
        return sum(t.user + t.system for t in times)

    def _stack(self) -> str:
        lines = (self._home / "stacks").read_text().splitlines()[:60]
        calls = [line.strip() for line in lines if "File" in line and "threading" not in line]
        return " ".join(line.rpartition("/")[2] for line in calls[:6])

    def close(self, kill: bool = False) -> None:
        """End the process and those that it started."""
        process, self._process = self._process, None
        if process is None:
            return
        with contextlib.suppress(psutil.Error):
            children = psutil.Process(process.pid).children(recursive=True)
            if not kill:
                with contextlib.suppress(OSError):
                    self._connection.send(None)
                process.join(5)
            for child in children:
                with contextlib.suppress(psutil.Error):
                    child.kill()
        process.kill()
        process.join()
        self._connection.close()


# ------------------------------------------------------------------------------------------------- the attack


@dc.dataclass
class Summary:
    """What became of the mutations of one format."""

    states: collections.Counter[str] = dc.field(default_factory=collections.Counter[str])
    slowest: float = 0.0
    largest: int = 0

    def __str__(self) -> str:
        bad = sum(n for state, n in self.states.items() if state not in GOOD)
        counts = f"{self.states['read']:6} read {self.states['refused']:6} refused {bad:4} errors"
        return f"{counts}, slowest {self.slowest:5.1f} s, at most {self.largest / 2**20:5.0f} MiB"


@dc.dataclass
class Outcome:
    """What became of all mutations."""

    by_format: dict[str, Summary] = dc.field(default_factory=dict[str, Summary])
    errors: list[str] = dc.field(default_factory=list[str])

    def add(self, row: Mapping[str, Any]) -> None:
        """Count one mutation."""
        summary = self.by_format.setdefault(row["format"], Summary())
        summary.states[row["state"]] += 1
        summary.slowest = max(summary.slowest, row["seconds"])
        summary.largest = max(summary.largest, row["bytes"])
        if row["state"] not in GOOD:
            self.errors.append(
                f"--only {row['number']}: {row['format']}, {row['file']}: {row['state']}: {row['text']}"
            )

    def count(self, *states: str) -> int:
        """Return the number of mutations of which this became, or of all."""
        counts = [summary.states for summary in self.by_format.values()]
        return sum(counter[s] for counter in counts for s in states or counter)


def write(seeds: Mapping[str, list[Seed]], folder: Path, seed: int, number: int) -> tuple[str, str, Path]:
    """Write the files of one mutation; return the format, what was mutated, and what is opened."""
    draw = random.Random(f"{seed}/{number}")
    kind = list(seeds)[number % len(seeds)]
    chosen = draw.choice(seeds[kind])
    contents = {name: path.read_bytes() for name, path in chosen.files.items()}
    everything = [
        *contents.values(),
        draw.choice(draw.choice(seeds[draw.choice(list(seeds))]).paths).read_bytes(),
    ]
    attacked = draw.choice(chosen.attacked)
    content = contents[attacked]
    sealed_content = sealed.is_sealed(content)
    inner = bytes(sealed.unseal(content)) if sealed_content else content
    inner = damage.damaged(draw, attacked, inner or b"\0", everything)
    contents[attacked] = sealed.seal(inner) if sealed_content else inner
    if draw.random() < 0.9:
        damage.state_checksums(contents)
    for name, content in contents.items():
        place = folder / name
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_bytes(content)
    return kind, attacked, folder / chosen.entry


def _rows(rows_file: Path | None) -> Iterator[dict[str, Any]]:
    """Yield the rows of an attack that was stopped; its last line may be incomplete."""
    if rows_file is not None and rows_file.exists():
        for line in rows_file.read_text().splitlines():
            with contextlib.suppress(ValueError):
                yield json.loads(line)


@dc.dataclass(frozen=True)
class Part:
    """Which mutations are read.

    Attributes:
        rows_file: a file of rows, one for each mutation; those that it has are not read again. None: no file.
        only: numbers of mutations; none: all.
        kinds: formats; none: all.
    """

    rows_file: Path | None = None
    only: tuple[int, ...] = ()
    kinds: tuple[str, ...] = ()

    def numbers(self, count: int, kinds: Sequence[str]) -> list[int]:
        """Return the numbers of mutations of those below `count`; formats are attacked in turn."""
        return [n for n in self.only or range(count) if kinds[n % len(kinds)] in (self.kinds or kinds)]


WHOLE = Part()


def attack(
    folder: Path, count: int, seed: int = 0, part: Part = WHOLE, reading: Reading = Reading()
) -> Outcome:
    """Read mutations 0 to `count`, or a part of them.

    Args:
        folder: an empty folder.
        count: number of mutations.
        seed: seed of all of them.
        part: which of them are read.
        reading: how they are read.
    """
    outcome, done = Outcome(), set[int]()
    seeds = {kind: file_format.seeds() for kind, file_format in formats(reading.module).items()}
    for row in _rows(part.rows_file):
        if row["seed"] == seed:
            done.add(row["number"])
            outcome.add(row)
    reader = _Reader(folder / "home", reading)
    with contextlib.ExitStack() as stack:
        stack.callback(reader.close)
        log = stack.enter_context(part.rows_file.open("a")) if part.rows_file is not None else None
        for number in part.numbers(count, list(seeds)):
            if number in done:
                continue
            place = folder / "files"
            shutil.rmtree(place, ignore_errors=True)
            kind, file, entry = write(seeds, place, seed, number)
            state, text, seconds, grown = reader.read(kind, entry)
            row = {"seed": seed, "number": number, "format": kind, "file": file, "state": state}
            row |= {"text": "" if state in GOOD else text, "seconds": round(seconds, 3), "bytes": grown}
            outcome.add(row)
            if log is not None:
                log.write(codec.line(row, ascii=True) + "\n")
                log.flush()
    return outcome
