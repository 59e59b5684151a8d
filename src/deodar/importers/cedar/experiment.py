"""Experiments of cedar: sequences of actions, each with a condition, as an `Experiment` of a model."""

from __future__ import annotations

import dataclasses as dc
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from deodar import codec
from deodar.errors import DocumentError
from deodar.experiments.actions import Action, Set
from deodar.experiments.events import Crosses, Event, Reached
from deodar.experiments.experiment import Experiment
from deodar.experiments.factor import Factor
from deodar.importers.cedar.file import items, members, pairs, text
from deodar.importers.cedar.links import KERNEL, NAMES
from deodar.importers.cedar.values import milliseconds, number
from deodar.importers.opening import load, require
from deodar.importers.report import ImportReport, Line, Verdict
from deodar.leaves import get
from deodar.model.document import Document, Entry
from deodar.model.files import MOST_BYTES
from deodar.model.paths import display

LONGEST = 60_000.0
"""Limit of a trial that no action ends at a time, ms (a guess: cedar has no limit)."""

SLOTS = {"activation": "activation", "sigmoided activation": "output"}
KINDS = {
    "Field": "NeuralField",
    "Gain": "StaticGain",
    "GaussianStimulus": "GaussInput",
    "BoxStimulus": "BoxInput",
}
"""Steps by the elements that they became, for the names of their parameters."""

DATA = re.compile(r"(.+?)(?:\[\w+\])?\.([^.\[\]]+)\Z")
"""The path of data: `group.field[BUFFER].activation`."""

OLD = {
    "OnInit": "OnEachTrial",
    "OnTrial": "OnTrialNumber",
    "CheckData": "OnMatrixValue",
    "SetParameter": "SetParameterValue",
    "ParameterAdd": "IncrementParameter",
    "StopAllTriggers": "EndTrial",
}
"""Earlier names of conditions and actions."""


@dc.dataclass(frozen=True)
class ImportedExperiment:
    """An experiment made from a file of cedar, and the report of the conversion."""

    experiment: Experiment
    report: ImportReport


def load_cedar_experiment(path: str | Path, architecture: str | Path) -> ImportedExperiment:
    """Read an experiment of cedar for an architecture of cedar.

    A sequence at the start of each trial or at a time sets parameters then; one with a condition on data sets
    them when its event occurs. `EndTrial` makes a condition that ends the trial. A parameter that is
    incremented in each trial becomes a factor with a level for each repetition. What cannot be carried over
    is in the report.

    Args:
        path: the file of the experiment.
        architecture: the file of the architecture.

    Raises:
        DocumentError: one of the files cannot be read, or the first is no experiment of cedar.
    """
    path = require(path)
    try:
        if path.stat().st_size > MOST_BYTES:
            raise DocumentError(f"is larger than {MOST_BYTES // 2**20} MiB", where=str(path))
        body = members(codec.foreign(path.read_bytes()))
    except OSError as error:
        raise DocumentError(f"cannot be read: {error.strerror}", where=str(path)) from None
    if "ActionSequences" not in body:
        raise DocumentError(
            "is no experiment of cedar", where=str(path), fix='It is an object with "ActionSequences"'
        )
    model = load(architecture)
    reading = _Reading(model.document, body)
    ends = [e.at for e in reading.events if isinstance(e, Reached) and e.ends]
    experiment = Experiment(
        text(body.get("name")) or path.stem,
        model,
        limit=max(ends) + model.document.step if ends else LONGEST,
        trials=1 if reading.factors else reading.repetitions,
        conditions=tuple(reading.events),
        actions=tuple(reading.actions),
        factors=tuple(reading.factors),
    )
    return ImportedExperiment(experiment, ImportReport("cedar", path.name, reading.lines))


