"""Kernels: convolutions of the first input."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Sequence

from deodar.couplings.convolutions import Convolve, Interaction
from deodar.couplings.projections import Project
from deodar.model.paths import display
from deodar.numerics.kernels._base import Kernel
from deodar.numerics.kernels.separable import Gaussian, Shifted, TruncatedGaussian
from deodar_interop.importers._element import ElementSignal, translates
from deodar_interop.importers._piece import Dims, axes
from deodar_interop.importers.cosivina.classes.stimuli import LETTERS, boundary
from deodar_interop.importers.cosivina.constructors import SUMS, components
from deodar_interop.importers.cosivina.element import SourceElement

WHOLE = 1e6
"""A cutoff beyond the length of any axis."""

ALIKE = 0.1
"""Largest width, as a share of a ring, at which a Gaussian and the sum of its images agree to 1e-6."""

PADDED = 4.0
"""Padding, in widths, from which the wrapping of a transform has no effect."""


@dc.dataclass(frozen=True)
class KernelForm:
    """The common properties of an element's kernels: dimensions, boundaries, whether amplitudes are
    integrals, and the cutoff.
    """

    dims: Dims
    ends: list[str]
    normalized: bool
    cutoff: float

    def gaussian(self, amplitude: float, sigmas: Sequence[float], least: float = 0.0) -> TruncatedGaussian:
        """Return a kernel of this form; widths of dimensions without an axis are ignored."""
        widths = [s for s, a in zip(sigmas, self.dims, strict=True) if a is not None]
        same = widths[0] if widths and len(set(widths)) == 1 else widths or 1.0
        return TruncatedGaussian(
            amplitude + 0.0,
            same,
            self.cutoff,
            least,
            self.normalized,
            boundary=boundary(self.dims, self.ends),
        )


@dc.dataclass(frozen=True)
class TransformForm:
    """The common properties of the kernels of a transform: dimensions, which of them are rings, whether
    amplitudes are integrals, and the padding in widths.
    """

    dims: Dims
    circular: Sequence[bool]
    normalized: bool
    padding: float

    def kernel(self, amplitude: float, sigmas: Sequence[float]) -> Kernel:
        """Return the kernel of an amplitude and of widths, one for each axis."""
        long = axes(self.dims)
        ends = ["periodic" if c else "zero" for c in self.circular][: len(long)]
        if self._sampled(sigmas):
            return KernelForm(long, ends, self.normalized, WHOLE).gaussian(amplitude, sigmas[: len(long)])
        same = sigmas[0] if len(set(sigmas)) == 1 else sigmas
        return Gaussian(amplitude + 0.0, same, self.normalized, boundary=boundary(self.dims, ends))

    def differs(self, amplitude: float, sigmas: Sequence[float]) -> bool:
        """Return whether this kernel is not cosivina's, which is cut by its padding and by the ring."""
        if not amplitude or self._sampled(sigmas):
            return False
        of = zip(sigmas, axes(self.dims), self.circular, strict=False)
        return self.padding < PADDED or max((s / a.samples for s, a, c in of if c), default=0.0) > ALIKE

    def _sampled(self, sigmas: Sequence[float]) -> bool:
        # cosivina samples what the grid does not resolve; Gaussian keeps its integral
        narrow = not self.normalized and min(sigmas, default=1.0) < 1
        return all(self.circular) or not axes(self.dims) or narrow


@translates("GaussKernel1D", "GaussKernel2D", "GaussKernel3D")
def gauss(b: SourceElement) -> ElementSignal:
    """Translate GaussKernel1D, 2D and 3D; the amplitude is on one axis, which gives the same product."""
    form = _form(b)
    mixed = b.element.kind == "GaussKernel3D" and len(form.ends) == 3 and form.ends[0] != form.ends[1]
    if mixed and b.bug("GaussKernel3D reads circularY for its convolution along x"):
        form = dc.replace(form, ends=[form.ends[0], form.ends[0], form.ends[2]])
    kernel = form.gaussian(b.values.number("amplitude", 0), _widths(b, "sigma", form))
    b.piece.passes_noise = True
    return _convolve(b, form, [kernel])


@translates(
    *(f"{family}{count}D" for family in ("MexicanHatKernel", "LateralInteractions") for count in (1, 2, 3)),
    "LateralInteractionsShifted1D",
)
def difference(b: SourceElement) -> ElementSignal | None:
    """Translate MexicanHatKernel and LateralInteractions of one to three dimensions, shifted or not.

    Each is two Gaussians, with or without a constant.
    """
    form = _form(b)
    up, down = b.values.number("amplitudeExc", 0), b.values.number("amplitudeInh", 0)
    wide, wider = _widths(b, "sigmaExc", form), _widths(b, "sigmaInh", form)
    least = 0.0
    if "1D" in b.element.kind:  # one cutoff for both: that of the wider one with an amplitude
        least = form.cutoff * max((up != 0) * max(wide[-1], 0.0), (down != 0) * max(wider[-1], 0.0))
    kernels: list[Kernel] = [form.gaussian(up, wide, least), form.gaussian(-down, wider, least)]
    if b.element.kind == "LateralInteractionsShifted1D":
        shift = b.values.number("shift", 0)
        kernels = [Shifted(dc.replace(k, boundary=None), shift, boundary=k.boundary) for k in kernels]  # type: ignore[type-var]
    if b.element.kind.startswith("MexicanHat"):
        return _convolve(b, form, kernels)
    inhibition = -b.values.number("amplitudeGlobal", 0) + 0.0
    _interact(b, form.dims, Interaction(kernels, inhibition, name=b.label))
    return None


