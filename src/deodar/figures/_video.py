"""A figure as a video: its layout is drawn once, and in each frame only what has changed."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from deodar.errors import FigureError, Fix, option
from deodar.figures import _encode
from deodar.figures._moving import Changing
from deodar.figures._view import View
from deodar.model.unit import unit_seconds

MOST_FRAMES = 600
"""Number of frames of a video for which no interval is given, at most."""

RATE = 25.0
"""Frames in a second, if no speed is given."""

WIDTH = 960
"""Width in pixels."""


def times(views: Sequence[View], every: float | None) -> np.ndarray:
    """Return the times of the frames: those of the records, or one every so much time.

    Raises:
        FigureError: the figure does not change over time, or the interval is not above 0.
    """
    found = [view.times for view in views if view.at is None and len(view.times) > 1]
    if not found:
        raise FigureError(
            "nothing in the figure changes over time",
            fix=Fix(
                "Draw a record with several times, without at",
                "Draw a record with several times, without --at",
            ),
        )
    if every is None:
        finest = max(found, key=len)
        return finest[:: -(-len(finest) // MOST_FRAMES)]
    if not every > 0:
        raise FigureError(f"the time between two frames is {every:g}; it must be above 0")
    first, last = min(t[0] for t in found), max(t[-1] for t in found)
    return np.arange(first, last + 1e-9 * max(1.0, abs(last)), every)


def rate(views: Sequence[View], shown: np.ndarray, speed: float | None, format: str) -> float:
    """Return the frames in a second.

    Raises:
        FigureError: the speed needs more frames in a second than the format has.
    """
    if speed is None:
        return RATE
    if not speed > 0:
        raise FigureError(f"the speed is {speed:g}; it must be above 0")
    unit = next((view.unit(view.time) for view in views if view.unit(view.time)), "ms")
    seconds = unit_seconds(unit) * float(np.diff(shown).mean())
    found, most = speed / seconds, _encode.FASTEST[format]
    if found > most:
        raise FigureError(
            f"needs {found:.4g} frames in a second; {format} has {most:g} at most",
            where=f"speed {speed:g}",
            fix=option(
                f"One frame every N {unit} or more:",
                "every",
                f"{speed / most / unit_seconds(unit):.3g}",
            ),
        )
    return found


def frames(
    figure: Figure,
    changing: Sequence[Changing],
    shown: Sequence[float],
    width: int,
    progress: Callable[[int, int], object] | None = None,
) -> Iterator[np.ndarray]:
    """Yield the frames: arrays (rows, columns, 3) of bytes.

    Args:
        figure: the figure, drawn as at the first time.
        changing: what changes in it.
        shown: the times.
        width: width in pixels.
        progress: called with the number of frames that are done, and of all frames.
    """
    canvas = FigureCanvasAgg(figure)
    figure.set_dpi(width / figure.get_size_inches()[0])
    artists = [artist for part in changing for artist in part.artists]
    for artist in artists:
        artist.set_animated(True)
    canvas.draw()
    figure.set_layout_engine("none")
    ground = canvas.copy_from_bbox(figure.bbox)  # pyright: ignore[reportAttributeAccessIssue]
    whole = any(not part.artists for part in changing)
    for n, time in enumerate(shown, 1):
        for part in changing:
            part.show(time)
        if whole:
            canvas.draw()
        else:
            canvas.restore_region(ground)  # pyright: ignore[reportAttributeAccessIssue]
        for artist in artists:
            if artist.axes is not None:
                artist.axes.draw_artist(artist)
            else:
                figure.draw_artist(artist)
        yield np.ascontiguousarray(np.asarray(canvas.buffer_rgba())[..., :3])
        if progress is not None:
            progress(n, len(shown))
