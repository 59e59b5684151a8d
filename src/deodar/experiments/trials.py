"""Trials of one model by one plan: prepared once, and run again and again."""

from __future__ import annotations

import contextlib
import threading
import warnings
from collections.abc import Callable, Generator, Mapping, Sequence

from deodar.compiler.build import Build
from deodar.compiler.dynamics import Dynamics
from deodar.errors import ParameterError, RunWarning, WorldError, instance_of
from deodar.experiments.actions import Action, End, Record, Reset, with_pushes
from deodar.experiments.actions import require as require_actions
from deodar.experiments.field_reader import with_readers
from deodar.experiments.levels import acted
from deodar.experiments.observations import require as require_events
from deodar.experiments.running_trial import RunningTrial
from deodar.experiments.trial import Trial, TrialPlan
from deodar.experiments.trial_copies import Numbered, TrialCopies
from deodar.experiments.trial_samples import LOOKS, SampledPlaces, Stops, TrialSamples
from deodar.model.document_graph import graph
from deodar.model.model import Model
from deodar.session import agreement, memory
from deodar.session.exchange import embodied
from deodar.session.run import require_step
from deodar.session.session import require_model, require_seed
from deodar.summary import Summarised, Summary
from deodar.worlds._base import World
from deodar.worlds._failure import errors_of


