"""Prints how fast the studio shows a moment of a long record: `python benchmarks/replay.py [--frames N]`.

A record of 100,000 frames of 50 x 50 samples is made in a temporary folder and opened by a studio in a
process of its own. A page without a screen watches the field, as a heat map and as a box, and asks for random
moments (as a drag of the slider does), for one frame after the other, and back; it answers each clock at
once. The time from each question to the frame of that moment is measured. Nothing is asserted: a busy machine
prints larger numbers.
"""

from __future__ import annotations

import argparse
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

import numpy as np
import psutil
import websockets

import deodar as dd
from deodar.server import frames as wire

LIMIT_MS = 50.0
SIDE = 50
QUESTIONS = 200


def show(name: str, value: float, unit: str, target: str = "none") -> None:
    """Print a figure beside its target."""
    print(f"{name:66} {value:10.2f} {unit:4} (target {target})", flush=True)


def make(path: Path, count: int, steady: bool) -> None:
    """Write the record of one field."""
    axes = [dd.Axis(name, 0, SIDE, samples=SIDE, periodic=True) for name in "xy"]
    model = dd.Model("replayed")
    field = model.add(dd.Field("u", axes, noise=1.0, kernel=[dd.Gaussian(1, 3)], global_inhibition=0.01))
    model.add(dd.GaussianStimulus("s", axes, center=25, sigma=3, amplitude=8)) >> field
    how: dict[str, Any] = {"out": path} if steady else {}
    data = dd.simulate(model, duration=count - 1, record=["u.activation"], progress=False, **how)
    if not steady:
        dd.save_record(data, path)


class Scrubber:
    """A page that asks for moments."""

    def __init__(self, socket: Any) -> None:
        self.socket = socket
        self.document: dict[str, Any] = {}
        self.timeline: dict[str, Any] | None = None
        self.times: dict[int, float] = {}

    async def read(self) -> None:
        """Read one message, and confirm it if it is a clock."""
        message = await self.socket.recv()
        if isinstance(message, bytes):
            stream, _, moment, _ = wire.unpack(message)
            self.times[stream] = moment
            return
        said = json.loads(message)
        if said["type"] == "opened":
            self.document = said["document"] or {}
        elif said["type"] == "clock":
            self.timeline = said["timeline"]
            await self.socket.send(json.dumps({"type": "drawn", "frame": said["frame"]}))

    async def ask(self, moment: float, **question: Any) -> float:
        """Return the milliseconds until all streams show a moment."""
        before = time.perf_counter()
        await self.socket.send(json.dumps(question))
        while any(shown != moment for shown in self.times.values()):
            await self.read()
        return 1e3 * (time.perf_counter() - before)


async def scrub(address: str, count: int) -> dict[str, list[float]]:
    """Return the milliseconds to a new frame, for each way to ask."""
    there = urlsplit(address)
    async with websockets.connect(f"ws://{there.netloc}/ws?{there.query}", max_size=None) as socket:
        page = Scrubber(socket)
        while not page.document or page.timeline is None:
            await page.read()
        element = next(e["id"] for e in page.document["elements"] if e["path"] == "u")
        for stream, most in ((1, 0), (2, 64)):
            wish = {"stream": stream, "element": element, "port": "activation", "most": most}
            await socket.send(json.dumps({"type": "watch", **wish}))
        while len(page.times) < 2:
            await page.read()
        places = np.random.default_rng(0).permutation(count)[:QUESTIONS].tolist()
        found = {"anywhere": [await page.ask(float(t), type="seek", time=float(t)) for t in places]}
        await page.ask(count // 2, type="seek", time=count // 2)
        for name, by in (("next frame", 1), ("previous frame", -1)):
            start = page.times[1]
            found[name] = [
                await page.ask(start + by * k, type="seek_frames", frames=by) for k in range(1, QUESTIONS + 1)
            ]
        return found


def main() -> None:
    """Make the record, scrub it, and print the figures."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--frames", type=int, default=100_000, help="frames of the record (default 100000)")
    parser.add_argument(
        "--at-once",
        action="store_true",
        help="write the record at the end, as save_record does, instead of during the run",
    )
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "long.zarr"
        before = time.perf_counter()
        make(path, given.frames, not given.at_once)
        size = sum(file.stat().st_size for file in path.rglob("*") if file.is_file())
        show(
            f"making a record of {given.frames} frames of {SIDE} x {SIDE}", time.perf_counter() - before, "s"
        )
        show("its size on the disk", size / 2**20, "MiB")
        command = [sys.executable, "-m", "deodar", "studio", str(path), "--no-browser", "--port", "0"]
        environment = os.environ | {"DEODAR_STATE": str(Path(folder) / "state")}
        before = time.perf_counter()
        server = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=environment)
        try:
            assert server.stdout is not None
            address = server.stdout.readline().split()[-1]
            show("starting the studio with it", time.perf_counter() - before, "s")
            process = psutil.Process(server.pid)
            start = process.memory_info().rss
            for name, times in asyncio.run(scrub(address, given.frames)).items():
                show(
                    f"question to frame, {name}: median of {len(times)}",
                    statistics.median(times),
                    "ms",
                    "< 50",
                )
                show(f"question to frame, {name}: slowest", max(times), "ms")
            show(
                "memory of the studio, growth by scrubbing",
                (process.memory_info().rss - start) / 2**20,
                "MiB",
            )
        finally:
            server.terminate()
            server.wait(30)


if __name__ == "__main__":
    main()
