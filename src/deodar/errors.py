"""Errors that say what is wrong, where, why, and what to type.

Every error that deodar raises on purpose is a `DeodarError`. Its message is one paragraph of up to four
parts: *what* is wrong, *where* (a path, and the line that declared it), *why* it is wrong, and a *fix* to
type. A fix that differs between a script, a shell and the page of the studio is a `Fix`.
"""

from __future__ import annotations

import contextlib
from collections.abc import Generator, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal, Self, TypeVar

from deodar.proposed_edit import EditValue, Medium, ProposedEdit, SetValues
from deodar.short_traceback import short_traceback
from deodar.similar import nearest
from deodar.summary import Summarised, Summary
from deodar.synonyms import KINDS, synonym

T = TypeVar("T")

Severity = Literal["problem", "warning"]

MEDIA: tuple[Medium, ...] = ("script", "shell", "page")

LONGEST = 4000
"""Most characters of where a problem is, of what it is, and of a fix that is text: a damaged file may hold
names of any length.
"""


class Fix(str):
    """What to do in a script, as text, with other words for a shell and for the page of the studio.

    Args:
        script: for readers of a script; where the other two are not given, for all.
        shell: for readers of a command's message.
        page: for readers of the page.

    >>> fix = Fix("Replace it: force=True", shell="Replace it: --force", page="Choose another name")
    >>> fix, fix.at("shell")
    ('Replace it: force=True', 'Replace it: --force')
    """

    shell: str
    page: str

    def __new__(cls, script: str, shell: str = "", page: str = "") -> Self:
        fix = super().__new__(cls, script)
        fix.shell, fix.page = shell or script, page or script
        return fix

    def at(self, place: Medium) -> str:
        """Return the text for a place."""
        return str(self) if place == "script" else getattr(self, place)

    def then(self, text: str) -> Fix:
        """Return this fix and another one, at each place."""
        return Fix(*(joined(self.at(place), worded(text).at(place)) for place in MEDIA))


class ConnectionFix(Fix):
    """A fix that is a connection of which the user chooses a part.

    Args:
        script: for readers of a script.
        page: for readers of the page, which has a button for the choice; "": the button says it all.
        ends: path of the source and its output port, path of the target and its input port. Both of an end
            are empty where the user chooses it; with both ends the user chooses a coupling between them.
        shell: for readers of a command's message; "": as for those of a script.
    """

    ends: tuple[str, str, str, str]

    def __new__(
        cls, script: str, page: str, ends: tuple[str, str, str, str], shell: str = ""
    ) -> ConnectionFix:
        fix = str.__new__(cls, script)
        fix.shell, fix.page, fix.ends = shell or script, page, ends
        return fix

    def __getnewargs__(self) -> Any:
        """Return the arguments, for copies and pickles."""
        return str(self), self.page, self.ends, self.shell

    @classmethod
    def into(cls, path: str, port: str = "input", otherwise: str = "") -> ConnectionFix:
        """Return the fix for an input port that nothing is connected to.

        >>> ConnectionFix.into("u", otherwise="or remove it")
        "Connect it: model.connect(..., 'u'); or remove it"
        """
        end = path if port == "input" else f"{path}.{port}"
        script = f"Connect it: model.connect(..., {end!r}){f'; {otherwise}' if otherwise else ''}"
        return cls(script, "", ("", "", path, port))

    @classmethod
    def out_of(cls, path: str, port: str, otherwise: str) -> ConnectionFix:
        """Return the fix for an element that nothing reads."""
        script = f"Connect it: model.connect({path!r}, ...); {otherwise}"
        return cls(script, "", (path, port, "", ""))


class WorldFix(Fix):
    """A fix that is another world, or another sensor or motor of the world, which the user chooses."""


class TrustFix(Fix):
    """A fix that is trust in the functions that a document names."""


