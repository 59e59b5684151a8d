"""The pictures of the gallery are what `examples/pictures.py` draws, in the colours of figures and studio."""

from __future__ import annotations

import importlib.util
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from PIL import Image

EXAMPLES = Path(__file__).parents[3] / "examples"


@pytest.fixture(scope="module")
def pictures() -> ModuleType:
    spec = importlib.util.spec_from_file_location("gallery_pictures", EXAMPLES / "pictures.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def pixels(path: Path) -> np.ndarray:
    """Return the red, green and blue of a picture, from 0 to 1."""
    return np.asarray(Image.open(path).convert("RGB"), float) / 255


@pytest.mark.parametrize("name", ["detection", "node"])
def test_a_stored_picture_of_the_gallery_is_what_its_function_draws(
    pictures: ModuleType, name: str, tmp_path: Path
) -> None:
    pictures.write(getattr(pictures, name)(), tmp_path / "drawn.png", photograph=False)
    drawn, stored = pixels(tmp_path / "drawn.png"), pixels(EXAMPLES / f"{name}.png")
    assert drawn.shape == stored.shape
    assert np.abs(drawn - stored).mean() < 0.005
    # the same picture in other colours, or turned, differs by more
    for wrong in (stored[..., ::-1], stored[:, ::-1]):
        assert np.abs(drawn - wrong).mean() > 0.02
