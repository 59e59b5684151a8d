"""A kernel of 499 free samples, learned from what a field with a known kernel does.

    python examples/learned_kernel.py

A field without noise sees random inputs. Its kernel is an array of 499 free numbers, all 0 at first, and the
gradient through 20 steps moves them until the field does what a field with a Mexican hat does. Look at the
figure: the learned samples lie on the curve.
"""

from __future__ import annotations

import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

import jax
import jax.numpy as jnp
import numpy as np

import deodar as dd

if TYPE_CHECKING:
    from matplotlib.figure import Figure

STEPS, INPUTS = 20, 8


def field(weights: np.ndarray) -> dd.Model:
    """Return a field whose kernel has free samples."""
    x = dd.Axis("x", 0, 100, samples=len(weights) // 2 + 1)
    model = dd.Model("learned kernel")
    kernel = [dd.Custom(weights)]
    model.add(dd.Field("u", [x], tau=10, resting_level=-1, kernel=kernel, sigmoid=dd.Logistic(beta=1)))
    return model


def hat(samples: int) -> np.ndarray:
    """Return the kernel to be found: local excitation, inhibition around it."""
    d = np.linspace(-100, 100, samples)
    return 0.12 * np.exp(-0.5 * (d / 4) ** 2) - 0.04 * np.exp(-0.5 * (d / 10) ** 2)


def learn(samples: int = 499, most: int = 1500) -> tuple[np.ndarray, np.ndarray, list[float]]:
    """Return the kernel, the learned one, and the error before each step of the search.

    Args:
        samples: number of free samples, odd.
        most: number of steps of the search.
    """
    wanted = hat(samples)
    d = dd.dynamics(field(np.zeros(samples)), ["u.kernel.0.weights"])
    rng = np.random.default_rng(0)
    given = rng.normal(0, 3, (INPUTS, samples // 2 + 1))

    def course(weights: Any, amount: Any) -> Any:
        found = dd.rollout(d, STEPS, {"u.kernel.0.weights": weights}, {"u": amount}, record=["u"])
        return found.records["u"]

    with d.context():
        many = jax.jit(jax.vmap(course, in_axes=(None, 0)))
        seen = many(wanted, given)
        loss = jax.jit(jax.value_and_grad(lambda w: jnp.mean((many(w, given) - seen) ** 2)))
        # Adam
        weights, mean, square, errors = np.zeros(samples), np.zeros(samples), np.zeros(samples), list[float]()
        for k in range(1, most + 1):
            error, slope = (np.asarray(a) for a in loss(weights))
            errors.append(float(error))
            mean, square = 0.9 * mean + 0.1 * slope, 0.99 * square + 0.01 * slope**2
            way = mean / (1 - 0.9**k) / (np.sqrt(square / (1 - 0.99**k)) + 1e-12)
            weights = weights - 0.004 * 0.998**k * way
    return wanted, weights, errors


def figure(wanted: np.ndarray, weights: np.ndarray) -> Figure:
    """Draw both kernels."""
    import matplotlib.pyplot as plt

    d = np.linspace(-100, 100, len(wanted))
    drawn, ax = plt.subplots(figsize=(5, 3), constrained_layout=True)
    ax.plot(d, wanted, lw=4, alpha=0.4, label="the kernel")
    ax.plot(d, weights, ".", ms=2, label="learned samples")
    ax.set(xlim=(-50, 50), xlabel="distance", ylabel="weight")
    ax.legend(frameon=False)
    return drawn


def main() -> None:
    """Learn the kernel, print the error, and draw it."""
    began = time.process_time()
    wanted, weights, errors = learn()
    off = float(np.sqrt(np.mean((weights - wanted) ** 2)) / np.abs(wanted).max())
    print(f"{len(weights)} samples, {len(errors)} steps: squared error {errors[0]:.2g} to {errors[-1]:.2g}")
    seconds = time.process_time() - began
    print(f"the kernel is off by {100 * off:.2g} % of its height, after {seconds:.0f} s of CPU")
    figure(wanted, weights).savefig(Path("learned_kernel.png"), dpi=150)


if __name__ == "__main__":
    main()
