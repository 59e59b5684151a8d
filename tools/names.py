"""Names that say only how a value came, or that it is one (`found`, `own`, `result`), counted in each folder.

    python tools/names.py                 compare with tools/names.csv, of which no number may rise
    python tools/names.py --where PATH    list the places
    python tools/names.py --write         lower the numbers that have fallen

A name offends if it is one of WORDS as a whole: `found_peaks` says of what. `left` is content beside `right`:
a word of PAIRS is free where its partner is named in the same function or class. The exit status is 1 if a
folder has more than its number.
"""

from __future__ import annotations

import argparse
import ast
import csv
import sys
from collections import Counter, defaultdict
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
LIMITS = Path(__file__).with_name("names.csv")
ROOTS = ("src", "tests", "tools", "benchmarks")

HOW_IT_CAME = """
found given made own said told here there now asked known wanted kept shown held away like each one other both
near left rest more way what how about again
"""
OF_ANYTHING = "result results res value data item obj thing"
WORDS = frozenset(f"{HOW_IT_CAME} {OF_ANYTHING}".split())
PAIRS = {
    "left": "right",
    "near": "far",
    "rest": "peak",
    "one": "two",
    "other": "one",
    "shown": "hidden",
    "found": "lost",
    "known": "unknown",
}

FUNCTIONS = (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)


@dataclass(frozen=True)
class Name:
    """A name that a file gives to something.

    Attributes:
        line: where it is given.
        text: the name.
        scope: number of the innermost function or class around it.
    """

    line: int
    text: str
    scope: int

    @property
    def word(self) -> str:
        """The name without the marks of a private one."""
        return self.text.strip("_")


def names(tree: ast.AST) -> list[Name]:
    """Return every name of a variable, parameter, attribute, function or class that a file gives."""
    scopes = 0

    def visit(node: ast.AST, scope: int) -> Iterator[Name]:
        nonlocal scopes
        for child in ast.iter_child_nodes(node):
            inner = scope
            match child:
                case ast.FunctionDef(name=text) | ast.AsyncFunctionDef(name=text) | ast.ClassDef(name=text):
                    yield Name(child.lineno, text, scope)
                case ast.Name(id=text, ctx=ast.Store()) | ast.Attribute(attr=text, ctx=ast.Store()):
                    yield Name(child.lineno, text, scope)
                case ast.arg(arg=text):
                    yield Name(child.lineno, text, scope)
                case _:
                    pass
            if isinstance(child, (*FUNCTIONS, ast.Lambda)):
                scopes += 1
                inner = scopes
            yield from visit(child, inner)

    return list(visit(tree, 0))


def offenders(text: str) -> list[Name]:
    """Return the names of a file that say nothing of what they name."""
    every = names(ast.parse(text))
    words: dict[int, set[str]] = defaultdict(set)
    for name in every:
        words[name.scope].add(name.word)
    return [n for n in every if n.word in WORDS and PAIRS.get(n.word) not in words[n.scope]]


def folder(path: Path) -> str:
    """Return the folder by which a file is counted: two levels below `src` and `tests`, else the first."""
    parts = path.relative_to(ROOT).parts[:-1]
    return "/".join(parts[: 3 if parts[0] in ("src", "tests") else 1])


def files() -> list[Path]:
    """Return the Python files that are counted."""
    return sorted(path for root in ROOTS for path in (ROOT / root).rglob("*.py"))


def counted() -> Counter[str]:
    """Return the number of such names in each folder, also where there are none."""
    counts: Counter[str] = Counter()
    for path in files():
        counts[folder(path)] += len(offenders(path.read_text(encoding="utf-8")))
    return counts


def limits(file: Path = LIMITS) -> dict[str, int]:
    """Return the number that each folder may have; a folder without a row may have none."""
    with file.open(encoding="utf-8", newline="") as text:
        return {row["folder"]: int(row["names"]) for row in csv.DictReader(text)}


def write(numbers: dict[str, int], file: Path = LIMITS) -> None:
    """Write the numbers of the folders that have such names."""
    with file.open("w", encoding="utf-8", newline="") as text:
        out = csv.writer(text, lineterminator="\n")
        out.writerow(("folder", "names"))
        out.writerows((name, number) for name, number in sorted(numbers.items()) if number)


def main() -> int:
    """Print the folders with too many, or the places."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--where", metavar="PATH", type=Path, help="list the places below a path")
    parser.add_argument("--write", action="store_true", help="lower the numbers that have fallen")
    given = parser.parse_args()
    if given.where:
        for path in files():
            if path.is_relative_to(given.where.resolve()):
                for name in offenders(path.read_text(encoding="utf-8")):
                    print(f"{path.relative_to(ROOT)}:{name.line}: {name.text}")
        return 0
    counts, most = counted(), limits()
    if given.write:
        write({name: min(count, most.get(name, 0)) for name, count in counts.items()})
    over = {name: count for name, count in counts.items() if count > most.get(name, 0)}
    for name, count in sorted(over.items()):
        print(f"{name}: {count} names that say only how a value came, {most.get(name, 0)} are allowed")
    print(f"{sum(counts.values())} such names in {len(counts)} folders, {sum(most.values())} are allowed")
    if over:
        print("See where: python tools/names.py --where FOLDER. Name what the value is.")
    return int(bool(over))


if __name__ == "__main__":
    sys.exit(main())
