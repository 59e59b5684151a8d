"""Rules for the files themselves that no rule of ruff or biome is about: words, state, docstrings, width."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

from tests.house.source import MODULES, ROOT, at, module, texts, tree

# Written in pieces, so that this file does not contain the words that it finds.
UNFINISHED = re.compile("|".join(rf"\b{a}{b}\b" for a, b in [("TO", "DO"), ("FIX", "ME"), ("XX", "X")]))
"""Words for unfinished work, in files of any kind: ruff's FIX finds them at the beginning of comments of
Python.
"""

# Names that are written once, when their module is imported, and hold something that could change; a `Family`
# (family.py) is another, filled by the decorators of its own module.
STATE = {
    ("compiler.hosts", "_joined"): "JAX joins hosts once for the process",
    ("registry", "_kinds"): "the registry itself",
    ("worlds._capture", "_silenced"): "the log of OpenCV has one level for the process",
}
MUTABLE_CALLS = {
    "dict",
    "list",
    "set",
    "defaultdict",
    "Counter",
    "deque",
    "OrderedDict",
    "WeakValueDictionary",
    "WeakKeyDictionary",
    "ContextVar",
    "local",
}
PAGES = [
    *sorted((ROOT / "docs").glob("*.md")),
    *(ROOT / name for name in ("README.md", "CONTRIBUTING.md", "ARCHITECTURE.md", "RELEASING.md")),
]
PAGE = [p for p in texts() if (ROOT / "studio") in p.parents and p.suffix in {".ts", ".tsx", ".css"}]
CHANGES = {"append", "add", "update", "pop", "clear", "extend", "insert", "remove", "setdefault", "discard"}


def test_no_file_holds_words_for_unfinished_work() -> None:
    found = [
        f"{at(path, number)}: {line.strip()[:80]}"
        for path in texts()
        for number, line in enumerate(path.read_text(encoding="utf-8", errors="replace").splitlines(), 1)
        if UNFINISHED.search(line)
    ]
    assert not found, found


def test_words_for_unfinished_work_are_found() -> None:
    assert UNFINISHED.search("# TO" + "DO: more")


def _mutable(value: ast.expr | None) -> bool:
    if isinstance(value, (ast.Dict, ast.List, ast.Set, ast.ListComp, ast.DictComp, ast.SetComp)):
        return True
    if isinstance(value, ast.Call):
        name = value.func.attr if isinstance(value.func, ast.Attribute) else getattr(value.func, "id", "")
        return name in MUTABLE_CALLS
    return False


def _assigned(path: Path) -> Iterator[ast.Name]:
    """Yield the names at the top of a module that hold a mutable object."""
    for node in tree(path).body:
        if isinstance(node, ast.Assign | ast.AnnAssign) and _mutable(node.value):
            targets = node.targets if isinstance(node, ast.Assign) else [node.target]
            yield from (target for target in targets if isinstance(target, ast.Name))


def _written(path: Path) -> set[str]:
    """Return the names that the code of a module changes, by a method or at an index."""
    changed: set[str] = set()
    for node in ast.walk(tree(path)):
        match node:
            case ast.Subscript(value=ast.Name(id=name), ctx=ast.Store() | ast.Del()):
                changed.add(name)
            case ast.Call(func=ast.Attribute(value=ast.Name(id=name), attr=method)) if method in CHANGES:
                changed.add(name)
    return changed


def _state(path: Path) -> dict[str, int]:
    """Return the names of mutable objects that a module keeps, with their lines.

    Constants and tables have names in capitals, and no code changes them. ruff finds `global` (PLW0603).
    """
    written = _written(path)
    return {
        name.id: name.lineno
        for name in _assigned(path)
        if name.id in written or not (name.id.isupper() or name.id.startswith("__"))
    }


def test_no_state_at_module_level() -> None:
    found = {
        (module(path) or "__init__", name): at(path, line)
        for path in MODULES
        for name, line in _state(path).items()
    }
    extra = [f"{place}: {name}" for (where, name), place in found.items() if (where, name) not in STATE]
    assert not extra, f"give it to an object that callers hold: {extra}"
    assert set(STATE) <= set(found), "STATE names what is gone"


def test_state_is_found(tmp_path: Path) -> None:
    bad = tmp_path / "bad.py"
    bad.write_text(
        "cache = {}\nTABLE = [1]\nSEEN = set()\nROWS: list[int] = []\n__all__ = ['f']\nsize = 3\n"
        "def f():\n    SEEN.add(1)\n    ROWS[0] = 2\n"
    )
    assert _state(bad) == {"cache": 1, "SEEN": 3, "ROWS": 4}


def _silent(path: Path) -> Iterator[int]:
    """Yield the line of a module without a docstring, and of its public functions and classes without."""
    top = tree(path)
    if path.name != "__init__.py" and not ast.get_docstring(top):
        yield 1
    for node in top.body:
        if not isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
            continue
        if not node.name.startswith("_") and not ast.get_docstring(node):
            yield node.lineno


def test_every_module_and_public_function_has_a_docstring() -> None:
    """In modules with a leading underscore too, which the rules D100 to D103 of ruff leave out."""
    assert not [at(path, line) for path in MODULES for line in _silent(path)]


def test_missing_docstrings_are_found(tmp_path: Path) -> None:
    bad = tmp_path / "_bad.py"
    bad.write_text('def f():\n    pass\nasync def g():\n    pass\nclass A:\n    """A."""\ndef _h(): pass\n')
    assert list(_silent(bad)) == [1, 1, 3]


BUILTINS = {"input": {"cli", "commands"}, "__import__": set[str]()}
"""Functions of Python that no rule of ruff is about, with the folders that may call them."""


def test_only_the_command_line_asks_and_imports_are_written() -> None:
    found = [
        at(path, node.lineno)
        for path in MODULES
        for node in ast.walk(tree(path))
        if isinstance(node, ast.Call)
        and isinstance(node.func, ast.Name)
        and node.func.id in BUILTINS
        and not BUILTINS[node.func.id] & set(module(path).split("."))
    ]
    assert not found, found


def test_no_module_is_named_after_no_particular_content() -> None:
    drawers = [p.name for p in MODULES if re.search("util|helper|misc|common|manager", p.stem)]
    assert not drawers, "a file is a noun or a family of siblings"


def test_lines_of_the_page_have_at_most_110_columns() -> None:
    long = [
        at(path, number)
        for path in PAGE
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1)
        if len(line) > 110
    ]
    assert not long, f"run `python studio/build.py format`; split comments and strings by hand: {long}"


def _wide(text: str) -> Iterator[int]:
    """Yield the numbers of lines of prose above 110 columns; code, tables and pictures may be wider."""
    free = (
        r"^```.*?^```$|^<!-- arguments of .*?^<!-- end of |<!-- (?:evidence|spikes) .*?<!-- end -->"
        r"|`[^`\n]{60,}`"
    )
    prose = re.sub(free, lambda code: "\n" * code[0].count("\n"), text, flags=re.MULTILINE | re.DOTALL)
    for number, line in enumerate(prose.splitlines(), 1):
        if len(line) > 110 and not line.startswith(("|", "![")):
            yield number


def test_lines_of_the_manual_have_at_most_110_columns() -> None:
    long = [at(path, line) for path in PAGES for line in _wide(path.read_text(encoding="utf-8"))]
    assert not long, f"wrap the prose: {long}"


def test_wide_lines_are_found() -> None:
    wide = "word " * 23
    assert list(_wide(f"```\n{wide}\n```\n{wide}\n| {wide}|\n")) == [4]


def test_types_of_the_page_have_different_names() -> None:
    declared: dict[str, set[str]] = {}
    sources = ROOT / "studio" / "src"
    for path in (p for p in PAGE if sources in p.parents and p.suffix in {".ts", ".tsx"}):
        text = path.read_text(encoding="utf-8")
        for name in re.findall(r"^(?:export )?(?:type|interface|class) (\w+)", text, re.MULTILINE):
            declared.setdefault(name, set()).add(path.relative_to(ROOT).as_posix())
    local = {"Props"}  # the properties of the only component of a file are not exported
    assert not {name: files for name, files in declared.items() if len(files) > 1 and name not in local}


def test_warnings_are_errors() -> None:
    assert 'filterwarnings = ["error"]' in (ROOT / "pyproject.toml").read_text(encoding="utf-8")
