"""Record a session into a file while a script, the wall clock or the studio advances it."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from deodar import codec
from deodar.codec import JsonObject
from deodar.compiler.executable import Executable
from deodar.compiler.program import Port
from deodar.errors import DeodarError, NotFinite, ParameterError, TimeError
from deodar.model import find, output
from deodar.numerics.axes import shape
from deodar.recording import provenance
from deodar.recording.probe import Probe, selector
from deodar.session.journal import Change, JournalReader, to_file
from deodar.session.run import Run, gaps
from deodar.summary import Summarised, Summary

if TYPE_CHECKING:
    from deodar.recording.growing import GrowingRecord

MOST_RECORDS = 64
"""Records of one chunk: a session advances by few steps at a time."""


class Recorder(Summarised):
    """The record of a session that is being written; `Session.record` returns it.

    It ends with `close`, at the end of a `with` block, or by itself where the record cannot continue: after a
    reset or a restored snapshot, if a recorded element is removed or gets other axes, or if the interval is
    not a multiple of a new dt. `ended` then states the reason.

    Attributes:
        path: the record, or the folder with the record and the model.
        names: names of the variables.
        ended: why it ended; empty while it is written.
    """

    def __init__(
        self,
        run: Run,
        journal: Sequence[Change],
        path: Path,
        probes: Sequence[Probe],
        every: float | None,
        force: bool = False,
    ) -> None:
        # start-up time: these import xarray
        from deodar.recording import folder, record
        from deodar.recording.growing import GrowingRecord

        self.path, self.ended = path, ""
        doc = run.doc
        ports = [find.shown(doc, probe.path) for probe in probes]
        if len(set(ports)) < len(ports):
            raise ParameterError("a port is recorded twice", fix="Record each port once")
        self._places = [(entry.id, port) for entry, port in ports]
        self._every = [every if probe.every is None else probe.every for probe in probes]
        steps = gaps(self._every, run.clock.dt)
        self._gap = math.gcd(*steps)
        self._axes = [run.program.axes(port) for port in self._ports(run.program)]
        self._selector = selector(ports, [n // self._gap for n in steps], [probe.when for probe in probes])
        self.names = list(self._selector.thresholds)
        self._taken, self._next = 0, run.clock.tick
        self._journal, self._reader, self._changes = journal, JournalReader(journal), list[JsonObject]()
        variables: list[Any] = [
            (entry, port, axes, np.empty((0, *shape(axes)), run.program.program.dtype))
            for (entry, port), axes in zip(ports, self._axes, strict=True)
        ]
        settings: dict[str, Any] = {
            "session": {"tick": run.clock.tick, "time": run.clock.time},
            "seed": run.seed,
            "record": list(map(str, probes)),
            "every": every,
        }
        description = provenance.provenance(doc, run, **settings)
        empty = record.dataset(doc, variables, np.empty(0), None, {}, description)
        self._writer: GrowingRecord | None = GrowingRecord(
            folder.begin(doc, path, force),
            record.with_times(empty, self._selector.found),
            [series.dimension for series in self._selector.found],
        )
        try:
            self.compile(run.program)
            self.sample(run)
        except BaseException:
            self._writer.abandon()
            raise

    # ------------------------------------------------------------------------------------- by the session

    def compile(self, program: Executable) -> None:
        """Compile what `advance` calls of a program, if that has all recorded ports."""
        compile_records(program, self._places)

    def advance(self, run: Run, steps: int) -> None:
        """Advance a run by `steps` Euler steps, and record the samples that are due.

        Raises:
            OutputError: samples cannot be written; the record has ended, and the steps may be taken again.
        """
        if not self._fits(run):
            run.advance(steps)
            return
        clock, due = run.clock, self._next - run.clock.tick

        def collect(k: int, seen: tuple[np.ndarray, ...]) -> None:
            ticks = clock.tick + due + (k + np.arange(len(seen[0]))) * self._gap
            self._put(clock.t0 + (ticks - clock.tick0) * clock.dt, seen)

        try:
            run.record(steps, self._ports(run.program), due, self._gap, collect, most=MOST_RECORDS)
        except NotFinite as error:
            self.end(error.problems[0].what)
            raise

    def sample(self, run: Run) -> None:
        """Record the present state, if a sample is due at this tick."""
        if self._next == run.clock.tick and self._fits(run):
            self._put(
                np.asarray([run.clock.time]), [values[None] for values in run.read(self._ports(run.program))]
            )

    def note(self) -> None:
        """Store the changes of the session since the last call, with their ticks."""
        gone, new = self._reader.news(self._journal)
        self._changes[len(self._changes) - gone :] = map(to_file, new)
        if new and self._writer is not None:
            self._writer.annotate("changes", codec.line(self._changes))

    def restep(self, run: Run, factor: float) -> None:
        """Adapt to a new step of the run; `factor` is the old step over the new one.

        The next sample stays at its time, rounded up to a step.
        """
        try:
            steps = gaps(self._every, run.clock.dt)
        except TimeError as error:
            self.end(f"the step has become {run.clock.dt:g}: {error.problems[0].what}")
            return
        self._gap = math.gcd(*steps)
        strides = {name: n // self._gap for name, n in zip(self.names, steps, strict=True)}
        new = [series._replace(stride=strides[series.names[0]]) for series in self._selector.found]
        if new != self._selector.found:  # some interval is a time, another one a step
            self._selector.found, self._taken = new, 0
        self._next = run.clock.tick + math.ceil((self._next - run.clock.tick) * factor - 1e-6)

    def end(self, reason: str) -> None:
        """End the record before its time."""
        self._end(reason, False, {"ended": reason})

    # -------------------------------------------------------------------------------------- by the script

    def close(self) -> None:
        """Complete the record; a second call does nothing.

        Raises:
            OutputError: samples cannot be written; those before are in the file.
        """
        self._end("closed", True)

    @property
    def open(self) -> bool:
        """Whether samples are still recorded."""
        return self._writer is not None

    def __enter__(self) -> Recorder:
        return self

    def __exit__(self, kind: type[BaseException] | None, *_: object) -> None:
        if kind is None:
            self.close()
        else:
            self.end(f"{kind.__name__} ended the script")

    # --------------------------------------------------------------------------------------------- inside

    def _end(self, reason: str, complete: bool, settings: Mapping[str, str] | None = None) -> None:
        if self._writer is not None:
            self.note()
            writer, self._writer = self._writer, None
            try:
                writer.close(complete, settings=settings)
                if complete:
                    output.note(self.path)
            finally:
                self.ended = reason

    def _put(self, times: np.ndarray, values: Sequence[np.ndarray]) -> None:
        assert self._writer is not None
        named = dict(zip(self.names, values, strict=True))
        try:
            for chosen in self._selector.choose(self._taken, times, named):
                self._writer.put(chosen.dimension, chosen.times, chosen.values)
        except DeodarError as error:
            writer, self._writer = self._writer, None
            writer.abandon()
            self.ended = error.problems[0].what
            error.advise(f"The record until then is kept: {self.path}")
            raise
        self._taken += len(times)
        self._next += len(times) * self._gap

    def _fits(self, run: Run) -> bool:
        """Return whether the record continues; end it if a recorded port is gone or has other axes."""
        if self._writer is None:
            return False
        row = run.program.plan.row
        lost = [n for n, (ident, _) in zip(self.names, self._places, strict=True) if ident not in row]
        if lost:
            self.end(f"{lost[0]} was removed")
            return False
        for name, port, axes in zip(self.names, self._ports(run.program), self._axes, strict=True):
            if run.program.axes(port) != axes:
                self.end(f"{name} has other axes")
                return False
        return True

    def _ports(self, program: Executable) -> list[Port]:
        return [program.port(ident, port) for ident, port in self._places]

    def _summary(self) -> Summary:
        state = f"ended: {self.ended}" if self.ended else "being written"
        return Summary(f"Record {self.path}, {state}", [(name,) for name in self.names])


def compile_records(program: Executable, places: Sequence[tuple[str, str]]) -> None:
    """Compile what a recorder of ports (id and name) calls of a program, if that has all of them."""
    if all(ident in program.plan.row for ident, _ in places):
        program.chunk([program.port(ident, port) for ident, port in places], MOST_RECORDS)
