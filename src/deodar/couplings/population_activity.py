"""The distribution of population activity."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

import jax.numpy as jnp
import numpy as np

from deodar.declarations import needed
from deodar.element import Arrays, Coupling, PortAxes, Setting
from deodar.errors import ParameterError
from deodar.leaves import per_axis
from deodar.numerics import starting
from deodar.numerics.axes import Axes, Axis, cell, shape
from deodar.parameters import ArrayLike, FrozenArray, Live, PerAxis, Rebuild
from deodar.registry import register


@register
@dataclass(frozen=True)
class PopulationActivity(Coupling):
    r"""A distribution of population activation: the sum of tuning curves weighted by firing rates.

    r is the input; where no neuron is tuned to x, the normalized form is 0.

    Equation:
        y(x) = \mathrm{amplitude} \sum_i T_i(x)\, r_i
        \text{normalized:}\quad y(x) = \mathrm{amplitude} \frac{\sum_i T_i(x)\, r_i}{\sum_i T_i(x)}

    Parameters:
        tuning: T, the tuning curve of each neuron: its mean rate as a function of x.
            `PopulationActivity.of(preferred, sigma, axes)` makes Gaussians.
        axes: the dimensions to which the neurons are tuned; at least one.
        amplitude: factor from the sum to activation.
        normalized: whether the output is the mean of the rates weighted by the tuning; it then does not
            depend on the number of neurons tuned to x.

    Ports:
        input: r, an axis with one sample for each neuron.
        output: over `axes`.

    Shapes:
        tuning: neurons first, then the samples of `axes`.

    Reference:
        Sandamirskaya (2014), Front. Neurosci. 7:276, figure 1; Bastian, Schöner & Riehle (2003), Preshaping
        and continuous evolution of motor cortical representations during movement preparation, Eur. J.
        Neurosci. 18, 2047-2058.
    """

    tuning: Annotated[ArrayLike, Rebuild()] = FrozenArray(np.eye(21))
    axes: Sequence[Axis] = needed("[x]")
    amplitude: Annotated[float, Live("activation")] = 1.0
    normalized: bool = False

    linear: ClassVar[bool] = True
    maps: ClassVar[Mapping[str, tuple[str, ...]]] = {"tuning": ("input", "output")}
    signed_by: ClassVar[tuple[str, ...]] = ("tuning", "amplitude")

    @classmethod
    def starting_values(cls, axes: Axes, arriving: Axes | None = None) -> Mapping[str, Any]:
        neurons = arriving if arriving is not None and len(arriving) == 1 else axes[:1]
        tuning = starting.map_of_places(neurons, axes) if neurons else None
        return {} if tuning is None else {"tuning": FrozenArray(tuning * cell(axes))}

    def validate(self) -> Iterator[tuple[str, str]]:
        if not self.axes:
            yield "axes", "is empty; tuning needs at least one axis"
        given = self.tuning.shape if isinstance(self.tuning, FrozenArray) else ()
        if given[1:] != shape(self.axes) or not given:
            yield (
                "tuning",
                (
                    f"has shape {list(given)}; it has the neurons first, then the samples of its axes,"
                    f" {list(shape(self.axes))}"
                ),
            )

    def validate_axes(self, ins: PortAxes) -> Iterator[tuple[str, str]]:
        arriving, neurons = (
            shape(ins["input"]),
            len(self.tuning.data) if isinstance(self.tuning, FrozenArray) else 0,
        )
        if arriving != (neurons,):
            yield (
                f"has the tuning of {neurons} neurons; its input has {list(arriving)} samples",
                "Give it one rate for each neuron",
            )

    def prepare(self, at: Setting) -> Arrays:
        tuning = at.array(self.tuning)
        if self.normalized:
            whole = jnp.sum(tuning, axis=0)
            tuning = jnp.where(whole == 0, 0.0, tuning / jnp.where(whole == 0, 1.0, whole))
        return {"tuning": tuning}

    def output(self, at: Setting) -> Arrays:
        return {
            "output": (
                self.amplitude
                * jnp.tensordot(at.inputs["input"], at.constants["tuning"], axes=1, precision="highest")
            )
        }

    @classmethod
    def of(
        cls, preferred: ArrayLike, sigma: PerAxis, axes: Sequence[Axis], rate: float = 1.0, **others: Any
    ) -> PopulationActivity:
        """Create neurons with Gaussian tuning curves; on a periodic axis the distance is the shorter one.

        Args:
            preferred: the value that each neuron prefers, in axis units; for several axes a row for each
                neuron.
            sigma: width of all tuning curves in axis units, one value or one for each axis; > 0.
            axes: the dimensions to which the neurons are tuned.
            rate: the rate at the preferred value.
            others: other parameters of the element.

        Raises:
            ParameterError: if `preferred` does not have one value for each neuron and axis.
        """
        places = np.asarray(preferred, float)
        places = places[:, None] if places.ndim == 1 and len(axes) == 1 else places
        if places.ndim != 2 or places.shape[1] != len(axes):
            raise ParameterError(
                f"preferred has shape {list(np.shape(preferred))}; it has a row for each neuron with one"
                f" value for each of {len(axes)} axes"
            )
        tuning = np.full(len(places), rate)
        widths = per_axis(sigma if isinstance(sigma, (int, float)) else tuple(sigma), axes)
        for d, (axis, width) in enumerate(zip(axes, widths, strict=True)):
            distance = axis.points - places[:, d, None]
            if axis.periodic:
                distance = distance - axis.range * np.round(distance / axis.range)
            tuning = tuning[..., None] * np.exp(-0.5 * (distance / width) ** 2).reshape(
                len(places), *(1,) * d, axis.samples
            )
        return cls(tuning, tuple(axes), **others)

    @classmethod
    def example(cls) -> PopulationActivity:
        return cls(np.eye(21), [Axis("x", 0, 20, samples=21)], name="example")
