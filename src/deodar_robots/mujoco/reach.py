"""The motion of a tool: joint velocities for a velocity of the tool in space, inside all limits."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from deodar_robots.mujoco.scene_file import TOOL, is_scalar, simulator

DAMPING = 0.1
"""Largest damping factor of the pseudo-inverse, m/rad (a guess; the arm has links of 0.4 m)."""

SINGULAR = 0.04
"""Manipulability, m3, below which the pseudo-inverse is damped (a guess)."""

POSTURE = 0.5
"""Rate at which joints return to the posture of the start, without moving the tool, 1/s (a guess)."""

MARGIN = 0.02
"""Distance from the end of a joint's range at which it stops, rad."""

HOLD, FASTEST_HOLD = 4.0, 0.25
"""Rate (1/s) and largest speed (m/s) at which the tool returns to its height, for motion in a plane."""


@dataclass(frozen=True)
class Arm:
    """Joints of a robot that velocity actuators move, and the site that is its tool.

    Attributes:
        site: number of the tool's site.
        actuators: places of the actuators' commands among those of all.
        dofs, places: index of each joint in velocities and in positions.
        lower, upper: range of each joint.
        fastest: largest speed of each joint.
        posture: positions of the joints at the start.
    """

    site: int
    actuators: np.ndarray
    dofs: np.ndarray
    places: np.ndarray
    lower: np.ndarray
    upper: np.ndarray
    fastest: np.ndarray
    posture: np.ndarray

    @classmethod
    def find(cls, model: Any, home: dict[str, float]) -> Arm | None:
        """Find the arm of a model; None without a site `tool` or without velocity actuators."""
        mujoco = simulator()
        site = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_SITE, TOOL)
        joints: dict[int, int] = {}
        for k in range(model.nactuator):
            joint = int(model.actuator_trnid[k, 0])
            of_joint = int(model.actuator_trntype[k]) == int(mujoco.mjtTrn.mjTRN_JOINT)
            gain, bias = model.actuator_gainprm[k, 0], model.actuator_biasprm[k]
            if of_joint and is_scalar(model, joint) and bias[1] == 0 and gain > 0 and bias[2] == -gain:
                joints.setdefault(joint, int(model.actuator_ctrladr[k]))
        if site < 0 or not joints:
            return None
        numbers, actuators = list(joints), list(joints.values())
        limited = np.asarray(model.jnt_limited)[numbers].astype(bool)
        low, high = np.asarray(model.jnt_range, float)[numbers].T
        bounded = np.asarray(model.actuator_ctrllimited)[actuators].astype(bool)
        speed = np.abs(np.asarray(model.actuator_ctrlrange, float)[actuators]).min(axis=1)
        return cls(
            site,
            np.array(actuators),
            np.asarray(model.jnt_dofadr)[numbers],
            np.asarray(model.jnt_qposadr)[numbers],
            np.where(limited, low, -np.inf),
            np.where(limited, high, np.inf),
            np.where(bounded, speed, np.inf),
            np.array([home.get(model.joint(j).name, 0.0) for j in numbers]),
        )

    def velocities(self, model: Any, data: Any, wanted: np.ndarray, horizon: float) -> np.ndarray:
        """Return joint velocities that move the tool with a wanted velocity (x, y, z, m/s).

        They are J^T (J J^T + d^2 I)^-1 v, with the Jacobian J of the tool and a damping d that is 0 except
        near singular poses, plus a motion towards the posture in the null space of J. A joint that would
        leave its range within `horizon` seconds stops there, and the others take over its part. Too fast
        motions are slowed down as a whole, so that the tool keeps its direction.

        Reference:
            Nakamura & Hanafusa (1986), Inverse kinematic solutions with singularity robustness for robot
            manipulator control, J. Dyn. Sys. Meas. Control 108(3), eqs. 19 and 33.
        """
        whole = np.zeros((3, model.nv))
        simulator().mj_jacSite(model, data, whole, None, self.site)
        q = np.asarray(data.qpos)[self.places]
        least = np.minimum(0.0, (self.lower + MARGIN - q) / horizon)
        most = np.maximum(0.0, (self.upper - MARGIN - q) / horizon)
        speeds, free = np.zeros(len(q)), np.ones(len(q), bool)
        for _ in range(len(q)):
            jacobian = whole[:, self.dofs] * free
            speeds = _solved(jacobian, wanted, POSTURE * (self.posture - q) * free) * free
            stopped = (speeds < least) | (speeds > most)
            if not stopped.any():
                break
            free &= ~stopped
        speeds = np.clip(speeds * free, least, most)
        return speeds / max(1.0, float(np.max(np.abs(speeds) / self.fastest, initial=0.0)))

    def plane(self, data: Any, wanted: np.ndarray, height: float) -> np.ndarray:
        """Return the velocity of the tool for a wanted one along x and y that keeps its height."""
        off = height - float(data.site_xpos[self.site][2])
        return np.array([*wanted, np.clip(HOLD * off, -FASTEST_HOLD, FASTEST_HOLD)])

    def limit(self, data: Any) -> None:
        """Keep the joints inside their ranges and below their largest speeds, whatever pushes them."""
        q, v = np.asarray(data.qpos)[self.places], np.asarray(data.qvel)[self.dofs]
        held = np.clip(q, self.lower, self.upper)
        v = np.clip(v, -self.fastest, self.fastest)
        v = np.where((held > q) & (v < 0) | (held < q) & (v > 0), 0.0, v)
        data.qpos[self.places], data.qvel[self.dofs] = held, v


def _solved(jacobian: np.ndarray, wanted: np.ndarray, preferred: np.ndarray) -> np.ndarray:
    square = jacobian @ jacobian.T
    measure = np.sqrt(max(0.0, float(np.linalg.det(square))))
    damping = (DAMPING * (1 - measure / SINGULAR)) ** 2 if measure < SINGULAR else 0.0
    inverse = jacobian.T @ np.linalg.inv(square + (damping + 1e-9) * np.eye(3))
    return inverse @ wanted + preferred - inverse @ (jacobian @ preferred)
