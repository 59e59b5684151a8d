"""What passes between devices in a step: as planned, and as counted in a compiled program."""

from __future__ import annotations

import dataclasses as dc
import math
import re
from collections.abc import Iterable, Iterator

from deodar.model.resolve import reach

BYTES = {1: ("pred", "s8", "u8"), 2: ("bf16", "f16"), 8: ("s64", "u64", "f64", "c64"), 16: ("c128",)}
"""Sizes of numbers by their names in a compiled program; all others have 4 bytes."""


KINDS = "all-reduce|all-gather|all-to-all|collective-permute|collective-broadcast|reduce-scatter"
OPERATION = re.compile(rf"= (.*?) ({KINDS})(?:-start)?\(")
SCOPE = re.compile(r"element-([0-9a-f]+)")
COMPUTATION = re.compile(r"^(?:ENTRY )?%?([\w.\-]+) .*\{$")
CALLED = re.compile(
    r"(?:to_apply|calls|body|condition|branch_computations|(?:true|false)_computation)="
    r"(\{[^}]*\}|%?[\w.\-]+)"
)
ARRAY = re.compile(r"\b([a-z]+\d*)\[([\d,]*)\]")


@dc.dataclass(frozen=True)
class Traffic:
    """What one element exchanges between devices in a step that computes it.

    Attributes:
        element: id of the element.
        path: its path.
        method: `waves` (sum of the spectral modes), `taps` (samples of the neighbours) or `sum`.
        bytes: bytes of the sums, or bytes that a device receives from its neighbours.
    """

    element: str
    path: str
    method: str
    bytes: int


@dc.dataclass(frozen=True)
class Collective:
    """An operation of a compiled program in which devices exchange numbers.

    Attributes:
        kind: its name in the program, such as all-reduce.
        bytes: size of its result on one device.
        element: id of the element that it computes; "" if unknown.
    """

    kind: str
    bytes: int
    element: str


def collectives(text: str) -> list[Collective]:
    """Return the operations that exchange numbers in one step of a compiled chunk: those inside its loops."""
    computations = dict(_computations(text))

    def called(lines: Iterable[str]) -> list[str]:
        return [name for line in lines for name in _called(line) if name in computations]

    loops = (line for lines in computations.values() for line in lines if " while(" in line)
    inside = reach(called(loops), lambda name: called(computations[name]))
    return [
        collective
        for name in sorted(inside)
        for line in computations[name]
        for collective in _operation(line)
    ]


def scope(ident: str) -> str:
    """Return the name under which the operations of an element are in a compiled program."""
    return f"element-{ident}"


def _operation(line: str) -> Iterator[Collective]:
    match = OPERATION.search(line)
    if match is None:
        return
    kind, element = match[2], SCOPE.search(line)
    arrays = _arrays(match[1])
    if f" {kind}-start(" in line and kind != "all-reduce":
        # operands, results, and numbers of the runtime
        arrays = [array for array in arrays if array != ("u32", "")]
        arrays = arrays[len(arrays) // 2 :]
    size = sum(_bytes(name) * math.prod(int(n) for n in dims.split(",") if n) for name, dims in arrays)
    yield Collective(kind, size, element[1] if element else "")


def _arrays(form: str) -> list[tuple[str, str]]:
    """Return the types and dimensions of the arrays in the form of a result."""
    return ARRAY.findall(form)


def _bytes(name: str) -> int:
    """Return the size of a number."""
    return next((size for size, names in BYTES.items() if name in names), 4)


def _computations(text: str) -> Iterator[tuple[str, list[str]]]:
    name, lines = "", list[str]()
    for line in text.splitlines():
        if (match := COMPUTATION.match(line)) is not None:
            name, lines = match[1], []
        elif line == "}" and name:
            yield name, lines
            name = ""
        elif name:
            lines.append(line)


def _called(line: str) -> list[str]:
    return [
        name.strip().lstrip("%")
        for group in CALLED.findall(line)
        for name in group.strip("{}").split(",")
        if name.strip()
    ]
