"""An opened experiment: its model, its world, and its trials as pieces of work."""

from __future__ import annotations

import dataclasses as dc
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

from deodar import codec
from deodar.batch.pieces import BATCH_BYTES
from deodar.experiments.actions import Snapshot
from deodar.experiments.checking import check
from deodar.experiments.design import Design
from deodar.experiments.levels import set_values, swept
from deodar.experiments.observations import DIVERGED, TIME
from deodar.experiments.record_target import RECORD, PieceRecords, RecordTarget
from deodar.experiments.rows import KEY, Row
from deodar.experiments.trial import Trial
from deodar.experiments.trials import Trials
from deodar.experiments.writing import trial_records, write_record, write_records
from deodar.model import edit, find
from deodar.model.document_graph import graph
from deodar.model.model import Model, load
from deodar.model.resolve import Node
from deodar.numerics.axes import shape
from deodar.recording import provenance
from deodar.recording.opened import named
from deodar.session import memory
from deodar.session.exchange import embodied
from deodar.summary import Summarised, Summary, counted
from deodar.worlds._base import World
from deodar.worlds._pure import PureWorld

MOST_COPIES = 250
"""Largest number of trials in one batch: enough to be fast (from 64 copies of a line on more hardly help),
few enough that a kill loses little work.
"""

RECORD_BYTES = 256 * 2**20
"""Largest size in bytes of the records of one batch before they are written (a guess that fits a small
machine).
"""


