"""Neurons whose common firing rate follows the output function of a field.

The membrane of a neuron obeys tau_mem dv/dt = -v + I, by Euler steps of length dt; a neuron that is above 1
after a step spikes once and is set to 0. With a constant current I it spikes in every k-th step,

    k = floor(log(1 - 1/I) / log(1 - dt/tau_mem)) + 1        for I > 1,

which for small steps is the rate tau_mem r = 1 / log(I / (I - 1)), close to I - 1/2 from I = 1.5 on.
"""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Sequence

import jax
import numpy as np
from numpy.typing import NDArray

from deodar.numerics.sigmoids import Linear, SemiLinear, SigmoidFunction

Levels = NDArray[np.float64]

REACH = 4.0
"""Largest rate, in spikes per membrane time constant, for which a linear output is fitted and measured."""

FOOT = 3
"""Exponent of the spread of the offsets of a linear output: offsets 1 - 2 x^3 for x from 0 to 1 have the mean
1/2, and make the foot of the mean rate straight to 0.08.
"""

RAMPS = (0.02, 0.05, 0.1, 0.2, 0.4, 0.8)
SHIFTS = np.linspace(0.0, 1.0, 21)
"""Widths of the range in which a neuron goes from silence to a spike in each step, in units of the middle
half of the thresholds, and places of the threshold in that range, among which the best ones are taken.
"""

QUICK = 4
"""tau_mem of the neurons of a bounded output, in steps."""

WIDEST = 1e6
"""Largest activation, in absolute value, that is searched for a threshold."""

POINTS = 801


class NoSpikeCode(ValueError):
    """Raised if no rates of neurons follow an output function; the message is the reason."""


@dc.dataclass(frozen=True)
class SpikeCode:
    """The neurons of one cell: neuron j receives the current `gain * u + offsets[j]`.

    Attributes:
        gain: current for a unit of activation.
        offsets: constant current of each neuron.
        unit: output that corresponds to a spike of every neuron in every step.
        membrane: tau_mem, in s.
        low, high: activation between which the error is measured.
        peak: largest output in this range.
        rms, worst: root of the mean square and largest absolute value of the difference between the output of
            neurons with a constant input and the output function, divided by `peak`.
    """

    gain: float
    offsets: Levels
    unit: float
    membrane: float
    low: float
    high: float
    peak: float
    rms: float
    worst: float

    def output(self, u: Levels, step: float) -> Levels:
        """Return the mean output for constant activation, with steps of length `step`, in s."""
        return self.unit * _mean_rate(self.gain * u, self.offsets, step / self.membrane)

    def __str__(self) -> str:
        return f"error {self.rms:.1%} rms, {self.worst:.1%} at most, of the peak"


def steady_rate(current: Levels, share: float) -> Levels:
    """Return the spikes per step of a neuron with a constant current.

    Args:
        current: I, any shape.
        share: dt / tau_mem, above 0 and below 1.
    """
    above = np.maximum(current, 1 + 1e-12)
    steps = np.floor(np.log1p(-1 / above) / np.log1p(-share)) + 1
    return np.where(current > 1 + 1e-12, 1 / np.maximum(steps, 1), 0.0)


def spike_code(sigmoid: SigmoidFunction, neurons: int, step: float, membrane: float) -> SpikeCode:
    """Return the neurons whose rate follows an output function.

    A semi-linear output is counted in spikes per membrane time constant. A bounded output is the share of
    neurons that are on, each spiking in every step: their thresholds are spread over the sigmoid. Their
    membrane is faster, `QUICK` steps: potentials of neurons that are off are far below 0, and would reach the
    threshold late.

    Args:
        sigmoid: the output function.
        neurons: number of neurons of a cell.
        step: dt, in s.
        membrane: tau_mem of a semi-linear output, in s; above the step.

    Raises:
        NoSpikeCode: it is neither linear above a threshold nor rises from 0 to a largest value.
    """
    if isinstance(sigmoid, (SemiLinear, Linear)):
        if sigmoid.slope <= 0:
            raise NoSpikeCode("its slope is not above 0")
        return _linear(sigmoid.slope, sigmoid.threshold, neurons, step, membrane)
    return _bounded(sigmoid, neurons, step)


