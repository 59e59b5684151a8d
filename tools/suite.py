"""The calls of pytest that run the whole suite, for the commands that time it. `make test` makes the same."""

from __future__ import annotations

SPREAD = ("-n", "2", "--dist", "loadfile", "--no-loadscope-reorder")
"""Files over two processes, in the order that `tests/conftest.py` gives them."""

CALLS = (
    (*SPREAD, "-m", "not default_program"),
    (*SPREAD, "-m", "default_program", "--default-programs"),
)

FAST = (*SPREAD, "-m", "fast")
