"""An experiment: its design, and how it is checked and run."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from deodar import renamed
from deodar.batch.simulate import LONG_STEPS
from deodar.errors import DeodarError, Problem, RunWarning
from deodar.experiments.design import Design
from deodar.experiments.jobs import Standing
from deodar.experiments.observations import DIVERGED
from deodar.experiments.results import carry
from deodar.experiments.setup import Setup

if TYPE_CHECKING:
    import xarray


@dataclass(frozen=True)
class Experiment(Design):
    """An unattended experiment: many trials of a model, each until a condition ends it, with one row of a
    table for each.

    Trials run beside each other in batches where nothing is done to them on the way and their world, if there
    is one, can be computed inside the step; otherwise one by one. Trial k has the noise of trial k of the
    seed, whatever runs beside it.

    Attributes:
        name: what it is called.
        model: the model, or the path of its document.
        limit: document time after which a trial ends at the latest.
        trials: of each combination of levels; with a random design of the whole experiment.
        conditions: what may happen; those that `ends` says end a trial, and give its outcome.
        actions: what is done to each trial, and when.
        factors: what trials differ in.
        measures: what is measured of each trial.
        design: `crossed`, `shuffled` (the same in an order drawn from the seed) or `random` (levels drawn for
            each trial).
        seed: of all noise, and of what is drawn.
        every: document time between looks (and records); none: each step.
        record: paths of ports of which every trial keeps a record; the path of a field alone means its
            activation.
        world: what sensors read and motors move: a world, or KIND:ARGUMENT as on the command line.
        dt: Euler step; none: the document's own.
        precision: float32 or float64.
    """

    if not TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any:
            raise renamed.no_member(self, name)

    def setup(self, trust: bool = False) -> Setup:
        """The experiment with its model and its world opened, and everything checked that can be checked
        before a trial runs.

        Raises:
            ParameterError: it names what is not there, or holds what cannot be; all problems are listed.
        """
        return Setup.open(self, trust)

    def check(self) -> list[Problem]:
        """What is wrong with it; nothing where it can be run."""
        try:
            self.setup(trust=True)
        except DeodarError as error:
            return list(error.problems)
        return []

    def run(
        self,
        out: str | Path | None = None,
        workers: int | None = None,
        progress: Callable[[Standing], None] | None = None,
        trust: bool = False,
    ) -> xarray.Dataset:
        """Run all trials that are not there yet, and give the table of all.

        Args:
            out: folder of the results. The run of an earlier call in this folder is resumed, with the same
                results as without the stop. None: nothing is kept.
            workers: number of processes of one core each; none: this process.
            progress: called with a `Standing` after each piece.
            trust: whether functions that the document names may be imported and run.

        Returns:
            A Dataset over `trial`: levels as coordinates; outcome, duration, times of conditions (NaN: did
            not happen) and measures as variables. A trial that diverges has the outcome `diverged`, and NaN
            for every number; the variable `diverged` gives its reason, the attribute `diverged` counts such
            trials, and a `RunWarning` repeats it. The rows of the other trials are not affected. A
            `RunWarning` is also given before trials that may take 10^9 steps in total.

        Raises:
            OutputExists: the folder holds another experiment, or something else.
            KeyboardInterrupt: on Ctrl-C, when the pieces that run are done; their rows are kept.
        """
        setup = self.setup(trust)
        if setup.trials * setup.steps >= LONG_STEPS:
            total = (
                f"{setup.trials * setup.steps:.3g} steps in total ({setup.trials} trials of at most"
                f" {setup.steps:.3g} steps of dt = {setup.dt:g})"
            )
            warnings.warn(f"{total}: a smaller number may be meant", RunWarning, stacklevel=2)
        data = carry(setup, out, workers, progress)
        if DIVERGED in data.attrs:
            warnings.warn(str(data.attrs[DIVERGED]), RunWarning, stacklevel=2)
        return data
