"""An element defined by a custom function."""

from __future__ import annotations

import importlib
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, Any

import jax.numpy as jnp
from jax import Array
from jax.typing import ArrayLike

from deodar.element import Arrays, Element, Setting, Time
from deodar.errors import DeodarError, ModelError, UnknownName, first_line
from deodar.numerics.axes import Axis
from deodar.numerics.scalar import Scalar
from deodar.parameters import Live, show
from deodar.registry import register


def leaky(state: Array, inputs: Mapping[str, Array], time: Time, rate: Scalar = 0.1) -> Array:
    """A leaky integrator, du/dt = rate (input - u): the default of `Function` and the manual's example."""
    return state + time.dt * rate * (inputs["input"] - state)


@register
@dataclass(frozen=True)
class Function(Element):
    r"""An element whose step is a custom function written in JAX.

    `time.dt` is the step and `time.now` the time; `values` are passed as keyword arguments.

    Equation:
        u(t + dt) = \mathrm{function}(u(t), \mathrm{inputs}(t), \mathrm{time}, \mathrm{values})

    Parameters:
        axes: axes of the state, the output and all inputs; none: numbers.
        function: `module:name`, or the function itself. A document stores its name; the function is imported
            when the model is compiled. A document from another source must be trusted first.
        ports_in: names of the input ports.
        initial: state at the start.
        values: named numbers passed to the function as keyword arguments.

    Ports:
        output: the state u, over `axes`.

    Reference:
        no reference
    """

    name: str = ""
    axes: Sequence[Axis] = ()
    function: str | Callable[..., ArrayLike] = "deodar.elements.function:leaky"
    ports_in: Sequence[str] = ("input",)
    initial: Annotated[float, Live()] = 0.0
    values: Annotated[Mapping[str, float], Live()] = ()  # type: ignore[assignment]

    def validate(self) -> Iterator[tuple[str, str]]:
        names = tuple(self.ports_in)
        for name in names:
            if not name.isidentifier() or name == "output":
                yield (
                    "ports_in",
                    f"contains {name!r}; the name of a port is a Python identifier other than 'output'",
                )
        if len(set(names)) < len(names):
            yield "ports_in", f"contains a name twice: {', '.join(names)}"
        for name in dict(self.values):
            if not name.isidentifier():
                yield "values", f"contains {name!r}, which cannot be the name of a keyword argument"

    def ports(self) -> tuple[str, ...]:
        return tuple(self.ports_in)

    def init(self, at: Setting) -> Arrays:
        return {"state": at.full(tuple(self.axes), self.initial)}

    def output(self, at: Setting) -> Arrays:
        return {"output": at.state["state"]}

    def advance(self, at: Setting) -> Arrays:
        function, here = self.load(), at.state["state"].shape
        try:
            new = jnp.asarray(function(at.state["state"], at.inputs, at.time, **dict(self.values)))
        except DeodarError:
            raise
        except Exception as error:
            raise ModelError(
                f"the function {self.function} raised {type(error).__name__}: {first_line(error)}",
                where=self.name,
                fix=(
                    "It is called as function(state, inputs, time, **values), traced by JAX, and returns the"
                    " new state"
                ),
            ) from error
        if new.shape != here or new.dtype.kind not in "fiu":
            raise ModelError(
                f"the function {self.function} returned {new.dtype} numbers of shape {list(new.shape)};"
                f" its state has real numbers of shape {list(here)}",
                where=self.name,
                fix="It returns the new state, one number for each sample of the axes",
            )
        return {"state": at.array(new)}

    def external_code(self) -> str:
        return str(self.function)

    def load(self) -> Callable[..., Any]:
        """Import the function. Importing runs its module, so this is called only for trusted documents."""
        module, _, path = str(self.function).partition(":")
        try:
            found: Any = sys.modules.get(module) or importlib.import_module(module)
            for step in path.split("."):
                found = getattr(found, step)
        except Exception as error:  # importing runs the module, which may raise any exception
            raise UnknownName(
                f"the function {self.function!r} cannot be found ({type(error).__name__}:"
                f" {first_line(error)})",
                where=self.name,
                fix="It is written module:name, and the module must be importable",
            ) from error
        if not callable(found):
            raise ModelError(f"{self.function!r} is {show(found)}, which is not a function", where=self.name)
        return found
