"""The open document with the history of its edits, and the changes that pages receive."""

from __future__ import annotations

import asyncio
import dataclasses as dc
from collections.abc import Awaitable, Callable
from typing import Any

import msgspec

from deodar.declarations import Cost
from deodar.errors import DocumentError, ModelError
from deodar.importers import stored_report
from deodar.model import edit, plain_values
from deodar.model.document import Document
from deodar.model.model import Model
from deodar.model.sketch import effect
from deodar.numerics.signs import Sign
from deodar_studio.messages.to_page import Edited, ImportReportView, KeyedDifference
from deodar_studio.project.change_queue import ChangeQueue
from deodar_studio.project.checker import Checker
from deodar_studio.project.conversions import Conversions
from deodar_studio.project.recent_changes import RecentChanges
from deodar_studio.views import converted, layouts, repairs, view


class DocumentHistory:
    """The open document, its edits, and the version that pages compare with their own.

    An edit is added after the run has accepted its document. Methods that change the document must be called
    through the queue of the project.

    Args:
        queue: keeps the task that checks the document.
        conversions: converts documents to parts of messages.
        adopt: makes the run continue with a document, and returns the cost; it raises what refuses it.
        differs: returns whether a document has edits that are not saved to its file.
        changed: called when pages may have something new to show.

    Attributes:
        model: the document with its history; None: no document is open.
        version: number of changes that pages must receive.
        checker: finds the warnings after changes of single parameters.
        record: the path of the record that the document belongs to, as the page names it; None: it is
            edited.
    """

    def __init__(
        self,
        queue: ChangeQueue,
        conversions: Conversions,
        adopt: Callable[[Document], Awaitable[Cost]],
        differs: Callable[[Document], bool],
        changed: Callable[[], None],
    ) -> None:
        self._conversions, self._adopt, self._differs, self._changed = conversions, adopt, differs, changed
        self.model: Model | None = None
        self.version = 0
        self.record: str | None = None
        self.checker = Checker(
            lambda: (self.version, None if self.model is None else self.model.document),
            conversions.check,
            queue,
            changed,
        )
        self._gesture: object = None
        self._recent = RecentChanges()
        self._report: tuple[Any, ImportReportView] = (None, view.NO_REPORT)  # as the layout has it, converted

    # ------------------------------------------------------------------------------------ opening and closing

    def open(self, model: Model, record: str | None = None) -> None:
        """Continue with another document, which is edited, or belongs to a record and is not."""
        self.model, self.record, self._gesture = model, record, None

    def close(self) -> None:
        """Continue without a document."""
        self.model, self.record, self._gesture = None, None, None

    # ------------------------------------------------------------------------------------------------ looking

    @property
    def unsaved(self) -> bool:
        """Whether the document has edits that are not saved to a file."""
        return self.model is not None and self.record is None and self._differs(self.model.document)

    def document(self) -> Document:
        """Return the open document, also that of a record; raise DocumentError if none is open."""
        return self._require().document

    def require_edited(self) -> Model:
        """Return the document that runs; raise DocumentError for that of a record."""
        if self.record is not None:
            raise DocumentError(
                "is a record, which neither runs nor changes",
                where=self.record,
                fix="Run its model: the button Run its model opens a copy of the document",
            )
        return self._require()

    def _require(self) -> Model:
        if self.model is None:
            raise DocumentError("no document is open")
        return self.model

    def changes_since(self, version: int) -> list[Edited] | None:
        """Return the changes from a version to the present one; None if a page needs the whole document."""
        return self._recent.between(version, self.version)

    def report(self) -> ImportReportView:
        """Return the import report of the document; it is converted once."""
        doc = None if self.model is None else self.model.document
        kept = None if doc is None else doc.layout.get(stored_report.KEY)
        if doc is None or kept is None:
            return view.NO_REPORT
        if self._report[0] is not kept:
            self._report = (kept, view.import_report(doc))
        return self._report[1]

    # ------------------------------------------------------------------------------------------------ editing

    async def set(self, element: str, parameter: str, value: Any, gesture: object) -> Cost:
        """Change a parameter of an element, or, with an empty element, a document parameter."""
        model = self.require_edited()
        doc = model.document
        if not element:
            if parameter not in [k.name for k in doc.parameters]:
                raise DocumentError("there is no such document parameter", where=parameter)
            new = edit.document_parameter(doc, parameter, value)
            return await self._commit(new, gesture)
        new = plain_values.put(doc, [element], parameter, value)
        return await self._commit(new, gesture, (element, parameter))

    async def change(self, how: Callable[[Document], Document], gesture: object = None) -> Cost:
        """Apply a function to the document, as one step of undo.

        Changes in sequence with the same `gesture` (not None) are one step together.
        """
        return await self._commit(how(self.require_edited().document), gesture)

    async def repair(self, where: str, what: str) -> Cost:
        """Make the edit that a button of a problem stands for, as one step of undo.

        Raises:
            ModelError: the document has no such problem, or it is not one of the document.
        """
        doc = self.require_edited().document
        problems = await asyncio.to_thread(self._conversions.check, doc)
        problem = next((p for p in problems if (p.where, p.what) == (where, what)), None)
        if problem is None:
            raise ModelError("this problem has no repair any more; the document has changed", where=where)
        repair = repairs.repair_of(doc, problem)
        if repair is None:
            raise ModelError("no edit solves this problem", where=where, fix=problem.fix_at("page"))
        return await self.change(repair[1])

    async def describe(self, values: dict[str, Any]) -> None:
        """Change general properties of the document."""
        await self.change(lambda doc: edit.describe(doc, **values))

    async def rename(self, name: str) -> None:
        """Change the name in all documents of the history, without a step of undo; redo remains.

        The next version is left to the caller.
        """
        history = self.require_edited().history
        edit.rename_everywhere(history, name)
        await self._adopt(history.document)

    async def arrange(self, layout: dict[str, Any], undoable: bool) -> None:
        """Change parts of the layout; without `undoable`, in all documents of the history."""
        model = self._require()
        before = model.document
        layout = layouts.changed(before.layout, layout)
        if undoable:
            merged = {k: v for k, v in {**before.layout, **layout}.items() if v is not None}
            model.history.commit(edit.arrange(before, merged))
            self._gesture = None
        else:  # a drag of a slider continues, and redo remains
            edit.arrange_everywhere(model.history, layout)
        self._edited(before, "live")

    async def lay_out(self, how: Callable[[Document], Document]) -> None:
        """Apply a function that changes only the layout, as one step of undo; records have a layout too."""
        model = self._require()
        before = model.document
        new = how(before)
        if new is not before:
            model.history.commit(new)
            self._gesture = None
            self._edited(before, "live")

    def follow(self, running: Document) -> None:
        """Take over elements, connections and parameters of the running document, as one step of undo.

        Notes, name and layout stay, and so do spare axes; one that an element of the present document has
        becomes spare again.
        """
        model = self.require_edited()
        now = model.document
        spare = (*now.spare_axes, *(a for a in running.spare_axes if edit.has_axis(now, a)))
        doc = dc.replace(running, name=now.name, notes=now.notes, layout=now.layout, spare_axes=spare)
        if doc != now:
            model.history.commit(doc)
            self._gesture = None
            self.touch()

    async def undo(self) -> None:
        """Undo the last change."""
        await self._travel(lambda h: h.undo(), lambda h: h.redo())

    async def redo(self) -> None:
        """Redo the change that was undone last."""
        await self._travel(lambda h: h.redo(), lambda h: h.undo())

    async def _travel(
        self,
        there: Callable[[edit.UndoHistory[Document]], bool],
        back: Callable[[edit.UndoHistory[Document]], bool],
    ) -> None:
        history = self.require_edited().history
        if not there(history):
            return
        doc = history.document
        back(history)  # the history moves only after the engine has accepted the document
        before = history.document
        cost = await self._adopt(doc)
        there(history)
        self._gesture = None
        self._edited(before, cost)

    async def _commit(self, doc: Document, gesture: object, leaf: tuple[str, str] | None = None) -> Cost:
        model = self.require_edited()
        before = model.document
        if doc is before or doc == before:
            return "live"
        cost = await self._adopt(doc)
        if gesture is not None and gesture == self._gesture:
            self._gesture = gesture if model.history.amend(doc) else None
        else:
            model.history.commit(doc)
            self._gesture = gesture
        if leaf is None or cost == "recompile" or _effect(before, leaf[0]) != _effect(doc, leaf[0]):
            self._edited(before, cost)
        else:
            self._add(view.one_parameter(doc, *leaf), {}, cost)
        return cost

    # ----------------------------------------------------------------------------------------------- versions

    def _edited(self, before: Document, cost: Cost) -> None:
        """Start a new version after an edit, of which pages receive the difference."""
        model = self._require()
        old, new = self._conversions.of(before), self._conversions.of(model.document)
        changes = converted.changes(old, new)
        if changes is None:
            self.touch()
        else:
            structural = bool(old.problems or new.problems)
            self._add(
                changes, {"problems": view.problems(new.problems, model.document)} if structural else {}, cost
            )

    def _add(self, changes: KeyedDifference, others: dict[str, Any], cost: Cost) -> None:
        """Start a new version, of which pages receive what changed and other fields of the document."""
        history = self._require().history
        status = {"unsaved": self.unsaved, "undo": history.depth, "redo": history.ahead}
        changes = msgspec.structs.replace(changes, changed=changes.changed | others | status)
        self.version += 1
        self._recent.add(Edited(version=self.version, difference=changes, cost=cost))
        self._changed()
        if self.record is None:
            self.checker.start()

    def touch(self) -> None:
        """Start a new version, for which every page needs the whole document."""
        self.version += 1
        self.checker.found = None
        self._recent.clear()
        self._changed()


def _effect(doc: Document, element: str) -> Sign:
    """Return the sign that an element gives to its connections, which the page draws."""
    return effect(doc.by_id()[element].element)
