"""The picture of a vehicle's camera, compared with geometry in plain NumPy."""

from __future__ import annotations

import colorsys
import dataclasses as dc
import math
from typing import Any

import jax
import numpy as np
import pytest

import deodar as dd
from deodar.errors import WorldError
from deodar.worlds._settings import arguments
from deodar.worlds.arena import arena as arena_file
from deodar.worlds.arena.arena import Arena
from deodar.worlds.arena.color_camera import AT_ONCE, BACKGROUND, picture
from deodar.worlds.arena.epuck import EPUCK
from deodar.worlds.arena.khepera import KHEPERA
from deodar.worlds.arena.vehicle import Vehicle, VehicleCamera
from deodar.worlds.arena.view import FLOOR, OUTSIDE

CAMERA = EPUCK.camera
assert CAMERA is not None
COLUMNS, ROWS, CHANNEL = dd.Axis("column", 0, 79, 80), dd.Axis("row", 0, 59, 60), dd.Axis("channel", 0, 2, 3)
AXES = (COLUMNS, ROWS, CHANNEL)
RED, GREEN, BLUE = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)


def room(*objects: dict[str, Any], wall: float = 0.5, **options: Any) -> Arena:
    """Return an arena of 4 m x 4 m that has begun, with the vehicle in its middle facing along x."""
    layout: dict[str, Any] = {"arena": {"x": [-2, 2], "y": [-2, 2], "height": wall}, "blocks": list(objects)}
    world = Arena(layout, **{"start": (0.0, 0.0, 0.0)} | arguments(Arena, options))
    world.reset(0)
    return world


def block(name: str, x: float, y: float, size: Any, height: float, color: Any) -> dict[str, Any]:
    return {"name": name, "center": [x, y], "size": size, "height": height, "color": list(color)}


def shot(world: Arena, axes: Any = AXES) -> np.ndarray:
    return world.sense("camera" if len(axes) == 3 else "line", axes, 0.0)[0]


def outline(
    world: Arena,
    pose: Any,
    name: str,
    camera: VehicleCamera | None = CAMERA,
    size: tuple[int, int] = (80, 60),
) -> tuple[float, float, float, float]:
    """Project the eight corners of an object: least and largest column and row, in pixels."""
    block_shown = next(t for t in world.layout.objects if t.name == name)
    x0, y0, x1, y1 = block_shown.box
    assert camera is not None and block_shown.height is not None
    c, s = math.cos(pose[2]), math.sin(pose[2])
    corners = []
    for x in (x0, x1):
        for y in (y0, y1):
            for z in (0.0, block_shown.height):
                dx, dy = x - pose[0], y - pose[1]
                depth, leftwards = c * dx + s * dy - camera.forward, c * dy - s * dx
                corners.append(
                    (leftwards / depth / math.tan(camera.horizontal / 2), (z - camera.height) / depth)
                )
    across, up = np.asarray(corners).T
    columns = (1 - across) * size[0] / 2
    rows = (1 - up / math.tan(camera.vertical / 2)) * size[1] / 2
    return columns.min(), columns.max(), rows.min(), rows.max()


def extent(picture: np.ndarray, color: Any) -> tuple[int, int, int, int]:
    """Return first and last column and row of the pixels of a colour, the last ones plus 1."""
    columns, rows = np.nonzero((np.abs(picture - color) < 1e-6).all(axis=-1))
    return columns.min(), columns.max() + 1, rows.min(), rows.max() + 1


@pytest.mark.parametrize(
    "pose", [(0.0, 0.0, 0.0), (-1.0, 0.3, -0.2), (0.2, -0.9, 1.0), (1.2, 1.1, -2.5), (-0.6, 0.9, -0.7)]
)
def test_a_block_has_its_projected_size_and_place(pose: tuple[float, float, float]) -> None:
    x, y = pose[0] + 0.5 * math.cos(pose[2] + 0.1), pose[1] + 0.5 * math.sin(pose[2] + 0.1)
    world = room(block("red", x, y, [0.06, 0.04], 0.05, RED), start=pose)
    wanted = outline(world, pose, "red")
    assert 0 < wanted[0] < wanted[1] < 80 and 0 < wanted[2] < wanted[3] < 60, "the block is in view"
    np.testing.assert_allclose(extent(shot(world), RED), wanted, atol=1.0)


