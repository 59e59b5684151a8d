"""Checks of refused calls and their messages."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from deodar.errors import DeodarError


def refused(
    call: Callable[[], Any], error: type[DeodarError] | tuple[type[DeodarError], ...], *says: str
) -> str:
    """Run a call that must be refused; return its message, one paragraph that contains every piece of
    `says`.
    """
    with pytest.raises(DeodarError) as caught:
        call()
    text = str(caught.value)
    assert isinstance(caught.value, error), f"{type(caught.value).__name__}: {text}"
    paragraph(text)
    for piece in says:
        assert piece in text, f"{piece!r} is not in: {text}"
    return text


def paragraph(text: str) -> None:
    """Require one short paragraph without the marks of a traceback."""
    assert text.strip() and "\n\n" not in text
    assert len(text) < 2000
    assert "Traceback" not in text and "<class" not in text and "object at 0x" not in text
