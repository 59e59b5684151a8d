"""The world that the studio uses if none was chosen."""

from __future__ import annotations

import base64
from pathlib import Path

import numpy as np
import pytest

import deodar as dd
from deodar import registry
from deodar.architectures.saliency import saliency
from deodar.elements.world_ports import Motor, Sensor
from deodar.errors import WorldError
from deodar.numerics.axes import Axes
from deodar.worlds._base import Signal, World
from deodar.worlds.arena.arena import Arena
from deodar.worlds.picture import Picture
from deodar_studio.world.embodiment import Embodiment, preview, problems, warnings

EXAMPLES = Path(__file__).parents[2] / "examples"


def driving() -> dd.Model:
    model = dd.Model("driving", dt=64)
    model.add(Sensor("eyes", [dd.Axis("sensor", 0, 7, 8)], "infrared"))
    model.add(Motor("left", [], "left"))
    return model


def test_an_example_with_all_sensors_and_motors_is_the_default() -> None:
    embodiment = Embodiment()
    picture, arena = embodiment.world(saliency().document), embodiment.world(driving().document)
    assert isinstance(picture, Picture) and embodiment.label(picture) == "Picture: an example"
    assert isinstance(arena, Arena) and embodiment.label(arena) == "Arena: an example"
    assert embodiment.world(dd.Model("blind").document) is None and embodiment.label(None) == ""


def test_an_example_that_the_axes_of_a_planner_cover_is_preferred() -> None:
    planner = dd.load(EXAMPLES / "spa.json").document
    world = Embodiment().world(planner)
    assert isinstance(world, Arena)
    assert world.source == "z"
    assert not problems(planner, world) and not warnings(planner, world)
    assert len(warnings(planner, Arena.example())) == 3


def test_a_search_for_colours_gets_a_khepera_that_sees_no_block_at_its_start() -> None:
    search = dd.architectures.color_search(1)
    world = Embodiment().world(search.document)
    assert isinstance(world, Arena)
    assert (world.source, world.vehicle.name, world.unit) == ("search", "khepera", "mm")
    assert not problems(search.document, world) and not warnings(search.document, world)
    world.reset(0)
    axes = (dd.Axis("column", 0, 79, 80), dd.Axis("row", 0, 59, 60), dd.Axis("channel", 0, 2, 3))
    picture = Arena("search", unit="mm", vehicle="khepera")
    picture.reset(0)
    saturation = np.ptp(picture.sense("camera", axes, 0.0), axis=-1)
    assert saturation.max() < 0.1
    picture.place("shown", (122, 0), (50, 50), (0.85, 0.1, 0.1))
    assert np.ptp(picture.sense("camera", axes, 0.0), axis=-1).max() > 0.6


def test_a_world_in_use_is_kept_where_it_fits() -> None:
    embodiment, present = Embodiment(Arena("z")), Arena("blocks")
    assert embodiment.world(driving().document, present) is present


def test_a_chosen_world_is_kept_where_it_fits() -> None:
    arena = Arena("z")
    embodiment = Embodiment(arena)
    assert embodiment.world(driving().document) is arena and embodiment.label(arena) == "Arena: z"
    assert isinstance(embodiment.world(saliency().document), Picture)


def test_problems_name_each_signal_that_a_world_lacks() -> None:
    eyes, left = driving().document.entries
    listed = problems(driving().document, Picture(np.zeros((4, 4, 3))))
    assert [(p.where, p.what) for p in listed] == [
        (eyes.path, "the world Picture lacks the sensor 'infrared'"),
        (left.path, "the world Picture lacks the motor 'left'"),
    ]
    (none,) = problems(driving().document, None)
    assert none.what == "no world was chosen that has the sensor 'infrared'"
    wide = dd.Model("wide")
    wide.add(Sensor("eyes", [dd.Axis("sensor", 0, 8, 9)], "infrared"))
    (shape,) = problems(wide.document, Arena("blocks"))
    assert "8 samples" in shape.what and not problems(driving().document, Arena("blocks"))


