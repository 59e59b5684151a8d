"""A robot on the network: the run is that of the world itself, and only its commander moves it."""

from __future__ import annotations

import threading
import time

import numpy as np
import psutil
import pytest

import deodar as dd
from deodar import codec
from deodar.cli import main
from deodar.errors import RunWarning, WorldError
from deodar.worlds._base import Signal
from deodar.worlds._motor_rule import MotorRule
from deodar_robots.zenoh import link
from deodar_robots.zenoh.about import WireMessage, key
from deodar_robots.zenoh.served_world import ServedWorld
from deodar_robots.zenoh.zenoh import Zenoh
from tests.deodar_robots.zenoh.wheel import Wheel


def avoiding() -> dd.Model:
    """Return a model that drives a robot around walls."""
    model = dd.Model("avoiding", dt=16)
    eyes = model.add(dd.Sensor("eyes", [dd.Axis("sensor", 0, 7, 8)], sensor="infrared"))
    model.add(dd.Sensor("pose", [dd.Axis("of", 0, 2, 3)], sensor="pose"))
    slows = {"left": [-1.5, -1, -0.5, 0, 0, 0, 0, -1.5], "right": [0, 0, 0, 0, 0, -0.5, -1, 0]}
    for name, weights in slows.items():
        wheel = model.add(dd.Motor(name, motor=name))
        eyes >> dd.Gain(0.5) >> dd.Weights(np.array(weights), axes=()) >> wheel
        model.add(dd.Boost(f"go {name}", amplitude=400.0)) >> wheel
    return model


def arena() -> dd.Arena:
    return dd.Arena(
        "blocks", unit="cm", start=(20, 30, 0.4), noise=dd.ArenaNoise(infrared_noise=0.1, place_noise=0.3)
    )


def turning(amplitude: float = 2.0) -> dd.Model:
    """Return a model that turns the wheel and sees its angle."""
    model = dd.Model("turning", dt=10)
    model.add(dd.Sensor("see", sensor="angle"))
    model.add(dd.Boost("go", amplitude=amplitude)) >> model.add(dd.Motor("turn", motor="speed"))
    return model


@pytest.fixture
def served():
    """Return a function that serves a world in a thread until the test ends."""
    begun = []

    def serve(world, name="robot", clock="step"):
        begun.append(ServedWorld(world, name, clock))
        return begun[-1]

    yield serve
    for sensing in begun:
        sensing.close()


def path(world, precision="float32", seed=3, periods=150):
    session = dd.Session(avoiding(), world=world, seed=seed, precision=precision)
    shown = []
    for _ in range(periods):
        session.run(64)
        shown.append(np.concatenate([session.read("pose"), session.read("eyes")]))
    return np.array(shown)


@pytest.mark.parametrize("precision", ["float32", "float64"])
def test_the_run_behind_the_network_has_the_bits_of_the_run_in_one_process(served, precision):
    world = Zenoh(at=served(arena()).endpoint)
    expected = path(arena(), precision)
    for _ in range(2):  # also after a reset
        assert np.array_equal(path(world, precision), expected)
    assert not np.array_equal(path(world, precision, seed=4), expected)
    state = world.link()
    assert (state.received, state.lost, state.refused) == (450, 0, 0) and state.round_trip > 0
    world.close()


def test_sensors_over_any_axes_are_read_like_those_of_the_world(served):
    world, same = Zenoh(at=served(arena()).endpoint), arena()
    axes = (dd.Axis("x", 0, 120, 13, unit="cm"), dd.Axis("y", 0, 80, 9, unit="cm"))
    coarse = (dd.Axis("x", 0, 120, 5, unit="cm"), dd.Axis("y", 0, 80, 4, unit="cm"))
    requests = [("obstacles", axes), ("obstacles", coarse), ("pose", (dd.Axis("of", 0, 2, 3),))]
    for sensing in (world, same):
        sensing.reset(0, [0, 5])
    for _ in range(3):
        found, expected = (sensing.sense_all(requests, 0.0) for sensing in (world, same))
        for a, b in zip(found, expected, strict=True):
            assert np.array_equal(a, b) and a.shape[0] == 2
        for sensing in (world, same):
            sensing.act({"left": np.full(2, 300.0, np.float32), "right": np.full(2, 200.0, np.float32)}, 0.0)
    with pytest.raises(WorldError, match=r"no sensor 'obstacle'\. Did you mean 'obstacles'"):
        world.sense("obstacle", axes, 0.0)
    world.close()


