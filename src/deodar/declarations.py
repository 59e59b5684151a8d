"""Declarations of a parameter beside its type: the cost of a change, the unit, the range, the role of a
time.
"""

from __future__ import annotations

import dataclasses as dc
import re
from typing import Any, Literal

Cost = Literal["live", "rebuild", "recompile"]
Role = Literal["", "time constant", "time scale", "rate", "speed", "moment", "duration"]
Names = Literal["", "port", "element", "parameter", "event"]
"""What in a model or an experiment a text names."""
FormSection = Literal["", "time course", "interaction", "noise", "axes"]
"""The part of a form in which a parameter is listed; "" for its head."""

TIME_ROLES: tuple[Role, ...] = ("time constant", "time scale", "rate", "speed", "moment", "duration")
"""The roles of parameters whose unit contains time: see `Declaration`."""

LIMITING: tuple[Role, ...] = ("time constant", "time scale", "rate")
"""Roles of parameters that limit the Euler step."""


@dc.dataclass(frozen=True)
class Declaration:
    """The declaration of a parameter beside its type; use `Live`, `Rebuild` or `Recompile`.

    A parameter whose unit contains time ("time", "1/time", "axis/time") states its `role`:

    * `time constant`: of a linear relaxation; a run refuses an Euler step that is longer.
    * `time scale`: a time constant for an input of 1, such as tau of tau dphi/dt = f (x - phi); a run refuses
      a longer step.
    * `rate`: the inverse of a time constant, such as r of dw/dt = r (x - w); a run refuses a step longer than
      1/r.
    * `speed`: a change per unit of time that does not relax, such as a velocity or the factor of an
      integrator; the step is not compared with it.
    * `moment`: a point of document time.
    * `duration`: a length of time, such as a delay, a period or an interval; it may be shorter than a step.

    A parameter that is compared with document time, or multiplied by it, is `exact`: in a program of single
    precision it keeps the digits of float64 (`numerics/exact.py`). Moments are always exact.

    Attributes:
        unit: unit of the value, for forms and messages: "time" for the document's unit, "axis",
            "activation", "1/time" and so on.
        lower: lowest value; None: any.
        upper: highest value; None: any.
        neutral: the value at which the parameter has no effect, so that the program leaves it out.
        choices: the allowed texts; empty: any.
        off: whether the neutral value switches the effect off, instead of being the limit of small values.
        role: role of a parameter whose unit contains time, see above.
        exact: whether it keeps the digits of float64 in a program of single precision.
        names: what a text names, for forms that list the valid names: the path of a port, an element or a
            parameter, or the name of an event of the experiment; empty: anything.
        section: the section of a form that lists it; None: the one that follows from its type and role
            (`deodar.kinds`).
        if_none: what None means, in a word for forms, such as `always`; empty: that there is none.
        if_empty: what an empty list means, in a word for forms, such as `never`; empty: that there is none.
    """

    unit: str = ""
    lower: float | None = None
    upper: float | None = None
    neutral: float | None = None
    choices: tuple[str, ...] = ()
    off: bool = False
    role: Role = dc.field(default="", kw_only=True)
    exact: bool = dc.field(default=False, kw_only=True)
    names: Names = dc.field(default="", kw_only=True)
    section: FormSection | None = dc.field(default=None, kw_only=True)
    if_none: str = dc.field(default="", kw_only=True)
    if_empty: str = dc.field(default="", kw_only=True)
    cost: Cost = dc.field(default="recompile", init=False)


class Live(Declaration):
    """A traced leaf: a change takes effect at the next exchange and never recompiles.

    A parameter is omitted from the program while it has its `neutral` value (noise 0); a change from that
    value recompiles once. If the neutral value is not the limit of small values (a speed limit of 0 means no
    limit), `off` is true, and a change to it recompiles as well.
    """

    cost = "live"


class Rebuild(Declaration):
    """A change reruns the part's `prepare`, a pure traced function, and does not recompile."""

    cost = "rebuild"


class Recompile(Declaration):
    """A change compiles a new program; states are kept by the element's id."""


@dc.dataclass(frozen=True)
class Needed:
    """The marker of a parameter without a default; an error proposes a value if it is omitted. Use `needed`.

    Attributes:
        like: a value as it is written in a call, such as `[x]`; the names in it denote axes.
    """

    like: str

    def __repr__(self) -> str:
        return "required"

    @property
    def names(self) -> list[str]:
        """The names of the axes in the proposed value."""
        return re.findall(r"\w+", self.like)


def needed(like: str) -> Any:
    """Declare that a parameter has no default.

    For example `axes: Sequence[Axis] = needed("[x]")`.
    """
    return Needed(like)


def range_text(lower: float | None, upper: float | None) -> str:
    """Return a range in words: "0 to 1", "at least 0", "at most 1"; "" for any value."""
    low, high = ("" if bound is None else f"{bound:.12g}" for bound in (lower, upper))
    if low and high:
        return f"{low} to {high}"
    return f"at least {low}" if low else f"at most {high}" if high else ""
