"""Sums, products and functions of each sample."""

from __future__ import annotations

from deodar.couplings.gain import Gain
from deodar.couplings.product import Product
from deodar.couplings.sigmoid import Sigmoid
from deodar.couplings.sum import Sum
from deodar.numerics.sigmoids.logistic import Logistic
from deodar.numerics.sigmoids.semilinear import SemiLinear
from deodar_interop.importers._piece import Inlet, Outlet, Piece
from deodar_interop.importers.cosivina.classes.fields import STEEPEST
from deodar_interop.importers.cosivina.element import SourceElement


def sum_inputs(b: SourceElement) -> Piece:
    """Translate SumInputs."""
    b.values.size()
    dims = b.dims()
    inlet = Inlet(b.label, dims, whole=True)
    return Piece(
        [Sum(name=b.label)], [[inlet]], {"output": Outlet(b.label, dims)}, sums=True, needs=1, why="Sum"
    )


def scale_input(b: SourceElement) -> Piece:
    """Translate ScaleInput."""
    return _one(b, Gain(b.values.number("amplitude", 0), name=b.label))


def half_wave(b: SourceElement) -> Piece:
    """Translate HalfWaveRectification."""
    return _one(b, Sigmoid(SemiLinear(1.0, 0.0), name=b.label))


def sigmoid(b: SourceElement) -> Piece:
    """Translate Sigmoid."""
    logistic = Logistic(b.values.number("beta", 1, 1e-6, STEEPEST), b.values.number("threshold", 0))
    return _one(b, Sigmoid(logistic, name=b.label))


def product(b: SourceElement) -> Piece:
    """Translate PointwiseProduct of two inputs, one of which may be smaller."""
    b.values.size()
    dims = b.dims()
    ports = [[Inlet(b.label, dims, whole=True)], [Inlet(b.label, dims, "factor")]]
    second = b.source(1)
    if second == dims and b.source(0) != dims:  # the port `input` takes the larger one
        ports = [[Inlet(b.label, dims, "factor")], [Inlet(b.label, dims, whole=True)]]
    return Piece([Product(name=b.label)], ports, {"output": Outlet(b.label, dims)}, needs=2, why="Product")


def _one(b: SourceElement, element: Gain | Sigmoid) -> Piece:
    b.values.size()
    dims = b.dims()
    inlet = Inlet(b.label, dims, whole=True)
    return Piece([element], [[inlet]], {"output": Outlet(b.label, dims)}, needs=1, why=type(element).__name__)


CLASSES = {
    "SumInputs": sum_inputs,
    "ScaleInput": scale_input,
    "HalfWaveRectification": half_wave,
    "Sigmoid": sigmoid,
    "PointwiseProduct": product,
}
