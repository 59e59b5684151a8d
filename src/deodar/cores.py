"""The number of cores of a program, set before JAX starts, because it creates its thread pool once."""

from __future__ import annotations

import os
import sys
from typing import Any

from deodar.compiler.device import CORES, cores
from deodar.errors import CoresError, ParameterError
from deodar.parameters import show


def use_cores(n: int) -> None:
    """Let every program of this process use n cores of the CPU.

    Call it before the first run. XLA creates its thread pool when it starts, and reads the number of threads
    (`NPROC` in the environment) only then; the number also determines how programs are compiled. Without it,
    and without `NPROC`, XLA takes all cores that the process may use.

    One core is right for most single runs, and the command line's default: work on fields below 50 x 50 x 30
    samples is no faster on two cores (the difference was within 15 %) and takes up to twice the CPU time. A
    field of 50 x 50 x 30 took 0.7 of the time, for 1.15 times the CPU time (measured by `NPROC=1` against
    `NPROC=2` on two otherwise idle cores). Trials and sweeps gain from workers, which are processes of
    one core each.

    Args:
        n: number of cores, at least 1.

    Raises:
        ParameterError: n is not a whole number of at least 1.
        CoresError: JAX has started with another number.
    """
    if isinstance(n, bool) or not isinstance(n, int) or n < 1:
        raise ParameterError(
            f"a number of cores is a whole number, at least 1, not {show(n)}",
            fix="For example dd.use_cores(1)",
        )
    if started() and n != cores():
        raise CoresError(
            f"JAX has already started with {cores()} cores, and keeps them until the process ends",
            fix=(
                f"Call dd.use_cores({n}) before the first run, or start Python with {CORES}={n} in the"
                " environment"
            ),
        )
    os.environ[CORES] = str(n)


def settled() -> bool:
    """Return whether the number is fixed: by the environment, or because JAX has started."""
    return CORES in os.environ or started()


def started() -> bool:
    """Return whether JAX has started a backend in this process; importing JAX does not start one."""
    bridge: Any = sys.modules.get("jax._src.xla_bridge")  # JAX has no public function for this
    return bridge is not None and bool(bridge.backends_are_initialized())
