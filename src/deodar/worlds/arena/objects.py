"""The objects of a running arena, which are added, moved and removed without recompilation."""

from __future__ import annotations

import copy
import dataclasses as dc
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from deodar.codec import Json
from deodar.errors import UnknownName, WorldError, did_you_mean
from deodar.worlds._settings import of
from deodar.worlds.arena.arena_layout import ArenaLayout, ArenaObject, make
from deodar.worlds.arena.starts_and_goals import rows_of
from deodar.worlds.arena.view import OUTSIDE

SPARE = 16
"""Number of objects that may be placed besides those of the layout; it fixes the size of the arrays."""

ALWAYS = (0, 2**31 - 1)
"""The window of an object without windows: first period of presence, and the first one after it."""

NEVER = (0, 0)
"""The window of an object that a trial does not have."""

BORDER = 4


@dataclass(frozen=True)
class ArenaSlot:
    """An object of one name, with one row for all trials or a row for each.

    Attributes:
        name: name of the object.
        rows: the object; None in a trial that does not have it.
        windows: the first period in which it is present, and the first after that in which it is not.
    """

    name: str
    rows: tuple[ArenaObject | None, ...]
    windows: np.ndarray

    def item(self, trial: int) -> ArenaObject | None:
        """Return the object of a trial; a trial beyond the rows has the last one."""
        return self.rows[min(trial, len(self.rows) - 1)]

    def window(self, trial: int) -> tuple[int, int]:
        """Return the window of a trial; a trial beyond the rows has the last one."""
        start, stop = self.windows[min(trial, len(self.windows) - 1)].tolist()
        return start, stop

    def for_trial(self, trial: int) -> ArenaSlot:
        """Return the slot with the row of one trial alone."""
        arena_object, window = self.item(trial), of([trial], self.windows, f"windows of {self.name}")
        return ArenaSlot(
            self.name, (arena_object,), np.asarray([NEVER], np.int32) if arena_object is None else window
        )

    def to_data(self) -> Json:
        """Return plain data."""
        windows, first = self.windows.tolist(), self.rows[0]
        if len(self.rows) == 1 and first is not None:
            numbers, height = _numbers(first)
            return [self.name, *numbers, windows, *height]
        rows = [None if t is None else [value for part in _numbers(t) for value in part] for t in self.rows]
        return [self.name, rows, windows]

    @classmethod
    def from_data(cls, data: Any) -> ArenaSlot:
        """Return the slot that `to_data` described."""
        name, has_rows = data[0], isinstance(data[1], list)
        described, windows = (data[1], data[2]) if has_rows else ([[*data[1:8], *data[9:]]], data[8])
        rows = tuple(None if row is None else _object(name, row) for row in described)
        return cls(name, rows, np.asarray(windows, np.int32))


