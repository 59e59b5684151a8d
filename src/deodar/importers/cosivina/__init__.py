"""cosivina, the MATLAB toolbox and its Python port: JSON files of simulators, parameters and presets."""

from __future__ import annotations

import re

from deodar.importers.cosivina.translate import read

NAME = "cosivina"

KEYS = re.compile(rb'"(?:simulator|elementLabels)"\s*:')
"""Keys that no other tool writes; as a value, another tool may have the same words."""


def sniff(head: bytes) -> bool:
    """Return whether a file begins like a cosivina file: an object with a `simulator`, or with its lists."""
    text = head.replace(b"\0", b"")  # two bytes a character
    return b'"deodar"' not in text[:1000] and KEYS.search(text) is not None


__all__ = ["NAME", "read", "sniff"]
