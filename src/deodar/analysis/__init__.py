"""Measurements: peaks, instabilities, regimes, phase plots, paths, statistics.

The functions are public as `dd.peaks`, `dd.regimes` and so on. `dd.analysis` has them too, and the classes of
their results. Where a module and its function share a name, `deodar.analysis` exports the function; import
other names from the module.
"""

from deodar.analysis.continuation.bifurcation import Bifurcation
from deodar.analysis.continuation.branch import SteadyBranch
from deodar.analysis.continuation.locus import Locus, LocusPoint
from deodar.analysis.continuation.right_hand_side import RightHandSide
from deodar.analysis.isolated import Isolated, isolate
from deodar.analysis.maps.map_result import RegimeMap
from deodar.analysis.peaks import Peak, Peaks, peaks
from deodar.analysis.phase import FixedPoint, Phase, phase
from deodar.analysis.ramp import Branch, SettledRamp, ramp
from deodar.analysis.regimes import Regimes, regimes
from deodar.analysis.robot_paths import (
    Grid,
    arena_grid,
    clearance,
    path_divergence,
    path_length,
    path_until,
    shortest_path,
)
from deodar.analysis.selection import Selection, selection
from deodar.analysis.settle import Settled, settle
from deodar.analysis.statistics import anova, mean_interval, median_interval, wilson
from deodar.analysis.thresholds import Thresholds, Transition, descend, thresholds
from deodar.analysis.tuning.response import FieldResponse, SettledBatch
from deodar.analysis.tuning.search import RegionSize
from deodar.analysis.tuning.tuned import Tuned
from deodar.analysis.working_memory import Memory, forgetting, outlives

__all__ = [
    "Bifurcation",
    "Branch",
    "FieldResponse",
    "FixedPoint",
    "Grid",
    "Isolated",
    "Locus",
    "LocusPoint",
    "Memory",
    "Peak",
    "Peaks",
    "Phase",
    "RegimeMap",
    "Regimes",
    "RegionSize",
    "RightHandSide",
    "Selection",
    "Settled",
    "SettledBatch",
    "SettledRamp",
    "SteadyBranch",
    "Thresholds",
    "Transition",
    "Tuned",
    "anova",
    "arena_grid",
    "clearance",
    "descend",
    "forgetting",
    "isolate",
    "mean_interval",
    "median_interval",
    "outlives",
    "path_divergence",
    "path_length",
    "path_until",
    "peaks",
    "phase",
    "ramp",
    "regimes",
    "selection",
    "settle",
    "shortest_path",
    "thresholds",
    "wilson",
]
