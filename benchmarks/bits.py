"""Whether the bits of a copy depend on anything but the width of its batch, in single precision.

    python benchmarks/bits.py                   1,000 random combinations
    python benchmarks/bits.py --count 50 --seed 7
    python benchmarks/bits.py --cost    what a single run would cost if it were computed in a wider batch

Each combination draws a model, the order in which it is declared, a width, trials in any number and order,
what is recorded and how often, the lengths of chunks, and now and then worker processes, programs that are
compiled again, or a session in place of a batch of one. Every record of a trial is compared with the first
that was made of it at this width. At the end the widths of each model are compared with each other.
"""

from __future__ import annotations

import argparse
import dataclasses as dc
import random
import time
from collections.abc import Callable, Iterator
from unittest import mock

import numpy as np

import deodar as dd
from deodar.model.model import Model
from deodar.session.run import Run

STEPS = 24
WIDTHS = (1, 2, 3, 4, 7, 16)
INTERVALS = (1, 2, 3, 4, 6, 8, 12, 24)
TRIALS = 40


def line(samples: int, fields: int, order: int) -> Model:
    """Fields of one line, each coupled to the next, with noise and a stimulus."""
    x = dd.Axis("x", 0, 60, samples=samples)
    model = dd.Model("line")
    for k in range(fields)[::order]:
        model.add(
            dd.Field(
                f"u{k}",
                [x],
                tau=10,
                kernel=[dd.Gaussian(1.2, 4), dd.Gaussian(-0.4, 9)],
                global_inhibition=0.1,
                noise=0.3,
            )
        )
    model.add(dd.GaussianStimulus("s", [x], center=30, sigma=4, amplitude=8)) >> model["u0"]
    for k in range(fields)[::order]:
        model["u0" if fields == 1 else f"u{k}"] >> dd.Gain(1.5, name=f"g{k}") >> model[f"u{(k + 1) % fields}"]
    return model


def plane(order: int) -> Model:
    """A plane that reads a line, and a node that reads both."""
    x, y = dd.Axis("x", 0, 20, samples=21), dd.Axis("y", 0, 15, samples=16, periodic=True)
    model = dd.Model("plane")
    makers: list[Callable[[], object]] = [
        lambda: model.add(
            dd.Field("u0", [x, y], tau=10, kernel=[dd.Gaussian(1.0, 2)], global_inhibition=0.02, noise=0.2)
        ),
        lambda: model.add(dd.Field("u1", [x], tau=15, kernel=[dd.Gaussian(1.5, 3)], noise=0.2)),
        lambda: model.add(dd.Field("u2", [], tau=5, noise=0.1)),
    ]
    for make in makers[::order]:
        make()
    model.add(dd.GaussianStimulus("s", [x], center=8, sigma=2, amplitude=6)) >> model["u1"]
    model["u1"] >> dd.Gain(0.8, name="a") >> model["u0"]
    model["u0"] >> dd.Gain(0.05, name="b") >> model["u2"]
    return model


MODELS: dict[str, Callable[[int], Model]] = {
    "two lines of 31": lambda order: line(31, 2, order),
    "three lines of 101": lambda order: line(101, 3, order),
    "a plane, a line and a node": plane,
}


@dc.dataclass
class Found:
    """What was seen: for each model, width, trial, path and step the first values; and what differed from
    them.
    """

    first: dict[tuple[str, int, int, str, int], np.ndarray] = dc.field(default_factory=dict)
    compared: int = 0
    differences: list[str] = dc.field(default_factory=list)

    def take(self, key: tuple[str, int, int, str, int], values: np.ndarray, how: str) -> None:
        """Keep values, or compare them with those that are kept."""
        kept = self.first.setdefault(key, values)
        self.compared += kept is not values
        if not np.array_equal(kept, values):
            self.differences.append(f"{how}: {key} by {np.abs(kept - values).max():.2g}")

    def widths(self) -> Iterator[tuple[str, list[list[int]], float]]:
        """For each model the widths that agree to the bit, and the largest difference between any two."""
        for name in MODELS:
            by: dict[int, dict[tuple[int, str, int], np.ndarray]] = {}
            for (model, width, *rest), values in self.first.items():
                if model == name:
                    by.setdefault(width, {})[tuple(rest)] = values  # type: ignore[index]
            alike: list[list[int]] = []
            largest = 0.0
            for width in sorted(by):
                gaps = {}
                for other in sorted(by):
                    shared = by[width].keys() & by[other].keys()
                    gaps[other] = max(
                        (float(np.abs(by[width][k] - by[other][k]).max()) for k in shared), default=0.0
                    )
                largest = max(largest, *gaps.values())
                home = next((group for group in alike if gaps[group[0]] == 0), None)
                if home is None:
                    alike.append([width])
                else:
                    home.append(width)
            yield name, alike, largest


