"""Look up paths: of an element, a port, a parameter or a document parameter."""

from __future__ import annotations

import dataclasses as dc
from typing import Any

from deodar.errors import ParameterError, UnknownName, did_you_mean
from deodar.leaves import get, leaves
from deodar.model.document import Document, Entry
from deodar.model.paths import quote, readings
from deodar.parameters import parameters
from deodar.synonyms import synonym


@dc.dataclass(frozen=True)
class Target:
    """The target of a parameter path: a parameter of an element, or a document parameter, by its name."""

    entry: Entry | None
    parameter: str


def entry(doc: Document, ident: str) -> Entry:
    """Return the entry of an id; the id of a removed element is an error."""
    match = doc.by_id().get(ident)
    if match is None:
        raise UnknownName(f"the element with the id {ident} was removed from the document")
    return match


def element(doc: Document, path: str) -> Entry:
    """Return the element at a path; the error of an unknown path suggests the nearest."""
    by = doc.by_names()
    matches = [names for names, rest in readings(path, doc.index()) if not rest]
    if not matches:
        raise UnknownName(
            f"there is no element {path!r}", fix=did_you_mean(path, [e.path for e in doc.entries])
        )
    return by[matches[0]]


def port(doc: Document, path: str, default: str = "output") -> tuple[Entry, str]:
    """Return the element and the port at a path; a path without a port means the port `default`."""
    by = doc.by_names()
    matches = readings(path, doc.index())
    for names, rest in matches:
        entry = by[names]
        port_names = readable(entry)
        name = rest.strip('"') if rest else default
        if name in port_names or not name:
            return entry, name
    if matches:
        names, rest = matches[0]
        entry = by[names]
        if rest in [p.name for p in parameters(type(entry.element))]:
            raise UnknownName(
                f"{path!r} is a parameter, not a port",
                fix=f"Ports of {entry.path}: {', '.join(readable(entry))}",
            )
        raise UnknownName(f"{entry.path} has no port {rest!r}", fix=did_you_mean(rest, readable(entry)))
    port_names = [f"{e.path}.{p}" for e in doc.entries for p in readable(e)]
    raise UnknownName(
        f"nothing is called {path!r}", fix=did_you_mean(path, [*port_names, *(e.path for e in doc.entries)])
    )


def shown(doc: Document, path: str) -> tuple[Entry, str]:
    """Return the element and the port whose values are recorded or read at a path.

    Without a port this is the activation of a field, else the default output.

    For connections a path without a port means the default output of every element: see `port`.
    """
    entry, name = port(doc, path, "")
    return entry, name or ("activation" if "activation" in outputs(entry) else outputs(entry)[0])


def written(doc: Document, path: str) -> str:
    """Return a recorded path with its port, as text: `u` gives `u.activation`."""
    entry, name = shown(doc, path)
    return f"{entry.path}.{quote(name)}"


def readable(entry: Entry) -> list[str]:
    """Return the ports that can be read and recorded: outputs, then inputs."""
    return [*outputs(entry), *entry.element.ports()]


def outputs(entry: Entry) -> list[str]:
    """Return the names of the output ports."""
    element = entry.element
    return list(element.outputs({port: () for port in element.ports()}))


def target(doc: Document, path: str) -> Target:
    """Return the parameter at a path: `u.tau`, `u.kernel.0.sigma`, or the name of a document parameter."""
    by = doc.by_names()
    matches = [(by[parameter_names], rest) for parameter_names, rest in readings(path, doc.index()) if rest]
    for entry, rest in matches:
        inner = rest.replace('"', "")
        if inner.split(".")[0] in [p.name for p in parameters(type(entry.element))]:
            return Target(entry, inner)
    if path in [k.name for k in doc.parameters]:
        return Target(None, path)
    if matches:
        entry, rest = matches[0]
        parameter_names = [p.name for p in parameters(type(entry.element)) if p.name != "name"]
        if rest in readable(entry):
            raise UnknownName(
                f"{path!r} is a port, not a parameter",
                fix=f"Parameters of {entry.path}: {', '.join(parameter_names)}",
            )
        fix = elsewhere(entry, rest) or did_you_mean(rest, parameter_names)
        raise UnknownName(f"{entry.path} has no parameter {rest!r}", fix=fix)
    everything = [f"{e.path}.{leaf}" for e in doc.entries for leaf, _, _ in leaves(e.element)] + [
        k.name for k in doc.parameters
    ]
    raise UnknownName(f"nothing is called {path!r}", fix=did_you_mean(path, everything))


def elsewhere(entry: Entry, name: str) -> str:
    """Return what to write for a parameter that papers or other tools call otherwise; "" if none do."""
    row = synonym(type(entry.element).__name__, name)
    if row is None:
        return ""
    try:
        get(entry.element, row.path)
    except UnknownName:  # such as the second width of a kernel that has one
        first = row.path.split(".")[0]
        return f"Set {entry.path}.{first}: {row.keyword()}"
    return f"Write: {entry.path}.{row.path}"


def value(doc: Document, path: str) -> Any:
    """Return the value of the parameter at a path."""
    end = target(doc, path)
    return present(doc, end.entry.id if end.entry else "", end.parameter)


def present(doc: Document, ident: str, path: str) -> Any:
    """Return the value of a parameter of an element, or of a document parameter, whose id is ""."""
    if ident:
        return get(entry(doc, ident).element, path)
    numbers = [k.value for k in doc.parameters if k.name == path]
    if not numbers:
        raise UnknownName(f"the document has no parameter {path!r}")
    return numbers[0]


def number(doc: Document, ident: str, leaf: str) -> float:
    """Return the value of a parameter that a document parameter can drive; any other parameter is an
    error.
    """
    linked = entry(doc, ident)
    numbers = {path: value for path, value, p in leaves(linked.element) if p.form != "array"}
    if leaf not in numbers:
        fault = (
            f"{linked.path}.{leaf} cannot be linked: it is not a number that can change while the model runs"
        )
        raise ParameterError(fault, fix=did_you_mean(leaf, list(numbers)))
    return float(numbers[leaf])
