"""The translation of each class of cosivina, by families; each file states its `CLASSES`."""

from __future__ import annotations

from collections.abc import Callable

from deodar_interop import _merged
from deodar_interop.importers._piece import Piece
from deodar_interop.importers.cosivina.element import SourceElement

CLASSES: dict[str, Callable[[SourceElement], Piece]] = _merged.merged(__name__, "CLASSES")
