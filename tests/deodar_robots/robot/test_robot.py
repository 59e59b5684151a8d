"""Robot files: what they state is applied and compared with the world, and bad files are named."""

from __future__ import annotations

import json
from pathlib import Path

import jsonschema
import numpy as np
import pytest

import deodar as dd
from deodar.errors import WorldError
from deodar.numerics.axes import Axis
from deodar.recording.opened import again, named
from deodar.session.session_at import session_at
from deodar.worlds._motor_rule import MotorRule
from deodar.worlds.combined import Combined
from deodar.worlds.picture import Picture
from deodar_robots.robot import robot_file, schema
from deodar_robots.robot.robot import Robot
from deodar_robots.zenoh.served_world import ServedWorld
from tests.command_line import typed

EPUCK = {"robot": 1, "name": "mine", "kind": "arena", "settings": {"layout": "blocks", "unit": "cm"}}


@pytest.fixture
def written(tmp_path: Path):
    """Return a function that writes a robot file and opens it."""

    def write(place: str = "", **keys) -> Robot:
        file = tmp_path / "mine.json"
        file.write_text(json.dumps(EPUCK | keys))
        return Robot(file, place)

    return write


def numbers(*values: float) -> np.ndarray:
    return np.array(values, np.float32)


def test_every_shipped_robot_is_valid_and_reads_its_sensors():
    validator = jsonschema.Draft202012Validator(json.loads(schema.SHIPPED.read_text()))
    assert set(robot_file.shipped()) == {"arm", "epuck", "head"}
    for name, file in robot_file.shipped().items():
        validator.validate(json.loads(file.read_text()))
        robot = Robot(name)
        robot.reset(0)
        for sensor, signal in robot.sensors.items():
            if signal.shape is not None:
                axes = [Axis(f"a{k}", 0, n, n, periodic=True) for k, n in enumerate(signal.shape)]
                assert np.isfinite(robot.sense(sensor, tuple(axes), 0.0)).all()
        assert all(rule.limits for rule in robot.rules.values())


def test_the_shipped_schema_is_up_to_date_and_refuses_what_is_refused():
    assert schema.SHIPPED.read_text(encoding="utf-8") == schema.text(), "type: python tools/generate.py"
    validator = jsonschema.Draft202012Validator(json.loads(schema.SHIPPED.read_text()))
    for wrong in ({"robot": 2}, {"strange": 1}, {"motors": {"left": {"slew": 0}}}, {"period": -1}):
        assert list(validator.iter_errors(EPUCK | wrong)), wrong


def test_commands_keep_limits_and_slew_and_are_scaled(written):
    seen = []
    robot = written(
        motors={
            "go": {"to": "left", "scale": 2.0, "offset": 1.0, "limits": [-10, 10], "slew": 62.5},
            "right": {},
        }
    )
    robot.reset(0)
    robot.world.act = lambda motors, time: seen.append({n: v.tolist() for n, v in motors.items()})
    for command in (3.0, 20.0, 20.0, 20.0, -20.0):
        robot.act({"go": numbers(command), "right": numbers(command)}, 0.0)
    # 62.5 per s are 4 in a period of 64 ms
    assert [s["left"] for s in seen] == [[7.0], [15.0], [21.0], [21.0], [13.0]]
    assert [s["right"] for s in seen] == [[3.0], [20.0], [20.0], [20.0], [-20.0]]
    robot.reset(0)
    robot.act({"go": numbers(20.0)}, 0.0)
    assert seen[-1]["left"] == [9.0], "it starts at rest again"


def test_readings_are_renamed_and_scaled(written):
    robot = written(sensors={"bearing": {"from": "heading", "unit": "deg", "scale": 57.29578, "offset": 5}})
    same = dd.Arena("blocks", unit="cm")
    for world in (robot, same):
        world.reset(0)
    assert list(robot.sensors) == ["bearing"] and robot.sensors["bearing"].unit == "deg"
    degrees = np.degrees(same.sense("heading", (), 0.0)) + 5
    np.testing.assert_allclose(robot.sense("bearing", (), 0.0), degrees, rtol=1e-5)
    model = dd.Model("lost")
    model.add(dd.Sensor("eye", sensor="camera"))
    with pytest.raises(WorldError, match=r"has no sensor 'camera'\. Valid names: bearing"):
        dd.Session(model, world=robot)


