"""Rules for the files themselves: words, state, printing."""

from __future__ import annotations

import ast
import re
from pathlib import Path

import pytest

from tests.house.source import MODULES, ROOT, SRC, module, texts, tree

# Written in pieces, so that this file does not contain the words that it finds.
FORBIDDEN = {
    "unfinished work": [rf"\b{a}{b}\b" for a, b in [("TO", "DO"), ("FIX", "ME"), ("XX", "X")]],
}

# Packages of extras that one module alone imports: only there an import may fail.
IMPORTERS = {
    "dask": "batch.scheduler",
    "dask_jobqueue": "batch.scheduler",
    "distributed": "batch.scheduler",
    "fsspec": "recording.remote_store",
}

# Names that are written once, when their module is imported, and hold something that could change; a `Family`
# (family.py) is another, filled by the decorators of its own module.
STATE = {
    ("compiler.hosts", "_joined"): "JAX joins hosts once for the process",
    ("registry", "_kinds"): "the registry itself",
    (
        "deodar_studio.requests.handlers",
        "HANDLERS",
    ): "the handlers of messages, filled by `handles` in this file",
    (
        "worlds._capture",
        "_silenced",
    ): "the log of OpenCV has one level for the process",
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
    *(ROOT / name for name in ("README.md", "CONTRIBUTING.md", "ARCHITECTURE.md")),
]
PAGE = [p for p in texts() if (ROOT / "studio") in p.parents and p.suffix in {".ts", ".tsx", ".css"}]
CHANGES = {"append", "add", "update", "pop", "clear", "extend", "insert", "remove", "setdefault", "discard"}


@pytest.mark.parametrize("what", FORBIDDEN)
def test_no_file_holds_forbidden_words(what: str) -> None:
    pattern = re.compile("|".join(FORBIDDEN[what]))
    found = [
        f"{path.relative_to(ROOT)}:{number}: {line.strip()[:80]}"
        for path in texts()
        for number, line in enumerate(path.read_text(encoding="utf-8", errors="replace").splitlines(), 1)
        if pattern.search(line)
    ]
    assert not found, found


def test_forbidden_words_are_found_with_their_line() -> None:
    for what, line in {
        "unfinished work": "# TO" + "DO: more",
    }.items():
        assert re.search("|".join(FORBIDDEN[what]), line)


def _mutable(value: ast.expr | None) -> bool:
    if isinstance(value, (ast.Dict, ast.List, ast.Set, ast.ListComp, ast.DictComp, ast.SetComp)):
        return True
    if isinstance(value, ast.Call):
        name = value.func.attr if isinstance(value.func, ast.Attribute) else getattr(value.func, "id", "")
        return name in MUTABLE_CALLS
    return False


def _state(path: Path) -> list[str]:
    """Return module-level names of mutable objects, and names that functions declare global."""
    found: list[str] = []
    for node in tree(path).body:
        targets = (
            node.targets
            if isinstance(node, ast.Assign)
            else [node.target]
            if isinstance(node, ast.AnnAssign)
            else []
        )
        for target in targets:
            # constants and tables are written in capitals and never changed
            if (
                isinstance(target, ast.Name)
                and _mutable(node.value)
                and not target.id.isupper()
                and not target.id.startswith("__")
            ):  # type: ignore[attr-defined]
                found.append(target.id)
    for node in ast.walk(tree(path)):
        if isinstance(node, (ast.Global, ast.Nonlocal)) and isinstance(node, ast.Global):
            found += node.names
    return found


def _written(path: Path) -> list[str]:
    """Return module-level names in capitals that a function changes."""
    constants = {
        t.id
        for n in tree(path).body
        for t in (
            n.targets if isinstance(n, ast.Assign) else [n.target] if isinstance(n, ast.AnnAssign) else []
        )
        if isinstance(t, ast.Name) and _mutable(n.value)  # type: ignore[attr-defined]
    }
    changed: list[str] = []
    for node in ast.walk(tree(path)):
        if (
            isinstance(node, ast.Subscript)
            and isinstance(node.ctx, (ast.Store, ast.Del))
            and isinstance(node.value, ast.Name)
        ):
            changed.append(node.value.id)
        method = node.func if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) else None
        if method is not None and isinstance(method.value, ast.Name) and method.attr in CHANGES:
            changed.append(method.value.id)
    return sorted(constants & set(changed))


