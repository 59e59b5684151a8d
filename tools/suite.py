"""Run the tests, or a part of them: the engine with the packages beside it hidden, then the others, and both
once more with programs as deodar compiles them.

    python tools/suite.py verdict [PYTEST OPTIONS]   what `make test` runs
    python tools/suite.py rest                       what `make whole` runs after it, and properties once more
    python tools/suite.py whole                      all
    python tools/suite.py core                       the engine's part of the verdict, and the contracts
    python tools/suite.py fast                       functions of little CPU time
"""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]

PYTEST = ("-m", "pytest")
ENGINE = ("tools/engine_alone.py",)
"""The programs: all packages, and the engine alone."""

SPREAD = ("-n", "2", "--dist", "loadfile", "--no-loadscope-reorder")
"""Files over two processes, in the order that `tests/conftest.py` gives them."""

OTHERS = ("tests", "--ignore", "tests/deodar")
"""What the engine alone does not test."""

QUICK = "not default_program"

PARTS = {"verdict": " and verdict", "rest": " and (not verdict or hypothesis)", "whole": ""}
"""The markers of each part, after that of the programs. Properties are in both: the rest draws new
examples.
"""

ALONE: dict[str, list[tuple[str, ...]]] = {
    "core": [
        (*ENGINE, *SPREAD, "-m", f"{QUICK}{PARTS['verdict']}"),
        (*PYTEST, *SPREAD, "-m", f"{QUICK}{PARTS['verdict']}", "tests/contracts"),
    ],
    "fast": [(*PYTEST, *SPREAD, "-m", "fast")],
}
"""The calls of parts that leave something out; contracts are of the packages, too."""


def calls(part: str) -> list[tuple[str, ...]]:
    """Return the arguments of Python of each call."""
    if part in ALONE:
        return ALONE[part]
    quick = ("-m", f"{QUICK}{PARTS[part]}")
    optimised = ("-m", f"default_program{PARTS[part]}", "--default-programs")
    return [
        (*program, *SPREAD, *programs, *paths)
        for programs in (quick, optimised)
        for program, paths in ((ENGINE, ()), (PYTEST, OTHERS))
    ]


def main(arguments: Sequence[str]) -> int:
    """Run all calls of a part; return the status of the first that fails."""
    if not arguments or arguments[0] not in (*PARTS, *ALONE):
        print(__doc__)
        return 2
    part, *options = arguments
    done = [subprocess.run([sys.executable, *call, *options], cwd=ROOT).returncode for call in calls(part)]
    return next((status for status in done if status), 0)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
