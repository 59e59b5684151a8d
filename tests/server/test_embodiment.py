"""The world that the studio uses if none was chosen."""

from __future__ import annotations

import deodar as dd
from deodar.architectures.saliency import saliency
from deodar.elements.motor import Motor
from deodar.elements.sensor import Sensor
from deodar.server.embodiment import Embodiment
from deodar.worlds.arena.arena import Arena
from deodar.worlds.picture import Picture


def driving() -> dd.Model:
    model = dd.Model("driving", dt=64)
    model.add(Sensor("eyes", [dd.Axis("sensor", 0, 7, 8)], "infrared"))
    model.add(Motor("left", [], "left"))
    return model


def test_an_example_with_all_sensors_and_motors_is_the_default() -> None:
    found = Embodiment()
    assert isinstance(found.world(saliency().document), Picture) and found.label == "Picture: an example"
    assert isinstance(found.world(driving().document), Arena) and found.label == "Arena: an example"
    assert found.world(dd.Model("blind").document) is None


def test_a_chosen_world_is_kept_where_it_fits() -> None:
    arena = Arena("z")
    found = Embodiment(arena)
    assert found.world(driving().document) is arena and found.label == "Arena: z"
    assert isinstance(found.world(saliency().document), Picture)


def test_a_robot_drives_in_the_studio_s_session() -> None:
    session = dd.Session(driving(), world=Embodiment().world(driving().document))
    session.step(3)
    assert session.read("eyes").shape == (8,)
