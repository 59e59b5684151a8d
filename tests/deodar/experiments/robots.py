"""Small models for trials: a robot that drives straight on, and a node that noise drives over a threshold."""

from __future__ import annotations

import deodar as dd
from deodar.elements.stimuli import Boost
from deodar.elements.world_ports import Motor
from deodar.worlds._settings import arguments
from deodar.worlds.arena.arena import Arena

ROOM = {
    "unit": "cm",
    "arena": {"x": [0, 100], "y": [0, 40]},
    "walls": [{"name": "far", "center": [97, 20], "size": [4, 40]}],
}


def straight(speed=500.0):
    """Return a model with both wheels at one speed; a step is the period of the arena."""
    model = dd.Model("straight")
    model.describe(time_unit="1 = 64 ms")
    for wheel in ("left", "right"):
        push = model.add(Boost(f"go {wheel}", amplitude=speed))
        model.connect(push, model.add(Motor(wheel, motor=wheel)))
    return model


def room(**options):
    """Return an arena of 100 x 40 cm with a wall at its far end."""
    return Arena(ROOM, **{"start": (10, 20, 0), "goal": (80, 20), "unit": "cm"} | arguments(Arena, options))


def decider(noise=3.0):
    """Return a node below threshold that its noise eventually drives over it."""
    model = dd.Model("decider")
    model.add(dd.Field("u", [], tau=20, resting_level=-1, noise=noise))
    return model
