"""An arena from above: walls and axes to scale, under paths and fields."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, Protocol

from matplotlib.axes import Axes
from matplotlib.patches import Rectangle

from deodar.figures import _style
from deodar.worlds.arena.arena import Arena


class Wall(Protocol):
    """An object of an arena: left, low, right and high in m."""

    @property
    def box(self) -> Any: ...


def borders(arena: Arena) -> tuple[float, float, float, float]:
    """Left, low, right and high, in the unit of the arena."""
    left, low, right, high = (v / arena.scale for v in arena.layout.border)
    return left, low, right, high


def box(arena: Arena, item: Wall, **look: Any) -> Rectangle:
    """The rectangle of an object, in the unit of the arena."""
    x0, y0, x1, y1 = (v / arena.scale for v in item.box)
    return Rectangle((x0, y0), x1 - x0, y1 - y0, **look)


def walls(ax: Axes, arena: Arena, objects: Iterable[Wall]) -> None:
    """Draw objects as walls, and set the axes to the arena's borders, to scale."""
    for item in objects:
        ax.add_patch(box(arena, item, facecolor=_style.COLOR.wall, linewidth=0))
    frame(ax, arena)


def frame(ax: Axes, arena: Arena) -> None:
    """Set the axes to the arena's borders, to scale, with a line round them."""
    left, low, right, high = borders(arena)
    ax.set_xlim(left, right)
    ax.set_ylim(low, high)
    ax.set_aspect("equal")
    for spine in ax.spines.values():
        spine.set_visible(True)


def labels(ax: Axes, arena: Arena) -> None:
    """Name both axes, with the unit of the arena."""
    ax.set_xlabel(f"x ({arena.unit})")
    ax.set_ylabel(f"y ({arena.unit})")
