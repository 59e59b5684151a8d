"""The pages as programs: their blocks of Python and of commands, run in order, and what they print compared
with the page.

Blocks of one page share their names and one folder. A `text` block right after a `python` block holds what it
prints. A block with a title, ```` ```toml title="figure.toml" ````, is written to the file of that name. In a
`console` block a line that begins with `$` is a command, the lines after it what it answers; one with a title
is not run here. A line `...` stands for any lines, and `...` in a line for any words; numbers agree to two
percent, since machines differ in the last digits.
"""

from __future__ import annotations

import contextlib
import io
import os
import re
import shlex
import shutil
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

DOCS = Path(__file__).parent
ROOT = DOCS.parent
FENCE = re.compile(r"^```(\w+)([^\n]*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
TITLE = re.compile(r'title="([\w.-]+)"')
PICTURE = re.compile(r"""(?:!\[[^\]]*\]\(|src="|srcset=")(?:[\w./]*/)?pictures/([\w.-]+)[)"]""")
NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:e[+-]?\d+)?")
NEAR = 0.02


@dataclass(frozen=True)
class Block:
    """A block to run: its place, its language, its text, and its output (None: not stated).

    Of a block that is written to a file, the language is `file` and the output the name of the file.
    """

    page: Path
    line: int
    language: str
    text: str
    prints: str | None = None

    @property
    def where(self) -> str:
        """File and line."""
        return f"{self.page.relative_to(ROOT)}:{self.line}"


def pages() -> list[Path]:
    """Every page with something to run."""
    found = [ROOT / "README.md", *sorted(DOCS.glob("*.md"))]
    return [page for page in found if blocks(page)]


def blocks(page: Path) -> list[Block]:
    """The blocks of a page that run: Python, and each command of a console block."""
    text = page.read_text(encoding="utf-8")
    out: list[Block] = []
    end = -1
    for found in FENCE.finditer(text):
        language, rest, body = found.groups()
        title = TITLE.search(rest)
        line = text.count("\n", 0, found.start()) + 2
        if title is not None and language == "console":
            continue  # what another user types, run by a test of its own
        if title is not None:
            out.append(Block(page, line, "file", body, title.group(1)))
        elif language == "python":
            out.append(Block(page, line, language, body))
        elif language == "console":
            out += _commands(page, line, body)
        elif (
            language == "text"
            and out
            and out[-1].language == "python"
            and not text[end : found.start()].strip()
        ):
            last = out.pop()
            out.append(Block(page, last.line, last.language, last.text, body))
        end = found.end()
    return out


def _commands(page: Path, line: int, body: str) -> Iterator[Block]:
    for part in re.split(r"^(?=\$ )", body, flags=re.MULTILINE):
        if part.startswith("$ "):
            command, _, answer = part[2:].partition("\n")
            yield Block(page, line, "command", command, answer if answer.strip() else None)
        line += part.count("\n")


def run(page: Path, folder: Path) -> list[str]:
    """Run a page in an empty folder, beside the examples; the names of the pictures it wrote there.

    Raises:
        AssertionError: where what is printed is not what the page says, or a command fails.
    """
    import matplotlib

    names: dict[str, Any] = {"__name__": "__page__"}
    shutil.copytree(ROOT / "examples", folder / "examples")
    # a page sets the style for itself alone
    with contextlib.chdir(folder), matplotlib.rc_context(), _importable(folder):
        for block in blocks(page):
            if block.language == "file":
                (folder / str(block.prints)).write_text(block.text, encoding="utf-8")
                continue
            printed = io.StringIO()
            with contextlib.redirect_stdout(printed):
                _run(block, names)
            if block.prints is not None:
                differs = difference(block.prints, printed.getvalue())
                assert not differs, f"{block.where}: {differs}\n--- printed:\n{printed.getvalue()}"
    return sorted(p.name for p in drawn(folder))


@contextlib.contextmanager
def _importable(folder: Path) -> Iterator[None]:
    """Let modules of a folder be imported, as a script in it does, and forget them afterwards."""
    before = set(sys.modules)
    sys.path.insert(0, str(folder))
    try:
        yield
    finally:
        sys.path.remove(str(folder))
        for name in set(sys.modules) - before:
            if str(getattr(sys.modules[name], "__file__", "")).startswith(f"{folder}{os.sep}"):
                del sys.modules[name]


def drawn(folder: Path) -> list[Path]:
    """The pictures that a page wrote into its folder; those of the examples beside it are the gallery's."""
    found = [path for ending in ("png", "svg") for path in folder.rglob(f"*.{ending}")]
    return [path for path in found if "examples" not in path.relative_to(folder).parts]


def _run(block: Block, names: dict[str, Any]) -> None:
    if block.language == "python":
        exec(compile("\n" * (block.line - 1) + block.text, str(block.page), "exec", dont_inherit=True), names)
        return
    from deodar import cli

    words = shlex.split(block.text)
    assert words[0] == "deodar", (
        f"{block.where}: a console block holds commands of deodar; use an sh block for other words"
    )
    told = io.StringIO()
    with contextlib.redirect_stderr(told):
        status = cli.main(words[1:])
    assert status == 0, f"{block.where}: status {status}: {told.getvalue()}"


def difference(expected: str, printed: str) -> str:
    """The first line that is not as the page has it; empty where all agree."""
    lines = [line.rstrip() for line in printed.splitlines() if line.strip()]
    at, skipping = 0, False
    for line in (line.rstrip() for line in expected.splitlines() if line.strip()):
        if line.strip() == "...":
            skipping = True
            continue
        while skipping and at < len(lines) and not same(line, lines[at]):
            at += 1
        if at >= len(lines):
            return f"{line!r} was not printed"
        if not same(line, lines[at]):
            return f"{line!r} on the page, {lines[at]!r} printed"
        at, skipping = at + 1, False
    return "" if skipping or at == len(lines) else f"{lines[at]!r} is not on the page"


def same(line: str, other: str) -> bool:
    """Whether two lines agree in their words, and in their numbers to two percent."""
    if "..." in line:
        return re.fullmatch(re.escape(line).replace(r"\.\.\.", ".*"), other) is not None
    a, b = [[float(n) for n in NUMBER.findall(text)] for text in (line, other)]
    words = [" ".join(NUMBER.sub("#", text).split()) for text in (line, other)]
    return words[0] == words[1] and all(
        abs(p - q) <= NEAR * max(abs(p), abs(q)) for p, q in zip(a, b, strict=True)
    )


def pictures(page: Path) -> list[str]:
    """Names of the pictures a page shows."""
    return PICTURE.findall(page.read_text(encoding="utf-8"))


@contextlib.contextmanager
def quiet() -> Iterator[None]:
    """Without a display, and without the colours of a terminal."""
    kept = dict(os.environ)
    os.environ.update({"MPLBACKEND": "Agg", "NO_COLOR": "1", "COLUMNS": "120"})
    try:
        yield
    finally:
        os.environ.clear()
        os.environ.update(kept)
