"""cedar, the framework in C++: JSON files of architectures."""

from __future__ import annotations

from deodar.importers.cedar.translate import read

NAME = "cedar"

KEYS = (b'"steps"', b'"triggers"', b'"groups"', b'"networks"')


def sniff(head: bytes) -> bool:
    """Return whether a file begins like a cedar architecture: an object of steps, triggers or groups."""
    if b'"deodar"' in head[:1000] or b'"simulator"' in head:
        return False
    return (b'"cedar.' in head and any(key in head for key in KEYS)) or (
        b'"meta"' in head[:200] and b'"format"' in head[:300] and any(key in head for key in KEYS)
    )


__all__ = ["NAME", "read", "sniff"]
