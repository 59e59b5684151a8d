"""The mutation command: its mutations, its draws, the tests that it runs, and its counts."""

from __future__ import annotations

import re
import sys
from pathlib import Path
from typing import Any

import pytest

from tests.house.source import ROOT

sys.path.insert(0, str(ROOT / "tools"))
import mutate


@pytest.mark.parametrize(
    ("text", "kind", "changed"),
    [
        ("a < b", "comparison", "(a <= b)"),
        ("x = [i for i in y if i not in z]", "comparison", "x = [i for i in y if (i in z)]"),
        ("a + b * c", "arithmetic", "(a - b * c)"),
        ("a + b * c", "arithmetic", "a + (b / c)"),
        ("é = 1", "constant", "é = (2)"),
        ("x = 'é', True", "constant", "x = 'é', (False)"),
        ("a and b", "boolean", "(a or b)"),
        ("if not a: b", "boolean", "if (a): b"),
        ("x = a if b else c", "condition", "x = (c if b else a)"),
        ("def f():\n    return 'a'", "return value", "def f():\n    return None"),
        ("f()", "removed statement", "pass"),
        ("self.a = b", "removed statement", "pass"),
        ("x = f(a, b, c)", "swapped argument", "x = (f(b, a, c))"),
        (
            "def f():\n    for i in a:\n        g(i)",
            "only the first",
            "def f():\n    for i in (list(a)[:1]):\n        g(i)",
        ),
        (
            "x = {i: j for i, j in a for k in b}",
            "only the first",
            "x = {i: j for i, j in (list(a)[:1]) for k in b}",
        ),
        ("x = sum(f(i) for i in a)", "only the first", "x = sum(f(i) for i in (list(a)[:1]))"),
        ("x = max(a, key=f)", "of several", "x = (min(a, key=f))"),
        ("x = sum(a)", "of several", "x = (max(a))"),
    ],
)
def test_a_mutant_changes_one_expression(text: str, kind: str, changed: str) -> None:
    places = [m.applied(text) for m in mutate.mutants("a.py", text) if m.kind == kind]
    assert changed in places


@pytest.mark.parametrize(
    "text",
    [
        "def f(a: 'int | None') -> list[3]: ...",
        "x: Literal[1]",
        "if TYPE_CHECKING:\n    f(a, b)",
        "class A(Protocol):\n    x = 1",
        "x = f'{a + 1}'",
        "def f():\n    return None",
    ],
)
def test_annotations_protocols_and_f_strings_are_not_mutated(text: str) -> None:
    assert not list(mutate.mutants("a.py", text))


@pytest.mark.parametrize("text", ["x = 1e300", "x = f(a, a)", "x = a if b else a"])
def test_no_mutant_equals_its_source(text: str) -> None:
    assert not list(mutate.mutants("a.py", text))


def test_the_same_commit_draws_the_same_mutants(tmp_path: Path) -> None:
    (tmp_path / "src").mkdir()
    (tmp_path / "src" / "a.py").write_text("\n".join(f"x{i} = {i}" for i in range(50)))
    drawn = mutate.draw(tmp_path, "abc", 10)
    assert drawn == mutate.draw(tmp_path, "abc", 10) != mutate.draw(tmp_path, "abd", 10)
    assert len(set(drawn)) == 10 and len(mutate.draw(tmp_path, "abc", 100)) == 50


