"""The tests that `make test` runs: those that notice most changes of the code for their CPU time.

`kills.csv` has for each judged mutant the functions that fail with it, `durations.csv` the CPU seconds of
every function, and `floor.csv` for each source file the cheapest function that fails when the public
functions of the file raise. The choice follows from these tables alone: first the floor, then functions by
their score until the budget is spent.

A function is taken whole. Functions that share a costly fixture are taken together.
"""

from __future__ import annotations

import csv
from collections import Counter
from collections.abc import Iterable, Mapping
from pathlib import Path

from tests.durations import Duration, is_function, units

KILLS = Path(__file__).with_name("kills.csv")
FLOOR = Path(__file__).with_name("floor.csv")

BUDGET = 220.0
"""CPU seconds of the chosen functions. `make test` shall end five minutes after the installation on two
cores, which are 600; reading the tests, types, lint and the page take the others.
"""

WEIGHTS = 20.0, 0.5, 3.0, 1.0
"""What a kill counts by the function itself, by its file, by its folder for each CPU second of the folder,
and what a function counts without any (guesses).
"""


def read(file: Path, column: str = "test") -> list[str]:
    """Return the functions, or another column, of a table, once for each row."""
    with file.open(encoding="utf-8", newline="") as text:
        return [row[column] for row in csv.DictReader(text)]


def scores(durations: Mapping[str, Duration], kills: Iterable[str]) -> dict[frozenset[str], float]:
    """Return what each unit of functions is worth for a CPU second."""
    killed = Counter(kills)
    by_file, by_folder, seconds = Counter[str](), Counter[str](), Counter[str]()
    for name, count in killed.items():
        by_file[_file(name)] += count
        by_folder[_folder(name)] += count
    for name, row in durations.items():
        seconds[_folder(name)] += row.seconds
    a, b, c, d = WEIGHTS
    out: dict[frozenset[str], float] = {}
    for unit in units(durations):
        name = min(unit)
        worth = a * sum(killed[n] for n in unit) + b * by_file[_file(name)] + d
        worth += c * by_folder[_folder(name)] / max(1.0, seconds[_folder(name)])
        out[unit] = worth / max(0.01, _cost(unit, durations))
    return out


def chosen(
    durations: Mapping[str, Duration], kills: Iterable[str], floor: Iterable[str], budget: float = BUDGET
) -> set[str]:
    """Return the functions of the verdict: the units of the floor, then others by their score.

    A unit that does not fit into what is left of the budget is passed over.
    """
    worth = scores(durations, kills)
    needed = set(floor)
    left, out = budget, set[str]()
    for unit in sorted(worth, key=lambda u: (u.isdisjoint(needed), -worth[u], min(u))):
        cost = _cost(unit, durations)
        if cost <= left or not unit.isdisjoint(needed):
            left -= cost
            out |= {name for name in unit if is_function(name)}
    return out


def _cost(unit: Iterable[str], durations: Mapping[str, Duration]) -> float:
    return sum(durations[name].seconds for name in unit if name in durations)


def _file(name: str) -> str:
    return name.partition("::")[0]


def _folder(name: str) -> str:
    return _file(name).rpartition("/")[0]
