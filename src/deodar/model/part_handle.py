"""Handles of parts inside an element of a model, such as `u.kernel`, `u.kernel[0]` and `u.sigmoid`."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Protocol, TypeGuard, cast

from deodar.errors import ParameterError, UnknownAttribute, UnknownName, did_you_mean
from deodar.leaves import get
from deodar.model import edit
from deodar.model.document import Document, Entry
from deodar.parameters import Part, Reference, normal, parameter, parameters, show
from deodar.summary import Summarised, Summary
from deodar.synonyms import argument


class Owner(Protocol):
    """The members of a model that its handles use."""

    @property
    def document(self) -> Document:
        """The present document."""
        ...

    def entry(self, ident: str) -> Entry:
        """Return the entry of an id."""
        ...

    def commit(self, document: Document) -> None:
        """Replace the document by an edited one."""
        ...


class PartHandle(Summarised, Reference):
    """A kernel, a sigmoid or another part inside an element of a model.

    `u.kernel[0].sigma` reads the present value, `u.kernel[0].sigma = 3` changes it in the model. Where a part
    is expected, the handle stands for the present part of the model: `v.sigmoid = u.sigmoid`.
    """

    def __init__(self, model: Owner, ident: str, leaf: str) -> None:
        vars(self).update(_model=model, _id=ident, _leaf=leaf)

    def __value__(self) -> Part:
        return get(self._model.entry(self._id).element, self._leaf)

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(f"{type(self).__name__!r} object has no attribute {name!r}")
        part = self.__value__()
        if name not in _names(part) and hasattr(part, name):
            return getattr(part, name)
        self._require(part, name)
        return inside(self._model, self._id, part, self._leaf, name)

    def __setattr__(self, name: str, value: Any) -> None:
        self._require(self.__value__(), name)
        self._model.commit(edit.put(self._model.document, self._id, f"{self._leaf}.{name}", value))

    def __delattr__(self, name: str) -> None:
        raise ParameterError(f"{name} cannot be deleted from a part", fix="Assign another value")

    def _require(self, part: Part, name: str) -> None:
        if name not in _names(part):
            where = f"{self._model.entry(self._id).path}.{self._leaf}.{name}"
            raise UnknownAttribute(
                f"{type(part).__name__} has no parameter {name!r}",
                where=where,
                fix=argument(type(part).__name__, name) or did_you_mean(name, _names(part)),
            )

    def __call__(self, *args: Any) -> Any:
        return cast(Any, self.__value__())(*args)

    def __eq__(self, other: object) -> bool:
        return self.__value__() == (other.__value__() if isinstance(other, Reference) else other)

    def __dir__(self) -> list[str]:
        return sorted(_names(self.__value__()))

    def _summary(self) -> Summary:
        return _described(self._model, self._id, self._leaf, self.__value__)


class PartsHandle(Summarised, Reference):
    """The kernels, windows or other parts inside an element of a model, in order; items are handles of
    parts.
    """

    def __init__(self, model: Owner, ident: str, leaf: str) -> None:
        vars(self).update(_model=model, _id=ident, _leaf=leaf)

    def __value__(self) -> tuple[Part, ...]:
        entry = self._model.entry(self._id)
        parts: tuple[Part, ...] | None = get(entry.element, self._leaf)
        if parts is None:
            path = f"{entry.path}.{self._leaf}"
            raise UnknownName(
                f"{path} is None now, no list of parts", fix=f"Write: model.set({path!r}, [...])"
            )
        return parts

    def __len__(self) -> int:
        return len(self.__value__())

    def __getitem__(self, index: int) -> PartHandle:
        return PartHandle(self._model, self._id, f"{self._leaf}.{self._place(index)}")

    def __setitem__(self, index: int, value: Any) -> None:
        self._model.commit(
            edit.put(self._model.document, self._id, f"{self._leaf}.{self._place(index)}", value)
        )

    def __delitem__(self, index: int) -> None:
        parts = list(self.__value__())
        del parts[self._place(index)]
        self._model.commit(edit.put(self._model.document, self._id, self._leaf, parts))

    def __iter__(self) -> Iterator[PartHandle]:
        return (self[k] for k in range(len(self)))

    def __add__(self, other: Sequence[Any]) -> list[Any]:
        return [*self.__value__(), *other]

    def __radd__(self, other: Sequence[Any]) -> list[Any]:
        return [*other, *self.__value__()]

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(f"{type(self).__name__!r} object has no attribute {name!r}")
        self._refuse(name)

    def __setattr__(self, name: str, value: Any) -> None:
        self._refuse(name)

    def _refuse(self, name: str) -> None:
        entry, parts = self._model.entry(self._id), self.__value__()
        written = f"{entry.names[-1] if entry.names[-1].isidentifier() else 'handle'}.{self._leaf}"
        if any(name in _names(part) for part in parts):
            raise UnknownAttribute(
                f"{entry.path}.{self._leaf} is a list of parts; {name!r} is a parameter of one",
                fix=f"Write: {written}[0].{name}",
            )
        sentence = f"{entry.path}.{self._leaf} is a list of parts in a model, without {name!r}"
        raise UnknownAttribute(sentence, fix=f"Assign another list. Write: {written} = [*{written}, part]")

    def _place(self, index: Any) -> int:
        n = len(self)
        if isinstance(index, bool) or not isinstance(index, int):
            raise ParameterError(f"the index of a part is a whole number, not {show(index)}")
        if not -n <= index < n:
            path = self._model.entry(self._id).path
            raise IndexError(
                f"{path}.{self._leaf} has {n} part{'' if n == 1 else 's'}, counted from 0; there is no part"
                f" {index}"
            )
        return index % n

    def __eq__(self, other: object) -> bool:
        if isinstance(other, Reference):
            return self.__value__() == other.__value__()
        return isinstance(other, (tuple, list)) and self.__value__() == tuple(cast("Sequence[Any]", other))

    def __dir__(self) -> list[str]:
        return []

    def _summary(self) -> Summary:
        return _described(self._model, self._id, self._leaf, self.__value__)


def inside(model: Owner, ident: str, part: Part, leaf: str, name: str) -> Any:
    """Return a parameter of an element, or of a part at the path `leaf` inside it; parts as handles."""
    form, path = parameter(type(part), name).form, f"{leaf}.{name}" if leaf else name
    parameter_value = getattr(part, name)
    if form == "parts" and parameter_value is not None:
        return PartsHandle(model, ident, path)
    return PartHandle(model, ident, path) if isinstance(parameter_value, Part) else parameter_value


def brief(part: Part, links: Mapping[str, str], leaf: str = "") -> list[str]:
    """Return `name=value` of every parameter that differs from its default or is linked to a document
    parameter.

    The name and the axes of an element are left out.
    """
    out: list[str] = []
    for p in parameters(type(part)):
        value, path = getattr(part, p.name), f"{leaf}.{p.name}" if leaf else p.name
        if p.name == "name" or p.form in ("axes", "axis"):
            continue
        if any(link == path or link.startswith(f"{path}.") for link in links) or not _is_default(p, value):
            by = f" ({links[path]})" if path in links else ""
            out.append(f"{p.name}={_value(value, links, path)}{by}")
    return out


def _value(value: Any, links: Mapping[str, str], path: str) -> str:
    if isinstance(value, Part):
        return f"{type(value).__name__}({', '.join(brief(value, links, path))})"
    if _are_parts(value):
        return f"[{', '.join(_value(part, links, f'{path}.{k}') for k, part in enumerate(value))}]"
    return show(value)


def _are_parts(value: Any) -> TypeGuard[tuple[Part, ...]]:
    return isinstance(value, tuple) and all(isinstance(part, Part) for part in cast("tuple[Any, ...]", value))


def _is_default(p: Any, value: Any) -> bool:
    try:
        return value == normal(p, p.default)
    except ValueError:  # a required parameter
        return False


def _described(model: Owner, ident: str, leaf: str, current: Any) -> Summary:
    try:
        text = _value(current(), links_of(model, ident), leaf)
        return Summary(f"{model.entry(ident).path}.{leaf}: {text}")
    except UnknownName:
        return Summary(f"{leaf} of a removed element, id {ident}")


def links_of(model: Owner, ident: str) -> dict[str, str]:
    """Return the document parameter that drives each linked parameter of an element."""
    return {leaf: name for (i, leaf), name in model.document.links().items() if i == ident}


def _names(part: Part) -> list[str]:
    return [p.name for p in parameters(type(part))]
