"""Which ports a connection may join, and which couplings convert between axes that differ.

The answers follow from what kinds declare: their ports, `input_axes`, `outputs`, `validate_axes`, `warnings`
and `starting_values`. No kind is known by name.
"""

from __future__ import annotations

import dataclasses as dc
import functools
import itertools
import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import Any

from deodar.element import Coupling, Element
from deodar.errors import AxesError, DeodarError
from deodar.model import document_files, edit, find, new_elements
from deodar.model.document import Document, Entry
from deodar.model.document_graph import graph
from deodar.model.resolve import Node, misfit, reach
from deodar.numerics.axes import Axes, Axis, describe, shape
from deodar.parameters import parameters

MOST_RESOLVED = 20
"""Number of candidates for which the whole document is resolved again, because axes further on change."""

MOST_RENAMED = 3
"""Largest number of axes that a conversion renames at once."""


@dc.dataclass(frozen=True)
class Offer:
    """A coupling that converts between the axes of two ports.

    Attributes:
        kind: its kind.
        values: its parameters in the format of documents, without those that a new element gets anyway.
        note: what it loses; empty if it keeps every position.
    """

    kind: str
    values: Mapping[str, Any]
    note: str = ""


@dc.dataclass(frozen=True)
class Fit:
    """Whether a port can be connected.

    Attributes:
        element: id of its element.
        port: its name.
        fits: whether it can.
        reason: why not, or how the connection changes the values; empty if they stay as they are.
        offers: couplings that can stand between ports whose axes differ, the best first.
    """

    element: str
    port: str
    fits: bool
    reason: str = ""
    offers: tuple[Offer, ...] = ()


@dc.dataclass(frozen=True)
class FittingKind:
    """A kind whose new element can be connected, and its port."""

    kind: str
    port: str


def fits(doc: Document, ident: str, port: str) -> tuple[list[Fit], list[FittingKind]]:
    """Judge every port of the other direction, and every kind of element.

    Args:
        doc: the document.
        ident: id of an element.
        port: one of its ports; an empty one is the default output, or the first input without outputs.

    Returns:
        For an output port, the input ports; for an input port, the output ports. And the kinds whose new
        element could be connected.

    Raises:
        UnknownName: the element or the port does not exist.
    """
    entry = find.entry(doc, ident)
    outs, ins = find.outputs(entry), entry.element.ports()
    port = port or (outs or list(ins))[0]
    if port not in (*outs, *ins):
        find.port(doc, f"{entry.path}.{port}")
    judge = _Judge(doc)
    if port in outs:
        axes = judge.output(ident, port)
        return judge.targets(entry, port, axes), kinds_after(doc, axes)
    axes_before = judge.input(ident, port)
    return judge.sources(entry, port), kinds_before(doc, axes_before)


def offers(axes: Axes, want: Axes, keys: Callable[[Axis], str]) -> tuple[Offer, ...]:
    """Return the couplings whose output over `want` follows from an input over `axes`, the best first.

    Those that lose nothing come first; among these the ones with fewest parameters to choose, without a
    state of their own.

    Args:
        axes: axes of the source.
        want: axes of the target.
        keys: returns the key of an axis in the document.
    """
    out: list[Offer] = []
    for cls, values, note, _ in _offers(axes, want):
        arguments = {k: [keys(a) for a in v] if k == "axes" else v for k, v in values.items()}
        out.append(Offer(cls.__name__, arguments, note))
    return tuple(out)


def kinds_after(doc: Document, axes: Axes | None) -> list[FittingKind]:
    """Return the kinds and input ports that can read a port with these axes (None: unknown)."""
    usual = new_elements.usual_axes(doc)
    return list(_after(usual if axes is None else axes))


def kinds_before(doc: Document, want: Axes | None) -> list[FittingKind]:
    """Return the kinds whose default output can be connected to a port with these axes (None: any)."""
    return list(_before(new_elements.usual_axes(doc) if want is None else want))


