"""Scene and robot files in the format of MuJoCo (MJCF), and the model that they give together.

MuJoCo trusts the sizes in a file, so a child compiles it (`compile_files`) and hands back the compiled model.
Each body and joint of the compiled model has a name.
"""

from __future__ import annotations

import contextlib
import hashlib
import io
import itertools
import math
import warnings
import xml.etree.ElementTree as ET
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypedDict

import numpy as np

from deodar import regular_file
from deodar.errors import MissingExtra, Problem, WorldError, did_you_mean, first_line
from deodar.guarded.guarded_file import GuardedFile

FOLDER = Path(__file__).parent
SCENES, ROBOTS = FOLDER / "scenes", FOLDER / "robots"

MOUNT = "robot"
"""Name of the site of a scene at which a robot is attached."""

TOOL = "tool"
"""Name of the site that the motors `tool_velocity` and `tool_plane` move."""

HOME = "home"
"""Name of the keyframe with the joint angles at the start."""


def simulator() -> Any:
    """Import MuJoCo, or raise an error that says how to install it."""
    try:
        # an extra
        import mujoco as found
    except ImportError:
        raise MissingExtra("mujoco-core", "robots", "a world with physics") from None
    mujoco: Any = found
    # its warnings would be written to a file in the working folder; deodar reports what matters itself
    mujoco.set_mju_user_warning(_silent)
    return mujoco


def _silent(text: str) -> None:
    """Ignore a warning of MuJoCo."""


@dataclass(frozen=True)
class SceneFile:
    """A scene, and the robot that is attached to it.

    Attributes:
        scene: file of the scene.
        robot: file of the robot; None: the scene has none, or contains it.
    """

    scene: Path
    robot: Path | None

    @classmethod
    def find(cls, scene: str | Path, robot: str | Path | None) -> SceneFile:
        """Find the files of a scene and a robot: those that come with deodar by name, others by path.

        Raises:
            WorldError: there is no such file.
        """
        simulator()
        file = _path(scene, SCENES, "scene")
        if (
            robot is None
            and file.parent == SCENES
            and GuardedFile(WorldError, str(file)).call(has_mount, str(file))
        ):
            robot = "lwr4"
        return cls(file, None if robot is None else _path(robot, ROBOTS, "robot"))

    def compiled(self, bodies: Iterable[FreeBody] = ()) -> tuple[Any, dict[str, float]]:
        """Return the model of the files and of bodies, and the position of each joint of the keyframe `home`.

        Raises:
            WorldError: a file is not valid MJCF, or needs too much memory or time; the scene has no place for
                the robot, or MuJoCo cannot build it.
        """
        robot = None if self.robot is None else str(self.robot)
        where = str(self.scene) if robot is None else f"{self.scene} with {self.robot}"
        compiled = GuardedFile(WorldError, where).call(compile_files, str(self.scene), robot, list(bodies))
        name = "compiled.mjb"
        return simulator().MjModel.from_binary_path(name, {name: compiled["model"]}), compiled["home"]

    def urdf(self) -> Problem | None:
        """Return what a file in the format URDF lacks; None if neither file is one."""
        for file in (self.scene, self.robot):
            if file is not None and GuardedFile(WorldError, str(file)).call(is_urdf, str(file)):
                return Problem(
                    str(file),
                    "is a URDF file, which states no motors and no sensors",
                    f"Convert it, add an <actuator> for each joint that moves, and open robot.xml: python -c"
                    f" \"import mujoco; spec = mujoco.MjSpec.from_file('{file.name}'); spec.compile();"
                    " spec.to_file('robot.xml')\"",
                    "warning",
                )
        return None

    def digest(self) -> str:
        """Return a digest of both files."""
        files = [self.scene] if self.robot is None else [self.scene, self.robot]
        return hashlib.sha256(b"\0".join(regular_file.read_bytes(file) for file in files)).hexdigest()


def is_scalar(model: Any, joint: int) -> bool:
    """Return whether a joint has one position: a hinge or a slide."""
    return int(model.jnt_type[joint]) >= int(simulator().mjtJoint.mjJNT_SLIDE)


def _path(given: str | Path, folder: Path, what: str) -> Path:
    builtin = {file.stem: file for file in sorted(folder.glob("*.xml"))}
    if str(given) in builtin:
        return builtin[str(given)]
    path = Path(given)
    if not regular_file.is_file(path):
        raise WorldError(
            f"there is no such {what}",
            where=str(given),
            fix=f"Name an MJCF file, or a {what} that comes with deodar: {did_you_mean(str(given), builtin)}",
        )
    return path.resolve()


# --------------------------------------------------------------------------------------------- in the child


