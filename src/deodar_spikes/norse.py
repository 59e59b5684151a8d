"""A graph in norse, in a process of its own: norse and torch are no dependencies of deodar."""

from __future__ import annotations

import importlib.util
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from deodar.errors import GraphError, MissingExtra
from deodar_spikes.graph import NirGraph
from deodar_spikes.nir_file import write_nir

SCRIPT = Path(__file__).with_name("norse_process.py")


def norse_version(python: str | Path | None = None) -> str:
    """Return the version of norse in an environment; "" if it is not installed there.

    Args:
        python: the interpreter of the environment; none: this one.
    """
    if python is None and importlib.util.find_spec("norse") is None:
        return ""
    code = "import importlib.metadata as m; print(m.version('norse'))"
    try:
        done = subprocess.run([str(python or sys.executable), "-c", code], capture_output=True, text=True)
    except OSError:
        return ""
    return done.stdout.strip() if done.returncode == 0 else ""


def run_norse(
    graph: NirGraph,
    inputs: NDArray[np.float32],
    every: int = 1,
    python: str | Path | None = None,
) -> NDArray[np.float32]:
    """Write a graph to a file, run norse on it from zero currents, and return the sums of the Output.

    Args:
        graph: the graph.
        inputs: steps x copies x values of the Input.
        every: number of steps in a window; the number of steps is a multiple of it.
        python: the interpreter of an environment with norse; none: this one.

    Returns:
        Sums, windows x copies x values of the Output.

    Raises:
        MissingExtra: norse is not installed there.
        GraphError: norse could not run the file.
    """
    if not norse_version(python):
        raise MissingExtra("norse", "neuromorphic", "the comparison with norse")
    with tempfile.TemporaryDirectory() as folder:
        file, given, out = (Path(folder) / name for name in ("graph.nir", "inputs.npz", "out.npz"))
        file.write_bytes(write_nir(graph))
        np.savez(given, inputs=inputs, step=graph.step, every=every)
        done = subprocess.run(
            [str(python or sys.executable), str(SCRIPT), str(file), str(given), str(out)],
            capture_output=True,
            text=True,
        )
        if done.returncode:
            last = (done.stderr.strip() or "no message").splitlines()[-1]
            raise GraphError(f"norse could not run the graph: {last}")
        return np.load(out)["sums"]
