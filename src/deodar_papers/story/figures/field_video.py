"""The moving picture of the first act: activation over space, and below it a strip of colours over time."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from deodar.figures import _encode
from deodar_papers.story.field_moments import FieldThresholds, Moments, StripLine, events, sentences, summary
from deodar_papers.story.figures.canvas import SCALE, Canvas, width
from deodar_papers.story.figures.moving_picture import MovingPicture, Shot
from deodar_papers.story.figures.plot import Plot
from deodar_papers.story.figures.theme import WHITE, Theme, activation_colours, activation_scale
from deodar_papers.story.one_field import AXIS, RESTING_LEVEL, FieldRun

LEFT, TOP, RIGHT, MIDDLE = 20, 52, 620, 250
"""Box of the curve, in units."""

STRIP_TOP, STRIP_BOTTOM = 266, 344

LOW, HIGH = -13.6, 13.2
"""Activation at the bottom and the top: of the whole video, because limits from the data wobble."""

RATE = 12.5
TOLERANCE = 12
SAMPLES_A_PICTURE = 2
"""Samples between two pictures: 8 ms of the field take 80 ms."""

RING_SAMPLES = 24
"""Samples for which a ring marks a new peak."""

FIRST, LAST, REST, PAUSE = 150, 200, 120, 90
"""Durations of the first and the last picture, of the field at rest, and of the pauses after detection and
memory, hundredths of a second.
"""

LABELLED_UNTIL = 85
"""The sample until which the curve is labelled."""

SHOWN = 0.05
"""Smallest input that is drawn."""


class FieldPainter:
    """Draws the pictures of one run.

    Args:
        run: the run.
        m: its moments.
        measured: the thresholds of the field.
        theme: the colours.
    """

    def __init__(self, run: FieldRun, m: Moments, measured: FieldThresholds, theme: Theme) -> None:
        self.run, self.moments, self.measured, self.theme = run, m, measured, theme
        self.events: Sequence[StripLine] = events(m, measured)
        self._sentences = sentences(m, measured)
        self._graph = Plot((LEFT, TOP, RIGHT, MIDDLE), LOW, HIGH, AXIS.samples)
        count = len(run.activation)
        pixels = self._graph.right - self._graph.left
        self._edges = np.rint(np.arange(count + 1) * pixels / count).astype(int)
        self._still = Canvas(theme)
        self._still.rectangle((LEFT, STRIP_TOP, RIGHT, STRIP_BOTTOM), theme.sunk)
        level = self._graph.height(0.0)
        self._still.line((LEFT, level), (RIGHT, level), theme.edge, dash=(4, 3))
        self._still.text(LEFT, level - 9, "threshold", 11, colour=theme.dim)
        self._rows = slice(*(round(y * SCALE) for y in (STRIP_TOP, STRIP_BOTTOM)))
        self._strip = self._draw_strip(pixels)

    def _draw_strip(self, pixels: int) -> np.ndarray:
        """Return the colours of the whole strip, with a gap between the scenes."""
        rows = self._rows.stop - self._rows.start
        up = np.rint(np.linspace(AXIS.samples - 1, 0, rows)).astype(int)
        colours = activation_colours(self.run.activation, LOW + 0.6, HIGH * 0.9)
        strip = np.zeros((rows, pixels, 3), np.float32)
        for k, (first, last) in enumerate(zip(self._edges, self._edges[1:], strict=False)):
            strip[:, first:last] = colours[k][up][:, None]
        gap = self._edges[self.run.second]
        strip[:, gap - 2 : gap + 1] = self.theme.page
        return strip

    def picture(self, k: int) -> np.ndarray:
        """Draw the picture of a sample."""
        canvas = self._curve(k)
        canvas.text(LEFT, 27, [text for begin, text in self._sentences if begin <= k][-1], 18, 600)
        self._ring(canvas, k)
        self._over_time(canvas, k, until=k + 1)
        if self.moments.detected is None or k < self.moments.detected:
            says = "the same activation as colour; time runs to the right"
            canvas.text(LEFT, STRIP_BOTTOM + 14, says, 11, colour=self.theme.dim)
        return canvas.frame()

    def whole(self, k: int) -> np.ndarray:
        """Draw the picture of a sample with the whole strip and all lines, under the sentence of the run."""
        canvas = self._curve(k)
        canvas.text(LEFT, 27, summary(self.moments), 18, 600)
        self._over_time(canvas, k, until=len(self.run.activation))
        return canvas.frame()

    def _curve(self, k: int) -> Canvas:
        canvas = self._still.copy()
        graph, theme, strength = self._graph, self.theme, self.run.input[k].max()
        base = RESTING_LEVEL + self.run.lowered[k]
        level = graph.height(base)
        canvas.line((LEFT, level), (RIGHT, level), theme.line)
        if self.run.lowered[k] < -SHOWN:
            self._lowered(canvas)
        if strength > SHOWN:
            graph.shade(canvas, base, base + self.run.input[k], theme.input, 0.30)
            graph.line(canvas, base + self.run.input[k], theme.input)
            self._input(canvas, k, base, float(strength))
        graph.activation(canvas, self.run.activation[k])
        if k < LABELLED_UNTIL:
            level = graph.height(RESTING_LEVEL) + 14
            canvas.text(RIGHT, level, "activation", 11, 500, theme.below, "right")
        return canvas

    def _lowered(self, canvas: Canvas) -> None:
        """Mark the resting level, and how far the field is lowered when it forgets."""
        level, mark = (self._graph.height(RESTING_LEVEL + by) for by in (0.0, self.measured.forgetting[0]))
        canvas.line((LEFT, level), (RIGHT, level), self.theme.line)
        canvas.line((560, mark), (RIGHT, mark), self.theme.input, dash=(3, 2))
        canvas.text(RIGHT, mark - 9, f"−{self.measured.lowering}", 11, 500, self.theme.input, "right")

    def _input(self, canvas: Canvas, k: int, base: float, strength: float) -> None:
        """Label the input; in the first scene also the input that a peak needs."""
        middle, colour = (LEFT + RIGHT) / 2, self.theme.input
        if k >= self.run.second:
            if strength > 1:
                canvas.text(middle, self._graph.height(base + 1.4), "input", 11, 500, colour, "middle")
            return
        needed = self._graph.height(base + self.measured.detection[0])
        canvas.line((middle - 64, needed), (middle + 64, needed), colour, 1.2, dash=(3, 2))
        canvas.text(middle + 70, needed, f"{self.measured.needed}  needed for a peak", 11, 500, colour)
        if self.moments.detected is None or k < self.moments.detected + 4:
            half = self._graph.height(base + strength / 2)
            canvas.text(middle - 70, half, f"input {strength:.1f}", 11, 500, colour, "right")

    def _ring(self, canvas: Canvas, k: int) -> None:
        """Draw a ring around a peak that has just appeared."""
        for born in (self.moments.detected, self.moments.compete):
            age = -1.0 if born is None else (k - born) / RING_SAMPLES
            if 0 <= age < 1:
                peak = int(np.argmax(self.run.activation[k]))
                x = LEFT + peak / (AXIS.samples - 1) * (RIGHT - LEFT)
                y = self._graph.height(float(self.run.activation[k, peak]))
                canvas.ring(x, y, 6 + 22 * age, self.theme.above, 0.9 * (1 - age))

    def _over_time(self, canvas: Canvas, k: int, until: int) -> None:
        """Draw the strip up to a sample, a line at sample k, and the lines that have happened by then."""
        first, columns = self._graph.left, self._edges[until]
        canvas.pixels[self._rows, first : first + columns] = self._strip[:, :columns]
        x = self._time(k)
        canvas.line((x, STRIP_TOP - 3), (x, STRIP_BOTTOM + 3), self.theme.text)
        end = float(RIGHT)
        for event in reversed(self.events):
            if event.sample < until:
                end = self._event(canvas, event, end) - 12

    def _event(self, canvas: Canvas, event: StripLine, end: float) -> float:
        """Write one of the four lines so that it ends at `end` or before; return where it begins."""
        x = self._time(event.sample)
        canvas.line((x, STRIP_TOP), (x, STRIP_BOTTOM), WHITE, 1.2, dash=(3, 3))
        canvas.line((x, STRIP_BOTTOM), (x, STRIP_BOTTOM + 8), self.theme.text, 1.2)
        begin = min(x - 3, end - max(width(event.text, 12), width(event.name, 13, 600)))
        canvas.text(begin, STRIP_BOTTOM + 18, event.name, 13, 600)
        canvas.text(begin, STRIP_BOTTOM + 35, event.text, 12, colour=self.theme.dim)
        return begin

    def _time(self, k: int) -> float:
        """Return the x of a sample in the strip."""
        return LEFT + (RIGHT - LEFT) * (k + 0.5) / len(self.run.activation)


def video(run: FieldRun, m: Moments, measured: FieldThresholds, theme: Theme) -> MovingPicture:
    """Return the video of a run.

    Its first picture is a summary, which previews and stopped videos show.
    """
    painter = FieldPainter(run, m, measured, theme)
    samples = _samples(len(run.activation), m)
    pauses = {samples[0]: REST, samples[-1]: LAST - 140}
    for moment, later in ((m.detected, 36), (m.remembered, 40)):
        if moment is not None:
            pauses[min(samples, key=lambda k, at=moment + later: abs(k - at))] = PAUSE
    middle = (m.gone + m.falls) // 2
    usual = round(100 / RATE)
    shots = [
        Shot(lambda: painter.whole(middle), FIRST),
        *(Shot(lambda k=k: painter.picture(k), pauses.get(k, usual)) for k in samples),
        Shot(lambda: painter.whole(samples[-1]), LAST),
    ]
    looked_at = [samples[20], (m.detected or m.grows) + 8, (m.compete or m.go) + 6, m.gone + 20, m.falls + 38]
    pictures = [painter.whole(middle), *(painter.picture(min(k, samples[-1])) for k in looked_at)]
    fixed = np.concatenate([activation_scale(), theme.colours()])
    return MovingPicture(shots, RATE, _encode.of_samples(pictures, fixed), TOLERANCE)


def _samples(count: int, m: Moments) -> list[int]:
    """Return the samples that are samples: all of them around a decision, otherwise every second one."""
    decided = [k for k in (m.detected, m.compete, None if m.forgotten is None else m.forgotten - 12) if k]
    samples, k = [], 0
    while k < count:
        if k and k - samples[-1] > 1 and samples[-1] < m.second < k:
            k = m.second
        samples.append(k)
        slow = any(at - 6 <= k <= at + 20 for at in decided)
        k += 1 if slow else SAMPLES_A_PICTURE
    return samples
