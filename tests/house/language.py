"""The prose of the repository, and the phrases of `docs/words.toml` in it.

python -m tests.house.language         the number of phrases in each part, as `known` of docs/words.toml
python -m tests.house.language PART    every phrase in a part, with its line
"""

from __future__ import annotations

import functools
import re
import sys
import tomllib
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from tests.house.source import ROOT, texts

WORDS = tomllib.loads((ROOT / "docs" / "words.toml").read_text(encoding="utf-8"))
KNOWN: dict[str, int] = WORDS["known"]

GENERATED = {"protocol.ts"}
PYTHON = re.compile(r'#[^\n]*|"""(?:.*?)"""|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])*\'', re.DOTALL)
SCRIPT = re.compile(
    r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"|`(?:\\.|[^`\\])*`|\'(?:\\.|[^\'\\\n])*\'|>[^<>{}=;]*<', re.DOTALL
)
HOLE = re.compile(r"\$\{[^{}]*\}")
STYLE = re.compile(r"/\*.*?\*/", re.DOTALL)
FENCE = re.compile(
    r"^```.*?^```$|^<!-- arguments of .*?^<!-- end of |<!-- evidence .*?<!-- end -->|`[^`]*`|\]\([^)\s]*\)",
    re.M | re.S,
)
TAGS = re.compile(r'^[^\S\n]*(?:#|//|\*)|["\'`]', re.MULTILINE)


@dataclass(frozen=True)
class Word:
    """A phrase that the prose does not use, and what to write instead."""

    wrong: str
    right: str

    @functools.cached_property
    def pattern(self) -> re.Pattern[str]:
        """A pattern of the phrase as whole words, across line ends; a word after a dot is an attribute of
        code.
        """
        body = r"\s+".join(re.escape(part) for part in self.wrong.split())
        end = r"(?![\w-])" if self.wrong[-1].isalnum() else ""
        return re.compile(rf"(?<![\w-])(?<!\w\.){body}{end}", re.IGNORECASE)


@dataclass(frozen=True)
class Found:
    """A phrase in a file."""

    path: Path
    line: int
    word: Word

    def __str__(self) -> str:
        place = f"{self.path.relative_to(ROOT).as_posix()}:{self.line}"
        return f"{place}: {self.word.wrong!r}: write {self.word.right}"


def words() -> list[Word]:
    """Return the phrases of the list."""
    return [Word(wrong, entry["right"]) for entry in WORDS["words"] for wrong in entry["wrong"]]


def prose(name: str, text: str) -> str:
    """Return the prose of a file, with everything else blank; lines keep their numbers."""
    match Path(name).suffix:
        case ".py" | ".pyi":
            return TAGS.sub(" ", _kept(PYTHON, text))
        case ".ts" | ".tsx":
            return TAGS.sub(" ", HOLE.sub(" ", _kept(SCRIPT, text)))
        case ".css":
            return _kept(STYLE, text)
        case _:
            if Path(name).name == "CHANGELOG.md":
                head, unreleased = text.split("\n## [", 2)[:2]
                text = "\n" * (head.count("\n") + 1) + unreleased
            return FENCE.sub(lambda found: _blank(found[0]), text)


def _blank(text: str) -> str:
    return "\n" * text.count("\n") or " "


def _kept(pattern: re.Pattern[str], text: str) -> str:
    parts: list[str] = []
    end = 0
    for found in pattern.finditer(text):
        parts += [_blank(text[end : found.start()]), found[0]]
        end = found.end()
    return "".join(parts)


def search(path: Path, text: str, listed: list[Word]) -> Iterator[Found]:
    """Yield the phrases in the text of a file."""
    body = prose(path.name, text)
    plain = " ".join(body.lower().split())
    for word in listed:
        if word.wrong in plain:
            for found in word.pattern.finditer(body):
                yield Found(path, body.count("\n", 0, found.start()) + 1, word)


def part(path: Path) -> str:
    """Return the part of the repository that a file belongs to: a package of `src`, a folder, or the file
    itself.
    """
    names = path.relative_to(ROOT).parts
    if names[:2] == ("src", "deodar"):
        return "/".join(names[: 3 if len(names) > 3 else 2])
    return names[0] if len(names) > 1 and names[0] != "docs" else "/".join(names)


def checked() -> list[Path]:
    """Return the files whose prose is checked."""
    return [path for path in texts() if _is_checked(path)]


def _is_checked(path: Path) -> bool:
    names = path.relative_to(ROOT).parts
    if path.name in GENERATED or names[:2] == ("docs", "reference"):
        return False
    match names[0]:
        case "src" | "examples" | "tests" | "benchmarks" | "tools":
            return path.suffix in {".py", ".pyi", ".md"} and path.name != "test_language.py"
        case "studio":
            return path.suffix in {".ts", ".tsx", ".css"}
        case "docs":
            return path.suffix in {".md", ".py"}
        case _:
            return len(names) == 1 and path.suffix == ".md"


@functools.cache
def found() -> list[Found]:
    """Return every phrase of the list in the repository."""
    listed = words()
    return [hit for path in checked() for hit in search(path, path.read_text(encoding="utf-8"), listed)]


def counts() -> dict[str, int]:
    """Return the number of phrases in each part that has any."""
    return dict(sorted(Counter(part(hit.path) for hit in found()).items()))


if __name__ == "__main__":
    if sys.argv[1:]:
        lines = [str(hit) for hit in found() if part(hit.path) in sys.argv[1:]]
    else:
        lines = ["[known]", *(f'"{name}" = {number}' for name, number in counts().items())]
    sys.stdout.write("\n".join([*lines, ""]))
