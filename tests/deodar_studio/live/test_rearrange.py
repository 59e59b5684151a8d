"""Moved, added and removed objects in the world of a session."""

from __future__ import annotations

import numpy as np
import pytest

import deodar as dd
from deodar.elements.stimuli import Boost
from deodar.elements.world_ports import Motor, Sensor
from deodar.errors import UnknownName, WorldError
from deodar.worlds.arena.arena import Arena
from deodar_studio.live.track import FINE, MOST, Track

OPEN = {
    "arena": {"x": [0, 3], "y": [0, 2]},
    "boxes": [{"name": "crate", "center": [0.5, 1.5], "size": [0.2, 0.2]}],
    "start": [0.2, 1.0],
    "goal": [2.5, 0.5],
}


def driving(turn: float = 0.0) -> dd.Model:
    """Return a model that drives straight on, or on a circle."""
    model = dd.Model("driving", dt=64)
    model.add(Sensor("pose", [dd.Axis("of", 0, 2, 3)], "pose"))
    for name, speed in (("left", 800 - turn), ("right", 800 + turn)):
        model.add(Boost(f"go {name}", [], speed)) >> model.add(Motor(name, [], name))
    return model


def test_the_journal_records_objects_that_move_appear_and_disappear() -> None:
    session = dd.Session(driving(), world=Arena(OPEN))
    session.move("crate", (0.6, 1.5))
    session.move("crate", (0.7, 1.5))
    session.step(2)
    session.place("block", (1.0, 1.5), (0.1, 0.1))
    session.place("red block", (1.4, 1.5), (0.1, 0.1), (1.0, 0.0, 0.0))
    session.move("goal", (2.5, 0.6))
    scene = session.scene()
    assert scene is not None
    assert [b.name for b in scene.boxes] == ["crate", "block", "red block"] and np.allclose(
        [b.center for b in scene.boxes], [(0.7, 1.5), (1.0, 1.5), (1.4, 1.5)]
    )
    assert scene.boxes[2].color == (1.0, 0.0, 0.0)
    assert scene.marks[0].center == pytest.approx((2.5, 0.6))
    session.remove("block")
    assert [(c.tick, c.method, c.arguments) for c in session.journal] == [
        (0, "move", ("crate", (0.7, 1.5))),
        (2, "place", ("block", (1.0, 1.5), (0.1, 0.1))),
        (2, "place", ("red block", (1.4, 1.5), (0.1, 0.1), (1.0, 0.0, 0.0))),
        (2, "move", ("goal", (2.5, 0.6))),
        (2, "remove", ("block",)),
    ]


def test_the_journal_repeats_the_run() -> None:
    """An obstacle that has stopped the robot is removed."""
    first = dd.Session(driving(), world=Arena(OPEN))
    first.move("crate", (0.8, 1.0))
    first.step(100)
    stopped = first.read("pose")[0]
    first.move("crate", (0.8, 1.5))
    first.step(30)
    assert stopped == pytest.approx(0.7 - 0.037, abs=1e-3) and first.read("pose")[0] > 0.8
    session = dd.Session(driving(), world=Arena(OPEN))
    for change in first.journal:
        session.step(change.tick - session.tick)
        change.repeat(session)
    session.step(first.tick - session.tick)
    assert np.array_equal(session.read("pose"), first.read("pose"))


def test_a_refused_change_has_no_effect_and_is_not_recorded() -> None:
    session = dd.Session(driving(), world=Arena(OPEN))
    before = session.scene()
    for wrong, message in [
        (lambda: session.move("crate", (0.2, 1.0)), "crate: .* cover 'e-puck'"),
        (lambda: session.move("goal", (0.5, 1.5)), "goal: .* inside 'crate'"),
        (lambda: session.place("goal", (1.0, 1.0), (0.1, 0.1)), "goal: is the name of a mark"),
        (lambda: session.place("flat", (1.0, 1.0), (0.1, 0.0)), "flat.*has no area"),
        (lambda: session.remove("goal"), "goal: is a mark"),
    ]:
        with pytest.raises(WorldError, match=message):
            wrong()
    with pytest.raises(UnknownName, match="crate"):
        session.remove("crat")
    assert session.scene() == before and session.journal == []


def test_a_world_without_a_scene_has_no_objects_to_move() -> None:
    model = dd.Model("blind")
    model.add(dd.Field("u", []))
    session = dd.Session(model)
    assert session.scene() is None
    with pytest.raises(WorldError, match=r"no world with a view from above.*world=dd.Arena"):
        session.move("crate", (1, 1))


def test_a_track_follows_the_bodies_and_is_cleared_by_a_reset() -> None:
    session, track = dd.Session(driving(), world=Arena(OPEN)), Track()
    for _ in range(30):
        track.follow(session)
        session.step()
    places, way = np.asarray(track.trail.places), track.trail
    assert track.scene is not None and np.allclose(places[0], (0.2, 1.0))
    assert (np.hypot(*np.diff(places, axis=0).T) >= FINE * 3).all() and len(places) > 10
    track.follow(session)
    track.follow(session)
    assert track.trail is way and len(way.places) - len(places) <= 1, (
        "a scene without motion is not recorded again"
    )
    session.reset()
    track.follow(session)
    assert track.trail is not way and np.allclose(track.trail.places, [(0.2, 1.0)])
    session.world = Arena({**OPEN, "start": [1.5, 1.0]})
    track.follow(session)
    assert np.allclose(track.trail.places, [(1.5, 1.0)])
    track.follow(None)
    assert track.scene is None and track.trail.places == []


def test_a_long_track_drops_every_second_point() -> None:
    session, track = dd.Session(driving(100), world=Arena(OPEN)), Track()
    track.follow(session)
    track.trail.fine, whole = 1e-9, track.trail
    track.trail.places.extend([(0.2 + 1e-6 * k, 1.0) for k in range(1, MOST)])
    session.step(2)
    track.follow(session)
    assert track.trail is not whole and len(track.trail.places) == MOST // 2 + 1 and track.trail.fine == 2e-9
