"""A small convolutional network that is trained through a field.

    python examples/trained_vision.py

Pictures show a cross and, as a distractor, a square of the same brightness. The network, one layer of
convolution that JAX computes, maps a picture to the input of a field over the columns; the field makes one
peak. Only the position of the peak is trained, by the gradient through network and field: the network learns
to see crosses, because the field selects what it shows most.
"""

from __future__ import annotations

import time
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

import deodar as dd

SIDE, STEPS = 24, 25
CROSS = np.array([[0, 1, 0], [1, 1, 1], [0, 1, 0]], float)
SQUARE = np.array([[1, 1, 0], [1, 1, 0], [0, 0, 1]], float)


def pictures(count: int, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Return pictures of a cross and a distractor, and the columns of the crosses."""
    rng = np.random.default_rng(seed)
    shown, places = rng.normal(0, 0.1, (count, SIDE, SIDE)), np.zeros(count, int)
    for k in range(count):
        here, there = rng.permutation(np.arange(2, SIDE - 2, 4))[:2]
        for shape, column in ((CROSS, here), (SQUARE, there)):
            row = rng.integers(1, SIDE - 1)
            shown[k, row - 1 : row + 2, column - 1 : column + 2] += shape
        places[k] = here
    return shown, places


def network(weights: Any, picture: Any) -> Any:
    """Return the input of the field: the strongest answer of the filter in each column."""
    filters = weights["filter"][None, None]
    seen = jax.lax.conv_general_dilated(picture[None, None], filters, (1, 1), "SAME")[0, 0]
    return weights["gain"] * jax.nn.logsumexp(4 * jax.nn.relu(seen - weights["bias"]), axis=0) / 4


def train(count: int = 64, most: int = 300) -> tuple[dict[str, np.ndarray], float, float]:
    """Return the weights, and the share of new pictures in which the peak is at the cross, before and after.

    Args:
        count: number of pictures.
        most: number of steps of the search.
    """
    x = dd.Axis("x", 0, SIDE - 1, samples=SIDE)
    model = dd.Model("trained vision")
    kernel = [dd.Gaussian(2.0, 1.0)]
    given = {"tau": 5, "resting_level": -2, "kernel": kernel, "global_inhibition": 0.6}
    model.add(dd.Field("u", [x], sigmoid=dd.Logistic(beta=2), **given))
    d = dd.dynamics(model, precision="float32")

    def peak(weights: Any, picture: Any) -> Any:
        found = dd.rollout(d, STEPS, inputs={"u": network(weights, picture)}, record=["u"])
        return found.records["u"][-1]

    many = jax.vmap(peak, in_axes=(None, 0))

    def loss(weights: Any, shown: Any, places: Any) -> Any:
        return -jnp.mean(jax.nn.log_softmax(many(weights, shown))[jnp.arange(len(places)), places])

    shown, places = pictures(count, 0)
    new, at = pictures(200, 1)
    noise = np.random.default_rng(2).normal(0, 0.3, (3, 3))
    weights: Any = {"filter": jnp.asarray(noise, jnp.float32), "gain": jnp.float32(2), "bias": jnp.float32(0)}
    right = jax.jit(lambda w: jnp.mean(jnp.argmax(many(w, new), axis=1) == at))
    slopes = jax.jit(jax.grad(loss))
    before, mean, square = float(right(weights)), *(jax.tree.map(jnp.zeros_like, weights),) * 2
    for k in range(1, most + 1):  # Adam
        slope = slopes(weights, shown, places)
        mean = jax.tree.map(lambda m, s: 0.9 * m + 0.1 * s, mean, slope)
        square = jax.tree.map(lambda v, s: 0.99 * v + 0.01 * s**2, square, slope)
        scale = 0.03 / (1 - 0.9**k)
        way = jax.tree.map(lambda m, v, k=k: m / (jnp.sqrt(v / (1 - 0.99**k)) + 1e-8), mean, square)
        weights = jax.tree.map(lambda w, m, scale=scale: w - scale * m, weights, way)
    return jax.tree.map(np.asarray, weights), before, float(right(weights))


def main() -> None:
    """Train, and print how often the peak is at the cross."""
    began = time.process_time()
    weights, before, after = train()
    print(f"peak at the cross in {100 * before:.0f} % of new pictures before, {100 * after:.0f} % after")
    print("filter:", np.round(weights["filter"], 1).tolist())
    print(f"{time.process_time() - began:.0f} s of CPU")


if __name__ == "__main__":
    main()
