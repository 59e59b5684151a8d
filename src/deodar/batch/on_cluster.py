"""A pool of workers that a scheduler of Dask manages (`scheduler.py` connects to it).

The pool is used like `Pool`, by one thread: give tasks, wait for results. Nothing waits for one future: a
coroutine for each task puts its result into a queue, and `wait` reads the queue, for a limited time. What
does not arrive is submitted again under a new name: a result whose data died with its worker, and a task
that the scheduler has lost. A task may therefore run twice, and its first result is taken.
"""

from __future__ import annotations

import asyncio
import concurrent.futures
import contextlib
import dataclasses as dc
import itertools
import pickle
import queue
import time
import uuid
import warnings
from collections.abc import Callable, Coroutine, Hashable, Mapping
from typing import Any, Self

from deodar.batch import cluster_task, scheduler
from deodar.batch.cluster_task import INSTRUCTIONS
from deodar.batch.driver import Staffing, WorkerWatch
from deodar.cluster import Cluster
from deodar.errors import WorkerError, first_line, option

TASKS_A_WORKER = 2
"""Most tasks per worker that are submitted at a time: one runs, and the next one is there when it ends."""

CHECK_EVERY = 0.5
"""Wall time between two questions to the scheduler, in seconds."""

SILENT_SECONDS = 20.0
"""Wall time without an answer after which a scheduler is given up, in seconds."""

FETCH_SECONDS = 20.0
"""Wall time in which the result of a completed task must arrive; later the task is submitted again, in
seconds."""

CANCELLED_SECONDS = 1.0
"""Wall time in which a cancelled task must say so itself; later it is submitted again, in seconds."""

LOST_SECONDS = 20.0
"""Wall time after which a task that no worker has, while workers are idle, is submitted again, in seconds."""

PREPARE_SECONDS = 180.0
"""Wall time in which a worker must import deodar and open the model, in seconds."""

MOST_ATTEMPTS = 20
"""Most times that a task is submitted."""

OWN = ("machine", "device", "cores", INSTRUCTIONS)
"""What may differ between the caller and a worker; versions may not."""


@dc.dataclass
class _Task:
    """A task, its present future, and what follows the future.

    Attributes:
        machine: the kind of machine that should run it; empty: any.
        fetching: when the task was first seen completed without its result here; 0: it is not.
        lost: when the task was first seen with no worker, although workers were idle; 0: it is not.
    """

    key: Hashable
    payload: bytes
    machine: str
    attempt: int = 0
    future: Any = None
    follower: concurrent.futures.Future[None] = dc.field(default_factory=concurrent.futures.Future)
    fetching: float = 0.0
    lost: float = 0.0


@dc.dataclass(frozen=True)
class _TaskAnswer:
    """What arrived of a task: what its worker is and its pickled result, or an error."""

    key: Hashable
    attempt: int
    about: Mapping[str, str]
    result: bytes
    error: BaseException | None = None


@dc.dataclass(frozen=True)
class _Seen:
    """The last answer of the scheduler: its time, the threads of each worker, the tasks that workers have."""

    time: float
    workers: Mapping[str, int]
    processing: frozenset[str]


