"""The limits of a chip, as files in the folder `chips`, each number with its source."""

from __future__ import annotations

import dataclasses as dc
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from deodar import regular_file
from deodar.errors import UnknownName, did_you_mean

FOLDER = Path(__file__).parent / "chips"


@dc.dataclass(frozen=True)
class ChipLimits:
    """What a chip has; None: no limit.

    Attributes:
        name, meaning: name and one line about it.
        neurons_per_core, cores: neurons of a core, and cores.
        fan_in: synapses of a neuron.
        sources_per_core: neurons whose spikes a core receives.
        synapse_bits_per_core: memory of a core for weights.
        weight_bits, bias_bits: bits of a weight and of a constant current, with the sign.
        mismatch: relative standard deviation between neurons, by parameter.
        sources: where each number comes from.
    """

    name: str
    meaning: str
    neurons_per_core: int | None = None
    cores: int | None = None
    fan_in: int | None = None
    sources_per_core: int | None = None
    synapse_bits_per_core: int | None = None
    weight_bits: int | None = None
    bias_bits: int | None = None
    mismatch: Mapping[str, float] = dc.field(default_factory=dict[str, float])
    sources: Mapping[str, str] = dc.field(default_factory=dict[str, str])


def chip_names() -> list[str]:
    """Return the names of all chips."""
    return sorted(p.stem for p in FOLDER.glob("*.toml"))


def chip_limits(name: str) -> ChipLimits:
    """Return the limits of a chip.

    Raises:
        UnknownName: there is no chip of that name.
    """
    if name not in chip_names():
        raise UnknownName(f"there is no chip {name!r}", fix=did_you_mean(name, chip_names()))
    document: dict[str, Any] = tomllib.loads(regular_file.read_text(FOLDER / f"{name}.toml"))
    return ChipLimits(name, **document)
