"""Environments of Gymnasium by name: the import, an extra, and the argument on the command line."""

from __future__ import annotations

import contextlib
from collections.abc import Generator, Mapping
from typing import Any

from deodar import codec
from deodar.errors import MissingExtra, WorldError, did_you_mean, first_line

OWN = ("period", "at_end")
"""Settings of the world; all others are those of the environment."""

WORDS = {"yes": True, "true": True, "no": False, "false": False, "none": None}


def parse_argument(argument: str) -> tuple[str, dict[str, Any], dict[str, Any]]:
    """Parse `NAME, SETTING=VALUE, ...` into the name, settings of the world, and those of the environment.

    An example is `MountainCarContinuous-v0, period=10, goal_velocity=0.02`. A value is a number, yes, no,
    none, or text.

    Raises:
        WorldError: a piece is no setting.
    """
    where = f"gym:{argument}"
    name, *pieces = (piece.strip() for piece in argument.split(","))
    if not name:
        raise WorldError("needs the name of an environment", where=where, fix="Write gym:CartPole-v1")
    require_registered(name, where)
    own, settings = dict[str, Any](), dict[str, Any]()
    for piece in pieces:
        key, equal, value = (part.strip() for part in piece.partition("="))
        if not equal or not key.isidentifier():
            raise WorldError(f"{piece!r} is no setting", where=where, fix="Write NAME=VALUE after a comma")
        (own if key in OWN else settings)[key] = _value(value)
    return name, own, settings


def require_registered(name: str, where: str) -> None:
    """Refuse `MODULE:NAME`, which would import the module: text of files and records runs no code."""
    if ":" in name:
        raise WorldError(
            f"{name!r} names a module, which is not imported from text",
            where=where,
            fix="In a script: dd.Gymnasium(...) of a function that returns the environment",
        )


def _value(text: str) -> Any:
    if text.lower() in WORDS:
        return WORDS[text.lower()]
    try:
        found = codec.parse(text)
    except ValueError:
        return text
    return found if isinstance(found, (int, float)) else text


REGISTERS = "dm_control"
"""Namespace of the environments that the package shimmy registers when it is imported."""


def package() -> Any:
    """Import Gymnasium, or raise an error that says how to install it."""
    try:
        # an extra
        import gymnasium as found
    except ImportError:
        raise MissingExtra("gymnasium", "gym", "an environment of Gymnasium") from None
    return found


def made(name: str, settings: Mapping[str, Any]) -> Any:
    """Return a new environment of a registered name.

    Raises:
        WorldError: there is no such environment, it needs another package, or refuses its settings.
    """
    gymnasium, absent = package(), False
    if name.startswith(f"{REGISTERS}/"):
        try:
            # registers them
            import shimmy  # noqa: F401  # pyright: ignore[reportMissingImports, reportUnusedImport]
        except ImportError:
            absent = True
    try:
        return gymnasium.make(name, disable_env_checker=True, **settings)
    except gymnasium.error.UnregisteredEnv as error:
        install = "Type: pip install 'shimmy[dm-control]'"
        raise WorldError(
            f"there is no such environment: {first_line(error)}",
            where=name,
            fix=install if absent else did_you_mean(name, gymnasium.registry),
        ) from None
    except Exception as error:  # constructors of environments may raise any exception
        fix = "Install what it needs" if isinstance(error, ImportError) else "Check the settings"
        raise WorldError(
            f"the environment could not be made: {type(error).__name__}: {first_line(error)}",
            where=name,
            fix=fix,
        ) from error


@contextlib.contextmanager
def errors_in(name: str, method: str) -> Generator[None]:
    """Raise WorldError from any exception that a method of an environment raises."""
    try:
        yield
    except (WorldError, MemoryError):
        raise
    except Exception as error:  # an environment may raise any exception
        raise WorldError(
            f"the environment raised {type(error).__name__} in {method}: {first_line(error)}", where=name
        ) from error
