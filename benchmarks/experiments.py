"""What it costs to watch what happens: trials of a selection experiment beside as many plain simulations in
one batch.

    python benchmarks/experiments.py

A field of 200 samples with two equal inputs; 1,000 trials of 2,000 steps. The experiment looks, at every
fifth step and at each step, whether a peak has appeared near either place, and measures where the field is
highest; no trial ends before the limit, so that all compute the same steps. Each is run once before it is
timed, so that none compiles, then in alternation; the least of the rounds counts. Times are of the processor,
which other work on the machine affects less than the wall clock; with `--workers N` they are of the
wall, with the start of the processes.
"""

from __future__ import annotations

import argparse
import dataclasses as dc
import os
import time
from collections.abc import Callable

TARGET = 1.3


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--trials", type=int, default=1000)
    parser.add_argument("--steps", type=int, default=2000)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--workers", type=int, help="number of processes that share the trials")
    given = parser.parse_args()
    os.environ["NPROC"] = "1"

    import deodar as dd
    from deodar.experiments.events import Appears
    from deodar.experiments.experiment import Experiment
    from deodar.experiments.measures import Measure

    x = dd.Axis("x", 0, 100, samples=200)
    model = dd.Model("selection")
    kernel = [dd.Gaussian(amplitude=1.2, sigma=5)]
    u = model.add(
        dd.Field("u", [x], tau=20, resting_level=-5, kernel=kernel, global_inhibition=0.6, noise=1.0)
    )
    for name, center in (("left", 30), ("right", 70)):
        model.add(dd.GaussianStimulus(name, [x], center=center, sigma=5, amplitude=6)) >> u
    conditions = [
        Appears(name, "u", near=center, radius=10, ends=False)
        for name, center in (("left", 30), ("right", 70))
    ]
    experiment = Experiment(
        "selection",
        model,
        dd.TrialPlan(given.steps, events=conditions, measures=[Measure("where", "u.activation", "place")]),
        given.trials,
    )

    def watched(every: float) -> Callable[[], object]:
        return lambda: dc.replace(experiment, every=every).run(on=dd.Resources(workers=given.workers))

    ways: dict[str, Callable[[], object]] = {
        "plain": lambda: dd.simulate(
            model, given.steps, trials=given.trials, on=dd.Resources(workers=given.workers)
        )
    }
    ways |= {f"looks every {n} ms": watched(n) for n in (5, 1)}
    clock = time.perf_counter if given.workers else time.process_time
    print(
        f"{given.trials} trials of {given.steps} steps, one field of 200 samples; load"
        f" {os.getloadavg()[0]:.1f}"
    )
    least = dict.fromkeys(ways, float("inf"))
    for round_ in range(given.rounds + 1):
        for name, run in ways.items():
            began = clock()
            run()
            least[name] = min(least[name], clock() - began) if round_ else least[name]
    for name, seconds in least.items():
        print(f"{name:18} {seconds:6.2f} s, {seconds / least['plain']:.2f} of plain (target {TARGET})")


if __name__ == "__main__":
    main()