class ClusterPool:
    """The workers of a cluster, as a context: leaving it ends what it started.

    Args:
        cluster: where the workers are.
        precision: precision of the programs.
        watch: called several times a second until the workers are ready; once it returns true,
            KeyboardInterrupt is raised.

    Attributes:
        cluster: where the workers are.
        made_by: the versions and the machine that all workers have, as records state them; of a mixed cluster
            the machine is `mixed`.
    """

    def __init__(
        self, cluster: Cluster, precision: str = "float32", watch: WorkerWatch | None = None
    ) -> None:
        self.cluster, self._precision, self._watch_by = cluster, precision, watch
        self.made_by: dict[str, str] = {}
        self._version = scheduler.version()
        self._tasks: dict[Hashable, _Task] = {}
        self._inbox: queue.SimpleQueue[_TaskAnswer] = queue.SimpleQueue()
        self._token, self._numbers = uuid.uuid4().hex[:8], itertools.count()
        self._seen = _Seen(time.monotonic(), {}, frozenset())
        self._staffed = self._checked = time.monotonic()
        self._failed: BaseException | None = None
        self._class: dict[str, str] = {}
        self._kinds: dict[str, str] = {}
        self._description: dict[str, str] = {}
        self._accepted: dict[str, str] = {}
        self._stack = contextlib.ExitStack()

    def __enter__(self) -> Self:
        with contextlib.ExitStack() as stack:
            look = None if self._watch_by is None else self.look
            self._client: Any = scheduler.connected(self.cluster, stack, look)
            self._loop = self._client.loop.asyncio_loop
            self._require_version()
            watch = asyncio.run_coroutine_threadsafe(self._watch(), self._loop)
            stack.callback(watch.cancel)
            self._await_workers()
            self.everywhere(cluster_task.nothing)
            self._stack = stack.pop_all()
        return self

    def __exit__(self, *error: object) -> None:
        for task in self._tasks.values():
            task.follower.cancel()
        self._stack.close()

    @property
    def idle(self) -> int:
        """Number of tasks that can be given now."""
        return max(0, TASKS_A_WORKER * len(self._seen.workers) - len(self._tasks))

    @property
    def busy(self) -> int:
        """Number of tasks that were given and have not returned."""
        return len(self._tasks)

    @property
    def workers(self) -> int:
        """Number of workers now."""
        return len(self._seen.workers)

    @property
    def machines(self) -> list[str]:
        """The kinds of machines of the workers that answered `everywhere` and still exist."""
        return sorted({kind for address, kind in self._kinds.items() if address in self._seen.workers})

    def look(self) -> None:
        """Call `watch`; raise KeyboardInterrupt if it ends the computation."""
        if self._watch_by is not None and self._watch_by(Staffing(self.workers, self.busy)):
            raise KeyboardInterrupt

    def give(self, key: Hashable, function: Callable[..., Any], *arguments: Any, machine: str = "") -> None:
        """Submit a task; `wait` returns its result under the key.

        `machine`: the kind of machine that should run it, one of `machines`; another one does if none of that
        kind is left.
        """
        payload = pickled(function, arguments)
        self._tasks[key] = self._submit(_Task(key, payload, machine))

    def wait(self, seconds: float) -> list[tuple[Any, Any]]:
        """Return keys and results of completed tasks, after waiting at most `seconds` for one.

        Raises:
            WorkerError: the workers, the scheduler or a task has failed.
            Exception: the exception that a task has raised.
        """
        if self._failed is not None:
            raise self._failed
        out: list[tuple[Any, Any]] = []
        try:
            for answer in self._arrived(seconds):
                self._take(answer, out)
            if time.monotonic() - self._checked >= CHECK_EVERY:
                self._checked = time.monotonic()
                self._check()
        except BaseException as error:
            if not out or not isinstance(error, Exception):
                raise
            self._failed = error  # what has arrived is returned first
        return out

    def everywhere(self, function: Callable[..., Any], *arguments: Any) -> list[Any]:
        """Run a function once on every present worker, and return the results.

        Raises:
            WorkerError: a worker has other versions or another machine, or does not answer.
            Exception: the exception that the function has raised.
        """
        payload = pickled(function, arguments)

        async def ask() -> dict[str, Any]:
            return await self._client.run(cluster_task.run, payload, self._precision, on_error="return")

        answers, out = self._wait_for(ask(), PREPARE_SECONDS, "the workers do not answer"), list[Any]()
        for address, answer in sorted(answers.items()):
            if isinstance(answer, OSError):
                continue  # it has died since
            if isinstance(answer, BaseException):
                raise _unable(answer, f"the worker {address}")
            self._accept(answer[0], f"the worker {address}")
            self._kinds[address] = answer[0]["machine"]
            good, answer_value = pickle.loads(answer[1])
            if not good:
                raise answer_value
            out.append(answer_value)
        return out

    # ------------------------------------------------------------------------------------------------ connect

    def _require_version(self) -> None:
        """Raise an error if the scheduler has another version of Dask than this process."""

        async def ask() -> dict[str, Any]:
            return await self._client.scheduler.versions()

        answer = self._wait_for(ask(), scheduler.CONNECT_SECONDS, "the scheduler does not answer")
        version = answer["packages"].get("distributed")
        if version != self._version:
            raise WorkerError(
                f"the scheduler at {self.cluster.address} has distributed {version}, and this process"
                f" distributed {self._version}",
                fix="Install the same versions everywhere",
            )

    def _await_workers(self) -> None:
        """Wait for all processes of `local:N`, or for the first worker of another cluster."""
        processes = self.cluster.processes or 1
        while self.workers < processes:
            time.sleep(0.05)
            self.look()
            self._check()
            if time.monotonic() - self._staffed > self.cluster.patience:
                break

    # -------------------------------------------------------------------------------------------------- tasks

    def _submit(self, task: _Task) -> _Task:
        """Submit a task under a name that no other one has had, and return it."""
        where = [address for address, kind in self._kinds.items() if kind == task.machine]
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # that the payload is large
            task.future = self._client.submit(
                cluster_task.run,
                task.payload,
                self._precision,
                key=f"deodar-{self._token}-{next(self._numbers)}",
                pure=False,
                retries=0,
                workers=where or None,
                allow_other_workers=bool(where),
            )
        task.follower = asyncio.run_coroutine_threadsafe(
            self._follow(task.key, task.attempt, task.future), self._loop
        )
        return task

    async def _follow(self, key: Hashable, attempt: int, future: Any) -> None:
        try:
            description, payload = await future
        except asyncio.CancelledError as error:
            self._inbox.put(_TaskAnswer(key, attempt, {}, b"", error))
            raise
        except BaseException as error:
            self._inbox.put(_TaskAnswer(key, attempt, {}, b"", error))
        else:
            self._inbox.put(_TaskAnswer(key, attempt, description, payload))

    def _arrived(self, seconds: float) -> list[_TaskAnswer]:
        out: list[_TaskAnswer] = []
        with contextlib.suppress(queue.Empty):
            out.append(self._inbox.get(timeout=seconds))
            while True:
                out.append(self._inbox.get_nowait())
        return out

    def _take(self, answer: _TaskAnswer, out: list[tuple[Any, Any]]) -> None:
        task = self._tasks.get(answer.key)
        if task is None or task.attempt != answer.attempt:
            return  # of an attempt that was given up
        error = answer.error
        if error is None:
            del self._tasks[answer.key]
            self._accept(answer.about, "a worker")
            good, outcome = pickle.loads(answer.result)
            if not good:
                raise outcome
            out.append((answer.key, outcome))
        elif type(error).__name__ == "KilledWorker":
            count = getattr(error, "allowed_failures", scheduler.ALLOWED_FAILURES) + 1
            raise WorkerError(
                f"the same task has ended {count} worker processes, one after another; its key is"
                f" {_key_text(answer.key)}",
                fix="The system may have stopped them for lack of memory: use fewer workers on a machine, or"
                " smaller pieces. What was completed is stored",
            )
        elif isinstance(error, (OSError, asyncio.CancelledError, concurrent.futures.CancelledError)):
            self._submit_again(task)
        else:
            raise _unable(error, "a worker")

    def _submit_again(self, task: _Task) -> None:
        """Submit a task under a new name; its former attempt no longer counts."""
        if task.attempt + 1 >= MOST_ATTEMPTS:
            raise WorkerError(
                f"the task {_key_text(task.key)} was submitted {MOST_ATTEMPTS} times without a result",
                fix="Look at the network and at the logs of the workers. What was completed is stored",
            )
        if self._client.status != "running":
            task.fetching = task.lost = 0.0
            return  # `_check` submits it when the scheduler answers again, or gives the scheduler up
        task.follower.cancel()
        with contextlib.suppress(Exception):
            task.future.release()
        task.attempt += 1
        self._submit(task)
        task.fetching = task.lost = 0.0

    # ------------------------------------------------------------------------------------------------- checks

    async def _watch(self) -> None:
        """Ask the scheduler from time to time which workers exist, and which tasks they have."""
        while True:
            with contextlib.suppress(Exception):
                workers = await asyncio.wait_for(self._client.scheduler.ncores(workers=None), SILENT_SECONDS)
                had = await asyncio.wait_for(self._client.scheduler.processing(workers=None), SILENT_SECONDS)
                keys = frozenset(str(key) for listed in had.values() for key in listed)
                self._seen = _Seen(time.monotonic(), dict(workers), keys)
            await asyncio.sleep(CHECK_EVERY if self._seen.workers else 0.1)

    def _check(self) -> None:
        """Raise an error if nothing can come any more, and submit again what was lost."""
        moment, seen = time.monotonic(), self._seen
        if moment - seen.time > SILENT_SECONDS:
            raise WorkerError(
                f"the scheduler of {self.cluster.address} has not answered for {SILENT_SECONDS:g} s",
                fix="Start it again, with its workers, and repeat the call: it resumes",
            )
        if seen.workers:
            self._staffed = moment
        elif moment - self._staffed > self.cluster.patience:
            raise WorkerError(
                f"{self.cluster.address} has had no worker for {self.cluster.patience:g} s",
                fix=option(
                    "Start workers (dask worker ADDRESS --nthreads 1), or wait longer for them:",
                    "patience",
                    "3600",
                    page="the field Patience",
                ).then("Then repeat the call: it resumes"),
            )
        wide = [f"{address} ({n})" for address, n in seen.workers.items() if n != 1]
        if wide:
            raise WorkerError(
                f"workers have several threads: {', '.join(sorted(wide)[:4])}",
                fix="Start them with one: dask worker ADDRESS --nthreads 1 --nworkers N",
            )
        for task in self._tasks.values():
            self._check_task(task, moment, len(seen.processing) < len(seen.workers))

    def _check_task(self, task: _Task, moment: float, idle: bool) -> None:
        status = task.future.status
        arriving = status in ("finished", "cancelled", "lost", "error")
        missing = status == "pending" and idle and str(task.future.key) not in self._seen.processing
        task.fetching = (task.fetching or moment) if arriving else 0.0
        task.lost = (task.lost or moment) if missing else 0.0
        allowed = CANCELLED_SECONDS if status in ("cancelled", "lost") else FETCH_SECONDS
        late = task.fetching and moment - task.fetching > allowed
        if late or (task.lost and moment - task.lost > LOST_SECONDS):
            self._submit_again(task)

    def _accept(self, worker: Mapping[str, str], who: str) -> None:
        """Raise an error if rows of this worker cannot be stored with those of the others."""
        if worker == self._accepted:
            return
        here_made = self._description = self._description or _made_here(self._precision)
        named = sorted({*here_made, *worker} - {*OWN})
        differ = [name for name in named if here_made.get(name) != worker.get(name)]
        if differ:
            there, mine = (
                ", ".join(f"{name} {versions.get(name, 'missing')}" for name in differ)
                for versions in (worker, here_made)
            )
            raise WorkerError(
                f"{who} has {there}, and this process {mine}", fix="Install the same versions everywhere"
            )
        if worker.get("cores") != "1":
            raise WorkerError(
                f"{who} computes with {worker.get('cores')} cores, which changes the last digits",
                fix="Start workers with NPROC=1 in the environment",
            )
        machine_class = {name: worker.get(name, "") for name in ("machine", "device", INSTRUCTIONS)}
        self._class = self._class or machine_class
        if machine_class != self._class and not self.cluster.mixed:
            name = next(name for name in machine_class if machine_class[name] != self._class[name])
            raise WorkerError(
                f"workers differ in their {name}: {self._class[name]!r} and {machine_class[name]!r}, so that"
                " the last digits of their rows may differ",
                fix=option(
                    "Use workers of one kind, or allow it:", "mixed", "", "True", "the box Mixed machines"
                ),
            )
        stated = {name: text for name, text in worker.items() if name != INSTRUCTIONS}
        self._accepted = dict(worker)
        self.made_by = stated | ({"machine": "mixed"} if self.cluster.mixed else {})

    def _wait_for(self, coroutine: Coroutine[Any, Any, Any], seconds: float, failure: str) -> Any:
        """Return the result of a coroutine of the client's loop, after at most `seconds`."""
        future = asyncio.run_coroutine_threadsafe(asyncio.wait_for(coroutine, seconds), self._loop)
        end = time.monotonic() + seconds + 5
        try:
            while True:
                try:
                    return future.result(0.2)
                except TimeoutError:
                    if future.done() or time.monotonic() > end:
                        raise WorkerError(
                            f"{failure}, at {self.cluster.address}, within {seconds:g} s",
                            fix="Look at the logs of the scheduler and of the workers",
                        ) from None
                self.look()
        finally:
            future.cancel()


