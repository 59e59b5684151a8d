"""Missing and broken pictures, files that are no pictures, and sensors that no world has."""

from __future__ import annotations

import struct
import zlib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

import deodar as dd
from deodar.elements.world_ports import Sensor
from deodar.errors import UnknownName, WorldError
from deodar.worlds.picture import Picture
from tests.deodar.errors.refused import refused

AXES = [dd.Axis("x", 0, 15, 16), dd.Axis("y", 0, 15, 16), dd.Axis("channel", 0, 2, 3)]


def _good(tmp_path: Path, kind: str = "png") -> Path:
    path = tmp_path / f"good.{kind}"
    Image.fromarray(np.random.default_rng(0).integers(0, 255, (40, 30, 3), dtype=np.uint8)).save(path)
    return path


def _chunk(kind: bytes, content: bytes) -> bytes:
    return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content))


def _claims(width: int, height: int) -> bytes:
    """Return a PNG of a few bytes that states a number of pixels."""
    head = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    return (
        b"\x89PNG\r\n\x1a\n"
        + _chunk(b"IHDR", head)
        + _chunk(b"IDAT", zlib.compress(b"\0" * 100))
        + _chunk(b"IEND", b"")
    )


def test_a_missing_picture_is_an_error(tmp_path: Path) -> None:
    path = tmp_path / "photo.jpg"
    refused(
        lambda: Picture(path), WorldError, str(path), "there is no such picture", "Name a picture: .png, .jpg"
    )


@pytest.mark.parametrize(
    "content",
    [
        b"",
        b"hello",
        b"\x89PNG\r\n\x1a\n",
        b"\xff\xd8\xff\xe0",
        bytes(range(256)) * 40,
        b"GIF89a",
        b"<svg/>",
        b"BM" + b"\xff" * 60,
    ],
)
def test_a_file_that_is_not_a_picture_is_an_error(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "photo.jpg"
    path.write_bytes(content)
    refused(lambda: Picture(path), WorldError, str(path), "cannot be read as a picture")


@pytest.mark.parametrize("kind", ["png", "jpg", "bmp", "webp", "tiff"])
@pytest.mark.parametrize("keep", [0.1, 0.5, 0.9])
def test_a_truncated_picture_is_an_error(tmp_path: Path, kind: str, keep: float) -> None:
    path = _good(tmp_path, kind)
    content = path.read_bytes()
    path.write_bytes(content[: int(len(content) * keep)])
    refused(lambda: Picture(path), WorldError, str(path), "cannot be read as a picture")


@pytest.mark.parametrize("size", [(20_000, 20_000), (12_000, 10_000), (2**31 - 1, 2**31 - 1)])
def test_a_picture_of_too_many_pixels_is_refused(tmp_path: Path, size: tuple[int, int]) -> None:
    path = tmp_path / "bomb.png"
    path.write_bytes(_claims(*size))
    refused(lambda: Picture(path), WorldError, str(path))


@pytest.mark.parametrize("file", ["", ".", "a" * 300, "nul\0byte.png", 5, None, [[1, 2, 3]]])
def test_a_value_that_is_not_a_path_of_a_picture_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, file: Any
) -> None:
    monkeypatch.chdir(tmp_path)
    refused(lambda: Picture(file), WorldError)


def test_a_named_pipe_is_refused_as_a_picture(tmp_path: Path) -> None:
    import os

    os.mkfifo(tmp_path / "pipe.png")
    refused(lambda: Picture(tmp_path / "pipe.png"), WorldError)


@pytest.mark.parametrize(
    "pixels",
    [
        np.zeros((4, 4)),
        np.zeros((4, 4, 4)),
        np.zeros((0, 4, 3)),
        np.full((4, 4, 3), np.nan),
        np.full((4, 4, 3), 2.0),
        np.full((4, 4, 3), -1),
        np.full((4, 4, 3), 256),
        np.full((4, 4, 3), "a"),
        np.full((4, 4, 3), None),
        np.full((4, 4, 3), 1j),
    ],
)
def test_arrays_of_another_shape_than_pictures_are_refused(pixels: np.ndarray) -> None:
    refused(lambda: Picture(pixels), WorldError)


@pytest.mark.parametrize("kind", ["L", "RGBA", "P", "1", "CMYK", "I", "LA"])
def test_pictures_of_every_mode_are_read_as_colour(tmp_path: Path, kind: str) -> None:
    path = tmp_path / "photo.tiff"
    Image.new(kind, (8, 6)).save(path) if kind not in ("P", "LA") else Image.new(kind, (8, 6)).save(
        path := tmp_path / "photo.png"
    )
    assert Picture(path).size == (8, 6)


def _sensing(sensor: str = "picture") -> dd.Model:
    model = dd.Model("m")
    model.add(Sensor("eye", AXES, sensor=sensor))
    return model


def test_a_sensor_without_a_world_is_an_error() -> None:
    model = _sensing()
    refused(
        lambda: dd.simulate(model, duration=1, record="eye.output"),
        WorldError,
        "eye: reads the sensor 'picture'",
        "world=dd.Picture('photo.jpg')",
        "dd.Picture(",
    )


def test_a_sensor_that_the_world_does_not_have_is_an_error() -> None:
    model = _sensing("pictur")
    refused(
        lambda: dd.simulate(model, duration=1, record="eye.output", world=Picture.example()),
        WorldError,
        "has no sensor 'pictur'",
        "Did you mean 'picture'?",
    )


def test_a_sensor_of_a_picture_with_other_axes_is_an_error() -> None:
    model = dd.Model("m")
    model.add(Sensor("eye", AXES[:2]))
    refused(
        lambda: dd.simulate(model, duration=1, record="eye.output", world=Picture.example()),
        WorldError,
        "two dimensions and three channels",
    )


@pytest.mark.parametrize("world", ["photo.jpg", 5, Picture, object()])
def test_a_value_that_is_not_a_world_is_refused(world: Any) -> None:
    refused(
        lambda: dd.simulate(_sensing(), duration=1, record="eye.output", world=world),
        WorldError,
        "expected a world",
    )


@pytest.mark.parametrize("reading", [np.zeros((16, 16)), np.full((16, 16, 3), np.nan), "picture", None])
def test_a_world_with_an_invalid_reading_is_an_error(reading: Any) -> None:
    class Broken(Picture):
        def sense(self, sensor: str, axes: Any, time: float) -> Any:
            return reading

    world = Broken(np.zeros((4, 4, 3)))
    refused(
        lambda: dd.simulate(_sensing(), duration=1, record="eye.output", world=world),
        WorldError,
        "picture",
        "it needs [16, 16, 3]",
    )


def test_an_unknown_port_of_a_sensor_is_an_error() -> None:
    refused(
        lambda: dd.simulate(_sensing(), duration=1, record="eye.outptu", world=Picture.example()),
        UnknownName,
        "Did you mean 'output'?",
    )
