"""Text as masks of coverage, in the font Inter, or in the font of matplotlib where Pillow cannot read it."""

from __future__ import annotations

from functools import cache
from importlib import resources
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw, ImageFont, features

LARGER = 4
"""Factor by which text is drawn larger before it is reduced: hinting of small letters spoils their distances.
"""

LINE = 1.4
"""Height of a mask, in sizes of type."""

BOLD = 600
"""Weight from which on a font without weights uses its bold form."""


@cache
def font(size: int, weight: int) -> ImageFont.FreeTypeFont:
    """Return the font at a size in pixels and a weight from 100 to 900."""
    inter = resources.files("deodar_papers.story.figures") / "inter-latin-wght-normal.woff2"
    try:
        with resources.as_file(inter) as path:
            face = ImageFont.truetype(path, size)
        face.set_variation_by_axes([weight])
    except OSError:  # this Pillow reads no WOFF2
        face = ImageFont.truetype(_of_matplotlib(weight), size)
    return face


def _of_matplotlib(weight: int) -> Path:
    """Return the file of the font that comes with matplotlib."""
    # start-up time
    import matplotlib

    name = "DejaVuSans-Bold.ttf" if weight >= BOLD else "DejaVuSans.ttf"
    return Path(matplotlib.get_data_path()) / "fonts" / "ttf" / name


@cache
def mask(text: str, size: float, weight: int) -> np.ndarray:
    """Return the coverage of a line of text, 0 to 1; its last two columns are empty.

    Digits have one width, so that a number that changes does not shake.
    """
    form = ["tnum"] if features.check("raqm") else None
    face = font(round(size * LARGER), weight)
    wide = int(face.getlength(text, features=form)) + 2 * LARGER
    columns, rows = -(-wide // LARGER) * LARGER, int(size * LINE) * LARGER
    picture = Image.new("L", (columns, rows), 0)
    ImageDraw.Draw(picture).text((0, 0), text, font=face, fill=255, features=form)
    return np.asarray(picture.reduce(LARGER), np.float32) / 255
