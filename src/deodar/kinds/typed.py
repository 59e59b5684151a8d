"""Values as one types them in a call."""

from __future__ import annotations

from deodar.numerics.axes import Axis
from deodar.parameters import Part, parameters


def typed(value: object) -> str:
    """Return a value as one types it, a part as the call that makes it."""
    if isinstance(value, Axis):
        return f"Axis({value.name!r}, {value.lower:g}, {value.upper:g}, {value.samples})"
    if isinstance(value, (tuple, list)):
        return "[" + ", ".join(typed(v) for v in value) + "]"
    if isinstance(value, Part):
        shown = [
            f"{p.name}={typed(getattr(value, p.name))}"
            for p in parameters(type(value))
            if getattr(value, p.name) not in (None, "", ())
        ]
        return f"{type(value).__name__}({', '.join(shown)})"
    return f"{value:g}" if isinstance(value, float) else repr(value)
