"""An arena with a vehicle: driving, sensors, changes during a run, and errors."""

from __future__ import annotations

import itertools
from typing import Any

import jax.numpy as jnp
import numpy as np
import pytest

import deodar as dd
from deodar.couplings.weights import Weights
from deodar.elements.stimuli import Boost
from deodar.elements.world_ports import Motor, Sensor
from deodar.errors import UnknownName, WorldError
from deodar.worlds._settings import arguments
from deodar.worlds.arena.arena import Arena
from deodar.worlds.arena.arena_layout import load
from deodar.worlds.arena.starts_and_goals import FINE, Room

EMPTY: dict[str, Any] = {"arena": {"x": [0, 3], "y": [0, 3]}}
COMPILED: dict[Any, Any] = {}
POSE, EIGHT, PAIR = dd.Axis("of", 0, 2, 3), dd.Axis("sensor", 0, 7, 8), dd.Axis("of", 0, 1, 2)


def drive(world: Arena, periods: int, left: float = 400.0, right: float = 400.0) -> np.ndarray:
    """Return poses (copies, periods + 1, 3) with constant wheel speeds."""
    copies = len(world.sense("pose", (POSE,), 0.0))
    seen = [world.sense("pose", (POSE,), 0.0)]
    for k in range(periods):
        world.act({"left": np.full(copies, left), "right": np.full(copies, right)}, 64.0 * k)
        seen.append(world.sense("pose", (POSE,), 64.0 * (k + 1)))
    return np.stack(seen, 1)


def begun(*args: Any, trials: Any = (0,), seed: int = 0, precision: str = "float32", **options: Any) -> Arena:
    world = Arena(*args, **arguments(Arena, options))
    # worlds of one kind share their functions, which are compiled once for this module to save time
    world._compiled = COMPILED.setdefault((world.physics, world.unit), {})
    world.reset(seed, trials, precision)
    return world


def avoiding() -> dd.Model:
    """Return a model that avoids obstacles: the right sensors slow the left wheel, and the left sensors
    the right wheel; for obstacles in front it turns left.
    """
    model = dd.Model("avoiding", dt=64)
    eyes = model.add(Sensor("eyes", [EIGHT], "infrared"))
    model.add(Sensor("pose", [POSE], "pose"))
    model.add(Sensor("touching", [], "touching"))
    for name, weights in (
        ("left", [-1.5, -1, -0.5, 0, 0, 0, 0, -1.5]),
        ("right", [0, 0, 0, 0, 0, -0.5, -1, 0]),
    ):
        wheel = model.add(Motor(name, [], name))
        eyes >> dd.Gain(0.5) >> Weights(np.asarray(weights), axes=()) >> wheel
        model.add(Boost(f"go {name}", [], 400.0)) >> wheel
    return model


def test_the_vehicle_drives_at_the_speed_of_the_robot_and_turns_on_the_spot() -> None:
    poses = drive(begun(EMPTY, start=(0.5, 1.5, 0.0), unit="m"), 50)
    speed = 400 / 1000 * 2 * np.pi * 0.0205
    np.testing.assert_allclose(poses[0, -1], [0.5 + 50 * 0.064 * speed, 1.5, 0], atol=1e-5)
    poses = drive(begun(EMPTY, start=(150, 150, 0.0), unit="cm"), 20, -100, 100)
    turned = 20 * 0.064 * 200 / 1000 * 2 * np.pi * 0.0205 / 0.052
    np.testing.assert_allclose(poses[0, -1], [150, 150, turned], atol=1e-4)


def test_encoders_count_wheel_steps_and_overflow_at_16_bits() -> None:
    world = begun(EMPTY, period=10_000.0, contact="stick")
    counted = []
    for _ in range(8):
        world.act({"left": np.array([500.0]), "right": np.array([-5000.0])}, 0.0)
        counted.append(world.sense("encoders", (PAIR,), 0.0)[0])
    true = np.stack([5000.0 * np.arange(1, 9), -10_000.0 * np.arange(1, 9)], 1)
    np.testing.assert_allclose(counted, (true + 2**15) % 2**16 - 2**15)


