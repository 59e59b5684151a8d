"""The examples of deodar by name: `example:selection` is valid wherever the file of a model is.

An example is a document in the folder `examples`, `NAME.json`, with its notes, or a script, `NAME.py`, with
its docstring. `order.txt` in the folder states the order of the first documents.
"""

from __future__ import annotations

import ast
import re
from pathlib import Path
from typing import Any

from deodar import codec, plugins, regular_file
from deodar.errors import UnknownName, did_you_mean
from deodar.plugins import Plugin
from deodar.similar import nearest

PREFIX = "example:"
"""Prefix of a name that means the file of an example."""

LONGEST = 140
"""Largest number of characters of a sentence."""

COURSE = {"exercises": "exercises/*.ipynb", "solutions": "exercises/solutions/*.py"}
"""Files that are copied together, by the name under which they are copied."""

MAKERS = ("make", "pictures")
"""Scripts of the folder that write the examples and their pictures, and are not examples."""


def packaged() -> list[Plugin]:
    """Return the folders of examples that installed packages name, without importing them."""
    return plugins.found("examples")


def folders() -> list[Path]:
    """Return the folder of deodar, and those of packages: the folder of the module that each entry names."""
    modules = [module for module, problem in (p.load() for p in packaged()) if not problem]
    return [folder(), *(Path(module.__file__).parent for module in modules)]


def folder() -> Path:
    """Return the folder of deodar: beside the code in an installed deodar, beside `src` in a copy of its
    repository.
    """
    package = Path(__file__).parents[1]
    installed = package / "examples"
    return installed if installed.is_dir() else package.parents[1] / "examples"


def names() -> list[str]:
    """List the documents, in the order in which a reader should see them."""
    order = folder() / "order.txt"
    first = regular_file.read_text(order).split() if order.is_file() else []
    stems = [p.stem for place in folders() for p in sorted(place.glob("*.json"))]
    return list(dict.fromkeys([*(n for n in first if n in stems), *stems]))


def scripts() -> list[str]:
    """List the scripts."""
    found = (p.stem for place in folders() for p in sorted(place.glob("*.py")))
    return [name for name in dict.fromkeys(found) if name not in MAKERS and not name.startswith("_")]


def file(name: str) -> Path:
    """Return the document or the script of an example.

    Raises:
        UnknownName: no example has that name.
    """
    ending = "json" if name in names() else "py" if name in scripts() else ""
    if ending:
        paths = (place / f"{name}.{ending}" for place in folders())
        return next(path for path in paths if path.is_file())
    known = [*names(), *scripts()]
    raise UnknownName(
        f"there is no example {name!r}",
        fix=f"{did_you_mean(name, known)}. All examples: deodar examples".removeprefix(". "),
    )


def parts(name: str) -> list[Path]:
    """List the files that an example needs, its own first: the arrays of a document, the documents of a
    script; or the notebooks of the exercises, or their solutions.
    """
    if name in COURSE:
        return sorted(folder().glob(COURSE[name]))
    own = file(name)
    text = regular_file.read_text(own)
    if own.suffix == ".json":
        arrays = codec.parse(text).get("arrays")
        return [own, own.with_name(arrays["file"])] if arrays else [own]
    read = [n for n in names() if f'"{n}.json"' in text]
    return [own, *(path for n in read for path in parts(n))]


def named(path: str | Path) -> Path:
    """Return the path of a document; `example:NAME` gives the document of an example.

    Raises:
        UnknownName: no example has that name, or it is a script.
    """
    text = str(path)
    if not text.startswith(PREFIX):
        return Path(path)
    name = text.removeprefix(PREFIX)
    if name in scripts():
        raise UnknownName(
            f"the example {name!r} is a script",
            fix=f"Type: deodar examples copy {name}, then python {name}.py",
        )
    return file(name)


def holds(path: Path) -> bool:
    """Return whether a path is the document of an example in the folder of the examples."""
    return path.suffix == ".json" and path.parent in folders() and path.stem in names()


def near(path: Path) -> str:
    """Suggest the intended file for a missing one: an example, or a document in the same folder with a
    similar name.
    """
    if path.stem in names() and path.suffix in ("", ".json"):
        return f"Did you mean '{PREFIX}{path.stem}'?"
    there = [p.name for p in path.parent.glob("*.json")] if path.parent.is_dir() else []
    example = nearest(path.stem, names())
    meant = nearest(path.name, there) or (f"{PREFIX}{example}" if example else "")
    return f"Did you mean {meant!r}?" if meant else ""


def about(name: str) -> dict[str, Any]:
    """Return the title and the notes of an example; of a script its name and the first paragraph of its
    docstring.
    """
    own = file(name)
    text = regular_file.read_text(own)
    if own.suffix == ".py":
        said = ast.get_docstring(ast.parse(text)) or ""
        return {"title": name.replace("_", " "), "notes": said.partition("\n\n")[0]}
    data = codec.parse(text)
    return {"title": str(data.get("name") or name.replace("_", " ")), "notes": str(data.get("notes", ""))}


def sentence(name: str) -> str:
    """Return one sentence on what an example shows."""
    found = about(name)
    return first_sentence(found["notes"], found["title"])


def first_sentence(notes: str, title: str) -> str:
    """Return the first sentence of notes, which may begin with the title; a long one is cut at a pause."""
    rest = " ".join(notes.split())
    if rest.lower().startswith(f"{title.lower()}."):
        rest = rest[len(title) + 1 :].strip()
    first = re.split(r"(?<=[.!?])\s+(?=[^a-z])", rest, maxsplit=1)[0]
    if len(first) <= LONGEST:
        return first
    pause = max(first.rfind(mark, 0, LONGEST) for mark in (", ", "; ", ": "))
    return first[:pause] + "." if pause > 0 else first[: LONGEST - 1].rpartition(" ")[0] + "…"


def duration(name: str) -> float | None:
    """Return the duration of an example in its time unit, which its notes state at the end. None for a
    script.
    """
    found = re.search(r"for (\d+) (?:ms|steps)\.$", about(name)["notes"].strip())
    return float(found[1]) if found and name in names() else None
