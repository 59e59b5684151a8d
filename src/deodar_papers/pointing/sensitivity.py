"""Every parameter of the architecture changed by 20 %, one at a time, on scenes with the seeds for tuning."""

from __future__ import annotations

import functools
from collections.abc import Mapping, Sequence

import numpy as np

from deodar.architectures.pointing import COLOURS, CUES, SIDES, pointing
from deodar.couplings.pictures import Homography
from deodar.declarations import LIMITING
from deodar.elements.stimuli import Boost
from deodar.leaves import leaves
from deodar_papers.pointing.scenes import TUNING

CHANGE = 0.2
FACTORS: Mapping[str, float] = {"-20 %": 1 - CHANGE, "+20 %": 1 + CHANGE}
SCENES = 3
FIRST = TUNING + 100
"""Scenes of each change, and the seed of the first."""

GROUPS: Mapping[str, Sequence[str]] = {
    "cue": CUES,
    "hue of a colour": [f"hue of {name}" for name in COLOURS],
    "space of a side": [f"space of {name}" for name in SIDES],
}
"""Elements that are changed together, by the name of the group."""


@functools.cache
def changes() -> Mapping[str, Mapping[str, float | np.ndarray]]:
    """Return for each condition, such as `perceptual.tau -20 %`, the changed values by path.

    Parameters are all live ones that are not 0. Left out are the input of the user, and the corners of the
    table in the picture, which are measured. A time scale is not changed below the step of the model.
    """
    group = {name: key for key, names in GROUPS.items() for name in names}
    found: dict[str, dict[str, float | np.ndarray]] = {}
    document = pointing().document
    for entry in document.entries:
        if isinstance(entry.element, (Boost, Homography)):
            continue
        for path, value, declared in leaves(entry.element):
            if not np.any(value):
                continue
            for sign, factor in FACTORS.items():
                condition = f"{group.get(entry.path, entry.path)}.{path} {sign}"
                changed = factor * value
                if declared.role in LIMITING and isinstance(changed, float):
                    changed = max(changed, document.step)
                found.setdefault(condition, {})[f"{entry.path}.{path}"] = changed
    return found
