"""Fields, memory traces, and the codes between space and rate."""

from __future__ import annotations

import dataclasses as dc

import numpy as np

from deodar.couplings.axis_weights import AxisWeights
from deodar.couplings.convolve import Convolve
from deodar.couplings.rate_code import RateCode
from deodar.couplings.space_code import SpaceCode
from deodar.element import Element
from deodar.elements.attractor import Attractor
from deodar.elements.field import Field
from deodar.elements.memory_trace import MemoryTrace
from deodar.numerics.axes import Axis
from deodar.numerics.kernels.truncated_gaussian import TruncatedGaussian
from deodar.numerics.sigmoids.absolute import Absolute
from deodar.numerics.sigmoids.linear import Linear
from deodar_interop.importers._piece import Unfit
from deodar_interop.importers.cedar.border import border
from deodar_interop.importers.cedar.composition import Composition, StepSignal
from deodar_interop.importers.cedar.convolution_kernels import kernels, too_long
from deodar_interop.importers.cedar.grid import Counts
from deodar_interop.importers.cedar.piece import InputSlot, OutputSlot, SourceStep, StepPiece, sizes
from deodar_interop.importers.cedar.sigmoids import sigmoid
from deodar_interop.importers.cedar.transfer import special, transferred
from deodar_interop.importers.cedar.values import StepValues
from deodar_interop.importers.cedar.wiring import BUFFER

MOST_DIMENSIONS = 4
LEAST = 1e-9
"""Sum of an input up to which there is no peak: cedar divides by any sum above 0."""

DEFAULT_KERNEL = ("cedar.aux.kernel.Gauss", {"amplitude": "1"})
"""The kernel of a field whose file states none: amplitude 1, width 3."""


def neural_field(b: SourceStep) -> StepPiece:
    """Translate NeuralField, with its kernels and its noise."""
    values = b.values
    dims = sizes(values, 50, MOST_DIMENSIONS)
    axes = b.axes(dims)
    ends = border(values, "lateral kernel convolution", len(dims))
    listed = (
        values.objects("lateral kernels")
        if "lateral kernels" in values.body
        else [(DEFAULT_KERNEL[0], StepValues(DEFAULT_KERNEL[1], values.where))]
    )
    apart = special(values, "sigmoid")
    field = Field(
        b.label,
        axes,
        tau=_tau(b, "time scale", 100.0),
        resting_level=values.number("resting level", -5.0),
        sigmoid=Linear(1.0) if apart else sigmoid(values, "sigmoid", Absolute(100.0, 0.0)),
        kernel=kernels(listed, axes, ends),
        global_inhibition=-values.number("global inhibition", -0.01) + 0.0,
        noise=values.number("input noise gain", 0.1, 0.0),
    )
    if apart == "Logarithm":
        values.say("sigmoid", "approximated", "of 0 and less it is -69 here, undefined in cedar")
    if ends.type == "Cyclic" and not ends.fourier and _unequal(field):
        b.bug("a cyclic convolution in two dimensions mixes up the widths of its two factors at the border")
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
    outlets = {
        "sigmoided activation": OutputSlot(b.label, dims, "output"),
        f"{BUFFER}activation": OutputSlot(b.label, dims, "activation", state=True),
    }
    if shows_activation:
        outlets["activation"] = OutputSlot(b.label, dims, "activation", state=True)
    piece = _with_own_output(b, field, dims) if apart else StepPiece([field], why="Field")
    piece.inlets = {"input": [[InputSlot(b.label)]]}
    piece.outlets = {**outlets, **piece.outlets}
    piece.sums, piece.wanted = frozenset({"input"}), {"input": dims}
    piece.fails = too_long(listed, axes, ends)
    return piece


def _with_own_output(b: SourceStep, field: Field, dims: Counts) -> StepPiece:
    """Return a field whose output, kernels and global inhibition are couplings of its activation."""
    c = Composition(b)
    c.add(dc.replace(field, kernel=[], global_inhibition=0.0))
    activation = StepSignal(b.label, "activation")
    output = transferred(c, "output", "sigmoid", Absolute(100.0, 0.0), activation)
    lateral: list[StepSignal] = []
    if field.kernel and dims:
        lateral.append(c.add(Convolve(field.kernel, name=b.named("lateral interaction")), input=output))
    elif field.kernel:
        factor = sum(float(getattr(kernel, "amplitude", 0.0)) for kernel in field.kernel)
        lateral.append(c.gain("lateral interaction", factor, output))
    if field.global_inhibition:
        all_of = c.projected("total", output, b.axes(dims), (), [None] * len(dims)) if dims else output
        lateral.append(c.gain("global inhibition", -field.global_inhibition, all_of))
    for signal in lateral:
        c.connect(signal, b.label)
    c.outlet("sigmoided activation", output, dims)
    return c.done("Field, with its output function and interaction as couplings")


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


def _tau(b: SourceStep, name: str, default: float) -> float:
    """Return a time constant, at least the step."""
    tau = b.values.time(name, default)
    if tau < b.dt:
        b.values.say(name, "approximated", f"{tau:g} ms is below the step; {b.dt:g} ms is used")
        return b.dt
    return tau