OTHER = dc.replace(
    EPUCK, name="other", camera=VehicleCamera(math.radians(90), math.radians(50), height=0.12, forward=0.03)
)
"""A vehicle with another field of view and height of its camera."""


@pytest.mark.parametrize("vehicle", [EPUCK, KHEPERA, OTHER], ids=lambda vehicle: vehicle.name)
@pytest.mark.parametrize("size", [(80, 60), (160, 120)])
@pytest.mark.parametrize("pose", [(0.0, 0.0, 0.0), (-1.0, 0.3, -0.2), (0.2, -0.9, 1.0)])
def test_every_vehicle_sees_a_block_within_a_pixel(
    vehicle: Vehicle, size: tuple[int, int], pose: tuple[float, float, float]
) -> None:
    x, y = pose[0] + 0.4 * math.cos(pose[2] + 0.1), pose[1] + 0.4 * math.sin(pose[2] + 0.1)
    world = room(block("red", x, y, [0.06, 0.04], 0.05, RED), start=pose, vehicle=vehicle)
    columns, rows = (dd.Axis(n, 0, k - 1, k) for n, k in zip(("column", "row"), size, strict=True))
    wanted = outline(world, pose, "red", vehicle.camera, size)
    assert 0 < wanted[0] < wanted[1] < size[0] and 0 < wanted[2] < wanted[3] < size[1], "it is in view"
    np.testing.assert_allclose(extent(shot(world, (columns, rows, CHANNEL)), RED), wanted, atol=1.0)


def test_a_block_grows_as_it_comes_near() -> None:
    for distance in (0.15, 0.3, 0.6, 1.2):
        world = room(block("red", distance, 0.0, [0.05, 0.05], 0.04, RED))
        np.testing.assert_allclose(extent(shot(world), RED), outline(world, (0, 0, 0), "red"), atol=1.0)


def test_columns_run_from_the_left_and_rows_from_the_top() -> None:
    picture = shot(room(block("red", 0.5, 0.15, [0.05, 0.05], 0.04, RED), wall=0.1))
    assert extent(picture, RED)[1] < 40
    np.testing.assert_allclose(picture[79, [0, -1]], [BACKGROUND, FLOOR], atol=1e-6)
    assert (np.abs(picture[79] - OUTSIDE) < 1e-6).all(axis=-1).any(), "the wall is between both"


def test_the_walls_of_the_border_end_where_their_height_says() -> None:
    assert CAMERA is not None
    picture = shot(room(wall=0.4))
    depth = 2 - CAMERA.forward
    edges = np.asarray([0.4 - CAMERA.height, -CAMERA.height]) / depth / math.tan(CAMERA.vertical / 2)
    np.testing.assert_allclose(extent(picture, OUTSIDE)[2:], (1 - edges) * 30, atol=1.0)


def meets(world: Arena, pose: Any, slope: tuple[float, float]) -> np.ndarray:
    """Return the colour at the first of many points along a ray that is inside an object or below the floor.

    Points on a line are compared with the objects; no formula is shared with the camera.
    """
    assert CAMERA is not None
    c, s = math.cos(pose[2]), math.sin(pose[2])
    depth = np.arange(1, 30_000) * 1e-4
    x = pose[0] + c * CAMERA.forward + depth * (c - slope[0] * s)
    y = pose[1] + s * CAMERA.forward + depth * (s + slope[0] * c)
    z = CAMERA.height + depth * slope[1]
    left, low, right, high = world.layout.border
    hit = np.full(len(depth), -1)
    hit[(z <= 0)] = -2
    for k, block_shown in enumerate(world.layout.objects):
        x0, y0, x1, y1 = block_shown.box
        top = world.layout.height if block_shown.height is None else block_shown.height
        hit[(x >= x0) & (x <= x1) & (y >= y0) & (y <= y1) & (z >= 0) & (z <= top)] = k
    outside = (x <= left) | (x >= right) | (y <= low) | (y >= high)
    hit[outside & (z >= 0) & (z <= world.layout.height)] = -3
    first = hit[np.argmax(hit != -1)] if (hit != -1).any() else -1
    colours = {-1: BACKGROUND, -2: FLOOR, -3: OUTSIDE}
    return np.asarray(colours.get(first) or world.layout.objects[first].color)