def _linear(slope: float, threshold: float, neurons: int, step: float, membrane: float) -> SpikeCode:
    """Return neurons whose mean rate is linear above a threshold."""
    share = step / membrane
    x = (np.arange(neurons) + 0.5) / neurons
    lifts = 1 - x**FOOT * (0.5 / np.mean(x**FOOT))
    high = threshold + REACH / slope
    u = np.linspace(threshold - 1 / slope, high, POINTS)
    expected = np.maximum(0.0, slope * (u - threshold))
    rate = _mean_rate(slope * (u - threshold), lifts, share)
    unit = float(rate @ expected / (rate @ rate))
    offsets = lifts - slope * threshold
    code = SpikeCode(slope, offsets, unit, membrane, float(u[0]), high, REACH, 0.0, 0.0)
    return _measured(code, u, expected, step)


def _bounded(sigmoid: SigmoidFunction, neurons: int, step: float) -> SpikeCode:
    """Return neurons that are on above thresholds, which are spread over a bounded sigmoid."""
    least, most = (float(v) for v in _values(sigmoid, np.array([-WIDEST, WIDEST])))
    if not (np.isfinite(most) and most > 0 and abs(least) <= 1e-3 * most):
        raise NoSpikeCode(f"it goes from {least:g} to {most:g}, and a rate from 0 to a largest value")
    thresholds = _inverse(sigmoid, most * (np.arange(neurons) + 0.5) / neurons)
    spread = float(np.ptp(thresholds))
    middle = float(np.subtract(*np.quantile(thresholds, [0.75, 0.25]))) or spread
    if middle == 0:  # a step
        middle = 0.05 * max(1.0, abs(float(thresholds[0])))
    margin = max(spread / 2, 2 * middle)
    u = np.linspace(thresholds[0] - margin, thresholds[-1] + margin, POINTS)
    expected = _values(sigmoid, u)
    codes: list[SpikeCode] = []
    for width in (w * middle for w in RAMPS):
        gain = (QUICK - 1) / width
        for shift in SHIFTS:
            offsets = 1 - gain * (thresholds - shift * width)
            code = SpikeCode(gain, offsets, most, QUICK * step, float(u[0]), float(u[-1]), most, 0.0, 0.0)
            codes.append(_measured(code, u, expected, step))
    return min(codes, key=lambda c: (c.rms, c.worst))


def _measured(code: SpikeCode, u: Levels, expected: Levels, step: float) -> SpikeCode:
    """Return a code with its errors."""
    difference = np.abs(code.output(u, step) - expected) / code.peak
    return dc.replace(code, rms=float(np.sqrt(np.mean(difference**2))), worst=float(difference.max()))


def _mean_rate(current: Levels, offsets: Sequence[float] | Levels, share: float) -> Levels:
    """Return the mean spikes per step over neurons with offsets."""
    return np.mean([steady_rate(current + o, share) for o in offsets], axis=0)


def _values(sigmoid: SigmoidFunction, u: Levels) -> Levels:
    with jax.enable_x64(True):
        return np.asarray(sigmoid(jax.numpy.asarray(u)), np.float64)


def _inverse(sigmoid: SigmoidFunction, outputs: Levels) -> Levels:
    """Return the activations at which a rising function has given values, by bisection."""
    low, high = np.full_like(outputs, -WIDEST), np.full_like(outputs, WIDEST)
    for _ in range(80):
        middle = (low + high) / 2
        below = _values(sigmoid, middle) < outputs
        low, high = np.where(below, middle, low), np.where(below, high, middle)
    found = (low + high) / 2
    if not (np.diff(found) >= 0).all():
        raise NoSpikeCode("it does not rise everywhere")
    return found
