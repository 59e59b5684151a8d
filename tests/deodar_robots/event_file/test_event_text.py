"""Events as text: `t x y p`, the common form of published data sets."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import deodar as dd
from deodar.errors import WorldError

LINES = [(0.25, 3, 7, 1), (0.259999, 4, 7, 0), (0.26, 5, 2, 1)]
PIXELS = (dd.Axis("column", 0, 5, 6), dd.Axis("row", 0, 7, 8))


def written(path: Path, text: str) -> Path:
    path.write_text(text)
    return path


@pytest.mark.parametrize(
    "text",
    [
        "".join(f"{t:.6f} {x} {y} {p}\n" for t, x, y, p in LINES),
        "".join(f"{t * 1e6:.0f},{x},{y},{2 * p - 1}\r\n" for t, x, y, p in LINES),
        "6 8\n" + "".join(f"{t:.6f}\t{x}\t{y}\t{p}\n" for t, x, y, p in LINES),
        "t,x,y,p\n" + "".join(f"{t:.6f},{x},{y},{p}\n" for t, x, y, p in LINES),
        "# seconds\n" + "".join(f"{t:.6e} {x} {y} {p}\n" for t, x, y, p in LINES),
    ],
    ids=["seconds", "microseconds and commas", "size first", "names first", "comment first"],
)
def test_events_are_read(tmp_path: Path, text: str) -> None:
    world = dd.EventFile(written(tmp_path / "events.txt", text))
    assert (world.count, world.size, world.duration) == (3, (6, 8), 10.001)
    assert np.argwhere(world.sense("on", PIXELS, 10.0)).tolist() == [[3, 7]]
    assert np.argwhere(world.sense("off", PIXELS, 10.0)).tolist() == [[4, 7]]
    assert np.argwhere(world.sense("on", PIXELS, 20.0)).tolist() == [[5, 2]]
    assert world.describe()["format"] == "text"


def test_the_size_of_the_sensor_may_be_stated(tmp_path: Path) -> None:
    path = written(tmp_path / "events.txt", "0.1 3 7 1\n")
    assert dd.EventFile(path, size=(240, 180)).size == (240, 180)
    with pytest.raises(WorldError, match=r"at column 3, row 7; the sensor has 2 x 2"):
        dd.EventFile(path, size=(2, 2))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("Dear diary\ntoday\n", r"is text, and no recording of events"),
        ("0.1 3 7\n", r"has 3 numbers in a line"),
        ("0.1 3 7 1\n0.2 3 7 5\n", r"event 1 of 2 is `0.2 3 7 5`"),
        ("0.1 3.5 7 1\n", r"event 0 of 1 is `0.1 3.5 7 1`"),
        ("0.1 -3 7 1\n", r"event 0 of 1 is"),
        ("nan 3 7 1\n", r"event 0 of 1 is `nan 3 7 1`"),
        ("1e300 3 7 1\n", r"more than a year apart"),
        ("# nothing\n", r"holds no events"),
    ],
)
def test_other_text_is_refused_and_the_format_named(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(WorldError, match=message):
        dd.EventFile(written(tmp_path / "events.txt", text))
