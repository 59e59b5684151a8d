"""How many cells of a map of regimes a core computes in a second: `python benchmarks/regime_map.py`.

Each row is a map of a field of 101 samples, in CPU time without compiling. Cells differ: those beside an
instability settle late. Status 1 if a target is missed; times are judged only where the load is at
most 1.5 times the cores.
"""

from __future__ import annotations

import os
import sys
import time

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ.setdefault("NPROC", "1")
import numpy as np

import deodar as dd
from deodar.analysis.maps import grid
from deodar.analysis.maps.protocol import RegimeProtocol
from deodar.analysis.maps.request import requested

MOST_LOAD = 1.5
CELLS = 64
AMPLITUDES = {"u.kernel.0.amplitude": (1, 30, CELLS), "u.global_inhibition": (0, 1.5, CELLS)}
WIDTHS = {"u.kernel.0.sigma": (2, 10, CELLS), "u.global_inhibition": (0, 1.5, CELLS)}


def line(samples: int = 101) -> dd.Model:
    """Return a field over one axis."""
    x = dd.Axis("x", 0, 100, samples)
    model = dd.Model("line")
    kernel = [dd.Gaussian(15, 5, normalized=True)]
    model.add(dd.Field("u", [x], tau=20, resting_level=-5, kernel=kernel, global_inhibition=0.6))
    return model


def measured(over: dict[str, tuple[float, float, int]], precision: str, refine: bool) -> tuple[float, int]:
    """Return the CPU time of a map whose functions are compiled, s, and how many cells were computed."""
    protocol = RegimeProtocol(requested(line(), over, "u", None, {"precision": precision}))

    def compute(labels: np.ndarray, cells: np.ndarray) -> np.ndarray:
        return protocol.run(labels, cells, lambda done: None)

    compute(np.zeros(CELLS * CELLS, np.uint8), np.arange(1))
    began = time.process_time()
    _, computed = (grid.refined if refine else grid.every)((CELLS, CELLS), compute)
    return time.process_time() - began, int(computed.sum())


def main() -> int:
    """Print cells a second, and judge."""
    load, cores = os.getloadavg()[0] if hasattr(os, "getloadavg") else 0.0, os.cpu_count() or 1
    print(f"{cores} cores, load {load:.1f}; maps of {CELLS} x {CELLS} cells, 101 samples")
    missed = 0
    for what, over, precision, refine, target in (
        ("excitation, inhibition; every cell", AMPLITUDES, "float32", False, 1000),
        ("the same in double precision", AMPLITUDES, "float64", False, None),
        ("excitation, inhibition; refined", AMPLITUDES, "float32", True, None),
        ("width, inhibition: matrices of their own", WIDTHS, "float32", False, None),
    ):
        seconds, computed = measured(over, precision, refine)
        speed = CELLS * CELLS / seconds
        said = "" if target is None else f"   at least {target}"
        print(f"  {what:42} {speed:8.0f} cells/s, {computed} computed in {seconds:.2f} s{said}", flush=True)
        missed += target is not None and speed < target
    if load > MOST_LOAD * cores:
        print("times are not judged: the load is above 1.5 times the cores")
        return 0
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
