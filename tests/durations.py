"""CPU seconds of every test function, from which the order of files and the markers `fast` and `verdict`
follow.

`pytest --write-durations` measures the tests that it runs, also over several processes, and replaces their
rows in `durations.csv`; rows of other tests stay. The seconds of a function are those of all its cases, with
the processes that they start. What a fixture of a module takes has a row of its own, FILE::FIXTURE, and the
functions that need it name it.
"""

from __future__ import annotations

import csv
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from os import times
from pathlib import Path
from typing import Any

import pytest

FILE = Path(__file__).with_name("durations.csv")

FAST = 0.2
"""Most CPU seconds of a fast function, with the fixtures that it needs."""

UNMEASURED = 1.0
"""Most CPU seconds of a function that may lack a row."""

SHARED = 0.05
"""Least CPU seconds of a fixture that is listed."""


@dataclass(frozen=True)
class Duration:
    """CPU seconds of a function without the fixtures that others use too, and these fixtures."""

    seconds: float
    fixtures: frozenset[str] = frozenset()


def function(nodeid: str) -> str:
    """Return the test function of a case: its name without parameters."""
    return nodeid.split("[", 1)[0]


def read(file: Path = FILE) -> dict[str, Duration]:
    """Return the duration of each function and of each fixture."""
    with file.open(encoding="utf-8", newline="") as text:
        return {
            row["test"]: Duration(float(row["seconds"]), frozenset(row["fixtures"].split()))
            for row in csv.DictReader(text)
        }


def write(rows: Mapping[str, Duration], file: Path = FILE) -> None:
    """Add rows to a file or replace them there; rows of functions and fixtures that are gone are left out."""
    rows = {name: row for name, row in read(file).items() if exists(name)} | dict(rows)
    used = {fixture for row in rows.values() for fixture in row.fixtures}
    with file.open("w", encoding="utf-8", newline="") as text:
        out = csv.writer(text, lineterminator="\n")
        out.writerow(("test", "seconds", "fixtures"))
        for name in sorted(rows):
            if is_function(name) or name in used:
                out.writerow((name, f"{rows[name].seconds:.2f}", " ".join(sorted(rows[name].fixtures))))


def is_function(name: str) -> bool:
    """Return whether a row is that of a function or of a state machine, not of a fixture."""
    return name.rpartition("::")[2].startswith(("test", "runTest"))


def exists(name: str) -> bool:
    """Return whether the file of a function or fixture still defines it, or a fixture of all tests has it."""
    path, _, last = name.partition("::")
    file = FILE.parents[1] / path
    machine, _, run = last.rpartition("::")
    found = f"{machine} = " if run == "runTest" else f"def {run}("
    return file.exists() and (not is_function(name) or found in file.read_text(encoding="utf-8"))


def total(name: str, rows: Mapping[str, Duration]) -> float:
    """Return the CPU seconds of a function alone: with every fixture that it needs; 0 without a row."""
    row = rows.get(name, Duration(0.0))
    return row.seconds + sum(rows[fixture].seconds for fixture in row.fixtures if fixture in rows)


def files(rows: Mapping[str, Duration]) -> Counter[str]:
    """Return the CPU seconds of each file."""
    out: Counter[str] = Counter()
    for name, row in rows.items():
        out[name.split("::")[0]] += row.seconds
    return out


def units(rows: Mapping[str, Duration]) -> list[frozenset[str]]:
    """Return the functions in groups that share fixtures, with these fixtures: a group costs their sum."""
    of: dict[str, set[str]] = defaultdict(set)
    for name, row in rows.items():
        group = {name}.union(row.fixtures, *(of[member] for member in (name, *row.fixtures)))
        for member in group:
            of[member] = group
    return [frozenset(group) for group in {id(group): group for group in of.values()}.values()]


