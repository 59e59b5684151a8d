"""Whether programs round a product before it is added to something."""

from __future__ import annotations

import os

FLAGS = "XLA_FLAGS"
"""Environment variable with the options of XLA."""

SEPARATE = "--xla_cpu_max_isa=AVX"
"""Option of XLA: instructions without one for a product and a sum together."""

SEPARATELY = "separate"
"""How a record states it."""


def separate_rounding() -> bool:
    """Return whether programs of this process round separately."""
    return SEPARATE in os.environ.get(FLAGS, "").split()
