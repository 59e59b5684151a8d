"""Types without a counterpart: a placeholder keeps their place and connections, and says what is missing."""

from __future__ import annotations

from collections.abc import Sequence

from deodar.elements.placeholder import Placeholder
from deodar_interop.importers._missing import unknown
from deodar_interop.importers.cedar.file import CedarStep, text
from deodar_interop.importers.cedar.grid import Counts
from deodar_interop.importers.cedar.piece import InputSlot, OutputSlot, StepPiece

ARM = "dd.MuJoCo"
VEHICLE = "dd.Arena"
OWN = "a world of your own (a subclass of dd.World) can do so, read by a Sensor and driven by a Motor"

WORLDS = {
    "Component": "is a part of a robot",
    "ForwardKinematics": f"computes the position of a robot's tool; {ARM} has it as the sensor tool",
    "Jacobian": f"computes the Jacobian of a robot; the motor tool_velocity of {ARM} contains it",
    "PseudoInverseKinematics": f"moves a robot's tool; {ARM} has the motor tool_velocity",
    "DampedPseudoInverseKinematics": f"moves a robot's tool; {ARM} has the motor tool_velocity",
    "ConfigurationLimits": f"gives the limits of a robot; {ARM} keeps those of its model",
    "Nullspace": f"computes the null space of a Jacobian; the motor tool_velocity of {ARM} contains it",
    "VehicleRotation": f"turns a vehicle; {VEHICLE} has the motors left and right",
    "VehicleObstacleAvoidanceForceLet": (
        f"keeps a vehicle away from obstacles; ObstacleRepulsion does so in {VEHICLE}"
    ),
    "AnglesOnPlane": "computes the angle between two vectors; write an element of your own",
    "CoordinateToCameraAngles": f"turns a camera to a position; a camera of {ARM} is where its scene puts it",
    "AllocentricToDistanceImage": "projects a map into a picture of distances; Homography projects planes",
    "DistanceImageCoordinateTransform": (
        f"projects a picture of distances into a map; the sensor obstacles of {VEHICLE} is such a map"
    ),
    "HeadCenteredTransform": "turns a picture into angles of the head; Homography projects planes",
    "InvHeadCenteredTransform": "turns angles of the head into a picture; Homography projects planes",
    "Camera": "reads a camera; open dd.Camera as world and read it by a Sensor",
    "CameraStream": "reads a camera; open dd.Camera as world and read it by a Sensor",
    "Video": "reads a video; open dd.Video as world and read it by a Sensor",
    "Picture": "reads a picture; open dd.Picture as world and read it by a Sensor",
    "VirtualCamera": f"draws a scene; cameras of {ARM} and {VEHICLE} are sensors of these worlds",
    "RealSense": f"reads a camera of depth; {OWN}",
    "NetReader": f"reads from a network; {OWN}",
    "NetWriter": f"writes to a network; {OWN}",
    "TCPReader": f"reads from a network; {OWN}",
    "TCPWriter": f"writes to a network; {OWN}",
    "LocalReader": "reads from another part of the program; connect its source, with reads='delayed'",
    "LocalWriter": "writes to another part of the program; connect it to the reader, with reads='delayed'",
    "PythonScript": "runs a script in Python; write an element of your own, or Function",
    "PythonScriptLooped": "runs a script in Python; write an element of your own, or Function",
    "VideoSink": "writes a video; deodar export writes one of a record",
    "ShapeVisualisation": f"shows an object in a scene; {ARM} and {VEHICLE} show theirs",
    "DNN": f"computes a trained network; {OWN}",
    "CSVToPhoneme": "plays the rows of a file; TimeSeries gives values at stated times",
    "LogTimeInterval": "writes times of events to a file; those of dd.Experiment are in its rows",
    "pairsGame": f"plays a game of cards; {OWN}",
}
"""What steps of robots, cameras, files and the network do, and what takes their place."""

ROBOTS = {
    "epuck": VEHICLE,
    "khepera": VEHICLE,
    "chassis": VEHICLE,
    "drive": VEHICLE,
    "caren": ARM,
    "cora": ARM,
    "youbot": ARM,
    "twodarm": ARM,
    "kuka": ARM,
    "arm": ARM,
    "head": ARM,
    "trunk": ARM,
}
"""The world for a robot or a part of one, by a word in the path of the component; the first that is found."""

SIGNALS = {
    "Joint Angles": "sensor joint_angles",
    "Joint Velocities": "sensor joint_velocities, or the velocity actuators of the scene as motors",
    "Wheel Speed": "motors left and right",
    "Wheel Velocities": "motors left and right",
    "Forward Velocity": "motors left and right",
    "Turning Rate": "motors left and right",
    "Encoders": "sensor encoders",
    "Camera Picture": "sensor camera",
    "IR values": "sensor infrared",
    "proximity": "sensor infrared",
}
"""Sensors and motors that take the place of measurements and commands of a component."""

