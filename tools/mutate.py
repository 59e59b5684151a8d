"""Change the package at places drawn by a commit, and run the tests that cover each change.

    python tools/mutate.py map [PYTEST ARGUMENTS]    note which functions each test calls
    python tools/mutate.py run [--count 300]         judge what HEAD draws: rows in evidence/mutants.csv, and
                                                     the functions that fail in tests/kills.csv
    python tools/mutate.py run --again               judge the survivors again, with the present tests
    python tools/mutate.py show                      print the share that is killed by all tests and by the
                                                     verdict, and every survivor
    python tools/mutate.py changed REV [--count 20]  judge mutants of the lines of `src` that changed since a
                                                     revision, in ten minutes after their tests are mapped
                                                     (`make mutants CHANGED=REV`), or in `--minutes`
    python tools/mutate.py floor [FILE ...]          find for each source file the cheapest test that notices
                                                     when its public functions raise: tests/floor.csv

A place is drawn from all comparisons, arithmetic, constants, conditions, returned values, statements and
calls below `src`. A mutant is killed when a test that covers it fails, and passes without the change. One
that takes too long survives. Rows are written one by one, so a run that was stopped continues. Mutants that
no test can distinguish from the package are listed with the reason in evidence/equivalent_mutants.csv and are
not counted.

`map` runs the tests in one process and adds to the map of a commit, which can so be filled folder by folder.
"""

from __future__ import annotations

import argparse
import ast
import builtins
import contextlib
import csv
import dataclasses as dc
import importlib.machinery
import io
import itertools
import json
import os
import random
import shutil
import signal
import subprocess
import sys
import tarfile
import tempfile
import time
from collections.abc import Collection, Generator, Iterable, Iterator, Mapping, Sequence
from importlib.machinery import ModuleSpec
from pathlib import Path
from types import CodeType
from typing import Any

ROOT = Path(__file__).parents[1]
KEPT = ROOT / ".pytest_cache" / "mutants"
ROWS = ROOT / "evidence" / "mutants.csv"
PROGRAMS = Path(".pytest_cache", "programs")
FLOOR = ROOT / "tests" / "floor.csv"
KILLS = ROOT / "tests" / "kills.csv"
EQUIVALENT = ROOT / "evidence" / "equivalent_mutants.csv"

COUNT = 300
CANDIDATES = 8
"""Most test functions that are tried for the floor of a file, the cheapest first."""

TESTS = 150
"""Most tests that are run for one mutant: those of the shortest time first."""

SECONDS = 15.0
"""CPU seconds of the tests that are run for one mutant, after which no others are added."""

FAILING = 2
"""Functions that fail with a mutant, after which no others are tried."""

NOT_FOUND = 4
"""What pytest returns if a test does not exist, and where it cannot import one."""

PATIENCE = 10.0, 60.0
"""A mutant times out after this multiple of the time of its tests, plus a number of seconds."""


NOTE = "__note_call__"
"""Name among the built-in ones by which functions note that they are called."""

MINUTES = 10.0
"""How long mutants of a change are judged, unless another time is stated."""

Key = tuple[str, str, str]
"""What identifies a mutant of a commit: place, source before, source after."""


@dc.dataclass(frozen=True)
class Mutant:
    """One change of one place.

    Attributes:
        file: path below the root.
        line, column: where the place begins, both from 1.
        kind: what is changed, such as "comparison".
        before, after: the source of the place.
        start, end: characters of the file that `after` replaces.
    """

    file: str
    line: int
    column: int
    kind: str
    before: str
    after: str
    start: int = dc.field(compare=False)
    end: int = dc.field(compare=False)

    @property
    def key(self) -> Key:
        """Its place, and the beginning of its source before and after, each in one line."""
        before, after = (" ".join(s.split())[:120] for s in (self.before, self.after))
        return f"{self.file}:{self.line}:{self.column}", before, after

    def applied(self, text: str) -> str:
        """The file with the change."""
        return text[: self.start] + self.after + text[self.end :]