def agrees(world: Arena, pose: Any) -> float:
    """Return the share of pixels whose colour is that of a ray through the pixel or right beside it."""
    assert CAMERA is not None
    axes = (dd.Axis("column", 0, 31, 32), dd.Axis("row", 0, 23, 24), CHANNEL)
    picture = shot(world, axes)
    right = []
    for i in range(32):
        for j in range(24):
            across = math.tan(CAMERA.horizontal / 2) * (1 - (2 * i + 1) / 32)
            up = math.tan(CAMERA.vertical / 2) * (1 - (2 * j + 1) / 24)
            around = [meets(world, pose, (across + d, up + e)) for d, e in ((0, 0), (3e-3, 0), (0, 3e-3))]
            right.append(min(np.abs(picture[i, j] - n).max() for n in around) < 1e-6)
    return float(np.mean(right))


def test_low_blocks_before_high_ones_hide_their_lower_parts_only() -> None:
    near, far = (
        block("near", 0.4, 0.0, [0.05, 0.1], 0.03, RED),
        block("far", 0.8, 0.0, [0.1, 0.1], 0.3, GREEN),
    )
    picture = shot(room(near, far))
    column = picture[40]
    reds, greens = ((np.abs(column - c) < 1e-6).all(axis=-1) for c in (RED, GREEN))
    assert reds.any() and greens.any() and np.flatnonzero(greens).max() + 1 == np.flatnonzero(reds).min()
    hidden = shot(room(near | {"height": 0.3}, far))
    assert not (np.abs(hidden[40] - GREEN) < 1e-6).all(axis=-1).any()


def test_the_top_of_a_block_below_the_camera_is_seen() -> None:
    assert CAMERA is not None
    flat = block("flat", 0.3, 0.0, [0.2, 0.1], 0.005, RED)
    _, _, top, bottom = extent(shot(room(flat)), RED)
    up = np.asarray(
        [(0.005 - CAMERA.height) / (0.4 - CAMERA.forward), -CAMERA.height / (0.2 - CAMERA.forward)]
    )
    rows = (1 - up / math.tan(CAMERA.vertical / 2)) * 30
    np.testing.assert_allclose([top, bottom], np.minimum(rows, 60), atol=1.0)


@pytest.mark.parametrize("seed", range(3))
def test_every_pixel_shows_the_first_surface_on_its_ray(seed: int) -> None:
    random = np.random.default_rng(seed)
    things = [
        block(
            f"b{k}",
            *random.uniform([0.15, -0.4], [1.5, 0.4]),
            random.uniform(0.03, 0.3, 2).tolist(),
            random.choice([0.01, 0.02, 0.05, 0.15]),
            random.uniform(0, 1, 3),
        )
        for k in range(12)
    ]  # they overlap, too
    pose = (0.0, 0.0, random.uniform(-0.3, 0.3))
    assert agrees(room(*things, wall=0.2, start=pose), pose) > 0.995


def test_a_block_without_a_height_is_as_tall_as_the_walls() -> None:
    bare = {"name": "bare", "center": [0.5, 0.0], "size": [0.05, 0.05], "color": list(RED)}
    stated = shot(room(bare | {"height": 0.08}, wall=0.5))
    np.testing.assert_array_equal(shot(room(bare, wall=0.08))[38:42, 20:40], stated[38:42, 20:40])
    np.testing.assert_allclose(shot(room(bare, wall=0.5))[40, 0], RED, atol=1e-6)


def test_the_line_is_the_row_of_the_picture_at_the_height_of_the_camera() -> None:
    things = block("low", 0.3, 0.0, [0.05, 0.05], 0.02, RED), block("high", 0.8, 0.1, [0.1, 0.1], 0.1, GREEN)
    world = room(*things)
    middle = shot(world, (COLUMNS, dd.Axis("row", 0, 60, 61), CHANNEL))[:, 30]
    line = shot(world, (COLUMNS, CHANNEL))
    np.testing.assert_array_equal(line, middle)
    assert (line == np.asarray(GREEN, line.dtype)).all(axis=-1).any()
    assert not (line == np.asarray(RED, line.dtype)).all(axis=-1).any(), "the camera looks over the low block"


