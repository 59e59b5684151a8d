"""Pictures from video files and cameras, read by OpenCV (extra `vision`)."""

from __future__ import annotations

import atexit
import shutil
import tempfile
import threading
import time
import weakref
from pathlib import Path
from typing import Any

import numpy as np

from deodar.errors import MissingExtra, WorldError
from deodar.numerics.axes import Axes, Axis

RATE = 5
"""OpenCV's number of the property for pictures per second (CAP_PROP_FPS)."""


def opencv(purpose: str) -> Any:
    """Import OpenCV, or raise an error that says how to install it."""
    try:
        # an extra
        import cv2
    except ImportError:
        raise MissingExtra("opencv-python-headless", "vision", purpose) from None
    return cv2


def capture(source: int | str, purpose: str) -> Any:
    """Open a video file or a camera; OpenCV's log is silent, because deodar reports a failure itself."""
    cv2 = opencv(purpose)
    log: Any = cv2.utils.logging
    level = log.getLogLevel()
    log.setLogLevel(log.LOG_LEVEL_SILENT)
    try:
        return cv2.VideoCapture(source)
    finally:
        log.setLogLevel(level)


class VideoReader:
    """Reader that returns the pictures of a video file by time.

    Attributes:
        size: width and height in pixels.
        rate: pictures per second.
        pictures: number of pictures, known once the last one was read; before that None.
    """

    def __init__(self, path: Path) -> None:
        self.pictures: int | None = None
        if not path.is_file():
            raise WorldError(
                "there is no such video",
                where=str(path),
                fix="Name a file that OpenCV can read, such as an .mp4 or .avi",
            )
        self.path = path
        self._opened: Any = None
        self.rewind()
        self.size = (int(self._shown.shape[1]), int(self._shown.shape[0]))

    def rewind(self) -> None:
        """Return to the first picture."""
        if self._opened is not None:
            self._opened.release()
        self._opened = capture(str(self.path), "reading a video")
        self.rate = float(self._opened.get(RATE)) if self._opened.isOpened() else 0.0
        first = self._next()
        if first is None or not self.rate > 0:
            raise WorldError("cannot be read as a video", where=str(self.path))
        self._shown, self._number = first, 0

    def picture(self, moment: float, again: bool) -> np.ndarray:
        """Return the picture (height, width, 3) at a time in ms.

        After the end of the video, return the last picture, or with `again` start from the first one.
        """
        wanted = int(moment * self.rate / 1000 + 1e-6)
        if again and self.pictures is not None:
            wanted %= self.pictures
        if wanted < self._number:
            self.rewind()
        while self._number < wanted:
            picture = self._next()
            if picture is None:
                self.pictures = self._number + 1
                return self.picture(moment, again) if again else self._shown
            self._shown, self._number = picture, self._number + 1
        return self._shown

    def _next(self) -> np.ndarray | None:
        there, picture = self._opened.read()
        return np.ascontiguousarray(picture[:, :, ::-1]) if there else None

    def __getstate__(self) -> dict[str, Any]:
        return {"path": self.path}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__init__(state["path"])


class CameraReader:
    """Camera reader with its own thread; `picture` returns the newest picture without waiting for the next.

    Attributes:
        size: width and height in pixels.
    """

    def __init__(self, source: int | str, patience: float) -> None:
        self.source, self.patience = source, patience
        opened = capture(source, "a camera")
        there, first = opened.read() if opened.isOpened() else (False, np.zeros((0, 0, 3), np.uint8))
        if not there:
            opened.release()
            raise WorldError(
                "there is no camera, or another program uses it",
                where=f"camera {source}",
                fix="Try another number: --camera 1",
            )
        self._stream = _Stream(opened, np.ascontiguousarray(first[:, :, ::-1]), patience)
        self.size = (int(first.shape[1]), int(first.shape[0]))
        self._thread = threading.Thread(target=self._stream.watch, name=f"camera {source}", daemon=True)
        self._thread.start()
        weakref.finalize(self, self._stream.closing.set)

    def picture(self) -> np.ndarray:
        """Return the newest picture (height, width, 3).

        Raises:
            WorldError: the camera has delivered no picture for `patience` seconds.
        """
        silent = time.monotonic() - self._stream.since
        if silent > self.patience:
            raise WorldError(
                f"has delivered no picture for {silent:.1f} s",
                where=f"camera {self.source}",
                fix="Check that it is connected",
            )
        return self._stream.newest

    def close(self) -> None:
        """Release the camera."""
        self._stream.closing.set()
        self._thread.join(timeout=1.0)


class _Stream:
    """The newest picture and the loop of the thread.

    It has no reference to its `CameraReader`, so that the camera is released when the `CameraReader` is
    garbage-collected.
    """

    def __init__(self, opened: Any, first: np.ndarray, patience: float) -> None:
        self.opened, self.newest, self.since, self.patience = opened, first, time.monotonic(), patience
        self.closing = threading.Event()

    def watch(self) -> None:
        """Read pictures until closed, or until none arrives for `patience` seconds."""
        try:
            while not self.closing.is_set() and time.monotonic() - self.since <= self.patience:
                there, picture = self.opened.read()
                if there:
                    self.newest, self.since = np.ascontiguousarray(picture[:, :, ::-1]), time.monotonic()
                else:
                    self.closing.wait(0.02)
        finally:
            self.opened.release()


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
        left = 2 * k if moves else 24
        picture[16:32, left : left + 16] = (0, 0, 255)
        film.write(picture)
    film.release()
    return file
