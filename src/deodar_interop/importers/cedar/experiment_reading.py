"""The sequences of an experiment of cedar, as events, actions and factors of an `Experiment`."""

from __future__ import annotations

import dataclasses as dc
import re
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from deodar.couplings.arithmetic import Gain, Pointwise, Sigmoid, Sum
from deodar.couplings.learning import AdaptiveWeights
from deodar.element import Element
from deodar.elements.memories import MemoryTrace
from deodar.elements.stimuli import Boost
from deodar.experiments.actions import Action, End, Set, Snapshot
from deodar.experiments.design import OWN
from deodar.experiments.events import All, Crosses, Event, Reached
from deodar.experiments.factor import Factor
from deodar.importers.report import Line, Verdict
from deodar.model import edit
from deodar.model.document import Document, Entry
from deodar.model.paths import display
from deodar.numerics.sigmoids import Step
from deodar_interop.importers._foreign import FreeNames
from deodar_interop.importers.cedar import translate
from deodar_interop.importers.cedar.condition import DataCondition, TrialCondition, condition, rounded, short
from deodar_interop.importers.cedar.file import StepPath, items, members, pairs, text
from deodar_interop.importers.cedar.held import ChangedParameter, TrialParameters, named
from deodar_interop.importers.cedar.values import number
from deodar_interop.importers.cedar.wiring import BUFFER

LONGEST = 60_000.0
"""Limit of a trial that no action ends at a time, ms (a guess: cedar has no limit)."""

MOST_TRIALS = 10_000
"""Largest number of repetitions; more are not run (a guess)."""

DATA = re.compile(r"(.+?)(?:\[\w+\])?\.([^.\[\]]+)\Z")
"""The path of data: `group.field[BUFFER].activation`."""

LOST = {
    "WriteMessage": "rows have the times of events, no texts",
    "CallElementAction": "deodar resets all elements of a trial together, by Reset",
    "IterateDirectoryContents": "deodar has no factor over the files of a folder",
}
"""Actions without a counterpart."""

LOG = ("Success", "Message", "stop triggers")
"""What `EndTrial` states for cedar's log and clock."""


@dc.dataclass
class ActionSequence:
    """The actions of a condition, with the name of the event after which they are carried out."""

    name: str
    when: TrialCondition
    actions: Sequence[tuple[str, Mapping[str, Any]]]
    event: str = ""


ParameterPath = tuple[StepPath, str]
"""A parameter: the path of a step, and the name."""

StartChange = tuple[ActionSequence, ChangedParameter, float, bool]
"""A change at the start of trials: its sequence, the parameter, the number, and whether it is added."""


