"""Working memory with change detection: is what is shown now the same as what was shown before?

Three layers over one feature. `contrast` detects what is new, `memory` takes it over and keeps it, and
`inhibition`, which both excite, inhibits both: around each peak of the memory, and at the place of each peak
in the contrast field. So what is held already makes no peak in `contrast` when it is shown again, and what is
not does. While a decision is asked for, a peak in `contrast` turns the node `different` on, and without one
the memory turns on `same`.

References:
    Johnson, Spencer & Schöner (2009), A layered neural architecture for the consolidation, maintenance, and
    updating of representations in visual working memory, Brain Research 1299, 17-32 (three layers with shared
    inhibition). Johnson, Spencer, Luck & Schöner (2009), A dynamic neural field model of visual working
    memory and change detection, Psychological Science 20(5), 568-577 (the decision). All parameters are ours.
"""

from __future__ import annotations

from collections.abc import Sequence

from deodar.couplings.convolve import Convolve
from deodar.couplings.gain import Gain
from deodar.couplings.project import Project
from deodar.elements.boost import Boost
from deodar.elements.field import Field
from deodar.elements.gaussian_stimulus import GaussianStimulus
from deodar.model.model import Handle, Model
from deodar.numerics.axes import Axis
from deodar.numerics.kernels.gaussian import Gaussian
from deodar.numerics.sigmoids.logistic import Logistic
from deodar.numerics.windows import Window

TAU, RESTING, STEEP = 20.0, -5.0, 4.0

QUICK, SLOW = 10.0, 60.0
"""Inhibition is quicker than what it balances.

The node `same` is slower than a new peak, since the memory speaks for it from the start.
"""

LOCAL = {"contrast": 4.0, "memory": 16.0, "inhibition": 0.0}
"""Integral of local excitation: peaks in `contrast` need their input, those in `memory` do not."""

WIDTH = 8.0
"""Of local excitation and of all couplings but one, and of what is shown, deg."""

COUPLINGS = {
    ("contrast", "memory"): (6.0, WIDTH),
    ("contrast", "inhibition"): (8.0, WIDTH),
    ("memory", "inhibition"): (10.0, WIDTH),
    ("inhibition", "contrast"): (-10.0, WIDTH),
    ("inhibition", "memory"): (-8.0, 3 * WIDTH),
}
"""Integral and width of the coupling between two layers."""

ITEM = 6.5
"""Strength of what is shown, at `contrast`; at `memory` a fifth of it arrives."""

DIRECT = 0.2

UNASKED, ASK, DIFFERENT, SAME, AGAINST, HELD = -7.0, 5.0, 4.5, 3.0, -8.0, 4.0
"""Both nodes rest at -7, so that neither can come on before it is asked.

While it is, the memory lifts `same` to 1, a new peak `different` to 2.5. A new peak is soon taken over by the
memory; what it said holds itself, at 2, for as long as the question stands.
"""

SAMPLE, TEST, LENGTH = (200.0, 700.0), (1700.0, 2300.0), 2600.0
"""When the sample is shown, when the test is shown and the decision asked for, and how long a trial is, ms.
"""


def colour_axis() -> Axis:
    """The circle of hues where no axis is given."""
    return Axis("colour", 0.0, 360.0, 120, periodic=True, unit="deg")


def change_detection(axis: Axis | None = None, noise: float = 0.3) -> Model:
    """The three layers and the two nodes, to be inserted as a group.

    What is shown arrives at `shown.input`; what asks for a decision at `ask.input`, as 1.

    Equation::

        tau du/dt = -u + h + s + k_uu * f(u) + k_uv * f(v)
        tau dw/dt = -w + h + s / 5 + k_ww * f(w) + k_wu * f(u) + k_wv * f(v)
        tau_v dv/dt = -v + h + k_vu * f(u) + k_vw * f(w)

    u is `contrast`, w `memory`, v `inhibition`; k_uv and k_wv are negative.

    Args:
        axis: of what is remembered, in deg; none: a circle of hues.
        noise: strength of the noise of all fields and nodes.
    """
    x = axis or colour_axis()
    model = Model("change detection")
    layers = {name: model.add(_layer(name, x, noise)) for name in LOCAL}
    for (a, b), (amplitude, sigma) in COUPLINGS.items():
        through = model.add(Convolve([Gaussian(amplitude, sigma, normalized=True)], name=f"{a} to {b}"))
        layers[a] >> through >> layers[b]
    shown, ask = model.add(Project([x], name="shown")), model.add(Gain(ASK, name="ask"))
    shown >> layers["contrast"]
    shown >> model.add(Gain(DIRECT, name="direct")) >> layers["memory"]
    nodes: list[Handle] = []
    for name, source, strength in (("different", "contrast", DIFFERENT), ("same", "memory", SAME)):
        own, tau = ([Gaussian(HELD)], TAU) if name == "different" else ([], SLOW)
        node = model.add(
            Field(
                name,
                [],
                tau=tau,
                resting_level=UNASKED,
                sigmoid=Logistic(beta=STEEP),
                kernel=own,
                noise=noise,
            )
        )
        (
            layers[source]
            >> model.add(Project([], reduce="max", name=f"any {source}"))
            >> model.add(Gain(strength, name=f"{name} says"))
            >> node
        )
        ask >> node
        nodes.append(node)
    for a, b in (nodes, reversed(nodes)):
        a >> model.add(Gain(AGAINST, name=f"{a.path} against {b.path}")) >> b
    return model


def change_trial(
    sample: Sequence[float] = (40.0, 130.0, 250.0),
    test: Sequence[float] = (40.0, 180.0, 250.0),
    noise: float = 0.3,
) -> Model:
    """The template in a trial: a sample, a pause of a second, and a test, together with the question.

    Args:
        sample: places of what is shown first, deg, at least 50 apart; three are the most that are surely
            held.
        test: places of what is shown then.
        noise: as in `change_detection`.
    """
    model = change_detection(noise=noise)
    model.describe(name="change trial")
    for when, window, places in (("sample", SAMPLE, sample), ("test", TEST, test)):
        for k, place in enumerate(places, 1):
            model.add(_item(f"{when} {k}", place, window)) >> model["shown"]
    model.add(Boost("question", [], amplitude=1.0, windows=[Window(*TEST)])) >> model["ask"]
    return model


def _item(name: str, place: float, window: tuple[float, float]) -> GaussianStimulus:
    return GaussianStimulus(
        name, [colour_axis()], center=place, sigma=WIDTH, amplitude=ITEM, windows=[Window(*window)]
    )


def _layer(name: str, axis: Axis, noise: float) -> Field:
    kernel = [Gaussian(LOCAL[name], WIDTH, normalized=True)] if LOCAL[name] else []
    tau = QUICK if name == "inhibition" else TAU
    return Field(
        name, [axis], tau=tau, resting_level=RESTING, sigmoid=Logistic(beta=STEEP), kernel=kernel, noise=noise
    )
