"""The figure of a search by colour: panels, scales and marks, from a constructed record."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import xarray
from matplotlib.figure import Figure
from matplotlib.patches import Circle

from deodar.architectures.saliency import CUE_AT
from deodar.figures._style import COLORS
from deodar.worlds.picture import Picture
from deodar_papers.figures.cues import cues_figure

X, HUE = np.arange(1.0, 80, 2), np.arange(0.0, 360, 15)
TIME = np.arange(0.0, 2 * CUE_AT, CUE_AT / 10)
PEAK, PLACE = (31.0, 52.0), (20.0, 12.0)


@pytest.fixture(scope="module")
def drawn() -> Figure:
    """Return the figure of two cues: a peak for the first, none for the second."""
    dims = ("cue.center", "time")
    seen = np.random.default_rng(0).normal(-3, 2, (2, len(TIME), len(X), len(HUE)))
    record = xarray.Dataset(
        {
            "seen.output": ((*dims, "x", "hue"), seen),
            "spatial.activation": ((*dims, "x", "y"), np.full((2, len(TIME), len(X), 30), -5.0)),
            "pan.output": (dims, np.tile(np.linspace(40, 31, len(TIME)), (2, 1))),
            "tilt.output": (dims, np.tile(np.linspace(40, 52, len(TIME)), (2, 1))),
        },
        {"time": TIME, "x": X, "y": np.arange(1.0, 60, 2), "hue": HUE},
    )
    cues = [
        SimpleNamespace(hue=hue, name=name, expect="", outlines=()) for hue, name in ((0, "red"), (240, ""))
    ]
    outcomes = [
        SimpleNamespace(cue=cues[0], places=[PLACE], spatial=[PEAK], motor=PLACE),
        SimpleNamespace(cue=cues[1], places=[], spatial=[], motor=PLACE),
    ]
    scene = SimpleNamespace(name="example", picture=Picture.example())
    result: Any = SimpleNamespace(record=record, outcomes=outcomes, scene=scene, corners=(0, 9, 9, 0))
    return cues_figure(result)


def panels(drawn: Figure) -> np.ndarray:
    return np.array(drawn.axes[:12], object).reshape(3, 4)


def test_every_cell_of_the_colour_space_is_centred_on_its_sample(drawn: Figure) -> None:
    for axes in panels(drawn)[:, 1]:
        (image,) = axes.get_images()
        assert np.asarray(image.get_array()).shape == (len(HUE), len(X))
        assert tuple(image.get_extent()) == (0, 80, -7.5, 352.5) and axes.get_ylim() == (-7.5, 352.5)


def test_the_spatial_peak_is_a_dotted_line_for_each_motor_variable(drawn: Figure) -> None:
    for row, peaks in ((1, [PEAK]), (2, [])):
        lines = panels(drawn)[row, 3].get_lines()
        dotted = [
            (float(line.get_ydata()[0]), line.get_color()) for line in lines if line.get_linestyle() == ":"
        ]
        assert dotted == [(value, color) for p in peaks for value, color in zip(p, COLORS, strict=False)]
        thickness = {
            line.get_linestyle(): line.get_linewidth() for line in lines if line.get_linestyle() in "-:"
        }
        assert thickness.get(":", 0.0) < thickness["-"], "a reference line is thinner than a curve"
        ends = {str(line.get_label()): float(line.get_ydata()[-1]) for line in lines}
        assert ends["pan (x)"] == 31.0 and ends["tilt (y)"] == 52.0
        assert [line for line in lines if list(line.get_xdata()) == [CUE_AT / 1000] * 2]


def test_the_spatial_field_has_the_corners_of_the_picture_and_no_numbers(drawn: Figure) -> None:
    width, height = Picture.example().size
    for axes in panels(drawn)[1:, 2]:
        assert (axes.get_xlim(), axes.get_ylim()) == ((0, width), (height, 0))
        assert not [*axes.get_xticks(), *axes.get_yticks()]


def test_the_selected_place_is_a_circle_in_the_picture(drawn: Figure) -> None:
    labels = [axes.get_ylabel() for axes in panels(drawn)[:, 0]]
    assert labels == ["no cue", "cue: red (0°)", "cue: hue (240°)"]
    for row, places in ((0, set()), (1, {PLACE}), (2, set())):
        axes = panels(drawn)[row, 0]
        assert {patch.center for patch in axes.patches if isinstance(patch, Circle)} == places
        assert [text.get_text() for text in axes.texts] == (["nothing selected"] if row == 2 else [])