@functools.lru_cache(maxsize=64)
def _offers(
    axes: Axes, want: Axes
) -> tuple[tuple[type[Element], Mapping[str, Any], str, tuple[Any, ...]], ...]:
    ranked: list[tuple[type[Element], Mapping[str, Any], str, tuple[Any, ...]]] = []
    for cls in new_elements.kinds():
        if not issubclass(cls, Coupling) or cls.inputs != ("input",):
            continue
        best: tuple[type[Element], Mapping[str, Any], str, tuple[Any, ...]] | None = None
        for values in _candidates(cls, axes, want):
            note = _converts(cls, values, axes, want)
            if note is not None and (best is None or (best[2] and not note)):
                arrays = sum(p.form == "array" for p in parameters(cls))
                rank = (bool(note), cls.stateful, cls.jumps, arrays, len(parameters(cls)), cls.__name__)
                best = (cls, values, note, rank)
        if best is not None:
            ranked.append(best)
    return tuple(sorted(ranked, key=lambda f: f[3]))


def _candidates(cls: type[Element], axes: Axes, want: Axes) -> Iterator[Mapping[str, Any]]:
    """Yield values for a coupling between two ports: with the axes of the target, and with names replaced."""
    forms = {p.name: p.form for p in parameters(cls)}
    target_axes: dict[str, Any] = {"axes": want} if forms.get("axes") == "axes" else {}
    yield target_axes
    sources, targets = {a.name: a for a in axes}, {a.name: a for a in want}
    extra, missing = [n for n in sources if n not in targets], [n for n in targets if n not in sources]
    if len(extra) != len(missing) or not 0 < len(extra) <= MOST_RENAMED:
        return
    for name in (n for n, form in forms.items() if form == "pairs"):
        for order in itertools.permutations(missing):
            pairs = dict(zip(extra, order, strict=True))
            if all(
                dc.replace(sources[a], unit="").fits(dc.replace(targets[b], unit=""))
                for a, b in pairs.items()
            ):
                yield target_axes | {name: pairs}


def _converts(cls: type[Element], values: Mapping[str, Any], axes: Axes, want: Axes) -> str | None:
    """Return what a coupling loses between two ports; None if it does not fit between them."""
    try:
        element_axes: Axes = values.get("axes", axes)
        begun = {k: v for k, v in cls.starting_values(element_axes, axes).items() if k not in values}
        element = cls(name="between", **values, **begun)
        ins: dict[str, Axes] = {}
        for port in element.ports():
            ins[port] = _arriving(element, port, axes)
        if ins["input"] != axes or any(True for _ in element.validate_axes(ins)):
            return None
        outs = element.outputs(ins)
        if tuple(next(iter(outs.values()))) != want:
            return None
        return "; ".join(loss for loss, _ in element.warnings(ins))
    except (DeodarError, KeyError, TypeError):
        return None


def _arriving(element: Element, port: str, axes: Axes) -> Axes:
    declared = element.input_axes(port, axes)
    return axes if declared is None else declared


@functools.lru_cache(maxsize=64)
def _after(axes: Axes) -> tuple[FittingKind, ...]:
    out: list[FittingKind] = []
    for cls, element in _new_elements(axes):
        for port in element.ports():
            ins = {p: _arriving(element, p, axes) for p in element.ports()}
            if not misfit(axes, ins[port]) and not any(True for _ in element.validate_axes(ins)):
                out.append(FittingKind(cls.__name__, port))
    return tuple(out)


@functools.lru_cache(maxsize=64)
def _before(want: Axes) -> tuple[FittingKind, ...]:
    out: list[FittingKind] = []
    for cls, element in _new_elements(want):
        ins = {p: _arriving(element, p, want) for p in element.ports()}
        try:
            outs = element.outputs(ins)
        except KeyError:
            continue
        if outs:
            port, axes = next(iter(outs.items()))
            if not misfit(tuple(axes), want) and not any(True for _ in element.validate_axes(ins)):
                out.append(FittingKind(cls.__name__, port))
    return tuple(out)


