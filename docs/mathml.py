"""Formulas of the manual: blocks of TeX marked `math`, written as MathML, which browsers typeset without a
script.
"""

from __future__ import annotations

from typing import Any

from latex2mathml.converter import convert


def block(source: str, language: str, css_class: str, options: Any, md: Any, **kwargs: Any) -> str:
    """A block as the site shows it; the signature is that of a fence of pymdownx.superfences."""
    return f'<div class="{css_class}" style="margin: 0.6em 0">{convert(source, display="block")}</div>'