class Meter:
    """Measure CPU seconds of this process and of those that ended in it, and attach them to reports.

    The report of the end of a case has `cpu`, the seconds of the case; that of a fixture of a module or of
    the session is taken out of the case, and listed in `shared` by the first case that needs it.
    """

    def __init__(self) -> None:
        self._began = self._inside = 0.0
        self._made: dict[str, float] = {}
        self._names: dict[int, str] = {}

    @pytest.hookimpl(tryfirst=True)
    def pytest_runtest_logstart(self) -> None:
        self._began, self._inside, self._made = _clock(), 0.0, {}

    @pytest.hookimpl(wrapper=True)
    def pytest_fixture_setup(
        self, fixturedef: pytest.FixtureDef[Any], request: pytest.FixtureRequest
    ) -> Iterator[None]:
        if fixturedef.scope == "function":
            return (yield)  # type: ignore[return-value]
        before, outer = _clock(), self._inside
        result = yield
        taken = _clock() - before
        # a fixture that another one needs counts by itself
        name = f"{request.node.nodeid.split('::')[0] or 'tests/conftest.py'}::{fixturedef.argname}"
        self._names[id(fixturedef)] = name
        self._made[name] = self._made.get(name, 0.0) + taken - (self._inside - outer)
        self._inside = outer + taken
        return result  # type: ignore[return-value]

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_teardown(self, item: pytest.Item) -> Iterator[None]:
        yield
        defined = getattr(item, "_fixtureinfo", None)
        needed = {} if defined is None else defined.name2fixturedefs
        names = {self._names[id(d)] for found in needed.values() for d in found if id(d) in self._names}
        item.user_properties.append(("needs", sorted(names)))
        item.user_properties.append(("shared", self._made))
        item.user_properties.append(("cpu", _clock() - self._began - self._inside))


class Durations:
    """Collect what a `Meter` attached to reports, here or in other processes; write it, or require rows."""

    def __init__(self, keep: bool) -> None:
        self.keep = keep
        self.seconds: Counter[str] = Counter()
        self.shared: dict[str, Counter[str]] = defaultdict(Counter)
        """Seconds of each fixture in each process, which makes its own."""
        self.needs: dict[str, set[str]] = defaultdict(set)

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        if report.when != "teardown":
            return
        name, told = function(report.nodeid), dict(report.user_properties)
        self.seconds[name] += float(told.get("cpu", 0.0))  # type: ignore[arg-type]
        for fixture, seconds in told.get("shared", {}).items():  # type: ignore[attr-defined]
            self.shared[fixture][getattr(report, "worker_id", "")] += seconds
        self.needs[name].update(told.get("needs", ()))  # type: ignore[arg-type]

    def rows(self) -> dict[str, Duration]:
        """Return the rows of the functions that ran, and of their fixtures."""
        shared = {name: max(processes.values()) for name, processes in self.shared.items()}
        out = {name: Duration(seconds) for name, seconds in shared.items() if seconds >= SHARED}
        return out | {
            name: Duration(seconds, frozenset(self.needs[name] & out.keys()))
            for name, seconds in self.seconds.items()
        }

    def unlisted(self, rows: Mapping[str, Duration]) -> list[str]:
        """Return the functions without a row that took long."""
        return sorted(name for name, s in self.seconds.items() if name not in rows and s > UNMEASURED)

    @pytest.hookimpl(wrapper=True)
    def pytest_sessionfinish(self, session: pytest.Session) -> Iterator[None]:
        yield
        if self.keep:
            write(self.rows())
        elif self.unlisted(read()) and session.exitstatus == 0:
            session.exitstatus = pytest.ExitCode.TESTS_FAILED

    def pytest_terminal_summary(self, terminalreporter: pytest.TerminalReporter) -> None:
        if not self.keep and (names := self.unlisted(read())):
            paths = " ".join(sorted({name.split("::")[0] for name in names}))
            terminalreporter.write_line(
                f"No row in {FILE.name} has {', '.join(names)}, which took more than {UNMEASURED:g} s of CPU "
                f"time. Type: pytest --write-durations {paths}",
                red=True,
            )


def fast(cases: Iterable[str], rows: Mapping[str, Duration]) -> set[str]:
    """Return the cases of fast functions; a function without a row counts as fast."""
    return {case for case in cases if total(function(case), rows) <= FAST}


def _clock() -> float:
    return sum(times()[:4])
