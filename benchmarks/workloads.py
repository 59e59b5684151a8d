"""The models whose steps are timed: single fields in one, two and three dimensions, a batch of trials, two
architectures of coupled fields, and those of two papers: the planner of a vehicle beside its arena, and the
search for a colour in a photograph.

All fields but those of the papers are rings or tori of unit spacing with tau = 20, h = -5, a logistic
output of steepness 4, noise of strength 1 in every step, global inhibition 0.1, and a kernel of two
normalised Gaussians, 15 and -8.
"""

from __future__ import annotations

import dataclasses as dc
import random
from collections.abc import Callable, Sequence

import deodar as dd
from deodar.architectures.saliency import saliency
from deodar.architectures.spa import maze, spa
from deodar.couplings.convolutions import Convolve
from deodar_papers.saliency.scenes import photographs

NAMES = "xyz"


@dc.dataclass(frozen=True)
class Workload:
    """What is run, and how its time is judged.

    Attributes:
        model: makes the model.
        meaning: in words.
        target: the highest ratio wanted, of the time of a step to that of `to`; None: none is set.
        to: "C" (the yardstick), or another workload of the same run.
        world: makes the world beside the model.
        session: steps are taken by a `dd.Session`, which exchanges values with the world at each of them, and
            not by `dd.simulate`.
        trials: how many copies run at once; 0: one, without the axis.
        shape, sigmas: what the yardstick is compiled for.
        earlier: how many times the yardstick that the targets were set against was slower than this one
            (README.md).
    """

    model: Callable[[], dd.Model]
    meaning: str
    target: float | None
    to: str = "C"
    world: Callable[[], dd.World] | None = None
    session: bool = False
    trials: int = 0
    shape: tuple[int, ...] = ()
    sigmas: tuple[int, int] = (0, 0)
    earlier: float = 1.0


def axes(shape: Sequence[int]) -> list[dd.Axis]:
    """Periodic axes of unit spacing."""
    return [dd.Axis(name, 0, n, samples=n, periodic=True) for name, n in zip(NAMES, shape, strict=False)]


def field(name: str, shape: Sequence[int], sigmas: tuple[int, int]) -> dd.Field:
    """A field with lateral excitation and inhibition of these widths."""
    kernel = [dd.Gaussian(15, sigmas[0], normalized=True), dd.Gaussian(-8, sigmas[1], normalized=True)]
    return dd.Field(
        name, axes(shape), tau=20, resting_level=-5, kernel=kernel, global_inhibition=0.1, noise=1.0
    )


def stimulus(shape: Sequence[int]) -> dd.GaussianStimulus:
    """A Gaussian of amplitude 6 and width 3 in the middle."""
    return dd.GaussianStimulus("s", axes(shape), center=[n // 2 for n in shape], sigma=3, amplitude=6)


def single(shape: Sequence[int], sigmas: tuple[int, int]) -> dd.Model:
    """One field and its stimulus."""
    model = dd.Model("one field")
    model.add(stimulus(shape)) >> model.add(field("u", shape, sigmas))
    return model


def targets(count: int, seed: int | None) -> list[int]:
    """Where the coupling of each source goes: to the next one round the ring, or anywhere but to itself."""
    if seed is None:
        return [(k + 1) % count for k in range(count)]
    number = random.Random(seed)
    while True:
        drawn = number.sample(range(count), count)
        if all(k != target for k, target in enumerate(drawn)):
            return drawn


def lines(seed: int | None = None) -> dd.Model:
    """20 fields of 100 samples coupled in a ring, each with a node that it drives and that boosts it; with a
    seed the targets are shuffled.
    """
    model = dd.Model("lines and nodes")
    fields = [model.add(field(f"u{k}", [100], (5, 10))) for k in range(20)]
    nodes = [
        model.add(dd.Field(f"v{k}", tau=20, resting_level=-5, kernel=[dd.Gaussian(2.0)], noise=1.0))
        for k in range(20)
    ]
    model.add(stimulus([100])) >> fields[0]
    for k, target in enumerate(targets(20, seed)):
        fields[k] >> Convolve([dd.Gaussian(3, 5, normalized=True)]) >> fields[target]
    to_nodes, to_fields = (
        ([*range(20)], [*range(20)]) if seed is None else (targets(20, seed + 1), targets(20, seed + 2))
    )
    for k in range(20):
        fields[k] >> dd.Gain(0.05) >> nodes[to_nodes[k]]
        nodes[k] >> fields[to_fields[k]]
    return model


def planes(seed: int | None = None) -> dd.Model:
    """16 fields of 50 x 50 samples coupled in a ring; with a seed the targets are shuffled."""
    model = dd.Model("planes")
    fields = [model.add(field(f"u{k}", [50, 50], (3, 6))) for k in range(16)]
    model.add(stimulus([50, 50])) >> fields[0]
    for k, target in enumerate(targets(16, seed)):
        fields[k] >> Convolve([dd.Gaussian(3, 3, normalized=True)]) >> fields[target]
    return model


def planner() -> dd.Model:
    """The planner of a vehicle in the Z-maze: 16 fields of 100 x 100, nodes, and the sensors of an arena."""
    return spa(maze("z"))


def photograph() -> dd.World:
    """The first of the photographs in which deodar searches."""
    return photographs()[0].picture


def _single(
    shape: tuple[int, ...], sigmas: tuple[int, int], target: float, earlier: float, trials: int = 0
) -> Workload:
    meaning = "one field, " + " x ".join(map(str, shape)) + (f", {trials} trials at once" if trials else "")
    return Workload(
        lambda: single(shape, sigmas),
        meaning,
        target,
        trials=trials,
        shape=shape,
        sigmas=sigmas,
        earlier=earlier,
    )


WORKLOADS = {
    "W1_100": _single((100,), (5, 10), 1.7, 3.2),
    "W1_200": _single((200,), (5, 10), 2.1, 2.5),
    "W1_500": _single((500,), (5, 10), 2.4, 1.9),
    "W2_50": _single((50, 50), (3, 6), 0.85, 1.9),
    "W2_100": _single((100, 100), (3, 6), 1.0, 1.55),
    "W2_200": _single((200, 200), (3, 6), 1.3, 1.5),
    "W3": _single((50, 50, 30), (3, 6), 0.65, 1.75),
    "W5": _single((200,), (5, 10), 1.45, 1.5, trials=100),
    "W4a": Workload(lines, "ring of 20 fields of 100 and 20 nodes", 10, to="W1_100"),
    "W4a_shuffled": Workload(lambda: lines(1), "the same, couplings shuffled", 1.25, to="W4a"),
    "W4b": Workload(planes, "ring of 16 fields of 50 x 50", 16, to="W2_50"),
    "W4b_shuffled": Workload(lambda: planes(1), "the same, couplings shuffled", 1.25, to="W4b"),
    "SPA": Workload(
        planner,
        "planner of 16 fields of 100 x 100, its arena inside the run",
        None,
        world=lambda: maze("z"),
        shape=(100, 100),
        sigmas=(3, 6),
    ),
    "SPA_session": Workload(
        planner,
        "the same, a session beside the arena",
        None,
        to="SPA",
        world=lambda: maze("z"),
        session=True,
    ),
    "saliency": Workload(
        saliency,
        "search in a photograph: a field of 40 x 40 x 30, one of 40 x 40, ...",
        None,
        world=photograph,
        shape=(40, 40, 30),
        sigmas=(3, 6),
    ),
}
CLOSED_LOOP = Workload(
    lines,
    "W4a in a session: every 10 steps one parameter set, one field read",
    3,
    to="W4a",
    session=True,
)