def test_objects_are_seen_while_they_are_present() -> None:
    world = room()
    before = shot(world)
    world.place("shown", (0.5, 0.0), (0.05, 0.05), RED, windows=(64.0, 128.0), height=0.06)
    seen = []
    for _ in range(3):
        seen.append((np.abs(shot(world) - RED) < 1e-6).all(axis=-1).any())
        world.act({}, 0.0)
    assert seen == [False, True, False]
    np.testing.assert_array_equal(shot(world), before)


def test_many_boxes_are_compared_in_several_loops() -> None:
    count = 2 * AT_ONCE
    posts = [
        block(f"p{k}", 1.0, 0.01 * (k - count / 2), [0.004, 0.004], 0.1, (k / count, 0, 1))
        for k in range(count)
    ]
    few = [p for p in posts if abs(p["center"][1]) < 0.1]
    axes = (dd.Axis("column", 0, 799, 800), CHANNEL)
    assert CAMERA is not None
    narrow = np.abs(math.tan(CAMERA.horizontal / 2) * (1 - (2 * np.arange(800) + 1) / 800)) < 0.08
    np.testing.assert_array_equal(shot(room(*posts), axes)[narrow], shot(room(*few), axes)[narrow])


@pytest.mark.parametrize("precision", ["float32", "float64"])
def test_both_precisions_give_the_same_picture(precision: str) -> None:
    world = room(
        block("red", 0.5, 0.03, [0.06, 0.04], 0.05, RED), block("low", 0.3, 0, [0.3, 0.3], 0.01, BLUE)
    )
    single = shot(world)
    world.reset(0, precision=precision)
    assert world.sense("camera", AXES, 0.0).dtype == precision
    assert (np.abs(shot(world) - single) < 1e-6).all(axis=-1).mean() > 0.999


def test_a_camera_around_which_a_box_is_placed_sees_the_box() -> None:
    world = room()
    world.place("over", (0.0, 0.0), (0.2, 0.2), RED, height=0.2)
    np.testing.assert_allclose(shot(world), np.broadcast_to(RED, (80, 60, 3)), atol=1e-6)


@pytest.mark.parametrize(
    ("sensor", "axes"), [("camera", (COLUMNS, ROWS)), ("line", AXES), ("line", (COLUMNS,))]
)
def test_other_axes_are_refused(sensor: str, axes: Any) -> None:
    with pytest.raises(WorldError, match="channels"):
        room().sense(sensor, axes, 0.0)


@pytest.mark.parametrize("height", [0, -1, math.nan, "tall"])
def test_invalid_heights_are_refused(height: Any) -> None:
    with pytest.raises(WorldError, match=r"height.*expected a finite number above 0"):
        room(block("red", 0.5, 0.0, [0.1, 0.1], 0.1, RED) | {"height": height})
    with pytest.raises(WorldError, match="height"):
        room().place("red", (0.5, 0.0), (0.1, 0.1), height=height)


def test_heights_are_part_of_the_description() -> None:
    world = Arena(
        {"unit": "cm", "arena": {"x": [0, 100], "y": [0, 100], "height": 20}, "start": [20, 20]}, unit="cm"
    )
    world.place("red", (50, 50), (5, 5), RED, height=7)
    world.place("bare", (50, 20), (5, 5), GREEN)
    reopened = Arena.again(world.describe())
    assert reopened.describe()["sha256"] == world.describe()["sha256"]
    np.testing.assert_allclose(reopened.objects.heights([0])[0], world.objects.heights([0])[0])
    assert sorted(set(reopened.objects.heights([0])[0].round(6))) == [0.07, 0.2]


# ------------------------------------------------------------------------------- a camera with its own period


