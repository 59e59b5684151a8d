"""Every registered kind can be drawn, and states the sign of its effect."""

from __future__ import annotations

import xml.etree.ElementTree as ET

import pytest

import deodar as dd
from tests.contracts.build import KINDS, PARTS, any_example, around


@pytest.mark.parametrize("kind", [*KINDS, *PARTS])
def test_every_kind_can_be_drawn(kind: str) -> None:
    element = any_example(kind)
    model = around(element)
    assert element.polarity() in ("+", "-", "±") and set(element.recurrence().values()) <= {"+", "-", "±"}
    drawn = ET.fromstring(dd.draw(model).svg)
    text = "".join(drawn.itertext())
    assert "example" in text and all(f"to {port}" in text for port in element.ports())
