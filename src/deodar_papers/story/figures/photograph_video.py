"""The moving picture of the second act: a photograph with the spatial field, and cues at its side."""

from __future__ import annotations

import colorsys
from collections.abc import Sequence

import numpy as np
from PIL import Image

from deodar.architectures.saliency import SIDE, scene
from deodar.figures import _encode
from deodar_papers.saliency.scenes import SceneResult
from deodar_papers.story.figures.canvas import SCALE, Canvas
from deodar_papers.story.figures.light import Light, positions
from deodar_papers.story.figures.moving_picture import MovingPicture, Shot
from deodar_papers.story.figures.plot import Plot
from deodar_papers.story.figures.theme import INK, WHITE, Theme, rgb
from deodar_papers.story.photograph import CueCourse, label, sentences, summary

LEFT, TOP, WIDE, HIGH = 20, 52, 468, 312
"""Box of the photograph, in units."""

SIDE_LEFT, SIDE_RIGHT = 508, 620
"""Ends of the cues and of the colour field beside it."""

LOW, HIGH_ACTIVATION = -4.6, 8.0
"""Activation at the bottom and the top of the colour field."""

HUES = 24
"""Number of colours below the colour field."""

CHIPS = {"light brown": rgb("c48c48")}
"""Colours of cues whose hue has another name when it is saturated."""

PHOTOGRAPH_COLOURS = 140
"""Number of colours of the photograph in the palette."""

RATE = 10.0
TOLERANCE = 9
FIRST, TITLE, LAST, PAUSE, END_OF_CUE = 150, 220, 250, 50, 130
"""Durations of the first picture, of the one that announces the cues, of the last one, of a cue's beginning
and of a new peak, and of the end of a cue, hundredths of a second.
"""

ANNOUNCEMENT = "The same on a photograph: one cue after the other."
SLOW_AFTER = 30
"""Samples after a peak has appeared from which on every second one is samples."""

AFTER_JUDGEMENT = 8
"""Samples that are samples after a missing peak is stated."""


