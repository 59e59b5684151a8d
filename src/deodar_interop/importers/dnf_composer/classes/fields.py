"""Fields and memory traces."""

from __future__ import annotations

import math
from typing import Any, cast

from deodar.elements.field import Field
from deodar.elements.memories import MemoryTrace
from deodar.elements.stimuli import Boost
from deodar.model.paths import display
from deodar.numerics.sigmoids import Absolute, Logistic, SigmoidFunction, Step
from deodar_interop.importers._element import translates
from deodar_interop.importers._piece import axes
from deodar_interop.importers.dnf_composer.element import StoredElement
from deodar_interop.importers.dnf_composer.file import number

STEEPEST, FLATTEST = 1e6, 1e-6

STEEPNESS = 10.0
"""Steepness of the sigmoid of a field whose file states none."""

FUNCTIONS = {
    "sigmoid": ("x_shift", "steepness"),
    "heaviside": ("x_shift",),
    "abs_sigmoid": ("x_shift", "beta"),
}
"""The parameters of each activation function."""

USUAL = {"x_shift": 0.0, "steepness": STEEPNESS, "beta": 100.0}


@translates("neural field", "neural field 2d")
def neural_field(b: StoredElement) -> None:
    """Translate `neural field` and its form over a plane; kernels and noise remain separate elements."""
    dims = b.dims()
    field = Field(
        b.label,
        axes(dims),
        tau=_tau(b, "tau", 25),
        resting_level=b.values.number("restingLevel", -5),
        sigmoid=activation(b),
    )
    b.start = float(_at_rest(field.sigmoid, field.resting_level))
    b.levels = {"activation": field.resting_level, "resting level": field.resting_level}
    signal = b.add(field, input=b.input(dims, whole=False, needed=False, sums=True))
    for component in ("output", "activation"):
        b.outlet(component, signal.at(component), state=True)
    if "resting level" in b.components_read:
        level = Boost(b.named("resting level"), axes(dims), field.resting_level)
        b.outlet("resting level", b.add(level, dims), still=True)
    b.piece.elsewhere = {"resting level": f"the parameter {display((b.label, 'resting_level'))}"}


def activation(b: StoredElement) -> SigmoidFunction:
    """Return the activation function; without a known one dnf-composer takes a sigmoid."""
    key = "activationFunction"
    stated = b.element.values.get(key)
    body = cast("dict[str, Any]", stated) if isinstance(stated, dict) else {}
    kind = body.get("type")
    if not isinstance(kind, str) or kind not in FUNCTIONS:
        fault = "it is not in the file" if stated is None else f"its type is {kind!r}"
        why = f"{fault}; a sigmoid at 0 with a steepness of {STEEPNESS:g} is used, as in dnf-composer"
        b.values.say(key, "approximated", why)
        return Logistic(STEEPNESS, 0.0)
    settings, replaced = dict(USUAL), list[str]()
    for name in FUNCTIONS[kind]:
        setting = number(body.get(name))
        if setting is None or abs(setting) > 1e30:
            replaced.append(f"{name} {USUAL[name]:g} is used, which is not in the file")
        elif name != "x_shift" and not FLATTEST <= setting <= STEEPEST:
            settings[name] = min(max(setting, FLATTEST), STEEPEST)
            replaced.append(f"{name} is {setting:g}, {settings[name]:g} is used")
        else:
            settings[name] = setting
    function = _function(kind, settings)
    if replaced:
        b.values.say(key, "approximated", "; ".join(replaced))
    else:
        b.values.say(key, "carried", f"as {type(function).__name__}")
    return function


def _function(kind: str, values: dict[str, float]) -> SigmoidFunction:
    match kind:
        case "heaviside":
            return Step(values["x_shift"])
        case "abs_sigmoid":
            return Absolute(values["beta"], values["x_shift"])
        case _:
            return Logistic(values["steepness"], values["x_shift"])


@translates("memory trace", "memory trace 2d")
def memory_trace(b: StoredElement) -> None:
    """Translate `memory trace` and its form over a plane; it decays also while no sample is active."""
    dims = b.dims()
    trace = MemoryTrace(
        b.label,
        axes(dims),
        tau_build=_tau(b, "tauBuild", 100),
        tau_decay=_tau(b, "tauDecay", 1000),
        threshold=b.values.number("threshold", 0.5),
        fades=True,
    )
    seen = b.input(dims, whole=False, needed=False, sums=True)
    b.outlet("output", b.add(trace, input=seen), state=True)


def _tau(b: StoredElement, name: str, default: float) -> float:
    """Return a time constant; one below the step is refused by deodar."""
    return b.values.number(name, max(default, b.step), b.step)


def _at_rest(sigmoid: SigmoidFunction, u: float) -> float:
    """Return the output for one activation, in double precision."""
    match sigmoid:
        case Step():
            return float(u > sigmoid.threshold)
        case Absolute():
            d = sigmoid.beta * (u - sigmoid.threshold)
            return 0.5 * (1 + d / (1 + abs(d)))
        case Logistic():
            return 1 / (1 + math.exp(min(max(-sigmoid.beta * (u - sigmoid.threshold), -88.0), 88.0)))
        case _:
            return 0.0