def turning(sensors: tuple[str, ...] = ("camera", "line")) -> dd.Model:
    """Return a model that turns its robot on the spot, and sees."""
    model = dd.Model("turning", dt=16)
    small = dd.Axis("column", 0, 15, 16), dd.Axis("row", 0, 11, 12), CHANNEL
    for name in sensors:
        model.add(dd.Sensor(name, small if name == "camera" else (small[0], CHANNEL), name))
    model.add(dd.Sensor("heading", sensor="heading"))
    for side, speed in (("left", -150.0), ("right", 150.0)):
        model.add(dd.Boost(f"turn {side}", amplitude=speed)) >> model.add(dd.Motor(side, motor=side))
    return model


SLOW: dict[str, Any] = dict(
    start=(0.3, 0.3, 0.2),
    physics=dd.ArenaPhysics(camera_every=3),
    noise=dd.ArenaNoise(slip=0.2, hue_noise=5.0, clutter=0.2),
)
PORTS = ["camera.output", "line.output", "heading.output"]


def test_a_picture_is_held_for_several_periods() -> None:
    record = dd.simulate(turning(), 64 * 12, record=PORTS, every=16, world=Arena("blocks", **SLOW))
    pictures, headings = record["camera.output"].values, record["heading.output"].values
    changed = 1 + np.flatnonzero(np.ptp(np.diff(headings)[:, None], axis=1) + (np.abs(np.diff(headings)) > 0))
    assert set(changed % 4) == {0}, "the robot turns in each period of 4 steps"
    seen = 1 + np.flatnonzero(np.abs(np.diff(pictures, axis=0)).max(axis=(1, 2, 3)) > 0)
    assert set(seen) <= {12, 24, 36, 48} and len(seen) >= 3


def test_pictures_inside_the_step_equal_those_of_a_session() -> None:
    """In double precision: in single precision a pixel at an edge may show either side."""
    model, options = turning(), dict(record=PORTS, every=16, precision="float64", seed=3)
    outside = dd.simulate(model, 64 * 14, world=beside(Arena("blocks", **SLOW)), **options)
    batch = dd.simulate(model, 64 * 14, world=Arena("blocks", **SLOW), trials=[0, 4], **options)
    for port in PORTS:
        np.testing.assert_allclose(batch[port].values[0], outside[port].values, atol=1e-10)
    assert np.abs(batch["camera.output"].values[0] - batch["camera.output"].values[1]).max() > 0.1


def beside(world: Arena) -> Arena:
    world.inside = False
    return world


def test_a_snapshot_between_two_pictures_is_restored() -> None:
    session = dd.Session(turning(), world=Arena("blocks", **SLOW))
    session.step(4 * 4 + 2)
    snapshot, seen = session.snapshot(), []
    for _ in range(2):
        session.restore(snapshot)
        frames = []
        for _ in range(12):
            frames.append(np.array(session.read("camera")))
            session.step(4)
        seen.append(np.asarray(frames))
    np.testing.assert_array_equal(*seen)
    assert np.ptp(seen[0], axis=0).max() > 0.1


def test_no_picture_is_computed_between_two_frames(monkeypatch: pytest.MonkeyPatch) -> None:
    """A callback inside the compiled step counts the pictures that are computed."""
    counted: list[int] = []

    def counting(numbers: Any, *others: Any) -> Any:
        jax.debug.callback(lambda _: counted.append(1), numbers[0, 0])
        return picture(numbers, *others)

    monkeypatch.setattr(arena_file, "picture", counting)
    model, world = turning(("camera",)), Arena("blocks", physics=dd.ArenaPhysics(period=48.0, camera_every=5))
    for trials in ([0], [0, 1]):
        taken = []
        for periods in (10, 10, 25):  # the first run compiles
            counted.clear()
            dd.simulate(model, 48 * periods, record="camera.output", every=48, world=world, trials=trials)
            jax.effects_barrier()
            taken.append(len(counted))
        assert taken[1:] == [len(trials) * (1 + 2), len(trials) * (1 + 5)], "one at the start"


@pytest.mark.parametrize("every", [0, 1.5, True])
def test_invalid_periods_of_the_camera_are_refused(every: Any) -> None:
    with pytest.raises(
        WorldError, match=r"camera_every (is 0, below its lower bound 1|needs a whole number)"
    ):
        Arena("blocks", physics=dd.ArenaPhysics(camera_every=every))
    assert Arena.open("blocks, camera_every=4").physics.camera_every == 4
    assert Arena.open("blocks, camera_every=4").sensors["camera"].period == 256.0
    assert str(Arena.open("blocks, camera_every=4").sensors["line"]).endswith("; a new value every 256 ms")
    assert (
        Arena.again(Arena("blocks", physics=dd.ArenaPhysics(camera_every=4)).describe()).physics.camera_every
        == 4
    )


