"""The file of a cedar architecture as plain data: groups of steps with their connections and triggers.

cedar's writer stores every scalar as text and lists as objects whose keys repeat, so that objects are read
as pairs here. Earlier names of types and parameters become the present ones.
"""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Iterator, Mapping
from typing import Any, cast

from deodar import codec
from deodar.codec import Ambiguous, collect
from deodar.errors import DocumentError
from deodar.importers._beside import Beside, nothing
from deodar.importers.report import Line
from deodar.parameters import show

KINDS = {
    "cedar.processing.source.BoxInput": "cedar.processing.sources.BoxInput",
    "cedar.processing.source.ConstDiagonalMatrix": "cedar.processing.sources.ConstDiagonalMatrix",
    "cedar.processing.source.ConstMatrix": "cedar.processing.sources.ConstMatrix",
    "cedar.processing.source.GaussInput": "cedar.processing.sources.GaussInput",
    "cedar.dynamics.Noise": "cedar.processing.sources.Noise",
    "cedar.processing.Sigmoid": "cedar.processing.TransferFunction",
    "cedar.processing.steps.CountLarger": "cedar.processing.steps.Count",
    "cedar.processing.steps.VehicleRotationStep": "cedar.processing.steps.VehicleRotation",
    # renamed without an alias: cedar itself refuses these
    "cedar.processing.steps.LinearDynamics": "cedar.processing.steps.LinearFunction",
    "cedar.processing.steps.SinusDynamics": "cedar.processing.steps.Sinus",
    "cedar.processing.steps.RotationOnPlane": "cedar.processing.steps.AnglesOnPlane",
    "cedar.processing.steps.ForceLet": "cedar.processing.steps.VehicleObstacleAvoidanceForceLet",
}
"""Earlier ids of types, and the present ones."""

FIELD = {
    "restingLevel": "resting level",
    "tau": "time scale",
    "globalInhibition": "global inhibition",
    "inputNoiseGain": "input noise gain",
    "lateralKernels": "lateral kernels",
    "noiseCorrelationKernel": "noise correlation kernel",
}
"""Parameters of very old fields; cedar itself ignores these names."""

PARAMETERS: Mapping[str, Mapping[str, str]] = {
    "cedar.dynamics.NeuralField": FIELD,
    "cedar.processing.TransferFunction": {"sigmoid": "function"},
    "cedar.dynamics.HebbianConnection": {
        "input dimension": "source dimension",
        "input sizes": "source sizes",
        "association dimension": "target dimension",
        "association sizes": "target sizes",
    },
}

GAUSS = "cedar.aux.kernel.Gauss"
MOST_KERNELS = 100
"""Largest number of kernels of a very old field (a guess)."""


def renamed(kind: str, values: Mapping[str, Any]) -> Mapping[str, Any]:
    """Return the parameters of a step under their present names."""
    names = PARAMETERS.get(kind)
    if names is None:
        return values
    out = {key: value for key, value in values.items() if key not in names}
    for old, new in names.items():
        if old in values:
            out.setdefault(new, values[old])
    if "numberOfKernels" in out:
        out = _numbered(out)
    return out


def _numbered(values: dict[str, Any]) -> dict[str, Any]:
    """Return the parameters with `lateralKernel0`, `lateralKernel1`, ... as a list of kernels."""
    kernels = [values.pop(name) for k in range(MOST_KERNELS) if (name := f"lateralKernel{k}") in values]
    count = str(values.pop("numberOfKernels"))
    counted = kernels[: int(count)] if count.isdigit() else kernels
    values.setdefault("lateral kernels", collect([(GAUSS, kernel) for kernel in counted]))
    return values


MOST_STEPS = 4000
"""Largest number of steps; more are refused (a guess: many times the largest published)."""

MOST_WIRES = 20_000
"""Largest number of connections, by the same rule."""

DEEPEST = 16
"""Deepest nesting of groups (a guess, several times that of the deepest known file)."""

TEMPLATES = ("fieldTemplates.json", "elementaryBehavior.json")
"""Files of cedar's own templates of groups."""

TRIGGER = "cedar.processing.LoopedTrigger"

StepPath = tuple[str, ...]
"""Names of the groups that contain an element, then its own name."""


@dc.dataclass(frozen=True)
class CedarStep:
    """One step: its path, the id of its type, and its parameters unconverted."""

    path: StepPath
    kind: str
    values: Mapping[str, Any]

    @property
    def label(self) -> str:
        """The path as cedar writes it."""
        return ".".join(self.path)

    @property
    def short(self) -> str:
        """The last part of the id of the type."""
        return self.kind.rpartition(".")[2]