class EditFix(Fix):
    """A fix that is an edit of the document; its text follows from the edit.

    Args:
        advice: what the edit does.
        edits: the edits, made together.
        otherwise: what else would help; a `Fix` where that differs between readers.

    >>> fix = EditFix("Change the sign", [SetValues((("resting_level", -5),), "u")])
    >>> fix, fix.at("shell")
    ('Change the sign: model.set("u.resting_level", -5)', 'Change the sign: --set u.resting_level=-5')
    """

    advice: str
    edits: tuple[ProposedEdit, ...]
    otherwise: str

    def __new__(cls, advice: str, edits: Iterable[ProposedEdit], otherwise: str = "") -> EditFix:
        edits = tuple(edits)
        texts = [f"{advice}: {' and '.join(edit.at(place) for edit in edits)}" for place in MEDIA]
        texts = [joined(text, worded(otherwise).at(place)) for text, place in zip(texts, MEDIA, strict=True)]
        fix = str.__new__(cls, texts[0])
        fix.shell, fix.page = texts[1:]
        fix.advice, fix.edits, fix.otherwise = advice, edits, otherwise
        return fix

    def __getnewargs__(self) -> Any:
        """Return the arguments, for copies and pickles."""
        return self.advice, self.edits, self.otherwise

    def with_edits(self, edits: Iterable[ProposedEdit]) -> EditFix:
        """Return the fix with other edits, such as the same ones of a certain element."""
        return EditFix(self.advice, edits, self.otherwise)

    def then(self, text: str) -> EditFix:
        """Return this fix and another one, as text."""
        return EditFix(self.advice, self.edits, worded(self.otherwise).then(text))


def worded(text: str) -> Fix:
    """Return a text as a fix, with the words for each reader."""
    return text if isinstance(text, Fix) else Fix(text)


def assign(advice: str, values: Mapping[str, EditValue], otherwise: str = "") -> EditFix:
    """Return a fix that sets parameters of the element that has the problem.

    Args:
        advice: what the edit does.
        values: the new values, by the paths of parameters inside the element.
        otherwise: what else would help.

    >>> assign("Change the sign", {"resting_level": -5}).edits
    (SetValues(values=(('resting_level', -5),), element=None),)
    """
    return EditFix(advice, [SetValues(tuple(values.items()))], otherwise)


def option(advice: str, name: str, text: str, argument: str = "", page: str = "") -> Fix:
    """Return advice that ends with an option of a command, and with the argument of a function.

    Args:
        advice: what is done with it.
        name: name of the argument; the option has hyphens.
        text: value of the option.
        argument: value of the argument; "": that of the option.
        page: what it is in the studio; "": the argument is named there, too.

    >>> option("Give a longer one:", "duration", "1000").at("shell")
    'Give a longer one: --duration 1000'
    """
    flag = f"--{name.replace('_', '-')} {text}".rstrip()
    return Fix(f"{advice} {name}={argument or text}", f"{advice} {flag}", page and f"{advice} {page}")


def joined(first: str, second: str) -> str:
    """Return two sentences as one text; either may be empty."""
    ended = first if first.endswith("...") else f"{first.rstrip('.')}."
    return f"{ended} {second}" if first and second else first or second


@dataclass(frozen=True, repr=False)
class Problem(Summarised):
    """One problem or warning: where, what, and what to type instead.

    A `problem` prevents a run. A `warning` does not: the model runs, but probably not as intended.
    """

    where: str
    what: str
    fix: str = ""
    severity: Severity = "problem"

    def __post_init__(self) -> None:
        for name in ("where", "what", "fix"):
            text: str = getattr(self, name)
            if len(text) > LONGEST and type(text) is str:
                object.__setattr__(self, name, f"{text[: LONGEST // 2]} ... {text[-LONGEST // 2 :]}")

    def __str__(self) -> str:
        return self.at("script")

    def at(self, place: Medium) -> str:
        """Return the message for a place."""
        text = f"{self.where}: {self.what}" if self.where else self.what
        return joined(text, self.fix_at(place))

    def fix_at(self, place: Medium) -> str:
        """Return what to do at a place."""
        return worded(self.fix).at(place)

    @property
    def edits(self) -> tuple[ProposedEdit, ...]:
        """The edits of the document that solve it; empty where the user has to decide."""
        return self.fix.edits if isinstance(self.fix, EditFix) else ()

    def _summary(self) -> Summary:
        return Summary(f"{self.severity}: {self}")


