"""The step of a model as pure functions: which parameters they depend on, and their checks."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from deodar.compiler.build import Build
from deodar.compiler.driven import array_leaf, driven
from deodar.compiler.dynamics import Dynamics
from deodar.errors import ParameterError, WorldError
from deodar.leaves import leaves as numbers
from deodar.model import edit, find
from deodar.model.document import Document, Leaf
from deodar.model.model import Handle, Model, path_of
from deodar.session.exchange import embodied, used
from deodar.session.run import require_step
from deodar.session.session import require_model
from deodar.worlds._base import World


def dynamics(
    model: Model,
    parameters: Sequence[str | Handle] = (),
    *,
    dt: float | None = None,
    precision: str = "float64",
    world: World | None = None,
) -> Dynamics:
    """Return the step of a model as pure functions, which JAX can compile, differentiate and vectorise.

    Noise, time, windows, delays and parts of several ticks are those of `simulate`. `rollout` takes many
    steps of them.

    Args:
        model: the model in its present state.
        parameters: paths of the parameters that the functions take: numbers that are live or rebuild, such as
            `u.tau`, document parameters, and arrays, such as the weights of a kernel. Others are constant.
        dt: Euler step; none: the document's own, else 1.
        precision: float64 or float32.
        world: the world that provides the sensors of the model; it must be made of pure functions, and is
            computed inside the step. None: readings of sensors are inputs, by default 0.

    Raises:
        ParameterError: a parameter is not a number or array of the program, is off, or names several
            different numbers.
        TimeError: dt is too long for an element.
        WorldError: the world is computed on the host.
    """
    doc = require_model(model).document
    model.require()
    step = doc.step if dt is None else dt
    require_step(doc, step)
    doc = edit.describe(doc, dt=float(step))
    body = embodied(doc, world)
    if world is not None and body is None and any(used(doc, world)):
        raise WorldError(
            f"{type(world).__name__} is computed on the host, between steps, where JAX has no derivative",
            fix=(
                "Leave out the world, and give the readings of the sensors as inputs: inputs={PATH: reading};"
                " or write it as a dd.PureWorld"
            ),
        )
    paths = [path_of(path) for path in parameters]
    drives = {path: _drives(doc, path) for path in paths}
    driven_leaves = [leaf for path in paths for leaf in drives[path]]
    if len(set(driven_leaves)) < len(driven_leaves):
        raise ParameterError("two of the parameters drive the same number", fix="Leave one of them out")
    accuracy = "exact" if any(array_leaf(doc, path) for path in paths) else "default"
    functions = Dynamics(model, Build(doc, precision, accuracy, body=body), drives)
    assert functions.executable.precision == precision  # made here, as checks of a model cannot be traced
    return functions


def _drives(doc: Document, path: str) -> tuple[Leaf, ...]:
    """Return the leaves of a parameter, which have one value."""
    if (array := array_leaf(doc, path)) is not None:
        return (array,)
    leaves = driven(doc, path)
    for ident, leaf in leaves:
        entry = find.entry(doc, ident)
        declared = next(p for name, _, p in numbers(entry.element) if name == leaf)
        if declared.off and find.number(doc, ident, leaf) == declared.neutral:
            raise ParameterError(
                f"is off at {declared.neutral:g}, which is not the limit of small values",
                where=f"{entry.path}.{leaf}",
                fix="Set it to another value first",
            )
    values = {float(np.asarray(find.number(doc, *leaf))) for leaf in leaves}
    if len(values) > 1:
        names = ", ".join(f"{find.entry(doc, ident).path}.{leaf}" for ident, leaf in leaves)
        raise ParameterError(
            "stands for several numbers of different values", where=path, fix=f"Name one of them: {names}"
        )
    return tuple(leaves)
