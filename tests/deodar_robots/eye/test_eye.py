"""The eye: the servo motors, the optics, the screen, and what the screen shows when."""

from __future__ import annotations

import numpy as np
import pytest

import deodar as dd
from deodar.errors import WorldError
from deodar.worlds._settings import arguments
from deodar_robots.eye.event_camera import EventCamera
from deodar_robots.eye.pan_tilt import CENTRE, PanTilt

PLANE = dd.Eye.example_axes("events")
PAIR = dd.Eye.example_axes("pose")
QUIET = EventCamera(leak=0.0, shot=0.0)


def sense(world: dd.Eye, sensor: str) -> np.ndarray:
    axes = PLANE if sensor in ("events", "on", "off") else () if sensor == "shown" else PAIR
    return world.sense(sensor, axes, 0.0)[0]


def turned(world: dd.Eye, pan: float, tilt: float, periods: int) -> None:
    for k in range(periods):
        world.act({"pan": np.array([pan]), "tilt": np.array([tilt])}, 10.0 * k)


def begun(**settings) -> dd.Eye:
    world = dd.Eye(**arguments(dd.Eye, {"endless": False, "first": (63.5, 63.5), **settings}))
    world.reset(1)
    return world


def test_the_servo_motors_approach_the_command_with_their_lag() -> None:
    world = begun(lag=25.0)
    turned(world, 1100, 900, 5)
    left = np.exp(-50 / 25)
    assert sense(world, "pose") == pytest.approx([1100 - 100 * left, 900 + 100 * left], abs=0.01)


def test_commands_are_limited() -> None:
    world = begun()
    turned(world, 9000, -9000, 100)
    assert sense(world, "pose") == pytest.approx([2000, 0], abs=0.01)


def test_a_motor_without_a_signal_stays() -> None:
    world = begun(pose=(900, 1200))
    world.act({}, 0.0)
    turned(world, 0.0, 1300, 60)
    assert sense(world, "pose") == pytest.approx([900, 1300], abs=0.01)


@pytest.mark.parametrize("curvature", [0.0, 0.12, 0.3])
def test_the_optics_are_inverted(curvature: float) -> None:
    optics = PanTilt(0.18, curvature, 0.06)
    places = np.random.default_rng(1).uniform(0, 127, (200, 2))
    back = optics.to_retina(optics.to_direction(places))
    assert np.abs(np.asarray(back) - places).max() < 0.05


def test_a_gaze_to_the_direction_of_the_target_centres_it() -> None:
    world = begun(first=(30, 100))
    assert sense(world, "target") == pytest.approx([30, 100], abs=0.02)
    (name,) = [mark for mark in world.scene().marks if mark.name == "target"]
    turned(world, *name.center, 60)
    assert sense(world, "target") == pytest.approx([CENTRE, CENTRE], abs=0.05)


def test_a_gaze_of_a_tenth_moves_the_picture_by_gain_and_roll() -> None:
    world = begun(gain=0.2, curvature=0.0, roll=0.1)
    turned(world, 1050, 1000, 100)
    moved = sense(world, "target") - CENTRE
    assert moved == pytest.approx([-10 * np.cos(0.1), -10 * np.sin(0.1)], abs=0.01)


def test_the_target_blinks_and_only_its_place_sends_events() -> None:
    world = begun(camera=QUIET, first=(41.5, 81.5), blink=40.0)
    rates = []
    for _ in range(16):
        turned(world, 1000, 1000, 1)
        rates.append(sense(world, "events"))
    total = np.array([r.sum() for r in rates])
    assert np.count_nonzero(total) == 4, "a change every 40 ms"
    here = rates[int(np.argmax(total))]
    assert np.unravel_index(here.argmax(), here.shape) == (10, 20)
    # pi 4^2 pixels, 4 or 5 events for 1 / (0.2 +- 3 %), in 10 ms
    assert total.max() * 16 * 0.01 == pytest.approx(np.pi * 16 * 4.7, rel=0.15)


def test_on_and_off_events_add_up() -> None:
    world = begun()
    turned(world, 1000, 1000, 4)
    on, off = sense(world, "on"), sense(world, "off")
    assert on.sum() > 5 * off.sum() > 0
    assert on + off == pytest.approx(sense(world, "events"), rel=1e-5)


