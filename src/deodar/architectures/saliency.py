"""Saliency: a colour cue selects an object in a picture, and a motor variable turns to it.

The architecture is that of figure 2 in Sandamirskaya (2014), with one change: the printed colour-space field
is defined over image column and hue, where objects in different rows of a photograph merge; here it is
defined over both image dimensions and hue.

References:
    Sandamirskaya (2014), Dynamic neural fields as a step toward cognitive neuromorphic architectures, Front.
    Neurosci. 7:276, section 2.2 to 2.4, figure 2, eqs. 8 and 9. Lomp, Richter, Zibner & Schöner (2016),
    Front. Neurorobot. 10:14, eq. 11.
"""

from __future__ import annotations

from deodar.architectures._noise import strength as strength_of_noise
from deodar.couplings.arithmetic import Gain
from deodar.couplings.convolutions import Convolve
from deodar.couplings.pictures import ColorSpace
from deodar.couplings.projections import Project
from deodar.elements.field import Field
from deodar.elements.stimuli import GaussianStimulus
from deodar.elements.variables import Attractor
from deodar.elements.world_ports import Sensor
from deodar.model.model import Model
from deodar.numerics.axes import Axis
from deodar.numerics.kernels.separable import Gaussian
from deodar.numerics.sigmoids import Logistic
from deodar.numerics.windows import Window

SIDE = 80.0
"""Length of the sides of the scene; the longer side of a picture has this length."""

CUE_AT = 500.0
"""Time at which the cue begins, ms."""

CELLS, PIXELS, HUES = 40, 160, 30

QUADRATURE = "point"
"""Quadrature of all fields; the parameters were found with `point`.

With `cell` one colour less is selected on the untuned photographs.
"""

# The parameters were tuned on photographs with a separate prototype and scaled so that integrals include the
# grid step; the paper prints none of them.
TAU, STEEP = 100.0, 15.0
CUE_STRENGTH = 4.3
"""Integral of the kernel from the colour field's peak to a ridge; the height of the ridge is then 3.8."""

STILL = 0.15
"""Standard deviation of the noise of a field without interaction."""


def scene() -> tuple[Axis, Axis, Axis]:
    """Return the axes of the colour-space field: x to the right, y downwards, hue in degrees.

    Samples are in the middle of cells.
    """
    edge = SIDE / CELLS / 2
    x, y = (Axis(name, edge, SIDE - edge, CELLS) for name in ("x", "y"))
    return x, y, Axis("hue", 0, 360, HUES, periodic=True, unit="deg")


def retina() -> tuple[Axis, Axis, Axis]:
    """Return the axes over which the picture is sampled, finer than the field's, so that pixels are not
    averaged before their hue is computed.
    """
    edge = SIDE / PIXELS / 2
    x, y = (Axis(name, edge, SIDE - edge, PIXELS) for name in ("x", "y"))
    return x, y, Axis("channel", 0, 2, 3)


def saliency(hue: float = 0.0, cue: float = 6.0) -> Model:
    """Create the architecture, with a cue for one hue that begins at CUE_AT.

    Args:
        hue: cued hue, degrees.
        cue: strength of the cue; 0 for none.
    """
    x, y, hues = scene()
    model = Model("saliency", dt=10.0)
    model.describe(notes="Sandamirskaya (2014), figure 2, over both dimensions of a picture")
    eye = model.add(Sensor("eye", retina(), sensor="picture"))
    sigmoid = Logistic(beta=STEEP)

    colours = model.add(ColorSpace([x, y, hues], sigma=15.0, name="colours"))
    blur = model.add(Convolve([Gaussian(1.0, (1.0, 1.0, 1e-3), normalized=True)], name="blur"))
    perceptual = model.add(
        Field(
            "perceptual",
            [x, y, hues],
            tau=TAU,
            resting_level=-5.0,
            sigmoid=sigmoid,
            kernel=[Gaussian(18.0, (3.0, 3.0, 18.0), normalized=True)],
            global_inhibition=2.6e-3,
            noise=strength_of_noise(STILL, TAU, [x, y, hues]),
            quadrature=QUADRATURE,
        )
    )
    eye >> colours >> blur >> model.add(Gain(2.6, name="camera strength")) >> perceptual

    # for figures only: the maximum of the field along the rows, as in the paper's figure
    perceptual["activation"] >> model.add(Project([x, hues], reduce="max", name="seen"))

    named = model.add(
        GaussianStimulus("cue", [hues], center=hue, sigma=18.0, amplitude=cue, windows=[Window(CUE_AT)])
    )
    colour = model.add(
        Field(
            "colour",
            [hues],
            tau=TAU,
            resting_level=-3.0,
            sigmoid=sigmoid,
            kernel=[Gaussian(4.0, 18.0, normalized=True)],
            noise=strength_of_noise(STILL, TAU, [hues]),
            quadrature=QUADRATURE,
        )
    )
    ridge = model.add(Convolve([Gaussian(CUE_STRENGTH, 22.0, normalized=True)], name="ridge"))
    named >> colour >> ridge >> perceptual

    spatial = model.add(
        Field(
            "spatial", [x, y], tau=TAU, resting_level=-5.0, sigmoid=sigmoid,
            kernel=[Gaussian(12.0, 2.5, normalized=True)], global_inhibition=0.05,
            noise=strength_of_noise(STILL, TAU, [x, y]), quadrature=QUADRATURE,
        )
    )  # fmt: skip
    (
        perceptual
        >> model.add(Project([x, y], name="where"))
        >> model.add(Gain(0.19, name="where strength"))
        >> spatial
    )

    for name, axis in (("pan", x), ("tilt", y)):
        spatial >> model.add(Attractor(name, axis, tau=20_000.0, initial=SIDE / 2))
    return model