class FreeBody(TypedDict):
    """A body with a free joint and one geom, which all have its name.

    Attributes:
        name: the name.
        position: of its middle: x, y and z, m.
        geom: name of the geom's kind in MuJoCo.
        size: size of the geom as MuJoCo states it, m.
        color: red, green, blue and opacity, 0 to 1.
        density: density of the geom, kg/m3.
    """

    name: str
    position: list[float]
    geom: str
    size: list[float]
    color: list[float]
    density: float


class CompiledFiles(TypedDict):
    """A compiled model in the format of MuJoCo (MJB), and joints of the keyframe `home` by name."""

    model: bytes
    home: dict[str, float]


def has_mount(scene: str) -> bool:
    """Return whether a robot can be attached to a scene."""
    return _specification(scene).site(MOUNT) is not None


def is_urdf(path: str) -> bool:
    """Return whether a file is in the format URDF: its outermost element is `robot`."""
    # MuJoCo opens files whose encoding Python does not read
    with contextlib.suppress(ET.ParseError, ValueError, LookupError):
        for _, element in ET.iterparse(io.BytesIO(regular_file.read_bytes(path)), ["start"]):
            return element.tag == "robot"
    return False


def compile_files(scene: str, robot: str | None, bodies: list[FreeBody]) -> CompiledFiles:
    """Return the model of a scene, of a robot that is attached to it, and of bodies that are added.

    Raises:
        WorldError: a file is not valid MJCF, the scene has no place for the robot, or MuJoCo cannot build it.
    """
    mujoco = simulator()
    spec = _specification(scene)
    attached = None if robot is None else _specification(robot)
    for kind in ("body", "joint"):
        _name_all(kind, spec, *([] if attached is None else [attached]))
    home: dict[str, float] | None = None
    if robot is not None:
        if spec.site(MOUNT) is None:
            raise WorldError(
                "has no site called 'robot', at which the robot would be attached",
                where=scene,
                fix=f'Add <site name="{MOUNT}" pos="0 0 0"/> to the scene, or open it without a robot',
            )
        home = _home(_compiled(attached, robot))
        with warnings.catch_warnings():
            # names of the robot stay as they are in its file; a clash of names is an error of `compile`
            warnings.simplefilter("ignore")
            spec.attach(attached, site=MOUNT, prefix="")
    for body in bodies:
        _add(spec, body)
    model = _compiled(spec, scene)
    content = np.empty(mujoco.mj_sizeModel(model), np.uint8)
    mujoco.mj_saveModel(model, None, content)
    return {"model": content.tobytes(), "home": _home(model) if home is None else home}


def _specification(path: str) -> Any:
    try:
        return simulator().MjSpec.from_file(path)
    except RuntimeError:
        # MuJoCo raises it for what it cannot allocate, and holds a lock from then on
        raise MemoryError from None
    except ValueError as error:
        raise WorldError(f"is not a valid MJCF file: {first_line(error)}", where=path) from None


def _name_all(kind: str, *specs: Any) -> None:
    """Name the bodies or joints without a name by the kind and a number, `joint2`, in files that are joined.

    The state is carried over by name where an object is placed, and so is the start of a robot.
    """
    objects = [each for spec in specs for each in getattr(spec, {"body": "bodies", "joint": "joints"}[kind])]
    used = {each.name for each in objects}
    for number, each in enumerate(objects):
        if not each.name:
            numbered = (f"{kind}{k}" for k in itertools.count(number))
            each.name = next(name for name in numbered if name not in used)
            used.add(each.name)


def _add(spec: Any, body: FreeBody) -> None:
    added = spec.worldbody.add_body(name=body["name"], pos=body["position"])
    added.add_freejoint(name=body["name"])
    added.add_geom(
        name=body["name"],
        type=getattr(simulator().mjtGeom, body["geom"]),
        size=body["size"],
        rgba=body["color"],
        density=body["density"],
        contype=1,
        conaffinity=3,
    )


def _compiled(spec: Any, where: str) -> Any:
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            model = spec.compile()
        bytes(model.names).decode()
    except UnicodeDecodeError:
        raise WorldError("has a name that is not UTF-8", where=where) from None
    except ValueError as error:
        raise WorldError(f"MuJoCo cannot build this scene: {first_line(error)}", where=where) from None
    if not 0 < model.opt.timestep < math.inf:
        raise WorldError(f"its time step is {model.opt.timestep:g}; expected seconds above 0", where=where)
    return model


def _home(model: Any) -> dict[str, float]:
    """Return the position of each joint of the keyframe `home`, by the joint's name; none without one."""
    if HOME not in [model.key(k).name for k in range(model.nkey)]:
        return {}
    positions = model.key(HOME).qpos
    return {
        model.joint(k).name: float(positions[model.jnt_qposadr[k]])
        for k in range(model.njnt)
        if is_scalar(model, k)
    }
