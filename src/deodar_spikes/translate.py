"""Translate a document to a network of spiking neurons, and report what has no counterpart.

A field becomes a population whose synapses have the field's time constant, because `tau du/dt = -u + ...` is
the equation of a synaptic current; rates follow the output function (`spike_code.py`). Elements that no
spiking element reaches, such as stimuli, are computed by deodar and are the input of the network. Couplings
between spiking elements must be linear: a chain of them becomes one matrix.

The constant current that holds a field at rest is the largest one, and neurons that differ in it differ in
their thresholds. Tonic neurons give all neurons of a network the same resting level: they are driven so
strongly that they spike in each step, however much they differ. Of the constant currents only the spread of
the thresholds remains, which follows the output function.
"""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Mapping, Sequence

import numpy as np

from deodar.couplings.delays import Delay
from deodar.element import Element
from deodar.errors import ModelError, ParameterError, TimeError, option
from deodar.importers.report import ImportReport, Line, Verdict
from deodar.model.document import Connection, Document, Entry
from deodar.model.document_graph import graph
from deodar.model.model import Model
from deodar.model.resolve import Node
from deodar.model.unit import unit_seconds
from deodar.parameters import parameters
from deodar_spikes.counterparts import COUNTERPARTS, Counterpart, TranslationSetup
from deodar_spikes.linear_maps import element_matrix, require_size
from deodar_spikes.network import Population, Projection, SpikingNetwork, WeightMatrix
from deodar_spikes.spike_code import QUICK, NoSpikeCode, SpikeCode

LABEL = "tonic neurons"

DRIVE = 10.0 * QUICK
"""Constant current of a tonic neuron: ten times the one from which on it spikes in each step."""


def with_tonic_neurons(network: SpikingNetwork, neurons: int) -> SpikingNetwork:
    """Return a network whose resting levels are synapses from tonic neurons.

    Args:
        network: the network.
        neurons: number of tonic neurons; each gives an equal part of every resting level.
    """
    quick = QUICK * network.step
    code = SpikeCode(1.0, np.full(neurons, DRIVE), 1.0, quick, 0.0, 0.0, 1.0, 0.0, 0.0)
    tonic = Population(LABEL, "", "tonic", (), code, 0.0, quick, probed=False)
    source = len(network.populations)
    resting = [
        Projection(source, target, np.full((p.cells, 1), p.resting))
        for target, p in enumerate(network.populations)
        if p.resting
    ]
    populations = [*(dc.replace(p, resting=0.0) for p in network.populations), tonic]
    return dc.replace(network, populations=populations, projections=[*network.projections, *resting])


NEURONS, MEMBRANE = 20, 20e-3
"""Defaults: neurons of a cell, and tau_mem in s."""

MOST_NEURONS = 200_000

Key = tuple[str, str]
"""Id of an element, and a port."""


@dc.dataclass(frozen=True)
class Translated:
    """A network, its report, and the document whose run gives its input.

    Attributes:
        network: populations and projections.
        report: a verdict for each element, parameter and connection.
        drive: the elements that are computed by deodar, and the spiking ones, which show what reaches them.
    """

    network: SpikingNetwork
    report: ImportReport
    drive: Document


def translate(
    model: Model,
    name: str = "",
    neurons: int = NEURONS,
    step: float | None = None,
    tonic: bool = False,
) -> Translated:
    """Translate a model to a network of spiking neurons.

    Args:
        model: the model; it must be free of problems.
        name: name of the file, for the report.
        neurons: neurons of a cell.
        step: dt in the document's time unit; none: the document's.
        tonic: whether neurons that spike in every step give the resting levels, in place of constant
            currents, which mismatch spreads.

    Raises:
        ModelError: the model has problems, or nothing in it has a counterpart that spikes.
        TimeError: the step is not shorter than every time constant.
        TooLarge: the network has too many neurons or weights.
    """
    doc = model.document
    nodes = graph(doc).required().nodes
    if neurons < 1:
        raise ParameterError(f"{neurons} neurons of a cell", fix=option("Give 1 or more:", "neurons", "20"))
    unit = unit_seconds(doc.time_unit)
    dt = (doc.step if step is None else step) * unit
    if not 0 < dt < MEMBRANE:
        raise TimeError(
            f"the step {dt * 1e3:g} ms is not below the membrane's time constant {MEMBRANE * 1e3:g} ms",
            fix=option("Give a shorter one, for example", "step", f"{MEMBRANE / 40 / unit:g}"),
        )
    return _Translation(doc, nodes, TranslationSetup(neurons, dt, MEMBRANE, unit, tonic)).run(name)


