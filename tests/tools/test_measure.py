"""The measures of the code base: each count finds its examples."""

from __future__ import annotations

import ast
import functools
import re
import sys
from pathlib import Path

import pytest

from tests.house.source import ROOT

sys.path.insert(0, str(ROOT / "tools"))
import measure


@functools.cache
def sources() -> dict[str, ast.Module]:
    """Return every module of the packages, read once."""
    return measure.trees(*measure.packages())


def package(folder: Path, **files: str) -> Path:
    root = folder / "toy"
    root.mkdir()
    for name, text in files.items():
        (root / f"{name}.py").write_text(text)
    return root


def test_a_name_of_two_classes_or_aliases_is_found_with_its_modules(tmp_path: Path) -> None:
    root = package(
        tmp_path,
        a="class Box: ...\nTree = dict[str, int]\nLIMIT = 3",
        b="class Box: ...\nTree: TypeAlias = 'list[int]'\nLIMIT = 4",
        c="class Other: ...",
    )
    assert measure.doubled(measure.trees(root)) == ["Box: toy/a.py, toy/b.py", "Tree: toy/a.py, toy/b.py"]


def test_modules_in_the_words_of_other_tools_may_repeat_names(tmp_path: Path) -> None:
    root = package(tmp_path, a="class Box: ...", compat="class Box: ...")
    assert measure.doubled(measure.trees(root)) == []


def test_any_is_counted_through_aliases_and_not_in_metadata(tmp_path: Path) -> None:
    root = package(
        tmp_path,
        a="Tree = dict[str, Any]\nForest = list[Tree]",
        b="def f(a: Forest, b: 'object', c: Annotated[int, Any], d: str) -> int: ...\nx: Tree = {}",
        c="Wood: TypeAlias = 'Forest | None'\ny: Wood = None",
    )
    held, total, by = measure.loose(measure.trees(root))
    assert (held, total, by["toy/b.py"], by["toy/c.py"]) == (4, 8, 3, 1)


def test_at_most_8_per_cent_of_the_annotations_hold_any_or_object() -> None:
    held, total, _ = measure.loose(sources())
    assert held <= 0.08 * total, "give them types: python tools/measure.py --where lists the places"


def test_parameters_of_every_kind_count_and_self_does_not(tmp_path: Path) -> None:
    root = package(
        tmp_path,
        a="class A:\n"
        "    def f(self, a, b, c, /, d, e, *f, g): ...\n"
        "    def g(self, a, b, c, d, e, f, *g, h, **i): ...\n",
    )
    assert measure.crowded(measure.trees(root)) == ["toy/a.py:3 g (9)"]


def test_a_cycle_through_an_import_in_a_function_is_found(tmp_path: Path) -> None:
    root = package(tmp_path, a="def f():\n    from toy import b", b="from toy.c import x", c="import toy.a")
    assert set(measure.cycle(measure.graph(measure.trees(root)))) == {"toy.a", "toy.b", "toy.c"}
    (root / "c.py").write_text("x = 1")
    assert measure.cycle(measure.graph(measure.trees(root))) == []


def test_an_import_in_a_function_needs_a_reason(tmp_path: Path) -> None:
    root = package(
        tmp_path,
        a="def f():\n    # an extra\n    import cv2\n    import zmq\n"
        "def g():\n    import json\n\n    import re  # why\n"
        "def h():\n    import json\n",
    )
    assert measure.inner_imports(tmp_path, measure.trees(root)) == ["toy/a.py:10"]


def test_the_words_of_the_optimiser_are_found_in_physics(tmp_path: Path) -> None:
    root = package(tmp_path, a="rest = 1\nREST = 2\nx = 'waves'\n# sharing\n")
    assert measure.worded(tmp_path, ["toy"]) == ["toy/a.py:2", "toy/a.py:3", "toy/a.py:4"]
    assert root.is_dir()


def test_the_command_prints_every_limit_and_marks_those_exceeded(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    figures = [
        measure.Figure("good", 1, 2),
        measure.Figure("bad", 3.5, 2, ["here"], "s"),
        measure.Figure("free", 9),
    ]
    monkeypatch.setattr(measure, "counted", lambda: iter(figures))
    assert measure.main([]) == 1
    good, bad, place, free = capsys.readouterr().out.splitlines()
    assert good.split() == ["good", "1", "at", "most", "2"] and free.split() == ["free", "9"]
    assert bad.split() == ["bad", "3.5", "s", "at", "most", "2", "s", "BROKEN"] and place.strip() == "here"
    assert measure.Figure("even", 2, 2).holds


def test_only_public_calls_of_scripts_have_eight_and_more_parameters() -> None:
    found = {" ".join(line.split()[:2]) for line in measure.crowded(sources())}
    assert {re.sub(r":\d+", "", place) for place in found} == {
        "deodar/analysis/continuation/continuation.py continuation",
        "deodar/batch/simulate.py simulate",
        "deodar/gradients/rollout.py rollout",
        "deodar_interop/compat/cosivina/window_controls.py __init__",
    }


def test_conditions_of_expressions_count_as_branches(tmp_path: Path) -> None:
    many = " and ".join(["x"] * 20)
    root = package(
        tmp_path,
        a=f"def few(x): return {many}\ndef more(x): return {many} or x\n",
        b=f"class A:\n    def f(self, x): return {many} or x\n    def g(self, x):\n"
        + "        if x: return 1\n" * 30,
    )
    assert measure.branched(root) == {"toy/a.py more": 21, "toy/b.py A.f": 21, "toy/b.py A.g": 31}


def test_no_class_or_alias_of_the_package_shares_its_name() -> None:
    assert measure.doubled(sources()) == []


def test_every_import_in_a_function_states_its_reason() -> None:
    assert measure.inner_imports(measure.SOURCE, sources()) == []


def test_lines_are_counted_without_blank_lines_comments_and_docstrings(tmp_path: Path) -> None:
    text = (
        '"""A module.\n\nIts text.\n"""\n\n# a comment\n'
        'x = """one\ntwo"""  # kept\n\n\ndef f():\n    """Why."""\n    return x\n'
    )
    assert measure.counted_lines(text) == (13, 4)
    root = package(tmp_path, a=text, b="y = 1\n")
    assert [(f.what.split()[-1], f.value) for f in measure.sizes([root])] == [
        *(("toy", 14), ("docstrings", 5)),
        *(("src", 14), ("docstrings", 5)),
    ]


def test_every_package_beside_deodar_is_measured(tmp_path: Path) -> None:
    for name in ("deodar", "deodar_robots", "deodar.egg-info", "other"):
        (tmp_path / name).mkdir()
    for name in ("deodar", "deodar_robots", "other"):
        (tmp_path / name / "__init__.py").write_text("")
    assert [path.name for path in measure.packages(tmp_path)] == ["deodar", "deodar_robots"]
    (tmp_path / "deodar_robots" / "arm.py").write_text("import deodar")
    imports = measure.graph(measure.trees(*measure.packages(tmp_path)))
    assert imports["deodar_robots.arm"] == {"deodar"}


def test_an_interpreter_without_the_tools_of_the_tests_is_refused() -> None:
    with pytest.raises(SystemExit, match=r"cannot run -m no_such_tool: .*\n.*pip install"):
        measure._python("-m", "no_such_tool")
