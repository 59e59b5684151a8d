"""Print the numbers that the code base is held to, each with its limit.

    python tools/measure.py             what can be counted, in seconds; status 1 if a limit is broken
    python tools/measure.py --stored    also compare trajectories with the stored ones (minutes)
    python tools/measure.py --tests     also time `pytest -m fast` and the whole suite (many minutes)

What is counted are the packages in `src`, unless the line says otherwise.
"""

from __future__ import annotations

import argparse
import ast
import dataclasses as dc
import io
import itertools
import json
import os
import re
import subprocess
import sys
import time
import tokenize
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from graphlib import CycleError, TopologicalSorter
from pathlib import Path
from typing import Any

import packages as architecture
import suite
from packages import ROOT
from packages import SRC as SOURCE

SRC = SOURCE / architecture.ENGINE

WIDTH = 110
PARAMETERS = 8
CROWDED = 5
"""Most functions with that many parameters."""
BRANCHED = 25
TANGLED, MOST_TANGLED = 20, 9
"""The complexity above which functions are counted, and how many of them there may be: only ever fewer."""
BLANK = {
    *(tokenize.COMMENT, tokenize.NL, tokenize.NEWLINE),
    *(tokenize.INDENT, tokenize.DEDENT, tokenize.ENDMARKER),
}
"""Tokens that are no code."""

LOOSE = {"Any", "object"}
OPTIMISER = re.compile(r"\b([Ww]aves?|WAVES|REST|sharing|to_waves|from_waves|at\.(choices|shared|waves))\b")
"""Words of the compiler."""
DEEP = re.compile(
    r"^\s*(?:>>> |\.\.\. )?((?:from deodar\b[\w.]* import|import deodar\.)[^\n#]*)", re.MULTILINE
)


@dc.dataclass(frozen=True)
class Figure:
    """One number: what it counts, its value, the most it may be (None: no limit), and where it comes from."""

    what: str
    value: float
    most: float | None = None
    where: Sequence[str] = ()
    unit: str = ""

    @property
    def holds(self) -> bool:
        return self.most is None or self.value <= self.most


Trees = Mapping[str, ast.Module]
"""Syntax trees by the path of their file, below the folder of the packages."""


def packages(source: Path = SOURCE) -> list[Path]:
    """The folders of packages: `deodar`, and every `deodar_*` beside it."""
    return [source / name for name in architecture.packages(source)]


def trees(*roots: Path) -> Trees:
    """The modules of packages in one folder."""
    return {
        p.relative_to(root.parent).as_posix(): ast.parse(p.read_text(encoding="utf-8"))
        for root in roots
        for p in sorted(root.rglob("*.py"))
    }


# ------------------------------------------------------------------------------------------------------ names


def doubled(modules: Trees) -> list[str]:
    """Names of classes and aliases that more than one module defines at its top level.

    Modules of `compat` have the names of other tools, whatever else has them.
    """
    where: dict[str, list[str]] = defaultdict(list)
    for path, module in modules.items():
        if Path(path).with_suffix("").parts[1:2] == ("compat",):
            continue
        for name in {*_classes(module), *_aliases(module)}:
            where[name].append(path)
    return [f"{name}: {', '.join(paths)}" for name, paths in sorted(where.items()) if len(paths) > 1]


def _classes(module: ast.Module) -> list[str]:
    return [node.name for node in module.body if isinstance(node, ast.ClassDef)]


def _aliases(module: ast.Module) -> dict[str, ast.expr]:
    """Names in capitals and small letters that a module assigns at its top level: aliases of types."""
    found: dict[str, ast.expr] = {}
    for node in module.body:
        match node:
            case ast.Assign(targets=[ast.Name(id=name)], value=value) if _is_type(value):
                found[name] = value
            case ast.AnnAssign(
                target=ast.Name(id=name), annotation=ast.Name(id="TypeAlias"), value=ast.expr() as value
            ):
                found[name] = value
    return {name: value for name, value in found.items() if re.match(r"_?[A-Z]\w*[a-z]", name)}


def _is_type(value: ast.expr) -> bool:
    return isinstance(value, ast.Name | ast.Attribute | ast.Subscript | ast.BinOp)


# ------------------------------------------------------------------------------------------------ annotations


