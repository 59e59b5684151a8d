"""The package Gymnasium, and the environments that it makes by name."""

from __future__ import annotations

import contextlib
from collections.abc import Generator, Mapping
from typing import Any

from deodar.errors import MissingExtra, WorldError, did_you_mean, first_line

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
