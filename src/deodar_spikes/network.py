"""A network of spiking neurons as plain arrays: populations, projections, inputs and probes.

A population is the counterpart of a field: n leaky integrate-and-fire neurons for each cell of its grid. The
current of neuron j of cell c is

    tau_syn dI/dt = -I + gain (resting + s(c) + sum over projections W r) + offset_j

with the input s and the outputs r, so that I is gain u + offset_j, and tau_mem dv/dt = -v + I. The output of
a cell is its spikes in a step, times unit / n.
"""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from deodar.numerics.axes import Axes
from deodar_spikes.spike_code import SpikeCode

WeightMatrix = NDArray[np.float64]


@dc.dataclass(frozen=True)
class Population:
    """The neurons of one field.

    Attributes:
        label: path of the element, and the role of the population in it.
        element, port: id of the element, and the port whose values are the rates.
        axes: axes of the cells.
        code: the neurons of a cell.
        resting: activation without input.
        synapse: tau_syn, in s.
        noise: white noise of the input, cells x deviates, as the square root of its variance times s; or
            None.
        probed: whether its rates are an output of the network.
    """

    label: str
    element: str
    port: str
    axes: Axes
    code: SpikeCode
    resting: float
    synapse: float
    noise: WeightMatrix | None = None
    probed: bool = True

    @property
    def cells(self) -> int:
        """Number of cells."""
        return int(np.prod([a.samples for a in self.axes], dtype=int))

    @property
    def neurons(self) -> int:
        """Number of neurons."""
        return self.cells * len(self.code.offsets)


@dc.dataclass(frozen=True)
class Projection:
    """The synapses from one population to another.

    Attributes:
        source, target: indices of the populations.
        weights: activation of a target cell for an output of 1 of a source cell, targets x sources.
    """

    source: int
    target: int
    weights: WeightMatrix


@dc.dataclass(frozen=True)
class SpikingNetwork:
    """Populations and projections, for one step.

    Attributes:
        populations, projections: its parts.
        step: dt, in s.
        unit: the document's unit of time, in s.
    """

    populations: Sequence[Population]
    projections: Sequence[Projection]
    step: float
    unit: float = 1e-3

    @property
    def neurons(self) -> int:
        """Number of neurons."""
        return sum(p.neurons for p in self.populations)

    @property
    def synapses(self) -> int:
        """Number of synapses between neurons whose weight is not zero."""
        per_cell = [len(p.code.offsets) for p in self.populations]
        return sum(
            int(np.count_nonzero(p.weights)) * per_cell[p.source] * per_cell[p.target]
            for p in self.projections
        )

    @property
    def settling(self) -> float:
        """Time after which currents that start from 0 are at rest, in s."""
        return 6 * max(p.synapse for p in self.populations)
