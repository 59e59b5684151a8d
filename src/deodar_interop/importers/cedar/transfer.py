"""Transfer functions of cedar: a sigmoid, or an expression where deodar has no such sigmoid."""

from __future__ import annotations

from deodar.couplings.arithmetic import Sigmoid
from deodar.numerics.sigmoids import Absolute, Linear, Logistic, SemiLinear, SigmoidFunction, Step
from deodar_interop.importers.cedar.composition import SourceStep, StepSignal
from deodar_interop.importers.cedar.values import StepValues

STEEPEST = 1e6
FLATTEST = 1e-6


def sigmoid(values: StepValues, name: str, default: SigmoidFunction) -> SigmoidFunction:
    """Return the transfer function of a parameter.

    An object without a type has the type of the default, as files of early versions have it.
    """
    typed = values.object(name)
    if typed is None:
        return default
    kind, inside = typed
    if "type" in inside.body:
        inside.say("type")
    match kind.rpartition(".")[2] or type(default).__name__:
        case "AbsSigmoid" | "Absolute":
            return Absolute(_beta(inside), inside.number("threshold", _threshold(default)))
        case "ExpSigmoid" | "Logistic":
            return Logistic(_beta(inside), inside.number("threshold", _threshold(default)))
        case "HeavisideSigmoid" | "Step":
            return Step(inside.number("threshold", _threshold(default)))
        case "LinearTransferFunction" | "LinearSigmoid" | "Linear":
            return _linear(inside)
        case "SemiLinearTransferFunction" | "SemiLinearSigmoid":
            return _semilinear(inside)
        case unknown:
            values.say(name, "approximated", f"deodar has no {unknown} here; {default} is used")
            return default


def _beta(values: StepValues) -> float:
    return values.number("beta", 100.0, FLATTEST, STEEPEST)


def _threshold(default: SigmoidFunction) -> float:
    return float(getattr(default, "threshold", 0.0))


def _linear(values: StepValues) -> SigmoidFunction:
    factor, offset = values.number("factor", 1.0), values.number("offset", 0.0)
    if factor == 0 and offset:
        values.say("offset", "dropped", "the factor is 0, and deodar's linear function has no constant")
        return Linear(0.0)
    return Linear(factor, -offset / factor if factor else 0.0)


def _semilinear(values: StepValues) -> SigmoidFunction:
    beta, threshold = values.number("beta", 1.0, 0.0), values.number("threshold", 0.0)
    if threshold:
        # cedar gives theta + beta x from theta on, and theta below
        values.say(
            "threshold",
            "approximated",
            "deodar's function begins at 0; cedar's has the value of the threshold below it, and jumps there",
        )
    return SemiLinear(beta, threshold)


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
