"""What a call of a few trials costs beside the trials: `python benchmarks/trials.py`.

A field decides between two inputs; each call has four trials with another seed and other values of two
parameters, as an optimiser or a notebook makes them. `kept`: calls of one `dd.Trials`. `made again`: each
call makes a `dd.Trials` of the same model. `one by one`: the trials run without a batch. Times are of the
processor, after two calls that compile.
"""

from __future__ import annotations

import os
import time
from collections.abc import Callable

os.environ["NPROC"] = "1"

import deodar as dd

CALLS, TRIALS = 40, 4
VALUES = {"u.noise": [1.0, 1.1, 1.2, 0.9], "u.global_inhibition": [0.60, 0.61, 0.62, 0.63]}


def field() -> dd.Model:
    """A field over 101 samples with an input at 30 and a weaker one at 70."""
    model, x = dd.Model("choice"), dd.Axis("x", 0, 100, 101)
    u = model.add(dd.Field("u", [x], tau=20, noise=1.0, kernel=[dd.Gaussian(1.0, 5)], global_inhibition=0.6))
    for name, center, amplitude in (("left", 30, 6.0), ("right", 70, 5.8)):
        model.add(dd.GaussianStimulus(name, [x], center=center, sigma=5, amplitude=amplitude)) >> u
    return model


def timed(call: Callable[[int], list[dd.Trial]]) -> tuple[float, float]:
    """CPU seconds of a call, and the mean number of steps of a trial."""
    call(0), call(1)
    began, steps = time.process_time(), 0.0
    for k in range(CALLS):
        steps += sum(trial.duration for trial in call(k + 2))
    return (time.process_time() - began) / CALLS, steps / CALLS / TRIALS


def main() -> None:
    """Print the times."""
    model, ends = (
        field(),
        [dd.Appears(name, "u", near=at, radius=10.0) for name, at in (("l", 30), ("r", 70))],
    )
    plan = dd.TrialPlan(1500, events=ends)
    kept, alone = dd.Trials(model, plan), dd.Trials(model, plan, together=False)
    print(f"{TRIALS} trials a call, {CALLS} calls; load {os.getloadavg()[0]:.1f} on {os.cpu_count()} cores")
    for name, call in {
        "kept": lambda k: kept.run(range(TRIALS), k, VALUES),
        "made again": lambda k: dd.Trials(model, plan).run(range(TRIALS), k, VALUES),
        "one by one": lambda k: alone.run(range(TRIALS), k),
    }.items():
        seconds, steps = timed(call)
        rate = f"{TRIALS / seconds:5.0f} trials a second, of {steps:.0f} steps"
        print(f"{name:10} {seconds * 1e3:6.1f} ms a call, {rate}")


if __name__ == "__main__":
    main()
