"""OpenCV (extra `vision`), without messages of its own, and the pictures of video files."""

from __future__ import annotations

import atexit
import contextlib
import os
import shutil
import tempfile
import threading
from collections.abc import Callable, Generator
from pathlib import Path
from typing import Any

import numpy as np

from deodar import regular_file
from deodar.errors import Fix, MissingExtra, WorldError
from deodar.guarded.guarded_file import GuardedFile
from deodar.numerics.axes import Axes, Axis

VIDEO_ENDINGS = (".mp4", ".avi", ".mov", ".mkv", ".webm", ".m4v", ".mpg", ".mpeg")
"""Endings of the files that are offered as videos."""

NAME_A_VIDEO = Fix(
    f"Name a video: {', '.join(VIDEO_ENDINGS)}. A picture is opened by dd.Picture",
    f"Name a video: {', '.join(VIDEO_ENDINGS)}. A picture is opened by --world picture:FILE",
    f"Name a video: {', '.join(VIDEO_ENDINGS)}. A picture is another world",
)

VIDEO_FORMATS = (
    *("avi", "matroska", "mov", "mpeg", "mpegts", "mpegvideo", "m4v", "h264", "hevc", "ivf", "flv", "asf"),
    *("ogg", "mxf", "gif", "apng", "mjpeg", "mpjpeg", "yuv4mpegpipe", "nut", "rm", "wtv"),
)
"""Formats of FFmpeg that are read. Among its others are text, which it shows as pictures of letters, files
without a format, and playlists, which name other files and addresses.
"""

FILE_OPTIONS = f"protocol_whitelist;file|format_whitelist;{','.join(VIDEO_FORMATS)}"
"""Options with which a file is opened, in the form of OpenCV."""

LEVELS = ("OPENCV_FFMPEG_LOGLEVEL", "OPENCV_FFMPEG_DEBUG")
"""Variables of the environment that state which messages of FFmpeg OpenCV prints."""

UNCONVERTED = "Cannot convert interlaced"
"""What FFmpeg writes of an interlaced picture that OpenCV 5.0 asks it to convert."""

DEINTERLACE = "Convert the video first: ffmpeg -i FILE -vf yadif NEW.mp4"

NO_MEMORY = -4
"""OpenCV's number of the error of an allocation that failed."""

RATE = 5
"""OpenCV's number of the property for pictures per second (CAP_PROP_FPS)."""


def opencv(purpose: str) -> Any:
    """Import OpenCV, or raise an error that says how to install it."""
    # FFmpeg writes nothing to the terminal, unless the user states another level; it is read once
    os.environ.setdefault("OPENCV_FFMPEG_LOGLEVEL", "-8")
    try:
        # an extra
        import cv2
    except ImportError:
        raise MissingExtra("opencv-python-headless", "vision", purpose) from None
    return cv2


_lock = threading.Lock()
_silenced: list[int] = []


@contextlib.contextmanager
def silence() -> Generator[None]:
    """Silence the log of OpenCV, because deodar reports a failure itself; several threads may do so at once.

    The log of OpenCV has one level for the whole process. The last one that ends restores it.
    """
    log: Any = opencv("a camera").utils.logging
    with _lock:
        _silenced.append(_silenced[0] if _silenced else log.getLogLevel())
        log.setLogLevel(log.LOG_LEVEL_SILENT)
    try:
        yield
    finally:
        with _lock:
            level = _silenced.pop()
            if not _silenced:
                log.setLogLevel(level)


@contextlib.contextmanager
def standard_error() -> Generator[Callable[[], str]]:
    """Collect what libraries write to the standard error of this process.

    Yields:
        A function that returns what was written since its last call.
    """

    def written() -> str:
        if not file.tell():  # both descriptors have one position
            return ""
        file.seek(0)
        text = file.read()
        file.seek(0)
        file.truncate()
        return text.decode(errors="replace")

    with tempfile.TemporaryFile(buffering=0) as file:
        before = os.dup(2)
        os.dup2(file.fileno(), 2)
        try:
            yield written
        finally:
            os.dup2(before, 2)
            os.close(before)


def pictures_of(file: str, where: str) -> Generator[np.ndarray]:
    """Yield pictures per second (0: no video), and each picture (height, width, 3); in a child process.

    Raises:
        MemoryError: a picture does not fit into the memory of the child.
        WorldError: a picture cannot be converted; it names `where`.
    """
    with standard_error() as written:
        for array in _arrays_of(file):
            # OpenCV returns such a picture with what the memory held before
            if UNCONVERTED in written():
                raise WorldError("has interlaced pictures, which OpenCV does not convert", where, DEINTERLACE)
            yield array


