"""The translation of each type of step, by cedar's categories.

A file states `CLASSES`, the translation of each type; `DECLARED`, types whose outputs have sizes of their
own, whatever arrives; and `LOOPED`, types that have a state, which triggers call: all others follow from
them.
"""

from __future__ import annotations

from collections.abc import Callable

from deodar_interop import _merged
from deodar_interop.importers.cedar.piece import SourceStep, StepPiece

CLASSES: dict[str, Callable[[SourceStep], StepPiece]] = _merged.merged(__name__, "CLASSES")
DECLARED: frozenset[str] = _merged.union(__name__, "DECLARED")
LOOPED: frozenset[str] = _merged.union(__name__, "LOOPED")
