"""Mutations of the content of a file: of its bytes, words, JSON or XML, and of the entries of an archive.

Every mutation follows from a `random.Random`. Some are of the bytes alone, and some grow a small file into
one that asks for much: nested deeply, repeated, or with numbers of sizes up to 10^12.
"""

from __future__ import annotations

import copy
import hashlib
import io
import json
import random
import re
import struct
import zipfile
import zlib
from collections.abc import Callable, Sequence
from typing import Any
from xml.etree import ElementTree

from deodar import codec
from tests.attacks.documents import STRANGE, places
from tests.attacks.seeds import MARK

Draw = random.Random

CODE = (f"__import__('os').system('touch {MARK}')", "payload:run", f"; system('touch {MARK}'); ")
"""Texts that leave the mark where they are run, or imported."""

OUTSIDE = (f"../{MARK}", f"../../{MARK}", f"/tmp/{MARK}", f"..\\{MARK}", "../../../../../../etc/passwd")
"""Names of files outside of the folder of a file."""

NUMBERS = (
    *("0", "-1", "1", "2", "3", "7", "255", "65536", "100000", "1000000", "2147483648", "4294967295"),
    *("1000000000", "1000000000000", "9223372036854775808", "-9223372036854775809", "1" + "0" * 400),
    *("1e308", "-1e308", "1e309", "1e-320", "5e-324", "-0.0", "nan", "NaN", "inf", "-Infinity", "0.5", "1e9"),
)
"""What numbers in a text are replaced with."""

VALUES: tuple[Any, ...] = (
    *STRANGE,
    *CODE,
    *OUTSIDE,
    *(
        2,
        3,
        7,
        1000,
        100_000,
        10**6,
        10**9,
        10**12,
        1e9,
        1e12,
        [10**5, 10**5],
        [10**9],
        [0, 0],
        [[1, 2], [3]],
    ),
    *("a" * 100_000, "." * 10_000, "\ud800", "_NaN_", {"x": {}}, [[[[]]]], "../" * 2000),
)
"""What values of JSON are replaced with."""

WORDS = (
    struct.Struct("<I"),
    struct.Struct(">I"),
    struct.Struct("<Q"),
    struct.Struct(">H"),
    struct.Struct("<B"),
)
EDGES = (
    0,
    1,
    0x7F,
    0x80,
    0xFF,
    0x7FFF,
    0xFFFF,
    100_000,
    10**9,
    2**31 - 1,
    2**31,
    2**32 - 1,
    2**63,
    2**64 - 1,
)

GROWN = 2**21
"""Largest number of bytes that a mutation adds by repeating."""

MOST_CHANGED = 300_000
"""Largest number of bytes of which more is changed."""

DEPTHS = (10, 70, 1000, 10_000, 100_000)
COUNTS = (2, 10, 1000, 30_000, 300_000)


# ------------------------------------------------------------------------------------------------------ bytes


def _block(draw: Draw, content: bytes) -> slice:
    start = draw.randrange(len(content))
    return slice(start, start + 1 + min(draw.randrange(len(content)), int(draw.expovariate(1 / 16))))


def _flip(draw: Draw, content: bytes, others: Sequence[bytes]) -> bytes:
    flipped = bytearray(content)
    for _ in range(draw.choice((1, 1, 2, 8, 32))):
        flipped[draw.randrange(len(flipped))] ^= 1 << draw.randrange(8)
    return bytes(flipped)


def _replace(draw: Draw, content: bytes, others: Sequence[bytes]) -> bytes:
    at = _block(draw, content)
    return content[: at.start] + draw.randbytes(at.stop - at.start) + content[at.stop :]


def _delete(draw: Draw, content: bytes, others: Sequence[bytes]) -> bytes:
    at = _block(draw, content)
    return content[: at.start] + content[at.stop :]


