"""What an error says to do fits its reader: options of a shell are in the words for a shell alone."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator

import pytest

from tests.house.source import ROOT

OPTION = re.compile(r"--[a-z]")
COMMAND = re.compile(r"\b(pip install|dask worker|deodar [a-z]+) [^,;()]*")
"""A whole command, which readers of a script may type, too."""

FOR_SHELLS = ("/cli/", "/commands/", "/web/", "cli.py")
"""Parts of the paths of files whose errors only commands raise."""


def words(node: ast.expr) -> str:
    """Return the text of a literal, of all parts of an f-string, and of a choice."""
    return " ".join(str(n.value) for n in ast.walk(node) if isinstance(n, ast.Constant))


def for_scripts(node: ast.expr) -> str:
    """Return the words of a fix that readers of a script see."""
    if isinstance(node, ast.Call):
        if not isinstance(node.func, ast.Name) or node.func.id not in ("Fix", "option"):
            return ""
        return words(node.args[0])
    if isinstance(node, ast.IfExp):
        return f"{for_scripts(node.body)} {for_scripts(node.orelse)}"
    return words(node)


def options_in_scripts(text: str) -> Iterator[int]:
    """Yield the lines of fixes that tell readers of a script to type options of a shell."""
    for node in ast.walk(ast.parse(text)):
        fixes = [k.value for k in node.keywords if k.arg == "fix"] if isinstance(node, ast.Call) else []
        if isinstance(node, ast.Assign) and any(
            isinstance(t, ast.Name) and t.id == "fix" for t in node.targets
        ):
            fixes.append(node.value)
        yield from (fix.lineno for fix in fixes if OPTION.search(COMMAND.sub("", for_scripts(fix))))


def test_no_script_is_told_to_type_options() -> None:
    places = [
        f"{path.relative_to(ROOT)}:{line}"
        for path in sorted((ROOT / "src").rglob("*.py"))
        if not any(part in path.as_posix() for part in FOR_SHELLS)
        for line in options_in_scripts(path.read_text(encoding="utf-8"))
    ]
    assert not places, f"write option(...) or Fix(script, shell) of deodar.errors: {places}"


@pytest.mark.parametrize(
    ("call", "count"),
    [
        ("E('x', fix='Type: --kind a')", 1),
        ("E('x', fix=f'Type: --kind {a}' if a else 'b')", 1),
        ("fix = 'Type: --kind a'", 1),
        ("E('x', fix=Fix('Type: --kind a', 'b'))", 1),
        ("E('x', fix=Fix('a', 'Type: --kind a'))", 0),
        ("E('x', fix=option('Type:', 'kind', 'a'))", 0),
        ("E('x', fix='Take a - b -- c')", 0),
        ("E('x', fix='Type: pip install --upgrade deodar')", 0),
    ],
)
def test_an_option_in_a_fix_is_noticed(call: str, count: int) -> None:
    assert len(list(options_in_scripts(call))) == count


def misnamed_options(text: str) -> Iterator[int]:
    """Yield the lines of `option(ADVICE, NAME, ...)` whose name, where it is a literal, is no name."""
    for node in ast.walk(ast.parse(text)) if "option(" in text else ():
        match node:
            case ast.Call(ast.Name("option"), [_, ast.Constant(str(name)), *_]) if not name.isidentifier():
                yield node.lineno
            case _:
                pass


def test_what_an_error_says_to_type_begins_with_the_name_of_an_argument() -> None:
    places = [
        f"{path.relative_to(ROOT)}:{line}"
        for path in sorted((ROOT / "src").rglob("*.py"))
        for line in misnamed_options(path.read_text(encoding="utf-8"))
    ]
    assert not places, f"write option(advice, name of the argument, ...): {places}"
    assert list(misnamed_options("fix = option('goal', 'Give one:', 'X Y')")) == [1]
