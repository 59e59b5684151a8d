"""Edits of a document as data: what the fix of a problem proposes, and its text for each reader.

Each edit is one call of a method of `deodar.Model`. `deodar.model.proposed.apply` makes it.
"""

from __future__ import annotations

import abc
import shlex
from dataclasses import dataclass, replace
from typing import Any, Literal

Medium = Literal["script", "shell", "page"]
"""Where a message is read: a script or notebook, a shell that ran `deodar`, or the page of the studio."""

EditValue = bool | int | float | str | tuple[Any, ...]
"""A value of an edit: what JSON can hold, with tuples for lists."""


class ProposedEdit(abc.ABC):
    """One edit of a document."""

    @abc.abstractmethod
    def at(self, place: Medium) -> str:
        """Return what to write at a place."""

    @abc.abstractmethod
    def plain_data(self) -> dict[str, Any]:
        """Return the edit as plain data, for programs that read the answer of a command."""


@dataclass(frozen=True)
class SetValues(ProposedEdit):
    """Set parameters of one element, or document parameters, in one step.

    Attributes:
        values: paths inside the element (`kernel.0.sigma`), each with its new value.
        element: path of the element; "": the paths are those of document parameters; None: the element that
            has the problem.
    """

    values: tuple[tuple[str, EditValue], ...]
    element: str | None = None

    def inside(self, element: str) -> SetValues:
        """Return the edit for an element, unless it names one."""
        return self if self.element is not None else replace(self, element=element)

    def paths(self) -> dict[str, EditValue]:
        """Return the new values by their paths in the document."""
        return {f"{self.element}.{path}" if self.element else path: setting for path, setting in self.values}

    def plain_data(self) -> dict[str, Any]:
        """Return the edit as plain data."""
        return {"set": self.paths()}

    def at(self, place: Medium) -> str:
        """Return what to write at a place."""
        values = self.paths()
        if place == "page":
            return ", ".join(f"{path} = {_written(setting)}" for path, setting in values.items())
        if place == "shell":
            return " ".join(
                f"--set {shlex.quote(f'{path}={_written(setting, shell=True)}')}"
                for path, setting in values.items()
            )
        pairs = [(f'"{path}"' if '"' not in path else repr(path), _written(v)) for path, v in values.items()]
        if len(pairs) == 1:
            return f"model.set({pairs[0][0]}, {pairs[0][1]})"
        return f"model.set({{{', '.join(f'{path}: {setting}' for path, setting in pairs)}}})"


@dataclass(frozen=True)
class SetAxis(ProposedEdit):
    """Change an axis, in every element that has it.

    Attributes:
        axis: its key in the document.
        values: what changes, by the names of the arguments of `deodar.Axis`.
    """

    axis: str
    values: tuple[tuple[str, EditValue], ...]

    def plain_data(self) -> dict[str, Any]:
        """Return the edit as plain data."""
        return {"axis": self.axis, "set": dict(self.values)}

    def at(self, place: Medium) -> str:
        """Return what to write at a place."""
        if place == "script":
            arguments = ", ".join(f"{name}={_written(setting)}" for name, setting in self.values)
            key = repr(self.axis) if '"' in self.axis else f'"{self.axis}"'
            return f"model.set_axis({key}, {arguments})"
        changes = ", ".join(f"{name} = {_written(setting, shell=True)}" for name, setting in self.values)
        where = f"in the file, axes.{self.axis}" if place == "shell" else f"axis {self.axis}"
        return f"{where}: {changes}"


@dataclass(frozen=True)
class SetStep(ProposedEdit):
    """Set the Euler step of the document."""

    dt: float

    def plain_data(self) -> dict[str, Any]:
        """Return the edit as plain data."""
        return {"dt": self.dt}

    def at(self, place: Medium) -> str:
        """Return what to write at a place."""
        number = _written(self.dt)
        return {"script": f"model.describe(dt={number})", "shell": f"--dt {number}"}.get(
            place, f"dt = {number}"
        )


@dataclass(frozen=True)
class Disconnect(ProposedEdit):
    """Remove the connection between two ports, by their paths."""

    source: str
    target: str

    def plain_data(self) -> dict[str, Any]:
        """Return the edit as plain data."""
        return {"disconnect": [self.source, self.target]}

    def at(self, place: Medium) -> str:
        """Return what to write at a place."""
        if place == "script":
            return f"model.disconnect({self.source!r}, {self.target!r})"
        return f"remove the connection {self.source} -> {self.target}"


