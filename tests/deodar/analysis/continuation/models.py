"""Models whose bifurcations are known: those of the benchmark."""

from __future__ import annotations

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[4] / "benchmarks"))

from bifurcations import line, node, node_folds, oscillator, plane, rivals

__all__ = ["line", "node", "node_folds", "oscillator", "plane", "rivals"]
