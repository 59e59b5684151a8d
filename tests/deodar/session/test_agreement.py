"""Models and worlds whose units of length or angle differ."""

from __future__ import annotations

import math
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np
import pytest

import deodar as dd
from deodar.errors import RunWarning, WorldError
from deodar.session import agreement

LAYOUT: dict[str, Any] = {"arena": {"x": [0, 1.2], "y": [0, 0.8]}, "start": [0.2, 0.3], "goal": [0.9, 0.6]}
PAIR = dd.Axis("of", 0, 1, 2)
PLANE = (dd.Axis("x", 0, 120, 121, unit="cm"), dd.Axis("y", 0, 80, 81, unit="cm"))


def coding(gain: Any = 1.0, axes: Sequence[dd.Axis] = PLANE, *between: Any) -> dd.Model:
    """Return a model that encodes the place of the robot on axes, through couplings."""
    model = dd.Model("coding", dt=64)
    last = model.add(dd.Sensor("place", [PAIR], sensor="place"))
    for coupling in between:
        last = last >> coupling
    (
        last
        >> model.add(dd.SpaceCode(axes, 5.0, gain=gain, name="own place"))
        >> model.add(dd.Field("u", axes, tau=1000))
    )
    return model


def found(model: dd.Model, world: dd.World) -> list[str]:
    return [p.what for p in agreement.judge(model.document, world)]


@pytest.mark.parametrize(
    ("unit", "gain", "between"),
    [
        ("cm", 1.0, ()),
        ("m", 100.0, ()),
        ("mm", 0.1, ()),
        ("m", 1.0, (dd.Gain(100.0),)),
        ("m", -100.0, (dd.Gain(-1.0), dd.Gain(1.0))),
        ("m", 1.0, (dd.Weights(np.array([[0.0, 100.0], [100.0, 0.0]]), axes=[PAIR]),)),
    ],
)
def test_positions_in_the_unit_of_the_axes_are_accepted(
    unit: str, gain: float, between: Sequence[Any]
) -> None:
    assert found(coding(gain, PLANE, *between), dd.Arena(LAYOUT, unit=unit)) == []


@pytest.mark.parametrize(
    ("unit", "gain", "between", "wrong", "gains"),
    [
        ("m", 1.0, (), "100 times too small", "100)"),
        ("mm", 1.0, (), "10 times too large", "0.1)"),
        ("cm", 100.0, (), "100 times too large", "1)"),
        ("m", [1.0, -1.0], (), "100 times too small", "[100, -100])"),
        ("cm", 1.0, (dd.Gain(0.01),), "100 times too small", "100)"),
        ("m", 1.0, (dd.Weights(np.eye(2)[::-1], axes=[PAIR]),), "100 times too small", "100)"),
    ],
)
def test_positions_in_another_unit_are_refused_with_the_gain_to_type(
    unit: str, gain: Any, between: Sequence[Any], wrong: str, gains: str
) -> None:
    model = coding(gain, PLANE, *between)
    with pytest.raises(WorldError, match=wrong) as caught:
        dd.simulate(model, 64, world=dd.Arena(LAYOUT, unit=unit))
    (problem,) = caught.value.problems
    assert problem.where == "own place"
    assert problem.fix.startswith(f'Set its gain: model.set("own place.gain", {gains}')


def test_the_gain_and_the_unit_of_an_error_correct_it() -> None:
    model = coding()
    (problem,) = agreement.judge(model.document, dd.Arena("blocks"))
    assert 'world=dd.Arena("blocks", unit="cm")' in problem.fix
    assert '--world "arena:blocks, unit=cm"' in problem.fix_at("shell")
    assert found(model, dd.Arena("blocks", unit="cm")) == []
    model.set("own place.gain", 100)
    assert found(model, dd.Arena("blocks")) == []


def test_a_factor_between_no_two_units_is_a_coordinate_of_the_user_s_own() -> None:
    assert found(coding(37.0), dd.Arena(LAYOUT)) == []


def test_the_planner_is_refused_in_an_arena_of_another_unit() -> None:
    at: dict[str, Any] = {"start": (-0.45, 0.55, 0.0), "goal": (-0.65, 0.65)}
    planner = dd.architectures.spa(dd.Arena("z", unit="cm", start=(-45, 55, 0), goal=(-65, 65)))
    problems = agreement.judge(planner.document, dd.Arena("z", **at))
    assert [(p.where, p.severity) for p in problems] == [("goal place", "problem"), ("own place", "problem")]
    assert agreement.judge(dd.architectures.spa(dd.Arena("z", **at)).document, dd.Arena("z", **at)) == []


@pytest.mark.parametrize(("gain", "wrong"), [(1.0, True), (180 / math.pi, False), (-180 / math.pi, False)])
def test_a_heading_in_radians_on_an_axis_in_degrees_is_refused(gain: float, wrong: bool) -> None:
    model = dd.Model("compass", dt=64)
    turn = dd.Axis("turn", -180, 180, 90, periodic=True, unit="deg")
    compass = model.add(dd.Sensor("compass", sensor="heading"))
    compass >> model.add(dd.SpaceCode([turn], 20.0, gain=gain, name="heading"))
    message = found(model, dd.Arena(LAYOUT))
    assert bool(message) == wrong
    if wrong:
        assert "57.3 times too small" in message[0]


