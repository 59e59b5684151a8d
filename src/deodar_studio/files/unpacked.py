"""Packages below the root, unpacked beside themselves when they are opened."""

from __future__ import annotations

from pathlib import Path

from deodar.errors import DocumentError, Fix
from deodar.experiments.results import EXPERIMENT
from deodar.packing import packing


def unpacked(place: Path, trust: bool) -> tuple[Path, str]:
    """Return the path to open in place of a file, and a sentence on the package that it is.

    A package with contents is unpacked into a folder beside it, unless one with the same files is there.
    Other files, and the package of a model alone, are opened as they are, without a sentence.

    Args:
        place: the file.
        trust: whether modules that come with a package may be imported and run.

    Raises:
        DocumentError: the package is damaged, it holds a figure, or what it holds cannot be opened without
            its modules.
    """
    if not packing.has_contents(place):
        return place, ""
    inner, contents = packing.unpack_beside(place, trust)
    if contents.kind == "figure":
        raise DocumentError(
            f"holds the file of a figure, which the studio does not open; it is unpacked: {inner}",
            where=place.name,
            fix=Fix(f"Draw it: deodar plot {inner}"),
        )
    makers = contents.about.get("made by", "")
    sentence = f"{place.name} is unpacked in {inner.relative_to(place.parent).parts[0]}: {contents.noun}"
    opened = inner / EXPERIMENT if contents.kind == "results" else inner
    return opened, sentence + (f", made by {makers}" if makers else "")
