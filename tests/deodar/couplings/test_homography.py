"""The map of a camera's picture onto a plane: against a pinhole camera, at borders, and what is refused."""

from __future__ import annotations

import numpy as np
import pytest

import deodar as dd
from deodar.couplings.pictures import Homography
from deodar.elements.stimuli import Pattern
from deodar.errors import DeodarError

COLUMN, ROW = dd.Axis("column", 0, 159, 160), dd.Axis("row", 0, 119, 120)
X, Y = dd.Axis("x", -0.39, 0.39, 40, unit="m"), dd.Axis("y", 0.01, 0.59, 30, unit="m")
CORNERS = np.array([[-0.4, 0.0], [0.4, 0.0], [0.4, 0.6], [-0.4, 0.6]])


def seen(points: np.ndarray) -> np.ndarray:
    """Return column and row of points of the table in an oblique pinhole camera."""
    position, target, focal = np.array([0.0, 1.0, 0.9]), np.array([0.0, 0.3, 0.0]), 130.0
    ahead = (target - position) / np.linalg.norm(target - position)
    right = np.cross(ahead, [0.0, 0.0, 1.0])
    right /= np.linalg.norm(right)
    down = np.cross(ahead, right)
    offset = np.concatenate([points, np.zeros((*points.shape[:-1], 1))], axis=-1) - position
    depth = offset @ ahead
    return np.stack(
        [79.5 + focal * (offset @ right) / depth, 59.5 + focal * (offset @ down) / depth], axis=-1
    )


def mapped(image: np.ndarray, axes=(COLUMN, ROW), onto=(X, Y), **parameters) -> np.ndarray:
    model = dd.Model("table")
    ports = {"picture": seen(CORNERS), "plane": CORNERS, **parameters}
    channels = [dd.Axis("channel", 0, 2, 3)] if image.ndim == 3 else []
    source = model.add(Pattern("camera", [*axes, *channels], image))
    model.connect(source, model.add(Homography(list(onto), **ports, name="map")))
    return dd.simulate(model, 1, dt=1.0, record="map.output")["map.output"].values[-1]


def test_each_sample_is_the_pixel_where_a_camera_sees_it():
    points = np.stack(np.meshgrid(X.points, Y.points, indexing="ij"), axis=-1)
    columns, rows = np.moveaxis(seen(points), -1, 0)
    assert columns.min() > 0 and columns.max() < 159 and rows.min() > 0 and rows.max() < 119
    picture = np.random.default_rng(0).random((160, 120, 3)).astype(np.float32)
    nearest = picture[np.rint(columns).astype(int), np.rint(rows).astype(int)]
    different = np.any(mapped(picture) != nearest, axis=-1)
    # in float32 a position between two pixels may round to either of them
    close = np.abs(columns % 1 - 0.5) < 1e-3, np.abs(rows % 1 - 0.5) < 1e-3
    assert not np.any(different & ~close[0] & ~close[1]) and different.mean() < 0.01
    ramp = np.broadcast_to(np.arange(160.0)[:, None] + 1000 * np.arange(120.0), (160, 120))
    expected = columns + 1000 * rows
    np.testing.assert_allclose(mapped(ramp, interpolation="linear"), expected, atol=2.0)


def test_the_units_of_the_axes_are_those_of_the_points():
    # the same picture over shares of its width and height
    column, row = dd.Axis("column", 0, 1, 160), dd.Axis("row", 0, 1, 120)
    picture = np.random.default_rng(1).random((160, 120)).astype(np.float32)
    shares = seen(CORNERS) / [159, 119]
    same = mapped(picture) == mapped(picture, axes=(column, row), picture=shares)
    assert same.mean() > 0.95, "but for positions between two pixels"


def test_outside_of_the_picture_and_behind_the_horizon_it_is_0():
    far = dd.Axis("y", -5.0, 5.0, 101)
    values = mapped(np.ones((160, 120)), onto=(X, far))
    points = np.stack(np.meshgrid(X.points, far.points, indexing="ij"), axis=-1)
    at = seen(points)
    # the camera is at y = 1, directed to smaller y; what lies behind it has no place in its picture
    inside = np.all((at > -0.5) & (at < [159.5, 119.5]), axis=-1) & (points[..., 1] < 1.5)
    np.testing.assert_array_equal(values, inside)
    assert 0 < inside.mean() < 0.5


@pytest.mark.parametrize("interpolation", ["nearest", "linear"])
def test_equal_planes_keep_the_picture(interpolation):
    x, y = dd.Axis("x", 0, 20, 21), dd.Axis("y", 0, 10, 11)
    picture = np.random.default_rng(2).random((21, 11)).astype(np.float32)
    corners = np.array([[0.0, 0.0], [20.0, 0.0], [20.0, 10.0], [0.0, 10.0]])
    same = mapped(picture, (x, y), (x, y), picture=corners, plane=corners, interpolation=interpolation)
    np.testing.assert_allclose(same, picture, atol=1e-4)


def test_points_on_a_line_are_refused_with_what_to_use():
    line = CORNERS.copy()
    line[2] = [0.0, 0.0]
    with pytest.raises(DeodarError, match=r"three of the points in plane lie on one line.*corners of a rec"):
        mapped(np.ones((160, 120)), plane=line)
    with pytest.raises(DeodarError, match=r"picture has shape \[3, 2\], four points need \[4, 2\]"):
        mapped(np.ones((160, 120)), picture=CORNERS[:3])
