"""Figures of maps of regimes: colours, words and the cross."""

from __future__ import annotations

import numpy as np
from matplotlib.colors import to_hex

import deodar as dd
from deodar.analysis.maps.labels import WORDS, RegimeLabel
from deodar.figures.regime_map import REGIME_COLORS
from tests.deodar.analysis.maps.test_regime_map import EXCITATION, INHIBITION, line


def test_cells_have_the_colour_of_their_regime_and_the_legend_its_word():
    regime_map = dd.regime_map(line(31), {EXCITATION: (1, 30, 6), INHIBITION: (0, 1.2, 4)}, refine=False)
    figure = dd.regime_map_figure(regime_map)
    axes = figure.axes[0]
    cells = axes.collections[0]
    drawn = np.array([to_hex(c) for c in cells.to_rgba(np.asarray(cells.get_array()).ravel())]).reshape(4, 6)
    expected = np.vectorize(lambda label: REGIME_COLORS[RegimeLabel(label)])(regime_map.labels.T)
    assert (drawn == expected).all()
    texts = [text.get_text() for text in figure.legends[0].get_texts()]
    assert texts == [*(WORDS[k] for k in np.unique(regime_map.labels)), "the model"]
    assert (axes.get_xlabel(), axes.get_ylabel()) == (EXCITATION, INHIBITION)
    assert axes.get_xlim() == (1 - 2.9, 30 + 2.9)
    (cross,) = axes.lines
    assert (cross.get_xdata()[0], cross.get_ydata()[0]) == (8.0, 0.1)


def test_the_colours_differ_also_in_lightness_or_are_of_the_set_for_colour_blind_readers():
    assert len({*REGIME_COLORS.values()}) == len(RegimeLabel)
    assert {*REGIME_COLORS.values()} - {*dd.figures.COLORS} == {REGIME_COLORS[RegimeLabel.SILENT]}


def test_a_model_outside_of_the_map_has_no_cross():
    regime_map = dd.regime_map(line(31), {EXCITATION: [20, 30], INHIBITION: [0.2, 0.4]})
    figure = dd.regime_map_figure(regime_map)
    assert not figure.axes[0].lines
    assert "the model" not in [text.get_text() for text in figure.legends[0].get_texts()]
