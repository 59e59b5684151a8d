"""The gallery: documents that come with deodar, each with a sentence and a picture.

An example is a document in the folder `examples`, `NAME.json`; its picture is `NAME.png` beside it, its sentence the first of its notes.
`order.txt` there says which come first.
"""

from __future__ import annotations

import json
import re
from pathlib import Path

from deodar.errors import UnknownName, did_you_mean
from deodar.server.to_page import ExampleView

LONGEST = 140
"""Most characters of a sentence."""


def examples() -> list[ExampleView]:
    """Every example, in the order in which they are best looked at."""
    return [_view(name) for name in _names()]


def example_file(name: str) -> Path:
    """The document of an example."""
    known = _names()
    if name not in known:
        raise UnknownName(f"there is no example {name!r}", fix=did_you_mean(name, known))
    return _folder() / f"{name}.json"


def picture_file(name: str) -> Path | None:
    """The picture of an example, if it has one."""
    path = _folder() / f"{name}.png"
    return path if name in _names() and path.is_file() else None


def sentence(notes: str, title: str) -> str:
    """The first sentence of notes, which may begin with the title; a long one is cut where it pauses."""
    rest = " ".join(notes.split())
    if rest.lower().startswith(f"{title.lower()}."):
        rest = rest[len(title) + 1 :].strip()
    first = re.split(r"(?<=[.!?])\s+(?=[^a-z])", rest, maxsplit=1)[0]
    if len(first) <= LONGEST:
        return first
    pause = max(first.rfind(mark, 0, LONGEST) for mark in (", ", "; ", ": "))
    return first[:pause] + "." if pause > 0 else first[: LONGEST - 1].rpartition(" ")[0] + "…"


def _folder() -> Path:
    """Beside the code in an installed deodar, beside `src` in a copy of its repository."""
    package = Path(__file__).parents[1]
    installed = package / "examples"
    return installed if installed.is_dir() else package.parents[1] / "examples"


def _names() -> list[str]:
    folder = _folder()
    order = folder / "order.txt"
    first = order.read_text(encoding="utf-8").split() if order.is_file() else []
    there = sorted(p.stem for p in folder.glob("*.json"))
    return [n for n in first if n in there] + [n for n in there if n not in first]


def _view(name: str) -> ExampleView:
    data = json.loads(example_file(name).read_text(encoding="utf-8"))
    title = str(data.get("name") or name.replace("_", " "))
    return ExampleView(
        name=name,
        title=title[0].upper() + title[1:],
        sentence=sentence(str(data.get("notes", "")), title),
        picture=f"examples/{name}.png" if picture_file(name) else "",
    )
