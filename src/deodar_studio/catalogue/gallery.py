"""The gallery: the documents that come with deodar, each with a sentence and a picture.

The picture is the file `NAME.png` in the folder of the document.
"""

from __future__ import annotations

from pathlib import Path

from deodar.errors import UnknownName, did_you_mean
from deodar.importers import examples as found
from deodar_studio.messages.to_page import ExampleView


def examples() -> list[ExampleView]:
    """Return all examples, in the order of the gallery."""
    return [_view(name) for name in found.names()]


def example_file(name: str) -> Path:
    """Return the path of an example's document.

    Raises:
        UnknownName: no example has that name.
    """
    known = found.names()
    if name not in known:
        raise UnknownName(f"there is no example {name!r}", fix=did_you_mean(name, known))
    return found.file(name)


def picture_file(name: str) -> Path | None:
    """Return the path of an example's picture, or None if it has none."""
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
