"""A video of a robot that plans and drives: motivation spreads through the maze, and the robot follows it."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image, ImageDraw

from deodar.architectures.spa import DIRECTIONS
from deodar.model import output
from deodar_papers.figures.plan import COLOUR, DrawnRun

SCALE = 4
"""Pixels of a cell."""

BETWEEN = 10
"""Steps between two frames."""

SHOWN_MS = 80
"""Duration of a frame, ms: the video is eight times faster than the robot."""

TONES = 64
"""Colours of a frame: fewer make a smaller file."""

FULL = 8.0
"""Activation at which a colour is fully saturated."""

FLOOR, WALL, OBSTACLE, ROBOT = (250, 250, 248), (70, 70, 74), (215, 185, 135), (20, 20, 20)


def save_animation(result: DrawnRun, file: str | Path) -> Path:
    """Write a GIF: each position in the colours of the behaviours that are motivated there, with the path,
    the robot, walls and goal.
    """
    path = output.claim(file)
    last = len(result.path)
    frames = [_frame(result, k) for k in range(0, last, max(1, BETWEEN // result.every))]
    output.write(
        path,
        lambda beside: frames[0].save(
            beside, format="GIF", save_all=True, append_images=frames[1:], duration=SHOWN_MS, loop=0
        ),
    )
    return path


def _frame(r: DrawnRun, k: int) -> Image.Image:
    x, y = r.record["x"].values, r.record["y"].values
    fields = np.stack([r.record[f"{name}.motivation.activation"].values[k] for name in DIRECTIONS])
    colours = np.array([_rgb(COLOUR[name]) for name in DIRECTIONS], float)
    parts = np.clip(fields, 0.0, FULL) ** 2  # the colours of equally motivated behaviours mix
    mixed = np.einsum("nij,nc->ijc", parts, colours) / np.maximum(parts.sum(axis=0), 1e-6)[..., None]
    share = np.clip(fields.max(axis=0) / FULL, 0.0, 1.0)[..., None] * 0.8
    cells = (1 - share) * np.array(FLOOR) + share * mixed
    image = Image.fromarray(np.clip(np.flipud(cells.transpose(1, 0, 2)), 0, 255).astype(np.uint8))
    image = image.resize((len(x) * SCALE, len(y) * SCALE), Image.Resampling.NEAREST)
    pen = ImageDraw.Draw(image)

    def at(px: float, py: float) -> tuple[float, float]:
        return (px - x[0] + 0.5) * SCALE, (y[-1] + 0.5 - py) * SCALE

    _objects(pen, r, k, at)
    pose = r.record["pose.output"].values
    pen.line([at(*p) for p in pose[: k + 1, :2]] if k else [at(*pose[0, :2])] * 2, fill=ROBOT, width=2)
    px, py, heading = (float(v) for v in pose[k])
    radius = r.arena.vehicle.radius * 100
    pen.ellipse(
        [*at(px - radius, py + radius), *at(px + radius, py - radius)],
        fill=(255, 255, 255),
        outline=ROBOT,
        width=2,
    )
    pen.line(
        [at(px, py), at(px + radius * math.cos(heading), py + radius * math.sin(heading))],
        fill=ROBOT,
        width=3,
    )
    gx, gy = r.goal
    for dx, dy in ((3, 0), (0, 3)):
        pen.line([at(gx - dx, gy - dy), at(gx + dx, gy + dy)], fill=ROBOT, width=3)
    for n, name in enumerate(DIRECTIONS):
        pen.rectangle((22 + 70 * n, 6, 30 + 70 * n, 14), fill=_rgb(COLOUR[name]))
        pen.text((34 + 70 * n, 3), name, fill=(255, 255, 255), font_size=12)
    pen.text((image.width - 76, 3), f"step {k * r.every}", fill=(255, 255, 255), font_size=12)
    return image.quantize(TONES, dither=Image.Dither.NONE)


def _objects(pen: Any, r: DrawnRun, k: int, at: Any) -> None:
    border = [100 * v for v in r.arena.layout.border]
    (width, height), (x0, y0), (x1, y1) = pen.im.size, at(border[0], border[3]), at(border[2], border[1])
    for side in ((0, 0, x0, height), (x1, 0, width, height), (0, 0, width, y0), (0, y1, width, height)):
        pen.rectangle(side, fill=WALL)
    for item in r.arena.objects.all():
        comes = r.obstacle_at is not None and item.name == "obstacle"
        if not comes or k * r.every > (r.obstacle_at or 0):
            left, low, right, high = (100 * v for v in item.box)
            pen.rectangle([*at(left, high), *at(right, low)], fill=OBSTACLE if comes else WALL)


def _rgb(colour: str) -> tuple[int, int, int]:
    return int(colour[1:3], 16), int(colour[3:5], 16), int(colour[5:7], 16)