def test_a_place_changes_what_it_states(written):
    places = {
        "room": {},
        "hall": {"settings": {"unit": "m"}, "period": 32, "motors": {"left": {"limits": [-5, 5]}}},
        "table": {"kind": "mujoco", "settings": {"scene": "table"}, "motors": {}},
    }
    first, hall = written(places=places), written("hall", places=places)
    assert first.world.unit == "cm" and first.period == 64 and first.rules["left"].limits is None
    assert hall.world.unit == "m" and hall.period == 32 and hall.rules["left"].limits == (-5, 5)
    assert "tool_plane" in written("table", places=places).motors
    with pytest.raises(WorldError, match=r"'mine' has no place 'hal'\. Did you mean 'hall'"):
        written("hal", places=places)


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        ({"robot": 2}, "is a robot file of version 2"),
        ({"kind": "areno"}, "no kind 'areno' of robots. Did you mean 'arena'"),
        ({"kind": "combined"}, "no kind 'combined' of robots"),
        ({"kind": "robot"}, "no kind 'robot' of robots"),
        ({"settings": {"layuot": "blocks"}}, "no setting 'layuot'. Did you mean 'layout'"),
        ({"settings": {"period": "soon"}}, "period needs a number, not 'soon'"),
        ({"settings": {"layout": "../secret.json"}}, "outside the folder of the robot's file"),
        ({"settings": {"layout": "/etc/passwd"}}, "outside the folder of the robot's file"),
        ({"strange": 1}, "unknown field `strange`"),
        ({"sensors": {"eye": {}}}, "mine.json: sensor eye: its world has no 'eye'"),
        ({"sensors": {"infrared": {"shape": [9]}}}, r"has the shape \[9\]; its world has \[8\]"),
        ({"sensors": {"heading": {"unit": "deg"}}}, "is in deg; its world has it in rad. State its scale"),
        ({"motors": {"left": {"limits": [5, -5]}}}, r"left: limits is \[5\.0, -5\.0\]|left: limits is \(5"),
        (
            {"motors": {"left": {"limits": [1, 5]}}},
            "left: rest is 0; expected a value within the limits 1 to 5",
        ),
        ({"motors": {"left": {"slew": -1}}}, r"motors\[\.\.\.\]\.slew"),
        ({"places": {"lab": {"places": {}}}}, "unknown field `places`"),
    ],
)
def test_a_bad_file_is_named_with_its_problem(written, keys, message):
    with pytest.raises(WorldError, match=message):
        written(**keys)


def test_files_that_are_not_robots_are_refused(tmp_path: Path):
    file = tmp_path / "mine.json"
    for content, message in (
        ("{", "is not JSON"),
        ('{"robot": 1, "robot": 1}', "occurs twice"),
        ("[" * 200 + "]" * 200, "nested deeper"),
        ('{"robot": NaN}', "not finite"),
    ):
        file.write_text(content)
        with pytest.raises(WorldError, match=message):
            Robot(file)
    with file.open("wb") as big:
        big.truncate(100_000_000)
    with pytest.raises(WorldError, match="has 100000000 bytes"):
        Robot(file)
    with pytest.raises(WorldError, match=r"no robot file 'epuk'\. Did you mean 'epuck'"):
        Robot("epuk")
    folder = tmp_path / "robots"
    folder.mkdir()
    (folder / "maze.json").symlink_to(file)
    for layout in ("maze.json", ["blocks", "../mine.json"]):
        inside = folder / "inside.json"
        inside.write_text(json.dumps(EPUCK | {"settings": {"layout": layout}}))
        with pytest.raises(WorldError, match="outside the folder"):
            Robot(inside)


def test_a_robot_is_named_on_the_command_line_and_opened_again_from_its_description():
    robot = named("robot:epuck@simulated", "--world")
    assert isinstance(robot, Robot)
    described = robot.describe()
    assert again(Robot, described).describe() == described


