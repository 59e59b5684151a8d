"""A robot on the network as a world."""

from __future__ import annotations

import os
import platform
import secrets
import threading
import time
import warnings
import weakref
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from deodar import codec
from deodar.codec import Json, JsonObject
from deodar.errors import RunWarning, WorldError, did_you_mean
from deodar.numerics.axes import Axes
from deodar.registry import register
from deodar.worlds._base import Signal
from deodar.worlds._link_state import LinkState
from deodar.worlds._settings import number, parse_argument
from deodar.worlds.arena.arena import Arena
from deodar_robots.limited_world import LimitedWorld
from deodar_robots.motor_limiter import MotorLimiter, slowed
from deodar_robots.zenoh import link
from deodar_robots.zenoh.about import (
    OLDER,
    About,
    Requests,
    WireMessage,
    bundle,
    key,
    reading_keys,
    requests_to_data,
    unbundle,
)
from deodar_robots.zenoh.inboxes import REASONS, ReadingInbox
from deodar_robots.zenoh.link import TlsFiles
from deodar_robots.zenoh.port_key import RobotKey
from deodar_robots.zenoh.served_world import ServedWorld

SLOWEST = 60.0
"""Time after which a robot that still answers is no longer waited for, s."""

FILES = ("authority", "certificate", "private_key")
"""Settings that name files of TLS."""


