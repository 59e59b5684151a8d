"""Parameter links and their equations: parameters that follow another one, as document parameters."""

from __future__ import annotations

import ast
import dataclasses as dc
import math
import operator
from collections.abc import Callable, Mapping
from typing import Any

from deodar.errors import DeodarError
from deodar.importers.report import Line, Verdict
from deodar.model import edit
from deodar.model.document import Document, Entry
from deodar_interop.importers.cedar.file import CedarGroup, StepPath, members, text
from deodar_interop.importers.cedar.held import held
from deodar_interop.importers.cedar.values import number

LONGEST = 200
"""Largest number of characters of an equation (a guess)."""

OF_TWO: dict[type[ast.operator], Callable[[float, float], float]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
}


def solved(equation: str, source: float) -> float | None:
    """Return the target that an equation gives for a source.

    Returns:
        None: the equation is not a sum, difference, product or quotient of numbers and `source`, or its value
            is not finite.
    """
    left, sign, right = equation.partition("=")
    text = (right if sign else left).strip()
    if len(text) > LONGEST or (sign and left.strip() != "target"):
        return None
    try:
        target = _value(ast.parse(text, mode="eval").body, source)
    except (SyntaxError, ValueError, ArithmeticError, RecursionError, MemoryError):
        return None
    return target if math.isfinite(target) else None


def _value(node: ast.expr, source: float) -> float:
    match node:
        case ast.Constant(value=int() | float() as value) if not isinstance(value, bool):
            return float(value)
        case ast.Name(id="source"):
            return source
        case ast.UnaryOp(op=ast.USub(), operand=inside):
            return -_value(inside, source)
        case ast.BinOp(left=left, op=op, right=right) if type(op) in OF_TWO:
            return OF_TWO[type(op)](_value(left, source), _value(right, source))
        case _:
            raise ValueError("unknown")


STRUCTURE = ("dimensionality", "sizes", "number of")


def linked(doc: Document, root: CedarGroup, by: Mapping[StepPath, Entry]) -> tuple[Document, list[Line]]:
    """Return a document in which document parameters drive what is linked, and a line for each link."""
    lines: list[Line] = []
    for group in root.all_groups():
        for entry in group.links:
            link = CedarLink.read(group, entry)
            try:
                doc, verdict, why = _applied(doc, link, by)
            except DeodarError as error:
                verdict, why = "dropped", error.problems[0].what
            lines.append(Line(link.where, "parameter", link.what, verdict, why))
    return doc, lines


@dc.dataclass(frozen=True)
class CedarLink:
    """One link of a file.

    Attributes:
        group: the group that has it.
        source, given: the step and its parameter that drive; the group itself if `source` is empty.
        target, taken: the step and its parameter that are driven.
        equation: the equation of the target; None: it is the value of the source.
    """

    group: CedarGroup
    source: str
    given: str
    target: str
    taken: str
    equation: str | None

    @classmethod
    def read(cls, group: CedarGroup, entry: Mapping[str, Any]) -> CedarLink:
        """Return what the file states."""
        direct = text(entry.get("type")).endswith("DirectParameterLink")
        equation = None if direct else text(members(entry.get("configuration")).get("equation"))
        source, parameter = text(entry.get("source element")), text(entry.get("source parameter"))
        target, taken = text(entry.get("target element")), text(entry.get("target parameter"))
        return cls(group, source, parameter, target, taken, equation)

    @property
    def where(self) -> str:
        """The label of the driven step."""
        return ".".join((*self.group.path, *([self.target] if self.target else [])))

    @property
    def what(self) -> str:
        """Both parameters."""
        return f"{'.'.join(w for w in (self.source, self.given) if w)} -> {self.taken}"

    @property
    def name(self) -> str:
        """The name of a document parameter for it."""
        return " ".join((*self.group.path, *([self.source] if self.source else []), self.given))

    def result(self, value: float) -> float | None:
        """Return the target's value for a value of the source; None: the equation cannot be read."""
        return value if self.equation is None else solved(self.equation, value)

    def keeps(self, value: float) -> bool:
        """Return whether the target has the value of the source, this one and others."""
        return all(self.result(v) == v for v in (value, 0.0, 1.0, 2.0))


def _applied(doc: Document, link: CedarLink, by: Mapping[StepPath, Entry]) -> tuple[Document, Verdict, str]:
    """Return a document with a link, and what became of it; raise DeodarError if it is dropped."""
    if link.taken.startswith(STRUCTURE):
        return doc, "carried", "a link of sizes; they have the file's values"
    end = _end(link.group, link.target, link.taken, by)
    if end is None:
        raise DeodarError("the parameter has no counterpart here")
    first = _end(link.group, link.source, link.given, by) if link.source else None
    if link.source and first is None:
        raise DeodarError("its source has no counterpart here")
    source = number(link.group.values.get(link.given)) if first is None else first.value
    if source is None:
        raise DeodarError("its source holds no number")
    target = link.result(source)
    if target is None:
        why = f"the equation {link.equation!r} cannot be read; the parameter has the file's value"
        raise DeodarError(why)
    if not link.keeps(source) or (first is not None and first.sign != end.sign):
        doc = edit.put(doc, end.ident, end.leaf, end.sign * target)
        return (
            doc,
            "approximated",
            f"as the value {target:g}; it does not follow when its source changes",
        )
    ends = [end] if first is None else [first, end]
    name = next((doc.links()[e.place] for e in ends if e.place in doc.links()), "")
    if not name:
        name = link.name
        doc = edit.document_parameter(doc, name, end.sign * source)
    for e in ends:
        if e.place not in doc.links():
            doc = edit.link(doc, *e.place, name)
    return doc, "carried", f"the document parameter {name!r}"


@dc.dataclass(frozen=True)
class LinkEnd:
    """One end of a link.

    Attributes:
        ident: id of the element.
        leaf: path of its parameter.
        sign: factor from cedar's number to deodar's.
        value: cedar's number.
    """

    ident: str
    leaf: str
    sign: float
    value: float

    @property
    def place(self) -> tuple[str, str]:
        """The element and its parameter."""
        return self.ident, self.leaf


def _end(group: CedarGroup, name: str, parameter: str, by: Mapping[StepPath, Entry]) -> LinkEnd | None:
    """Return one end of a link; None without a parameter of deodar that holds cedar's number."""
    entry, step = by.get((*group.path, name)), group.steps.get(name)
    holder = None if entry is None or step is None else held(step, entry, parameter)
    if entry is None or holder is None:
        return None
    return LinkEnd(entry.id, holder.leaf, holder.sign, holder.value)