def _arrays_of(file: str) -> Generator[np.ndarray]:
    cv2 = opencv("reading a video")
    os.environ["OPENCV_FFMPEG_CAPTURE_OPTIONS"] = FILE_OPTIONS
    # other readers of OpenCV know formats besides these
    reader = cv2.CAP_FFMPEG if cv2.CAP_FFMPEG in cv2.videoio_registry.getStreamBackends() else cv2.CAP_ANY
    with silence():
        for name in LEVELS:  # without them FFmpeg writes its errors to the standard error, at once
            os.environ.pop(name, None)
        opened = cv2.VideoCapture(file, reader)
    yield np.array([opened.get(RATE) if opened.isOpened() else 0.0])
    try:
        while (read := opened.read())[0]:
            yield cv2.cvtColor(read[1], cv2.COLOR_BGR2RGB)
    except cv2.error as error:
        raise MemoryError if error.code == NO_MEMORY else error from None
    opened.release()


def video_pictures(path: Path, where: str) -> Generator[np.ndarray]:
    """Yield what `pictures_of` yields; errors name `where`."""
    return GuardedFile(WorldError, where).items(pictures_of, str(path), where)


class VideoReader:
    """Reader that returns the pictures of a video file by time.

    Attributes:
        size: width and height in pixels.
        rate: pictures per second.
        pictures: number of pictures, known once the last one was read; before that None.
    """

    def __init__(self, path: Path) -> None:
        self.pictures: int | None = None
        regular_file.refuse_special(path, WorldError)
        if not regular_file.is_file(path):
            raise WorldError(
                "there is no such video",
                where=str(path),
                fix=NAME_A_VIDEO,
            )
        self.path = path
        self._pictures = self._read()
        self.rewind()
        self.size = (int(self._shown.shape[1]), int(self._shown.shape[0]))

    def rewind(self) -> None:
        """Return to the first picture."""
        self._pictures.close()
        self._pictures, self._process = self._read(), os.getpid()
        self.rate = next(self._pictures, np.zeros(())).item()
        first = self._next()
        if first is None or not self.rate > 0:
            raise WorldError("cannot be read as a video", where=str(self.path), fix=NAME_A_VIDEO)
        self._shown, self._number = first, 0

    def close(self) -> None:
        """Leave the child to other files; the next picture opens the video again."""
        self._pictures.close()
        self._process = 0

    def picture(self, moment: float, again: bool) -> np.ndarray:
        """Return the picture (height, width, 3) at a time in ms.

        After the end of the video, return the last picture, or with `again` start from the first one.
        """
        number = int(moment * self.rate / 1000 + 1e-6)
        if again and self.pictures is not None:
            number %= self.pictures
        # the reader of a process does not read for its forks
        if number < self._number or os.getpid() != self._process:
            self.rewind()
        while self._number < number:
            picture = self._next()
            if picture is None:
                self.pictures = self._number + 1
                return self.picture(moment, again) if again else self._shown
            self._shown, self._number = picture, self._number + 1
        return self._shown

    def _next(self) -> np.ndarray | None:
        return next(self._pictures, None)

    def _read(self) -> Generator[np.ndarray]:
        return video_pictures(self.path, str(self.path))

    def __getstate__(self) -> dict[str, Any]:
        return {"path": self.path}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__init__(state["path"])


EXAMPLE_AXES: Axes = (Axis("x", 0, 15, 16), Axis("y", 0, 11, 12), Axis("channel", 0, 2, 3))
"""Axes over which the example can be read, in the proportions of its pictures."""


def example(moves: bool = True) -> Path:
    """Write a short video into the folder of temporary files, and delete it at exit.

    A red square of 16 pixels crosses a grey ground in one second, or with `moves=False` does not move.
    """
    cv2 = opencv("writing a video")
    folder = Path(tempfile.mkdtemp(prefix="deodar-"))
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    file = folder / "square.avi"
    film: Any = cv2.VideoWriter(str(file), cv2.VideoWriter_fourcc(*"MJPG"), 25.0, (64, 48))
    for k in range(25):
        picture = np.full((48, 64, 3), 128, np.uint8)
        corner = 2 * k if moves else 24
        picture[16:32, corner : corner + 16] = (0, 0, 255)
        film.write(picture)
    film.release()
    return file
