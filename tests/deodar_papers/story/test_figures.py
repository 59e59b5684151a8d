"""The moving pictures: what a picture shows at a moment, and the parts that draw it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PIL import Image, ImageFont

from deodar_papers.story.field_moments import moments
from deodar_papers.story.figures import field_video, letters
from deodar_papers.story.figures.canvas import HIGH, SCALE, WIDE, Canvas
from deodar_papers.story.figures.field_video import FieldPainter
from deodar_papers.story.figures.light import Light, positions
from deodar_papers.story.figures.moving_picture import MovingPicture, Shot
from deodar_papers.story.figures.plot import Plot, interpolation
from deodar_papers.story.figures.theme import THEMES, activation_colours
from tests.deodar_papers.story.traces import COUNT, THRESHOLDS, field_run

RUN = field_run((50, 20, 39), (28, 48, 51), (72, 47, 90))
LIGHT = THEMES["light"]


@pytest.fixture(scope="module")
def painter() -> FieldPainter:
    return FieldPainter(RUN, moments(RUN), THRESHOLDS, LIGHT)


def strip(picture: np.ndarray) -> np.ndarray:
    """Return the strip over time of a picture of the first act."""
    rows = slice(round(field_video.STRIP_TOP * SCALE), round(field_video.STRIP_BOTTOM * SCALE))
    return picture[rows, round(field_video.LEFT * SCALE) : round(field_video.RIGHT * SCALE)]


def test_the_strip_is_filled_up_to_the_present_sample(painter: FieldPainter) -> None:
    pixels = strip(painter.picture(30))
    empty = (pixels == LIGHT.sunk).all(2).all(0)
    assert not empty[: int(30 / COUNT * len(empty))].any() and empty[int(32 / COUNT * len(empty)) :].all()
    assert not (strip(painter.whole(30)) == LIGHT.sunk).all(2).any()


def test_a_picture_of_the_first_act_shows_a_peak_in_the_colour_above_the_threshold(
    painter: FieldPainter,
) -> None:
    above, flat = painter.picture(30), painter.picture(15)
    curve = np.s_[: round(field_video.MIDDLE * SCALE)]
    count = [(np.abs(picture[curve] - LIGHT.above).sum(2) < 30).sum() for picture in (above, flat)]
    assert count[0] > 100 and count[1] == 0


def test_a_line_of_the_strip_appears_with_its_moment_and_all_lines_with_the_summary(
    painter: FieldPainter,
) -> None:
    names = np.s_[round((field_video.STRIP_BOTTOM + 10) * SCALE) :]
    dark = [
        (picture[names].sum(2) < 200).sum()
        for picture in (painter.picture(25), painter.picture(55), painter.whole(55))
    ]
    assert 0 < dark[0] < dark[1] < dark[2]


def test_every_sample_of_a_decision_is_shown_and_others_by_turns_without_the_gap() -> None:
    samples = field_video._samples(COUNT, moments(RUN))
    assert set(range(14, 39)) <= set(samples) and 40 in samples and 39 in samples
    assert samples == sorted(set(samples)) and samples[-1] >= COUNT - 2 and 1 not in samples


def test_a_shot_is_shown_for_a_whole_number_of_pictures(tmp_path: Path) -> None:
    black, white = (np.full((40, 60, 3), v, np.uint8) for v in (0, 255))
    colours = np.array([[0, 0, 0], [255, 255, 255]], np.uint8)
    video = MovingPicture([Shot(lambda: black, 50), Shot(lambda: white, 8)], 12.5, colours, 0)
    assert video.seconds == pytest.approx(7 / 12.5) and len(list(video.frames())) == 7
    video.write(tmp_path / "a.gif")
    with Image.open(tmp_path / "a.gif") as gif:
        durations = []
        for k in range(gif.n_frames):
            gif.seek(k)
            durations.append(gif.info["duration"])
    assert durations == [480, 80]


def test_a_graph_draws_a_value_at_its_height() -> None:
    canvas = Canvas(LIGHT)
    graph = Plot((20, 50, 620, 250), -10.0, 10.0, 11)
    assert graph.height(0.0) == pytest.approx(150, abs=0.5)
    graph.line(canvas, np.full(11, 5.0), LIGHT.text, width=2.0)
    rows = np.flatnonzero((canvas.frame()[:, 400] != LIGHT.page.astype(np.uint8)).any(1))
    assert rows.mean() == pytest.approx(graph.height(5.0) * SCALE - 0.5, abs=0.6)


def test_interpolation_keeps_samples_and_is_exact_for_a_line() -> None:
    at = np.array([0.0, 1.0, 2.5, 4.0])
    assert interpolation(at, 6) @ np.arange(6.0) == pytest.approx([0.0, 1.0, 2.5, 4.0])


def test_a_canvas_cuts_what_lies_outside() -> None:
    canvas = Canvas(LIGHT)
    canvas.disc(WIDE, HIGH, 5, LIGHT.text)
    canvas.disc(-20, -20, 5, LIGHT.text)
    changed = np.argwhere((canvas.frame() != LIGHT.page.astype(np.uint8)).any(2))
    assert len(changed) and changed.min() > 580


def test_a_light_marks_a_peak_and_leaves_a_field_below_the_threshold_alone() -> None:
    light = Light((0, 0), positions(200, (0, 1), 40), positions(300, (0, 1), 40), 40)
    field = np.full((40, 40), -5.0)
    canvas = Canvas(LIGHT)
    light.draw(canvas, field)
    assert (canvas.pixels == LIGHT.page).all()
    field[8:13, 28:33] = 6.0  # x, y: a quarter from the left, three quarters from the top
    light.draw(canvas, field)
    brightest = np.abs(canvas.pixels[:200, :300] - activation_colours(np.array(6.0), -9.0, 8.5, 20)).sum(2)
    row, column = np.unravel_index(brightest.argmin(), brightest.shape)
    assert abs(row - 153) < 12 and abs(column - 78) < 12


def test_activation_has_a_white_threshold_and_few_colours() -> None:
    colours = activation_colours(np.linspace(-10, 10, 1001), -10, 10)
    assert len(np.unique(colours, axis=0)) <= 80
    assert colours[500] == pytest.approx([255, 255, 255]) and colours[0][2] > colours[0][0]
    assert colours[-1][0] > colours[-1][2]


def test_text_is_written_with_the_font_of_matplotlib_where_a_woff2_cannot_be_read(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    usual, read = letters.mask.__wrapped__("peak", 18.0, 600), ImageFont.truetype

    def refuse(file: Path, size: int) -> ImageFont.FreeTypeFont:
        if Path(file).suffix == ".woff2":
            raise OSError("unknown file format")
        return read(file, size)

    monkeypatch.setattr(letters, "font", letters.font.__wrapped__)
    monkeypatch.setattr(letters.ImageFont, "truetype", refuse)
    of_matplotlib = letters.mask.__wrapped__("peak", 18.0, 600)
    assert of_matplotlib.shape != usual.shape and usual.max() == of_matplotlib.max() == 1.0
