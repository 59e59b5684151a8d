"""Random edits, undone and redone: a document has the bytes that it had, and patches give it to a page.

A walk makes edits on one history. The text of every document is stored when it is made; after each undo and
redo the document of that moment is written again, and compared. The kind that was undone and redone least is
drawn first, and walks follow one another until every kind was undone and redone as often as asked.
"""

from __future__ import annotations

import dataclasses as dc
import functools
import json
import random
from collections.abc import Callable
from typing import Any

import msgspec

import deodar as dd
from deodar.errors import DeodarError
from deodar.importers import presets
from deodar.model import building, clipboard, document_files, edit, script
from deodar.model.building import Around
from deodar.model.document import Document, Entry
from deodar_studio.catalogue import templates
from deodar_studio.views import converted, view
from tests.deodar_studio.page import applied

MOST_ELEMENTS = 12
"""Number of elements from which the walk adds no more."""

SCRIPTED = 20
"""Number of steps after which a document is also made again by its script."""

WALK = 150
"""Number of steps after which a walk begins again with an empty document."""

Draw = random.Random
X, Y = dd.Axis("x", 0, 10, samples=11), dd.Axis("y", 0, 1, samples=5)
TEMPLATE = "boost"


def _zeros() -> dict[str, int]:
    return dict.fromkeys(KINDS, 0)


@dc.dataclass
class Outcome:
    """Numbers of steps by outcome, and of edits that were made, undone and redone by kind."""

    made: dict[str, int] = dc.field(default_factory=_zeros)
    undone: dict[str, int] = dc.field(default_factory=_zeros)
    redone: dict[str, int] = dc.field(default_factory=_zeros)
    refused: int = 0
    steps: int = 0
    errors: list[str] = dc.field(default_factory=list[str])

    def least(self, kind: str) -> int:
        """How often a kind was both undone and redone."""
        return min(self.undone[kind], self.redone[kind])

    def fail(self, what: str) -> None:
        """Note an error at the present step."""
        self.errors.append(f"step {self.steps}: {what}")


def _entry(draw: Draw, doc: Document) -> Entry:
    if not doc.entries:
        raise dd.errors.ModelError("empty")
    return draw.choice(doc.entries)


def _wire(draw: Draw, doc: Document) -> tuple[str, str, str, str]:
    if not doc.connections:
        raise dd.errors.ModelError("no connections")
    return draw.choice(doc.connections).ends


def _group(draw: Draw, doc: Document) -> tuple[str, ...]:
    if not doc.groups:
        raise dd.errors.ModelError("no groups")
    return draw.choice(doc.groups)


def _some(draw: Draw, doc: Document) -> list[str]:
    return [e.id for e in draw.sample(doc.entries, min(len(doc.entries), draw.randint(1, 3)))]


def _added(draw: Draw, doc: Document, kind: str, **options: Any) -> Document:
    if len(doc.entries) >= MOST_ELEMENTS:
        raise dd.errors.ModelError("full")
    return building.add(doc, kind, {}, draw.choice(("", "u", "v")), at=(draw.randint(0, 99), 5.0), **options)[
        0
    ]


def _at_an_end(wire: tuple[str, str, str, str]) -> Around:
    return Around(source=wire[:2], replaces=wire)


