r"""Selection in front of an event camera: a field over the retina selects where most events are.

Events are counted in cells of 4 x 4 pixels, blurred, and sampled by the field. Local excitation and global
inhibition let one peak exist: the place that reaches the threshold first suppresses all others. The events of
a blinking target come in volleys, which the time constant of the field smooths. All but the field is linear
and without a state, so that the translation to spikes has events as its input and the field as its neurons.

Reference:
    Sandamirskaya (2014), Dynamic neural fields as a step toward cognitive neuromorphic architectures, Front.
    Neurosci. 7:276, section 2.2, figure 3 (the camera and the perceptual field). The paper prints no
    parameters: all values here are deodar's.
"""

from __future__ import annotations

from deodar.architectures.looking import retina
from deodar.couplings.convolutions import Convolve
from deodar.couplings.projections import Resample
from deodar.elements.field import Field
from deodar.elements.world_ports import Sensor
from deodar.model.model import Model
from deodar.numerics.kernels.separable import Gaussian
from deodar.numerics.sigmoids import Logistic

COUNTED, SAMPLES = 32, 16
"""Cells in which events are counted, and samples of the field, along each axis. A field of 16 x 16 samples
becomes a network that is within the limit of weights with 20 neurons of a cell and fewer.
"""

TAU, STEEP, REST = 100.0, 4.0, -5.0
"""Time constant of the field, ms, slope of its sigmoid, and resting level."""

GAIN, BLUR = 0.3, 8.0
"""Activation for one event per pixel and second, and width of the blur, pixels."""

EXCITATION, WIDTH, INHIBITION = 20.0, 8.0, 1.0 / 64
"""Integral and width (pixels) of the kernel, and global inhibition for each active square pixel."""


def event_selection(samples: int = SAMPLES, inhibition: float = INHIBITION) -> Model:
    """Create the architecture: the sensor `events` of a world such as `dd.Eye`, and the field `perceptual`.

    Args:
        samples: samples of the field along columns and rows. The parameters were found for 16; with fewer,
            the input of a target depends on its place between samples, and nearly equal ones both get a peak.
        inhibition: global inhibition for each active square pixel; 0: no selection, as a control.
    """
    model = Model("event selection", dt=1.0)
    model.describe(notes="Sandamirskaya (2014), section 2.2: a field selects where most events are")
    plane = list(retina(samples))
    field = Field(
        "perceptual",
        plane,
        tau=TAU,
        resting_level=REST,
        sigmoid=Logistic(STEEP),
        kernel=[Gaussian(EXCITATION, WIDTH, normalized=True)],
        global_inhibition=inhibition,
    )
    events = model.add(Sensor("events", list(retina(COUNTED)), sensor="events"))
    blur = model.add(Convolve([Gaussian(GAIN, BLUR, normalized=True)], name="blur"))
    events >> blur >> model.add(Resample(plane, name="cells")) >> model.add(field)
    return model
