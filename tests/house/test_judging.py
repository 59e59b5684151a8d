"""Every test judges something: no path to its end is without an assertion."""

from __future__ import annotations

import ast
import functools
from collections.abc import Iterator, Mapping, Sequence

from tests.house.source import ROOT, at, tree

Function = ast.FunctionDef | ast.AsyncFunctionDef
Functions = Mapping[str, Function]

FAILING = {"raises", "warns", "fail", "until", "check_schema", "check_env"}
"""Calls that fail a test, besides helpers of the tests that assert and what begins with `assert_`. `until`
waits for a condition and raises after a time.
"""
FINDING = {"glob", "rglob", "iterdir", "filter"}
"""Calls that may return nothing: a loop over one may have no turn, as one over what a condition left."""


def _own(node: ast.AST) -> Iterator[ast.AST]:
    """Yield a node and what it contains, without the functions in it."""
    yield node
    for child in ast.iter_child_nodes(node):
        if not isinstance(child, Function | ast.Lambda | ast.ClassDef):
            yield from _own(child)


@functools.cache
def _calls(node: ast.AST) -> frozenset[str]:
    """Return the last names of what a statement calls, also in a lambda that it hands on."""
    called = (inside.func for inside in ast.walk(node) if isinstance(inside, ast.Call))
    return frozenset(f.attr if isinstance(f, ast.Attribute) else getattr(f, "id", "") for f in called)


def _fails(node: ast.AST, helpers: frozenset[str]) -> bool:
    called = _calls(node)
    return bool(called & (helpers | FAILING)) or any(name.startswith("assert_") for name in called)


def _turns(iterated: ast.expr) -> bool:
    """Return whether a loop has a turn; not, if what it visits was searched, or is left by a condition."""
    chosen = any(isinstance(inside, ast.comprehension) and inside.ifs for inside in ast.walk(iterated))
    return not chosen and not _calls(iterated) & FINDING


def _judge(body: Sequence[ast.stmt], helpers: frozenset[str], turn: bool = False) -> bool:
    """Return whether every path to the end of some statements, or of a turn, meets an assertion."""
    for statement in body:
        if _judges(statement, helpers):
            return True
        if _leaves(statement, helpers, turn):
            return False
    return False


def _leaves(statement: ast.stmt, helpers: frozenset[str], turn: bool) -> bool:
    """Return whether a statement may end its function, or a turn of its loop, before an assertion."""
    if isinstance(statement, ast.If):
        branches = (statement.body, statement.orelse)
        return any(
            any(_leaves(s, helpers, turn) for s in b) and not _judge(b, helpers, turn) for b in branches
        )
    ends = ast.Return | ast.Continue if turn else ast.Return
    return not isinstance(statement, Function) and any(isinstance(s, ends) for s in _own(statement))


def _judges(statement: ast.stmt, helpers: frozenset[str]) -> bool:
    judge = functools.partial(_judge, helpers=helpers)
    match statement:
        case ast.Assert() | ast.Raise():
            return True
        case ast.If(body=body, orelse=other):
            return judge(body) and judge(other)
        case ast.With(items=items, body=body) | ast.AsyncWith(items=items, body=body):
            return any(_fails(item, helpers) for item in items) or judge(body)
        case ast.For(iter=iterated, body=body) | ast.AsyncFor(iter=iterated, body=body):
            return _turns(iterated) and judge(body, turn=True)
        case ast.While(test=test, body=body):
            return _fails(test, helpers) or judge(body, turn=True)
        case ast.Try(body=body, handlers=handlers, orelse=other, finalbody=last):
            return judge(last) or (judge([*body, *other]) and all(judge(h.body) for h in handlers))
        case ast.Match(cases=cases):
            return all(judge(case.body) for case in cases)
        case ast.FunctionDef(body=body) | ast.AsyncFunctionDef(body=body):
            return judge(body)  # a scene, or what a thread runs
        case ast.ClassDef():
            return False
        case _:
            return _fails(statement, helpers)


def without_judgement(files: Mapping[str, Functions]) -> list[tuple[str, str]]:
    """Return file and name of the tests that can end without an assertion.

    A helper that a file lacks is that of other files, if all of that name assert.
    """
    open_: dict[str, Functions] = dict(files)
    while True:
        silent = {name for functions in open_.values() for name in functions}
        shared = {name for functions in files.values() for name in functions} - silent
        own = {file: functions.keys() - open_[file].keys() for file, functions in files.items()}
        helpers = {file: frozenset((shared - files[file].keys()) | own[file]) for file in files}
        left = {
            file: {name: f for name, f in functions.items() if not _judge(f.body, helpers[file])}
            for file, functions in open_.items()
        }
        if left == open_:
            return [(file, name) for file in left for name in left[file] if name.startswith("test_")]
        open_ = left


def _functions(module: ast.Module) -> Functions:
    return {node.name: node for node in ast.walk(module) if isinstance(node, Function)}


def test_every_test_judges_something() -> None:
    paths = {path.as_posix(): path for path in sorted((ROOT / "tests").rglob("*.py"))}
    files = {name: _functions(tree(path)) for name, path in paths.items()}
    wrong = [f"{at(paths[f], files[f][name].lineno)} {name}" for f, name in without_judgement(files)]
    assert not wrong, f"assert what is true on every path, or leave out the cases that judge nothing: {wrong}"


def test_tests_that_can_end_without_an_assertion_are_found() -> None:
    text = """
def test_nothing(): run()
def test_returns(kind):
    if kind: return
    assert kind
def test_if(kind):
    if kind: assert kind
def test_found():
    for path in ROOT.glob("*"): assert path
def test_continues():
    for x in ALL:
        if x: continue
        assert x
def test_chosen():
    for x in [x for x in ALL if x]: assert x
def test_caught():
    try: assert f()
    except E: pass
def test_quiet(): quiet(1)
def quiet(x): return x
def test_helped(): helper(1)
def helper(x): assert x
def test_both(kind):
    if kind:
        assert kind
        return
    with pytest.raises(E): f()
def test_scene():
    def scene(p): assert p
    play(scene)
def test_numbers(): np.testing.assert_allclose(1, 1)
"""
    found = [name for _, name in without_judgement({"": _functions(ast.parse(text))})]
    named = ("nothing", "returns", "if", "found", "continues", "chosen", "caught", "quiet")
    assert found == [f"test_{name}" for name in named]