def test_distractors_send_events_when_the_camera_moves() -> None:
    world = begun(camera=QUIET, distractors=3, blink=1e9)
    turned(world, 1000, 1000, 5)
    assert sense(world, "events").sum() == 0
    turned(world, 1100, 1000, 1)
    assert sense(world, "events").sum() > 0


def test_a_rival_blinks_with_the_target_and_has_a_contrast_of_its_own() -> None:
    world = begun(camera=QUIET, first=(41.5, 81.5), rival=(101.5, 25.5, 0.5))
    counts = []
    for _ in range(16):
        turned(world, 1000, 1000, 1)
        seen = sense(world, "events")
        counts.append((seen[8:13, 18:23].sum(), seen[23:28, 4:9].sum(), seen.sum()))
    target, rival, all_of_them = np.array(counts).T
    assert target + rival == pytest.approx(all_of_them)
    assert np.count_nonzero(rival) == 4 and np.array_equal(rival > 0, target > 0)
    # a change by c is c / 0.2 - 1 events on average, whatever the pixels remember
    assert rival.sum() / target.sum() == pytest.approx(1.5 / 4, rel=0.15)
    marks = {mark.name: mark.center for mark in world.scene().marks}
    turned(world, *marks["rival"], 60)
    assert {mark.name: mark.center for mark in world.scene().marks} == marks


def test_each_trial_has_its_own_rival() -> None:
    rivals = [(101.5, 25.5, 0.5), (21.5, 61.5, 0.0)]
    world = dd.Eye(QUIET, screen=dd.EyeScreen(endless=False), first=(41.5, 81.5), rival=rivals)
    world.reset(0, [1, 0])
    for _ in range(4):
        world.act({}, 0.0)
    one, other = world.sense("events", PLANE, 0.0)
    assert one[23:28, 4:9].sum() == 0 and other[23:28, 4:9].sum() > 0
    assert np.unravel_index(one.argmax(), one.shape) == (10, 20)


def test_the_target_moves_at_its_speed_and_stays_on_the_screen() -> None:
    world = begun(speed=200.0, reach=100.0)
    places = []
    for _ in range(300):
        turned(world, 1000, 1000, 1)
        places.append(world.scene().marks[0].center)
    steps = np.linalg.norm(np.diff(places, axis=0), axis=1)
    assert np.median(steps) == pytest.approx(2.0, rel=0.01)
    assert np.abs(np.asarray(places) - 1000).max() < 103


def test_another_target_is_shown_after_a_gaze_and_after_a_time() -> None:
    world = begun(endless=True, first=(20, 20))
    turned(world, 1000, 1000, 350)
    assert sense(world, "shown") == 1
    turned(world, 1000, 1000, 60)
    assert sense(world, "shown") == 2, "after 4 s"
    turned(world, 1150, 1050, 10)
    assert sense(world, "shown") == 2
    turned(world, 1150, 1050, 55)
    assert sense(world, "shown") == 3, "the camera has moved and rested for 400 ms"


def test_a_target_out_of_sight_is_shown_again_and_one_in_the_centre_is_done() -> None:
    world = begun(endless=True, first=(5, 5))
    turned(world, 1500, 1500, 20)
    assert sense(world, "shown") == 1
    turned(world, 1500, 1500, 25)
    assert sense(world, "shown") == 2
    centred = begun(endless=True)
    turned(centred, 1000, 1000, 49)
    assert sense(centred, "shown") == 1
    turned(centred, 1000, 1000, 2)
    assert sense(centred, "shown") == 2


def test_targets_are_uniform_over_the_retina_and_on_the_screen() -> None:
    world = dd.Eye(screen=dd.EyeScreen(endless=False))
    world.reset(1, range(400))
    places = world.sense("target", PAIR, 0.0)
    assert 6 <= places.min() < 9 and 118 < places.max() <= 121.1
    assert np.abs(places.mean(axis=0) - CENTRE).max() < 6
    near = dd.Eye(screen=dd.EyeScreen(endless=False), pose=(1550, 1000))
    near.reset(1, range(100))
    directions = np.asarray(near.parts()[2]["objects"])[:, 0]
    assert directions.max() <= 1600.01


def test_the_first_target_waits() -> None:
    world = begun(wait=200.0)
    turned(world, 1000, 1000, 19)
    assert sense(world, "shown") == 0 and world.scene().marks == ()
    turned(world, 1000, 1000, 1)
    assert sense(world, "shown") == 1