def _repeat(draw: Draw, content: bytes, others: Sequence[bytes]) -> bytes:
    block = content[_block(draw, content)]
    at = draw.randrange(len(content) + 1)
    return content[:at] + block * min(draw.choice(COUNTS), GROWN // len(block)) + content[at:]


def _splice(draw: Draw, content: bytes, others: Sequence[bytes]) -> bytes:
    source = draw.choice(others) or b"\0"
    at = draw.randrange(len(content) + 1)
    return content[:at] + source[draw.randrange(len(source)) :]


def _cut(draw: Draw, content: bytes, others: Sequence[bytes]) -> bytes:
    return content[: draw.randrange(len(content))]


def _word(draw: Draw, content: bytes, others: Sequence[bytes]) -> bytes:
    word, at = draw.choice(WORDS), draw.randrange(len(content))
    edge = draw.choice(EDGES) % 2 ** (8 * word.size)
    return content[:at] + word.pack(edge) + content[at + word.size :]


BYTES = (_flip, _flip, _replace, _delete, _repeat, _splice, _cut, _word, _word, _word)


# ------------------------------------------------------------------------------------------------------ words

_NUMBER = re.compile(rb"(?<![\w.])-?\d+(?:\.\d*)?(?:[eE][-+]?\d+)?")
_NAME = re.compile(rb"[A-Za-z_][\w.]*")
_OPEN, _CLOSE = b"([{<'\"", {"(": b")", "[": b"]", "{": b"}", "<": b">", "'": b"'", '"': b'"'}


def _some(draw: Draw, pattern: re.Pattern[bytes], content: bytes) -> slice:
    """Return the place of a match, or of a block where there is none."""
    spans = [match.span() for match in pattern.finditer(content)]
    return slice(*draw.choice(spans)) if spans else _block(draw, content)


def _numbers(draw: Draw, content: bytes, others: Sequence[bytes]) -> bytes:
    for _ in range(draw.choice((1, 1, 1, 2, 5))):
        at = _some(draw, _NUMBER, content or b" ")
        content = content[: at.start] + draw.choice(NUMBERS).encode() + content[at.stop :]
    return content


def _names(draw: Draw, content: bytes, others: Sequence[bytes]) -> bytes:
    """Put a name of this or another file, code, or a long text in the place of a name."""
    from_ = draw.choice((content, draw.choice(others))) or b"x"
    words = (
        from_[_some(draw, _NAME, from_)],
        draw.choice((*CODE, *OUTSIDE)).encode(),
        b"a" * draw.choice(DEPTHS),
    )
    at = _some(draw, _NAME, content)
    return content[: at.start] + draw.choice(words) + content[at.stop :]


def _lines(draw: Draw, content: bytes, others: Sequence[bytes]) -> bytes:
    lines = content.split(b"\n")
    source = draw.choice((lines, draw.choice(others).split(b"\n")))
    at, line = draw.randrange(len(lines)), draw.choice(source)
    match draw.randrange(4):
        case 0:
            del lines[at]
        case 1:
            lines.insert(at, line)
        case 2:
            lines[at] = line
        case _:
            lines[at:at] = [line] * min(draw.choice(COUNTS), GROWN // (len(line) + 1))
    return b"\n".join(lines)


def _nest(draw: Draw, content: bytes, others: Sequence[bytes]) -> bytes:
    """Repeat a bracket, or a number or name in brackets, many times inside itself."""
    depth = draw.choice(DEPTHS)
    at = _some(draw, draw.choice((_NUMBER, _NAME)), content)
    bracket = draw.choice("([{-~!<'")
    before = bracket.encode()
    after = _CLOSE.get(bracket, b"")
    if bracket == "{" and draw.random() < 0.5:
        before = b'{"a":'
    whole = content[at] if draw.random() < 0.8 else b""
    return content[: at.start] + before * depth + whole + after * depth + content[at.stop :]


TEXT = (_numbers, _numbers, _numbers, _names, _names, _lines, _lines, _nest)


# -------------------------------------------------------------------------------------------------- structure


def _inside(tree: Any, at: tuple[Any, ...]) -> Any:
    for key in at:
        tree = tree[key]
    return tree


WAYS = ("replace", "replace", "replace", "size", "remove", "swap", "rename", "copy", "grow", "nest")
"""What is done with a value of JSON."""

XML_WAYS = ("attribute", "attribute", "number", "number", "remove", "tag", "copy", "grow", "nest", "file")
"""What is done with an element of XML."""


def _nested(draw: Draw, branch: Any) -> str:
    depth, text = draw.choice(DEPTHS), json.dumps(branch)
    before, after = draw.choice((("[", "]"), ('{"x":', "}"), ('[0,{"kind":', "}]")))
    return before * depth + text + after * depth


def _json_values(draw: Draw, change: str, tree: Any, at: tuple[Any, ...]) -> str | None:
    """Change the value at a place; return the text that stands for it where it is not plain JSON."""
    *above, last = at
    parent = _inside(tree, tuple(above))
    match change:
        case "remove":
            del parent[last]
        case "swap" if len(parent) > 1:
            place = draw.choice(list(parent) if isinstance(parent, dict) else range(len(parent)))
            parent[last], parent[place] = parent[place], parent[last]
        case "rename" if isinstance(parent, dict):
            name = draw.choice((f"{last}x", "", "kind", "name", str(draw.choice([*parent])), "__class__"))
            parent[name] = parent.pop(last)
        case "copy":
            parent[last] = copy.deepcopy(_inside(tree, draw.choice(places(tree))))
        case "grow":
            branch = parent[last]
            size = max(1, len(json.dumps(branch)))
            count = min(draw.choice(COUNTS), GROWN // size)
            grown = (
                {f"{last}{k}": branch for k in range(count)} if isinstance(branch, dict) else [branch] * count
            )
            parent[last] = branch * count if isinstance(branch, (str, list)) and size > 2 else grown
        case "nest":
            text, parent[last] = _nested(draw, parent[last]), "\0nested"
            return text
        case "size" if isinstance(parent[last], (int, float)):
            parent[last] = draw.choice((10**5, 10**6, 10**9, 10**12, -1, 0, 1e9, 1e308, 2**31, 1e-300))
        case _:
            parent[last] = copy.deepcopy(draw.choice(VALUES))
    return None


def _json(draw: Draw, content: bytes, others: Sequence[bytes]) -> bytes:
    try:
        tree = codec.parse(content)
    except ValueError:
        return _numbers(draw, content, others)
    nested = None
    for _ in range(draw.choice((1, 1, 2, 3, 8))):
        below = [place for place in places(tree) if place]
        if not below or len(json.dumps(tree)) > MOST_CHANGED:
            break
        change = draw.choice(WAYS)
        nested = _json_values(draw, change, tree, draw.choice(below))
        if change in ("grow", "nest"):
            break  # what is grown is the same object many times
    text = json.dumps(tree)
    if nested is not None:
        text = text.replace('"\\u0000nested"', nested, 1)
    return text.encode("utf-8", "surrogatepass")


BOMB = "".join(f'<!ENTITY e{k} "{f"&e{k - 1};" * 10}">' for k in range(1, 12))
DOCTYPE = f'<!DOCTYPE x [<!ENTITY e0 "0 0 0 0 0 ">{BOMB}<!ENTITY file SYSTEM "file:///etc/passwd">]>'


NESTED = "nested"
"""Tag of the element in whose place others lie inside each other."""


def _xml(draw: Draw, content: bytes, others: Sequence[bytes]) -> bytes:
    try:
        root = ElementTree.fromstring(content)
        ElementTree.tostring(root)
    except (ElementTree.ParseError, RecursionError):
        return _numbers(draw, content, others)
    parents = {child: parent for parent in root.iter() for child in parent}
    for _ in range(draw.choice((1, 1, 2, 4))):
        nodes = list(root.iter())
        if len(ElementTree.tostring(root)) > MOST_CHANGED:
            break
        node = draw.choice(nodes)
        name = draw.choice(list(node.attrib) or ["name"])
        match draw.choice(XML_WAYS):
            case "attribute":
                node.set(name, draw.choice((*CODE, *OUTSIDE, "&e11;", "a" * 100_000, "", "0 0 0")))
            case "number":
                words = node.get(name, "1").split() or [""]
                words[draw.randrange(len(words))] = draw.choice(NUMBERS)
                node.set(name, " ".join(words))
            case "remove":
                node.attrib.pop(name, None)
            case "tag":
                node.tag = draw.choice(list(root.iter())).tag
            case "file":
                node.append(ElementTree.Element("include", file=draw.choice((*OUTSIDE, "scene.xml"))))
            case "copy":
                node.append(copy.deepcopy(draw.choice(list(parents) or [root])))
            case "grow":
                node.extend([copy.deepcopy(draw.choice(list(parents) or [root])) for _ in range(200)])
            case _:
                node.append(ElementTree.Element(NESTED))
                break
    tag, depth = draw.choice(("body", root.tag)), draw.choice(DEPTHS)
    text = ElementTree.tostring(root, encoding="unicode")
    text = text.replace(f"<{NESTED} />", f"<{tag}>" * depth + f"</{tag}>" * depth)
    if draw.random() < 0.1:
        text = DOCTYPE + text.replace("&amp;", "&")
    return text.encode("utf-8", "surrogatepass")


def _zip(draw: Draw, content: bytes, others: Sequence[bytes]) -> bytes:
    """Change an entry of an archive, or the archive around its entries, and write sound checksums."""
    try:
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            entries = {entry.filename: archive.read(entry) for entry in archive.infolist()}
    except (zipfile.BadZipFile, NotImplementedError, zlib.error, EOFError):
        return _word(draw, content, others)
    names = list(entries)
    name = draw.choice(names) if names else "x.json"
    match draw.randrange(8):
        case 0:
            entries[draw.choice(OUTSIDE)] = entries.pop(name, b"x")
        case 1:
            entries.pop(name, None)
        case 2:
            entries[draw.choice((*names, "more.json"))] = draw.choice(others)
        case 3:
            entries[name] = draw.choice((b"{},", b"0", b"\0", b"[")) * draw.choice((10**6, 3 * 10**7))
        case _:
            entries[name] = damaged(draw, name, entries.get(name, b"") or b"\0", others)
    if draw.random() < 0.9:
        state_checksums(entries)
    changed = io.BytesIO()
    with zipfile.ZipFile(changed, "w") as archive:
        for entry, inner in entries.items():
            archive.writestr(zipfile.ZipInfo(entry), inner, zipfile.ZIP_DEFLATED, 1)
    return changed.getvalue()


def state_checksums(entries: dict[str, bytes]) -> None:
    """State the size and SHA-256 of files where a document or the contents of a package name them."""
    for name in sorted(entries, key=lambda name: name == "contents.json"):
        try:
            tree = codec.parse(entries[name]) if name.endswith(".json") else None
        except ValueError:
            continue
        match tree:
            case {"deodar_package": _, "files": dict(files)}:
                for file in files.keys() & entries.keys():
                    digest = hashlib.sha256(entries[file]).hexdigest()
                    files[file] = {"size": len(entries[file]), "sha256": digest}
            case {"arrays": {"file": str(file), **more_keys}} if file in entries:
                tree["arrays"] = {
                    **more_keys,
                    "file": file,
                    "sha256": hashlib.sha256(entries[file]).hexdigest(),
                }
            case _:
                continue
        entries[name] = json.dumps(tree).encode("utf-8", "surrogatepass")


Mutation = Callable[[Draw, bytes, Sequence[bytes]], bytes]

STRUCTURES: dict[str, Sequence[Mutation]] = {
    ".json": (_json, _json, _json),
    ".dnf": (_json, _json, _json),
    ".data": (_json,),
    ".jsonl": (),
    ".m": (),
    ".csv": (),
    ".txt": (),
    ".toml": (),
    ".yaml": (),
    ".xml": (_xml, _xml, _xml),
    ".urdf": (_xml, _xml, _xml),
}
"""What is done with texts of an ending besides words."""


def damaged(draw: Draw, name: str, content: bytes, others: Sequence[bytes]) -> bytes:
    """Return the content of a file after one to three mutations of the kinds that suit its name.

    Args:
        draw: the source of every choice.
        name: the name of the file.
        content: its content, at least one byte.
        others: contents of other files, of which parts are put into it.
    """
    ending = name[name.rfind(".") :]
    if content[:4] == b"PK\3\4" and draw.random() < 0.7:
        return _zip(draw, content, others)
    text = ending in STRUCTURES
    structures = STRUCTURES.get(ending, ())
    for _ in range(draw.choice((1, 1, 1, 2, 3))):
        if len(content) > MOST_CHANGED:
            break
        kinds: Sequence[Mutation] = BYTES
        if text and draw.random() < 0.85:
            kinds = structures if structures and draw.random() < 0.6 else TEXT
        content = draw.choice(kinds)(draw, content, others) or b"\n"
    return content
