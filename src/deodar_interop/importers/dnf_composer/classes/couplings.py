"""Weights between fields. Learning is off whenever a file is opened, so that weights are fixed."""

from __future__ import annotations

import math

import numpy as np

from deodar.couplings.arithmetic import Gain
from deodar.couplings.weights import Weights
from deodar.errors import DeodarError
from deodar.importers._beside import is_plain
from deodar.importers.report import Line
from deodar.model.paths import display
from deodar.numerics.axes import shape
from deodar_interop.importers._element import ElementSignal, translates
from deodar_interop.importers._piece import Unfit, axes
from deodar_interop.importers._values import LARGEST
from deodar_interop.importers.dnf_composer.element import StoredElement
from deodar_interop.importers.dnf_composer.sizes import INPUT_LENGTH, input_length

MOST_PRODUCTS = 500_000_000
"""Largest number of weights times peaks (a guess; they take seconds)."""

LEARNING = ("learningRule", "learningRate", "decayRate")


@translates("field coupling")
def field_coupling(b: StoredElement) -> ElementSignal:
    """Translate `field coupling`: weights from the file beside the simulation, times `scalar`."""
    came = _input(b)
    weights = stored_weights(b, came)
    scalar = b.values.number("scalar", 1)
    for name in LEARNING:
        if name in b.element.values:
            b.values.say(name, "dropped", "learning is off when a file is opened, and weights are fixed here")
    return _weighted(b, weights, scalar)


@translates("gauss field coupling")
def gauss_field_coupling(b: StoredElement) -> ElementSignal:
    """Translate `gauss field coupling`: a sum of Gaussian peaks, whose samples are counted from 0."""
    came = _input(b)
    b.values.optional |= {"couplings"}
    normalized, circular = b.values.flag("normalized", True), b.values.flag("circular", False)
    count, peaks = b.counts[1], b.values.rows("couplings", 4)
    b.budget.take(came * count)
    if len(peaks) * came * count > MOST_PRODUCTS:
        raise Unfit(f"its {len(peaks)} peaks over {came} x {count} samples take too long to add")
    weights = np.zeros((came, count))
    source = b.source()
    spacing = b.spacing("input_d_x") if source is None else _spacing(source.values.get("d_x", 1.0))
    good = [peak for peak in peaks if min(peak) > 0]
    for x, y, amplitude, width in good:
        height = amplitude / (math.sqrt(2 * math.pi) * width) if normalized else amplitude
        a, z = (
            _bell(n, position, width, circular)
            for n, position in ((came, x / spacing), (count, y / b.spacing("d_x")))
        )
        weights += height * np.outer(a, z)
    if not np.isfinite(weights).all() or np.abs(weights).max(initial=0.0) > LARGEST:
        raise Unfit("its weights are not finite")
    if len(good) < len(peaks):
        why = f"{len(peaks) - len(good)} of {len(peaks)} entries are not above 0, and are left out"
        b.values.say("couplings", "approximated", why)
    elif "couplings" in b.element.values and b.values.lines["couplings"].verdict == "carried":
        b.values.say("couplings", "carried", "as weights")
    return _weighted(b, weights, 1.0)


def stored_weights(b: StoredElement, came: int) -> np.ndarray:
    """Return the weights of the file NAME_weights.txt, one row for each input sample; else zeros."""
    name, count = f"{b.label}_weights.txt", b.counts[1]
    b.budget.take(came * count)
    nothing = np.zeros((came, count))
    try:
        content = b.beside(name) if is_plain(name) else None
    except DeodarError as error:
        return _no_weights(b, name, error.problems[0].what, nothing)
    if content is None:
        fault = "there is no such file" if is_plain(name) else "this name leads to another folder"
        return _no_weights(b, name, fault, nothing)
    words = content.split(maxsplit=came * count)
    try:
        weights = np.array([float(word) for word in words[: came * count]])
    except ValueError:
        return _no_weights(b, name, "it holds more than numbers", nothing)
    if len(words) != came * count:
        fault = f"it does not hold {came} x {count} numbers"
        return _no_weights(b, name, fault, nothing)
    if not np.isfinite(weights).all() or np.abs(weights).max(initial=0.0) > LARGEST:
        return _no_weights(b, name, "some of its numbers are not finite", nothing)
    b.extra.append(Line(b.label, "file", name, "carried"))
    return weights.reshape(came, count)


def _no_weights(b: StoredElement, name: str, fault: str, nothing: np.ndarray) -> np.ndarray:
    why = f"{fault}; weights of 0 are used, as in dnf-composer"
    b.extra.append(Line(b.label, "file", name, "approximated", why))
    return nothing


def _input(b: StoredElement) -> int:
    """Return the number of input samples, and report the parameters that state it."""
    b.dims()
    came, values = input_length(b.element), b.element.values
    pair = [name for name in ("input_x_max", "input_d_x") if name in values]
    for name in pair:
        if len(pair) == 2:
            b.values.say(name, "carried", f"as {came} samples")
        else:
            b.values.say(name, "dropped", f"it has a meaning only with the other; {came} samples are used")
    if "inputFieldSize" in values:
        if pair:
            b.values.say("inputFieldSize", "dropped", "replaced by input_x_max and input_d_x")
        else:
            why = f"as {came} samples; today's dnf-composer ignores it and takes {INPUT_LENGTH}"
            b.values.say("inputFieldSize", "approximated", why)
    elif not pair:
        why = f"it is not in the file; {INPUT_LENGTH} samples are used, dnf-composer's default"
        b.values.say("input_x_max", "approximated", why)
    b.of((1, came))
    return came


def _weighted(b: StoredElement, weights: np.ndarray, scalar: float) -> ElementSignal:
    dims, came = b.of(b.counts), b.of((1, weights.shape[0]))
    ours = weights.T.reshape(shape(axes(dims)) + shape(axes(came)))
    element = Weights(ours, axes(dims), name=b.named("" if scalar == 1 else "weights"))
    b.piece.elsewhere = {
        "weights": f"the parameter {display((element.name, 'weights'))}, output samples first"
    }
    weighted = b.add(element, dims, input=b.input(came, sums=True))
    if scalar == 1:
        return weighted
    b.explain("Gain and Weights")
    return b.add(Gain(scalar, name=b.label), input=weighted)


def _spacing(value: object) -> float:
    return float(value) if isinstance(value, (int, float)) and value > 0 else 1.0


def _bell(count: int, position: float, width: float, circular: bool) -> np.ndarray:
    """Return exp(-d^2 / (2 width^2)) at the samples 0, 1, ..., count - 1."""
    d = np.abs(np.arange(count) - position)
    return np.exp(-0.5 * ((np.minimum(d, count - d) if circular else d) / width) ** 2)
