"""Noise that is white in space, whose effect on a field has no limit on finer grids."""

from __future__ import annotations

import functools
import math
from collections.abc import Iterator

from deodar.couplings.arithmetic import Gain, Product, Sum
from deodar.couplings.delays import Delay, DelayLine
from deodar.element import Element
from deodar.elements.changing_stimuli import Noise
from deodar.elements.field import Field
from deodar.errors import Problem, assign
from deodar.leaves import per_axis
from deodar.model.resolve import reach
from deodar.model.wiring import Wiring, warning
from deodar.proposed_edit import rounded

POINTWISE = (Gain, Sum, Product, Delay, DelayLine)
"""Couplings that pass noise on as it is."""


def check(wiring: Wiring) -> Iterator[Problem]:
    """Check the noise of fields with means over cells, their own and that of sources: their results are meant
    to be those of a fine grid.
    """
    fields = [
        n.id for n in wiring.declared if isinstance(n.element, Field) and n.element.quadrature == "cell"
    ]
    noisy = reach(fields, functools.partial(_before, wiring))
    for n in wiring.declared:
        if n.id in noisy and (values := correlated(n.element)):
            sentence = (
                "its noise is white in space, which has no limit on a grid: with more samples drift and rates"
                " change, whatever the quadrature"
            )
            advice = "Give it a length of one step, and keep its integral"
            yield warning(n, sentence, assign(advice, values))


def _before(wiring: Wiring, ident: str) -> list[str]:
    """Return what a node reads and passes on sample by sample. A convolution or an integral averages the
    noise, and that of another field has an effect of its own.
    """
    n = wiring.nodes[ident]
    if n.declared and not isinstance(n.element, (Field, *POINTWISE)):
        return []
    sources = [source for slots in n.reads.values() for source, _, _ in slots]
    return [source for source in sources if not isinstance(wiring.nodes[source].element, Field)]


def correlated(element: Element) -> dict[str, float | tuple[float, ...]]:
    """Return a correlation length of one step for noise that is white in space, and the strength with which
    its integral over the axes stays the same; empty for an element without such noise.

    The correlation exp(-d^2 / (2 length^2)) has the integral length sqrt(2 pi) along each axis, and white
    noise of strength q has the integral q^2.
    """
    if isinstance(element, Field):
        (strength, length), q, lengths = ("noise", "noise_length"), element.noise, element.noise_length
    elif isinstance(element, Noise):
        (strength, length), q, lengths = ("amplitude", "length"), element.amplitude, element.length
    else:
        return {}
    axes = tuple(element.axes)
    if q <= 0 or not any(a.samples > 1 for a in axes) or any(map(float, per_axis(lengths, axes))):
        return {}
    steps = tuple(rounded(a.step) for a in axes)
    at_a_point = q / math.sqrt(math.prod(math.sqrt(2 * math.pi) * s for s in steps))
    return {length: steps[0] if len(set(steps)) == 1 else steps, strength: rounded(at_a_point)}
