"""An experiment: its design, its check and its run."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from deodar.batch.simulate import LONG_STEPS
from deodar.errors import DeodarError, Problem, RunWarning
from deodar.experiments.design import Design
from deodar.experiments.jobs import USABLE
from deodar.experiments.observations import DIVERGED
from deodar.experiments.results import run_trials
from deodar.experiments.setup import Setup
from deodar.resources import Resources, use_resources

if TYPE_CHECKING:
    import xarray


@dataclass(frozen=True, repr=False)
class Experiment(Design):
    """An unattended experiment: many trials of a model, each ended by a condition, and a table of the
    results.

    Trials run together in batches if their world, if any, can be computed inside the step, and no action sets
    a parameter that needs another program; otherwise one by one. Trial k has the noise of trial k of the seed
    in any batch.
    """

    def setup(self, trust: bool = False) -> Setup:
        """Open the model and the world, and check the experiment before any trial runs.

        Raises:
            ParameterError: the experiment has unknown names or invalid values; the error lists all problems.
        """
        return Setup.open(self, trust)

    def check(self) -> list[Problem]:
        """Return the problems of the experiment; an empty list: it can be run."""
        try:
            self.setup(trust=True)
        except DeodarError as error:
            return list(error.problems)
        return []

    def run(
        self,
        out: str | Path | None = None,
        *,
        trust: bool = False,
        part: tuple[int, int] | None = None,
        records: str | Path | None = None,
        on: Resources = Resources(),
    ) -> xarray.Dataset:
        """Run all trials without a row, and return the table of all trials.

        Args:
            out: folder of the results. An existing run in this folder is resumed, with the same results as
                without the stop. None: results are not stored.
            trust: whether functions that the document names may be imported and run.
            part: the first trial and the one after the last, to run a part of the trials; batches that begin
                there are run whole. `dd.merge_results` merges the folders of all parts.
            records: folder, or address of fsspec such as `s3://BUCKET/NAME`, of a store for the records of
                trials: one object for each batch. All workers must reach it. `dd.open_records` reads it.
                None: each trial has files of its own, in `records/` beside the rows.
            on: workers or a cluster; its `progress` counts trials.

        Returns:
            A Dataset over `trial`: levels as coordinates; outcome, duration, times of conditions (NaN: it did
            not occur) and measures as variables. A trial that diverges has the outcome `diverged`, and NaN
            for every number; the variable `diverged` gives its reason, the attribute `diverged` counts such
            trials, and a `RunWarning` repeats it. The rows of the other trials are not affected. A
            `RunWarning` also precedes trials that may take 10^9 steps in total.

        Raises:
            OutputExists: the folder contains another experiment, or something else.
            RecordError: another process runs an experiment in this folder; or rows exist whose records are
                not in the store that `records` names.
            OutputError: the store cannot be written; rows that exist are kept.
            WorkerError: the workers cannot run the experiment; rows that exist are kept.
            KeyboardInterrupt: on Ctrl-C, after the running pieces have ended; their rows are stored.
        """
        use_resources(on, "an experiment", *USABLE)
        setup = self.setup(trust)
        setup.store = "" if records is None else str(records)
        if setup.trials * setup.steps >= LONG_STEPS:
            total = (
                f"{setup.trials * setup.steps:.3g} steps in total ({setup.trials} trials of at most"
                f" {setup.steps:.3g} steps of dt = {setup.dt:g})"
            )
            warnings.warn(f"{total}: a smaller number may be meant", RunWarning, stacklevel=2)
        table = run_trials(setup, out, on, part)
        if DIVERGED in table.attrs:
            warnings.warn(str(table.attrs[DIVERGED]), RunWarning, stacklevel=2)
        return table
