"""cosivina, the MATLAB toolbox and its Python port: JSON files of simulators."""

from __future__ import annotations

from deodar.exporters.cosivina.simulator import write

NAME = "cosivina"
ENDING = ".json"

__all__ = ["ENDING", "NAME", "write"]
