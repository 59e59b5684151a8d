"""An event camera on a pan-tilt unit, in front of a screen with a blinking target."""

from __future__ import annotations

import dataclasses as dc
import math
from collections.abc import Hashable, Iterator, Mapping, Sequence
from typing import Any

import jax.numpy as jnp
import numpy as np
from jax import Array, lax

from deodar.codec import JsonObject
from deodar.element import Arrays
from deodar.errors import Problem, WorldError, instance_of
from deodar.numerics.axes import Axes, Axis
from deodar.numerics.copies import any_copy
from deodar.numerics.pytree import PyTree
from deodar.parameters import show
from deodar.registry import register
from deodar.worlds._base import Signal
from deodar.worlds._pure import PureWorld
from deodar.worlds._scene import Mark, Scene, SceneBody
from deodar.worlds._settings import arguments, finite_rows, number, of, parse_argument
from deodar_robots.eye.event_camera import EventCamera, EventPicture, rate
from deodar_robots.eye.pan_tilt import CENTRE, PIXELS, PanTilt
from deodar_robots.eye.screen import EyeScreen, drawn, headings, luminance

LOWEST, HIGHEST = 0.0, 2000.0
"""Positions of the servo motors at their limits, as in the paper."""

MIDDLE = (LOWEST + HIGHEST) / 2

STILL = 0.2
"""Movement of the picture in a period, pixels, below which the camera counts as still."""

MOVES = 1.0
"""Movement of the picture in a period, pixels, above which the camera has made a gaze."""

CENTRED, CENTRED_FOR, LOST_FOR, LONGEST, RESTED = 12.0, 500.0, 300.0, 4000.0, 400.0
"""When the screen shows a new target: within 12 pixels of the centre for 500 ms, out of sight for 300 ms,
after 4 s, or once the camera has moved and then rested for 400 ms. These are guesses: in the paper a person
moves the target.
"""

PAN_TILT, SCREEN = PanTilt(), EyeScreen()

TARGET, RIVAL = "target", "rival"
EVENTS = {"events": ("on", "off"), "on": ("on",), "off": ("off",)}