class ArenaObjects:
    """The objects of one layout for all trials, or of one for each trial, and those placed later, as arrays
    of fixed size.

    Objects of one name are one object, which differs between trials. Their order is that of their first
    occurrence in the layouts.

    Attributes:
        slots: what is in each slot; None: the slot is free.
        fixed: names of walls and boxes of the layouts, which may overlap.
    """

    def __init__(self, layouts: Sequence[ArenaLayout], period: float) -> None:
        self.border = layouts[0].border
        self.fixed = frozenset[str]().union(*(layout.fixed for layout in layouts))
        self.wall_heights = np.asarray([layout.height for layout in layouts])
        self.period = period
        by = [{t.name: t for t in layout.objects} for layout in layouts]
        names = dict.fromkeys(name for objects in by for name in objects)
        slots = [ArenaSlot(n, _folded([objects.get(n) for objects in by]), _always()) for n in names]
        self.slots: list[ArenaSlot | None] = [*slots, *[None] * SPARE]

    @property
    def room(self) -> int:
        """Number of slots."""
        return len(self.slots)

    @property
    def trials(self) -> int:
        """Number of trials for which objects that are always present differ; 1: all have the same."""
        return max((len(s.rows) for s in self.slots if s is not None), default=1)

    def names(self) -> list[str]:
        """Return the names of all objects."""
        return [s.name for s in self.slots if s is not None]

    def place(self, rows: Sequence[ArenaObject], windows: npt.ArrayLike | None) -> None:
        """Add an object, or replace the one of the same name.

        Args:
            rows: the object, one for all trials or one for each.
            windows: in ms, or None.
        """
        name, times = rows[0].name, _always()
        if windows is not None:
            label = f"windows of {name}"
            times_in_ms = rows_of(label, windows, [1.0, 1.0])
            if not (times_in_ms[:, 0] <= times_in_ms[:, 1]).all():
                raise WorldError("begins after it ends", where=label)
            times = np.clip(np.ceil(times_in_ms / self.period - 0.5), *ALWAYS).astype(np.int32)
        names = [s.name if s is not None else None for s in self.slots]
        if name not in names and None not in names:
            raise WorldError(
                f"the arena is full: {SPARE} objects besides those of its file",
                where=name,
                fix="Remove one with remove(name)",
            )
        self.slots[names.index(name if name in names else None)] = ArenaSlot(name, _folded(rows), times)

    def move(self, name: str, center: Any, scale: float) -> None:
        """Move an object; `center` is in units of `scale` metres, with a row for each trial if they
        differ.
        """
        k, slot = self._slot(name)
        places = [t.center for t in made(name, center, (1, 1), (0, 0, 0), scale)]
        count = max(len(places), len(slot.rows))
        if not {len(places), len(slot.rows)} <= {1, count}:
            raise WorldError(f"got {len(places)} places for {len(slot.rows)} trials", where=name)
        rows = [
            None if t is None else dc.replace(t, center=places[n % len(places)])
            for n in range(count)
            for t in [slot.rows[n % len(slot.rows)]]
        ]
        self.slots[k] = dc.replace(slot, rows=_folded(rows))

    def remove(self, name: str) -> None:
        """Remove an object."""
        self.slots[self._slot(name)[0]] = None

    def permanent(self, trial: int = 0) -> list[ArenaObject]:
        """Return the objects of a trial that are always present."""
        objects = (s.item(trial) for s in self.slots if s is not None and (s.windows == ALWAYS).all())
        return [block for block in objects if block is not None]

    def present(self, period: int, trial: int) -> list[ArenaObject]:
        """Return the objects that are present in a period of a trial."""
        objects = ((s.item(trial), s.window(trial)) for s in self.slots if s is not None)
        return [block for block, (start, stop) in objects if block is not None and start <= period < stop]

    def all(self, trial: int = 0) -> list[ArenaObject]:
        """Return the objects that a trial has at any time."""
        objects = (s.item(trial) for s in self.slots if s is not None)
        return [block for block in objects if block is not None]

    def for_trial(self, trial: int) -> ArenaObjects:
        """Return the objects of one trial, as those of all trials."""
        new = copy.copy(self)
        new.wall_heights = of([trial], self.wall_heights[:, None], "layouts")[:, 0]
        new.slots = [None if s is None else s.for_trial(trial) for s in self.slots]
        return new

    # ------------------------------------------------------------------------------------------------- arrays

    def boxes(self, trials: Sequence[int]) -> np.ndarray:
        """Return the boxes (trials, n, 4) of the slots in metres, then the four sides of the border.

        A slot that a trial does not fill has a box far outside the arena.
        """
        left, low, right, high = self.border
        far = 10 * max(right - left, high - low)
        free = (right + 2 * far, high + 2 * far, right + 3 * far, high + 3 * far)
        x0, y0, x1, y1 = left - far, low - far, right + far, high + far
        sides = [(x0, y0, left, y1), (right, y0, x1, y1), (x0, y0, x1, low), (x0, high, x1, y1)]
        return self._stacked(trials, lambda t: t.box, free, sides)

    def colours(self, trials: Sequence[int]) -> np.ndarray:
        """Return the colours (trials, n, 3) of the rows of `boxes`."""
        return self._stacked(trials, lambda t: t.color, OUTSIDE, [OUTSIDE] * BORDER)

    def heights(self, trials: Sequence[int]) -> np.ndarray:
        """Return the heights (trials, n) of the rows of `boxes` in metres."""
        stated = self._stacked(
            trials, lambda t: [np.nan if t.height is None else t.height], [np.nan], [[np.nan]]
        )
        walls = of(trials, self.wall_heights[:, None], "layouts")
        return np.where(np.isnan(stated[..., 0]), walls, stated[..., 0])

    def times(self, trials: Sequence[int]) -> np.ndarray:
        """Return the windows (trials, n, 2) of the rows of `boxes`, in periods."""
        out = np.zeros((len(trials), self.room + BORDER, 2), np.int32)
        out[:, self.room :] = ALWAYS
        for k, slot in enumerate(self.slots):
            if slot is not None:
                has = np.asarray([[t is not None] for t in slot.rows])
                out[:, k] = of(trials, slot.windows, f"windows of {slot.name}")
                out[:, k] = np.where(of(trials, has, slot.name), out[:, k], NEVER)
        return out

    def _stacked(
        self,
        trials: Sequence[int],
        numbers: Callable[[ArenaObject], Sequence[float]],
        free: Sequence[float],
        border: Sequence[Sequence[float]],
    ) -> np.ndarray:
        """Return numbers (trials, n, ...) of the objects in all slots, and of the border."""
        out = np.empty((len(trials), self.room + BORDER, len(free)))
        out[:, self.room :] = border
        for k, slot in enumerate(self.slots):
            rows = (None,) if slot is None else slot.rows
            rows_of_slot = np.asarray([free if t is None else numbers(t) for t in rows])
            out[:, k] = of(trials, rows_of_slot, "" if slot is None else slot.name)
        return out

    def to_data(self) -> list[Json]:
        """Return the objects and their windows as plain data."""
        return [s.to_data() for s in self.slots if s is not None]

    def to_slots(self) -> list[Json]:
        """Return what is in each slot as plain data, None for a free one; `restore` reads it, too."""
        return [None if s is None else s.to_data() for s in self.slots]

    def restore(self, data: Sequence[Any]) -> None:
        """Replace all objects by those that `to_data` or `to_slots` returned."""
        slots = [None if d is None else ArenaSlot.from_data(d) for d in data]
        self.slots = [*slots, *[None] * (self.room - len(slots))]

    def _slot(self, name: str) -> tuple[int, ArenaSlot]:
        slots = {s.name: (k, s) for k, s in enumerate(self.slots) if s is not None}
        if name not in slots:
            raise UnknownName(f"nothing in the arena is called {name!r}", fix=did_you_mean(str(name), slots))
        return slots[name]


