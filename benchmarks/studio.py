"""Prints what the studio promises about time, each figure beside its target: `python benchmarks/studio.py
[engine|browser ...]`.

`engine` measures how much a free-running engine is slowed by a page without a screen that watches four plots
at 30 frames a second; `browser` starts a real browser, with graphics in software. Nothing is asserted: a busy
machine prints larger numbers.
"""

from __future__ import annotations

import asyncio
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import websockets

HERE = Path(__file__).parent
FRAME = 1 / 30
ROUNDS = 7


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


PARTS = {"engine": engine, "browser": browser}

if __name__ == "__main__":
    for name in sys.argv[1:] or PARTS:
        PARTS[name]()
