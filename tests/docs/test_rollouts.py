"""Rollouts of examples are those of `simulate`, with noise, and a world inside the step where it can be."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import jax
import numpy as np
import pytest

import deodar as dd
from deodar.elements.world_ports import Sensor
from deodar.importers import examples
from deodar.worlds._base import World
from deodar.worlds.arena.arena import Arena
from deodar_papers.saliency.scenes import photographs

EVERY, SEED = 4, 3

INSIDE: Mapping[str, Callable[[], World]] = {
    "color_search": lambda: Arena(
        "search", unit="mm", vehicle="khepera", physics=dd.ArenaPhysics(period=20, camera_every=4)
    )
}
"""Worlds that are computed inside the step."""

OUTSIDE: Mapping[str, Callable[[], World]] = {
    "saliency": lambda: next(scene for scene in photographs() if scene.name == "coffee").picture,
    "looking": lambda: dd.Eye(first=(30, 85), screen=dd.EyeScreen(endless=False)),
}
"""Worlds on the host; what they showed is given as input."""


LIKE_OTHERS = {"spa", "pointing"}
"""Large examples whose worlds are exchanged as those of others."""


@pytest.mark.parametrize("name", sorted(set(examples.names()) - LIKE_OTHERS))
def test_a_rollout_is_the_run_of_simulate(name: str) -> None:
    model = dd.load(f"example:{name}")
    entries = model.document.entries
    fields = [
        e.path for e in entries if "activation" in e.element.outputs({p: () for p in e.element.ports()})
    ]
    sensors = [e.path for e in entries if isinstance(e.element, Sensor)] if name in OUTSIDE else []
    world = (OUTSIDE[name] if name in OUTSIDE else INSIDE[name])() if name in OUTSIDE | INSIDE else None
    d = dd.dynamics(model, world=None if name in OUTSIDE else world)
    steps, trial = 12, 0 if name in OUTSIDE else 5  # worlds on the host know only one copy
    record = [f"{path}.activation" for path in fields]
    simulated = dd.simulate(
        model,
        steps * d.dt,
        record=[*record, *(f"{path}.output" for path in sensors)],
        precision="float64",
        seed=SEED,
        trials=[trial] if trial else None,
        world=world,
    ).squeeze("trial" if trial else None)
    readings = {path: simulated[f"{path}.output"].values[:-1] for path in sensors}
    with d.context():
        run = jax.jit(
            lambda key: dd.rollout(d, steps, inputs=readings, key=key, record=record, every=EVERY * d.dt)
        )
        records = run(d.key(SEED, trial)).records
    assert record
    for path in record:
        difference = np.abs(np.asarray(records[path]) - simulated[path].values[::EVERY])
        assert np.nanmax(difference) <= 1e-12
