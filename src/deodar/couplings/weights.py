"""Couplings by stated weights."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

import jax.numpy as jnp
import numpy as np
import numpy.typing as npt

from deodar.declarations import needed
from deodar.element import Arrays, Coupling, PortAxes, PortBounds, PortUnits, Setting
from deodar.numerics import starting
from deodar.numerics.axes import Axes, Axis, cell, shape, wrong_shape
from deodar.numerics.convolution import along
from deodar.numerics.intervals import times, total
from deodar.numerics.positions import PositionUnit, PositionUnits
from deodar.numerics.signs import Sign
from deodar.parameters import ArrayLike, FrozenArray, Live, Rebuild
from deodar.registry import register


@register
@dataclass(frozen=True)
class Weights(Coupling):
    r"""Fixed weights between all samples of a source and all samples of a target: any linear map.

    The integral is the sum times the source's grid step.

    Equation:
        y(x) = \int W(x, x')\, \mathrm{input}(x')\, dx'

    Parameters:
        weights: W, target samples first, then source samples; per unit of the source's axes.
        axes: axes of the output; none: one number.

    Ports:
        input: any axes.
        output: over `axes`.

    Shapes:
        weights: samples of `axes`, then samples of the input's axes.

    Reference:
        Sandamirskaya (2014), Front. Neurosci. 7:276, eq. 7.
    """

    weights: Annotated[ArrayLike, Rebuild()] = FrozenArray(np.eye(21))
    axes: Sequence[Axis] = needed("[x]")

    linear: ClassVar[bool] = True
    maps: ClassVar[Mapping[str, tuple[str, ...]]] = {"weights": ("output", "input")}
    signed_by: ClassVar[tuple[str, ...]] = ("weights",)

    @classmethod
    def starting_values(cls, axes: Axes, arriving: Axes | None = None) -> Mapping[str, Any]:
        weights = starting.map_of_places(axes, axes if arriving is None else arriving)
        return {} if weights is None else {"weights": FrozenArray(weights)}

    def validate_axes(self, ins: PortAxes) -> Iterator[tuple[str, str]]:
        needed = shape(self.axes) + shape(ins["input"])
        yield from wrong_shape("weights", self.weights, needed, "target and source have")

    def warnings(self, ins: PortAxes) -> Iterator[tuple[str, str]]:
        if isinstance(self.weights, FrozenArray) and not self.weights.data.any():
            yield (
                "its weights are all zero, so nothing passes",
                "Give it the weights of the map, or remove it",
            )

    def bounds(self, ins: PortAxes, inputs: PortBounds, before: PortBounds) -> PortBounds:
        if not isinstance(self.weights, FrozenArray):
            return {}
        rows = self.weights.data.reshape(math.prod(shape(self.axes)), -1) * cell(ins["input"])
        up, down = float(np.maximum(rows, 0).sum(axis=1).max()), float(np.minimum(rows, 0).sum(axis=1).min())
        return {"output": total(times((0.0, up), inputs["input"]), times((down, 0.0), inputs["input"]))}

    def position_units(self, ins: PortAxes, inputs: PortUnits) -> PortUnits:
        arriving = inputs["input"]
        if not arriving or not isinstance(self.weights, FrozenArray):
            return {}
        rows = self.weights.data.reshape(-1, len(arriving)) * cell(ins["input"])
        return {"output": tuple(_weighted(row.tolist(), arriving) for row in rows)}

    def prepare(self, at: Setting) -> Arrays:
        return {"weights": at.array(self.weights) * cell(at.ins["input"])}

    def output(self, at: Setting) -> Arrays:
        x = at.inputs["input"]
        return {"output": jnp.tensordot(at.constants["weights"], x, axes=x.ndim, precision="highest")}

    @classmethod
    def example(cls) -> Weights:
        return cls(np.eye(21), [Axis("x", 0, 20, samples=21)], name="example")


def _weighted(row: Sequence[float], arriving: PositionUnits) -> PositionUnit | None:
    """Return the unit of a weighted sum of positions; None if its terms have no common one."""
    used = [p and p.scaled(weight) for weight, p in zip(row, arriving, strict=True) if weight != 0]
    first = used[0] if used else None
    if first is None or any(p is None or not p.fits(first) for p in used):
        return None
    return first if len(used) == 1 else first.unbounded()


@register
@dataclass(frozen=True)
class AxisWeights(Coupling):
    r"""Fixed weights between the samples of one axis of the input and a new axis, the same everywhere else.

    It resamples, crops, pads, mirrors or permutes an array along one axis; one after another, several of them
    do so along several axes. `Weights` has weights between all samples.

    Equation:
        y(x, z) = \sum_{x'} W(x, x')\, \mathrm{input}(x', z)

    Parameters:
        weights: W, samples of the new axis first.
        axis: the new axis, x.
        along: name of the axis of the input that it takes the place of; empty: the axis of the same name.

    Ports:
        input: any axes, one of them `along`.
        output: the axes of the input, with `axis` in the place of the one that is summed.

    Shapes:
        weights: samples of `axis`, then samples of the axis `along` of the input.

    Reference:
        no reference
    """

    weights: Annotated[ArrayLike, Rebuild()] = FrozenArray(np.eye(21))
    axis: Axis = needed("x")
    along: str = ""

    linear: ClassVar[bool] = True
    signed_by: ClassVar[tuple[str, ...]] = ("weights",)

    def outputs(self, ins: PortAxes) -> PortAxes:
        return {"output": tuple(self.axis if a.name == self._name else a for a in ins["input"])}

    def validate_axes(self, ins: PortAxes) -> Iterator[str | tuple[str, str]]:
        found = next((a for a in ins["input"] if a.name == self._name), None)
        if found is None:
            given = ", ".join(repr(a.name) for a in ins["input"]) or "none"
            yield (
                f"acts along the axis {self._name!r}, which the input does not have; it has {given}",
                "Name one of these in 'along'",
            )
            return
        if self.axis.name != self._name and any(a.name == self.axis.name for a in ins["input"]):
            yield f"gives an axis {self.axis.name!r}, which the input has already"
        yield from wrong_shape(
            "weights", self.weights, (self.axis.samples, found.samples), "the new axis and the old one have"
        )

    def bounds(self, ins: PortAxes, inputs: PortBounds, before: PortBounds) -> PortBounds:
        if not isinstance(self.weights, FrozenArray):
            return {}
        w, x = self.weights.data, inputs["input"]
        up, down = float(np.maximum(w, 0).sum(axis=1).max()), float(np.minimum(w, 0).sum(axis=1).min())
        return {"output": total(times((0.0, up), x), times((down, 0.0), x))}

    def prepare(self, at: Setting) -> Arrays:
        return {"weights": at.array(self.weights)}

    def output(self, at: Setting) -> Arrays:
        d = next(k for k, a in enumerate(at.ins["input"]) if a.name == self._name)
        return {"output": along(at.constants["weights"], at.inputs["input"], d)}

    @property
    def _name(self) -> str:
        return self.along or self.axis.name

    @classmethod
    def example(cls) -> AxisWeights:
        return cls(np.eye(21), Axis("x", 0, 20, samples=21), name="example")


@register
@dataclass(frozen=True)
class Weighting(Coupling):
    r"""A coupling strength that depends on position, such as a ramp or a mask.

    Equation:
        y(x) = c(x) \cdot \mathrm{input}(x)

    Parameters:
        weights: c, one value for each sample of the axes; `Weighting.of(function, axes)` samples a function.
        axes: axes of the weights; the input expands to them.

    Ports:
        input: over `axes`; missing axes expand.
        output: over `axes`.

    Shapes:
        weights: the samples of `axes`, in their order.

    Reference:
        Lomp, Richter, Zibner & Schöner (2016), Front. Neurorobot. 10:14, eq. 9.
    """

    weights: Annotated[ArrayLike, Rebuild()] = FrozenArray(np.ones(21))
    axes: tuple[Axis, ...] = needed("[x]")

    linear: ClassVar[bool] = True
    signed_by: ClassVar[tuple[str, ...]] = ("weights",)

    @classmethod
    def starting_values(cls, axes: Axes, arriving: Axes | None = None) -> Mapping[str, Any]:
        return {"weights": FrozenArray(np.ones(shape(axes)))}

    def input_axes(self, port: str, arriving: Axes | None) -> Axes | None:
        return tuple(self.axes)

    def validate_axes(self, ins: PortAxes) -> Iterator[tuple[str, str]]:
        yield from wrong_shape("weights", self.weights, shape(self.axes))

    def prepare(self, at: Setting) -> Arrays:
        return {"weights": at.array(self.weights)}

    def output(self, at: Setting) -> Arrays:
        return {"output": at.constants["weights"] * at.inputs["input"]}

    @classmethod
    def of(cls, function: Callable[..., npt.ArrayLike], axes: Sequence[Axis]) -> Weighting:
        """Sample the weights from a function of the axes' values: `Weighting.of(lambda x: x / 100, [x])`."""
        grids = np.meshgrid(*(a.points for a in axes), indexing="ij")
        return cls(np.broadcast_to(np.asarray(function(*grids), float), shape(axes)), tuple(axes))

    @classmethod
    def example(cls) -> Weighting:
        return cls(np.ones(21), (Axis("x", 0, 20, samples=21),), name="example")


@register
@dataclass(frozen=True)
class PseudoInverse(Coupling):
    r"""The pseudo-inverse of a matrix, for example of a Jacobian: a change of the tool becomes one of the
    joints.

    Without damping it is the inverse of Moore and Penrose: of all solutions the one with the smallest norm.
    Damping bounds it near matrices of lower rank, where it is discontinuous. It is computed from the singular
    values, by sums over samples without the grid step.

    Equation:
        Y = \begin{cases} X^+ & \mathrm{damping} = 0 \\ X^T (X X^T + \mathrm{damping}^2 I)^{-1} &
            \text{else} \end{cases}

    Parameters:
        damping: bound of the inverse, in units of the input; a singular value s becomes s / (s^2 +
            damping^2).
        least: part of the largest singular value below which one counts as 0; 0 to 1.

    Ports:
        input: X, over two axes, or over one axis as a single column.
        output: Y, over the axes of `input` in reverse order.

    Reference:
        Penrose (1955), A generalized inverse for matrices, Math. Proc. Camb. Phil. Soc. 51, 406-413. Nakamura
        & Hanafusa (1986), Inverse kinematic solutions with singularity robustness for robot manipulator
        control, J. Dyn. Sys. Meas. Control 108, 163-171 (damping).
    """

    damping: Annotated[float, Live(lower=0)] = 0.0
    least: Annotated[float, Live(lower=0, upper=1)] = 1e-6

    def polarity(self) -> Sign:
        return "±"

    def outputs(self, ins: PortAxes) -> PortAxes:
        return {"output": ins["input"][::-1]}

    def validate_axes(self, ins: PortAxes) -> Iterator[tuple[str, str]]:
        if len(ins["input"]) not in (1, 2):
            yield f"needs an input of one or two axes, not of {len(ins['input'])}", "Put a Project before it"

    def output(self, at: Setting) -> Arrays:
        x = at.inputs["input"]
        left, sizes, right = jnp.linalg.svd(x.reshape(x.shape[0], -1), full_matrices=False)
        counts = (sizes > self.least * sizes[0]) & (sizes > 0)
        strength = jnp.where(counts, sizes, 0.0) / jnp.where(counts, sizes**2 + self.damping**2, 1.0)
        y = jnp.matmul(right.T * strength, left.T, precision="highest")
        return {"output": y.reshape(x.shape[::-1])}
