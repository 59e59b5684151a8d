"""The counterpart of each kind of element, by families; each file states its `KINDS`."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from deodar.element import Element
from deodar_interop import _merged
from deodar_interop.exporters.cosivina.draft import Given

KINDS: dict[type[Element], Callable[[Given, Any], None]] = _merged.merged(__name__, "KINDS")
