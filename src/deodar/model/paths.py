"""Names and paths: `group.element.port`, `group.element.parameter`.

Names may be any text. In a path a name may be written without quotation marks where that is unambiguous;
`quote` gives a form that always is. Texts that Unicode counts as equal are one name: an accent may be a
character of its own (NFD, as file names of macOS have it) or part of its letter (NFC).
"""

from __future__ import annotations

import dataclasses as dc
import hashlib
from collections.abc import Collection, Iterable, Mapping, Sequence

from deodar import codec
from deodar.codec import composed
from deodar.errors import UnknownName

PathNames = tuple[str, ...]


def quote(name: str) -> str:
    """Return the safe form of a name in a path: plain identifiers unchanged, others in double quotes.

    >>> quote("u")
    'u'
    >>> quote("u -> u (global)")
    '"u -> u (global)"'
    """
    return name if name.isidentifier() else codec.line(name)


def display(names: Sequence[str]) -> str:
    """Return the path of an element as messages, records and documents write it."""
    return ".".join(quote(n) if ("." in n or '"' in n or n == "") else n for n in names)


def split(path: str) -> PathNames:
    """Return the names of a path; a quoted name is not split."""
    names: list[str] = []
    at = 0
    while at <= len(path):
        if path[at : at + 1] == '"':
            try:
                name, end = codec.leading(path, at)
            except ValueError:
                raise UnknownName(f"the path {path!r} opens a quotation mark and never closes it") from None
            if end < len(path) and path[end] != ".":
                raise UnknownName(f"the path {path!r} has text between a quoted name and the next dot")
        else:
            end = path.find(".", at)
            end = len(path) if end < 0 else end
            name = path[at:end]
        names.append(str(name))
        at = end + 1
    return tuple(names)


def as_taken(names: PathNames, taken: Collection[PathNames]) -> PathNames | None:
    """Return names as `taken` has them, which may write accents in another way; None: it lacks them."""
    if names in taken or all(map(str.isascii, names)):
        return names if names in taken else None
    letters = tuple(map(composed, names))
    if letters in taken:
        return letters
    return next((n for n in taken if len(n) == len(letters) and tuple(map(composed, n)) == letters), None)


@dc.dataclass(frozen=True)
class Index:
    """Names that paths may begin with, indexed for many look-ups.

    Attributes:
        names: all of them.
        texts: each name joined by dots without quotation marks and composed, with its position in `names`.
        depth: largest number of parts of a name.
        longest: largest number of characters of a text.
    """

    names: Collection[PathNames]
    texts: Mapping[str, Sequence[tuple[int, PathNames]]]
    depth: int
    longest: int

    @classmethod
    def of(cls, names: Collection[PathNames]) -> Index:
        """Return the index of names."""
        texts: dict[str, list[tuple[int, PathNames]]] = {}
        for k, parts in enumerate(names):
            texts.setdefault(composed(".".join(parts)), []).append((k, parts))
        return cls(names, texts, max(map(len, names), default=0), max(map(len, texts), default=0))


def readings(path: str, index: Index) -> list[tuple[PathNames, str]]:
    """Return every way to read `path` as a known name followed by a rest, the quoted reading first."""
    matches: list[tuple[PathNames, str]] = []
    path = composed(path)
    parts = split(path)
    for k in range(min(len(parts), index.depth), 0, -1):
        if (names := as_taken(parts[:k], index.names)) is not None:
            matches.append((names, ".".join(quote(p) if not p.isdigit() else p for p in parts[k:])))
    ends = [k for k, c in enumerate(path[: index.longest + 1]) if c == "."]
    for _, names in sorted(hit for end in [*ends, len(path)] for hit in index.texts.get(path[:end], ())):
        if not any(names == f[0] for f in matches):
            matches.append((names, path[len(composed(".".join(names))) + 1 :]))
    return matches


def stored_id(path: str, taken: Iterable[str]) -> str:
    """Return eight hex digits: a hash of the path an element was created under.

    Rename, grouping and moves preserve the id.

    The same script gives the same ids in any order of declaration; ids key the noise.
    """
    used = taken if isinstance(taken, (set, frozenset, Mapping)) else set(taken)
    n = 0
    while True:
        text = path if n == 0 else f"{path}#{n}"
        ident = hashlib.blake2b(text.encode(), digest_size=4).hexdigest()
        if ident not in used:
            return ident
        n += 1
