"""States that cannot occur, because the strengths of a model do not allow them."""

from __future__ import annotations

import dataclasses as dc
import math
from collections.abc import Iterator
from typing import Any

from deodar.couplings.arithmetic import Threshold
from deodar.couplings.hebbian import Hebbian
from deodar.couplings.positions import PeakPosition, RateCode
from deodar.elements.field import Field
from deodar.elements.memories import MemoryTrace
from deodar.elements.populations import RateNode
from deodar.errors import ConnectionFix, EditFix, Fix, Problem, assign, joined
from deodar.model.checks.resolution import fix_with_cells
from deodar.model.resolve import Node
from deodar.model.wiring import Wiring, warning
from deodar.numerics.axes import cell
from deodar.numerics.sigmoids import Linear, Logistic
from deodar.parameters import parameter
from deodar.proposed_edit import SetValues, rounded

SILENT = 0.25
"""Output below which a field counts as silent (a guess: half of the output at its threshold)."""

CLEAR = 0.15
"""Share of the distance from the resting level to the threshold that is missing; a field that comes nearer
may reach it with a small input (a guess).
"""

AT_REST = 0.2
"""Output at the resting level from which a sigmoid counts as too flat (a guess)."""

WINDOWS = "windows=[(start, stop)]"
"""What a constant input gets: with any other resting level it leaves a field always on, or never."""

UNREACHED = "Make its input stronger"
"""What helps where no level lies below the input."""


def check(wiring: Wiring) -> Iterator[Problem]:
    """Report fields that are never or always on, and thresholds that no signal reaches."""
    for n in wiring.declared:
        e = n.element
        if isinstance(e, (Field, RateNode)) and not isinstance(e.sigmoid, Linear):
            for problem in _field(wiring, n, e):
                fix = fix_with_cells(wiring, e, problem.fix) if isinstance(e, Field) else problem.fix
                yield dc.replace(problem, fix=fix)
        else:
            yield from _waiting(wiring, n)


@dc.dataclass(frozen=True)
class InputLevels:
    """The levels between which the activation of a field lies.

    Attributes:
        rest: the resting level.
        threshold: the threshold of its sigmoid.
        low, high: what its inputs add, at least and at most.
        most: the highest activation.
    """

    rest: float
    threshold: float
    low: float
    high: float
    most: float

    @property
    def spans(self) -> bool:
        """Whether a resting level exists at which the inputs alone decide between on and off."""
        return -math.inf < self.low < self.high < math.inf

    def off(self, level: float) -> bool:
        """Return whether a field at a resting level is off with its weakest input, and on with its
        strongest.
        """
        return level + self.low < self.threshold < level + self.high and level < self.threshold


def _field(wiring: Wiring, n: Node, e: Field | RateNode) -> Iterator[Problem]:
    at = _input_levels(wiring, n, e)
    yield from _never_on(wiring, n, e, at)
    yield from _always_on(wiring, n, e, at)
    if at.rest < at.threshold and isinstance(e.sigmoid, Logistic):
        yield from _flat(n, e.sigmoid, at)
    if isinstance(e, Field):
        yield from _noisy(n, e, at)


def _input_levels(wiring: Wiring, n: Node, e: Field | RateNode) -> InputLevels:
    _, most = wiring.bounds[n.id].get("activation", (-math.inf, math.inf))
    return InputLevels(e.resting_level, getattr(e.sigmoid, "threshold", 0.0), *wiring.arriving(n), most)


def off_at_rest(wiring: Wiring, n: Node, e: Field | RateNode) -> dict[str, float]:
    """Return values with which a field that is on at rest is off; empty where there are none."""
    at = _input_levels(wiring, n, e)
    return _levels(e, at) if at.rest >= at.threshold else {}


