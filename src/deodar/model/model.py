"""`Model`, the builder that a script holds: it replaces its immutable document through `edit`."""

from __future__ import annotations

import copy
import dataclasses as dc
import html
import sys
from collections.abc import Hashable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from deodar import renamed
from deodar.element import Element
from deodar.errors import ModelError, ParameterError, Problem, UnknownName
from deodar.leaves import get
from deodar.model import edit, files, find, uses
from deodar.model.check import check, problems
from deodar.model.document import Document, Entry
from deodar.model.handle import Handle as Handle
from deodar.model.paths import PathNames, display, quote, readings, split
from deodar.parameters import show


class Model:
    """An architecture being built.

    Args:
        name: name of the document.
        time_unit: unit of all times: us, ms, s, min, abstract, or steps such as "1 = 64 ms".
        dt: Euler step where a run states none.
        document: start from this document instead of an empty one.
        trusted: whether user functions named in the document may be imported and run. None: if this process
            made the document, or read it with trust; not if it came from a file, a pickle or a message.
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

    if not TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any:
            raise renamed.no_member(self, name)

    def __copy__(self) -> Model:
        """An independent model with the same document, history and trust, without compiled programs."""
        other = object.__new__(type(self))
        other.__dict__.update(
            self.__dict__, history=copy.copy(self.history), declared=dict(self.declared), programs={}
        )
        return other

    def __deepcopy__(self, memo: dict[int, Any]) -> Model:
        """The same as `copy.copy`: documents never change, so that copies share them."""
        memo[id(self)] = other = copy.copy(self)
        return other

    def __getstate__(self) -> dict[str, Any]:
        """What a pickle holds: no compiled programs, and no trust in functions that a document names.

        Whoever reads the pickle decides whether to trust them: `Model(document=model.document,
        trusted=True)`.
        """
        plain = not any(e.element.external_code() for d in self.history.documents for e in d.entries)
        return {**self.__dict__, "programs": {}, "_trusted": self._trusted and plain}

    # ----------------------------------------------------------------------------------------------- building

    @renamed.arguments("dd.Model.add")
    def add(self, element: Element, group: str = "", ticks: int = 1, after: Handle | None = None) -> Handle:
        """Add an element and return its handle.

        `ticks` is the length of its own step: with `ticks=10` it takes a step of 10 dt at every tenth tick.
        Elements without a state (couplings, stimuli) have no step: they follow their inputs at every tick;
        noise is drawn anew once in this number of ticks.
        """
        near = self.entry(after.id) if after is not None else None
        doc, entry = edit.add(self.document, element, split(group) if group else (), ticks, near)
        self.commit(doc)
        self.declared[entry.id] = _caller()
        return Handle(self, entry.id)

    def follow(self, source: Handle, element: Element) -> Handle:
        """Add an element that reads `source`, in one change: what `source >> element` does."""
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
        """Take a connection away."""
        (a, a_port), (b, b_port) = self._end(source, "output"), self._end(target, "")
        a_port, b_port = a_port or find.outputs(a)[0], b_port or b.element.ports()[0]
        self.commit(edit.disconnect(self.document, a.id, a_port, b.id, b_port))

    def remove(self, what: Handle | str) -> None:
        """Take an element, or a group with everything in it, away."""
        if isinstance(what, str) and split(what) in self.document.groups:
            self.commit(edit.remove_group(self.document, split(what)))
        else:
            self.commit(edit.remove(self.document, [self._entry(what).id]))

    def rename(self, what: Handle | str, name: str) -> None:
        """Give an element, or a group, another name; its place stays."""
        if isinstance(what, str) and split(what) in self.document.groups:
            names = split(what)
            self.commit(edit.move_group(self.document, names, (*names[:-1], name)))
        else:
            entry = self._entry(what)
            self.commit(edit.move(self.document, entry.id, (*entry.group, name)))

    def move(self, what: Handle | str, group: str) -> None:
        """Put an element, or a group, into another group; "" is the top."""
        to = split(group) if group else ()
        if isinstance(what, str) and split(what) in self.document.groups:
            names = split(what)
            self.commit(edit.move_group(self.document, names, (*to, names[-1])))
        else:
            entry = self._entry(what)
            self.commit(edit.move(self.document, entry.id, (*to, entry.names[-1])))

    def group(self, path: str) -> None:
        """Make a group."""
        self.commit(edit.group(self.document, split(path)))

    def ungroup(self, path: str) -> None:
        """Put a group's contents where the group stands."""
        self._group(path)
        self.commit(edit.ungroup(self.document, split(path)))

    def copy(self, group: str, to: str) -> None:
        """Copy a group, with the connections and links inside it, under another path.

        One element is copied by `model.add(model["u"].element, group="other")`.
        """
        names, target = self._group(group), split(to)
        inside = [e.id for e in self.document.entries if e.names[: len(names)] == names]
        self.commit(edit.copy(self.document, inside, lambda n: target + n[len(names) :]))

    def insert(self, template: Model, group: str, link: bool = False) -> None:
        """Copy another model into this one, as a group; with `link` it stays one of the template's uses, for
        `refresh`.

        Document parameters come along; one whose name this model has already is shared, at the value it has
        here. Functions of a model that nobody trusts are not trusted here either.
        """
        target = split(group)
        self.commit(edit.insert(self.document, template.document, lambda n: target + n, linked=link))
        self._doubt(template)

    def refresh(self, template: Model) -> None:
        """Make all groups that are linked to a template of this name as the template now is.

        Elements keep their ids, and so their states and noise; connections across the border of a group stay.
        What was changed inside is made again as the template has it, except what document parameters drive.
        Those keep their values here; new ones come along.
        """
        self.commit(uses.refresh(self.document, template.document))
        self._doubt(template)

    def set(self, path: str | Mapping[str, Any], value: Any = ...) -> None:
        """Change a parameter (`u.tau`, `u.kernel.0.sigma`) or a document parameter (`gain`), or several at
        once: all or, after an error, none.

        For example `model.set("u.tau", 30)` or `model.set({"u.tau": 30, "v.tau": 10})`, which is one step of
        the history.
        """
        self.commit(edit.change_all(self.document, edit.assignments(path, value)))

    def get(self, path: str) -> Any:
        """The value of a parameter."""
        found = find.target(self.document, path)
        if found.entry is None:
            return next(k.value for k in self.document.knobs if k.name == found.knob)
        return get(found.entry.element, found.parameter)

    def set_ticks(self, what: Handle | str, ticks: int) -> None:
        """Set the length of an element's own step, in ticks of the model."""
        self.commit(edit.every(self.document, self._entry(what).id, ticks))

    def parameter(self, name: str, value: float) -> None:
        """A named parameter of the document: one knob for everything linked to it."""
        self.commit(edit.knob(self.document, name, value))

    def link(self, path: str, name: str) -> None:
        """Let a document parameter drive a parameter of an element: `model.link("u.tau", "gain")`."""
        found = find.target(self.document, path)
        if found.entry is None:
            raise UnknownName(f"{path!r} is itself a document parameter")
        self.commit(edit.link(self.document, found.entry.id, found.parameter, name))

    def unlink(self, path: str) -> None:
        """Let a parameter stand for itself again."""
        found = find.target(self.document, path)
        if found.entry is not None:
            self.commit(edit.unlink(self.document, found.entry.id, found.parameter))

    def describe(self, **values: Any) -> None:
        """Change general properties: name, time_unit, dt, t0, notes."""
        self.commit(edit.describe(self.document, **values))

    def commit(self, document: Document) -> None:
        """Take a document that `deodar.model.edit` made from the present one: one step of the history."""
        if self._doubted is not None and self.history.depth < self._doubted:
            self._doubted = None  # the change that brought it was taken back, and is now forgotten
        self.history.commit(document)

    def undo(self) -> bool:
        """Take the last change back; False where there is none."""
        return self.history.undo()

    def redo(self) -> bool:
        """Make the change again that was taken back; False where there is none."""
        return self.history.redo()

    # ------------------------------------------------------------------------------------------------ looking

    @property
    def document(self) -> Document:
        """The immutable document as it now is."""
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
        """The entry of an id."""
        found = self.document.by_id().get(ident)
        if found is None:
            raise UnknownName(f"the element with the id {ident} was removed from the model")
        return found

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
        """Problems and warnings, each with its path and the line that declared it; without a problem it
        runs.
        """
        return self._placed(check(self.document))

    def require(self) -> None:
        """Raise a `ModelError` with every problem that stops a run, if there is any; warnings do not
        count.
        """
        found = self._placed(problems(self.document))
        if found:
            raise ModelError(found)

    def to_json(self) -> str:
        """The document as JSON text (arrays by name only; `save` writes them beside it)."""
        return files.dumps(self.document)[0]

    def __repr__(self) -> str:
        d = self.document
        return f"<Model {d.name!r}: {len(d.entries)} elements, {len(d.connections)} connections>"

    def _repr_html_(self) -> str:
        # start-up time: these bring JAX
        from deodar.model.diagram import Diagram

        by = self.document.by_id()
        rows = "".join(
            f"<tr><td>{html.escape(e.path)}</td><td>{type(e.element).__name__}</td><td>"
            + html.escape(", ".join(by[c.source].path for c in self.document.connections if c.target == e.id))
            + "</td></tr>"
            for e in self.document.entries
        )
        head = "<tr><th>element</th><th>kind</th><th>reads from</th></tr>"
        table = (
            f"<details><summary>{len(self.document.entries)}"
            f" elements</summary><table>{head}{rows}</table></details>"
        )
        return (
            f"<b>{html.escape(self.name)}</b><div"
            f' style="overflow-x:auto">{Diagram(self.document).svg}</div>{table}'
        )

    # ------------------------------------------------------------------------------------------------- inside

    def _placed(self, found: Sequence[Problem]) -> list[Problem]:
        where = {e.path: self.declared.get(e.id, "") for e in self.document.entries}
        return [
            dc.replace(p, where=f"{p.where} ({where[p.where]})") if where.get(p.where) else p for p in found
        ]

    def _doubt(self, template: Model) -> None:
        if not template.trusted and any(e.element.external_code() for e in template.document.entries):
            self._doubted = self.history.depth  # taken back, the change takes the doubt with it

    def _entry(self, what: Handle | str) -> Entry:
        if isinstance(what, str):
            return find.element(self.document, what)
        return self._end(what, "")[0]

    def _end(self, what: Handle | str, default: str) -> tuple[Entry, str]:
        if isinstance(what, str):
            return find.port(self.document, what, default)
        if not isinstance(what, Handle):
            raise ModelError(
                f"{show(what)} cannot be connected", fix="Give a path, or what model.add returned"
            )
        if what.model is not self:
            raise ModelError(
                f"{what.path!r} belongs to another model",
                fix="Add it to this one, or insert the other model as a group",
            )
        return self.entry(what.id), what.port

    def _group(self, path: str) -> PathNames:
        names = split(path)
        if names not in self.document.groups:
            raise UnknownName(
                f"there is no group {path!r}",
                fix=edit.did_you_mean(path, [display(g) for g in self.document.groups]),
            )
        return names


def path_of(what: Any) -> str:
    """A path as text: given as such, or by a handle of an element or port."""
    if isinstance(what, Handle):
        return f"{what.path}.{quote(what.port)}" if what.port else what.path
    if not isinstance(what, str):
        raise ParameterError(
            f"{show(what)} is no path",
            fix="Write it as text: 'u.activation'; or take a handle: u['activation']",
        )
    return what


def save(model: Model, path: str | Path, force: bool = False) -> None:
    """Write a model as a document, its arrays first; refuses to replace a file unless `force`."""
    files.save(model.document, path, force)


def load(path: str | Path, trust: bool = False) -> Model:
    """Read a document. `trust=True` allows it to import and run the functions it names.

    Raises:
        DocumentError: with every problem found, each with its path.
    """
    return Model(document=files.load(path), trusted=trust)


def _caller() -> str:
    """File and line outside this package that called."""
    frame = sys._getframe(1)  # pyright: ignore[reportPrivateUsage]
    own = str(Path(__file__).parent.parent)
    while frame.f_back is not None and frame.f_code.co_filename.startswith(own):
        frame = frame.f_back
    return f"{Path(frame.f_code.co_filename).name}:{frame.f_lineno}"