def test_the_server_keeps_the_limits_whatever_the_model_sends(written):
    robot = written(motors={"left": {"limits": [-100, 100]}, "right": {"limits": [-100, 100]}})
    served = ServedWorld(robot, "mine")
    world = dd.Zenoh(at=served.endpoint)
    assert world.about.rules["left"] == MotorRule((-100.0, 100.0))
    object.__setattr__(world.about, "rules", {})  # a sender that keeps no limits
    world.reset(0)
    count = (Axis("of", 0, 1, 2),)
    for _ in range(5):
        world.act({"left": numbers(900.0), "right": numbers(900.0)}, 0.0)
    steps = world.sense("encoders", count, 0.0)
    np.testing.assert_allclose(steps, [[32.0, 32.0]], rtol=0.1)
    world.close()
    served.close()


def test_the_command_lists_robots_and_checks_one_without_moving_it(written, monkeypatch, tmp_path):
    listing = typed("robots")
    assert listing.status == 0 and "epuck  arena; places: simulated, network" in listing.out
    written(motors={"left": {"limits": [-100, 100], "slew": 50}, "right": {}})
    monkeypatch.setattr(Robot, "act", lambda *args: pytest.fail("a motor was moved"))
    command = typed("robots check", tmp_path / "mine.json")
    assert command.status == 0 and "mine is there: arena, repeatable" in command.out
    assert "sensor heading: heading; 0 along x, counter-clockwise; one number rad; 15.6 Hz" in command.out
    assert "step/s; -100 to 100, at most 50 per s; at rest 0 after 200 ms" in command.out
    as_json = typed("robots check", tmp_path / "mine.json", "--json")
    assert as_json.status == 0 and as_json.json["robot"] == "mine"
    assert typed("robots check").status == 2
    absent = typed("robots check nowhere")
    assert absent.status == 1 and "no robot file 'nowhere'" in absent.err


def test_the_world_of_a_robot_has_all_that_it_has_without_the_file(tmp_path: Path):
    robot = Robot("epuck")
    robot.place("tower", (30, 30), (5, 5), height=5)
    [tower] = [t for t in robot.world.objects.present(1, 0) if t.name == "tower"]
    assert tower.height == 0.05
    plan = dd.TrialPlan(200.0, actions=[dd.Place(64.0, "wall", (30, 30), (5, 5), height=5)])
    model = dd.Model("still")
    model.add(dd.Sensor("eye", [dd.Axis("beam", 0, 7, 8)], sensor="infrared"))
    dd.Trials(model, plan, Robot("epuck"), together=False).run([0])
    blind = dd.Model("blind")
    blind.add(dd.Sensor("eye", [dd.Axis("beam", 0, 5, 6)], sensor="beams"))
    file = tmp_path / "mine.json"
    file.write_text(json.dumps(EPUCK | {"sensors": {"beams": {"from": "infrared"}}}))
    with pytest.raises(WorldError, match=r"\[6\]. Choose another vehicle of the arena: vehicle=khepera"):
        dd.Session(blind, world=Robot(file))


def test_motors_are_narrowed_from_the_next_command_on_and_stay_narrow_after_a_reset(written):
    seen = []
    robot = written(motors={"left": {"limits": [-10, 10]}, "right": {"scale": 2.0}})
    robot.reset(0)
    robot.world.act = lambda motors, time: seen.append({n: v.tolist() for n, v in motors.items()})
    fast = {"left": numbers(20.0), "right": numbers(20.0)}
    robot.act(fast, 0.0)
    robot.narrow("left", (-50, 4))
    robot.narrow("right", (-1, 8))
    robot.narrow("left", (-3, 6), slew=62.5)  # 4 in a period
    robot.act(fast, 64.0)
    robot.reset(1)
    robot.act({"left": numbers(-20.0), "right": numbers(5.0)}, 0.0)
    assert [s["left"] for s in seen] == [[10.0], [4.0], [-3.0]]
    assert [s["right"] for s in seen] == [[40.0], [16.0], [10.0]]
    with pytest.raises(WorldError, match="has no motor 'lift'"):
        robot.narrow("lift", (-1, 1))


def test_a_narrowed_robot_is_opened_again_with_its_limits(written):
    robot = written(motors={"left": {"limits": [-10, 10]}, "right": {}})
    before = robot.describe()
    robot.narrow("left", (-2, 2), 5.0)
    opened = again(Robot, robot.describe())
    assert opened.rules == robot.rules and opened.describe() == robot.describe() != before
    assert again(Robot, before).rules["left"].limits == (-10, 10)


