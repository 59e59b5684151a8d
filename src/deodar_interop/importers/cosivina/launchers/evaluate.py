"""The values of expressions: numbers, text and lists are computed, nothing is executed."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Protocol

import numpy as np

from deodar_interop.importers.cosivina.launchers import matlab_values
from deodar_interop.importers.cosivina.launchers.expressions import NotRead
from deodar_interop.importers.cosivina.launchers.matlab_functions import FUNCTIONS, RANDOM
from deodar_interop.importers.cosivina.launchers.objects import ClassCall, MissingValue
from deodar_interop.importers.cosivina.launchers.tree import (
    BinaryNode,
    IndexNode,
    ListNode,
    MemberNode,
    NameNode,
    NumberNode,
    RangeNode,
    ScriptNode,
    TextNode,
    UnaryNode,
    WholeNode,
)

MOST_STEPS = 200_000
"""Most operations of a script: statements and parts of expressions."""

MOST_COMPUTED = 20_000_000
"""Most entries of arrays that a script computes."""

FAILURES = (ValueError, TypeError, IndexError, KeyError, OverflowError, ZeroDivisionError, MemoryError)
"""Errors of NumPy at arguments that do not fit together."""


class Exhausted(Exception):
    """Raised when a script takes too many operations."""


class Budget:
    """The operations that a script may still take."""

    def __init__(self) -> None:
        self.steps, self.entries = MOST_STEPS, MOST_COMPUTED

    def step(self) -> None:
        """Count an operation."""
        self.steps -= 1
        if self.steps < 0:
            raise Exhausted(f"more than {MOST_STEPS} operations")

    def made(self, value: Any) -> Any:
        """Count the entries of a value, and return it."""
        if isinstance(value, np.ndarray):
            if value.ndim < 2:
                raise NotRead("an array has fewer than two dimensions")
            self.entries -= value.size
            if self.entries < 0:
                raise Exhausted(f"arrays of more than {MOST_COMPUTED} entries in all")
        return value


class Host(Protocol):
    """What a script offers to its expressions."""

    def call(self, name: str, arguments: Sequence[Any]) -> Any:
        """Return the value of a function that is not one of MATLAB's."""
        ...

    def method(self, target: Any, name: str, arguments: Sequence[Any]) -> Any:
        """Return the value of a method of an object."""
        ...

    def member(self, target: Any, name: str) -> Any:
        """Return a property of an object."""
        ...