def loose(modules: Trees) -> tuple[int, int, dict[str, int]]:
    """How many annotations hold Any, object or an alias of them; how many there are; how many by module."""
    aliases = {name: value for module in modules.values() for name, value in _aliases(module).items()}
    words = set(LOOSE)
    while more := {name for name, value in aliases.items() if name not in words and _words(value) & words}:
        words |= more
    total, by = 0, defaultdict[str, int](int)
    for path, module in modules.items():
        for annotation in _annotations(module):
            total += 1
            by[path] += bool(_words(annotation) & words)
    return sum(by.values()), total, dict(by)


def _annotations(module: ast.Module) -> Iterator[ast.expr]:
    for node in ast.walk(module):
        if isinstance(node, ast.AnnAssign | ast.arg) and node.annotation is not None:
            yield node.annotation
        elif isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef) and node.returns is not None:
            yield node.returns


def _words(node: ast.expr) -> set[str]:
    """Names in an annotation; `Annotated` counts by its first argument."""
    if isinstance(node, ast.Subscript) and ast.unparse(node.value).endswith("Annotated"):
        first = node.slice.elts[0] if isinstance(node.slice, ast.Tuple) else node.slice
        return _words(first)
    found: set[str] = set()
    for part in ast.walk(node):
        if isinstance(part, ast.Name):
            found.add(part.id)
        elif isinstance(part, ast.Attribute):
            found.add(part.attr)
        elif isinstance(part, ast.Constant) and isinstance(part.value, str):
            found |= set(re.findall(r"\w+", part.value))
    return found


# -------------------------------------------------------------------------------------------------- functions


def crowded(modules: Trees) -> list[str]:
    """Functions with many parameters of any kind; `self` and `cls` do not count."""
    found: list[str] = []
    for path, module in modules.items():
        for node in ast.walk(module):
            if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
                a = node.args
                names = [x.arg for x in (*a.posonlyargs, *a.args, *a.kwonlyargs, a.vararg, a.kwarg) if x]
                n = len([name for name in names if name not in ("self", "cls")])
                if n >= PARAMETERS:
                    found.append(f"{path}:{node.lineno} {node.name} ({n})")
    return found


def inner_imports(source: Path, modules: Trees) -> list[str]:
    """Imports in functions without a comment that says why: in or above a run of them."""
    found: list[str] = []
    for path, module in modules.items():
        lines = (source / path).read_text(encoding="utf-8").splitlines()
        for function in ast.walk(module):
            if isinstance(function, ast.FunctionDef | ast.AsyncFunctionDef):
                for run in _runs(function):
                    if "#" not in "".join(lines[run[0].lineno - 2 : run[-1].end_lineno]):
                        found += [f"{path}:{node.lineno}" for node in run]
    return sorted(set(found))


def _runs(function: ast.AST) -> Iterator[list[ast.stmt]]:
    """Imports of a function that follow each other."""
    for node in ast.walk(function):
        for name in ("body", "orelse", "finalbody"):
            body = getattr(node, name, None)
            for imports, run in itertools.groupby(body if isinstance(body, list) else (), _imports):
                if imports:
                    yield list(run)


def _imports(node: ast.AST) -> bool:
    return isinstance(node, ast.Import | ast.ImportFrom)


# ---------------------------------------------------------------------------------------------------- imports


def graph(modules: Trees) -> dict[str, set[str]]:
    """Return for each module those of the packages that it imports: at the top, in functions, for types."""
    names = {_module(path) for path in modules}
    out: dict[str, set[str]] = {}
    for path, module in modules.items():
        here = _module(path)
        out[here] = {name for name in _imported(module, names) if name != here}
    return out


def cycle(imports: Mapping[str, set[str]]) -> list[str]:
    """Return the first cycle of imports; empty without one."""
    try:
        TopologicalSorter(imports).prepare()
    except CycleError as error:
        return [str(name) for name in error.args[1]]
    return []


def _module(path: str) -> str:
    return architecture.dotted(SOURCE / path)


def _imported(module: ast.Module, names: set[str]) -> Iterator[str]:
    for node in ast.walk(module):
        if isinstance(node, ast.Import):
            wanted = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom) and node.module:
            wanted = [f"{node.module}.{alias.name}" for alias in node.names]
        else:
            continue
        for name in wanted:
            while name and name not in names:  # what is imported from a module is no module
                name = name.rpartition(".")[0]
            if name:
                yield name


def deep(paths: Iterable[Path]) -> list[str]:
    """Distinct lines that import from deodar otherwise than by `import deodar as dd`."""
    return sorted({line.strip() for path in paths for line in DEEP.findall(path.read_text(encoding="utf-8"))})


# ------------------------------------------------------------------------------------------------------ lines


