"""Exceptions of worlds from outside deodar, as errors that name the world, its method and the line."""

from __future__ import annotations

import contextlib
import sys
import traceback
from collections.abc import Generator
from dataclasses import FrozenInstanceError
from pathlib import Path

from deodar import registry
from deodar.credentials import masked
from deodar.errors import DeodarError, WorldError, first_line, show
from deodar.kind_errors import problem_of, rule_of
from deodar.worlds._base import World


@contextlib.contextmanager
def errors_of(world: World | type[World], method: str, argument: str = "") -> Generator[None]:
    """Raise WorldError from any exception of a world that a package or a script defines.

    Errors of deodar, a lack of memory and exceptions of deodar's own worlds pass unchanged; so do Ctrl-C and
    SystemExit.

    Args:
        world: the world, or its class.
        method: name of the method that is called.
        argument: the text that a user gave to `open`, to state in the message.
    """
    kind = world if isinstance(world, type) else type(world)
    try:
        yield
    except (DeodarError, MemoryError):
        raise
    except Exception as error:  # a method may raise any exception
        if registry.own(kind):
            raise
        # worlds are not frozen: such an error is of an object of the user
        broken = None if isinstance(error, FrozenInstanceError) else rule_of(error)
        if broken is not None or isinstance(error, NotImplementedError):
            problem = problem_of(error, kind)
            raise WorldError(problem.what, fix=problem.fix) from error
        name, line = _position(kind, error)
        package = registry.package(kind.__name__)
        origin = f"package {package}" if package else f"module {kind.__module__}"
        fix = f"correct {kind.__name__}.{name or method}"
        if package:
            fix = f"report this to the authors of {package.split()[0]}"
        if argument:
            fix = f"check the argument {show(masked(argument))}; if it is right, {fix}"
        raise WorldError(
            f"the world {kind.__name__} of the {origin} raised {type(error).__name__} in"
            f" {name or method}{line}: {first_line(error)}",
            fix=fix[0].upper() + fix[1:],
        ) from error


def _position(kind: type[World], error: Exception) -> tuple[str, str]:
    """Return the method of the world's module that was called first, and the last line of that module.

    JAX calls methods of pure worlds, such as `start` inside `reset`. Both are "" without a line of the module
    in the traceback.
    """
    file = getattr(sys.modules.get(kind.__module__), "__file__", None)
    frames = [frame for frame in traceback.extract_tb(error.__traceback__) if frame.filename == file]
    return (frames[0].name, f" ({Path(str(file)).name}, line {frames[-1].lineno})") if frames else ("", "")
