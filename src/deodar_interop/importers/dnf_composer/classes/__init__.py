"""The translation of each label, by families: functions that `translates` decorates."""

from __future__ import annotations

from deodar_interop import _merged
from deodar_interop.importers._element import ElementKind

CLASSES = _merged.declared(__name__, ElementKind)
