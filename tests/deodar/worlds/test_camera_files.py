"""Video files as cameras and videos: a child reads them, until they are closed; what ends it is an error."""

from __future__ import annotations

import struct
import subprocess
import time
import zlib
from pathlib import Path
from typing import Any

import cv2
import imageio_ffmpeg
import numpy as np
import psutil
import pytest

import deodar as dd
from deodar.errors import WorldError
from deodar.worlds.camera import Camera

AXES = Camera.example_axes("picture")
SIDE = 16_000


def readers(file: Path) -> list[psutil.Process]:
    """Return the processes that have a file open."""
    processes = [psutil.Process(), *psutil.Process().children(recursive=True)]
    return [p for p in processes if any(Path(f.path) == file for f in p.open_files())]


def long_video(folder: Path) -> Path:
    """Write a video of 25 s with 10 pictures per second."""
    file = folder / "long.avi"
    film = cv2.VideoWriter(str(file), cv2.VideoWriter_fourcc(*"MJPG"), 10.0, (64, 48))
    for k in range(250):
        film.write(np.full((48, 64, 3), k, np.uint8))
    film.release()
    return file


def huge_video(folder: Path) -> Path:
    """Write a video of a few kilobytes, whose only picture takes gigabytes: black, a bit for each pixel."""
    head = struct.pack(">IIBBBBB", SIDE, SIDE, 1, 0, 0, 0, 0)
    rows = zlib.compress(bytes(SIDE * (1 + SIDE // 8)), 9)
    chunks = [(b"IHDR", head), (b"IDAT", rows), (b"IEND", b"")]
    picture, file = folder / "huge.png", folder / "huge.avi"
    picture.write_bytes(
        b"\x89PNG\r\n\x1a\n"
        + b"".join(
            struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content))
            for kind, content in chunks
        )
    )
    program = imageio_ffmpeg.get_ffmpeg_exe()
    command = [program, "-y", "-loglevel", "error", "-i", str(picture), "-c", "copy", str(file)]
    subprocess.run(command, check=True)
    assert file.stat().st_size < 100_000
    return file


def test_a_child_reads_the_file_and_is_free_after_the_camera_closes(tmp_path: Path) -> None:
    file = long_video(tmp_path)
    camera = Camera(str(file), patience=600.0)
    camera.reset(0)
    [reader] = readers(file)
    assert reader.pid != psutil.Process().pid
    assert camera.sense("picture", AXES, 0.0).shape == (16, 12, 3)
    camera.close()
    assert not readers(file)


def test_a_reader_that_was_killed_is_an_error_and_a_reset_opens_the_file_again(tmp_path: Path) -> None:
    file = long_video(tmp_path)
    camera = Camera(str(file), patience=600.0)
    camera.reset(0)
    [reader] = readers(file)
    reader.kill()

    limit = time.monotonic() + 60
    while camera.running and time.monotonic() < limit:  # pictures that it sent before are shown
        assert camera.sense("picture", AXES, 0.0).shape == (16, 12, 3)
    with pytest.raises(WorldError, match=r"camera .*long\.avi: cannot be read: its reader ended by SIGKILL"):
        camera.sense("picture", AXES, 0.0)
    camera.reset(0)
    assert camera.sense("picture", AXES, 0.0).shape == (16, 12, 3)
    camera.close()


def test_a_video_that_is_closed_has_no_reader_until_the_next_reading(tmp_path: Path) -> None:
    require_no_reader_once_closed(dd.Video, "picture", AXES, long_video(tmp_path))


def require_no_reader_once_closed(kind: Any, sensor: str, axes: Any, file: Path) -> None:
    """Require that a world of a video has a reader while it is open alone, and then continues."""
    worlds = [kind(file), kind(file)]
    seen = worlds[0].sense(sensor, axes, 2000.0)
    assert len(readers(file)) == 2
    worlds[0].close()
    assert len(readers(file)) == 1
    worlds[1].close()
    assert not readers(file)
    assert np.array_equal(worlds[0].sense(sensor, axes, 2000.0), seen)
    later = worlds[0].sense(sensor, axes, 4000.0)
    assert np.array_equal(worlds[1].sense(sensor, axes, 4000.0), later)
    for world in worlds:
        world.close()


@pytest.mark.parametrize("kind", [dd.Video, dd.Camera])
def test_a_small_file_that_states_gigabytes_is_an_error(kind: type, tmp_path: Path) -> None:
    before = psutil.Process().memory_info().rss
    with pytest.raises(WorldError, match=r"huge\.avi: cannot be read: it needs more than 2 GiB"):
        kind(str(huge_video(tmp_path))).reset(0)
    assert psutil.Process().memory_info().rss - before < 2**29
