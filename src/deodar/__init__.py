"""deodar: a workbench for Dynamic Field Theory.

>>> import deodar as dd
>>> x = dd.Axis("x", 0, 100, samples=101)
>>> model = dd.Model("first")
>>> u = model.add(dd.Field("u", [x], kernel=[dd.Gaussian(amplitude=1.2, sigma=5)]))

`__init__.pyi` lists the public names and where each is defined; packages of others add names by the entry
points `deodar.names`.
"""

from __future__ import annotations

import importlib
import importlib.machinery
import os
from typing import Any

__version__ = "0.2.0"


def _homes() -> dict[str, tuple[str, str]]:
    """Return module and attribute of each public name, from the lines `from MODULE import NAME as NAME` of
    the stub; what is imported from the root of a package is a module.

    The lines of a package that is not beside this one are left out.
    """
    beside = set(os.listdir(os.path.dirname(__path__[0])))
    with open(os.path.join(__path__[0], "__init__.pyi"), encoding="utf-8") as stub:
        lines = [line.split() for line in stub if line.startswith("from ")]
    return {words[5]: (words[1], words[3]) for words in lines if words[1].partition(".")[0] in beside}


_HOMES = _homes()

__all__ = sorted(_HOMES)  # pyright: ignore[reportUnsupportedDunderAll]


def __getattr__(name: str) -> Any:
    """Import a public name when it is first used, so that `import deodar` imports neither JAX nor NumPy."""
    if name not in _HOMES:
        # `from deodar import MODULE` asks for the attribute before it imports the module
        if name.startswith("_") or importlib.machinery.PathFinder.find_spec(f"deodar.{name}", __path__):
            raise AttributeError(f"module 'deodar' has no attribute {name!r}", name=name, obj=None)
        return importlib.import_module("deodar.names").packaged(name, __all__)
    home, attribute = _HOMES[name]
    value = (
        getattr(importlib.import_module(home), attribute)
        if "." in home
        else importlib.import_module(f"{home}.{attribute}")
    )
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted([*_HOMES, *importlib.import_module("deodar.names").outside(__all__), "__version__"])