class _Reading:
    def __init__(self, doc: Document, body: Mapping[str, Any]) -> None:
        self.by = {e.names: e for e in doc.entries}
        self.repetitions = max(int(number(body.get("repetitions")) or 1), 1)
        self.lines: list[Line] = []
        self.events: list[Event] = []
        self.actions: list[Action] = []
        self.factors: list[Factor] = []
        for k, entry in enumerate(items(body["ActionSequences"])):
            self.sequence(f"sequence {k + 1}", members(entry))

    def say(self, where: str, what: str, verdict: Verdict, why: str = "") -> None:
        self.lines.append(Line(where, "parameter", what, verdict, why))

    def sequence(self, name: str, body: Mapping[str, Any]) -> None:
        """Read one sequence: its condition gives a time or an event, its actions follow."""
        name = text(body.get("name")) or name
        condition = members(body.get("Condition"))
        kind = _short(text(condition.get("type")))
        at, event = self.condition(name, kind, condition)
        if at is None:
            self.say(name, kind or "Condition", "dropped", "deodar has no such condition")
            return
        self.say(name, kind, "carried")
        if event is not None:
            self.events.append(event)
        for action, values in pairs(body.get("ActionSet")):
            self.action(name, _short(action), members(values), at, event)

    def condition(self, name: str, kind: str, body: Mapping[str, Any]) -> tuple[float | None, Crosses | None]:
        """Return the time of the actions, and the event after which they are carried out."""
        if kind == "OnEachTrial":
            return 0.0, None
        if kind == "AtTime":
            time = milliseconds(body.get("Time"))
            return (time if time is not None and time >= 0 else None), None
        if kind != "OnMatrixValue":
            return None, None
        data = body.get("Step Data")
        where = text(data) or ".".join(text(v) for v in members(data).values())
        found = DATA.match(where)
        entry = None if found is None else self.by.get(tuple(found[1].split(".")))
        level, compare = number(body.get("value")), text(body.get("compare operator"))
        if found is None or entry is None or level is None or compare not in (">", "<"):
            return None, None
        whole = text(body.get("check full matrix")) != "false"
        above = compare == ">"
        reduce = "min" if whole == above else "max"
        port = SLOTS.get(found[2], "output")
        event = Crosses(
            name, f"{display(entry.names)}.{port}", level, "above" if above else "below", reduce, ends=False
        )
        return 0.0, event

    def action(
        self, where: str, kind: str, body: Mapping[str, Any], at: float, event: Crosses | None
    ) -> None:
        """Read one action."""
        when = "" if event is None else event.name
        if kind == "EndTrial":
            if event is not None:
                self.events[self.events.index(event)] = dc.replace(event, ends=True)
            else:
                self.events.append(Reached(f"{where} ends", max(at, 0.0)))
            self.say(where, kind, "carried", "as a condition that ends the trial")
            return
        given = members(body.get("Step Parameter", body.get("StepParameter", body)))
        entry, leaf, factor = self.parameter(given)
        value = number(given.get("parameter value", body.get("step value", body.get("step size"))))
        if kind not in ("SetParameterValue", "IncrementParameter") or entry is None or value is None:
            self.say(where, kind, "dropped", "it has no counterpart, or its parameter has none")
            return
        path = f"{display(entry.names)}.{leaf}"
        if kind == "SetParameterValue":
            self.actions.append(Set(at, path, factor * value, when))
        else:
            start = float(get(entry.element, leaf))
            levels = [start + factor * value * k for k in range(self.repetitions)]
            self.factors.append(Factor(f"{where} value", levels, path))
        self.say(where, kind, "carried", path)

    def parameter(self, body: Mapping[str, Any]) -> tuple[Entry | None, str, float]:
        """Return the element, the path of its parameter and the factor of its values."""
        step = text(body.get("element path", body.get("Step")))
        name = text(body.get("parameter path", body.get("Property")))
        entry = self.by.get(tuple(step.split(".")))
        if entry is None:
            return None, "", 1.0
        kind = type(entry.element).__name__
        if name == "global inhibition" and kind == "Field":
            return entry, "global_inhibition", -1.0
        kernel = KERNEL.match(name)
        if kernel:
            return entry, f"kernel.{kernel[1]}.{kernel[2]}", 1.0
        leaf = NAMES.get(KINDS.get(kind, kind), {}).get(name)
        return (entry, leaf, 1.0) if leaf else (None, "", 1.0)


def _short(kind: str) -> str:
    name = kind.rpartition(".")[2]
    return OLD.get(name, name)