EDITS: dict[str, Callable[[Draw, Document], Document]] = {
    "add a field": lambda r, d: _added(r, d, "Field"),
    "add a stimulus": lambda r, d: _added(r, d, "GaussianStimulus"),
    "add in a group": lambda r, d: _added(r, d, "Field", group=_group(r, d)),
    "add after": lambda r, d: _added(r, d, "Gain", around=Around(source=(_entry(r, d).id, ""))),
    "add before": lambda r, d: _added(r, d, "Noise", around=Around(target=(_entry(r, d).id, ""))),
    "add on a wire": lambda r, d: _added(r, d, "Sigmoid", around=Around(wire=_wire(r, d))),
    "add with an array": lambda r, d: _added(r, d, "Weights"),
    "add at an end": lambda r, d: _added(r, d, "Field", around=_at_an_end(_wire(r, d))),
    "insert": lambda r, d: building.insert_element(d, _entry(r, d).id, _wire(r, d)),
    "connect": lambda r, d: building.connect(d, (_entry(r, d).id, "", _entry(r, d).id, "")),
    "connect delayed": lambda r, d: building.connect(
        d, (_entry(r, d).id, "", _entry(r, d).id, ""), "delayed"
    ),
    "disconnect": lambda r, d: building.disconnect(d, [_wire(r, d)]),
    "reconnect": lambda r, d: building.reconnect(d, w := _wire(r, d), (*w[:2], _entry(r, d).id, "")),
    "remove": lambda r, d: building.remove(d, [_entry(r, d).id]),
    "remove several": lambda r, d: building.remove(d, _some(r, d)),
    "remove a group": lambda r, d: building.remove(d, [], [_group(r, d)]),
    "remove a wire": lambda r, d: building.remove(d, [], [], [_wire(r, d)]),
    "rename": lambda r, d: building.rename(d, _entry(r, d).id, f"n{r.randint(0, 99)}"),
    "rename a group": lambda r, d: building.rename_group(d, _group(r, d), f"g{r.randint(0, 99)}"),
    "group": lambda r, d: building.group(d, _some(r, d), [], at=(0.0, 0.0))[0],
    "ungroup": lambda r, d: building.ungroup(d, _group(r, d)),
    "move into": lambda r, d: building.move_into(d, _some(r, d), [], _group(r, d)),
    "move out": lambda r, d: building.move_into(d, _some(r, d), [], ()),
    "paste": lambda r, d: building.paste(d, _copied(r, d), at=(3.0, 4.0))[0],
    "paste in a group": lambda r, d: building.paste(d, _copied(r, d), ("pasted",))[0],
    "set": lambda r, d: edit.put(d, _named(r, d, "tau").id, "tau", r.uniform(5, 50)),
    "set axes": lambda r, d: edit.put(d, _named(r, d, "axes").id, "axes", [r.choice((X, Y))]),
    "change an axis": lambda r, d: edit.replace_axis(d, *r.sample((X, Y, dd.Axis("x", 0, 9, samples=10)), 2)),
    "step of an element": lambda r, d: edit.every(d, _entry(r, d).id, r.randint(1, 3)),
    "document parameter": lambda r, d: edit.document_parameter(d, r.choice("abc"), r.uniform(5, 50)),
    "link": lambda r, d: edit.link(d, _named(r, d, "tau").id, "tau", r.choice("abc")),
    "unlink": lambda r, d: edit.unlink(d, _named(r, d, "tau").id, "tau"),
    "remove a parameter": lambda r, d: edit.remove_document_parameter(d, r.choice("abc")),
    "describe": lambda r, d: edit.describe(d, notes=str(r.random()), dt=r.choice((None, 0.5, 1.0))),
    "place": lambda r, d: building.placed(d, {i: (r.random(), 1.0) for i in _some(r, d)}),
    "comment": lambda r, d: building.comment(d, "", {"text": str(r.random()), "x": 1, "y": 2})[0],
    "move a comment": lambda r, d: building.comment(d, _comment(r, d), {"x": r.random(), "y": 3})[0],
    "remove a comment": lambda r, d: building.comment(d, _comment(r, d), None)[0],
    "set several": lambda r, d: edit.change_all(d, {f"{e.path}.tau": r.uniform(5, 50) for e in _with_tau(d)}),
    "add a template": lambda r, d: _inserted(r, d),
    "apply a preset": lambda r, d: presets.applied(d, _preset(r, d))[0],
    "add a kernel": lambda r, d: _listed(r, d, "kernel", lambda old: [*old, _kernel(r)]),
    "change a kernel": lambda r, d: _listed(r, d, "kernel", lambda old: [_kernel(r), *old[1:]]),
    "remove a kernel": lambda r, d: _listed(r, d, "kernel", lambda old: old[:-1]),
    "add a window": lambda r, d: _listed(r, d, "windows", lambda old: [*old, _window(r, len(old))]),
    "change a window": lambda r, d: _listed(r, d, "windows", lambda old: [_window(r, 0), *old[1:]]),
    "remove a window": lambda r, d: _listed(r, d, "windows", lambda old: old[1:]),
}
"""Edits by kind; an edit that does not apply raises an error of deodar."""

AMENDED = "several edits of a drag"
KINDS = (*EDITS, AMENDED)


def _comment(draw: Draw, doc: Document) -> str:
    comments: Any = doc.layout.get("comments")
    if not comments:
        raise dd.errors.ModelError("no comments")
    return draw.choice(sorted(comments))


def _with_tau(doc: Document) -> list[Entry]:
    elements = [e for e in doc.entries if isinstance(e.element, dd.Field)]
    if len(elements) < 2:
        raise dd.errors.ModelError("too few fields")
    return elements


def _inserted(draw: Draw, doc: Document) -> Document:
    if len(doc.entries) >= MOST_ELEMENTS:
        raise dd.errors.ModelError("full")
    return building.insert(doc, _template(), TEMPLATE, (), (draw.random(), 2.0))[0]


@functools.cache
def _template() -> Document:
    return templates.document(TEMPLATE)


def _preset(draw: Draw, doc: Document) -> Document:
    """Return a document with one other value."""
    return edit.put(doc, _named(draw, doc, "tau").id, "tau", draw.uniform(5, 50))


def _kernel(draw: Draw) -> Any:
    kernel = dd.Gaussian(draw.uniform(1, 9), sigma=draw.uniform(1, 3))
    return draw.choice((kernel, dd.MexicanHat(5, draw.uniform(1, 2), 3, 4)))


def _window(draw: Draw, before: int) -> dd.Window:
    start = 100 * before + draw.uniform(1, 40)
    return dd.Window(start, start + draw.uniform(1, 40))


