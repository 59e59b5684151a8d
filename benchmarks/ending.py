"""How long a studio takes to end: `python benchmarks/ending.py [CASE ...]`.

A studio is started in a process of its own, brought into the state of the case, and gets SIGINT and SIGTERM
in alternate tries (`--tries 4`). Status 1 if one of them takes more than 3 s, where the load is at most 1.5
times the cores.
"""

from __future__ import annotations

import argparse
import asyncio
import contextlib
import os
import signal
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import AsyncGenerator, Callable
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT))

from tests.deodar_studio.page import Page, page  # noqa: E402

import deodar as dd  # noqa: E402
from stops import status  # noqa: E402

LIMIT = 3.0
"""Longest time that the manual states, s."""

STATUS = {signal.SIGINT: 0, signal.SIGTERM: 128 + signal.SIGTERM}
State = contextlib.AbstractAsyncContextManager[None]


def small() -> dd.Model:
    """Return a model that is compiled soon."""
    x = dd.Axis("x", 0, 100, 101)
    model = dd.Model("small", dt=1)
    stimulus = model.add(dd.GaussianStimulus("s", [x], amplitude=6.0, center=50.0))
    stimulus >> model.add(dd.Field("u", [x], kernel=[dd.Gaussian(1.0, 5.0)], noise=0.1))
    return model


def slow() -> dd.Model:
    """Return a model that takes many seconds to compile: fields of many sizes, each a program of its own."""
    model = dd.Model("slow", dt=1)
    for k in range(60):
        x = dd.Axis("x", 0, 100, 60 + k)
        stimulus = model.add(dd.GaussianStimulus(f"s{k}", [x], amplitude=6.0, center=50.0))
        stimulus >> model.add(dd.Field(f"u{k}", [x], kernel=[dd.Gaussian(1.0, 5.0)], noise=0.1))
    return model


def turning() -> dd.Model:
    """Return a model that turns the motor of a robot."""
    model = dd.Model("turning", dt=10)
    model.add(dd.Boost("go", amplitude=2.0)) >> model.add(dd.Motor("turn", motor="speed"))
    return model


@contextlib.asynccontextmanager
async def idle(address: str) -> AsyncGenerator[None]:
    """No page is connected."""
    yield


@contextlib.asynccontextmanager
async def run(address: str) -> AsyncGenerator[None]:
    """A model runs, and a page watches it."""
    async with page(address) as visitor:
        await visitor.runs()
        await visitor.do("speed", factor=None)
        await visitor.do("play")
        await visitor.send(type="watch", stream=1, element=visitor.element("u"), port="activation")
        await visitor.until(lambda: visitor.frames)
        yield


@contextlib.asynccontextmanager
async def alone(address: str) -> AsyncGenerator[None]:
    """A model runs, and its page was closed."""
    async with run(address):
        pass
    yield


@contextlib.asynccontextmanager
async def stalled(address: str) -> AsyncGenerator[None]:
    """A model runs, and a program holds the socket of a page open and reads nothing."""
    parts = urlsplit(address)
    async with run(address):
        with socket.create_connection((parts.hostname or "", parts.port or 0)) as silent:
            lines = (
                f"GET /ws?{parts.query} HTTP/1.1",
                f"Host: {parts.netloc}",
                "Upgrade: websocket",
                "Connection: Upgrade",
                "Sec-WebSocket-Version: 13",
                "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==",
            )
            silent.sendall("".join(f"{line}\r\n" for line in (*lines, "")).encode())
            await asyncio.to_thread(silent.recv, 20)
            yield


@contextlib.asynccontextmanager
async def recording(address: str) -> AsyncGenerator[None]:
    """A model runs and is recorded."""
    async with page(address) as visitor:
        await visitor.runs()
        await visitor.do("start_record")
        await visitor.do("play")
        await visitor.until(lambda: visitor.clock["recording"] and visitor.clock["tick"] > 100)
        yield


@contextlib.asynccontextmanager
async def moving(address: str) -> AsyncGenerator[None]:
    """A model moves a robot."""
    async with page(address) as visitor:
        await visitor.runs()
        await visitor.do("play")
        await visitor.until(lambda: visitor.said.get("robot_link", {}).get("round_trip", 0) > 0)
        yield


@contextlib.asynccontextmanager
async def compiling(address: str) -> AsyncGenerator[None]:
    """A document is compiled."""
    async with page(address) as visitor:
        await visitor.until(lambda: (visitor.clock["compiling"] or {}).get("phase") == "compiling")
        yield


