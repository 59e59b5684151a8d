"""Scene and robot files in the format of MuJoCo (MJCF), and the specification that they give together."""

from __future__ import annotations

import hashlib
import warnings
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from deodar import regular_file
from deodar.errors import MissingExtra, WorldError, did_you_mean, first_line

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
        found = _found(scene, SCENES, "scene")
        own = found.parent == SCENES
        if robot is None and own and _read(found).site(MOUNT) is not None:
            robot = "lwr4"
        return cls(found, None if robot is None else _found(robot, ROBOTS, "robot"))

    def specification(self) -> Any:
        """Read the files.

        Raises:
            WorldError: a file is not valid MJCF, or the scene has no place for the robot.
        """
        spec = _read(self.scene)
        if self.robot is not None:
            if spec.site(MOUNT) is None:
                raise WorldError(
                    "has no site called 'robot', at which the robot would be attached",
                    where=str(self.scene),
                    fix=f'Add <site name="{MOUNT}" pos="0 0 0"/> to the scene, or open it without a robot',
                )
            with warnings.catch_warnings():
                # names of the robot stay as they are in its file; a clash of names is an error of `compile`
                warnings.simplefilter("ignore")
                spec.attach(_read(self.robot), site=MOUNT, prefix="")
        return spec

    def home(self, model: Any) -> dict[str, float]:
        """Return the position of each joint of the keyframe `home`, by the joint's name; 0 without one."""
        source = compiled(_read(self.robot), self.robot) if self.robot is not None else model
        names = [source.joint(k).name for k in range(source.njnt)]
        keys = [source.key(k).name for k in range(source.nkey)]
        if HOME not in keys:
            return {}
        values = source.key(HOME).qpos
        return {
            name: float(values[source.jnt_qposadr[k]]) for k, name in enumerate(names) if is_scalar(source, k)
        }

    def digest(self) -> str:
        """Return a digest of both files."""
        files = [self.scene] if self.robot is None else [self.scene, self.robot]
        return hashlib.sha256(b"\0".join(regular_file.read_bytes(file) for file in files)).hexdigest()


def compiled(spec: Any, where: Path | None) -> Any:
    """Compile a specification, or raise WorldError with what MuJoCo says."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            return spec.compile()
    except ValueError as error:
        raise WorldError(
            f"MuJoCo cannot build this scene: {first_line(error)}", where=str(where or "scene")
        ) from None


def is_scalar(model: Any, joint: int) -> bool:
    """Return whether a joint has one position: a hinge or a slide."""
    return int(model.jnt_type[joint]) >= int(simulator().mjtJoint.mjJNT_SLIDE)


def _found(given: str | Path, folder: Path, what: str) -> Path:
    builtin = {file.stem: file for file in sorted(folder.glob("*.xml"))}
    if str(given) in builtin:
        return builtin[str(given)]
    path = Path(given)
    if not path.is_file():
        raise WorldError(
            f"there is no such {what}",
            where=str(given),
            fix=f"Name an MJCF file, or a {what} that comes with deodar: {did_you_mean(str(given), builtin)}",
        )
    return path.resolve()


def _read(path: Path) -> Any:
    try:
        return simulator().MjSpec.from_file(str(path))
    except (ValueError, RuntimeError) as error:  # MuJoCo raises the latter for what it cannot allocate
        raise WorldError(f"is not a valid MJCF file: {first_line(error)}", where=str(path)) from None