class ExperimentReading:
    """The parts of an experiment, as they are read.

    Attributes:
        doc: the document, with the elements that count the entries of data.
        repetitions: number of trials.
        events: events by name.
        actions: actions that are carried out in a trial.
        factors: parameters in which trials differ.
        limit: time after which a trial ends, ms.
        lines: lines of the report.
    """

    def __init__(self, doc: Document, parts: translate.StepTranslation, body: Mapping[str, Any]) -> None:
        self.doc, self.parts = doc, parts
        self.lines: list[Line] = []
        self.events: dict[str, Event] = {}
        self.actions: list[Action] = []
        self.factors: list[Factor] = []
        entries = {e.names: e for e in doc.entries}
        self.parameters = TrialParameters(parts.steps, entries)
        self.names = FreeNames([e.path for e in doc.entries])
        self.titles = FreeNames((*OWN, ""))
        repetitions = max(int(number(body.get("repetitions")) or 1), 1)
        self.repetitions = min(repetitions, MOST_TRIALS)
        if repetitions != self.repetitions:
            self.say("", "repetitions", "approximated", f"{repetitions} are too many; {MOST_TRIALS} are run")
        sequences = [s for k, e in enumerate(items(body["ActionSequences"])) if (s := self.sequence(k, e))]
        listed = [values for s in sequences for kind, values in s.actions if kind == "EndTrial"]
        self.reloads = any(text(values.get("Reset type")) == "Reload" for values in listed)
        self.end, self.limit = self.times(sequences)
        self.starting: list[StartChange] = []
        # those at the start first: later ones depend on what a trial begins with
        for sequence in sorted(sequences, key=lambda s: bool(s.when.at or s.when.data)):
            for kind, values in sequence.actions:
                self.action(sequence, kind, values)
        self.start()

    def say(self, where: str, name: str, verdict: Verdict, why: str = "") -> None:
        self.lines.append(Line(where, "parameter", name, verdict, why))

    def sequence(self, k: int, entry: Any) -> ActionSequence | None:
        """Return a sequence; None if its condition has no counterpart, or never holds."""
        body = members(entry)
        name = self.titles.new(text(body.get("name")) or f"sequence {k + 1}")
        condition_body = members(body.get("Condition"))
        kind, when = short(text(condition_body.get("type"))), condition(condition_body)
        if when is None:
            self.say(name, kind or "Condition", "dropped", "deodar has no such condition")
            return None
        dt = self.doc.step
        when = dc.replace(when, at=rounded(when.at, dt))
        if not 0 <= when.trial <= self.repetitions:
            why = f"it never holds: there are {self.repetitions} trials"
            self.say(name, kind, "carried", why)
            return None
        parts = [self.compared(name, data) for data in when.data]
        if any(part is None for part in parts):
            self.say(name, kind, "dropped", "its data have no counterpart")
            return None
        self.say(name, kind, "carried")
        actions = [(short(kind), members(values)) for kind, values in pairs(body.get("ActionSet"))]
        return ActionSequence(
            name, when, actions, self.event(name, when, [p for p in parts if p is not None])
        )

    def event(self, name: str, when: TrialCondition, parts: list[Crosses]) -> str:
        """Add the event of a condition, and return its name; "" if a time in every trial is enough."""
        if not parts and not when.trial:
            return ""
        events: list[Crosses | Reached | All] = list(parts)
        if when.at or not parts:
            events.append(Reached(name, when.at, ends=False))
        if len(events) > 1:
            titles = [self.titles.new(f"{name}, part {k + 1}") for k in range(len(events))]
            listed = [dc.replace(member, name=title) for member, title in zip(events, titles, strict=True)]
            self.events |= {member.name: member for member in listed}
            events = [All(name, [member.name for member in listed], ends=False)]
        self.events[name] = events[0]
        return name

    def compared(self, name: str, data: DataCondition) -> Crosses | None:
        """Return the event of a comparison; what counts entries becomes elements of the model."""
        match = DATA.match(data.path)
        path = () if match is None else tuple(match[1].split("."))
        piece = self.parts.pieces.get(path)
        slot = "" if match is None else match[2]
        outlet = None if piece is None else piece.outlets.get(slot, piece.outlets.get(f"{BUFFER}{slot}"))
        source = None if outlet is None else self.doc.by_names().get((*path[:-1], outlet.name))
        if outlet is None or source is None:
            return None
        port = f"{display(source.names)}.{outlet.port}"
        above = data.compare == ">"
        if data.compare != "=" and data.count <= 1:
            reduce = "min" if (data.count == 0) == above else "max"
            return Crosses(name, port, data.value, "above" if above else "below", reduce, ends=False)
        count_port = self.counter(name, path[:-1], source, outlet.port, data)
        if not data.count:
            return Crosses(name, count_port, 0.5, "above", "min", ends=False)
        return Crosses(name, count_port, data.count - 0.5, "above", "sum", ends=False)

    def counter(self, name: str, group: StepPath, source: Entry, port: str, data: DataCondition) -> str:
        """Add elements that give 1 at each entry for which a comparison holds; return their port."""

        def new(role: str) -> str:
            return self.names.new(f"{name} {role}".replace(".", " "))

        holds: Element
        inner: list[Element]
        if data.compare == ">":
            inner = [Sigmoid(Step(data.value), name=new("holds"))]
        elif data.compare == "<":
            inner = [Gain(-1.0, name=new("minus")), Sigmoid(Step(-data.value), name=new("holds"))]
        else:
            inner = [
                Sum(name=new("distance")),
                Pointwise("abs", name=new("size")),
                Sigmoid(Step(0.0), name=new("differs")),
                Gain(-1.0, name=new("minus")),
                Sum(name=new("holds")),
            ]
        entries: list[Entry] = []
        for element in inner:
            self.doc, entry = edit.add(self.doc, element, group)
            before, out = (entries[-1], "output") if entries else (source, port)
            self.doc = edit.connect(self.doc, before, out, entry, "input")
            entries.append(entry)
        if data.compare == "=":
            for constant_value, target in ((-data.value, entries[0]), (1.0, entries[-1])):
                self.doc, constant = edit.add(self.doc, Boost(new("constant"), (), constant_value), group)
                self.doc = edit.connect(self.doc, constant, "output", target, "input")
        holds = entries[-1].element
        return f"{display((*group, holds.name))}.output"

    def times(self, sequences: Sequence[ActionSequence]) -> tuple[float, float]:
        """Return when every trial ends at the latest, and the limit of trials."""
        dt, end = self.doc.step, float("inf")
        latest = max((s.when.at for s in sequences), default=0.0)
        for s in sequences:
            if not s.event and any(kind == "EndTrial" for kind, _ in s.actions):
                end = min(end, s.when.at)
        return end, (end if end < float("inf") else rounded(max(LONGEST, latest), dt)) + dt

    def action(self, sequence: ActionSequence, kind: str, body: Mapping[str, Any]) -> None:
        """Read one action."""
        where, when = sequence.name, sequence.when
        if not sequence.event and when.at > self.end:
            self.say(where, kind, "carried", "never: every trial has ended by then")
        elif kind == "EndTrial":
            self.ending(sequence)
            for name in body:
                if name in LOG:
                    self.say(where, name, "carried", "of cedar's log and clock only")
            self.say(where, kind, "carried", "as a condition that ends the trial")
        elif kind == "StoreSerializableData":
            learned = (MemoryTrace, AdaptiveWeights)
            ports = {e.path: "weights" for e in self.doc.entries if isinstance(e.element, AdaptiveWeights)}
            ports |= {e.path: "output" for e in self.doc.entries if isinstance(e.element, learned[0])}
            listed = [f"{path}.{port}" for path, port in ports.items()]
            label = text(body.get("filename")).replace("\\", "/").rpartition("/")[2] or where
            if listed:
                self.schedule(sequence, lambda at, event: Snapshot(at, label, listed, event))
            self.say(
                where, kind, "carried", "as a snapshot of traces and weights" if listed else "it has none"
            )
        elif kind in ("SetParameterValue", "IncrementParameter"):
            self.changing(sequence, kind, body)
        else:
            self.say(where, kind, "dropped", LOST.get(kind, "deodar has no such action"))

    def ending(self, sequence: ActionSequence) -> None:
        """Let a sequence end the trial."""
        if sequence.when.trial:
            self.schedule(sequence, lambda at, event: End(at, f"{sequence.name} ends", event))
        elif sequence.event:
            event: Any = self.events[sequence.event]
            self.events[sequence.event] = dc.replace(event, ends=True)
        else:
            name = self.titles.new(f"{sequence.name} ends")
            self.events[name] = Reached(name, sequence.when.at)

    def schedule(
        self, sequence: ActionSequence, make: Callable[[float | Sequence[float], str], Action]
    ) -> None:
        """Add an action at the time of its sequence, after its event, or in one trial only."""
        trial = sequence.when.trial
        if not sequence.event:
            self.actions.append(make(sequence.when.at, ""))
        elif not trial:
            self.actions.append(make(0.0, sequence.event))
        else:
            never = self.limit + self.doc.step
            at = [0.0 if k + 1 == trial else never for k in range(self.repetitions)]
            self.actions.append(make(at, sequence.event))

    def changing(self, sequence: ActionSequence, kind: str, body: Mapping[str, Any]) -> None:
        """Read an action that sets or increments a parameter."""
        action, adds = named(body), kind == "IncrementParameter"
        parameter = self.parameters.find(action)
        raw = action.get("parameter value", body.get("step value", body.get("step size")))
        parameter_value = None if parameter is None else self.parameters.given(parameter, raw)
        if parameter is None or parameter_value is None:
            self.say(sequence.name, kind, "dropped", "its parameter or its value has no counterpart")
        elif not sequence.when.at and not sequence.when.data:
            self.starting.append((sequence, parameter, parameter_value, adds))
        elif adds:
            why = "an increment during a trial; increments at the start of trials are factors"
            self.say(sequence.name, kind, "dropped", why)
        else:
            self.later(sequence, parameter, parameter_value)

    def later(self, sequence: ActionSequence, parameter: ChangedParameter, value: float) -> None:
        """Set a parameter during a trial."""
        key = (parameter.step, parameter.name)
        number = self.parameters.here(parameter, {**self.begun(1, {}), key: value})
        verdict, why = "carried", parameter.path
        always = any(
            (p.step, p.name) == key and not s.when.trial for s, p, _, adds in self.starting if not adds
        )
        if self.repetitions > 1 and not self.reloads and not always:
            verdict = "approximated"
            why = f"{why}; cedar keeps the value for the next trial, which begins with the file's here"
        self.schedule(sequence, lambda at, event: Set(at, parameter.path, number, event))
        self.say(sequence.name, "SetParameterValue", verdict, why)

    def begun(self, trial: int, values: Mapping[ParameterPath, float]) -> dict[ParameterPath, float]:
        """Return the parameters that are changed when a trial has begun, in cedar's numbers.

        `values` are those when the trial before had begun.
        """
        out = {} if self.reloads else dict(values)
        for sequence, parameter, value, adds in self.starting:
            if sequence.when.trial in (0, trial):
                key = (parameter.step, parameter.name)
                out[key] = value + (out.get(key, parameter.value) if adds else 0.0)
        return out

    def start(self) -> None:
        """Give parameters their values at the start of trials: the same in all, or a factor."""
        changed = {parameter.path: parameter for _, parameter, _, _ in self.starting}
        rows: list[dict[str, float]] = []
        values: dict[ParameterPath, float] = {}
        for k in range(self.repetitions if changed else 0):
            values = self.begun(k + 1, values)
            rows.append(
                {path: self.parameters.here(parameter, values) for path, parameter in changed.items()}
            )
        levels = [row[path] for row in rows for path in row]
        if all(row == rows[0] for row in rows):
            same = rows[0] if rows else {}
            self.actions = [*(Set(0.0, path, value) for path, value in same.items()), *self.actions]
        elif len(changed) == 1 and len(set(levels)) == len(levels):
            name = self.titles.new(f"{self.starting[0][0].name} value")
            self.factors = [Factor(name, levels, next(iter(changed)))]
        else:
            name = self.titles.new("values at the start")
            self.factors = [Factor(name, {f"{k + 1}": row for k, row in enumerate(rows)})]
        for sequence, parameter, _, adds in self.starting:
            kind = "IncrementParameter" if adds else "SetParameterValue"
            self.say(sequence.name, kind, "carried", parameter.path)
