"""Frames as a video: GIF, with one palette for all frames, MP4, or a folder of numbered PNG files; one frame
is in memory at a time.
"""

from __future__ import annotations

import contextlib
import itertools
import shutil
import struct
import subprocess
import tempfile
from collections.abc import Generator, Iterable, Iterator, Sequence
from pathlib import Path
from typing import IO

import numpy as np
from PIL import GifImagePlugin, Image

from deodar.errors import MissingExtra, OutputError, RecordError
from deodar.model import output
from deodar.recording import places

FORMATS = {"png": "", "gif": ".gif", "mp4": ".mp4"}
"""Formats of videos and the endings of their names; PNG files are in a folder."""

FASTEST = {"png": float("inf"), "gif": 50.0, "mp4": 60.0}
"""Most frames in a second: a GIF counts hundredths of a second, of which programs want two."""

ChangedPart = tuple[Image.Image, tuple[int, int]]
"""A rectangle of changed pixels, and its corner (column, row)."""

LOOP = b"\x21\xff\x0bNETSCAPE2.0\x03\x01\x00\x00\x00"


def claim(path: Path, format: str, force: bool = False) -> None:
    """Refuse a path that may not be written, and a format whose program is missing.

    Raises:
        OutputExists: the path exists, and `force` is not given.
        OutputError: it cannot be written.
        MissingExtra: an MP4 needs ffmpeg, which is not installed.
    """
    if format == "png":
        places.claim_folder(path, force)
        if path.is_dir() and any(p.suffix != ".png" for p in path.iterdir()):
            raise OutputError(
                "is a folder with other files than PNG", where=str(path), fix="Choose another name"
            )
    else:
        output.claim(path, force)
    if format == "mp4":
        ffmpeg()


def write(
    frames: Iterable[np.ndarray],
    path: Path,
    format: str,
    rate: float,
    force: bool = False,
    palette: VideoPalette | None = None,
) -> None:
    """Write a video.

    Args:
        frames: arrays (rows, columns, 3) of bytes, all of one size.
        path: the file, or the folder; `claim` has checked it.
        format: png, gif or mp4.
        rate: frames in a second.
        force: whether to replace an existing file or folder.
        palette: the colours of all frames of a GIF; none: each frame has its own.

    Raises:
        OutputError: it cannot be written.
    """
    if format == "png":
        places.write_folder(path, lambda folder: _png(frames, folder), force)
    elif format == "gif":
        output.write(path, lambda beside: _gif(frames, beside, rate, palette))
    else:
        output.write(path, lambda beside: _mp4(frames, beside, rate))


def ffmpeg() -> str:
    """Return the path of the program ffmpeg: that of imageio-ffmpeg, or an installed one.

    Raises:
        MissingExtra: neither is installed.
    """
    try:
        # an extra
        import imageio_ffmpeg

        return str(imageio_ffmpeg.get_ffmpeg_exe())
    except (ImportError, RuntimeError):
        found = shutil.which("ffmpeg")
        if found is None:
            raise MissingExtra("imageio-ffmpeg", "video", "a video in MP4") from None
        return found


def _png(frames: Iterable[np.ndarray], folder: Path) -> None:
    for n, frame in enumerate(frames, 1):
        Image.fromarray(frame).save(folder / f"frame-{n:05}.png")


def _gif(frames: Iterable[np.ndarray], path: Path, rate: float, palette: VideoPalette | None) -> None:
    """Write a GIF frame by frame: each has the pixels that differ from the one before.

    Pillow would keep all frames in memory. A frame without a change lengthens the one before.
    """
    with path.open("wb") as file:
        waiting: ChangedPart | None = None
        shown, clock = 0, 0.0
        for change in _changes(frames) if palette is None else palette.changes(frames):
            if change is not None:
                if waiting is None:
                    table = b"" if palette is None else palette.table()
                    size = struct.pack("<HHBBB", *change[0].size, 0xF7 if table else 0x70, 0, 0)
                    file.write(b"GIF89a" + size + table + LOOP)
                else:
                    shown += _gif_frame(file, *waiting, round(clock) - shown)
                waiting = change
            clock += 100.0 / rate
        if waiting is not None:
            _gif_frame(file, *waiting, round(clock) - shown)
        file.write(b";")