def test_the_vehicle_stays_in_the_maze_and_slides_or_sticks_at_walls() -> None:
    for contact, moving in (("slide", True), ("stick", False)):
        world = begun("z", start=(-0.8, 0.4, 0.4), contact=contact)
        poses = drive(world, 400, 900, 880)
        assert world.sense("touching", (), 0.0)[0] in (0, 1)
        left, low, right, high = load("z").border
        x, y = poses[0, :, 0], poses[0, :, 1]
        assert (
            x.min() > left + 0.0369
            and x.max() < right - 0.0369
            and y.min() > low + 0.0369
            and y.max() < high - 0.0369
        )
        boxes = np.asarray([t.box for t in load("z").objects])
        distance = np.hypot(
            np.maximum(np.maximum(boxes[:, 0] - x[:, None], x[:, None] - boxes[:, 2]), 0),
            np.maximum(np.maximum(boxes[:, 1] - y[:, None], y[:, None] - boxes[:, 3]), 0),
        )
        assert distance.min() > 0.0369
        walked = np.linalg.norm(np.diff(poses[0, :, :2], axis=0), axis=1)
        assert bool((walked[200:] > 1e-4).mean() > 0.5) == moving


def test_a_closed_loop_keeps_clear_of_walls() -> None:
    record = dd.simulate(
        avoiding(), 64 * 600, record=["pose.output", "eyes.output", "touching.output"], world=Arena("z")
    )
    pose = record["pose.output"].values
    assert np.linalg.norm(np.diff(pose[:, :2], axis=0), axis=1).sum() > 1.0, "it continues to drive"
    assert record["eyes.output"].values[300:].max() > 100, "it meets walls"
    assert record["touching.output"].values.mean() < 0.05


@pytest.mark.parametrize("precision", ["float32", "float64"])
def test_a_trial_alone_equals_the_trial_in_a_batch(precision: str) -> None:
    options: dict[str, Any] = dict(place_noise=0.01, slip=0.05, encoder_noise=0.1)
    many = begun("blocks", trials=[0, 3, 7, 3], seed=5, precision=precision, **options)
    alone = begun("blocks", trials=[3], seed=5, precision=precision, **options)
    a, b = drive(many, 40), drive(alone, 40)
    tolerance = 1e-5 if precision == "float32" else 1e-12
    np.testing.assert_allclose(a[1], b[0], atol=tolerance)
    np.testing.assert_allclose(a[3], b[0], atol=tolerance)
    assert np.abs(a[0] - a[1]).max() > 1e-3, "trials differ in their noise"
    for sensor, axes in (("infrared", (EIGHT,)), ("place", (PAIR,)), ("encoders", (PAIR,))):
        np.testing.assert_allclose(
            many.sense(sensor, axes, 0.0)[1], alone.sense(sensor, axes, 0.0)[0], rtol=1e-4
        )


def test_noise_has_the_stated_standard_deviation() -> None:
    world = begun(
        EMPTY, trials=range(400), unit="cm", start=(150, 150, 0), place_noise=2.0, slip=0.1, encoder_noise=0.2
    )
    places = []
    for _ in range(20):
        places.append(world.sense("place", (PAIR,), 0.0) - world.sense("pose", (POSE,), 0.0)[:, :2])
        world.act({}, 0.0)
    np.testing.assert_allclose(np.std(places), 2.0, rtol=0.03)
    assert (
        abs(np.mean(places)) < 0.05
        and abs(np.corrcoef(np.ravel(places[:-1]), np.ravel(places[1:]))[0, 1]) < 0.03
    )
    world.act({"left": np.full(400, 100.0), "right": np.full(400, 100.0)}, 0.0)
    rolled = world.sense("encoders", (PAIR,), 0.0)
    np.testing.assert_allclose(rolled.std(), 6.4 * np.hypot(0.1, 0.2), rtol=0.1)
    np.testing.assert_allclose(rolled.mean(), 6.4, rtol=0.02)


