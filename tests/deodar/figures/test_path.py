"""Paths in an arena, as a figure and as a GIF."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import xarray
from PIL import Image

from deodar.errors import DeodarError, RecordError
from deodar.figures import View, path
from deodar.worlds.arena.arena import Arena
from deodar.worlds.picture import Picture


@pytest.fixture
def walked() -> xarray.DataArray:
    """Return two trials, straight lines of half a metre."""
    times = np.arange(26) * 64.0
    driven = np.stack([0.2 + 0.02 * np.arange(26), np.full(26, 0.3), np.zeros(26)], -1)
    values = np.stack([driven, driven + np.array([0, 0.05, 0.1])])
    of = ("of", [0, 1, 2], {"lower": 0.0})
    return xarray.DataArray(
        values,
        dims=("trial", "time", "of"),
        coords={"trial": [0, 1], "time": times, "of": of},
        name="pose.output",
    )


def test_the_figure_shows_arena_and_paths_to_scale(walked: xarray.DataArray) -> None:
    (axes,) = path.path_figure(walked, Arena("blocks")).axes
    assert axes.get_aspect() == 1 and axes.get_xlim() == (0, 1.2) and axes.get_ylim() == (0, 0.8)
    drawn = [np.asarray(line.get_xydata()) for line in axes.get_lines()]
    for trial in (0, 1):
        assert any(len(line) == 26 and np.allclose(line, walked.values[trial, :, :2]) for line in drawn)
    assert len([p for p in axes.patches if p.get_width() > 0.05 and type(p).__name__ == "Rectangle"]) >= 4  # type: ignore[attr-defined]
    assert axes.get_xlabel() == "x (m)"
    assert [tuple(line.get_xydata()[0]) for line in axes.get_lines() if line.get_marker() == "+"] == [
        pytest.approx(goal) for goal in Arena("blocks").goals
    ]
    (alone,) = path.path_figure(walked, trial=1).axes
    assert len([line for line in alone.get_lines() if len(np.asarray(line.get_xydata())) == 26]) == 1


def test_the_animation_shows_more_of_the_path_in_each_frame(walked: xarray.DataArray, tmp_path: Path) -> None:
    arena = Arena("blocks", unit="cm")
    file = path.animate_path(walked * 100, tmp_path / "walk.gif", arena, width=240, stride=5)
    with Image.open(file) as film:
        assert film.size == (240, 160) and getattr(film, "n_frames", 1) == 6
        first = np.asarray(film.convert("RGB"), float)
        film.seek(5)
        last = np.asarray(film.convert("RGB"), float)
    assert np.abs(first - last).max() > 50
    red = first[round(160 * (1 - 65 / 80)), round(240 * 25 / 120)]
    assert red[0] > 150 > 80 > red[1]
    with pytest.raises(DeodarError, match=r"walk\.gif"):
        path.animate_path(walked * 100, file, arena)


def test_the_animation_of_a_view_shows_its_trial(walked: xarray.DataArray, tmp_path: Path) -> None:
    arena, films = Arena("blocks"), []
    for k, variable in enumerate([walked, View(walked, trial=1), walked.isel(trial=[1])]):
        file = path.animate_path(variable, tmp_path / f"{k}.gif", arena, width=120, stride=20)
        films.append(file.read_bytes())
    assert films[1] == films[2] != films[0]


def test_a_value_that_is_not_a_path_is_refused(walked: xarray.DataArray, tmp_path: Path) -> None:
    with pytest.raises(RecordError, match="is not a path"):
        path.path_figure(walked.isel(of=0))
    with pytest.raises(RecordError, match="not into a Picture"):
        path.path_figure(walked, Picture.example())
    with pytest.raises(RecordError, match=r"\.gif"):
        path.animate_path(walked, tmp_path / "walk.mp4", Arena("blocks"))
    with pytest.raises(RecordError, match="1 frames"):
        path.animate_path(walked, tmp_path / "walk.gif", Arena("blocks"), stride=100)
