"""Time windows, in which a stimulus is on."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any, ClassVar

from deodar.numerics.scalar import Scalar
from deodar.parameters import Live, Part
from deodar.registry import register

if TYPE_CHECKING:
    from jax.typing import DTypeLike

FOR_EVER = 1e30
"""A time that no run reaches, in any time unit."""


@register
@dataclass(frozen=True)
class Window(Part):
    r"""A time window from `start` to `stop`, without `stop`; a pair of numbers is its short form.

    Equation:
        w(t) = \begin{cases} 1 & \mathrm{start} \le t < \mathrm{stop} \\ 0 & \text{else} \end{cases}

    Parameters:
        start: start of the window; in the document's time unit.
        stop: end of the window, excluded; in the document's time unit; by default no run reaches it.

    Shapes:
        One number at each time.

    Reference:
        no reference
    """

    start: Annotated[float, Live("time", role="moment")] = 0.0
    stop: Annotated[float, Live("time", role="moment")] = FOR_EVER

    short: ClassVar[str] = "also written as a pair: windows=[(100, 400)]"

    @classmethod
    def accept(cls, value: Any) -> Any:
        return cls(*value) if isinstance(value, (tuple, list)) and len(value) == 2 else value


def gate(windows: Sequence[Window] | None, time: Any, dtype: DTypeLike) -> Scalar:
    """Return 1 inside any of the windows, else 0; None: always 1; no windows: always 0.

    A step belongs to a window if its time does, with a tolerance of half a step, so that rounding moves no
    edge.
    """
    if not windows:
        return 1.0 if windows is None else 0.0
    half = 0.5 * time.dt
    inside = False
    for w in windows:
        inside = inside | ((time.since(w.start) >= -half) & (time.since(w.stop) < -half))
    return inside.astype(dtype)  # type: ignore[union-attr]