COMPARISONS: dict[type[ast.cmpop], ast.cmpop] = {
    ast.Lt: ast.LtE(),
    ast.LtE: ast.Lt(),
    ast.Gt: ast.GtE(),
    ast.GtE: ast.Gt(),
    ast.Eq: ast.NotEq(),
    ast.NotEq: ast.Eq(),
    ast.In: ast.NotIn(),
    ast.NotIn: ast.In(),
    ast.Is: ast.IsNot(),
    ast.IsNot: ast.Is(),
}
ARITHMETIC: dict[type[ast.operator], ast.operator] = {
    ast.Add: ast.Sub(),
    ast.Sub: ast.Add(),
    ast.Mult: ast.Div(),
    ast.Div: ast.Mult(),
    ast.FloorDiv: ast.Mult(),
    ast.Mod: ast.Mult(),
    ast.Pow: ast.Mult(),
    ast.BitAnd: ast.BitOr(),
    ast.BitOr: ast.BitAnd(),
}


OF_SEVERAL = {"max": "min", "min": "max", "any": "all", "all": "any", "sum": "max", "sorted": "list"}
"""Functions of several values, and others that are equal for one."""


def several_of(node: ast.AST) -> ast.expr | None:
    """What a loop or a comprehension goes through, if it is one."""
    match node:
        case ast.For(iter=several) | ast.ListComp(generators=[ast.comprehension(iter=several), *_]):
            return several
        case ast.SetComp(generators=[ast.comprehension(iter=several), *_]):
            return several
        case ast.DictComp(generators=[ast.comprehension(iter=several), *_]):
            return several
        case ast.GeneratorExp(generators=[ast.comprehension(iter=several), *_]):
            return several
        case _:
            return None


def changes(node: ast.AST) -> Iterator[tuple[str, ast.AST]]:
    """Kinds of changes of a node, with the changed node."""
    match node:
        case ast.Compare(left, [op, *ops], right) if type(op) in COMPARISONS:
            yield "comparison", ast.Compare(left, [COMPARISONS[type(op)], *ops], right)
        case ast.BinOp(left, op, right) if type(op) in ARITHMETIC:
            yield "arithmetic", ast.BinOp(left, ARITHMETIC[type(op)], right)
        case ast.Constant(bool(value)):
            yield "constant", ast.Constant(not value)
        case ast.Constant(int(value) | float(value)):
            yield "constant", ast.Constant(value + 1)
        case ast.BoolOp(op, values):
            yield "boolean", ast.BoolOp(ast.Or() if isinstance(op, ast.And) else ast.And(), values)
        case ast.UnaryOp(ast.Not(), operand):
            yield "boolean", operand
        case ast.IfExp(test, body, orelse):
            yield "condition", ast.IfExp(test, orelse, body)
        case ast.Return(value) if value is not None and ast.unparse(value) != "None":
            yield "return value", ast.Return(ast.Constant(None))
        case ast.Expr(ast.Call()) | ast.AugAssign() | ast.Raise():
            yield "removed statement", ast.Pass()
        case ast.Assign([ast.Attribute() | ast.Subscript()]):
            yield "removed statement", ast.Pass()
        case ast.Call(ast.Name(name), [_, *_] as arguments, keywords) if name in OF_SEVERAL:
            yield "of several", ast.Call(ast.Name(OF_SEVERAL[name]), arguments, keywords)
        case ast.Call(f, [a, b, *rest], keywords) if not any(isinstance(x, ast.Starred) for x in (a, b)):
            yield "swapped argument", ast.Call(f, [b, a, *rest], keywords)
        case _:
            return


def unread(node: ast.AST) -> list[ast.AST]:
    """Children that no run reads: annotations, what only types need, and the text of messages."""
    match node:
        case ast.If(ast.Name("TYPE_CHECKING")):
            return list(node.body)
        case ast.ClassDef(bases=[*bases]) if any("Protocol" in ast.unparse(b) for b in bases):
            return list(node.body)
        case ast.arg(annotation=annotation) | ast.AnnAssign(annotation=annotation) if annotation:
            return [annotation]
        case ast.FunctionDef(returns=returns) if returns:
            return [returns]
        case ast.Raise(exc=ast.Call(args=args, keywords=keywords)):
            return [*args, *keywords]
        case ast.JoinedStr(values=values):
            return list(values)
        case _:
            return []


