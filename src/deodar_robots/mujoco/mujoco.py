"""A world with real physics, from a file."""

from __future__ import annotations

import dataclasses
import hashlib
import math
import warnings
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from deodar import codec
from deodar.codec import Json, JsonObject
from deodar.errors import Problem, RunWarning, UnknownName, WorldError, did_you_mean, instance_of
from deodar.numerics.axes import Axes, Axis
from deodar.parameters import real, show
from deodar.registry import register
from deodar.worlds._base import Signal, World
from deodar.worlds._scene import Scene, SceneBody, SceneBox, pair
from deodar.worlds._settings import arguments, number, parse_argument
from deodar_robots.mujoco import cameras as pictures
from deodar_robots.mujoco import solids
from deodar_robots.mujoco.cameras import CAMERAS, MuJoCoCameras, Renderer, visible
from deodar_robots.mujoco.objects import PlacedObject
from deodar_robots.mujoco.reach import Arm
from deodar_robots.mujoco.scene_file import ROBOTS, SCENES, SceneFile, is_scalar, simulator
from deodar_robots.mujoco.scene_names import SceneNames

LONGEST_PERIOD = 10.0
"""Longest period of a scene that states none, ms, unless its time step is longer."""

CONTROL = 0.01
"""Interval between two commands to the joints, s, if the time step of the scene is shorter."""

GAP = 0.0005
"""Height above the plane at which a moved object is put down, m."""


PICTURE = Signal("picture: columns from the left, rows from the top, and red, green, blue", each=True)
JOINT_SENSORS = {
    "joint_angles": Signal("position of each hinge and slide", each=True),
    "joint_velocities": Signal("velocity of each hinge and slide", each=True),
}
MOCAP_POSITION = Signal("position of the mocap body: x, y and z", (3,), "m", each=True)
MOCAP_ORIENTATION = Signal(
    "orientation of the mocap body: a quaternion, its real part first", (4,), each=True
)
TOOL_SENSORS = {
    "tool": Signal("x, y and z of the tool", (3,), "m", each=True),
    "tool_plane": Signal("x and y of the tool", (2,), "m", each=True),
}
TOOL_MOTORS = {
    "tool_velocity": Signal("velocity of the tool along x, y and z", (3,), "m/s", each=True),
    "tool_plane": Signal("velocity of the tool along x and y; it keeps its height", (2,), "m/s", each=True),
}


