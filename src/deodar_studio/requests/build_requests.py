"""Requests that build a document: new elements, connections, groups, copies."""

from __future__ import annotations

import asyncio
import dataclasses as dc
from collections.abc import Callable, Mapping
from typing import Annotated, Any, TypeVar, cast

import msgspec

from deodar.errors import DeodarError, DocumentError
from deodar.importers import stored_report
from deodar.model import building, clipboard, edit, fits, plain_values, proposed, script, strength
from deodar.model.building import Around, BoxPosition, ElementPort, EndPorts
from deodar.model.document import Document
from deodar_studio.catalogue import templates
from deodar_studio.messages.message import Data, Id
from deodar_studio.messages.to_page import Answer, Fits
from deodar_studio.pages.hub import Hub
from deodar_studio.pages.page import Page
from deodar_studio.requests.request import (
    MESSAGES,
    Count,
    DocumentRequest,
    Text,
    answer,
    asks,
    changes,
    edits,
)
from deodar_studio.views import view

T = TypeVar("T")

Coordinate = Annotated[float, msgspec.Meta(ge=-1e9, le=1e9)]
Position = tuple[Coordinate, Coordinate]
Group = Annotated[tuple[Text, ...], msgspec.Meta(max_length=64)]
Many = msgspec.Meta(max_length=100_000)
Ids = Annotated[tuple[Id, ...], Many]
Groups = Annotated[tuple[Group, ...], Many]


class PortEnd(Data, frozen=True, kw_only=True):
    """A port of an element; an empty `port` means the default one: the output, the first input."""

    element: Id
    port: Text = ""

    @property
    def key(self) -> ElementPort:
        return self.element, self.port


class Ends(Data, frozen=True, kw_only=True):
    """The ends of a connection; an empty port means the default one."""

    source: Id
    source_port: Text = ""
    target: Id
    target_port: Text = ""

    @property
    def ports(self) -> EndPorts:
        return self.source, self.source_port, self.target, self.target_port


async def _changed(hub: Hub, how: Callable[[Document], tuple[Document, T]]) -> T:
    """Change the document by a function that also returns a result, and return the result."""
    found: list[T] = []

    def change(doc: Document) -> Document:
        new, result = how(doc)
        found.append(result)
        return new

    await hub.project.history.change(change)
    return found[0]


@MESSAGES.register
class AddElement(DocumentRequest, frozen=True, kw_only=True, tag="add_element"):
    """Add an element of a kind; the answer has its id in `made`.

    `values` has the format of documents. Parameters without a value get one that works at once: axes are
    those of the ports that the element is connected with, else those of the first field, else a new axis x.
    `source`, `target`: ports that it is connected with; `wire`: a connection that it is inserted into;
    `replaces`: a connection that is removed. An empty name means a free one after its kind; a taken one gets
    a number. `at` is the position of its box; `positions` and `comments` are those of boxes and comments that
    make room for it, in the same step of undo.
    """

    kind: Text
    values: dict[str, Any] = {}
    name: Text = ""
    group: Group = ()
    at: Position | None = None
    source: PortEnd | None = None
    target: PortEnd | None = None
    wire: Ends | None = None
    replaces: Ends | None = None
    positions: Mapping[Id, Position] = {}
    comments: Mapping[Id, Position] = {}

    async def serve(self, hub: Hub, page: Page) -> Answer:
        source, target = (None if end is None else end.key for end in (self.source, self.target))
        wire, replaces = (None if ends is None else ends.ports for ends in (self.wire, self.replaces))
        around = Around(source, target, wire, replaces)
        session, doc = hub.engine.session, hub.project.history.document()
        world = None if session is None else session.world
        values = hub.embodiment.starting_values(self.kind, self.values, doc, world)

        def add(doc: Document) -> tuple[Document, list[str]]:
            new, ids = building.add(doc, self.kind, values, self.name, self.group, self.at, around)
            return _placed(new, self.positions, self.comments), ids

        return answer(made=await _changed(hub, add))


@edits(tag="insert")
def insert_element(
    doc: Document,
    *,
    element: Id,
    wire: Ends,
    positions: Mapping[Id, Position] = {},
    comments: Mapping[Id, Position] = {},
) -> Document:
    """Insert an existing element into a connection, by its default ports.

    `positions` and `comments` are those of boxes and comments, which change in the same step of undo.
    """
    return _placed(building.insert_element(doc, element, wire.ports), positions, comments)


