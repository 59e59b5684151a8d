"""Random damage of files of each format: each file is a world, perhaps after a repair, or one error."""

from __future__ import annotations

import random
import warnings
from pathlib import Path

import numpy as np
import pytest

import deodar as dd
from deodar.errors import RunWarning, WorldError
from deodar.worlds import _capture
from deodar_robots.event_file import aedat2

HERE = Path(__file__).parent
NUMBERS = (b"\xff\xff\xff\xff", bytes(4), b"\xff\xff\xff\x7f", b"\x00\x00\x00\x80", b"\x00\x00\x00\x40")


def damaged(content: bytes, random: random.Random) -> bytes:
    """Return content with one kind of damage at a random place."""
    data, at = bytearray(content), random.randrange(len(content) - 4)
    kind = random.randrange(6)
    if kind == 0:
        del data[at:]
    elif kind == 1:
        for _ in range(random.randrange(1, 8)):
            data[random.randrange(len(data))] = random.randrange(256)
    elif kind == 2:
        data[at] ^= 1 << random.randrange(8)
    elif kind == 3:
        del data[at : at + random.randrange(1, 64)]
    elif kind == 4:
        data[at:at] = random.randbytes(random.randrange(1, 64))
    else:
        data[at : at + 4] = random.choice(NUMBERS)
    return bytes(data)


def content_of(name: str) -> bytes:
    if name == "aedat":
        k = np.arange(400)
        return aedat2.encoded(250 * k, k % 128, 3 * k % 128, k % 3 == 0)
    if name == "avi":
        return _capture.example().read_bytes()
    return (HERE / f"{name.removesuffix('.aedat4')}.aedat4").read_bytes()


@pytest.mark.parametrize("name", ["aedat", "one.aedat4", "two.aedat4", "plain.aedat4", "avi"])
def test_200_damaged_files_are_worlds_or_one_error(name: str, tmp_path: Path) -> None:
    content, axes = content_of(name), dd.EventFile.example_axes("events")
    path = tmp_path / f"damaged.{name.rpartition('.')[2]}"
    read = refused = 0
    for seed in range(200):
        path.write_bytes(damaged(content, random.Random(seed)))
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            try:
                seen = dd.EventFile(path, size=(64, 48) if name == "avi" else None)
                reading = seen.sense("events", axes, 10.0)
            except WorldError as error:
                assert len(error.problems) == 1 and str(path) in str(error)
                refused += 1
            else:
                assert reading.shape == (32, 32) and np.isfinite(reading).all() and reading.min() >= 0
                read += 1
        assert all(w.category is RunWarning and str(path) in str(w.message) for w in caught)
    assert read > 20 and refused > 5
