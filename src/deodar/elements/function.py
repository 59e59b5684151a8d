"""A user's own function as an element."""

from __future__ import annotations

import importlib
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

from deodar.element import Arrays, Element, Setting, Time
from deodar.errors import ModelError, UnknownName
from deodar.numerics.axes import Axes, Axis
from deodar.parameters import Live, Recompile
from deodar.registry import register


def leaky(state: Any, inputs: Mapping[str, Any], time: Time, rate: Any = 0.1) -> Any:
    """The example of the manual: a leaky integrator, du/dt = rate (input - u)."""
    return state + time.dt * rate * (inputs["input"] - state)


@register
@dataclass(frozen=True)
class Function(Element):
    """An element whose step is a function of one's own, written in JAX.

    Equation:
        u(t + dt) = function(u(t), inputs(t), time, **values); `time.dt` is the step, `time.now` the time.

    Parameters:
        axes: axes of the state, the output and all inputs; none: numbers.
        function: `module:name`, or the function itself. It is stored by name and found again when the model is compiled, in
            a document from elsewhere only after it is trusted.
        ports_in: names of the input ports.
        initial: state at the start.
        values: named numbers handed to the function as keyword arguments.

    Ports:
        output: the state u, over `axes`.

    Reference:
        no reference
    """

    name: Annotated[str, Recompile(meaning="name inside its group")] = ""
    axes: Annotated[Sequence[Axis], Recompile(meaning="axes of the state")] = ()
    function: Annotated[str | Callable[..., Any], Recompile(meaning="module:name")] = "deodar.elements.function:leaky"
    ports_in: Annotated[Sequence[str], Recompile(meaning="names of the input ports")] = ("input",)
    initial: Annotated[float, Live(meaning="state at the start")] = 0.0
    values: Annotated[Mapping[str, float], Live(meaning="numbers handed to the function")] = ()  # type: ignore[assignment]

    stateful: ClassVar[bool] = True

    def ports(self) -> tuple[str, ...]:
        return tuple(self.ports_in)

    def outputs(self, ins: Mapping[str, Axes]) -> Mapping[str, Axes]:
        return {"output": tuple(self.axes)}

    def init(self, at: Setting) -> Arrays:
        return {"state": at.full(tuple(self.axes), self.initial)}

    def output(self, at: Setting, state: Arrays, inputs: Arrays, constants: Any, time: Time, noise: Any) -> Arrays:
        return {"output": state["state"]}

    def advance(self, at: Setting, state: Arrays, inputs: Arrays, constants: Any, time: Time, noise: Any) -> Arrays:
        values: Any = self.values
        new = self.load()(state["state"], inputs, time, **dict(values))
        if getattr(new, "shape", ()) != state["state"].shape:
            raise ModelError(f"{self.function} returned shape {getattr(new, 'shape', ())}, its state has {state['state'].shape}", where=self.name)
        return {"state": at.array(new)}

    def load(self) -> Callable[..., Any]:
        """The function itself. This imports its module: never called before the document is trusted."""
        module, _, path = str(self.function).partition(":")
        try:
            found: Any = sys.modules.get(module) or importlib.import_module(module)
            for step in path.split("."):
                found = getattr(found, step)
        except (ImportError, AttributeError, ValueError) as error:
            raise UnknownName(
                f"the function {self.function!r} cannot be found ({error})",
                where=self.name,
                fix="It is written module:name, and the module must be importable",
            ) from None
        return found
