"""Handles of elements and ports: parameters are attributes, ports are items."""

from __future__ import annotations

from typing import Any, Protocol

from deodar.element import Element
from deodar.errors import ParameterError, UnknownAttribute, UnknownName, did_you_mean
from deodar.model import edit, find
from deodar.model.document import Entry
from deodar.model.part_handle import Owner, brief, inside, links_of
from deodar.model.paths import quote
from deodar.numerics.axes import describe
from deodar.parameters import parameters
from deodar.summary import Summarised, Summary

_OWN = frozenset({"model", "id", "port", "path", "element"})


class Builder(Owner, Protocol):
    """The methods of a model that `>>` calls."""

    def connect(self, source: Handle, target: Handle) -> None:
        """Connect an output port to an input port."""
        ...

    def follow(self, source: Handle, element: Element) -> Handle:
        """Add an element that reads `source`."""
        ...


class Handle(Summarised):
    """An element of a model or one of its ports, as `add` returns it and `>>` connects it.

    A parameter is an attribute: `u.tau` reads its present value in the model, `u.tau = 30` changes it as
    `model.set("u.tau", 30)` does. Kernels and sigmoids are read and changed inside: `u.kernel[0].sigma = 3`.
    A parameter that is linked to a document parameter has the value of the document parameter and cannot be
    set.
    A port is an item: `u["activation"]`.

    Attributes:
        model: the model.
        id: stored id of the element.
        port: name of the port, or "" for the element.
    """

    model: Builder
    id: str
    port: str

    def __init__(self, model: Builder, id: str, port: str = "") -> None:
        vars(self).update(model=model, id=id, port=port)

    # -------------------------------------------------------------------------------------------------- ports

    def __getitem__(self, port: str) -> Handle:
        entry = self.model.entry(self.id)
        if port not in find.readable(entry):
            raise UnknownName(
                f"{entry.path} has no port {port!r}", fix=did_you_mean(port, find.readable(entry))
            )
        return Handle(self.model, self.id, port)

    __iter__ = None
    """A handle is not a sequence of its ports."""

    def __rshift__(self, other: Handle | Element) -> Handle:
        if isinstance(other, Handle):
            self.model.connect(self, other)
            return other
        return self.model.follow(self, other)

    def _ipython_key_completions_(self) -> list[str]:
        """Return the ports, for completion inside the brackets."""
        return find.readable(self.model.entry(self.id))

    # ------------------------------------------------------------------------- the element and its parameters

    @property
    def path(self) -> str:
        """The present path of the element, after renames and moves."""
        return self.model.entry(self.id).path

    @property
    def element(self) -> Element:
        """The element in the present document."""
        return self.model.entry(self.id).element

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(f"{type(self).__name__!r} object has no attribute {name!r}")
        entry = self.model.entry(self.id)
        self._require(entry, name)
        return inside(self.model, self.id, entry.element, "", name)

    def __setattr__(self, name: str, value: Any) -> None:
        if name in _OWN:
            raise ParameterError(
                f"{name} belongs to the handle and cannot be assigned",
                fix="An element is renamed by model.rename(handle, name)",
            )
        entry = self.model.entry(self.id)
        self._require(entry, name)
        self.model.commit(edit.put(self.model.document, self.id, name, value))

    def __delattr__(self, name: str) -> None:
        raise ParameterError(f"{name} cannot be deleted from an element", fix="Assign another value")

    def _require(self, entry: Entry, name: str) -> None:
        names = [p.name for p in parameters(type(entry.element))]
        if name in names:
            return
        last = entry.names[-1]
        if name in find.readable(entry):
            variable = last if last.isidentifier() else "handle"
            raise UnknownAttribute(
                f"{entry.path}.{name} is a port, not a parameter", fix=f'Write: {variable}["{name}"]'
            )
        raise UnknownAttribute(
            f"{type(entry.element).__name__} has no parameter {name!r}",
            where=f"{entry.path}.{name}",
            fix=find.elsewhere(entry, name) or did_you_mean(name, names),
        )

    # ------------------------------------------------------------------------------------------- as an object

    def __dir__(self) -> list[str]:
        try:
            names = [p.name for p in parameters(type(self.element))]
        except UnknownName:
            names = []
        return sorted({*_OWN, *names})

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Handle) and (other.model, other.id, other.port) == (
            self.model,
            self.id,
            self.port,
        )

    def __hash__(self) -> int:
        return hash((self.model, self.id, self.port))

    def __repr__(self) -> str:
        title, rows = self._summary()[:2]
        others = ", ".join("=".join(row) for row in rows)
        return f"<{title}{': ' if others else ''}{others}>"

    def _summary(self) -> Summary:
        try:
            entry = self.model.entry(self.id)
        except UnknownName:
            return Summary(f"Handle of a removed element, id {self.id}")
        kind = type(entry.element).__name__
        if self.port:
            return Summary(f"{kind} {entry.path}.{quote(self.port)}")
        axes = getattr(entry.element, "axes", ())
        rows = [setting.split("=", 1) for setting in brief(entry.element, links_of(self.model, self.id))]
        return Summary(f"{kind} {entry.path}{f' {describe(axes)}' if axes else ''}", rows)
