"""`simulate`: one call, one labelled record; trials and sweeps as one batched program, or as several beside
each other.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from deodar.batch.compute import compute
from deodar.batch.progress import Shown
from deodar.batch.request import SimulationRequest
from deodar.batch.workers import run as in_workers
from deodar.errors import RunWarning
from deodar.model.model import Model
from deodar.parameters import real
from deodar.session.run import MOST_STEPS
from deodar.session.session import require_model
from deodar.worlds._base import World

if TYPE_CHECKING:
    import xarray

TICKS = 2**32
"""Steps that the counter of the noise tells apart."""

LONG_STEPS = 10**9
"""Steps from which on a run is announced: the fastest models take an hour for them, most a day."""


def simulate(
    model: Model,
    duration: float,
    dt: float | None = None,
    seed: int = 0,
    record: Sequence[str] | str | None = None,
    every: float | None = None,
    trials: int | Sequence[int] | None = None,
    sweep: Mapping[str, Sequence[float]] | None = None,
    precision: str = "float32",
    world: World | None = None,
    progress: Shown = None,
    workers: int | None = None,
    batch: int | None = None,
    device: str | None = None,
    accuracy: str = "default",
) -> xarray.Dataset:
    """Run a model and return what was recorded.

    Trials and points of a sweep are copies of the model in one batch. A batch that would outgrow the
    processor's cache is cut into pieces, along the longest of these dimensions; `workers` runs the pieces in
    processes of one core each. The noise is the same bits however it is cut, and float64 results agree to
    1e-10. A worker takes one to two seconds to start, so a short run is done sooner without.

    In float32 the last digits of a copy depend on how many points and trials are computed together, because
    the compiler orders sums by the size of arrays: results of other widths agree to 1e-4. Of the same width
    all bits agree, whatever the place of a copy, the number of pieces, chunks, workers, restarts and the
    order of declaration. All pieces of a run have the same width: `batch` in the record; the last one is
    filled up. With `batch=1` each trial has the bits of a single run. `python benchmarks/bits.py` tests this
    with random combinations.

    Args:
        model: the model, as it now is.
        duration: document time; a whole number of steps.
        dt: Euler step; none: the document's own, else 1.
        seed: seed of all noise, 0 to 2^32 - 1.
        record: paths of ports; the path of a field alone means its activation. None: the activation of every
            field and node, at one time, the end.
        every: document time between records; none: dt. The first record is the initial state.
        trials: number of trials (0 to n - 1 of the seed), or a list of trial numbers; trials differ in their
            noise.
        sweep: for each parameter path its values; several entries form a grid. All points share the noise.
        precision: float32 or float64.
        world: what provides the sensors that the model names.
        progress: whether to show a progress bar; none: on a terminal, if the run takes longer than a second.
            A function is called with the number of completed steps. From 10^9 steps on a `RunWarning` states
            their number, and progress is shown unless this is False: without a terminal as lines.
        workers: number of processes that share the copies; one for each core is best.
        batch: copies that run at once in one process; none: as many as fit into the cache, all where there is
            no cache to fit into.
        device: where it runs: cpu, gpu, or one of several as gpu:1; none: the CPU.
        accuracy: default (at most 1e-4 off in activation), or exact: every kernel by its matrix, however much
            longer that takes. Double precision always is, and so are elements of which a width is swept.

    Returns:
        A Dataset with one variable for each path; dimensions: sweep paths, `trial` (where given), `time`,
        axes. Of copies that diverge all values are NaN, at all times; the coordinate `diverged` gives the
        reason of each, the attribute `diverged` counts them, and a `RunWarning` repeats it.

    Raises:
        NotFinite: a single run diverges, or all copies do.
        Interrupted: on Ctrl-C; its `data` holds what was recorded until then; of a run in pieces those that
            are complete, if there are any.
        DeviceError: there is no such device.
        WorkerError: something cannot be handed to another process, or a process has died.
    """
    require_model(model)
    steps = expected_steps(duration, model.document.step if dt is None else dt)
    if steps >= LONG_STEPS:
        step = model.document.step if dt is None else dt
        again = "" if steps <= TICKS else f"; the noise of an element repeats after {TICKS:.3g} steps"
        warnings.warn(
            f"{steps:.3g} steps of dt = {step:g}: a smaller number may be meant{again}",
            RunWarning,
            stacklevel=2,
        )
        progress = True if progress is None else progress
    request = SimulationRequest(
        duration, dt, seed, record, every, trials, sweep, precision, workers, batch, device, accuracy
    )
    data, _, lost = compute(model, request, world, progress, in_workers)
    if lost is not None:
        raise lost
    if "diverged" in data.attrs:
        warnings.warn(str(data.attrs["diverged"]), RunWarning, stacklevel=2)
    return data


def expected_steps(duration: Any, dt: Any) -> int:
    """Steps of a run, 0 where it will be refused anyway."""
    wanted, step = real(duration), real(dt)
    good = wanted is not None and step is not None and 0 < step < math.inf and 0 <= wanted < math.inf
    steps = wanted / step if good and wanted is not None and step is not None else 0.0
    return int(steps) if steps <= MOST_STEPS else 0