def test_a_record_of_a_run_whose_motor_was_narrowed_is_continued_within_the_limits(written, tmp_path):
    model = dd.Model("ahead", dt=64)
    model.add(dd.Boost("go", amplitude=9.0)) >> model.add(dd.Motor("left", motor="left"))
    model.add(dd.Sensor("pose", [Axis("of", 0, 2, 3)], sensor="pose"))
    robot = written(motors={"left": {"limits": [-10, 10]}, "right": {}})
    robot.narrow("left", (-5, 5))
    session = dd.Session(model, world=robot)
    with session.record(tmp_path / "run", ["pose.output"]):
        session.step(5)
        session.narrow_motor("left", (-2, 2))
        session.step(5)
    continued = session_at(tmp_path / "run", 640.0)
    assert continued.world.rules["left"].limits == (-2, 2)
    assert continued.read("pose").tobytes() == session.read("pose").tobytes()
    early = session_at(tmp_path / "run", 128.0)
    assert early.world.rules["left"].limits == (-5, 5)


def driven(robot: Robot | Combined) -> dd.Session:
    """Return a session that drives the motors of a robot, "left" backwards."""
    model = dd.Model("driving", dt=64)
    for motor, amplitude in {"left": -9.0, "right": 9.0}.items():
        model.add(dd.Boost(f"go {motor}", amplitude=amplitude)) >> model.add(dd.Motor(motor, motor=motor))
    model.add(dd.Sensor("pose", [Axis("of", 0, 2, 3)], sensor="pose"))
    return dd.Session(model, world=robot)


@pytest.mark.parametrize("combined", [False, True])
def test_a_stored_state_is_restored_before_and_after_motors_are_narrowed(written, tmp_path, combined):
    def opened() -> Robot | Combined:
        robot = written(motors={"left": {"limits": [-10, 10]}, "right": {"slew": 20}})
        return Combined(robot, {"eye": Picture.example()}) if combined else robot

    session = driven(opened())
    session.step(3)
    dd.save_snapshot(session.snapshot(), tmp_path / "wide")
    session.narrow_motor("left", slew=10.0)
    session.step(3)
    dd.save_snapshot(session.snapshot(), tmp_path / "narrow")
    session.step(3)
    after = session.read("pose").tobytes()
    session.restore(dd.load_snapshot(tmp_path / "wide"))
    session.step(6)
    assert session.read("pose").tobytes() == after, "the slow motor continues from its command of that moment"
    fresh = driven(opened())
    fresh.restore(dd.load_snapshot(tmp_path / "narrow"))
    fresh.narrow_motor("left", slew=10.0)
    fresh.step(3)
    assert fresh.read("pose").tobytes() == after


@pytest.mark.parametrize("combined", [False, True])
def test_a_state_is_restored_that_has_only_motors_with_a_rate_of_change(written, tmp_path, combined):
    """Older versions stored such states."""

    def opened() -> Robot | Combined:
        robot = written(motors={"left": {"limits": [-10, 10]}, "right": {"slew": 20}})
        return Combined(robot, {"eye": Picture.example()}) if combined else robot

    session = driven(opened())
    session.step(3)
    snapshot = session.snapshot()
    state = snapshot.world.world
    robot = state["world"] if combined else state
    robot["commands"] = {"right": robot["commands"]["right"]}
    dd.save_snapshot(snapshot, tmp_path / "older")
    session.step(3)
    fresh = driven(opened())
    fresh.restore(dd.load_snapshot(tmp_path / "older"))
    fresh.step(3)
    assert fresh.read("pose").tobytes() == session.read("pose").tobytes()
    session.narrow_motor("right", slew=5.0)
    session.restore(dd.load_snapshot(tmp_path / "older"))
    assert session.time == 3 * 64


def test_motors_of_a_robot_in_a_combined_world_are_narrowed():
    robot = dd.Robot("epuck")
    world = Combined(robot, {"eye": Picture.example()})
    assert world.can_narrow and dict(world.rules) == dict(robot.rules)
    world.narrow("left", (-1.0, 1.0))
    world.narrow("right", slew=3.0)
    assert world.rules["left"].limits == (-1.0, 1.0) and world.rules["right"].slew == 3.0
