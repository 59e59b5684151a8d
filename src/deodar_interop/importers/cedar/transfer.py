"""Transfer functions inside a step: a `Sigmoid`, or an expression where deodar has no such sigmoid."""

from __future__ import annotations

from deodar.couplings.arithmetic import Sigmoid
from deodar.numerics.sigmoids import SigmoidFunction
from deodar_interop.importers.cedar.composition import SourceStep, StepSignal
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
    s: SourceStep, role: str, name: str, default: SigmoidFunction, signal: StepSignal
) -> StepSignal:
    """Add a transfer function of a signal.

    Args:
        s: the step.
        role: name of the element that gives the result, after that of the step.
        name: the parameter.
        default: the function without the parameter.
        signal: its input.
    """
    kind = special(s.values, name)
    if not kind:
        return s.add(Sigmoid(sigmoid(s.values, name, default), name=s.named(role)), input=signal)
    inside = s.values.inside(name)
    inside.say("type")
    of = f"{role} " if role else ""
    if kind == "Logarithm":
        return s.function(role, "log", signal)
    if kind == "Linear":
        offset = s.constant(f"{of}offset", inside.number("offset", 0.0))
        return s.total(role, s.gain(f"{of}nothing", 0.0, signal), offset)
    beta, threshold = inside.number("beta", 1.0), inside.number("threshold", 0.0)
    begun = s.rest(f"{of}begun", s.below(f"{of}below", threshold, signal))
    above = s.product(f"{of}above", s.gain(f"{of}slope", beta, signal), begun)
    return s.total(role, above, s.constant(f"{of}threshold", threshold))