def mutants(file: str, text: str) -> Iterator[Mutant]:
    """Every change of a file, in the order of its syntax tree."""
    starts = [0]
    for line in text.splitlines(keepends=True):
        starts.append(starts[-1] + len(line))
    lines = text.splitlines()

    def at(line: int, column: int) -> int:
        """Columns of syntax trees count bytes."""
        return starts[line - 1] + len(lines[line - 1].encode()[:column].decode())

    def walk(node: ast.AST) -> Iterator[ast.AST]:
        yield node
        left_out = unread(node)
        for child in ast.iter_child_nodes(node):
            if child not in left_out:
                yield from walk(child)

    def mutant(node: ast.AST, kind: str, new: ast.AST) -> Mutant:
        assert isinstance(node, ast.expr | ast.stmt) and node.end_lineno and node.end_col_offset is not None
        start, end = at(node.lineno, node.col_offset), at(node.end_lineno, node.end_col_offset)
        after = ast.unparse(ast.fix_missing_locations(new))
        after = f"({after})" if isinstance(node, ast.expr) else after
        return Mutant(file, node.lineno, node.col_offset + 1, kind, text[start:end], after, start, end)

    for node in walk(ast.parse(text)):
        for kind, new in changes(node):
            # 1e300 + 1 is 1e300, and f(a, a) is the same with its arguments swapped
            if ast.unparse(new) != ast.unparse(node):
                yield mutant(node, kind, new)
        if several := several_of(node):
            first = ast.Call(ast.Name("list"), [several], [])
            yield mutant(several, "only the first", ast.Subscript(first, ast.Slice(upper=ast.Constant(1))))


def draw(root: Path, seed: str, count: int) -> list[Mutant]:
    """Mutants of the package, drawn by a text: the same text draws the same ones from the same files."""
    places = [
        mutant
        for path in sorted((root / "src").rglob("*.py"))
        for mutant in mutants(path.relative_to(root).as_posix(), path.read_text(encoding="utf-8"))
    ]
    return random.Random(seed).sample(places, min(count, len(places)))


# Which test calls which function.

Calls = dict[str, tuple[float, set[str]]]
"""For each test its seconds, and the functions it calls as `FILE:FIRST LINE`."""


class Recorder:
    """A plugin of pytest that notes, for each test that passes, the functions of the package that it calls.

    Functions say it themselves: each begins with a statement that `NotedCalls` inserts when their module is
    imported. `sys.settrace` would make the suite twice as long.
    """

    def __init__(self, root: Path, out: io.TextIOBase) -> None:
        self.out = out
        self.failed = False
        self.calls = NotedCalls(root)
        sys.meta_path.insert(0, self.calls)

    def pytest_runtest_logstart(self) -> None:
        self.calls.seen.clear()
        self.failed, self.began = False, time.process_time()

    def pytest_runtest_logreport(self, report: object) -> None:
        self.failed |= getattr(report, "failed", False)

    def pytest_runtest_logfinish(self, nodeid: str) -> None:
        calls = sorted(self.calls.seen)
        if calls and not self.failed and "\n" not in nodeid:
            seconds = round(time.process_time() - self.began, 3)
            self.out.write(json.dumps([nodeid, seconds, calls]) + "\n")
            self.out.flush()


class NotedCalls(importlib.machinery.PathFinder):
    """A finder of modules below `src` whose functions note that they are called.

    Attributes:
        seen: the functions that were called, as `FILE:FIRST LINE`.
    """

    def __init__(self, root: Path) -> None:
        self.root = str(root) + os.sep
        self.seen: set[str] = set()
        setattr(builtins, NOTE, self.seen.add)

    def find_spec(self, fullname: str, path: Any = None, target: Any = None) -> ModuleSpec | None:  # type: ignore[override]
        spec = super().find_spec(fullname, path, target)
        origin = spec.origin if spec else None
        if spec and origin and origin.endswith(".py") and origin.startswith(self.root + "src"):
            spec.loader = NotingLoader(fullname, origin, origin.removeprefix(self.root))
        return spec


class NotingLoader(importlib.machinery.SourceFileLoader):
    """Compiles a module whose functions note their calls; byte code is neither read nor written."""

    def __init__(self, name: str, path: str, file: str) -> None:
        super().__init__(name, path)
        self.file = file

    def get_code(self, fullname: str) -> CodeType:
        return compile(
            noting(self.file, self.get_source(fullname) or ""), self.path, "exec", dont_inherit=True
        )


