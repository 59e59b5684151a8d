"""Rounding of a product that is added to something, chosen before JAX starts, because XLA reads it once."""

from __future__ import annotations

import os
import platform

from deodar.compiler.rounding import FLAGS, SEPARATE, separate_rounding
from deodar.cores import started
from deodar.errors import DeviceError


def use_separate_rounding() -> None:
    """Let every program of this process round a product before it is added to something.

    By default XLA computes both by one instruction, with one rounding, where they are part of one loop. Which
    loops it makes depends on the whole model, and so do the last digits. With separate rounding parts of a
    model that run in other processes give the same bits as the whole, for example two halves of which one is
    served by `deodar serve --model`. Programs use narrower vectors then, and take longer: `python
    benchmarks/batches.py rounding` prints how much.

    Call it before the first run, in every process of the model.

    Raises:
        DeviceError: JAX has started without it, or the processor has no such instructions (only x86 has).
    """
    if separate_rounding():
        return
    if platform.machine().lower() not in ("x86_64", "amd64"):
        raise DeviceError(f"a processor of the kind {platform.machine()} has no separate rounding; x86 has")
    if started():
        raise DeviceError(
            "JAX has already started, and keeps its rounding until the process ends",
            fix=(
                "Call dd.use_separate_rounding() before the first run, or start Python with"
                f" {FLAGS}={SEPARATE} in the environment"
            ),
        )
    os.environ[FLAGS] = f"{os.environ.get(FLAGS, '')} {SEPARATE}".strip()
