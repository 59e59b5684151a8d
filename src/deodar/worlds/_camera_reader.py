"""The newest picture of a camera, which a thread reads by OpenCV (extra `vision`).

A video file is read by a child (`_capture`); devices and streams are read in this process.
"""

from __future__ import annotations

import os
import threading
import time
import weakref
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, Protocol

import numpy as np

from deodar import regular_file
from deodar.errors import Fix, WorldError
from deodar.worlds import _capture
from deodar.worlds._address import Address, Unreachable, unreachable

LEAVING = 1.0
"""s that closing a camera, also at the end of a program, waits for a picture that is being read (a guessed
constant).
"""

CameraForm = Literal["device", "file", "address"]


@dataclass(frozen=True)
class CameraSource:
    """What a camera opens.

    Attributes:
        form: a device, a file, or an address.
        shown: its name in messages and records.
        opened: what OpenCV opens; the address has one of its own.
        address: the address, for this form.
    """

    form: CameraForm
    shown: int | str
    opened: int | str = 0
    address: Address | None = None

    @property
    def where(self) -> str:
        """The camera in messages."""
        return f"camera {self.shown}"


@dataclass(frozen=True)
class CameraTimes:
    """Times of a camera.

    Attributes:
        opening: s until the first picture is there.
        patience: s without a new picture after which the camera has stopped.
        rate: most pictures per second; None: all.
    """

    opening: float
    patience: float
    rate: float | None = None


class CameraReader:
    """Camera reader with its own thread; `picture` returns the newest picture without waiting for the next.

    Only the newest picture is kept.

    Args:
        source: what is opened.
        times: how long it may take.
        size: width and height in pixels that the pictures have to have; None: any.

    Attributes:
        size: width and height in pixels.
    """

    def __init__(self, source: CameraSource, times: CameraTimes, size: tuple[int, int] | None = None) -> None:
        self.source, self.times = source, times
        _capture.opencv("a camera")
        self._stream = _Stream(source, times, size)
        self._thread = threading.Thread(target=self._stream.run, name=source.where, daemon=True)
        self._thread.start()
        weakref.finalize(self, self._stream.closing.set)
        weakref.finalize(self._stream, _leave, self._thread, self._stream.closing)
        began = time.monotonic()
        # the last tenth is for the question why no picture came; the reader of a file has a limit of its own
        answered = self._stream.ready.wait(None if source.form == "file" else 0.9 * times.opening)
        if self._stream.newest is None:
            self._stream.closing.set()
            raise self._failed(answered, max(times.opening - (time.monotonic() - began), 0.1))
        height, width = self._stream.newest.shape[:2]
        self.size = (int(width), int(height))
        if size is not None and self.size != size:
            self.close()
            raise WorldError(
                f"has pictures of {width} x {height}, and {size[0]} x {size[1]} are stated",
                where=source.where,
                fix=f"State the size that it has: size=({width}, {height})",
            )

    @property
    def running(self) -> bool:
        """Whether new pictures may come."""
        return self._thread.is_alive()

    def picture(self) -> np.ndarray:
        """Return the newest picture (height, width, 3).

        Raises:
            WorldError: the camera has delivered no picture for `patience` seconds, or the reader of a file
                has ended.
        """
        stream = self._stream
        if stream.error is not None:
            raise stream.error
        silent = time.monotonic() - stream.since
        if silent > self.times.patience or stream.newest is None:
            ended = "has ended, and " if stream.ended else ""
            raise WorldError(
                f"{ended}has delivered no picture for {silent:.1f} s",
                where=self.source.where,
                fix="Check that it is connected and sends pictures, then "
                + (
                    "reset the run"
                    if self.source.form == "file"
                    else "continue: the next reading opens it again"
                ),
            )
        return stream.newest

    def close(self) -> None:
        """Release the camera. A thread that waits for a picture ends when its patience does."""
        _leave(self._thread, self._stream.closing)

    def _failed(self, answered: bool, seconds: float) -> WorldError:
        """Return why no picture came."""
        where = self.source.where
        if self._stream.error is not None:
            return self._stream.error
        if self.source.address is not None:
            reason = unreachable(self.source.address, seconds)
            if reason is None and not answered:
                peer = f"{self.source.address.host}:{self.source.address.port}"
                fault = f"{peer} accepts the connection and sends no picture within {self.times.opening:g} s"
                reason = Unreachable(fault, "Check the port and the path, or allow more: open_timeout=10")
            if reason is None:
                fix = "Check the path: a player of videos has to show it, too"
                reason = Unreachable("sends nothing that OpenCV reads as pictures", fix)
            return WorldError(reason.what, where=where, fix=reason.fix)
        if self.source.form == "file":
            return WorldError("cannot be read as a video", where=where, fix=_capture.NAME_A_VIDEO)
        fault = "there is no camera, or another program uses it"
        if not answered:
            fault = f"sends no picture within {self.times.opening:g} s"
        return WorldError(
            fault,
            where=where,
            fix=Fix("Try another number: Camera(1)", "Try another number: --world camera:1"),
        )


class _Pictures(Protocol):
    """Pictures one after another.

    Attributes:
        rate: pictures per second at which they are played; 0: they come by themselves.
        is_open: whether there may be a picture.
    """

    rate: float
    is_open: bool

    def read(self) -> np.ndarray | None:
        """Return the next picture, (height, width, 3), blue first; None: there is none."""
        ...

    def release(self) -> None:
        """Leave the device or file."""
        ...


