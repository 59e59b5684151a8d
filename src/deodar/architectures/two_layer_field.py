"""A two-layer field: an excitatory layer that drives an inhibitory layer.

The one-layer field computes inhibition without delay. In a two-layer field, inhibition lags by the time
constant of the inhibitory layer, has a threshold, and may be shared: connect other fields to `inhibitory`,
and `inhibitory` to them.

    tau u' = -u + h + s(x, t) + integral k(x - x') g(u(x')) dx'
             + integral k_v(x - x') g_v(v(x')) dx' - c integral g_v(v) dx
    tau_v v' = -v + h_v + integral k_d(x - x') g(u(x')) dx'

With tau_v far below tau, h_v = 0 and g_v linear it equals the one-layer field whose kernels are those of k,
and those of k_v convolved with k_d.

References:
    Sandamirskaya (2014), Front. Neurosci. 7:276, section 2.1 (when the inhibitory layer may be omitted).
    Amari (1977), Dynamics of pattern formation in lateral-inhibition type neural fields, Biol. Cybern. 27,
    section 5 (two layers). Johnson, Spencer & Schöner (2009), A layered neural architecture for the
    consolidation, maintenance, and updating of representations in visual working memory, Brain Res. 1299,
    17-32 (a layer of inhibition shared by two fields).
"""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Sequence

from deodar.couplings.convolutions import Convolve, Interaction
from deodar.elements.field import Field
from deodar.model.model import Model
from deodar.numerics.axes import Axis
from deodar.numerics.kernels._base import Kernel
from deodar.numerics.sigmoids import Logistic, SigmoidFunction


@dc.dataclass(frozen=True)
class Layer:
    """The field dynamics of one layer.

    Attributes:
        tau: time constant, in the document's time unit; > 0, and at least one step.
        resting_level: h, attractor without input.
        sigmoid: g, output; none: the logistic function.
        noise: strength of the noise.
    """

    tau: float = 20.0
    resting_level: float = -5.0
    sigmoid: SigmoidFunction | None = None
    noise: float = 0.0

    def field(self, name: str, axes: Sequence[Axis], kernel: Sequence[Kernel] = ()) -> Field:
        """Return the layer as a field."""
        sigmoid = self.sigmoid or Logistic()
        return Field(name, axes, self.tau, self.resting_level, sigmoid, kernel, noise=self.noise)


def two_layer_field(
    axes: Sequence[Axis],
    kernel: Sequence[Kernel],
    inhibition: Sequence[Kernel] = (),
    global_inhibition: float = 0.0,
    drive: Sequence[Kernel] = (),
    excitatory: Layer | None = None,
    inhibitory: Layer | None = None,
) -> Model:
    """Create the two layers, fields `excitatory` and `inhibitory`, to be inserted into a model as a group.

    Connect inputs to `excitatory`.

    Args:
        axes: the metric dimensions of both layers.
        kernel: k, excitation within the excitatory layer, summed.
        inhibition: k_v, from the inhibitory layer to the excitatory one, summed; its amplitudes are negative,
            as in a Field.
        global_inhibition: c, factor of the integral of the inhibitory layer's output.
        drive: k_d, from the excitatory layer to the inhibitory one, summed; none: pointwise, with a
            strength of 1.
        excitatory: tau, h, g and noise of the excitatory layer; none: the defaults of `Layer`.
        inhibitory: tau_v, h_v, g_v and noise of the inhibitory layer; none: the defaults of `Layer`, with a
            tau_v of 10.
    """
    model = Model("two-layer field")
    u = model.add((excitatory or Layer()).field("excitatory", axes, kernel))
    v = model.add((inhibitory or Layer(tau=10.0)).field("inhibitory", axes))
    if drive:
        u >> model.add(Convolve(drive, name="drive")) >> v
    else:
        u >> v
    if inhibition:
        v >> model.add(Convolve(inhibition, name="inhibition")) >> u
    if global_inhibition or not inhibition:
        v >> model.add(Interaction((), global_inhibition, name="global inhibition")) >> u
    return model
