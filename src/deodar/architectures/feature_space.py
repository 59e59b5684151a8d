"""A feature-space field with read-outs: a cue for a position selects the feature there, and vice versa.

`bound` receives objects as input below threshold. A cue in `feature` creates a ridge over all positions with
this feature, a cue in `space` a ridge over all features at this position. Where a ridge overlaps an object, a
peak forms; its contraction over the other dimension activates the bound value in the other field.

The selection outlives its cue: the peak in `bound` and the peaks that it activates excite each other.
Inhibition of all three fields ends it.

References:
    Lomp, Richter, Zibner & Schöner (2016), Front. Neurorobot. 10:14, eqs. 5 and 6 and section 5 (expansion,
    contraction and the ridge that meets an object). Johnson, Spencer & Schöner (2008), Moving to higher
    ground: The dynamic field theory and the dynamics of visual cognition, New Ideas in Psychology 26(2)
    (coupled feature-space fields). All parameters are deodar's.
"""

from __future__ import annotations

from collections.abc import Sequence

from deodar.couplings.arithmetic import Gain
from deodar.couplings.projections import Project
from deodar.elements.field import Field
from deodar.elements.stimuli import Boost, GaussianStimulus
from deodar.model.model import Model
from deodar.numerics.axes import Axis
from deodar.numerics.kernels.separable import Gaussian
from deodar.numerics.sigmoids import Logistic
from deodar.numerics.windows import Window

TAU, RESTING, STEEP = 20.0, -5.0, 4.0

RIDGE, READ = 2.2, 6.0
"""Strengths from a read-out field to `bound`, and from the maximum along the other dimension back.

An object of 3.5 and a ridge of 2.2 together create a peak (0.7 above threshold, before local excitation); two
ridges that cross without an object stay at -0.6. The value read out raises a read-out field to 1.
"""

OBJECT, CUE, RELEASE = 3.5, 6.0, -10.0


def axes() -> tuple[Axis, Axis]:
    """Return the default axes of space and feature."""
    return Axis("space", 0.0, 100.0, 51, unit="deg"), Axis(
        "feature", 0.0, 360.0, 36, periodic=True, unit="deg"
    )


def feature_space(
    space: Axis | None = None,
    feature: Axis | None = None,
    sigma: Sequence[float] = (5.0, 20.0),
    noise: float = 0.2,
) -> Model:
    """Create the three fields `bound`, `space` and `feature`, to be inserted as a group.

    Connect objects to `bound` with a strength of about 3.5, cues to `space` or `feature` with about 6.

    Args:
        space: the axis of positions; none: 0 to 100 deg.
        feature: the axis of features; none: a circle of hues.
        sigma: width of local excitation, along space and along feature, in their units.
        noise: strength of the noise of all fields.
    """
    x, f = space or axes()[0], feature or axes()[1]
    model = Model("feature space")
    both = model.add(_field("bound", [x, f], 10.0, list(sigma), 0.0015, noise))
    for name, axis, width in (("space", x, sigma[0]), ("feature", f, sigma[1])):
        one = model.add(_field(name, [axis], 8.0, [width], 0.3 / width, noise))
        (
            one
            >> model.add(Gain(RIDGE, name=f"{name} ridge"))
            >> model.add(Project([x, f], name=f"{name} expands"))
            >> both
        )
        (
            both
            >> model.add(Project([axis], reduce="max", name=f"{name} of the peak"))
            >> model.add(Gain(READ, name=f"{name} read-out"))
            >> one
        )
    return model


def binding(noise: float = 0.2) -> Model:
    """Create a `feature_space` model with three objects, a cue for a feature and then a cue for a
    position.
    """
    model = feature_space(noise=noise)
    model.describe(name="binding")
    x, f = axes()
    for name, at in (("red", [20.0, 0.0]), ("green", [50.0, 120.0]), ("blue", [80.0, 240.0])):
        (
            model.add(GaussianStimulus(name, [x, f], center=at, sigma=[5.0, 20.0], amplitude=OBJECT))
            >> model["bound"]
        )
    hue, place = Window(200.0, 600.0), Window(1000.0, 1400.0)
    (
        model.add(GaussianStimulus("cue green", [f], center=120.0, sigma=20.0, amplitude=CUE, windows=[hue]))
        >> model["feature"]
    )
    (
        model.add(GaussianStimulus("cue right", [x], center=80.0, sigma=5.0, amplitude=CUE, windows=[place]))
        >> model["space"]
    )
    release = model.add(
        Boost("release", [], amplitude=RELEASE, windows=[Window(800.0, 900.0), Window(1600.0, 1700.0)])
    )
    for name in ("bound", "space", "feature"):
        release >> model[name]
    return model


def _field(
    name: str,
    over: Sequence[Axis],
    excitation: float,
    sigma: Sequence[float],
    inhibition: float,
    noise: float,
) -> Field:
    kernel, steep = [Gaussian(excitation, sigma, normalized=True)], Logistic(beta=STEEP)
    return Field(
        name,
        over,
        tau=TAU,
        resting_level=RESTING,
        sigmoid=steep,
        kernel=kernel,
        global_inhibition=inhibition,
        noise=noise,
    )
