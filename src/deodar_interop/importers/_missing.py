"""What has no translation: a placeholder keeps the name and the connections, and the report says why."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import TypeVar

from deodar.errors import DeodarError, did_you_mean
from deodar.importers.report import Line
from deodar_interop.importers._axes import SizeLimit
from deodar_interop.importers._piece import Unfit

Translated = TypeVar("Translated")


def unknown(kind: str, missing: str, known: Sequence[str]) -> str:
    """Return what is missing for an unknown kind, with the name that may be meant."""
    hint = did_you_mean(kind, known)
    return missing + (f". {hint}" if hint.startswith("Did") else "")


def or_placeholder(
    translate: Callable[[], Translated], placeholder: Callable[[str], Translated]
) -> Translated:
    """Return a translation, or a placeholder with the reason if the parameters contradict each other."""
    try:
        return translate()
    except (Unfit, SizeLimit) as error:
        return placeholder(str(error))
    except (DeodarError, ValueError, TypeError, IndexError, OverflowError) as error:
        return placeholder(f"its parameters are inconsistent ({error})")


def placeholder_lines(label: str, parameters: Iterable[str]) -> list[Line]:
    """Return the report lines of the parameters of an element that is a placeholder."""
    why = "its element is a placeholder"
    return [Line(label, "parameter", name, "dropped", why) for name in parameters]
