"""SerialOrder: a chain of ordinal nodes, each with a memory node."""

from __future__ import annotations

from deodar.elements.field import Field
from deodar.numerics.sigmoids.absolute import Absolute
from deodar_interop.importers.cedar.composition import Composition, StepSignal
from deodar_interop.importers.cedar.piece import SourceStep, StepPiece
from deodar_interop.importers.cedar.sigmoids import sigmoid


def serial_order(b: SourceStep) -> StepPiece:
    """Translate SerialOrder: ordinal and memory nodes, which cedar updates in turn.

    An ordinal node reads the new memory node before it in the chain, and the memory node its new ordinal
    node. Memory nodes are inhibited by all ordinal nodes, and excite themselves by what is left of that.
    """
    values, count = b.values, b.values.whole("number of ordinal positions", 3, 1, 10)
    tau = max(values.time("tau", 100.0), b.dt)
    g = sigmoid(values, "sigmoid", Absolute(100.0, 0.0))
    excitation, inhibition = (
        values.number("ordinal self excitation", 11.0),
        values.number("ordinal global inhibition", -11.0),
    )
    memory_excitation, others = (
        values.number("memory self excitation", 7.0),
        values.number("memory global inhibition", -2.0),
    )
    later, same = values.number("memory to next ordinal", 5.0), values.number("memory to same ordinal", -5.0)
    up, back = values.number("ordinal to same memory", 7.0), values.number("ordinal to prev memory", -7.0)
    resting_levels = values.number("ordinal resting level", -5.0), values.number("memory resting level", -2.0)
    cyclic = values.flag("cyclic", False)
    if not cyclic and "ordinal to prev memory" in values.body:
        values.say("ordinal to prev memory", "carried", "without effect, since the chain is not cyclic")
    c = Composition(b)
    ordinal, memory = (
        [
            c.add(
                Field(
                    b.named(f"{role} {k}"), (), tau=tau, resting_level=level, sigmoid=g, kernel=[], noise=0.0
                )
            )
            for k in range(count)
        ]
        for role, level in zip(("node", "memory"), resting_levels, strict=True)
    )
    total = c.total("", *ordinal)
    of_all, of_memory = c.gain("inhibition", inhibition, total), c.gain("memory inhibition", others, total)
    common = [of_all]
    if "CoS signal input" in b.ins:
        common.append(c.gain("minus CoS", -1.0, c.slot("CoS signal input", (), optional=True)))
    for k in range(count):
        node, kept_node = ordinal[k].name, memory[k].name
        parts = [
            *common,
            c.gain(f"node {k} to itself", excitation - inhibition, ordinal[k]),
            c.gain(f"memory {k} to node", same, memory[k]),
        ]
        if k or cyclic:
            before = StepSignal(memory[k - 1].name, reads="current" if k else "")
            parts.append(c.gain(f"memory to node {k}", later, before))
        else:
            parts.append(c.constant("start", later))
        for part in parts:
            c.connect(part, node)
        parts = [
            of_memory,
            c.gain(f"memory {k} to itself", memory_excitation - others, memory[k]),
            c.gain(f"node {k} to memory", up, StepSignal(node, reads="current")),
        ]
        if cyclic:
            after = StepSignal(ordinal[(k + 1) % count].name, reads="current" if k == count - 1 else "")
            parts.append(c.gain(f"node to memory {k}", back, after))
        for part in parts:
            c.connect(part, kept_node)
        # what cedar gives is 0 until its first step
        node_output = c.total(f"output {k}", StepSignal(node, reads="current"))
        c.outlet(f"ordinal node {k} output", node_output, ())
    why = "Field for each node; that all nodes are inhibited by the outputs before the step is a guess"
    return c.done(why, "approximated")


CLASSES = {"cedar.dynamics.SerialOrder": serial_order}

DECLARED = frozenset(CLASSES)

LOOPED = frozenset({"cedar.dynamics.SerialOrder"})
