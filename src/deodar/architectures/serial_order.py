"""Serial order: a chain of ordinal nodes that learns a sequence of actions from a demonstration and produces
it again.

Each position in the sequence has two nodes: an ordinal node that is active during its action, and a memory
node that is active until the next ordinal node is. Weights from each ordinal node to an action field learn
the action of that node. An action ends when the field of the condition of satisfaction detects its predicted
outcome. The peak of that field switches all ordinal nodes off, and the memory node activates the next one.

Several sequences share one chain when each has weights of its own from the ordinal nodes to the action field,
which a cue node opens (`serial_order(cues=2)`). The order of the positions does not depend on the cue.

`serial_order` creates the chain; `lesson` adds a demonstration and then the perceived outcomes during
production, both as timed stimuli, so that it runs without a world.

Reference:
    Sandamirskaya & Schöner (2010), An embodied account of serial order, Neural Networks 23(10), sections 4.1
    to 4.4, eqs. 4 to 8, table B.1. Deviations from the table are stated below.
"""

from __future__ import annotations

from collections.abc import Sequence

from deodar.couplings.arithmetic import Gain, Product, Sum
from deodar.couplings.learning import AdaptiveWeights
from deodar.couplings.projections import Project
from deodar.elements.field import Field
from deodar.elements.stimuli import Boost, GaussianStimulus
from deodar.errors import ParameterError
from deodar.model.model import Handle, Model
from deodar.numerics.axes import Axis
from deodar.numerics.kernels.separable import Gaussian
from deodar.numerics.sigmoids import Logistic
from deodar.numerics.windows import Window
from deodar.parameters import show

TAU, STEEP = 10.0, 100.0
"""Time constant of all nodes and fields, ms, and beta of all sigmoids (table B.1)."""

QUADRATURE = "point"
"""Quadrature of all fields: the strengths count active samples of a grid in steps of 1.

With `cell` the model produces the same sequences.
"""

LEARN = 1 / 20.0
"""Speed of learning, 1/ms: tau_l is 20 ms (table B.1)."""

RESTING = {"node": -0.5, "memory": -2.0, "action": -1.8, "satisfaction": -2.0, "cue nodes": -1.5}
"""Resting levels.

Table B.1 prints -5 for ordinal nodes: too low for c2, as no next node could become active. The cue nodes are
deodar's.
"""

STRENGTHS = {
    "c0 self-excitation": 7.2,
    "c1 other nodes": -3.6,
    "c2 next": 0.9,
    "c3 own memory": -0.8,
    "c4 self-excitation of memory": 3.5,
    "c5 other nodes to memory": -2.0,
    "c6 to memory": 2.6,
}
"""Document parameters, shared by all pairs, numbered as in eqs. 4 and 5, with their sign."""

EXCITATION, WIDTH, INHIBITION = 0.9, 3.0, 0.5
"""Kernel of action and satisfaction, for an axis in steps of 1.

The table prints 5.0 for the inhibition, with which no peak can exist.
"""

READ, BOOST, PREDICT, OFF = 10.0, 0.5, 1.2, -3.0
"""c_ord; the homogeneous boost (c_ord in the table, with which the whole field would be above threshold); c_A
(1.5 in the table); c_CoS of each sample of the field above threshold (15 in the table).

An active node is at 6.7, so that with 15 a single noisy sample above threshold switches it off within 6 ms,
and the sample may vanish before the peak of the action field does. With 3 it takes two samples; a peak has
five or six.
"""

SHOWN, SEEN = 2.0, 0.95
"""Strengths of the input of the action field during the demonstration (c_vis), and of the satisfaction field
(c_vis^C, slightly below the table's 1).
"""

CUE = 2.0, 0.5
"""Strength and width of the input of the cue nodes (ours): the node of the cue gets 2, one beside it 0.27; at
1.5, between two cues, no node is active.
"""

START, CLEAR = 3.8, -20.0
"""Strengths of the pulse that activates the first node, and of the inhibition of all nodes and fields between
learning and production.

Both are deodar's; the paper does not mention them.
"""

SHOW, DEMONSTRATION, LOOK = 1000.0, 1000.0, 400.0
"""Time of the first demonstrated action, interval between demonstrated actions, and interval between
perceived positions during production, ms.
"""

MOST = 50
"""Longest chain (a guess: longer lists are not learned from one demonstration)."""


def action_axis() -> Axis:
    """Return the default axis of actions: a circle in steps of 1."""
    return Axis("action", 0.0, 60.0, 60, periodic=True)


