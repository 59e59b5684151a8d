"""cosivina, the MATLAB toolbox and its Python port: JSON files of simulators, parameters and presets."""

from __future__ import annotations

from deodar.importers.cosivina.translate import read

NAME = "cosivina"


def sniff(head: bytes) -> bool:
    """Return whether a file begins like a cosivina file: an object with a `simulator`, or with its lists."""
    text = head.replace(b"\0", b"")  # two bytes a character
    return b'"deodar"' not in text[:1000] and any(key in text for key in (b'"simulator"', b'"elementLabels"'))


__all__ = ["NAME", "read", "sniff"]