def _listed(draw: Draw, doc: Document, leaf: str, how: Callable[[list[Any]], list[Any]]) -> Document:
    """Return a document in which one element has another list of parts."""
    chosen = _named(draw, doc, leaf)
    old = list(getattr(chosen.element, leaf) or ())
    new = how(old)
    if new == old:
        raise dd.errors.ModelError("nothing to change")
    return edit.put(doc, chosen.id, leaf, new)


def _copied(draw: Draw, doc: Document) -> Document:
    if len(doc.entries) >= MOST_ELEMENTS:
        raise dd.errors.ModelError("full")
    return clipboard.read(clipboard.text(building.excerpt(doc, _some(draw, doc))))


def _named(draw: Draw, doc: Document, parameter: str) -> Entry:
    elements = [e for e in doc.entries if hasattr(e.element, parameter)]
    if not elements:
        raise dd.errors.ModelError("none")
    return draw.choice(elements)


def written(doc: Document) -> tuple[str, bytes | None]:
    """Return the bytes of a document's files."""
    return document_files.dumps(doc, "walk")


def whole(doc: Document) -> Any:
    """Return a document as a page has it, with problems of its structure: the warnings follow later."""
    made = converted.convert(doc)
    document = view.document(doc, "", False, 0, 0, made)
    document = msgspec.structs.replace(document, problems=view.problems(made.problems, doc))
    return json.loads(msgspec.json.encode(document))


def _scripted(doc: Document) -> Document:
    """Return the document that the script of a document makes."""
    space: dict[str, Any] = {"__name__": "script"}
    exec(script.script(doc), space)
    return space["make"]().document


def attack(times: int, seed: int) -> Outcome:
    """Make edits at random, until every kind was undone and redone a number of times."""
    draw, outcome = random.Random(seed), Outcome()
    while not outcome.errors and any(outcome.least(kind) < times for kind in KINDS):
        _walk(draw, outcome, times)
    return outcome


def _walk(draw: Draw, outcome: Outcome, times: int) -> None:
    """Walk through a history that begins with an empty document."""
    history = edit.UndoHistory(Document("walk"))
    texts = [written(history.document)]
    kinds: list[str] = []  # of the change from each document to the next
    shown = converted.convert(history.document)
    page = whole(history.document)
    for _ in range(WALK):
        if all(outcome.least(kind) >= times for kind in KINDS):
            return
        # an edit discards what was undone, so that it comes more rarely where a redo is possible
        choice, ahead = draw.random(), history.ahead > 0
        if choice < 0.35:
            if history.undo():
                outcome.undone[kinds[history.depth]] += 1
        elif choice < 0.85 and ahead:
            history.redo()
            outcome.redone[kinds[history.depth - 1]] += 1
        elif choice > 0.99:
            texts = _arranged(draw, history, outcome)
        elif (kind := _drawn(draw, history, outcome)) is not None:
            outcome.made[kind] += 1
            kinds[history.depth - 1 :] = [kind]
            texts[history.depth :] = [written(history.document)]
        outcome.steps += 1
        doc = history.document
        if written(doc) != texts[history.depth]:
            outcome.fail("the document after undo or redo has other bytes")
        if outcome.steps % SCRIPTED == 0 and written(_scripted(doc)) != written(doc):
            outcome.fail("the script makes another document")
        after = converted.convert(doc, shown)
        changes = converted.changes(shown, after)
        expected = whole(doc)
        # problems are sent whole
        page = (
            expected
            if changes is None
            else applied(page, json.loads(msgspec.json.encode(changes))) | {"problems": expected["problems"]}
        )
        if page != expected:
            outcome.fail("the document after its difference differs")
        shown = after


def _arranged(draw: Draw, history: edit.UndoHistory, outcome: Outcome) -> list[tuple[str, bytes | None]]:
    """Change the layout of all documents, and return their texts."""
    steps_of = history.depth, history.ahead
    folded = draw.choice(([], ["a"], ["a", "b"], None))
    edit.arrange_everywhere(history, {"folded": folded, "panels": {"k": draw.random()}})
    if (history.depth, history.ahead) != steps_of:
        outcome.fail("a layout without undo changed the history")
    past = history.documents[: history.depth + 1]
    return [written(doc) for doc in (*past, *reversed(history.documents[history.depth + 1 :]))]


def _drawn(draw: Draw, history: edit.UndoHistory, outcome: Outcome) -> str | None:
    """Make an edit of the rarest kind that applies, and return the kind; None where none applies."""
    for kind in sorted(KINDS, key=lambda kind: (outcome.least(kind), draw.random())):
        try:
            if kind == AMENDED:
                history.commit(edit.describe(history.document, notes=str(draw.random())))
                history.amend(edit.describe(history.document, notes=str(draw.random())))
                return kind
            new = EDITS[kind](draw, history.document)
        except DeodarError:
            outcome.refused += 1
            continue
        if new is not history.document:
            history.commit(new)
            return kind
    return None