def _changes(frames: Iterable[np.ndarray]) -> Iterator[ChangedPart | None]:
    """Yield for each frame the rectangle of its changed pixels with a palette of its own, and its corner;
    None without a change.
    """
    last: np.ndarray | None = None
    for frame in frames:
        changed = np.ones(frame.shape[:2], bool) if last is None else (frame != last).any(2)
        last = frame
        yield _indexed(frame, changed) if changed.any() else None


def _indexed(frame: np.ndarray, changed: np.ndarray) -> ChangedPart:
    """Return the rectangle of the changed pixels with a palette, other pixels being clear, and its corner."""
    rows, columns = (np.flatnonzero(changed.any(axis)) for axis in (1, 0))
    box = slice(rows[0], rows[-1] + 1), slice(columns[0], columns[-1] + 1)
    pixels = Image.fromarray(frame[box][changed[box]].reshape(1, -1, 3))
    few = pixels.quantize(CLEAR, method=Image.Quantize.MAXCOVERAGE, dither=Image.Dither.NONE)
    numbers = np.full(changed[box].shape, CLEAR, np.uint8)
    numbers[changed[box]] = np.asarray(few).reshape(-1)
    image = Image.fromarray(numbers, "P")
    image.putpalette(few.getpalette() or [])
    return image, (int(columns[0]), int(rows[0]))


def _gif_frame(file: IO[bytes], image: Image.Image, at: tuple[int, int], hundredths: int) -> int:
    """Write one frame, which stays below the next one; return its duration in hundredths of a second.

    An image in greys has numbers of the palette of the whole file.
    """
    delay = max(1, min(hundredths, 65535))
    file.write(b"\x21\xf9\x04" + struct.pack("<BHBB", 0x05, delay, CLEAR, 0))
    for part in GifImagePlugin.getdata(image, at, include_color_table=image.mode == "P"):
        file.write(part)
    return delay


def _mp4(frames: Iterable[np.ndarray], path: Path, rate: float) -> None:
    """Send the frames to ffmpeg; H.264 needs an even number of rows and of columns."""
    found = iter(frames)
    first = _even(next(found))
    height, width = first.shape[:2]
    command = [ffmpeg(), "-y", "-loglevel", "error", "-f", "rawvideo", "-pix_fmt", "rgb24"]
    command += ["-s", f"{width}x{height}", "-r", f"{rate:.6f}", "-i", "-", "-an", "-c:v", "libx264"]
    command += ["-pix_fmt", "yuv420p", "-crf", "18", "-movflags", "+faststart", "-fflags", "+bitexact"]
    command += ["-flags:v", "+bitexact", "-f", "mp4", str(path)]
    with _process(command, path) as pipe:
        pipe.write(first.tobytes())
        for frame in found:
            pipe.write(_even(frame).tobytes())


@contextlib.contextmanager
def _process(command: list[str], path: Path) -> Generator[IO[bytes]]:
    """Start a program that reads from a pipe; raise an error with its last words if it fails."""
    with tempfile.TemporaryFile() as words:
        process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=words, stderr=words)
        assert process.stdin is not None
        try:
            yield process.stdin
            process.stdin.close()
        except BrokenPipeError:
            with contextlib.suppress(OSError):  # its words say why
                process.stdin.close()
        except BaseException:
            process.kill()
            process.wait()
            raise
        if process.wait() != 0:
            words.seek(0)
            said = words.read().decode(errors="replace").strip().splitlines()
            raise OutputError(
                f"ffmpeg failed: {said[-1] if said else f'status {process.returncode}'}", where=str(path)
            )


def _even(frame: np.ndarray) -> np.ndarray:
    rows, columns = frame.shape[0] % 2, frame.shape[1] % 2
    if rows or columns:
        frame = np.pad(frame, ((0, rows), (0, columns), (0, 0)), constant_values=255)
    return np.ascontiguousarray(frame)


def format_of(path: Path) -> str:
    """Return the format of a video from the ending of its name; a name without one is a folder of PNG files.

    Raises:
        RecordError: the ending names no format of videos.
    """
    found = [name for name, ending in FORMATS.items() if path.suffix.lower() == ending]
    if not found:
        raise RecordError(
            f"the name ends in {path.suffix!r}, which names no format of videos",
            where=str(path),
            fix="End it in .gif or .mp4; a name without ending is a folder of PNG files",
        )
    return found[0]


MOST = 255
"""Largest number of colours: a GIF has 256, one of which is clear."""

