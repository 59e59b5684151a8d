"""Sums in Fourier space: the ports, reads and functions of nodes that share waves.

`strategies` decides which nodes share. `shared` adds ports to them: what ends in `WAVES` holds the
coefficients of a port, and what ends in `REST` the part of an input that does not come as coefficients.
`functions` wraps the elements, which see neither: a `SharingSource` gives its output as coefficients and
takes those that arrive into the convolution of its dynamics, and a `SharingFilter` applies its own function
to coefficients, where a convolution is a product.
"""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Collection, Mapping, Sequence
from typing import TYPE_CHECKING, Any, TypeVar

from deodar.compiler.functions import Functions, TappedOver, own
from deodar.compiler.strategies import EXACT, Strategy, acted_axes, role
from deodar.element import Arrays, Element, Setting
from deodar.errors import ModelError
from deodar.model.resolve import Node, Slot
from deodar.numerics import interaction
from deodar.numerics.native import Kernels
from deodar.numerics.transforms import from_waves, to_waves

if TYPE_CHECKING:
    from jax import Array

T = TypeVar("T")

WAVES = "~"
"""Suffix of a port with the spectral modes of the port without the suffix; for an input, only the part that
arrives as modes.
"""

REST = "-"
"""Suffix of a port with the part of an input that does not arrive as spectral modes."""


@dc.dataclass(frozen=True)
class SharedNode(Node):
    """A node that shares waves: one with the ports that hold them."""

    def passes(self, port: str) -> Sequence[str]:
        direct = super().passes(port.removesuffix(WAVES))
        return (*direct, "input" + WAVES, "input" + REST) if "input" in direct else direct


def plain_ports(ports: Mapping[str, T]) -> dict[str, T]:
    """Return the ports of the element, without the ports for spectral modes."""
    return {name: port for name, port in ports.items() if not name.endswith((WAVES, REST))}


def shared(nodes: Sequence[Node], strategy_of: dict[str, Strategy]) -> list[Node]:
    """The nodes, with the second parts of ports where they share waves.

    What cannot share after all takes back its choice in `strategy_of`.
    """
    by = {n.id: n for n in nodes}
    smooth: set[str] = set()
    """Nodes whose output is complete as waves: a field's own is not, before a kernel has been applied to it.
    """
    joining = [n for n in nodes if strategy_of[n.id].shared and role(n) != "source"]
    for n in sorted(joining, key=lambda n: (n.level, n.id)):  # upstream first
        if role(n) == "filter" or (
            n.reads["input"]
            and all(s[0] in smooth and _joined(by[s[0]], n, strategy_of) for s in n.reads["input"])
        ):
            smooth.add(n.id)
        else:
            strategy_of[n.id] = EXACT
    return [_with_waves(n, by, strategy_of, smooth) if strategy_of[n.id].shared else n for n in nodes]


def _with_waves(
    n: Node, by: Mapping[str, Node], strategy_of: Mapping[str, Strategy], smooth: Collection[str]
) -> Node:
    strategy = strategy_of[n.id]
    waves = tuple(
        w.axis(a) for w, a in zip(dict(strategy.choices)[strategy.shared].waves, acted_axes(n), strict=True)
    )
    through = role(n) == "filter"

    def comes(slot: Slot) -> bool:
        source = by[slot[0]]
        if slot[1] != "output" or not _joined(source, n, strategy_of):
            return False
        if role(source) == "source":
            return through
        # beyond a border there is nothing; as waves what a kernel has spread over it would still be there for
        # the next
        return slot[0] in smooth and not (through and "zero" in strategy.shared)

    arriving = [slot for slot in n.reads["input"] if comes(slot)]
    staying = [slot for slot in n.reads["input"] if not comes(slot)]
    reads: dict[str, list[Slot]] = dict(n.reads)
    reads["input" + REST] = staying
    reads["input" + WAVES] = [(i, port + WAVES, instant) for i, port, instant in arriving]
    if role(n) == "source":  # its own, for its lateral interaction: transformed once
        reads["output" + WAVES] = [(n.id, "output" + WAVES, 0)]
    return SharedNode(
        n.id,
        n.path,
        n.element,
        n.every,
        n.ins | {"input" + REST: n.ins["input"], "input" + WAVES: waves},
        n.outs | {"output" + WAVES: waves},
        reads,
        n.level,
        n.declared,
    )


def _joined(a: Node, b: Node, strategy_of: Mapping[str, Strategy]) -> bool:
    """Return whether both nodes share the same spectral modes."""
    first, second = strategy_of[a.id], strategy_of[b.id]
    same = (
        bool(first.shared)
        and first.shared == second.shared
        and dict(first.choices)[first.shared] == dict(second.choices)[second.shared]
    )
    return same and a.every == b.every and acted_axes(a) == acted_axes(b)


# ------------------------------------------------------------------------------------------ wrapped functions


def functions(
    node: Node, strategy: Strategy, kernels: Kernels | None = None, tapped: TappedOver | None = None
) -> Functions:
    """Return the functions of a group whose rows have the structure of the node."""
    if not strategy.shared:
        return Functions(node, dict(strategy.choices), strategy.apart, kernels, tapped)
    return (SharingSource if role(node) == "source" else SharingFilter)(node, strategy, kernels, tapped)


class _Sharing(Functions):
    def __init__(
        self, node: Node, strategy: Strategy, kernels: Kernels | None, tapped: TappedOver | None
    ) -> None:
        super().__init__(node, dict(strategy.choices), strategy.apart, kernels, tapped)
        self.key, self.waves = strategy.shared, dict(strategy.choices)[strategy.shared].waves


class SharingSource(_Sharing):
    """Elements whose dynamics convolve their output: it is transformed once for all readers, and what arrives
    as waves is added before the one transform back.
    """

    def output(self, element: Element, at: Setting) -> Arrays:
        out = super().output(element, at)
        return out | {"output" + WAVES: to_waves(self.waves, out["output"], self.kernels)}

    def advance(self, element: Element, at: Setting) -> Arrays:
        ports, calls = at.inputs, list[Any]()

        def convolve(y: Array) -> Array:
            calls.append(y)
            modes = interaction.SharedModes(self.key, ports["output" + WAVES], ports["input" + WAVES])
            mixture, shared_parts = at.constants.kernels, (modes, self.kernels, self.tapped)
            return interaction.apply(mixture, self.axes, y, self.choices, *shared_parts)

        inputs = plain_ports(ports) | {"input": ports["input" + REST]}
        new = element.advance(own(at, convolve=convolve, inputs=inputs))
        if len(calls) != 1:
            raise ModelError(
                f"{type(element).__name__} declares a convolution that `advance` adds to its input, and calls"
                f" `at.convolve` {len(calls)} times; the input arrives by exactly one call",
                fix="Call it once in `advance`, or declare no convolution, and add the integral up yourself",
            )
        return new


class SharingFilter(_Sharing):
    """Elements that are linear and translation invariant: their own function is applied to waves, where the
    convolution is a product.
    """

    def output(self, element: Element, at: Setting) -> Arrays:
        arriving = at.inputs["input" + WAVES]
        if self.convolves:
            arriving = arriving + to_waves(self.waves, at.inputs["input" + REST], self.kernels)
            gains = at.constants.kernels["waves"][self.key]
            at = dc.replace(at, convolve=lambda y: gains * y)
        out = element.output(own(at, inputs={"input": arriving}))["output"]
        return {"output": from_waves(self.waves, out, self.kernels), "output" + WAVES: out}
