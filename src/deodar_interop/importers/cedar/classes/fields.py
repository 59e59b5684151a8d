"""Fields, memory traces, and the codes between space and rate."""

from __future__ import annotations

import dataclasses as dc

import numpy as np

from deodar.couplings.rate_code import RateCode
from deodar.couplings.space_code import SpaceCode
from deodar.elements.attractor import Attractor
from deodar.elements.field import Field
from deodar.elements.memory_trace import MemoryTrace
from deodar.numerics.axes import Axis
from deodar.numerics.kernels.truncated_gaussian import TruncatedGaussian
from deodar.numerics.sigmoids.absolute import Absolute
from deodar.numerics.sigmoids.linear import Linear
from deodar_interop.importers._piece import Unfit
from deodar_interop.importers.cedar.border import CedarBorder, border
from deodar_interop.importers.cedar.composition import SourceStep, StepSignal, step
from deodar_interop.importers.cedar.convolution_kernels import kernels, too_long
from deodar_interop.importers.cedar.piece import sizes
from deodar_interop.importers.cedar.sigmoids import sigmoid
from deodar_interop.importers.cedar.transfer import special, transferred
from deodar_interop.importers.cedar.values import StepValues
from deodar_interop.importers.cedar.wiring import BUFFER

MOST_DIMENSIONS = 4
LEAST = 1e-9
"""Sum of an input up to which there is no peak: cedar divides by any sum above 0."""

DEFAULT_KERNEL = ("cedar.aux.kernel.Gauss", {"amplitude": "1"})
"""The kernel of a field whose file states none: amplitude 1, width 3."""


@step("cedar.dynamics.NeuralField", sized=True, looped=True)
def neural_field(s: SourceStep) -> None:
    """Translate NeuralField, with its kernels and its noise."""
    values = s.values
    dims = sizes(values, 50, MOST_DIMENSIONS)
    axes = s.axes(dims)
    ends = border(values, "lateral kernel convolution", len(dims))
    listed = (
        values.objects("lateral kernels")
        if "lateral kernels" in values.body
        else [(DEFAULT_KERNEL[0], StepValues(DEFAULT_KERNEL[1], values.where))]
    )
    apart = special(values, "sigmoid")
    field = Field(
        s.label,
        axes,
        tau=_tau(s, "time scale", 100.0),
        resting_level=values.number("resting level", -5.0),
        sigmoid=Linear(1.0) if apart else sigmoid(values, "sigmoid", Absolute(100.0, 0.0)),
        kernel=kernels(listed, axes, ends),
        global_inhibition=-values.number("global inhibition", -0.01) + 0.0,
        noise=values.number("input noise gain", 0.1, 0.0),
    )
    if apart == "Logarithm":
        values.say("sigmoid", "approximated", "of 0 and less it is -69 here, undefined in cedar")
    if ends.type == "Cyclic" and not ends.fourier and _unequal(field):
        s.bug("a cyclic convolution in two dimensions mixes up the widths of its two factors at the border")
    for name in ("multiplicative noise (input)", "multiplicative noise (activation)"):
        if values.flag(name, False):
            values.say(name, "approximated", "the noise here does not depend on input or activation")
    _correlation(values)
    for name in (
        "discrete metric (workaround)",
        "update stepIcon according to output",
        "threshold for updating the stepIcon",
    ):
        if name in values.body:
            values.say(name, "carried", "only a matter of cedar's plots and icons")
    shows_activation = values.flag("activation as output", False)
    field_output = s.add(dc.replace(field, kernel=[], global_inhibition=0.0) if apart else field)
    activation = dc.replace(field_output, port="activation")
    s.outlet("sigmoided activation", _own_output(s, field, activation) if apart else field_output)
    s.outlet(f"{BUFFER}activation", activation, state=True)
    if shows_activation:
        s.outlet("activation", activation, state=True)
    s.connect(s.slot("input", dims, sums=True), field_output)
    s.piece.fails = too_long(listed, axes, ends)


def _own_output(s: SourceStep, field: Field, activation: StepSignal) -> StepSignal:
    """Return the output of a field whose kernels and global inhibition are couplings of its activation."""
    output = transferred(s, "output", "sigmoid", Absolute(100.0, 0.0), activation)
    if field.kernel:
        s.connect(s.convolved("lateral interaction", field.kernel, output), activation)
    if field.global_inhibition:
        total = s.reduced("total", output) if output.dims else output
        s.connect(s.gain("global inhibition", -field.global_inhibition, total), activation)
    s.explain("Field, with its output function and interaction as couplings")
    return output


def _unequal(field: Field) -> bool:
    """Return whether a kernel over two dimensions has two widths."""
    return len(field.axes) == 2 and any(
        isinstance(k, TruncatedGaussian) and isinstance(k.sigma, tuple) and len(set(k.sigma)) > 1
        for k in field.kernel
    )


