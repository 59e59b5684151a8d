"""A document as a Python script that makes the same document."""

from __future__ import annotations

import base64
import dataclasses as dc
import re
import textwrap
from collections import Counter
from collections.abc import Iterator, Sequence
from typing import Any

from deodar import registry
from deodar.declarations import Needed
from deodar.element import Coupling
from deodar.errors import DeodarError
from deodar.model import document_files
from deodar.model.document import Document, Entry
from deodar.model.paths import PathNames, display, stored_id
from deodar.model.python_code import (
    Bracketed,
    Chain,
    Code,
    LongText,
    Prefixed,
    call,
    lines,
    listed,
    literal,
    number,
    pair,
    text,
    variable,
)
from deodar.model.statements import ChainItem, Statement, statements
from deodar.numerics.axes import Axis
from deodar.parameters import FrozenArray, Parameter, Part, normal, parameters, positional

MOST_NUMBERS = 32
"""Largest number of values of an array that is written as a list of numbers; larger ones are encoded."""

TAKEN = ("dd", "np", "io", "base64", "model", "arrays", "make", "ARRAYS")
"""Names that scripts use."""


def script(doc: Document, path: str = "") -> str:
    """Return a Python script that makes the same document.

    The script declares a function `make` that returns the model. Run as a program it also writes the
    document.

    Args:
        doc: the document.
        path: file that the script writes, text of the script's last line; empty: the name of the document.
    """
    name = re.sub(r"[^\w -]", "", doc.name).strip() or "model"
    return _Script(doc, path or f"{name}.json").text()


