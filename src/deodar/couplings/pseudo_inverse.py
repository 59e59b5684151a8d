"""The pseudo-inverse of a matrix."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Annotated

import jax.numpy as jnp
from jax import Array

from deodar.element import Arrays, Coupling, Setting, Time
from deodar.numerics.axes import Axes
from deodar.numerics.signs import Sign
from deodar.parameters import Live
from deodar.registry import register


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

    damping: Annotated[float, Live(lower=0, meaning="bound of the inverse, in units of the input")] = 0.0
    least: Annotated[
        float, Live(lower=0, upper=1, meaning="part of the largest singular value that counts as 0")
    ] = 1e-6

    def polarity(self) -> Sign:
        return "±"

    def outputs(self, ins: Mapping[str, Axes]) -> Mapping[str, Axes]:
        return {"output": ins["input"][::-1]}

    def validate_axes(self, ins: Mapping[str, Axes]) -> Iterator[tuple[str, str]]:
        if len(ins["input"]) not in (1, 2):
            yield f"needs an input of one or two axes, not of {len(ins['input'])}", "Put a Project before it"

    def output(
        self, at: Setting, state: Arrays, inputs: Arrays, constants: Arrays, time: Time, noise: Array | None
    ) -> Arrays:
        x = inputs["input"]
        left, sizes, right = jnp.linalg.svd(x.reshape(x.shape[0], -1), full_matrices=False)
        counts = (sizes > self.least * sizes[0]) & (sizes > 0)
        strength = jnp.where(counts, sizes, 0.0) / jnp.where(counts, sizes**2 + self.damping**2, 1.0)
        y = jnp.matmul(right.T * strength, left.T, precision="highest")
        return {"output": y.reshape(x.shape[::-1])}
