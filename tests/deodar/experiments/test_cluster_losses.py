"""Any division, order, repetition and loss of tasks gives the same rows, and merged parts are the whole."""

from __future__ import annotations

import asyncio
import contextlib
import json
import threading
import types

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from deodar.batch import on_cluster, scheduler
from deodar.batch.on_cluster import ClusterPool
from deodar.cluster import Cluster
from deodar.errors import DamagedFile, DeodarError
from deodar.experiments.jobs import Job, run_jobs
from deodar.experiments.merging import merge_results
from deodar.experiments.results import ROWS, load_results
from deodar.experiments.rows import Rows
from deodar.resources import Resources
from tests.deodar.experiments import clustered

KEYS = [f"{k:02}" for k in range(12)]
WORKERS = {"tcp://a": 1, "tcp://b": 1}
QUICK = settings(max_examples=30, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])


class _LossyClient:
    """A scheduler that decides the fate of each task, and runs it here.

    Fates: `done` at once; `late`, after others; `cancelled`, because its worker has died; `broken`, its
    connection; `slow`, complete, but its result arrives only
    after the task was submitted again; `gone`, which no
    worker has.
    """

    def __init__(self, fates, loop):
        self.fates, self.status, self.scheduler = iter(fates), "running", self
        self.loop = types.SimpleNamespace(asyncio_loop=loop)
        self.submitted = 0

    def submit(self, function, payload, precision, key, **_):
        self.submitted += 1
        fate = next(self.fates, "done")
        status = {"slow": "finished", "cancelled": "cancelled"}.get(fate, "pending")
        return _Future(fate, lambda: function(payload, precision), key, status)

    async def run(self, function, payload, precision, on_error):
        return {address: function(payload, precision) for address in WORKERS}

    async def ncores(self, workers):
        return WORKERS

    async def processing(self, workers):
        return {}


class _Future:
    def __init__(self, fate, function, key, status):
        self.fate, self.function, self.key, self.status = fate, function, key, status

    def __await__(self):
        return self._result().__await__()

    async def _result(self):
        match self.fate:
            case "late":
                await asyncio.sleep(0.01)
            case "cancelled":
                raise asyncio.CancelledError
            case "broken":
                raise OSError("reset by peer")
            case "slow":
                with contextlib.suppress(asyncio.CancelledError):
                    await asyncio.sleep(100)
            case "gone":
                await asyncio.sleep(100)
        return self.function()

    def release(self):
        pass


class _LossyPool(ClusterPool):
    def __init__(self, fates, loop):
        super().__init__(Cluster("tcp://127.0.0.1:1"))
        self.client = _LossyClient(fates, loop)

    def __enter__(self):
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(scheduler, "connected", lambda cluster, stack, look: self.client)
            return super().__enter__()

    def _require_version(self):
        pass


@pytest.fixture(scope="module")
def loop():
    loop = asyncio.new_event_loop()
    thread = threading.Thread(target=loop.run_forever)
    thread.start()
    yield loop
    loop.call_soon_threadsafe(loop.stop)
    thread.join()
    loop.close()


@pytest.fixture
def hasty(monkeypatch):
    """Count a task as lost soon; workers have one core."""
    monkeypatch.setenv("NPROC", "1")
    for name in ("FETCH_SECONDS", "LOST_SECONDS", "CHECK_EVERY", "CANCELLED_SECONDS"):
        monkeypatch.setattr(on_cluster, name, 0.02)


def _jobs(cuts, order):
    """Return the rows in pieces that end at some places, in an order."""
    ends = sorted({*cuts, len(KEYS)})
    pieces = [KEYS[a:b] for a, b in zip([0, *ends], ends, strict=False) if a < b]
    order.shuffle(pieces)
    return [
        Job(tuple(keys), json.loads, {"s": json.dumps([{"key": key, "trial": int(key)} for key in keys])})
        for keys in pieces
    ]


class _KilledError(Exception):
    pass


FATES = st.lists(st.sampled_from(["done", "late", "cancelled", "broken", "slow", "gone"]), max_size=16)
CALLS = st.lists(
    st.tuples(st.sets(st.integers(1, 11)), FATES, st.integers(0, 12)), min_size=1, max_size=3
).map(lambda calls: [*calls[:-1], (*calls[-1][:2], None)])


