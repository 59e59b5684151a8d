"""The document: an immutable description of an architecture."""

from __future__ import annotations

import dataclasses as dc
import functools
from collections.abc import Collection, Hashable, Iterable, Iterator, Mapping, Sequence
from typing import Any

from deodar.codec import Json
from deodar.element import Element
from deodar.errors import Problem
from deodar.leaves import StepLimit, resting, step_limits, structure
from deodar.model.parts import axes_in
from deodar.model.paths import Index, PathNames, display
from deodar.numerics.axes import Axes
from deodar.summary import Summarised, Summary, counted

VERSION = 4
READS = ("", "previous", "current", "delayed")
KEYS = (
    *(
        "deodar",
        "written_by",
        "name",
        "time_unit",
        "dt",
        "t0",
        "axes",
        "parameters",
        "elements",
        "connections",
        "groups",
        "uses",
        "packages",
        "arrays",
    ),
    *("notes", "layout"),
)
"""Keys of a document file, in their order."""

Leaf = tuple[str, str]
"""Element id and path of a traced leaf inside the element."""


@dc.dataclass(frozen=True, repr=False)
class Entry(Summarised):
    """One element of a document.

    `id` is its stored identity, `names` its path (groups, then its own name), `every` the length of its step
    in ticks.
    """

    id: str
    names: PathNames
    element: Element
    every: int = 1

    def __getstate__(self) -> dict[str, Any]:
        """Return the state for a pickle, without what follows from it."""
        return _stated(self)

    @property
    def path(self) -> str:
        """The path as text."""
        return display(self.names)

    @property
    def group(self) -> PathNames:
        """Names of the groups that contain it."""
        return self.names[:-1]

    @functools.cached_property
    def structure(self) -> tuple[Hashable, ...]:
        """All that a program depends on but the values of traced leaves; the id comes first."""
        return (self.id, self.every, structure(self.element))

    @functools.cached_property
    def axes(self) -> Axes:
        """The axes of the element and of its parts, each once."""
        return tuple(dict.fromkeys(axes_in(self.element)))

    @functools.cached_property
    def resting(self) -> Mapping[Leaf, bool]:
        """The leaves that have their neutral value, and whether that switches something off."""
        return {(self.id, path): p.off for path, p in resting(self.element).items()}

    @functools.cached_property
    def limits(self) -> tuple[StepLimit, ...]:
        """The parameters that limit the Euler step."""
        return tuple(step_limits(self.element))

    def too_long(self, dt: float, unit: str) -> Iterator[Problem]:
        """Report an Euler step that is too long for the element; `check` and runs use the same sentence.

        Args:
            dt: Euler step of the model.
            unit: unit of time of the document.
        """
        for limit in self.exceeded(dt):
            better = "smaller" if limit.role == "rate" else "larger"
            yield Problem(
                self.path,
                f"the step of {dt * self.every:g} {unit} is longer than {limit}",
                f"Use dt <= {limit.longest / self.every:g}, better a tenth of it, or a {better} {limit.path}",
            )

    def exceeded(self, dt: float) -> list[StepLimit]:
        """Return the limits that an Euler step of the model exceeds."""
        return [limit for limit in self.limits if dt * self.every > limit.longest * (1 + 1e-9)]

    def _summary(self) -> Summary:
        return Summary(f"{type(self.element).__name__} {self.path}")


@dc.dataclass(frozen=True)
class Connection:
    """From an output port to an input port, elements by id. `reads` is empty if the model states no value."""

    source: str
    source_port: str
    target: str
    target_port: str
    reads: str = ""

    @property
    def ends(self) -> tuple[str, str, str, str]:
        """The identity of the connection: its element ids and ports, without `reads`."""
        return (self.source, self.source_port, self.target, self.target_port)


@dc.dataclass(frozen=True)
class DocumentParameter:
    """A document parameter and the parameters of elements that it drives: (id, path inside the element)."""

    name: str
    value: float
    links: tuple[Leaf, ...] = ()


@dc.dataclass(frozen=True)
class Use:
    """A group that stays linked to a template: its path, the template's name, and (id in the template, id
    here) for each of its elements.
    """

    group: PathNames
    template: str
    elements: tuple[tuple[str, str], ...] = ()


