"""CPU time of a step of every workload, ours and the yardstick's in alternation.

Ours run in one process (`python benchmarks/steps.py`, with NPROC=1) that reads lines "WORKLOAD STEPS" and
answers each with the CPU seconds of that call of `dd.simulate`; the yardstick is one process for each
workload and answers in the same way. A step is (T(2n) - T(n)) / n.
"""

from __future__ import annotations

import argparse
import contextlib
import dataclasses as dc
import os
import shutil
import statistics
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import IO

import deodar as dd
import workloads

HERE = Path(__file__).parent
CLOSED, BETWEEN = 1000, 10
CLOSED_LOOP = "closed_loop"
FLAGS = ["-O3", "-march=native", "-fno-math-errno", "-fno-trapping-math"]


@dc.dataclass(frozen=True)
class Row:
    """A figure of one workload.

    Attributes:
        us: microseconds a step, the median of the rounds; `spread`: (largest - smallest) / median.
        c_us: the same of the yardstick, None without.
        ratio: to the yardstick, or to the workload `to` of the same run; None where it could not be taken.
        earlier: to the yardstick that the target was set against.
    """

    name: str
    meaning: str
    us: float
    c_us: float | None
    ratio: float | None
    earlier: float | None
    to: str
    target: float | None
    spread: float


# ---------------------------------------------------------------------------------- the process that is timed


class Timed:
    """The workloads of a process; each is made at its first call."""

    def __init__(self) -> None:
        self.models: dict[str, dd.Model] = {}
        self.sessions: dict[str, dd.Session] = {}

    def run(self, name: str, count: int) -> float:
        """Return the CPU seconds of `count` steps of a workload."""
        workload = workloads.CLOSED_LOOP if name == CLOSED_LOOP else workloads.WORKLOADS[name]
        if workload.session:
            return self._session(name, workload, count)
        world = workload.world() if workload.world else None
        model = self.models.setdefault(name, workload.model())
        before = time.process_time()
        duration = count * model.document.step
        dd.simulate(
            model, duration, trials=workload.trials or None, world=world, on=dd.Resources(progress=False)
        )
        return time.process_time() - before

    def _session(self, name: str, workload: workloads.Workload, count: int) -> float:
        if name not in self.sessions:
            world = workload.world() if workload.world else None
            session = self.sessions[name] = dd.Session(workload.model(), world=world)
            _closed_loop(session, 4 * BETWEEN) if name == CLOSED_LOOP else session.step(4)
        session = self.sessions[name]
        before = time.process_time()
        _closed_loop(session, count) if name == CLOSED_LOOP else session.step(count)
        return time.process_time() - before


def serve() -> None:
    """Answer lines "WORKLOAD STEPS" with CPU seconds."""
    timed = Timed()
    for line in sys.stdin:
        name, steps = line.split()
        print(f"{timed.run(name, int(steps)):.9f}", flush=True)