def test_place_every_holds_a_reading_for_several_periods() -> None:
    world = begun(EMPTY, place_noise=0.1, place_every=3)
    seen = []
    for _ in range(9):
        seen.append(world.sense("place", (PAIR,), 0.0)[0].tolist())
        world.act({"left": np.array([300.0])}, 0.0)
    assert all((a == b) == (k % 3 != 2) for k, (a, b) in enumerate(itertools.pairwise(seen)))


def test_infrared_noise_can_be_switched_off() -> None:
    layout = {**EMPTY, "start": [0.039, 1.5], "heading": np.pi}
    quiet = [begun(layout, infrared_noise=0.0, trials=[k]).sense("infrared", (EIGHT,), 0.0) for k in (0, 1)]
    np.testing.assert_array_equal(quiet[0], quiet[1])
    np.testing.assert_allclose(quiet[0][0, 0], quiet[0][0, 7], rtol=1e-3)
    loud = begun(layout).sense("infrared", (EIGHT,), 0.0)
    assert quiet[0].max() > 1000 and np.abs(loud - quiet[0]).max() > 10


def test_the_sensor_obstacles_gives_the_map_of_the_published_maze() -> None:
    """On cells of 1 cm; a cell counts as wall if an object covers a part of it, and so do all cells
    outside.
    """
    y, x = dd.Axis("y", 5, 104, 100, unit="cm"), dd.Axis("x", -104, -5, 100, unit="cm")
    world = begun("z", unit="cm")
    seen = world.sense("obstacles", (y, x), 0.0)[0]
    assert seen.shape == (100, 100) and seen.min() == 0 and seen.max() == 1
    assert (seen[-4:] > 0.99).all() and (seen[:, -4:] > 0.99).all()
    walls = [t for t in world.layout.objects if t.center[1] < 1 and t.center[0] < 0]
    inside = sum(t.size[0] * t.size[1] for t in walls if t.name in ("Maze_Wall4", "Maze_Wall5", "Maze_Wall2"))
    free = seen[10:90, 10:90]
    overlap = 0.0  # of the three walls, which touch at the corners of the Z
    boxes = [t.box for t in walls if t.name in ("Maze_Wall4", "Maze_Wall5", "Maze_Wall2")]
    for k, a in enumerate(boxes):
        for b in boxes[k + 1 :]:
            overlap += max(0.0, min(a[2], b[2]) - max(a[0], b[0])) * max(
                0.0, min(a[3], b[3]) - max(a[1], b[1])
            )
    np.testing.assert_allclose(free.sum() / 1e4, inside - overlap, rtol=0.03)
    turned = world.sense("obstacles", (x, y), 0.0)[0]
    np.testing.assert_array_equal(turned, seen.T)


def test_the_sensor_above_shows_blocks_in_their_colours() -> None:
    axes = *Arena.example_axes("obstacles"), dd.Axis("channel", 0, 2, 3)
    fine = dd.Axis("x", 0, 1.2, 121), dd.Axis("y", 0, 0.8, 81), axes[2]
    seen = begun("blocks").sense("above", fine, 0.0)[0]
    np.testing.assert_allclose(seen[25, 65], [0.85, 0.1, 0.1], atol=1e-5)
    np.testing.assert_allclose(seen[5, 40], [0.96, 0.96, 0.94], atol=1e-5)


# -------------------------------------------------------------------------------------- changes while it runs


