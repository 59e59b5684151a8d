"""CPU seconds of the slow tests, from which the markers `fast` and `long` follow.

`pytest --write-durations` measures the tests that it runs, in one process, and replaces their rows in
`durations.csv`; rows of other tests are kept. The seconds of a function are those of all its cases,
with the processes that they start and the fixtures of a module that it uses. A test without a row is fast.
"""

from __future__ import annotations

import csv
import os
from collections import Counter
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

import pytest

FILE = Path(__file__).with_name("durations.csv")
LIMIT = 0.2
"""CPU seconds of all cases of a function above which it is slow."""

CLOCK = 2.0
"""Seconds by the clock of all cases of a function above which it is slow, also on a busy machine."""

SHARE = 0.6
"""Most CPU seconds of a function outside of the marker `long`."""

ALWAYS = (
    "tests/deodar/experiments/test_cluster.py::test_a_killed_caller_leaves_no_process_and_is_resumed",
    "tests/deodar/experiments/test_cluster.py::test_rows_are_the_same_while_workers_are_killed",
)
"""Functions that never have the marker `long`: what they test has no shorter form, and failed before."""


def function(nodeid: str) -> str:
    """Return the test function of a case: its name without parameters."""
    return nodeid.split("[", 1)[0]


def seconds(file: Path = FILE) -> dict[str, float]:
    """Return the CPU seconds of each test function known to be slow."""
    with file.open(encoding="utf-8", newline="") as text:
        return {row["test"]: float(row["seconds"]) for row in csv.DictReader(text)}


def files(rows: dict[str, float]) -> Counter[str]:
    """Return the CPU seconds of the slow test functions of each file."""
    out: Counter[str] = Counter()
    for test, s in rows.items():
        out[test.split("::")[0]] += s
    return out


def long_cases(cases: Iterable[str], rows: dict[str, float]) -> set[str]:
    """Return the cases that have the marker `long`.

    Of a function with more than `SHARE` CPU seconds as many cases lack it as take `SHARE` together, at
    regular distances; none where a single case takes longer. Functions of `ALWAYS` are left out.
    """
    of: dict[str, list[str]] = {}
    for case in cases:
        of.setdefault(function(case), []).append(case)
    out: set[str] = set()
    for name, members in of.items():
        if name in ALWAYS:
            continue
        share = SHARE / max(rows.get(name, 0.0), SHARE)
        out |= {case for i, case in enumerate(members) if int((i + 1) * share) == int(i * share)}
    return out


def unlisted(reports: Iterable[pytest.TestReport]) -> list[str]:
    """Return the files of test functions that counted as fast and took longer than `CLOCK`."""
    taken: Counter[str] = Counter()
    for report in reports:
        taken[function(report.nodeid)] += report.duration
    return sorted({test.split("::")[0] for test, s in taken.items() if s > CLOCK})


def exists(test: str) -> bool:
    """Return whether the file of a test function still defines it."""
    path, _, name = test.partition("::")
    file = FILE.parents[1] / path
    return file.exists() and f"def {name.split('::')[-1]}(" in file.read_text(encoding="utf-8")


def write(measured: dict[str, float], file: Path = FILE) -> None:
    """Replace the rows of the functions that were measured; rows of missing functions are dropped."""
    kept = {test: s for test, s in seconds(file).items() if exists(test) and test not in measured}
    rows = kept | {test: s for test, s in measured.items() if s > LIMIT}
    with file.open("w", encoding="utf-8", newline="") as text:
        out = csv.writer(text, lineterminator="\n")
        out.writerow(("test", "seconds"))
        out.writerows((test, f"{rows[test]:.1f}") for test in sorted(rows))


class Recorder:
    """Measure the CPU seconds of this process and of those that ended in it, test by test.

    What a fixture of a module takes counts for every function that uses it: without the others, each would
    have to pay it.
    """

    def __init__(self) -> None:
        self.seconds: Counter[str] = Counter()
        self._shared: dict[tuple[str, str], float] = {}
        self._paid: set[tuple[str, tuple[str, str]]] = set()
        self._inside = 0.0

    @pytest.hookimpl(wrapper=True, tryfirst=True)
    def pytest_runtest_protocol(self, item: pytest.Item) -> Iterator[None]:
        before, self._inside = sum(os.times()[:4]), 0.0
        result = yield
        name = function(item.nodeid)
        self.seconds[name] += sum(os.times()[:4]) - before - self._inside
        for fixture in getattr(item, "fixturenames", ()):
            key = (item.nodeid.split("::")[0], fixture)
            if key in self._shared and (name, key) not in self._paid:
                self._paid.add((name, key))
                self.seconds[name] += self._shared[key]
        return result  # type: ignore[return-value]

    @pytest.hookimpl(wrapper=True)
    def pytest_fixture_setup(
        self, fixturedef: pytest.FixtureDef[Any], request: pytest.FixtureRequest
    ) -> Iterator[None]:
        if fixturedef.scope not in ("module", "class"):
            return (yield)  # type: ignore[return-value]
        before, outer = sum(os.times()[:4]), self._inside
        result = yield
        taken = sum(os.times()[:4]) - before
        key = (request.node.nodeid.split("::")[0], fixturedef.argname)
        # a fixture that another one needs is among the names of the test, and counts by itself
        self._shared[key] = self._shared.get(key, 0.0) + taken - (self._inside - outer)
        self._inside = outer + taken
        return result  # type: ignore[return-value]

    def pytest_sessionfinish(self) -> None:
        write(dict(self.seconds))
