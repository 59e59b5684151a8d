"""A video of a vehicle that is taught a sequence of colours and looks for them, seen from above."""

from __future__ import annotations

import colorsys
import math
from collections.abc import Sequence
from pathlib import Path
from typing import Protocol

import numpy as np
from PIL import Image, ImageDraw

from deodar.architectures.color_search import HUES
from deodar.model import output
from deodar.worlds.arena.khepera import KHEPERA
from deodar_papers.figures.sequence import DrawnSearch

WIDTH, TOP = 420, 40
"""Side of the arena in the picture, and height of the row of taught colours above it, pixels."""

CAMERA, GAP = (240, 180), 12
"""Width and height of the camera's picture beside the arena, and its distance from the arena, pixels."""

COARSER = 2
"""Columns and rows of the camera's picture to one that is drawn: its noise makes most of the file."""

FRAMES = 200
"""Largest number of frames."""

SHOWN_MS = 80
"""Duration of a frame, ms."""

GREYS, SATURATED = 10, 24
"""Greys and saturated colours of all frames, beside those of the blocks: fewer make a smaller file."""

SIDE = 50.0
"""Side of a block, mm."""

REACH = 180.0
"""Drawn length of the view, mm."""

FLOOR, SEEN, BODY = (250, 250, 248), (228, 228, 224), (20, 20, 20)


class DrawnBlock(Protocol):
    """A block: its letter, and its middle in mm."""

    @property
    def letter(self) -> str: ...
    @property
    def center(self) -> tuple[float, float]: ...


class DrawnView(Protocol):
    """What was around the vehicle: the present blocks, and the picture of its camera (rows, columns, and red,
    green and blue, 0 to 1).
    """

    @property
    def blocks(self) -> Sequence[DrawnBlock]: ...
    @property
    def picture(self) -> np.ndarray: ...


def animation_samples(result: DrawnSearch) -> range:
    """Return the samples of the record that the video of a run shows."""
    count = result.record.sizes["time"]
    return range(0, count, max(1, math.ceil(count / FRAMES)))


def save_sequence_animation(
    result: DrawnSearch, views: Sequence[DrawnView], side: float, file: str | Path
) -> Path:
    """Write a GIF of the arena with the vehicle, its path and its view, and of the picture of its camera;
    above them the taught colours, those that were found with a bar below them.

    Args:
        result: the run.
        views: what was around the vehicle at each of `animation_samples`.
        side: side of the arena, mm.
        file: the video.
    """
    path = output.claim(file)
    shown = zip(animation_samples(result), views, strict=True)
    colours = _palette(result)
    frames = [
        draw_frame(result, view, side, k).quantize(palette=colours, dither=Image.Dither.NONE)
        for k, view in shown
    ]
    output.write(
        path,
        lambda beside: frames[0].save(
            beside, format="GIF", save_all=True, append_images=frames[1:], duration=SHOWN_MS, loop=0
        ),
    )
    return path


def draw_frame(r: DrawnSearch, seen: DrawnView, side: float, k: int) -> Image.Image:
    """Draw a frame of the video.

    Args:
        r: the run.
        seen: what is around the vehicle.
        side: side of the arena, mm.
        k: the sample of the record that is shown.
    """
    image = Image.new("RGB", (WIDTH + GAP + CAMERA[0], WIDTH + TOP), FLOOR)
    pen, scale = ImageDraw.Draw(image), WIDTH / side
    time, poses = float(r.record["time"].values[k]), r.record["pose.output"].values
    producing = time >= r.begins
    x, y, heading = (float(v) for v in poses[k])

    def at(px: float, py: float) -> tuple[float, float]:
        return (px + side / 2) * scale, TOP + (side / 2 - py) * scale

    camera = KHEPERA.camera
    assert camera is not None
    view, half = math.degrees(-heading), math.degrees(camera.horizontal / 2)
    px, py = at(x, y)
    reach = REACH * scale
    pen.pieslice([px - reach, py - reach, px + reach, py + reach], view - half, view + half, fill=SEEN)
    for block in seen.blocks:
        bx, by = block.center
        corners = [*at(bx - SIDE / 2, by + SIDE / 2), *at(bx + SIDE / 2, by - SIDE / 2)]
        pen.rectangle(corners, fill=_rgb(r, block.letter))
    begin = int(np.searchsorted(r.record["time"].values, r.begins))
    if k > begin:
        pen.line([at(*p) for p in poses[begin : k + 1, :2]], fill=BODY, width=2)
    rim = 1000 * KHEPERA.radius
    radius = rim * scale
    pen.ellipse([px - radius, py - radius, px + radius, py + radius], (255, 255, 255), BODY, 2)
    ahead = at(x + rim * math.cos(heading), y + rim * math.sin(heading))
    pen.line([(px, py), ahead], fill=BODY, width=3)
    pen.rectangle([0, TOP, WIDTH - 1, WIDTH + TOP - 1], outline=BODY)
    for n, letter in enumerate(r.sequence):
        left = 8 + 26 * n
        pen.rectangle([left, 6, left + 20, 26], fill=_rgb(r, letter))
        if n < len(r.found) and time >= r.found[n]:
            pen.rectangle([left, 30, left + 20, 34], fill=BODY)
    words = "production" if producing else "teaching"
    left = WIDTH + GAP
    pen.text((left, 12), f"{words}, {time / 1000:.0f} s", fill=BODY, font_size=13)
    coarse = seen.picture[::COARSER, ::COARSER]
    pixels = (255 * np.clip(coarse, 0.0, 1.0)).round().astype(np.uint8)
    image.paste(Image.fromarray(pixels).resize(CAMERA, Image.Resampling.NEAREST), (left, TOP))
    pen.rectangle([left, TOP, left + CAMERA[0] - 1, TOP + CAMERA[1] - 1], outline=BODY)
    pen.text((left, TOP + CAMERA[1] + 4), "picture of the camera", fill=BODY, font_size=13)
    return image


def _palette(r: DrawnSearch) -> Image.Image:
    """Return a picture with the colours of all frames; blocks have exact ones even where they are small."""
    greys = [(round(v), round(v), round(v)) for v in np.linspace(BODY[0], 255, GREYS)]
    hues = [_saturated(k / SATURATED) for k in range(SATURATED)]
    found = [FLOOR, SEEN, BODY, *(_rgb(r, letter) for letter in r.hues), *greys, *hues]
    out = Image.new("P", (1, 1))
    out.putpalette([value for colour in found for value in colour])
    return out


def _rgb(r: DrawnSearch, letter: str) -> tuple[int, int, int]:
    return _saturated(r.hues[letter] / HUES)


def _saturated(hue: float) -> tuple[int, int, int]:
    red, green, blue = (round(255 * c) for c in colorsys.hsv_to_rgb(hue, 1.0, 0.9))
    return red, green, blue
