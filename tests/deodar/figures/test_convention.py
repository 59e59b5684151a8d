"""One colour convention: figures, and the boxes and plots of the studio."""

from __future__ import annotations

import re
from pathlib import Path

import matplotlib
import numpy as np
import pytest
from matplotlib.colors import to_hex

import deodar as dd
from deodar.diagrams import wires
from deodar.figures import _color, _style

PAGE = Path(__file__).parents[3] / "studio" / "src"
FIELD = ("activation", "ember", "output", "input", "interaction", "level")


def theme(scheme: str) -> dict[str, str]:
    """Return the colours of theme.css by name."""
    light, dark = re.findall(r":root[^{]*\{(.*?)\n\}", (PAGE / "theme.css").read_text(), re.S)
    return dict(re.findall(r"--([a-z-]+)\W+(#[0-9a-f]{6});", light if scheme == "light" else dark))


def plots(scheme: str) -> dict[str, str]:
    """Return the colours of the studio's boxes and plots by name."""
    colors = re.search(r"FIELD_COLORS = \{(.*?)\n\}", (PAGE / "model" / "colors.ts").read_text(), re.S)
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
    assert plots("light") == {**figures, "level": palette.threshold, "ember": plots("light")["ember"]}
    assert (theme("light")["inhibition"], theme("light")["mixed"]) == (palette.inhibition, palette.mixed)
    assert {"+": palette.excitation, "-": palette.inhibition, "±": palette.mixed} == wires.COLORS


GROUNDS = ("page", "panel", "sunk")
PAIRS = [
    *[("text", ground, 7.0) for ground in GROUNDS],
    *[("dim", ground, 4.5) for ground in GROUNDS],
    *[(name, "panel", 4.5) for name in FIELD],
    *[(name, "panel", 3.0) for name in ("edge", "inhibition", "mixed")],
    *[(name, "panel", 4.5) for name in ("accent", "warn", "error")],
    *[(name, f"{name}-soft", 4.5) for name in ("accent", "warn", "error")],
    ("accent-on", "accent", 4.5),
]
"""Colour, its ground, and the least contrast (WCAG 2: 3 for lines that carry a meaning, 4.5 for text; 7 for
the text of the page).
"""


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize(("name", "ground", "least"), PAIRS)
def test_a_colour_of_the_studio_has_contrast_with_its_ground(
    scheme: str, name: str, ground: str, least: float
) -> None:
    colors = theme(scheme)
    low, high = sorted([luminance(colors[name]), luminance(colors[ground])])
    assert (high + 0.05) / (low + 0.05) >= least


def luminance(color: str) -> float:
    """Return the relative luminance of a colour (WCAG 2)."""
    parts = [int(color[k : k + 2], 16) / 255 for k in (1, 3, 5)]
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in parts]
    return float(np.dot(linear, (0.2126, 0.7152, 0.0722)))


def anchors(name: str) -> list[str]:
    """Return the colours between which a scale of the studio is interpolated."""
    text = (PAGE / "model" / "colors.ts").read_text()
    entries = re.search(rf"\n  {name}:(.*?),\n", text, re.S)
    assert entries is not None
    return re.findall(r"#[0-9a-f]{6}", entries[1])


def test_the_map_of_activation_is_one_in_the_studio_and_in_figures() -> None:
    assert anchors("diverging") == [*_style.BELOW[::-1], *_style.ABOVE[1:]]
    colors = anchors("viridis")
    for color, place in zip(colors, np.linspace(0, 1, len(colors)), strict=True):
        rgb = np.array([int(color[k : k + 2], 16) for k in (1, 3, 5)])
        assert np.abs(rgb - 255 * np.array(matplotlib.colormaps["viridis"](place)[:3])).max() < 4


@pytest.mark.parametrize("side", [_style.BELOW, _style.ABOVE])
def test_lightness_falls_on_both_sides_of_the_threshold(side: tuple[str, ...]) -> None:
    lightness = [luminance(color) for color in side]
    assert lightness == sorted(lightness, reverse=True)


@pytest.mark.parametrize(("low", "high", "threshold"), [(-10, 4, 0), (-3, 9, 1), (-10.3, 3.7, 0.1)])
def test_activation_takes_all_colours_on_each_side_and_is_white_at_the_threshold(
    low: float, high: float, threshold: float
) -> None:
    scale = _color.scale([np.array([low, high])], threshold)
    values = np.array([low, threshold, high])
    assert [to_hex(c) for c in scale.to_rgba(values)] == [_style.BELOW[-1], "#ffffff", _style.ABOVE[-1]]


def test_a_value_just_above_the_threshold_of_a_field_at_rest_is_pale() -> None:
    scale = _color.scale([np.array([-9.0, 0.5])], 0.0)
    assert luminance(to_hex(scale.to_rgba(0.5))) > 0.6


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


def test_the_map_of_amounts_is_one_in_the_studio_and_in_figures() -> None:
    """One hue, from the colour of nothing to that of the port, and to that of interaction for all others."""
    text = (PAGE / "model" / "colors.ts").read_text()
    sunk = re.search(r'SUNK = \{ light: "(#\w+)", dark: "(#\w+)" \}', text)
    assert sunk is not None and sunk.groups() == (theme("light")["sunk"], theme("dark")["sunk"])
    assert sunk[1] == _style.SUNK == to_hex(dd.figures.AMOUNTS(0.0))
    assert to_hex(dd.figures.AMOUNTS(1.0)) == plots("light")["interaction"]


def test_the_page_names_no_colour_that_it_does_not_have() -> None:
    styles = [*PAGE.rglob("*.css"), *PAGE.rglob("*.ts"), *PAGE.rglob("*.tsx")]
    text = "\n".join(path.read_text() for path in styles)
    named = set(re.findall(r"var\((--(?!mantine|xy)[a-z][a-z-]*)\)", text))
    stated = set(re.findall(r"(--[a-z][a-z-]*)\"?\]?\s*:", text)) | set(re.findall(r'"(--[a-z-]+)"', text))
    assert named <= stated, sorted(named - stated)