class _Translation:
    def __init__(self, doc: Document, nodes: Sequence[Node], setup: TranslationSetup) -> None:
        self.doc = doc
        self.entries = doc.by_id()
        self.nodes = {n.id: n for n in nodes}
        self.setup = setup
        self.populations: list[Population] = []
        self.index: dict[Key, int] = {}
        self.inner: list[Projection] = []
        self.lines: list[Line] = []
        self.failed: dict[str, str] = {}
        self.reached: set[str] = set()

    def run(self, name: str) -> Translated:
        for entry in self.doc.entries:
            if type(entry.element) in COUNTERPARTS:
                self._spiking(entry)
        if not self.populations:
            kinds = ", ".join(k.__name__ for k in COUNTERPARTS)
            why = "; ".join(f"{self.entries[i].path}: {reason}" for i, reason in self.failed.items())
            raise ModelError(
                f"nothing in the model {self.doc.name!r} becomes neurons that spike"
                + (f" ({why})" if why else ""),
                fix=f"Add one of: {kinds}",
            )
        total = sum(p.neurons for p in self.populations)
        if total > MOST_NEURONS:
            require_size(total * total, f"the network of {total:,} neurons")
        self.reached = self._reached()
        for entry in self.doc.entries:
            if type(entry.element) not in COUNTERPARTS:
                self._other(entry)
        projections = [*self.inner, *self._projections()]
        for c in self.doc.connections:
            self.lines.append(self._connection(c))
        setup = self.setup
        network = SpikingNetwork(self.populations, projections, setup.step, setup.unit)
        if setup.tonic:
            network = with_tonic_neurons(network, setup.neurons)
        return Translated(network, ImportReport("neuromorphic", name, self.lines), self._drive())

    # ---------------------------------------------------------------------------------------------- elements

    def _spiking(self, entry: Entry) -> None:
        """Add the populations of an element, and report its parameters."""
        try:
            counterpart = COUNTERPARTS[type(entry.element)](entry, self.setup)
        except NoSpikeCode as error:
            self.failed[entry.id] = str(error)
            self._all(entry, "dropped", str(error), "its element has no counterpart")
            return
        first = len(self.populations)
        for p in counterpart.populations:
            self.index[p.element, p.port] = len(self.populations)
            self.populations.append(p)
        self.inner += [
            Projection(p.source + first, p.target + first, p.weights) for p in counterpart.projections
        ]
        self._report(entry, counterpart)

    def _report(self, entry: Entry, counterpart: Counterpart) -> None:
        kind = type(entry.element).__name__
        counted = ", ".join(
            f"{p.cells} x {len(p.code.offsets)} neurons ({p.port})" for p in counterpart.populations
        )
        self.lines.append(Line(entry.path, "element", kind, "approximated", counted))
        for p in parameters(type(entry.element)):
            if p.name != "name":
                verdict, why = counterpart.parameters.get(p.name, ("carried", ""))
                self.lines.append(Line(entry.path, "parameter", p.name, verdict, why))

    def _other(self, entry: Entry) -> None:
        """Report an element without neurons of its own."""
        element = entry.element
        if entry.id not in self.reached:
            self._all(entry, "carried", "computed by deodar, an input of the network", "")
        elif self._linear(self.nodes[entry.id]):
            self._all(entry, "carried", "synaptic weights", "")
        else:
            self._all(entry, "dropped", self._obstacle(element), "its element has no counterpart")

    def _all(self, entry: Entry, verdict: Verdict, why: str, each: str) -> None:
        kind = type(entry.element).__name__
        self.lines.append(Line(entry.path, "element", kind, verdict, why))
        self.lines += [
            Line(entry.path, "parameter", p.name, verdict, each)
            for p in parameters(type(entry.element))
            if p.name != "name"
        ]

    def _obstacle(self, element: Element) -> str:
        """Return why an element that depends on rates has no counterpart."""
        kind = type(element).__name__
        if element.stateful:
            return f"it has a state of its own, and neurons have none like that of {kind}"
        return f"it reads rates, and synapses cannot compute a {kind}, which is not linear"

    # ------------------------------------------------------------------------------------------- connections

    def _reached(self) -> set[str]:
        """Return the nodes that depend on a population."""
        readers: dict[str, set[str]] = {}
        for n in self.nodes.values():
            for slots in n.reads.values():
                for ident, _, _ in slots:
                    readers.setdefault(ident, set()).add(n.id)
        found = {ident for ident, _ in self.index} | set(self.failed)
        waiting = list(found)
        while waiting:
            for reader in readers.get(waiting.pop(), ()):
                if reader not in found:
                    found.add(reader)
                    waiting.append(reader)
        return found

    def _linear(self, node: Node) -> bool:
        """Return whether an element is a matrix from its one input to its outputs, or a delay by a step."""
        if isinstance(node.element, Delay):
            return True
        return bool(node.element.linear) and not node.element.stateful and set(node.ins) == {"input"}

    def _projections(self) -> list[Projection]:
        """Return the projections of all couplings between populations."""
        out: list[Projection] = []
        arriving: dict[Key, Mapping[int, WeightMatrix]] = {}
        for (ident, port), target in self.index.items():
            if port != "output":
                continue
            found = self._arriving(self.nodes[ident], "input", arriving, ())
            out += [Projection(source, target, w) for source, w in found.items() if np.any(w)]
        return out

    def _arriving(
        self, node: Node, port: str, known: dict[Key, Mapping[int, WeightMatrix]], via: tuple[str, ...]
    ) -> Mapping[int, WeightMatrix]:
        """Return, for each population, the matrix from its rates to what arrives at an input port."""
        total: dict[int, WeightMatrix] = {}
        for ident, out, _ in node.reads.get(port, ()):
            for source, w in self._leaving(ident, out, known, via).items():
                total[source] = total[source] + w if source in total else w
        return total

    def _leaving(
        self, ident: str, port: str, arriving: dict[Key, Mapping[int, WeightMatrix]], via: tuple[str, ...]
    ) -> Mapping[int, WeightMatrix]:
        """Return, for each population, the matrix from its rates to an output port."""
        if (ident, port) in arriving:
            return arriving[ident, port]
        weights: Mapping[int, WeightMatrix] = {}
        node = self.nodes[ident]
        if (ident, port) in self.index:
            k = self.index[ident, port]
            weights = {k: np.eye(self.populations[k].cells)}
        elif ident in self.reached and self._linear(node) and ident not in via:
            before = self._arriving(node, "input", arriving, (*via, ident))
            if isinstance(node.element, Delay) or not before:
                weights = before
            else:
                matrix = element_matrix(node, port)
                weights = {source: matrix @ w for source, w in before.items()}
        arriving[ident, port] = weights
        return weights

    def _connection(self, c: Connection) -> Line:
        """Report a connection."""
        source, target = self.entries[c.source], self.entries[c.target]
        what = source.path if c.source_port == "output" else f"{source.path}.{c.source_port}"
        gone = self._gone(source, c.source_port) or self._gone(target, "")
        if gone:
            return Line(target.path, "connection", what, "dropped", gone)
        if c.reads == "delayed":
            why = "a spike arrives in the same step or the next, and not one step later"
            return Line(target.path, "connection", what, "approximated", why)
        return Line(target.path, "connection", what, "carried")

    def _gone(self, entry: Entry, port: str) -> str:
        """Return why nothing connects to an element, or to a port of it."""
        if entry.id in self.failed:
            return f"{entry.path} has no counterpart"
        if type(entry.element) in COUNTERPARTS:
            known = not port or (entry.id, port) in self.index
            return "" if known else f"neurons send spikes, and no {port}"
        if entry.id in self.reached and not self._linear(self.nodes[entry.id]):
            return f"{entry.path} has no counterpart"
        return ""

    def _drive(self) -> Document:
        """Return the document of what is computed by deodar: its runs give the input of the network."""
        spiking = {ident for ident, _ in self.index}
        ids = {e.id for e in self.doc.entries if e.id not in self.reached}
        inner = [c for c in self.doc.connections if c.source not in spiking and c.target not in self.failed]
        grown = True
        while grown:  # linear couplings that pass on what deodar computes
            more = {
                c.target
                for c in inner
                if c.source in ids and c.target not in spiking and self._linear(self.nodes[c.target])
            }
            grown = bool(more - ids)
            ids |= more
        ids |= spiking
        return dc.replace(
            self.doc,
            entries=tuple(e for e in self.doc.entries if e.id in ids),
            connections=tuple(c for c in inner if c.source in ids and c.target in ids),
            parameters=tuple(
                dc.replace(p, links=tuple(link for link in p.links if link[0] in ids))
                for p in self.doc.parameters
            ),
            uses=(),
        )
