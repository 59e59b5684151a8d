"""The layout of an arena: its JSON format, the reader, and the checks.

    {"unit": "m", "arena": {"x": [0, 1], "y": [0, 1], "height": 0.1},
     "walls": [{"name": "north", "center": [0.5, 0.9], "size": [0.6, 0.05]}],
     "boxes": [...],
     "blocks": [{"name": "red", "center": [0.2, 0.3], "size": [0.05, 0.05], "height": 0.07,
                 "color": [1, 0, 0]}],
     "start": [0.2, 0.2], "heading": 0.0, "goal": [0.8, 0.8]}

A file may contain several arenas by name. All objects are parallel to the two axes. Only the camera depends
on heights: `arena.height` is that of the walls of the border (by default 0.1 m), and of objects that state
none.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from importlib import resources
from pathlib import Path

from deodar import codec, regular_file
from deodar.codec import Json, JsonObject
from deodar.errors import Problem, WorldError, did_you_mean, reading
from deodar.parameters import real, show
from deodar.similar import nearest

UNITS = {"m": 1.0, "cm": 0.01, "mm": 0.001}
"""Units of length, in metres."""

LayoutSource = str | Path | Mapping[str, Json]
"""The name of an arena that comes with deodar, `FILE` or `FILE#NAME`, or data."""

COLOURS = {"walls": (0.45, 0.45, 0.45), "boxes": (0.72, 0.53, 0.3), "blocks": (0.8, 0.2, 0.2)}
"""Lists of objects, and the colour of an object that states none."""

KNOWN = ("unit", "plane", "arena", *COLOURS, "start", "heading", "goal", "goal_area")
LARGEST_FILE = 2**24

WALL_HEIGHT = 0.1
"""Height of the walls of the border where a layout states none, m: about twice that of the vehicles."""


@dataclass(frozen=True)
class ArenaObject:
    """A box in an arena: middle and size (x, y) in metres, colour (red, green, blue) from 0 to 1, height in
    metres; None: that of the walls of the border.
    """

    name: str
    center: tuple[float, float]
    size: tuple[float, float]
    color: tuple[float, float, float]
    height: float | None = None

    @property
    def box(self) -> tuple[float, float, float, float]:
        """Lower x, lower y, upper x, upper y."""
        (x, y), (w, h) = self.center, self.size
        return x - w / 2, y - h / 2, x + w / 2, y + h / 2


@dataclass(frozen=True)
class ArenaLayout:
    """An arena: its border, its objects, the start of the vehicle and the goal.

    Attributes:
        border: lower x, lower y, upper x, upper y, m.
        objects: boxes in it; they may overlap, and may lie outside the border (parked).
        start: x, y in m and heading in rad, or None.
        goal: x, y in m, or None.
        height: height of the walls of the border, m.
        fixed: names of the objects that a file lists as walls or boxes; a description of an arena does not
            keep them apart from blocks.
    """

    border: tuple[float, float, float, float]
    objects: tuple[ArenaObject, ...] = ()
    start: tuple[float, float, float] | None = None
    goal: tuple[float, float] | None = None
    height: float = WALL_HEIGHT
    fixed: frozenset[str] = field(default=frozenset(), compare=False)

    def to_data(self) -> JsonObject:
        """Return the layout in the format of a file."""
        left, low, right, high = self.border
        area: JsonObject = {"x": [left, right], "y": [low, high]}
        if self.height != WALL_HEIGHT:
            area["height"] = self.height
        blocks: list[Json] = []
        for t in self.objects:
            block: JsonObject = {
                "name": t.name,
                "center": list(t.center),
                "size": list(t.size),
                "color": list(t.color),
            }
            blocks.append(block if t.height is None else block | {"height": t.height})
        layout: JsonObject = {"unit": "m", "arena": area, "blocks": blocks}
        if self.start is not None:
            layout |= {"start": list(self.start[:2]), "heading": self.start[2]}
        return layout if self.goal is None else layout | {"goal": list(self.goal)}


def builtin() -> JsonObject:
    """Return the data of the arenas that come with deodar, by name."""
    layouts: JsonObject = {}
    for file in sorted((resources.files("deodar.worlds.arena") / "layouts").iterdir(), key=lambda f: f.name):
        if file.name.endswith(".json"):
            layouts |= codec.read(file.read_bytes())
    return layouts


def load_each(source: LayoutSource | Sequence[LayoutSource]) -> tuple[ArenaLayout, ...]:
    """Load one layout for all trials, or a list of layouts with one for each trial.

    Raises:
        WorldError: a layout does not exist or is invalid, or the borders differ.
    """
    if isinstance(source, (str, Path, Mapping)) or not isinstance(source, Sequence):
        return (load(source),)
    if not source:
        raise WorldError("the list of layouts is empty", fix="Give one layout, or one for each trial")
    layouts = tuple(load(single) for single in source)
    for k, layout in enumerate(layouts):
        if layout.border != layouts[0].border:
            raise WorldError(
                f"the arena of trial {k} has the border {show(layout.border)} m, and that of trial 0"
                f" {show(layouts[0].border)} m",
                fix="Give all layouts the same arena",
            )
    return layouts


def load(source: LayoutSource) -> ArenaLayout:
    """Load a layout from data, the name of an arena that comes with deodar, `FILE` or `FILE#NAME`.

    Raises:
        WorldError: the arena does not exist or is invalid; the error lists all problems.
    """
    if isinstance(source, Mapping):
        return _layout(source, "arena")
    if not isinstance(source, (str, Path)):
        raise WorldError(f"an arena is a name, a file or a dictionary, not {show(source)}")
    layouts = builtin()
    if str(source) in layouts:
        return _layout(layouts[str(source)], str(source))
    file, _, name = str(source).partition("#")
    if not regular_file.is_file(file):
        hint = did_you_mean(str(source), layouts) + ". Or name a .json file" if layouts else ""
        raise WorldError(
            "there is no arena and no file of this name", where=str(source), fix=hint.replace("?.", "?")
        )
    arenas = _read(Path(file))
    if "arena" in arenas:
        return _layout(arenas, str(source))
    if not name and len(arenas) == 1:
        name = next(iter(arenas))
    if name not in arenas:
        fault = f"holds no arena {name!r}" if name else "holds several arenas" if arenas else "holds no arena"
        names = ", ".join(f"{file}#{n}" for n in list(arenas)[:8])
        raise WorldError(fault, where=file, fix=f"Type one of: {names}" if names else "")
    return _layout(arenas[name], str(source))


def _read(path: Path) -> JsonObject:
    with reading(path, WorldError):
        if path.stat().st_size > LARGEST_FILE:
            raise WorldError(f"is larger than {LARGEST_FILE // 2**20} MiB")
        arenas = codec.read(regular_file.read_bytes(path), codec.FEW_VALUES)
        if not isinstance(arenas, dict):
            raise WorldError(f"holds {show(arenas)}; an arena is an object with walls")
        return arenas


class _Faults(list[Problem]):
    """Problems found while reading one arena."""

    def __init__(self, where: str) -> None:
        super().__init__()
        self.where = where

    def say(self, place: str, fault: str, fix: str = "") -> None:
        self.append(Problem(": ".join(p for p in (self.where, place) if p), fault, fix))

    def pair(self, place: str, value: Json) -> tuple[float, float] | None:
        numbers = (
            [real(v) for v in value] if isinstance(value, Sequence) and not isinstance(value, str) else []
        )
        if len(numbers) != 2 or not all(n is not None and math.isfinite(n) for n in numbers):
            self.say(place, f"is {show(value)}; expected two finite numbers")
            return None
        return float(numbers[0] or 0), float(numbers[1] or 0)

    def height(self, place: str, value: Json, scale: float) -> float | None:
        """Return a height in metres, None where none is stated."""
        number = None if value is None else real(value)
        if value is not None and (number is None or not 0 < number < math.inf):
            self.say(place, f"is {show(value)}; expected a finite number above 0")
            return None
        return None if number is None else float(number) * scale


def _layout(layout: Json, where: str) -> ArenaLayout:
    faults = _Faults(where)
    if not isinstance(layout, Mapping):
        raise WorldError(f"is {show(layout)}; an arena is an object with walls", where=where)
    for key in layout:
        similar = "" if key in KNOWN else nearest(str(key), KNOWN)
        if similar:  # keys that are not similar to a known one are notes of the author
            faults.say("", f"has the unknown key {key!r}", f"Did you mean {similar!r}?")
    unit = layout.get("unit", "m")
    scale = UNITS.get(unit, 0.0) if isinstance(unit, str) else 0.0
    if not scale:
        faults.say("unit", f"is {show(unit)}; expected one of {', '.join(UNITS)}")
        scale = 1.0
    names = str(layout.get("plane", "x,y")).split(" ")[0]
    if names not in ("x,y", "x,z"):
        faults.say("plane", f"is {names!r}; expected x,y, or x,z (y up)")
        names = "x,y"
    # as in Webots: y is up, and heading 0 points along -z; so x is the file's -z, and y its -x
    turned = names == "x,z"
    border = _border(layout, names.split(","), turned, scale, faults)
    objects = tuple(_objects(layout, turned, scale, faults))
    start = _place(layout, "start", turned, scale, faults)
    heading = real(layout.get("heading", 0.0))
    if heading is None or not math.isfinite(heading):
        faults.say("heading", f"is {show(layout.get('heading'))}; expected an angle in rad")
    area = layout.get("goal_area")
    goal = _place(
        layout if "goal" in layout or not isinstance(area, Mapping) else {"goal": area.get("center")},
        "goal",
        turned,
        scale,
        faults,
    )
    walls = layout.get("arena")
    height = faults.height("arena.height", walls.get("height") if isinstance(walls, Mapping) else None, scale)
    if faults or border is None:
        raise WorldError(faults)
    begin = None if start is None else (*start, float(heading or 0))
    blocks = layout.get("blocks")
    count = len(blocks) if isinstance(blocks, Sequence) else 0
    fixed = frozenset(t.name for t in objects[: len(objects) - count])  # blocks are listed last
    return ArenaLayout(border, objects, begin, goal, WALL_HEIGHT if height is None else height, fixed)


def _border(
    layout: Mapping[str, Json], names: Sequence[str], turned: bool, scale: float, faults: _Faults
) -> tuple[float, float, float, float] | None:
    area = layout.get("arena")
    if not isinstance(area, Mapping) or not set(names) <= set(area):
        faults.say(
            "arena", f"is {show(area)}; expected {{{', '.join(f'{n!r}: [lower, upper]' for n in names)}}}"
        )
        return None
    spans = [faults.pair(f"arena.{n}", area[n]) for n in names]
    for name, span in zip(names, spans, strict=True):
        if span is not None and span[0] >= span[1]:
            faults.say(
                f"arena.{name}",
                f"is {show(area[name])}; expected [lower, upper] with lower < upper",
            )
    first, second = spans
    if first is None or second is None:
        return None
    lower, upper = _turn((first[0], second[0]), turned, scale), _turn((first[1], second[1]), turned, scale)
    return min(lower[0], upper[0]), min(lower[1], upper[1]), max(lower[0], upper[0]), max(lower[1], upper[1])


def _turn(place: tuple[float, float], turned: bool, scale: float) -> tuple[float, float]:
    a, b = place[0] * scale, place[1] * scale
    return (-b, -a) if turned else (a, b)


def _place(
    layout: Mapping[str, Json], key: str, turned: bool, scale: float, faults: _Faults
) -> tuple[float, float] | None:
    if layout.get(key) is None:
        return None
    position = faults.pair(key, layout[key])
    return None if position is None else _turn(position, turned, scale)


def _objects(
    layout: Mapping[str, Json], turned: bool, scale: float, faults: _Faults
) -> Iterator[ArenaObject]:
    taken: set[str] = set()
    for kind, colour in COLOURS.items():
        listed = layout.get(kind, [])
        if not isinstance(listed, Sequence) or isinstance(listed, str):
            faults.say(kind, f"is {show(listed)}; expected a list")
            continue
        for k, entry in enumerate(listed):
            name = str(entry.get("name", f"{kind}.{k}")) if isinstance(entry, Mapping) else f"{kind}.{k}"
            if not isinstance(entry, Mapping):
                faults.say(name, f"is {show(entry)}; expected an object with center and size")
                continue
            if name in taken:
                faults.say(name, "is the name of two objects")
            taken.add(name)
            unscaled = _object(
                name, entry.get("center"), entry.get("size"), entry.get("color", colour), faults
            )
            height = faults.height(f"{name}.height", entry.get("height"), scale)
            if unscaled is not None:
                (w, h), center = unscaled.size, _turn(unscaled.center, turned, scale)
                size = (h * scale, w * scale) if turned else (w * scale, h * scale)
                yield ArenaObject(name, center, size, unscaled.color, height)


def make(
    name: str, center: Json, size: Json, color: Json, scale: float = 1.0, height: Json = None
) -> ArenaObject:
    """Make an object from unchecked values; lengths are in units of `scale` metres.

    Without a height it is as tall as the walls of the border.

    Raises:
        WorldError: a number is missing or not finite, the object has no area, or its colour or
            height is invalid.
    """
    faults = _Faults("")
    unscaled = _object(name, center, size, color, faults)
    tall = faults.height(f"{name}.height", height, scale)
    if unscaled is None or faults:
        raise WorldError(faults)
    (x, y), (w, h) = unscaled.center, unscaled.size
    return ArenaObject(name, (x * scale, y * scale), (w * scale, h * scale), unscaled.color, tall)


def _object(name: str, center: Json, size: Json, color: Json, faults: _Faults) -> ArenaObject | None:
    before = len(faults)
    middle, extent = faults.pair(f"{name}.center", center), faults.pair(f"{name}.size", size)
    if extent is not None and not min(extent) > 0:
        faults.say(name, f"has the size {show(size)}; both are above 0, or it has no area")
    parts = [real(c) for c in color] if isinstance(color, Sequence) and not isinstance(color, str) else []
    if len(parts) != 3 or not all(c is not None and 0 <= c <= 1 for c in parts):
        faults.say(f"{name}.color", f"is {show(color)}; expected red, green and blue, each from 0 to 1")
    if len(faults) > before:
        return None
    assert middle is not None and extent is not None
    return ArenaObject(
        name, middle, extent, (float(parts[0] or 0), float(parts[1] or 0), float(parts[2] or 0))
    )