@dc.dataclass(frozen=True)
class CedarWire:
    """A connection inside a group: element and slot of the source, element and slot of the target."""

    source: str
    source_slot: str
    target: str
    target_slot: str

    def __str__(self) -> str:
        return f"{self.source}.{self.source_slot}"


@dc.dataclass(frozen=True)
class LoopedTrigger:
    """A looped trigger: its name, the elements it calls in order, and its parameters."""

    name: str
    listeners: tuple[str, ...]
    values: Mapping[str, Any]


@dc.dataclass
class CedarGroup:
    """A group of the file; the root has the path ().

    Attributes:
        path: names of the groups down to this one.
        steps: steps by name, in the order of the file.
        groups: groups by name, in the order of the file.
        wires: connections among them.
        connectors: names of the connectors, and whether each is an input.
        triggers: looped triggers.
        links: entries of `parameter links`.
        values: all keys of the group, for its own parameters.
    """

    path: StepPath
    steps: dict[str, CedarStep] = dc.field(default_factory=dict[str, CedarStep])
    groups: dict[str, CedarGroup] = dc.field(default_factory=dict[str, "CedarGroup"])
    wires: list[CedarWire] = dc.field(default_factory=list[CedarWire])
    connectors: dict[str, bool] = dc.field(default_factory=dict[str, bool])
    triggers: list[LoopedTrigger] = dc.field(default_factory=list[LoopedTrigger])
    links: list[Mapping[str, Any]] = dc.field(default_factory=list[Mapping[str, Any]])
    values: Mapping[str, Any] = dc.field(default_factory=dict[str, Any])

    def all_groups(self) -> Iterator[CedarGroup]:
        """Yield this group and all groups inside it."""
        yield self
        for group in self.groups.values():
            yield from group.all_groups()

    def all_steps(self) -> Iterator[CedarStep]:
        """Yield the steps of this group and of all groups inside it."""
        for group in self.all_groups():
            yield from group.steps.values()


@dc.dataclass(frozen=True)
class CedarFile:
    """The content of a file: the root group, and the report lines of reading."""

    root: CedarGroup
    lines: tuple[Line, ...]


def parse(content: bytes, beside: Beside = nothing) -> CedarFile:
    """Parse the content of a file of an architecture; `beside` reads files whose groups it links.

    Raises:
        DocumentError: the content is not JSON, is nested too deeply, or does not describe an architecture.
    """
    data = codec.foreign(content)
    body = members(data)
    if not {"steps", "groups", "networks", "triggers"} & set(body):
        raise DocumentError(
            "holds no architecture of cedar", fix='It is an object {"steps": {...}, "connections": [...]}'
        )
    reader = _FileReader(beside)
    root = reader.group((), body, 0)
    plugins = body.get("required", members(body.get("meta")).get("required plugins"))
    for plugin in items(plugins):
        reader.lines.append(Line("", "file", text(plugin), "dropped", "it is a plugin of cedar"))
    return CedarFile(root, tuple(reader.lines))


def pairs(value: Any) -> list[tuple[str, Any]]:
    """Return the keys and values of an object, repeated keys included; of anything else nothing."""
    if isinstance(value, Ambiguous):
        return value.pairs
    return list(cast("dict[str, Any]", value).items()) if isinstance(value, dict) else []


def members(value: Any) -> dict[str, Any]:
    """Return an object, with the first value of a repeated key, as cedar reads it; else an empty one."""
    first_values: dict[str, Any] = {}
    for key, inside in pairs(value):
        first_values.setdefault(key, inside)
    return first_values


def items(value: Any) -> list[Any]:
    """Return the entries of a list; the empty list is written as empty text."""
    return cast("list[Any]", value) if isinstance(value, list) else []


def text(value: Any) -> str:
    """Return a name as valid text: unpaired surrogates and control characters are replaced."""
    if isinstance(value, bool) or not isinstance(value, (str, int, float)):
        return ""
    valid = str(value)[:500].encode("utf-8", "replace").decode()
    return "".join(c if c.isprintable() else " " for c in valid).strip()


