"""cedar, the framework in C++: JSON files of architectures."""

from __future__ import annotations

from deodar_interop.importers.cedar.translate import read

NAME = "cedar"

PARTS = (b'"steps"', b'"groups"', b'"networks"')
OTHERS = (b'"triggers"', b'"connections"', b'"connectors"', b'"meta"', b'"required"', b'"promotedSlots"')


def sniff(head: bytes) -> bool:
    """Return whether a file begins like a cedar architecture: an object of steps or groups, with types of
    cedar or other keys of an architecture.
    """
    if b'"deodar"' in head[:1000] or b'"simulator"' in head:
        return False
    return any(key in head for key in PARTS) and (b'"cedar.' in head or any(key in head for key in OTHERS))


__all__ = ["NAME", "read", "sniff"]
