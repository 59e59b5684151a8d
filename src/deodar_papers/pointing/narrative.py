"""The demonstration: one table, two or more cues in sequence, with everything that figures 8 and 11 show."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from deodar.analysis.claims import Claim
from deodar.architectures.pointing import table as axes_of
from deodar.numerics.axes import Axis
from deodar_papers.pointing.cycle import EVENTS, PointingCycle, clear, control, run_cycle
from deodar_papers.pointing.scenes import HUES, Disc
from deodar_papers.pointing.table import CAMERA, Moment, Table

SCENE = (
    ("green 1", "green", -0.22, 0.40, 0.038),
    ("red 1", "red", -0.14, 0.18, 0.042),
    ("green 2", "green", 0.20, 0.22, 0.040),
    ("red 2", "red", 0.27, 0.45, 0.036),
    ("blue 1", "blue", 0.09, 0.49, 0.040),
)
"""Objects of the demonstration: name, colour, x and y (m), radius (m)."""

ASKED = (("green", "left"), ("red", "right"))
"""Cues of the demonstration, one pair after another."""

FRAME = (Axis("column", 0, 239, 240), Axis("row", 0, 179, 180), Axis("channel", 0, 2, 3))
"""Axes of the pictures of the video."""

SOURCE = "Lomp et al. (2016), Front. Neurorobot. 10:14"

EVERY = 12
"""Steps between two pictures of the video."""


@dataclass
class TableView:
    """A moment to draw.

    Attributes:
        title: what happens.
        picture: picture of the camera, (rows, columns, 3), 0 to 1.
        map: activation of the perceptual field, its maximum along hue, over x and y.
        tool: x and y, m.
    """

    title: str
    picture: np.ndarray
    map: np.ndarray
    tool: tuple[float, float]


@dataclass
class Pointed:
    """The run of the demonstration.

    Attributes:
        asked: the pairs of cues.
        cycles: what happened for each pair.
        starts: time of the first cue of each pair, s.
        quiet: the camera alone, and each first cue alone.
        moments: all observations.
        views: moments to draw.
        frames: pictures of the video, (rows, columns, 3) of bytes.
    """

    asked: Sequence[tuple[str, str]]
    cycles: list[PointingCycle] = field(default_factory=list[PointingCycle])
    starts: list[float] = field(default_factory=list[float])
    quiet: dict[str, PointingCycle] = field(default_factory=dict[str, PointingCycle])
    moments: list[Moment] = field(default_factory=list[Moment])
    views: list[TableView] = field(default_factory=list[TableView])
    frames: list[np.ndarray] = field(default_factory=list[np.ndarray])


def discs() -> list[Disc]:
    """Return the objects of the demonstration."""
    return [Disc(name, colour, x, y, radius, HUES[colour], 0.85, 0.8) for name, colour, x, y, radius in SCENE]


def run(
    asked: Sequence[tuple[str, str]] = ASKED,
    seed: int = 0,
    robot: str | None = None,
    show: Callable[[str, float], None] = lambda words, share: None,
) -> Pointed:
    """Run the demonstration: the camera alone, one cue alone, then each pair of cues."""
    at, result = Table(discs(), seed, robot=robot), Pointed(asked)
    at.watch = lambda now: _watch(at, result, now)
    parts = 2 + len(asked)
    show("the camera alone", 0.0)
    result.quiet["camera alone"] = control(at)
    result.views.append(_view(at, "camera alone"))
    cue = asked[0][0]
    show(f"{cue} alone", 1 / parts)
    result.quiet[f"{cue} alone"] = _one_cue(at, result, cue)
    for k, pair in enumerate(asked):
        show(" ".join(pair), (2 + k) / parts)
        result.starts.append(at.session.time / 1000)
        seen: set[str] = set()

        def look(
            at: Table,
            time: float,
            events: Mapping[str, float],
            pair: tuple[str, str] = pair,
            seen: set[str] = seen,
        ) -> None:
            for event, words in (("detection", "detected"), ("satisfaction", "reached")):
                if event in events and event not in seen and time > events[event] + 0.1:
                    seen.add(event)
                    result.views.append(_view(at, f"{' '.join(pair)}: {words}"))

        done = run_cycle(at, pair, 0.3, hook=look)
        result.cycles.append(done)
        if "rest" not in done.events:
            clear(at)
    return result


def claims(result: Pointed) -> list[Claim]:
    """Return the claims of the demonstration."""
    printed: dict[str, Any] = {"source": f"{SOURCE}, figure 8", "origin": "read off a figure"}
    out = [
        Claim(f"{name}: no peak", done.peaks, 0, done.peaks == 0, **printed)
        for name, done in result.quiet.items()
    ]
    for pair, done in zip(result.asked, result.cycles, strict=True):
        name = " ".join(pair)
        if any((d.colour, d.side) == pair for d in discs()):
            out += _of_a_match(name, pair, done)
        else:
            text = f"{name}: no such object, no peak"
            out.append(Claim(text, done.peaks, 0, done.peaks == 0, **printed))
    return out


def _of_a_match(name: str, pair: tuple[str, str], done: PointingCycle) -> list[Claim]:
    found, events = done.object, [e for e in EVENTS if e in done.events]
    right = found is not None and (found.colour, found.side) == pair
    miss = None if done.miss is None else round(100 * done.miss, 2)
    rim = None if found is None else round(100 * found.radius, 2)
    inside = miss is not None and rim is not None and miss < rim
    eleven: dict[str, Any] = {"source": f"{SOURCE}, figure 11", "origin": "read off a figure"}
    return [
        Claim(f"{name}: the right object", found and found.name, name, right, origin="ours"),
        Claim(f"{name}: the events of figure 11, in order", events, list(EVENTS), done.ordered, **eleven),
        Claim(f"{name}: the tool from the middle, cm", miss, f"< {rim}", inside, origin="ours"),
    ]


def sentence(result: Pointed) -> str:
    """Return the outcome in one line of plain words."""
    parts: list[str] = []
    for pair, done in zip(result.asked, result.cycles, strict=True):
        name = " ".join(pair)
        if done.object is None or done.miss is None:
            parts.append(f"{name}: no peak")
        else:
            reach = done.events["satisfaction"] - done.events["cues"]
            parts.append(
                f"{name}: {done.object.name} at {reach:.1f} s, {100 * done.miss:.1f} cm from its middle"
            )
    return f"{'; '.join(parts)}."


def _one_cue(at: Table, result: Pointed, cue: str) -> PointingCycle:
    """Give one cue alone, draw it while the node is on, and clear it."""
    done = control(at, [cue], clears=False)
    result.views.append(_view(at, f"{cue} alone"))
    clear(at)
    return done


def _view(at: Table, title: str) -> TableView:
    picture = at.world.sense(CAMERA, FRAME, at.session.time)[0]
    return TableView(title, picture.transpose(1, 0, 2), at.activation.max(axis=2), at.world.tool()[:2])


def _watch(at: Table, result: Pointed, now: Moment) -> None:
    result.moments.append(now)
    if len(result.moments) % EVERY == 0:
        picture = at.world.sense(CAMERA, FRAME, at.session.time)[0]
        result.frames.append((255 * picture.transpose(1, 0, 2)).astype(np.uint8))


def distance(result: Pointed) -> list[float]:
    """Return the distance of the tool from the object of the present cycle at each moment, m; NaN before."""
    out: list[float] = []
    for now in result.moments:
        k = sum(now.time / 1000 >= start for start in result.starts) - 1
        aim = result.cycles[k].object if k >= 0 else None
        out.append(math.nan if aim is None else aim.distance(*now.tool))
    return out


def plane() -> tuple[Axis, Axis]:
    """Return the axes of the maps."""
    return axes_of()[:2]