def test_a_model_without_sensors_moves_the_robot_period_by_period(served):
    wheel = Wheel()
    world = Zenoh(at=served(wheel).endpoint)
    model = dd.Model("turning", dt=10)
    model.add(dd.Boost("go", amplitude=2.0)) >> model.add(dd.Motor("turn", motor="speed"))
    session = dd.Session(model, world=world)
    session.run(1000)
    assert wheel.angle == pytest.approx(2.0 * 0.99, abs=0.021), "the last command may still be on its way"
    world.close()


def test_a_second_commander_is_refused_by_name_until_the_first_leaves(served):
    at = served(Wheel()).endpoint
    first, second = Zenoh(at=at), Zenoh(at=at)
    first.reset(0)
    with pytest.raises(WorldError, match=r"'robot' is commanded by process \d+ on .*one commander at a time"):
        second.reset(0)
    first.close()
    for _ in range(100):
        try:
            second.reset(0)
            break
        except WorldError:
            time.sleep(0.02)
    second.act({"speed": np.ones(1, np.float32)}, 0.0)
    assert second.sense("angle", (), 10.0) == pytest.approx(0.01)
    second.close()


def test_only_whole_finite_commands_of_the_commander_move_a_motor(served):
    wheel = Wheel()
    robot = served(wheel)
    world = Zenoh(at=robot.endpoint)
    world.reset(0)
    stranger = link.connect(robot.endpoint, 2.0, link.credentials(robot.endpoint))
    right = dict(sequence=1, commander=world._commander)
    good = WireMessage(np.float32(9), **right).to_bytes()
    nan = WireMessage(np.float32(np.nan), **right).to_bytes()
    other = [WireMessage(np.float32(9), 1, commander=number).to_bytes() for number in (0, 5)]
    wrong = {
        "bad": [b"", good[:-1], good + b"x", b"\0" * 200, nan],
        "shape": [WireMessage(np.zeros(3, np.float32), **right).to_bytes()],
        "foreign": other,
    }
    for raws in wrong.values():
        for raw in raws:
            stranger.put(key("robot", "motor", "speed"), raw)
    stranger.put(key("robot", "motor", "no such"), good)
    stranger.put(key("robot", "step"), WireMessage(np.zeros(()), 1, parts=0).to_bytes())
    expected = {"bad": 5, "shape": 1, "foreign": 3, "unknown": 1}
    until(lambda: {k: robot.server.counts[k] for k in expected} == expected)
    assert wheel.angle == 0
    until(lambda: sum(world._inbox.refusals.values()) == 10)
    with pytest.warns(
        RunWarning, match=r"has refused 10 messages so far: 5 not a message.* 3 of another com"
    ):
        world.act({"speed": np.ones(1, np.float32)}, 0.0)
    for _ in range(2):
        world.act({"speed": np.ones(1, np.float32)}, 0.0)
    stranger.put(
        key("robot", "motor", "speed"), WireMessage(np.float32(9), 2, commander=world._commander).to_bytes()
    )
    until(lambda: robot.server.counts["old"] == 1)
    until(lambda: world.link().refused == 11)
    assert world.sense("angle", (), 30.0) == pytest.approx(0.03)
    stranger.close()
    world.close()


def test_a_flood_of_a_stranger_is_counted_and_needs_no_memory(served):
    robot = served(Wheel(), clock="live")
    stranger = link.connect(robot.endpoint, 2.0, link.credentials(robot.endpoint))
    publisher = stranger.declare_publisher(
        key("robot", "motor", "speed"), congestion_control=link.library().CongestionControl.BLOCK
    )
    raw = WireMessage(np.zeros(500, np.float32), 1, commander=4).to_bytes()
    time.sleep(0.1)
    before = psutil.Process().memory_info().rss
    for _ in range(40_000):
        publisher.put(raw)
    until(lambda: robot.server.counts["foreign"] == 40_000)
    assert psutil.Process().memory_info().rss - before < 40_000 * len(raw) / 4
    angle = Zenoh(at=robot.endpoint)
    angle.reset(0)
    assert angle.sense("angle", (), 0.0) == 0, "the robot still answers, and did not move"
    angle.close()
    stranger.close()


def test_an_error_of_the_world_reaches_the_model_with_its_text(served):
    world = Zenoh(at=served(Wheel()).endpoint)
    session = dd.Session(turning(1e7), world=world)
    with pytest.raises(WorldError, match=r"the robot reports: the world Wheel .* the wheel flew off"):
        session.run(100)
    session = dd.Session(turning(), world=world)
    session.run(100)
    assert session.read("see") == pytest.approx(0.2)
    world.close()


