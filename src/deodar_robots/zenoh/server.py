"""A world of deodar as a robot on the network: it owns the motors and publishes the sensors."""

from __future__ import annotations

import math
import os
import queue
import time
import weakref
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from typing import Any, cast
from urllib.parse import unquote

import jax
import numpy as np

from deodar import codec
from deodar.errors import DeodarError, WorldError, option
from deodar.numerics.axes import Axes, shape
from deodar.parameters import real, show
from deodar.worlds._base import Signal, World
from deodar.worlds._failure import errors_of
from deodar.worlds._pure import PureWorld
from deodar_robots.motor_limiter import MotorLimiter, slowed
from deodar_robots.zenoh import link
from deodar_robots.zenoh.about import (
    MOST_BYTES,
    OLDER,
    About,
    BadMessage,
    RobotClock,
    WireMessage,
    bundle,
    key,
    reading_keys,
    requests_from_data,
    unbundle,
)
from deodar_robots.zenoh.inboxes import CommandInbox
from deodar_robots.zenoh.link import TlsFiles
from deodar_robots.zenoh.port_key import RobotKey

MOST_WAITING = 64
"""Most queries that wait for the world; more are refused, so that memory is bounded."""

QUERIES = ("begin", "read", "keep", "put")


class WorldServer:
    """Serves a world of deodar to one commander at a time.

    With the clock `step` the world advances by one period when all commands of the period are there. With
    `live` it advances by the wall clock; a motor whose commands stay away goes to rest, and so do all motors
    when the commander leaves and when the server closes.

    Args:
        world: the world.
        name: name of the robot.
        endpoint: where to listen.
        clock: step, or live.
        trusted: whether the network of another host is trusted; on this machine, whether every process is.
        files: certificate and private key for an endpoint with TLS. With an authority a commander needs a
            certificate that it signed.

    Attributes:
        about: what the robot says of itself.
        late: periods of a live world that began more than a period late.
        endpoint: where the server listens.
    """

    def __init__(
        self,
        world: World,
        name: str,
        endpoint: str = link.HERE,
        clock: RobotClock = "step",
        trusted: bool = False,
        files: TlsFiles = link.NO_FILES,
    ) -> None:
        self.endpoint = link.require_endpoint(endpoint, trusted, files)
        self.world = world
        if clock == "live" and world.period is None:
            raise WorldError(
                f"the world {type(world).__name__} never changes, so that it has no live clock",
                fix=option("Serve it with", "clock", "step", "'step'"),
            )
        with errors_of(world, "reset"):
            world.reset(0)
        self.about = About.of_world(world, name, clock)
        self.late = 0
        self._events: queue.Queue[tuple[str, Any]] = queue.Queue()
        events = self._events
        self._inbox = CommandInbox(
            world.motors, lambda *step: events.put(("step", step)) if clock == "step" else None, world.period
        )
        self._reported_refusals: dict[str, int] = {}
        self._requests: list[tuple[str, Axes]] = []
        self._readings: list[np.ndarray] | None = None
        self._limiter = MotorLimiter(self.about.motors, self.about.rules)
        self._driven: dict[str, np.ndarray] = {}
        self._sequence, self._moment = 0, 0.0
        self._copies = 1
        self._dtype = np.dtype(np.float32)
        self._deferred: Any = None
        self._who = ""
        self._credentials = link.credentials(self.endpoint, trusted, files)
        self._session = link.listen(self.endpoint, self._credentials)
        self._publishers: dict[str, Any] = {}
        self._close = weakref.finalize(self, self._session.close)
        self._declare()

    @property
    def counts(self) -> Counter[str]:
        """Messages by what became of them."""
        return self._inbox.counts

    def serve(self, stopped: Callable[[], bool] = lambda: False) -> None:
        """Serve until `stopped` returns true; it is called at least every 0.1 s."""
        if self.about.clock == "live":
            self._serve_live(stopped)
            return
        while not stopped():
            self._handle(0.1)
            self._tell_refusals()

    def close(self) -> None:
        """Put the motors to rest, close the world, and leave the network."""
        if not self._close.alive:
            return
        try:
            if self.about.clock == "live":
                self._rest()
        finally:
            self._close()
            self.world.close()

    # ------------------------------------------------------------------- what arrives, in threads of Zenoh

    def _declare(self) -> None:
        zenoh, robot = link.library(), self.about.name
        inbox, events, text, credentials = self._inbox, self._events, self.about.to_text(), self._credentials

        def command(sample: Any) -> None:
            inbox.offer(unquote(str(sample.key_expr).rsplit("/", 1)[1]), bytes(sample.payload))

        def end(sample: Any) -> None:
            inbox.end(bytes(sample.payload))

        def halt(sample: Any) -> None:
            inbox.halt(bytes(sample.payload))

        def describe(request: Any) -> None:
            challenge = bytes(request.payload or b"")
            proof = credentials.proof(challenge) if isinstance(credentials, RobotKey) else None
            request.reply(about, text, attachment=proof)

        def query(kind: str) -> Callable[[Any], None]:
            def put(request: Any) -> None:
                if events.qsize() < MOST_WAITING:
                    events.put((kind, request))
                else:
                    request.reply_err("the robot is busy")

            return put

        def gone(sample: Any) -> None:
            number = str(sample.key_expr).rsplit("/", 1)[1]
            if sample.kind == zenoh.SampleKind.DELETE and number == f"{inbox.commander:x}":
                inbox.begin(0)

        session, about = self._session, key(robot, "about")
        self._declared = [
            session.declare_subscriber(key(robot, "motor") + "/*", link.callback(command)),
            session.declare_subscriber(key(robot, "step"), link.callback(end)),
            session.declare_subscriber(key(robot, "halt"), link.callback(halt)),
            session.declare_queryable(about, link.callback(describe)),
            *(session.declare_queryable(key(robot, kind), link.callback(query(kind))) for kind in QUERIES),
            session.liveliness().declare_subscriber(key(robot, "commander") + "/*", link.callback(gone)),
            session.liveliness().declare_token(key(robot, "alive")),
        ]

    # ------------------------------------------------------------------------ what the world does, in turn

    def _handle(self, seconds: float) -> None:
        """Handle the next event, if one comes in time."""
        try:
            kind, event = self._events.get(timeout=max(0.0, seconds))
        except queue.Empty:
            return
        if kind == "step":
            self._step(*event)
            return
        try:
            answer = getattr(self, f"_{kind}")(event)
            if answer is not None:
                event.reply(event.key_expr, answer)
        except (DeodarError, BadMessage) as error:
            event.reply_err(str(error))

    def _begin(self, query: Any) -> str:
        """Accept a commander, and reset a world that waits for it."""
        request = _object(query)
        number, who = request.get("commander"), request.get("who")
        if type(number) is not int or not 0 < number < 2**64 or not isinstance(who, str):
            raise WorldError("a commander states its number and who it is")
        if self._inbox.commander not in (0, number):
            raise WorldError(
                f"the robot {self.about.name!r} is commanded by {self._who}, and by one commander at a time"
            )
        copies = 1
        if self.about.clock == "step":
            trials, seed, precision = (request.get(name) for name in ("trials", "seed", "precision"))
            if not isinstance(trials, list) or not all(type(t) is int for t in trials) or not trials:
                raise WorldError(f"trials is {show(trials)}; expected whole numbers")
            if type(seed) is not int or precision not in ("float32", "float64"):
                raise WorldError("a seed is a whole number, and a precision float32 or float64")
            with errors_of(self.world, "reset"):
                self.world.reset(seed, cast("list[int]", trials), precision)
            copies = len(trials)
            self._sequence = 0
        self._who, self._copies = who[:80], copies
        self._requests, self._readings, self._deferred = [], None, None
        self._limiter.begin(copies)
        self._inbox.begin(number, copies)
        self._reported_refusals = {}
        return codec.line({"clock": self.about.clock})

    def _read(self, query: Any) -> bytes | None:
        """Return readings over any axes, and publish them from now on."""
        request = _object(query)
        if request.get("commander") != self._inbox.commander:
            raise WorldError("only the commander chooses what is read")
        after = request.get("sequence", 0)
        if self.about.clock == "step" and type(after) is int and after > self._sequence:
            self._deferred = query  # its step is on its way
            return None
        requests = requests_from_data(request.get("requests"), self.world.sensors)
        if sum(8 * int(np.prod(shape(axes), dtype=float)) for _, axes in requests) > MOST_BYTES:
            raise WorldError("more is read than a message carries")
        time = real(request.get("time", 0.0))
        if time is None or not math.isfinite(time):
            raise WorldError(f"time is {show(request['time'])}; expected a finite number")
        readings = self._sensed(requests, time)
        if request.get("watch", True):
            self._requests, self._readings = requests, readings
        return bundle(self._messages(requests, readings, time))

    def _keep(self, query: Any) -> bytes:
        """Return the state of the world; the query says whether in the form of older versions."""
        older = bytes(query.payload or b"") == OLDER
        return bundle([WireMessage(_numbers(leaf)) for leaf in jax.tree.leaves(self._state(older))])

    def _state(self, older: bool) -> list[Any]:
        with errors_of(self.world, "keep"):
            world, commands = self.world.keep(), self._limiter.keep()
            if older:
                return [self.world.older_form(world), slowed(commands, self.about.rules)]
            return [world, commands]

    def _put(self, query: Any) -> str:
        """Restore a state that `_keep` returned."""
        if self.about.clock != "step":
            raise WorldError("the state of a live robot cannot be restored")
        leaves = [message.array for message in unbundle(bytes(query.payload or b""))]
        old, form = jax.tree.flatten(self._state(older=False))
        if len(old) != len(leaves):
            old, form = jax.tree.flatten(self._state(older=True))
        if len(old) != len(leaves) or not all(
            isinstance(b, str) or np.shape(b) == a.shape for a, b in zip(leaves, old, strict=True)
        ):
            raise WorldError("is not a state of this robot")
        restored = [_leaf(a, b) for a, b in zip(leaves, old, strict=True)]
        with errors_of(self.world, "put"):
            world, commands = jax.tree.unflatten(form, restored)
            self.world.put(world)
        self._limiter.put(commands)
        self._readings = None
        return ""

    def _step(self, sequence: int, start: float) -> None:
        """Advance by a period with the commands of the period, and publish what was asked for."""
        if sequence != self._sequence + 1:
            self._publish("error", f"period {sequence} follows period {self._sequence}".encode())
            return
        commands = {
            motor: self._limiter.allowed(motor, command.value, self.about.period or 0.0)
            for motor, command in self._inbox.commands(sequence).items()
        }
        after = start + (self.about.period or 0.0)
        try:
            readings = self._advanced(commands, start, after)
        except DeodarError as error:
            self._publish("error", str(error).encode())
            return
        self._sequence = sequence
        self._publish_readings(readings, after)
        if self._deferred is not None:
            query, self._deferred = self._deferred, None
            self._events.put(("read", query))

    def _advanced(
        self, commands: Mapping[str, np.ndarray], start: float, after: float
    ) -> Sequence[np.ndarray]:
        """Advance by a period and return the readings after it, as a session in the same process would."""
        world, requests = self.world, self._requests
        with errors_of(world, "act"):
            if isinstance(world, PureWorld) and world.exchanges:
                readings = world.exchange(commands, requests, self._readings)
                self._readings = readings
                return readings
            world.act(commands, start)
        return self._sensed(requests, after)

    def _sensed(self, requests: Sequence[tuple[str, Axes]], time: float) -> list[np.ndarray]:
        if not requests:
            return []
        with errors_of(self.world, "sense"):
            return self.world.sense_all(requests, time)

    # -------------------------------------------------------------------------------------- the live clock

    def _serve_live(self, stopped: Callable[[], bool]) -> None:
        period = (self.about.period or 0.0) / 1000
        start, due = time.monotonic(), time.monotonic()
        try:
            while not stopped():
                while (wait := due - time.monotonic()) > 0:
                    self._handle(min(wait, 0.1))
                self._live_period(1000 * (due - start))
                due += period
                behind = time.monotonic() - due
                if behind > period:
                    self.late += 1
                    due += behind // period * period
        except DeodarError as error:
            self._publish("error", str(error).encode())
            raise

    def _live_period(self, moment: float) -> None:
        """Advance by a period with the newest commands; a motor without a fresh one is at rest.

        A motor that was never commanded gets no command, as in a run in one process.
        """
        self._sequence += 1
        self._tell_refusals()
        commands: dict[str, np.ndarray] = {}
        newest, clock = self._inbox.commands(), time.monotonic()
        for motor in self.about.motors:
            command, rule = newest.get(motor), self.about.rule(motor)
            if command is not None and 1000 * (clock - command.arrived) <= rule.stops_after:
                commands[motor] = self._limiter.allowed(motor, command.value, self.about.period or 0.0)
                self._driven[motor] = command.value
            elif motor in self._driven:
                commands[motor] = rule.at_rest(self._driven[motor])
                self._limiter.rest(motor)
        self._moment = after = moment + (self.about.period or 0.0)
        self._publish_readings(self._advanced(commands, moment, after), after)

    def _rest(self) -> None:
        """Send the command at rest to all motors that were commanded."""
        self._inbox.begin(0)
        self._live_period(self._moment)

    # --------------------------------------------------------------------------------------- what is sent

    def _publish_readings(self, readings: Sequence[np.ndarray], moment: float) -> None:
        keys = reading_keys(self.about.name, self._requests)
        for where, message in zip(keys, self._messages(self._requests, readings, moment), strict=True):
            self._put_at(where, message.to_bytes())
        done = WireMessage(np.zeros(()), self._sequence, moment, time.monotonic_ns(), self._inbox.stamp)
        self._publish("period", done.to_bytes())

    def _messages(
        self, requests: Sequence[tuple[str, Axes]], readings: Sequence[np.ndarray], moment: float
    ) -> list[WireMessage]:
        """Return the messages of readings; without the axis of copies if there is one copy."""
        stamp, parts = time.monotonic_ns(), len(requests)
        messages: list[WireMessage] = []
        for (sensor, _), reading in zip(requests, readings, strict=True):
            signal = self.world.sensors.get(sensor, Signal(sensor))
            array = np.asarray(reading)
            array = array[0] if signal.each and self._copies == 1 else array
            messages.append(WireMessage(array, self._sequence, moment, stamp, self._inbox.stamp, parts=parts))
        return messages

    def _tell_refusals(self) -> None:
        """Tell the model how many messages were refused, if there are more than before."""
        refusals = self._inbox.refusals()
        if refusals != self._reported_refusals:
            self._reported_refusals = refusals
            self._publish("refused", codec.line({**refusals}).encode())

    def _publish(self, part: str, raw: bytes) -> None:
        self._put_at(key(self.about.name, part), raw)

    def _put_at(self, where: str, raw: bytes) -> None:
        if where not in self._publishers:
            control = link.library().CongestionControl
            waits = self.about.clock == "step"
            self._publishers[where] = self._session.declare_publisher(
                where, congestion_control=control.BLOCK if waits else control.DROP
            )
        self._publishers[where].put(raw)


def _numbers(leaf: Any) -> np.ndarray:
    """Return a part of a state as an array; text as its bytes in UTF-8."""
    return np.frombuffer(leaf.encode(), np.uint8) if isinstance(leaf, str) else np.asarray(leaf)


def _leaf(numbers: np.ndarray, template: Any) -> Any:
    """Return a part of a state from its array, of the type that it had."""
    if isinstance(template, str):
        try:
            return numbers.astype(np.uint8).tobytes().decode()
        except UnicodeDecodeError:
            raise WorldError("is not a state of this robot") from None
    return (
        numbers
        if isinstance(template, (np.ndarray, np.generic, jax.Array))
        else type(template)(numbers.item())
    )


def free_name(world: World) -> str:
    """Return the name of a robot that states none: that of its file or model, else the kind of its world and
    the number of this process.
    """
    stated = getattr(getattr(world, "file", world), "name", "")
    return stated if isinstance(stated, str) and stated else f"{type(world).__name__.lower()}-{os.getpid()}"


def _object(query: Any) -> dict[str, Any]:
    """Return the object that a query holds."""
    content = codec.read(bytes(query.payload or b""))
    if not isinstance(content, dict):
        raise WorldError("a query holds an object")
    return cast("dict[str, Any]", content)
