"""`Model`, the builder that a script holds: it replaces its immutable document through `edit`."""

from __future__ import annotations

import copy
import dataclasses as dc
import sys
from collections.abc import Hashable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from deodar.element import Element
from deodar.errors import ModelError, ParameterError, Problem, UnknownName
from deodar.model import document_files, edit, find, proposed, uses
from deodar.model.check import check, problems
from deodar.model.document import Document, Entry
from deodar.model.handle import Handle as Handle
from deodar.model.paths import PathNames, display, quote, readings, split
from deodar.model.script import script
from deodar.numerics.axes import Axis
from deodar.parameters import show
from deodar.summary import Summarised, Summary, counted

LARGEST_PICTURE = 17_000
"""Most characters of the picture of a model in a notebook, which stores each of its outputs."""


class Model(Summarised):
    """An architecture under construction.

    Args:
        name: name of the document.
        time_unit: unit of all times: us, ms, s, min, abstract, or steps such as "1 = 64 ms".
        dt: Euler step of runs that state none.
        document: start from this document instead of an empty one.
        trusted: whether user functions that the document names may be imported and run. None: yes if this
            process made the document or read it with trust, no if it came from a file, a pickle or a message.
    """

    def __init__(
        self,
        name: str = "model",
        *,
        time_unit: str = "ms",
        dt: float | None = None,
        document: Document | None = None,
        trusted: bool | None = None,
    ) -> None:
        doc = (
            document
            if document is not None
            else edit.describe(Document(name), name=name, time_unit=time_unit, dt=dt)
        )
        self._trusted = not doc.foreign if trusted is None else trusted
        self.history = edit.UndoHistory(
            doc if doc.foreign != self._trusted else dc.replace(doc, foreign=not self._trusted)
        )
        self._doubted: int | None = None
        self.declared: dict[str, str] = {}
        self.programs: dict[Hashable, Any] = {}

    def __copy__(self) -> Model:
        """Return an independent model with the same document, history and trust, without compiled
        programs.
        """
        twin = object.__new__(type(self))
        twin.__dict__.update(
            self.__dict__, history=copy.copy(self.history), declared=dict(self.declared), programs={}
        )
        return twin

    def __deepcopy__(self, memo: dict[int, Any]) -> Model:
        """Return the same as `copy.copy`: documents are immutable, so copies share them."""
        memo[id(self)] = twin = copy.copy(self)
        return twin

    def __getstate__(self) -> dict[str, Any]:
        """Return the state for a pickle: no compiled programs, and no trust in functions that a document
        names.

        The code that reads the pickle decides whether to trust them: `Model(document=model.document,
        trusted=True)`.
        """
        plain = not any(e.element.external_code() for d in self.history.documents for e in d.entries)
        return {**self.__dict__, "programs": {}, "_trusted": self._trusted and plain}

    # ----------------------------------------------------------------------------------------------- building

    def add(
        self, element: Element, group: str = "", ticks: int = 1, after: Handle | None = None, id: str = ""
    ) -> Handle:
        """Add an element and return its handle.

        `ticks` is the length of the element's step: with `ticks=10` it takes a step of 10 dt at every tenth
        tick. Elements without a state (couplings, stimuli) have no step: they follow their inputs at every
        tick; noise draws new values every `ticks` ticks.

        `id` is the stored identity of the element, eight hexadecimal digits, which key its noise. Without it
        the id follows from the path; scripts state the id of an element that was renamed or moved.
        """
        predecessor = self.entry(after.id) if after is not None else None
        doc, entry = edit.add(self.document, element, split(group) if group else (), ticks, predecessor, id)
        self.commit(doc)
        self.declared[entry.id] = _caller()
        return Handle(self, entry.id)

    def follow(self, source: Handle, element: Element) -> Handle:
        """Add an element that reads `source`, as one change, like `source >> element`."""
        entry = self.entry(source.id)
        doc, new = edit.add(self.document, element, after=entry)
        self.commit(edit.connect(doc, entry, source.port, new, ""))
        self.declared[new.id] = _caller()
        return Handle(self, new.id)

    def connect(self, source: Handle | str, target: Handle | str, reads: str = "") -> None:
        """Connect an output port to an input port; `reads` is previous (the default), current or delayed."""
        a, b = self._end(source, "output"), self._end(target, "")
        self.commit(edit.connect(self.document, *a, *b, reads))

    def disconnect(self, source: Handle | str, target: Handle | str) -> None:
        """Remove a connection."""
        (a, a_port), (b, b_port) = self._end(source, "output"), self._end(target, "")
        a_port, b_port = a_port or find.outputs(a)[0], b_port or b.element.ports()[0]
        self.commit(edit.disconnect(self.document, a.id, a_port, b.id, b_port))

    def remove(self, what: Handle | str) -> None:
        """Remove an element, or a group with its content."""
        if isinstance(what, str) and split(what) in self.document.groups:
            self.commit(edit.remove_group(self.document, split(what)))
        else:
            self.commit(edit.remove(self.document, [self._entry(what).id]))

    def rename(self, what: Handle | str, name: str) -> None:
        """Rename an element or a group; its group does not change."""
        if isinstance(what, str) and split(what) in self.document.groups:
            names = split(what)
            self.commit(edit.move_group(self.document, names, (*names[:-1], name)))
        else:
            entry = self._entry(what)
            self.commit(edit.move(self.document, entry.id, (*entry.group, name)))

    def move(self, what: Handle | str, group: str) -> None:
        """Move an element or a group into another group; "" is the top level."""
        to = split(group) if group else ()
        if isinstance(what, str) and split(what) in self.document.groups:
            names = split(what)
            self.commit(edit.move_group(self.document, names, (*to, names[-1])))
        else:
            entry = self._entry(what)
            self.commit(edit.move(self.document, entry.id, (*to, entry.names[-1])))

    def group(self, path: str) -> None:
        """Add a group."""
        self.commit(edit.group(self.document, split(path)))

    def ungroup(self, path: str) -> None:
        """Move the content of a group to the parent of the group."""
        self._group(path)
        self.commit(edit.ungroup(self.document, split(path)))

    def copy(self, group: str, to: str) -> None:
        """Copy a group, with the connections and links inside it, to another path.

        To copy one element: `model.add(model["u"].element, group="other")`.
        """
        names, target = self._group(group), split(to)
        inside = [e.id for e in self.document.entries if e.names[: len(names)] == names]
        self.commit(edit.copy(self.document, inside, lambda n: target + n[len(names) :]))

    def insert(self, template: Model, group: str, link: bool = False) -> None:
        """Copy another model into this one as a group.

        With `link` the group stays linked to the template, and `refresh` updates it.

        Document parameters of the template are copied; where this model has one of the same name, both share
        it at the value of this model. Functions of a model that is not trusted are not trusted here either.
        """
        target = split(group)
        self.commit(edit.insert(self.document, template.document, lambda n: target + n, linked=link))
        self._doubt(template)

    def link_group(self, group: str, template: str, elements: Mapping[str, str]) -> None:
        """Link an existing group to a template, as `insert` with `link` does.

        `elements` are the paths of its elements, by the ids of the template's elements that they copy.
        """
        self.commit(edit.link_group(self.document, split(group), template, elements))

    def refresh(self, template: Model) -> None:
        """Update all groups that are linked to a template of this name to its present content.

        Elements keep their ids, and so their states and noise; connections across the border of a group stay.
        Changes inside a group are overwritten by the template, except parameters that document parameters
        drive: these keep their values, and new document parameters are added.
        """
        self.commit(uses.refresh(self.document, template.document))
        self._doubt(template)

    def set(self, path: str | Mapping[str, Any], value: Any = ...) -> None:
        """Set a parameter (`u.tau`, `u.kernel.0.sigma`), a document parameter (`gain`), or several at once.

        After an error no value is changed.

        For example `model.set("u.tau", 30)` or `model.set({"u.tau": 30, "v.tau": 10})`, which is one step of
        the history.
        """
        self.commit(edit.change_all(self.document, edit.assignments(path, value)))

    def get(self, path: str) -> Any:
        """Return the value of a parameter."""
        return find.value(self.document, path)

    def add_axis(self, axis: Axis) -> None:
        """Add an axis that no element has yet, so that the studio offers it and the file contains it.

        Raises:
            ModelError: the document has the axis already.
            ParameterError: it is another object, such as a name.
        """
        self.commit(edit.add_axis(self.document, axis))

    def remove_axis(self, axis: Axis | str) -> None:
        """Remove an axis: elements over several axes lose this one, with what they state for it alone.

        Args:
            axis: the axis, or its key in the document, which is its name unless several axes have this name.

        Raises:
            UnknownName: the document has no such axis.
            ParameterError: an element needs the axis, such as one whose array has a dimension for it.
        """
        self.commit(proposed.remove_axis(self.document, axis))

    def set_axis(self, axis: str, **values: Any) -> None:
        """Change an axis in every element that has it: `model.set_axis("x", samples=201, periodic=True)`.

        Args:
            axis: its key in the document, which is its name unless several axes have this name.
            values: arguments of `Axis` with their new values.

        Raises:
            UnknownName: no element has the axis.
            ParameterError: an element cannot have the new axis, such as one with an array of the old length.
        """
        self.commit(proposed.change_axis(self.document, axis, values))

    def apply_fix(self, problem: Problem) -> None:
        """Make the edits that the fix of a problem proposes (`problem.edits`), as one step of the history.

        Raises:
            ModelError: the fix is not an edit: it needs a decision, which its text states.
        """
        if not problem.edits:
            raise ModelError("its fix needs a decision", where=problem.where, fix=problem.fix)
        self.commit(proposed.apply(self.document, problem.edits))

    def set_ticks(self, what: Handle | str, ticks: int) -> None:
        """Set the step of an element, in ticks of the model."""
        self.commit(edit.every(self.document, self._entry(what).id, ticks))

    def parameter(self, name: str, value: float) -> None:
        """Add or set a document parameter: one value that drives all parameters linked to it."""
        self.commit(edit.document_parameter(self.document, name, value))

    def link(self, path: str, name: str) -> None:
        """Let a document parameter drive a parameter of an element: `model.link("u.tau", "gain")`."""
        target = find.target(self.document, path)
        if target.entry is None:
            raise UnknownName(f"{path!r} is itself a document parameter")
        self.commit(edit.link(self.document, target.entry.id, target.parameter, name))

    def unlink(self, path: str) -> None:
        """Remove the link of a parameter to a document parameter; it keeps its value."""
        target = find.target(self.document, path)
        if target.entry is not None:
            self.commit(edit.unlink(self.document, target.entry.id, target.parameter))

    def describe(self, **values: Any) -> None:
        """Set general properties: name, time_unit, dt, t0, notes, layout."""
        self.commit(edit.describe(self.document, **values))

    def commit(self, document: Document) -> None:
        """Replace the document by one that `deodar.model.edit` made from it: one step of the history."""
        if self._doubted is not None and self.history.depth < self._doubted:
            self._doubted = None  # the change that brought it was undone, and can no longer be redone
        self.history.commit(document)

    def undo(self) -> bool:
        """Undo the last change; False if no change can be undone."""
        return self.history.undo()

    def redo(self) -> bool:
        """Redo the last change that was undone; False if no change was undone."""
        return self.history.redo()

    # ------------------------------------------------------------------------------------------------ looking

    @property
    def document(self) -> Document:
        """The present immutable document."""
        return self.history.document

    @property
    def trusted(self) -> bool:
        """Whether functions that the document names may be imported and run."""
        return self._trusted and (self._doubted is None or self.history.depth < self._doubted)

    @property
    def name(self) -> str:
        """Name of the document."""
        return self.document.name

    def entry(self, ident: str) -> Entry:
        """Return the entry of an id."""
        entry = self.document.by_id().get(ident)
        if entry is None:
            raise UnknownName(f"the element with the id {ident} was removed from the model")
        return entry

    def __getitem__(self, path: str) -> Handle:
        by = self.document.by_names()
        for names, rest in readings(path, self.document.index()):
            if not rest:
                return Handle(self, by[names].id)
        entry, port = find.port(self.document, path)
        return Handle(self, entry.id, port)

    def __contains__(self, path: str) -> bool:
        return any(not rest for _, rest in readings(path, self.document.index()))

    def __iter__(self) -> Iterator[Handle]:
        return iter([Handle(self, e.id) for e in self.document.entries])

    def check(self) -> list[Problem]:
        """Return problems and warnings, each with its path and the line that declared it.

        A model without problems runs.
        """
        return self._placed(check(self.document))

    def require(self) -> None:
        """Raise a `ModelError` with every problem that prevents a run; warnings do not raise."""
        placed = self._placed(problems(self.document))
        if placed:
            raise ModelError(placed)

    def to_json(self) -> str:
        """Return the document as JSON text (arrays by name only; `save` writes them to a file)."""
        return document_files.dumps(self.document)[0]

    def to_script(self, path: str = "") -> str:
        """Return a Python script that makes the same document.

        The script declares a function `make` that returns the model. Run as a program it writes the document
        to the file `path`; by default this is the name of the model.
        """
        return script(self.document, path)

    def __repr__(self) -> str:
        return f"<{self._summary().title}>"

    def _repr_html_(self) -> str:
        # start-up time: these bring matplotlib
        from deodar.model.diagram import Diagram

        summary = self._summary()
        inside = Diagram(self.document, legend=False).inside(LARGEST_PICTURE)
        return summary.html(inside or "<div>Too large for a picture here: dd.draw(model)</div>")

    def _summary(self) -> Summary:
        doc = self.document
        by, sources = doc.by_id(), dict[str, list[str]]()
        for connection in doc.connections:
            sources.setdefault(connection.target, []).append(by[connection.source].path)
        rows = [(e.path, type(e.element).__name__, ", ".join(sources.get(e.id, ()))) for e in doc.entries]
        elements = counted(len(doc.entries), "element")
        title = f"Model {doc.name!r}: {elements}, {counted(len(doc.connections), 'connection')}"
        return Summary(title, rows, ("element", "kind", "reads from"), elements)

    # ------------------------------------------------------------------------------------------------- inside

    def _placed(self, unplaced: Sequence[Problem]) -> list[Problem]:
        where = {e.path: self.declared.get(e.id, "") for e in self.document.entries}
        return [
            dc.replace(p, where=f"{p.where} ({where[p.where]})") if where.get(p.where) else p
            for p in unplaced
        ]

    def _doubt(self, template: Model) -> None:
        if not template.trusted and any(e.element.external_code() for e in template.document.entries):
            self._doubted = self.history.depth  # if the change is undone, the doubt ends with it

    def _entry(self, part: Handle | str) -> Entry:
        if isinstance(part, str):
            return find.element(self.document, part)
        return self._end(part, "")[0]

    def _end(self, end: Handle | str, default: str) -> tuple[Entry, str]:
        if isinstance(end, str):
            return find.port(self.document, end, default)
        if not isinstance(end, Handle):
            raise ModelError(
                f"{show(end)} cannot be connected", fix="Give a path, or what model.add returned"
            )
        if end.model is not self:
            raise ModelError(
                f"{end.path!r} belongs to another model",
                fix="Add it to this one, or insert the other model as a group",
            )
        return self.entry(end.id), end.port

    def _group(self, path: str) -> PathNames:
        names = split(path)
        if names not in self.document.groups:
            raise UnknownName(
                f"there is no group {path!r}",
                fix=edit.did_you_mean(path, [display(g) for g in self.document.groups]),
            )
        return names


def path_of(end: Any) -> str:
    """Return a path as text, from text or from a handle of an element or port."""
    if isinstance(end, Handle):
        return f"{end.path}.{quote(end.port)}" if end.port else end.path
    if not isinstance(end, str):
        raise ParameterError(
            f"{show(end)} is not a path",
            fix="Write it as text: 'u.activation'; or take a handle: u['activation']",
        )
    return end


def save(model: Model, path: str | Path, force: bool = False) -> None:
    """Write a model as a document, its arrays first; an existing file is replaced only with `force`."""
    document_files.save(model.document, path, force)


def load(path: str | Path, trust: bool = False) -> Model:
    """Read a document. With `trust=True` it may import and run the functions it names.

    Raises:
        DocumentError: the document has problems; the error lists all, each with its path.
    """
    return Model(document=document_files.load(path), trusted=trust)


def _caller() -> str:
    """Return the file and line of the first caller outside this package."""
    frame = sys._getframe(1)  # pyright: ignore[reportPrivateUsage]
    package = str(Path(__file__).parent.parent)
    while frame.f_back is not None and frame.f_code.co_filename.startswith(package):
        frame = frame.f_back
    return f"{Path(frame.f_code.co_filename).name}:{frame.f_lineno}"