@dataclass(repr=False)
class Setup(Summarised):
    """An experiment that is ready to run.

    Attributes:
        experiment: the experiment.
        model: its model.
        world: its world, or None.
        store: folder or address of the store of the records; empty: each trial has files of its own, beside
            the rows. It does not belong to the identity of the experiment.
    """

    experiment: Design
    model: Model
    world: World | None
    store: str = field(default="", repr=False)
    _prepared_trials: dict[Any, tuple[Trials, Model]] = field(
        default_factory=dict[Any, Any], init=False, repr=False
    )

    @classmethod
    def open(cls, experiment: Design, trust: bool = False) -> Setup:
        """Open the model and the world of an experiment, and check it before any trial runs."""
        source: Any = experiment.model
        model = source if isinstance(source, Model) else load(source, trust)
        place: Any = experiment.world
        world = named(place, "world") if isinstance(place, str) and place else place or None
        check(experiment, model, world)
        return cls(experiment, model, world)

    @cached_property
    def cells(self) -> list[tuple[int, ...]]:
        """Return for each trial the level (its number) of each factor."""
        return self.experiment.cells

    @property
    def trials(self) -> int:
        """Number of trials in total."""
        return len(self.cells)

    @property
    def recorded(self) -> bool:
        """Whether trials have records or snapshots."""
        return bool(self.experiment.plan.watch) or self.experiment.plan.has(Snapshot)

    @property
    def dt(self) -> float:
        """Euler step."""
        return float(self.experiment.plan.dt or self.model.document.step)

    @property
    def steps(self) -> int:
        """Number of steps of a trial that times out."""
        return round(self.experiment.plan.limit / self.dt)

    def shortened(self, steps: int) -> Setup:
        """Return the same setup with another limit, in steps, to measure the time of a step.

        A trial has at least one sampling interval, so the limit is a whole number of them.
        """
        gap = self.experiment.plan.gap(self.dt)
        plan = dc.replace(self.experiment.plan, limit=math.ceil(steps / gap) * gap * self.dt)
        return Setup(dc.replace(self.experiment, plan=plan), self.model, self.world)

    @cached_property
    def batched(self) -> bool:
        """Whether trials run together in one program: their world is computed in the program, and actions
        change numbers of the program and objects of the world.
        """
        plan, doc = self.experiment.plan, self.model.document
        sensors = () if self.world is None else self.world.sensors
        if any(view.of in sensors for view in plan.views):
            return False
        if self.world is not None and embodied(doc, self.world) is None:
            return False
        per_trial = (
            isinstance(self.world, PureWorld) and type(self.world).for_trial is not PureWorld.for_trial
        )
        if any(a.world_method for a in plan.actions) and not per_trial:
            return False
        return all(self._sweeps(path, numbers) for path, numbers in set_values(plan.actions).items())

    def _sweeps(self, path: str, numbers: Sequence[Any]) -> bool:
        """Return whether trials of one batch may differ in a parameter with these values, besides the values
        that it has at the start of trials.
        """
        first = [level[path] for f in self.experiment.factors for level in f.sets if path in level]
        return swept(self.model.document, path, [self.model.get(path), *first, *numbers])

    @cached_property
    def swept(self) -> list[str]:
        """Parameters in which the trials of one batch differ; each value of another parameter has its own
        batches.
        """
        if not self.batched:
            return []
        values: dict[str, list[Any]] = {}
        for factor in self.experiment.factors:
            for level in factor.sets:
                for path, value in level.items():
                    values.setdefault(
                        path,
                        [self.model.get(path)] if any(path not in changes for changes in factor.sets) else [],
                    ).append(value)
        return [path for path, numbers in values.items() if swept(self.model.document, path, numbers)]

    def pieces(self) -> list[list[int]]:
        """Return the trials in the pieces in which they are run: the same for any number of workers."""
        if not self.batched:
            return [[k] for k in range(len(self.cells))]
        groups: dict[str, list[int]] = {}
        by_cell: dict[tuple[int, ...], list[int]] = {}  # trials of a cell have the same values
        for k, levels in enumerate(self.cells):
            if levels not in by_cell:
                fixed = {path: value for path, value in self.changes(k).items() if path not in self.swept}
                by_cell[levels] = groups.setdefault(codec.line(sorted(fixed.items()), other=str), [])
            by_cell[levels].append(k)
        most, out = self._most(), list[list[int]]()
        for group in groups.values():
            size = math.ceil(len(group) / math.ceil(len(group) / most))
            out += [group[i : i + size] for i in range(0, len(group), size)]
        return out

    def changes(self, trial: int) -> dict[str, Any]:
        """Return the parameters that a trial's levels set."""
        out: dict[str, Any] = {}
        for factor, level in zip(self.experiment.factors, self.cells[trial], strict=True):
            out |= factor.sets[level]
        return out

    def rows(self, trials: Sequence[int], records: Path | RecordTarget | None = None) -> list[Row]:
        """Run some trials and return their rows.

        Args:
            trials: numbers of the trials.
            records: the folder or the store of their records; None: no records.

        Raises:
            OutputError: the records cannot be written; the store is not seen.
        """
        out: list[Row] = []
        stored = PieceRecords(records, trials) if isinstance(records, RecordTarget) else None
        for k, trial, model in self._results(trials, () if records is None else self.experiment.plan.watch):
            row = self._row(k, trial)
            if records is not None:
                description = self._about(row) | ({DIVERGED: row[DIVERGED]} if DIVERGED in row else {})
                records_of_trial = trial_records(
                    model.document, self.experiment.plan.watch, trial, description
                )
                if isinstance(records, Path):
                    write_records(records, row[KEY], records_of_trial)
                elif stored is not None:
                    stored.add(row, records_of_trial)
            out.append(row)
        entry = stored.put() if stored is not None else None
        return out if entry is None else [{**row, RECORD: entry} for row in out]

    def _row(self, trial: int, run: Trial) -> Row:
        e = self.experiment
        levels = {f.name: f.labels[n] for f, n in zip(e.factors, self.cells[trial], strict=True)}
        awaited = [c.name for c in e.plan.events if c.ends and run.events[c.name] is None]
        row: Row = {KEY: f"{trial:06}", "trial": trial, "levels": levels, "outcome": run.outcome}
        row |= {
            "awaited": ", ".join(awaited) if run.outcome == TIME else "",
            "duration": run.duration,
        }
        row |= {} if run.error is None else {"duration": None, DIVERGED: run.error.problems[0].what}
        return row | {"events": dict(run.events), "measures": dict(run.measures)}

    def _about(self, row: Row) -> dict[str, Any]:
        e = self.experiment
        shared = {key: row[key] for key in ("levels", "outcome")}
        return {"experiment": e.name, "trial": row["trial"], "seed": e.seed, **shared}

    def repeat(self, trial: int, watch: Sequence[str], path: Path) -> Row:
        """Run a trial again as it ran in the experiment, in its piece, write its record, and return its row.

        Args:
            trial: number of the trial.
            watch: paths of the recorded ports.
            path: the file of the record; an existing one is replaced.
        """
        piece = next(piece for piece in self.pieces() if trial in piece)
        runs = self._results(piece, watch, [trial])
        k, of_trial, _ = next(run for run in runs if run[0] == trial)
        row = self._row(k, of_trial)
        doc = self._with(self.changes(k)).document
        description = (
            self._about(row)
            | {"dt": self.dt, "world": provenance.described(self.world)}
            | provenance.stored(doc)
        )
        write_record(path, doc, watch, of_trial, description)
        return row

    def _results(
        self, trials: Sequence[int], watch: Sequence[str], watched: Sequence[int] | None = None
    ) -> list[tuple[int, Trial, Model]]:
        e = self.experiment
        if not self.batched:
            alone = [(k, *self._prepared(self.changes(k), watch)) for k in trials]
            return [(k, prepared.results([k], e.seed)[0], model) for k, prepared, model in alone]
        changes_of = [self.changes(k) for k in trials]
        fixed = {path: value for path, value in changes_of[0].items() if path not in self.swept}
        prepared, model = self._prepared(fixed, watch)
        values = {
            path: [float(changes.get(path, model.get(path))) for changes in changes_of] for path in self.swept
        }
        runs = prepared.results(trials, e.seed, values, watched=watched)
        return [(k, run, model) for k, run in zip(trials, runs, strict=True)]

    def _prepared(self, changes: Mapping[str, Any], watch: Sequence[str]) -> tuple[Trials, Model]:
        """Return the trials of a model with other parameters, and the model; the last ones are kept."""
        e = self.experiment
        # levels are the same objects in every trial
        key = tuple(watch), tuple((path, id(value)) for path, value in changes.items())
        if key not in self._prepared_trials:
            model = self._with(changes)
            plan = dc.replace(e.plan, watch=watch)
            self._prepared_trials = {key: (Trials(model, plan, self.world, e.precision, self.batched), model)}
        return self._prepared_trials[key]

    def _with(self, changes: Mapping[str, Any]) -> Model:
        """Return the model with other parameters; it shares the compiled programs."""
        doc = self.model.document
        for path, value in changes.items():
            doc = edit.change(doc, path, value)
        out = Model(document=doc, trusted=self.model.trusted)
        out.programs = self.model.programs
        return out

    @property
    def _nodes(self) -> Sequence[Node]:
        return graph(self.model.document).nodes

    @property
    def record_bytes(self) -> float:
        """Size in bytes of the records of a trial that lasts until the limit."""
        plan, by = self.experiment.plan, {node.id: node for node in self._nodes}
        ports = [find.shown(self.model.document, name) for name in plan.watch]
        cells = sum(math.prod(shape(by[entry.id].axes(port))) for entry, port in ports)
        size = 8 if self.experiment.precision == "float64" else 4
        return cells * (plan.limit / (plan.every or self.dt) + 1) * size

    def _most(self) -> int:
        """Return the largest number of trials in one batch."""
        size = memory.copy_bytes(self._nodes, self.experiment.precision)
        recorded = int(RECORD_BYTES // max(1.0, self.record_bytes))
        return max(1, min(MOST_COPIES, BATCH_BYTES // max(1, size), recorded))

    def _summary(self) -> Summary:
        trials = counted(self.trials, "trial")
        return Summary(f"Setup of {self.experiment.name!r}: {trials} of {self.model.name!r}")
