"""The command `deodar robots [check FILE | key ENDPOINT]`."""

from __future__ import annotations

import argparse
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from deodar.cli import _options
from deodar.cli._answer import CommandAnswer
from deodar.codec import JsonObject

if TYPE_CHECKING:
    from deodar.numerics.axes import Axes
    from deodar_robots.robot.robot import Robot

HELP = "list robots that files describe, check one: connect to it and print its signals, or make a key"
WATCHED = 1.0
"""Time for which the readings of a live robot are counted, s."""


def arguments(parser: _options.CommandParser) -> None:
    """Add the arguments of the command."""
    parser.add_argument(
        "what",
        nargs="?",
        choices=("check", "key"),
        help="check the robot of FILE, which moves nothing; or print the key file of an endpoint here",
    )
    parser.option(
        "file", "FILE[@PLACE]", "a robot file, or the name of a shipped one; of key: ENDPOINT", nargs="?"
    )
    _options.add_json(parser)


def run(args: argparse.Namespace) -> CommandAnswer:
    """Print the robots, or the signals of one."""
    # start-up time: these bring JAX
    from deodar_robots.robot import robot_file
    from deodar_robots.robot.robot import Robot
    from deodar_robots.zenoh import link

    if args.what and not args.file:
        args.wrong("key needs an ENDPOINT" if args.what == "key" else "check needs a FILE")
    if args.what == "key":
        path = str(link.key_of(args.file).path)
        return CommandAnswer({"key": path}, [path])
    if not args.what:
        files = robot_file.shipped() | {str(p): p for p in sorted(Path("robots").glob("*.json"))}
        listed = {name: robot_file.load_robot(path) for name, path in files.items()}
        width, lines = max(map(len, listed)), list[str]()
        for name, file in listed.items():
            places = f"; places: {', '.join(file.places)}" if file.places else ""
            lines.append(f"{name:{width}}  {file.kind}{places}")
        return CommandAnswer(
            {name: {"kind": f.kind, "places": list(f.places)} for name, f in listed.items()}, lines
        )
    robot = Robot.open(args.file)
    try:
        found = _check(robot)
    finally:
        robot.close()
    lines = [f"{found['robot']} is there: {found['kind']}, {found['clock']}"]
    rows: dict[str, dict[str, Any]] = {"sensor": found["sensors"], "motor": found["motors"]}
    for what, signals in rows.items():
        lines += [f"  {what} {name}: {about}" for name, about in signals.items()]
    return CommandAnswer(found, lines)


def _check(robot: Robot) -> dict[str, Any]:
    """Read every sensor once, and count the readings of a live robot; no motor is moved."""
    robot.reset(0)
    shaped = [
        (name, _axes(signal.shape)) for name, signal in robot.sensors.items() if signal.shape is not None
    ]
    robot.sense_all(shaped, 0.0)
    live = robot.wall_clock
    before, began = _received(robot), time.monotonic()
    each = dict(_by_sensor(robot))
    if live:
        time.sleep(WATCHED)
        robot.sense_all(shaped, 0.0)
    seconds = time.monotonic() - began
    rate = (_received(robot) - before) / seconds if live else None
    rates = {name: (n - each.get(name, 0)) / seconds for name, n in _by_sensor(robot).items()}
    sensors: JsonObject = {}
    for name, signal in robot.sensors.items():
        period = signal.period or robot.period
        text = "constant" if period is None else f"{1000 / period:.3g} Hz"
        counted = rates.get(robot.source_of(name), rate)
        if counted is not None and _received(robot):
            text += f", {counted:.3g} Hz counted"
        sensors[name] = f"{signal}; {text}"
    motors: JsonObject = {}
    for name, signal in robot.motors.items():
        rule = robot.rules[name]
        limits = "no limits" if rule.limits is None else f"{rule.limits[0]:g} to {rule.limits[1]:g}"
        slew = "" if rule.slew is None else f", at most {rule.slew:g} per s"
        motors[name] = f"{signal}; {limits}{slew}; at rest {rule.rest:g} after {rule.stops_after:g} ms"
    clock = "live" if live else "repeatable"
    return {
        "robot": robot.file.name,
        "kind": robot.file.kind,
        "clock": clock,
        "sensors": sensors,
        "motors": motors,
    }


def _axes(shape: Sequence[int]) -> Axes:
    """Return axes of a shape, for a reading."""
    # start-up time: this brings NumPy
    from deodar.numerics.axes import Axis

    return tuple(Axis(f"a{k}", 0, n, n, periodic=True) for k, n in enumerate(shape))


def _received(robot: Robot) -> int:
    """Return the number of periods that came over the network."""
    link = robot.link()
    return 0 if link is None else link.received


def _by_sensor(robot: Robot) -> Mapping[str, int]:
    """Return the number of messages of each sensor of the world, where they come one by one."""
    link = robot.link()
    return {} if link is None else link.by_sensor
