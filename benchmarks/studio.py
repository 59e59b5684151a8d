"""Prints what the studio promises about time, each figure beside its target: `python benchmarks/studio.py
[engine|browser|building|large|opening ...]`.

`engine` measures how much a free-running engine is slowed by a page without a screen that watches four plots
at 30 frames a second; `browser` starts a real browser, with graphics in software. `building` edits a running
model of 50 elements, `large` a document of 5,000; `opening` opens examples and a file of cedar. Nothing is
asserted: a busy machine prints larger numbers.
"""

from __future__ import annotations

import asyncio
import contextlib
import json
import os
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import AsyncGenerator
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import websockets

import deodar as dd
from deodar.model import building as building_edits
from deodar.model import edit
from deodar.model.document import Document

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE.parent))

from tests.deodar_studio.page import Page, page, studio  # noqa: E402

FRAME = 1 / 30
ROUNDS = 7
CEDAR = "tests/deodar_interop/importers/cedar/data/field_1d.json"


def show(name: str, value: float, unit: str, target: str) -> None:
    print(f"{name:62} {value:9.2f} {unit:8} (target {target})", flush=True)


async def steps(socket: Any, watching: bool, streams: list[str], element: str) -> float:
    """Steps a second while the engine runs free, with or without a page that watches."""
    for number, port in enumerate(streams, 1):
        await socket.send(
            json.dumps(
                {"type": "watch", "stream": number, "element": element, "port": port}
                if watching
                else {"type": "unwatch", "stream": number}
            )
        )
    await settle(socket, 1.2, watching)  # the engine averages over half a second
    return statistics.median([(await settle(socket, 0.6, watching))["steps"] for _ in range(3)])


async def settle(socket: Any, seconds: float, watching: bool) -> dict[str, Any]:
    """Answer clocks for so long, at 30 a second where it watches, else hardly at all; the last clock."""
    end = time.perf_counter() + seconds
    while True:
        message = await socket.recv()
        if isinstance(message, str) and (clock := json.loads(message))["type"] == "clock":
            moment = time.perf_counter()
            await asyncio.sleep(FRAME if watching else max(0.05, end - moment))
            await socket.send(json.dumps({"type": "drawn", "frame": clock["frame"]}))
            if moment >= end:
                return clock


async def compare(address: str) -> tuple[float, float]:
    """Free steps a second, and the median slowdown in percent, in alternation."""
    there = urlsplit(address)
    async with websockets.connect(f"ws://{there.netloc}/ws?{there.query}", max_size=None) as socket:
        document = None
        while document is None or not document["elements"]:
            message = json.loads(await socket.recv())
            document = message["document"] if message["type"] == "opened" else document
            if message["type"] == "clock":
                await socket.send(json.dumps({"type": "drawn", "frame": message["frame"]}))
        element = document["elements"][0]
        for request in ({"type": "speed", "factor": None}, {"type": "play"}):
            await socket.send(json.dumps(request))
        await settle(socket, 8.0, False)
        streams = [*element["outputs"], *element["inputs"]][:4]
        alone, slower = [], []
        for _ in range(ROUNDS):
            free = await steps(socket, False, streams, element["id"])
            seen = await steps(socket, True, streams, element["id"])
            alone.append(free)
            slower.append(100 * (1 - seen / free))
    return statistics.median(alone), statistics.median(slower)


def engine() -> None:
    """A server in a process of its own, and a page without a screen in this one."""
    with tempfile.TemporaryDirectory() as state:
        command = [
            sys.executable,
            "-m",
            "deodar",
            "studio",
            str(HERE.parent / "examples" / "selection.json"),
            "--no-browser",
            "--port",
            "0",
        ]
        server = subprocess.Popen(
            command, stdout=subprocess.PIPE, text=True, env=os.environ | {"DEODAR_STATE": state}
        )
        assert server.stdout is not None
        try:
            address = server.stdout.readline().split()[-1]
            free, slower = asyncio.run(compare(address))
        finally:
            server.terminate()
            server.wait(30)
    show("a free-running field of 101 samples, no page connected", free, "steps/s", "none")
    show("slowed by a page that watches four plots at 30 frames/s", slower, "%", "< 10")


def browser() -> None:
    """First paint, slider to plot, ten plots, 200 elements: measured by the page itself."""
    subprocess.run([sys.executable, str(HERE.parent / "studio" / "build.py"), "build", "bench"], check=True)


