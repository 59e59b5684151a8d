"""The spiking counterpart of each kind of element that has one: its populations, and its own synapses."""

from __future__ import annotations

import dataclasses as dc
import math
from collections.abc import Callable, Mapping, Sequence

import jax
import jax.numpy as jnp
import numpy as np

from deodar.element import Element
from deodar.elements.field import Field
from deodar.elements.populations import SoftWinnerTakeAll
from deodar.errors import TimeError, option
from deodar.importers.report import Verdict
from deodar.leaves import per_axis
from deodar.model.document import Entry
from deodar.numerics import noise as noises
from deodar.numerics.axes import Axes, cell, shape
from deodar.numerics.processor import on_cpu
from deodar.numerics.sigmoids import Linear, SigmoidFunction
from deodar_spikes.linear_maps import kernel_matrix
from deodar_spikes.network import Population, Projection, WeightMatrix
from deodar_spikes.spike_code import SpikeCode, spike_code

INHIBITORY = 2
"""Neurons of an inhibitory unit, as a multiple of those of a cell."""


@dc.dataclass(frozen=True)
class TranslationSetup:
    """What a translation is made for.

    Attributes:
        neurons: neurons of a cell.
        step, membrane: dt and tau_mem, in s.
        unit: the document's unit of time, in s.
        tonic: whether tonic neurons give the resting levels (see `translate.py`).
    """

    neurons: int
    step: float
    membrane: float
    unit: float
    tonic: bool = False

    @property
    def resting(self) -> tuple[Verdict, str]:
        """Verdict on a resting level or threshold, and what it becomes."""
        return "carried", "synaptic weights from tonic neurons" if self.tonic else "constant current"

    def code(self, sigmoid: SigmoidFunction, neurons: int = 0) -> SpikeCode:
        """Return the neurons of an output function."""
        return spike_code(sigmoid, neurons or self.neurons, self.step, self.membrane)

    def synapse(self, entry: Entry, name: str) -> float:
        """Return a time constant in s, which must be longer than the step."""
        tau = float(getattr(entry.element, name)) * self.unit
        if self.step >= tau:
            raise TimeError(
                f"the step {self.step * 1e3:g} ms is not below {name} = {tau * 1e3:g} ms",
                where=entry.path,
                fix=option("Give one below it, for example", "step", f"{tau / self.unit / 10:g}"),
            )
        return tau


@dc.dataclass(frozen=True)
class Counterpart:
    """The populations of an element, the synapses among them, and the verdict on its parameters.

    Attributes:
        populations: its populations; the first one receives what is connected to the element.
        projections: synapses among them, with indices of this list.
        parameters: verdict and reason of parameters that are not simply carried.
    """

    populations: Sequence[Population]
    projections: Sequence[Projection]
    parameters: Mapping[str, tuple[Verdict, str]]


def field(entry: Entry, setup: TranslationSetup) -> Counterpart:
    """Return the neurons of a field; its global inhibition acts through negative weights."""
    element = entry.element
    assert isinstance(element, Field)
    axes = tuple(element.axes)
    code = setup.code(element.sigmoid)
    weights = kernel_matrix(element.kernel, axes) - element.global_inhibition * cell(axes)
    said: dict[str, tuple[Verdict, str]] = {
        "tau": ("carried", "time constant of the synapses"),
        "resting_level": setup.resting,
        "sigmoid": _sigmoid(element.sigmoid, code),
        "kernel": ("carried", "synaptic weights"),
        "global_inhibition": ("carried", "synaptic weights from each cell to each cell"),
    }
    if element.quadrature != "point":
        said["quadrature"] = (
            "approximated",
            "the output at the sample takes the place of its mean over a cell",
        )
    noise = None
    if element.noise:
        noise = _noise(element, axes) * element.noise * math.sqrt(setup.unit)
        said["noise"] = ("approximated", "Poisson input of equal variance")
        if any(float(v) for v in per_axis(element.noise_length, axes)):
            said["noise_length"] = ("carried", "weights of the Poisson input")
    u = Population(
        entry.path, entry.id, "output", axes, code, element.resting_level, setup.synapse(entry, "tau"), noise
    )
    return Counterpart([u], _own(weights), said)


def soft_winner_take_all(entry: Entry, setup: TranslationSetup) -> Counterpart:
    """Return excitatory neurons for each unit, and a pool of inhibitory ones."""
    element = entry.element
    assert isinstance(element, SoftWinnerTakeAll)
    axes = tuple(element.axes)
    code = setup.code(element.sigmoid)
    pool = setup.code(element.sigmoid_inhibition, INHIBITORY * setup.neurons)
    own = kernel_matrix(element.kernel, axes)
    own = own + element.self_excitation * np.eye(len(own))
    ones = np.ones((1, len(own)))
    said: dict[str, tuple[Verdict, str]] = {
        "tau": ("approximated", "time constant of the synapses, so that the input passes it too"),
        "tau_inhibition": ("carried", "time constant of the synapses of the inhibitory neurons"),
        "threshold": setup.resting,
        "threshold_inhibition": setup.resting,
        "sigmoid": _sigmoid(element.sigmoid, code),
        "sigmoid_inhibition": _sigmoid(element.sigmoid_inhibition, pool),
        **dict.fromkeys(
            ("self_excitation", "kernel", "inhibition", "drive"), ("carried", "synaptic weights")
        ),
    }
    noise = None
    if element.noise:
        # r = low-passed noise: as input of the rate it would have to pass the output function
        said["noise"] = ("approximated", "Poisson input of equal variance, before the output function")
        noise = np.eye(len(own)) * element.noise / math.sqrt(cell(axes)) * math.sqrt(setup.unit)
    tau, fast = setup.synapse(entry, "tau"), setup.synapse(entry, "tau_inhibition")
    r = Population(entry.path, entry.id, "output", axes, code, -element.threshold, tau, noise)
    v = Population(
        f"{entry.path} inhibitory",
        entry.id,
        "inhibitory",
        (),
        pool,
        -element.threshold_inhibition,
        fast,
        probed=False,
    )
    among = [
        Projection(0, 1, element.drive * cell(axes) * ones),
        Projection(1, 0, -element.inhibition * ones.T),
    ]
    return Counterpart([r, v], [*_own(own), *among], said)


COUNTERPARTS: Mapping[type[Element], Callable[[Entry, TranslationSetup], Counterpart]] = {
    Field: field,
    SoftWinnerTakeAll: soft_winner_take_all,
}
"""The kinds of elements that become neurons."""


def _own(weights: WeightMatrix) -> list[Projection]:
    return [Projection(0, 0, weights)] if np.any(weights) else []


def _sigmoid(sigmoid: SigmoidFunction, code: SpikeCode) -> tuple[Verdict, str]:
    kind = type(sigmoid).__name__
    below = "; a rate is never negative" if isinstance(sigmoid, Linear) else ""
    return "approximated", f"{kind} by the rates of {len(code.offsets)} neurons: {code}{below}"


def _noise(element: Field, axes: Axes) -> WeightMatrix:
    """Return the matrix from independent deviates to the noise of a field with the strength 1."""
    many = np.eye(math.prod(shape(axes)))
    with on_cpu(), jax.enable_x64(True):
        filters = noises.prepare(axes, element.noise_length, np.dtype("float64")).get("noise")
        if filters is None:
            return many / math.sqrt(cell(axes))
        made = [np.asarray(noises.over(axes, jnp.asarray(row.reshape(shape(axes))), filters)) for row in many]
    return np.stack([m.reshape(-1) for m in made], axis=1)
