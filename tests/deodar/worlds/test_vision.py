"""Videos and cameras: their pictures over time, and the errors without one."""

from __future__ import annotations

import itertools
import pickle
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

import deodar as dd
from deodar.elements.world_ports import Sensor
from deodar.errors import MissingExtra, WorldError
from deodar.worlds import _capture
from deodar.worlds.camera import Camera
from deodar.worlds.picture import Picture
from deodar.worlds.video import Video

AXES = Video.example_axes("picture")
FINE = dd.Axis("x", 0, 63, 64), dd.Axis("y", 0, 47, 48), dd.Axis("channel", 0, 2, 3)


def middle(picture: np.ndarray) -> float:
    """Return the column of the middle of the red pixels."""
    red = np.clip(picture[:, :, 0] - picture[:, :, 2] - 0.3, 0, None).sum(axis=1)
    return float((red * np.arange(len(red))).sum() / red.sum())


@pytest.fixture(scope="module")
def film() -> Path:
    return _capture.example()


def test_a_video_follows_the_time_of_the_model(film: Path) -> None:
    world = Video(film)
    assert world.size == (64, 48)
    for moment in (0.0, 39.0, 40.0, 400.0, 120.0, 960.0):  # also back in time
        assert abs(middle(world.sense("picture", FINE, moment)) - (2 * (moment // 40) + 7.5)) < 1.0
    model = dd.Model("watching")
    model.add(Sensor("eye", FINE, "picture"))
    record = dd.simulate(model, 400, dt=10, record=["eye.output"], every=10, world=Video(film, period=80))
    seen = [middle(v) for v in record["eye.output"].values]
    assert all((abs(a - b) < 0.1) == (k % 8 != 7) for k, (a, b) in enumerate(itertools.pairwise(seen)))


def test_a_video_keeps_its_last_picture_or_repeats(film: Path) -> None:
    last = Video(film).sense("picture", FINE, 960.0)
    np.testing.assert_array_equal(Video(film).sense("picture", FINE, 5000.0), last)
    looped = Video(film, loop=True)
    for moment, place in ((80.0, 80.0), (1080.0, 80.0), (10_400.0, 400.0)):
        assert abs(middle(looped.sense("picture", FINE, moment)) - (2 * (place // 40) + 7.5)) < 1.0


def test_a_repeated_video_is_read_once_for_each_repetition(
    film: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    world = Video(film, loop=True)
    world.sense("picture", AXES, 2000.0)
    read: list[int] = []
    following = _capture.VideoReader._next
    monkeypatch.setattr(_capture.VideoReader, "_next", lambda self: read.append(1) or following(self))
    for k in range(25):
        world.sense("picture", AXES, 2000.0 + 40 * k)
    assert len(read) <= 26


def test_a_video_can_be_pickled(film: Path) -> None:
    world = pickle.loads(pickle.dumps(Video(film)))
    np.testing.assert_array_equal(
        world.sense("picture", AXES, 200.0), Video(film).sense("picture", AXES, 200.0)
    )


def test_a_record_names_the_video(film: Path) -> None:
    description = Video(film).describe()
    assert Video.again(description).describe() == description and len(description["sha256"]) == 64


def test_files_that_are_not_a_video_are_refused(tmp_path: Path) -> None:
    text = tmp_path / "film.mp4"
    text.write_text("not a video")
    with pytest.raises(WorldError, match=r"film.mp4: cannot be read as a video"):
        Video(text)
    with pytest.raises(WorldError, match="there is no such video"):
        Video(tmp_path / "none.avi")
    with pytest.raises(WorldError, match="period is 0"):
        Video(text, period=0)


def test_a_camera_gives_its_latest_picture_without_waiting(film: Path) -> None:
    camera = Camera(str(film), patience=60.0)
    camera.reset(0)
    # a video in place of a camera is played to its last picture
    while abs(middle(camera.sense("picture", FINE, 0.0)) - 55.5) >= 1.0:
        time.sleep(0.01)
    camera.sense("picture", FINE, 0.0)  # no picture follows, and the test does not wait for one
    camera.close()
    assert camera.sense("picture", AXES, 0.0).shape == (16, 12, 3), "a reading opens it again"
    camera.close()


def test_a_camera_that_stops_is_an_error(film: Path) -> None:
    camera = Camera(str(film), patience=0.2)
    camera.reset(0)
    time.sleep(1.6)  # it lasts for one second
    says = r"camera .*square.avi: has ended, and has delivered no picture for \d+\.\d s"
    with pytest.raises(WorldError, match=says):
        camera.sense("picture", AXES, 0.0)
    camera.close()


def test_a_missing_camera_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(WorldError, match="there is no camera, or another program uses it"):
        Camera(97, open_timeout=60.0).reset(0)
    with pytest.raises(WorldError, match="there is no such device or file"):
        Camera(str(tmp_path / "nothing")).reset(0)
    (tmp_path / "text.mp4").write_text("not a video")
    with pytest.raises(WorldError, match="cannot be read as a video"):
        Camera(str(tmp_path / "text.mp4"), open_timeout=60.0).reset(0)
    for source in (-1, 1.5, True, "", None):
        with pytest.raises(WorldError, match="source of a camera"):
            Camera(source)  # type: ignore[arg-type]


def test_without_opencv_the_error_names_the_package_to_install(
    film: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "cv2", None)
    says = r"needs the package opencv-python-headless.*pip install 'deodar\[vision\]'"
    with pytest.raises(MissingExtra, match=says):
        next(_capture.pictures_of(str(film), "film"))
    with pytest.raises(MissingExtra, match=says):
        Camera(0).reset(0)


def test_worlds_are_opened_from_the_command_line(film: Path) -> None:
    from deodar.cli._options import world

    opened: Any = world(f"video:{film}")
    assert isinstance(opened, Video) and isinstance(world("camera:2"), Camera)


@pytest.mark.parametrize("ending", ["png", "tif"])
def test_a_picture_of_sixteen_bits_keeps_its_shades(tmp_path: Path, ending: str) -> None:
    ramp = np.linspace(0, 65535, 81).astype(np.uint16)[None, :].repeat(60, axis=0)
    Image.fromarray(ramp).save(tmp_path / f"ramp.{ending}")
    pixels = Picture(tmp_path / f"ramp.{ending}").pixels
    assert pixels.shape == (60, 81, 3)
    assert np.allclose(pixels[30, [0, 20, 40, 80], 0], [0, 0.25, 0.5, 1], atol=1e-4)


@pytest.mark.parametrize(
    ("orientation", "size", "white"), [(1, (80, 60), 0), (3, (80, 60), 79), (6, (60, 80), 0)]
)
def test_a_picture_is_turned_as_its_file_states(
    tmp_path: Path, orientation: int, size: tuple[int, int], white: int
) -> None:
    half = np.zeros((60, 80, 3), np.uint8)
    half[:, :40] = 255
    image = Image.fromarray(half)
    exif = image.getexif()
    exif[0x0112] = orientation
    image.save(tmp_path / "phone.jpg", exif=exif)
    picture = Picture(tmp_path / "phone.jpg")
    assert picture.size == size
    along = np.mean(picture.pixels[:, :, 0], axis=0 if size == (80, 60) else 1).tolist()
    assert along[white] > 0.9 and along[len(along) - 1 - white] < 0.1


def test_a_picture_with_numbers_beyond_its_range_is_refused(tmp_path: Path) -> None:
    Image.fromarray(np.full((4, 4), 70_000, np.int32)).save(tmp_path / "deep.tif")
    with pytest.raises(WorldError, match=r"0 to 255 .* or 0 to 1"):
        Picture(tmp_path / "deep.tif")


@pytest.mark.parametrize(("dtype", "factor"), [("int32", 1), ("float32", 1), ("float32", 1 / 255)])
def test_a_grey_picture_of_another_form_has_its_own_white(tmp_path: Path, dtype: str, factor: float) -> None:
    grey = np.linspace(0, 255, 12).reshape(3, 4)
    Image.fromarray((grey * factor).astype(dtype)).save(tmp_path / "grey.tiff")
    assert np.allclose(dd.Picture(tmp_path / "grey.tiff").pixels[:, :, 1], grey / 255, atol=1 / 255)


def test_a_picture_that_is_too_long_for_its_axes_is_refused(tmp_path: Path) -> None:
    Image.fromarray(np.zeros((2, 30_000, 3), np.uint8)).save(tmp_path / "line.png")
    axes = tuple(dd.Axis(n, 0, 9, samples=k) for n, k in (("x", 10), ("y", 10), ("c", 3)))
    with pytest.raises(WorldError, match=r"30000 x 2 pixels needs 3000\d x 3000\d over these axes"):
        Picture(tmp_path / "line.png").sense("picture", axes, 0.0)