class DeodarError(Exception):
    """The base class of all errors raised on purpose; `problems` lists the problems, one entry each."""

    def __init__(self, what: str | Sequence[Problem], where: str = "", fix: str = "") -> None:
        if isinstance(what, str):
            self.problems: tuple[Problem, ...] = (Problem(where, what, fix),)
        else:
            self.problems = tuple(what)
        super().__init__(self.at("script"))

    def __reduce__(self) -> Any:
        """Pickle all attributes, whatever the arguments of the class, so that an error can cross
        processes.
        """
        return _again, (type(self), self.args, self.__dict__)

    def advise(self, text: str) -> None:
        """Append a sentence to what the message says to do."""
        *others, last = self.problems
        self.problems = (*others, replace(last, fix=worded(last.fix).then(text)))
        self.args = (self.at("script"),)

    def inside(self, place: object, mark: str = ":") -> list[Problem]:
        """Return the problems as those of a place, such as a file, in which each is at its own `where`."""
        return [
            replace(p, where=f"{place}{mark} {p.where}" if p.where else str(place)) for p in self.problems
        ]

    def _render_traceback_(self) -> list[str]:
        """Return the lines that IPython shows: without the frames of deodar."""
        return short_traceback(self)

    def at(self, place: Medium) -> str:
        """Return the message for a place."""
        if len(self.problems) == 1:
            return self.problems[0].at(place)
        lines = [f"{len(self.problems)} problems"]
        lines += [f"  {number}. {problem.at(place)}" for number, problem in enumerate(self.problems, 1)]
        return "\n".join(lines)


class ParameterError(DeodarError):
    """Raised when a parameter has the wrong type, lies outside its range, or does not exist."""


class UnknownName(DeodarError):
    """Raised when a name (element, port, parameter, kind, command) does not exist; suggests the nearest
    one.
    """


class UnknownAttribute(UnknownName, AttributeError):
    """Raised when an element's handle lacks a parameter; also an `AttributeError`, so that `hasattr`
    works.
    """

    def __init__(self, what: str | Sequence[Problem], where: str = "", fix: str = "") -> None:
        super().__init__(what, where, fix)
        self.name = self.obj = None  # pyright: ignore[reportAttributeAccessIssue]  # the message suggests a name; Python would add a second suggestion


class AxesError(DeodarError):
    """Raised when axes are invalid or do not match each other."""


class ModelError(DeodarError):
    """Raised when a model is invalid: duplicate names, ports that do not match, loops without a state."""


class KindError(ModelError):
    """Raised when the code of a kind that a package or script defines raises any other exception or returns
    what its contract does not allow; names the class (`kind`), the file and the line. Worlds raise
    WorldError.
    """

    def __init__(self, what: str | Sequence[Problem], where: str = "", fix: str = "", kind: str = "") -> None:
        self.kind = kind
        super().__init__(what, where, fix)


class DocumentError(DeodarError):
    """Raised when a document file cannot be read: not JSON, unknown version or kind, or an array file of
    another document.
    """


class Untrusted(DeodarError):
    """Raised when a document contains a custom function and is not trusted."""


class WorldError(DeodarError):
    """Raised when a world cannot provide the reading of a sensor, a model reads sensors without a world, or a
    method of a world that a package or script defines raises any other exception.
    """


class TimeError(DeodarError):
    """Raised when durations and steps do not match: not a multiple of dt, or a step longer than a time
    constant.
    """


class ThreadError(DeodarError):
    """Raised when a thread calls a session in which another thread is."""


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
    """Warns that copies or trials of a run diverged, that it has at least 10^9 steps, or that a part of a
    record is damaged.
    """


class TooLarge(DeodarError):
    """Raised before an allocation that would not fit into memory."""


class CoresError(DeodarError):
    """Raised on an attempt to change the number of cores after JAX has started."""


class DeviceError(DeodarError):
    """Raised when a requested device does not exist, or JAX has started it in another way."""


class HostsError(DeodarError):
    """Raised when hosts that compute one model together differ, or one of them has ended."""


class WorkerError(DeodarError):
    """Raised when worker processes cannot execute a run: an object cannot be pickled, or a worker has
    died.
    """


class OutputExists(DeodarError):
    """Raised before overwriting a file that this run did not write."""


class OutputError(DeodarError):
    """Raised when a file or folder cannot be written."""


class RecordError(DeodarError):
    """Raised when a record cannot be read, drawn or repeated."""


class DamagedFile(RecordError):
    """Raised when the content of a stored file is not what was written."""


class GraphError(DeodarError):
    """Raised when a file of NIR cannot be read, or its graph cannot be simulated."""


class FigureError(DeodarError):
    """Raised when the file of a figure cannot be read."""


class DerivativeError(DeodarError):
    """Raised where a gradient passes through a jump, which has no derivative."""


class AnalysisError(DeodarError):
    """Raised when a measurement does not apply to its argument."""


