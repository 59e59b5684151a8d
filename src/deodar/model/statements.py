"""The statements of a script that makes a document: elements that it adds, and chains of connections.

Elements and connections keep their order in the document. A connection stands where both of its ends exist,
and becomes part of a chain, `left >> dd.Gain(2) >> u`, where it directly follows the element or connection
before it.
"""

from __future__ import annotations

import dataclasses as dc
from collections import Counter
from collections.abc import Iterator, Sequence
from typing import Literal

from deodar.model import edit, find
from deodar.model.document import Connection, Document, Entry
from deodar.model.paths import PathNames, stored_id

How = Literal["", "exists", "added", "follows", "named"]
"""How an item of a statement is written: an existing element by its variable; an element that is added in
place; one that follows the item before it without a name of its own; the same, at the end of its chain, whose
value is kept in a variable.
"""


@dc.dataclass(frozen=True)
class ChainItem:
    """An element in a statement, and its port if it is not the default one."""

    entry: Entry
    how: How
    port: str = ""


@dc.dataclass(frozen=True)
class Statement:
    """One element that is added, or a chain of items; `reads` of its only connection, if the document states
    one.
    """

    items: tuple[ChainItem, ...]
    reads: str = ""


_Step = Entry | Connection


def statements(doc: Document) -> list[Statement]:
    """Return the statements that add the elements of a document and connect them, in order."""
    return list(_Statements(doc).all())


class _Statements:
    def __init__(self, doc: Document) -> None:
        self.doc = doc
        self.by = doc.by_id()
        self.uses = Counter(i for c in doc.connections for i in (c.source, c.target))
        self.steps: Sequence[_Step] = list(self._ordered())
        self.unnamed = set(self._unnamed())
        self.hows: list[How] = [""] * len(self.steps)
        for k in reversed(range(len(self.steps))):
            self.hows[k] = self._how(k)

    def _ordered(self) -> Iterator[_Step]:
        """Yield elements in their order, and each connection as soon as both of its ends exist."""
        exist: set[str] = set()
        unread = iter(self.doc.connections)
        following = next(unread, None)
        for e in self.doc.entries:
            yield e
            exist.add(e.id)
            while following is not None and following.source in exist and following.target in exist:
                yield following
                following = next(unread, None)

    def _unnamed(self) -> Iterator[str]:
        """Yield the elements to which `source >> element` gives their name and id."""
        ids: set[str] = set()
        names: set[PathNames] = set()
        for k, e in enumerate(self.steps):
            if isinstance(e, Connection):
                continue
            into = self._plain(k + 1)
            if into is not None and into.target == e.id and e.every == 1:
                source = self.by[into.source]
                base = edit.name_after(source, e.element)
                if e.group == source.group and e.names[-1].startswith(base):
                    name, n = base, 1
                    while (*e.group, name) in names:
                        n += 1
                        name = f"{base}{n}"
                    if name == e.names[-1] and stored_id(e.path, ids) == e.id:
                        yield e.id
            ids.add(e.id)
            names.add(e.names)

    def _how(self, k: int) -> How:
        """Return how a chain contains the element that step k adds, if step k + 1 connects the chain to it;
        empty: it does not.
        """
        e, into = self.steps[k], self._plain(k + 1)
        if not isinstance(e, Entry) or into is None or into.target != e.id or into.source == e.id:
            return ""
        if self._target(into).port:
            return ""
        complete = self.uses[e.id] == 1 or (self.uses[e.id] == 2 and self._continues(k + 2, e))
        if e.id in self.unnamed:
            return "follows" if complete else "named"
        return "added" if complete else ""

    def _continues(self, k: int, last: Entry) -> bool:
        """Return whether a chain that ends in an element continues at step k."""
        step = self.steps[k] if k < len(self.steps) else None
        out = self._plain(k + 1 if isinstance(step, Entry) else k)
        if out is None or out.source != last.id or out.target == last.id or self._source(out).port:
            return False
        return not isinstance(step, Entry) or (out.target == step.id and self.hows[k] != "")

    def all(self) -> Iterator[Statement]:
        k = 0
        while k < len(self.steps):
            items, reads, k = self._begun(k)
            if len(items) > 1 and not reads:
                while not items[-1].port and items[-1].how != "named" and self._continues(k, items[-1].entry):
                    operand, k = self._next(k)
                    items.append(operand)
            yield Statement(tuple(items), reads)

    def _begun(self, k: int) -> tuple[list[ChainItem], str, int]:
        """Return the first items of the statement of step k, what its connection reads, and the step after
        them.
        """
        step = self.steps[k]
        if isinstance(step, Connection):
            return [self._source(step), self._target(step)], step.reads, k + 1
        following = self._plain(k + 1)
        if (
            following is not None
            and following.source == step.id != following.target
            and self.uses[step.id] == 1
        ):
            source = self._source(following)
            if not source.port:
                return [dc.replace(source, how="added"), self._target(following)], "", k + 2
        if following is not None and self.hows[k]:
            return [self._source(following), ChainItem(step, self.hows[k])], "", k + 2
        return [ChainItem(step, "added")], "", k + 1

    def _next(self, k: int) -> tuple[ChainItem, int]:
        """Return the item with which a chain continues at step k, and the step after it."""
        step = self.steps[k]
        if isinstance(step, Connection):
            return self._target(step), k + 1
        return ChainItem(step, self.hows[k]), k + 2

    def _plain(self, k: int) -> Connection | None:
        """Return step k if it is a connection that states no `reads`."""
        step = self.steps[k] if k < len(self.steps) else None
        return step if isinstance(step, Connection) and not step.reads else None

    def _source(self, c: Connection) -> ChainItem:
        entry = self.by[c.source]
        return ChainItem(entry, "exists", "" if c.source_port == find.outputs(entry)[0] else c.source_port)

    def _target(self, c: Connection) -> ChainItem:
        entry = self.by[c.target]
        return ChainItem(entry, "exists", "" if c.target_port == entry.element.ports()[0] else c.target_port)