@pytest.mark.parametrize("path", MODULES, ids=lambda p: str(p.relative_to(SRC)))
def test_no_state_at_module_level(path: Path) -> None:
    name = module(path) or "__init__"
    known = {n for m, n in STATE if m == name}
    extra = (set(_state(path)) | set(_written(path))) - known
    assert not extra, f"{name} keeps state in {sorted(extra)}: give it to an object that callers hold"


def test_every_listed_module_holds_state() -> None:
    held = {(module(p) or "__init__", n) for p in MODULES for n in {*_state(p), *_written(p)}}
    assert set(STATE) <= held, set(STATE) - held


@pytest.mark.parametrize("path", MODULES, ids=lambda p: str(p.relative_to(SRC)))
def test_only_the_command_line_prints(path: Path) -> None:
    if {"cli", "commands"} & set(module(path).split(".")):
        return
    calls = [
        n.lineno
        for n in ast.walk(tree(path))
        if isinstance(n, ast.Call)
        and isinstance(n.func, ast.Name)
        and n.func.id in ("print", "input", "exit")
    ]
    assert not calls


@pytest.mark.parametrize("path", MODULES, ids=lambda p: str(p.relative_to(SRC)))
def test_every_module_and_public_function_has_a_docstring(path: Path) -> None:
    assert path.name == "__init__.py" or ast.get_docstring(tree(path))
    silent = [
        n.name
        for n in tree(path).body
        if isinstance(n, (ast.FunctionDef, ast.ClassDef))
        and not n.name.startswith("_")
        and not ast.get_docstring(n)
    ]
    assert not silent


def test_no_module_is_named_after_no_particular_content() -> None:
    drawers = [p.name for p in MODULES if re.search("util|helper|misc|common|manager", p.stem)]
    assert not drawers, "one noun is one file"


@pytest.mark.parametrize("path", PAGE, ids=lambda p: p.relative_to(ROOT / "studio").as_posix())
def test_lines_of_the_page_have_at_most_110_columns(path: Path) -> None:
    lines = path.read_text(encoding="utf-8").splitlines()
    long = [number for number, line in enumerate(lines, 1) if len(line) > 110]
    assert not long, f"run `python studio/build.py format`; split comments and strings by hand: lines {long}"


@pytest.mark.parametrize("path", PAGES, ids=lambda p: p.relative_to(ROOT).as_posix())
def test_lines_of_the_manual_have_at_most_110_columns(path: Path) -> None:
    whole = re.compile(r"^```.*?^```$|^<!-- arguments of .*?^<!-- end of ", re.MULTILINE | re.DOTALL)
    text = whole.sub(lambda code: "\n" * code[0].count("\n"), path.read_text(encoding="utf-8"))
    lines = re.sub(
        r"<!-- (?:evidence|spikes) .*?<!-- end -->|`[^`\n]{60,}`", "", text, flags=re.DOTALL
    ).splitlines()
    long = [line for line in lines if len(line) > 110 and not line.startswith(("|", "!["))]
    assert not long, "wrap the prose; code, tables and pictures may be wider"


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


@pytest.mark.parametrize("package", sorted(IMPORTERS))
def test_one_module_imports_a_package_of_an_extra(package: str) -> None:
    found = {module(path) for path in MODULES if package in _packages(path)}
    assert found == {IMPORTERS[package]}


def _packages(path: Path) -> set[str]:
    """Return the packages that a file imports, at its top, in functions, and for types."""
    out: set[str] = set()
    for node in ast.walk(tree(path)):
        if isinstance(node, ast.Import):
            out |= {alias.name.split(".")[0] for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module:
            out.add(node.module.split(".")[0])
    return out