class MissingExtra(DeodarError):
    """Raised when an optional part of deodar is needed and not installed."""

    def __init__(self, package: str, extra: str, purpose: str) -> None:
        super().__init__(
            f"{purpose} needs the package {package}, which is not installed",
            fix=f"Type: pip install 'deodar[{extra}]'",
        )


class Interrupted(KeyboardInterrupt):
    """Raised when a run is stopped with Ctrl-C; `data` is the record until then (an `xarray.Dataset`).

    It is no `DeodarError`, so that a loop that continues after errors can be stopped.
    """

    def __init__(self, what: str, data: Any) -> None:
        self.data = data
        super().__init__(what)

    def __reduce__(self) -> Any:
        """Pickle it with its data, as errors are."""
        return _again, (type(self), self.args, self.__dict__)


@contextlib.contextmanager
def reading(path: object, kind: type[DeodarError]) -> Generator[None]:
    """Name the file that is read inside a block in its errors, which become errors of one class.

    Args:
        path: the file.
        kind: the class, also of errors of the system.
    """
    try:
        yield
    except DeodarError as error:
        raise kind(error.inside(path)) from None
    except OSError as error:
        raise kind(f"cannot be read: {error.strerror}", where=str(path)) from None


def _again(kind: type[DeodarError], args: tuple[Any, ...], state: dict[str, Any]) -> DeodarError:
    error = kind.__new__(kind, *args)
    error.__dict__.update(state)
    return error


def problems_of(error: BaseException) -> tuple[Problem, ...]:
    """Return the problems of an error of any class, such as one of a function that a document names."""
    if isinstance(error, DeodarError):
        return error.problems
    return (Problem("", f"{type(error).__name__}: {error}"),)


def did_you_mean(name: str, known: Iterable[str], kind: str = "") -> str:
    """Return a hint with the name that is meant, or with the known names, at most twelve.

    Meaning comes before spelling: what papers and other tools call a parameter, then slips of typing.

    Args:
        name: the name that is not known.
        known: the names of things that could be meant here, such as sensors for a sensor.
        kind: what has the name, in the table of synonyms: "" for none, `KINDS` for a kind.

    >>> did_you_mean("restng_level", ["tau", "resting_level"])
    "Did you mean 'resting_level'?"
    """
    names = sorted(set(known))
    row = synonym(kind, name) if kind else None
    meant = row.path if row is not None and row.path in names else nearest(name, names)
    if meant:
        return f"Did you mean {meant!r}?"
    if not names:
        return ""
    listed = [*map(_shortened, names[:12]), *(["..."] if len(names) > 12 else [])]
    return f"Valid names: {', '.join(listed)}"


def no_attribute(module: str, name: str, known: Iterable[str]) -> AttributeError:
    """Return the error for a name that a module does not have, with the nearest known name.

    A private name, which Python and tools look up by themselves, suggests nothing.
    """
    hint = "" if name.startswith("_") else did_you_mean(name, known, KINDS)
    text = f"module {module!r} has no attribute {name!r}"
    return AttributeError(f"{text}. {hint}" if hint else text, name=name, obj=None)


def first_line(error: BaseException) -> str:
    """Return the first line of the message of an error that deodar did not raise."""
    return (str(error).strip() or "no message").splitlines()[0]


def show(value: Any) -> str:
    """Return any value as one short line, for messages."""
    if isinstance(value, type):
        return f"the class {value.__name__}"
    try:
        text = " ".join(repr(value).split()) if not isinstance(value, str) else repr(value)
    except Exception as error:  # a number of thousands of digits, or an object whose repr raises
        text = f"{type(value).__name__} ({error})"
    if " at 0x" in text:
        text = f"{an(type(value).__name__)}"
    return _shortened(text)


def _shortened(text: str) -> str:
    return text if len(text) <= 60 else f"{text[:57]}..."


def instance_of(kind: type[T], argument: object, where: str) -> T:
    """Return an argument that is an object of a class.

    Args:
        kind: the class.
        argument: what was given for it.
        where: its name.

    Raises:
        ParameterError: it is something else, such as a dict of the fields.
    """
    if not isinstance(argument, kind):
        problem, fix = (
            f"needs {an(kind.__name__)}, not {show(argument)}",
            f"Write: {where}={kind.__name__}(...)",
        )
        raise ParameterError(problem, where=where, fix=fix)
    return argument


def an(name: str) -> str:
    """Return a name with its article: an Axis, a Kernel."""
    return f"{'an' if name[0] in 'AEIOUaeiou' else 'a'} {name}"