def pairs(count: int) -> dd.Model:
    """Return a model of fields, each with a stimulus, in groups of 40 elements, with positions."""
    x = dd.Axis("x", 0, 100, samples=101)
    elements: list[tuple[Any, tuple[str, ...], int]] = []
    for k in range(count):
        field = dd.Field(f"u{k}", [x], kernel=[dd.Gaussian(1.0, 5.0)], global_inhibition=0.1, noise=0.1)
        stimulus = dd.GaussianStimulus(f"s{k}", [x], amplitude=6.0)
        elements += [(field, (f"g{k // 20}",), 1), (stimulus, (f"g{k // 20}",), 1)]
    doc, entries = edit.add_all(Document("pairs"), elements)
    for u, s in zip(entries[::2], entries[1::2], strict=True):
        doc = edit.connect(doc, s, "", u, "")
    at = {e.id: (240.0 * (k % 40), 140.0 * (k // 40)) for k, e in enumerate(doc.entries)}
    return dd.Model(document=building_edits.placed(doc, at))


@contextlib.asynccontextmanager
async def opened(model: dd.Model) -> AsyncGenerator[Page, None]:
    """A page whose studio, a thread of this process, has a model open, which has run for a second."""
    with tempfile.TemporaryDirectory() as folder:
        dd.save(model, Path(folder) / "pairs.json")
        with studio(Path(folder)) as address:
            async with page(address) as one:
                began = time.perf_counter()
                await one.do("open_file", path="pairs.json")
                await one.until(lambda: len(one.document["elements"]) == len(model.document.entries))
                show("a document is opened and sent", time.perf_counter() - began, "s", "none")
                yield one


async def timed(one: Page, type: str, **message: Any) -> float:
    """Return the milliseconds until a page has the answer of an edit and the document with it."""
    before, began = one.said["opened"]["version"], time.perf_counter()
    await one.do(type, **message)
    await one.until(lambda: one.said["opened"]["version"] > before)
    return 1000 * (time.perf_counter() - began)


async def edited_while_running() -> None:
    """Edits of a running model: they are shown, the old program runs on, states stay, a new one follows."""
    async with opened(pairs(25)) as one:
        await one.runs()
        u, s = one.element("g0.u0"), one.element("g0.s0")
        await one.do("watch", stream=1, element=u, port="activation")
        await one.do("play")
        await one.until(lambda: 1 in one.frames and one.frames[1][1].max() > 0)
        shown: list[float] = []
        for k in range(ROUNDS):
            kind = ("Gain", "GaussianStimulus", "Field")[k % 3]
            where = {"source": {"element": u}} if kind == "Gain" else {}
            shown.append(await timed(one, "add_element", kind=kind, at=[0, 100 * k], **where))
        peak, began = one.frames[1], time.perf_counter()
        shown.append(await timed(one, "add_element", kind="Gain", wire={"source": s, "target": u}))
        await one.until(lambda: one.clock["busy"])
        await one.until(lambda: one.frames[1][0] > peak[0])
        ran = 1000 * (time.perf_counter() - began)
        await one.until(lambda: not one.clock["busy"])
        took, (tick, after) = time.perf_counter() - began, one.frames[1]
        await one.until(lambda: one.frames[1][0] > tick)
    show(
        "an edit of a running model of 50 elements is shown: median", statistics.median(shown), "ms", "< 100"
    )
    show("the slowest of these", max(shown), "ms", "< 100")
    show("the next frame of the old program after the last edit", ran, "ms", "none")
    show("the new program runs after", took, "s", "< 5")
    show("maximum of the activation after the change, before it", after.max(), "", f"{peak[1].max():.2f}")


def building() -> None:
    """Edits of a running model of 50 elements."""
    asyncio.run(edited_while_running())


def large() -> None:
    """A document of 5,000 elements: opened, edited, its groups moved and dissolved."""
    asyncio.run(edited_large())


async def edited_large() -> None:
    """Edits of a document of 5,000 elements."""
    async with opened(pairs(2500)) as one:
        ids = [e["id"] for e in one.document["elements"]]
        edits: list[tuple[str, str, dict[str, Any]]] = [
            ("a parameter is set", "set", {"element": ids[0], "parameter": "tau", "value": 25.0}),
            ("an element is added", "add_element", {"kind": "Field", "at": [0, 0]}),
            ("an element is renamed", "rename", {"element": ids[2], "name": "renamed"}),
            ("a group of 40 is renamed", "rename", {"group": ["g0"], "name": "renamed"}),
            ("2,500 elements are moved into a group", "move_into", {"elements": ids[2500:], "group": ["g5"]}),
            ("a group of 2,540 is dissolved", "ungroup", {"group": ["g5"]}),
            ("one step of undo", "undo", {}),
        ]
        for name, type, message in edits:
            show(f"5,000 elements: {name}, and shown", await timed(one, type, **message), "ms", "none")


OPENED = ("examples/selection.json", "examples/binding.json", CEDAR)


def opening() -> None:
    """Documents are opened in turn, the first of each kind of file apart: its reader may have to start."""
    asyncio.run(opened_in_turn())


async def opened_in_turn() -> None:
    """The time from the request for a file to its document on the page."""
    with tempfile.TemporaryDirectory() as folder:
        for file in OPENED:
            shutil.copy(HERE.parent / file, folder)
        spent: dict[str, list[float]] = {}
        with studio(Path(folder)) as address:
            async with page(address) as one:
                for _ in range(1 + ROUNDS):
                    for file in OPENED:
                        began = time.perf_counter()
                        await one.do("open_file", path=Path(file).name, discard=True)
                        spent.setdefault(file, []).append(1000 * (time.perf_counter() - began))
        for file, (first, *others) in spent.items():
            show(f"{Path(file).name} is opened: the first time", first, "ms", "none")
            show(f"{Path(file).name} is opened: median of {ROUNDS}", statistics.median(others), "ms", "none")


PARTS = {"building": building, "large": large, "opening": opening, "engine": engine, "browser": browser}

if __name__ == "__main__":
    for name in sys.argv[1:] or PARTS:
        PARTS[name]()
