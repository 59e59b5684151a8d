"""The regime of a field: its measured instabilities and a description in words."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Unpack

import numpy as np

from deodar.analysis.discretisation import discretisation, obstacle
from deodar.analysis.isolated import Isolated, Isolation, isolate
from deodar.analysis.peaks import Peak, Peaks
from deodar.analysis.ramp import SettledRamp, ramp
from deodar.analysis.selection import Selection, separation
from deodar.analysis.selection import selection as measured_selection
from deodar.analysis.settle import LIMIT
from deodar.analysis.thresholds import SHARES, Boosted, Thresholds, Transition, boosted, thresholds
from deodar.analysis.working_memory import Memory, forgetting, outlives, suppression
from deodar.codec import JsonObject
from deodar.elements.field import Field
from deodar.model.model import Model
from deodar.progress import Tell, telling
from deodar.resources import Resources, use_resources
from deodar.summary import Summarised, Summary

ABOVE = 1.02
"""Input just above detection, relative to the threshold."""
STRONG = 1.2
"""Input that creates peaks in the tests of memory and selection, relative to the detection threshold."""
STEPS = 31

NOT_ASKED = "not asked for"
"""Reason why the discretisation error was not measured, where `finer` was not given."""


@dataclass(frozen=True, repr=False)
class Regimes(Summarised):
    """The response of a field to its input, measured in isolation and without noise.

    Attributes:
        isolated: the field, with the inputs of the measurement.
        thresholds: detection and reverse detection for localised input.
        rest: activation without input.
        above: activation just above detection; None without a detection threshold.
        driven: the peaks just above detection.
        memory: the field after the input of a peak is removed; None if no input creates a peak.
        forgetting: homogeneous input below which no peak outlives its input; None if no peak does, and on a
            node.
        suppression: localised input, switched on at a tenth of its width beside a peak that outlives its
            input, below which the peak vanishes; weaker inputs move it aside. None if no peak outlives its
            input, and on a node.
        selection: result of two inputs; None if no input creates a peak, and on a node.
        separation: smallest distance, as a share of each axis' range, at which two equal inputs both keep a
            peak; None if no distance does.
        boosts: pre-shapes, and the homogeneous boost at which each becomes a peak; empty on a node, where a
            boost is an input.
        ramp: the settled field over a ramp of its input.
        transitions: the thresholds that exist with their intervals: `detection`, `reverse`, `forgetting`,
            `suppression`.
        discretisation: shift of each of these on a grid twice as fine (None: it does not exist there);
            None if it was not measured.
        coarse_alone: reason why it was not measured; empty if it was.
    """

    isolated: Isolated
    thresholds: Thresholds
    rest: np.ndarray
    above: np.ndarray | None
    driven: Peaks | None
    memory: Memory | None
    forgetting: float | None
    suppression: float | None
    selection: Selection | None
    separation: float | None
    boosts: tuple[Boosted, ...]
    ramp: SettledRamp
    transitions: Mapping[str, Transition]
    discretisation: Mapping[str, float | None] | None
    coarse_alone: str

    @property
    def detection(self) -> float | None:
        """The input at which a peak appears."""
        return self.thresholds.detection.value if self.thresholds.detection else None

    @property
    def reverse(self) -> float | None:
        """The input at which the peak vanishes; None if it outlives its input."""
        return self.thresholds.reverse.value if self.thresholds.reverse else None

    @property
    def bistable(self) -> tuple[float, float] | None:
        """The range of inputs at which the field is bistable, with or without a peak; None if it has no such
        range.

        On a field the range begins at 0 or above, as localised inhibition would only move the peak aside.
        """
        up, down = self.thresholds.detection, self.thresholds.reverse
        if up is None or (down is not None and not up.jump):
            return None
        low = down.value if down is not None else (self.ramp.values[0] if not self.isolated.axes else 0.0)
        return (float(low), up.value)

    @property
    def graded(self) -> bool:
        """Whether activation grows through the threshold without a jump, so without a detection
        instability.
        """
        return self.thresholds.detection is not None and not self.thresholds.detection.jump

    @property
    def self_sustained(self) -> bool:
        """Whether a peak outlives its input and does not spread over the field."""
        return self.memory is not None and self.memory.outlives and not self.unbounded

    @property
    def unbounded(self) -> bool:
        """Whether excitation spreads over the whole field once a peak exists."""
        patterns = [
            self.driven,
            self.memory.driven if self.memory else None,
            self.memory.left if self.memory else None,
        ]
        return any(self.isolated.covers(p) for p in patterns if p is not None)

    @property
    def peak(self) -> Peak | None:
        """The peak just above detection."""
        return self.driven[0] if self.driven else None

    @property
    def words(self) -> tuple[str, ...]:
        """The regime in words, the most important first."""
        if self.thresholds.active_at_rest:
            return ("active without input",)
        up = self.thresholds.detection
        if up is None:
            return (f"silent: no input up to {self.thresholds.searched:g} makes a peak",)
        if self.unbounded:
            return ("unbounded: a peak spreads over the whole field",)
        kind = "node" if not self.isolated.axes else "peak"
        if self.self_sustained:
            first = "self-sustained (working memory)"
        elif up.jump:
            first = "input-driven, bistable near detection"
        else:
            first = "input-driven, graded (no detection instability)"
        if self.selection is None:
            return (first,)
        equal, different = len(self.selection.equal), len(self.selection.different)
        if equal == 1 and different == 1:
            return (first, f"selective (two inputs, one {kind})")
        if different == 1:
            return (first, "selective between different inputs, multi-peak for equal ones")
        return (
            first,
            (
                "multi-peak (each input has its peak)"
                if equal >= 2
                else "two inputs merge or suppress each other"
            ),
        )

    def data(self) -> JsonObject:
        """Return all measurements as plain data, for JSON."""
        i, peak = self.isolated, self.peak
        selection = None
        if self.selection is not None:
            s = self.selection
            selection = {
                "peaks_for_equal_inputs": len(s.equal),
                "peaks_for_different_inputs": len(s.different),
            }
            selection |= {"stronger_wins": s.right, "peaks_left_without_input": len(s.left)}
        return {
            "element": i.path,
            "axes": [a.name for a in i.axes],
            "input": {"center": list(i.center), "sigma": list(i.sigma), "kept": list(i.background)},
            "regime": list(self.words),
            "detection_threshold": self.detection,
            "detection_is_instability": self.thresholds.detection.jump if self.thresholds.detection else None,
            "reverse_detection_threshold": self.reverse,
            "bistable_range": list(self.bistable) if self.bistable else None,
            "active_at_rest": self.thresholds.active_at_rest,
            "self_sustained": self.self_sustained,
            "unbounded": self.unbounded,
            "forgetting_boost": self.forgetting,
            "suppressing_input": self.suppression,
            "intervals": {name: list(t.interval) for name, t in self.transitions.items()},
            "discretisation_error": None if self.discretisation is None else dict(self.discretisation),
            "discretisation_not_measured": self.coarse_alone or None,
            "detection_by_boost": [
                {"preshape": b.preshape, "boost": b.boost, "at_the_preshape": b.localised}
                for b in self.boosts
            ],
            "separation": self.separation,
            "selective": self.selection.selects if self.selection is not None else None,
            "selection": selection,
            "peak": (
                {"width": list(peak.width), "amplitude": peak.amplitude, "size": peak.size} if peak else None
            ),
            "peak_without_input": _remembered(self.memory),
            "ramp": {
                "input": self.ramp.values.tolist(),
                "up": self.ramp.up.activation.tolist(),
                "down": self.ramp.down.activation.tolist(),
                "settled": bool(self.ramp.up.settled.all() and self.ramp.down.settled.all()),
            },
        }

    def _summary(self) -> Summary:
        numbers = ("detection", "reverse", "forgetting", "suppression")
        rows = [(n, "none" if (v := getattr(self, n)) is None else f"{v:.4g}") for n in numbers]
        return Summary(f"Regimes of {self.isolated.path}: {'; '.join(self.words)}", rows)


def regimes(
    model: Model | Field,
    path: str = "",
    *,
    accuracy: float = 0.01,
    limit: float = LIMIT,
    finer: bool = False,
    on: Resources = Resources(),
    **isolation: Unpack[Isolation],
) -> Regimes:
    """Measure the instabilities of one field of a model.

    Args:
        model: the model, or a field without a model.
        path: path of the field in the model.
        accuracy: relative accuracy of the thresholds.
        limit: longest settling, in time constants.
        finer: whether to measure the thresholds also on a grid twice as fine, if that grid has at most 20,000
            samples.
        on: its `progress` has the name of the next measurement, `stage`.
        sigma: width of the localised input; none: that of the kernel's excitation.
        center: position of the localised input; none: the sample nearest to the middle.
        precision: float32 or float64.
        dt: Euler step; none: see `isolate`.
        inputs: elements of the model kept as constant inputs.

    Raises:
        UnknownName: if the model has no element at `path`.
        AnalysisError: if the element is not a field.
    """
    with telling(use_resources(on, "dd.regimes", "progress").progress, "regimes") as tell:
        tell(stage="compiling")
        isolated = isolate(model, path, **isolation)
        return _measured(isolated, accuracy, limit, finer, tell)


def _measured(isolated: Isolated, accuracy: float, limit: float, finer: bool, tell: Tell) -> Regimes:
    """Return the regimes of an isolated field."""
    tell(stage="resting state")
    isolated.reset()
    isolated.settle(limit=limit)
    resting = isolated.activation()
    tell(stage="thresholds")
    found = thresholds(isolated, accuracy=accuracy, limit=limit)
    above, driven, memory, forgets, suppressed, selection, apart = None, None, None, None, None, None, None
    boosts: tuple[Boosted, ...] = ()
    lost, pressed = None, None
    up = found.detection
    if up is not None:
        tell(stage="working memory")
        memory = outlives(isolated, STRONG * up.after, limit=limit)
        isolated.restore(up.state)
        isolated.put(input=ABOVE * up.after)
        isolated.settle(limit=limit)
        above, driven = isolated.activation(), isolated.peaks()
        if isolated.axes:
            tell(stage="selection")
            selection = measured_selection(isolated, STRONG * up.after, limit=limit)
            apart = separation(isolated, STRONG * up.after, limit)
            tell(stage="forgetting")
            lost = forgetting(isolated, STRONG * up.after, accuracy, limit)
            pressed = suppression(isolated, STRONG * up.after, accuracy, limit) if memory.outlives else None
            forgets, suppressed = (t.value if t else None for t in (lost, pressed))
            tell(stage="detection by a boost")
            boosts = tuple(boosted(isolated, share * up.before, accuracy, limit) for share in SHARES)
    tell(stage="ramp")
    swept = ramp(isolated, _span(isolated, found), limit=limit)
    named = {"detection": up, "reverse": found.reverse, "forgetting": lost, "suppression": pressed}
    transitions = {name: t for name, t in named.items() if t is not None}
    moved, why = None, obstacle(isolated) if finer else NOT_ASKED
    if transitions and not why:
        tell(stage="a grid twice as fine")
        moved = discretisation(isolated, transitions, STRONG, accuracy, limit)
    return Regimes(
        isolated,
        found,
        resting,
        above,
        driven,
        memory,
        forgets,
        suppressed,
        selection,
        apart,
        boosts,
        swept,
        transitions,
        moved,
        why,
    )


def _span(isolated: Isolated, crossed: Thresholds) -> np.ndarray:
    """Return inputs for a ramp that contains both thresholds."""
    if crossed.detection is None:
        return np.linspace(0.0, 2 * isolated.scale, STEPS)
    high = crossed.detection.value
    low = min(0.0, crossed.reverse.value) if crossed.reverse else 0.0
    low -= 0.15 * (high - low) if low < 0 else 0.0
    top = high + 0.3 * (high - low)
    values = np.linspace(low, top, STEPS)
    marks = [t for f in (crossed.detection, crossed.reverse) if f for t in (f.before, f.after)]
    return np.unique([*values, *marks]) if math.isfinite(top) else values


def _remembered(memory: Memory | None) -> JsonObject | None:
    if memory is None or not memory.left:
        return None
    return {
        "width": list(memory.left[0].width),
        "amplitude": memory.left[0].amplitude,
        "size": memory.left[0].size,
    }
