"""The traceback of an error in a notebook: the frames of the user, the message, and how to see all frames."""

from __future__ import annotations

import os
from pathlib import Path

FULL = "DEODAR_TRACEBACK"
"""The variable of the environment that shows all frames if it is `full`."""

ROOT = Path(__file__).parent.parent

LIBRARIES = ("IPython", "ipykernel", "jax", "jaxlib")
"""Packages whose frames are hidden, too: they call cells, and functions of users inside a step."""


def short_traceback(error: BaseException) -> list[str]:
    """Return the lines that IPython shows for an error.

    Frames of deodar, of JAX and of IPython are hidden, those of the user are not.
    """
    # start-up time
    import traceback

    if os.environ.get(FULL) == "full":
        return "".join(traceback.format_exception(error)).splitlines()
    frames = traceback.extract_tb(error.__traceback__)
    shown = [frame for frame in frames if not _hidden(frame.filename)]
    lines: list[str] = []
    for frame in shown:
        inside = "" if frame.name == "<module>" else f", in {frame.name}"
        lines += [f"{_place(frame.filename)}, line {frame.lineno}{inside}", f"    {frame.line}"]
    name = type(error).__name__
    lines += [f"{name}: {error}", ""]
    hidden = len(frames) - len(shown)
    word = "frame is" if hidden == 1 else "frames are"
    return [*lines, f"{hidden} {word} hidden. To see all: %env {FULL}=full, then %tb"]


def _hidden(file: str) -> bool:
    path = Path(file)
    if path.is_relative_to(ROOT):
        return path.relative_to(ROOT).parts[0].startswith("deodar")
    return any(library in path.parts for library in LIBRARIES)


def _place(file: str) -> str:
    """Return the file of a frame; a cell has none that a reader could open."""
    return "Cell" if file.startswith("<") or "ipykernel_" in file else file
