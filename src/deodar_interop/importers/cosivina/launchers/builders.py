"""The methods of simulators and windows that build a model: `addElement`, `addControl` and others."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Protocol

import numpy as np

from deodar.importers.report import Line
from deodar_interop.importers.cosivina.classes import CLASSES
from deodar_interop.importers.cosivina.constructors import (
    CONSTRUCTORS,
    OUTPUTS,
    components,
    is_fixed,
    parameters_of,
)
from deodar_interop.importers.cosivina.file import Simulator
from deodar_interop.importers.cosivina.launchers import matlab_values
from deodar_interop.importers.cosivina.launchers.expressions import NotRead
from deodar_interop.importers.cosivina.launchers.objects import (
    BuiltElement,
    BuiltSimulator,
    BuiltWindow,
    ClassCall,
    MissingValue,
)

ElementArguments = Sequence[Any]

QUIET = frozenset(
    (
        *("init", "run", "step", "close", "tryInit", "tryStep", "runWithTimer", "stepWithTimer"),
        *("saveSettings", "updateVisualizations", "checkAndUpdateControls", "delete"),
    )
)
"""Methods that run a simulator or draw its window, and change nothing of the model."""


class ElementBuilder(Protocol):
    """What the methods need of the script."""

    line: int
    lines: list[Line]

    def say(self, why: str) -> None:
        """Report that something of the present statement is not read."""
        ...

    def file(self, name: str) -> Simulator:
        """Return the simulator of a file beside the script."""
        ...


def simulator(script: ElementBuilder, arguments: ElementArguments) -> BuiltSimulator:
    """Return the simulator of a call `Simulator(name, value, ...)`."""
    built = BuiltSimulator()
    for name, value in zip(arguments[::2], arguments[1::2], strict=False):
        match matlab_values.string(known(name)):
            case "file":
                load(script, built, matlab_values.string(known(value)))
            case "deltaT":
                built.step = matlab_values.real(known(value))
            case "tZero":
                built.start = matlab_values.real(known(value))
            case other:
                script.say(f"the setting {other!r} of a simulator is not read")
    return built


def window(script: ElementBuilder, arguments: ElementArguments) -> BuiltWindow:
    """Return the window of a call `StandardGUI(simulator, position, ...)`."""
    first = arguments[0] if arguments else None
    return BuiltWindow(first if isinstance(first, BuiltSimulator) else None)


def known(value: Any) -> Any:
    """Return a value that is known.

    Raises:
        NotRead: it is not known; the message says why.
    """
    if isinstance(value, MissingValue):
        raise NotRead(value.why)
    return value


def argument(arguments: ElementArguments, k: int) -> Any:
    """Return an argument, or an empty list if there are fewer."""
    return known(arguments[k]) if k < len(arguments) else np.zeros((0, 0))


# ------------------------------------------------------------------------------------------------- simulators


def add_element(script: ElementBuilder, sim: BuiltSimulator, arguments: ElementArguments) -> None:
    """Add an element, with its inputs and its targets."""
    call = argument(arguments, 0)
    if not isinstance(call, ClassCall):
        raise NotRead(f"an element is expected, not {matlab_values.described(call)}")
    label = matlab_values.string(argument(call.arguments, 0))
    if not label.strip():
        raise NotRead("the label of an element is empty")
    if label in sim.elements:
        raise NotRead(f"the label {label!r} is used already")
    sim.elements[label] = built = element(script, call, label)
    built.inputs += sources(script, sim, arguments, 1, label)
    targets = _labels(arguments, 3)
    component_names = _labels(arguments, 4)
    for k, target in enumerate(targets):
        component = (
            component_names[k] if k < len(component_names) and component_names[k] else output(built.kind)
        )
        if target in sim.elements:
            sim.elements[target].inputs.append((label, component))
        else:
            why = f"line {script.line}: no element has the label {target!r}"
            script.lines.append(Line(label, "connection", target, "dropped", why))


def element(script: ElementBuilder, call: ClassCall, label: str) -> BuiltElement:
    """Return the element of a call of its class; an argument that is not known gets its default."""
    values: list[Any] = []
    names = list(CONSTRUCTORS.get(call.name, {"size": None}))
    defaults = list(CONSTRUCTORS.get(call.name, {"size": None}).values())
    for k, value in enumerate(call.arguments[1:]):
        if isinstance(value, MissingValue):
            name = names[k] if k < len(names) else f"argument {k + 2}"
            why = f"line {call.line}: {value.why}"
            why += "; its default is used" if k < len(names) else ""
            script.lines.append(Line(label, "parameter", name, "approximated", why))
            value = defaults[k] if k < len(names) else None
        elif k >= len(names) and call.name in CONSTRUCTORS:
            why = f"line {call.line}: {call.name} has {len(names)} arguments behind the label"
            script.lines.append(Line(label, "parameter", f"argument {k + 2}", "dropped", why))
        values.append(value)
    if call.name not in CONSTRUCTORS and len(values) > 1:
        why = f"line {call.line}: the arguments of an unknown class have no names"
        script.lines.append(Line(label, "parameter", "arguments", "dropped", why))
    return BuiltElement(label, call.name, parameters_of(call.name, values))


def output(kind: str) -> str:
    """Return the component that is read where none is named."""
    return OUTPUTS.get(kind, "output")


def sources(
    script: ElementBuilder, sim: BuiltSimulator, arguments: ElementArguments, first: int, target: str
) -> list[tuple[str, str]]:
    """Return label and component of inputs, from the arguments with labels and with components."""
    labels = _labels(arguments, first)
    component_names = _labels(arguments, first + 1)
    if component_names and len(component_names) != len(labels):
        script.say(f"{len(labels)} inputs and {len(component_names)} components do not fit together")
    inputs: list[tuple[str, str]] = []
    for k, label in enumerate(labels):
        if label not in sim.elements:
            why = f"line {script.line}: no element has the label {label!r}"
            script.lines.append(Line(target, "connection", label, "dropped", why))
            continue
        kind = sim.elements[label].kind
        component = component_names[k] if k < len(component_names) and component_names[k] else output(kind)
        if kind in CLASSES and component not in components(kind):
            has = ", ".join(components(kind))
            script.say(f"{label!r} is a {kind} without a component {component!r}; it has {has}")
        inputs.append((label, component))
    return inputs


def _labels(arguments: ElementArguments, k: int) -> list[str]:
    return matlab_values.names_of(argument(arguments, k))


def add_connection(script: ElementBuilder, sim: BuiltSimulator, arguments: ElementArguments) -> None:
    """Connect elements that exist."""
    target = matlab_values.string(argument(arguments, 2))
    if target not in sim.elements:
        raise NotRead(f"no element has the label {target!r}")
    sim.elements[target].inputs += sources(script, sim, arguments, 0, target)


def set_parameters(script: ElementBuilder, sim: BuiltSimulator, arguments: ElementArguments) -> None:
    """Change parameters of elements."""
    labels, names = _labels(arguments, 0), _labels(arguments, 1)
    values = argument(arguments, 2)
    listed = list(values.reshape(-1, order="F")) if matlab_values.is_cells(values) else [values]
    if not matlab_values.is_cells(values) and len(names) > 1:
        listed = [matlab_values.number(v) for v in matlab_values.numbers(values).reshape(-1)]
    labels = labels * len(names) if len(labels) == 1 else labels
    if not len(labels) == len(names) == len(listed):
        raise NotRead(
            f"{len(labels)} labels, {len(names)} names and {len(listed)} values do not fit together"
        )
    for label, name, value in zip(labels, names, listed, strict=True):
        if label not in sim.elements:
            script.say(f"no element has the label {label!r}")
        else:
            set_parameter(script, sim.elements[label], name, known(value))


def set_parameter(script: ElementBuilder, built: BuiltElement, name: str, value: Any) -> None:
    """Change one parameter of an element."""
    if built.kind in CONSTRUCTORS and name not in built.values:
        script.say(f"{built.label!r} is a {built.kind} without a parameter {name!r}")
    else:
        built.values[name] = value


def load_settings(script: ElementBuilder, sim: BuiltSimulator, arguments: ElementArguments) -> Any:
    """Take over the parameters of a file that can be changed, or all; return that it was read."""
    every_parameter = len(arguments) > 1 and matlab_values.string(arguments[1]) == "all"
    load(script, sim, matlab_values.string(argument(arguments, 0)), every_parameter)
    return matlab_values.flag(True)


def load_file(script: ElementBuilder, sim: BuiltSimulator, arguments: ElementArguments) -> Any:
    """Take over a file; return that it was read."""
    load(script, sim, matlab_values.string(argument(arguments, 0)))
    return matlab_values.flag(True)


def load(script: ElementBuilder, sim: BuiltSimulator, name: str, every_parameter: bool = True) -> None:
    """Take over a file: all of it if the simulator has no elements, else the parameters of its elements."""
    stored = script.file(name)
    sim.step, sim.start = stored.step, stored.start
    if not sim.elements:
        for e in stored.elements:
            inputs = [(s.label, s.component) for s in e.sources]
            sim.elements[e.label] = BuiltElement(e.label, e.kind, dict(e.values), inputs)
        return
    elements = stored.by_label
    for built in sim.elements.values():
        twin = elements.get(built.label)
        if twin is None or twin.kind != built.kind:
            why = f"line {script.line}: it has no such {built.kind}, which keeps its values"
            script.lines.append(Line(built.label, "preset", name, "dropped", why))
            continue
        built.values |= {
            parameter: value
            for parameter, value in twin.values.items()
            if parameter in built.values and (every_parameter or not is_fixed(built.kind, parameter))
        }
    for label in elements:
        if label not in sim.elements:
            why = f"line {script.line}: it has this {elements[label].kind}, the simulator does not"
            script.lines.append(Line(label, "preset", name, "dropped", why))


def get_element(script: ElementBuilder, sim: BuiltSimulator, arguments: ElementArguments) -> Any:
    """Return an element."""
    label = matlab_values.string(argument(arguments, 0))
    if label not in sim.elements:
        raise NotRead(f"no element has the label {label!r}")
    return sim.elements[label]


def get_parameter(script: ElementBuilder, sim: BuiltSimulator, arguments: ElementArguments) -> Any:
    """Return the value of a parameter."""
    built, name = get_element(script, sim, arguments), matlab_values.string(argument(arguments, 1))
    return value_of(built, name)


def value_of(built: BuiltElement, name: str) -> Any:
    """Return a parameter of an element as a value of the script."""
    if name == "label":
        return matlab_values.text(built.label)
    if name not in built.values:
        raise NotRead(f"{built.label!r} is a {built.kind} without a parameter {name!r}")
    value = built.values[name]
    if isinstance(value, np.ndarray) and value.ndim >= 2:
        return value
    return (
        matlab_values.text(value) if isinstance(value, str) else np.atleast_2d(np.asarray(value, dtype=float))
    )


def is_element(script: ElementBuilder, sim: BuiltSimulator, arguments: ElementArguments) -> Any:
    """Return whether an element has a label."""
    return matlab_values.flag(matlab_values.string(argument(arguments, 0)) in sim.elements)


# ---------------------------------------------------------------------------------------------------- windows


def add_control(script: ElementBuilder, gui: BuiltWindow, arguments: ElementArguments) -> None:
    """Add a control."""
    gui.controls.append(_call(arguments, "a control"))


def add_plot(script: ElementBuilder, gui: BuiltWindow, arguments: ElementArguments) -> None:
    """Add a plot."""
    gui.plots.append(_call(arguments, "a visualization"))


def connect(script: ElementBuilder, gui: BuiltWindow, arguments: ElementArguments) -> None:
    """Connect a window with a simulator."""
    sim = argument(arguments, 0)
    if isinstance(sim, BuiltSimulator):
        gui.simulator = sim


def _call(arguments: ElementArguments, expected: str) -> ClassCall:
    call = argument(arguments, 0)
    if not isinstance(call, ClassCall):
        raise NotRead(f"{expected} is expected, not {matlab_values.described(call)}")
    return call


SIMULATOR_METHODS: Mapping[str, Callable[[ElementBuilder, BuiltSimulator, ElementArguments], Any]] = {
    "addElement": add_element,
    "addConnection": add_connection,
    "setElementParameters": set_parameters,
    "loadSettings": load_settings,
    "loadFromFile": load_file,
    "getElement": get_element,
    "getElementParameter": get_parameter,
    "isElement": is_element,
}
WINDOW_METHODS: Mapping[str, Callable[[ElementBuilder, BuiltWindow, ElementArguments], Any]] = {
    "addControl": add_control,
    "addVisualization": add_plot,
    "connect": connect,
}
