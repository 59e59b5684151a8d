"""The translation of each class of cosivina, by families."""

from __future__ import annotations

from collections.abc import Callable

from deodar_interop.importers._piece import Piece
from deodar_interop.importers.cosivina.classes import algebra, fields, kernels, shapes, stimuli, weights
from deodar_interop.importers.cosivina.element import SourceElement

CLASSES: dict[str, Callable[[SourceElement], Piece]] = {
    **fields.CLASSES,
    **stimuli.CLASSES,
    **kernels.CLASSES,
    **algebra.CLASSES,
    **shapes.CLASSES,
    **weights.CLASSES,
}
