"""One worker that stays for the next function."""

from __future__ import annotations

import itertools
import os
from collections.abc import Callable

import pytest

from deodar.batch.kept_worker import KeptWorker
from deodar.errors import WorkerError


def counted(send: Callable[[object], None], number: int) -> int:
    send(number + 1)
    if number < 0:
        os._exit(1)
    return os.getpid()


def test_a_worker_stays_until_its_result_is_not_wanted_or_it_dies() -> None:
    worker, heard, looks = KeptWorker(talks=True), list[object](), itertools.count()
    assert worker.ask(counted, (1,), lambda: False, heard.append) is None and not worker.started
    first = worker.ask(counted, (2,), lambda: True, heard.append)
    assert worker.ask(counted, (3,), lambda: True, heard.append) == first != os.getpid() and worker.started
    assert worker.ask(counted, (4,), lambda: next(looks) < 1) is None and not worker.started
    with pytest.raises(WorkerError, match="ended unexpectedly"):
        worker.ask(counted, (-7,), lambda: True, heard.append)
    assert heard == [3, 4, -6] and not worker.started
