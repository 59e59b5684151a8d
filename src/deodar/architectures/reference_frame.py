"""A transformation between reference frames: from retinal position and gaze to body-centred position.

An object at x on the retina, seen with the gaze at g, is at x + g relative to the body. Two forms compute the
sum. The steered form shifts the whole pattern by the number g. The diagonal form uses fields only: a field
over both dimensions has a peak where the ridge of the object and the ridge of the gaze cross; all pairs with
the same sum lie on one diagonal, and the read-out sums along it. Both forms transform any number of objects.

Reference:
    Schneegans & Schöner (2012), A neural mechanism for coordinate transformation predicts pre-saccadic
    remapping, Biol. Cybern. 106, 89-109 (the transformation field and its diagonals). All parameters are
    deodar's.
"""

from __future__ import annotations

from deodar.couplings.arithmetic import Gain
from deodar.couplings.convolutions import SteeredShift
from deodar.couplings.positions import SpaceCode
from deodar.couplings.projections import DiagonalSum, Project, Resample
from deodar.elements.field import Field
from deodar.elements.stimuli import Boost, GaussianStimulus
from deodar.errors import ParameterError, did_you_mean
from deodar.model.model import Handle, Model
from deodar.numerics.axes import Axis
from deodar.numerics.kernels.separable import Gaussian
from deodar.numerics.sigmoids import Logistic
from deodar.numerics.windows import Window
from deodar.parameters import show

RETINA = Axis("retina", -30.0, 30.0, 61, unit="deg")
GAZE = Axis("gaze", -30.0, 30.0, 61, unit="deg")
BODY = Axis("body", -60.0, 60.0, 121, unit="deg")
"""Axes in steps of 1 deg; the body's axis contains every sum of the other two."""

TAU, RESTING, STEEP = 20.0, -5.0, 4.0
WIDTH = 3.0

RIDGE = 3.5
"""Strength of the ridges of an object and of the gaze in the transformation field: one ridge alone raises
activation to -1.5, both together to 2.
"""

SUMMED, SHIFTED = 0.85, 6.0
"""Strengths of the inputs of the body's field: from the sum along diagonals (a peak is about 7 samples wide)
and from the shifted pattern.
"""

FORMS = ("diagonal", "steered")


def reference_frame(form: str = "diagonal", noise: float = 0.2) -> Model:
    """Create the fields `retina` and `body` and the transformation between them, to be inserted as a group.

    Connect objects to `retina` with a strength of about 6, and the gaze, -20 to 20 deg (a peak nearer to the
    end of its axis would be cut off), to `gaze`.

    Equation::

        steered:  s_body(y) = 6 f(u_retina(y - g))
        diagonal: s_transform(x, g') = 3 f(u_retina(x)) + 3 exp(-(g' - g)^2 / (2 3^2))
                  s_body(y) = 0.7 integral f(u_transform(y - g', g')) dg'

    Args:
        form: `diagonal` or `steered`.
        noise: strength of the noise of all fields.
    """
    if form not in FORMS:
        raise ParameterError(
            f"form is {show(form)}; it is diagonal or steered", fix=did_you_mean(str(form), FORMS)
        )
    model = Model(f"reference frame, {form}")
    retina, body = (
        model.add(_field(name, axis, noise)) for name, axis in (("retina", RETINA), ("body", BODY))
    )
    gaze = model.add(Gain(1.0, name="gaze"))
    (_diagonal if form == "diagonal" else _steered)(model, retina, gaze, body, noise)
    return model


def remapping(noise: float = 0.2) -> Model:
    """Create both forms side by side: the gaze jumps, so that an object that does not move jumps on the
    retina; another object is new.
    """
    model = Model("remapping")
    place, jumps = 12.0, ((0.0, 0.0, 400.0), (15.0, 400.0, 800.0), (-10.0, 800.0, 1e6))
    gaze = [
        model.add(Boost(f"gaze at {g:g}", [], amplitude=g, windows=[Window(a, b)])) for g, a, b in jumps if g
    ]
    at = [
        model.add(
            GaussianStimulus(
                f"seen at {place - g:g}",
                [RETINA],
                center=place - g,
                sigma=WIDTH,
                amplitude=6.0,
                windows=[Window(a, b)],
            )
        )
        for g, a, b in jumps
    ]
    at.append(
        model.add(
            GaussianStimulus(
                "another", [RETINA], center=-15.0, sigma=WIDTH, amplitude=6.0, windows=[Window(1000.0)]
            )
        )
    )
    for form in FORMS:
        model.insert(reference_frame(form, noise), form)
        for source in gaze:
            source >> model[f"{form}.gaze"]
        for source in at:
            source >> model[f"{form}.retina"]
    return model


def _steered(model: Model, retina: Handle, gaze: Handle, body: Handle, noise: float) -> None:
    wide = Axis(RETINA.name, BODY.lower, BODY.upper, BODY.samples, unit=RETINA.unit)
    shift = model.add(SteeredShift([RETINA.name], name="shift"))
    retina >> model.add(Resample([wide], name="wide")) >> shift
    model.connect(gaze, "shift.by")
    (
        shift
        >> model.add(Project([BODY], rename={RETINA.name: BODY.name}, name="before the body"))
        >> model.add(Gain(SHIFTED, name="strength"))
        >> body
    )


def _diagonal(model: Model, retina: Handle, gaze: Handle, body: Handle, noise: float) -> None:
    kernel = [Gaussian(3.0, 2.0, normalized=True)]
    sigmoid = Logistic(beta=STEEP)
    both = model.add(
        Field(
            "transform",
            [RETINA, GAZE],
            tau=TAU,
            resting_level=RESTING,
            sigmoid=sigmoid,
            kernel=kernel,
            noise=noise,
        )
    )
    retina >> model.add(Gain(RIDGE, name="object's ridge")) >> both
    gaze >> model.add(SpaceCode([GAZE], WIDTH, RIDGE, name="gaze's ridge")) >> both
    (
        both
        >> model.add(DiagonalSum([BODY], name="diagonals"))
        >> model.add(Gain(SUMMED, name="strength"))
        >> body
    )


def _field(name: str, axis: Axis, noise: float) -> Field:
    kernel = [Gaussian(6.0, WIDTH, normalized=True)]
    sigmoid = Logistic(beta=STEEP)
    return Field(
        name,
        [axis],
        tau=TAU,
        resting_level=RESTING,
        sigmoid=sigmoid,
        kernel=kernel,
        global_inhibition=0.03,
        noise=noise,
    )