def test_each_number_of_a_pose_has_a_unit_of_its_own() -> None:
    model = dd.Model("pose", dt=64)
    axes = [dd.Axis("x", 0, 120, 61, unit="cm"), dd.Axis("y", 0, 80, 41, unit="cm")]
    axes.append(dd.Axis("heading", -180, 180, 36, periodic=True, unit="deg"))
    pose = model.add(dd.Sensor("pose", [dd.Axis("of", 0, 2, 3)], sensor="pose"))
    pose >> model.add(dd.SpaceCode(axes, [5, 5, 20], gain=[100, 100, 1], name="code"))
    (wrong,) = agreement.judge(model.document, dd.Arena(LAYOUT))
    assert "on the axis 'heading' in deg" in wrong.what
    assert "[100, 100, 57.2958]" in wrong.fix
    model.set("code.gain", [100, 100, 180 / math.pi])
    assert found(model, dd.Arena(LAYOUT)) == []


def test_a_shift_by_a_position_in_another_unit_is_refused() -> None:
    model = dd.Model("shift", dt=64)
    place = model.add(dd.Sensor("place", [PAIR], sensor="place"))
    shift = model.add(dd.SteeredShift(["x", "y"], name="to the robot"))
    model.add(dd.GaussianStimulus("spot", PLANE, center=[10, 10])) >> shift
    model.connect(place, shift["by"])
    (wrong,) = agreement.judge(model.document, dd.Arena(LAYOUT))
    assert wrong.where == "to the robot"
    assert "100 times too small" in wrong.what
    assert found(model, dd.Arena(LAYOUT, unit="cm")) == []


def test_an_axis_of_a_reading_that_states_another_unit_is_refused() -> None:
    model = dd.Model("place", dt=64)
    model.add(dd.Sensor("place", [dd.Axis("of", 0, 1, 2, unit="m")], sensor="place"))
    (wrong,) = agreement.judge(model.document, dd.Arena("blocks", unit="cm"))
    assert wrong.where == "place"
    assert "states the unit m" in wrong.what
    assert 'unit="m"' in wrong.fix
    assert found(model, dd.Arena("blocks")) == []


class Rail(dd.World):
    """A cart on a rail, commanded in mm."""

    motors: Mapping[str, dd.Signal] = {"reach": dd.Signal("position of the cart", (), "mm")}
    period = 10.0


class Crane(dd.World):
    """A hook that is commanded in cm along its first axis, and in mm along its second."""

    motors: Mapping[str, dd.Signal] = {"reach": dd.Signal("place of the hook", (2,), "cm, mm")}
    period = 10.0


def test_each_number_of_a_command_has_a_unit_of_its_own() -> None:
    model = dd.Model("crane", dt=10)
    read = model.add(dd.Field("u", [PLANE[0]])) >> model.add(dd.PeakPosition(name="read"))
    read >> dd.Weights(np.ones(2), axes=[PAIR]) >> model.add(dd.Motor("hook", [PAIR], motor="reach"))
    (wrong,) = found(model, Crane())
    assert "takes mm" in wrong and "10 times too small" in wrong


@pytest.mark.parametrize(("factor", "wrong"), [(1.0, True), (10.0, False)])
def test_a_motor_that_takes_another_unit_than_the_axis_is_refused(factor: float, wrong: bool) -> None:
    model = dd.Model("rail", dt=10)
    u = model.add(dd.Field("u", [PLANE[0]]))
    read = u >> model.add(dd.PeakPosition(name="read")) >> dd.Gain(factor)
    read >> model.add(dd.Motor("cart", motor="reach"))
    if not wrong:
        assert found(model, Rail()) == []
        return
    with pytest.raises(WorldError, match="takes mm") as caught:
        dd.Session(model, world=Rail())
    (problem,) = caught.value.problems
    assert problem.where == "cart"
    assert problem.fix == "Connect it through a gain: dd.Gain(10)"


def test_the_axes_of_a_map_are_converted_to_the_unit_of_the_arena() -> None:
    walls = {**LAYOUT, "walls": [{"name": "wall", "center": [0.6, 0.4], "size": [0.2, 0.8]}]}
    del walls["goal"]
    seen: list[np.ndarray] = []
    for unit, scale in (("cm", 100.0), ("mm", 1000.0), ("metres", 1.0), ("", 100.0)):
        axes = [dd.Axis(n, 0, b * scale, 13, unit=unit) for n, b in (("x", 1.2), ("y", 0.8))]
        model = dd.Model("map", dt=64)
        model.add(dd.Sensor("map", axes, sensor="obstacles"))
        assert found(model, dd.Arena(walls, unit="cm")) == []
        seen.append(dd.Session(model, world=dd.Arena(walls, unit="cm")).read("map"))
    assert seen[0][6, 6] > 0.999
    assert seen[0][3, 6] == 0
    for other in seen[1:]:
        np.testing.assert_allclose(other, seen[0], atol=1e-5)


