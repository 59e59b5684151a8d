"""A studio that is killed while pages edit and save: the file is complete, and stored edits are offered at
the next start.
"""

from __future__ import annotations

import asyncio
import dataclasses as dc
import os
import random
import signal
import subprocess
import sys
from pathlib import Path

import deodar as dd
from deodar.model import partial
from deodar_studio.files.state_store import StateStore
from tests.attacks.edits import small
from tests.deodar_studio.page import page


@dc.dataclass
class Outcome:
    """Results after the kills."""

    kills: int = 0
    saves: int = 0
    abandoned: int = 0
    errors: list[str] = dc.field(default_factory=list[str])


ROOT = Path(__file__).parents[2]


def start(folder: Path, module: str = "deodar", **variables: str) -> tuple[subprocess.Popen[str], str]:
    """Start a studio in a process of its own; return both it and its address."""
    command = [sys.executable, "-m", module, "studio", "m.json", "--no-browser", "--port", "0"]
    path = os.pathsep.join(filter(None, [str(ROOT), os.environ.get("PYTHONPATH", "")]))
    environment = os.environ | {"DEODAR_STATE": str(folder / "state"), "PYTHONPATH": path} | variables
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, cwd=folder, env=environment)
    assert process.stdout is not None
    return process, process.stdout.readline().split()[-1]


def stop(process: subprocess.Popen[str]) -> None:
    """Kill a process and read the rest of its output."""
    process.kill()
    process.communicate(timeout=30)


async def edit_and_save(address: str, process: subprocess.Popen[str], after: int, outcome: Outcome) -> float:
    """Save without a pause, and kill the process during a save; return the value of the last answered
    save.
    """
    saved = 0.0
    async with page(address) as visitor:
        await visitor.until(lambda: visitor.document)
        u = visitor.element("u")
        closed = asyncio.create_task(visitor.socket.wait_closed())
        for k in range(after + 1):
            await visitor.do("set", element=u, parameter="tau", value=100 + k)
            saving = asyncio.create_task(visitor.do("save", replace=True))
            if k == after:
                await asyncio.sleep(0.02 * random.random())
                process.send_signal(signal.SIGKILL)
            await asyncio.wait({saving, closed}, return_when=asyncio.FIRST_COMPLETED)
            if saving.done():
                saved, outcome.saves = 100.0 + k, outcome.saves + 1
            else:
                saving.cancel()
    return saved


def attack(folder: Path, count: int, seed: int = 0) -> Outcome:
    """Kill a studio repeatedly."""
    outcome, random_ = Outcome(), random.Random(seed)
    dd.save(small(), folder / "m.json", force=True)
    for k in range(count):
        process, address = start(folder)
        try:
            saved = asyncio.run(edit_and_save(address, process, random_.randrange(12), outcome))
        finally:
            stop(process)
        outcome.kills += 1
        try:
            loaded = dd.load(folder / "m.json").get("u.tau")
            if saved and loaded not in (saved, saved + 1):
                outcome.errors.append(f"{k}: {saved} was answered as saved, and the file holds {loaded}")
        except dd.errors.DeodarError as error:
            outcome.errors.append(f"{k}: {error}")
        outcome.abandoned += len(list(partial.abandoned(folder)))
    dd.save(small(), folder / "m.json", force=True)
    StateStore(folder / "state").store_edits("0" * 16, small().document, "")
    for place in (folder, folder / "state" / "unsaved"):
        outcome.errors += [f"{path.name} is left" for path in partial.abandoned(place)]
    return outcome
