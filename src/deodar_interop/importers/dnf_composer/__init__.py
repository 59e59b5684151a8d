"""dnf-composer, the C++ framework for dynamic neural fields: simulations saved as `.dnf` or JSON files."""

from __future__ import annotations

import re

from deodar_interop.importers.dnf_composer.translate import read

NAME = "dnf-composer"

ENDINGS = (".dnf",)
"""Endings of its file names, besides `.json`, by which the studio lists them."""

ELEMENT = re.compile(rb'"uniqueName"\s*:')
"""The key of every element, which no other tool writes."""

WHOLE = (re.compile(rb'"identifier"\s*:'), re.compile(rb'"deltaT"\s*:'), re.compile(rb'"elements"\s*:'))
"""The keys of a simulation, which may have no elements."""


def sniff(head: bytes) -> bool:
    """Return whether a file begins like a simulation of dnf-composer, or like its bare list of elements."""
    if b'"deodar"' in head[:1000]:
        return False
    return ELEMENT.search(head) is not None or all(key.search(head) for key in WHOLE)


__all__ = ["ENDINGS", "NAME", "read", "sniff"]
