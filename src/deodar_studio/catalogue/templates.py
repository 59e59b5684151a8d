"""Models that the studio adds to a document as a group: published architectures, and examples."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping

from deodar import architectures, docstring
from deodar.errors import UnknownName, did_you_mean
from deodar.importers import examples
from deodar.kinds.description import title
from deodar.model import document_files
from deodar.model.document import Document
from deodar.model.model import Model
from deodar_studio.catalogue import gallery
from deodar_studio.messages.to_page import TemplateView


def listed() -> list[TemplateView]:
    """Return all templates: architectures, then examples; an architecture has the picture of the example of
    its name.
    """
    shown = {e.name: e for e in gallery.examples()}
    published = [
        TemplateView(
            name=name,
            title=title(name.capitalize()),
            sentence=_sentence(make),
            picture=shown[name].picture if name in shown else "",
            room="architectures",
        )
        for name, make in _architectures().items()
    ]
    others = [
        TemplateView(name=e.name, title=e.title, sentence=e.sentence, picture=e.picture, room="examples")
        for e in shown.values()
        if e.name not in _architectures()
    ]
    return published + others


def _sentence(make: Callable[[], Model]) -> str:
    """Return the first sentence of a function's description, without the verb."""
    summary = docstring.parse(inspect.getdoc(make) or "").summary
    said = summary.split(". ")[0].removesuffix(".").removeprefix("Create ").replace("`", "")
    return f"{said[:1].upper()}{said[1:]}."


def document(name: str) -> Document:
    """Return the document of a template.

    Raises:
        UnknownName: no template has that name.
    """
    make = _architectures().get(name)
    if make is not None:
        return make().document
    known = examples.names()
    if name not in known:
        fix = did_you_mean(name, [*known, *_architectures()])
        raise UnknownName(f"there is no template {name!r}", fix=fix)
    return document_files.load(gallery.example_file(name))


def _architectures() -> Mapping[str, Callable[[], Model]]:
    """Return the functions of `deodar.architectures` that make a model without arguments, by name."""
    found: dict[str, Callable[[], Model]] = {}
    for name in architectures.__all__:
        made = getattr(architectures, name)
        if inspect.isfunction(made):
            form = inspect.signature(made)
            free = all(p.default is not p.empty for p in form.parameters.values())
            if free and form.return_annotation in ("Model", Model):
                found[name] = made
    return found
