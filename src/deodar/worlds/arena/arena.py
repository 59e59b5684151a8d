"""An arena with a vehicle in it."""

from __future__ import annotations

import copy
import dataclasses as dc
import functools
import hashlib
import math
from collections.abc import Hashable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, TypedDict

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array
from jax.typing import DTypeLike

from deodar import codec
from deodar.codec import JsonObject
from deodar.element import Arrays
from deodar.errors import Problem, WorldError, instance_of, reading
from deodar.numerics.axes import Axes, Axis
from deodar.numerics.noise import normal
from deodar.parameters import show
from deodar.registry import register
from deodar.worlds._base import Signal
from deodar.worlds._pure import PureWorld
from deodar.worlds._scene import Mark, Scene, SceneBody, SceneBox
from deodar.worlds._settings import arguments, of, parse_argument
from deodar.worlds.arena.arena_layout import UNITS, ArenaObject, LayoutSource, builtin, load_each
from deodar.worlds.arena.arena_settings import NOISE, PHYSICS, PICTURE_NOISES, ArenaNoise, ArenaPhysics
from deodar.worlds.arena.color_camera import PictureNoise, picture, picture_rays, surfaces
from deodar.worlds.arena.contact import move
from deodar.worlds.arena.epuck import EPUCK
from deodar.worlds.arena.infrared import distances, readings
from deodar.worlds.arena.objects import ArenaObjects, made
from deodar.worlds.arena.overlaps import BlockCheck
from deodar.worlds.arena.starts_and_goals import Places, Room, rows_of
from deodar.worlds.arena.vehicle import Vehicle, drive, limited, wrapped
from deodar.worlds.arena.vehicles import VEHICLES, vehicle_of
from deodar.worlds.arena.view import coloured, judge_plane, require_plane, sides

Numbers = Sequence[float] | Sequence[Sequence[float]] | np.ndarray
"""A value of some numbers, or a row of them for each trial."""

BODY_NOISES = ("infrared", "place", "slip", "encoders")
GOAL = "goal"
CUSTOM = "custom"
"""What records state as the vehicle's name if it is none of those that come with deodar."""

LATER = {"camera_every": 1, **dict.fromkeys(PICTURE_NOISES, 0.0)}
"""Settings of later versions with their defaults, which records leave out."""

WRAP = 2.0**15
"""Encoders count from -WRAP to WRAP and then wrap around, like those of the e-puck (16 bits)."""


def signals(
    vehicle: Vehicle,
    unit: str,
    goal: bool,
    frame: float | None = None,
    border: Sequence[float] | None = None,
) -> dict[str, Signal]:
    """Return the signals of a vehicle's sensors in an arena.

    Args:
        vehicle: the vehicle.
        unit: unit of lengths.
        goal: whether the arena has a goal.
        frame: period of the camera in ms, if it has one of its own.
        border: lower x, lower y, upper x and upper y, in `unit`, if they are known.
    """
    plane = None if border is None else ((border[0], border[2]), (border[1], border[3]))
    out = {
        "infrared": Signal(
            vehicle.infrared.meaning, (vehicle.infrared.count,), vehicle.infrared.unit, each=True
        ),
        "place": Signal("x and y of the vehicle, with noise", (2,), unit, each=True, bounds=plane),
        "heading": Signal("heading; 0 along x, counter-clockwise", (), "rad", each=True),
        "pose": Signal(
            "true x, y and heading, for records and figures",
            (3,),
            f"{unit}, {unit}, rad",
            each=True,
            bounds=None if plane is None else (*plane, (-math.pi, math.pi)),
        ),
        "encoders": Signal("motor steps counted by the left and the right wheel", (2,), "step", each=True),
        "touching": Signal("1 while it touches something, else 0", (), each=True),
        "obstacles": Signal(
            "over two dimensions: the share of a sample's cell that an object covers, or that lies outside",
            each=True,
        ),
        "above": Signal(
            "the arena from above without the vehicle; the last axis is red, green, blue", each=True
        ),
    }
    if vehicle.camera is not None:
        out |= {
            "camera": Signal(
                "picture of the camera: columns from the left, rows from the top, and red, green, blue",
                period=frame,
                each=True,
            ),
            "line": Signal("one row of that picture, at the height of the camera", period=frame, each=True),
        }
    goals = {"goal": Signal("x and y of the goal", (2,), unit, each=True, bounds=plane)}
    return out | goals if goal else out


