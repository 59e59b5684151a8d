"""The simulator: it builds an architecture, runs it, and reads and writes cosivina's files."""

from __future__ import annotations

import math
import warnings
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, cast

import numpy as np

from deodar import codec, regular_file
from deodar.errors import (
    DocumentError,
    ModelError,
    ParameterError,
    RunWarning,
    UnknownName,
    did_you_mean,
    reading,
)
from deodar.importers.report import ImportReport
from deodar.model import output
from deodar.model.model import Model
from deodar_interop.compat.cosivina.elements import CLASSES, Element, FileElement
from deodar_interop.compat.cosivina.running import Running
from deodar_interop.importers.cosivina import file
from deodar_interop.importers.cosivina.constructors import components, is_fixed
from deodar_interop.importers.cosivina.translate import read
from deodar_interop.records import mat

Labels = str | Sequence[str] | None
"""A label or component, several, or none."""


class Simulator:
    """An architecture of elements, and its simulation.

    Args:
        tZero: time at the start.
        deltaT: duration of a step.
        struct: content of a file, the object under `simulator`.
        file: name of a JSON file.
        seed: seed of the noise of the first initialization; each further one counts it up.
    """

    def __init__(
        self,
        tZero: float = 0.0,
        deltaT: float = 1.0,
        *,
        struct: Mapping[str, Any] | None = None,
        file: str | Path = "",
        seed: int = 0,
    ) -> None:
        self.tZero, self.deltaT = float(tZero), float(deltaT)
        self.elements: list[Element] = []
        self._by: dict[str, Element] = {}
        self._seed = seed
        self._running: Running | None = None
        if struct is not None:
            self._build(codec.text({"simulator": struct}).encode())
        elif file:
            self._build(_content(file))

    # ----------------------------------------------------------------------------------------- architecture

    def addElement(
        self,
        element: Element,
        inputLabels: Labels = None,
        inputComponents: Labels = None,
        targetLabels: Labels = None,
        componentsForTargets: Labels = None,
    ) -> None:
        """Add an element behind the others, and connect it.

        Args:
            element: the element.
            inputLabels: labels of the elements that it reads.
            inputComponents: the component of each, or "" for the default one; may be left out.
            targetLabels: labels of elements that read it.
            componentsForTargets: the component that each of them reads, or ""; may be left out.
        """
        if not element.label or element.label in self._by:
            what = "is used already" if element.label else "is empty"
            raise ModelError(f"the label {element.label!r} {what}", fix="Choose another label")
        arriving = self._sources(inputLabels, inputComponents)
        targets = [self._element(label) for label in _listed(targetLabels)]
        leaving = _components(element, len(targets), componentsForTargets)
        self.elements.append(element)
        self._by[element.label] = element
        for label, component in arriving:
            element.addInput(label, component)
        for target, component in zip(targets, leaving, strict=True):
            target.addInput(element.label, component)
        self._running = None

    def addConnection(self, inputLabels: Labels, inputComponents: Labels, targetLabel: str) -> None:
        """Add connections from existing elements to one existing element."""
        target = self._element(targetLabel)
        for label, component in self._sources(inputLabels, inputComponents):
            target.addInput(label, component)
        self._running = None

    @property
    def elementLabels(self) -> list[str]:
        """The labels, in the order of the list."""
        return [e.label for e in self.elements]

    @property
    def nElements(self) -> int:
        """The number of elements."""
        return len(self.elements)

    def isElement(self, elementLabel: str) -> bool:
        """Return whether an element has a label."""
        return elementLabel in self._by

    def getElement(self, elementLabel: str) -> Element | None:
        """Return an element; None if none has the label."""
        return self._by.get(elementLabel)

    # ---------------------------------------------------------------------------------------------- running

    @property
    def initialized(self) -> bool:
        """Whether `init` was called since the architecture changed."""
        return self._running is not None

    @property
    def t(self) -> float:
        """The present time."""
        return self.tZero if self._running is None else self._running.time

    @property
    def report(self) -> ImportReport:
        """The report of the translation of the present architecture."""
        return read(self.content(), "simulator.json").report

    @property
    def model(self) -> Model:
        """The model that deodar runs, of the present architecture."""
        return read(self.content(), "simulator.json").model

    def init(self) -> None:
        """Set the time to `tZero`, and all elements to their initial state.

        Warns:
            RunWarning: deodar has no counterpart of an element or a connection.
        """
        self._running = Running(self.content(), self._seed)
        self._seed += 1
        lost = self._running.report.losses
        _warn([str(line) for line in lost if line.part != "parameter" or line.verdict == "approximated"])

    def step(self) -> None:
        """Advance by one step."""
        self._ready().step(1)

    def run(self, tMax: float, initialize: bool = False, closeWhenFinished: bool = False) -> None:
        """Advance to a time.

        Args:
            tMax: the time.
            initialize: whether to begin at `tZero`.
            closeWhenFinished: whether to close the elements then.
        """
        if initialize:
            self._running = None
        running = self._ready()
        running.step(max(math.ceil((tMax - running.time) / self.deltaT - 1e-9), 0))
        if closeWhenFinished:
            self.close()

    def close(self) -> None:
        """Close the elements: none of them has anything to close."""

    # --------------------------------------------------------------------------------- components, parameters

    def getComponent(self, elementLabel: str, componentName: str) -> np.ndarray:
        """Return the present value of a component, an array of at least two dimensions.

        It is a copy; a script that plots calls this again after each step.
        """
        element = self._element(elementLabel)
        return self._ready().component(element.label, componentName)

    def getElementParameter(self, elementLabel: str, parameterName: str) -> Any:
        """Return the value of a parameter."""
        element = self._element(elementLabel)
        return getattr(element, _parameter(element, parameterName))

    def setElementParameters(
        self,
        elementLabels: str | Sequence[str],
        parameterNames: str | Sequence[str],
        newValues: Any,
    ) -> None:
        """Change parameters; states stay. A kernel that is changed in a run acts from its next step on.

        Args:
            elementLabels: a label for each parameter, or one label for all.
            parameterNames: the parameters.
            newValues: a value for each.
        """
        labels, names = _listed(elementLabels), _listed(parameterNames)
        values = cast("list[Any]", newValues) if isinstance(newValues, list) else [newValues]
        labels = labels * len(names) if len(labels) == 1 else labels
        if not len(labels) == len(names) == len(values):
            raise ParameterError(
                f"{len(labels)} labels, {len(names)} names and {len(values)} values do not fit together"
            )
        elements = [self._element(label) for label in labels]
        for element, name in zip(elements, names, strict=True):
            if is_fixed(element.kind, _parameter(element, name)):
                raise ParameterError("cannot be changed", where=f"{element.label}: {name}")
        for element, name, value in zip(elements, names, values, strict=True):
            setattr(element, name, value)

    # ------------------------------------------------------------------------------------------------- files

    def saveSettings(self, filename: str | Path) -> bool:
        """Write architecture and parameters as a JSON file; an existing file is replaced."""
        output.write(Path(filename), self.content())
        return True

    def loadSettings(self, filename: str | Path, parameters: str = "changeable") -> bool:
        """Take the parameters of elements of the same label and class from a file.

        Args:
            filename: the JSON file.
            parameters: `changeable`, or `all` for sizes too.

        Warns:
            RunWarning: an element occurs on one side alone.
        """
        if parameters not in ("changeable", "all"):
            raise ParameterError(f"expected 'changeable' or 'all', got {parameters!r}")
        found = file.parse(_content(filename))
        self.deltaT, self.tZero = found.step, found.start
        there = {e.label: e for e in found.elements}
        unmatched: list[str] = []
        for element in self.elements:
            other = there.pop(element.label, None)
            if other is None or other.kind != element.kind:
                unmatched.append(f"{element.label}: the file has no such {element.kind}")
                continue
            for name, value in other.values.items():
                if element.isParameter(name) and (parameters == "all" or not is_fixed(element.kind, name)):
                    setattr(element, name, value)
        _warn([*unmatched, *(f"{label}: the simulator has no such element" for label in there)])
        self._running = None
        return True

    def saveComponentsToMat(self, filename: str | Path) -> None:
        """Write the components of all elements as a file of MATLAB; an existing file is replaced."""
        running = self._ready()
        elements = [
            {"label": e.label, **{c: running.component(e.label, c) for c in running.shown(e.label)}}
            for e in self.elements
        ]
        mat.write({"elements": elements}, Path(filename))

    # ------------------------------------------------------------------------------------------------ inside

    def content(self) -> bytes:
        """Return the content of a file, as `saveSettings` writes it."""
        entries = [
            {
                "label": e.label,
                "class": e.kind,
                "param": {name: _plain(v) for name, v in e.values.items() if v is not None},
                "nInputs": e.nInputs,
                "input": [
                    {"label": label, "component": component}
                    for label, component in zip(e.inputElementLabels, e.inputComponents, strict=True)
                ],
            }
            for e in self.elements
        ]
        body = {"deltaT": self.deltaT, "tZero": self.tZero, "nElements": len(entries)}
        return codec.text(
            {"simulator": {**body, "elementLabels": self.elementLabels, "elements": entries}}
        ).encode()

    def _build(self, content: bytes) -> None:
        """Take over the elements of a file."""
        found = file.parse(content)
        self.tZero, self.deltaT = found.start, found.step
        for e in found.elements:
            cls = CLASSES.get(e.kind)
            if cls is None:
                element: Element = FileElement(e.label, e.kind, e.values)
            else:
                element = cls(e.label)
                for name, value in e.values.items():
                    if name in cls.PARAMETERS:
                        setattr(element, name, value)
            for s in e.sources:
                element.addInput(s.label, s.component)
            self.elements.append(element)
            self._by[e.label] = element

    def _ready(self) -> Running:
        """Return the running simulation, with the present parameters; begin one if there is none."""
        if self._running is None:
            self.init()
        assert self._running is not None
        self._running.take(self.content())
        return self._running

    def _element(self, label: str) -> Element:
        if label not in self._by:
            raise UnknownName(f"no element has the label {label!r}", fix=did_you_mean(label, self._by))
        return self._by[label]

    def _sources(self, labels: Labels, given: Labels) -> list[tuple[str, str]]:
        """Return label and component of each source."""
        sources = [self._element(label) for label in _listed(labels)]
        listed = _listed(given) or [""] * len(sources)
        if len(listed) != len(sources):
            raise ParameterError(f"{len(sources)} labels and {len(listed)} components do not fit together")
        return [
            (source.label, _components(source, 1, name)[0])
            for source, name in zip(sources, listed, strict=True)
        ]