def test_mutants_are_killed_or_survive_by_the_tests_that_cover_them(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    # this saves time at the start of the three processes
    monkeypatch.setenv("PYTEST_DISABLE_PLUGIN_AUTOLOAD", "1")
    (tmp_path / "src").mkdir()
    (tmp_path / "src" / "toy.py").write_text(
        "def total(a, b):\n    return a + b\n\n"
        "def large(a):\n    return a > 10\n\n"
        "def unused(a):\n    return a * 2\n"
    )
    (tmp_path / "test_toy.py").write_text(
        "import toy\ndef test_total(): assert toy.total(1, 2) == 3\ndef test_large(): assert toy.large(20)\n"
        "def test_wrong(): assert toy.unused(1) == 1\n"
    )
    calls = tmp_path / "calls.jsonl"
    mutate.note(tmp_path, calls, ["-q", "-p", "no:cacheprovider", "test_toy.py"])
    found = mutate.calls(calls)
    assert {test: set(called) for test, (_, called) in found.items()} == {
        "test_toy.py::test_total": {"src/toy.py:1"},
        "test_toy.py::test_large": {"src/toy.py:4"},
    }
    text = (tmp_path / "src" / "toy.py").read_text()
    chosen = [m for m in mutate.mutants("src/toy.py", text) if m.kind in ("arithmetic", "comparison")]
    rows = [mutate.judge(tmp_path, m, found, "abc") for m in chosen]
    assert [(r.place, r.outcome, r.test) for r in rows] == [
        ("src/toy.py:2:12", "killed", "test_toy.py::test_total"),
        ("src/toy.py:5:12", "survived", ""),
        ("src/toy.py:8:12", "survived", ""),
    ]
    assert mutate.lowest(tmp_path, "src/toy.py", found) in (
        "test_toy.py::test_total",
        "test_toy.py::test_large",
    )
    assert mutate.lowest(tmp_path, "src/toy.py", {}) is None
    assert (tmp_path / "src" / "toy.py").read_text() == text
    mutate.write(tmp_path / "rows.csv", rows)
    assert mutate.read(tmp_path / "rows.csv") == rows
    kills = "commit,place,after,test\n{}other,p,a,t\n"
    (tmp_path / "kills.csv").write_text(kills.format("abc,p,a,t\n"))
    mutate.write_kills(rows, tmp_path / "kills.csv")
    row = "abc,src/toy.py:2:12,(a - b),test_toy.py::test_total\n"
    assert (tmp_path / "kills.csv").read_text() == kills.format("") + row
    assert mutate.report(rows, {rows[1].key: "the test is about 20 alone"}, {"test_toy.py::test_large"}) == [
        "1 of 2 mutants killed (50.0 %); 1 are equivalent",
        "0 of 2 mutants killed (0.0 %) by the verdict",
        "    survived  src/toy.py:8:12  arithmetic: a * 2  ->  (a / 2)",
    ]


def test_a_test_that_fails_without_the_change_kills_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PYTEST_DISABLE_PLUGIN_AUTOLOAD", "1")
    (tmp_path / "src").mkdir()
    (tmp_path / "src" / "toy.py").write_text("def total(a, b):\n    return a + b\n")
    (tmp_path / "test_toy.py").write_text(
        "import toy\ndef test_later(): assert toy.total(1, 2) == 4\n"
        "def test_zero(): assert toy.total(1, 0) == 1\ndef test_sum(): assert toy.total(1, 2) == 3\n"
    )
    places = mutate.mutants("src/toy.py", "def total(a, b):\n    return a + b\n")
    [change] = [m for m in places if m.kind == "arithmetic"]
    later, zero, right = (f"test_toy.py::test_{name}" for name in ("later", "zero", "sum"))
    called = {test: (k / 10, {"src/toy.py:1"}) for k, test in enumerate((later, zero, right))}

    def outcome(calls: mutate.Calls) -> tuple[str, list[str]]:
        [row] = mutate.confirmed(tmp_path, [mutate.judge(tmp_path, change, calls, "abc")], [change], calls)
        return row.outcome, row.failed

    assert outcome(called) == ("killed", [right])
    assert outcome({name: called[name] for name in (later, right)}) == ("killed", [right])
    assert outcome({later: called[later]}) == ("survived", [])


@pytest.mark.parametrize("condition", ["case", "case in (2, 3)"])
def test_a_change_of_the_cases_of_a_test_alone_kills_nothing(
    condition: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PYTEST_DISABLE_PLUGIN_AUTOLOAD", "1")
    (tmp_path / "src").mkdir()
    (tmp_path / "src" / "toy.py").write_text("CASES = [3]\n")
    (tmp_path / "test_toy.py").write_text(
        "import pytest, toy\n@pytest.mark.parametrize('case', toy.CASES)\n"
        f"def test_case(case): assert {condition}\n"
    )
    [change] = mutate.mutants("src/toy.py", "CASES = [3]\n")
    row = mutate.judge(tmp_path, change, {"test_toy.py::test_case[3]": (0.1, {"src/toy.py:1"})}, "abc")
    assert row.outcome == ("survived" if condition == "case" else "killed")


def test_the_test_file_of_the_module_comes_first_then_the_quickest_case_of_each_function() -> None:
    text = "def total(a, b):\n    return a + b\n\nSTART = 1 + 1\n\ndef late(a):\n    return a + 1\n"
    sums = [m for m in mutate.mutants("src/toy.py", text) if m.kind == "arithmetic"]
    found = {
        "tests/test_other.py::quick": (0.1, {"src/other.py:1"}),
        "tests/test_both.py::slow[1]": (3.0, {"src/toy.py:1"}),
        "tests/test_both.py::slow[2]": (0.5, {"src/toy.py:1"}),
        "tests/test_both.py::quicker": (1.0, {"src/toy.py:1"}),
        "tests/test_toy.py::own": (5.0, {"src/toy.py:1"}),
    }
    both = ("slow[2]", "quicker", "slow[1]")
    called = ["tests/test_toy.py::own", *(f"tests/test_both.py::{name}" for name in both)]
    # within a function, outside of functions, and in a function that no mapped test calls
    assert [mutate.covering(m, text, found) for m in sums] == [called, called, called]
    assert mutate.covering(sums[0], text, {"tests/test_other.py::quick": (0.1, {"src/other.py:1"})}) == [
        "tests/test_other.py::quick"
    ]


def test_a_mutant_that_times_out_survives(tmp_path: Path) -> None:
    (tmp_path / "test_slow.py").write_text("import time\ndef test_slow(): time.sleep(600)\n")
    assert mutate.run(tmp_path, ["test_slow.py::test_slow"], 0.5) == ("timed out", [])


def test_public_functions_and_methods_raise_and_private_ones_do_not() -> None:
    text = (
        "def f(): return 1\n\ndef _g(): return 2\n\n"
        "class A:\n    def h(self): return 3\n    def _i(self): return 4\n"
    )
    changed = mutate.raising(text)
    assert changed is not None
    names: dict[str, Any] = {}
    exec(changed, names)
    assert names["_g"]() == 2 and names["A"]()._i() == 4
    for call in (names["f"], names["A"]().h):
        with pytest.raises(RuntimeError, match="a mutant"):
            call()
    assert mutate.raising("x = 1\ndef _f(): return 1\n") is None


def test_the_floor_is_read_as_it_was_written(tmp_path: Path) -> None:
    rows = {"src/b.py": "tests/test_b.py::test_x", "src/a.py": "tests/test_a.py::test_y"}
    mutate.write_floor(rows, tmp_path / "floor.csv")
    assert mutate.read_floor(tmp_path / "floor.csv") == rows


def test_the_lines_that_a_file_has_gained_are_read_from_a_diff() -> None:
    diff = (
        "--- a/src/a.py\n+++ b/src/a.py\n@@ -1 +1,2 @@ def f():\n-x\n+y\n+z\n"
        "@@ -9,0 +11 @@\n+w\n+++ b/src/b.py\n@@ -3,2 +0,0 @@\n-u\n-v\n"
    )
    assert mutate.changed_lines(diff) == {"src/a.py": {1, 2, 11}, "src/b.py": set()}


@pytest.mark.parametrize(
    ("file", "folder"),
    [
        ("src/deodar/model/edit.py", "tests/deodar/model"),
        ("src/deodar/model/checks/units.py", "tests/deodar/model"),
        ("src/deodar/errors.py", "tests/deodar"),
    ],
)
def test_the_tests_of_a_file_lie_in_the_folder_of_its_name(file: str, folder: str) -> None:
    assert mutate.beside(file) == folder


def test_the_age_of_a_record_is_that_of_its_commits() -> None:
    rows = [
        mutate.Row(commit, "src/a.py:1:1", "a", "b", "constant", "killed", "t", 1, 0.1)
        for commit in ("HEAD", "x")
    ]
    first, second = mutate.age(rows)
    # the second where the folder is not that of git
    assert re.fullmatch(
        r"mutants of HEAD, (\d{4}-\d\d-\d\d, 0|a commit that is not here, \?) commits ago", first
    )
    assert second == "mutants of x, a commit that is not here, ? commits ago"
