"""The calls of pytest that run the whole suite, for the commands that time it. `make test` makes the same."""

from __future__ import annotations

PYTEST = ("-m", "pytest")
ENGINE = ("tools/engine_alone.py",)
"""The programs: all packages, and the engine alone."""

SPREAD = ("-n", "2", "--dist", "loadfile", "--no-loadscope-reorder")
"""Files over two processes, in the order that `tests/conftest.py` gives them."""

REST = ("tests", "--ignore", "tests/deodar")
"""What the engine alone does not test."""

QUICK = ("-m", "not default_program")
OPTIMISED = ("-m", "default_program", "--default-programs")

CALLS = (
    (*ENGINE, *SPREAD, *QUICK),
    (*PYTEST, *SPREAD, *QUICK, *REST),
    (*ENGINE, *SPREAD, *OPTIMISED),
    (*PYTEST, *SPREAD, *OPTIMISED, *REST),
)

FAST = (*PYTEST, *SPREAD, "-m", "fast")