def _correlation(values: StepValues) -> None:
    """Report the kernel that correlates noise inside cedar's output function."""
    name = "noise correlation kernel"
    if name not in values.body:
        return
    inside = values.inside(name)
    if inside.number("amplitude", 0.0) == 0:
        for key in (*inside.body, ""):
            if key:
                inside.say(key, "carried", "without effect, since its amplitude is 0")
        values.say(name, "carried", "without effect, since its amplitude is 0")
    else:
        for key in inside.body:
            inside.say(key, "dropped", "cedar adds this noise inside the output function")
        values.say(name, "dropped", "cedar adds this noise inside the output function; deodar does not")


def _tau(s: SourceStep, name: str, default: float) -> float:
    """Return a time constant, at least the step."""
    tau = s.values.time(name, default)
    if tau < s.dt:
        s.values.say(name, "approximated", f"{tau:g} ms is below the step; {s.dt:g} ms is used")
        return s.dt
    return tau


@step("cedar.dynamics.Preshape", sized=True, looped=True)
def preshape(s: SourceStep) -> None:
    """Translate Preshape, cedar's memory trace: it builds up towards its input, weighted by f(input)."""
    values = s.values
    dims = sizes(values, 50, MOST_DIMENSIONS)
    peak = s.optional("peak detector", ())
    trace = MemoryTrace(
        s.label,
        s.axes(dims),
        tau_build=_tau(s, "time scale build up", 100.0),
        tau_decay=_tau(s, "time scale decay", 1000.0),
        activity=sigmoid(values, "sigmoid", Absolute(1000.0, 0.5)),
        fades=True,
        gated=peak is not None,
        start=s.stored("activation", dims),
    )
    activation = s.add(trace, input=s.slot("input", dims))
    if peak is not None:
        s.connect(peak, activation, "gate")
    s.outlet("activation", activation, state=True)


@step("cedar.dynamics.SpaceToRateCode", "input", looped=True)
def space_to_rate(s: SourceStep, seen: StepSignal) -> None:
    """Translate SpaceToRateCode: a read-out that relaxes to the position of a peak."""
    values = s.values
    if len(seen.dims) != 1:
        raise Unfit(f"its input has {len(seen.dims)} dimensions; it reads one")
    axis, count = seen.axes[0], seen.dims[0]
    lower, upper = values.number("lowerLimit", 0.0), values.number("upperLimit", 1.0)
    gain = (upper - lower) / max(count - 1, 1)
    tau = _tau(s, "tau", 100.0)
    cyclic, jumps = values.flag("use cyclic mean", False), values.flag("jump to fixed point", False)
    if values.flag("NaN if no peak", False):
        values.say(
            "NaN if no peak", "approximated", "the last position remains" if not jumps else "0 is given"
        )
    if not cyclic and not jumps:
        s.outlet(
            "output",
            s.add(Attractor(s.label, axis, tau, gain=gain, offset=lower), (), input=seen),
            state=True,
        )
        return
    if gain == 0:
        raise Unfit("its limits are equal")
    if cyclic:
        # cedar spreads the samples over a whole turn, whatever the field's own border
        axis = Axis("turn", 0, count, count, periodic=True)
        seen = s.turned("ring", np.eye(count), axis, seen, 0)
        gain = (upper - lower) / count
    if "tau" in values.body:
        values.say("tau", "carried", "without effect: the output jumps to the position")
    # cedar gives the position; deodar's gain is in axis units per unit of the output
    code = RateCode([axis], gain=1 / gain, offset=-lower / gain, least=LEAST, absent=lower, name=s.label)
    s.outlet("output", s.add(code, (), input=seen))


@step("cedar.dynamics.RateToSpaceCode", "input", gives="output")
def rate_to_space(s: SourceStep, seen: StepSignal) -> StepSignal:
    """Translate RateToSpaceCode: a Gaussian whose place is the input."""
    values = s.values
    count = max(seen.dims[0] if seen.dims else 0, 1)
    dims = tuple(int(n) for n in values.numbers("output sizes", 50, count, 1, 1e6))
    lower, upper = values.numbers("lower limits", 0.0, count), values.numbers("upper limits", 1.0, count)
    if any(high == low for low, high in zip(lower, upper, strict=True)):
        raise Unfit("its limits are equal")
    gains = [n / (high - low) for n, low, high in zip(dims, lower, upper, strict=True)]
    offsets = [-low * gain for low, gain in zip(lower, gains, strict=True)]
    axes = s.axes(dims)
    ends = CedarBorder("Cyclic" if values.flag("cyclic", False) else "Zero").ends(axes)
    sigmas, amplitude = values.numbers("sigma", 3.0, count, 1e-6), values.number("amplitude", 1.0)
    s.piece.wanted["input"] = () if count == 1 else (count,)
    return s.add(
        SpaceCode(axes, sigmas, amplitude, gains, offsets, boundary=ends, name=s.label), axes, input=seen
    )
