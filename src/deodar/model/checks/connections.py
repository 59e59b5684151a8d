"""Connections that are missing or duplicated."""

from __future__ import annotations

from collections.abc import Iterator

from deodar.couplings.arithmetic import Gain
from deodar.elements.placeholder import Placeholder
from deodar.elements.world_ports import Motor
from deodar.errors import ConnectionFix, EditFix, Fix, Problem
from deodar.model.paths import quote
from deodar.model.resolve import Node
from deodar.model.wiring import Wiring, warning
from deodar.proposed_edit import Disconnect

NEEDED = {
    "gate": "it never learns",
    "factor": "its output is always 0",
    "post": "it never learns anything",
    "error": "its gains never change",
}
"""Ports without which an element has no effect, and the reason."""

IDLE = ("Motor", "MemoryTrace", "Attractor", "DelayLine", "History", "TransientDetector", "Delay")
"""Kinds that have no effect without an input."""


def check(wiring: Wiring) -> Iterator[Problem]:
    """Report ports without an input, sources without a reader, signals and motors that occur twice, and
    document parameters that drive no parameter.
    """
    for n in wiring.declared:
        yield from _ports(wiring, n)
        yield from _twice(wiring, n)
    motors: dict[str, Node] = {}
    for n in wiring.declared:
        if isinstance(n.element, Motor) and (first := motors.setdefault(n.element.motor, n)) is not n:
            sentence = (
                f"commands the motor {n.element.motor!r}, which {first.path} commands too: a motor takes one"
                " command"
            )
            yield warning(n, sentence, "Name another motor, or connect both signals to one element")
    for shared in wiring.doc.parameters:
        if not shared.links and wiring.driven:
            link = f"Link it: model.link('element.parameter', {shared.name!r}); or remove it"
            fix = Fix(link, page="Let it drive a parameter, or remove it")
            yield Problem(shared.name, "the document parameter drives nothing", fix, "warning")


def _ports(wiring: Wiring, n: Node) -> Iterator[Problem]:
    e = n.element
    for port in e.ports():
        if port in NEEDED and not n.reads.get(port) and n.id in wiring.driven:
            yield warning(
                n,
                f"nothing is connected to its port {port!r}, so {NEEDED[port]}",
                ConnectionFix.into(n.path, port),
            )
    if type(e).__name__ in IDLE and not n.reads.get("input"):
        yield warning(
            n,
            "nothing is connected to it, so it does nothing",
            ConnectionFix.into(n.path, otherwise="or remove it"),
        )
    # a model may have a sensor only to record it
    if not e.ports() and not e.external and not wiring.readers[n.id]:
        if port := next(iter(n.outs), ""):
            yield warning(n, "nothing reads it", ConnectionFix.out_of(n.path, port, "or remove it"))
        else:
            yield warning(n, "has no ports, so it does nothing", "Remove it")
    if isinstance(e, Placeholder) and wiring.readers[n.id]:
        yield warning(
            n,
            f"is a placeholder for {e.missing or 'a missing element'}: its output is 0",
            "Replace it with an element that computes this",
        )


def _twice(wiring: Wiring, n: Node) -> Iterator[Problem]:
    for port in n.reads:
        direct = wiring.sources(n, port)
        for g in direct:
            if (
                isinstance(g.element, Gain)
                and (source := wiring.sources(g))
                and len(source) == 1
                and source[0] in direct
                and not source[0].element.stateful
            ):
                sentence = f"gets {source[0].path} twice: directly, and through {g.path}"
                yield warning(
                    n,
                    sentence,
                    EditFix("Disconnect one", [Disconnect(source[0].path, f"{n.path}.{quote(port)}")]),
                )