def test_objects_are_placed_moved_and_removed_without_recompiling() -> None:
    world = begun(EMPTY, start=(1.5, 1.5, 0.0), goal=(2.5, 2.5))
    drive(world, 1)
    for sensor, axes in (
        ("obstacles", Arena.example_axes("obstacles")),
        ("infrared", (EIGHT,)),
        ("goal", (PAIR,)),
    ):
        world.sense(sensor, axes, 0.0)
    compiled = {key: function._cache_size() for key, function in world._compiled.items()}
    world.place("wall", (1.7, 1.5), (0.1, 1.0))
    assert drive(world, 60)[0, -1, 0] < 1.65 - 0.0369
    assert world.sense("infrared", (EIGHT,), 0.0)[0, 0] > 500
    world.move("wall", (2.0, 1.5))
    assert 1.85 < drive(world, 80)[0, -1, 0] < 1.95 - 0.0369
    world.remove("wall")
    assert drive(world, 60)[0, -1, 0] > 2.0
    world.aim((0.5, 0.5))
    np.testing.assert_allclose(world.sense("goal", (PAIR,), 0.0), [[0.5, 0.5]])
    world.sense("obstacles", Arena.example_axes("obstacles"), 0.0)
    assert {key: world._compiled[key]._cache_size() for key in compiled} == compiled


def test_an_object_with_windows_is_present_during_them_in_each_trial() -> None:
    world = Arena(EMPTY, start=(1.3, 1.5, 0.0))
    world.place(
        "gate", (1.5, 1.5), (0.1, 2.9), windows=[(0, 64 * 200), (64 * 100, 64 * 200), (64 * 200, 64 * 300)]
    )
    world.reset(0, [0, 1, 2])
    poses = drive(world, 150)
    assert poses[0, -1, 0] < 1.42 and poses[1, -1, 0] > 1.6 and poses[2, -1, 0] > 1.6
    poses = drive(world, 60)
    assert poses[0, -1, 0] > 1.42
    with pytest.raises(WorldError, match="windows of gate: there are 3 of them, and trial 3 is run"):
        world.reset(0, [3])


def test_an_object_placed_on_the_vehicle_displaces_it() -> None:
    world = begun(EMPTY, start=(1.5, 1.5, 0.0))
    world.place("crate", (1.52, 1.5), (0.1, 0.3))
    pose = drive(world, 1, 0, 0)[0, -1]
    np.testing.assert_allclose(pose, [1.47 - 0.037, 1.5, 0], atol=1e-4)


@pytest.mark.parametrize(
    ("change", "error", "says"),
    [
        (lambda w: w.place("p", (1, 1), (0, 1)), WorldError, "p: has the size .*no area"),
        (lambda w: w.place("p", (1, float("nan")), (1, 1)), WorldError, "p.center: .*two finite numbers"),
        (lambda w: w.place("p", 5, (1, 1)), WorldError, "p.center: is 5"),
        (lambda w: w.place("p", (1, 1), (1, 1), color=(1, 2, 3)), WorldError, "p.color"),
        (
            lambda w: w.place("p", (1, 1), (1, 1), windows=(5, 1)),
            WorldError,
            "windows of p: begins after it ends",
        ),
        (lambda w: w.place("p", (1, 1), (1, 1), windows="ever"), WorldError, "windows of p: is 'ever'"),
        (lambda w: w.move("crat", (1, 1)), UnknownName, "Did you mean 'crate'"),
        (lambda w: w.move("crate", (1, None)), WorldError, "crate.center"),
        (lambda w: w.remove("nothing"), UnknownName, "nothing in the arena is called 'nothing'"),
        (lambda w: w.aim((0.92, 0.22)), WorldError, r"goal: \(0.92, 0.22\) lies inside 'crate'"),
        (
            lambda w: w.aim((5, 0.22)),
            WorldError,
            r"goal: \(5, 0.22\) lies outside the arena, 0 to 1.2, 0 to 0.8 m",
        ),
        (lambda w: w.aim("there"), WorldError, "goal: is 'there'"),
        (
            lambda w: [w.place(f"p{k}", (0.1, 0.7), (0.01, 0.01)) for k in range(17)],
            WorldError,
            "p16: the arena is full",
        ),
    ],
)
def test_invalid_changes_of_an_arena_are_refused(change: Any, error: type[Exception], says: str) -> None:
    world = Arena("blocks")
    before = world.describe()
    with pytest.raises(error, match=says):
        change(world)
    if "full" not in says:
        assert world.describe() == before


