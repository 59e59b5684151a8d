"""Types without a counterpart: a placeholder keeps their place and connections, and says what is missing."""

from __future__ import annotations

from deodar.elements.placeholder import Placeholder
from deodar.importers._missing import unknown
from deodar.importers.cedar.file import CedarStep
from deodar.importers.cedar.grid import Counts
from deodar.importers.cedar.piece import InputSlot, OutputSlot, StepPiece

WORLDS = {
    "Component": "is a part of a robot; open a world with its sensors and motors, such as dd.MuJoCo",
    "ForwardKinematics": "computes the position of a robot's tool; dd.MuJoCo has it as the sensor tool",
    "Jacobian": "computes the Jacobian of a robot; the motor tool_velocity of dd.MuJoCo contains it",
    "PseudoInverseKinematics": "moves a robot's tool; dd.MuJoCo has the motor tool_velocity",
    "DampedPseudoInverseKinematics": "moves a robot's tool; dd.MuJoCo has the motor tool_velocity",
    "ConfigurationLimits": "gives the limits of a robot; dd.MuJoCo keeps those of its model",
    "VehicleRotation": "turns a vehicle; dd.Arena has wheels as motors",
    "VehicleObstacleAvoidanceForceLet": "keeps a vehicle away from obstacles; see ObstacleRepulsion",
    "Camera": "reads a camera; open dd.Camera as world and read it by a Sensor",
    "CameraStream": "reads a camera; open dd.Camera as world and read it by a Sensor",
    "Video": "reads a video; open dd.Video as world and read it by a Sensor",
    "Picture": "reads a picture; open dd.Picture as world and read it by a Sensor",
    "VirtualCamera": "draws a scene; dd.MuJoCo has cameras",
    "RealSense": "reads a camera of depth",
    "NetReader": "reads from a network",
    "NetWriter": "writes to a network",
    "TCPReader": "reads from a network",
    "TCPWriter": "writes to a network",
    "LocalReader": "reads from another part of the program",
    "LocalWriter": "writes to another part of the program",
    "PythonScript": "runs a script in Python",
    "PythonScriptLooped": "runs a script in Python",
    "VideoSink": "writes a video; deodar export writes one of a record",
    "ShapeVisualisation": "shows an object in a scene",
}
"""What steps of robots, cameras and the network do, and what takes their place."""


def placeholder(
    step: CedarStep, known: list[str], ins: list[str], outs: list[str], why: str = "", stops: str = ""
) -> StepPiece:
    """Return a placeholder for a step, with the reason.

    Args:
        step: the step.
        known: ids of the types that are translated.
        ins: input slots that connections name.
        outs: output slots that connections name.
        why: the reason, if it is not the type.
        stops: why cedar does not run the step.
    """
    what = why or WORLDS.get(step.short, "") or unknown(step.kind, "has no counterpart", known)
    name = step.path[-1]
    dims: Counts = ()
    return StepPiece(
        [Placeholder(name, (), f"{step.kind}: {what}")],
        {slot: [[InputSlot(name)]] for slot in ins},
        {slot: OutputSlot(name, dims, state=True) for slot in outs},
        sums=frozenset(ins),
        stops=stops,
        verdict="dropped",
        why=f"Placeholder: {what}",
    )