def noting(file: str, text: str) -> ast.Module:
    """Return the syntax tree of a file whose functions begin with a note of their call."""
    tree = ast.parse(text)
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            [call] = ast.parse(f"{NOTE}({f'{file}:{first_line(node)}'!r})").body
            place = node.body[0]
            for part in ast.walk(call):
                ast.copy_location(part, place)
            # a docstring stays first
            node.body.insert(1 if ast.get_docstring(node, clean=False) is not None else 0, call)
    return tree


def first_line(node: ast.FunctionDef | ast.AsyncFunctionDef) -> int:
    """Return the line where a function begins, with its decorators."""
    return min([node.lineno, *(decorator.lineno for decorator in node.decorator_list)])


def note(root: Path, out: Path, arguments: Sequence[str]) -> int:
    """Run tests of a tree in a process of its own, and add to the map which functions they call."""
    code = (
        "import sys, pytest; from pathlib import Path; sys.path.insert(0, sys.argv[1]); import mutate\n"
        "with open(sys.argv[2], 'a', encoding='utf-8') as out:\n"
        "    sys.exit(pytest.main(sys.argv[3:], plugins=[mutate.Recorder(Path.cwd().resolve(), out)]))"
    )
    out.parent.mkdir(parents=True, exist_ok=True)
    return subprocess.run(
        [sys.executable, "-c", code, str(Path(__file__).parent), str(out), *arguments],
        cwd=root,
        env=environment(root),
        check=False,
    ).returncode


def calls(file: Path) -> Calls:
    """The map: of a test that was run twice, the later run."""
    if not file.exists():
        return {}
    with file.open(encoding="utf-8") as text:
        return {test: (seconds, set(functions)) for test, seconds, functions in map(json.loads, text)}


def covering(mutant: Mutant, text: str, calls_by_test: Calls) -> list[str]:
    """Tests that call the function of a mutant: a case of each test function, then the other cases. In both,
    those of the module's own test file come first, then the quickest.

    Outside of functions, and where no test was seen to call the function (it is called at import, or in a
    process that a test starts), these are the tests that call any function of its file; without such tests
    the quickest of all, which at least imports the package.
    """
    around = [
        node
        for node in ast.walk(ast.parse(text))
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef)
        and node.body[0].lineno <= mutant.line <= (node.end_lineno or 0)
    ]
    of_module = f"/test_{Path(mutant.file).stem}.py::"
    by_time = sorted(calls_by_test, key=lambda test: (of_module not in test, calls_by_test[test][0], test))
    # one case of each function, then the others
    first = {test.split("[")[0]: test for test in reversed(by_time)}
    order = sorted(by_time, key=lambda test: first[test.split("[")[0]] != test)
    tests: list[str] = []
    if around:
        inner = max(around, key=lambda node: node.lineno)
        tests = [test for test in order if f"{mutant.file}:{first_line(inner)}" in calls_by_test[test][1]]
    if not tests:
        tests = [
            test for test in order if any(c.startswith(f"{mutant.file}:") for c in calls_by_test[test][1])
        ]
    return tests or [test for test in order if of_module not in test][:1]


# One mutant after another.


@dc.dataclass(frozen=True)
class Row:
    """What became of a mutant: killed, survived or timed out.

    Attributes:
        test: the functions that failed, up to FAILING, divided by blanks.
        tests: number of tests that were run, if all passed.
    """

    commit: str
    place: str
    before: str
    after: str
    kind: str
    outcome: str
    test: str
    tests: int
    seconds: float

    @property
    def key(self) -> Key:
        return self.place, self.before, self.after

    @property
    def failed(self) -> list[str]:
        """The functions that failed."""
        return self.test.split()


def raising(text: str) -> str | None:
    """Return a file whose public functions and methods raise; None if it has none."""
    tree = ast.parse(text)
    functions = [
        node
        for scope in (tree, *(node for node in tree.body if isinstance(node, ast.ClassDef)))
        for node in scope.body
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef) and not node.name.startswith("_")
    ]
    for function in functions:
        function.body = ast.parse("raise RuntimeError('a mutant')").body
    return ast.unparse(ast.fix_missing_locations(tree)) if functions else None