def _new_elements(axes: Axes) -> Iterator[tuple[type[Element], Element]]:
    """Yield every kind with a new element of it over these axes."""
    empty = Document("kinds")
    for cls in new_elements.kinds():
        try:
            yield cls, new_elements.element(empty, cls.__name__, "new", {}, axes, axes)
        except (DeodarError, TypeError):
            continue


class _Judge:
    """The resolved document, and the questions about it."""

    def __init__(self, doc: Document) -> None:
        self.doc = doc
        self.problems = graph(doc).problems
        self.nodes = {n.id: n for n in graph(doc).nodes if n.declared}
        self.axes = document_files.axes(doc)
        self.ends = doc.ends()
        self.resolved = 0

    def key(self, axis: Axis) -> str:
        return document_files.axis_key(self.axes, axis)

    def output(self, ident: str, port: str) -> Axes | None:
        node = self.nodes.get(ident)
        return None if node is None or port not in node.outs else tuple(node.outs[port])

    def input(self, ident: str, port: str) -> Axes | None:
        """Return the axes of an input port; None if it takes those of its first connection."""
        entry, node = self.doc.by_id()[ident], self.nodes.get(ident)
        if node is not None and node.reads.get(port):
            return node.ins.get(port)
        follows = type(entry.element).follows.get(port, "")
        if node is not None and follows and node.reads.get(follows):
            return node.ins.get(follows)
        return entry.element.input_axes(port, None)

    # -------------------------------------------------------------------------------------------- directions

    def targets(self, source: Entry, port: str, axes: Axes | None) -> list[Fit]:
        """Judge every input port of the document as the target of an output port."""
        ahead = self.upstream(source.id)
        return [
            self.fit(source, port, axes, target, name, ahead, (target.id, name))
            for target in self.doc.entries
            for name in target.element.ports()
        ]

    def sources(self, target: Entry, port: str) -> list[Fit]:
        """Judge every output port of the document as the source of an input port."""
        out: list[Fit] = []
        for source in self.doc.entries:
            for name in find.outputs(source):
                axes, ahead = self.output(source.id, name), self.upstream(source.id)
                out.append(self.fit(source, name, axes, target, port, ahead, (source.id, name)))
        return out

    def fit(
        self,
        source: Entry,
        port: str,
        axes: Axes | None,
        target: Entry,
        name: str,
        ahead: set[tuple[str, str]],
        place: tuple[str, str],
    ) -> Fit:
        if (source.id, port, target.id, name) in self.ends:
            want = axes if axes is None else self.judged(source, port, axes, target, name)[1]
            instead = (
                () if axes is None or want is None or not misfit(axes, want) else offers(axes, want, self.key)
            )
            return Fit(*place, False, "they are connected already", instead)
        if (target.id, name) in ahead:
            return Fit(*place, False, "this would close a loop without a state in it")
        if axes is None:
            return Fit(*place, True, f"the axes of {source.path} are not known yet")
        reason, want = self.judged(source, port, axes, target, name)
        if reason:
            return Fit(*place, False, reason, offers(axes, want, self.key) if want != axes else ())
        return Fit(*place, True, _change(axes, want))

    # ------------------------------------------------------------------------------------------------ judging

    def judged(self, source: Entry, port: str, axes: Axes, target: Entry, name: str) -> tuple[str, Axes]:
        """Return why a connection does not fit, "" if it does, and the axes that the input port then has."""
        element, node = target.element, self.nodes.get(target.id)
        want = self.input_axes(element, node, name, axes)
        ends = f"{source.path} has {describe(axes)}, {target.path}.{name} has {describe(want)}"
        if why := misfit(axes, want):
            return f"{ends}: {why}", want
        if node is not None and node.reads.get(name) and (why := misfit(tuple(node.ins[name]), want)):
            return f"{ends}, and other connections into it do not fit these: {why}", want
        follows = type(element).follows.get(name, "")
        if follows and {a.name for a in axes} > {a.name for a in want}:
            return f"{ends}: it has more axes, so it belongs to the port {follows!r}", want
        ins = self.ins(element, node) | {name: want}
        before = set() if node is None else set(self.validated(element, self.ins(element, node)))
        new = [fault for fault in self.validated(element, ins) if fault not in before]
        if new:
            return f"{ends}: it {new[0]}", want
        return self.further(source, port, target, name, ins), want

    def input_axes(self, element: Element, node: Node | None, name: str, axes: Axes) -> Axes:
        """Return the axes that an input port would have with one more connection."""
        follows = type(element).follows.get(name, "")
        if node is not None and follows and node.reads.get(follows):
            return tuple(node.ins[follows])
        want = element.input_axes(name, axes)
        if (want is None or tuple(want) == axes) and node is not None and node.reads.get(name):
            old = tuple(node.ins[name])
            return max(old, axes, key=lambda a: (len(a), math.prod(shape(a)), a == old))
        return axes if want is None else tuple(want)

    def ins(self, element: Element, node: Node | None) -> dict[str, Axes]:
        if node is not None:
            return dict(node.ins)
        return {p: tuple(element.input_axes(p, None) or ()) for p in element.ports()}

    def validated(self, element: Element, ins: Mapping[str, Axes]) -> Sequence[str]:
        try:
            faults = list(element.validate_axes(ins))
        except (KeyError, AxesError):
            return []
        return [fault if isinstance(fault, str) else fault[0] for fault in faults]

    def further(self, source: Entry, port: str, target: Entry, name: str, ins: Mapping[str, Axes]) -> str:
        """Return the problem of what reads the target, if its output axes change by the connection."""
        node, element = self.nodes.get(target.id), target.element
        read = any(c.source == target.id for c in self.doc.connections)
        if not type(element).direct or not read or self.resolved >= MOST_RESOLVED:
            return ""
        if node is not None and dict(element.outputs(ins)) == dict(node.outs):
            return ""
        self.resolved += 1
        new = edit.connect(self.doc, source, port, target, name)
        new_problems = [p for p in graph(new).problems if p not in self.problems]
        return f"{new_problems[0].where}: {new_problems[0].what}" if new_problems else ""

    def upstream(self, ident: str) -> set[tuple[str, str]]:
        """Return the input ports on which an output port depends in the same instant, or for its axes."""

        def direct(i: str) -> list[tuple[str, str]]:
            # the axes of all outputs of an element are known together, so a state shown beside a direct
            # output, such as learned weights, waits for the inputs too
            passed = type(self.doc.by_id()[i].element).direct.values()
            return [(i, name) for names in passed for name in names]

        return reach(
            direct(ident),
            lambda end: [before for source, _ in self.into.get(end, []) for before in direct(source)],
        )

    @functools.cached_property
    def into(self) -> Mapping[tuple[str, str], list[tuple[str, str]]]:
        """The output ports that are connected to each input port, except by a delay."""
        out: dict[tuple[str, str], list[tuple[str, str]]] = {}
        for c in self.doc.connections:
            if c.reads != "delayed":
                out.setdefault((c.target, c.target_port), []).append((c.source, c.source_port))
        return out


def _change(axes: Axes, want: Axes) -> str:
    """Return how a connection between axes that fit changes the values, in words; "" if it does not."""
    sources, targets = {a.name: a for a in axes}, {a.name: a for a in want}
    words = _listed("the integral over", (n for n in sources if n not in targets))
    words += _listed("the same value everywhere along", (n for n in targets if n not in sources))
    resampled = [n for n in targets if n in sources and targets[n].samples != sources[n].samples]
    words += [f"{sources[n].samples} samples of {n} become {targets[n].samples}" for n in resampled]
    return ", ".join(words)


def _listed(effect: str, names: Iterable[str]) -> list[str]:
    text = ", ".join(names)
    return [f"{effect} {text}"] if text else []