def test_a_live_robot_shows_its_newest_reading_and_cannot_be_repeated(served):
    robot = served(Wheel(), clock="live")
    world = Zenoh(at=robot.endpoint)
    assert not world.repeatable and world.period == 10
    session = dd.Session(turning(), world=world)
    meter = session.run_live(600)
    assert meter.wall > 0.5
    assert 0.4 < float(session.read("see")) < 2.5, "about 2 rad/s for 0.6 s of the wall clock"
    assert world.link().received > 10
    world.close()
    angle = robot.server.world.angle
    time.sleep(0.15)
    assert robot.server.world.angle - angle < 0.1 * 2.0 + 0.2, "at rest since its commander left"
    angle = robot.server.world.angle
    time.sleep(0.1)
    assert robot.server.world.angle == angle


class SlowToStop(Wheel):
    """A wheel whose owner would wait for a minute before it stops it."""

    rules = {"speed": MotorRule(stops_after=60_000.0)}


@pytest.mark.parametrize("ended", ["halt", "an error"])
def test_a_robot_is_halted_at_once_and_moves_again_with_the_next_commands(served, ended):
    wheel = SlowToStop()
    world = Zenoh(at=served(wheel, clock="live").endpoint)
    session = dd.Session(turning(), world=world)
    session.run_live(200)
    before = wheel.angle
    until(lambda: wheel.angle > before + 0.1)
    if ended == "halt":
        world.halt()
    else:
        with pytest.raises(ZeroDivisionError):
            session.run_live(100, between=lambda: 1 / 0)
    until(lambda: still(wheel))
    before = wheel.angle
    session.run_live(100)
    until(lambda: wheel.angle > before + 0.1)
    world.close()


def still(wheel: Wheel) -> bool:
    """Return whether a wheel does not turn for four periods."""
    before = wheel.angle
    time.sleep(0.04)
    return wheel.angle == before


def test_a_stranger_cannot_halt_a_robot(served):
    robot = served(SlowToStop(), clock="live")
    world = Zenoh(at=robot.endpoint)
    dd.Session(turning(), world=world).run_live(100)
    stranger = link.connect(robot.endpoint, 2.0, link.credentials(robot.endpoint))
    for raw in (WireMessage(np.float32(0), 99, commander=7).to_bytes(), b"DDR1"):
        stranger.put(key("robot", "halt"), raw)
    until(lambda: robot.server.counts["foreign"] == robot.server.counts["bad"] == 1)
    before = robot.server.world.angle
    until(lambda: robot.server.world.angle > before + 0.1)
    stranger.close()
    world.close()


def test_a_run_that_is_not_paced_is_refused_for_a_live_robot(served, tmp_path, capsys):
    at = served(Wheel(), clock="live").endpoint
    file = tmp_path / "turning.json"
    dd.save(turning(), file)
    asked = ["run", str(file), "--world", f"zenoh:*, at={at}", "--duration", "200", "--no-progress"]
    with pytest.raises(SystemExit):
        main(asked)
    assert "follows the wall clock, so the run needs --live" in capsys.readouterr().err
    assert main([*asked, "--live"]) == 0


def test_a_reset_during_a_period_leaves_no_message_of_the_run_before(served):
    for clock in ("step", "live"):
        world = Zenoh(at=served(Wheel(), clock=clock).endpoint)
        world.reset(0)
        for k in range(40):
            for _ in range(k):
                world.sense("angle", (), 0.0)
                world.act({"speed": np.ones(1, np.float32)}, 0.0)
            world.reset(0)
            if clock == "step":
                assert world.sense("angle", (), 0.0) == 0
        assert world.link().refused == 0 and world.link().lost == 0
        world.close()


