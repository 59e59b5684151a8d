"""The pictures of the page on serial order that come from runs of their own: figures 3, 8, 11 and 12 of the
paper and a frame of the video, as `deodar demo serial-order` writes them.

    python docs/demonstrations.py              all of them, in two minutes
    python docs/demonstrations.py perception   those with these names

The demonstrations write larger pictures; those of the page have fewer dots.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

import deodar as dd
from deodar_papers.figures import sequence

PAPER = dd.papers.serial_order
PICTURES = Path(__file__).parent / "pictures"
DOTS = 125
"""Dots an inch."""

SEED = 4
"""Seed of the runs of figure 12: no search is so long that it squeezes the rest."""

BEFORE = 1500.0
"""Time before the last block is found at which the frame of the video is, ms."""

PREFIX = "serial-order-"


def transition(folder: Path) -> None:
    """Draw figure 3."""
    save(PAPER.figures.transition_figure(PAPER.figures.transition()), folder, "transition")


def perception(folder: Path) -> None:
    """Draw figure 8."""
    save(PAPER.figures.perception_figure(PAPER.figures.perception()), folder, "perception")


def demonstrations(folder: Path) -> None:
    """Draw figure 12."""
    runs = PAPER.figures.demonstrations(SEED)
    save(PAPER.figures.demonstrations_figure(*PAPER.figures.titled(runs)), folder, "demonstrations")


def lesson(folder: Path) -> None:
    """Draw figure 11, and a frame of the video: the robot has the last block of the sequence in view."""
    run = PAPER.narrative.run()
    save(sequence.sequence_figure(run), folder, "sequence")
    times = run.record["time"].values
    k = int(np.searchsorted(times, run.found[-1] - BEFORE))
    poses = run.record[PAPER.narrative.POSE].values
    [view] = PAPER.views.camera_views(run.taught, run.begins, times[[k]], poses[[k]])
    frame = sequence.draw_frame(run, view, run.taught.arena.side, k)
    frame.save(folder / f"{PREFIX}frame.png", optimize=True)


DRAWN: Mapping[str, Callable[[Path], None]] = {
    "transition": transition,
    "perception": perception,
    "demonstrations": demonstrations,
    "sequence": lesson,
}
"""How each picture is drawn; `sequence` draws the frame, too."""


def save(figure: Any, folder: Path, name: str) -> None:
    """Save a figure as a picture of the page, with 256 colours, which makes it three times as small."""
    path = folder / f"{PREFIX}{name}.png"
    dd.figures.save_figure(figure, path, force=True, dots=DOTS)
    with Image.open(path) as picture:
        small = picture.convert("RGB").quantize(256, dither=Image.Dither.NONE)
    small.save(path, optimize=True)


def main(words: list[str], folder: Path = PICTURES) -> int:
    """Status 0; 2 for an unknown name."""
    unknown = [word for word in words if word not in DRAWN]
    if unknown:
        sys.stderr.write(f"no picture {unknown[0]!r}; names: {', '.join(DRAWN)}\n")
        return 2
    for name in words or DRAWN:
        DRAWN[name](folder)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
