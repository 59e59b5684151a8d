"""Runs of figures 3, 8 and 12: a transition, a picture of the camera, and three demonstrations."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from deodar.analysis.claims import Claim
from deodar.architectures.color_search import COLUMNS, HUES
from deodar.architectures.serial_order import OFF, RESTING, STEEP, STRENGTHS
from deodar.numerics.windows import Window
from deodar.session.session import Session
from deodar_papers.figures.demonstrations import demonstrations_figure
from deodar_papers.figures.ordinal_dynamics import OrdinalMoment, OrdinalTransition, transition_figure
from deodar_papers.figures.perception import ColourPerception, perception_figure
from deodar_papers.serial_order import narrative
from deodar_papers.serial_order.arenas import SIDE, Block, SearchArena, ring
from deodar_papers.serial_order.colours import CLUTTERED, away, hue_of
from deodar_papers.serial_order.conditions import CLUTTER
from deodar_papers.serial_order.runs import CHANGED, EVERY, Settings, TaughtRun, prepared, run_many
from deodar_papers.serial_order.teaching import brief_lesson
from deodar_papers.serial_order.world import world

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SOURCE = "Sandamirskaya & Schöner (2010), Neural Networks 23(10)"

SEQUENCE = "RBGBY"
"""The sequence whose transition figure 3 shows."""

ITEM = 2
"""The transition is that from this item to the next one, as in figures 2 and 3."""

RING_LIMIT = 20_000.0
"""Longest production on the ring, ms."""

BEFORE, AFTER = 100.0, 200.0
"""Time that figure 3 shows before the condition of satisfaction is detected, and after it, ms."""

IN_VIEW = (Block("R", (190.0, 80.0)), Block("G", (185.0, -5.0)), Block("B", (200.0, -90.0)))
"""Blocks in front of the vehicle in figure 8; the one in the middle of the row is wanted."""

WANTED = "G"

LOOKED = 120.0
"""Time after which the peak of figure 8 has formed, ms."""

WAIT = 2000.0
"""Longest time for which the peak of figure 8 is waited for, ms."""

DETECTED = 0.5
"""Integral of the output of the condition of satisfaction above which it has a peak."""

SILENT = 0.01
"""Integral below which it is silent; noise exceeds it shortly before the peak forms."""

LEAD = 40.0
"""Least time of the first moment of figure 3 before the condition of satisfaction is detected, ms."""

SLICE = 20.0
"""Interval between two samples of the session of figure 8, ms."""

DEMONSTRATIONS: Mapping[str, float] = {"RGBY": 0.0, "RGGY": 0.0, CLUTTERED: CLUTTER}
"""Sequences of figure 12, and the share of the background that random colours cover while each is taught."""

ALIKE = 9.0
"""Largest distance of the hue of a learned weight from that of its block, samples (18 degrees)."""


def transition(seed: int = 0) -> OrdinalTransition:
    """Teach a sequence, produce it on the ring, and return the transition of figure 3."""
    lesson, taught = brief_lesson(SEQUENCE)
    run = TaughtRun(SEQUENCE, lesson, taught, ring())
    count = len(SEQUENCE) + 1
    paths = {
        kind: [f"item {k}.{kind}.activation" for k in range(1, count + 1)] for kind in ("node", "memory")
    }
    settings = Settings(limit=RING_LIMIT)
    [(trial, begins)] = run_many([run], settings, seed, [*paths["memory"], "satisfied.output"])
    v, t = trial.values, trial.times
    nodes, memories = (np.stack([v[path] for path in paths[kind]], axis=1) for kind in ("node", "memory"))
    satisfied = v["satisfied.output"]
    # the node is active from the start of production on, and then switched off
    active = (nodes[:, ITEM - 1] > 0) & (t > begins + CHANGED)
    off = int(np.flatnonzero(active)[-1]) + 1
    on = off - int(np.argmax(satisfied[off::-1] < DETECTED))
    released = off + int(np.argmax(satisfied[off:] < DETECTED))
    following = released + int(np.argmax(nodes[released:, ITEM] > 0))
    at = {
        f"item {ITEM} is active": int(np.flatnonzero(satisfied[: on - round(LEAD / EVERY)] < SILENT)[-1]),
        "the peak of the CoS inhibits": (on + released) // 2,
        f"item {ITEM + 1} comes next": (released + following) // 2,
    }
    moments = [
        OrdinalMoment(title, float(t[k]), inputs(nodes[k], memories[k], float(satisfied[k])))
        for title, k in at.items()
    ]
    in_window = (t >= t[on] - BEFORE) & (t <= t[on] + AFTER)
    return OrdinalTransition(
        t[in_window],
        nodes[in_window],
        ITEM,
        float(t[on]),
        float(t[released]),
        moments,
        RESTING["node"],
        STRENGTHS["c0 self-excitation"],
        STEEP,
    )


def inputs(nodes: np.ndarray, memories: np.ndarray, satisfied: float) -> list[float]:
    """Return the input of each ordinal node (eq. 4): from other nodes, both memories, and the condition of
    satisfaction.
    """
    active, remembered = (nodes > 0).astype(float), (memories > 0).astype(float)
    before = np.concatenate([[0.0], remembered[:-1]])
    received = (
        STRENGTHS["c1 other nodes"] * (active.sum() - active)
        + STRENGTHS["c2 next"] * before
        + STRENGTHS["c3 own memory"] * remembered
        + OFF * satisfied
    )
    return [float(number) for number in received]


def perception(seed: int = 0) -> ColourPerception:
    """Teach one colour, put three blocks in view, and return what is seen when the colour was found."""
    lesson, taught = brief_lesson(WANTED)
    begins = math.ceil(taught / 800.0) * 800.0
    model = prepared(1, Settings(look_around=False))
    model.set("producing.windows", [Window(begins)])
    arena = SearchArena(SIDE, IN_VIEW, (0.0, 0.0, 0.0))
    session = Session(model, seed=seed, world=world([arena], [lesson], begins))
    session.run(begins + CHANGED)
    waited = 0.0
    while float(session.read("strongest peak.output")) < 0.5 and waited < WAIT:
        session.run(SLICE)
        waited += SLICE
    session.run(LOOKED)
    return ColourPerception(
        session.read("camera.output"),
        session.read("colours.output"),
        session.read("colour space.activation"),
        (-COLUMNS / 2, COLUMNS / 2),
        (0.0, float(HUES)),
        float(session.read("hue of action.output")),
    )


def demonstrations(
    seed: int = 0, done: Callable[[float, bool], None] = lambda *_: None
) -> list[narrative.SearchRun]:
    """Teach and produce the three sequences of figure 12, each in an arena of its own."""
    return [narrative.run(sequence, seed, done, clutter) for sequence, clutter in DEMONSTRATIONS.items()]


def titled(runs: Sequence[narrative.SearchRun]) -> tuple[Sequence[narrative.SearchRun], list[str]]:
    """Return demonstrations with their titles."""
    return runs, [
        f"{r.sequence}, {'taught in clutter' if DEMONSTRATIONS[r.sequence] else 'taught'} and produced in an"
        " arena"
        for r in runs
    ]


@dataclass(frozen=True)
class PaperFigures:
    """What figures 3, 8 and 12 show, from runs of deodar."""

    transition: OrdinalTransition
    perception: ColourPerception
    demonstrations: Sequence[narrative.SearchRun]

    def draw(self) -> dict[str, Figure]:
        """Draw each figure, by the name of the paper's."""
        return {
            "figure-3": transition_figure(self.transition),
            "figure-8": perception_figure(self.perception),
            "figure-12": demonstrations_figure(*titled(self.demonstrations)),
        }