def test_a_world_that_lacks_a_sensor_offers_its_others_first() -> None:
    model = dd.Model("m")
    model.add(Sensor("eye", [dd.Axis("x", 0, 3, 4), dd.Axis("y", 0, 3, 4)], "picture"))
    first, *others = Embodiment(Arena("blocks")).offered(model.document).worlds
    assert "infrared" in {signal.name for signal in first.signals}
    assert any("picture" in {signal.name for signal in world.signals} for world in others)


def test_a_robot_drives_in_the_studio_s_session() -> None:
    session = dd.Session(driving(), world=Embodiment().world(driving().document))
    session.step(3)
    assert session.read("eyes").shape == (8,)


def test_a_world_may_have_a_preview_of_its_own() -> None:
    class Striped(Picture):
        def preview(self) -> np.ndarray:
            return np.tile(np.array([[[0.0], [1.0], [0.5]]]), (2, 1, 3))

    shown = preview(Striped(np.zeros((4, 4, 3))), None)
    assert (shown.width, shown.height) == (3, 2)
    assert list(base64.b64decode(shown.pixels)) == [0, 0, 0, 255, 255, 255, 127, 127, 127] * 2
    assert preview(Picture.example(), None).width == 160


def test_the_page_shows_no_login_of_a_camera() -> None:
    embodiment, address = Embodiment(), "rtsp://user:s3cr3t@127.0.0.1:1/live?token=s3cr3t"
    camera = embodiment.open("Camera", address, address, {})
    with pytest.raises(WorldError, match=r"has no 'infrared', 'left'") as caught:
        embodiment.choose(camera, "Camera", address, driving().document)
    assert "s3cr3t" not in str(caught.value)
    with pytest.raises(WorldError) as caught:
        embodiment.open("Camera", address, address, {"period": -1})
    assert "s3cr3t" not in str(caught.value)
    embodiment.choose(camera, "Camera", address, dd.Model("blind").document)
    assert embodiment.label(camera) == "Camera: rtsp://***@127.0.0.1:1/live?token=***"


class Lamp(World):
    sensors = {"light": Signal("brightness", ()), "free": Signal("any shape")}
    motors = {"power": Signal("electrical power", ())}


class Broken(Lamp):
    @staticmethod
    def example_axes(sensor: str) -> Axes:
        raise RuntimeError(sensor)


class Empty(Lamp):
    sensors = {"light": Signal("no samples", (0,))}


@pytest.mark.parametrize(
    ("cls", "names"), [(Lamp, ["light", "power"]), (Broken, ["light", "power"]), (Empty, ["power"])]
)
def test_a_world_without_axes_of_an_example_offers_what_has_a_shape(
    cls: type[Lamp], names: list[str]
) -> None:
    (world,) = Embodiment(cls()).offered(dd.Model("new").document).worlds
    assert [signal.name for signal in world.signals] == names


def test_an_edit_that_leaves_the_signals_alone_asks_no_world_again(monkeypatch: pytest.MonkeyPatch) -> None:
    calls: list[str] = []
    axes, kinds = Arena.example_axes, registry.kinds

    def example_axes(sensor: str) -> Axes:
        calls.append(sensor)
        return axes(sensor)

    def of_room(room: str | None = None) -> dict[str, type]:
        calls.append(f"room {room}")
        return kinds(room)

    monkeypatch.setattr(Arena, "example_axes", staticmethod(example_axes))
    monkeypatch.setattr(registry, "kinds", of_room)
    embodiment, model = Embodiment(), dd.Model("new")
    model.add(dd.Field("u", [dd.Axis("x", 0, 10, 11)]))
    first = embodiment.offered(model.document)
    assert calls.count("room worlds") == 1 and calls.count("infrared") == 1
    calls.clear()

    model.set("u.tau", 30)
    assert embodiment.offered(model.document) is first and calls == []

    model.add(Motor("left", [], "left"))  # another offer, of the same examples
    arena = next(w for w in embodiment.offered(model.document).worlds if w.world == "Arena")
    assert "left" not in [s.name for s in arena.signals if s.kind == "Motor"]
    assert set(calls) == {"room worlds"}
    assert calls.count("room worlds") == 1
