"""What a program is built from. Its key alone decides whether a program computes a document."""

from __future__ import annotations

import dataclasses as dc
import functools
from collections.abc import Hashable, Mapping, Sequence
from typing import TYPE_CHECKING

from deodar.compiler import device as devices
from deodar.compiler.copy_batch import Batch
from deodar.compiler.device import Device
from deodar.compiler.division import Distribution, divided_axis
from deodar.compiler.strategies import EXACT, Strategy, strategies
from deodar.errors import ParameterError
from deodar.leaves import leaves, same_structure
from deodar.model.document import Document, Entry, Leaf
from deodar.model.document_graph import graph
from deodar.model.resolve import Node, reach, readers
from deodar.numerics import interaction, native
from deodar.numerics.choice import MANY, Shards
from deodar.parameters import Parameter

if TYPE_CHECKING:
    from deodar.compiler.body import Body

PRECISIONS = ("float32", "float64")
ACCURACIES = ("default", "exact")


@dc.dataclass(frozen=True, eq=False)
class Build:
    """What a program is built from: a document, and how it runs. Builds of one key have one program.

    Attributes:
        doc: the document.
        precision: float32 or float64.
        accuracy: "exact" applies every kernel by its matrix, as double precision always does; "default" may
            take what is cheaper and errs by less than 1e-4 in activation.
        on: the device, or the devices that divide the work; None: the CPU.
        body: the world inside the step; None: there is none, or it is on the host.
        batch: the copies that run at once.
        plain: whether there are no compiled kernels, which have no derivatives.
        staying: leaves that stay in the program although they have their neutral value now.
    """

    doc: Document
    precision: str = "float32"
    accuracy: str = "default"
    on: str | Distribution | None = None
    body: Body | None = None
    batch: Batch = Batch()
    plain: bool = False
    staying: frozenset[Leaf] = frozenset()

    def __post_init__(self) -> None:
        if self.precision not in PRECISIONS:
            raise ParameterError(f"precision is {self.precision!r}; expected float32 or float64")
        if self.accuracy not in ACCURACIES:
            raise ParameterError(f"accuracy is {self.accuracy!r}; expected default or exact")

    # ------------------------------------------------------------------------------------------ what follows

    @property
    def exact(self) -> bool:
        """Whether every kernel is applied by its matrix."""
        return self.accuracy == "exact" or self.precision == "float64"

    @property
    def distribution(self) -> Distribution | None:
        """The devices among which the program is divided; None: it runs on one."""
        return self.on if isinstance(self.on, Distribution) else None

    @functools.cached_property
    def device(self) -> Device:
        """The device; of several the first that belongs to this host."""
        return self.on.own if isinstance(self.on, Distribution) else devices.find(self.on)

    @property
    def part(self) -> Batch:
        """The copies that one device computes."""
        return self.batch if self.distribution is None else self.distribution.part(self.batch)

    @property
    def fields(self) -> Distribution | None:
        """The devices, if they divide the fields of one copy."""
        return None if self.distribution is None else self.distribution.of_fields

    @property
    def kernels(self) -> native.Kernels | None:
        """The compiled kernels that the program calls; None where JAX computes all."""
        # a call of a kernel cannot be divided
        without = self.plain or self.fields is not None
        return None if without else native.kernels(self.device.platform, self.precision)

    @functools.cached_property
    def lifted(self) -> frozenset[Leaf]:
        """The leaves that are swept."""
        return frozenset(leaf for leafs in self.batch.sweep for leaf in leafs)

    def omitted(self, entry: Entry) -> frozenset[Leaf]:
        """Return the leaves of an element that have their neutral value, and are left out of the program."""
        return frozenset(entry.resting) - self.lifted - self.staying

    @functools.cached_property
    def neutral(self) -> frozenset[Leaf]:
        """The leaves of the document that are left out of the program."""
        return frozenset().union(*(self.omitted(e) for e in self.doc.entries))

    @functools.cached_property
    def still(self) -> Mapping[str, bool]:
        """Whether the outputs of each node are constant during a chunk."""
        return still(graph(self.doc).nodes, self.body is not None)

    @functools.cached_property
    def shards(self) -> Shards | None:
        """The axis that devices divide.

        Raises:
            DeviceError: the document has no axis that these devices can divide.
        """
        return None if self.fields is None else divided_axis(graph(self.doc).nodes, len(self.fields.devices))

    @functools.cached_property
    def strategies(self) -> Mapping[str, Strategy]:
        """How each node applies its kernels."""
        nodes, by, copies = graph(self.doc).nodes, self.doc.by_id(), self.part.planned
        if graph(self.doc).problems:
            return {}
        costs = {(i, path): cost(p) for i, _ in self.lifted for path, _, p in leaves(by[i].element)}
        # their constants are computed for several values at once
        swept = {leaf[0] for leaf in self.lifted if costs[leaf] == "rebuild"}
        exact = {n.id for n in nodes} if self.exact else swept
        strategy_of = strategies(nodes, self.still, exact, copies, self.shards)
        if copies // (trials := self.part.trials or 1) >= MANY > trials:
            for i in {i for i, path in self.lifted if path.startswith("kernel.")} - swept:
                strategy_of[i] = dc.replace(strategy_of[i], apart=True)
        return strategy_of

    # ------------------------------------------------------------------------------------------------ the key

    @functools.cached_property
    def key(self) -> Hashable:
        """A key whose change requires a new program.

        Functions of the user are imported for it, so the document must be trusted.
        """
        functions = tuple(e.element.load() for e in self.doc.entries if e.element.external_code())
        return self.form, functions

    @functools.cached_property
    def form(self) -> Hashable:
        """The key without the functions of the user, which it names: nothing is imported for it."""
        distribution = self.distribution
        return (
            tuple(sorted(e.structure for e in self.doc.entries)),
            frozenset(self.doc.connections),
            self.neutral,
            tuple((i, choice) for i, choice in sorted(self.strategies.items()) if choice != EXACT),
            self.precision,
            self.exact,
            self.batch,
            devices.name(self.device),
            native.version(self.kernels),
            self.body and self.body.key,
            self.plain,
            distribution and distribution.key,
        )

    def of(self, doc: Document) -> Build:
        """Return what a new program of another document is built from."""
        return dc.replace(self, doc=doc, staying=frozenset())

    def continued(self, doc: Document) -> Build:
        """Return what a running program would be built from with another document.

        A leaf of the program stays in it at its neutral value, unless that switches something off. The form
        is taken over where nothing that it follows from has changed, so that a change of one number is as
        quick in a large model.
        """
        before = self.doc.by_id()
        changed = [e for e in doc.entries if e is not before.get(e.id)]
        ids = {e.id for e in changed}
        rests = {leaf for e in changed for leaf, off in e.resting.items() if not off} - self.neutral
        staying = frozenset(rests | {leaf for leaf in self.staying if leaf[0] not in ids})
        new = dc.replace(self, doc=doc, staying=staying)
        if (
            doc.connections is self.doc.connections
            and len(doc.entries) == len(before)
            and all(e.id in before and _alike(before[e.id], e) for e in changed)
            and all(self.omitted(before[e.id]) == new.omitted(e) for e in changed)
        ):
            new.__dict__.update(form=self.form, neutral=self.neutral, strategies=self.strategies)
        return new

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Build) and self.key == other.key

    def __hash__(self) -> int:
        return hash(self.key)


def cost(p: Parameter) -> str:
    """Return the cost of a change of a leaf; arrays are constants of `prepare`."""
    return "rebuild" if p.form == "array" else p.cost


def still(nodes: Sequence[Node], embodied: bool) -> dict[str, bool]:
    """Return whether the outputs of each node are constant during a chunk.

    Args:
        nodes: the nodes of the model.
        embodied: whether readings of sensors change in it.
    """

    def changes(n: Node) -> bool:
        alone = not n.element.stateful and n.element.steady() and n.element.noise_axes() is None
        return not alone or (embodied and bool(n.element.external))

    changing = reach((n.id for n in nodes if changes(n)), readers(nodes).__getitem__)
    return {n.id: n.id not in changing for n in nodes}


def _alike(a: Entry, b: Entry) -> bool:
    """Return whether two elements have the same structure, and kernels of about the same widths: while their
    buckets are equal, so are all strategies.
    """
    before, after = a.element.kernels(), b.element.kernels()
    widths = before is after or interaction.buckets(before) == interaction.buckets(after)
    return a.every == b.every and widths and same_structure(a.element, b.element)
