"""Four parameters of a field, fitted to a time course by their gradient.

    python examples/fitted_time_course.py

The time course is the highest activation of a field with noise, the mean of 40 trials, while an input comes
and goes. The fit begins at other parameters and moves numbers without bounds (`dd.bounded`), so that no time
constant falls below the step. Look at the figure: the fitted course lies on the data.
"""

from __future__ import annotations

import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

import jax
import jax.numpy as jnp
import numpy as np
from scipy.optimize import minimize

import deodar as dd

if TYPE_CHECKING:
    from matplotlib.figure import Figure

DURATION = 200
TRUE = {"u.tau": 15.0, "u.resting_level": -4.0, "u.kernel.0.amplitude": 1.0, "s.amplitude": 6.0}
BEGIN = {"u.tau": 30.0, "u.resting_level": -3.0, "u.kernel.0.amplitude": 0.5, "s.amplitude": 4.0}


def model(noise: float) -> dd.Model:
    """Return a field with an input from 20 to 120 ms."""
    x = dd.Axis("x", 0, 100, samples=51)
    made = dd.Model("fitted time course")
    kernel = [dd.Gaussian(1.0, 5)]
    u = made.add(dd.Field("u", [x], tau=15, resting_level=-4, kernel=kernel, noise=noise))
    windows = [dd.Window(20, 120)]
    made.add(dd.GaussianStimulus("s", [x], center=50, sigma=5, amplitude=6, windows=windows)) >> u
    return made


def measured(trials: int = 40) -> np.ndarray:
    """Return the activation at the middle of the input, the mean of trials of the field with noise."""
    made = model(0.3)
    data = dd.simulate(made, DURATION, record="u", trials=trials)
    return data["u.activation"].sel(x=50).mean("trial").values


def fit(data: np.ndarray) -> tuple[dict[str, float], np.ndarray]:
    """Return the fitted parameters and their time course."""
    d = dd.dynamics(model(0.0), list(TRUE))

    def course(parameters: Any) -> Any:
        return dd.rollout(d, len(data) - 1, parameters, record=["u"]).records["u"][:, 25]

    with d.context():
        free = dd.unbounded(d, BEGIN)

        def error(z: Any) -> Any:
            given = dd.bounded(d, dict(zip(free, z, strict=True)))
            return jnp.mean((course(given) - data) ** 2)

        both = jax.jit(jax.value_and_grad(error))

        def values(z: np.ndarray) -> tuple[float, np.ndarray]:
            value, slope = both(z)
            return float(value), np.asarray(slope)

        found = minimize(values, np.array([float(z) for z in free.values()]), jac=True, method="L-BFGS-B")
        fitted = {k: float(v) for k, v in dd.bounded(d, dict(zip(free, found.x, strict=True))).items()}
        return fitted, np.asarray(course(fitted))


def figure(data: np.ndarray, fitted: np.ndarray) -> Figure:
    """Draw the data and the fitted course."""
    import matplotlib.pyplot as plt

    drawn, ax = plt.subplots(figsize=(5, 3), constrained_layout=True)
    ax.plot(data, lw=4, alpha=0.4, label="mean of 40 trials")
    ax.plot(fitted, lw=1, label="fitted field")
    ax.set(xlabel="time (ms)", ylabel="activation at the input")
    ax.legend(frameon=False)
    return drawn


def main() -> None:
    """Fit, print the parameters, and draw the courses."""
    began = time.process_time()
    data = measured()
    found, course = fit(data)
    for path, value in found.items():
        print(f"{path:22} from {BEGIN[path]:5g} to {value:6.2f}, true {TRUE[path]:g}")
    error = float(np.sqrt(np.mean((course - data) ** 2)))
    print(f"root mean square error {error:.3f}, after {time.process_time() - began:.0f} s of CPU")
    figure(data, course).savefig(Path("fitted_time_course.png"), dpi=150)


if __name__ == "__main__":
    main()
