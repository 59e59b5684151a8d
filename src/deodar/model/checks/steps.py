"""Time constants, windows and delays that do not fit the step."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Iterator, Mapping
from typing import Any

from deodar.couplings.hebbian import Hebbian
from deodar.couplings.learning import AdaptiveWeights
from deodar.elements.changing_stimuli import MovingGaussian, TimeSeries
from deodar.elements.memories import MemoryTrace
from deodar.errors import EditFix, Problem, assign, joined
from deodar.leaves import StepLimit, per_axis, step_limits, with_entry
from deodar.model.resolve import Node
from deodar.model.wiring import Wiring, warning
from deodar.numerics.windows import Window
from deodar.parameters import FrozenArray, parameters
from deodar.proposed_edit import SetStep, rounded

COARSE = 0.4
"""Share of a time constant from which a step is called long: the Euler method then relaxes a quarter too
fast. A step equal to the time constant gets no warning: it copies the input, which is intended.
"""

SECOND = 1000.0
"""A second in milliseconds."""

MOST_TIMES = 8
"""Largest number of moments that a fix writes out."""


def check(wiring: Wiring) -> Iterator[Problem]:
    """Check every element, with the step of the document and its own step."""
    for n in wiring.declared:
        step = wiring.doc.step * n.every
        yield from _constants(wiring, n, step)
        yield from _windows(wiring, n, step)
        yield from _learning(n)
        yield from _series(wiring, n, step)


def _constants(wiring: Wiring, n: Node, step: float) -> Iterator[Problem]:
    unit, doc = wiring.doc.time_unit, wiring.doc
    entry = doc.by_id()[n.id]
    for limit, problem in zip(entry.exceeded(doc.step), entry.too_long(doc.step, unit), strict=True):
        yield dc.replace(problem, fix=_shorter_step(wiring, n, limit, problem.fix))
    for limit in step_limits(n.element):
        if limit.role == "time constant" and COARSE * limit.value < step < limit.value * (1 - 1e-9):
            sentence = (
                f"the step of {step:g} {unit} is long for {limit.path} = {limit.value:g}: the Euler method is"
                f" inaccurate from {COARSE:g} of it"
            )
            tenth = SetStep(rounded(limit.value / n.every / 10))
            yield warning(n, sentence, EditFix(f"Take a tenth of {limit.path}", [tenth]))
    for p in parameters(type(n.element)):
        duration: Any = getattr(n.element, p.name)
        if p.role == "duration" and p.name in ("delay", "interval") and duration < step * (1 - 1e-9):
            sentence = (
                f"{p.name} = {duration:g} {unit} is shorter than the step of {step:g}, and counts as one step"
            )
            yield warning(n, sentence, _in_unit(wiring, {p.name: duration}))
    if isinstance(n.element, MemoryTrace) and n.element.tau_build > n.element.tau_decay:
        sentence = (
            f"tau_build = {n.element.tau_build:g} is longer than tau_decay = {n.element.tau_decay:g}: it"
            " forgets faster than it learns"
        )
        yield warning(
            n,
            sentence,
            assign(
                "Exchange the two",
                {"tau_build": n.element.tau_decay, "tau_decay": n.element.tau_build},
            ),
        )


def _shorter_step(wiring: Wiring, n: Node, limit: StepLimit, advice: str) -> EditFix:
    """Return the fix for a limit below the step: the limit in milliseconds, or a tenth of it as the step."""
    doc = wiring.doc
    stated = "" if doc.dt is not None else f"The document states no dt, so it is {doc.step:g} {doc.time_unit}"
    in_seconds = doc.time_unit == "ms" and limit.role == "time constant" and limit.value < doc.step
    if doc.dt is None and in_seconds and SECOND * limit.value >= doc.step * n.every:
        begin = joined(stated, f"If {limit.path} is in seconds, give it in ms")
        return assign(begin, {limit.path: rounded(SECOND * limit.value, 12)}, advice)
    tenth = SetStep(rounded(limit.longest / n.every / 10))
    return EditFix(joined(stated, "Take a tenth of it"), [tenth], advice)


def _in_unit(wiring: Wiring, times: Mapping[str, float]) -> str:
    """Return the fix for times that are shorter than a step, probably because they are in seconds."""
    unit = wiring.doc.time_unit
    if unit != "ms":
        return f"Give it in {unit}, or take a smaller step"
    in_ms = {path: rounded(SECOND * time, 12) for path, time in times.items()}
    return assign("If it is in seconds, give it in ms", in_ms, "Or take a smaller step")


def _windows(wiring: Wiring, n: Node, step: float) -> Iterator[Problem]:
    windows: Any = getattr(n.element, "windows", None)
    for k, w in enumerate(windows if isinstance(windows, tuple) else ()):
        if not isinstance(w, Window) or w.stop <= w.start:
            continue
        if w.stop <= wiring.doc.t0:
            sentence = f"windows.{k} ends at {w.stop:g}, before the run begins at {wiring.doc.t0:g}"
            later = wiring.doc.t0 - min(w.start, 0.0)
            moved = {f"windows.{k}.start": w.start + later, f"windows.{k}.stop": w.stop + later}
            yield warning(
                n, sentence, assign("Windows are times on the document's clock. Begin with the run", moved)
            )
        elif w.stop - w.start < step * (1 - 1e-9):
            sentence = (
                f"windows.{k} is {w.stop - w.start:g} {wiring.doc.time_unit} long, shorter than the step of"
                f" {step:g}: it may never be on"
            )
            yield warning(
                n, sentence, _in_unit(wiring, {f"windows.{k}.start": w.start, f"windows.{k}.stop": w.stop})
            )


def _learning(n: Node) -> Iterator[Problem]:
    e = n.element
    if not isinstance(e, (Hebbian, AdaptiveWeights)):
        return
    if e.rate == 0 and e.start is None and e.initial == 0:
        sentence = "its rate is 0 and its weights begin at 0: it learns nothing, and gives 0"
        yield warning(
            n, sentence, assign("Give it a rate", {"rate": 0.01}, "Or give it weights to start with")
        )
    if isinstance(e, Hebbian) and 0 < e.saturation < e.initial and e.start is None:
        sentence = (
            f"its initial weights of {e.initial:g} lie above its saturation {e.saturation:g}: the first"
            " learning step makes them smaller"
        )
        yield warning(
            n, sentence, assign("Begin at the saturation", {"initial": e.saturation}, "Or take a larger one")
        )


def _series(wiring: Wiring, n: Node, step: float) -> Iterator[Problem]:
    e = n.element
    if isinstance(e, TimeSeries) and isinstance(e.times, FrozenArray) and len(e.times.data) > 1:
        first, last = float(e.times.data[0]), float(e.times.data[-1])
        if last - first < step:
            sentence = f"its times from {first:g} to {last:g} all lie inside one step of {step:g}"
            advice = "Give times in the document's time unit"
            in_seconds = wiring.doc.time_unit == "ms" and len(e.times.data) <= MOST_TIMES
            times = tuple(SECOND * float(t) for t in e.times.data)
            yield warning(n, sentence, assign(advice, {"times": times}) if in_seconds else advice)
        elif 0 < e.period < last:
            yield warning(
                n,
                f"its period is {e.period:g}, so its moments from there to {last:g} are never reached",
                assign("End it at the last moment", {"period": last}, "Or write 0: it is not repeated"),
            )
    if isinstance(e, MovingGaussian):
        every = zip(e.axes, *(per_axis(v, e.axes) for v in (e.center, e.sigma, e.velocity)), strict=True)
        for d, (axis, center, sigma, velocity) in enumerate(every):
            c, s, v = float(center), float(sigma), float(velocity)
            if abs(v) * step > 2 * s:
                sentence = (
                    f"its velocity of {v:g} carries it {abs(v) * step:g} in one step of {step:g}, further"
                    " than its width: it jumps"
                )
                slower = with_entry(e.velocity, e.axes, d, v / SECOND)
                advice = (
                    f"Give the velocity in units of the axis {axis.name!r} per {wiring.doc.time_unit}, not"
                    " per second"
                )
                unit_known = wiring.doc.time_unit == "ms"
                yield warning(n, sentence, assign(advice, {"velocity": slower}) if unit_known else advice)
            elif (
                e.waypoints is None
                and not axis.periodic
                and ((c > axis.upper + 3 * s and v >= 0) or (c < axis.lower - 3 * s and v <= 0))
            ):
                sentence = (
                    f"begins at {c:g}, outside the axis {axis.name!r} ({axis.lower:g}..{axis.upper:g}); its"
                    f" velocity {v:g} never brings it there"
                )
                inside = f"Use a center between {axis.lower:g} and {axis.upper:g}"
                back = with_entry(e.velocity, e.axes, d, -v)
                yield warning(
                    n,
                    sentence,
                    assign("Change the sign of the velocity", {"velocity": back}, inside) if v else inside,
                )