# ------------------------------------------------------------------------------------ an arena for each trial


def drawn(*blocks: tuple[str, float, float, tuple[float, float, float]], **more: Any) -> dict[str, Any]:
    """Return a layout of blocks: name, x, y and colour."""
    listed = [{"name": n, "center": [x, y], "size": [0.2, 0.2], "color": list(c)} for n, x, y, c in blocks]
    return {**EMPTY, "start": [1.5, 1.5], "blocks": listed, **more}


RED, GREEN, BLUE = (0.9, 0.1, 0.1), (0.1, 0.9, 0.1), (0.1, 0.1, 0.9)
OWN = [
    drawn(("red", 1.9, 1.5, RED)),
    drawn(("green", 2.3, 1.5, GREEN), ("red", 0.5, 0.5, BLUE), start=[1.4, 1.5]),
    drawn(),
]
ABOVE = dd.Axis("x", 0, 3, 31, unit="m"), dd.Axis("y", 0, 3, 31, unit="m"), dd.Axis("channel", 0, 2, 3)


def test_each_trial_has_the_arena_of_its_own_layout() -> None:
    """It drives, senses and is seen as in an arena with that layout alone."""
    many = begun(OWN, trials=[0, 1, 2])
    poses = drive(many, 160, 900, 900)
    for k, layout in enumerate(OWN):
        alone = begun(layout, trials=[k])
        np.testing.assert_allclose(poses[k], drive(alone, 160, 900, 900)[0], atol=1e-6)
        for sensor, axes in (("infrared", (EIGHT,)), ("obstacles", ABOVE[:2]), ("above", ABOVE)):
            a, b = (w.sense(sensor, axes, 0.0) for w in (many, alone))
            np.testing.assert_allclose(a[k], b[0], rtol=1e-4, atol=1e-4)
    assert poses[0, -1, 0] < 1.8 - 0.0369 < poses[1, -1, 0] < 2.2 - 0.0369 < poses[2, -1, 0]


def test_the_step_of_a_batch_has_the_arena_of_each_trial() -> None:
    together = dd.simulate(avoiding(), 64 * 60, trials=3, world=Arena(OWN), record=["pose.output"])
    for k, layout in enumerate(OWN):
        alone = dd.simulate(avoiding(), 64 * 60, trials=[k], world=Arena(layout), record=["pose.output"])
        a, b = (d["pose.output"].values for d in (together.isel(trial=k), alone.isel(trial=0)))
        np.testing.assert_allclose(a, b, atol=1e-5)


def test_an_object_is_placed_and_moved_in_each_trial_to_its_own_place() -> None:
    world = begun(EMPTY, start=(1.5, 1.5, 0.0), trials=[0, 1])
    places, sizes = [(1.9, 1.5), (2.3, 1.5)], [(0.2, 0.2), (0.4, 0.2)]
    world.place("block", places, sizes, [RED, GREEN], windows=[(0, 64e3), (0, 32e3)])
    poses = drive(world, 160, 900, 900)
    assert poses[0, -1, 0] < 1.8 - 0.0369 < poses[1, -1, 0] < 2.1 - 0.0369
    seen = world.sense("above", ABOVE, 0.0)
    np.testing.assert_allclose(seen[0, 19, 15], RED, atol=1e-5)
    np.testing.assert_allclose(seen[1, 23, 15], GREEN, atol=1e-5)
    world.move("block", [(0.5, 0.5), (1.0, 0.5)])
    seen = world.sense("obstacles", ABOVE[:2], 0.0)
    np.testing.assert_allclose(seen[[0, 0, 1, 1], [5, 10, 5, 10], 5], [1, 0, 0, 1], atol=1e-5)
    world.move("block", (1.0, 1.0))
    np.testing.assert_allclose(world.sense("obstacles", ABOVE[:2], 0.0)[:, 10, 10], [1, 1], atol=1e-5)


