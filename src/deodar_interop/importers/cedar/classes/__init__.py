"""The translation of each type of step, by cedar's categories: functions that `step` decorates."""

from __future__ import annotations

from deodar_interop import _merged
from deodar_interop.importers.cedar.classes import missing
from deodar_interop.importers.cedar.composition import StepKind

CLASSES = _merged.declared(__name__, StepKind)
SIZED = frozenset(name for name, kind in CLASSES.items() if kind.sized)
LOOPED = missing.LOOPED | {name for name, kind in CLASSES.items() if kind.looped}
