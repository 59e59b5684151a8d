"""A studio under load for a long time: pages connect, watch, edit and disconnect while the model runs, and
the process keeps no more objects than before.

Its objects are counted while no page is connected and a document was just opened, so that none belongs to a
page or an edit.
"""

from __future__ import annotations

import asyncio
import contextlib
import dataclasses as dc
import json
import random
import signal
import subprocess
import time
from pathlib import Path

import psutil

import deodar as dd
from tests.attacks.edits import small
from tests.attacks.kills import start, stop
from tests.deodar_studio.page import page

AT_ONCE = 4
"""Pages that visit at the same time."""

MOST_KIB = 8.0
"""Memory in KiB that each visit may add, above `ROOM` (a guess)."""

ROOM = 32.0
"""Memory in MiB that allocators and caches may add, whatever the number of visits (a guess)."""

MOST_OBJECTS = 5.0
"""Python objects that each visit may add, above `CACHED`. A page that is not released keeps hundreds."""

CACHED = 2000
"""Python objects that caches may add, whatever the number of visits."""

POOL = 8
"""Threads that the pools of asyncio and JAX may start late."""

PATIENCE = 60.0
"""Longest wall time, in seconds, until the objects of pages must be released."""


@dc.dataclass(frozen=True)
class Held:
    """Numbers of objects and resources of a process."""

    mebibytes: float
    files: int
    objects: int
    tasks: int
    threads: int
    sessions: int
    connections: int


@dc.dataclass
class Outcome:
    """Numbers of a process after a quarter of the time, and at the end."""

    visits: int
    early: Held
    late: Held
    errors: list[str]


def beyond(early: Held, late: Held, visits: int) -> list[str]:
    """Return the limits that were exceeded, in words.

    Args:
        early: numbers of the process before.
        late: its present numbers.
        visits: pages that connected and disconnected in between.
    """
    limits = {
        "mebibytes": early.mebibytes + ROOM + visits * MOST_KIB / 1024,
        "files": early.files,
        "objects": early.objects + CACHED + visits * MOST_OBJECTS,
        "tasks": early.tasks,
        "threads": early.threads + POOL,
        "sessions": 1,
        "connections": 0,
    }
    return [
        f"{getattr(late, name):g} {name} after {visits} visits, at most {limit:g} expected"
        for name, limit in limits.items()
        if getattr(late, name) > limit
    ]


def held(process: subprocess.Popen[str], counts: Path) -> Held:
    """Return the present numbers of a process."""
    counts.unlink(missing_ok=True)
    process.send_signal(signal.SIGUSR1)
    end = time.monotonic() + PATIENCE
    while not counts.exists():
        assert process.poll() is None and time.monotonic() < end, "the studio does not count what it holds"
        time.sleep(0.02)
    there = psutil.Process(process.pid)
    with there.oneshot():
        return Held(
            there.memory_info().rss / 2**20,
            len(there.open_files()) + len(there.net_connections()),
            **json.loads(counts.read_text()),
        )


def settled(
    process: subprocess.Popen[str], counts: Path, before: Held | None, visits: int
) -> tuple[Held, list[str]]:
    """Return the numbers of a process after the objects of pages are released, and the limits that it still
    exceeds after some time.

    Args:
        process: the studio.
        counts: the file of its numbers.
        before: its numbers before the visits; None: there were no visits before, and its number of tasks must
            no longer fall.
        visits: pages that connected and disconnected.
    """
    end, last = time.monotonic() + PATIENCE, held(process, counts)
    while True:
        time.sleep(0.2)
        parameter = held(process, counts)
        errors = beyond(
            before or dc.replace(parameter, tasks=min(parameter.tasks, last.tasks)), parameter, visits
        )
        if (not errors and parameter.tasks >= last.tasks) or time.monotonic() > end:
            return parameter, errors
        last = parameter


async def visit(address: str, random: random.Random) -> None:
    """Connect, watch, run, edit and disconnect."""
    async with page(address) as visitor:
        await visitor.runs()
        u = visitor.element("u")
        await visitor.do("watch", stream=1, element=u, port="activation")
        await visitor.do("trace", stream=2, element=u, port="activation", reduce="max")
        await visitor.do("play")
        for _ in range(random.randrange(1, 10)):
            await visitor.do("set", element=u, parameter="tau", value=random.uniform(10, 90), gesture=1)
        await visitor.do("undo")


async def visits(address: str, seconds: float, random: random.Random) -> int:
    """Let pages visit for some time; each round ends with the document opened again."""
    end, count = time.monotonic() + seconds, 0
    while count == 0 or time.monotonic() < end:
        await asyncio.gather(*(visit(address, random) for _ in range(AT_ONCE)))
        async with page(address) as visitor:
            await visitor.open("open_file", path="m.json", discard=True)
        count += AT_ONCE + 1
    return count


def attack(folder: Path, seconds: float, seed: int = 0) -> Outcome:
    """Load a studio for some seconds."""
    dd.save(small(), folder / "m.json", force=True)
    counts = folder / "counts"
    process, address = start(folder, "tests.attacks.counted", COUNTS=str(counts))
    try:
        with contextlib.closing(asyncio.new_event_loop()) as loop:
            first = loop.run_until_complete(visits(address, seconds / 4, random.Random(f"{seed} early")))
            early, errors = settled(process, counts, None, first)
            then = loop.run_until_complete(visits(address, 3 * seconds / 4, random.Random(f"{seed} late")))
            late, more = settled(process, counts, early, then)
        return Outcome(first + then, early, late, [*errors, *more])
    finally:
        stop(process)
