"""Working memory with change detection: a test array is the same as the sample array or different.

The architecture has three layers over one feature. `contrast` detects new values and `memory` holds them.
`inhibition`, which both excite, inhibits both: around each peak of `memory`, and at the position of each peak
of the memory in `contrast`. A value that the memory holds therefore creates no peak in `contrast` when it is
shown again, and a new value does. While a decision is requested, a peak in `contrast` activates the node
`different`; without one, the memory activates `same`.

References:
    Johnson, Spencer & Schöner (2009), A layered neural architecture for the consolidation, maintenance, and
    updating of representations in visual working memory, Brain Research 1299, 17-32 (three layers with shared
    inhibition). Johnson, Spencer, Luck & Schöner (2009), A dynamic neural field model of visual working
    memory and change detection, Psychological Science 20(5), 568-577 (the decision). All parameters are
    deodar's.
"""

from __future__ import annotations

from collections.abc import Sequence

from deodar.couplings.arithmetic import Gain
from deodar.couplings.convolutions import Convolve
from deodar.couplings.projections import Project
from deodar.elements.field import Field
from deodar.elements.stimuli import Boost, GaussianStimulus
from deodar.model.model import Handle, Model
from deodar.numerics.axes import Axis
from deodar.numerics.kernels.separable import Gaussian
from deodar.numerics.sigmoids import Logistic
from deodar.numerics.windows import Window

TAU, RESTING, STEEP = 20.0, -5.0, 4.0

QUICK, SLOW = 10.0, 60.0
"""Time constants, ms. Inhibition is faster than the excitation that it balances.

The node `same` is slower than a new peak, since the memory excites it from the start.
"""

LOCAL = {"contrast": 4.0, "memory": 16.0, "inhibition": 0.0}
"""Integral of local excitation: peaks in `contrast` are input-driven, those in `memory` self-sustained."""

WIDTH = 8.0
"""Width of local excitation, of all couplings but one, and of the shown items, deg."""

COUPLINGS = {
    ("contrast", "memory"): (6.0, WIDTH),
    ("contrast", "inhibition"): (8.0, WIDTH),
    ("memory", "inhibition"): (10.0, WIDTH),
    ("inhibition", "contrast"): (-10.0, WIDTH),
    ("inhibition", "memory"): (-8.0, 3 * WIDTH),
}
"""Integral and width of the coupling between two layers."""

ITEM = 6.5
"""Strength of a shown item at `contrast`; at `memory` it is a fifth of this."""

DIRECT = 0.2

UNASKED, ASK, DIFFERENT, SAME, AGAINST, HELD = -7.0, 5.0, 4.5, 3.0, -8.0, 4.0
"""Parameters of the decision. Both nodes rest at -7, so neither is active before a decision is requested.

During the request, the memory raises `same` to 1 and a new peak raises `different` to 2.5. The memory soon
holds the new item too; the active node then sustains itself, at 2, until the request ends.
"""

SAMPLE, TEST, LENGTH = (200.0, 700.0), (1700.0, 2300.0), 2600.0
"""Time window of the sample, time window of the test and the request for a decision, length of a trial,
ms.
"""


def colour_axis() -> Axis:
    """Return the default axis: a circle of hues."""
    return Axis("colour", 0.0, 360.0, 120, periodic=True, unit="deg")


def change_detection(axis: Axis | None = None, noise: float = 0.3) -> Model:
    """Create the three layers and the two nodes, to be inserted as a group.

    Connect the shown items to `shown.input` and the request for a decision, a value of 1, to `ask.input`.

    Equation::

        tau du/dt = -u + h + s + k_uu * f(u) + k_uv * f(v)
        tau dw/dt = -w + h + s / 5 + k_ww * f(w) + k_wu * f(u) + k_wv * f(v)
        tau_v dv/dt = -v + h + k_vu * f(u) + k_vw * f(w)

    u is `contrast`, w `memory`, v `inhibition`; k_uv and k_wv are negative.

    Args:
        axis: axis of the remembered feature, in deg; none: a circle of hues.
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
    """Create a trial of `change_detection`: a sample, a pause of one second, a test with the decision.

    Args:
        sample: values of the sample items, deg, at least 50 apart; the memory holds up to three reliably.
        test: values of the test items, deg.
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
