"""How long motors move after something has failed: `python benchmarks/stops.py [CASE ...]`.

A wheel is served by a process of its own and writes each command with its time. A case fails something in
each of its tries (`--tries 20`), and prints how long the wheel then moved; status 1 if that was longer than
the page *What stops when* states. Halted processes stay so for 10 s (`--halt`), in which the wheel has to
stay at rest. Judged only where the load is at most 1.5 times the cores. Needs SIGSTOP: not on Windows.
"""

from __future__ import annotations

import argparse
import asyncio
import contextlib
import io
import multiprocessing as mp
import os
import random
import signal
import struct
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Generator, Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from unittest import mock

os.environ.setdefault("NPROC", "1")
ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT))

PERIOD, STOPS_AFTER, ABSENT, PATIENCE = 0.01, 0.2, 5.0, 0.5
MARGIN = 0.02
"""What a quiet machine adds to a time, s."""

QUIET = 0.3
"""Time in which nothing moves after a stop, s: a machine that is busy also delays a command now and then."""

MOST_LOAD = 1.5
CONTEXT = mp.get_context("forkserver" if "forkserver" in mp.get_all_start_methods() else "spawn")
Commands = Callable[[], list[tuple[float, float]]]
"""Function that returns the time and the value of each command that reached a motor."""


@dataclass(frozen=True)
class Stop:
    """How long a motor moved in each try after an event, and at most as the manual states it, s."""

    event: str
    times: list[float]
    limit: float


# ---------------------------------------------------------------------------------------------- the processes


def serve(at: str, log: str) -> None:
    """Serve the wheel of the tests."""
    from tests.deodar_robots.zenoh.wheel import Wheel

    serve_world(at, lambda: Wheel(log))


def serve_table(at: str, folder: str, port: str) -> None:
    """Serve the turntable of docs/your-robot.md, whose motor has a driver."""
    os.chdir(folder)
    sys.path.insert(0, folder)
    import table  # type: ignore[import-not-found]

    serve_world(at, lambda: table.Table(port))


def serve_world(at: str, make: Callable[[], Any]) -> None:
    """Serve a world by the wall clock, as `deodar serve` does."""
    from deodar.cli import _options, main

    options: Any = _options
    options.world = lambda text: make()
    with contextlib.redirect_stdout(io.StringIO()):
        main(["serve", "world:it", "--at", at, "--name", "wheel", "--clock", "live"])


def turn(at: str, pipe: Any) -> None:
    """Turn the wheel until the robot is lost; say when and why. Leave the network when the pipe says so."""
    import numpy as np

    from deodar.errors import WorldError
    from deodar_robots.zenoh.zenoh import Zenoh

    world = connected(lambda: Zenoh(at=at, patience=PATIENCE))
    world.reset(0)
    pipe.send("ready")
    try:
        while not pipe.poll():
            if world.sensors:
                world.sense_all([(name, ()) for name in world.sensors], 0.0)
            world.act({"speed": np.full(1, 2.0, np.float32)}, 0.0)
            world._inbox.wait(world._inbox.period() + 1, PATIENCE)
    except WorldError as error:
        pipe.send((time.monotonic(), str(error)))
    world.close()


def connected(open_world: Callable[[], Any], seconds: float = 30.0) -> Any:
    """Return a world when its robot has started."""
    from deodar.errors import WorldError

    end = time.monotonic() + seconds
    while True:
        try:
            return open_world()
        except WorldError:
            if time.monotonic() > end:
                raise


def begun(target: Any, *arguments: Any) -> Any:
    """Start a process."""
    CONTEXT.set_forkserver_preload(["deodar_robots.zenoh.server", "deodar_robots.zenoh.zenoh"])
    process = CONTEXT.Process(target=run_with_keys, args=(os.environ["DEODAR_STATE"], target, *arguments))
    process.start()
    return process


def run_with_keys(state: str, target: Any, *arguments: Any) -> None:
    """Call a function with the keys in a folder: a forked process has the environment of the first one."""
    os.environ["DEODAR_STATE"] = state
    target(*arguments)


def ended(process: Any) -> None:
    """Kill a process, also a halted one, and wait for its end."""
    process.kill()
    process.join()


@contextlib.contextmanager
def wheel(folder: Path) -> Generator[tuple[str, Commands]]:
    """Serve a wheel; yield its endpoint and its commands."""
    from deodar_robots.zenoh.served_world import free_endpoint

    at = free_endpoint()
    log = folder / f"{at.rpartition(':')[2]}.txt"
    robot = begun(serve, at, str(log))
    try:
        wait_for(log.exists)
        yield at, lambda: written(log)
    finally:
        ended(robot)