UNDOCUMENTED = {
    "CoordinateTransformation": "the mapping of its rows and columns to radius and angle",
    "WeightedSum": "its weights, and how two dimensions and its noise enter",
    "DiagonalReadout": "the direction of its diagonals, and the size of its result",
    "LinearLateralShift": "the positions of its samples, and what lies between and beyond them",
    "ShiftedMultiplication": "its rotations, and the size of its result",
    "ImageGradient": "the border, the unit of its orientations and its rounding to 8 bits",
    "TemplateMatching": "which normalisation of the cross-correlation it has, and the size of its result",
    "ImageTransform": "the centre of its rotation, and the order of rotation, scaling and translation",
    "NeuralCoordinateTransform": "what it convolves over which border, and which slice it gives",
    "TwoStepInput": "when its countdown begins, and how it moves",
    "ViewportCamera": "the position of its window, and how it learns",
    "ViewportSlice": "the position of its window",
    "ResetDetector": "whether it also gives 1 at the start of a run",
    "UnitConverter": "what follows from the unit of a value",
}
"""What cedar's documentation does not state of steps that deodar could compute."""


def placeholder(
    step: CedarStep, kinds: list[str], ins: list[str], outs: list[str], why: str = "", stops: str = ""
) -> StepPiece:
    """Return a placeholder for a step, with the reason.

    Args:
        step: the step.
        kinds: ids of the types that are translated.
        ins: input slots that connections name.
        outs: output slots that connections name.
        why: the reason, if it is not the type.
        stops: why cedar does not run the step.
    """
    reason = _reason(step, [*ins, *outs]) or unknown(step.kind, "has no counterpart", kinds)
    if why:
        # of a step that is translated elsewhere: what takes its place with a robot, too
        reason = f"{why}; it {WORLDS[step.short]}" if step.short in WORLDS and step.kind in kinds else why
    name = step.path[-1]
    dims: Counts = ()
    return StepPiece(
        [Placeholder(name, (), f"{step.kind}: {reason}")],
        {slot: [[InputSlot(name)]] for slot in ins},
        {slot: OutputSlot(name, dims, state=True) for slot in outs},
        sums=frozenset(ins),
        stops=stops,
        verdict="dropped",
        why=f"Placeholder: {reason}",
    )


def _reason(step: CedarStep, slots: Sequence[str]) -> str:
    """Return why a known type has no counterpart, and what to use; "" for others."""
    if step.short == "Component":
        return f"{WORLDS['Component']}; {_component(step, slots)}"
    if step.short in UNDOCUMENTED:
        return f"its computation is not documented: {UNDOCUMENTED[step.short]}"
    return WORLDS.get(step.short, "")


def _component(step: CedarStep, slots: Sequence[str]) -> str:
    """Return the world for a part of a robot, and its signals for the slots that are connected."""
    path = text(step.values.get("component"))
    wheels = text(step.values.get("Command Subset")) == "differential drive interface"
    named = (world for word, world in ROBOTS.items() if word in path.lower())
    world = VEHICLE if wheels else next(named, "")
    replaced = f" in place of {path!r}" if path else ""
    signals = [f"{slot}: {SIGNALS[slot]}" for slot in slots if slot in SIGNALS]
    use = f"open {world} as world" if world else f"open {VEHICLE} for a vehicle or {ARM} for an arm as world"
    return f"{use}{replaced}" + (f" ({'; '.join(signals)})" if signals else "")


LOOPED = frozenset(
    {
        "cedar.dynamics.CSVToPhoneme",
        "cedar.dynamics.LogTimeInterval",
        "cedar.dynamics.ViewportCamera",
        "cedar.dynamics.ViewportSlice",
        "cedar.dynamics.steps.TwoStepInput",
        "cedar.processing.VideoSink",
        "cedar.processing.sinks.LocalWriter",
        "cedar.processing.sinks.NetWriter",
        "cedar.processing.sinks.TCPWriter",
        "cedar.processing.sources.LocalReader",
        "cedar.processing.sources.NetReader",
        "cedar.processing.sources.RealSense",
        "cedar.processing.sources.TCPReader",
        "cedar.processing.sources.VirtualCamera",
        "cedar.processing.steps.Component",
        "cedar.processing.steps.ConfigurationLimits",
        "cedar.processing.steps.DNN",
        "cedar.processing.steps.DampedPseudoInverseKinematics",
        "cedar.processing.steps.ForwardKinematics",
        "cedar.processing.steps.Jacobian",
        "cedar.processing.steps.PseudoInverseKinematics",
        "cedar.processing.steps.PythonScriptLooped",
        "cedar.processing.steps.VehicleRotation",
    }
)
