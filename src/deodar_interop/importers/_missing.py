"""The placeholder of an element that has no counterpart: it keeps the name and the connections."""

from __future__ import annotations

from collections.abc import Sequence

from deodar.elements.placeholder import Placeholder
from deodar.errors import did_you_mean
from deodar_interop.importers._foreign import Foreign
from deodar_interop.importers._piece import Dims, Inlet, Outlet, Piece, axes


def unknown(kind: str, missing: str, known: Sequence[str]) -> str:
    """Return what is missing for an unknown kind, with the name that may be meant."""
    hint = did_you_mean(kind, known)
    return missing + (f". {hint}" if hint.startswith("Did") else "")


def placeholder_piece(e: Foreign, dims: Dims, missing: str) -> Piece:
    """Return a placeholder for an element of this size; `what` is missing."""
    return Piece(
        [Placeholder(e.label, axes(dims), f"{e.kind}: {missing}")],
        [[Inlet(e.label, dims)]],
        {"output": Outlet(e.label, dims, state=True)},
        sums=True,
        verdict="dropped",
        why=f"Placeholder: {missing}",
    )
