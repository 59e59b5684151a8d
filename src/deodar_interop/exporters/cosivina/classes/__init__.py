"""The counterpart of each kind of element, by families."""

from __future__ import annotations

from collections.abc import Callable

from deodar.element import Element
from deodar_interop.exporters.cosivina.classes import (
    algebra,
    fields,
    histories,
    kernels,
    shapes,
    stimuli,
    weights,
)
from deodar_interop.exporters.cosivina.draft import Given

KINDS: dict[type[Element], Callable[[Given], None]] = {
    **fields.KINDS,
    **histories.KINDS,
    **stimuli.KINDS,
    **kernels.KINDS,
    **algebra.KINDS,
    **shapes.KINDS,
    **weights.KINDS,
}