class Evaluator:
    """The computation of expressions in one scope.

    Args:
        scope: the variables.
        host: the script.
        budget: the operations that are left.
    """

    def __init__(self, scope: dict[str, Any], host: Host, budget: Budget) -> None:
        self.scope = scope
        self.host = host
        self.budget = budget
        self.ends: list[tuple[np.ndarray, int, int]] = []

    def value(self, node: ScriptNode) -> Any:
        """Return the value of an expression.

        Raises:
            NotRead: it is not read, or needs a value that is not known.
        """
        self.budget.step()
        try:
            with np.errstate(all="ignore"):
                computed = self._value(node)
        except NotRead:
            raise
        except FAILURES as error:
            raise NotRead(f"it cannot be computed ({error})") from None
        if isinstance(computed, MissingValue):
            raise NotRead(computed.why)
        return self.budget.made(computed)

    def tolerant(self, node: ScriptNode) -> Any:
        """Return the value of an expression, or why it has none as a `MissingValue`."""
        try:
            return self.value(node)
        except NotRead as error:
            return MissingValue(str(error))

    def _value(self, node: ScriptNode) -> Any:
        match node:
            case NumberNode(value):
                return matlab_values.number(value)
            case TextNode(value):
                return matlab_values.text(value)
            case NameNode(name):
                return self._name(name)
            case UnaryNode(operator, operand):
                return self._unary(operator, self.value(operand))
            case BinaryNode(operator, left, right):
                return self._binary(operator, left, right)
            case RangeNode(first, step, last):
                by = 1.0 if step is None else matlab_values.real(self.value(step))
                return matlab_values.counted(
                    matlab_values.real(self.value(first)), by, matlab_values.real(self.value(last))
                )
            case ListNode(cells, rows):
                return self._list(cells, rows)
            case IndexNode():
                return self._index(node)
            case MemberNode(target, name):
                return self._member(self.value(target), name)
            case WholeNode():
                raise NotRead("a colon alone is an index")

    def _name(self, name: str) -> Any:
        if name in self.scope:
            return self.scope[name]
        if name == "end" and self.ends:
            array, place, count = self.ends[-1]
            if count == 1:
                return matlab_values.number(array.size)
            return matlab_values.number(array.shape[place] if place < array.ndim else 1)
        return self.call(name, ())

    def call(self, name: str, arguments: Sequence[Any]) -> Any:
        """Return the value of a function."""
        if name in RANDOM:
            raise NotRead(f"{name} differs from run to run")
        if name in FUNCTIONS:
            for argument in arguments:
                if isinstance(argument, MissingValue):
                    raise NotRead(argument.why)
            return FUNCTIONS[name](arguments)
        return self.host.call(name, arguments)

    def _unary(self, operator: str, value: Any) -> Any:
        if operator == "'":
            if not isinstance(value, np.ndarray) or value.ndim != 2:
                raise NotRead("only a matrix is transposed")
            return value.T
        numbers = matlab_values.numbers(value)
        return -numbers if operator == "-" else numbers == 0 if operator == "~" else numbers

    def _binary(self, operator: str, left: ScriptNode, right: ScriptNode) -> Any:
        first = self.value(left)
        if operator in ("&&", "||"):
            if matlab_values.is_true(first) != (operator == "&&"):
                return matlab_values.flag(operator == "||")
            return matlab_values.flag(matlab_values.is_true(self.value(right)))
        second = self.value(right)
        a, b = matlab_values.numbers(first), matlab_values.numbers(second)
        if operator in ("*", "/", "\\") and a.size != 1 and b.size != 1:
            if operator != "*" or a.ndim != 2 or b.ndim != 2 or a.shape[1] != b.shape[0]:
                raise NotRead(f"matrices of these sizes are not computed with {operator!r}")
            matlab_values.require_size(float(a.shape[0]) * b.shape[1])
            matlab_values.require_size(float(a.size) * b.shape[1] / 100)
            return a @ b
        if operator == "^" and (a.size != 1 or b.size != 1):
            raise NotRead("powers of matrices are not computed")
        matlab_values.require_size(math.prod(np.broadcast_shapes(a.shape, b.shape)))
        return OPERATORS[operator](a, b)

    def _list(self, cells: bool, rows: Sequence[Sequence[ScriptNode]]) -> Any:
        if not cells:
            return matlab_values.joined([[self.value(entry) for entry in row] for row in rows])
        entries = [[self.tolerant(entry) for entry in row] for row in rows]
        if len({len(row) for row in entries}) > 1:
            raise NotRead("its rows have different lengths")
        return (
            np.concatenate([matlab_values.cells(row) for row in entries])
            if entries
            else np.empty((0, 0), dtype=object)
        )

    # ------------------------------------------------------------------------------------ calls and indices

    def _index(self, node: IndexNode) -> Any:
        target = node.target
        if isinstance(target, NameNode) and target.name not in self.scope and not node.braces:
            if target.name == "exist" and node.arguments:
                name = matlab_values.string(self.value(node.arguments[0]))
                return matlab_values.flag(name in self.scope)
            return self.call(target.name, self.arguments(node.arguments))
        if isinstance(target, MemberNode) and not node.braces:
            holder = self.value(target.target)
            if not isinstance(holder, (dict, np.ndarray)):
                return self.host.method(holder, target.name, self.arguments(node.arguments))
            value = self._member(holder, target.name)
        else:
            value = self.value(target)
        if not isinstance(value, np.ndarray):
            raise NotRead(f"{matlab_values.described(value)} has no entries")
        indices = self.indices(value, node.arguments)
        if not node.arguments:
            return value
        entries = matlab_values.index_of(value, indices)
        if not node.braces:
            return entries
        if not matlab_values.is_cells(value) or entries.size != 1:
            raise NotRead("braces are the index of one cell")
        return entries.reshape(-1)[0]

    def indices(self, value: np.ndarray, nodes: Sequence[ScriptNode]) -> list[Any]:
        """Return indices of an array, in which `end` is its last entry."""
        out: list[Any] = []
        for place, node in enumerate(nodes):
            self.ends.append((value, place, len(nodes)))
            try:
                out.append(None if isinstance(node, WholeNode) else self.value(node))
            finally:
                self.ends.pop()
        return out

    def arguments(self, nodes: Sequence[ScriptNode]) -> list[Any]:
        """Return arguments; one that is not read is a `MissingValue`. `c{:}` gives all cells."""
        out: list[Any] = []
        for node in nodes:
            if isinstance(node, IndexNode) and node.braces and node.arguments == (WholeNode(),):
                cells = self.tolerant(node.target)
                out += list(cells.reshape(-1, order="F")) if matlab_values.is_cells(cells) else [cells]
            else:
                out.append(self.tolerant(node))
        return out

    def _member(self, holder: Any, name: str) -> Any:
        if isinstance(holder, dict):
            if name not in holder:
                raise NotRead(f"the structure has no field {name!r}")
            return holder[name]
        if isinstance(holder, np.ndarray):
            raise NotRead(f"{matlab_values.described(holder)} has no member {name!r}")
        if isinstance(holder, ClassCall):
            raise NotRead(f"the property {name!r} of {holder.name} is not read")
        return self.host.member(holder, name)


OPERATORS: Mapping[str, Callable[[np.ndarray, np.ndarray], np.ndarray]] = {
    **{"+": np.add, "-": np.subtract, "*": np.multiply, ".*": np.multiply, "/": np.divide, "./": np.divide},
    **{"^": np.power, ".^": np.power, "==": np.equal, "~=": np.not_equal, "!=": np.not_equal},
    **{"<": np.less, "<=": np.less_equal, ">": np.greater, ">=": np.greater_equal},
    **{"&": np.logical_and, "|": np.logical_or},
    "\\": lambda a, b: np.divide(b, a),
    ".\\": lambda a, b: np.divide(b, a),
}
"""The operators between numbers, entry by entry."""
