"""An element whose step is a function of one's own: two nodes that oscillate.

    python examples/own_function.py

Look at the time course: activation goes round, with a period of about a second. The document stores the
function as `module:name`, and loads it only with `dd.load(file, trust=True)`.
"""

from __future__ import annotations

from typing import Any

import jax.numpy as jnp

import deodar as dd


def turn(state: Any, inputs: Any, time: Any, period: Any = 1000.0) -> Any:
    """One Euler step of a Hopf oscillator: two numbers that go round on a circle of radius 1."""
    x, y = state
    omega = 2 * jnp.pi / period
    grow = 0.01 * (1 - x**2 - y**2)
    return jnp.stack([x + time.dt * (grow * x - omega * y), y + time.dt * (grow * y + omega * x)])


def model() -> dd.Model:
    """The oscillator, which drives a field up and down."""
    pair = dd.Axis("pair", 0, 1, samples=2)
    out = dd.Model("oscillator")
    clock = out.add(
        dd.Function("clock", [pair], function=turn, ports_in=[], initial=0.1, values={"period": 1000.0})
    )
    u = out.add(dd.Field("u", [], resting_level=-0.5, kernel=[dd.Gaussian(2)]))
    clock >> dd.Gain(2) >> u
    return out


if __name__ == "__main__":
    data = dd.simulate(model(), 5000, record=["u.activation"], every=10)
    dd.time_course(data["u.activation"]).savefig("oscillator.png")
    u = data["u.activation"].values
    print(
        f"{int(((u[1:] > 0) & (u[:-1] <= 0)).sum())} times up through the threshold in 5 seconds; drawn into"
        " oscillator.png"
    )
