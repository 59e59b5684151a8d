"""A studio under load for a long time: pages come, watch, edit and go while the model runs, and the process does not grow."""

from __future__ import annotations

import asyncio
import contextlib
import dataclasses as dc
import random
import time
from pathlib import Path

import psutil

import deodar as dd
from tests.attacks.edits import small
from tests.attacks.kills import start, stop
from tests.server.page import page


@dc.dataclass(frozen=True)
class Size:
    """What a process holds."""

    mebibytes: float
    threads: int
    files: int


@dc.dataclass
class Outcome:
    """What a process held after a quarter of the time, and at the end."""

    visits: int
    early: Size
    late: Size


def size(process: psutil.Process) -> Size:
    """What a process holds now."""
    return Size(process.memory_info().rss / 2**20, process.num_threads(), len(process.open_files()) + len(process.net_connections()))


async def visits(address: str, seconds: float, random: random.Random) -> int:
    """Let pages visit for some time, four at once."""
    end, count = time.monotonic() + seconds, 0

    async def visitor() -> None:
        nonlocal count
        while time.monotonic() < end:
            async with page(address) as one:
                await one.runs()
                u = one.element("u")
                await one.do("watch", stream=1, element=u, port="activation")
                await one.do("play")
                for _ in range(random.randrange(1, 10)):
                    await one.do("set", element=u, parameter="tau", value=random.uniform(10, 90), gesture=1)
                await one.do("undo")
                count += 1

    await asyncio.gather(*(visitor() for _ in range(4)))
    return count


def attack(folder: Path, seconds: float, seed: int = 0) -> Outcome:
    """Load a studio for some seconds."""
    dd.save(small(), folder / "m.json", force=True)
    process, address = start(folder)
    try:
        with contextlib.closing(asyncio.new_event_loop()) as loop:
            count = loop.run_until_complete(visits(address, seconds / 4, random.Random(f"{seed} early")))
            early = size(psutil.Process(process.pid))
            count += loop.run_until_complete(visits(address, 3 * seconds / 4, random.Random(f"{seed} late")))
        return Outcome(count, early, size(psutil.Process(process.pid)))
    finally:
        stop(process)