@dc.dataclass(frozen=True, repr=False)
class Document(Summarised):
    """An architecture as immutable data. Only `deodar.model.edit` makes new documents.

    Attributes:
        spare_axes: axes that no element has yet, for elements to come. An axis that an element has is not
            among them, so that a document and its file, which has one table of axes, are equal.
        foreign: whether the document came from a file or another process and the user has not allowed the
            functions that it names to be run. It is not written to files, does not count when documents are
            compared, and is copied to every document that is made from this one.
    """

    name: str
    entries: tuple[Entry, ...] = ()
    connections: tuple[Connection, ...] = ()
    groups: tuple[PathNames, ...] = ()
    parameters: tuple[DocumentParameter, ...] = ()
    uses: tuple[Use, ...] = ()
    time_unit: str = "ms"
    dt: float | None = None
    t0: float = 0.0
    notes: str = ""
    layout: Mapping[str, Json] = dc.field(default_factory=dict[str, Any])
    spare_axes: Axes = ()
    foreign: bool = dc.field(default=False, compare=False)

    def __post_init__(self) -> None:
        if self.spare_axes:
            self._set_spare(self.spare_axes, self.entries)

    def __getstate__(self) -> dict[str, Any]:
        """Return the state for a pickle, without cached look-ups and without trust: it is valid only in the
        process in which it was given.
        """
        return _stated(self) | {"foreign": True}

    def _set_spare(self, axes: Axes, entries: Iterable[Entry]) -> None:
        """Set the spare axes to those that none of some entries has."""
        spare = dict.fromkeys(axes)
        for e in entries if spare else ():
            for axis in e.axes:
                spare.pop(axis, None)
        object.__setattr__(self, "spare_axes", tuple(spare))

    def forget(self) -> None:
        """Drop the graph, the largest of the cached look-ups, with about 1.5 KiB for each element."""
        self.__dict__.pop("_graph", None)

    def asks(self) -> bool:
        """Return whether the document names functions that the user has not allowed to be run."""
        return self.foreign and any(e.element.external_code() for e in self.entries)

    def by_id(self) -> Mapping[str, Entry]:
        """Return the entries by id."""
        return self._by_id

    def by_names(self) -> Mapping[PathNames, Entry]:
        """Return the entries by path."""
        return self._by_names

    def ends(self) -> Collection[tuple[str, str, str, str]]:
        """Return the ends of all connections."""
        return self._ends

    def connected(self, new: Connection) -> Document:
        """Return this document with one more connection.

        The new document shares the mappings of the entries and takes over the set of ends, so that n
        connections take O(n) time, not O(n^2).
        """
        ends = self.__dict__.pop("_ends", None)
        out = dc.replace(self, connections=(*self.connections, new), spare_axes=())
        out._set_spare(self.spare_axes, ())
        out.__dict__.update(
            {key: self.__dict__[key] for key in ("_by_id", "_by_names", "_index") if key in self.__dict__}
        )
        if ends is not None:  # this document computes the set again if it is needed
            ends.add(new.ends)
            out.__dict__["_ends"] = ends
        return out

    def extended(self, new: Sequence[Entry], groups: tuple[PathNames, ...]) -> Document:
        """Return this document with more entries and these groups.

        The mappings of the entries are copied and extended, which is much faster than to build them again;
        the new document takes over the set of ends.
        """
        ends = self.__dict__.pop("_ends", None)
        out = dc.replace(self, entries=(*self.entries, *new), groups=groups, spare_axes=())
        out._set_spare(self.spare_axes, new)
        out.__dict__["_by_id"] = self._by_id | {e.id: e for e in new}
        out.__dict__["_by_names"] = self._by_names | {e.names: e for e in new}
        if ends is not None:
            out.__dict__["_ends"] = ends
        return out

    def index(self) -> Index:
        """Return the names of the entries as an index for look-ups by path."""
        return self._index

    @functools.cached_property
    def _ends(self) -> set[tuple[str, str, str, str]]:
        return {c.ends for c in self.connections}

    @functools.cached_property
    def _index(self) -> Index:
        return Index.of(self.by_names())

    @functools.cached_property
    def _by_id(self) -> dict[str, Entry]:
        return {e.id: e for e in self.entries}

    @functools.cached_property
    def _by_names(self) -> dict[PathNames, Entry]:
        return {e.names: e for e in self.entries}

    def links(self) -> dict[Leaf, str]:
        """Return the name of the document parameter that drives each linked parameter."""
        return {link: p.name for p in self.parameters for link in p.links}

    @property
    def step(self) -> float:
        """The Euler step of runs that state none: the document's own, else 1."""
        return 1.0 if self.dt is None else self.dt

    def _summary(self) -> Summary:
        elements = counted(len(self.entries), "element")
        return Summary(f"Document {self.name!r}: {elements}, {counted(len(self.connections), 'connection')}")


def _stated(node: Entry | Document) -> dict[str, Any]:
    return {f.name: getattr(node, f.name) for f in dc.fields(node)}