def long_lines(paths: Iterable[Path]) -> list[str]:
    """Lines above the width, except those with a comment for the type checker."""
    return [
        f"{path}:{n}"
        for path in paths
        for n, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1)
        if len(line) > WIDTH and not re.search(r"# (type|pyright): ", line)
    ]


def counted_lines(text: str) -> tuple[int, int]:
    """How many lines a module has, and how many without blank lines, comments and docstrings."""
    code: set[int] = set()
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type not in BLANK:
            code.update(range(token.start[0], token.end[0] + 1))
    for node in ast.walk(ast.parse(text)):
        match node:
            case ast.Expr(value=ast.Constant(value=str())):
                code.difference_update(range(node.lineno, (node.end_lineno or node.lineno) + 1))
            case _:
                pass
    return len(text.splitlines()), len(code)


def sizes(roots: Iterable[Path]) -> Iterator[Figure]:
    """The lines of each package, and their sum."""
    total = [0, 0]
    for root in roots:
        files = [counted_lines(p.read_text(encoding="utf-8")) for p in sorted(root.rglob("*.py"))]
        lines = [sum(n) for n in zip(*files, strict=True)]
        yield from _size(root.name, lines)
        total = [a + b for a, b in zip(total, lines, strict=True)]
    yield from _size("src", total)


def _size(name: str, lines: Sequence[int]) -> Iterator[Figure]:
    yield Figure(f"lines of {name}", lines[0])
    yield Figure("  without blank lines, comments, docstrings", lines[1])


def worded(root: Path, folders: Sequence[str]) -> list[str]:
    """Lines of the physics that mention the optimisation of a program."""
    return [
        f"{path.relative_to(root)}:{n}"
        for folder in folders
        for path in sorted((root / folder).glob("*.py"))
        for n, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1)
        if OPTIMISER.search(line)
    ]


def _tracked(*patterns: str) -> list[Path]:
    told = subprocess.run(
        ["git", "ls-files", "-z", *patterns], cwd=ROOT, capture_output=True, text=True, check=True
    )
    return [ROOT / name for name in told.stdout.split("\0") if name and (ROOT / name).exists()]


# -------------------------------------------------------------------------------------------------- processes


def _python(*arguments: str) -> str:
    """What this interpreter prints, with the packages of this checkout."""
    done = subprocess.run(
        [sys.executable, *arguments],
        cwd=ROOT,
        env=os.environ | {"PYTHONPATH": str(SOURCE)},
        capture_output=True,
        text=True,
    )
    if done.returncode:
        sys.exit(
            f"measure.py: {sys.executable} cannot run {' '.join(arguments[:2])}: {done.stderr.strip()}\n"
            'Run it with an interpreter that has what the tests need: pip install -e ".[test]"'
        )
    return done.stdout


def _import_time() -> tuple[float, bool]:
    """The shortest of five imports, in seconds of CPU time, and whether it brought JAX."""
    code = (
        "import time; a = time.process_time(); import deodar; b = time.process_time(); import sys; "
        "print(b - a, 'jax' in sys.modules)"
    )
    texts = [_python("-c", code) for _ in range(5)]
    return min(float(text.split()[0]) for text in texts), "True" in texts[0]


def _complex() -> list[str]:
    options = ("--select", "C901", "--output-format", "json", "--exit-zero")
    text = _python("-m", "ruff", "check", *options, *map(str, packages()))
    return [f"{Path(x['filename']).relative_to(SOURCE)}:{x['location']['row']}" for x in json.loads(text)]


def branched(*roots: Path) -> dict[str, int]:
    """Return the functions above TANGLED with their complexity: loops, branches, and each `and`, `or`, `if`
    of an expression.
    """
    found: dict[str, list[dict[str, Any]]] = json.loads(
        _python("-m", "radon", "cc", "--json", "--min", "D", *map(str, roots))
    )
    return {
        f"{Path(path).relative_to(roots[0].parent).as_posix()} {_qualified(block)}": block["complexity"]
        for path, blocks in found.items()
        for block in blocks
        if block["type"] != "class" and block["complexity"] > TANGLED
    }


def _qualified(block: Mapping[str, Any]) -> str:
    return f"{block['classname']}.{block['name']}" if block.get("classname") else block["name"]


def _timed(*command: str) -> tuple[float, int]:
    """Wall seconds of a command, and its status."""
    began = time.perf_counter()
    status = subprocess.run([sys.executable, *command], cwd=ROOT, check=False).returncode
    return time.perf_counter() - began, status