def lowest(root: Path, file: str, calls_by_test: Calls) -> str | None:
    """Return the cheapest test function that calls a file and fails when its public functions raise."""
    changed = raising((root / file).read_text(encoding="utf-8"))
    if changed is None:
        return None
    cases: dict[str, list[str]] = {}
    for test, (_, called) in calls_by_test.items():
        # the tests may be later than the map
        if any(call.startswith(f"{file}:") for call in called) and defined(root, test):
            cases.setdefault(test.split("[")[0], []).append(test)
    cost = {name: sum(calls_by_test[test][0] for test in members) for name, members in cases.items()}
    with replaced(root, file, changed):
        for name in sorted(cost, key=lambda name: (cost[name], name))[:CANDIDATES]:
            if run(root, [name], PATIENCE[0] * cost[name] + PATIENCE[1])[0] == "killed":
                return name
    return None


def find_floor(root: Path, calls_by_test: Calls, named: Sequence[str]) -> None:
    """Find the tests of the named files, or of all that have none, and write them one by one."""
    files = [path.relative_to(root).as_posix() for path in sorted((root / "src").rglob("*.py"))]
    tests = {file: test for file, test in read_floor().items() if file in files}
    for file in named or [file for file in files if file not in tests]:
        if test := lowest(root, file, calls_by_test):
            tests = {**tests, file: test}
            write_floor(tests)
        print(f"{file}  {test or 'no test that is mapped'}", flush=True)


def defined(root: Path, test: str) -> bool:
    """Return whether the file of a test still defines its function."""
    path, _, name = test.split("[")[0].partition("::")
    file = root / path
    return file.is_file() and f"def {name.split('::')[-1]}(" in file.read_text(encoding="utf-8")


def write_floor(rows: Mapping[str, str], file: Path = FLOOR) -> None:
    """Write the test of each source file."""
    with file.open("w", encoding="utf-8", newline="") as text:
        out = csv.writer(text, lineterminator="\n")
        out.writerow(("file", "test"))
        out.writerows(sorted(rows.items()))


def read_floor(file: Path = FLOOR) -> dict[str, str]:
    """Return the test of each source file."""
    with file.open(encoding="utf-8", newline="") as text:
        return {row["file"]: row["test"] for row in csv.DictReader(text)}


def environment(root: Path) -> dict[str, str]:
    """The environment of the tests of a tree, which import the package from there."""
    return {**os.environ, "PYTHONPATH": str(root / "src"), "PYTHONDONTWRITEBYTECODE": "1"}


def judge(root: Path, mutant: Mutant, calls_by_test: Calls, commit: str) -> Row:
    """Change a tree, run the tests that cover the change, and take the change back."""
    path = root / mutant.file
    text = path.read_text(encoding="utf-8")
    tests = covering(mutant, text, calls_by_test)[:TESTS]
    spent = itertools.accumulate((calls_by_test[test][0] for test in tests), initial=0.0)
    tests = [test for test, before in zip(tests, spent, strict=False) if before < SECONDS]
    began = time.monotonic()
    if not tests:  # pytest would run all that it finds
        return Row(commit, *mutant.key, mutant.kind, "survived", "", 0, 0.0)
    with replaced(root, mutant.file, mutant.applied(text)):
        outcome, failed = run(
            root, tests, PATIENCE[0] * sum(calls_by_test[t][0] for t in tests) + PATIENCE[1]
        )
    seconds = round(time.monotonic() - began, 1)
    return Row(commit, *mutant.key, mutant.kind, outcome, " ".join(failed), len(tests), seconds)