@QUICK
@given(calls=CALLS, order=st.randoms(use_true_random=False))
def test_any_division_order_repetition_and_loss_gives_the_same_rows(
    tmp_path_factory, hasty, loop, calls, order
):
    file = tmp_path_factory.mktemp("lossy") / "rows.jsonl"
    for cuts, fates, killed in calls:

        def watch(progress, killed=killed):
            if killed is not None and progress >= killed:
                raise _KilledError

        with contextlib.suppress(_KilledError), _LossyPool(fates, loop) as pool:
            jobs = _jobs(cuts, order)
            clustered.within(
                lambda told=watch, jobs=jobs, pool=pool: run_jobs(
                    jobs, Rows(file, {}), Resources(progress=told), pool
                )
            )
    stored = sorted(json.loads(line)["key"] for line in file.read_text().splitlines()[1:])
    assert stored == KEYS


def test_each_fate_occurs(tmp_path, hasty, loop):
    """Otherwise the property above would be tested without losses."""
    with _LossyPool(["late", "cancelled", "broken", "slow", "gone"], loop) as pool:
        jobs = [Job((key,), json.loads, {"s": json.dumps([{"key": key}])}) for key in KEYS]
        clustered.within(lambda: run_jobs(jobs, Rows(tmp_path / "rows", {}), pool=pool))
        assert pool.client.submitted == len(KEYS) + 4


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    folder = tmp_path_factory.mktemp("whole") / "out"
    clustered.experiment(8, 100.0).run(folder)
    return folder


@QUICK
@given(
    parts=st.lists(st.sets(st.integers(0, 7)), min_size=1, max_size=4),
    order=st.randoms(use_true_random=False),
)
def test_any_parts_are_merged_to_the_rows_that_they_have(tmp_path_factory, whole, parts, order):
    head, *lines = (whole / ROWS).read_text().splitlines()
    place, folders = tmp_path_factory.mktemp("parts"), []
    for number, part in enumerate(parts):
        folder = place / str(number)
        folder.mkdir()
        for name in ("experiment.json", "model.json"):
            (folder / name).write_bytes((whole / name).read_bytes())
        mine = [lines[k] for k in part]
        order.shuffle(mine)
        (folder / ROWS).write_text("\n".join([head, *mine, ""]))
        folders.append(folder)
    merged = merge_results(folders, place / "merged")
    have = set().union(*parts)
    assert merged.data["trial"].values.tolist() == sorted(have)
    assert clustered.lines(place / "merged") == sorted([head, *(lines[k] for k in have)])
    assert {k for a, b in merged.gaps for k in range(a, b)} == {*range(8)} - have


@settings(QUICK, max_examples=200)
@given(data=st.data())
def test_a_damaged_file_of_rows_is_read_or_refused_by_name(tmp_path_factory, whole, data):
    content = bytearray((whole / ROWS).read_bytes())
    for _ in range(data.draw(st.integers(1, 3))):
        at = data.draw(st.integers(0, len(content) - 1))
        if data.draw(st.booleans()):
            content[at] = data.draw(st.integers(0, 255))
        else:
            del content[at : at + data.draw(st.integers(1, 60))]
    folder = tmp_path_factory.mktemp("damaged")
    for name in ("experiment.json", "model.json"):
        (folder / name).write_bytes((whole / name).read_bytes())
    (folder / ROWS).write_bytes(content)
    for read in (load_results, lambda place: merge_results([whole, place], place / "merged")):
        message = ""
        try:
            read(folder)
        except DeodarError as error:
            message = str(error)
        assert not message or str(folder) in message


def test_a_row_with_another_digit_is_refused_with_its_file_and_line(tmp_path, whole):
    for name in ("experiment.json", "model.json"):
        (tmp_path / name).write_bytes((whole / name).read_bytes())
    head, row, *more_rows = (whole / ROWS).read_bytes().splitlines(True)
    damaged_row = row.replace(b'"duration": 100', b'"duration": 900', 1)
    assert damaged_row != row
    (tmp_path / ROWS).write_bytes(b"".join([head, damaged_row, *more_rows]))
    with pytest.raises(DamagedFile, match=r"trials\.jsonl: line 2 is not a row .* that of another line"):
        load_results(tmp_path)
