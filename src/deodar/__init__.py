"""deodar: a workbench for Dynamic Field Theory.

>>> import deodar as dd
>>> x = dd.Axis("x", 0, 100, samples=101)
>>> model = dd.Model("first")
>>> u = model.add(dd.Field("u", [x], kernel=[dd.Gaussian(amplitude=1.2, sigma=5)]))

`__init__.pyi` lists the public names and where each is defined.
"""

from __future__ import annotations

import importlib
import os
from typing import Any

__version__ = "0.1.0"


def _homes() -> dict[str, str]:
    """Return the module of each public name, from the lines `from MODULE import NAME as NAME` of the stub."""
    with open(os.path.join(__path__[0], "__init__.pyi"), encoding="utf-8") as stub:
        lines = [line.split() for line in stub if line.startswith("from ")]
    return {words[3]: words[1] for words in lines}


_HOMES = _homes()

__all__ = sorted(_HOMES)  # pyright: ignore[reportUnsupportedDunderAll]


def __getattr__(name: str) -> Any:
    """Import a public name when it is first used, so that `import deodar` imports neither JAX nor NumPy."""
    home = _HOMES.get(name)
    if home is None:
        # not `from deodar import errors`, which would call this function again
        raise importlib.import_module("deodar.errors").no_attribute("deodar", name, _HOMES)
    found = (
        importlib.import_module(f"deodar.{name}")
        if home == "deodar"
        else getattr(importlib.import_module(home), name)
    )
    globals()[name] = found
    return found


def __dir__() -> list[str]:
    return sorted([*_HOMES, "__version__"])