@edits()
def connect(
    doc: Document,
    *,
    source: Id,
    source_port: Text = "",
    target: Id,
    target_port: Text = "",
    reads: Text = "",
) -> Document:
    """Connect an output port to an input port; `reads` is previous, current, delayed, or empty."""
    return building.connect(doc, (source, source_port, target, target_port), reads)


@changes()
async def set_strength(
    hub: Hub, page: Page, *, wire: Ends, value: float, gesture: Count = 0, dragging: bool = False
) -> Answer:
    """Change the strength of a connection; a Gain inside it is made, and removed at strength 1.

    `wire` is a plain connection or the one into its Gain, whose id the answer has in `made`. Changes with the
    same `gesture` (not 0) are one step of undo; while `dragging` the Gain stays at strength 1.
    """
    drag, history = (page.number, gesture) if gesture else None, hub.project.history
    before = history.document()
    new, gain = strength.set_strength(before, wire.ports, value, dragging)
    if gain == wire.target and new.connections == before.connections:  # pages receive a number alone
        await history.set(wire.target, strength.FACTOR, value, drag)
    else:
        await history.change(lambda _: new, drag)
    return answer(made=[] if gain is None else [gain])


@edits()
def disconnect(
    doc: Document, *, source: Id, source_port: Text = "", target: Id, target_port: Text = ""
) -> Document:
    """Remove a connection."""
    return building.disconnect(doc, [(source, source_port, target, target_port)])


@edits()
def reconnect(doc: Document, *, old: Ends, new: Ends) -> Document:
    """Move the ends of a connection."""
    return building.reconnect(doc, old.ports, new.ports)


@edits(tag="remove")
def remove_elements(
    doc: Document,
    *,
    elements: Ids = (),
    groups: Groups = (),
    connections: Annotated[tuple[Ends, ...], Many] = (),
) -> Document:
    """Remove elements, groups with their content, and connections."""
    return building.remove(doc, elements, groups, [ends.ports for ends in connections])


@edits()
def rename(doc: Document, *, name: Text, element: Id = "", group: Group = ()) -> Document:
    """Rename an element, or with an empty `element` a group. A name that is taken is refused."""
    if element:
        return building.rename(doc, element, name)
    return building.rename_group(doc, group, name)


@edits()
def move_into(
    doc: Document,
    *,
    elements: Ids = (),
    groups: Groups = (),
    group: Group = (),
    positions: Mapping[Id, Position] = {},
) -> Document:
    """Move elements and groups into a group; an empty `group` is the top level.

    `positions` are those of boxes, which change in the same step of undo.
    """
    return _placed(building.move_into(doc, elements, groups, group), positions)


@changes(tag="group")
async def make_group(
    hub: Hub,
    page: Page,
    *,
    elements: Ids = (),
    groups: Groups = (),
    name: Text = "",
    at: Position | None = None,
) -> Answer:
    """Put elements and groups into a new group, whose names are `group` of the answer.

    An empty name means a free one. `at`: the boxes are moved together, their corner to there.
    """
    path = await _changed(hub, lambda doc: building.group(doc, elements, groups, name, at))
    return answer(group=list(path))


@edits()
def ungroup(doc: Document, *, group: Group) -> Document:
    """Move the content of a group to its parent."""
    return building.ungroup(doc, group)


@asks(tag="copy")
async def copy_elements(hub: Hub, page: Page, *, elements: Ids = (), groups: Groups = ()) -> Answer:
    """Return elements and groups as a document of their own, the JSON text `text` of the answer."""
    doc = hub.project.history.document()
    return answer(
        text=await asyncio.to_thread(lambda: clipboard.text(building.excerpt(doc, elements, groups)))
    )


@asks()
async def export_script(hub: Hub, page: Page) -> Answer:
    """Return a Python script that makes the document, the `text` of the answer."""
    # a script says how the model is built, not what was imported
    doc, path = stored_report.without_report(hub.project.history.document()), hub.project.file.path
    return answer(text=await asyncio.to_thread(script.script, doc, "" if path is None else path.name))


@changes()
async def paste(hub: Hub, page: Page, *, text: str, group: Group = (), at: Position | None = None) -> Answer:
    """Add the content of a document, given as text, to a group; the answer has the new ids in `made`.

    `at` is the position of its upper left corner. Other text is refused, and nothing changes.
    """
    try:
        read = await asyncio.to_thread(clipboard.read, text)
    except DeodarError as error:
        first, *more = error.problems
        what = f"the clipboard holds no elements that can be pasted: {first.what}"
        raise DocumentError(
            what + (f" (and {len(more)} more problems)" if more else ""), first.where, first.fix
        ) from None
    # functions that the text names run only where the studio was started with trust, as those of a file
    template = dc.replace(read, foreign=not hub.project.trust)
    return answer(made=await _changed(hub, lambda doc: building.paste(doc, template, group, at)))