def confirmed(root: Path, rows: Sequence[Row], places: Iterable[Mutant], calls_by_test: Calls) -> list[Row]:
    """Take away functions that also fail without a change: the tests may be later than the map, and one may
    need what the commit does not have. A mutant that no other function killed is judged again.
    """
    functions = sorted({name for row in rows for name in row.failed if "::" in name})
    if not functions:
        return list(rows)
    seconds = sum(cost for test, (cost, _) in calls_by_test.items() if test.split("[")[0] in functions)
    outcome, failed = run(root, functions, PATIENCE[0] * seconds + PATIENCE[1])
    broken = {*functions} if outcome == "timed out" else {*failed}
    if not broken:
        return list(rows)
    others = {test: called for test, called in calls_by_test.items() if test.split("[")[0] not in broken}
    by_key = {mutant.key: mutant for mutant in places}

    def again(row: Row) -> Row:
        left = [name for name in row.failed if name not in broken]
        if left == row.failed:
            return row
        if left:
            return dc.replace(row, test=" ".join(left))
        return judge(root, by_key[row.key], others, row.commit)

    return confirmed(root, [again(row) for row in rows], by_key.values(), others)


@contextlib.contextmanager
def replaced(root: Path, file: str, text: str) -> Generator[None]:
    """Replace the text of a file of a tree inside the block."""
    path = root / file
    before = path.read_text(encoding="utf-8")
    path.write_text(text, encoding="utf-8")
    try:
        yield
    finally:
        path.write_text(before, encoding="utf-8")
        if file.startswith("src/deodar/compiler/"):  # it may have kept wrong programs
            link_programs(root)


def link_programs(root: Path) -> None:
    """Let a tree begin with the compiled programs of this one, without any that it has added."""
    programs = root / PROGRAMS
    shutil.rmtree(programs, ignore_errors=True)
    if (ROOT / PROGRAMS).exists():
        try:
            shutil.copytree(ROOT / PROGRAMS, programs, copy_function=os.link)
        except (OSError, shutil.Error):  # another disk
            shutil.copytree(ROOT / PROGRAMS, programs, dirs_exist_ok=True)


def run(root: Path, tests: Sequence[str], allowed: float) -> tuple[str, list[str]]:
    """Run tests until some fail: the outcome, and the functions that failed, up to FAILING cases."""
    with tempfile.TemporaryDirectory() as place:
        names = Path(place) / "tests"
        names.write_text("\n".join(tests), encoding="utf-8")
        command = ["-m", "pytest", "-q", "-p", "no:cacheprovider", "-p", "no:xdist", "--tb=no", "-rfE"]
        process = subprocess.Popen(
            [sys.executable, *command, f"--maxfail={FAILING}", f"@{names}"],
            cwd=root,
            env=environment(root),
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            start_new_session=True,
        )
        try:
            out, _ = process.communicate(timeout=allowed)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            process.communicate()
            return "timed out", []
    if process.returncode == 0:
        return "survived", []
    failed = [
        line.split(" ", 1)[1].split(" - ")[0].split("[")[0]
        for line in out.splitlines()
        if line.startswith(("FAILED ", "ERROR "))
    ]
    functions = list(dict.fromkeys(test.split("[")[0] for test in tests))
    if process.returncode == NOT_FOUND and not failed and functions != list(tests):
        return run(root, functions, allowed)  # the change gives a test other cases
    # a session that ends at import names no function
    return "killed", list(dict.fromkeys(failed)) or functions[:1]


def read(file: Path) -> list[Row]:
    """The rows of a file; none without a file."""
    if not file.exists():
        return []
    with file.open(encoding="utf-8", newline="") as text:
        return [
            Row(**{**row, "tests": int(row["tests"]), "seconds": float(row["seconds"])})  # type: ignore[arg-type]
            for row in csv.DictReader(text)
        ]


def write(file: Path, rows: Iterable[Row]) -> None:
    """Write all rows; what is there is replaced at once."""
    file.parent.mkdir(parents=True, exist_ok=True)
    new = file.with_suffix(".new")
    with new.open("w", encoding="utf-8", newline="") as text:
        out = csv.DictWriter(text, [f.name for f in dc.fields(Row)], lineterminator="\n")
        out.writeheader()
        out.writerows(dc.asdict(row) for row in rows)
    new.replace(file)


def equivalents(file: Path = EQUIVALENT) -> Mapping[Key, str]:
    """Return why a mutant (place, before, after) is equivalent to the package."""
    if not file.exists():
        return {}
    with file.open(encoding="utf-8", newline="") as text:
        return {(r["place"], r["before"], r["after"]): r["why"] for r in csv.DictReader(text)}


