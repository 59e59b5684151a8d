"""Pieces of a batch: their sizes, and the joined results."""

from __future__ import annotations

import itertools
import json
import pickle
from collections.abc import Iterator

import numpy as np
import pytest
import xarray

from deodar.batch.pieces import BATCH_BYTES, PieceResult, Pieces, cut, joined
from deodar.batch.simulation_request import SimulationRequest
from deodar.errors import ParameterError
from deodar.recording.provenance import KEY
from deodar.resources import Resources

SIZES = [1, 2, 7, 100]


def faults(trials: int, points: int, workers: int, batch: int | None) -> Iterator[str]:
    """Yield what is wrong with the pieces of a batch."""
    pieces = cut({"trial": trials, "a": points}, 2**20, workers, batch)
    whole = SimulationRequest(100.0)
    requests = pieces.requests(whole, range(trials), {"a": [float(k) for k in range(points)]})
    jobs = [(r.trials, (r.sweep or {})["a"]) for r in requests if isinstance(r.trials, list)]
    copies = [(t, a) for job in jobs for t in job[0] for a in job[1]]
    if len(jobs) != pieces.count or not len(copies) == len(set(copies)) == trials * points:
        yield f"{len(copies)} copies, {len(set(copies))} different ones, in {len(jobs)} pieces"
    sizes = [len(job[0]) * len(job[1]) for job in jobs]
    if max(sizes) != pieces.batch or sizes[:-1] != [pieces.batch] * (len(jobs) - 1):
        yield f"sizes {sizes}"
    if pieces.batch > max(min(trials, points), batch if batch is not None else BATCH_BYTES // 2**20):
        yield f"{pieces.batch} copies at once"


def test_every_copy_is_in_exactly_one_piece() -> None:
    cases = itertools.product(SIZES, SIZES, [1, 2, 3, 16], [None, 1, 5, 10_000])
    wrong = [(case, fault) for case in cases for fault in faults(*case)]
    assert not wrong, wrong


def test_workers_get_pieces_of_equal_size() -> None:
    assert cut({"trial": 100}, 1000, 4) == Pieces("trial", 100, 25, 1)
    assert cut({"trial": 100}, 1000) == Pieces("trial", 100, 100, 1)
    assert cut({"trial": 100}, 2**20).count == 13  # 8 MiB at once
    assert cut({"trial": 100}, 2**20, 4).count == 15 and cut({"trial": 100}, 2**20, 4).length == 7
    assert cut({"trial": 3, "a": 5, "b": 4}, 0, 5) == Pieces("a", 5, 1, 12)
    assert cut({}, 2**30, 4) == Pieces("", 1, 1, 1)


@pytest.mark.parametrize("wrong", [0, True, 2.0, "3"])
def test_an_invalid_batch_is_refused(wrong: object) -> None:
    with pytest.raises(ParameterError, match="batch is"):
        Resources(batch=wrong)  # type: ignore[arg-type]


def part(trials: list[int], times: int, whole: bool) -> PieceResult:
    values = np.multiply.outer(np.array(trials, float), np.ones(times))
    part_record = xarray.Dataset(
        {"u": (("trial", "time"), values)}, {"trial": trials, "time": np.arange(times)}
    )
    part_record.attrs[KEY] = json.dumps({"trials": trials, "dt": 1.0})
    return PieceResult(part_record, whole)


def test_complete_pieces_are_joined_to_one_record() -> None:
    pieces = Pieces("trial", 6, 2, 1)
    record = joined(
        pieces, [part([0, 1], 3, True), part([2, 3], 3, True), part([4, 5], 3, True)], {"trials": [*range(6)]}
    )
    assert record["trial"].values.tolist() == [*range(6)] and np.array_equal(
        record["u"].values[:, 2], range(6)
    )
    assert json.loads(record.attrs[KEY]) == {"trials": [*range(6)], "dt": 1.0, "batch": 2, "complete": True}


def test_complete_pieces_of_an_interrupted_run_are_kept() -> None:
    some = joined(
        Pieces("trial", 6, 2, 1),
        [part([0, 1], 3, True), part([2, 3], 2, False), None],
        {"trials": [*range(6)]},
    )
    assert some["trial"].values.tolist() == [0, 1] and json.loads(some.attrs[KEY])["complete"] is False


@pytest.mark.parametrize(
    ("times", "trials", "kept"),
    [((5, 4, 0), [0, 1, 2, 3], 4), ((9, 2, 1), [0, 1], 9), ((4, 3, 3), [0, 1, 2, 3, 4, 5], 3)],
)
def test_without_a_complete_piece_the_longest_one_is_kept(
    times: tuple[int, ...], trials: list[int], kept: int
) -> None:
    parts = [part([2 * k, 2 * k + 1], n, False) for k, n in enumerate(times)]
    record = joined(Pieces("trial", 6, 2, 1), parts, {})
    assert (
        record["trial"].values.tolist() == trials
        and record.sizes["time"] == kept
        and json.loads(record.attrs[KEY])["complete"] is False
    )


def test_an_interrupted_run_without_any_piece_gives_an_empty_record() -> None:
    assert not joined(Pieces("trial", 6, 2, 1), [None, None, None], {}).sizes


def test_a_request_of_many_trials_is_pickled_small() -> None:
    """A worker process receives one for each piece."""
    whole = SimulationRequest(1000.0, trials=range(10_000), sweep={"u.tau": [10.0, 20.0]})
    first = cut({"trial": 10_000, "u.tau": 2}, 2**20).requests(whole, range(10_000), whole.sweep or {})[0]
    assert first.trials == [0, 1, 2, 3] and len(pickle.dumps(first)) < 500