CLEAR = 255
"""The number of the clear colour."""

WEIGHTS = np.array([0.9, 1.2, 0.8], np.float32)
"""Weights of red, green and blue in the distance of two colours: an eye sees most by green."""

AT_ONCE = 20_000
"""Number of colours whose distances to the palette are in memory at once."""


def of_samples(samples: Sequence[np.ndarray], fixed: np.ndarray) -> np.ndarray:
    """Return a palette: the fixed colours, and a median cut of the colours of sample frames.

    Every colour of the samples counts once. Counted by its pixels, the edges of letters would lose theirs to
    large areas.

    Args:
        samples: arrays (..., 3) of bytes.
        fixed: colours (colours, 3) that the palette has, at most 254.
    """
    certain = np.unique(np.rint(fixed).astype(np.uint8), axis=0)
    seen = np.zeros(1 << 24, bool)
    for sample in samples:
        seen[_keys(sample)] = True
    colours = _colours(np.flatnonzero(seen)).astype(np.uint8)
    room = MOST - len(certain)
    few = Image.fromarray(colours[None]).quantize(
        room, method=Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE
    )
    others = np.array((few.getpalette() or [])[: 3 * room], np.uint8).reshape(-1, 3)
    return np.concatenate([certain, others])


class VideoPalette:
    """The colours of a whole video, and its frames as numbers of them.

    Args:
        colours: bytes (colours, 3), at most 255.
        tolerance: largest difference, summed over red, green and blue, up to which a pixel keeps the colour
            that is shown.
    """

    def __init__(self, colours: np.ndarray, tolerance: int = 0) -> None:
        self.colours = colours
        self._weighted = colours.astype(np.float32) * WEIGHTS
        self._nearest = np.full(1 << 24, -1, np.int16)
        wide = np.zeros((MOST, 3), int)
        wide[: len(colours)] = colours
        self._visible = np.abs(wide[:, None] - wide[None]).sum(2) > tolerance

    def table(self) -> bytes:
        """Return the colours as the table of a GIF, which has 256 entries."""
        return self.colours.tobytes().ljust(3 * 256, b"\0")

    def changes(self, frames: Iterable[np.ndarray]) -> Iterator[tuple[Image.Image, tuple[int, int]] | None]:
        """Yield for each frame the rectangle that differs from what is shown, and its corner; None without a
        difference.

        The other pixels of the rectangle are clear.
        """
        rest_of_frames = iter(frames)
        first = next(rest_of_frames)
        keys = _keys(first)
        display = self._numbers(keys)
        yield Image.fromarray(display.copy()), (0, 0)
        for last, frame in itertools.pairwise(itertools.chain([first], rest_of_frames)):
            if frame is last:
                yield None
                continue
            before, keys = keys, _keys(frame)
            changed = keys != before
            numbers = self._numbers(keys[changed])
            visible = self._visible[numbers, display[changed]]
            changed[changed] = visible
            if not visible.any():
                yield None
                continue
            display[changed] = numbers[visible]
            rows, columns = (np.flatnonzero(changed.any(axis)) for axis in (1, 0))
            box = slice(rows[0], rows[-1] + 1), slice(columns[0], columns[-1] + 1)
            part = np.where(changed[box], display[box], np.uint8(CLEAR))
            yield Image.fromarray(part), (int(columns[0]), int(rows[0]))

    def _numbers(self, keys: np.ndarray) -> np.ndarray:
        """Return the number of the nearest colour for each of some colours."""
        new = np.unique(keys[self._nearest[keys] < 0])
        for k in range(0, len(new), AT_ONCE):
            part = new[k : k + AT_ONCE]
            at = _colours(part).astype(np.float32) * WEIGHTS
            distances = (self._weighted**2).sum(1) - 2.0 * at @ self._weighted.T
            self._nearest[part] = distances.argmin(1)
        return self._nearest[keys].astype(np.uint8)


def _keys(pixels: np.ndarray) -> np.ndarray:
    """Return each colour as a number of 24 bits."""
    red, green, blue = (pixels[..., k].astype(np.int32) for k in range(3))
    return (red << 16) | (green << 8) | blue


def _colours(keys: np.ndarray) -> np.ndarray:
    """Return the colours (colours, 3) of numbers of 24 bits."""
    return np.stack([keys >> 16, (keys >> 8) & 255, keys & 255], axis=-1)
