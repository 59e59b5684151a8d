"""Kernels: convolutions of the first input."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Sequence

from deodar.couplings.convolve import Convolve
from deodar.couplings.interaction import Interaction
from deodar.couplings.project import Project
from deodar.element import Element
from deodar.model.paths import display
from deodar.numerics.kernels._base import Kernel
from deodar.numerics.kernels.gaussian import Gaussian
from deodar.numerics.kernels.shifted import Shifted
from deodar.numerics.kernels.truncated_gaussian import TruncatedGaussian
from deodar_interop.importers._piece import Dims, Inlet, Outlet, Piece, axes, projection
from deodar_interop.importers.cosivina.classes.stimuli import LETTERS, boundary
from deodar_interop.importers.cosivina.components import components
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


def kernel_1d(b: SourceElement) -> Piece:
    """Translate GaussKernel1D."""
    form = _form(b)
    kernel = form.gaussian(b.values.number("amplitude", 0), _widths(b, "sigma", form))
    return dc.replace(_convolve(b, form, [kernel]), passes_noise=True)


def kernel_nd(b: SourceElement) -> Piece:
    """Translate GaussKernel2D and 3D; the amplitude is applied on one axis, which gives the same product."""
    form = _form(b)
    mixed = b.element.kind == "GaussKernel3D" and len(form.ends) == 3 and form.ends[0] != form.ends[1]
    if mixed and b.bug("GaussKernel3D reads circularY for its convolution along x"):
        form = dc.replace(form, ends=[form.ends[0], form.ends[0], form.ends[2]])
    kernel = form.gaussian(b.values.number("amplitude", 0), _widths(b, "sigma", form))
    return dc.replace(_convolve(b, form, [kernel]), passes_noise=True)


def difference(b: SourceElement) -> Piece:
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
    return _interaction(b, form.dims, Interaction(kernels, inhibition, name=b.label))


def discrete(b: SourceElement) -> Piece:
    """Translate LateralInteractionsDiscrete: self-excitation of every position, and global inhibition."""
    b.values.size()
    dims = b.dims()
    form = KernelForm(dims, ["periodic" if a.periodic else "zero" for a in axes(dims)], True, 0.0)
    kernel = form.gaussian(b.values.number("amplitudeExc", 0), [1e-6] * len(dims))
    return _interaction(
        b, dims, Interaction([kernel], -b.values.number("amplitudeGlobal", 0) + 0.0, name=b.label)
    )


def kernel_fft(b: SourceElement) -> Piece:
    """Translate KernelFFT, and its inverse half: kernels over the whole ring, or over an input padded with
    zeros.
    """
    b.values.size()
    dims = b.dims()
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
    piece = _interaction(b, dims, Interaction(kernels, -overall + 0.0, name=b.label))
    if not any(form.differs(amplitude, sigmas) for amplitude, sigmas in gaussians):
        return dc.replace(piece, why="Interaction", verdict="carried")
    why = "Interaction, as if the padding were endless and Gaussians on rings had all their images"
    return dc.replace(piece, why=why, verdict="approximated")


def fourier(b: SourceElement) -> Piece:
    """Translate FastFourierTransform: only KernelInverseFFT can read its output, so it passes its input."""
    b.values.size()
    dims = b.dims()
    return Piece(
        [Project(axes(dims), name=b.label)],
        [[Inlet(b.label, dims)]],
        {"output": Outlet(b.label, dims)},
        needs=1,
        why="Project, untransformed",
    )


def sums(b: SourceElement) -> tuple[list[Element], list[Inlet], dict[str, Outlet]]:
    """Return the sums of its input that an element offers: `horizontalSum`, `verticalSum`, `fullSum`.

    Sums without a reader cost nothing in a step.
    """
    size = b.values.size()
    dims = b.of(size) if b.element.kind == "SumAllDimensions" else b.dims()
    elements, inlets, outlets = list[Element](), list[Inlet](), dict[str, Outlet]()
    for component in ("horizontalSum", "verticalSum", "fullSum"):
        if component not in components(b.element.kind):
            continue
        sum_dims = b.dims(component)
        if component == "fullSum" and b.element.kind != "SumAllDimensions":
            outlets[component] = Outlet(b.label, sum_dims, "total")
            continue
        name = b.label if component == "fullSum" else b.named(component)
        left_axis = {"horizontalSum": 0, "verticalSum": 1}.get(component)
        places = [sum_dims[1] if d == left_axis else None for d, a in enumerate(dims) if a is not None]
        elements.append(projection(name, axes(dims), sum_dims, places))
        inlets.append(Inlet(name, dims, whole=True))
        outlets[component] = Outlet(name, sum_dims)
    return elements, inlets, outlets


# ----------------------------------------------------------------------------------------------------- inside


def _form(b: SourceElement) -> KernelForm:
    b.values.size()
    dims = b.dims()
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


def _convolve(b: SourceElement, form: KernelForm, kernels: Sequence[Kernel]) -> Piece:
    element = Convolve(kernels, name=b.label)
    inlets, outlets = [[Inlet(b.label, form.dims, whole=True)]], {"output": Outlet(b.label, form.dims)}
    return Piece([element], inlets, outlets, elsewhere=_constants(b), needs=1, why="Convolve")


def _interaction(b: SourceElement, dims: Dims, element: Interaction) -> Piece:
    extra, inlets, outlets = sums(b)
    first = {"output": Outlet(b.label, dims)}
    inlets = [[Inlet(b.label, dims, whole=True), *inlets]]
    return Piece(
        [element, *extra], inlets, first | outlets, elsewhere=_constants(b), needs=1, why="Interaction"
    )


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


CLASSES = {
    "GaussKernel1D": kernel_1d,
    "GaussKernel2D": kernel_nd,
    "GaussKernel3D": kernel_nd,
    "MexicanHatKernel1D": difference,
    "MexicanHatKernel2D": difference,
    "MexicanHatKernel3D": difference,
    "LateralInteractions1D": difference,
    "LateralInteractions2D": difference,
    "LateralInteractions3D": difference,
    "LateralInteractionsShifted1D": difference,
    "LateralInteractionsDiscrete": discrete,
    "KernelFFT": kernel_fft,
    "KernelInverseFFT": kernel_fft,
    "FastFourierTransform": fourier,
}
