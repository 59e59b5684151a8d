"""One colour convention: figures, and the boxes and plots of the studio."""

from __future__ import annotations

import re
from pathlib import Path

import matplotlib
import numpy as np
import pytest

import deodar as dd
from deodar.diagrams import wires
from deodar.figures import _style

PAGE = Path(__file__).parents[3] / "studio" / "src"
FIELD = ("activation", "output", "input", "interaction", "level")


def theme(scheme: str) -> dict[str, str]:
    """Return the colours of theme.css by name."""
    light, dark = re.findall(r":root[^{]*\{(.*?)\n\}", (PAGE / "theme.css").read_text(), re.S)
    return dict(re.findall(r"--([a-z-]+)\W+(#[0-9a-f]{6});", light if scheme == "light" else dark))


def plots(scheme: str) -> dict[str, str]:
    """Return the colours of the studio's boxes and plots by name."""
    colors = re.search(
        r"FIELD_COLORS = \{(.*?)\n\}", (PAGE / "plots" / "colors" / "colors.ts").read_text(), re.S
    )
    assert colors is not None
    part = re.search(rf"{scheme}: \{{(.*?)\}}", colors[1], re.S)
    assert part is not None
    return dict(re.findall(r'([a-z]+)\W+(#[0-9a-f]{6})"', part[1]))


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_plots_and_theme_of_the_studio_have_the_same_colours(scheme: str) -> None:
    assert plots(scheme) == {name: theme(scheme)[name] for name in FIELD}


def test_the_studio_has_the_colours_of_figures_on_a_light_page() -> None:
    palette = dd.figures.COLOR
    figures = {name: getattr(palette, name) for name in _style.PORTS}
    assert plots("light") == {**figures, "level": palette.threshold}
    assert (theme("light")["inhibition"], theme("light")["mixed"]) == (palette.inhibition, palette.mixed)
    assert {"+": palette.excitation, "-": palette.inhibition, "±": palette.mixed} == wires.COLORS


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_every_colour_of_the_studio_has_contrast_with_its_ground(scheme: str) -> None:
    ground = luminance(theme(scheme)["surface-raised"])
    for name in (*FIELD, "inhibition", "mixed"):
        one, other = sorted([luminance(theme(scheme)[name]), ground])
        assert (other + 0.05) / (one + 0.05) > 3, name


def luminance(color: str) -> float:
    """Return the relative luminance of a colour (WCAG 2)."""
    parts = [int(color[k : k + 2], 16) / 255 for k in (1, 3, 5)]
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in parts]
    return float(np.dot(linear, (0.2126, 0.7152, 0.0722)))


def test_maps_of_the_studio_and_of_figures_have_the_same_scales() -> None:
    text = (PAGE / "plots" / "colors" / "colors.ts").read_text()
    for name, colormap in (("viridis", dd.figures.SEQUENTIAL), ("diverging", dd.figures.DIVERGING)):
        entries = re.search(rf"\n  {name}: \[(.*?)\]", text, re.S)
        assert entries is not None
        anchors = re.findall(r"#[0-9a-f]{6}", entries[1])
        for color, place in zip(anchors, np.linspace(0, 1, len(anchors)), strict=True):
            rgb = np.array([int(color[k : k + 2], 16) for k in (1, 3, 5)])
            assert np.abs(rgb - 255 * np.array(matplotlib.colormaps[colormap](place)[:3])).max() < 4
    assert 'sequential = scale("viridis")' in text


def test_a_line_has_the_colour_of_its_port() -> None:
    model = dd.Model("one field")
    model.add(dd.Field("u", [dd.Axis("x", 0, 10, samples=11)]))
    paths = [f"u.{port}" for port in _style.PORTS]
    record = dd.simulate(model, 2, record=paths)
    for port, path in zip(_style.PORTS, paths, strict=True):
        for draw in (dd.time_course, dd.snapshot):
            [axes] = draw(record[path]).axes
            assert axes.get_lines()[0].get_color() == getattr(dd.figures.COLOR, port)
    assert _style.port_color("u.rate") == dd.figures.COLORS[0]
