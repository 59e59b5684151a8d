"""What it costs to read files of others in a child process: `python benchmarks/foreign_files.py`.

A row for each kind of file: the median time of reading it in this process, in a new child, and in one that is
kept; REPEATS times each. The first time of this process, which imports the parser here too, is left out.
"""

from __future__ import annotations

import functools
import itertools
import statistics
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from unittest import mock

import numpy as np
from PIL import Image

from deodar.errors import WorldError
from deodar.guarded import guarded_file
from deodar.guarded.channel import PlainData
from deodar.guarded.children import Children
from deodar.guarded.guarded_file import GuardedFile
from deodar.importers._beside import nothing
from deodar.importers.conversion import converted
from deodar.worlds.picture import pixels_of
from deodar_interop.records.mat import array_of, write
from deodar_robots.mujoco.scene_file import ROBOTS, SCENES, compile_files

REPEATS = 7

SAMPLE = Path(__file__).parents[1] / "tests/deodar_interop/importers/cosivina/presetCouplingFFT.json"

Reading = tuple[Callable[..., object], tuple[PlainData, ...]]


def readings(folder: Path) -> dict[str, Reading]:
    """Return a function and its arguments for each kind of file, some of which are written to a folder."""
    picture, matrix = folder / "picture.png", folder / "weights.mat"
    Image.fromarray(np.random.default_rng(0).integers(0, 255, (480, 640, 3), np.uint8)).save(picture)
    write({"weights": np.ones((100, 100))}, matrix)
    scene = str(SCENES / "table.xml"), str(ROBOTS / "lwr4.xml"), []
    return {
        "picture of 640 x 480": (pixels_of, (str(picture),)),
        "MATLAB, 100 x 100": (array_of, (str(matrix), "")),
        "MuJoCo, table and arm": (compile_files, scene),
        "cosivina, coupled fields": (
            converted,
            ("cosivina", SAMPLE.read_bytes(), SAMPLE.name, False, nothing),
        ),
    }


def times(name: str, function: Callable[..., object], values: tuple[PlainData, ...]) -> list[float]:
    """Return the times of reading a file here, in a new child, and in the same child again, in ms."""
    pool = Children()
    child = GuardedFile(WorldError, name)
    moments = [time.perf_counter()]
    with mock.patch.object(guarded_file, "children", lambda: pool):
        for reading in (function, *[functools.partial(child.call, function)] * 2):
            reading(*values)
            moments.append(time.perf_counter())
    return [1000 * (end - start) for start, end in itertools.pairwise(moments)]


def main() -> None:
    """Print the table."""
    sys.stdout.write("| file | here, ms | new child, ms | kept child, ms |\n|---|---|---|---|\n")
    with tempfile.TemporaryDirectory() as folder:
        for name, (function, values) in readings(Path(folder)).items():
            function(*values)
            rows = [times(name, function, values) for _ in range(REPEATS)]
            cells = (f"{statistics.median(column):.1f}" for column in zip(*rows, strict=True))
            sys.stdout.write(f"| {name} | {' | '.join(cells)} |\n")


if __name__ == "__main__":
    main()
