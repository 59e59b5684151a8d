"""Elementary behaviours and their order: intention, condition of satisfaction, precondition, suppression,
competition.

A behaviour begins with its task and ends when its condition of satisfaction is met. Nodes between behaviours
decide which of them may be active: a precondition inhibits one behaviour until another is satisfied,
suppression interrupts one while another is active, competition selects one of two.

References:
    Sandamirskaya (2014), Front. Neurosci. 7:276, section 2.5 and eq. 10 (intention and condition of
    satisfaction). Richter, Sandamirskaya & Schöner (2012), A robotic architecture for action selection and
    behavioral organization inspired by human cognition, IROS (the nodes between behaviours). The strengths
    are deodar's, derived in the comments beside them.
"""

from __future__ import annotations

from collections.abc import Sequence

from deodar.couplings.arithmetic import Gain
from deodar.couplings.projections import Project
from deodar.elements.field import Field
from deodar.elements.stimuli import Boost, GaussianStimulus
from deodar.model.model import Handle, Model
from deodar.numerics.axes import Axis
from deodar.numerics.kernels.separable import Gaussian
from deodar.numerics.sigmoids import Logistic
from deodar.numerics.windows import Window

TAU, STEEP = 20.0, 8.0
QUICK = 10.0
"""Time constant of tasks and of the nodes that inhibit intentions, ms: they must be active before an
intention is.
"""

NODES = {"task": (-1.0, 0.0), "intention": (-2.0, 2.0), "satisfaction": (-6.0, 4.5)}
"""Resting level and self-excitation.

Any two of task, intention and signal leave `satisfaction` at -1 or below; all three raise it to 1, and its
self-excitation then to 5.5. Task and self-excitation alone keep it at 1.5; without the task it falls to -1.5.
"""

STRENGTHS = {
    "task to intention": 3.0,
    "task to satisfaction": 3.0,
    "intention to satisfaction": 2.0,
    "satisfaction to intention": -6.0,
}
"""Document parameters, shared by all behaviours of a model."""

HOLD = -6.0
"""Strength of each inhibition of an intention: more than task and self-excitation together."""

SIGNAL = 2.0
"""Strength of the signal at `satisfaction` while the goal is reached."""

ON = 2.0
"""Strength of the input that activates a task."""

PREDICT, LIFT = 3.0, 3.0
"""Strengths from the field `goal` to the field `outcome`, and from a node to its field."""

LOCAL, WIDTH = 6.0, 4.0
"""Integral and width of the fields' local excitation; the width in units of the axes."""


def behaviour(axes: Sequence[Axis] = (), noise: float = 0.3) -> Model:
    """Create one behaviour, to be inserted as a group: the nodes `task`, `intention` and `satisfaction`.

    With axes, intention and satisfaction also have a field each.

    Equation::

        tau du_int/dt = -u_int + h + w f(u_int) + 3 f(task) - 6 f(u_CoS)
        tau du_CoS/dt = -u_CoS + h + w f(u_CoS) + 3 f(task) + 2 f(u_int) + signal

    The signal (2 while the goal is reached) arrives at `satisfaction`. With axes the behaviour has a second
    layer. A peak of `goal`, which the intention boosts, represents the intended value; it pre-shapes the
    expected value in `outcome`. A peak in `outcome`, where perception matches the expectation, is the signal.
    Connect the intended value to `goal` and the perceived value to `outcome`, each with a strength of about
    3.

    Args:
        axes: axes of the intended and perceived values; none: nodes only.
        noise: strength of the noise of each node, and of each field at its samples.

    Reference:
        Sandamirskaya (2014), eq. 10. There the field of satisfaction inhibits the field of the intention;
        here its node inhibits the node of the intention, and remains active as long as the task.
    """
    model = Model("elementary behaviour")
    for name, value in STRENGTHS.items():
        model.parameter(name, value)
    task, intention, satisfaction = (
        model.add(_node(name, *NODES[name], QUICK if name == "task" else TAU, noise)) for name in NODES
    )
    for source, target in (
        (task, intention),
        (task, satisfaction),
        (intention, satisfaction),
        (satisfaction, intention),
    ):
        strength = f"{source.path} to {target.path}"
        through = source >> model.add(Gain(STRENGTHS[strength], name=f"{source.path} > {target.path}"))
        model.link(f"{through.path}.factor", strength)
        through >> target
    if axes:
        goal, outcome = (model.add(_field(name, axes, noise)) for name in ("goal", "outcome"))
        intention >> model.add(Gain(LIFT, name="lift")) >> goal
        goal >> model.add(Gain(PREDICT, name="predict")) >> outcome
        (
            outcome
            >> model.add(Project([], reduce="max", name="match"))
            >> model.add(Gain(SIGNAL, name="signal"))
            >> satisfaction
        )
        satisfaction >> model.add(Gain(HOLD, name="end")) >> goal
    return model