@dataclass(frozen=True)
class SetSourcePort(ProposedEdit):
    """Set which output port of its source a connection reads.

    Attributes:
        source: path of the output port that it reads.
        target: path of its input port.
        port: path of the output port that it will read.
        reads: the instant that the connection states and keeps; "": none.
    """

    source: str
    target: str
    port: str
    reads: str = ""

    def plain_data(self) -> dict[str, Any]:
        """Return the edit as plain data."""
        return {"connection": [self.source, self.target], "set": {"source": self.port}}

    def at(self, place: Medium) -> str:
        """Return what to write at a place."""
        if place == "script":
            gone = f"model.disconnect({self.source!r}, {self.target!r})"
            reads = f", reads={self.reads!r}" if self.reads else ""
            return f"{gone} and model.connect({self.port!r}, {self.target!r}{reads})"
        where = "in the file, " if place == "shell" else ""
        return f"{where}connect {self.port} to {self.target} in place of {self.source}"


@dataclass(frozen=True)
class SetReads(ProposedEdit):
    """Set which instant a connection reads.

    Attributes:
        source: path of its output port.
        target: path of its input port.
        reads: previous, current or delayed; "": none is stated.
    """

    source: str
    target: str
    reads: str

    def plain_data(self) -> dict[str, Any]:
        """Return the edit as plain data."""
        return {"connection": [self.source, self.target], "set": {"reads": self.reads}}

    def at(self, place: Medium) -> str:
        """Return what to write at a place."""
        if place == "script":
            ends = f"{self.source!r}, {self.target!r}"
            reads = f", reads={self.reads!r}" if self.reads else ""
            return f"model.disconnect({ends}) and model.connect({ends}{reads})"
        reads = f"with reads = {self.reads}" if self.reads else "without reads"
        where = "in the file, " if place == "shell" else ""
        return f"{where}the connection {self.source} -> {self.target} {reads}"


@dataclass(frozen=True)
class InsertCoupling(ProposedEdit):
    """Put a new coupling over the axes of a port into the connection to it.

    Attributes:
        ends: path of the source and its output port, path of the target and its input port.
        kind: kind of the coupling.
        axes: names of its axes, those of the input port.
        rename: names of axes of the source, each with the one that it becomes.
    """

    ends: tuple[str, str, str, str]
    kind: str
    axes: tuple[str, ...]
    rename: tuple[tuple[str, str], ...]

    def values(self) -> dict[str, Any]:
        """Return the parameters of the coupling, without its axes."""
        return {"rename": dict(self.rename)} if self.rename else {}

    def plain_data(self) -> dict[str, Any]:
        """Return the edit as plain data."""
        source, out, target, port = self.ends
        wire = [f"{source}.{out}", f"{target}.{port}"]
        return {"insert": self.kind, "connection": wire, "set": self.values()}

    def at(self, place: Medium) -> str:
        """Return what to write at a place."""
        values = "".join(f", {name}={setting!r}" for name, setting in self.values().items())
        coupling = f"{self.kind}([{', '.join(self.axes)}]{values})"
        source, out, target, port = self.ends
        if place == "shell":
            return f"in the file, put a {coupling} into the connection {source}.{out} -> {target}.{port}"
        if place == "page":
            renames = " and ".join(f"{name!r} to {new!r}" for name, new in self.rename)
            return f"a new {self.kind} between {source} and {target} renames {renames}"
        gone = f"model.disconnect({f'{source}.{out}'!r}, {f'{target}.{port}'!r})"
        first, last = (path if path.isidentifier() else f"model[{path!r}]" for path in (source, target))
        first += "" if out == "output" else f"[{out!r}]"
        last += "" if port == "input" else f"[{port!r}]"
        return f"{gone} and {first} >> {coupling} >> {last}"


def rounded(setting: float, digits: int = 2) -> float:
    """Return a number with few digits, as a person would choose it."""
    return float(f"{setting:.{digits}g}")


def _written(setting: EditValue, shell: bool = False) -> str:
    """Return a value as it is written in Python, or in JSON for a shell."""
    if isinstance(setting, bool):
        return str(setting).lower() if shell else str(setting)
    if isinstance(setting, (int, float)):
        return f"{setting:.12g}"
    if isinstance(setting, str):
        return setting if shell else f'"{setting}"'
    if not isinstance(setting, tuple):
        return str(setting)  # an axis
    items = [_written(v, shell) for v in setting]
    return f"[{','.join(items)}]" if shell else f"[{', '.join(items)}]"
