"""What a worker of a cluster runs: tasks on one core, and the answer what it is."""

from __future__ import annotations

import functools
import os
import pickle
import signal

from deodar.errors import WorkerError, first_line

INSTRUCTIONS = "instructions"
"""Key of the instruction set of the processor in `description`."""


def dask_setup(worker: object) -> None:
    """Ignore Ctrl-C in a process that `local:N` started: the caller ends it."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)


def run(payload: bytes, precision: str) -> tuple[dict[str, str], bytes]:
    """Run a pickled function with its arguments; return what this worker is, and a pickled result.

    The result is a pair: whether the function returned, and its result or its error.
    """
    # start-up time: these bring JAX
    from deodar.batch import pool

    description_here = description(precision)
    try:
        function, arguments = pickle.loads(payload)
    except Exception as error:  # an import may raise any exception
        return description_here, pickle.dumps((False, _lacks(error)))
    return description_here, pool.done(function, arguments)


def description(precision: str) -> dict[str, str]:
    """Return the versions and the machine of this process, as records state them, and its instructions."""
    return dict(_description(precision))


@functools.lru_cache(maxsize=4)
def _description(precision: str) -> dict[str, str]:
    # start-up time: these bring JAX
    from deodar.batch import pool
    from deodar.compiler.device import CORES, find
    from deodar.cores import settled
    from deodar.recording.provenance import made_by

    if not settled():
        os.environ[CORES] = "1"
    pool.use_processor()
    return {**made_by(find(), precision), INSTRUCTIONS: instructions()}


def instructions() -> str:
    """Return the sets of vector instructions of the processor, where the system lists them."""
    try:
        with open("/proc/cpuinfo") as file:
            for line in file:
                name, _, listed = line.partition(":")
                if name.strip() in ("flags", "Features"):
                    return " ".join(sorted(word for word in listed.split() if _is_vector(word)))
    except OSError:
        pass
    return ""


def _is_vector(name: str) -> bool:
    return name.startswith(("sse", "ssse", "avx", "fma", "amx", "asimd", "sve", "neon"))


def _lacks(error: Exception) -> WorkerError:
    return WorkerError(
        f"a worker cannot import what the task needs ({type(error).__name__}: {first_line(error)})",
        fix="Install the same packages on every worker; code of your own goes into a module, not the script",
    )


def nothing(*arguments: object) -> None:
    """Return nothing: the task that asks a worker only what it is."""
