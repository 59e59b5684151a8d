"""Small models that several tests of sessions share."""

from __future__ import annotations

import jax
import numpy as np

import deodar as dd
from deodar.couplings.convolutions import Convolve
from deodar.elements.changing_stimuli import Noise
from deodar.elements.stimuli import GaussianStimulus

x = dd.Axis("x", 0, 60, samples=31, periodic=True)
y = dd.Axis("y", 0, 20, samples=11)


def mixed(order: int = 1, prefix: str = "", extra: int = 0) -> dd.Model:
    """Return fields of one and two dimensions, a node, couplings, several rates and noise; `order` -1
    reverses the declarations.
    """
    name = (prefix + "{}").format
    elements = {
        "u": dd.Field(
            name("u"),
            [x],
            tau=10,
            kernel=[dd.Gaussian(1.0, 4), dd.Gaussian(-0.3, 9)],
            global_inhibition=0.05,
            noise=0.3,
        ),
        "v": dd.Field(
            name("v"),
            [x, y],
            tau=12,
            kernel=[dd.Gaussian(8, (4, 3), normalized=True)],
            noise=0.4,
            noise_length=3,
        ),
        "n": dd.Field(name("n"), [], tau=8, resting_level=-1, kernel=[dd.Gaussian(2)], noise=0.2),
        "slow": dd.Field(name("slow"), [x], tau=40, resting_level=-2, noise=0.3),
        "s": GaussianStimulus(name("s"), [x], center=20, sigma=4, amplitude=7, windows=[(5, 60), (90, 300)]),
        "xi": Noise(name("xi"), [x], amplitude=0.2),
    }
    rates = {"slow": 3, "v": 2}
    model = dd.Model("mixed")
    handles = {}
    for key in list(elements)[::order]:
        handles[key] = model.add(elements[key], ticks=rates.get(key, 1))
    for k in range(extra):
        model.add(
            dd.Field(
                f"neighbour{k}", [x], tau=10, kernel=[dd.Gaussian(1.0, 4), dd.Gaussian(-0.3, 9)], noise=0.3
            )
        )
    couplings = [
        ("u", dd.Gain(1.5, name=name("u>v")), "v"),
        ("v", Convolve([dd.Gaussian(0.2, 2)], name=name("v>u")), "u"),
        ("u", dd.Project([], name=name("u>n")), "n"),
        ("n", dd.Gain(1.0, name=name("n>slow")), "slow"),
    ]
    for source, coupling, target in couplings[::order]:
        handles[source] >> model.add(coupling) >> handles[target]
    for source, target in [("s", "u"), ("xi", "u"), ("u", "slow"), ("slow", "u")][::order]:
        handles[source] >> handles[target]
    return model


RECORD = [
    "u.activation",
    "v.output",
    "n.activation",
    "slow.activation",
    "xi.output",
    "u.input",
    "u.interaction",
]


def bits(session: dd.Session) -> dict[str, bytes]:
    """Return the whole state of a session, as bytes."""
    session.scene()  # the world advances to the present
    snapshot = session.snapshot()
    out = {
        f"{ident}.{number}.{name}": values.tobytes()
        for ident, pair in snapshot.states.items()
        for number, row in enumerate(pair)
        for name, values in row.items()
    }
    out["clock"] = repr((snapshot.clock.tick, snapshot.clock.time, snapshot.seed)).encode()
    if snapshot.world is not None:
        out["world"] = b"".join(np.asarray(a).tobytes() for a in jax.tree.leaves(snapshot.world.world))
        out["objects"] = repr(snapshot.world.objects).encode()
    return out