# ---------------------------------------------------------------------------------------------------- figures


def counted() -> Iterator[Figure]:
    """What is read off the files."""
    roots = packages()
    modules = trees(*roots)
    yield from sizes(roots)
    scripts = [
        ROOT / "README.md",
        *_tracked("docs/*.md", "docs/*.ipynb", "docs/*.py", "examples/*.py", "examples/*.md"),
    ]
    names = re.findall(r" as (\w+)$", (SRC / "__init__.pyi").read_text(encoding="utf-8"), re.MULTILINE)
    yield Figure("public names", len(names))
    seconds, brings = _import_time()
    yield Figure("import deodar, CPU time", seconds, 0.05, unit="s")
    yield Figure("import deodar brings JAX", int(brings), 0)
    lines = deep(scripts)
    yield Figure("deep import lines in README, docs, examples", len(lines), 5, lines)
    found = doubled(modules)
    yield Figure("class or alias names that occur twice", len(found), 0, found)
    ring = cycle(graph(modules))
    yield Figure("modules in the first cycle of imports", len(ring), 0, ring)
    found = _complex()
    yield Figure("functions of a complexity above 15", len(found), 0, found)
    above = branched(*roots)
    found = [f"{name} ({n})" for name, n in above.items() if n > BRANCHED]
    yield Figure(f"functions of a complexity above {BRANCHED}, conditions counted", len(found), 0, found)
    found = [f"{name} ({n})" for name, n in sorted(above.items(), key=lambda item: -item[1])]
    yield Figure(
        f"functions of a complexity above {TANGLED}, conditions counted", len(found), MOST_TANGLED, found
    )
    found = [str(Path(x).relative_to(ROOT)) for x in long_lines(_tracked("*.py", "*.pyi"))]
    yield Figure(f"lines of Python above {WIDTH} columns, all folders", len(found), 0, found)
    found = crowded(modules)
    yield Figure(f"functions of {PARAMETERS} and more parameters", len(found), CROWDED, found)
    held, total, by = loose(modules)
    worst = [f"{path}: {n}" for path, n in sorted(by.items(), key=lambda item: -item[1])[:25] if n]
    yield Figure(f"annotations with Any, object or an alias, of {total}", 100 * held / total, 8, worst, "%")
    found = inner_imports(SOURCE, modules)
    yield Figure("imports in functions without a reason", len(found), 0, found)
    found = worded(SOURCE, [f"{root.name}/{room}" for root in roots for room in ("elements", "couplings")])
    yield Figure("lines of elements and couplings on the optimiser", len(found), 0, found)


def stored() -> Iterator[Figure]:
    """Trajectories against those stored before the renovation."""
    _, status = _timed("benchmarks/trajectories.py", "compare")
    yield Figure("status of the comparison with stored trajectories", status, 0)


def tests() -> Iterator[Figure]:
    """Wall time of the tests, called as `make` calls them; the limits are for two idle cores."""
    for what, most, calls in (
        ("pytest -m fast", 60, suite.calls("fast")),
        ("the verdict", 240, suite.calls("verdict")),
        ("the whole suite", 720, suite.calls("whole")),
    ):
        runs = [_timed(*call, "-q") for call in calls]
        yield Figure(f"{what}, wall time", sum(seconds for seconds, _ in runs), most, unit="s")
        yield Figure(f"{what}, status", max(status for _, status in runs), 0)


def main(argv: Sequence[str] | None = None) -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--stored", action="store_true", help="compare trajectories with the stored ones")
    parser.add_argument("--tests", action="store_true", help="time the tests")
    parser.add_argument("--where", action="store_true", help="list the places behind each number")
    args = parser.parse_args(argv)
    broken = 0
    parts = [counted, *([stored] if args.stored else []), *([tests] if args.tests else [])]
    for part in parts:
        for figure in part():
            number = f"{figure.value:.3g}" if figure.value != int(figure.value) else f"{int(figure.value)}"
            limit = (
                ""
                if figure.most is None
                else f"at most {figure.most:g}{' ' * bool(figure.unit)}{figure.unit}"
            )
            verdict = "" if figure.holds else "BROKEN"
            print(f"{figure.what:58}{number:>8} {figure.unit:3}{limit:18}{verdict}".rstrip())
            for line in figure.where if args.where or (not figure.holds and len(figure.where) <= 5) else ():
                print(f"    {line}")
            broken += not figure.holds
    return int(broken > 0)


if __name__ == "__main__":
    sys.exit(main())