def write_kills(rows: Sequence[Row], file: Path = KILLS) -> None:
    """Write the functions that fail with mutants into the table that the verdict is chosen by; rows of other
    commits stay.
    """
    here = {row.commit[:8] for row in rows}
    with file.open(encoding="utf-8", newline="") as text:
        header, *others = csv.reader(text)
    with file.open("w", encoding="utf-8", newline="") as text:
        out = csv.writer(text, lineterminator="\n")
        out.writerow(header)
        out.writerows(kill for kill in others if kill[0] not in here)
        out.writerows(
            (row.commit[:8], row.place, row.after, name)
            for row in rows
            for name in row.failed
            if "::" in name
        )


def of_the_verdict() -> set[str]:
    """Return the functions that `make test` runs."""
    sys.path.insert(0, str(ROOT))
    from tests import durations, verdict  # of this tree alone: the others here work on any tree

    return verdict.chosen(durations.read(), verdict.read(verdict.KILLS), verdict.read(verdict.FLOOR))


def report(
    rows: Sequence[Row], equal: Mapping[Key, str], verdict: Collection[str] | None = None
) -> list[str]:
    """The share that is killed, that by functions of the verdict, and a line for each mutant that is not."""
    counted = [r for r in rows if r.key not in equal]

    def share(killed: int) -> str:
        return f"{killed} of {len(counted)} mutants killed ({100 * killed / max(1, len(counted)):.1f} %)"

    killed = sum(r.outcome == "killed" for r in counted)
    out = [f"{share(killed)}; {len(rows) - len(counted)} are equivalent"]
    if verdict is not None:
        out.append(f"{share(sum(any(test in verdict for test in r.failed) for r in counted))} by the verdict")
    return out + [
        f"{r.outcome:>12}  {r.place}  {r.kind}: {r.before}  ->  {r.after}"
        for r in counted
        if r.outcome != "killed"
    ]


def changed_lines(diff: str) -> dict[str, set[int]]:
    """Return the numbers of the lines that each file has gained, from what `git diff --unified=0` prints."""
    lines: dict[str, set[int]] = {}
    file = ""
    for row in diff.splitlines():
        if row.startswith("+++ "):
            file = row.removeprefix("+++ b/")
        elif row.startswith("@@"):
            start, _, count = row.split(" +", 1)[1].split(" ", 1)[0].partition(",")
            lines.setdefault(file, set()).update(range(int(start), int(start) + int(count or 1)))
    return lines


def beside(file: str) -> str:
    """Return the folder of the tests of a source file."""
    folder = ROOT / "tests" / Path(file).parent.relative_to("src")
    return next(p for p in (folder, *folder.parents) if p.is_dir()).relative_to(ROOT).as_posix()


def judge_changes(
    root: Path, map_file: Path, commit: str, since: str, count: int, minutes: float
) -> list[Row]:
    """Judge mutants of the lines that changed since a revision, until the minutes have passed; the map of
    their tests is completed first.
    """
    command = ["git", "diff", "--unified=0", since, commit, "--", "src/*.py"]
    diff = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout
    lines = {file: numbers for file, numbers in changed_lines(diff).items() if (root / file).is_file()}
    places = [
        mutant
        for file in sorted(lines)
        for mutant in mutants(file, (root / file).read_text(encoding="utf-8"))
        if mutant.line in lines[file]
    ]
    drawn = random.Random(commit).sample(places, min(count, len(places)))
    tested = {test.partition("::")[0] for test in calls(map_file)}
    folders = {beside(mutant.file) for mutant in drawn}
    if missing := sorted(f for f in folders if not any(test.startswith(f"{f}/") for test in tested)):
        note(root, map_file, ["-q", "-m", "fast or verdict", *missing])
    rows: list[Row] = []
    calls_by_test = calls(map_file)
    began = time.monotonic()
    for mutant in drawn:
        if time.monotonic() > began + 60 * minutes:
            print(f"{len(drawn) - len(rows)} of {len(drawn)} were not judged in {minutes:g} minutes")
            break
        rows.append(judge(root, mutant, calls_by_test, commit))
        print(
            f"{rows[-1].outcome:>12}  {rows[-1].place}  {rows[-1].before}  ->  {rows[-1].after}", flush=True
        )
    return confirmed(root, rows, drawn, calls_by_test)