@contextlib.contextmanager
def turning(at: str, commands: Commands) -> Generator[tuple[Any, Any]]:
    """Start a model that turns a wheel; yield its process and its pipe, when the wheel turns."""
    parent_end, child_end = CONTEXT.Pipe()
    model = begun(turn, at, child_end)
    child_end.close()
    try:
        if parent_end.recv() != "ready":
            raise RuntimeError("the model did not begin")
        wait_for(lambda: moves(commands))
        time.sleep(random.uniform(0.1, 0.3))
        yield model, parent_end
    finally:
        ended(model)


def written(log: Path) -> list[tuple[float, float]]:
    """Return the newest commands that the wheel wrote."""
    with contextlib.suppress(FileNotFoundError), log.open("rb") as file:
        file.seek(max(0, log.stat().st_size - 100_000))
        rows = [row.split() for row in file.read().decode().splitlines(keepends=True)[1:] if row[-1:] == "\n"]
        return [(float(row[0]), float(row[1])) for row in rows if len(row) == 2]
    return []


def moves(commands: Commands) -> bool:
    """Return whether the newest command moves the motor."""
    return bool(newest := commands()[-1:]) and newest[0][1] != 0


def moved(commands: Commands, since: float, still: float = 0.0, seconds: float = 30.0) -> float:
    """Return how long a motor moved after a moment; infinity if it does not stop, or moves again before
    `still` seconds have passed.
    """
    end = time.monotonic() + seconds
    while (stopped := last_stop(commands)) > time.monotonic() - QUIET:
        if time.monotonic() > end:
            return float("inf")
        time.sleep(0.02)
    time.sleep(max(0.0, since + still - time.monotonic()))
    return stopped - since if last_stop(commands) == stopped else float("inf")


def last_stop(commands: Commands) -> float:
    """Return when a motor came to rest the last time; infinity while it moves."""
    rows = commands()
    last = max((k for k, row in enumerate(rows) if row[1] != 0), default=-1)
    return rows[last + 1][0] if 0 <= last < len(rows) - 1 else float("inf")


def wait_for(holds: Callable[[], Any], seconds: float = 60.0) -> None:
    """Wait until a condition holds."""
    end = time.monotonic() + seconds
    while not holds():
        if time.monotonic() > end:
            raise TimeoutError("the wheel does not turn, or is not served")
        time.sleep(0.01)


# -------------------------------------------------------------------------------------------------- the cases


def killed(folder: Path, tries: int, halt: float) -> Iterator[Stop]:
    """Kill the model (SIGKILL)."""
    times: list[float] = []
    with wheel(folder) as (at, commands):
        for _ in range(tries):
            with turning(at, commands) as (model, _):
                since = time.monotonic()
                model.kill()
                times.append(moved(commands, since))
    yield Stop("the model is killed", times, STOPS_AFTER + PERIOD)


def halted(folder: Path, tries: int, halt: float) -> Iterator[Stop]:
    """Halt the model (SIGSTOP), several at once, each with a wheel of its own."""

    def halted_once(_: int) -> float:
        with wheel(folder) as (at, commands), turning(at, commands) as (model, _):
            since = time.monotonic()
            os.kill(model.pid, signal.SIGSTOP)
            return moved(commands, since, halt)

    with ThreadPoolExecutor(5) as pool:
        times = list(pool.map(halted_once, range(tries)))
    yield Stop(f"the model is halted for {halt:g} s", times, STOPS_AFTER + PERIOD)


def lost(folder: Path, tries: int, halt: float) -> Iterator[Stop]:
    """Let nothing pass between robot and model, while no connection is closed."""
    from tests.deodar_robots.zenoh.relay import Relay

    from deodar_robots.zenoh import port_key

    times: list[float] = []
    error_times: list[float] = []
    with wheel(folder) as (at, commands):
        for _ in range(tries):
            relay = Relay(at)
            key = port_key.key_at("127.0.0.1", int(at.rpartition(":")[2])).path
            shared = port_key.path_of("127.0.0.1", relay.port)
            shared.write_text(key.read_text())
            shared.chmod(0o600)
            with turning(f"tcp/127.0.0.1:{relay.port}", commands) as (_, pipe):
                since = time.monotonic()
                relay.passing.clear()
                times.append(moved(commands, since))
                when, text = pipe.recv() if pipe.poll(10) else (float("inf"), "")
                error_times.append(when - since if "'wheel'" in text else float("inf"))
            relay.close()
            wait_for(lambda: not moves(commands))
            time.sleep(STOPS_AFTER)
    yield Stop("nothing passes the link", times, STOPS_AFTER + PERIOD)
    yield Stop("nothing passes the link: the model names it", error_times, PATIENCE + PERIOD)