# ------------------------------------------------------------------------------------------------------ noise


def wall(trials: Any = (0,), **settings: float) -> Arena:
    """Return an arena whose camera sees, in the upper half of its picture, a block with a hue of 120
    degrees.
    """
    layout = {
        "arena": {"x": [-2, 2], "y": [-2, 2]},
        "blocks": [block("wall", 0.5, 0, [0.5, 3], 2.0, (0.2, 0.7, 0.2))],
    }
    world = Arena(layout, start=(0.0, 0.0, 0.0), **arguments(Arena, settings))
    world.reset(5, trials)
    return world


def hues(picture: np.ndarray) -> np.ndarray:
    """Return hue in degrees from -180 to 180, saturation and value of each pixel."""
    flat = np.asarray([colorsys.rgb_to_hsv(*p) for p in picture.reshape(-1, 3).tolist()])
    flat[:, 0] = (flat[:, 0] * 360 + 180) % 360 - 180
    return flat.reshape(picture.shape)


def pictures(world: Arena, count: int, axes: Any = AXES) -> np.ndarray:
    """Return pictures (copies, count, columns, rows, 3) in following periods."""
    seen = []
    for k in range(count):
        if k:
            world.act({}, 0.0)
        seen.append(world.sense("camera" if len(axes) == 3 else "line", axes, 0.0))
    return np.stack(seen, 1)


def test_pixel_noise_has_its_standard_deviation_in_each_channel() -> None:
    noise = pictures(wall([0, 1], pixel_noise=0.04), 3)[..., :30, :] - np.asarray((0.2, 0.7, 0.2), np.float32)
    np.testing.assert_allclose(noise.std(axis=(0, 1, 2, 3)), 0.04, rtol=0.02)
    assert np.abs(noise.mean(axis=(0, 1, 2, 3))).max() < 0.001
    between = np.corrcoef(noise.reshape(-1, 3).T) - np.eye(3)
    frames = np.corrcoef(noise.reshape(6, -1)) - np.eye(6)
    pixels = np.corrcoef(noise[..., 1:, :].ravel(), noise[..., :-1, :].ravel())[0, 1]
    assert max(np.abs(between).max(), np.abs(frames).max(), abs(pixels)) < 0.03
    line = pictures(wall(pixel_noise=0.04), 1, (COLUMNS, CHANNEL))[0, 0] - np.asarray((0.2, 0.7, 0.2))
    alike = np.corrcoef(line[:30].ravel(), noise[0, 0, 0].ravel())[0, 1]
    assert abs(alike) < 0.3, "the line has noise of its own"


def test_pixels_stay_between_0_and_1() -> None:
    noisy = pictures(wall(pixel_noise=1.0), 1)
    assert noisy.min() == 0 and noisy.max() == 1 and np.isfinite(noisy).all()


def test_hue_noise_changes_the_hue_alone() -> None:
    noisy = hues(pictures(wall(hue_noise=6.0), 2)[..., :30, :])
    np.testing.assert_allclose(noisy[..., 0].std(), 6.0, rtol=0.02)
    np.testing.assert_allclose(noisy[..., 0].mean(), 120.0, atol=0.2)
    np.testing.assert_allclose(noisy[..., 1], 5 / 7, atol=1e-5)
    np.testing.assert_allclose(noisy[..., 2], 0.7, atol=1e-6)
    assert abs(np.corrcoef(noisy[0, 0, :, :, 0].ravel(), noisy[0, 1, :, :, 0].ravel())[0, 1]) < 0.03


