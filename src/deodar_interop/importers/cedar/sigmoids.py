"""Transfer functions of cedar."""

from __future__ import annotations

from deodar.numerics.sigmoids import Absolute, Linear, Logistic, SemiLinear, SigmoidFunction, Step
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
