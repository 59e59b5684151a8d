"""Labels without a counterpart: a placeholder keeps their place and connections."""

from __future__ import annotations

from deodar_interop.importers._axes import SizeLimit
from deodar_interop.importers._foreign import Foreign
from deodar_interop.importers._missing import placeholder_piece, unknown
from deodar_interop.importers._piece import Dims, Piece
from deodar_interop.importers.dnf_composer.sizes import SampleAxes, size

MISSING = {"field projection": "a reduction or an expansion of 2026, which collapse and expand replaced"}
"""What each label that is not translated was."""


def placeholder(e: Foreign, sizes: SampleAxes, kinds: list[str], why: str = "") -> Piece:
    """Return a placeholder for an element, with the reason."""
    missing = why or MISSING.get(e.kind, "") or unknown(e.kind, "an unknown label of dnf-composer", kinds)
    return placeholder_piece(e, _dims(e, sizes), missing)


def _dims(e: Foreign, sizes: SampleAxes) -> Dims:
    try:
        return sizes.of(size(e))
    except SizeLimit:
        return (None, None)
