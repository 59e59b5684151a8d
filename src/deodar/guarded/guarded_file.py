"""The only way to code that reads files of others: a function that a child process calls.

A parser of another project may trust a file. A damaged or hostile one then ends the process, takes all of its
memory, or never ends; the child ends instead, and this process continues with an error that names the file.
The child has the rights of its user: this is a limit of memory and time, and no wall against a file that
takes control of a parser.
"""

from __future__ import annotations

import contextlib
import os
from collections.abc import Callable, Generator, Iterator
from dataclasses import dataclass
from typing import ParamSpec, TypeVar, cast

from deodar.errors import DeodarError
from deodar.guarded.channel import PlainData, error_of
from deodar.guarded.child import TAKEN, ChildRequest
from deodar.guarded.children import DAMAGED, Child, EndedChild, children

P = ParamSpec("P")
T = TypeVar("T")


@dataclass(frozen=True)
class GuardedFile:
    """The limits within which a child reads one file, and the error if they do not suffice.

    Attributes:
        kind: class of the error.
        where: the file.
        memory: bytes that a call may take besides what the child has; Linux alone can limit them.
        seconds: longest time of a call, and of each item of `items`; Windows has no limit.
    """

    kind: type[DeodarError]
    where: str
    memory: int = 2**31
    seconds: float = 60.0

    def call(self, function: Callable[P, T], *values: P.args, **named: P.kwargs) -> T:
        """Return what a function returns in a child.

        Args:
            function: a public function of a module. Values and result are plain data: None, bool, int, float,
                str, bytes, arrays of numbers, lists, and dicts with keys of text. A tuple arrives as a list.
            values: its arguments; a function among them is called in this process.
            named: none; all arguments are given by position.

        Raises:
            DeodarError: what the function raised; or an error of `kind`, because it raised something else,
                because the child ended, or because a limit does not suffice.
            TypeError: an argument is no plain data.
        """
        with self._busy_child(function, values) as child:
            return cast("T", self._content(*child.answer()))

    def items(
        self, function: Callable[P, Iterator[T]], *values: P.args, **named: P.kwargs
    ) -> Generator[T, None, None]:
        """Yield the items of a generator that a child runs, some of them ahead; see `call`.

        The child is used again when the last item was taken, or this generator is closed.
        """
        with self._busy_child(function, values) as child:
            try:
                taken = 0
                while (answer := child.answer())[0] == "item":
                    yield cast("T", answer[1])
                    taken += 1
                    if taken % TAKEN == 0:
                        child.say("taken")
                self._content(*answer)
            finally:
                if child.yields:
                    child.stop()

    @contextlib.contextmanager
    def _busy_child(self, function: Callable[P, T], values: tuple[object, ...]) -> Generator[Child]:
        name = f"{function.__module__}:{function.__name__}"
        plain = cast("tuple[PlainData, ...]", values)
        request = ChildRequest(name, plain, self.memory, self.seconds, _working_folder())
        with children().child(name) as child:
            child.request(request)
            try:
                yield child
            except EndedChild as error:
                raise self._error(str(error), error.fix) from None

    def _content(self, word: str, content: PlainData) -> PlainData:
        if word == "error":
            raise error_of(content)
        if word == "memory":
            raise self._error(f"it needs more than {self.memory / 2**30:g} GiB of memory")
        if word == "failed":
            raise self._error(str(content))
        return content

    def _error(self, why: str, fix: str = DAMAGED) -> DeodarError:
        return self.kind(f"cannot be read: {why}", where=self.where, fix=fix)


def _working_folder() -> str:
    """Return the working folder; "" if it was removed."""
    try:
        return os.getcwd()
    except FileNotFoundError:
        return ""