def test_an_arena_for_each_trial_is_described_arranged_and_drawn() -> None:
    world = Arena(OWN)
    world.place("block", [(1.0, 2.0), (2.0, 2.0), (2.5, 2.0)], (0.1, 0.1), height=[0.1, 0.2, 0.3])
    reopened = Arena.again(world.describe())
    assert reopened.describe() == world.describe()
    for name, values in world.own([2, 1]).items():
        np.testing.assert_array_equal(reopened.own([2, 1])[name], values)
    before, arrangement = world.describe(), world.arrangement()
    world.move("red", (2.5, 2.5))
    world.remove("block")
    world.arrange(arrangement)
    assert world.describe() == before
    world.reset(0, [1])
    scene = world.scene()
    assert [b.name for b in scene.boxes] == ["red", "green", "block"]
    assert scene.boxes[0].center == (0.5, 0.5) and scene.boxes[2].center == (2.0, 2.0)


def test_heights_are_those_of_each_trial() -> None:
    low, high = ({**EMPTY, "arena": {**EMPTY["arena"], "height": h}} for h in (0.1, 0.4))
    world = Arena([low, high])
    world.place("stated", (1.0, 1.0), (0.1, 0.1), height=[0.2, 0.3])
    world.place("as the walls", (2.0, 2.0), (0.1, 0.1))
    heights = world.own([1, 0])["heights"]
    np.testing.assert_allclose(heights[:, [0, 1, -1]], [[0.3, 0.4, 0.4], [0.2, 0.1, 0.1]])


def test_starts_that_are_not_stated_are_free_places_of_each_arena() -> None:
    free = [{**EMPTY}, {**EMPTY, "blocks": [{"center": [1.5, 1.5], "size": [1, 1]}]}]
    world = Arena(free)
    assert world.starts[0, :2] == pytest.approx([1.5, 1.5], abs=0.01)
    assert np.abs(world.starts[1, :2] - 1.5).max() > 0.5


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: Arena([]), "the list of layouts is empty"),
        (
            lambda: Arena([EMPTY, "blocks"]),
            r"the arena of trial 1 has the border .*Give all layouts the same",
        ),
        (lambda: Arena([EMPTY, {**EMPTY, "goal": [1, 1]}]), "layout of trial 0 has no goal"),
        (lambda: Arena(OWN, start=(2.3, 1.5, 0)), r"start of trial 1: \(2.3, 1.5\) lies inside 'green'"),
        (lambda: Arena(OWN, goal=(1.9, 1.5)), r"goal of trial 0: \(1.9, 1.5\) lies inside 'red'"),
        (
            lambda: Arena([EMPTY, CLOSED], start=(0.5, 0.5, 0), goal=(2.5, 0.5)),
            r"goal of trial 1: \(2.5, 0.5\) is out of reach",
        ),
        (lambda: Arena(OWN).reset(0, [3]), "there are 3 of them, and trial 3 is run"),
        (
            lambda: Arena(EMPTY).place("p", [(1, 1), (2, 2)], [(1, 1)] * 3),
            "p.center: has 2 rows, and another value has 3",
        ),
        (lambda: Arena(EMPTY).place("p", [(1, 1), (2, 2)], [(1, 1), (0, 1)]), "p: has the size"),
        (lambda: Arena(OWN).move("green", [(1, 1), (2, 2)]), "green: got 2 places for 3 trials"),
    ],
)
def test_invalid_arenas_of_trials_are_refused(make: Any, says: str) -> None:
    with pytest.raises(WorldError, match=says):
        make()


# --------------------------------------------------------------------------------------------- what cannot be