def made(
    name: str, center: Any, size: Any, color: Any, scale: float, height: Any = None
) -> list[ArenaObject]:
    """Make an object from unchecked values, each of which may have a row for each trial.

    Lengths are in units of `scale` metres.

    Raises:
        WorldError: a value is invalid, or the numbers of rows differ.
    """
    values = {"center": _rows(center), "size": _rows(size), "color": _rows(color)}
    values["height"] = list(height) if isinstance(height, (list, tuple, np.ndarray)) else [height]
    count = max(map(len, values.values()))
    for parameter, rows in values.items():
        if len(rows) not in (1, count):
            raise WorldError(
                f"has {len(rows)} rows, and another value has {count}",
                where=f"{name}.{parameter}",
                fix="Give one for all trials, or a row for each",
            )
    by_trial = [{parameter: rows[k % len(rows)] for parameter, rows in values.items()} for k in range(count)]
    return [make(name, scale=scale, **arguments) for arguments in by_trial]


def _rows(value: Any) -> list[Any]:
    """Return the rows of a value that has one for each trial, else the value as the only row."""
    plain = value.tolist() if isinstance(value, np.ndarray) else value
    nested = isinstance(plain, (list, tuple)) and bool(plain)
    return list(plain) if nested and all(isinstance(v, (list, tuple, np.ndarray)) for v in plain) else [plain]


def _folded(rows: Sequence[ArenaObject | None]) -> tuple[ArenaObject | None, ...]:
    """Return a single row where all are equal."""
    return tuple(rows[:1] if all(row == rows[0] for row in rows) else rows)


def _always() -> np.ndarray:
    return np.asarray([ALWAYS], np.int32)


def _numbers(block: ArenaObject) -> tuple[list[float], list[float]]:
    """Return centre, size and colour, and the height, if one is stated."""
    height = [] if block.height is None else [block.height]
    return [*block.center, *block.size, *block.color], height


def _object(name: str, numbers: Sequence[float]) -> ArenaObject:
    x, y, w, h, r, g, b, *height = numbers
    return ArenaObject(name, (x, y), (w, h), (r, g, b), *height)
