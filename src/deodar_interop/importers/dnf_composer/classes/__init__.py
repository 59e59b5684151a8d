"""The translation of each label of dnf-composer, by families."""

from __future__ import annotations

from collections.abc import Callable

from deodar_interop.importers._piece import Piece
from deodar_interop.importers.dnf_composer.classes import couplings, fields, kernels, noise, shapes, stimuli
from deodar_interop.importers.dnf_composer.element import StoredElement

CLASSES: dict[str, Callable[[StoredElement], Piece]] = {
    **fields.CLASSES,
    **stimuli.CLASSES,
    **kernels.CLASSES,
    **noise.CLASSES,
    **couplings.CLASSES,
    **shapes.CLASSES,
}