def refused(folder: Path, tries: int, halt: float) -> Iterator[Stop]:
    """Send commands of the model's number that jump, and others that are forged or damaged, 100 times."""
    import numpy as np

    from deodar_robots.zenoh.about import WireMessage, key
    from deodar_robots.zenoh.zenoh import Zenoh

    times: list[float] = []
    with wheel(folder) as (at, commands):
        world = connected(lambda: Zenoh(at=at))
        motor, number = key("wheel", "motor", "speed"), world._commander
        for _ in range(tries):
            world.reset(0)
            while not moves(commands):
                world.act({"speed": np.full(1, 2.0, np.float32)}, 0.0)
                time.sleep(PERIOD)
            since = time.monotonic()
            for k in range(1, 101):
                for raw in (
                    WireMessage(np.float32(9), 10**9 + k, commander=number).to_bytes(),
                    WireMessage(np.float32(9), k, commander=number + 1).to_bytes(),
                    WireMessage(np.float32(np.nan), 100 + k, commander=number).to_bytes(),
                    WireMessage(np.float32(9), 100 + k, commander=number).to_bytes()[:-1],
                    struct.pack("<f", 9.0),
                ):
                    world._session.put(motor, raw)
                time.sleep(PERIOD / 2)
            times.append(moved(commands, since))
        world.close()
    yield Stop("all commands are refused", times, STOPS_AFTER + PERIOD)


def closed(folder: Path, tries: int, halt: float) -> Iterator[Stop]:
    """Close the world of the model."""
    times: list[float] = []
    with wheel(folder) as (at, commands):
        for _ in range(tries):
            with turning(at, commands) as (model, pipe):
                since = time.monotonic()
                pipe.send("close")
                times.append(moved(commands, since))
                model.join()
    # the model ends its period first
    yield Stop("the model closes its world", times, 2 * PERIOD)


def served(folder: Path, tries: int, halt: float) -> Iterator[Stop]:
    """End the process that serves the wheel by SIGTERM."""
    from deodar_robots.zenoh.served_world import free_endpoint

    times: list[float] = []
    for k in range(tries):
        at, log = free_endpoint(), folder / f"ended-{k}.txt"
        robot = begun(serve, at, str(log))
        commands: Commands = lambda log=log: written(log)  # noqa: E731
        with turning(at, commands):
            since = time.monotonic()
            robot.terminate()
            robot.join()
            times.append(moved(commands, since))
    yield Stop("the server ends by SIGTERM", times, 0.1 + PERIOD)


def driver(folder: Path, tries: int, halt: float) -> Iterator[Stop]:
    """Kill, and halt, the process that serves the turntable; its driver stays."""
    from tests.docs.source import DOCS, module

    from deodar_robots.zenoh.served_world import free_endpoint

    blocks = module(DOCS / "pages.py").blocks(DOCS / "your-robot.md")
    for block in (b for b in blocks if b.language == "file"):
        (folder / block.prints).write_text(block.text)
    times: dict[int, list[float]] = {signal.SIGKILL: [], signal.SIGSTOP: []}
    for k in range(tries):
        port, rows = folder / f"port-{k}", list[tuple[float, float]]()
        os.mkfifo(port)

        def read(port: Path = port, rows: list[tuple[float, float]] = rows) -> None:
            with port.open("rb") as lines:
                rows += [(0.0, 0.0)]
                for line in lines:
                    rows.append((time.monotonic(), float(line)))

        for number, seconds in times.items():
            reader = threading.Thread(target=read, daemon=True)
            reader.start()
            at = free_endpoint()
            robot = begun(serve_table, at, str(folder), str(port))
            with turning(at, lambda rows=rows: rows):
                since = time.monotonic()
                os.kill(robot.pid or 0, number)
                seconds.append(moved(lambda rows=rows: rows, since))
            ended(robot)
            reader.join(10)
    yield Stop("the server is killed, its driver stays", times[signal.SIGKILL], STOPS_AFTER)
    yield Stop("the server is halted, its driver stays", times[signal.SIGSTOP], STOPS_AFTER + 2 * PERIOD)


