"""Order and markers of tests follow from measured CPU time; programs compile quickly unless tests judge
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
from tests.durations import Duration

HERE = "tests/house/test_durations.py"
KEPT, QUICKER, SLOWER = (
    f"{HERE}::{name}"
    for name in (
        "test_every_row_is_that_of_a_test",
        "test_a_test_without_a_row_is_fast_and_in_the_verdict",
        "test_every_default_program_exists",
    )
)


def test_every_row_is_that_of_a_test() -> None:
    gone = [test for test in durations.read() if not durations.exists(test)]
    assert not gone, (
        f"durations.csv lists tests that are gone; type `pytest --write-durations FILE`: {gone[:5]}"
    )


def test_a_measured_function_replaces_its_row_and_others_keep_theirs(tmp_path: Path) -> None:
    file = tmp_path / "durations.csv"
    shared, unused = f"{HERE}::made", f"{HERE}::unused"
    file.write_text(
        f"test,seconds,fixtures\n{KEPT},0.20,{shared}\n{QUICKER},5.00,{unused}\n"
        f"{shared},3.00,\n{unused},4.00,\n{HERE}::test_that_is_gone,7.00,\n"
    )
    durations.write({QUICKER: Duration(0.123), SLOWER: Duration(2.04)}, file)
    assert durations.read(file) == {
        KEPT: Duration(0.2, frozenset({shared})),
        QUICKER: Duration(0.12),
        SLOWER: Duration(2.04),
        shared: Duration(3.0),
    }


def test_the_cases_of_a_function_and_the_functions_of_a_file_count_together() -> None:
    assert durations.function("tests/a/test_b.py::test_c[x-1]") == "tests/a/test_b.py::test_c"
    rows = {"a.py::test_x": Duration(1.0), "a.py::made": Duration(2.0), "b.py::test_x": Duration(4.0)}
    assert durations.files(rows) == {"a.py": 3.0, "b.py": 4.0}


def test_functions_that_share_a_fixture_are_one_unit() -> None:
    rows = {
        "a.py::test_x": Duration(1.0, frozenset({"a.py::one"})),
        "a.py::test_y": Duration(1.0, frozenset({"a.py::one", "a.py::two"})),
        "a.py::test_z": Duration(1.0, frozenset({"a.py::two"})),
        "a.py::test_alone": Duration(1.0),
        "a.py::one": Duration(5.0),
        "a.py::two": Duration(5.0),
    }
    together = frozenset(rows) - {"a.py::test_alone"}
    assert set(durations.units(rows)) == {together, frozenset({"a.py::test_alone"})}
    assert durations.total("a.py::test_y", rows) == 11.0 and durations.total("b.py::test_new", rows) == 0.0


def test_a_test_without_a_row_is_fast_and_in_the_verdict() -> None:
    rows = {"a.py::test_slow": Duration(0.1, frozenset({"a.py::made"})), "a.py::made": Duration(0.15)}
    cases = ["a.py::test_slow[1]", "a.py::test_new[2]"]
    assert durations.fast(cases, rows) == {"a.py::test_new[2]"}


def test_a_function_that_takes_long_without_a_row_is_named() -> None:
    def report(nodeid: str, cpu: float) -> pytest.TestReport:
        properties = [("needs", []), ("shared", {}), ("cpu", cpu)]
        return pytest.TestReport(
            nodeid, ("", 0, ""), {}, "passed", None, "teardown", (), 0.0, 0, 0, properties
        )

    measured = durations.Durations(keep=False)
    for nodeid, cpu in (("b.py::test_x[1]", 0.6), ("b.py::test_x[2]", 0.6), ("a.py::test_y", 0.9)):
        measured.pytest_runtest_logreport(report(nodeid, cpu))
    assert measured.unlisted({}) == ["b.py::test_x"]
    assert measured.unlisted({"b.py::test_x": Duration(0.1)}) == []


def test_programs_are_compiled_quickly_without_the_option_default_programs(
    request: pytest.FixtureRequest,
) -> None:
    default = request.config.getoption("--default-programs")
    given = set(os.environ.get("XLA_FLAGS", "").split())
    assert given.isdisjoint(conftest.QUICK_PROGRAMS) if default else given.issuperset(conftest.QUICK_PROGRAMS)


def test_every_default_program_exists() -> None:
    root = Path(conftest.__file__).parents[1]
    places = [place.partition("::") for place in conftest.DEFAULT_PROGRAM]
    by_hand = [p for p in (root / "tests").rglob("test_*.py") if "mark.default_" + "program" in p.read_text()]
    assert not by_hand, "`tools/suite.py` reads the files of DEFAULT_PROGRAM alone with default programs"
    assert all((root / file).exists() for file, _, _ in places)
    assert all(
        f"def {durations.function(name)}" in (root / file).read_text() for file, _, name in places if name
    )


@pytest.mark.parametrize(("profile", "same"), [("quick", True), ("new", False)])
def test_drawn_examples_follow_from_the_test_or_are_new_and_can_be_repeated(
    profile: str, same: bool, tmp_path: Path
) -> None:
    test = (
        "from hypothesis import given, strategies as st\n"
        "@given(st.integers(0, 2**60))\n"
        "def test_drawn(n):\n"
        "    print('drawn', n)\n"
        "    assert n == 0\n"
    )
    (tmp_path / "test_drawn.py").write_text(test)
    (tmp_path / "conftest.py").write_text("from tests import conftest\n")
    root = Path(conftest.__file__).parents[1]
    command = [sys.executable, "-m", "pytest", "-q", "--hypothesis-profile", profile, str(tmp_path)]
    runs = [
        subprocess.run(
            command, cwd=root, env=os.environ | {"PYTHONPATH": str(root)}, capture_output=True, text=True
        )
        for _ in range(2)
    ]
    drawn = [re.findall(r"^drawn (\d+)", run.stdout, re.MULTILINE) for run in runs]
    assert all(drawn) and (drawn[0] == drawn[1]) == same
    assert all(("@reproduce_failure(" in run.stdout) != same for run in runs)


def test_processes_keep_byte_code(tmp_path: Path) -> None:
    (tmp_path / "imported.py").write_text("x = 1\n")
    subprocess.run([sys.executable, "-c", "import imported"], cwd=tmp_path, check=True)
    assert list(tmp_path.rglob("imported.*.pyc"))


SHARED = """
import pytest, time
def spend(seconds):
    end = time.process_time() + seconds
    while time.process_time() < end: pass
