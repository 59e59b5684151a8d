"""What trials with actions cost in one batch, and one by one: `python benchmarks/actions.py`.

Sixteen robots, each with a block at a place of its own, drive for 300 steps with a map of 26 x 11 cells.
`timed`: one object appears, another one vanishes, and a parameter is set, at stated times. `events`: two of
these wait for an event, so that the batch stops at each sample until all trials have had it. Each is run once
before it is timed, so that none compiles; the least of three rounds counts. Times are of the processor.
"""

from __future__ import annotations

import functools
import os
import time
from collections.abc import Callable

os.environ["NPROC"] = "1"

import deodar as dd

STEPS, TRIALS = 300, 16
ROOM = {
    "unit": "cm",
    "arena": {"x": [0, 100], "y": [0, 40]},
    "walls": [{"name": "far", "center": [97, 20], "size": [4, 40]}],
}
TOUCHED = dd.Crosses("touched", "touching.output", 0.5, ends=False)


def robot() -> dd.Model:
    """A robot that drives straight on."""
    model = dd.Model("straight", time_unit="1 = 64 ms")
    for wheel in ("left", "right"):
        model.add(dd.Boost(f"go {wheel}", amplitude=600.0)) >> model.add(dd.Motor(wheel, motor=wheel))
    model.add(dd.Sensor("touching", [], sensor="touching"))
    plane = [dd.Axis("x", 0, 100, 26, unit="cm"), dd.Axis("y", 0, 40, 11, unit="cm")]
    model.add(dd.Sensor("map", plane, sensor="obstacles"))
    return model


def actions(when: str) -> list[dd.Action]:
    """Three actions; two of them wait for an event, if one is named."""
    return [
        dd.Place(60, "box", (60, 10), (4, 9)),
        dd.Remove(12 if when else 80, "own", when=when),
        dd.Set(20 if when else 100, "go left.amplitude", 550.0, when=when),
    ]


def least(run: Callable[[], object]) -> float:
    """CPU seconds of the fastest of three runs, after one that compiles."""
    run()
    spent: list[float] = []
    for _ in range(3):
        began = time.process_time()
        run()
        spent.append(time.process_time() - began)
    return min(spent)


def main() -> None:
    """Print the times."""
    world = dd.Arena(ROOM, unit="cm", start=(10, 20, 0))
    world.place("own", center=[(30 + k, 20) for k in range(TRIALS)], size=(4, 4))
    print(f"{TRIALS} trials of {STEPS} steps in an arena; load {os.getloadavg()[0]:.1f}")
    for name, when in (("timed", ""), ("events", "touched")):
        model, given = robot(), actions(when)
        plan = dd.TrialPlan(STEPS, events=[TOUCHED], actions=given)
        batch, single = (
            least(functools.partial(dd.Trials(model, plan, world, together=together).run, range(TRIALS)))
            for together in (True, False)
        )
        print(f"{name:8} {batch:6.3f} s in a batch, {single:6.3f} s one by one, {single / batch:.0f} times")


if __name__ == "__main__":
    main()
