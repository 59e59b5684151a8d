"""Time constants, windows and delays that do not fit the step."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Iterator
from typing import Any

from deodar.couplings.hebbian import Hebbian
from deodar.couplings.learning import AdaptiveWeights
from deodar.elements.changing_stimuli import MovingGaussian, TimeSeries
from deodar.elements.memories import MemoryTrace
from deodar.errors import Problem
from deodar.leaves import per_axis, step_limits
from deodar.model.resolve import Node
from deodar.model.wiring import Wiring, warning
from deodar.numerics.windows import Window
from deodar.parameters import FrozenArray, parameters

COARSE = 0.4
"""Share of a time constant from which a step is called long: the Euler method then relaxes a quarter too
fast. A step equal to the time constant gets no warning: it copies the input, which is intended.
"""


def check(wiring: Wiring) -> Iterator[Problem]:
    """Check every element, with the step of the document and its own step."""
    for n in wiring.declared:
        step = wiring.doc.step * n.every
        yield from _constants(wiring, n, step)
        yield from _windows(wiring, n, step)
        yield from _learning(n)
        yield from _series(n, step)


def _constants(wiring: Wiring, n: Node, step: float) -> Iterator[Problem]:
    unit, doc = wiring.doc.time_unit, wiring.doc
    for problem in doc.by_id()[n.id].too_long(doc.step, unit):
        stated = "" if doc.dt is not None else f"The document states no dt, so it is {doc.step:g} {unit}. "
        yield dc.replace(problem, fix=f"{stated}{problem.fix}")
    for limit in step_limits(n.element):
        if limit.role == "time constant" and COARSE * limit.value < step < limit.value * (1 - 1e-9):
            sentence = (
                f"the step of {step:g} {unit} is long for {limit.path} = {limit.value:g}: the Euler method is"
                f" inaccurate from {COARSE:g} of it"
            )
            yield warning(n, sentence, f"Write dt={limit.value / n.every / 10:g}, a tenth of {limit.path}")
    for p in parameters(type(n.element)):
        duration: Any = getattr(n.element, p.name)
        if p.role == "duration" and p.name in ("delay", "interval") and duration < step * (1 - 1e-9):
            sentence = (
                f"{p.name} = {duration:g} {unit} is shorter than the step of {step:g}, and counts as one step"
            )
            yield warning(n, sentence, f"Give it in {unit}, or take a smaller step")
    if isinstance(n.element, MemoryTrace) and n.element.tau_build > n.element.tau_decay:
        sentence = (
            f"tau_build = {n.element.tau_build:g} is longer than tau_decay = {n.element.tau_decay:g}: it"
            " forgets faster than it learns"
        )
        yield warning(n, sentence, "Exchange the two")


def _windows(wiring: Wiring, n: Node, step: float) -> Iterator[Problem]:
    windows: Any = getattr(n.element, "windows", None)
    for k, w in enumerate(windows if isinstance(windows, tuple) else ()):
        if not isinstance(w, Window) or w.stop <= w.start:
            continue
        if w.stop <= wiring.doc.t0:
            sentence = f"windows.{k} ends at {w.stop:g}, before the run begins at {wiring.doc.t0:g}"
            yield warning(
                n, sentence, f"Windows are times on the document's clock: begin at {wiring.doc.t0:g} or later"
            )
        elif w.stop - w.start < step * (1 - 1e-9):
            sentence = (
                f"windows.{k} is {w.stop - w.start:g} {wiring.doc.time_unit} long, shorter than the step of"
                f" {step:g}: it may never be on"
            )
            yield warning(
                n, sentence, f"Give start and stop in {wiring.doc.time_unit}, or take a smaller step"
            )


def _learning(n: Node) -> Iterator[Problem]:
    e = n.element
    if not isinstance(e, (Hebbian, AdaptiveWeights)):
        return
    if e.rate == 0 and e.start is None and e.initial == 0:
        sentence = "its rate is 0 and its weights begin at 0: it learns nothing, and gives 0"
        yield warning(n, sentence, "Give it a rate, such as 0.01, or weights: start=...")
    if isinstance(e, Hebbian) and 0 < e.saturation < e.initial and e.start is None:
        sentence = (
            f"its initial weights of {e.initial:g} lie above its saturation {e.saturation:g}: the first"
            " learning step makes them smaller"
        )
        yield warning(n, sentence, f"Write initial={e.saturation:g} or less, or a larger saturation")


def _series(n: Node, step: float) -> Iterator[Problem]:
    e = n.element
    if isinstance(e, TimeSeries) and isinstance(e.times, FrozenArray) and len(e.times.data) > 1:
        first, last = float(e.times.data[0]), float(e.times.data[-1])
        if last - first < step:
            sentence = f"its times from {first:g} to {last:g} all lie inside one step of {step:g}"
            yield warning(n, sentence, "Give times in the document's time unit")
        elif 0 < e.period < last:
            yield warning(
                n,
                f"its period is {e.period:g}, so its moments from there to {last:g} are never reached",
                f"Write period={last:g}, or 0",
            )
    if isinstance(e, MovingGaussian):
        every = zip(e.axes, *(per_axis(v, e.axes) for v in (e.center, e.sigma, e.velocity)), strict=True)
        for axis, center, sigma, velocity in every:
            c, s, v = float(center), float(sigma), float(velocity)
            if abs(v) * step > 2 * s:
                sentence = (
                    f"its velocity of {v:g} carries it {abs(v) * step:g} in one step of {step:g}, further"
                    " than its width: it jumps"
                )
                yield warning(
                    n,
                    sentence,
                    f"Give the velocity in units of the axis {axis.name!r} per unit of the document's time",
                )
            elif (
                e.waypoints is None
                and not axis.periodic
                and ((c > axis.upper + 3 * s and v >= 0) or (c < axis.lower - 3 * s and v <= 0))
            ):
                sentence = (
                    f"begins at {c:g}, outside the axis {axis.name!r} ({axis.lower:g}..{axis.upper:g}); its"
                    f" velocity {v:g} never brings it there"
                )
                yield warning(
                    n,
                    sentence,
                    f"Use a center between {axis.lower:g} and {axis.upper:g}, or another sign of the"
                    " velocity",
                )
