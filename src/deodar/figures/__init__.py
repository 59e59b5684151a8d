"""Drawing of records: one file for each kind of figure; the folder is the list of kinds.

A kind is a module with `ACROSS` (whether time runs across), `suits(variable)`, `size(view)`, `fill(place,
view)`, and a function named as the module that returns a `matplotlib.figure.Figure`: `dd.space_time`,
`dd.time_course` and so on. Nothing here uses pyplot, so that figures are objects and not global state.
"""

from deodar.figures._files import save_figure
from deodar.figures._view import View
from deodar.figures.path import animate_path, path_figure
from deodar.figures.projection import projection
from deodar.figures.snapshot import snapshot
from deodar.figures.snapshots import snapshots
from deodar.figures.space_time import space_time
from deodar.figures.time_course import time_course

__all__ = [
    "View",
    "animate_path",
    "path_figure",
    "projection",
    "save_figure",
    "snapshot",
    "snapshots",
    "space_time",
    "time_course",
]