def age(rows: Sequence[Row]) -> list[str]:
    """Return a line for each commit whose mutants are on record: its date, and its distance."""

    def git(*words: str) -> str:
        return subprocess.run(["git", *words], cwd=ROOT, capture_output=True, text=True).stdout.strip()

    lines: list[str] = []
    for commit in dict.fromkeys(row.commit for row in rows):
        date = git("log", "-1", "--format=%as", commit) or "a commit that is not here"
        ago = git("rev-list", "--count", f"{commit}..HEAD") or "?"
        lines.append(f"mutants of {commit[:8]}, {date}, {ago} commits ago")
    return lines


def tree(commit: str, into: Path) -> Path:
    """The files of a commit, with the tests of the working tree and the page that was built here."""
    archive = subprocess.run(["git", "archive", commit], cwd=ROOT, capture_output=True, check=True).stdout
    with tarfile.open(fileobj=io.BytesIO(archive)) as files:
        files.extractall(into, filter="data")
    shutil.rmtree(into / "tests")
    shutil.copytree(ROOT / "tests", into / "tests")
    if (page := ROOT / "src" / "deodar_studio" / "static").exists():
        shutil.copytree(page, into / page.relative_to(ROOT))
    link_programs(into)
    return into


def main(arguments: Sequence[str] | None = None) -> None:
    """Read the command line."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0] if __doc__ else "")
    commands = parser.add_subparsers(dest="command", required=True)
    for name in ("map", "run", "show", "floor", "changed"):
        command = commands.add_parser(name)
        command.add_argument("--commit", default="HEAD", help="draw by this commit, and change its files")
        if name == "changed":
            command.add_argument("since", metavar="REV", help="lines that changed since this revision")
            command.add_argument("--minutes", type=float, default=MINUTES, help="how long they are judged")
        if name in ("run", "changed"):
            count = COUNT if name == "run" else 20
            command.add_argument("--count", type=int, default=count, help="how many are drawn")
        if name == "show":
            command.add_argument("--short", action="store_true", help="without the survivors")
        if name == "run":
            command.add_argument("--again", action="store_true", help="judge survivors once more")
    given, rest = parser.parse_known_args(arguments)
    if rest and given.command not in ("map", "floor"):
        parser.error(f"unknown: {' '.join(rest)}")
    name = ["git", "rev-parse", given.commit]
    commit = subprocess.run(name, cwd=ROOT, capture_output=True, text=True, check=True).stdout.strip()
    map_file = KEPT / f"{commit}.jsonl"
    rows = read(ROWS)
    if given.command == "show":
        lines = report(rows, equivalents(), of_the_verdict())
        print(*age(rows), *lines[: 2 if given.short else None], sep="\n")
        return
    with tempfile.TemporaryDirectory() as place:
        root = tree(commit, Path(place).resolve())
        if given.command == "map":
            sys.exit(note(root, map_file, rest or ["tests"]))
        if given.command == "changed":
            rows = judge_changes(root, map_file, commit, given.since, given.count, given.minutes)
            print("\n".join(report(rows, equivalents())))
            return
        calls_by_test = calls(map_file)
        if not calls_by_test:
            parser.error(
                f"no map of {commit[:7]}; type `python tools/mutate.py map --commit {commit[:7]}` first"
            )
        if given.command == "floor":
            find_floor(root, calls_by_test, rest)
            return
        rows = [r for r in rows if r.commit == commit]
        done = {r.key for r in rows if r.outcome == "killed" or not given.again}
        drawn = draw(root, commit, given.count)
        for mutant in drawn:
            if mutant.key in done:
                continue
            row = judge(root, mutant, calls_by_test, commit)
            rows = [*(r for r in rows if r.key != mutant.key), row]
            write(ROWS, rows)
            print(f"{row.outcome:>12}  {row.place}  {row.kind}: {row.before}  ->  {row.after}", flush=True)
        rows = confirmed(root, rows, drawn, calls_by_test)
    write(ROWS, rows)
    write_kills(rows)
    print("\n".join(report(rows, equivalents())[:1]))


if __name__ == "__main__":
    main()