def studio(folder: Path, tries: int, halt: float) -> Iterator[Stop]:
    """Pause and halt a studio that turns the wheel, and close its page."""
    with wheel(folder) as (at, commands):
        yield from asyncio.run(studio_tries(folder, at, commands, tries, halt))


async def studio_tries(folder: Path, at: str, commands: Commands, tries: int, halt: float) -> list[Stop]:
    """Turn the wheel by a studio, and return how long it moved after a pause, a halt and without a page."""
    from tests.deodar_studio.page import page

    import deodar as dd

    model = dd.Model("turning", dt=10)
    model.add(dd.Boost("go", amplitude=2.0)) >> model.add(dd.Motor("turn", motor="speed"))
    dd.save(model, folder / "turning.json")
    words = [
        str(folder / "turning.json"),
        "--no-browser",
        "--port",
        "0",
        "--world",
        f"zenoh:wheel, at={at}",
    ]
    process = subprocess.Popen(
        [sys.executable, "-m", "deodar", "studio", *words], stdout=subprocess.PIPE, text=True
    )
    assert process.stdout is not None
    paused, stopped, unwatched = list[float](), list[float](), list[float]()
    try:
        address = process.stdout.readline().split()[-1]
        for _ in range(tries):
            async with page(address) as visitor:
                await visitor.runs()
                for times in (paused, stopped):
                    await run_again(visitor)
                    await asyncio.to_thread(wait_for, lambda: moves(commands))
                    since = time.monotonic()
                    if times is paused:
                        await visitor.do("pause")
                    else:
                        process.send_signal(signal.SIGSTOP)
                    times.append(
                        await asyncio.to_thread(moved, commands, since, 0.0 if times is paused else halt)
                    )
                    process.send_signal(signal.SIGCONT)
                await run_again(visitor)
                await asyncio.to_thread(wait_for, lambda: moves(commands))
            unwatched.append(await asyncio.to_thread(moved, commands, time.monotonic()))
    finally:
        process.kill()
        process.communicate()
    return [
        Stop("the run of a studio pauses", paused, 2 * PERIOD),
        Stop(f"a studio is halted for {halt:g} s", stopped, STOPS_AFTER + PERIOD),
        Stop("the last page is closed", unwatched, ABSENT + 2 * PERIOD),
    ]


async def run_again(visitor: Any) -> None:
    """Run again from the start; the link with the robot ends in a long halt, and comes back."""
    while (await visitor.ask("reset"))["problems"]:
        await asyncio.sleep(0.1)
    await visitor.do("play")


CASES = {case.__name__: case for case in (killed, halted, lost, refused, closed, served, driver, studio)}


def stops(name: str, tries: int, halt: float) -> list[Stop]:
    """Run a case in a folder of its own, which also holds its keys."""
    with (
        tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder,
        mock.patch.dict(os.environ, {"DEODAR_STATE": str(Path(folder, "state"))}),
    ):
        return list(CASES[name](Path(folder), tries, halt))


def status(load: float, late: int) -> int:
    """Return the exit status: 1 if something was late, unless the load, before or now, is too high."""
    load = max(load, os.getloadavg()[0])
    if load > MOST_LOAD * (os.cpu_count() or 1):
        print(f"not judged: the load is {load:.1f}")
        return 0
    return 1 if late else 0


def main() -> int:
    """Measure, print, and judge where the machine is quiet."""
    parser = argparse.ArgumentParser()
    parser.add_argument("case", nargs="*", help=f"one of {', '.join(CASES)} (default: all)")
    parser.add_argument("--tries", type=int, default=20)
    parser.add_argument("--halt", type=float, default=10.0)
    args = parser.parse_args()
    load, late = os.getloadavg()[0], 0
    print(f"{os.cpu_count()} cores, load {load:.1f}, {args.tries} tries each", flush=True)
    for name in args.case or CASES:
        for stop in stops(name, args.tries, args.halt):
            milliseconds = sorted(1000 * t for t in stop.times)
            missed = sum(t > 1000 * (stop.limit + MARGIN) for t in milliseconds)
            late += missed
            print(
                f"{stop.event:46} median {milliseconds[len(milliseconds) // 2]:5.0f} ms, longest"
                f" {milliseconds[-1]:5.0f} ms, at most {1000 * stop.limit:5.0f} ms:"
                f" {len(milliseconds) - missed} of {len(milliseconds)}",
                flush=True,
            )
    return status(load, late)


if __name__ == "__main__":
    sys.exit(main())
