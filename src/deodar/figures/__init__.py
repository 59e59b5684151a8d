"""Figures with matplotlib, in one style: records, regimes, arenas, runs of papers.

`COLOR` defines the meaning of each colour, and `RC` the sizes of type and lines, for your own figures:
`matplotlib.rc_context(dd.figures.RC)`.

A kind of figure of a recorded variable is a module with `ACROSS` (whether time runs across),
`suits(view)`, `size(view)`, `fill(place, view)`, and a function named as the module that returns a
`matplotlib.figure.Figure`: `dd.space_time`, `dd.time_course` and so on. No module uses pyplot, so figures
are objects without global state.
"""

from deodar.figures._file import FigureFile, FigurePanel
from deodar.figures._files import save_figure
from deodar.figures._style import ACTIVATION, AMOUNTS, COLOR, COLORS, RC, THRESHOLD_LINE, Palette
from deodar.figures._view import View
from deodar.figures.bifurcation import bifurcation_diagram
from deodar.figures.locus import locus_figure
from deodar.figures.path import animate_path, path_figure
from deodar.figures.projection import projection
from deodar.figures.regime_map import regime_map_figure
from deodar.figures.regimes import phase_figure, regimes_figure
from deodar.figures.snapshot import snapshot
from deodar.figures.snapshots import snapshots
from deodar.figures.space_time import space_time
from deodar.figures.time_course import time_course

__all__ = [
    "ACTIVATION",
    "AMOUNTS",
    "COLOR",
    "COLORS",
    "RC",
    "THRESHOLD_LINE",
    "FigureFile",
    "FigurePanel",
    "Palette",
    "View",
    "animate_path",
    "bifurcation_diagram",
    "locus_figure",
    "path_figure",
    "phase_figure",
    "projection",
    "regime_map_figure",
    "regimes_figure",
    "save_figure",
    "snapshot",
    "snapshots",
    "space_time",
    "time_course",
]