@contextlib.asynccontextmanager
async def recompiling(address: str) -> AsyncGenerator[None]:
    """A model runs while a change of it is compiled."""
    async with page(address) as visitor:
        await visitor.runs()
        await visitor.do("play")
        await add_fields(visitor)
        await visitor.until(lambda: (visitor.clock["compiling"] or {}).get("phase") == "compiling")
        yield


async def add_fields(visitor: Page) -> None:
    """Add fields of many sizes, so that the program takes many seconds to compile."""
    for k in range(60):
        axis = {"name": "x", "lower": 0, "upper": 100, "samples": 60 + k}
        values = {"axes": [axis], "kernel": [{"kind": "Gaussian", "amplitude": 1.0, "sigma": 5.0}]}
        await visitor.do("add_element", kind="Field", values=values)


@contextlib.asynccontextmanager
async def measuring(address: str) -> AsyncGenerator[None]:
    """A regime is measured in another process."""
    async with page(address) as visitor:
        await visitor.runs()
        await visitor.do("measure_regime", element=visitor.element("u"))
        await visitor.until(lambda: visitor.said["regime"]["measuring"])
        yield


CASES: dict[str, tuple[Callable[[str], State], Callable[[], dd.Model] | None]] = {
    "idle": (idle, None),
    "run": (run, small),
    "alone": (alone, small),
    "stalled": (stalled, small),
    "recording": (recording, small),
    "moving": (moving, turning),
    "compiling": (compiling, slow),
    "recompiling": (recompiling, small),
}


async def ended(folder: Path, name: str, number: int) -> float:
    """Return how long a studio takes to end by a signal in a case, s.

    Raises:
        RuntimeError: it ends with another status, or prints an error.
    """
    state, model = CASES[name]
    words = ["--no-browser", "--port", "0"]
    if model is not None:
        dd.save(model(), folder / f"{name}.json")
        words = [f"{name}.json", *words]
    robot: Any = None
    if name == "moving":
        from tests.deodar_robots.zenoh.wheel import Wheel

        from deodar_robots.zenoh.served_world import ServedWorld

        robot = ServedWorld(Wheel(), "wheel", "live")
        words += ["--world", f"zenoh:wheel, at={robot.endpoint}"]
    process = await asyncio.create_subprocess_exec(
        *(sys.executable, "-m", "deodar", "studio", *words),
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        cwd=folder,
        env=os.environ | {"DEODAR_CACHE": str(folder / "programs")},
    )
    try:
        assert process.stdout is not None
        address = (await process.stdout.readline()).decode().split()[-1]
        async with state(address):
            since = time.monotonic()
            process.send_signal(number)
            _, printed = await process.communicate()
            seconds = time.monotonic() - since
    finally:
        if process.returncode is None:
            process.kill()
            await process.communicate()
        if robot is not None:
            robot.close()
    wrong = [line for line in printed.decode().splitlines() if "SIGTERM has ended" not in line]
    if process.returncode != STATUS[signal.Signals(number)] or wrong:
        raise RuntimeError(f"{name}: status {process.returncode}, printed {wrong}")
    return seconds


def endings(name: str, tries: int) -> list[float]:
    """Return how long studios take to end in a case, s."""
    times: list[float] = []
    for k in range(tries):
        with tempfile.TemporaryDirectory() as folder:
            os.environ["DEODAR_STATE"] = str(Path(folder, "state"))
            times.append(asyncio.run(ended(Path(folder), name, list(STATUS)[k % 2])))
    return times


def main() -> int:
    """Measure, print, and judge where the machine is quiet."""
    parser = argparse.ArgumentParser()
    parser.add_argument("case", nargs="*", help=f"visitor of {', '.join(CASES)} (default: all)")
    parser.add_argument("--tries", type=int, default=4)
    args = parser.parse_args()
    load, late = os.getloadavg()[0], 0
    print(f"{os.cpu_count()} cores, load {load:.1f}, {args.tries} tries each", flush=True)
    for name in args.case or CASES:
        times = sorted(endings(name, args.tries))
        late += times[-1] > LIMIT
        case_text = (CASES[name][0].__doc__ or "").strip().rstrip(".")
        print(f"{case_text:76} median {times[len(times) // 2]:.2f} s, longest {times[-1]:.2f} s", flush=True)
    return status(load, late)


if __name__ == "__main__":
    sys.exit(main())