CLOSED = {**EMPTY, "walls": [{"name": "all across", "center": [1.5, 1.5], "size": [0.05, 4]}]}
GAP = {
    **EMPTY,
    "walls": [{"center": [1.5, 0.7], "size": [0.05, 1.4]}, {"center": [1.5, 2.25], "size": [0.05, 1.6]}],
}


@pytest.mark.parametrize("shift", [(0, 0), (300, 200), (-300, -200)])
def test_an_arena_far_from_the_origin_has_the_same_free_places(shift: tuple[int, int]) -> None:
    """A vehicle without a start begins at the free position nearest the middle."""
    dx, dy = shift
    moved = {
        "arena": {"x": [dx, dx + 3], "y": [dy, dy + 1]},
        "walls": [{"center": [dx + 1.5, dy + 0.5], "size": [0.4, 0.6]}],
    }
    world = Arena(moved)
    world.reset(0)
    (body,) = world.scene().bodies
    assert np.subtract(body.center, shift) == pytest.approx([1.243, 0.5], abs=0.01)
    room = Room(world.layout, world.vehicle.radius, np.asarray([t.box for t in world.layout.objects]))
    assert room.cell == world.vehicle.radius / FINE
    assert room.joined((dx + 0.5, dy + 0.5), (dx + 2.5, dy + 0.5))


@pytest.mark.parametrize(
    ("options", "says"),
    [
        (
            dict(start=(0.6, 0.5, 0)),
            r"blocks: start: \(0.6, 0.5\) lies inside 'divide'; the vehicle needs 0.037 m around it",
        ),
        (dict(start=(0.02, 0.5, 0)), "lies outside the arena"),
        (dict(start=(0.25, 0.59, 0)), "lies inside 'red'; the vehicle needs"),
        (dict(goal=(0.6, 0.5)), "goal: .*lies inside 'divide'"),
        (dict(goal=(-1, 0.5)), "goal: .*lies outside the arena"),
        (dict(start=[(0.2, 0.3, 0), (9, 9, 0)]), r"start of trial 1: \(9, 9\) lies outside"),
        (dict(start=(0.2, 0.3)), "start: .*3 finite numbers"),
        (dict(start=(0.2, 0.3, float("nan"))), "start: .*3 finite numbers"),
        (dict(goal="there"), "goal: is 'there'"),
        (
            dict(layout=CLOSED, start=(0.5, 0.5, 0), goal=(2.5, 0.5)),
            r"goal: \(2.5, 0.5\) is out of reach from \(0.5, 0.5\)",
        ),
        (dict(layout=GAP, start=(0.5, 0.5, 0), goal=(2.5, 0.5)), "out of reach"),
        (
            dict(layout={"arena": {"x": [0, 0.05], "y": [0, 0.05]}}),
            "the e-puck fits nowhere: it is 0.074 m wide",
        ),
        (dict(unit="ft"), "unit is 'ft'; expected one of m, cm, mm"),
        (dict(contact="slied"), "Did you mean 'slide'"),
        (dict(period=0), "period is 0, below its lower bound 1e-06"),
        (dict(reflection=0), "reflection is 0"),
        (dict(place_noise=-1), "place_noise is -1, below its lower bound 0"),
        (dict(place_every=0), "place_every is 0"),
        (dict(slip=float("inf")), "slip needs a finite number, not inf"),
    ],
)
def test_invalid_arenas_are_refused(options: dict[str, Any], says: str) -> None:
    with pytest.raises(WorldError, match=says):
        Arena(**{"layout": "blocks", **arguments(Arena, options)})


def test_walls_may_overlap_and_lie_outside_and_goals_behind_them_are_reachable() -> None:
    over = [
        {"center": [1.5, 1.5], "size": [0.05, 2.0]},
        {"center": [1.5, 1.4], "size": [0.5, 0.05]},
        {"center": [9, 9], "size": [1, 1]},
    ]
    gap = [{"center": [1.5, 0.7], "size": [0.05, 1.4]}, {"center": [1.5, 2.25], "size": [0.05, 1.5]}]
    for walls in (over, gap):
        world = Arena({**EMPTY, "walls": walls}, start=(0.5, 0.5, 0), goal=(2.5, 0.5))
        assert len(world.scene().boxes) == len(walls)