def ordinal_pair(axis: Axis, noise: float = 0.22, cues: int = 1) -> Model:
    """Create one position of a sequence, to be inserted as a group: ordinal node, memory node, and the
    weights to the action field.

    Equation::

        tau dd/dt = -d + h_d + c0 f(d) + c1 others + c3 f(m) + what arrives
        tau dm/dt = -m + h_m + c4 f(m) + c5 others + c6 f(d)
        tau_l dM(x)/dt = gate (f(U_A(x)) - M(x)) f(d)

    `others` is the sum of all other ordinal nodes: the sum of all nodes, which arrives at `others.input`,
    minus this one. U_A arrives at `meaning.post`; `meaning.output` is f(d) M(x).

    With more than one cue each cue k has its own weights M_k, and f(d) f(c_k) is in the place of f(d), both
    where they learn and where they are read; the output f(c) of the cue nodes arrives at `cued.input`.

    Args:
        axis: axis of the actions.
        noise: strength of the noise of both nodes; 0.22 is a standard deviation of 0.05 at rest.
        cues: number of cues.

    Reference:
        Sandamirskaya & Schöner (2010), eqs. 4, 5 and 7.
    """
    model = Model("ordinal pair")
    for name, value in STRENGTHS.items():
        model.parameter(name, value)
    node = model.add(_field("node", [], [Gaussian(STRENGTHS["c0 self-excitation"])], noise))
    memory = model.add(_field("memory", [], [Gaussian(STRENGTHS["c4 self-excitation of memory"])], noise))
    model.link("node.kernel.0.amplitude", "c0 self-excitation")
    model.link("memory.kernel.0.amplitude", "c4 self-excitation of memory")
    others = model.add(Sum(name="others"))
    node >> model.add(Gain(-1.0, name="less the own")) >> others
    _couple(model, others, node, "c1 other nodes")
    _couple(model, memory, node, "c3 own memory")
    _couple(model, others, memory, "c5 other nodes to memory")
    _couple(model, node, memory, "c6 to memory")
    source = node
    if cues > 1:
        source = model.add(Product(name="cued"))
        model.connect(node, "cued.factor")
    source >> model.add(AdaptiveWeights([axis], rate=LEARN, gated=True, name="meaning"))
    return model


def serial_order(items: int = 5, axis: Axis | None = None, noise: float = 0.22, cues: int = 1) -> Model:
    """Create the chain: pairs `item 1`, `item 2`, ..., the fields `action` and `satisfaction`.

    Connect demonstrated actions to `action` and perceived outcomes to `satisfaction`. `learning` and
    `producing` are the modes: the weights learn during the first and are read during the second (in the paper
    they are always read, so that an error of learning would sustain itself). `start` is a pulse at the first
    node, `clear` inhibits all nodes and fields; the weights keep their values.

    With more than one cue the chain holds as many sequences. The document parameter `cue`, from 1 on,
    activates one of the `cue nodes`; only the weights of this cue learn and are read::

        tau_l dM_ik(x)/dt = gate (f(U_A(x)) - M_ik(x)) f(d_i) f(c_k)
        action field: + c_ord sum_i f(d_i) sum_k f(c_k) M_ik(x)

    The cue enters only these two equations (7 and 6), so a new cue leaves the ordinal nodes as they are: the
    order continues at the present position, with the action of the other sequence. A cue of 0 activates no
    node; then nothing is learned, and no action is recalled.

    Args:
        items: number of positions, 1 to 50. A sequence may be shorter.
        axis: axis of the actions and of their perceived outcomes, in steps of 1; none: a circle of 60.
        noise: strength of the noise of all nodes, and of the fields at each of their samples.
        cues: number of sequences that the chain holds, 1 to 50; with 1 it has no cue nodes.

    Reference:
        Sandamirskaya & Schöner (2010), eqs. 4 to 8; the cue nodes are deodar's.
    """
    if isinstance(items, bool) or not isinstance(items, int) or not 1 <= items <= MOST:
        raise ParameterError(
            f"a chain has 1 to {MOST} items, not {show(items)}", fix="For example serial_order(5)"
        )
    if isinstance(cues, bool) or not isinstance(cues, int) or not 1 <= cues <= MOST:
        raise ParameterError(
            f"a chain has 1 to {MOST} cues, not {show(cues)}", fix="For example serial_order(5, cues=2)"
        )
    x = axis or action_axis()
    model = Model("serial order", dt=2.0)
    model.parameter("c2 next", STRENGTHS["c2 next"])
    kernel = [Gaussian(EXCITATION, WIDTH)]
    action, satisfaction = (
        model.add(_field(name, [x], kernel, noise, INHIBITION)) for name in ("action", "satisfaction")
    )
    learning, producing = (model.add(Boost(name, [], amplitude=1.0)) for name in ("learning", "producing"))
    start = model.add(Boost("start", [], amplitude=START, windows=[Window(300.0, 400.0)]))
    clear = model.add(Boost("clear", [], amplitude=0.0))
    nodes, meant = model.add(Sum(name="all nodes")), model.add(Sum(name="all meanings"))
    off = model.add(Gain(OFF, name="off"))
    for k in range(1, items + 1):
        group = f"item {k}"
        model.insert(ordinal_pair(x, noise, cues), group)
        node, memory, meaning = (model[f"{group}.{name}"] for name in ("node", "memory", "meaning"))
        node >> nodes
        nodes >> model[f"{group}.others"]
        meaning >> meant
        model.connect(action, f"{group}.meaning.post")
        model.connect(learning, f"{group}.meaning.gate")
        for target in (node, memory):
            clear >> target
        off >> node
        if k == 1:
            start >> node
        else:
            _couple(model, model[f"item {k - 1}.memory"], node, "c2 next", group)
    read = model.add(Product(name="read"))
    meant >> read
    model.connect(producing, "read.factor")
    read >> model.add(Gain(READ, name="c_ord")) >> action
    nodes >> model.add(Gain(BOOST, name="boost")) >> action
    action >> model.add(Gain(PREDICT, name="predict")) >> satisfaction
    satisfaction >> model.add(Project([], name="satisfied")) >> off
    for field in (action, satisfaction):
        clear >> field
    if cues > 1:
        _cue(model, items, cues, noise)
    return model