@translates("LateralInteractionsDiscrete")
def discrete(b: SourceElement) -> None:
    """Translate LateralInteractionsDiscrete: self-excitation of every position, and global inhibition."""
    dims = b.sized()
    form = KernelForm(dims, ["periodic" if a.periodic else "zero" for a in axes(dims)], True, 0.0)
    kernel = form.gaussian(b.values.number("amplitudeExc", 0), [1e-6] * len(dims))
    inhibition = -b.values.number("amplitudeGlobal", 0) + 0.0
    _interact(b, dims, Interaction([kernel], inhibition, name=b.label))


@translates("KernelFFT", "KernelInverseFFT")
def kernel_fft(b: SourceElement) -> None:
    """Translate KernelFFT, and its inverse half: kernels over the whole ring, or over an input padded with
    zeros.
    """
    dims = b.sized()
    count = max(len(axes(dims)), 1)
    circular = [True] * count
    if b.element.kind == "KernelFFT":
        circular = [v != 0 for v in b.values.numbers("circular", [1.0] * count, count)]
    normalized = b.values.flag("normalized", True)
    up, down = b.values.number("amplitudeExc", 0), b.values.number("amplitudeInh", 0)
    wide, wider = (
        [max(v, 1e-6) for v in b.values.numbers(name, [1.0] * count, count)]
        for name in ("sigmaExc", "sigmaInh")
    )
    overall = b.values.number("amplitudeGlobal", 0)
    alone = b.element.kind == "KernelInverseFFT" and overall and not up and not down
    if alone and b.bug("KernelInverseFFT drops amplitudeGlobal where both amplitudes are 0"):
        overall = 0.0
    form = TransformForm(dims, circular, normalized, b.values.number("paddingFactor", 5, 0))
    gaussians = ((up, wide), (-down, wider))
    kernels = [form.kernel(amplitude, sigmas) for amplitude, sigmas in gaussians]
    _interact(b, dims, Interaction(kernels, -overall + 0.0, name=b.label))
    if any(form.differs(amplitude, sigmas) for amplitude, sigmas in gaussians):
        why = "Interaction, as if the padding were endless and Gaussians on rings had all their images"
        b.explain(why, "approximated")


@translates("FastFourierTransform")
def fourier(b: SourceElement) -> ElementSignal:
    """Translate FastFourierTransform: only KernelInverseFFT can read its output, so it passes its input."""
    dims = b.sized()
    b.explain("Project, untransformed")
    return b.add(Project(axes(dims), name=b.label), input=b.input(dims))


def add_sums(b: SourceElement, seen: ElementSignal, names: Sequence[str] = SUMS) -> None:
    """Add the sums of its input that an element offers, by the names of the components.

    Sums without a reader cost nothing in a step.
    """
    alone = b.element.kind == "SumAllDimensions"
    for component in names:
        if component not in components(b.element.kind):
            continue
        sum_dims = b.dims(component)
        if component == "fullSum" and not alone:
            b.outlet(component, ElementSignal(b.label, sum_dims, "total"))
            continue
        left_axis = {"horizontalSum": 0, "verticalSum": 1}.get(component)
        places = [sum_dims[1] if d == left_axis else None for d, a in enumerate(seen.dims) if a is not None]
        role = "" if component == "fullSum" else component
        b.outlet(component, b.projected(role, seen, sum_dims, places))


# ----------------------------------------------------------------------------------------------------- inside


def _form(b: SourceElement) -> KernelForm:
    dims = b.sized()
    flags = _flags(b, KernelForm(dims, [], True, 5.0))
    ends = ["periodic" if f else "zero" for f, a in zip(flags, dims, strict=True) if a is not None]
    return KernelForm(
        dims, ends, b.values.flag("normalized", True), b.values.number("cutoffFactor", 5, 0, WHOLE)
    )


def _flags(b: SourceElement, form: KernelForm) -> list[bool]:
    if "1D" in b.element.kind:
        return [b.values.flag("circular", True)] * len(form.dims)
    return [b.values.flag(f"circular{letter}", True) for letter, _ in zip(LETTERS, form.dims, strict=False)]


def _widths(b: SourceElement, name: str, form: KernelForm) -> list[float]:
    if "1D" in b.element.kind:
        return [b.values.width(name)] * len(form.dims)
    return [b.values.width(f"{name}{letter}") for letter, _ in zip(LETTERS, form.dims, strict=False)]


def _convolve(b: SourceElement, form: KernelForm, kernels: Sequence[Kernel]) -> ElementSignal:
    b.piece.elsewhere = _constants(b)
    return b.add(Convolve(kernels, name=b.label), input=b.input(form.dims))


def _interact(b: SourceElement, dims: Dims, element: Interaction) -> None:
    seen = b.input(dims)
    b.outlet("output", b.add(element, input=seen))
    add_sums(b, seen)
    b.piece.elsewhere = _constants(b)


def _constants(b: SourceElement) -> dict[str, str]:
    """Return the components that cosivina computes from parameters alone."""
    out: dict[str, str] = {}
    for component in components(b.element.kind):
        if component.startswith("kernel"):
            out[component] = f"computed from the parameter {display((b.label, 'kernel'))}"
        elif component == "amplitudeGlobal":
            out[component] = (
                f"the parameter {display((b.label, 'global_inhibition'))}, with the opposite sign"
            )
        elif component == "amplitudeExc":
            out[component] = f"the parameter {display((b.label, 'kernel', '0', 'amplitude'))}"
    return out