def test_a_map_over_an_axis_that_is_no_length_is_refused() -> None:
    model = dd.Model("map", dt=64)
    model.add(dd.Sensor("map", [dd.Axis("x", 0, 90, 10, unit="deg"), PLANE[1]], sensor="obstacles"))
    with pytest.raises(WorldError, match=r"map: .* 'deg', which is no unit of length. Write unit='m'"):
        dd.Session(model, world=dd.Arena(LAYOUT))


def test_axes_without_a_unit_that_barely_overlap_the_arena_cause_a_warning() -> None:
    axes = dd.Axis("x", 0, 210, 22), dd.Axis("y", 0, 0.8, 9)
    model = coding(1.0, axes)
    model.add(dd.Sensor("map", axes, sensor="obstacles"))
    arena = dd.Arena(LAYOUT)
    warned = agreement.judge(model.document, arena)
    assert [(p.where, p.severity) for p in warned] == [("map", "warning"), ("own place", "warning")]
    assert "walls of the arena run from 0 to 1.2 m, and the axis 'x' from 0 to 210" in warned[0].what
    assert all("unit='cm'" in p.fix for p in warned)
    with pytest.warns(RunWarning, match="they barely overlap"):
        dd.simulate(model, 64, world=arena)
    with pytest.warns(RunWarning, match="they barely overlap"):
        session = dd.Session(model, world=arena)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        session.run(128)
    assert found(model, dd.Arena(LAYOUT, unit="cm"))[0].endswith("'y' from 0 to 0.8: they barely overlap")


@dataclass(frozen=True)
class Doubling(dd.Coupling):
    """The input times 2, or times the number of a package's user."""

    scale: Annotated[float, dd.Live()] = 2.0

    def position_units(
        self, ins: Mapping[str, dd.Axes], inputs: Mapping[str, dd.PositionUnits]
    ) -> Mapping[str, dd.PositionUnits]:
        return {"output": tuple(p and p.scaled(self.scale) for p in inputs["input"])}

    def output(self, at: dd.Setting) -> dd.Arrays:
        return {"output": self.scale * at.inputs["input"]}


@dataclass(frozen=True)
class Marking(Doubling):
    """The input as a place on a line of 120 cm."""

    def position_codes(self, ins: Mapping[str, dd.Axes]) -> Mapping[str, dd.PositionCode]:
        return {"input": dd.PositionCode(PLANE, (self.scale, self.scale), (0.0, 0.0), "scale")}


@dataclass(frozen=True)
class Reading(dd.Coupling):
    """The first sample of a field as a place on its axis."""

    def outputs(self, ins: Mapping[str, dd.Axes]) -> Mapping[str, dd.Axes]:
        return {"output": ()}

    def position_units(
        self, ins: Mapping[str, dd.Axes], inputs: Mapping[str, dd.PositionUnits]
    ) -> Mapping[str, dd.PositionUnits]:
        return {"output": (dd.PositionUnit.of(ins["input"][0]),)}

    def output(self, at: dd.Setting) -> dd.Arrays:
        return {"output": at.inputs["input"][0]}


def test_a_kind_of_a_user_passes_positions_on() -> None:
    (wrong,) = agreement.judge(coding(1.0, PLANE, Doubling(10.0)).document, dd.Arena(LAYOUT))
    assert wrong.where == "own place" and "10 times too small" in wrong.what
    assert found(coding(1.0, PLANE, Doubling(100.0)), dd.Arena(LAYOUT)) == []
    assert found(coding(0.5, PLANE, Doubling(200.0)), dd.Arena(LAYOUT)) == []


def test_a_kind_of_a_user_that_uses_positions_is_checked_and_its_parameter_named() -> None:
    model = dd.Model("marking", dt=64)
    model.add(dd.Sensor("place", [PAIR], sensor="place")) >> model.add(Marking(1.0, name="mark"))
    (wrong,) = agreement.judge(model.document, dd.Arena(LAYOUT))
    assert wrong.where == "mark" and "with a scale of 1 on the axes 'x' and 'y' in cm" in wrong.what
    assert wrong.fix.startswith('Set its scale: model.set("mark.scale", 100)')
    model.set("mark.scale", 100.0)
    assert found(model, dd.Arena(LAYOUT)) == []


def test_positions_that_a_kind_of_a_user_reads_off_an_axis_reach_a_motor() -> None:
    model = dd.Model("rail", dt=10)
    read = model.add(dd.Field("u", [PLANE[0]])) >> model.add(Reading(name="read"))
    read >> model.add(dd.Motor("cart", motor="reach"))
    (wrong,) = agreement.judge(model.document, Rail())
    assert (wrong.where, wrong.fix) == ("cart", "Connect it through a gain: dd.Gain(10)")
    assert "the position that read reads out" in wrong.what