def _content(path: str | Path) -> bytes:
    with reading(path, DocumentError):
        return regular_file.read_bytes(Path(path))


def _warn(what: Sequence[str]) -> None:
    """Warn at the call of the method of the simulator."""
    if what:
        warnings.warn("; ".join(what), RunWarning, stacklevel=3)


def _listed(names: Labels) -> list[str]:
    return [names] if isinstance(names, str) else list(names or ())


def _components(source: Element, count: int, given: Labels) -> list[str]:
    """Return the component for each of some readers; "" means the default one."""
    names = _listed(given) or [""] * count
    if len(names) != count:
        raise ParameterError(f"{count} targets and {len(names)} components do not fit together")
    default = source.defaultOutputComponent if type(source) is not FileElement else ""
    for name in names:
        if name and not source.isComponent(name):
            raise UnknownName(
                f"{source.label!r} has no component {name!r}",
                fix=did_you_mean(name, list(components(source.kind))),
            )
    return [name or default for name in names]


def _parameter(element: Element, name: str) -> str:
    if not element.isParameter(name):
        raise UnknownName(
            f"{element.label!r} has no parameter {name!r}", fix=did_you_mean(name, element.parameterList())
        )
    return name


def _plain(value: Any) -> Any:
    """Return a value as JSON holds it."""
    if isinstance(value, np.ndarray):
        return _plain(value.tolist())
    if isinstance(value, (list, tuple)):
        return [_plain(v) for v in cast("list[Any]", value)]
    if isinstance(value, (bool, np.bool_)):
        return int(value)
    return value.item() if isinstance(value, np.generic) else value