class ArenaCopy(TypedDict):
    """Arrays of one copy of an arena, as its functions read them."""

    start: Array
    goal: Array
    boxes: Array
    colours: Array
    heights: Array
    windows: Array
    carried: Array
    carries: Array
    keys: Arrays


@register
class Arena(PureWorld):
    r"""A vehicle with two wheels among walls, boxes and coloured blocks, seen from above.

    In a period the axle moves on a circle, whose turn and path follow from the steps of both wheels. The body
    is a disc; it slides along what it touches, or sticks to it, and never passes through it, however long the
    period. d_i is the distance along one infrared ray, T and N are tables of the vehicle. The place sensor
    has a new reading every `place_every` periods (`physics`) and keeps it in between.

    Equation:
        \mathrm{turn} = \frac{\mathrm{right} - \mathrm{left}}{\mathrm{axle}},\quad \mathrm{path} =
            \frac{\mathrm{left} + \mathrm{right}}{2}
        \mathrm{infrared}_i = T\!\left(\frac{d_i}{\mathrm{reflection}}\right) \left(1 +
            N\!\left(\frac{d_i}{\mathrm{reflection}}\right) \xi_i\right)
        \mathrm{place} = \text{true place} + \mathrm{place\_noise}\, \xi

    Parameters:
        layout: name of an arena that comes with deodar (blocks, large, search, z), a JSON file, FILE#NAME for
            one arena of a file with several, or a dictionary; or a list of these, one for each trial, with
            the same border.
        start: x, y and heading (rad), or a row of these for each trial; None: that of the layout, else the
            free place nearest the middle.
        goal: x and y, or a row for each trial; None: that of the layout.
        unit: unit of all lengths in arguments and readings: m, cm or mm.
        vehicle: `e-puck` or `khepera`, or a `Vehicle` of your own (`deodar.worlds.arena.vehicle`), which
            records do not contain.
        physics: time and surfaces.
        noise: noise of the sensors and wheels.

    Shapes:
        `infrared` has one sample for each sensor, `place` and `goal` two, `pose` three; `obstacles` and
        `above` are sampled over the model's axes; x is the axis named x, else the first. `camera` has the
        axes columns, rows and channel (red, green, blue), `line` columns and channel: they may have any
        number of samples and show the whole field of view. Values are 0 to 1. For a file with the
        plane x,z (y up), x is the file's -z, y is the file's -x, and heading 0 points along the file's -z.

    Reference:
        Billing, Lowe & Sandamirskaya (2015), Adapt. Behav. 23(5), section 4 and its published simulator;
        Mondada et al. (2009), the e-puck.
    """

    sensors: Mapping[str, Signal] = signals(EPUCK, "m", True)
    motors: Mapping[str, Signal] = {
        "left": Signal("speed of the left wheel", (), "step/s", each=True),
        "right": Signal("speed of the right wheel", (), "step/s", each=True),
    }
    opens = (".json",)
    noises = (*BODY_NOISES, "pixels", "hues", "clutter")

    def __init__(
        self,
        layout: LayoutSource | Sequence[LayoutSource] = "blocks",
        start: Sequence[float] | np.ndarray | None = None,
        goal: Sequence[float] | np.ndarray | None = None,
        unit: str = "m",
        vehicle: str | Vehicle = EPUCK.name,
        physics: ArenaPhysics = PHYSICS,
        noise: ArenaNoise = NOISE,
    ) -> None:
        self.layouts = load_each(layout)
        self.layout = self.layouts[0]
        if unit not in UNITS:
            raise WorldError(f"unit is {show(unit)}; expected one of {', '.join(UNITS)}")
        self.unit, self.scale = unit, UNITS[unit]
        self.vehicle = vehicle_of(vehicle)
        self.physics = instance_of(ArenaPhysics, physics, "physics")
        self.noise = instance_of(ArenaNoise, noise, "noise")
        self.period = physics.period
        self.source = str(layout) if isinstance(layout, (str, Path)) else ""
        self.objects = ArenaObjects(self.layouts, physics.period)
        self.places = Places(self.layout.border, unit, self.scale, self.source)
        self.goals = self._goals() if goal is None else rows_of("goal", goal, [self.scale] * 2)
        self.starts = self._settled(
            [layout.start for layout in self.layouts]
            if start is None
            else list(rows_of("start", start, [self.scale, self.scale, 1.0]))
        )
        frame = physics.camera_every * physics.period if physics.camera_every > 1 else None
        border = [v / self.scale for v in self.layout.border]
        self.carried, self.carries = np.zeros((1, 3)), 0
        self.sensors = signals(self.vehicle, unit, self.goals is not None, frame, border)

    # ------------------------------------------------------------------------- objects, also changed in a run

    def place(
        self,
        name: str,
        center: Numbers,
        size: Numbers,
        color: Numbers = (0.72, 0.53, 0.3),
        windows: Numbers | None = None,
        height: float | Sequence[float] | np.ndarray | None = None,
    ) -> None:
        """Add an object to the arena from the next period on, or replace the one of the same name.

        Each argument except the name is one value for all trials, or a row for each trial.

        Args:
            name: name of the object.
            center: x and y of its middle.
            size: size along x and y.
            color: red, green and blue, 0 to 1.
            windows: (start, stop) in ms of the run's time between which the object is present; None: from now
                on. An object that appears several times is several objects.
            height: height of the object; None: that of the walls of the border.
        """
        rows = made(name, center, size, color, self.scale, height)
        self.places.require_near(name, [row.center for row in rows])
        self.objects.place(rows, windows)

    def move(self, name: str, center: Numbers) -> None:
        """Move an object; `center` is the new x and y of its middle, or a row for each trial.

        The name `goal` moves the goal, and that of the vehicle carries the vehicle, unless an object has that
        name; a third number is the new heading of the vehicle (rad).
        """
        if name == self.vehicle.name and name not in self.objects.names():
            self.carry(center)
        elif name == GOAL and self.goals is not None and name not in self.objects.names():
            self.aim(center)
        else:
            rows = made(name, center, (1, 1), (0, 0, 0), self.scale)
            self.places.require_near(name, [row.center for row in rows])
            self.objects.move(name, center, self.scale)

    def carry(self, pose: Numbers) -> None:
        """Carry the vehicle of all copies to x and y, and turn it to a heading (rad) if there is a third
        number; a row for each trial carries each to its own place. It is there after the next period.

        Raises:
            WorldError: a place is inside an object or outside the arena.
        """
        count = np.atleast_2d(np.asarray(pose, float)).shape[1]
        rows = rows_of(self.vehicle.name, pose, [self.scale, self.scale, 1.0][: max(2, count)])
        problems = self.places.misplaced(rows, self.vehicle.name, self.vehicle.radius, self._permanent())
        if problems:
            raise WorldError(problems)
        turned = rows if rows.shape[1] == 3 else np.column_stack([rows, np.full(len(rows), np.nan)])
        self.carried, self.carries = turned, self.carries + 1

    def remove(self, name: str) -> None:
        """Remove an object."""
        self.objects.remove(name)

    def aim(self, goal: Numbers) -> None:
        """Move the goal of all copies to x and y, or of each trial to its own row.

        Raises:
            WorldError: the position is inside an object or outside the arena, or the arena has no goal.
        """
        if self.goals is None:
            raise WorldError("the arena has no goal to move", fix="Give it one: Arena(..., goal=(x, y))")
        goals = rows_of("goal", goal, [self.scale] * 2)
        problems = self.places.misplaced(goals, "goal", 0.0, self._permanent())
        if problems:
            raise WorldError(problems)
        self.goals = goals

    def for_trial(self, trial: int) -> Arena:
        new = copy.copy(self)
        new.objects = self.objects.for_trial(trial)
        new.starts = of([trial], self.starts, "start")
        new.goals = None if self.goals is None else of([trial], self.goals, "goal")
        new.carried = of([trial], self.carried, "places to carry the vehicle to")
        return new

    def arrangement(self) -> Any:
        """Return the present objects and goals, which may change during a run, for `arrange`."""
        return {
            "objects": self.objects.to_slots(),
            "goals": None if self.goals is None else self.goals.tolist(),
        }

    def arrange(self, kept: Any) -> None:
        """Restore objects and goals that `arrangement` returned."""
        self.objects.restore(kept["objects"])
        self.goals = None if kept["goals"] is None else np.asarray(kept["goals"], float)

    def scene(self) -> Scene:
        """Return the arena from above, in its unit.

        The scene has the objects that are present for the first copy, the goals and, after `reset`, the
        vehicle of each copy.
        """
        state, trials = (self._now(), self._trials) if hasattr(self, "_state") else (None, (0,))
        period = 0 if state is None else int(np.asarray(state["tick"])[0])
        scale, k = self.scale, trials[0]
        present = self.objects.present(period, k)
        boxes = tuple(
            SceneBox(
                t.name,
                (t.center[0] / scale, t.center[1] / scale),
                (t.size[0] / scale, t.size[1] / scale),
                t.color,
            )
            for t in present
        )
        goals = () if self.goals is None else tuple((float(x), float(y)) for x, y in self.goals / scale)
        marks = tuple(
            Mark(GOAL if len(goals) == 1 else f"{GOAL} {n}", goal, len(goals) > 1)
            for n, goal in enumerate(goals)
        )
        bodies: list[SceneBody] = []
        if state is not None:
            places, headings, name = (
                np.asarray(state["position"]) / scale,
                np.asarray(state["heading"]),
                self.vehicle.name,
            )
            for n, trial in enumerate(trials):
                called = name if len(trials) == 1 else f"{name} {trial}"
                bodies.append(
                    SceneBody(
                        called,
                        (float(places[n, 0]), float(places[n, 1])),
                        float(headings[n]),
                        self.vehicle.radius / scale,
                    )
                )
        border = self.layout.border
        return Scene(
            self.unit,
            (border[0] / scale, border[1] / scale, border[2] / scale, border[3] / scale),
            boxes,
            marks,
            tuple(bodies),
        )

    # ------------------------------------------------------------------------------------------------- arrays

    def shared(self) -> dict[str, np.ndarray]:
        settings = {"reflection": self.physics.reflection, **dc.asdict(self.noise)}
        return {name: np.asarray(value) for name, value in settings.items()}

    def own(self, trials: Sequence[int]) -> dict[str, np.ndarray]:
        goals = np.zeros((1, 2)) if self.goals is None else self.goals
        return {
            "start": of(trials, self.starts, "start"),
            "goal": of(trials, goals, "goal"),
            "boxes": self.objects.boxes(trials),
            "colours": self.objects.colours(trials),
            "heights": self.objects.heights(trials),
            "windows": self.objects.times(trials),
            "carried": of(trials, self.carried, "places to carry the vehicle to"),
            "carries": np.full(len(trials), self.carries, np.int32),
        }

    def structure(self) -> Hashable:
        return (
            self.vehicle,
            dc.replace(self.physics, reflection=1.0),
            self.noise.in_pictures,
            self.scale,
            self.objects.room,
            self.goals is not None,
        )

    # ----------------------------------------------------------------------------------------------- one copy

    def start(self, shared: Arrays, own: ArenaCopy) -> Arrays:
        zero = jnp.zeros((), own["boxes"].dtype)
        state = {
            "position": own["start"][:2],
            "heading": wrapped(own["start"][2]),
            "encoders": jnp.stack([zero, zero]),
            "touching": zero,
            "carries": own["carries"],
        }
        if self.physics.camera_every > 1:
            state["frame"] = own["start"].at[2].set(state["heading"])
        tick = jnp.uint32(0)
        return self._sensed(shared, own, state, tick, self._deviates(own, tick, zero.dtype), own["start"][:2])

    def advance(self, shared: Arrays, own: ArenaCopy, state: Arrays, motors: Arrays) -> Arrays:
        boxes, tick = own["boxes"], state["tick"] + jnp.uint32(1)
        deviates = self._deviates(own, tick, boxes.dtype)
        ordered = limited(self.vehicle, motors["left"], motors["right"]) * (self.physics.period / 1000)
        rolled = ordered * (1 + shared["slip"] * deviates["slip"][:2])
        step, turn = drive(self.vehicle, state["heading"], rolled)
        position, touched = move(
            state["position"],
            step,
            boxes,
            _there(own, state["tick"]),
            self.vehicle.radius,
            self.physics.contact == "stick",
        )
        counted = state["encoders"] + rolled * (1 + shared["encoder_noise"] * deviates["encoders"][:2])
        carried, x_y, angle = own["carries"] != state["carries"], own["carried"][:2], own["carried"][2]
        position = jnp.where(carried, x_y, position)
        turned = wrapped(jnp.where(carried & ~jnp.isnan(angle), angle, state["heading"] + turn))
        new = {
            "position": position,
            "heading": turned,
            "encoders": counted - 2 * WRAP * jnp.round(counted / (2 * WRAP)),
            "touching": jnp.asarray(touched, boxes.dtype),
            "carries": own["carries"],
        }
        if self.physics.camera_every > 1:
            pose = jnp.concatenate([position, new["heading"][None]])
            new["frame"] = jnp.where(self._is_frame(tick), pose, state["frame"])
        return self._sensed(shared, own, new, tick, deviates, state["place"])

    def _deviates(self, own: ArenaCopy, tick: Array, dtype: DTypeLike) -> Arrays:
        """Draw the standard normal deviates of a period for each noise.

        Every noise gets the number that the largest one needs, because one graph for all compiles faster.
        """
        keys = jnp.stack([own["keys"][name] for name in BODY_NOISES])
        drawn = jax.vmap(lambda key: normal((max(2, self.vehicle.infrared.count),), key, tick, dtype))(keys)
        return dict(zip(BODY_NOISES, drawn, strict=True))

    def _sensed(
        self, shared: Arrays, own: ArenaCopy, body: Arrays, tick: Array, deviates: Arrays, held: Array
    ) -> Arrays:
        """Add the readings of the noisy sensors to the state, so that one period has one reading."""
        seen = distances(
            self.vehicle.infrared,
            body["position"],
            body["heading"],
            own["boxes"],
            _there(own, tick),
            shared["reflection"],
        )
        place = body["position"] + self.scale * shared["place_noise"] * deviates["place"][:2]
        fresh = tick % jnp.uint32(self.physics.place_every) == 0
        factor = shared["infrared_noise"] * deviates["infrared"][: self.vehicle.infrared.count]
        infrared = readings(self.vehicle.infrared, seen, factor)
        return {**body, "tick": tick, "infrared": infrared, "place": jnp.where(fresh, place, held)}

    def read(self, shared: Arrays, own: ArenaCopy, state: Arrays, sensor: str, axes: Axes) -> Array:
        if sensor in ("infrared", "heading", "encoders", "touching"):
            return state[sensor]
        if sensor in ("place", "goal"):
            return (state["place"] if sensor == "place" else own["goal"]) / self.scale
        if sensor == "pose":
            return jnp.concatenate([state["position"] / self.scale, state["heading"][None]])
        if sensor in ("camera", "line"):
            return self._picture(shared, own, state, sensor, axes)
        require_plane(sensor, axes, sensor == "above")
        one, other = sides(axes[:2], own["boxes"], self.scale)
        one = one * _there(own, state["tick"])[:, None]
        if sensor == "obstacles":  # one matrix product, which needs no array over boxes and the plane
            return jnp.clip(jnp.einsum("bi,bj->ij", one, other, precision="highest"), 0.0, 1.0)
        return coloured(one[:, :, None] * other[:, None, :], own["colours"])

    def renews(self, state: Arrays, sensor: str) -> Array:
        return self._is_frame(state["tick"])

    def _is_frame(self, tick: Array) -> Array:
        return tick % jnp.uint32(self.physics.camera_every) == 0

    def validate_axes(self, sensor: str, axes: Axes) -> Iterator[Problem]:
        try:
            if sensor in ("camera", "line") and self.vehicle.camera is not None:
                picture_rays(self.vehicle.camera, sensor, axes)
            if sensor in ("obstacles", "above"):
                require_plane(sensor, axes, sensor == "above")
                yield from judge_plane(axes[:2], self.layout.border, self.scale, self.unit)
        except WorldError as error:
            yield from error.problems

    def validate(self) -> Iterator[Problem]:
        check = BlockCheck(self.objects, self.places)
        yield from check.warnings(self.starts, self.vehicle.name, self.vehicle.radius)

    def validate_object(self, name: str) -> Iterator[Problem]:
        yield from BlockCheck(self.objects, self.places).overlaps(name)

    def alternative(self, signal: str, shape: Sequence[int]) -> str:
        for vehicle in VEHICLES.values():
            vehicle_signals = signals(vehicle, self.unit, goal=False)
            if signal in vehicle_signals and vehicle_signals[signal].shape == tuple(shape):
                return f"Choose another vehicle of the arena: vehicle={vehicle.name}"
        return ""

    def _picture(self, shared: Arrays, own: ArenaCopy, state: Arrays, sensor: str, axes: Axes) -> Array:
        """Return the last picture: with a period of its own the camera is where the vehicle was then."""
        camera, pose, tick = self.vehicle.camera, (state["position"], state["heading"]), state["tick"]
        assert camera is not None
        if self.physics.camera_every > 1:
            pose = state["frame"][:2], state["frame"][2]
            tick = tick - tick % jnp.uint32(self.physics.camera_every)
        seen_surfaces = surfaces(
            camera,
            pose,
            own["boxes"],
            own["heights"],
            _there(own, tick),
            picture_rays(camera, sensor, axes),
        )
        levels = {name: shared[name] for name in self.noise.in_pictures}
        noise = PictureNoise(levels, own["keys"], tick, sensor)
        seen = picture(seen_surfaces, own["colours"], self.objects.room, noise)
        return seen if sensor == "camera" else seen[:, 0]

    def _permanent(self) -> list[list[ArenaObject]]:
        """Return the objects that are always present: of all trials, or of each."""
        return [self.objects.permanent(k) for k in range(self.objects.trials)]

    def _goals(self) -> np.ndarray | None:
        """Return the goals of the layouts, m; None if they have none."""
        goals = [layout.goal for layout in self.layouts]
        if None in goals and any(goal is not None for goal in goals):
            raise WorldError(
                f"the layout of trial {goals.index(None)} has no goal, and that of another trial has one",
                fix="State a goal in each layout or in none",
            )
        return None if None in goals else np.asarray(goals)

    def _settled(self, stated: Sequence[Sequence[float] | np.ndarray | None]) -> np.ndarray:
        """Check starts and goals, and return the starts; choose those that are None.

        Raises:
            WorldError: a start or goal lies outside the arena or inside an object, a goal cannot be reached
                from its start, or the vehicle fits nowhere.
        """
        permanent, radius = self._permanent(), self.vehicle.radius

        @functools.lru_cache(maxsize=1)
        def room(k: int) -> Room:
            with reading(self.source, WorldError):
                return Room(self.layout, radius, np.asarray([t.box for t in permanent[k]]))

        chosen: list[Sequence[float] | np.ndarray] = []
        for k, start in enumerate(stated):
            middle = room(k % len(permanent)).near_middle() if start is None else ()
            if middle is None:
                raise WorldError(
                    f"the {self.vehicle.name} fits nowhere: it is {2 * radius / self.scale:g} {self.unit}"
                    " wide",
                    where=self.source if len(stated) == 1 else f"the layout of trial {k}",
                )
            chosen.append((*middle, 0.0) if start is None else start)
        starts = np.asarray(chosen)
        problems = self.places.misplaced(starts, "start", radius, permanent)
        if self.goals is not None:
            problems += self.places.misplaced(self.goals, "goal", 0.0, permanent)
            count = max(len(starts), len(self.goals), len(permanent))
            for k in range(0 if problems else count):
                start, goal = starts[k % len(starts)], self.goals[k % len(self.goals)]
                if not room(k % len(permanent)).joined(start[:2], goal):
                    text = f"is out of reach from {self.places.shown(start)}"
                    problems.append(self.places.fault("goal", self.goals, k, text, count))
        if problems:
            raise WorldError(problems)
        return starts

    # ------------------------------------------------------------------------------------------------ records

    def describe(self) -> JsonObject:
        settings: JsonObject = {
            "unit": self.unit,
            "vehicle": self.vehicle.name if VEHICLES.get(self.vehicle.name) == self.vehicle else CUSTOM,
            **dc.asdict(self.physics),
            **dc.asdict(self.noise),
        }
        # without settings of later versions that have their default, so that rows of older versions fit
        description: JsonObject = {
            "settings": {name: value for name, value in settings.items() if LATER.get(name) != value},
            "start": (self.starts / [self.scale, self.scale, 1]).tolist(),
            "goal": None if self.goals is None else (self.goals / self.scale).tolist(),
            "layout": (
                self.layout.to_data()
                if len(self.layouts) == 1
                else [layout.to_data() for layout in self.layouts]
            ),
            "things": self.objects.to_data(),
        }
        digest = hashlib.sha256(codec.line(description, ascii=True, sort=True).encode()).hexdigest()
        return {"world": "Arena", "file": self.source, **description, "sha256": digest}

    @classmethod
    def names(cls) -> list[str]:
        return list(builtin())

    @classmethod
    def open(cls, argument: str) -> Arena:
        layout, settings = parse_argument(cls, argument)
        if len(settings.get("start", ())) == 2:
            settings["start"].append(0.0)
        return cls(layout, **settings)

    @classmethod
    def again(cls, described: Mapping[str, Any]) -> Arena:
        settings = dict(described["settings"])
        if settings["vehicle"] not in VEHICLES:
            raise WorldError("was run with a custom vehicle, which a record does not contain", where="arena")
        arena = cls(described["layout"], described["start"], described["goal"], **arguments(cls, settings))
        arena.objects.restore(described["things"])
        arena.objects.fixed = frozenset(t.name for layout in arena.layouts for t in layout.objects)
        arena.source = str(described.get("file", ""))
        return arena

    @classmethod
    def example(cls) -> Arena:
        """Return an arena with an e-puck among coloured blocks."""
        return cls(
            "blocks",
            physics=ArenaPhysics(place_every=2, camera_every=2),
            noise=ArenaNoise(place_noise=0.005, slip=0.01, encoder_noise=0.02, hue_noise=4.0, outliers=0.02),
        )

    @classmethod
    def examples(cls) -> Iterator[Arena]:
        """Yield the example; a published maze with the start and the goal of its case 3, for planners; and a
        Khepera among coloured blocks that it sees only after it has turned, for models that read distances.
        """
        yield cls.example()
        yield cls(
            "z",
            start=(-0.45, 0.55, 0.0),
            goal=(-0.65, 0.65),
            physics=ArenaPhysics(place_every=2),
            noise=ArenaNoise(place_noise=0.005),
        )
        yield cls(
            "search",
            unit="mm",
            vehicle="khepera",
            physics=ArenaPhysics(period=20.0, camera_every=4),
            noise=ArenaNoise(hue_noise=6.0, outliers=0.04, slip=0.05),
        )

    @staticmethod
    def example_axes(sensor: str) -> Axes:
        plane = (Axis("x", 0.0, 1.2, 13, unit="m"), Axis("y", 0.0, 0.8, 9, unit="m"))
        columns, rows, channel = Axis("column", 0, 15, 16), Axis("row", 0, 11, 12), Axis("channel", 0, 2, 3)
        counts = {"infrared": 8, "place": 2, "goal": 2, "encoders": 2, "pose": 3}
        if sensor in counts:
            return (Axis("of", 0, counts[sensor] - 1, counts[sensor]),)
        axes = {"obstacles": plane, "above": (*plane, channel), "line": (columns, channel)}
        return (axes | {"camera": (columns, rows, channel)}).get(sensor, ())


def _there(own: ArenaCopy, tick: Array) -> Array:
    period = tick.astype(jnp.int32)
    return (own["windows"][:, 0] <= period) & (period < own["windows"][:, 1])