def _never_on(wiring: Wiring, n: Node, e: Field | RateNode, at: InputLevels) -> Iterator[Problem]:
    h, threshold = at.rest, at.threshold
    short = at.most < threshold - CLEAR * (threshold - h)
    if not (short and e.sigmoid.bounds((at.most, at.most))[1] < SILENT):
        return
    if not n.reads["input"] and wiring.driven:
        sentence = (
            f"nothing is connected to it, and its resting level {h:g} lies below its threshold {threshold:g}:"
            " it is never active"
        )
        yield warning(n, sentence, ConnectionFix.into(n.path, otherwise="or remove it"))
    elif n.id in wiring.driven and at.high <= 0 and at.low < 0:
        sentence = (
            f"gets only inhibition (at most {at.high:g}), and its resting level {h:g} lies below its"
            f" threshold {threshold:g}: it is never on"
        )
        yield warning(n, sentence, _excite(wiring, n, at))
    elif n.id in wiring.driven:
        sentence = (
            f"never reaches its threshold {threshold:g}: its resting level is {h:g}, its inputs add at most"
            f" {at.high:.3g}, and its own excitation does not help below the threshold; activation stays"
            f" below {at.most:.3g}"
        )
        stronger = f"Make its inputs stronger than {threshold - h:g}"
        raised = f"raise resting_level above {threshold - at.high:.3g}"
        values = _levels(e, at)
        fix = assign("Raise its resting level", values, f"Or m{stronger[1:]}") if values else ""
        if at.low == at.high:
            yield warning(n, sentence, _in_a_window(f"{stronger},"))
        else:
            yield warning(n, sentence, fix or f"{stronger}, or {raised}")


def _excite(wiring: Wiring, n: Node, at: InputLevels) -> str:
    """Return the fix for a field that gets only inhibition: the other sign of its only source.

    A source that is always on would keep the field on then, and one that has other targets may inhibit them
    on purpose, so neither is proposed.
    """
    advice, connect = "Change the sign of what should excite it", "Or connect what does"
    sources = wiring.sources(n)
    targets = [c for m in sources for c in wiring.doc.connections if c.source == m.id]
    if len(sources) == len(targets) == 1 and at.rest - at.high < at.threshold < at.rest - at.low:
        e = sources[0].element
        for name in ("factor", "amplitude"):
            strength: Any = getattr(e, name, None)
            if isinstance(strength, float) and strength < 0:
                return EditFix(advice, [SetValues(((name, -strength),), sources[0].path)], connect)
    if sources and at.low == at.high:
        return _in_a_window(f"{advice}, and let it be on")
    return joined(advice, connect)


def _always_on(wiring: Wiring, n: Node, e: Field | RateNode, at: InputLevels) -> Iterator[Problem]:
    inhibition = wiring.bounds[n.id].get("interaction", (0.0, 0.0))[0]
    if isinstance(e, RateNode):
        inhibition = min(0.0, e.self_excitation)
    least, values = at.rest + at.low + inhibition, _levels(e, at)
    if least > at.threshold + CLEAR and n.reads["input"]:
        sentence = (
            f"is always above its threshold {at.threshold:g}: with its resting level {at.rest:g} and its"
            f" weakest input ({at.low:g}) activation stays at {least:g} or above"
        )
        fix = f"Use a resting_level below {at.threshold - at.low:g}; resting levels are usually negative (-5)"
        if at.low == at.high:
            yield warning(n, sentence, _in_a_window("Let its input be on"))
        else:
            yield warning(n, sentence, assign(_lower(at), values) if values else fix)
    elif at.rest > at.threshold + CLEAR and at.rest + at.low > at.threshold + CLEAR and n.reads["input"]:
        sentence = (
            f"is on without any input: its resting level {at.rest:g} lies above its threshold"
            f" {at.threshold:g}, and only its own inhibition can silence it"
        )
        lower = f"Use a resting_level below {at.threshold:g}"
        yield warning(n, sentence, assign(_lower(at), values) if values else lower)


def _in_a_window(advice: str) -> Fix:
    text = f"{advice} in a window of time"
    return Fix(f"{text}: {WINDOWS}", page=text)


