"""Runs that are killed while they write their record: it holds all samples up to less than a second before,
with the bits of an undisturbed run, and is resumed to the same end.

The process of a run notes the wall time at which each step was complete, beside the record. A kill may lose
what is younger than a second, or the samples of the last chunk of steps, where one takes longer.
"""

from __future__ import annotations

import dataclasses as dc
import os
import random
import shutil
import subprocess
import sys
import time
import unittest.mock
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import xarray

import deodar as dd
from deodar.recording import files

LOST_SECONDS = 1.0
"""Age of the oldest step that a kill may lose, on a machine that has a core for the run and one to write."""

STEPS = 10**6
ROOT = Path(__file__).parents[2]


@dc.dataclass
class Outcome:
    """Results after the kills."""

    kills: int = 0
    samples: int = 0
    resumed: int = 0
    worst: float = 0.0
    errors: list[str] = dc.field(default_factory=list[str])


def model(kind: str) -> dd.Model:
    """Return a noisy model: `line` or `plane` with a node."""
    network = dd.Model(kind)
    x = dd.Axis("x", 0, 20, samples=30)
    axes = [x] if kind == "line" else [x, dd.Axis("y", 0, 20, samples=40)]
    network.add(dd.Field("u", axes, kernel=[dd.Gaussian(6, 2)], noise=0.5))
    (
        network.add(dd.GaussianStimulus("s", axes, center=[10.0] * len(axes), sigma=3, amplitude=6))
        >> network["u"]
    )
    network.add(dd.Field("n", [], tau=10, noise=0.2))
    return network


CASES: dict[str, tuple[str, dict[str, Any]]] = {
    "line": ("line", {"record": ["u", "n"]}),
    "plane": ("plane", {"record": ["u", "n.output"], "every": 2}),
    "trials": ("line", {"record": ["u"], "every": 3, "trials": 5}),
    "pieces": ("line", {"record": ["n"], "every": 50, "trials": 4, "on": dd.Resources(batch=2)}),
    "workers": ("line", {"record": ["n"], "every": 50, "trials": 4, "on": dd.Resources(workers=2)}),
}

RESUMED = tuple(case for case in CASES if case != "workers")
"""Cases that are stopped after a number of steps: the pieces of workers stop where their chunks end."""


def child(case: str, out: str, notes: str) -> None:
    """Run a model without end, and note the wall time of each chunk."""
    kind, settings = CASES[case]
    with open(notes, "wb", buffering=0) as file:

        def note(done: int) -> None:
            if done:  # workers begin after their parent
                file.write(f"{time.time()!r} {done}\n".encode())

        dd.simulate(
            model(kind),
            STEPS * (10 if case == "workers" else 1),
            seed=3,
            out=out,
            **settings | {"on": dc.replace(settings.get("on", dd.Resources()), progress=note)},
        )


def kill(folder: Path, case: str, seconds: float, outcome: Outcome, limit: float = LOST_SECONDS) -> Path:
    """Run a case, kill it some seconds after its first chunk of steps, and check its record; return it.

    A record without samples is as good as another one if it is right: nothing may be a second old.
    """
    out, notes = folder / f"{case}-{outcome.kills}", folder / f"notes-{outcome.kills}"
    code = f"from tests.attacks.records import child; child({case!r}, {str(out)!r}, {str(notes)!r})"
    path = os.pathsep.join(filter(None, [str(ROOT), os.environ.get("PYTHONPATH", "")]))
    process = subprocess.Popen([sys.executable, "-c", code], env=os.environ | {"PYTHONPATH": path})
    began = time.time()
    while not (notes.exists() and notes.stat().st_size) and time.time() < began + 120:
        time.sleep(0.005)  # until then the run compiles, for as long as the machine needs
    time.sleep(seconds)
    process.kill()
    killed = time.time()
    process.wait()
    outcome.kills += 1
    lines = [line.split() for line in notes.read_text().splitlines() if line.count(" ") == 1]
    record = files.load_record(out)
    samples = record.sizes["time"]
    outcome.samples += samples
    every = int(CASES[case][1].get("every", 1))
    steps = (samples - 1) * every if samples else 0
    own = [samples] * 2
    if case == "workers" and samples:  # both pieces note the sum of their steps
        values = record["n.activation"].values
        own = [int(np.isfinite(values[first]).sum()) for first in (0, 2)]
        lost = [killed - float(at) for at, done in lines if int(done) >= sum(own) * every]
    else:
        lost = [killed - float(at) for at, done in lines if int(done) % STEPS >= steps + every]
    outcome.worst = max([outcome.worst, *lost])
    if any(age > limit for age in lost):
        outcome.errors.append(f"{case}: {max(lost):.2f} s are lost")
    if not samples:
        return out
    expected = undisturbed(case, steps)
    cut = {name: slice(n) for name, n in record.sizes.items()}
    whole = expected.isel(cut)
    for name in record.data_vars:
        same = record[name].values.tobytes() == whole[name].values.tobytes()
        if case in ("pieces", "workers"):  # of the second piece nothing may be written yet
            same = all(
                record[name].values[k, : own[k // 2]].tobytes()
                == whole[name].values[k, : own[k // 2]].tobytes()
                for k in range(4 if case == "workers" else 2)
            )
        if not same:
            outcome.errors.append(f"{case}: {name} differs from an undisturbed run")
    return out


def undisturbed(case: str, duration: float) -> xarray.Dataset:
    """Return the record of a case that nothing disturbed."""
    kind, settings = CASES[case]
    return dd.simulate(model(kind), duration, seed=3, **settings)


def resume(folder: Path, case: str, outcome: Outcome) -> None:
    """Stop a run after a number of steps that is drawn, resume it twice, and compare it with a whole one."""
    kind, settings = CASES[case]
    out, end = folder / f"{case}-resumed-{outcome.resumed}", 3000.0

    def stopping(after: int) -> Callable[[int], None]:
        def stop(done: int) -> None:
            if done >= after:
                raise KeyboardInterrupt

        return stop

    with unittest.mock.patch("deodar.session.run.CHUNK_SECONDS", 0.002):
        for again in range(2):
            try:
                if again:
                    dd.resume(out, on=dd.Resources(progress=stopping(1800)))
                else:
                    fields: dict[str, Any] = {"seed": 3, "out": dd.Output(out, snapshots=200), **settings}
                    on = dc.replace(settings.get("on", dd.Resources()), progress=stopping(600))
                    dd.simulate(model(kind), end, **fields | {"on": on})
            except dd.errors.Interrupted:
                pass
            else:
                outcome.errors.append(f"{case}: the run was not stopped")
    dd.resume(out)
    record, whole = files.load_record(out), undisturbed(case, end)
    outcome.resumed += 1
    for name in whole.variables:
        if record[name].values.tobytes() != whole[name].values.tobytes():
            outcome.errors.append(f"{case}: {name} differs after the run was resumed")


def attack(
    folder: Path,
    kills: int,
    seed: int,
    cases: Sequence[str] = tuple(CASES),
    resumed: Sequence[str] = RESUMED,
    longest: float = 3.0,
    limit: float = LOST_SECONDS,
) -> Outcome:
    """Kill runs of some cases up to `longest` seconds after their first chunk, and stop and resume others.

    The later in the attack, the later a run is killed, so that the last ones have samples that must be there.
    """
    draw, outcome = random.Random(seed), Outcome()
    for k in range(kills):
        case = cases[k % len(cases)]
        seconds = (k + draw.random()) / kills * longest
        shutil.rmtree(kill(folder, case, seconds, outcome, limit), ignore_errors=True)
    for case in resumed:
        resume(folder, case, outcome)
    return outcome
