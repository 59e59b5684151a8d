"""A chain of ordinal nodes learns sequences of 2 to 10 actions and produces them, with noise.

    python examples/sequences.py            a few sequences of each length
    python examples/sequences.py 100    a hundred of each: every seed has its own sequence and its own noise

During production the perceived input cycles through the same positions for every sequence: each action waits
until the input reaches its position.
"""

from __future__ import annotations

import sys

import numpy as np

import deodar as dd

PLACES = (6.0, 18.0, 30.0, 42.0, 54.0)
NEAR = 1.5


def judged(length: int, seeds: range) -> tuple[int, int, int]:
    """How many seeds were right, and of all their transitions how many were in order, and how many there
    were.
    """
    model = dd.architectures.lesson([PLACES[0]] * length, PLACES)
    right = orderly = transitions = 0
    for seed in seeds:
        sequence = np.random.default_rng([length, seed]).choice(PLACES, length)
        for k, place in enumerate(sequence, 1):
            model.set(f"shown {k}.center", float(place))
            model.set(f"end {k}.center", float(place))
        data = dd.simulate(
            model,
            dd.architectures.lesson_end(length, len(PLACES)),
            seed=seed,
            record=dd.architectures.cascade_paths(length),
        )
        begin = dd.architectures.production_start(length)
        learned = dd.architectures.cascade(data, 0.0, begin)
        produced = dd.architectures.cascade(data, begin + 250.0)
        good = [
            [t.item for t in part] == list(range(1, length + 1))
            and bool(np.all(np.abs([t.place for t in part] - sequence) < NEAR))
            for part in (learned, produced)
        ]
        right += all(good)
        orderly += sum(t.in_order for t in produced)
        transitions += len(produced)
    return right, orderly, transitions


def main(seeds: int = 3, lengths: range = range(2, 11)) -> dict[int, tuple[int, int, int]]:
    """Judge every length, and print what was found."""
    found: dict[int, tuple[int, int, int]] = {}
    for length in lengths:
        right, orderly, transitions = found[length] = judged(length, range(seeds))
        print(
            f"{length:2d} actions: learned and produced in {right} of {seeds} seeds; transitions in the right"
            f" order: {orderly} of {transitions}"
        )
    return found


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
