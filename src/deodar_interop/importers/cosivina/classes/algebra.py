"""Sums, products and functions of each sample."""

from __future__ import annotations

from deodar.couplings.arithmetic import Gain, Product, Sigmoid, Sum
from deodar.numerics.sigmoids import Logistic, SemiLinear
from deodar_interop.importers._element import ElementSignal, translates
from deodar_interop.importers.cosivina.classes.fields import STEEPEST
from deodar_interop.importers.cosivina.element import SourceElement


@translates("SumInputs")
def sum_inputs(b: SourceElement) -> ElementSignal:
    """Translate SumInputs."""
    return b.add(Sum(name=b.label), input=b.input(b.sized(), sums=True))


@translates("ScaleInput")
def scale_input(b: SourceElement) -> ElementSignal:
    """Translate ScaleInput."""
    return b.add(Gain(b.values.number("amplitude", 0), name=b.label), input=b.input(b.sized()))


@translates("HalfWaveRectification")
def half_wave(b: SourceElement) -> ElementSignal:
    """Translate HalfWaveRectification."""
    return b.add(Sigmoid(SemiLinear(1.0, 0.0), name=b.label), input=b.input(b.sized()))


@translates("Sigmoid")
def sigmoid(b: SourceElement) -> ElementSignal:
    """Translate Sigmoid."""
    logistic = Logistic(b.values.number("beta", 1, 1e-6, STEEPEST), b.values.number("threshold", 0))
    return b.add(Sigmoid(logistic, name=b.label), input=b.input(b.sized()))


@translates("PointwiseProduct")
def product(b: SourceElement) -> ElementSignal:
    """Translate PointwiseProduct of two inputs, one of which may be smaller."""
    dims = b.sized()
    turned = b.source(1) == dims and b.source(0) != dims  # the port `input` takes the larger one
    first, second = b.input(dims, whole=not turned), b.input(dims, whole=turned)
    larger, factor = (second, first) if turned else (first, second)
    return b.add(Product(name=b.label), input=larger, factor=factor)
