"""Runs of a batch: a sequence is taught, then produced in an arena; what a run leaves, as a row."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from deodar.architectures.color_search import HUES, color_search
from deodar.couplings.arithmetic import Product
from deodar.couplings.positions import PeakPosition
from deodar.couplings.projections import Project
from deodar.elements.stimuli import Boost
from deodar.experiments.actions import Action
from deodar.experiments.events import All, AnyOf, Crosses, Event
from deodar.experiments.rows import Row
from deodar.experiments.trial import Trial, TrialPlan
from deodar.experiments.trials import Trials
from deodar.model.model import Model
from deodar.numerics.windows import Window
from deodar.worlds.arena.arena import Arena
from deodar_papers.serial_order.arenas import SearchArena
from deodar_papers.serial_order.colours import FIVE, TEN, away, hue_of, letter_at, offset
from deodar_papers.serial_order.reasons import reason, require_possible
from deodar_papers.serial_order.sight import chosen, distance
from deodar_papers.serial_order.teaching import Showing
from deodar_papers.serial_order.world import world

EVERY, COARSE = 2.0, 20.0
"""Sampling intervals, ms: each step of the model, and where no times of instabilities are wanted."""

OVER = 400.0
"""Time for which the node behind the sequence is active at the end of a run, ms: more than its activity after
the lesson lasts.
"""

READ = 800.0
"""Interval in which the weights of one node are read after a lesson, ms."""

PULSE = -15.0
"""Input that switches an active node off, to read the weights of the next one."""

PICTURE = 120.0
"""Age up to which a picture may satisfy a condition, ms: a frame of the camera, and the rise of the peak."""

FAR = 170.0
"""Largest distance between the middle of the vehicle and a block that satisfies its condition, mm."""

CHANGED = 250.0
"""Time after the change of the mode at which the activity of the lesson is over, and the first node has not
begun, ms.
"""

SOON = 40.0
"""Time within which a peak of the condition of satisfaction has formed, ms."""

NEXT = 1000.0
"""Time within which the next node is active after a transition, ms; a run may end before."""

TOLERANCE = 9.0
"""Largest distance of the hue of a peak from that of its colour, samples: half that between ten hues."""

PEAKS = "columns of the peak.output"
"""Output of the colour-space field over the columns of the picture, its largest over hue."""

SPARSE = 10
"""Samples between two poses that are judged."""

ABSENT = -1.0
STRONG = 0.3
"""Smallest maximum of the weights of a learned node."""


@dataclass(frozen=True)
class TaughtRun:
    """What is run: a sequence, its lesson and an arena.

    Attributes:
        sequence: letters of the colours that are to be produced.
        lesson: how it is taught, with times of the run.
        taught: duration of the lesson, ms.
        arena: the arena.
    """

    sequence: str
    lesson: Sequence[Showing]
    taught: float
    arena: SearchArena

    @property
    def positions(self) -> int:
        """Length of the longest sequence that is taught."""
        return len(self.sequence)


@dataclass(frozen=True)
class Settings:
    """Settings that all runs of a batch have.

    Attributes:
        limit: longest production, ms.
        clutter: share of the background rows of the picture that random colours cover.
        look_around, habituation: as in `color_search`.
        varied: for each run the parameters of the model that differ from those of the paper's set, by path;
            empty: none.
        actions: actions on each run; `looks for K` is the event that item K becomes active in production.
        coarse: whether samples are taken every 20 ms, where no times of instabilities are wanted.
        cues: number of sequences that the model holds.
        ends_unlearned: whether a run ends when a node of the sequence is active without a colour in the
            action field: it has learned none, so that nothing is looked for.
    """

    limit: float = 600_000.0
    clutter: float = 0.0
    look_around: bool = True
    habituation: bool = False
    varied: Sequence[Mapping[str, float]] = ()
    actions: Sequence[Action] = ()
    coarse: bool = False
    cues: int = 1
    ends_unlearned: bool = False


def prepared(length: int, settings: Settings) -> Model:
    """Create the model of a batch: the architecture with a node more than the longest sequence has colours,
    and what reads single numbers of its fields.
    """
    model = color_search(
        length + 1,
        look_around=settings.look_around,
        habituation=settings.habituation,
        cues=settings.cues,
    )
    for name in ("action", "satisfaction"):
        strongest = model.add(Project([], reduce="max", name=f"strongest {name}"))
        model.connect(f"{name}.activation", strongest)
        model[name] >> model.add(PeakPosition(absent=ABSENT, name=f"hue of {name}"))
    model["colour space"] >> model.add(Project([], reduce="max", name="strongest peak"))
    for k in range(1, length + 2):
        produced = model.add(Product(name=f"produced {k}"))
        model[f"item {k}.node"] >> produced
        model.connect("producing", f"{produced.path}.factor")
    model.set("mode", 1.0)
    return model


def run_many(
    runs: Sequence[TaughtRun],
    settings: Settings,
    seed: int = 0,
    watch: Sequence[str] = (),
    between: Callable[[int], None] | None = None,
) -> list[tuple[Trial, float]]:
    """Run a batch of runs that produce sequences of equal length; other sequences that they are taught may
    be shorter or longer.

    Lessons end at one time, the shorter ones begin later. Returns each trial, and the time at which
    production begins, ms.

    Args:
        runs: the runs.
        settings: their common settings.
        seed: seed of all noise.
        watch: paths of ports that are sampled too.
        between: called after each call of the program, as in `Trials.run`.

    Raises:
        ParameterError: a lesson has another number of colours than its sequence, or an arena lacks a wanted
            colour.
    """
    require_possible(runs, settings.cues == 1)
    [length] = {len(run.sequence) for run in runs}
    model, positions, produced = _staged(runs, settings)
    nodes = [f"item {k}.node" for k in range(1, positions + 2)]
    needed = [
        *(f"{node}.activation" for node in nodes),
        *(f"strongest {name}.output" for name in ("action", "satisfaction", "peak")),
        *(f"hue of {name}.output" for name in ("action", "satisfaction")),
        "pose.output",
        "touching.output",
    ]
    every = COARSE if settings.coarse else EVERY
    times = round(OVER / every)
    events: list[Event] = [Crosses("over", f"produced {length + 1}.output", 0.5, times=times)]
    if settings.ends_unlearned:
        events += _unlearned(length, times)
    if settings.actions:
        looks = (
            Crosses(f"looks for {k}", f"produced {k}.output", 0.5, ends=False) for k in range(1, length + 1)
        )
        events = [*looks, *events]
    limit, watched = produced + settings.limit, list(dict.fromkeys([*needed, *watch]))
    plan = TrialPlan(limit, watched, events, actions=settings.actions, every=every)
    prepared = Trials(model, plan, _world(runs, produced, settings))
    trials = prepared.results(range(len(runs)), seed, _values(model, settings.varied), between)
    return [(trial, produced) for trial in trials]


def _values(model: Model, varied: Sequence[Mapping[str, float]]) -> dict[str, list[float]]:
    """Return for each parameter that any run varies the value of each run."""
    paths = dict.fromkeys(path for values in varied for path in values)
    return {path: [values.get(path, float(model.get(path))) for values in varied] for path in paths}


def _unlearned(length: int, times: int) -> list[Event]:
    """Return the event that a node of the sequence is active in production without a colour for a number of
    samples, and its parts.

    A node that has learned one is without its colour for a few milliseconds at most.
    """
    names = [f"wants {k}" for k in range(1, length + 1)]
    return [
        *(Crosses(name, f"produced {k}.output", 0.5, ends=False) for k, name in enumerate(names, 1)),
        AnyOf("wants a colour", names, ends=False),
        Crosses("no colour", "strongest action.output", 0.0, "below", ends=False),
        All("nothing learned", ["wants a colour", "no colour"], times=times),
    ]


def read_weights(runs: Sequence[TaughtRun], settings: Settings, seed: int = 0) -> list[np.ndarray]:
    """Teach a batch of runs, and return the weights of each (nodes, hues), with those of the node behind the
    sequence.

    The weights are read as the model reads them: after the lesson one node after another is active, each
    until a pulse inhibits all nodes; there is nothing in view.
    """
    model, length, produced = _staged(runs, settings)
    begins = [produced + READ * (k + 1) for k in range(length + 1)]
    pulse = model.add(
        Boost("next", [], amplitude=PULSE, windows=[Window(begin - 100.0, begin - 40.0) for begin in begins])
    )
    for k in range(1, length + 2):
        pulse >> model[f"item {k}.node"]
    limit = READ * (length + 1)
    world = _world([replace(run, arena=replace(run.arena, blocks=())) for run in runs], produced, settings)
    plan = TrialPlan(produced + limit, ["all meanings.output"], every=READ / 8)
    trials = Trials(model, plan, world).results(range(len(runs)), seed)
    # read shortly before each pulse
    at = [round((begin - 200.0) / (READ / 8)) for begin in begins]
    return [trial.values["all meanings.output"][at] for trial in trials]


def learned(run: TaughtRun, weights: np.ndarray) -> Row:
    """Return what a lesson leaves: the colour of each node, and the shape of its weights."""
    hues = np.arange(HUES)
    shapes: list[list[float]] = []
    letters = ""
    for row in weights:
        top = float(row.max())
        among = tuple(TEN if run.sequence[0] in TEN else FIVE)
        letter = letter_at(float(row.argmax()), among) if top >= STRONG else "-"
        letters += letter
        if letter != "-":
            turn = np.angle(np.sum(row * np.exp(2j * math.pi * hues / HUES))) * HUES / (2 * math.pi)
            deviation = offset(float(turn), hue_of(letter))
            shapes.append([round(top, 3), int((row > top / 2).sum()), round(deviation, 3)])
    return {
        "sequence": run.sequence,
        "learned": letters,
        "right": letters == run.sequence + "-",
        "weights": shapes,
        "taught": round(run.taught / 1000, 3),
    }


def end_of_lessons(runs: Sequence[TaughtRun]) -> float:
    """Return the time at which the lessons of a batch end, a multiple of the periods of the world."""
    return math.ceil(max(run.taught for run in runs) / 800.0) * 800.0


def _staged(runs: Sequence[TaughtRun], settings: Settings) -> tuple[Model, int, float]:
    """Return the model of a batch, the length of the longest sequence that is taught, and the time at which
    production begins.
    """
    positions = max(run.positions for run in runs)
    model, produced = prepared(positions, settings), end_of_lessons(runs)
    model.set("producing.windows", [Window(produced)])
    return model, positions, produced


def _world(runs: Sequence[TaughtRun], produced: float, settings: Settings) -> Arena:
    lessons = [[s.later(produced - run.taught) for s in run.lesson] for run in runs]
    return world([run.arena for run in runs], lessons, produced, settings.clutter)


def found(run: TaughtRun, trial: Trial, produced: float) -> Row:
    """Return what a production leaves: the blocks found, the times of all instabilities, and the outcome.

    A block is found where the condition of satisfaction switches an ordinal node off, or where another node
    follows a node; its colour is that of the peak of the condition of satisfaction, `?` without one. The
    outcome is `wrong` where the nodes, from the first one on, do not follow each other, where a colour is not
    that of its node, or where no block of this colour was near.
    """
    v, times = trial.values, trial.times
    begin = int(np.searchsorted(times, produced))
    t = times[begin:] - produced
    count = sum(name.endswith(".node.activation") for name in v)
    nodes = np.stack([v[f"item {k}.node.activation"][begin:] > 0 for k in range(1, count + 1)], axis=1)
    nodes[t < CHANGED] = False
    on = {name: v[f"strongest {name}.output"][begin:] > 0 for name in ("action", "satisfaction")}
    on["peak"] = v["strongest peak.output"][begin:] > 0.5
    pose = v["pose.output"][begin:]
    letters = tuple(sorted({b.letter for b in run.arena.blocks} | set(run.sequence)))
    completed = _completed(t, nodes, on["satisfaction"])
    ends, got = list[int](), list[str]()
    for step in completed:
        hue = _peak(
            v["hue of satisfaction.output"][begin + step.satisfied :], times[begin + step.satisfied :]
        )
        ends.append(step.satisfied)
        got.append(_letter(hue, letters))
    # the picture is that of a moment ago, before the vehicle was carried
    moments = [pose[(t <= t[k]) & (t >= t[k] - PICTURE)] for k in ends]
    far = [
        min(distance(run.arena, letter, row) for row in rows)
        for letter, rows in zip(got, moments, strict=True)
    ]
    produced_ = "".join(got)
    order = [step.node for step in completed]
    in_order = order == list(range(1, len(order) + 1))
    right = in_order and run.sequence.startswith(produced_) and all(d <= FAR for d in far)
    starts = [0.0, *(float(t[k]) for k in ends)]
    sight: Row = {}
    if PEAKS in v:
        columns = v[PEAKS][begin:]
        finds = zip(got, ends, strict=True)
        sight["chosen"] = [chosen(run.arena, letter, pose[k], columns[k]) for letter, k in finds]
    outcome = "wrong" if not right else "complete" if produced_ == run.sequence else "unfinished"
    return {
        "sequence": run.sequence,
        "produced": produced_,
        "outcome": outcome,
        **({"reason": reason(run, trial, produced)} if outcome == "unfinished" else {}),
        "nodes": order,
        "found": [round(float(t[k]) / 1000, 3) for k in ends],
        "actions": [round((b - a) / 1000, 3) for a, b in itertools.pairwise(starts)],
        "distances": [round(d, 1) for d in far],
        "left": _left(run, got, ends, pose),
        "transitions": transitions(t, nodes, on),
        **sight,
        "touching": round(float(v["touching.output"][begin:].mean()), 4),
        "length": round(float(np.linalg.norm(np.diff(pose[:, :2], axis=0), axis=1).sum()), 1),
    }


def transitions(t: np.ndarray, nodes: np.ndarray, on: Mapping[str, np.ndarray]) -> list[list[float | None]]:
    """Return for each completed node the times of the instabilities in ms, from the moment at which it is
    switched off: satisfaction on, action off, peak off, satisfaction off, next node on, next action on.

    The next node is None where the node that is active next is not the next one. A transition is left out
    where the run ends before any node is active again.
    """
    out: list[list[float | None]] = []
    for step in _completed(t, nodes, on["satisfaction"]):
        i = step.off
        later = np.flatnonzero(nodes[i:].any(axis=1))
        if not len(later) and t[-1] - t[i] < NEXT:
            continue
        j = i + int(later[0]) if len(later) else len(t) - 1
        follows = len(later) > 0 and step.node < nodes.shape[1] and bool(nodes[j, step.node])
        row = [
            t[step.satisfied] if on["satisfaction"][step.satisfied] else None,
            _first(t, ~on["action"], i),
            _first(t, ~on["peak"], i),
            _last_off(t, on["satisfaction"], i, j),
            t[j] if follows else None,
            _first(t, on["action"], j) if follows else None,
        ]
        out.append([None if moment is None else round(float(moment - t[i]), 3) for moment in row])
    return out


def _left(run: TaughtRun, letters: Sequence[str], ends: Sequence[int], pose: np.ndarray) -> list[bool]:
    """Return for each block that was found whether its colour had left the middle of the picture, or the
    vehicle was far from it, at some time since the block before was found.
    """
    begins = [0, *ends][: len(ends)]
    return [
        any(distance(run.arena, letter, row) > FAR for row in pose[begin : end + 1 : SPARSE])
        for letter, begin, end in zip(letters, begins, ends, strict=True)
    ]


def _rises(on: np.ndarray) -> np.ndarray:
    """Return the samples at which something is switched on; the first one, if it is on at the start."""
    return np.flatnonzero(np.diff(on.astype(int), prepend=0) == 1)


def _falls(on: np.ndarray) -> np.ndarray:
    """Return the samples at which something is switched off."""
    return np.flatnonzero(np.diff(on.astype(int)) == -1) + 1


class _CompletedNode(NamedTuple):
    """The number of a node, and the samples at which it is switched off and at which the peak began that
    switched it off; the same sample without such a peak.
    """

    node: int
    off: int
    satisfied: int


def _completed(t: np.ndarray, nodes: np.ndarray, satisfied: np.ndarray) -> list[_CompletedNode]:
    """Return each node that the condition of satisfaction switches off, or that another one or none follows,
    in the order of time. Noise alone may switch a node off and on again while its activation rises.
    """
    begun = _rises(satisfied)
    out: list[_CompletedNode] = []
    for k in range(nodes.shape[1]):
        for off in _falls(nodes[:, k]).tolist():
            peaks = begun[(begun <= off) & (t[begun] >= t[off] - SOON)]
            later = np.flatnonzero(nodes[off:].any(axis=1))
            if len(peaks) or not len(later) or not nodes[off + later[0], k]:
                out.append(_CompletedNode(k + 1, off, int(peaks[-1]) if len(peaks) else off))
    return sorted(out, key=lambda step: step.off)


def _letter(hue: float | None, letters: Sequence[str]) -> str:
    """Return the colour of a hue; `?` where it is that of none."""
    if hue is None:
        return "?"
    letter = letter_at(hue, letters)
    return letter if away(hue, hue_of(letter)) <= TOLERANCE else "?"


def _peak(hues: np.ndarray, times: np.ndarray) -> float | None:
    """Return the hue of a peak that begins now; None if there is none soon."""
    soon = hues[times <= times[0] + SOON]
    hues_of_peaks = soon[soon != ABSENT]
    return float(hues_of_peaks[-1]) if len(hues_of_peaks) else None


def _first(t: np.ndarray, true: np.ndarray, begin: int) -> float | None:
    places = np.flatnonzero(true[begin:])
    return float(t[begin + places[0]]) if len(places) else None


def _last_off(t: np.ndarray, on: np.ndarray, begin: int, end: int) -> float | None:
    """Return the last time from `begin` to `end` at which something is switched off."""
    off = _falls(on[begin : end + 1])
    return float(t[begin + off[-1]]) if len(off) else None