@pytest.mark.parametrize("share", [0.05, 0.3, 1.0])
def test_a_share_of_the_pixels_are_outliers_with_any_hue(share: float) -> None:
    noisy = hues(pictures(wall(range(4), hue_noise=6.0, outliers=share), 1)[..., :30, :]).reshape(-1, 3)
    outliers = noisy[:, 1] > 0.99
    np.testing.assert_allclose(
        outliers.mean(), share, atol=4 * math.sqrt(share * (1 - share) / len(outliers)) + 1e-9
    )
    counts = np.histogram(noisy[outliers, 0], bins=12, range=(-180, 180))[0]
    np.testing.assert_allclose(counts / outliers.sum(), 1 / 12, atol=4 * math.sqrt(1 / 12 / outliers.sum()))
    np.testing.assert_allclose(noisy[outliers, 2], 1.0, atol=1e-6)
    if share < 1:
        np.testing.assert_allclose(noisy[~outliers, 0].std(), 6.0, rtol=0.03)


def test_strips_of_clutter_cover_a_share_of_the_background() -> None:
    world = room(block("red", 0.5, 0.0, [0.1, 0.05], 0.2, (0.5, 0.1, 0.1)), clutter=0.25)
    fine = dd.Axis("column", 0, 159, 160), dd.Axis("row", 0, 119, 120), CHANNEL
    clean = shot(room(block("red", 0.5, 0.0, [0.1, 0.05], 0.2, (0.5, 0.1, 0.1))), fine)
    world.reset(5, range(12))
    seen = pictures(world, 2, fine)
    np.testing.assert_array_equal(seen[:, 0], seen[:, 1])
    covered = (np.abs(seen[:, 0] - clean) > 1e-3).any(axis=-1)
    red = (np.abs(clean - (0.5, 0.1, 0.1)) < 1e-6).all(axis=-1)
    assert red.any() and not covered[:, red].any()
    free = ~red.any(axis=1)
    np.testing.assert_allclose(covered[:, free].sum(axis=2), 30, atol=1)
    colors = hues(np.where(covered[..., None], seen[:, 0], 0.0))
    strips = [
        colors[k, 8 * n : 8 * n + 8][covered[k, 8 * n : 8 * n + 8]] for k in range(12) for n in range(20)
    ]
    assert all(np.ptp(s[:, 0]) < 1e-3 for s in strips if len(s))
    chosen = np.asarray([s[0, 0] for s in strips if len(s)])
    assert len(np.unique(chosen.round(3))) > 0.95 * len(chosen), "trials and strips differ"
    below = np.asarray([np.flatnonzero(covered[k, 8 * n])[0] for k in range(12) for n in range(6)])
    assert len(np.unique(below)) > 20


def test_the_line_shows_the_clutter_of_its_row() -> None:
    world = room(clutter=0.4)
    axes = (dd.Axis("column", 0, 159, 160), dd.Axis("row", 0, 60, 61), CHANNEL)
    np.testing.assert_array_equal(shot(world, axes[::2]), shot(world, axes)[:, 30])


@pytest.mark.parametrize("precision", ["float32", "float64"])
def test_noise_of_a_trial_is_that_in_a_batch(precision: Any) -> None:
    options = dict(pixel_noise=0.05, hue_noise=5.0, outliers=0.1, clutter=0.2)
    many, alone = wall([0, 3], **options), wall([3], **options)
    many.reset(5, [0, 3], precision)
    single = alone.sense("camera", AXES, 0.0)[0]
    np.testing.assert_allclose(many.sense("camera", AXES, 0.0)[1], single, atol=2e-4)
    assert np.abs(many.sense("camera", AXES, 0.0)[0] - single).max() > 0.1


def test_noise_of_a_held_picture_is_held() -> None:
    frames = pictures(wall(pixel_noise=0.1, camera_every=2), 4)[0]
    np.testing.assert_array_equal(frames[0], frames[1])
    assert np.abs(frames[1] - frames[2]).max() > 0.1


def test_noises_of_the_camera_are_settings() -> None:
    arena = Arena.open("blocks, pixel_noise=0.1, hue_noise=6, outliers=0.05, clutter=0.25")
    assert Arena.again(arena.describe()).noise == arena.noise
    assert "outliers" not in Arena("blocks").describe()["settings"]
    with pytest.raises(WorldError, match=r"outliers is 1\.5, above its upper bound 1"):
        Arena("blocks", noise=dd.ArenaNoise(outliers=1.5))