@register
class MuJoCo(World):
    r"""A scene with real physics: any file in the format of MuJoCo (MJCF), and a robot in it.

    Every sensor, camera and actuator of the files is a sensor or a motor of the world, by its name. Without a
    name an actuator has that of what it moves (its joint, tendon, site or body), a sensor that of what it
    measures and its type (`tip_gyro`), a camera its number (`camera0`); where two would have one name, the
    second is `hip_2`. A mocap body is a motor for its position, and with `_orientation` one for its
    orientation.

    If the robot has a site called `tool` and velocity actuators, two more motors move this tool: the joints
    get the velocities that the damped pseudo-inverse of its Jacobian J gives for a wanted velocity v of the
    tool, and approach their posture q_0 of the start as far as the tool does not move by it. Joints keep
    their ranges and largest speeds, whatever the command.

    Equation:
        \frac{dq}{dt} = J^{+} v + (I - J^{+} J)\, k\, (q_0 - q),\quad J^{+} = J^T (J J^T + d^2 I)^{-1}

    Parameters:
        scene: an MJCF file, or the name of a scene that comes with deodar (table, head).
        robot: an MJCF file of a robot that is attached at the site `robot` of the scene, or the name of one
            that comes with deodar (lwr4, four, six); None: lwr4 on the table of deodar, else none.
        period: ms between two exchanges with the model; a multiple of the time step of the scene. None: the
            longest up to 10 ms, at least one step.
        tool_noise: standard deviation of the sensors `tool` and `tool_plane`, m.
        cameras: what cameras see, and how often.

    Shapes:
        A sensor of the file has one axis with as many samples as MuJoCo states, none if it is one number.
        `joint_angles` and `joint_velocities` have one sample for each hinge and slide, in the order of the
        file. `tool` has x, y and z of the tool, `tool_plane` x and y. A camera has the axes columns, rows
        and channel (red, green, blue), any number of samples; the rows cover its vertical opening angle, and
        pixels are squares.

    Reference:
        Todorov, Erez & Tassa (2012), MuJoCo: a physics engine for model-based control, IROS. Nakamura &
        Hanafusa (1986), J. Dyn. Sys. Meas. Control 108(3), eqs. 19 and 33. Lomp, Richter, Zibner & Schöner
        (2016), Front. Neurorobot. 10:14, section 2.5.2.
    """

    sensors: Mapping[str, Signal] = {
        **JOINT_SENSORS,
        "camera": PICTURE,
        **TOOL_SENSORS,
    }
    motors: Mapping[str, Signal] = TOOL_MOTORS
    opens = (".xml",)

    def __init__(
        self,
        scene: str | Path = "table",
        robot: str | Path | None = None,
        period: float | None = None,
        tool_noise: float = 0.0,
        cameras: MuJoCoCameras = CAMERAS,
    ) -> None:
        self.files = SceneFile.find(scene, robot)
        self.source = str(scene), None if robot is None else str(robot)
        self.period = None if period is None else number("period", period, above=0.0)
        self.cameras = instance_of(MuJoCoCameras, cameras, "cameras")
        self.tool_noise = number("tool_noise", tool_noise)
        self.objects: dict[str, PlacedObject] = {}
        self._seed, self._trials, self._tick = 0, (0,), 0
        self._build()
        self.sensors, self.motors = self._signals()
        self._urdf = self.files.urdf()
        if self._urdf is not None:
            warnings.warn(str(self._urdf), RunWarning, stacklevel=2)

    # ----------------------------------------------------------------------------------------- the simulation

    def _build(self) -> None:
        """Compile the scene with its objects."""
        model, self._home = self.files.compiled(thing.body() for thing in self.objects.values())
        self.model = model
        model.opt.disableflags |= int(simulator().mjtDisableBit.mjDSBL_AUTORESET)
        self._steps = self._steps_of_period(1000 * float(model.opt.timestep))
        self._control = max(1, round(CONTROL / model.opt.timestep))
        self._joints = [k for k in range(model.njnt) if is_scalar(model, k)]
        self.arm = Arm.find(model, self._home)
        tool = self.arm is not None
        read = [*(JOINT_SENSORS if self._joints else ()), *(TOOL_SENSORS if tool else ())]
        self._scene_names = SceneNames.of(model, read, TOOL_MOTORS if tool else ())
        self._colors, self._shown = pictures.shades(model), simulator().MjData(model)
        self._renderers: dict[tuple[int, int], Renderer] = {}
        self._geoms = solids.shown(model)
        self._solids = solids.solids(model, self._colors, self.objects)
        self._copies = [self._started() for _ in self._trials]
        self._height = 0.0 if self.arm is None else float(self._copies[0].site_xpos[self.arm.site][2])
        self._take_frames()

    def _steps_of_period(self, timestep: float) -> int:
        """Return the number of time steps (ms) of a period, and choose a period if none was stated."""
        if self.period is None:
            self.period = round(max(1, math.floor(LONGEST_PERIOD / timestep + 1e-6)) * timestep, 9)
        steps = self.period / timestep
        if not math.isclose(steps, round(steps), rel_tol=1e-6) or round(steps) < 1:
            raise WorldError(
                f"the period {self.period:g} ms is not a multiple of the time step of the scene,"
                f" {timestep:g} ms",
                where=str(self.files.scene),
                fix=f"For example period={timestep * max(1, round(steps)):g}",
            )
        return round(steps)

    def _take_frames(self) -> None:
        """Keep the state that the cameras show until their next picture."""
        entries = _positions()
        self._frames = [np.empty(simulator().mj_stateSize(self.model, entries)) for _ in self._copies]
        for frame, data in zip(self._frames, self._copies, strict=True):
            simulator().mj_getState(self.model, data, frame, entries)
        self._pictures: dict[tuple[str, int, tuple[int, int]], np.ndarray] = {}

    def _started(self) -> Any:
        mujoco = simulator()
        data = mujoco.MjData(self.model)
        for k in self._joints:
            data.qpos[self.model.jnt_qposadr[k]] = self._home.get(
                self.model.joint(k).name, data.qpos[self.model.jnt_qposadr[k]]
            )
        for thing in self.objects.values():  # where they were placed, or moved by hand
            place = self.model.joint(thing.name).qposadr[0]
            data.qpos[place : place + 2] = thing.center
        mujoco.mj_forward(self.model, data)
        return data

    def _rebuild(self) -> None:
        """Compile the scene again after its objects changed; everything that stays keeps its state."""
        before, copies = self.model, self._copies
        height = self._height
        self._build()
        self._height = height
        for old, new in zip(copies, self._copies, strict=True):
            _carry_over(before, old, self.model, new)
        self._take_frames()

    def _signals(self) -> tuple[dict[str, Signal], dict[str, Signal]]:
        sensors = {
            name: dataclasses.replace(signal, shape=(len(self._joints),))
            for name, signal in JOINT_SENSORS.items()
            if self._joints
        }
        every = self.cameras.camera_every
        frame = every * float(self.period or 0) if every > 1 else None
        sensors |= {name: dataclasses.replace(PICTURE, period=frame) for name in self._scene_names.cameras}
        for name, k in self._scene_names.sensors.items():
            size = int(self.model.sensor_dim[k])
            sensors[name] = Signal("sensor of the scene", () if size == 1 else (size,), each=True)
        motors = {name: self._actuator(k) for name, k in self._scene_names.actuators.items()}
        motors |= dict.fromkeys(self._scene_names.positions, MOCAP_POSITION)
        motors |= dict.fromkeys(self._scene_names.orientations, MOCAP_ORIENTATION)
        if self.arm is not None:
            sensors |= TOOL_SENSORS
            motors |= TOOL_MOTORS
        return sensors, motors

    def _actuator(self, number: int) -> Signal:
        rows = self._controls(number)
        size = rows.stop - rows.start
        ranges = tuple(_pair(row) for row in self.model.actuator_ctrlrange[rows])
        limited = all(self.model.actuator_ctrllimited[rows])
        shape = () if size == 1 else (size,)
        return Signal("actuator of the scene", shape, each=True, bounds=ranges if limited else None)

    def _controls(self, actuator: int) -> slice:
        """Return the places of an actuator's commands among those of all."""
        first = int(self.model.actuator_ctrladr[actuator])
        return slice(first, first + int(self.model.actuator_ctrlnum[actuator]))

    def require_motor(self, motor: str) -> None:
        try:
            super().require_motor(motor)
        except WorldError as error:
            if self._urdf is None:
                raise
            raise WorldError([*error.problems, dataclasses.replace(self._urdf, severity="problem")]) from None

    def reset(self, seed: int, trials: Sequence[int] = (0,), precision: str = "float32") -> None:
        self._seed, self._trials, self._tick = seed, tuple(trials), 0
        self._copies = [self._started() for _ in self._trials]
        self._take_frames()

    def act(self, motors: Mapping[str, np.ndarray], time: float) -> None:
        for k, data in enumerate(self._copies):
            commands = {name: np.asarray(values[k], float) for name, values in motors.items()}
            for n in range(self._steps):
                if n % self._control == 0:
                    self._command(data, commands)
                simulator().mj_step(self.model, data)
                if self.arm is not None:
                    self.arm.limit(data)
            self._require_finite(data, time)
            simulator().mj_forward(self.model, data)
        self._tick += 1
        if self._tick % self.cameras.camera_every == 0:
            self._take_frames()

    def _command(self, data: Any, commands: Mapping[str, np.ndarray]) -> None:
        data.ctrl[:] = 0.0
        names = self._scene_names
        for name, value in commands.items():
            if name in names.actuators:
                data.ctrl[self._controls(names.actuators[name])] = value
            elif name in names.positions:
                data.mocap_pos[names.positions[name]] = value
            elif name in names.orientations:
                data.mocap_quat[names.orientations[name]] = value
        arm = self.arm
        if arm is None:
            return
        wanted = np.zeros(3)
        if "tool_velocity" in commands:
            wanted = wanted + commands["tool_velocity"]
        if "tool_plane" in commands:
            wanted = wanted + arm.plane(data, commands["tool_plane"], self._height)
        if "tool_velocity" in commands or "tool_plane" in commands:
            data.ctrl[arm.actuators] += arm.velocities(self.model, data, wanted, self._horizon)

    @property
    def _horizon(self) -> float:
        return 2 * self._control * float(self.model.opt.timestep)

    def _require_finite(self, data: Any, time: float) -> None:
        kinds = simulator().mjtWarning
        diverged = any(
            data.warning[int(w)].number
            for w in (kinds.mjWARN_BADQPOS, kinds.mjWARN_BADQVEL, kinds.mjWARN_BADQACC)
        )
        if diverged or not np.isfinite(data.qpos).all():
            data.ctrl[:] = 0.0
            raise WorldError(
                f"the simulation of the scene diverged at {time:g} ms; all motors are at 0",
                where=str(self.files.scene),
                fix="Reset the run. Use a smaller timestep in the scene, or weaker actuators",
            )

    # ------------------------------------------------------------------------------------------- the readings

    def sense(self, sensor: str, axes: Axes, time: float) -> np.ndarray:
        self.require(sensor)
        return np.stack([self._reading(k, sensor, axes) for k in range(len(self._copies))])

    def _reading(self, k: int, sensor: str, axes: Axes) -> np.ndarray:
        data, model, arm = self._copies[k], self.model, self.arm
        if sensor == "joint_angles":
            return np.array([data.qpos[model.jnt_qposadr[j]] for j in self._joints])
        if sensor == "joint_velocities":
            return np.array([data.qvel[model.jnt_dofadr[j]] for j in self._joints])
        if sensor in ("tool", "tool_plane") and arm is not None:
            place = np.array(data.site_xpos[arm.site][: 3 if sensor == "tool" else 2])
            if self.tool_noise:
                place += self.tool_noise * self._random(k, sensor, self._tick).standard_normal(len(place))
            return place
        if sensor in self._scene_names.cameras:
            return self._picture(k, sensor, axes)
        reading = np.array(data.sensor(self._scene_names.sensors[sensor]).data)
        return reading[0] if len(reading) == 1 else reading

    def _picture(self, k: int, sensor: str, axes: Axes) -> np.ndarray:
        pictures.require_picture(sensor, axes)
        size = axes[0].samples, axes[1].samples
        key = sensor, k, size
        if key not in self._pictures:
            simulator().mj_setState(self.model, self._shown, self._frames[k], _positions())
            simulator().mj_fwdPosition(self.model, self._shown)
            seen = self._seen(sensor, size)
            if self.cameras.pixel_noise:
                random = self._random(k, sensor, self._tick // self.cameras.camera_every)
                noise = random.standard_normal(seen.shape, np.float32)
                seen = np.clip(seen + np.float32(self.cameras.pixel_noise) * noise, 0.0, 1.0)
            self._pictures[key] = seen
        return self._pictures[key]

    def _seen(self, camera: str, size: tuple[int, int]) -> np.ndarray:
        """Return the picture of a camera without noise, as `render` states."""
        number = self._scene_names.cameras[camera]
        if self.cameras.render == "rays":
            return pictures.picture(self.model, self._shown, number, size, self._colors, self.cameras.light)
        if size not in self._renderers:
            self._renderers[size] = Renderer(self.model, size)
        return self._renderers[size].picture(self._shown, number, self.cameras.light)

    def _random(self, k: int, sensor: str, count: int) -> np.random.Generator:
        """Return the noise of a sensor in one period; it depends on seed, trial, sensor and period alone."""
        name = int.from_bytes(hashlib.sha256(sensor.encode()).digest()[:4], "little")
        return np.random.Generator(
            np.random.Philox(key=[self._seed % 2**64, self._trials[k]], counter=[0, 0, name, count])
        )

    def validate_axes(self, sensor: str, axes: Axes) -> Iterator[Problem]:
        if self.sensors[sensor].shape is None:
            try:
                pictures.require_picture(sensor, axes)
            except WorldError as error:
                yield from error.problems

    # -------------------------------------------------------------------------------------------- the objects

    def place(
        self,
        name: str,
        center: Sequence[float],
        size: Sequence[float],
        color: Sequence[float] = (0.72, 0.53, 0.3),
        height: float | None = None,
        shape: str = "cylinder",
    ) -> None:
        """Add an object to the scene, or replace the one of the same name, on the plane z = 0.

        Args:
            name: name of the object.
            center: x and y of its middle, m.
            size: size along x and y, m; a cylinder has the first as its diameter.
            color: red, green and blue, 0 to 1.
            height: height, m; None: 1 cm.
            shape: `cylinder` or `box`.
        """
        thing = PlacedObject.checked(name, center, size, color, height, shape)
        if name not in self.objects and self._has_body(name):
            raise WorldError("is a part of the scene, which cannot be replaced", where=name)
        kept = self.objects
        self.objects = {key: value for key, value in kept.items() if key != name} | {name: thing}
        try:
            self._rebuild()
        except WorldError:
            self.objects = kept
            raise
        self.move(name, thing.center)

    def move(self, name: str, center: Sequence[float]) -> None:
        """Move an object; `center` is the new x and y of its middle, m. It stands upright and still there."""
        self._require_object(name)
        x, y = pair(f"{name}.center", center)
        thing = self.objects[name] = dataclasses.replace(self.objects[name], center=(x, y))
        joint = self.model.joint(name)
        for data in self._copies:
            data.qpos[joint.qposadr[0] : joint.qposadr[0] + 7] = [x, y, thing.height / 2 + GAP, 1, 0, 0, 0]
            data.qvel[joint.dofadr[0] : joint.dofadr[0] + 6] = 0.0
            simulator().mj_forward(self.model, data)
        self._take_frames()

    def remove(self, name: str) -> None:
        """Remove an object."""
        self._require_object(name)
        del self.objects[name]
        self._rebuild()

    def _require_object(self, name: str) -> None:
        if name in self.objects:
            return
        if self._has_body(name):
            raise WorldError("cannot be moved by hand", where=name)
        raise UnknownName(f"nothing here is called {name!r}", fix=did_you_mean(name, self.objects))

    def _has_body(self, name: str) -> bool:
        mujoco = simulator()
        kinds = (mujoco.mjtObj.mjOBJ_BODY, mujoco.mjtObj.mjOBJ_GEOM, mujoco.mjtObj.mjOBJ_JOINT)
        return any(mujoco.mj_name2id(self.model, kind, name) >= 0 for kind in kinds)

    def tool(self) -> tuple[float, float, float]:
        """Return the true x, y and z of the tool of the first copy, m.

        Raises:
            WorldError: the scene has no site called `tool` and joints that move it.
        """
        if self.arm is None:
            raise WorldError("has no tool", where=str(self.files.scene))
        x, y, z = (float(v) for v in self._copies[0].site_xpos[self.arm.site])
        return x, y, z

    def visible(self, name: str, camera: str) -> float:
        """Return the share of the top of an object that a camera of the first copy sees, 0 to 1."""
        self._require_object(name)
        thing, data = self.objects[name], self._copies[0]
        number = self._scene_names.cameras[camera]
        return visible(self.model, data, number, name, min(thing.size) / 2, thing.height)

    def push(self, body: str, force: Sequence[float]) -> None:
        """Push a body, such as a link of an arm, with a force along x, y and z (N) until the next call.

        The force acts at the middle of its mass.

        Raises:
            UnknownName: the scene has no such body.
        """
        bodies = [self.model.body(k).name for k in range(1, self.model.nbody)]
        if body not in bodies:
            raise UnknownName(f"the scene has no body {body!r}", fix=did_you_mean(body, bodies))
        numbers = [real(f) for f in force]
        if len(numbers) != 3 or any(f is None or not math.isfinite(f) for f in numbers):
            raise WorldError(f"the force is {show(force)}; expected three finite numbers, N", where=body)
        for data in self._copies:
            data.body(body).xfrc_applied[:3] = numbers

    def arrangement(self) -> Any:
        return [thing.to_data() for thing in self.objects.values()]

    def arrange(self, kept: Any) -> None:
        self.objects = {data["name"]: PlacedObject.from_data(data) for data in kept}
        self._rebuild()
        for thing in list(self.objects.values()):
            self.move(thing.name, thing.center)

    def scene(self) -> Scene:
        """Return the scene of the first copy: from above its objects and its tool, and all solids."""
        data = self._copies[0]
        boxes: list[SceneBox] = []
        for thing in self.objects.values():
            x, y = data.joint(thing.name).qpos[:2]
            boxes.append(SceneBox(thing.name, (float(x), float(y)), thing.size, thing.color))
        places = [[*b.center] for b in boxes]
        bodies: tuple[SceneBody, ...] = ()
        if self.arm is not None:
            x, y = (float(v) for v in data.site_xpos[self.arm.site][:2])
            ahead = np.asarray(data.site_xmat[self.arm.site]).reshape(3, 3)[:, 0]
            bodies = (SceneBody("tool", (x, y), float(math.atan2(ahead[1], ahead[0])), 0.01),)
            places.append([x, y])
        elif self.model.nbody > 1:
            x, y = (float(v) for v in data.xpos[1][:2])
            bodies = (SceneBody(self.model.body(1).name, (x, y), 0.0, 0.05),)
            places.append([x, y])
        inside = np.array([*self._border(), *places])
        left, low, right, high = (float(v) for v in (*inside.min(axis=0), *inside.max(axis=0)))
        border = (left, low, right, high)
        return Scene("m", border, tuple(boxes), (), bodies, self._solids, solids.poses(data, self._geoms))

    def _border(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """Return the corners of the geom `table`, else of a square of 1 m."""
        mujoco = simulator()
        table = mujoco.mj_name2id(self.model, mujoco.mjtObj.mjOBJ_GEOM, "table")
        if table < 0:
            return (-0.5, -0.5), (0.5, 0.5)
        (x, y), (wide, deep) = self.model.geom_pos[table][:2], self.model.geom_size[table][:2]
        return (float(x - wide), float(y - deep)), (float(x + wide), float(y + deep))

    # -------------------------------------------------------------------------------------- state and records

    def keep(self) -> Any:
        state = {
            "tick": np.asarray(self._tick),
            "time": np.array([data.time for data in self._copies]),
            "qpos": np.array([data.qpos for data in self._copies]),
            "qvel": np.array([data.qvel for data in self._copies]),
            "act": np.array([data.act for data in self._copies]),
            "warmstart": np.array([data.qacc_warmstart for data in self._copies]),
            "pushes": np.array([data.xfrc_applied for data in self._copies]),
            "frames": np.array(self._frames),
        }
        # of a scene without them, states of versions that stored no mocap bodies have the same entries
        if self.model.nmocap:
            state["mocap"] = np.array([np.hstack([d.mocap_pos, d.mocap_quat]) for d in self._copies])
        return state

    def put(self, kept: Any) -> None:
        self._tick = int(kept["tick"])
        for k, data in enumerate(self._copies):
            data.time = float(kept["time"][k])
            data.qpos[:], data.qvel[:] = kept["qpos"][k], kept["qvel"][k]
            data.act[:] = kept["act"][k]
            if "mocap" in kept:
                data.mocap_pos[:], data.mocap_quat[:] = np.split(kept["mocap"][k], [3], axis=1)
            data.xfrc_applied[:] = kept["pushes"][k]
            simulator().mj_forward(self.model, data)
            # which `mj_forward` changes
            data.qacc_warmstart[:] = kept["warmstart"][k]
        self._frames, self._pictures = list(kept["frames"]), {}

    def describe(self) -> dict[str, Json]:
        scene, robot = self.source
        said: JsonObject = {
            "scene": scene,
            "robot": robot,
            "settings": {
                "period": self.period,
                "tool_noise": self.tool_noise,
                **dataclasses.asdict(self.cameras),
            },
            "objects": self.arrangement(),
            "files": self.files.digest(),
        }
        digest = hashlib.sha256(codec.line(said, ascii=True, sort=True).encode()).hexdigest()
        return {"world": "MuJoCo", "file": scene, **said, "sha256": digest}

    @classmethod
    def open(cls, argument: str) -> MuJoCo:
        scene, settings = parse_argument(cls, argument)
        return cls(scene or "table", **settings)

    @classmethod
    def names(cls) -> list[str]:
        return sorted(file.stem for file in SCENES.glob("*.xml"))

    @classmethod
    def robots(cls) -> list[str]:
        """Return the names of the robots that come with deodar."""
        return sorted(file.stem for file in ROBOTS.glob("*.xml"))

    @classmethod
    def again(cls, described: Mapping[str, Any]) -> MuJoCo:
        found = cls(described["scene"], described["robot"], **arguments(cls, described["settings"]))
        if found.files.digest() != described["files"]:
            raise WorldError("the scene or the robot has changed since", where=str(described["scene"]))
        found.arrange(described["objects"])
        return found

    @classmethod
    def example(cls) -> MuJoCo:
        """Return the table with four coloured objects, with noise of the camera and of the tool's place."""
        world = cls("table", tool_noise=0.002, cameras=MuJoCoCameras(pixel_noise=0.03))
        red, green = (0.8, 0.12, 0.12), (0.12, 0.8, 0.12)
        for name, place, color in (
            ("red left", (-0.14, 0.18), red),
            ("green left", (-0.22, 0.4), green),
            ("red right", (0.27, 0.45), red),
            ("green right", (0.2, 0.22), green),
        ):
            world.place(name, place, (0.08, 0.08), color)
        return world

    @staticmethod
    def example_axes(sensor: str) -> Axes:
        counts = {"tool": 3, "tool_plane": 2, "joint_angles": 7, "joint_velocities": 7}
        if sensor in counts:
            return (Axis("of", 0, counts[sensor] - 1, counts[sensor]),)
        return Axis("column", 0, 31, 32), Axis("row", 0, 23, 24), Axis("channel", 0, 2, 3)


def _positions() -> int:
    """Return which entries of a state, in the numbers of MuJoCo, decide where all bodies are."""
    entries = simulator().mjtState
    return int(entries.mjSTATE_QPOS | entries.mjSTATE_MOCAP_POS | entries.mjSTATE_MOCAP_QUAT)


def _carry_over(before: Any, old: Any, model: Any, new: Any) -> None:
    """Copy the state of all joints that two models share, and the forces on their bodies, by name."""
    mujoco = simulator()
    widths = {0: (7, 6), 1: (4, 3), 2: (1, 1), 3: (1, 1)}  # positions and velocities of each kind of joint
    for k in range(model.njnt):
        at = mujoco.mj_name2id(before, mujoco.mjtObj.mjOBJ_JOINT, model.joint(k).name)
        if at < 0:
            continue
        q, v = widths[int(model.jnt_type[k])]
        for name, width, place in (("qpos", q, "jnt_qposadr"), ("qvel", v, "jnt_dofadr")):
            i, j = int(getattr(model, place)[k]), int(getattr(before, place)[at])
            getattr(new, name)[i : i + width] = getattr(old, name)[j : j + width]
    for k in range(1, model.nbody):
        at = mujoco.mj_name2id(before, mujoco.mjtObj.mjOBJ_BODY, model.body(k).name)
        if at > 0:
            new.xfrc_applied[k] = old.xfrc_applied[at]
            mocap, was = int(model.body_mocapid[k]), int(before.body_mocapid[at])
            if mocap >= 0:
                new.mocap_pos[mocap], new.mocap_quat[mocap] = old.mocap_pos[was], old.mocap_quat[was]
    new.time = old.time
    mujoco.mj_forward(model, new)


def _pair(values: Any) -> tuple[float, float]:
    low, high = (float(v) for v in values)
    return low, high