@pytest.fixture(scope="session")
def base():
    spend(0.2)
@pytest.fixture(scope="module")
def made(base):
    spend(0.5)
@pytest.mark.parametrize("k", [1, 2])
def test_first(made, k):
    spend(0.1)
def test_second(base): pass
def test_other(): pass
"""


@pytest.mark.parametrize("processes", ["0", "2"])
def test_a_shared_fixture_has_a_row_of_its_own_and_its_users_name_it(tmp_path: Path, processes: str) -> None:
    (tmp_path / "test_shared.py").write_text(SHARED)
    (tmp_path / "conftest.py").write_text(
        "from tests import durations\n"
        "def pytest_configure(config): config.pluginmanager.register(durations.Meter())\n"
    )
    code = (
        "import pytest; from tests import durations\n"
        "measured = durations.Durations(keep=False)\n"
        f"assert pytest.main(['-qq', '-n{processes}', '--rootdir', {str(tmp_path)!r}, {str(tmp_path)!r}], "
        "[measured]) == 0\n"
        "print({n.split('::')[1]: (round(r.seconds, 1), sorted(f.split('::')[1] for f in r.fixtures)) "
        "for n, r in sorted(measured.rows().items())})"
    )
    root = Path(conftest.__file__).parents[1]
    where = {**os.environ, "PYTHONPATH": str(root)}
    run = subprocess.run(
        [sys.executable, "-c", code], cwd=root, env=where, capture_output=True, text=True, check=True
    )
    assert eval(run.stdout.splitlines()[-1]) == {
        "base": (0.2, []),
        "made": (0.5, []),
        "test_first": (0.2, ["base", "made"]),
        "test_second": (0.0, ["base"]),
        "test_other": (0.0, []),
    }
