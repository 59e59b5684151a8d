"""Bifurcations by another program: `python benchmarks/jaxcont_folds.py`.

JaxCont (MIT) is a package for continuation of functions of JAX. It gets the equations of a field and of two
nodes as they are written here, without deodar. Both programs then find the same folds, cusp, Hopf points and
Bogdanov-Takens point. It is no dependency of deodar: `pip install jaxcont==0.4.0`. Status 1 if a difference
is larger than its target, 2 if JaxCont is not installed.
"""

from __future__ import annotations

import importlib
import os
import sys
import time
from collections.abc import Callable, Mapping
from typing import Any

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

import deodar as dd
from bifurcations import line, oscillator

Equations = Callable[[Array, Any, Any], Array]
"""A function of the state, of one or two parameters, and of nothing else."""


def field(excitation: float | None = 8.0) -> Equations:
    """Return a field as in `bifurcations.line`, over its input; or, with None, over input and excitation."""
    x = np.linspace(0, 100, 101)
    kernel = np.exp(-((x[:, None] - x) ** 2) / (2 * 5**2)) / (5 * np.sqrt(2 * np.pi))
    shape = np.exp(-((x - 50) ** 2) / (2 * 5**2))

    def rates(u: Array, p: Any, args: Any) -> Array:
        s, w = (p, excitation) if excitation is not None else (p[0], p[1])
        g = 1 / (1 + jnp.exp(-4 * u))
        return -u - 5 + s * shape + w * (kernel @ g) - 0.1 * g.sum()

    return rates


def nodes(u: Array, p: Any, args: Any) -> Array:
    """Return the rates of two nodes as in `bifurcations.oscillator`, over a level (and a factor)."""
    level, factor = (p, -6.0) if jnp.ndim(p) == 0 else (p[0], p[1])
    e, i = 1 / (1 + jnp.exp(-4 * u[0])), 1 / (1 + jnp.exp(-u[1]))
    return jnp.stack([(-u[0] + level + 2.5 * e + factor * i) / 20, (-u[1] - 3 + 6 * e) / 40])


def followed(other: Any, rates: Equations, start: np.ndarray, span: tuple[float, float]) -> list[float]:
    """Return the folds and Hopf points that JaxCont finds on a branch, in growing order."""
    problem = other.bif_problem(rates, u0=jnp.asarray(start), p0=span[0])
    settings = other.ContinuationPar(ds=0.05, ds_max=0.5, max_steps=400, newton_tol=1e-10)
    found = other.continuation(problem, p_span=span, settings=settings, events=[other.Fold(), other.Hopf()])
    return sorted(float(event.p) for event in found.events)


def _both(state: Mapping[str, np.ndarray]) -> np.ndarray:
    """Return the state of two nodes in the order of `nodes`."""
    return np.array([float(state["e.activation"]), float(state["i.activation"])])


def main() -> int:
    """Print the largest differences, and judge."""
    try:
        other: Any = importlib.import_module("jaxcont")
    except ImportError:
        print("jaxcont is not installed: pip install jaxcont==0.4.0")
        return 2
    jax.config.update("jax_enable_x64", True)
    missed: list[str] = []

    def add(what: str, difference: float, target: float) -> None:
        print(f"  {what:52} {difference:9.1e}   at most {target:g}", flush=True)
        if not difference <= target:
            missed.append(what)

    began = time.process_time()
    own = dd.continuation(line(), "s.amplitude", (0, 8), finer=False)
    d, seconds = own.line.right_hand_side, time.process_time() - began
    test = np.random.default_rng(0).standard_normal(d.size)
    written = np.asarray(field()(jnp.asarray(test), 1.3, None))
    apart = np.abs(written - d.rates(test, np.array([1.3])))
    add("the equations of a field of 101 samples", float(apart.max()), 1e-12)
    began = time.process_time()
    theirs = followed(other, field(), own.states[0], (0.0, 8.0))
    ours = sorted(b.value for b in own.bifurcations)
    also = time.process_time() - began
    add("both folds", float(np.abs(np.subtract(ours, theirs)).max()), 1e-8)
    print(f"  (CPU time with compiling: deodar {seconds:.1f} s, jaxcont {also:.1f} s)")

    up = own.bifurcations[0]
    (cusp,) = dd.locus(up, "u.kernel.0.amplitude", (2, 10), within=(0, 8)).points
    guess = jnp.asarray(np.add(cusp.values, (0.02, 0.05)))
    _, place, _, converged = other.cusp_point(field(None), jnp.asarray(up.state), guess, tol=1e-10)
    add("cusp over input and excitation", float(np.abs(np.subtract(place, cusp.values)).max()), 1e-7)
    assert bool(converged)

    pair = dd.continuation(oscillator(), "e.resting_level", (-4, 6), finer=False)
    theirs = followed(other, nodes, _both(pair.state(0)), (-4.0, 6.0))
    ours = sorted(b.value for b in pair.bifurcations)
    add("both Hopf points of two nodes", float(np.abs(np.subtract(ours, theirs)).max()), 1e-8)
    hopf = dd.locus(pair.bifurcations[0], "back.factor", (-12, 0), (-20, 20))
    (end,) = hopf.points
    guess, near = jnp.asarray(np.add(end.values, (0.01, -0.02))), _both(pair.bifurcations[0].state_by_path)
    found = other.bogdanov_takens_point(nodes, jnp.asarray(near), guess, tol=1e-10)
    place = found[1]
    add("Bogdanov-Takens point of two nodes", float(np.abs(np.subtract(place, end.values)).max()), 1e-7)
    for what in missed:
        print(f"missed: {what}")
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
