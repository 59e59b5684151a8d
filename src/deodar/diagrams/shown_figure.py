"""A figure of matplotlib that a notebook shows by itself."""

from __future__ import annotations

import io
import warnings
from collections.abc import Mapping
from typing import Any

import matplotlib
from matplotlib.figure import Figure


class ShownFigure(Figure):
    """A figure that a notebook shows by itself, once, because pyplot does not know it.

    It is a picture on the white page of its file, so it can be read in each theme.

    Attributes:
        settings: settings of matplotlib while the picture is drawn.
    """

    settings: Mapping[Any, Any] = {}

    def _repr_png_(self) -> bytes:
        picture = io.BytesIO()
        with matplotlib.rc_context(dict(self.settings)), warnings.catch_warnings():
            warnings.filterwarnings("ignore", message="Glyph .* missing")
            self.savefig(picture, format="png")
        return picture.getvalue()
