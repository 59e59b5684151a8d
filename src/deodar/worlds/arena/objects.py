"""The objects of a running arena, which are added, moved and removed without recompilation."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from deodar.codec import Json
from deodar.errors import UnknownName, WorldError, did_you_mean
from deodar.worlds.arena.layout import ArenaLayout, ArenaObject, make
from deodar.worlds.arena.places import of, rows_of
from deodar.worlds.arena.view import OUTSIDE

SPARE = 16
"""Number of objects that may be placed besides those of the layout; it fixes the size of the arrays."""

ALWAYS = (0, 2**31 - 1)
"""The window of an object without windows: first period of presence, and the first one after it."""

BORDER = 4


class ArenaObjects:
    """The objects of a layout and those placed later, as arrays of fixed size.

    Attributes:
        slots: object in each slot; None: the slot is free.
        windows: for each object the first period in which it is present, and the first after that in which it
            is not; one row, or one for each trial.
    """

    def __init__(self, layout: ArenaLayout, period: float) -> None:
        self.border = layout.border
        self.wall_height = layout.height
        self.period = period
        self.room = len(layout.objects) + SPARE
        self.slots: list[ArenaObject | None] = list(layout.objects) + [None] * SPARE
        self.windows: list[np.ndarray] = [np.asarray([ALWAYS], np.int32) for _ in range(self.room)]

    def place(self, item: ArenaObject, windows: npt.ArrayLike | None) -> None:
        """Add an object, or replace the one of the same name; windows are in ms, or None."""
        times = np.asarray([ALWAYS], np.int32)
        if windows is not None:
            what = f"windows of {item.name}"
            given = rows_of(what, windows, [1.0, 1.0])
            if not (given[:, 0] <= given[:, 1]).all():
                raise WorldError("begins after it ends", where=what)
            times = np.clip(np.ceil(given / self.period - 0.5), *ALWAYS).astype(np.int32)
        names = [t.name if t is not None else None for t in self.slots]
        if item.name not in names and None not in names:
            raise WorldError(
                f"the arena is full: {SPARE} objects besides those of its file",
                where=item.name,
                fix="Remove one with remove(name)",
            )
        k = names.index(item.name if item.name in names else None)
        self.slots[k], self.windows[k] = item, times

    def move(self, name: str, center: Sequence[float], scale: float) -> None:
        """Move an object; `center` is in units of `scale` metres."""
        k = self._index(name)
        old = self.slots[k]
        assert old is not None
        self.slots[k] = dc.replace(old, center=make(name, center, (1, 1), old.color, scale).center)

    def remove(self, name: str) -> None:
        """Remove an object."""
        self.slots[self._index(name)] = None

    def permanent(self) -> list[ArenaObject]:
        """Return the objects that are always present."""
        return [
            t for t, w in zip(self.slots, self.windows, strict=True) if t is not None and (w == ALWAYS).all()
        ]

    def present(self, period: int, trial: int) -> list[ArenaObject]:
        """Return the objects that are present in a period of a trial."""
        rows = (
            (t, w[min(trial, len(w) - 1)])
            for t, w in zip(self.slots, self.windows, strict=True)
            if t is not None
        )
        return [item for item, (start, stop) in rows if start <= period < stop]

    # ------------------------------------------------------------------------------------------------- arrays

    def boxes(self) -> np.ndarray:
        """Return the boxes (n, 4) of the slots in metres, then the four sides of the border.

        A free slot has a box far outside the arena.
        """
        left, low, right, high = self.border
        far = 10 * max(right - left, high - low)
        free = (right + 2 * far, high + 2 * far, right + 3 * far, high + 3 * far)
        x0, y0, x1, y1 = left - far, low - far, right + far, high + far
        sides = [(x0, y0, left, y1), (right, y0, x1, y1), (x0, y0, x1, low), (x0, high, x1, y1)]
        return np.asarray([*(free if t is None else t.box for t in self.slots), *sides])

    def colours(self) -> np.ndarray:
        """Return the colours (n, 3) of the rows of `boxes`."""
        return np.asarray([*(OUTSIDE if t is None else t.color for t in self.slots), *([OUTSIDE] * BORDER)])

    def heights(self) -> np.ndarray:
        """Return the heights (n,) of the rows of `boxes` in metres."""
        stated = [None if t is None else t.height for t in self.slots]
        return np.asarray(
            [*(self.wall_height if h is None else h for h in stated), *[self.wall_height] * BORDER]
        )

    def times(self, trials: Sequence[int]) -> np.ndarray:
        """Return the windows (trials, n, 2) of the rows of `boxes`, in periods."""
        out = np.zeros((len(trials), self.room + BORDER, 2), np.int32)
        out[:, self.room :] = ALWAYS
        for k, (item, rows) in enumerate(zip(self.slots, self.windows, strict=True)):
            if item is not None:
                out[:, k] = of(trials, rows, f"windows of {item.name}")
        return out

    def to_data(self) -> list[Json]:
        """Return the objects and their windows as plain data."""
        return [
            [t.name, *t.center, *t.size, *t.color, w.tolist(), *([] if t.height is None else [t.height])]
            for t, w in zip(self.slots, self.windows, strict=True)
            if t is not None
        ]

    def to_slots(self) -> list[Json]:
        """Return what is in each slot as plain data, None for a free one; `restore` reads it, too."""
        objects = iter(self.to_data())
        return [None if t is None else next(objects) for t in self.slots]

    def restore(self, data: Sequence[Any]) -> None:
        """Replace all objects by those that `to_data` or `to_slots` returned."""
        self.slots = [
            None if d is None else ArenaObject(d[0], (d[1], d[2]), (d[3], d[4]), (d[5], d[6], d[7]), *d[9:])
            for d in data
        ]
        self.windows = [np.asarray([ALWAYS] if d is None else d[8], np.int32) for d in data]
        self.slots += [None] * (self.room - len(data))
        self.windows += [np.asarray([ALWAYS], np.int32)] * (self.room - len(data))

    def _index(self, name: str) -> int:
        names = {t.name: k for k, t in enumerate(self.slots) if t is not None}
        if name not in names:
            raise UnknownName(f"nothing in the arena is called {name!r}", fix=did_you_mean(str(name), names))
        return names[name]
