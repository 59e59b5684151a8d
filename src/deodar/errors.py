"""Errors that say what is wrong, where, why, and what to type.

Every error deodar raises on purpose is a `DeodarError`. Its message is one paragraph made of up to four
parts: *what* is wrong, *where* (a path, and the line that declared it), *why* it cannot be, and a *fix* to
type.
"""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any, Literal

Severity = Literal["problem", "warning"]


@dataclass(frozen=True)
class Problem:
    """One thing that is wrong: where, what, and what to type instead.

    A `problem` stops a run. A `warning` never does: the model runs, but probably not as it was meant.
    """

    where: str
    what: str
    fix: str = ""
    severity: Severity = "problem"

    def __str__(self) -> str:
        text = f"{self.where}: {self.what}" if self.where else self.what
        return f"{text.rstrip('.')}. {self.fix}" if self.fix else text


class DeodarError(Exception):
    """Base of every error raised on purpose; `problems` lists what is wrong, one entry each."""

    def __init__(self, what: str | Sequence[Problem], where: str = "", fix: str = "") -> None:
        if isinstance(what, str):
            self.problems: tuple[Problem, ...] = (Problem(where, what, fix),)
        else:
            self.problems = tuple(what)
        super().__init__(self._text())

    def __reduce__(self) -> Any:
        """An error crosses from one process to another whole, whatever its class takes."""
        return _again, (type(self), self.args, self.__dict__)

    def _text(self) -> str:
        if len(self.problems) == 1:
            return str(self.problems[0])
        lines = [f"{len(self.problems)} problems"]
        lines += [f"  {number}. {problem}" for number, problem in enumerate(self.problems, 1)]
        return "\n".join(lines)


class ParameterError(DeodarError):
    """Raised when a parameter has the wrong type, lies outside its range, or does not exist."""


class UnknownName(DeodarError):
    """Raised when a name (element, port, parameter, kind, command) does not exist; suggests the nearest
    one.
    """


class UnknownAttribute(UnknownName, AttributeError):
    """Raised when a handle of an element has no such parameter; an `AttributeError` too, so that `hasattr`
    answers.
    """

    def __init__(self, what: str | Sequence[Problem], where: str = "", fix: str = "") -> None:
        super().__init__(what, where, fix)
        self.name = self.obj = None  # pyright: ignore[reportAttributeAccessIssue]  # the message suggests a name; Python would add a second suggestion


class AxesError(DeodarError):
    """Raised when axes are impossible or do not fit each other."""


class ModelError(DeodarError):
    """Raised when an architecture cannot be: names that clash, ports that do not fit, loops without a
    state.
    """


class DocumentError(DeodarError):
    """Raised when a document file cannot be read: not JSON, unknown version or kind, an array file that is
    not its own.
    """


class Untrusted(DeodarError):
    """Raised when a document asks to run a user's function and nobody has said that it may be trusted."""


class WorldError(DeodarError):
    """Raised when a world cannot give what a sensor asks for, or a model reads sensors that no world
    provides.
    """


class TimeError(DeodarError):
    """Raised when durations and steps do not fit: not a multiple of dt, or a step longer than a time
    constant.
    """


class NotFinite(DeodarError):
    """Raised at the end of a chunk in which a value became infinite or undefined; names the step (`step`),
    and the elements in `paths`.
    """

    def __init__(
        self, what: str | Sequence[Problem], paths: Sequence[str] = (), fix: str = "", step: int = 0
    ) -> None:
        self.paths = tuple(paths)
        self.step = step
        super().__init__(what, fix=fix)


class RunWarning(UserWarning):
    """Warns that copies or trials of a run diverged, or that a run has at least 10^9 steps."""


class TooLarge(DeodarError):
    """Raised before allocating what would not fit into memory."""


class CoresError(DeodarError):
    """Raised when the number of cores is to be changed after JAX has started."""


class DeviceError(DeodarError):
    """Raised when a device is asked for that is not there."""


class WorkerError(DeodarError):
    """Raised when worker processes cannot do a run: something cannot be handed to them, or one of them has
    died.
    """


class OutputExists(DeodarError):
    """Raised before writing over something that this run did not write."""


class OutputError(DeodarError):
    """Raised when a file or folder cannot be written."""


class RecordError(DeodarError):
    """Raised when a record cannot be read, drawn or repeated."""


class AnalysisError(DeodarError):
    """Raised when a measurement does not apply to what it was asked of."""


class MissingExtra(DeodarError):
    """Raised when an optional part of deodar is needed and not installed."""

    def __init__(self, package: str, extra: str, purpose: str) -> None:
        super().__init__(
            f"{purpose} needs the package {package}, which is not installed",
            fix=f"Type: pip install 'deodar[{extra}]'",
        )


class Interrupted(DeodarError):
    """Raised when a run is stopped with Ctrl-C; `data` holds what was recorded until then (an
    `xarray.Dataset`).
    """

    def __init__(self, what: str, data: Any) -> None:
        self.data = data
        super().__init__(what)


def _again(kind: type[DeodarError], args: tuple[Any, ...], state: dict[str, Any]) -> DeodarError:
    error = kind.__new__(kind, *args)
    error.__dict__.update(state)
    return error


def did_you_mean(name: str, known: Iterable[str]) -> str:
    """A hint that names the nearest known name, or lists the few there are.

    >>> did_you_mean("restng_level", ["tau", "resting_level"])
    "Did you mean 'resting_level'?"
    """
    names = sorted(set(known))
    near = difflib.get_close_matches(name, names, n=1, cutoff=0.6)
    if near:
        return f"Did you mean {near[0]!r}?"
    if not names:
        return ""
    shown = ", ".join(names[:12]) + (", ..." if len(names) > 12 else "")
    return f"There is: {shown}"


def show(value: Any) -> str:
    """A value as messages show it: in one short line, whatever it is."""
    if isinstance(value, type):
        return f"the class {value.__name__}"
    try:
        text = " ".join(repr(value).split()) if not isinstance(value, str) else repr(value)
    except Exception as error:  # a number of thousands of digits, an object whose repr is broken
        text = f"{type(value).__name__} ({error})"
    if " at 0x" in text:
        text = f"{an(type(value).__name__)}"
    return text if len(text) <= 60 else f"{text[:57]}..."


def an(name: str) -> str:
    """A name with its article: an Axis, a Kernel."""
    return f"{'an' if name[0] in 'AEIOUaeiou' else 'a'} {name}"