@pytest.mark.parametrize("kind", ["text", "slew"])
def test_the_state_of_any_world_is_restored_over_the_network(served, kind, tmp_path):
    if kind == "text":  # Gymnasium keeps the actions of an episode as text
        inner, model = dd.Gymnasium("Pendulum-v1"), dd.Model("swing", dt=20)
        model.add(dd.Sensor("see", [dd.Axis("of", 0, 2, 3)], sensor="observation"))
        model.add(dd.Boost("go", amplitude=1.0)) >> model.add(dd.Motor("push", motor="action"))
    else:
        file = tmp_path / "slow.json"
        motors = {m: {"limits": [-400, 400], "slew": 300} for m in ("left", "right")}
        file.write_text(codec.text({"robot": 1, "name": "slow", "kind": "arena", "motors": motors}))
        inner, model = dd.Robot(file), dd.Model("driving", dt=16)
        model.add(dd.Sensor("see", [dd.Axis("of", 0, 2, 3)], sensor="pose"))
        for side in motors:
            model.add(dd.Boost(f"go {side}", amplitude=400.0)) >> model.add(dd.Motor(side, motor=side))
    world = Zenoh(at=served(inner).endpoint)
    session = dd.Session(model, world=world)
    start = session.snapshot()
    seen = [shown(session) for _ in range(10)]
    middle = session.snapshot()
    after = [shown(session) for _ in range(10)]
    session.restore(start)
    assert [shown(session) for _ in range(10)] == seen
    session.reset()
    session.restore(middle)
    assert [shown(session) for _ in range(10)] == after
    world.close()


def test_a_stored_state_of_older_versions_is_restored_over_the_network(served, tmp_path):
    """Robot and link stored the commands of the motors with a rate of change alone."""
    file = tmp_path / "slow.json"
    motors = {"left": {"slew": 300}, "right": {}}
    file.write_text(codec.text({"robot": 1, "name": "slow", "kind": "arena", "motors": motors}))
    model = dd.Model("driving", dt=16)
    model.add(dd.Sensor("see", [dd.Axis("of", 0, 2, 3)], sensor="pose"))
    for side in motors:
        model.add(dd.Boost(f"go {side}", amplitude=400.0)) >> model.add(dd.Motor(side, motor=side))
    world = Zenoh(at=served(dd.Robot(file)).endpoint)
    session = dd.Session(model, world=world)
    shown(session)
    snapshot = session.snapshot()
    left, right, *of_robot, link_left, link_right = snapshot.world.world["robot"]
    assert right == link_right == 400
    snapshot.world.world.update(robot=[left, *of_robot, link_left])
    del snapshot.world.world["commands"]["right"]
    dd.save_snapshot(snapshot, tmp_path / "older")
    after = [shown(session) for _ in range(5)]
    session.restore(dd.load_snapshot(tmp_path / "older"))
    assert [shown(session) for _ in range(5)] == after
    world.close()


def shown(session: dd.Session) -> list[float]:
    """Advance by a period, and return what the model sees."""
    session.run(session.world.period)
    return session.read("see").tolist()


def test_a_query_with_values_of_other_types_is_answered_and_the_robot_goes_on(served):
    robot = served(Wheel())
    world = Zenoh(at=robot.endpoint)
    world.reset(0)
    stranger = link.connect(robot.endpoint, 2.0, link.credentials(robot.endpoint))
    for time_, message in (("x", "time is 'x'"), (None, "time is None"), ([1], "expected a finite number")):
        asked = {"commander": world._commander, "requests": [["angle", []]], "time": time_}
        (answer,) = stranger.get(key("robot", "read"), payload=codec.line(asked), timeout=5.0)
        assert message in bytes(answer.err.payload).decode()
    assert world.sense("angle", (), 0.0) == 0
    stranger.close()
    world.close()


def test_a_robot_that_leaves_is_named_and_one_that_returns_is_connected_again(served):
    robot = served(Wheel())
    world = Zenoh(at=robot.endpoint)
    session = dd.Session(turning(), world=world)
    session.run(100)
    robot.close()
    with pytest.raises(WorldError, match=r"'robot' has left .*\d\.\d\d s ago.*motors stop by themselves"):
        session.run(100)
    with pytest.raises(WorldError, match=f"no robot answers at {robot.endpoint}"):
        session.reset()
    again = at_the_same_place(robot, Wheel())
    session.reset()
    session.run(100)
    assert session.read("see") == pytest.approx(0.2)
    again.close()

    class Other(Wheel):
        sensors = {"angle": Signal("angle", (), "deg")}

    again = at_the_same_place(robot, Other())
    with pytest.raises(WorldError, match="'robot' has other sensors than before"):
        session.reset()
    again.close()


