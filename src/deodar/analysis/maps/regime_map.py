"""Maps of regimes over two parameters, by simulation."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Unpack

import numpy as np

from deodar.analysis.maps import grid
from deodar.analysis.maps.map_result import RegimeMap
from deodar.analysis.maps.protocol import RegimeProtocol
from deodar.analysis.maps.request import MapOptions, requested
from deodar.model.model import Model
from deodar.progress import telling
from deodar.resources import Resources, use_resources


def regime_map(
    model: Model,
    over: Mapping[str, Sequence[float] | np.ndarray | tuple[float, float, int]],
    field: str = "",
    strength: float | None = None,
    refine: bool = True,
    on: Resources = Resources(),
    **options: Unpack[MapOptions],
) -> RegimeMap:
    """Map what a field does with its input over two parameters, by simulation of each cell.

    The field is measured alone, without noise, as by `dd.regimes`. Each cell is a run of several stages, each
    until the field settles: no input; one localised input; none again; then, from the resting level, two
    equal inputs, the first a hundredth stronger until the field settles. Peaks are counted at the end of each
    stage. A single peak that covers both inputs is no selection.

    Args:
        model: the model.
        over: for each of two parameters its values in growing order, or (lowest, highest, number).
        field: path of the field or node; empty: the only one.
        strength: amplitude of each input; None: 1.2 times the distance between resting level and threshold
            of the model's own field, which makes a peak without interaction.
        refine: whether a coarse grid comes first, and then only cells of which a neighbour has another label;
            else every cell is computed.
        on: its `progress` counts cells; the total is the number that is known to be needed.
        limit: longest stage, in time constants (500); a field that has not settled then gets a label of its
            own.
        sigma: width of the inputs; None: that of the kernel's excitation, in all cells.
        center: position of the single input; None: the sample nearest to the middle.
        precision: float32 or float64.
        dt: Euler step; None: see `isolate`.
        inputs: elements of the model kept as constant inputs.

    Raises:
        AnalysisError: the element is not a field with one axis or none, or a parameter changes no label.
        ParameterError: changing a parameter needs another program, or its values are no axis of a map.
        UnknownName: a path is unknown.
    """
    finished, progress = 0, use_resources(on, "dd.regime_map", "progress").progress
    request = requested(model, over, field, strength, options)
    protocol = RegimeProtocol(request)

    def compute(labels: np.ndarray, cells: np.ndarray) -> np.ndarray:
        nonlocal finished
        before, finished = finished, finished + len(cells)
        return protocol.run(labels, cells, lambda done: tell(before + done, before + len(cells)))

    first, second = (len(values) for values in request.values)
    with telling(progress, "regime map", "cells") as tell:
        labels, computed = (grid.refined if refine else grid.every)((first, second), compute)
    return RegimeMap.of(model, request, labels, computed)