class _FileReader:
    def __init__(self, beside: Beside) -> None:
        self.beside = beside
        self.lines: list[Line] = []
        self.numbers: dict[tuple[StepPath, str], int] = {}
        self.steps = 0
        self.wires = 0

    def group(self, path: StepPath, body: Mapping[str, Any], level: int) -> CedarGroup:
        if level > DEEPEST:
            raise DocumentError(f"holds groups nested deeper than {DEEPEST} levels")
        body = self.whole(path, body)
        group = CedarGroup(path, values=body)
        for kind, values in pairs(body.get("steps")):
            self.step(group, kind, values)
        for key in ("groups", "networks"):
            for name, inside in pairs(body.get(key)):
                name = self.free(group, text(name) or "group", "group")
                group.groups[name] = self.group((*path, name), members(inside), level + 1)
        for entry in items(body.get("connections")):
            self.wire(group, entry)
        for name, is_input in pairs(body.get("connectors")):
            group.connectors[text(name)] = text(is_input) == "true"
        for kind, values in pairs(body.get("triggers")):
            self.trigger(group, kind, members(values))
        group.links += [members(entry) for entry in items(body.get("parameter links"))]
        if not level:
            for entry in items(body.get("scripts")):
                self.lines.append(
                    Line(
                        "", "file", text(members(entry).get("type")) or "script", "dropped", "a script in C++"
                    )
                )
        return group

    def whole(self, path: StepPath, body: Mapping[str, Any]) -> Mapping[str, Any]:
        """Return a group with the content that it links; cedar does not store it with the group."""
        template, linked = text(body.get("linked group template")), body.get("linked file")
        if not template and not linked:
            return body
        where, group_name = ".".join(path), text(body.get("linked group name")) or template
        name = text(members(linked).get("path")) or text(linked)
        name = name.replace("\\", "/").rpartition("/")[2]
        for file in [name] if name else TEMPLATES:
            try:
                content = self.beside(file)
            except DocumentError as error:
                self.lines.append(Line(where, "element", group_name, "dropped", error.problems[0].what))
                continue
            listed = {} if content is None else members(members(codec.foreign(content)).get("groups"))
            if group_name in listed:
                self.lines.append(
                    Line(where, "element", group_name, "carried", f"the group of {file}, as a copy")
                )
                own_values = {key: value for key, value in body.items() if key in ("ui generic", "name")}
                return {**members(listed[group_name]), **own_values}
        files = name or " or ".join(TEMPLATES)
        why = f"its content is in another file; put {files} beside this file"
        self.lines.append(Line(where, "element", group_name or "group", "dropped", why))
        return body

    def step(self, group: CedarGroup, kind: str, values: Any) -> None:
        self.steps += 1
        if self.steps > MOST_STEPS:
            raise DocumentError(f"holds more than {MOST_STEPS} steps")
        body = members(values)
        name = text(body.get("name"))
        where = ".".join((*group.path, name))
        if not isinstance(values, dict):
            self.lines.append(Line(where, "element", show(values), "dropped", "it is not a step"))
            return
        if not name:
            name = kind.rpartition(".")[2] or "step"
            self.lines.append(
                Line(name, "element", kind, "approximated", f"it has no name; it is called {name!r}")
            )
        name = self.free(group, name, kind)
        present = KINDS.get(kind, kind)
        group.steps[name] = CedarStep((*group.path, name), present, renamed(present, body))

    def free(self, group: CedarGroup, name: str, kind: str) -> str:
        """Return a name that is not taken in a group; names are the identity, so cedar refuses a second."""
        if "." in name:
            # a connection is split at its first dot
            self.lines.append(
                Line(
                    ".".join((*group.path, name)),
                    "element",
                    kind,
                    "approximated",
                    "its name contains a dot, where cedar splits it: connections to it do not exist",
                )
            )
        free_name, key = name, (group.path, name)
        while free_name in group.steps or free_name in group.groups:
            self.numbers[key] = self.numbers.get(key, 1) + 1
            free_name = f"{name} ({self.numbers[key]})"
        if free_name != name:
            self.lines.append(
                Line(
                    ".".join((*group.path, free_name)),
                    "element",
                    kind,
                    "approximated",
                    f"a second element named {name!r}; connections lead to the first",
                )
            )
        return free_name

    def wire(self, group: CedarGroup, entry: Any) -> None:
        self.wires += 1
        if self.wires > MOST_WIRES:
            raise DocumentError(f"holds more than {MOST_WIRES} connections")
        body = members(entry)
        ends = [text(body.get(key)).partition(".") for key in ("source", "target")]
        if not all(name and slot for name, _, slot in ends):
            self.lines.append(
                Line(".".join(group.path), "connection", show(entry), "dropped", "it does not name two slots")
            )
            return
        (source, _, out), (target, _, into) = ends
        group.wires.append(CedarWire(source, out, target, into))

    def trigger(self, group: CedarGroup, kind: str, body: Mapping[str, Any]) -> None:
        name = text(body.get("name")) or "trigger"
        where = ".".join((*group.path, name))
        if kind != TRIGGER:
            self.lines.append(Line(where, "element", kind, "dropped", "deodar has no such trigger"))
            return
        listeners = tuple(text(listener) for listener in items(body.get("listeners")))
        group.triggers.append(LoopedTrigger(name, listeners, body))