def test_a_motor_stays_narrow_when_the_robot_was_away_and_when_another_one_was_refused(served):
    robot = served(Wheel())
    world = Zenoh(at=robot.endpoint)
    world.narrow("speed", (-1.0, 1.0))
    session = dd.Session(turning(), world=world)
    session.run(100)
    assert session.read("see") == pytest.approx(0.1)
    session.narrow_motor("speed", (-3.0, 0.5))
    session.run(100)
    assert session.read("see") == pytest.approx(0.15)
    robot.close()

    class Other(Wheel):
        sensors = {"angle": Signal("angle", (), "deg")}

    changed = at_the_same_place(robot, Other())
    for _ in range(2):
        with pytest.raises(WorldError, match="'robot' has other sensors than before"):
            session.reset()
    changed.close()
    returned = at_the_same_place(robot, Wheel())
    session.reset()
    session.run(100)
    assert session.read("see") == pytest.approx(0.05) and world.rules["speed"].limits == (-1.0, 0.5)
    returned.close()


def test_a_robot_that_returns_with_narrower_motors_keeps_them_narrow(served):
    def wheel(*limits: float) -> Wheel:
        moved = Wheel()
        moved.rules = {"speed": MotorRule(limits)}
        return moved

    robot = served(wheel(-5.0, 5.0))
    world = Zenoh(at=robot.endpoint)
    world.reset(0)
    world.narrow("speed", (-1.0, 3.0))
    robot.close()
    returned = at_the_same_place(robot, wheel(-2.0, 2.0))
    world.reset(0)
    assert world.rules["speed"].limits == (-1.0, 2.0)
    returned.close()


def test_a_record_keeps_what_was_seen_before_a_robot_left_and_is_a_world(served, tmp_path):
    robot = served(Wheel(), clock="live")
    world = Zenoh(at=robot.endpoint)
    session = dd.Session(turning(), world=world)
    with session.record(tmp_path / "run", ["see.output", "turn.output"], every=10):
        session.run_live(300)
        robot.close()
        with pytest.raises(WorldError, match="'robot' has left"):
            session.run_live(300)
    record = dd.load_record(tmp_path / "run")
    seen = record["see.output"].values
    assert len(seen) > 20 and np.unique(seen).size > 5, "the wheel turned"
    replay = dd.simulate(turning(), 200, record="see.output", every=10, world=dd.Recording(record))
    np.testing.assert_array_equal(replay["see.output"].values, seen[: replay.sizes["time"]])


def test_names_that_are_not_there_are_answered_with_those_that_are(served):
    at = served(Wheel(), "epuck").endpoint
    with pytest.raises(WorldError, match=f"no robot called 'epuk' is at {at}. Did you mean 'epuck'?"):
        Zenoh("epuk", at)
    with pytest.raises(WorldError, match="there is no setting 'port'"):
        Zenoh.open("epuck, port=3")
    opened = Zenoh.open(f"*, at={at}, patience=2")
    assert opened.robot == "epuck" and opened.patience == 2
    assert Zenoh.again(opened.describe()).describe() == opened.describe()
    opened.close()


def test_names_of_robots_and_signals_may_have_any_characters(served):
    class Odd(Wheel):
        sensors = {"an*gle/ü #?$": Signal("angle", (), "rad")}
        motors = {"speed": Signal("speed", (), "rad/s")}

    world = Zenoh(at=served(Odd(), "a robot/*").endpoint)
    world.reset(0)
    for k in range(2):
        world.act({"speed": np.ones(1, np.float32)}, 0.0)
        assert world.sense("an*gle/ü #?$", (), 0.0) == pytest.approx(0.01 * (k + 1))
    world.close()


def test_a_world_that_never_changes_has_no_live_clock():
    with pytest.raises(WorldError, match=r"never changes.*clock='step'"):
        ServedWorld(dd.Picture(np.zeros((4, 4, 3))), clock="live")


def test_no_thread_and_no_socket_is_left_after_close(served):
    def present():
        sockets = {tuple(c.laddr) for c in psutil.Process().net_connections("inet")}
        return sockets, {t.name for t in threading.enumerate()}

    before = present()
    robot = ServedWorld(Wheel())
    world = Zenoh(at=robot.endpoint)
    world.reset(0)
    world.act({"speed": np.ones(1, np.float32)}, 0.0)
    assert present() != before
    world.close()
    robot.close()
    until(lambda: present() == before)


def at_the_same_place(robot: ServedWorld, world: Wheel) -> ServedWorld:
    """Serve another world at the endpoint of a robot that has stopped."""
    return ServedWorld(world, "robot", at=robot.endpoint)


def until(holds, seconds: float = 10.0) -> None:
    """Wait until a condition holds."""
    end = time.monotonic() + seconds
    while not holds():
        assert time.monotonic() < end, "timed out"
        time.sleep(0.01)
