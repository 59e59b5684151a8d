"""The gallery: the documents that come with deodar, each with a sentence and a picture, `NAME.png` beside the
document.
"""

from __future__ import annotations

from pathlib import Path

from deodar.errors import UnknownName, did_you_mean
from deodar.importers import examples as found
from deodar.server.to_page import ExampleView


def examples() -> list[ExampleView]:
    """Every example, in the order in which they are best looked at."""
    return [_view(name) for name in found.names()]


def example_file(name: str) -> Path:
    """The document of an example."""
    known = found.names()
    if name not in known:
        raise UnknownName(f"there is no example {name!r}", fix=did_you_mean(name, known))
    return found.file(name)


def picture_file(name: str) -> Path | None:
    """The picture of an example, if it has one."""
    path = found.folder() / f"{name}.png"
    return path if name in found.names() and path.is_file() else None


def _view(name: str) -> ExampleView:
    title = found.about(name)["title"]
    return ExampleView(
        name=name,
        title=title[0].upper() + title[1:],
        sentence=found.sentence(name),
        picture=f"examples/{name}.png" if picture_file(name) else "",
    )