def preshape(b: SourceStep) -> StepPiece:
    """Translate Preshape, cedar's memory trace: it builds up towards its input, weighted by f(input)."""
    values = b.values
    dims = sizes(values, 50, MOST_DIMENSIONS)
    trace = MemoryTrace(
        b.label,
        b.axes(dims),
        tau_build=_tau(b, "time scale build up", 100.0),
        tau_decay=_tau(b, "time scale decay", 1000.0),
        activity=sigmoid(values, "sigmoid", Absolute(1000.0, 0.5)),
        fades=True,
        gated="peak detector" in b.ins,
        start=b.stored("activation", dims),
    )
    inlets = {"input": [[InputSlot(b.label)]]}
    input_sizes = {"input": dims}
    if trace.gated:
        inlets["peak detector"] = [[InputSlot(b.label, "gate")]]
        input_sizes["peak detector"] = ()
    return StepPiece(
        [trace],
        inlets,
        {"activation": OutputSlot(b.label, dims, state=True)},
        wanted=input_sizes,
        needs=("input",),
        why="MemoryTrace",
    )


def space_to_rate(b: SourceStep) -> StepPiece:
    """Translate SpaceToRateCode: a read-out that relaxes to the position of a peak."""
    values = b.values
    dims = b.first("input")
    if len(dims) != 1:
        raise Unfit(f"its input has {len(dims)} dimensions; it reads one")
    axis = b.axes(dims)[0]
    lower, upper = values.number("lowerLimit", 0.0), values.number("upperLimit", 1.0)
    gain = (upper - lower) / max(dims[0] - 1, 1)
    tau = _tau(b, "tau", 100.0)
    cyclic, jumps = values.flag("use cyclic mean", False), values.flag("jump to fixed point", False)
    if values.flag("NaN if no peak", False):
        values.say(
            "NaN if no peak", "approximated", "the last position remains" if not jumps else "0 is given"
        )
    inlets, extra, inner = {"input": [[InputSlot(b.label)]]}, list[Element](), list[tuple[str, ...]]()
    if not cyclic and not jumps:
        element: Element = Attractor(b.label, axis, tau, gain=gain, offset=lower)
        why = "Attractor"
    elif gain == 0:
        raise Unfit("its limits are equal")
    else:
        if cyclic:
            # cedar spreads the samples over a whole turn, whatever the field's own border
            turn = Axis("turn", 0, dims[0], dims[0], periodic=True)
            ring = AxisWeights(np.eye(dims[0]), turn, axis.name, name=b.named("ring"))
            extra, inner = [ring], [(ring.name, b.label)]
            inlets = {"input": [[InputSlot(ring.name)]]}
            axis, gain = turn, (upper - lower) / dims[0]
        if "tau" in values.body:
            values.say("tau", "carried", "without effect: the output jumps to the position")
        # cedar gives the position; deodar's gain is in axis units per unit of the output
        element = RateCode(
            [axis], gain=1 / gain, offset=-lower / gain, least=LEAST, absent=lower, name=b.label
        )
        why = "RateCode"
    return StepPiece(
        [element, *extra],
        inlets,
        {"output": OutputSlot(b.label, (), state=why == "Attractor")},
        inner,
        wanted={"input": dims},
        needs=("input",),
        why=why,
    )


def rate_to_space(b: SourceStep) -> StepPiece:
    """Translate RateToSpaceCode: a Gaussian whose place is the input."""
    values = b.values
    count = max(len(b.first("input")) and b.first("input")[0], 1)
    dims = tuple(int(n) for n in values.numbers("output sizes", 50, count, 1, 1e6))
    lower, upper = values.numbers("lower limits", 0.0, count), values.numbers("upper limits", 1.0, count)
    if any(high == low for low, high in zip(lower, upper, strict=True)):
        raise Unfit("its limits are equal")
    gains = [n / (high - low) for n, low, high in zip(dims, lower, upper, strict=True)]
    offsets = [-low * gain for low, gain in zip(lower, gains, strict=True)]
    axes = b.axes(dims)
    wraps = values.flag("cyclic", False)
    ends = ["periodic" if wraps else "zero"] * count
    axis_ends = ["periodic" if a.periodic else "zero" for a in axes]
    code = SpaceCode(
        axes,
        values.numbers("sigma", 3.0, count, 1e-6),
        values.number("amplitude", 1.0),
        gains,
        offsets,
        boundary=None if ends == axis_ends else ends,
        name=b.label,
    )
    return StepPiece(
        [code],
        {"input": [[InputSlot(b.label)]]},
        {"output": OutputSlot(b.label, dims)},
        wanted={"input": () if count == 1 else (count,)},
        needs=("input",),
        why="SpaceCode",
    )


CLASSES = {
    "cedar.dynamics.NeuralField": neural_field,
    "cedar.dynamics.Preshape": preshape,
    "cedar.dynamics.SpaceToRateCode": space_to_rate,
    "cedar.dynamics.RateToSpaceCode": rate_to_space,
}

DECLARED = frozenset({"cedar.dynamics.NeuralField", "cedar.dynamics.Preshape"})

LOOPED = frozenset(
    {"cedar.dynamics.NeuralField", "cedar.dynamics.Preshape", "cedar.dynamics.SpaceToRateCode"}
)