class _Script:
    def __init__(self, doc: Document, path: str) -> None:
        self.doc = doc
        self.path = path
        self.by = doc.by_id()
        self.uses = Counter(i for c in doc.connections for i in (c.source, c.target))
        self.linked: dict[str, set[str]] = {}
        for k in doc.parameters:
            for ident, leaf in k.links:
                self.linked.setdefault(ident, set()).add(leaf)
        self.imports: set[str] = set()
        self.encoded: dict[str, FrozenArray] = {}
        self.numpy = False
        self.array_keys = {array.digest: key for key, array in document_files.arrays(doc).items()}
        self.axes: dict[Axis, str] = {}
        for key, axis in document_files.axes(doc).items():
            self.axes[axis] = variable(key, {*TAKEN, *self.axes.values()})
        self.variables: dict[str, str] = {}
        self.taken = {*TAKEN, *self.axes.values()}

    def text(self) -> str:
        graph = list(self._graph())
        body = [*self._beginning(), *graph, *self._ending()]
        head = ['"""Make a model, and write it as a document."""', ""]
        if self.encoded:
            head += ["import base64", "import io", ""]
        if self.numpy:
            head += ["import numpy as np", ""]
        head += ["import deodar as dd", *sorted(self.imports), "", "", "def make() -> dd.Model:"]
        tail = ["", "", *self._arrays(), 'if __name__ == "__main__":']
        tail.append(lines(call("dd.save", "make()", text(self.path)), 4))
        return "\n".join([*head, *body, *tail]) + "\n"

    # --------------------------------------------------------------------------------------- before and after

    def _beginning(self) -> Iterator[str]:
        if self.encoded:
            yield "    arrays = np.load(io.BytesIO(base64.b64decode(ARRAYS)))"
        for axis, name in self.axes.items():
            declared = [p for p in parameters(Axis) if not _is_default(p, getattr(axis, p.name))]
            values = {p.name: self._value(p, getattr(axis, p.name)) for p in declared}
            first = [values.pop(key) for key in ("name", "lower", "upper")]
            yield lines(Prefixed(f"{name} = ", call("dd.Axis", *first, **values)), 4)
        general: dict[str, Code] = {}
        general |= {} if self.doc.time_unit == "ms" else {"time_unit": text(self.doc.time_unit)}
        general |= {} if self.doc.dt is None else {"dt": number(self.doc.dt)}
        general |= {"trusted": "False"} if self.doc.asks() else {}
        yield lines(Prefixed("model = ", call("dd.Model", text(self.doc.name), **general)), 4)

    def _ending(self) -> Iterator[str]:
        doc = self.doc
        for axis in doc.spare_axes:
            yield lines(call("model.add_axis", self.axes[axis]), 4)
        for k in doc.parameters:
            yield lines(call("model.parameter", text(k.name), number(k.value)), 4)
            for ident, leaf in k.links:
                yield lines(call("model.link", text(f"{self.by[ident].path}.{leaf}"), text(k.name)), 4)
        for use in doc.uses:
            pairs = Bracketed(
                "{", tuple(Prefixed(f"{text(t)}: ", text(self.by[i].path)) for t, i in use.elements), "}"
            )
            yield lines(call("model.link_group", text(display(use.group)), text(use.template), pairs), 4)
        general: dict[str, Code] = {}
        general |= {"t0": number(doc.t0)} if doc.t0 else {}
        general |= {"notes": LongText(doc.notes)} if doc.notes else {}
        general |= {"layout": literal(doc.layout)} if doc.layout else {}
        if general:
            yield lines(call("model.describe", **general), 4)
        yield "    return model"

    def _arrays(self) -> list[str]:
        if not self.encoded:
            return []
        packed = base64.b64encode(document_files.pack(self.encoded)).decode()
        return ['ARRAYS = """', *textwrap.wrap(packed, 86), '"""', ""]

    # ---------------------------------------------------------------------------------------------- the graph

    def _graph(self) -> Iterator[str]:
        groups = [lines(call("model.group", text(display(g))), 4) for g in self._missing_groups()]
        first = self.doc.groups[:1] == self._missing_groups()[:1]
        yield from groups if first else ()
        ids: set[str] = set()
        group: PathNames = ()
        for statement in statements(self.doc):
            new = [operand.entry for operand in statement.items if operand.how != "exists"]
            if new and new[0].group != group:
                group = new[0].group
                heading = re.sub(r"[^\w .,:;()>/+-]", "?", display(group))  # it cannot end the comment
                yield f"\n    # {heading}" if group else ""
            yield lines(self._statement(statement, ids), 4)
        yield from () if first else groups

    def _missing_groups(self) -> Sequence[PathNames]:
        """Return the groups that the script adds on their own: those that no element adds, or all if their
        order is another one.
        """
        added: dict[PathNames, None] = {}
        for e in self.doc.entries:
            added |= dict.fromkeys(e.group[:k] for k in range(1, len(e.names)))
        same = tuple(added) == self.doc.groups[: len(added)]
        return self.doc.groups[len(added) :] if same else self.doc.groups

    def _statement(self, statement: Statement, ids: set[str]) -> Code:
        last = statement.items[-1]
        if statement.reads:
            ends = [self._handle(operand) for operand in statement.items]
            return call("model.connect", *ends, reads=text(statement.reads))
        items: list[Code] = []
        for operand in statement.items:
            e = operand.entry
            if operand.how == "exists":
                items.append(self._handle(operand))
                continue
            unnamed = operand.how in ("follows", "named")
            element = self._part(e.element, unnamed, self.linked.get(e.id, set()))
            items.append(element if unnamed else self._added(e, element, ids))
            ids.add(e.id)
        keeps = last.how == "named" or (len(items) == 1 and self.uses[last.entry.id] > 0)
        target = f"{self._variable(last.entry)} = " if keeps else ""
        return Prefixed(target, items[0]) if len(items) == 1 else Chain(target, tuple(items))

    def _added(self, e: Entry, element: Code, ids: set[str]) -> Code:
        named: dict[str, Code] = {"group": text(display(e.group))} if e.group else {}
        named |= {"ticks": str(e.every)} if e.every != 1 else {}
        named |= {"id": text(e.id)} if stored_id(e.path, ids) != e.id else {}
        return call("model.add", element, **named)

    def _handle(self, operand: ChainItem) -> str:
        name = self._variable(operand.entry)
        return f"{name}[{text(operand.port)}]" if operand.port else name

    def _variable(self, e: Entry) -> str:
        if e.id not in self.variables:
            name = variable(e.names[-1], ())
            if name in self.taken:
                name = variable("_".join(e.names), self.taken)
            self.variables[e.id] = name
            self.taken.add(name)
        return self.variables[e.id]

    # ------------------------------------------------------------------------------------------------- values

    def _part(self, part: Part, unnamed: bool = False, linked: set[str] | None = None) -> Code:
        """Return the call that makes a part: values that differ from the defaults."""
        kind = type(part)
        arguments = {
            p.name: self._value(p, getattr(part, p.name))
            for p in parameters(kind)
            if (not unnamed if p.name == "name" else not _is_default(p, getattr(part, p.name)))
            and not (linked and p.name in linked and _may_be_left_out(part, p))
        }
        first: list[Code] = []
        declared = {p.name: p for p in parameters(kind)}
        for name in positional(kind):
            p = declared[name]
            alone = isinstance(part, Coupling) and set(arguments) - {"name"} == {name}
            if name not in arguments or not (
                name == "name" or isinstance(p.default, Needed) or p.form in ("axes", "axis") or alone
            ):
                break
            first.append(arguments.pop(name))
        function = f"dd.{kind.__name__}"
        if not registry.own(kind):
            self.imports.add(f"from {kind.__module__} import {kind.__name__}")
            function = kind.__name__
        name = {"name": arguments.pop("name")} if "name" in arguments else {}
        return call(function, *first, **arguments, **name)

    def _value(self, p: Parameter, value: Any) -> Code:
        if value is None:
            return "None"
        match p.form:
            case "number":
                return number(value)
            case "per_axis":
                return listed(map(number, value)) if isinstance(value, tuple) else number(value)
            case "axes":
                return listed(self.axes[axis] for axis in value)
            case "axis":
                return self.axes[value]
            case "part":
                return self._inner(p, value)
            case "parts":
                return listed(self._inner(p, part) for part in value)
            case "array":
                return self._array(value)
            case "numbers" | "pairs":
                written = number if p.form == "numbers" else text
                return Bracketed("{", tuple(Prefixed(f"{text(k)}: ", written(v)) for k, v in value), "}")
            case _:
                return literal(value)

    def _inner(self, p: Parameter, part: Part) -> Code:
        """Return a part inside another one, in its short form if it has one."""
        values = tuple(getattr(part, q.name) for q in parameters(type(part)))
        whole = not any(_is_default(q, v) for q, v in zip(parameters(type(part)), values, strict=True))
        if whole and p.of is not None and p.of.accept(values) == part:
            return pair(self._value(q, v) for q, v in zip(parameters(type(part)), values, strict=True))
        return self._part(part)

    def _array(self, array: FrozenArray) -> Code:
        size = array.data.size
        if _is_short(array) and (size or array.data.ndim == 1):
            return _numbers(array.data.tolist())
        self.numpy = True
        values = array.data.ravel()
        if not size or ((values == values[0]).all() and str(values[0]) != "-0.0"):
            shape = f"({', '.join(map(str, array.shape))}{',' * (len(array.shape) == 1)})"
            return call("np.full", shape, number(float(values[0])) if size else "0")
        key = self.array_keys[array.digest]
        self.encoded[key] = array
        return f"arrays[{text(key)}]"


def _is_short(array: FrozenArray) -> bool:
    return array.data.size <= MOST_NUMBERS


def _numbers(value: Any) -> Code:
    return listed(map(_numbers, value)) if isinstance(value, list) else number(value)


def _is_default(p: Parameter, value: Any) -> bool:
    """Return whether a parameter has its default, to the sign of a zero."""
    try:
        default = normal(p, p.default)
    except ValueError:  # a required parameter
        return False
    return value == default and repr(value) == repr(default)


def _may_be_left_out(part: Part, p: Parameter) -> bool:
    """Return whether a linked parameter can have its default until it is linked."""
    try:
        dc.replace(part, **{p.name: p.default})  # type: ignore[type-var]
    except (DeodarError, TypeError):
        return False
    return True
