"""The description of a parameter: form, unit, range, meaning, symbol and default."""

from __future__ import annotations

import dataclasses as dc
import re
from collections.abc import Mapping, Sequence
from typing import Any

from deodar.codec import Json
from deodar.declarations import Cost, Declaration, FormSection, Needed, range_text
from deodar.model.parts import to_json
from deodar.numerics.axes import Axis
from deodar.numerics.kernels._base import Kernel
from deodar.numerics.sigmoids import SigmoidFunction
from deodar.numerics.windows import Window
from deodar.parameters import FrozenArray, Parameter, Part, ValueForm, parameters

QUANTITIES = ("number", "integer", "per_axis", "part", "array", "numbers")
"""Forms of parameters whose names may occur in an equation."""

ENDLESS = 1e20
"""A time of this size as a default means: never."""

_LETTERS = (
    "alpha beta gamma delta epsilon zeta eta theta kappa lambda mu nu xi pi rho sigma tau phi chi psi omega"
    " Gamma Delta Theta Lambda Xi Pi Sigma Phi Psi Omega"
)
GREEK = frozenset(_LETTERS.split())

NAME = re.compile(r"[A-Za-z][A-Za-z0-9]*(?:_[A-Za-z0-9]+)*'*")
"""A name as equations write it, with subscripts and primes."""


@dc.dataclass(frozen=True, kw_only=True)
class ParameterDescription(Declaration):
    """What a parameter is: its declaration, and what follows from it.

    Attributes:
        name: its name.
        meaning: one phrase for forms and lists.
        form: the shape of its value.
        description: what the docstring says of it.
        symbol: its symbol in the equation, as TeX; "" without one.
        default: the default as documents write it; axes and arrays have none.
        typed: the default as one types it in a call; "required" without one.
        optional: whether it may be None.
        of: names of the kinds that its value may have, where it is a part or a list of parts.
        section: the section of a form that lists it; "" its head.
    """

    name: str
    meaning: str
    form: ValueForm
    cost: Cost
    description: str
    symbol: str
    default: Json
    typed: str
    optional: bool
    of: tuple[str, ...]
    section: FormSection = ""

    @property
    def range(self) -> str:
        """The allowed values in words."""
        return ", ".join(self.choices) or range_text(self.lower, self.upper)


def describe_parameter(
    p: Parameter, description: str, equation: Sequence[str], known: Mapping[str, type]
) -> ParameterDescription:
    """Describe one parameter.

    Args:
        p: its declaration.
        description: what the docstring of its kind says of it.
        equation: the equation of its kind.
        known: every registered kind by name.
    """
    declared: dict[str, Any] = {field.name: getattr(p, field.name) for field in dc.fields(Declaration)}
    declared["section"] = _section(p) if p.section is None else p.section
    return ParameterDescription(
        **declared,
        meaning=p.meaning,
        name=p.name,
        form=p.form,
        description=description,
        symbol=_symbol(p, description, equation),
        default=_default(p),
        typed=_typed(p),
        optional=p.optional,
        of=tuple(name for name, cls in known.items() if p.of is not None and _holds(p, p.of, cls)),
    )


def _section(p: Parameter) -> FormSection:
    """Return the section of a parameter whose declaration states none."""
    if p.form in ("axis", "axes"):
        return "axes"
    if p.role or (p.of is not None and issubclass(p.of, Window)):
        return "time course"
    if p.of is not None and issubclass(p.of, (Kernel, SigmoidFunction)):
        return "interaction"
    return ""


def plain(part: Part) -> Json:
    """Return a part as documents write it, without arrays: documents keep those in files."""
    return _without_arrays(to_json(part, _no_key, _no_key))


def _holds(p: Parameter, of: type, cls: type) -> bool:
    return p.form in ("part", "parts") and issubclass(cls, of)


def _symbol(p: Parameter, description: str, equation: Sequence[str]) -> str:
    """The symbol with which its description begins (`h, the attractor`), else its own name if the equation
    has it.
    """
    first = NAME.match(description)
    if first and is_letter(first[0]) and description[first.end() : first.end() + 1] in (",", ".", ":", ";"):
        return symbol(first[0])
    own = symbol(p.name)
    written = rf"(?<![A-Za-z\\]){re.escape(own)}(?![A-Za-z])"
    return own if p.form in QUANTITIES and any(re.search(written, line) for line in equation) else ""


def _default(p: Parameter) -> Json:
    value = p.default
    if value is dc.MISSING or isinstance(value, Needed) or value is None or p.form in ("axis", "array"):
        return [] if p.form == "axes" else None
    match p.form:
        case "axes":
            return []
        case "part":
            return plain(value)
        case "parts":
            return [plain(v) for v in value]
        case "numbers" | "pairs":
            return dict(value)
        case _:
            return list(value) if isinstance(value, tuple) else value


def _typed(p: Parameter) -> str:
    value = p.default
    if isinstance(value, Needed) or value is dc.MISSING or value is ...:
        return "required"
    if isinstance(value, float) and abs(value) >= ENDLESS:
        return "never"
    return "none" if value is None or value == () else typed(value)


def _no_key(shared: Axis | FrozenArray) -> str:
    return ""


def _without_arrays(data: Json) -> Json:
    if isinstance(data, dict):
        return {k: _without_arrays(v) for k, v in data.items() if v != {"array": ""}}
    return [_without_arrays(v) for v in data] if isinstance(data, list) else data


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


def is_letter(name: str) -> bool:
    """Whether a name is a letter of some alphabet, perhaps with a number, subscripts and primes: u, x', t_n,
    u1, sigma_i.
    """
    base = name.rstrip("'").split("_")[0]
    return base in GREEK or re.fullmatch(r"[A-Za-z]\d*", base) is not None


def symbol(name: str) -> str:
    """A name in TeX."""
    plain = name.rstrip("'")
    base, *below = plain.split("_")
    numbered = re.fullmatch(r"([A-Za-z])(\d+)", base)
    if numbered:
        base, below = numbered[1], [numbered[2], *below]
    low = r"\,".join(_letters(b) for b in below)
    primes = "'" * (len(name) - len(plain))
    if low:
        low = f"_{low}" if len(low) == 1 else f"_{{{low}}}"
    return _letters(base) + low + primes


def _letters(word: str) -> str:
    if word in GREEK:
        return f"\\{word}"
    return word if len(word) == 1 or word.isdigit() else rf"\mathrm{{{word}}}"