def precondition(model: Model, first: str, then: str) -> Handle:
    """Add a node that inhibits one behaviour until another is satisfied.

    The task of `then` activates the node, the satisfaction of `first` inhibits it.

    Args:
        model: the model, with both behaviours inserted as groups.
        first: group of the behaviour that must be satisfied first.
        then: group of the behaviour that waits.

    Returns:
        The node `first before then`.
    """
    node = model.add(_node(f"{first} before {then}", -0.5, 0.0, QUICK, 0.0))
    model[f"{then}.task"] >> Gain(ON) >> node
    model[f"{first}.satisfaction"] >> Gain(HOLD) >> node
    node >> Gain(HOLD) >> model[f"{then}.intention"]
    return node


def suppression(model: Model, by: str, of: str) -> Handle:
    """Add a node that interrupts one behaviour while another is active.

    The intention of `by` activates the node, which inhibits the intention of `of`.

    Args:
        model: the model, with both behaviours inserted as groups.
        by: group of the behaviour that interrupts.
        of: group of the behaviour that is interrupted; it continues when the other has ended.

    Returns:
        The node `by suppresses of`.
    """
    node = model.add(_node(f"{by} suppresses {of}", -1.0, 0.0, QUICK, 0.0))
    model[f"{by}.intention"] >> Gain(ON) >> node
    node >> Gain(HOLD) >> model[f"{of}.intention"]
    return node


def competition(model: Model, one: str, other: str) -> None:
    """Let two behaviours compete, so that only one is active at a time: their intentions inhibit each other.

    The behaviour that begins first is selected; if both begin at the same time, noise decides.

    The inhibition is direct: with a node between them, the delay would switch both off and on again before
    one is selected.

    Args:
        model: the model, with both behaviours inserted as groups.
        one: group of the first behaviour.
        other: group of the second behaviour.
    """
    for a, b in ((one, other), (other, one)):
        model[f"{a}.intention"] >> model.add(Gain(HOLD, name=f"{a} against {b}")) >> model[f"{b}.intention"]


def behaviours(noise: float = 0.3) -> Model:
    """Create a model with five behaviours: `find` before `reach`, `avoid`, which interrupts `reach`, and
    `look left` or `look right`.
    """
    x = Axis("x", 0.0, 100.0, 101, unit="cm")
    model = Model("behaviours")
    for name in ("find", "avoid", "look left", "look right"):
        model.insert(behaviour(noise=noise), name)
    model.insert(behaviour([x], noise), "reach")
    precondition(model, "find", "reach")
    suppression(model, "avoid", "reach")
    competition(model, "look left", "look right")
    task = model.add(Boost("task", [], amplitude=ON, windows=[Window(100.0, 2100.0)]))
    for name in ("find", "reach", "look left", "look right"):
        task >> model[f"{name}.task"]
    model.add(Boost("obstacle", [], amplitude=ON, windows=[Window(900.0, 1200.0)])) >> model["avoid.task"]
    (
        model.add(Boost("found", [], amplitude=SIGNAL, windows=[Window(500.0, 600.0)]))
        >> model["find.satisfaction"]
    )
    seen = model.add(
        Boost("seen", [], amplitude=SIGNAL, windows=[Window(700.0, 760.0), Window(1400.0, 1460.0)])
    )
    for side in ("left", "right"):
        seen >> model[f"look {side}.satisfaction"]
    model.add(GaussianStimulus("target", [x], center=70.0, sigma=WIDTH, amplitude=3.0)) >> model["reach.goal"]
    for name, place, window in (
        ("hand at rest", 30.0, Window(0.0, 1600.0)),
        ("hand there", 70.0, Window(1600.0)),
    ):
        (
            model.add(GaussianStimulus(name, [x], center=place, sigma=WIDTH, amplitude=3.0, windows=[window]))
            >> model["reach.outcome"]
        )
    return model


def _node(name: str, resting: float, own: float, tau: float, noise: float) -> Field:
    return Field(
        name,
        [],
        tau=tau,
        resting_level=resting,
        sigmoid=Logistic(beta=STEEP),
        kernel=[Gaussian(own)] if own else [],
        noise=noise,
    )


def _field(name: str, axes: Sequence[Axis], noise: float) -> Field:
    kernel = [Gaussian(LOCAL, WIDTH, normalized=True)]
    return Field(
        name,
        axes,
        tau=TAU,
        resting_level=-5.0,
        sigmoid=Logistic(beta=4.0),
        kernel=kernel,
        global_inhibition=0.1,
        noise=noise,
    )
