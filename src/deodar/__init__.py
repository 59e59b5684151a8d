"""deodar: a workbench for Dynamic Field Theory.

>>> import deodar as dd
>>> x = dd.Axis("x", 0, 100, samples=101)
>>> model = dd.Model("first")
>>> u = model.add(dd.Field("u", [x], kernel=[dd.Gaussian(amplitude=1.2, sigma=5)]))
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from deodar import errors as errors
    from deodar.couplings.gain import Gain as Gain
    from deodar.couplings.project import Project as Project
    from deodar.elements.field import Field as Field
    from deodar.elements.gaussian_stimulus import GaussianStimulus as GaussianStimulus
    from deodar.experiments.experiment import Experiment as Experiment
    from deodar.importers.opening import load as load
    from deodar.model.diagram import draw as draw
    from deodar.model.model import Model as Model
    from deodar.model.model import save as save
    from deodar.model.paths import quote as quote
    from deodar.numerics.axes import Axis as Axis
    from deodar.numerics.kernels.gaussian import Gaussian as Gaussian
    from deodar.numerics.sigmoids.logistic import Logistic as Logistic
    from deodar.runtime.cores import use_cores as use_cores
    from deodar.runtime.session import Session as Session
    from deodar.runtime.simulate import simulate as simulate

__version__ = "0.1.0"

_HOMES = {
    "Axis": "numerics.axes",
    "Experiment": "experiments.experiment",
    "Field": "elements.field",
    "Gain": "couplings.gain",
    "Gaussian": "numerics.kernels.gaussian",
    "GaussianStimulus": "elements.gaussian_stimulus",
    "Logistic": "numerics.sigmoids.logistic",
    "Model": "model.model",
    "Project": "couplings.project",
    "Session": "runtime.session",
    "draw": "model.diagram",
    "errors": "errors",
    "load": "importers.opening",
    "quote": "model.paths",
    "save": "model.model",
    "simulate": "runtime.simulate",
    "use_cores": "runtime.cores",
}

__all__ = sorted(_HOMES)  # pyright: ignore[reportUnsupportedDunderAll]


def __getattr__(name: str) -> Any:
    """Root names are resolved when first used, so that `import deodar` imports neither JAX nor NumPy."""
    if name not in _HOMES:
        raise AttributeError(f"module 'deodar' has no attribute {name!r}")
    module = importlib.import_module(f"deodar.{_HOMES[name]}")
    found = module if name == "errors" else getattr(module, name)
    globals()[name] = found
    return found


def __dir__() -> list[str]:
    return sorted([*_HOMES, "__version__"])
