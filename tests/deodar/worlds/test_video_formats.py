"""What is read as a video, and that files of other formats are refused under any name."""

from __future__ import annotations

import json
import os
import subprocess
from pathlib import Path
from typing import Any

import imageio_ffmpeg
import numpy as np
import pytest
from PIL import Image

import deodar as dd
from deodar.errors import WorldError
from deodar.worlds import _capture

SQUARE = _capture.example()

LETTERS = "deodar\n" * 200
SHORT_PLAYLIST = "#EXTM3U\n#EXT-X-TARGETDURATION:1\n#EXTINF:1,\n{video}\n#EXT-X-ENDLIST\n"

NO_VIDEOS = {
    "letters.txt": LETTERS.encode(),
    "letters.nfo": LETTERS.encode(),
    "letters.mp4": LETTERS.encode(),
    "events.txt": b"0.1 1 2 1\n" * 200,
    "page.html": b"<html><body>deodar</body></html>",
    "data.json": json.dumps({"a": [1, 2, 3]}).encode(),
    "bytes.bin": bytes(range(256)) * 100,
    "script.py": b"print('deodar')\n" * 50,
    "empty.mp4": b"",
}


def written(path: Path, *options: str, source: Path = SQUARE) -> Path:
    """Write the video of a red square, or another source, in the format of a file's ending."""
    program = imageio_ffmpeg.get_ffmpeg_exe()
    subprocess.run([program, "-loglevel", "error", "-i", str(source), *options, str(path)], check=True)
    return path


@pytest.mark.parametrize("name", NO_VIDEOS)
def test_a_file_of_another_format_is_no_video(name: str, tmp_path: Path):
    file = tmp_path / name
    file.write_bytes(NO_VIDEOS[name])
    says = rf"{file.name}: cannot be read as a video\. Name a video: .*\.mp4, .*\.avi.* dd\.Picture"
    with pytest.raises(WorldError, match=says):
        dd.Video(file)


@pytest.mark.parametrize("ending", ["png", "jpg", "bmp", "tif", "webp"])
def test_a_picture_is_no_video(ending: str, tmp_path: Path):
    file = tmp_path / f"picture.{ending}"
    Image.fromarray(np.zeros((48, 64, 3), np.uint8)).save(file)
    assert dd.Picture(file).size == (64, 48)
    with pytest.raises(WorldError, match="cannot be read as a video"):
        dd.Video(file)


@pytest.mark.parametrize("name", ["list.m3u8", "list.ffconcat"])
def test_a_playlist_reads_no_other_file(name: str, tmp_path: Path):
    video = written(tmp_path / "part.ts")
    assert dd.Video(video).size == (64, 48)
    lists = {
        "list.m3u8": SHORT_PLAYLIST.format(video=video),
        "list.ffconcat": f"ffconcat version 1.0\nfile {video.name}\n",
    }
    file = tmp_path / name
    file.write_text(lists[name])
    with pytest.raises(WorldError, match="cannot be read as a video"):
        dd.Video(file)


OPTIONS = {".mjpg": ("-f", "mjpeg"), ".mjpeg": ("-f", "mpjpeg")}
"""Options with which formats are written that have no ending of their own."""


@pytest.mark.parametrize(
    "ending",
    [*dd.Video.opens, ".ts", ".flv", ".ogv", ".wmv", ".gif", ".y4m", ".nut", ".rm", ".wtv", *OPTIONS],
)
def test_formats_of_videos_are_read(ending: str, tmp_path: Path):
    world = dd.Video(written(tmp_path / f"square{ending}", *OPTIONS.get(ending, ())))
    assert world.size == (64, 48)
    first, later = world.picture(0.0), world.picture(400.0)
    assert np.argmax(first[24, :, 0]) < 17 and 17 < np.argmax(later[24, :, 0]) < 40


INTERLACED = ("-vf", "fps=50,tinterlace=interleave_top", "-flags", "+ildct+ilme")
"""Options of ffmpeg with which each picture has the lines of two moments."""


@pytest.mark.parametrize("kind", [dd.Video, dd.Camera])
@pytest.mark.parametrize("coder", ["libx264", "mpeg4", "mpeg2video"])
def test_an_interlaced_video_is_read_or_refused(coder: str, kind: Any, tmp_path: Path):
    """OpenCV 5.0 returns undefined pictures of it; other versions convert them."""
    options = (*INTERLACED, "-c:v", coder, "-pix_fmt", "yuv420p")
    file = written(tmp_path / "lines.mkv", *options)
    try:
        world = kind(str(file))
        world.reset(0)
    except WorldError as error:
        (problem,) = error.problems
        assert problem.where.endswith("lines.mkv") and "has interlaced pictures" in problem.what
        assert "ffmpeg -i FILE -vf yadif NEW.mp4" in problem.fix
        converted = written(tmp_path / "new.mp4", "-vf", "yadif", source=file)
        assert 100 < dd.Video(converted).picture(0.0).mean() < 200
    else:
        assert kind is not dd.Video or 100 < world.picture(0.0).mean() < 200


def test_what_libraries_write_of_an_error_is_collected(capfd: pytest.CaptureFixture[str]):
    with _capture.standard_error() as written:
        assert written() == ""
        for text in ("one\n", "two\n" * 10_000, "\N{GREEK SMALL LETTER ALPHA}"):
            os.write(2, text.encode())
            assert written() == text and written() == ""
    os.write(2, b"after")
    assert capfd.readouterr().err == "after"


@pytest.mark.parametrize("content", [LETTERS.encode(), b"", bytes(range(256)) * 100])
def test_an_error_of_a_picture_names_formats(content: bytes, tmp_path: Path):
    file = tmp_path / "letters.png"
    file.write_bytes(content)
    with pytest.raises(WorldError, match=r"cannot be read as a picture.*Name a picture: .*\.png, .*\.jpg"):
        dd.Picture(file)


@pytest.mark.parametrize("name", NO_VIDEOS)
def test_a_file_of_another_format_is_no_camera(name: str, tmp_path: Path):
    file = tmp_path / name
    file.write_bytes(NO_VIDEOS[name])
    says = rf"camera .*{file.name}: cannot be read as a video\. Name a video: .*\.mp4"
    with pytest.raises(WorldError, match=says):
        dd.Camera(str(file)).reset(0)


@pytest.mark.parametrize("kind", [dd.Picture, dd.Video, dd.Camera])
def test_a_pipe_in_place_of_a_file_says_that_its_content_is_saved_first(kind: Any, tmp_path: Path):
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(WorldError, match=r"pipe: is not a regular file\. Save its content in a file"):
        kind(str(tmp_path / "pipe")).reset(0)
