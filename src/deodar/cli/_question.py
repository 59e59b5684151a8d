"""Questions to the user of a terminal."""

from __future__ import annotations

import sys


def on_terminal() -> bool:
    """Return whether a user can read a question and type its answer."""
    return sys.stdin.isatty() and sys.stderr.isatty()


def confirmed(question: str) -> bool:
    """Ask a question; only y and yes confirm."""
    print(f"{question} [y/N] ", end="", file=sys.stderr, flush=True)
    return sys.stdin.readline().strip().lower() in ("y", "yes")