class _Device:
    """Pictures of a device or an address."""

    rate = 0.0

    def __init__(self, source: CameraSource, times: CameraTimes, size: tuple[int, int] | None) -> None:
        self._opened = _opened(source, times, size)
        self.is_open = bool(self._opened.isOpened())

    def read(self) -> np.ndarray | None:
        has_picture, picture = self._opened.read()
        return picture if has_picture else None

    def release(self) -> None:
        self._opened.release()


class _File:
    """Pictures of a video file, which a child reads."""

    def __init__(self, source: CameraSource) -> None:
        self._pictures = _capture.video_pictures(Path(str(source.opened)), source.where)
        self.rate = float(next(self._pictures, np.zeros(())).item())
        self.is_open = self.rate > 0

    def read(self) -> np.ndarray | None:
        picture = next(self._pictures, None)
        return None if picture is None else picture[:, :, ::-1]

    def release(self) -> None:
        self._pictures.close()


class _Stream:
    """The newest picture and the loop of the thread.

    It has no reference to its `CameraReader`, so that the camera is released when the `CameraReader` is
    garbage-collected.
    """

    def __init__(self, source: CameraSource, times: CameraTimes, size: tuple[int, int] | None) -> None:
        self.source, self.times, self.size = source, times, size
        self.newest: np.ndarray | None = None
        self.error: WorldError | None = None
        self.since = time.monotonic()
        self.ended = False
        self.closing, self.ready = threading.Event(), threading.Event()

    def run(self) -> None:
        """Open the camera and read pictures until closed, or until none arrives for `patience` seconds."""
        with _capture.silence():
            pictures: _Pictures | None = None
            try:
                in_file = self.source.form == "file"
                pictures = _File(self.source) if in_file else _Device(self.source, self.times, self.size)
                if pictures.is_open:
                    self._watch(pictures)
            except WorldError as error:
                self.error = error
            except _capture.opencv("a camera").error:
                pass  # as a camera that is not there
            finally:
                if pictures is not None:
                    pictures.release()
                self.ready.set()

    def _watch(self, pictures: _Pictures) -> None:
        least, next_kept, due = 1.0 / (self.times.rate or np.inf), 0.0, time.monotonic()
        while not self.closing.is_set():
            picture = pictures.read()
            moment = time.monotonic()
            if picture is not None and moment >= next_kept:
                self.newest = np.ascontiguousarray(picture[:, :, ::-1])
                next_kept = moment + least if self.times.rate else 0.0
            if picture is not None:
                self.since = moment
                self.ready.set()
            elif self.source.form != "device" or moment - self.since > self.times.patience:
                # FFmpeg gives up a stream that sends nothing for `patience`
                self.ended = self.source.form != "device" and moment - self.since < 0.9 * self.times.patience
                return
            else:
                self.closing.wait(0.02)
            if pictures.rate > 0:
                due += 1.0 / pictures.rate
                self.closing.wait(max(0.0, due - time.monotonic()))


def _leave(thread: threading.Thread, closing: threading.Event) -> None:
    """End a reading thread, and wait for its end, also before the interpreter ends.

    A thread that returns from OpenCV to an interpreter that is ending aborts the process.
    """
    closing.set()
    if thread is not threading.current_thread():
        thread.join(timeout=LEAVING)


def _opened(source: CameraSource, times: CameraTimes, size: tuple[int, int] | None) -> Any:
    """Open the device or address that a camera names."""
    cv2 = _capture.opencv("a camera")
    if source.address is not None:
        limits = [cv2.CAP_PROP_OPEN_TIMEOUT_MSEC, max(1, round(900 * times.opening))]
        limits += [cv2.CAP_PROP_READ_TIMEOUT_MSEC, max(1, round(1000 * times.patience))]
        return cv2.VideoCapture(source.address.full, cv2.CAP_FFMPEG, limits)
    opened = cv2.VideoCapture(source.opened, cv2.CAP_ANY if isinstance(source.opened, int) else cv2.CAP_V4L2)
    if size is not None:
        opened.set(cv2.CAP_PROP_FRAME_WIDTH, size[0])
        opened.set(cv2.CAP_PROP_FRAME_HEIGHT, size[1])
    if times.rate is not None:
        opened.set(cv2.CAP_PROP_FPS, times.rate)
    return opened


def source_of(name: int | str) -> CameraSource:
    """Return what the number of a device, the path of a device or file, or an address names.

    Raises:
        WorldError: it names none of these, or there is no such file.
    """
    if not isinstance(name, str):
        return CameraSource("device", int(name), int(name))
    if "://" in name:
        address = Address.of(name)
        return CameraSource("address", address.shown, address=address)
    path = Path(name)
    if os.path.exists(path) and path.is_char_device():  # False for a name that is too long
        return CameraSource("device", name, str(path.absolute()))
    regular_file.refuse_special(path, WorldError)
    if not regular_file.is_file(path):
        fix = "Name a number such as 0, a device, a file, or an address: rtsp://HOST/PATH"
        raise WorldError("there is no such device or file", where=f"camera {name}", fix=fix)
    return CameraSource("file", name, str(path.absolute()))