def _lower(at: InputLevels) -> str:
    return "Change the sign" if at.off(-at.rest) else "Lower its resting level"


def _levels(e: Field | RateNode, at: InputLevels) -> dict[str, float]:
    """Return a resting level at which a field is off with its weakest input and on with its strongest.

    A smaller distance than a flat sigmoid resolves needs a steeper one. Empty where there is no such level,
    or no sigmoid that is steep enough for it.
    """
    if not at.spans:
        return {}
    level = -at.rest if at.off(-at.rest) else rounded(at.threshold - (at.low + at.high) / 2)
    values = {"resting_level": level}
    missing = at.threshold - level
    if isinstance(e.sigmoid, Logistic) and e.sigmoid.bounds((level, level))[1] > AT_REST and missing > 0:
        values["sigmoid.beta"] = rounded(4 / missing)
    return values if values.get("sigmoid.beta", 0.0) <= _steepest() else {}


def _steepest() -> float:
    """Return the largest beta of a sigmoid."""
    upper = parameter(Logistic, "beta").upper
    return math.inf if upper is None else upper


def _flat(n: Node, sigmoid: Logistic, at: InputLevels) -> Iterator[Problem]:
    output = sigmoid.bounds((at.rest, at.rest))[1]
    if output > AT_REST:
        sentence = (
            f"gives an output of {output:.2g} at rest: with beta = {sigmoid.beta:g} its sigmoid is too flat"
            f" for a resting level of {at.rest:g}"
        )
        steeper = rounded(4 / (at.threshold - at.rest))
        lower = "Lower its resting_level"
        steepened = assign("Make it steeper", {"sigmoid.beta": steeper}, f"Or l{lower[1:]}")
        yield warning(n, sentence, steepened if steeper <= _steepest() else lower)


def _noisy(n: Node, e: Field, at: InputLevels) -> Iterator[Problem]:
    lengths = e.noise_length if isinstance(e.noise_length, tuple) else (e.noise_length,)
    deviation = e.noise / math.sqrt(2 * e.tau * (1.0 if any(lengths) else cell(tuple(e.axes))))
    missing = at.threshold - at.rest
    if 0 < missing < deviation:
        sentence = (
            "its noise alone brings it above its threshold: activation has a standard deviation of"
            f" {deviation:.2g}, and its resting level lies {missing:g} below the threshold"
        )
        calmer = {"noise": rounded(e.noise * missing / deviation / 4)}
        yield warning(n, sentence, assign("Use less noise", calmer))


def _waiting(wiring: Wiring, n: Node) -> Iterator[Problem]:
    e = n.element
    if not n.reads.get("input"):
        return
    _, most = wiring.arriving(n)
    if (
        isinstance(e, (MemoryTrace, Hebbian))
        and most <= e.threshold
        and not (isinstance(e, MemoryTrace) and e.graded)
    ):
        yield warning(
            n,
            f"learns nothing: its threshold is {e.threshold:g}, and what arrives is at most {most:g}",
            assign("Lower it", {"threshold": rounded(min(0.5, most / 2))}) if most > 0 else UNREACHED,
        )
    if isinstance(e, Threshold) and most <= e.level:
        yield warning(
            n,
            f"its input never exceeds its level {e.level:g}: it is at most {most:g}",
            assign("Lower it", {"level": rounded(most / 2)}) if most > 0 else UNREACHED,
        )
    if isinstance(e, (PeakPosition, RateCode)):
        axes = n.ins["input"] if isinstance(e, PeakPosition) else tuple(e.axes)
        whole = most * math.prod(a.step * a.samples for a in axes)
        if whole < e.least:
            sentence = (
                f"never finds a peak: least is {e.least:g}, and the integral of its input is at most"
                f" {whole:g}"
            )
            yield warning(
                n,
                sentence,
                assign(
                    "Use a value far below the integral of one peak (its width times its height)",
                    {"least": rounded(whole / 100)},
                )
                if whole > 0
                else UNREACHED,
            )