def test_a_trial_without_a_start_is_named() -> None:
    world = Arena("blocks", start=[(0.2, 0.3, 0), (0.3, 0.3, 0)])
    with pytest.raises(WorldError, match="start: there are 2 of them, and trial 5 is run"):
        world.reset(0, [5])


def test_an_arena_is_created_again_from_its_description() -> None:
    world = Arena(
        "z",
        start=(-45, 55, 0.3),
        unit="cm",
        physics=dd.ArenaPhysics(reflection=0.8, contact="stick"),
        noise=dd.ArenaNoise(place_noise=0.5),
    )
    world.place("obstacle", (-65, 90), (10, 20), windows=(100, 300))
    world.remove("Maze_Wall3")
    reopened = Arena.again(world.describe())
    assert reopened.describe() == world.describe()
    a, b = (begun_as(w) for w in (world, reopened))
    np.testing.assert_array_equal(drive(a, 30), drive(b, 30))


def begun_as(world: Arena) -> Arena:
    world.reset(3, [2])
    return world


def test_a_motor_that_gets_a_value_that_is_not_finite_is_named() -> None:
    model = dd.Model("broken", dt=64)
    model.add(Boost("huge", [], 1e38)) >> dd.Gain(1e10) >> model.add(Motor("wheel", [], "left"))
    with pytest.raises(dd.errors.NotFinite, match="motor 'left' received"):
        dd.Session(model, world=Arena("blocks")).step(2)


class Broken(Arena):
    """An arena in which the position of the vehicle becomes NaN after some periods."""

    def advance(self, shared, own, state, motors):
        new = super().advance(shared, own, state, motors)
        return {**new, "position": jnp.where(new["tick"] > 7, jnp.nan, new["position"])}


def test_a_world_that_becomes_infinite_inside_the_step_is_named():
    model = dd.Model("watching", dt=64)
    model.add(Sensor("heading", sensor="heading"))
    with pytest.raises(
        dd.errors.NotFinite, match=r"^position of the world Broken became infinite or undefined in step 8 "
    ):
        dd.simulate(model, 64 * 30, world=Broken(), record="heading.output")


def test_an_object_far_outside_is_refused_because_its_lengths_have_another_unit() -> None:
    world = begun("blocks")
    for change in (
        lambda: world.place("crate", center=(60, 15), size=(8, 8)),
        lambda: world.move("red", (30, 40)),
    ):
        with pytest.raises(WorldError, match=r"m outside the arena, 0 to 1.2, 0 to 0.8 m. Give lengths in m"):
            change()
    world.place("parked", center=(-0.5, -0.5), size=(0.05, 0.05))


def test_a_model_for_another_vehicle_names_the_vehicle_that_fits() -> None:
    six = dd.Axis("sensor", 0, 5, samples=6)
    model = dd.Model("distances")
    model.add(dd.Sensor("distance", [six], sensor="infrared"))
    arena = dd.Arena(
        {"unit": "mm", "arena": {"x": [-300, 300], "y": [-300, 300]}}, start=(0, 0, 0), unit="mm"
    )
    with pytest.raises(WorldError) as caught:
        dd.Session(model, world=arena)
    [problem] = caught.value.problems
    assert problem.where == "distance" and "axes of 8 samples; the model gives it [6]" in problem.what
    assert problem.fix == "Choose another vehicle of the arena: vehicle=khepera"
    model.set("distance.axes", [dd.Axis("sensor", 0, 6, samples=7)])
    with pytest.raises(WorldError, match="Give the element such axes"):
        dd.Session(model, world=arena)