class PhotographPainter:
    """Draws the pictures of one scene.

    Args:
        scene_result: the run.
        cues: what each cue did.
        theme: the colours.
    """

    def __init__(self, scene_result: SceneResult, cues: Sequence[CueCourse], theme: Theme) -> None:
        self.cues, self.theme = cues, theme
        self._chips = [CHIPS.get(c.name, _saturated(c.outcome.cue.hue)) for c in cues]
        picture = scene_result.scene.picture
        (x, y, hues), (columns, rows) = scene(), picture.size
        self._graph = Plot((SIDE_LEFT, 256, SIDE_RIGHT, 338), LOW, HIGH_ACTIVATION, hues.samples + 1)
        box = [round(v * SCALE) for v in (LEFT, TOP, LEFT + WIDE, TOP + HIGH)]
        self._box = slice(box[1], box[3]), slice(box[0], box[2])
        self.photograph = _resized(picture.pixels, box[2] - box[0], box[3] - box[1])
        self.still = self._draw_still()
        ends = [picture.to_pixels((x, y), *corner) for corner in ((x.lower, y.lower), (x.upper, y.upper))]
        (left, right), (top, bottom) = ([e[0] / columns for e in ends], [e[1] / rows for e in ends])
        self._light = Light(
            (box[1], box[0]),
            positions(box[3] - box[1], (top, bottom), y.samples),
            positions(box[2] - box[0], (left, right), x.samples),
            x.samples,
        )
        # scene to units: linear along both axes
        at = [picture.to_pixels((x, y), *corner) for corner in ((0.0, 0.0), (SIDE, SIDE))]
        size = np.array([WIDE / columns, HIGH / rows])
        self._origin, self._unit = np.array(at[0]) * size, (np.array(at[1]) - at[0]) * size / SIDE

    def _draw_still(self) -> Canvas:
        canvas = Canvas(self.theme)
        canvas.pixels[self._box] = self.photograph
        step = (SIDE_RIGHT - SIDE_LEFT) / HUES
        for k in range(HUES):
            x = SIDE_LEFT + k * step
            canvas.rectangle((x, 342, x + step, 350), _hue_of_bar(k))
        canvas.text(SIDE_LEFT, 364, "colour field", 11, colour=self.theme.dim)
        level = self._graph.height(0.0)
        canvas.line((SIDE_LEFT, level), (SIDE_RIGHT, level), self.theme.edge, dash=(4, 3))
        canvas.text(LEFT + WIDE / 2 + 16, TOP + HIGH + 19, "motor variable", 11, colour=self.theme.dim)
        return canvas

    def announcement(self) -> np.ndarray:
        """Draw the picture before the first cue."""
        canvas = self.still.copy()
        canvas.text(LEFT, 27, ANNOUNCEMENT, 18, 600)
        self._names(canvas, decided=0)
        self._colour_field(canvas, self.cues[0].colour[0])
        self._arrow(canvas, np.array([SIDE / 2, SIDE / 2]))
        return canvas.frame()

    def picture(self, number: int, k: int) -> np.ndarray:
        """Draw the picture of a sample of a cue."""
        cue = self.cues[number]
        sentence = [text for begin, text in sentences(cue) if begin <= k][-1]
        return self._picture(number, k, sentence, decided=number + (k >= _decided(cue)))

    def whole(self, number: int, k: int) -> np.ndarray:
        """Draw the picture of a sample with the results of all cues, under the sentence of the run."""
        return self._picture(number, k, summary(self.cues), decided=len(self.cues))

    def _picture(self, number: int, k: int, sentence: str, decided: int) -> np.ndarray:
        cue, canvas = self.cues[number], self.still.copy()
        canvas.text(LEFT, 27, sentence, 18, 600)
        if k >= cue.begins:
            self._frame(canvas, number)
        self._names(canvas, decided)
        self._colour_field(canvas, cue.colour[k])
        self._light.draw(canvas, cue.spatial[k])
        self._arrow(canvas, cue.motor[k])
        return canvas.frame()

    def _frame(self, canvas: Canvas, number: int) -> None:
        """Mark the present cue by a frame, not by a colour alone."""
        y = 66 + 54 * number
        for inset, colour in ((0.0, self.theme.accent), (1.6, self.theme.page)):
            box = SIDE_LEFT - 8 + inset, y - 18 + inset, SIDE_RIGHT + 8 - inset, y + 30 - inset
            canvas.rectangle(box, colour, 8 - inset)

    def _names(self, canvas: Canvas, decided: int) -> None:
        """Write the names of the cues, and the results of those that are decided."""
        for n, (cue, chip) in enumerate(zip(self.cues, self._chips, strict=True)):
            y = 66 + 54 * n
            canvas.disc(SIDE_LEFT + 8, y, 8, chip)
            canvas.text(SIDE_LEFT + 24, y, cue.name, 13, 600)
            if n < decided:
                canvas.text(SIDE_LEFT, y + 19, label(cue), 12, colour=self.theme.dim)

    def _colour_field(self, canvas: Canvas, activation: np.ndarray) -> None:
        self._graph.activation(canvas, np.append(activation, activation[0]), width=2.0, halo=False)

    def _arrow(self, canvas: Canvas, motor: np.ndarray) -> None:
        """Draw an arrow from below the photograph to the value of the motor variable."""
        tip = self._origin + motor * self._unit + [LEFT, TOP]
        base = np.array([LEFT + WIDE / 2, TOP + HIGH + 18.0])
        along = (tip - base) / np.hypot(*(tip - base))
        across = np.array([-along[1], along[0]])
        for margin, radius, colour in ((1.4, 7.4, INK), (0.0, 6.0, WHITE)):
            thin, wide, neck = 1.7 + margin, 7 + 1.5 * margin, tip - along * (15 + margin)
            tail = base - along * margin
            corners = [tail + across * thin, neck + across * thin, neck + across * wide]
            corners += [tip + along * 1.6 * margin]
            corners += [neck - across * wide, neck - across * thin, tail - across * thin]
            canvas.polygon(corners, colour)
            canvas.disc(float(base[0]), float(base[1]), radius, colour)

    def palette(self, samples: Sequence[np.ndarray]) -> np.ndarray:
        """Return a palette of the photograph, of the page, and of what differs from both in some pictures."""
        still = self.still.frame()
        shot = Image.fromarray(still[self._box])
        few = shot.quantize(PHOTOGRAPH_COLOURS, method=Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE)
        colours = np.array((few.getpalette() or [])[: 3 * PHOTOGRAPH_COLOURS]).reshape(-1, 3)
        bar = [_hue_of_bar(k) for k in range(HUES)]
        fixed = np.concatenate([colours, self.theme.colours(), np.stack([*self._chips, WHITE, *bar])])
        changed = [sample[(sample != still).any(2)] for sample in samples]
        return _encode.of_samples([*changed, still[:, self._box[1].stop :]], fixed)