def test_each_trial_has_its_own_target_and_pose() -> None:
    world = dd.Eye(
        screen=dd.EyeScreen(endless=False), first=[(20, 30), (90, 40)], pose=[(900, 950), (1000, 1100)]
    )
    world.reset(0, [1, 0])
    assert world.sense("target", PAIR, 0.0) == pytest.approx(np.array([[90, 40], [20, 30]]), abs=0.02)
    assert world.sense("pose", PAIR, 0.0).tolist() == [[1000, 1100], [900, 950]]
    with pytest.raises(WorldError, match="there are 2 of them, and trial 2 is run"):
        world.reset(0, [2])


def test_the_target_can_be_moved_by_hand() -> None:
    world = begun()
    world.move("target", (1100, 1000))
    turned(world, 1000, 1000, 1)
    assert world.scene().marks[0].center == pytest.approx((1100, 1000))
    turned(world, 1000, 1000, 1)
    assert world.scene().marks[0].center == pytest.approx((1100, 1000))
    with pytest.raises(WorldError):
        world.move("distractor 1", (1100, 1000))


@pytest.mark.parametrize(
    "wrong",
    [
        {"gain": 0},
        {"gain": float("nan")},
        {"period": -1},
        {"distractors": 1.5},
        {"distractors": True},
        {"first": (200, 10)},
        {"first": "here"},
        {"pose": (0, 2001)},
        {"blink": 0},
        {"rival": (200, 10, 1)},
        {"rival": (20, 10)},
        {"rival": (20, 10, float("nan"))},
        {"roll": float("inf")},
    ],
)
def test_wrong_settings_are_refused(wrong) -> None:
    with pytest.raises(WorldError, match=next(iter(wrong)) if "pose" not in wrong else "2000"):
        dd.Eye(**arguments(dd.Eye, wrong))


def test_a_reading_needs_two_axes_on_the_retina() -> None:
    line, far = dd.Axis("column", 0, 127, 32), dd.Axis("row", 500, 600, 8)
    problems = list(dd.Eye().validate_axes("events", (line,)))
    assert "two axes" in problems[0].what
    assert "outside of the retina" in next(iter(dd.Eye().validate_axes("events", (line, far)))).what


def test_it_opens_with_settings_and_opens_again_as_it_was_described() -> None:
    world = dd.Eye.open("distractors=2, gain=0.2, speed=50")
    assert (world.screen.distractors, world.pan_tilt.gain, world.screen.speed) == (2, 0.2, 50)
    assert dd.Eye.open("").screen.distractors == 0
    for made in (world, dd.Eye(rival=(20, 30, 0.8))):
        again = dd.Eye.again(made.describe())
        assert again.describe() == made.describe() and again.structure() == made.structure()
    again = dd.Eye.again({k: v for k, v in world.describe().items() if k != "rival"})
    assert again.describe() == world.describe() and again.structure() == world.structure()
    with pytest.raises(WorldError, match="no setting 'gian'"):
        dd.Eye.open("gian=3")
    with pytest.raises(WorldError, match="expected a number"):
        dd.Eye.open("gain=much")


def test_the_picture_of_the_scene_shows_events_that_fade() -> None:
    world = begun(camera=QUIET, first=(41.5, 81.5), blink=40.0)

    def drawn() -> np.ndarray:
        picture = world.scene().picture
        assert (picture.name, picture.columns, picture.rows) == ("events", 128, 128)
        pixels = np.frombuffer(picture.pixels, np.uint8).reshape(128, 128, 3).astype(int)
        return (pixels - [22, 24, 28])[::-1].transpose(1, 0, 2)  # columns first, row 0 at the bottom

    assert not drawn().any(), "nothing was seen yet"
    turned(world, 1000, 1000, 4)  # 40 ms: the target was lit once
    lit = drawn()
    where = np.argwhere(lit.any(axis=-1))
    assert where.mean(axis=0) == pytest.approx([41.5, 81.5], abs=0.5)
    red, _, blue = lit[41, 81]
    assert red > 100 > blue, "brighter: orange"
    turned(world, 1000, 1000, 4)  # it went dark
    red, _, blue = drawn()[41, 81]
    assert red < 0 or blue > red, "darker: blue"
    world.reset(0)
    assert not drawn().any()
