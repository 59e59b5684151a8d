"""Labels without a counterpart: a placeholder keeps their place and connections."""

from __future__ import annotations

from deodar.elements.placeholder import Placeholder
from deodar.errors import did_you_mean
from deodar.importers._axes import SizeLimit
from deodar.importers._foreign import Foreign
from deodar.importers._piece import Dims, Inlet, Outlet, Piece, axes
from deodar.importers.dnf_composer.sizes import SampleAxes, size

MISSING = {"field projection": "a reduction or an expansion of 2026, which collapse and expand replaced"}
"""What each label that is not translated was."""


def placeholder(e: Foreign, sizes: SampleAxes, known: list[str], why: str = "") -> Piece:
    """Return a placeholder for an element, with the reason."""
    what = why or MISSING.get(e.kind, "")
    if not what:
        hint = did_you_mean(e.kind, known)
        what = "an unknown label of dnf-composer" + (f". {hint}" if hint.startswith("Did") else "")
    dims = _dims(e, sizes)
    element = Placeholder(e.label, axes(dims), f"{e.kind}: {what}")
    outlets = {"output": Outlet(e.label, dims, state=True)}
    return Piece(
        [element], [[Inlet(e.label, dims)]], outlets, sums=True, verdict="dropped", why=f"Placeholder: {what}"
    )


def _dims(e: Foreign, sizes: SampleAxes) -> Dims:
    try:
        return sizes.of(size(e))
    except SizeLimit:
        return (None, None)
