"""A sequence that is taught and produced: a figure, as figure 11 of the paper, and a video from above."""

from __future__ import annotations

import colorsys
import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Protocol

import numpy as np
import xarray
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from PIL import Image, ImageDraw

from deodar.architectures.color_search import HUES
from deodar.figures._style import (
    ACTIVATION,
    AMOUNTS,
    COLOR,
    DOUBLE,
    MEDIUM,
    SMALL,
    THIN,
    THRESHOLD_LINE,
    style,
)
from deodar.figures._style import figure as sheet
from deodar.model import output
from deodar.worlds.arena.khepera import KHEPERA

RANGE = 6.0
"""Activation at both ends of the colour scale."""

HEADROOM = 2.0
"""Upper end of the axis of the nodes, as a multiple of their largest activation: phases are named there."""

BRIEF = 0.05
"""Share of a phase below which the number of a node is as wide as the time for which the node is active."""

TICKS = (-5, 0, 5)
"""Ticks of that scale."""

LOWEST = -10.0
"""Lower end of the axis of the nodes; inhibition at a change of the mode exceeds it."""


class DrawnSearch(Protocol):
    """A sequence of colours that was taught and produced.

    `hues` are samples of hue by letter; times are in ms, None for a block that did not come into view.
    """

    @property
    def record(self) -> xarray.Dataset: ...
    @property
    def sequence(self) -> str: ...
    @property
    def begins(self) -> float: ...
    @property
    def produced(self) -> str: ...
    @property
    def found(self) -> Sequence[float]: ...
    @property
    def seen(self) -> Sequence[float | None]: ...
    @property
    def hues(self) -> Mapping[str, float]: ...


def line_colour(hue: float) -> tuple[float, float, float]:
    """Return a colour in which a line is visible on white: a sample of hue, dark."""
    return colorsys.hsv_to_rgb(hue / HUES, 1.0, 0.75)


def sequence_figure(result: DrawnSearch) -> Figure:
    """Draw the ordinal nodes, both fields over hue, and the colour-space field over image columns, over time.

    Triangles mark the times at which blocks were found, and those at which they came into view.
    """
    r = result
    with style():
        out = sheet(DOUBLE, 6.2)
        rows: Any = out.subplots(4, 1, sharex=True)
        draw_nodes(rows[0], r)
        for axes, name, title in (
            (rows[1], "action", "action field"),
            (rows[2], "satisfaction", "field of the condition of satisfaction; triangles: a block is found"),
        ):
            image = draw_hues(axes, r, name)
            axes.set_title(title, loc="left")
            out.colorbar(image, ax=axes, label="activation", pad=0.01, aspect=12, ticks=TICKS)
        _columns(rows[3], r, out)
        _marks(rows[2], r, r.found, r.produced)
        came = [(t, letter) for t, letter in zip(r.seen, r.produced, strict=True) if t is not None]
        _marks(rows[3], r, [t for t, _ in came], "".join(letter for _, letter in came))
        for axes in rows:
            axes.axvline(r.begins / 1000, color=COLOR.threshold, linewidth=MEDIUM)
        rows[3].set_xlabel("time (s)")
        out.align_ylabels(list(rows))
    return out


def draw_nodes(axes: Axes, r: DrawnSearch) -> None:
    """Draw the activation of the ordinal nodes, each in the colour that it was taught.

    A node is dashed if an earlier one has its colour; the node behind the sequence is grey.
    """
    times = r.record["time"].values / 1000
    begin = int(np.searchsorted(times, r.begins / 1000))
    for k, letter in enumerate(r.sequence, 1):
        u = r.record[f"item {k}.node.activation"].values
        again = letter in r.sequence[: k - 1]
        axes.plot(
            times,
            u,
            color=line_colour(r.hues[letter]),
            linewidth=MEDIUM,
            linestyle=(0, (2, 1)) if again else "-",
        )
        for phase in (slice(None, begin), slice(begin, None)):
            _number(axes, times[phase], u[phase], k, line_colour(r.hues[letter]))
    count = len(r.sequence) + 1
    last = r.record[f"item {count}.node.activation"].values
    axes.plot(times, last, color=COLOR.moment, linewidth=THIN)
    _number(axes, times[begin:], last[begin:], count, COLOR.moment)
    axes.axhline(0, **THRESHOLD_LINE)
    top = max(
        float(np.max(r.record[f"item {k}.node.activation"].values)) for k in range(1, len(r.sequence) + 1)
    )
    axes.set_ylim(LOWEST, HEADROOM * top)
    axes.set_ylabel("activation")
    axes.set_title("ordinal nodes, in the colours that they were taught", loc="left")
    for at, words in ((times[0], "teaching"), (times[begin], "production")):
        axes.annotate(
            words,
            (at, 1),
            xycoords=axes.get_xaxis_transform(),
            xytext=(4, -8),
            textcoords="offset points",
            fontsize=SMALL,
            color=COLOR.threshold,
        )


def _number(axes: Axes, times: np.ndarray, u: np.ndarray, number: int, colour: Any) -> None:
    """Write the number of a node above the longest time for which it is active."""
    active = np.flatnonzero(u > 0)
    if len(active):
        middle = _longest(active)
        brief = len(active) < BRIEF * len(u)
        axes.annotate(
            f"{number}",
            # above the pulse that starts the first node, if both are at one place
            (times[middle], float(u[active].max() if brief else np.median(u[active]))),
            xytext=(0, 2),
            textcoords="offset points",
            ha="center",
            fontsize=SMALL,
            color=colour,
        )


def _longest(active: np.ndarray) -> int:
    """Return the middle of the longest row of successive samples."""
    pieces = np.split(active, np.flatnonzero(np.diff(active) > 1) + 1)
    piece = max(pieces, key=len)
    return int(piece[len(piece) // 2])


def draw_hues(axes: Axes, r: DrawnSearch, name: str) -> Any:
    """Draw the activation of a field over hue, and return the image."""
    u = r.record[f"{name}.activation"].values
    times = r.record["time"].values / 1000
    # the circle of hue is cut between violet and red, so that red is whole
    turned = np.roll(u, HUES // 12, axis=1)
    low = -HUES // 12 - 0.5
    image = axes.imshow(
        turned.T,
        extent=(times[0], times[-1], low, low + HUES),
        cmap=ACTIVATION,
        vmin=-RANGE,
        vmax=RANGE,
        aspect="auto",
    )
    axes.set_yticks(list(r.hues.values()), list(r.hues))
    axes.set_ylabel("hue")
    return image


def _columns(axes: Axes, r: DrawnSearch, out: Figure) -> None:
    field, times = r.record["columns of the peak.output"], r.record["time"].values / 1000
    half = -float(field["column"].values[0]) * field.sizes["column"] / (field.sizes["column"] - 1)
    image = axes.imshow(
        field.values.T,
        extent=(times[0], times[-1], -half, half),
        cmap=AMOUNTS,
        vmin=0.0,
        vmax=1.0,
        aspect="auto",
    )
    axes.set_yticks([-half, 0, half])
    axes.set_ylabel("column (px)")
    axes.set_title("colour-space field over image columns; triangles: a block comes into view", loc="left")
    out.colorbar(image, ax=axes, label="output", pad=0.01, aspect=12)


def _marks(axes: Axes, r: DrawnSearch, times: Sequence[float], letters: str) -> None:
    for time, letter in zip(times, letters, strict=True):
        axes.plot(
            time / 1000,
            1.0,
            marker="v",
            color=line_colour(r.hues[letter]),
            transform=axes.get_xaxis_transform(),
            clip_on=False,
            markersize=4.5,
        )


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