class Trials(Summarised):
    """Trials of one model by one plan.

    What they have in common is prepared and compiled once: for repeated calls with other trials, seeds and
    values keep the object. Threads may call it at once; trials in a world then wait for each other. A pickled
    object has what it was made from, and is prepared again.

    Together, trials are one batch, each with its world inside the step. When half of the copies have ended,
    the others continue in a batch of half the width: always in a world, otherwise where this saves more time
    than compiling takes. The widths follow from the trials alone, so the same call gives the same bits each
    time. In a batch with other trials the widths may differ: activations then agree to 1e-4 in float32 and to
    1e-10 in float64, until the model amplifies the difference. The reduction of a field for events and
    measures (for example its maximum) is computed inside the step too; only watched ports are copied whole.
    The batch stops at each action of any trial, and at each sample while an action waits for an event; then
    only the copies of the trials in question change. Actions may set parameters that are live numbers.

    One by one, each trial runs beside its world on the host, such as a robot; actions may set any parameter,
    and events and measures may look at sensors of the world. Objects that actions moved are restored.

    At the time of an action a trial is sampled before the action: its effect shows one step (for a world, one
    period) later.

    Args:
        model: the model in its present state.
        plan: what is done and observed in each trial.
        world: the world of the model's sensors and motors; if its starts and goals are given per trial, each
            trial has its own. Together it is one of pure functions, such as an arena.
        precision: float32 or float64.
        together: whether trials run in one batch; False: one by one.
    """

    def __init__(
        self,
        model: Model,
        plan: TrialPlan,
        world: World | None = None,
        precision: str = "float32",
        together: bool = True,
    ) -> None:
        self.plan = instance_of(TrialPlan, plan, "plan")
        self.world, self.precision, self.together = world, precision, together
        self._model = model
        # a world has one state on the host, which all trials reset
        self._world_lock = threading.RLock() if world is not None else contextlib.nullcontext()
        base = require_model(model)
        require_events(plan.events, plan.measures)
        require_actions(plan.actions, [e.name for e in plan.events], base.document, world)
        staged, self._pushes = with_pushes(base, plan.actions)
        doc = staged.document
        self.dt = float(doc.step if plan.dt is None else plan.dt)
        require_step(doc, self.dt)
        self._stops = Stops(plan.gap(self.dt), plan.steps(self.dt), LOOKS if together else 1)
        body = embodied(doc, world) if together else None
        if together and world is not None and body is None:
            raise WorldError(
                f"the world {type(world).__name__} cannot be computed for a batch of copies",
                fix="Run them one by one: dd.Trials(..., together=False)",
            )
        agreement.warn(doc, world, stacklevel=2)
        readers = {}
        if together:
            doc, readers = with_readers(doc, plan.views)
        self.dynamics = Dynamics(staged, Build(doc, precision, body=body))
        self._nodes = graph(doc).nodes
        self._places = SampledPlaces(doc, plan, None if together else world, readers)

    def __reduce__(self) -> tuple[type[Trials], tuple[object, ...]]:
        return Trials, (self._model, self.plan, self.world, self.precision, self.together)

    def memory(self, trials: int = 1) -> int:
        """Return about how many bytes this number of trials needs that run at once, without their samples."""
        return memory.run_bytes(self._nodes, self.precision, trials if self.together else 1)

    def run(
        self,
        trials: Sequence[int] = (0,),
        seed: int = 0,
        values: Mapping[str, Sequence[float]] | None = None,
        between: Callable[[int], None] | None = None,
    ) -> list[Trial]:
        """Run trials, and return the result of each.

        The same trials of a seed give the same results, whatever ran before.

        Args:
            trials: numbers of the trials of the seed.
            seed: seed of all noise.
            values: for parameter paths the value of each trial, of trials that run together.
            between: called after each call of the program with the number of trials that still run; an
                exception that it raises ends the call.

        Returns:
            The result of each trial. One that diverges before it ends has the outcome `diverged` and an
            `error` with the reason; its values are NaN, its events and measures None. The others are not
            affected. A `RunWarning` counts those that diverged.

        Raises:
            NotFinite: all trials diverge.
        """
        out = self.results(trials, seed, values, between)
        lost = [result.error for result in out if result.error is not None]
        if len(lost) == len(out):
            raise lost[0]
        if lost:
            warnings.warn(
                f"{len(lost)} of {len(out)} trials diverged, the first: {lost[0].problems[0].what}",
                RunWarning,
                stacklevel=2,
            )
        return out

    def results(
        self,
        trials: Sequence[int],
        seed: int = 0,
        values: Mapping[str, Sequence[float]] | None = None,
        between: Callable[[int], None] | None = None,
        watched: Sequence[int] | None = None,
    ) -> list[Trial]:
        """Return the result of each trial, as `run` does, also if all diverge, and without a warning.

        `watched`: the trials whose watched values are returned; none: all.
        """
        numbers, seed = [require_seed(t) for t in trials], require_seed(seed)
        if not numbers or len(set(numbers)) < len(numbers):
            raise ParameterError(f"expected trial numbers, each of them once, not {list(trials)}")
        if self.together:
            swept = acted(self.dynamics.doc, self.plan.actions, self._pushes, values or {}, len(numbers))
            with self._world_lock:
                return self._results(Numbered(seed, numbers, swept), between, watched)
        if values:
            raise ParameterError(
                "trials that run one by one have the parameters of the model",
                where=next(iter(values)),
                fix="Run them together, or set the parameter of the model",
            )
        with self._world_lock:
            return [self._results(Numbered(seed, [number]), between, watched)[0] for number in numbers]

    def _results(
        self, numbered: Numbered, between: Callable[[int], None] | None, watched: Sequence[int] | None
    ) -> list[Trial]:
        """Return the results of trials that run together, or of a single one."""
        plan = self.plan
        memory.require(self._nodes, self.precision, len(numbered.trials), 0)
        copies = TrialCopies(self.dynamics, self.dt, numbered, self.world, not self.together)
        if plan.has(Reset):
            copies.keep_start()
        samples = TrialSamples(copies, plan, self._places, watched)
        running = [
            RunningTrial(copies, row, plan.actions, self._pushes) for row in range(len(numbered.trials))
        ]
        for trial in running:
            trial.recording = not any(isinstance(a, Record) and a.on for a in plan.actions)
        with _put_back(None if self.together else self.world, plan.actions):
            to = 0
            while True:
                samples.advance(to, self._stops, running)
                self._act(to, copies, samples, running)
                running_rows = [k for k, row in enumerate(copies.rows) if not samples.ended(row)]
                if between is not None:
                    between(len(running_rows))
                if not running_rows:
                    break
                copies.shrink(running_rows, self._stops.steps - to)
                still_running = [running[row] for row in copies.rows if not samples.ended(row)]
                to = self._stops.after(to, still_running if plan.actions else [])
        return [samples.trial(trial) for trial in running]

    def _act(
        self, tick: int, copies: TrialCopies, samples: TrialSamples, running: Sequence[RunningTrial]
    ) -> None:
        """Carry out the actions that are due."""
        if not self.plan.actions:
            return
        still_running = [running[row] for row in copies.rows if not samples.ended(row)]
        for trial in still_running:
            trial.notice(samples.observed.events_of(trial.row))
        due = [trial for trial in still_running if trial.due == tick]
        if due:
            copies.run.sense()  # a world on the host is at its time, whether or not it was read
            if self.plan.has(End) and not self._stops.sampled(tick):
                samples.look()
        for trial in due:
            trial.do()
            if trial.outcome:
                samples.end(trial, self._stops.sampled(tick))

    def _summary(self) -> Summary:
        doc, batch = self._model.document, "in one batch" if self.together else "one by one"
        return Summary(f"Trials of {doc.name!r}, {batch}, each up to {self.plan.limit:g} {doc.time_unit}")


@contextlib.contextmanager
def _put_back(world: World | None, actions: Sequence[Action]) -> Generator[None]:
    """Restore the changes of actions to a world after the trial."""
    if world is None or not any(a.world_method for a in actions):
        yield
        return
    with errors_of(world, "arrangement"):
        before = world.arrangement()
    try:
        yield
    finally:
        with errors_of(world, "arrange"):
            world.arrange(before)