def check(
    count: int,
    seed: int = 0,
    names: list[str] | None = None,
    widths: tuple[int, ...] = WIDTHS,
    workers_every: int = 100,
) -> Found:
    """Draw combinations and compare."""
    draw, found = random.Random(seed), Found()
    models: dict[tuple[str, int], Model] = {}
    for n in range(count):
        name, order, width = draw.choice(names or list(MODELS)), draw.choice((1, -1)), draw.choice(widths)
        if draw.random() < 0.05:
            models.pop((name, order), None)  # the programs are compiled again, or read from the disk
        model = models.setdefault((name, order), MODELS[name](order))
        paths = sorted(
            draw.sample([f"u{k}.activation" for k in range(3) if f"u{k}" in model], draw.choice((1, 2)))
        )
        trials = draw.sample(range(TRIALS), draw.randint(width, max(width, 12)))
        every, longest = draw.choice(INTERVALS), draw.choice((1, 5, 7, 1000))
        workers = 2 if workers_every and n % workers_every == workers_every - 1 else None
        how = f"order {order}, trials {trials}, every {every}, chunks of {longest}, workers {workers}"
        with mock.patch.object(Run, "_chunk_steps", lambda run, longest=longest: longest):
            if width == 1 and draw.random() < 0.3:
                session = dd.Session(model, seed=seed, trial=trials[0])
                session.step(STEPS)
                for path in paths:
                    found.take((name, width, trials[0], path, STEPS), session.read(path), f"a session, {how}")
                continue
            data = dd.simulate(
                model,
                STEPS,
                seed=seed,
                record=paths,
                every=every,
                trials=trials,
                on=dd.Resources(workers=workers, batch=width),
            )
        for path in paths:
            values = data[path].values
            for t, trial in enumerate(trials):
                for k in range(values.shape[1]):
                    found.take((name, width, trial, path, k * every), values[t, k], how)
    return found


def cost(name: str, width: int, steps: int = 20_000) -> float:
    """Microseconds of a step of a batch: the quickest of seven runs, less the quickest of those without
    steps.
    """
    model, best = MODELS[name](1), {0: float("inf"), steps: float("inf")}
    for _ in range(7):
        for duration in best:
            began = time.perf_counter()
            dd.simulate(model, duration, trials=width, on=dd.Resources(progress=False))
            best[duration] = min(best[duration], time.perf_counter() - began)
    return 1e6 * (best[steps] - best[0]) / steps


def main() -> None:
    """Check and print."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--count", type=int, default=1000, help="of combinations (default 1000)")
    parser.add_argument("--seed", type=int, default=0, help="of what is drawn (default 0)")
    parser.add_argument("--cost", action="store_true", help="print the time of a step over the width instead")
    args = parser.parse_args()
    if args.cost:
        for name in MODELS:
            times = {width: cost(name, width) for width in (1, 2, 4, 8, 16)}
            print(
                f"{name}: a single run {times[1]:.1f} us a step; as wide as "
                + ", ".join(f"{w}: {t / times[1]:.2f}x" for w, t in times.items())
            )
        return
    found = check(args.count, args.seed)
    print(
        f"{args.count} combinations, {found.compared} comparisons, {len(found.differences)} differ in a bit"
    )
    for line in found.differences[:10]:
        print(f"  {line}")
    for name, alike, largest in found.widths():
        print(
            f"{name}: widths that agree {' | '.join(', '.join(map(str, group)) for group in alike)}; largest"
            f" difference {largest:.2g}"
        )
    raise SystemExit(bool(found.differences))


if __name__ == "__main__":
    main()
