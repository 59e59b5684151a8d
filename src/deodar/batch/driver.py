"""The thread that drives a pool: gives tasks to idle workers, and takes their results."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any, Protocol

from deodar.session.interrupt import SecondInterrupt

WAIT = 0.1
"""Longest wall time between two checks for Ctrl-C, in seconds."""


@dataclass(frozen=True)
class Staffing:
    """The workers at one moment.

    Attributes:
        workers: number of workers now.
        running: number of pieces that were given to them and have not returned.
    """

    workers: int
    running: int


WorkerWatch = Callable[[Staffing], bool]
"""A function that is called several times a second while workers run or are awaited; once it returns true,
the computation ends at once.
"""


class WorkerPool(Protocol):
    """Workers that one thread drives: `Pool`, or `ClusterPool`."""

    @property
    def workers(self) -> int: ...

    @property
    def idle(self) -> int: ...

    @property
    def busy(self) -> int: ...

    def give(self, key: Hashable, function: Callable[..., Any], *arguments: Any, **where: Any) -> None: ...

    def wait(self, seconds: float) -> list[tuple[Any, Any]]: ...


@dataclass(frozen=True)
class PoolTask:
    """A task of a pool: a function of a module, its arguments, and where it should run."""

    key: Hashable
    function: Callable[..., Any]
    arguments: tuple[Any, ...]
    where: Mapping[str, str] = field(default_factory=dict[str, str])


def driven(
    pool: WorkerPool,
    tasks: Iterable[PoolTask],
    check: Callable[[], None],
    look: Callable[[], None] = lambda: None,
    wait: Callable[[float], list[tuple[Any, Any]]] | None = None,
) -> Iterator[tuple[Any, Any]]:
    """Run tasks in a pool; yield keys and results as they arrive.

    Args:
        pool: the workers; the pool was entered.
        tasks: the tasks; each is read when the one before was given.
        check: called several times a second; after a KeyboardInterrupt that it raises no more tasks begin.
        look: called as often; what it raises ends the call at once.
        wait: as the method of the pool; none: that method.

    Raises:
        KeyboardInterrupt: `check` raised it, after the tasks that had begun; SecondInterrupt at once.
        WorkerError: the workers have failed.
        Exception: the exception that a task has raised.
    """
    waiting, interrupted = iter(tasks), False
    task = next(waiting, None)
    while task is not None or pool.busy:
        while task is not None and pool.idle:
            pool.give(task.key, task.function, *task.arguments, **task.where)
            task = next(waiting, None)
        look()
        yield from (wait or pool.wait)(WAIT)
        if not interrupted:
            try:
                check()
            except SecondInterrupt:
                raise
            except KeyboardInterrupt:
                interrupted, task = True, None
    if interrupted:
        raise KeyboardInterrupt