def _cue(model: Model, items: int, cues: int, noise: float) -> None:
    """Create the cue nodes, of which the document parameter `cue` activates one."""
    numbers = Axis("cue", 1.0, float(cues), cues)
    amplitude, sigma = CUE
    given = model.add(GaussianStimulus("cue input", [numbers], center=1.0, sigma=sigma, amplitude=amplitude))
    model.parameter("cue", 1.0)
    model.link("cue input.center", "cue")
    nodes = model.add(_field("cue nodes", [numbers], [], noise))
    given >> nodes
    for k in range(1, items + 1):
        model.connect(nodes, f"item {k}.cued.input")


def lesson(
    sequence: Sequence[float],
    seen: Sequence[float] = (),
    items: int | None = None,
    axis: Axis | None = None,
    noise: float = 0.22,
) -> Model:
    """Create the chain with a demonstration and the perceived outcomes during production, as timed stimuli.

    First each action of the sequence is shown for 0.6 s, and its outcome towards the end of that time; each
    action takes one second. Then all activation is cleared, and the first node is started. From then on
    the positions in `seen` are perceived one after another, repeatedly, each for 0.2 s with a pause of 0.2 s:
    an action ends only when its position is perceived.

    Args:
        sequence: positions of the actions on the axis, in their order; repeats are allowed.
        seen: positions that are perceived during production, in this order; none: those of the sequence, each
            once, in increasing order.
        items: positions of the chain; none: the length of the sequence. In a longer chain, the node after the
            last action becomes active without an action.
        axis: as in `serial_order`.
        noise: as in `serial_order`.
    """
    x = axis or action_axis()
    if items is not None and items < len(sequence):
        raise ParameterError(
            f"a chain of {items} items cannot hold a sequence of {len(sequence)}",
            fix=f"Give items={len(sequence)}, or none",
        )
    model = serial_order(len(sequence) if items is None else items, x, noise)
    model.describe(name="lesson")
    begins = [SHOW + DEMONSTRATION * k for k in range(len(sequence))]
    for k, (place, t) in enumerate(zip(sequence, begins, strict=True), 1):
        for name, amplitude, first in (("shown", SHOWN, 0.0), ("end", SEEN, 400.0)):
            stimulus = GaussianStimulus(
                f"{name} {k}",
                [x],
                center=place,
                sigma=WIDTH,
                amplitude=amplitude,
                windows=[Window(t + first, t + 600.0)],
            )
            model.add(stimulus) >> model["action" if name == "shown" else "satisfaction"]
    learned = production_start(len(sequence))
    model.set("learning.windows", [Window(0.0, learned)])
    model.set("producing.windows", [Window(learned)])
    model.set("clear.amplitude", CLEAR)
    model.set("clear.windows", [Window(learned, learned + 200.0)])
    model.set("start.windows", [Window(300.0, 400.0), Window(learned + 300.0, learned + 400.0)])
    places = list(seen) or sorted(set(sequence))
    for k, place in enumerate(places, 1):
        times = [learned + 1000.0 + LOOK * (k - 1 + len(places) * n) for n in range(len(sequence))]
        windows = [Window(t, t + LOOK / 2) for t in times]
        (
            model.add(
                GaussianStimulus(f"seen {k}", [x], center=place, sigma=WIDTH, amplitude=SEEN, windows=windows)
            )
            >> model["satisfaction"]
        )
    return model


def production_start(items: int) -> float:
    """Return the time at which production begins in a lesson of `items` items, ms."""
    return SHOW + DEMONSTRATION * items


def lesson_end(items: int, places: int) -> float:
    """Return the time at which a lesson ends: after the last position and the transition that follows, ms."""
    return production_start(items) + 1000.0 + LOOK * items * places + 400.0


def _couple(model: Model, source: Handle, target: Handle, strength: str, group: str = "") -> None:
    """Add a connection whose strength is a document parameter."""
    through = model.add(Gain(STRENGTHS[strength], name=strength.split(" ", 1)[1]), group=group)
    model.link(f"{through.path}.factor", strength)
    source >> through >> target


def _field(
    name: str, axes: Sequence[Axis], kernel: Sequence[Gaussian], noise: float, inhibition: float = 0.0
) -> Field:
    rest, steep = RESTING[name], Logistic(beta=STEEP)
    return Field(
        name,
        axes,
        tau=TAU,
        resting_level=rest,
        sigmoid=steep,
        kernel=kernel,
        global_inhibition=inhibition,
        noise=noise,
        quadrature=QUADRATURE,
    )