@changes()
async def set_many(
    hub: Hub, page: Page, *, elements: Ids, parameter: Text, value: Any, gesture: Count = 0
) -> Answer:
    """Change one parameter of several elements to the same value, as `set` does for one."""
    ids = list(dict.fromkeys(elements))
    drag = (page.number, gesture) if gesture else None
    cost = await hub.project.history.change(lambda doc: plain_values.put(doc, ids, parameter, value), drag)
    return answer(cost=cost)


@changes()
async def change_axis(hub: Hub, page: Page, *, key: Text, axis: Mapping[str, Any]) -> Answer:
    """Change an axis, given by its key, for all elements that have it.

    `axis` has the properties of the new one: name, lower, upper, samples, periodic, unit.
    """
    new = dc.asdict(plain_values.axis(axis))
    cost = await hub.project.history.change(lambda doc: proposed.change_axis(doc, key, new))
    return answer(cost=cost)


@edits()
def add_axis(doc: Document, *, axis: Mapping[str, Any]) -> Document:
    """Add an axis that no element has yet; `axis` has the properties of `change_axis`."""
    return edit.add_axis(doc, plain_values.axis(axis))


@edits()
def remove_axis(doc: Document, *, key: Text) -> Document:
    """Remove an axis, given by its key, also from the elements that have it; refused if one needs it."""
    return proposed.remove_axis(doc, key)


@changes()
async def add_template(
    hub: Hub, page: Page, *, name: Text, group: Group = (), at: Position | None = None
) -> Answer:
    """Add a template of `welcome` as a new group; the answer has its ids in `made` and its names in `group`.

    `group` is the group that it is added to, `at` the position of its upper left corner.
    """
    template = await asyncio.to_thread(templates.document, name)

    def insert(doc: Document) -> tuple[Document, Answer]:
        new, ids, path = building.insert(doc, template, name, group, at)
        return new, answer(made=ids, group=list(path))

    return await _changed(hub, insert)


@changes()
async def comment(
    hub: Hub,
    page: Page,
    *,
    comment: Id = "",
    text: str | None = None,
    at: Position | None = None,
    size: Position | None = None,
    remove: bool = False,
) -> Answer:
    """Add, change or remove a comment on the graph; the answer has the id of a new one in `made`.

    An empty `comment` adds one. None leaves text, position or size (width, height) unchanged. Comments are in
    the layout, `comments` by id, with `text`, `x`, `y`, `width` and `height`.
    """
    values: dict[str, Any] = {} if text is None else {"text": text}
    values |= {} if at is None else {"x": at[0], "y": at[1]}
    values |= {} if size is None else {"width": size[0], "height": size[1]}
    ids: list[str] = []

    def change(doc: Document) -> Document:
        new, ident = building.comment(doc, comment, None if remove else values)
        ids.append(ident)
        return new

    await hub.project.history.lay_out(change)
    return answer(made=[] if comment else ids)


@asks(tag="fits")
async def find_fits(hub: Hub, page: Page, *, element: Id, port: Text = "") -> Fits:
    """Judge what a port can be connected with; a `fitting` message follows.

    An empty `port` means the default output, or the first input of an element without outputs.
    """
    ports, kinds = await asyncio.to_thread(fits.fits, hub.project.history.document(), element, port)
    return view.fits((element, port), ports, kinds)


@changes(tag="place")
async def place_boxes(hub: Hub, page: Page, *, positions: dict[Id, Position]) -> None:
    """Move boxes to positions, by the ids of their elements."""
    await hub.project.history.lay_out(lambda doc: _placed(doc, positions))


def _placed(
    doc: Document, positions: Mapping[str, BoxPosition], comments: Mapping[str, BoxPosition] = {}
) -> Document:
    """Move the boxes of elements, and comments, that exist: another page may have removed the others."""
    for ident, (x, y) in comments.items():
        if ident in cast("dict[str, Any]", doc.layout.get(building.COMMENTS) or {}):
            doc, _ = building.comment(doc, ident, {"x": x, "y": y})
    return building.placed(doc, {i: at for i, at in positions.items() if i in doc.by_id()})
