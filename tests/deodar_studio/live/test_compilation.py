"""How long a compilation is expected to take."""

from __future__ import annotations

from pathlib import Path

import deodar as dd
from deodar.model.document import Document
from deodar_studio.files.state_store import StateStore
from deodar_studio.live.compilation import MOST_SIZES, CompileTimes


def chain(count: int) -> Document:
    model = dd.Model("chain")
    for i in range(count):
        model.add(dd.Boost(f"n{i}"))
    return model.document


def test_the_last_program_of_about_the_same_size_gives_the_expected_time() -> None:
    times = CompileTimes()
    assert times.start(chain(9)).expected is None
    times.took(chain(9), 3.0)
    times.took(chain(99), 20.0)
    assert times.start(chain(9)).expected == 3.0
    assert times.start(chain(14)).expected == 3.0
    assert times.start(chain(80)).expected == 20.0
    assert times.start(chain(29)).expected is None
    times.took(chain(9), 4.0)
    assert times.start(chain(9)).expected == 4.0


def test_a_compilation_begins_with_planning_and_counts_its_time() -> None:
    compilation = CompileTimes().start(chain(1))
    assert compilation.phase == "planning" and 0 <= compilation.elapsed < 60


def test_old_sizes_are_dropped() -> None:
    times = CompileTimes({size: 1.0 for size in range(1000, 1000 + MOST_SIZES)})
    times.took(chain(2), 1.0)
    assert len(times.known) == MOST_SIZES and 1000 not in times.known


def test_times_are_stored_between_runs_of_the_studio(tmp_path: Path) -> None:
    store = StateStore(tmp_path / "state")
    assert store.compile_times() == {}
    store.store_compile_times({12: 3.5})
    assert StateStore(tmp_path / "state").compile_times() == {12: 3.5}
    (tmp_path / "state" / "compile_times.json").write_text('{"x": 1, "0": 2, "7": "a", "8": 2}')
    assert store.compile_times() == {8: 2.0}
