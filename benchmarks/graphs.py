"""Architectures of 60 fields and 300 couplings, for the time that compiling takes."""

from __future__ import annotations

import random

import deodar as dd
from deodar.couplings.convolutions import Convolve


def _field(name: str, axes: list[dd.Axis], number: random.Random) -> dd.Field:
    kernel = (
        [dd.Gaussian(15 + number.random(), 5, normalized=True), dd.Gaussian(-8, 10, normalized=True)]
        if axes
        else [dd.Gaussian(2.0)]
    )
    return dd.Field(name, axes, kernel=kernel, global_inhibition=0.1, noise=0.5)


def line_fields(convolutions: int) -> dd.Model:
    """Graphs A (0 convolutions, 300 gains) and B (100 convolutions, 200 gains): 60 one-dimensional fields of
    100 samples.
    """
    number = random.Random(1)
    x = dd.Axis("x", 0, 100, samples=100, periodic=True)
    model = dd.Model("lines")
    fields = [model.add(_field(f"u{k}", [x], number)) for k in range(60)]
    for k in range(300):
        source, target = number.sample(range(60), 2)
        strength = number.uniform(-1, 1)
        coupling = (
            Convolve([dd.Gaussian(strength, 3, normalized=True)]) if k < convolutions else dd.Gain(strength)
        )
        fields[source] >> coupling >> fields[target]
    return model


def mixed_fields() -> dd.Model:
    """Graph C: 34 fields over two line axes, 6 fields over planes, 20 nodes, and 300 mixed couplings between
    them.
    """
    number = random.Random(2)
    x = dd.Axis("x", 0, 100, samples=100, periodic=True)
    hue = dd.Axis("hue", 0, 360, samples=60, periodic=True)
    model = dd.Model("mixed")
    kinds = [[x]] * 24 + [[hue]] * 10 + [[x, hue]] * 6 + [[]] * 20
    fields = [model.add(_field(f"u{k}", list(axes), number)) for k, axes in enumerate(kinds)]
    made = 0
    while made < 300:
        source, target = number.sample(range(60), 2)
        ours, theirs = {a.name for a in kinds[source]}, {a.name for a in kinds[target]}
        if not (ours <= theirs or theirs <= ours):
            continue
        strength = number.uniform(-1, 1)
        spread = made % 3 == 0 and bool(ours)
        coupling = Convolve([dd.Gaussian(strength, 3, normalized=True)]) if spread else dd.Gain(strength)
        fields[source] >> coupling >> fields[target]
        made += 1
    return model
