"""What a good refusal looks like."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from deodar.errors import DeodarError


def refused(
    call: Callable[[], Any], error: type[DeodarError] | tuple[type[DeodarError], ...], *says: str
) -> str:
    """Run what must be refused; its message, one paragraph that holds every piece of `says`."""
    with pytest.raises(DeodarError) as caught:
        call()
    text = str(caught.value)
    assert isinstance(caught.value, error), f"{type(caught.value).__name__}: {text}"
    paragraph(text)
    for piece in says:
        assert piece in text, f"{piece!r} is not in: {text}"
    return text


def paragraph(text: str) -> None:
    """One paragraph, not too long to read, without the marks of a traceback."""
    assert text.strip() and "\n\n" not in text
    assert len(text) < 2000
    assert "Traceback" not in text and "<class" not in text and "object at 0x" not in text
