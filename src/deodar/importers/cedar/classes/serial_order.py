"""The chain of serial order."""

from __future__ import annotations

import numpy as np

from deodar.couplings.axis_weights import AxisWeights
from deodar.couplings.gain import Gain
from deodar.couplings.weights import Weights
from deodar.element import Element
from deodar.elements.boost import Boost
from deodar.elements.field import Field
from deodar.importers.cedar.piece import InputSlot, OutputSlot, SourceStep, StepPiece
from deodar.importers.cedar.sigmoids import sigmoid
from deodar.numerics.axes import Axis
from deodar.numerics.kernels.box import Box
from deodar.numerics.sigmoids.absolute import Absolute


def serial_order(b: SourceStep) -> StepPiece:
    """Translate SerialOrder: a field of ordinal nodes and a field of memory nodes over the positions."""
    values = b.values
    count = values.whole("number of ordinal positions", 3, 1, 10)
    axis = Axis("position", 0, count - 1, count) if count > 1 else Axis("position", 0, 1, 1, periodic=True)
    tau = max(values.time("tau", 100.0), b.dt)
    g = sigmoid(values, "sigmoid", Absolute(100.0, 0.0))
    excitation, inhibition = (
        values.number("ordinal self excitation", 11.0),
        values.number("ordinal global inhibition", -11.0),
    )
    own, others = (
        values.number("memory self excitation", 7.0),
        values.number("memory global inhibition", -2.0),
    )
    later, same = values.number("memory to next ordinal", 5.0), values.number("memory to same ordinal", -5.0)
    up, before = values.number("ordinal to same memory", 7.0), values.number("ordinal to prev memory", -7.0)
    cyclic = values.flag("cyclic", False)
    memory, minus = b.named("memory"), b.named("CoS")
    ordinal_field = Field(
        b.label,
        [axis],
        tau=tau,
        resting_level=values.number("ordinal resting level", -5.0),
        sigmoid=g,
        kernel=[Box(excitation - inhibition, 1.0)],
        global_inhibition=-inhibition,
    )
    # cedar's memory nodes are inhibited by all ordinal nodes and excite themselves by what is left
    memory_field = Field(
        memory,
        [axis],
        tau=tau,
        resting_level=values.number("memory resting level", -2.0),
        sigmoid=g,
        kernel=[Box(own - others, 1.0)],
    )
    shift = np.eye(count, k=-1)
    to_next = later * shift
    first = np.zeros(count)
    back = up * np.eye(count) + others * np.ones((count, count))
    if cyclic:
        to_next[0, -1] += later
        back = back + before * np.roll(np.eye(count), 1, axis=1)
    else:
        first[0] = later
        if "ordinal to prev memory" in values.body:
            values.say("ordinal to prev memory", "carried", "without effect, since the chain is not cyclic")
    names = [b.named(w) for w in ("memory to ordinal", "ordinal to memory", "start")]
    elements: list[Element] = [
        ordinal_field,
        memory_field,
        AxisWeights(to_next + same * np.eye(count), axis, name=names[0]),
        AxisWeights(back, axis, name=names[1]),
        Weights(first, [axis], name=names[2]),
        Boost(b.named("one"), (), 1.0),
        Gain(-1.0, name=minus),
        *(Weights(np.eye(count)[k], (), name=b.named(f"node {k}")) for k in range(count)),
    ]
    nodes = [e.name for e in elements[7:]]
    return StepPiece(
        elements,
        {"CoS signal input": [[InputSlot(minus)]]},
        {f"ordinal node {k} output": OutputSlot(name, ()) for k, name in enumerate(nodes)},
        [
            (memory, names[0]),
            (names[0], b.label),
            (b.label, names[1]),
            (names[1], memory),
            (elements[5].name, names[2]),
            (names[2], b.label),
            (minus, b.label),
            *((b.label, name) for name in nodes),
        ],
        wanted={"CoS signal input": ()},
        verdict="approximated",
        why="Field of ordinal nodes and Field of memory nodes; cedar updates nodes one after another",
    )


CLASSES = {
    "cedar.dynamics.SerialOrder": serial_order,
}