@register
class Zenoh(LimitedWorld):
    r"""A robot in another process or on another machine, over [Zenoh](https://zenoh.io), without a router.

    The robot says of itself which sensors and motors it has, and how it counts time. With the clock `step` it
    waits for the commands of each period, and a run has the bits that it has with the world in the process
    itself. With the clock `live` the newest reading counts, at the age a(t), and the model is to be paced to
    the wall clock (`session.run_live`); such a run cannot be repeated, so record its sensors and replay them
    (`Recording`).

    A robot that leaves the network, or whose last message is older than `patience`, is an error that names
    it. Its motors stop by themselves: the owner of a motor puts it to rest when no command comes.

    Equation:
        y(t) = y_{\mathrm{robot}}(t - a(t)),\quad a(t) \le \mathrm{patience}

    Parameters:
        robot: name of the robot; empty: the only one at the endpoint.
        at: endpoint of the robot, tcp/HOST:PORT, or with TLS tls/HOST:PORT.
        patience: time without a message of the robot after which a reading raises an error, s.
        trusted: whether the network between this machine and another host is trusted; without TLS messages
            are not encrypted. On this machine: whether every process is, so that no key is needed.
        authority: file of the authority that signed the certificate of the robot; needed with TLS.
        certificate: file of a certificate of this side, if the robot asks for one.
        private_key: file of its private key.

    Shapes:
        Those of the robot's sensors and motors.

    Reference:
        Lomp, Richter, Zibner & Schöner (2016), Front. Neurorobot. 10:14, section 3.2 (parts of one
        architecture on several computers, connected by a network).
    """

    # of the example
    sensors: Mapping[str, Signal] = Arena.sensors
    motors: Mapping[str, Signal] = Arena.motors
    stands_in = False

    def __init__(
        self,
        robot: str = "",
        at: str = link.HERE,
        patience: float = 0.5,
        trusted: bool = False,
        authority: str | Path = "",
        certificate: str | Path = "",
        private_key: str | Path = "",
    ) -> None:
        self._files = TlsFiles(str(authority), str(certificate), str(private_key))
        self.at = link.require_endpoint(at, trusted, self._files)
        self.patience, self.trusted = number("patience", patience, above=0.0), bool(trusted)
        self._inbox = ReadingInbox()
        self._connect(robot)
        self.robot = self.about.name
        self.sensors, self.motors, self.period = self.about.sensors, self.about.motors, self.about.period
        self._requests: Requests | None = None
        self._copies, self._sequence, self._begun = 1, 0, False
        self._read_at, self._warned = 0, False

    @property
    def repeatable(self) -> bool:  # type: ignore[override]
        """Whether a restored state leads to the same readings again."""
        return self.about.repeatable

    @property
    def wall_clock(self) -> bool:  # type: ignore[override]
        """Whether it follows the wall clock."""
        return self.about.clock == "live"

    # ----------------------------------------------------------------------------------------- the connection

    def _connect(self, robot: str) -> None:
        self._credentials = link.credentials(self.at, self.trusted, self._files)
        self._session = session = link.connect(self.at, max(self.patience, 0.2), self._credentials)
        self._commander = secrets.randbits(62) + 1
        self._publishers: dict[str, Any] = {}
        self._close = weakref.finalize(self, session.close)
        try:
            self.about = self._robot_named(robot)
            self._limiter = MotorLimiter(self.about.motors, self._declare_rules(self.about.rules))
            self._declare()
        except BaseException:
            self._close()
            raise

    def _robot_named(self, robot: str) -> About:
        """Return the robot of a name, or the only one."""
        named = key(robot, "about") if robot else "*/about"
        limit = time.monotonic() + max(self.patience, 0.2)
        robots: list[About] = []
        while not robots and time.monotonic() < limit:
            robots = self._robots(named, max(self.patience, 0.2))
            if not robots:
                time.sleep(0.02)
        names = sorted(about.name for about in robots)
        if len(robots) == 1:
            return robots[0]
        if not robots and robot:
            others = [present.name for present in self._robots("*/about", self.patience)]
            hint = did_you_mean(robot, others)
            raise WorldError(f"no robot called {robot!r} is at {self.at}", fix=hint)
        if not robots:
            raise WorldError(f"no robot is at {self.at}", fix="Start one: deodar serve arena:blocks")
        if len(set(names)) < len(names):
            raise WorldError(f"two robots at {self.at} have one name, {names[0]!r}", fix="Rename one of them")
        raise WorldError(f"several robots are at {self.at}", fix=f"Name one: {', '.join(names)}")

    def _robots(self, named: str, seconds: float) -> list[About]:
        """Return the robots that answer; each has to prove that it has the key of the port, if there is one.

        Raises:
            WorldError: one does not prove it, or does not describe itself.
        """
        challenge = secrets.token_bytes(32)
        replies = self._session.get(named, payload=challenge, timeout=seconds)
        robots: list[About] = []
        for sample in (reply.ok for reply in replies if reply.ok is not None):
            proof, port = bytes(sample.attachment or b""), self._credentials
            if isinstance(port, RobotKey) and not port.proven(challenge, proof):
                raise WorldError(
                    f"the program at {self.at} does not prove that it has the key of this port, {port.path}",
                    fix="Let it answer `about` with the proof, as a robot without deodar does",
                )
            robots.append(About.from_text(bytes(sample.payload)))
        return robots

    def _declare(self) -> None:
        zenoh, robot, inbox, session = link.library(), self.about.name, self._inbox, self._session

        def reading(sample: Any) -> None:
            inbox.offer(str(sample.key_expr), bytes(sample.payload))

        def gone(sample: Any) -> None:
            if sample.kind == zenoh.SampleKind.DELETE:
                inbox.leave()

        def cut(event: Any) -> None:
            # Zenoh connects again by itself, also to a program that took the port and proves nothing
            if event.kind == zenoh.SampleKind.DELETE:
                inbox.leave()

        def passed_to(take: Callable[[bytes], None]) -> Any:
            return link.callback(lambda sample: take(bytes(sample.payload)))

        self._declared = [
            session.declare_subscriber(key(robot, "sensor") + "/**", link.callback(reading)),
            session.declare_subscriber(key(robot, "period"), passed_to(inbox.end)),
            session.declare_subscriber(key(robot, "refused"), passed_to(inbox.refuse)),
            session.declare_subscriber(
                key(robot, "error"), passed_to(lambda raw: inbox.fail(raw.decode(errors="replace")))
            ),
            session.liveliness().declare_subscriber(key(robot, "alive"), link.callback(gone), history=True),
            session.liveliness().declare_token(key(robot, "commander", f"{self._commander:x}")),
            session.info.declare_transport_events_listener(link.callback(cut)),
        ]

    def close(self) -> None:
        """Leave the network; the robot puts its motors to rest. The next `reset` connects again."""
        self._close()
        self._inbox.leave()

    # ------------------------------------------------------------------------------------------- the exchange

    def reset(self, seed: int, trials: Sequence[int] = (0,), precision: str = "float32") -> None:
        if not self._close.alive or self._inbox.gone:
            self._reconnect()
        self._inbox.begin()
        request: JsonObject = {"commander": self._commander, "who": _who(), "seed": int(seed)}
        request |= {"trials": [int(t) for t in trials], "precision": str(precision)}
        if self.about.reads:  # a robot without deodar has nothing to begin
            self._ask("begin", codec.line(request).encode())
            self._inbox.begin()  # a message of the run before may have come meanwhile
        # a live robot is one, whatever the number of copies
        self._copies = len(trials) if self.about.clock == "step" else 1
        self._begun, self._sequence, self._read_at, self._requests = True, 0, 0, None
        self._warned = False
        self._limiter.begin(self._copies)

    def _reconnect(self) -> None:
        """Connect again to a robot that was away; it has to have the same signals."""
        before = self.about
        self._close()
        self._inbox = ReadingInbox()
        self._connect(self.robot)
        for attribute in ("sensors", "motors", "period", "clock"):
            if getattr(before, attribute) != getattr(self.about, attribute):
                self.close()
                self.about = before  # the next attempt is compared with it again
                raise WorldError(
                    f"the robot {self.robot!r} has other {attribute} than before", fix="Open the world again"
                )

    def sense(self, sensor: str, axes: Axes, time: float) -> np.ndarray:
        return self.sense_all([(sensor, axes)], time)[0]

    def sense_all(self, requests: Sequence[tuple[str, Axes]], time: float) -> list[np.ndarray]:
        self._warn_refused()
        for sensor, _ in requests:
            self.require(sensor)
        requested = [(sensor, tuple(axes)) for sensor, axes in requests]
        if self.about.clock == "live":
            return self._newest(requested, time)
        self._wait()
        if self._requests == requested and self._sequence > self._read_at:
            keys = reading_keys(self.robot, requested)
            self._until(lambda seconds: self._inbox.wait_for(keys, seconds, self._sequence))
            readings = [self._inbox.reading(k) for k in keys]
            return [self._incoming(s, r[0]) for (s, _), r in zip(requested, readings, strict=True) if r]
        return self._read(requested, time)

    def act(self, motors: Mapping[str, np.ndarray], time: float) -> None:
        self._require_there()
        self._wait()
        self._warn_refused()
        self._sequence += 1
        for motor, command in motors.items():
            self.require_motor(motor)
            allowed = np.asarray(self._limiter.allowed(motor, command, self.period or 0.0))
            where = key(self.robot, "motor", motor)
            self._send(where, allowed[0] if self._copies == 1 else allowed, time)
        self._send(key(self.robot, "step"), np.zeros(()), time, len(motors))

    def halt(self) -> None:
        if self._begun and self._close.alive and self.about.clock == "live":
            self._limiter.rest()
            self._send(key(self.robot, "halt"), np.zeros(()), 0.0)

    def _warn_refused(self) -> None:
        """Issue one warning of a run when the robot has refused messages; `link` counts the later ones."""
        refusals = self._inbox.refusals
        if not refusals or self._warned:
            return
        self._warned = True
        reasons = "; ".join(f"{n} {REASONS[reason]}" for reason, n in refusals.items())
        warnings.warn(
            f"the robot {self.robot!r} has refused {sum(refusals.values())} messages so far: {reasons}",
            RunWarning,
            stacklevel=3,
        )

    def _newest(self, requests: Sequence[tuple[str, Axes]], time: float) -> list[np.ndarray]:
        """Return the newest readings of a live robot, none of them older than the patience."""
        self._require_there()
        keys = reading_keys(self.robot, requests)
        if self._requests != requests:
            if self.about.reads:
                return self._read(requests, time)
            self._inbox.want(keys)
            self._requests = list(requests)
        self._inbox.wait_for(keys, self.patience)
        self._require_there()
        readings: list[np.ndarray] = []
        for (sensor, _), where in zip(requests, keys, strict=True):
            newest = self._inbox.reading(where)
            slow = (self.sensors[sensor].period or 0.0) / 1000
            if newest is None or newest[2] > self.patience + slow:
                raise self._silent(newest[2] if newest else self.patience, sensor)
            readings.append(self._incoming(sensor, newest[0]))
        return readings

    def _read(self, requests: Sequence[tuple[str, Axes]], time: float) -> list[np.ndarray]:
        """Read sensors now, and receive them after each period from now on."""
        keys = reading_keys(self.robot, requests)
        self._inbox.want(keys)
        self._requests, self._read_at = list(requests), self._sequence
        question: JsonObject = {"commander": self._commander, "requests": requests_to_data(requests)}
        question |= {"sequence": self._sequence, "time": time}
        messages = unbundle(self._ask("read", codec.line(question).encode()))
        if self.about.clock == "live":
            for where, message in zip(keys, messages, strict=True):
                self._inbox.add(where, message)
        return [self._incoming(s, m.array) for (s, _), m in zip(requests, messages, strict=True)]

    def _incoming(self, sensor: str, array: np.ndarray) -> np.ndarray:
        return array[None] if self.sensors[sensor].each and self._copies == 1 else array

    def _send(self, where: str, array: np.ndarray, start: float, parts: int = 1) -> None:
        """Send a message of the present period."""
        if where not in self._publishers:
            control = link.library().CongestionControl
            waits = self.about.clock == "step"
            self._publishers[where] = self._session.declare_publisher(
                where, congestion_control=control.BLOCK if waits else control.DROP
            )
        times = self._sequence, start, time.monotonic_ns(), self._inbox.stamp
        message = WireMessage(array, *times, commander=self._commander, parts=parts)
        self._publishers[where].put(message.to_bytes())

    # ------------------------------------------------------------------------------- a robot that stays away

    def _wait(self) -> None:
        """Wait until the period of the last commands has ended; a live robot is not waited for."""
        if self.about.clock == "live" or not self._sequence:
            return
        self._until(lambda seconds: self._inbox.wait(self._sequence, seconds))
        self._inbox.require()

    def _until(self, wait: Callable[[float], bool]) -> None:
        """Wait as long as the robot answers; raise WorldError when it is gone or silent."""
        limit = time.monotonic() + SLOWEST
        while not wait(self.patience):
            self._require_there()
            replies = self._session.get(key(self.robot, "about"), timeout=self.patience)
            if not any(reply.ok is not None for reply in replies) or time.monotonic() > limit:
                raise self._silent(self._inbox.age())
        self._require_there()

    def _require_there(self) -> None:
        self._inbox.require()
        if not self._begun:
            raise WorldError(
                f"the world of the robot {self.robot!r} has not begun", fix="Type: world.reset(seed)"
            )
        if self._inbox.gone:
            age = self._inbox.age()
            raise WorldError(
                f"the robot {self.robot!r} has left the network; its last message came {age:.2f} s ago. Its"
                " motors stop by themselves",
                fix="Start it again, then reset the run",
            )

    def _silent(self, age: float, sensor: str = "") -> WorldError:
        state = f" shows nothing new of {sensor!r}" if sensor else " is silent"
        return WorldError(
            f"the robot {self.robot!r}{state}; its last message came {age:.2f} s ago, and the patience is"
            f" {self.patience:g} s. Its motors stop by themselves",
            fix="Look after it, then reset the run",
        )

    def _ask(self, kind: str, payload: bytes) -> bytes:
        """Ask the robot, and wait for its answer as long as it is there."""
        answers: list[Any] = []
        ended = threading.Event()
        handler = link.callback(answers.append, ended.set)
        self._session.get(key(self.robot, kind), handler, payload=payload, timeout=SLOWEST)
        begun, self._begun = self._begun, True
        try:
            self._until(ended.wait)
        finally:
            self._begun = begun
        if not answers:
            raise WorldError(f"the robot {self.robot!r} does not answer {kind!r}")
        if answers[0].err is not None:
            raise WorldError(bytes(answers[0].err.payload).decode(errors="replace"), where=self.robot)
        return bytes(answers[0].ok.payload)

    def link(self) -> LinkState:
        return self._inbox.state(self.robot)

    # -------------------------------------------------------------------------------------- state and records

    def keep(self) -> Any:
        if not self._begun or not self.about.repeatable:
            return None
        self._wait()
        return {"robot": self._robot_state(b""), "commands": self._limiter.keep()}

    def _robot_state(self, form: bytes) -> list[np.ndarray]:
        return [message.array for message in unbundle(self._ask("keep", form))]

    def older_form(self, state: Any) -> Any:
        if state is None:
            return None
        return {"robot": self._robot_state(OLDER), "commands": slowed(state["commands"], self._robot_rules)}

    def put(self, kept: Any) -> None:
        if kept is None:
            return
        self._require_there()
        self._wait()
        self._ask("put", bundle([WireMessage(np.asarray(leaf)) for leaf in kept["robot"]]))
        self._limiter.put(kept["commands"])
        self._requests = None

    def describe(self) -> dict[str, Json]:
        return {
            "world": "Zenoh",
            "robot": self.robot,
            "at": self.at,
            "trusted": self.trusted,
            **self._files.to_data(),
            "clock": self.about.clock,
            "period": self.period,
            "of": dict(self.about.of),
            **self._narrowing(),
        }

    @classmethod
    def open(cls, argument: str) -> Zenoh:
        """Make the world of a text such as `epuck, at=tcp/127.0.0.1:7461, patience=1`, with TLS also
        `authority=FILE`; the name `*` is the only robot there.
        """
        name, settings = parse_argument(cls, argument, closed=("trusted",))
        return cls("" if name == "*" else name, **settings)

    @classmethod
    def again(cls, described: Mapping[str, Json]) -> Zenoh:
        trusted = described.get("trusted") is True
        files = (str(described.get(file, "")) for file in FILES)
        world = cls(str(described["robot"]), str(described["at"]), 0.5, trusted, *files)
        world._narrow_as(described)
        return world

    @classmethod
    def example(cls) -> Zenoh:
        """Return the robot of an arena that a thread of this process serves."""
        server = ServedWorld(Arena.example())
        world = cls(at=server.endpoint)
        weakref.finalize(world, server.close)
        return world

    @staticmethod
    def example_axes(sensor: str) -> Axes:
        return Arena.example_axes(sensor)


def _who() -> str:
    """Return the name of this machine and the number of this process, for messages to others."""
    return f"process {os.getpid()} on {platform.node() or 'an unnamed machine'}"
