"""The perceptual half on photographs of coloured objects: a photograph lies on one side of the table.

The photographs and the regions that a person marked in them are those of the saliency demonstration.
"""

from __future__ import annotations

import functools

import numpy as np

from deodar.architectures.pointing import COLOURS, PIXELS, SIDES, TABLE, pointing, table
from deodar.experiments.rows import Row
from deodar_papers.pointing.table import SPEECH, Table
from deodar_papers.saliency.scenes import Cue, CueScene, photographs

WIDTH = 0.2
"""Width of a photograph on the table, m."""

PLACES = {"left": (-0.2, 0.3), "right": (0.2, 0.3)}
"""Middle of a photograph, m."""

NEAREST, LEAST = 15.0, 0.06
"""Photographs are taken in which a marked object differs from a colour that can be cued by at most as many
degrees, and is at least as wide and high on the table, m: as the objects of the scenes.
"""

STEPS = 150
"""Steps that a pair of cues is watched."""


@functools.cache
def chosen() -> tuple[tuple[CueScene, Cue, str], ...]:
    """Return the photographs, each with the mark of its object and the colour that names it."""
    out: list[tuple[CueScene, Cue, str]] = []
    for scene in (*photographs(), *photographs(untuned=True)):
        for cue in scene.cues:
            corners = np.array([corner for outline in cue.outlines for corner in outline])
            if not len(corners) or np.ptp(corners, axis=0).min() * WIDTH / scene.picture.size[0] < LEAST:
                continue
            for colour, hue in COLOURS.items():
                if abs((cue.hue - hue + 180) % 360 - 180) <= NEAREST:
                    out.append((scene, cue, colour))
    return tuple(out)


def watch(name: str, side: str, seed: int) -> list[Row]:
    """Show a photograph on one side of the table, and give all pairs of a colour and a side, one by one.

    Args:
        name: name of the photograph.
        side: side of the table on which it lies.
        seed: seed of all noise.
    """
    scene, cue, colour = next(one for one in chosen() if one[0].name == name)
    wide, high = scene.picture.size
    size = WIDTH, WIDTH * high / wide
    model = pointing(corners=_corners(PLACES[side], size))
    quiet = {"pixel_noise": 0.0, "tool_noise": 0.0}
    at = Table([], seed, settings=quiet, model=model, camera=scene.picture)
    x, y, _ = (axis.points for axis in table())
    rows: list[Row] = []
    for named in COLOURS:
        for where in SIDES:
            at.session.reset()
            highest, peak = -np.inf, None
            for k in range(STEPS):
                at.say((named, where) if k < SPEECH else ())
                now = at.step()
                if now.perceptual > highest:
                    highest, u = now.perceptual, at.activation
                    i, j, _n = np.unravel_index(int(u.argmax()), u.shape)
                    peak = float(x[i]), float(y[j])
            assert peak is not None
            place = _pixel(peak, PLACES[side], size, (wide, high))
            rows.append(
                {
                    "key": f"photograph/{name} {side} {named} {where}",
                    "condition": "photograph",
                    "trial": f"{name} {side}",
                    "pair": [named, where],
                    "match": (named, where) == (colour, side),
                    "highest": round(highest, 3),
                    "inside": bool(highest > 0 and cue.holds(place)),
                }
            )
    return rows


def _corners(place: tuple[float, float], size: tuple[float, float]) -> list[list[float]]:
    """Return column and row of the table's corners in the picture, as `pointing` takes them."""
    (left, right), (near, far) = TABLE
    out: list[list[float]] = []
    for at in ((left, near), (right, near), (right, far), (left, far)):
        column, row = _pixel(at, place, size, PIXELS)
        out.append([column - 0.5, row - 0.5])
    return out


def _pixel(
    at: tuple[float, float], place: tuple[float, float], size: tuple[float, float], pixels: tuple[int, int]
) -> tuple[float, float]:
    """Return column and row of a place on the table in a photograph that is seen from above."""
    across, up = ((at[d] - place[d]) / size[d] for d in (0, 1))
    return (across + 0.5) * pixels[0], (0.5 - up) * pixels[1]