def video(scene_result: SceneResult, cues: Sequence[CueCourse], theme: Theme) -> MovingPicture:
    """Return the video of a scene.

    Its first picture is a summary, which previews and stopped videos show.
    """
    painter = PhotographPainter(scene_result, cues, theme)
    end = len(cues[0].motor) - 1
    first, last = _with_peak(cues), len(cues) - 1
    shots = [Shot(lambda: painter.whole(first, end), FIRST), Shot(painter.announcement, TITLE)]
    for number, cue in enumerate(cues):
        samples = _samples(cue, end)
        pauses = {cue.begins: PAUSE, cue.appears or 0: PAUSE, samples[-1]: END_OF_CUE}
        shots += [
            Shot(lambda n=number, k=k: painter.picture(n, k), pauses.get(k, round(100 / RATE)))
            for k in samples
        ]
    shots.append(Shot(lambda: painter.whole(last, end), LAST))
    looked_at = [painter.whole(first, end), painter.announcement(), painter.whole(last, end)]
    looked_at += [
        painter.picture(n, k)
        for n, c in enumerate(cues)
        if c.appears
        for k in (c.appears, c.appears + 8)
        if k <= end
    ]
    return MovingPicture(shots, RATE, painter.palette(looked_at), TOLERANCE)


def _with_peak(cues: Sequence[CueCourse]) -> int:
    """Return the number of the first cue with a peak, or 0."""
    return next((n for n, cue in enumerate(cues) if cue.appears is not None), 0)


def _decided(cue: CueCourse) -> int:
    """Return the sample from which on the scene_result of a cue is written."""
    return cue.judged if cue.appears is None else cue.appears


def _samples(cue: CueCourse, end: int) -> list[int]:
    """Return the samples of a cue that are samples."""
    first = cue.begins - 1
    if cue.appears is None:
        return list(range(first, min(cue.judged + AFTER_JUDGEMENT, end) + 1))
    slow = range(first, min(cue.appears + SLOW_AFTER, end))
    return [*slow, *range(slow.stop, end + 1, 2)]


def _resized(pixels: np.ndarray, columns: int, rows: int) -> np.ndarray:
    """Return a picture of values 0 to 1 at another size, 0 to 255."""
    picture = Image.fromarray((pixels * 255).round().astype(np.uint8))
    return np.asarray(picture.resize((columns, rows), Image.Resampling.LANCZOS), np.float32)


def _saturated(hue: float) -> np.ndarray:
    return np.array(colorsys.hsv_to_rgb(hue / 360, 0.82, 0.86), np.float32) * 255


def _hue_of_bar(k: int) -> np.ndarray:
    return _saturated((k + 0.5) * 360 / HUES)
