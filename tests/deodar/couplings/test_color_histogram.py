"""The colours of each column, against counted pixels."""

from __future__ import annotations

import colorsys

import numpy as np
import pytest

import deodar as dd
from deodar.couplings.pictures import ColorHistogram
from deodar.couplings.projections import Project
from deodar.elements.stimuli import Pattern
from deodar.errors import ModelError

COLUMNS, ROWS, CHANNEL = dd.Axis("column", 0, 11, 12), dd.Axis("row", 0, 7, 8), dd.Axis("channel", 0, 2, 3)
HUE = dd.Axis("hue", 0, 360, 36, periodic=True, unit="deg")


def histograms(pixels, histogram, axes=(COLUMNS, ROWS)):
    model = dd.Model("picture")
    model.add(Pattern("picture", [*axes, CHANNEL], pixels)) >> model.add(histogram)
    return dd.simulate(model, 1, dt=1.0, record="h.output", precision="float64")["h.output"].values[-1]


def counted(pixels, palest=0.3, darkest=0.15, bins=36):
    """Count pixel by pixel, with another conversion to hue and saturation."""
    y = np.zeros((len(pixels), bins))
    for x, column in enumerate(pixels):
        for red, green, blue in column:
            hue, saturation, value = colorsys.rgb_to_hsv(red, green, blue)
            if saturation >= palest and value >= darkest:
                low = int(hue * bins)
                y[x, low % bins] += (1 - (hue * bins - low)) / len(column)
                y[x, (low + 1) % bins] += (hue * bins - low) / len(column)
    return y


PIXELS = np.random.default_rng(4).random((12, 8, 3)) * np.random.default_rng(5).choice([0.2, 1.0], (12, 8, 1))


def test_the_histogram_is_the_share_of_pixels_of_each_hue():
    np.testing.assert_allclose(
        histograms(PIXELS, ColorHistogram([COLUMNS, HUE], name="h")), counted(PIXELS), atol=1e-12
    )
    strict = ColorHistogram([COLUMNS, HUE], palest=0.7, darkest=0.6, name="h")
    np.testing.assert_allclose(histograms(PIXELS, strict), counted(PIXELS, 0.7, 0.6), atol=1e-12)


def test_columns_or_rows_of_the_picture_may_be_kept():
    y = histograms(PIXELS.transpose(1, 0, 2), ColorHistogram([COLUMNS, HUE], name="h"), (ROWS, COLUMNS))
    np.testing.assert_allclose(y, counted(PIXELS), atol=1e-12)


def test_smoothing_keeps_a_full_column_at_one():
    pixels = np.zeros((12, 8, 3))
    for x, hue in enumerate(np.arange(12) * 30):
        pixels[x, : 8 if x != 5 else 2] = colorsys.hsv_to_rgb(hue / 360, 0.9, 0.8)
    y = histograms(pixels, ColorHistogram([COLUMNS, HUE], sigma=20.0, name="h"))
    d = HUE.points - np.arange(12)[:, None] * 30
    d -= 360 * np.round(d / 360)
    share = np.where(np.arange(12) == 5, 0.25, 1.0)[:, None]
    np.testing.assert_allclose(y, share * np.exp(-0.5 * (d / 20) ** 2), atol=1e-9)


def test_columns_of_a_coarser_grid_are_the_means_of_their_pixels():
    coarse = dd.Axis("column", 0.5, 10.5, 6)
    y = histograms(PIXELS, ColorHistogram([coarse, HUE], name="h"))
    np.testing.assert_allclose(y, counted(PIXELS).reshape(6, 2, 36).mean(1), atol=1e-12)


def test_grey_and_dark_pixels_have_no_hue():
    grey, dark = np.full((12, 8, 3), 0.5), np.zeros((12, 8, 3))
    dark[..., 0] = 0.1
    for pixels in (grey, dark):
        assert not histograms(pixels, ColorHistogram([COLUMNS, HUE], palest=0.0, name="h")).any()


def test_projections_give_the_position_and_the_hues_of_blocks():
    """A red block on the left and a blue one on the right, projected to columns and to hues."""
    pixels = np.full((12, 8, 3), 0.6)
    pixels[2:4, 3:7], pixels[8:11, 1:] = (0.9, 0.1, 0.1), (0.1, 0.1, 0.9)
    model = dd.Model("blocks")
    histogram = model.add(ColorHistogram([COLUMNS, HUE], name="h"))
    model.add(Pattern("picture", [COLUMNS, ROWS, CHANNEL], pixels)) >> histogram
    histogram >> model.add(Project([COLUMNS], "sum", name="where"))
    histogram >> model.add(Project([HUE], "max", name="which"))
    record = dd.simulate(model, 1, dt=1.0, record=["where.output", "which.output"])
    np.testing.assert_allclose(
        record["where.output"].values[-1], np.repeat([0, 0.5, 0, 7 / 8, 0], [2, 2, 4, 3, 1]), atol=1e-6
    )
    which = record["which.output"].values[-1]
    assert (
        which[0] == pytest.approx(0.5)
        and which[24] == pytest.approx(7 / 8)
        and np.count_nonzero(which > 1e-6) == 2
    )


@pytest.mark.parametrize(
    ("axes", "problem"),
    [
        ([COLUMNS], "needs a picture"),
        ([dd.Axis("place", 0, 11, 12), HUE], "'place' does not fit the picture's: column and row there"),
        ([dd.Axis("column", 0, 100, 12), HUE], "'column' does not fit the picture's"),
        ([COLUMNS, dd.Axis("hue", 0, 360, 36)], "must be periodic"),
    ],
)
def test_axes_that_do_not_fit_are_reported(axes, problem):
    with pytest.raises(ModelError, match=problem):
        histograms(PIXELS, ColorHistogram(axes, name="h"))
