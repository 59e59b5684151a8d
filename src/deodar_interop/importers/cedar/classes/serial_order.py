"""SerialOrder: a chain of ordinal nodes, each with a memory node."""

from __future__ import annotations

from deodar.elements.field import Field
from deodar.numerics.sigmoids import Absolute
from deodar_interop.importers.cedar.composition import SourceStep, step
from deodar_interop.importers.cedar.transfer import sigmoid


@step("cedar.dynamics.SerialOrder", sized=True, looped=True)
def serial_order(s: SourceStep) -> None:
    """Translate SerialOrder: ordinal and memory nodes, which cedar updates in turn.

    An ordinal node reads the new memory node before it in the chain, and the memory node its new ordinal
    node. Memory nodes are inhibited by all ordinal nodes, and excite themselves by what is left of that.
    """
    values, count = s.values, s.values.whole("number of ordinal positions", 3, 1, 10)
    tau = max(values.time("tau", 100.0), s.dt)
    g = sigmoid(values, "sigmoid", Absolute(100.0, 0.0))
    excitation = values.number("ordinal self excitation", 11.0)
    inhibition = values.number("ordinal global inhibition", -11.0)
    memory_excitation = values.number("memory self excitation", 7.0)
    others = values.number("memory global inhibition", -2.0)
    later, same = values.number("memory to next ordinal", 5.0), values.number("memory to same ordinal", -5.0)
    up, back = values.number("ordinal to same memory", 7.0), values.number("ordinal to prev memory", -7.0)
    resting_levels = values.number("ordinal resting level", -5.0), values.number("memory resting level", -2.0)
    cyclic = values.flag("cyclic", False)
    if not cyclic and "ordinal to prev memory" in values.body:
        values.say("ordinal to prev memory", "carried", "without effect, since the chain is not cyclic")
    why = "Field for each node; that all nodes are inhibited by the outputs before the step is a guess"
    s.explain(why, "approximated")
    ordinal, memory = (
        [
            s.add(
                Field(
                    s.named(f"{role} {k}"), (), tau=tau, resting_level=level, sigmoid=g, kernel=[], noise=0.0
                )
            )
            for k in range(count)
        ]
        for role, level in zip(("node", "memory"), resting_levels, strict=True)
    )
    total = s.total("", *ordinal)
    common = [s.gain("inhibition", inhibition, total)]
    of_memory = s.gain("memory inhibition", others, total)
    done = s.optional("CoS signal input", ())
    if done is not None:
        common.append(s.gain("minus CoS", -1.0, done))
    for k, (node, kept_node) in enumerate(zip(ordinal, memory, strict=True)):
        parts = [
            *common,
            s.gain(f"node {k} to itself", excitation - inhibition, node),
            s.gain(f"memory {k} to node", same, kept_node),
        ]
        if k or cyclic:
            parts.append(s.gain(f"memory to node {k}", later, memory[k - 1].updated if k else memory[-1]))
        else:
            parts.append(s.constant("start", later))
        for part in parts:
            s.connect(part, node)
        parts = [
            of_memory,
            s.gain(f"memory {k} to itself", memory_excitation - others, kept_node),
            s.gain(f"node {k} to memory", up, node.updated),
        ]
        if cyclic:
            after = ordinal[0].updated if k == count - 1 else ordinal[k + 1]
            parts.append(s.gain(f"node to memory {k}", back, after))
        for part in parts:
            s.connect(part, kept_node)
        # what cedar gives is 0 until its first step
        s.outlet(f"ordinal node {k} output", s.total(f"output {k}", node.updated))
