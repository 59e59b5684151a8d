"""What a part declares of a parameter beside its type: what a change costs, the unit, the range, and what
kind of time it is.
"""

from __future__ import annotations

import dataclasses as dc
import re
from typing import Any, ClassVar, Literal

Cost = Literal["live", "rebuild", "recompile"]
Role = Literal["", "time constant", "time scale", "rate", "speed", "moment", "duration"]
TIME_ROLES: tuple[Role, ...] = ("time constant", "time scale", "rate", "speed", "moment", "duration")
"""What a parameter is whose unit has time in it: see `Declaration`."""

LIMITING: tuple[Role, ...] = ("time constant", "time scale", "rate")
"""Roles of parameters that limit the Euler step."""


@dc.dataclass(frozen=True)
class Declaration:
    """What is declared beside a parameter's type; use `Live`, `Rebuild` or `Recompile`.

    A parameter whose unit has time in it ("time", "1/time", "axis/time") states its `role`:

    * `time constant`: of a linear relaxation; a run refuses an Euler step that is longer.
    * `time scale`: a time constant for an input of 1, such as tau of tau dphi/dt = f (x - phi); a run refuses
      a longer step.
    * `rate`: the inverse of a time constant, such as r of dw/dt = r (x - w); a run refuses a step longer than
      1/r.
    * `speed`: a change per unit of time that does not relax, such as a velocity or the factor of an
      integrator; the step is not compared with it.
    * `moment`: a point of document time.
    * `duration`: a length of time, such as a delay, a period or an interval; it may be shorter than a step.

    What is compared with document time, or multiplied by it, is `exact`: in a program of single precision it
    keeps the digits of float64 (`numerics/exact.py`). Moments always are.

    Attributes:
        unit: of the value, for forms and messages: "time" for the document's, "axis", "activation", "1/time"
            and so on.
        lower: lowest value; None: any.
        upper: highest value; None: any.
        neutral: the value at which the parameter has no effect, so that the program leaves it out.
        choices: the allowed texts; empty: any.
        meaning: one phrase for forms, the reference and the schema.
        off: whether the neutral value switches something off, instead of being what small values tend to.
        role: what a parameter is whose unit has time in it, see above.
        exact: whether it keeps the digits of float64 in a program of single precision.
    """

    unit: str = ""
    lower: float | None = None
    upper: float | None = None
    neutral: float | None = None
    choices: tuple[str, ...] = ()
    meaning: str = ""
    off: bool = False
    role: Role = dc.field(default="", kw_only=True)
    exact: bool = dc.field(default=False, kw_only=True)
    cost: ClassVar[Cost] = "recompile"


class Live(Declaration):
    """A traced leaf: a change takes effect at the next exchange and never recompiles.

    A parameter with a `neutral` value (noise 0) is left out of the program while it has it; leaving it
    recompiles once. Where that value is not what small values tend to (a speed limit of 0 means none), `off`
    says so: reaching it recompiles as well.
    """

    cost = "live"


class Rebuild(Declaration):
    """A change reruns the part's `prepare`, a pure traced function, and does not recompile."""

    cost = "rebuild"


class Recompile(Declaration):
    """A change makes a new program; states are kept by the element's id."""

    cost = "recompile"


@dc.dataclass(frozen=True)
class Needed:
    """The default of a parameter that has none: leaving it out is an error that proposes a value; use
    `needed`.

    Attributes:
        like: a value as it is written in a call, such as `[x]`; the names in it stand for axes.
    """

    like: str

    def __repr__(self) -> str:
        return "required"

    @property
    def names(self) -> list[str]:
        """Names of the axes in the proposed value."""
        return re.findall(r"\w+", self.like)


def needed(like: str) -> Any:
    """Declare that a parameter has no default.

    For example `axes: Annotated[Sequence[Axis], Recompile(meaning="axes of the output")] = needed("[x]")`.
    """
    return Needed(like)


def range_text(lower: float | None, upper: float | None) -> str:
    """Return a range in words: "0 to 1", "at least 0", "at most 1"; "" for any value."""
    low, high = ("" if bound is None else f"{bound:.12g}" for bound in (lower, upper))
    if low and high:
        return f"{low} to {high}"
    return f"at least {low}" if low else f"at most {high}" if high else ""
