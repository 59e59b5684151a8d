"""The translation of each label of dnf-composer, by families; each file states its `CLASSES`."""

from __future__ import annotations

from collections.abc import Callable

from deodar_interop import _merged
from deodar_interop.importers._piece import Piece
from deodar_interop.importers.dnf_composer.element import StoredElement

CLASSES: dict[str, Callable[[StoredElement], Piece]] = _merged.merged(__name__, "CLASSES")