def _closed_loop(session: dd.Session, steps: int) -> None:
    for k in range(steps // BETWEEN):
        session.set("u3.resting_level", -5 + 0.01 * (k % 7))
        session.step(BETWEEN)
        session.read("u3.activation")


def require_known(parser: argparse.ArgumentParser, names: Sequence[str], known: Sequence[str]) -> None:
    """End the command with the known names if it got another one."""
    unknown = [name for name in names if name not in known]
    if unknown:
        parser.error(f"unknown: {', '.join(unknown)}; there are {', '.join(known)}")


# ------------------------------------------------------------------------------------ the processes beside it


def compiler() -> str | None:
    """A C compiler of this machine."""
    return next(
        (
            found
            for name in (os.environ.get("CC", ""), "gcc", "clang", "cc")
            if name and (found := shutil.which(name))
        ),
        None,
    )


def build(
    cc: str, folder: Path, name: str, shape: Sequence[int], sigmas: tuple[int, int], trials: int
) -> Path:
    """The yardstick for one workload."""
    sizes = [*shape, 1, 1][:3]
    made = folder / name
    keys = ("DIM", "N0", "N1", "N2", "TRIALS", "SIGMA_EXC", "SIGMA_INH")
    defined = [
        f"-D{key}={value}"
        for key, value in zip(keys, (len(shape), *sizes, trials or 1, *sigmas), strict=True)
    ]
    subprocess.run([cc, *FLAGS, *defined, str(HERE / "yardstick.c"), "-o", str(made), "-lm"], check=True)
    return made


@contextlib.contextmanager
def process(*command: str, **environment: str) -> Iterator[Callable[[str], float]]:
    """A process that answers each line with CPU seconds; `environment`: variables that it has besides."""
    environment = {**os.environ, "NPROC": "1", **environment}
    running = subprocess.Popen(
        command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, env=environment
    )
    to, back = _pipe(running.stdin), _pipe(running.stdout)

    def ask(line: str) -> float:
        to.write(line + "\n")
        to.flush()
        answer = back.readline()
        if not answer:
            raise RuntimeError(f"{' '.join(command)} ended at {line!r}")
        return float(answer)

    try:
        yield ask
    finally:
        to.close()
        running.wait(30)
        back.close()


def _pipe(stream: IO[str] | None) -> IO[str]:
    if stream is None:
        raise RuntimeError("a process without pipes")
    return stream


# -------------------------------------------------------------------------------------------------- measuring


def measure(names: Sequence[str], rounds: int, seconds: float, folder: Path) -> list[Row]:
    """The figures of the named workloads and of those they are compared with; about `seconds` of CPU for each
    T(n).
    """
    table = workloads.WORKLOADS
    closed = CLOSED_LOOP in names
    chosen = {*names} - {CLOSED_LOOP} | ({workloads.CLOSED_LOOP.to} if closed else set())
    while more := {table[name].to for name in chosen} - chosen - {"C"}:
        chosen |= more
    wanted = [name for name in table if name in chosen]
    cc = compiler()
    with contextlib.ExitStack() as stack:
        ours = stack.enter_context(process(sys.executable, str(HERE / "steps.py")))
        askers: dict[str, list[Callable[[int], float]]] = {}
        for name in wanted:
            w = table[name]
            askers[name] = [lambda n, name=name: ours(f"{name} {n}")]
            if cc and w.shape:
                c = stack.enter_context(process(str(build(cc, folder, name, w.shape, w.sigmas, w.trials))))
                askers[name].append(lambda n, c=c: c(f"{n} 1"))
        counts = {name: [count(ask, seconds) for ask in both] for name, both in askers.items()}
        if closed:
            ours(f"{CLOSED_LOOP} {CLOSED}")
        times: dict[str, list[list[float]]] = {name: [[] for _ in both] for name, both in askers.items()}
        loop: list[float] = []
        for _ in range(rounds):
            for name, both in askers.items():
                for k, ask in enumerate(both):
                    n = counts[name][k]
                    once, twice = ask(n), ask(2 * n)
                    times[name][k].append(1e6 * (twice - once) / n)
            if closed:
                loop.append(1e6 * ours(f"{CLOSED_LOOP} {CLOSED}") / CLOSED)
    medians = {name: [statistics.median(t) for t in both] for name, both in times.items()}
    rows = [_row(name, table[name], times[name][0], medians) for name in wanted]
    if closed:
        rows.append(_row(CLOSED_LOOP, workloads.CLOSED_LOOP, loop, medians))
    return rows


def count(ask: Callable[[int], float], seconds: float) -> int:
    """Even number of steps that take about so long beyond what every call takes; the first call compiles."""
    ask(20)
    n, slope = 20, 0.0
    while n < 4_000_000 and (slope := min(ask(2 * n), ask(2 * n)) - min(ask(n), ask(n))) < 0.3 * seconds:
        n *= 4
    return max(2, 2 * round(0.5 * n * seconds / max(slope, 0.1 * seconds)))


def _row(name: str, w: workloads.Workload, times: Sequence[float], medians: dict[str, list[float]]) -> Row:
    us = statistics.median(times)
    c_us = medians[name][1] if len(medians.get(name, ())) > 1 else None
    base = c_us if w.to == "C" else medians[w.to][0]
    ratio = us / base if base else None
    judged = ratio is not None and w.to == "C" and w.target is not None
    earlier = ratio / w.earlier if judged else None
    return Row(name, w.meaning, us, c_us, ratio, earlier, w.to, w.target, (max(times) - min(times)) / us)


if __name__ == "__main__":
    serve()
