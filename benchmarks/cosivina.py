"""What files of cosivina cost: `python benchmarks/cosivina.py [FILE ...]`, by default the published files in
the tests.

For each file, in this process: CPU time of importing it, of compiling its first program (nothing kept on disk
is used), and steps a second of CPU time, in both precisions; the median of three. Pin it to one core for
figures on one core (Linux: `taskset -c 0`). For comparison, the Python port of cosivina takes 34 steps a
second of the scene representation on a server core. Nothing is asserted.
"""

from __future__ import annotations

import argparse
import os
import statistics
import sys
import tempfile
import time
from pathlib import Path

SAMPLES = Path(__file__).parent.parent / "tests" / "deodar_interop" / "importers" / "cosivina"
PORT = {"presetSceneRepresentation": 34.0}
"""Steps a second of the Python port, where they were measured."""

ENOUGH = 1.0
"""Seconds of CPU time that a measurement lasts at least."""


def measured(path: Path) -> None:
    """One line for each precision."""
    import deodar as dd
    from deodar.importers.opening import read

    start = time.process_time()
    model = read(path).model
    imported = time.process_time() - start
    for precision in ("float64", "float32"):
        start = time.process_time()
        session = dd.Session(model, precision=precision)
        session.step(1)
        compiled = time.process_time() - start
        speed = steps(session)
        beside = f", {speed / PORT[path.stem]:5.1f} times the Python port" if path.stem in PORT else ""
        sys.stdout.write(
            f"{path.stem:38} {precision}: import {imported:5.2f} s, compile {compiled:5.2f} s, {speed:9.0f}"
            f" steps/s{beside}\n"
        )
        sys.stdout.flush()


def steps(session: object) -> float:
    """Steps a second of CPU time."""
    run = session.step  # type: ignore[attr-defined]

    def seconds(n: int) -> float:
        start = time.process_time()
        run(n)
        return time.process_time() - start

    n = 100
    while seconds(n) < ENOUGH / 4:
        n *= 2
    return statistics.median(n / seconds(n) for _ in range(3))


def main() -> None:
    """The files that are named, or all samples."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("files", nargs="*", type=Path, metavar="FILE")
    files = parser.parse_args().files or sorted(SAMPLES.glob("*.json"))
    with tempfile.TemporaryDirectory() as cache:
        os.environ["DEODAR_CACHE"] = cache
        import deodar as dd

        dd.Session(dd.Model("warm"))  # JAX itself is started before anything is measured
        for path in files:
            measured(path)


if __name__ == "__main__":
    main()
