"""Kernels: of couplings, and of fields, whose interaction is an element of its own in cosivina."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Sequence
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from deodar.couplings.convolutions import Convolve, Interaction, Shift
from deodar.elements.field import Field
from deodar.elements.stimuli import Pattern
from deodar.leaves import per_axis
from deodar.model.document import Entry
from deodar.numerics import interaction
from deodar.numerics.axes import Axes, cell
from deodar.numerics.kernels._base import Kernel
from deodar.numerics.kernels.separable import NARROWEST, Gaussian, Shifted, TruncatedGaussian
from deodar.parameters import FrozenArray
from deodar_interop.exporters.cosivina.classes.gaussians import Bell, bells
from deodar_interop.exporters.cosivina.classes.stimuli import kernel_values
from deodar_interop.exporters.cosivina.draft import FilePart, Given, Unwritable
from deodar_interop.exporters.cosivina.layout import circular, is_row, layout, widths
from deodar_interop.importers._piece import Dims

MOST_DIMENSIONS = 3
"""Number of dimensions up to which cosivina has kernels."""


def convolve(b: Given, element: Convolve) -> None:
    """Write GaussKernel or MexicanHatKernel, or what else has the kernel."""
    moved = _as_shift(b, element.kernel)
    if moved is None:
        parts = _parts(b, b.axes(), element.kernel, 0.0, KernelWish())
    else:
        parts = [b.sized("ShiftInput", moved)]
        if moved["amplitude"] != 1:
            b.approximate("cosivina does not apply the amplitude of a ShiftInput")
    for p in parts:
        b.take(p)
    b.show(_joined(b, parts))


def interact(b: Given, element: Interaction) -> None:
    """Write LateralInteractions, KernelFFT or KernelInverseFFT, or what else has the kernels."""
    axes = b.axes()
    sides = [e for c in ("horizontalSum", "verticalSum") for e in b.draft.followers(b.id, c)]
    part = (None if sides else _transformed(b, element)) or _discrete(b, element)
    parts = (
        [part]
        if part
        else _parts(
            b, axes, element.kernel, element.global_inhibition, KernelWish(sums=True, plane=len(sides) == 2)
        )
    )
    part = _joined(b, parts)
    for p in parts:
        b.take(p)
    b.show(part)
    lateral = parts[0] if "Lateral" in parts[0].kind else None
    if lateral is not None and lateral.kind == "LateralInteractions2D" and len(sides) == 2:
        b.claim(sides)
        for component, e in zip(("horizontalSum", "verticalSum"), sides, strict=True):
            b.show(lateral, "output", component, of=e.id)
    if not b.draft.readers(b.id, "total"):
        return
    if lateral is not None and cell(axes) == 1:
        b.show(lateral, "total", "fullSum", dims=(None, None))
        return
    dims = b.dims()
    total = b.part(
        "SumDimension",
        {"sumDimensions": list(range(1, len(dims) + 1)), "size": [1, 1], "amplitude": cell(axes)},
        label=f"{b.label} total",
    )
    b.take(total)
    b.show(total, "total", dims=(None, None))


def field_kernels(b: Given, element: Field, part: FilePart) -> None:
    """Write the interaction of a field with itself."""
    if not element.kernel and not element.global_inhibition:
        return
    axes = tuple(element.axes)
    label, made = f"{b.label} -> {b.label}", len(b.made)
    try:
        parts = _parts(b, axes, element.kernel, element.global_inhibition, KernelWish(label, beside=-1))
    except Unwritable as error:
        del b.made[made:]
        _lost(b, str(error))
        return
    for p in parts:
        b.inner(p, part, after=True)
        b.inner(part, p)
    if b.draft.readers(b.id, "interaction"):
        if len(parts) == 1:
            b.show(parts[0], "interaction")
            b.draft.outlets[b.id, "interaction"] = dc.replace(
                b.draft.outlets[b.id, "interaction"], state=False
            )
        else:
            b.approximate("its interaction consists of several elements, and what reads it is not connected")


def shift(b: Given, element: Shift) -> None:
    """Write ShiftInput for whole samples."""
    axes, dims = b.axes(), b.dims()
    amounts = [v / a.step for a, v in zip(axes, per_axis(element.amount, axes), strict=True)]
    rings = {a.periodic for a in axes}
    if len(dims) > 2 or len(rings) > 1 or any(abs(v - round(v)) > 1e-9 for v in amounts):
        raise Unwritable("cosivina shifts rows and planes, by whole samples, on a ring or a line")
    b.carry(b.sized("ShiftInput", _shift_values(dims, axes, amounts, True in rings, 0.0, 1.0)))


def shift_input(b: Given, moved: Entry, border: Entry) -> None:
    """Write ShiftInput with a value that fills the border."""
    element, filled = moved.element, border.element
    assert isinstance(element, Convolve) and isinstance(filled, Pattern)
    assert isinstance(filled.values, FrozenArray)
    values = _as_shift(b, element.kernel)
    fill = filled.values.data
    if values is None or not fill.any():
        raise Unwritable("cosivina fills the border of a shift with one value")
    b.claim([moved, border])
    part = b.sized("ShiftInput", values | {"fillValue": float(fill[fill != 0][0])})
    b.take(part, of=moved.id)
    b.show(part)


# ----------------------------------------------------------------------------------------------------- inside


def _as_shift(b: Given, kernels: Sequence[Kernel]) -> dict[str, Any] | None:
    """Return the parameters of ShiftInput if the kernels are a single sample, shifted by whole samples."""
    if len(kernels) != 1 or not isinstance(kernels[0], Shifted):
        return None
    outer, inner = kernels[0], kernels[0].kernel
    axes, dims = b.axes(), b.dims()
    if not isinstance(inner, TruncatedGaussian) or inner.cutoff or not inner.normalized or len(dims) != 2:
        return None
    amounts = [v / a.step for a, v in zip(axes, per_axis(outer.shift, axes), strict=True)]
    rings = circular(axes, outer.boundary)
    if any(not v.is_integer() for v in amounts) or len(set(rings)) > 1:
        return None
    return _shift_values(dims, axes, amounts, True in rings, 0.0, inner.amplitude)


def _shift_values(
    dims: Dims, axes: Axes, amounts: Sequence[float], ring: bool, fill: float, amplitude: float
) -> dict[str, Any]:
    by = {a.name: v for a, v in zip(axes, amounts, strict=True)}
    return {
        "shiftValue": [0 if a is None else by[a.name] for a in dims],
        "amplitude": amplitude,
        "circular": ring,
        "fillValue": fill,
    }


def _lost(b: Given, why: str) -> None:
    """Report kernels of a field that are not written."""
    b.say("kernel", "dropped", why)
    b.approximate(f"a kernel of it is not written: {why}")


@dc.dataclass(frozen=True)
class KernelWish:
    """How the elements of several kernels are written.

    Attributes:
        label: label of each, with a number; "": the first one has that of the entry.
        sums: whether the first one must have the sum of its input as a component.
        plane: whether a row has the class of a plane.
        beside: preferred position beside the entry.
    """

    label: str = ""
    sums: bool = False
    plane: bool = False
    beside: int = 0


def _parts(
    b: Given, axes: Axes, kernels: Sequence[Kernel], inhibition: float, wish: KernelWish
) -> list[FilePart]:
    """Add the elements of a sum of kernels and of global inhibition; their outputs add up."""
    dims = layout(axes)

    def name(k: int) -> str:
        return wish.label or (f"{b.label} part" if k else "")

    if not axes and wish.label:  # on a node kernels are self-excitation
        strength = sum(float(t.amplitude) for k in kernels for t in k.terms()) - inhibition
        return [b.sized("ScaleInput", {"amplitude": strength}, dims, label=wish.label, beside=wish.beside)]
    parts: list[FilePart] = []
    found = bells(b, axes, dims, kernels)
    pairs = _pairs(found.bells)
    if (inhibition or wish.sums) and not pairs:
        pairs = [(Bell.nothing(axes, found.normalized), Bell.nothing(axes, found.normalized))]
    for k, (up, down) in enumerate(pairs):
        lateral = k == 0 and (inhibition or wish.sums)
        overall = -inhibition * cell(axes) if lateral else None
        kind, values = _difference(dims, axes, up, down, overall, wish.plane)
        parts.append(b.sized(kind, values, dims, label=name(len(parts)), beside=wish.beside))
    if found.others:
        try:
            parts.append(_matrix(b, axes, dims, found.others, name(len(parts)), wish.beside))
        except Unwritable as error:
            if not wish.label:
                raise
            _lost(b, str(error))
    if not parts and not wish.label:
        raise Unwritable("it has no kernel")
    return parts


def _pairs(found: Sequence[Bell]) -> list[tuple[Bell, Bell | None]]:
    """Return excitation with inhibition of the same form, as many elements as it takes.

    Two Gaussians of an imported file keep their order, whatever their signs are.
    """
    forms: dict[tuple[object, ...], list[Bell]] = {}
    for bell in found:
        forms.setdefault(bell.form, []).append(bell)
    out: list[tuple[Bell, Bell | None]] = []
    for same in forms.values():
        if len(same) == 2 and same[0].paired and same[1].paired:
            out.append((same[0], same[1]))
            continue
        up, down = ([v for v in same if (v.amplitude < 0) == below] for below in (False, True))
        longer = max(len(up), len(down))
        pairs = [(up[k : k + 1], down[k : k + 1]) for k in range(longer)]
        out += [(a[0], d[0] if d else None) if a else (d[0], None) for a, d in pairs]
    return out


def _difference(
    dims: Dims, axes: Axes, up: Bell, down: Bell | None, overall: float | None, plane: bool
) -> tuple[str, dict[str, Any]]:
    """Return class and parameters of one Gaussian, or of two, with a constant or without."""
    row = is_row(dims) and not plane and (down is None or up.common(down))
    rank = 1 if row else len(dims)
    if rank > (1 if up.shift is not None else MOST_DIMENSIONS):
        raise Unwritable(f"cosivina has no such kernels over {rank} dimensions")
    rings = {a.name: ring for a, ring in zip(axes, up.rings, strict=True)}
    shared = {"normalized": up.normalized, "cutoffFactor": up.cutoff}
    if down is None and overall is None and up.shift is None:
        values = _widths(dims, axes, up, rings, "", rank)
        return f"GaussKernel{rank}D", {**values, "amplitude": up.amplitude, **shared}
    if down is None:
        down = dc.replace(up, amplitude=0.0)
    values = {
        **_widths(dims, axes, up, rings, "Exc", rank),
        **_widths(dims, axes, down, rings, "Inh", rank),
        "amplitudeExc": up.amplitude,
        "amplitudeInh": -down.amplitude,
        **shared,
    }
    if up.shift is not None:
        return "LateralInteractionsShifted1D", {
            **values,
            "amplitudeGlobal": overall or 0.0,
            "shift": up.shift,
        }
    if overall is None:
        return f"MexicanHatKernel{rank}D", values
    return f"LateralInteractions{rank}D", {**values, "amplitudeGlobal": overall}


def _widths(
    dims: Dims, axes: Axes, bell: Bell, rings: dict[str, bool], part: str, rank: int
) -> dict[str, Any]:
    by = {a.name: s for a, s in zip(axes, bell.sigmas, strict=True)}
    if rank > 1 and is_row(dims):  # a row in a class of two dimensions
        axis = dims[-1]
        return {
            f"sigma{part}Y": 1,
            f"sigma{part}X": 1 if axis is None else by[axis.name],
            "circularY": True,
            "circularX": True if axis is None else rings[axis.name],
        }
    return kernel_values(dims, by, rings, part)


def _matrix(b: Given, axes: Axes, dims: Dims, kernels: Sequence[Kernel], label: str, beside: int) -> FilePart:
    """Add a matrix of the weights between all samples of a row, for kernels that cosivina does not have."""
    names = ", ".join(sorted({type(k).__name__ for k in kernels}))
    if not is_row(dims) or len(axes) != 1:
        raise Unwritable(f"cosivina has no {names} over {len(axes)} dimensions; it has Gaussians")
    with jax.enable_x64(True):
        weights = interaction.mix(kernels, axes, interaction.prepare(kernels, axes, "float64"))
        count = axes[0].samples
        columns = [np.asarray(interaction.apply(weights, axes, jnp.asarray(one))) for one in np.eye(count)]
    b.reasons.append(f"a matrix holds the weights of {names}")
    values = {"size": [count, count], "weights": np.stack(columns).tolist()}
    return b.part("WeightMatrix", values, label=label, beside=beside)


def _joined(b: Given, parts: list[FilePart]) -> FilePart:
    """Return the part that readers read: the only one, or a sum of all."""
    if len(parts) == 1:
        return parts[0]
    parts[0].label, inside = b.draft.names.new(f"{b.label} part"), parts[0].label
    total = b.sized("SumInputs", {}, sums=True)
    total.label = inside
    for p in parts:
        b.inner(total, p)
    return total


def _transformed(b: Given, element: Interaction) -> FilePart | None:
    """Add KernelFFT or its inverse half, if the kernels are those that it has."""
    axes = b.axes()
    if not b.draft.endless(element, axes):
        return None
    up, down = element.kernel
    assert isinstance(up, (Gaussian, TruncatedGaussian)) and isinstance(down, (Gaussian, TruncatedGaussian))
    rings = circular(axes, up.boundary)
    wide, wider = ([[max(v, NARROWEST)] for v in widths(axes, k.sigma)] or 1 for k in (up, down))
    values = {
        "sigmaExc": wide,
        "amplitudeExc": up.amplitude,
        "sigmaInh": wider,
        "amplitudeInh": -down.amplitude,
        "amplitudeGlobal": -element.global_inhibition,
        "normalized": up.normalized,
    }
    source = b.draft.wires.into.get((b.id, "input"), [])
    if len(source) == 1 and b.draft.passes_on(source[0].source):
        return b.sized("KernelInverseFFT", values)
    return b.sized("KernelFFT", {**values, "circular": [[v] for v in rings] or 1, "paddingFactor": 5})


def _discrete(b: Given, element: Interaction) -> FilePart | None:
    """Add LateralInteractionsDiscrete, if the kernel is a single sample."""
    kernels = element.kernel
    if len(kernels) != 1 or not isinstance(kernels[0], TruncatedGaussian):
        return None
    kernel, axes = kernels[0], b.axes()
    if kernel.cutoff or kernel.least or not kernel.normalized or kernel.boundary is not None:
        return None
    return b.sized(
        "LateralInteractionsDiscrete",
        {
            "amplitudeExc": kernel.amplitude,
            "amplitudeGlobal": -element.global_inhibition * cell(axes),
        },
    )


KINDS = {Convolve: convolve, Interaction: interact, Shift: shift}
