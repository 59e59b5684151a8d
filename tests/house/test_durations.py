"""The markers `fast` and `long` follow from measured CPU time; programs compile quickly unless tests judge
bits.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from tests import conftest, durations


def test_every_slow_test_exists() -> None:
    gone = [test for test in durations.seconds() if not durations.exists(test)]
    assert not gone, (
        f"durations.csv lists tests that are gone; type `pytest --write-durations FILE`: {gone[:5]}"
    )


def test_a_measured_function_replaces_its_row_and_others_keep_theirs(tmp_path: Path) -> None:
    file = tmp_path / "durations.csv"
    here = "tests/house/test_durations.py"
    kept, quicker, slower = (
        f"{here}::{name}"
        for name in (
            "test_every_slow_test_exists",
            "test_a_test_without_a_row_is_fast",
            "test_every_default_program_exists",
        )
    )
    file.write_text(f"test,seconds\n{kept},0.2\n{quicker},5.0\n{here}::test_that_is_gone,7.0\n")
    durations.write({quicker: 0.1, slower: 2.04}, file)
    assert durations.seconds(file) == {kept: 0.2, slower: 2.0}, "0.2 may be more, before it was rounded"


def test_the_cases_of_a_function_count_together() -> None:
    assert durations.function("tests/a/test_b.py::test_c[x-1]") == "tests/a/test_b.py::test_c"
    assert durations.files({"a.py::x": 1.0, "a.py::y": 2.0, "b.py::x": 4.0}) == {"a.py": 3.0, "b.py": 4.0}


def test_a_function_spends_its_share_and_the_other_cases_are_long() -> None:
    cases = [f"a.py::many[{k}]" for k in range(10)]
    all_cases = [*cases, "a.py::quick", "a.py::whole", *(f"a.py::heavy[{k}]" for k in range(3))]
    rows = {"a.py::many": 2 * durations.SHARE, "a.py::whole": durations.SHARE + 1, "a.py::heavy": 90.0}
    long = durations.long_cases(all_cases, rows)
    assert set(cases) - long == set(cases[1::2]), "half of the cases, at regular distances"
    assert "a.py::quick" not in long, "a function without a row"
    assert long - set(cases) == {"a.py::whole", *(f"a.py::heavy[{k}]" for k in range(3))}


def test_some_functions_are_never_long() -> None:
    assert all(durations.exists(name) for name in durations.ALWAYS)
    assert durations.long_cases(durations.ALWAYS, dict.fromkeys(durations.ALWAYS, 90.0)) == set()


def test_every_long_file_of_browser_tests_exists() -> None:
    studio = Path(conftest.__file__).parents[1] / "studio"
    listed = re.findall(r'^  "(\w+)",$', (studio / "vitest.short.ts").read_text(), re.MULTILINE)
    assert listed and listed == sorted(listed)
    assert [name for name in listed if not (studio / "browser" / f"{name}.test.ts").is_file()] == []


def test_the_files_of_slow_tests_without_a_row_are_named() -> None:
    def report(nodeid: str, seconds: float) -> pytest.TestReport:
        return pytest.TestReport(nodeid, ("", 0, ""), {}, "passed", None, "call", duration=seconds)

    cases = [report(f"b.py::x[{k}]", 1.2) for k in range(2)]
    assert durations.unlisted([report("a.py::x", 1.2), *cases, report("a.py::y", 0.1)]) == ["b.py"]


def test_a_test_without_a_row_is_fast(request: pytest.FixtureRequest) -> None:
    assert request.node.get_closest_marker("fast")
    assert not request.node.get_closest_marker("default_program")


def test_programs_are_compiled_quickly_without_the_option_default_programs(
    request: pytest.FixtureRequest,
) -> None:
    default = request.config.getoption("--default-programs")
    given = set(os.environ.get("XLA_FLAGS", "").split())
    assert given.isdisjoint(conftest.QUICK_PROGRAMS) if default else given.issuperset(conftest.QUICK_PROGRAMS)


def test_every_default_program_exists() -> None:
    root = Path(conftest.__file__).parents[1]
    places = [place.partition("::") for place in conftest.DEFAULT_PROGRAM]
    assert all((root / file).exists() for file, _, _ in places)
    assert all(
        f"def {durations.function(name)}" in (root / file).read_text() for file, _, name in places if name
    )


def test_processes_keep_byte_code(tmp_path: Path) -> None:
    (tmp_path / "imported.py").write_text("x = 1\n")
    subprocess.run([sys.executable, "-c", "import imported"], cwd=tmp_path, check=True)
    assert list(tmp_path.rglob("imported.*.pyc"))


def test_what_a_fixture_of_a_module_takes_counts_for_every_user(tmp_path: Path) -> None:
    (tmp_path / "test_shared.py").write_text(
        "import pytest, time\n"
        "@pytest.fixture(scope='module')\n"
        "def made():\n"
        "    end = time.process_time() + 0.5\n"
        "    while time.process_time() < end: pass\n"
        "@pytest.mark.parametrize('k', [1, 2])\n"
        "def test_first(made, k): pass\n"
        "def test_second(made): pass\n"
        "def test_other(): pass\n"
    )
    code = (
        "import pytest; from tests import durations\n"
        "recorder = durations.Recorder(); durations.write = lambda found: None\n"
        f"assert pytest.main(['-q', {str(tmp_path)!r}], [recorder]) == 0\n"
        "print({name.split('::')[1]: round(s, 1) for name, s in recorder.seconds.items()})"
    )
    root = Path(conftest.__file__).parents[1]
    run = subprocess.run([sys.executable, "-c", code], cwd=root, capture_output=True, text=True, check=True)
    assert "{'test_first': 0.5, 'test_second': 0.5, 'test_other': 0.0}" in run.stdout