@register
class Eye(PureWorld):
    r"""An event camera of 128 x 128 pixels on a pan-tilt unit, in front of a screen.

    On the screen a disc, the target, blinks; a second one, the rival, may blink with it, with a contrast of
    its own. Distractors are further discs. Each servo motor approaches the
    position that its motor signal commands; a signal of exactly 0 is no signal, as is that of a motor that no
    element drives, and leaves it where it is. A direction d relative to the axis of the camera appears on the
    retina rotated by the roll R, with a gain that grows with its distance. After a gaze the screen shows the
    target at another place, uniform over the retina where the screen permits.

    Equation:
        \mathrm{lag}\, \frac{dq}{dt} = \mathrm{command} - q
        \mathrm{place} = 63.5 + \mathrm{gain} \left(1 + \mathrm{curvature}\, \frac{|d|^2}{400^2}\right) R d,
            \quad d = \mathrm{target} - q

    Parameters:
        camera: the pixels, an `EventCamera` (`deodar_robots.eye.event_camera`).
        pan_tilt: the pan-tilt unit.
        screen: the screen.
        first: column and row of the first target on the retina, or a row for each trial; None: random.
        rival: column and row of the rival on the retina at the start, and its contrast; or a row for each
            trial; None: there is none. Its direction does not change.
        pose: pan and tilt at the start, or a row for each trial.
        period: ms between two exchanges with the model.

    Shapes:
        `events`, `on` and `off` are sampled over two axes in pixels, columns and rows, which grow with the
        pan and the tilt of the target: the rate over the cell of each sample in the last period, per pixel
        and second. `pose` and `target` have two samples.

    Reference:
        Sandamirskaya (2014), Front. Neurosci. 7:276, section 3.1 (the camera, the unit, its range from 0 to
        2000 and the task). Gain, curvature, roll, lag and the timing of targets are not printed there; they
        are deodar's.
    """

    sensors: Mapping[str, Signal] = {
        "events": Signal("rate of all events over columns and rows of the retina", unit="1/s", each=True),
        "on": Signal("rate of the events of brighter pixels", unit="1/s", each=True),
        "off": Signal("rate of the events of darker pixels", unit="1/s", each=True),
        "pose": Signal("pan and tilt", (2,), "servo", each=True, bounds=((LOWEST, HIGHEST),) * 2),
        "target": Signal("true column and row of the target, for records and figures", (2,), "px", each=True),
        "shown": Signal("number of targets that the screen has shown", (), each=True),
    }
    motors: Mapping[str, Signal] = {
        "pan": Signal("commanded position of the pan servo, 0 to 2000", (), "servo", each=True),
        "tilt": Signal("commanded position of the tilt servo, 0 to 2000", (), "servo", each=True),
    }
    noises = ("pixels", "screen")

    def __init__(
        self,
        camera: EventCamera | None = None,
        pan_tilt: PanTilt = PAN_TILT,
        screen: EyeScreen = SCREEN,
        first: Sequence[float] | Sequence[Sequence[float]] | np.ndarray | None = None,
        rival: Sequence[float] | Sequence[Sequence[float]] | np.ndarray | None = None,
        pose: Sequence[float] | Sequence[Sequence[float]] | np.ndarray = (MIDDLE, MIDDLE),
        period: float = 10.0,
    ) -> None:
        self.camera = EventCamera() if camera is None else instance_of(EventCamera, camera, "camera")
        self.pan_tilt = instance_of(PanTilt, pan_tilt, "pan_tilt")
        self.screen = instance_of(EyeScreen, screen, "screen")
        self.period = self.step = number("period", period, above=0.0)
        self.first = None if first is None else _rows("first", first, 0.0, PIXELS - 1.0)
        self.rival = None if rival is None else finite_rows(RIVAL, rival, 3)
        if self.rival is not None:
            _within(RIVAL, self.rival[:, :2], 0.0, PIXELS - 1.0)
        self.poses = _rows("pose", pose, LOWEST, HIGHEST)
        self.carried, self.carries = np.full(2, MIDDLE), 0
        self._picture = EventPicture(PIXELS)

    # ------------------------------------------------------------------------------------------------- arrays

    def shared(self) -> dict[str, np.ndarray]:
        return {"carried": self.carried, "carries": np.asarray(self.carries, np.int32)}

    def own(self, trials: Sequence[int]) -> dict[str, np.ndarray]:
        first = np.full((1, 2), np.nan) if self.first is None else self.first
        found = {"pose": of(trials, self.poses, "pose"), "first": of(trials, first, "first")}
        return found if self.rival is None else {**found, RIVAL: of(trials, self.rival, RIVAL)}

    def structure(self) -> Hashable:
        return self.camera, self.pan_tilt, self.screen, self.rival is None, self.period

    # ----------------------------------------------------------------------------------------------- one copy

    def start(self, shared: Arrays, own: PyTree) -> PyTree:
        pose = own["pose"]
        zero, tick = jnp.zeros((), pose.dtype), jnp.uint32(0)
        state = {
            "tick": tick,
            "pose": pose,
            "objects": jnp.broadcast_to(pose, (1 + self.screen.distractors, 2)),
            "velocities": jnp.zeros((1 + self.screen.distractors, 2), pose.dtype),
            "shown": zero,
            "centred": zero,
            "lost": zero,
            "age": zero,
            "rest": zero,
            "moved": zero,
            "carries": shared["carries"],
        }
        if self.screen.wait == 0:
            state = self._show(own, state, tick)
        dark = self._luminance(own, state, jnp.zeros((), bool))
        return {**state, **self.camera.start(dark, own["keys"]["pixels"])}

    def advance(self, shared: Arrays, own: PyTree, state: PyTree, motors: Arrays) -> PyTree:
        tick = state["tick"] + jnp.uint32(1)
        given = jnp.stack([motors["pan"], motors["tilt"]])
        command = jnp.where(given == 0, state["pose"], jnp.clip(given, LOWEST, HIGHEST))
        share = 1.0 if self.pan_tilt.lag == 0 else 1 - math.exp(-self.step / self.pan_tilt.lag)
        pose = state["pose"] + share * (command - state["pose"])
        moved = jnp.sum(jnp.abs(pose - state["pose"])) * self.pan_tilt.gain
        objects = state["objects"] + self.step * state["velocities"]
        # objects turn back at the border of the screen
        outward = (objects - MIDDLE) * state["velocities"] > 0
        turned = outward & (jnp.abs(objects - MIDDLE) > self.screen.reach)
        new = {
            **state,
            "tick": tick,
            "pose": pose,
            "objects": objects,
            "velocities": jnp.where(turned, -state["velocities"], state["velocities"]),
        }
        carried = shared["carries"] != state["carries"]
        new["objects"] = new["objects"].at[0].set(jnp.where(carried, shared["carried"], new["objects"][0]))
        new["carries"] = shared["carries"]
        new = self._timed(new, moved)
        due = self._due(new, tick)
        new = lax.cond(any_copy(due), lambda: _where(due, self._show(own, new, tick), new), lambda: new)
        luminance = self._luminance(own, new, self._lit(tick))
        pixels = self.camera.expose(new, luminance, self.step, own["keys"]["pixels"], tick + 1)
        return {**new, **pixels}

    def read(self, shared: Arrays, own: PyTree, state: PyTree, sensor: str, axes: Axes) -> Array:
        if sensor in EVENTS:
            return rate(jnp.sum(jnp.stack([state[name] for name in EVENTS[sensor]]), axis=0), axes, self.step)
        if sensor == "target":
            return self.pan_tilt.to_retina(state["objects"][0] - state["pose"])
        return state["pose"] if sensor == "pose" else state["shown"]

    def _luminance(self, own: PyTree, state: PyTree, lit: Array) -> Array:
        """Return the log luminance of the retina; the target and the rival are lit or dark, distractors are
        always lit.
        """
        directions, dtype = state["objects"], state["pose"].dtype
        on = jnp.ones(1 + self.screen.distractors, dtype).at[0].set(lit.astype(dtype)) * (state["shown"] > 0)
        bright = on * (jnp.exp(jnp.asarray(self.screen.contrast, dtype)) - 1)
        if self.rival is not None:
            directions = jnp.concatenate([directions, self._rival(own)[None]])
            bright = jnp.append(bright, on[0] * (jnp.exp(own[RIVAL][2]) - 1))
        places = self.pan_tilt.to_retina(directions - state["pose"])
        return luminance(places, bright, self.screen.radius, dtype)

    def _rival(self, own: PyTree) -> Array:
        """Return the direction of the rival, pan and tilt."""
        return own["pose"] + self.pan_tilt.to_direction(own[RIVAL][:2])

    def _lit(self, tick: Array) -> Array:
        half = max(1, round(self.screen.blink / self.step))
        return (tick // jnp.uint32(half)) % jnp.uint32(2) == 1

    def _timed(self, state: PyTree, moved: Array) -> PyTree:
        """Count how long the target has been centred, lost and shown, and how long the camera has rested."""
        place = self.pan_tilt.to_retina(state["objects"][0] - state["pose"])
        still = moved < STILL
        centred = (jnp.linalg.norm(place - CENTRE) <= CENTRED) & still
        lost = jnp.any((place < 0) | (place > PIXELS - 1))

        def counted(name: str, condition: Array) -> Array:
            return jnp.where(condition, state[name] + self.step, 0.0)

        return {
            **state,
            "centred": counted("centred", centred),
            "lost": counted("lost", lost),
            "age": state["age"] + self.step,
            "rest": counted("rest", still),
            "moved": jnp.where(moved > MOVES, 1.0, state["moved"]),
        }

    def _due(self, state: PyTree, tick: Array) -> Array:
        """Return whether the screen shows a new target now."""
        begins = (state["shown"] == 0) & (tick >= round(self.screen.wait / self.step))
        if not self.screen.endless:
            return begins
        over = (state["centred"] >= CENTRED_FOR) | (state["lost"] >= LOST_FOR) | (state["age"] >= LONGEST)
        return begins | (state["shown"] > 0) & (over | (state["moved"] > 0) & (state["rest"] >= RESTED))

    def _show(self, own: PyTree, state: PyTree, tick: Array) -> PyTree:
        """Show the target, and the distractors, at new places."""
        key, pose, dtype = own["keys"]["screen"], state["pose"], state["pose"].dtype
        blocks = tick * jnp.uint32(1 + self.screen.distractors) + jnp.arange(
            1 + self.screen.distractors, dtype=jnp.uint32
        )
        places = jnp.stack(
            [drawn(self.pan_tilt, pose, MIDDLE, self.screen.reach, 6.0, key, block) for block in blocks]
        )
        given = (state["shown"] == 0) & ~jnp.isnan(own["first"][0])
        first = pose + self.pan_tilt.to_direction(jnp.nan_to_num(own["first"]))
        speeds = jnp.asarray([self.screen.speed] + [self.screen.drift] * self.screen.distractors, dtype)[
            :, None
        ]
        zero = jnp.zeros((), dtype)
        return {
            **state,
            "objects": places.at[0].set(jnp.where(given, first, places[0])),
            "velocities": speeds * headings(1 + self.screen.distractors, 1.0, key, tick, dtype),
            "shown": state["shown"] + 1,
            "centred": zero,
            "lost": zero,
            "age": zero,
            "moved": zero,
        }

    # -------------------------------------------------------------------------------------------- the outside

    def reset(self, seed: int, trials: Sequence[int] = (0,), precision: str = "float32") -> None:
        super().reset(seed, trials, precision)
        self._picture.clear()

    def passed(self) -> None:
        state = self._now()
        on, off = (np.asarray(state[name])[0] for name in ("on", "off"))
        self._picture.add(on, off, self.step)

    def move(self, name: str, center: Sequence[float]) -> None:
        """Move the target of all copies; `center` is its new direction, pan and tilt in servo units."""
        if name != TARGET:
            raise WorldError("nothing here is called so", where=name, fix=f"It can move the {TARGET!r}")
        self.carried, self.carries = _rows(name, center, LOWEST, HIGHEST)[0], self.carries + 1

    def arrangement(self) -> Any:
        """Return where `move` has put the target, for `arrange`."""
        return {"carried": self.carried.tolist(), "carries": self.carries}

    def arrange(self, kept: Any) -> None:
        """Restore what `arrangement` returned."""
        self.carried, self.carries = np.asarray(kept["carried"], float), int(kept["carries"])

    def scene(self) -> Scene:
        """Return the directions that the servo motors reach, with the target, distractors and the gaze; its
        picture has the events of the first copy.
        """
        border = (LOWEST, LOWEST, HIGHEST, HIGHEST)
        if not hasattr(self, "_state"):
            return Scene("servo", border)
        state = self._now()
        objects, pose = np.asarray(state["objects"], float)[0], np.asarray(state["pose"], float)[0]
        marks = [Mark(TARGET, (float(objects[0, 0]), float(objects[0, 1])))]
        if self.rival is not None:
            x, y = np.asarray(self._rival(self.own_values(self._trials[0])), float)
            marks.append(Mark(RIVAL, (float(x), float(y)), True))
        marks += [Mark(f"distractor {k}", (float(x), float(y)), True) for k, (x, y) in enumerate(objects[1:])]
        shown = tuple(marks) if float(np.asarray(state["shown"])[0]) > 0 else ()
        gaze = SceneBody("gaze", (float(pose[0]), float(pose[1])), 0.0, CENTRED / self.pan_tilt.gain)
        return Scene("servo", border, (), shown, (gaze,), picture=self._picture.scene())

    def validate_axes(self, sensor: str, axes: Axes) -> Iterator[Problem]:
        if sensor not in EVENTS:
            return
        if len(axes) != 2:
            yield Problem(sensor, f"has two axes, columns and rows; the model gives it {len(axes)}")
            return
        for axis in axes:
            if axis.points[-1] < 0 or axis.points[0] > PIXELS - 1:
                yield Problem(
                    sensor, f"the axis {axis.name!r} lies outside of the retina, 0 to {PIXELS - 1} px"
                )

    def describe(self) -> JsonObject:
        camera = self.camera
        return {
            "world": "Eye",
            **dc.asdict(self.pan_tilt),
            **dc.asdict(self.screen),
            "period": self.period,
            "first": None if self.first is None else self.first.tolist(),
            RIVAL: None if self.rival is None else self.rival.tolist(),
            "pose": self.poses.tolist(),
            "camera": {f.name: getattr(camera, f.name) for f in dc.fields(camera)},
        }

    @classmethod
    def open(cls, argument: str) -> Eye:
        _, settings = parse_argument(cls, f",{argument}" if argument else "")
        return cls(**settings)

    @classmethod
    def again(cls, described: Mapping[str, Any]) -> Eye:
        said = {name: value for name, value in described.items() if name not in ("world", "camera")}
        return cls(EventCamera(**described["camera"]), **arguments(cls, said))

    @classmethod
    def example(cls) -> Eye:
        return cls()

    @staticmethod
    def example_axes(sensor: str) -> Axes:
        if sensor in EVENTS:
            return Axis("column", 1.5, 125.5, 32), Axis("row", 1.5, 125.5, 32)
        return () if sensor == "shown" else (Axis("component", 0, 1, 2),)


def _rows(name: str, given: Any, low: float, high: float) -> np.ndarray:
    """Return rows of two numbers between two limits, or raise WorldError."""
    found = finite_rows(name, given, 2)
    _within(name, found, low, high)
    return found


def _within(name: str, given: np.ndarray, low: float, high: float) -> None:
    """Refuse rows with a number beyond two limits."""
    beyond = ((given < low) | (given > high)).any(1)
    if beyond.any():
        row = given[beyond.argmax()].tolist()
        raise WorldError(f"has the row {show(row)}; expected numbers from {low:g} to {high:g}", where=name)


def _where(condition: Array, one: PyTree, other: PyTree) -> PyTree:
    return {name: jnp.where(condition, one[name], other[name]) for name in other}
