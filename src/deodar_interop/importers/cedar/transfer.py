"""Transfer functions inside a step: a `Sigmoid`, or an expression where deodar has no such sigmoid."""

from __future__ import annotations

from deodar.couplings.sigmoid import Sigmoid
from deodar.numerics.sigmoids._base import SigmoidFunction
from deodar_interop.importers.cedar.composition import Composition, StepSignal
from deodar_interop.importers.cedar.sigmoids import sigmoid
from deodar_interop.importers.cedar.values import StepValues


def special(values: StepValues, name: str) -> str:
    """Return the type of a transfer function that no sigmoid of deodar equals; "" for others.

    These are the logarithm, constants, and semi-linear functions with a threshold, at which cedar's jump.
    """
    typed = values.object(name)
    if typed is None:
        return ""
    kind, inside = typed[0].rpartition(".")[2], typed[1]
    match kind.replace("Sigmoid", "TransferFunction"):
        case "SemiLinearTransferFunction" if inside.number("threshold", 0.0):
            return "SemiLinear"
        case "LinearTransferFunction" if not inside.number("factor", 1.0) and inside.number("offset", 0.0):
            return "Linear"
        case "Logarithm":
            return "Logarithm"
        case _:
            return ""


def transferred(
    c: Composition, role: str, name: str, default: SigmoidFunction, signal: StepSignal
) -> StepSignal:
    """Add a transfer function of a signal.

    Args:
        c: the step.
        role: name of the element that gives the result, after that of the step.
        name: the parameter.
        default: the function without the parameter.
        signal: its input.
    """
    values = c.b.values
    kind = special(values, name)
    if not kind:
        return c.add(Sigmoid(sigmoid(values, name, default), name=c.named(role)), input=signal)
    inside = values.inside(name)
    inside.say("type")
    of = f"{role} " if role else ""
    if kind == "Logarithm":
        return c.function(role, "log", signal)
    if kind == "Linear":
        offset = c.constant(f"{of}offset", inside.number("offset", 0.0))
        return c.total(role, c.gain(f"{of}nothing", 0.0, signal), offset)
    beta, threshold = inside.number("beta", 1.0), inside.number("threshold", 0.0)
    begun = c.rest(f"{of}begun", c.below(f"{of}below", threshold, signal))
    above = c.product(f"{of}above", c.gain(f"{of}slope", beta, signal), begun)
    return c.total(role, above, c.constant(f"{of}threshold", threshold))