def _made_here(precision: str) -> dict[str, str]:
    """Return the versions of this process, as records state them."""
    # start-up time: these bring JAX
    from deodar.compiler.device import find
    from deodar.recording.provenance import made_by

    return made_by(find(), precision)


def pickled(function: Callable[..., Any], arguments: tuple[Any, ...]) -> bytes:
    """Return a task as bytes.

    Raises:
        WorkerError: a part of it cannot be sent to another process.
    """
    if getattr(function, "__module__", "") == "__main__":
        raise WorkerError(
            f"{getattr(function, '__name__', 'a function')} is written in the script itself, which workers do"
            " not run",
            fix="Put it into a module of its own and import it, or run without a cluster",
        )
    try:
        return pickle.dumps((function, arguments))
    except Exception as error:  # a class may raise any exception
        raise WorkerError(
            f"a task cannot be sent to other processes ({type(error).__name__}: {first_line(error)})",
            fix="Run without a cluster",
        ) from None


def _unable(error: BaseException, who: str) -> WorkerError:
    return WorkerError(
        f"{who} cannot run a task ({type(error).__name__}: {first_line(error)})",
        fix="Install deodar, with the same versions of all packages, where workers run",
    )


def _key_text(key: Hashable) -> str:
    return ", ".join(map(str, key[:2])) if isinstance(key, tuple) else str(key)