def run(seed: int = 0, done: Callable[[float, bool], None] = lambda *_: None) -> PaperFigures:
    """Make the runs of all three figures.

    Args:
        seed: seed of the arenas and of all noise.
        done: called as by `narrative.run`, by each demonstration of figure 12.
    """
    return PaperFigures(transition(seed), perception(seed), demonstrations(seed, done))


def claims(figures: PaperFigures) -> list[Claim]:
    """Return the claims on what the figures show, computed from their runs."""
    t, p = figures.transition, figures.perception
    stable = [[len(t.attractors(m.inputs[k])) for k in (t.item - 1, t.item)] for m in t.moments]
    # with inhibition by the condition of satisfaction nothing but off is stable; then only on, of the next
    expected = [[2, 2], [1, 1], [2, 1]]
    peak = np.unravel_index(int(p.activation.argmax()), p.activation.shape)
    hue = float(peak[1]) * HUES / p.activation.shape[1]
    above = np.flatnonzero((p.activation > 0).any(axis=0)) * HUES / p.activation.shape[1]
    within = bool(len(above)) and max(away(float(h), hue_of(WANTED)) for h in above) <= ALIKE
    out = [
        Claim(
            f"figure 3: stable states of nodes {t.item} and {t.item + 1} at the three moments",
            stable,
            expected,
            stable == expected,
            source=f"{SOURCE}, figure 3",
            origin="ours",
        ),
        Claim(
            f"figure 8: the colour-space field has a peak at the wanted hue alone ({hue_of(WANTED):g})",
            hue if len(above) else None,
            f"within {ALIKE:g}",
            within,
            source=f"{SOURCE}, figure 8",
            origin="ours",
        ),
    ]
    for r in figures.demonstrations:
        out.append(
            Claim(
                f"figure 12: {r.sequence} is learned and produced: colours found",
                r.produced,
                r.sequence,
                r.produced == r.sequence and r.recalled == r.sequence,
                source=f"{SOURCE}, figure 12",
                origin="ours",
            )
        )
    return out
