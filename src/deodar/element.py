"""The contract of elements and couplings: everything that stands in a model.

An element sees one copy of itself: batches, trials, groups, rates and the working precision are the
compiler's. Inside the compiled program its live and rebuild parameters are tracers, so that `self.tau` may be
used in formulas as it stands.

The laws that an element may rely on:

* a step reads every output at time t, then commits all new states together;
* all connections into one port are summed, in the port's axes;
* `prepare` may use parameters that rebuild (and arrays), not live ones; what it returns is handed to
  `hoist`, which may use all and is computed once a chunk; what that returns is handed to `output` and
  `advance`.
"""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Self

import jax.numpy as jnp
import numpy as np
from jax import Array, lax
from jax.typing import DTypeLike

from deodar import renamed
from deodar.errors import ModelError
from deodar.numerics.axes import Axes, Axis, shape
from deodar.numerics.exact import Exact, exact, split, wide
from deodar.numerics.intervals import Interval
from deodar.numerics.kernels._base import Kernel
from deodar.numerics.signs import Sign
from deodar.parameters import Part, Recompile

Arrays = dict[str, Array]


@dc.dataclass(frozen=True)
class Time:
    """Document time inside a step, exact in both precisions.

    It is `origin + passed * step`, computed in float64 from the number of steps, so that it does not depend
    on how a run was cut into chunks.

    Attributes:
        origin: document time at some tick before, or at the present one.
        passed: steps since then, a whole number.
        step: step of the model.
        ticks: step of the element as a multiple of it.
    """

    origin: Any
    passed: Any
    step: Exact
    ticks: int = 1

    if not TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any:
            raise renamed.no_member(self, name)

    @classmethod
    def at(cls, now: float, dt: float, dtype: DTypeLike) -> Time:
        """A time given by numbers of the host."""
        return cls(Exact(*split(now, dtype)), np.uint32(0), Exact(*split(dt, dtype)))

    @property
    def dt(self) -> Any:
        """Step of the element (of its own rate), in the working precision."""
        return self.step.high * self.ticks

    @property
    def wide(self) -> Array:
        """The time in float64, inside `exact()`."""
        return wide(self.origin) + jnp.asarray(self.passed).astype(jnp.float64) * wide(self.step)

    @property
    def wide_dt(self) -> Array:
        """Step of the element in float64, inside `exact()`."""
        return wide(self.step) * self.ticks

    @property
    def moment(self) -> Exact:
        """The time as two numbers of the working precision, for a state that stores when something happened.

        A state that counts steps or adds up `dt` instead stops counting in single precision.
        """
        dtype = self.step.high.dtype
        with exact():
            now, digits = self.wide, jnp.finfo(dtype)
            high = lax.reduce_precision(
                now, digits.nexp, digits.nmant
            )  # a cast there and back would be left out as superfluous
            return Exact(high.astype(dtype), (now - high).astype(dtype))

    def since(self, moment: Exact | Array | float) -> Array:
        """Time passed since `moment` (negative before it), in the working precision: exact to its last digit
        near the moment.
        """
        now = self.moment
        m = moment if isinstance(moment, Exact) else Exact(moment, 0.0)
        return (now.high - m.high) + (now.low - m.low)

    @property
    def now(self) -> Array:
        """The time itself, in the working precision: in float32 it has 24 bits, so compare with moments by
        `since`.
        """
        return self.since(0.0)


@dc.dataclass(frozen=True)
class Convolution:
    """Declares what an element convolves with its `kernels`, by `Setting.convolve`, and where the integral
    goes.

    A class that overrides `output` or `advance` restates the declaration. Without it `Setting.convolve` works
    too, but the compiler does not rearrange sums around the class.

    Attributes:
        of: port that is convolved: an input, or the output that the dynamics read.
        into: an output that is the integral and nothing else, or an input to which `advance` adds the
            integral and which it does not use otherwise.
    """

    of: str
    into: str


def _undeclared(y: Any) -> Any:
    raise ModelError(
        "an element calls `at.convolve` and declares no convolution, or calls it outside of `output` and"
        " `advance`",
        fix='Declare it in the class: convolution: ClassVar = dd.Convolution("output", into="input")',
    )


@dc.dataclass(frozen=True)
class Setting:
    """Where an element stands: the axes at its ports, the precision of the model, and its convolution.

    Attributes:
        ins, outs: axes of the ports.
        dtype: working precision.
        convolve: function of an array over the axes of the port that `Element.convolution` declares: the
            integral of the kernels times it, over the same axes. In `output` and `advance` only.
    """

    ins: Mapping[str, Axes]
    outs: Mapping[str, Axes]
    dtype: DTypeLike
    convolve: Callable[[Any], Any] = _undeclared

    if not TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any:
            raise renamed.no_member(self, name)

    def full(self, axes: Axes, value: Any) -> Array:
        """An array over the axes, filled with one value."""
        return jnp.full(shape(axes), value, self.dtype)

    def array(self, values: Any) -> Array:
        """The values as an array in the working precision."""
        return jnp.asarray(getattr(values, "data", values), self.dtype)

    def exact(self, values: Any) -> Exact:
        """The values, with the digits of float64."""
        return (
            values
            if isinstance(values, Exact)
            else Exact(*split(getattr(values, "data", values), self.dtype))
        )

    def points(self, axis: Axis) -> Array:
        """Values at the samples of an axis, in the working precision."""
        return jnp.asarray(axis.points, self.dtype)


@dc.dataclass(frozen=True)
class Element(Part):
    """Base of everything that stands in a model.

    Class attributes:
        inputs: names of the input ports.
        direct: for each output port that passes inputs on in the same instant, which; ports not named show
            the state.
        follows: for an input port that takes the axes of another one, which.
        external: input that no connection reaches, of the axes of `output`; its value comes from outside the
            model: from the world for a `Sensor` and classes derived from it, else it is 0. "": none.
        stateful: whether `advance` exists; if not, all outputs follow from inputs, time and noise.
        reads_own_output: output ports that `advance` finds among its inputs, as they were in the same step.
        linear: whether the default output is linear in the one input.
        convolution: what it convolves with its `kernels`, and where the integral goes; None: nothing.
        scaled_by: the parameter by which `output` is a multiple of `input`; "" where it is no multiple.
        levels: for a port, the parameters that are levels on its scale, by what they are called: drawn as
            lines in plots.
    """

    name: Annotated[str, Recompile(meaning="name inside its group")] = dc.field(default="", kw_only=True)

    inputs: ClassVar[tuple[str, ...]] = ("input",)
    direct: ClassVar[Mapping[str, tuple[str, ...]]] = {}
    follows: ClassVar[Mapping[str, str]] = {}
    external: ClassVar[str] = ""
    stateful: ClassVar[bool] = False
    reads_own_output: ClassVar[tuple[str, ...]] = ()
    linear: ClassVar[bool] = False
    convolution: ClassVar[Convolution | None] = None
    scaled_by: ClassVar[str] = ""
    levels: ClassVar[Mapping[str, Mapping[str, str]]] = {}

    def __init_subclass__(cls, **options: Any) -> None:
        super().__init_subclass__(**options)
        for name in vars(cls):
            if hint := renamed.fix(f"dd.Element.{name}"):
                raise ModelError(f"{cls.__name__} sets {name!r}, which elements no longer have", fix=hint)

    def __rshift__(self, other: object) -> Any:
        raise ModelError(
            f"{self.name or type(self).__name__} stands in no model yet, so nothing can be connected to it",
            fix="Add it first: model.add(...); a chain begins with what was added: u >> dd.Gain(2) >> v",
        )

    # ------------------------------------------------------------------------------- on paper: axes and ports

    def ports(self) -> tuple[str, ...]:
        """Names of the input ports."""
        return self.inputs

    def input_axes(self, port: str, arriving: Axes | None) -> Axes | None:
        """Return the axes that an input port takes; None where the connection with most axes decides."""
        axes: Axes | None = getattr(self, "axes", None)
        return axes

    def outputs(self, ins: Mapping[str, Axes]) -> Mapping[str, Axes]:
        """Axes of every output port; the first is the default one.

        Elements that show only states ignore `ins`.
        """
        raise NotImplementedError

    def steady(self) -> bool:
        """Whether outputs of a stateless element stay the same while its inputs and parameters do."""
        return True

    def noise_axes(self) -> Axes | None:
        """Axes of the element's noise, or None where it has none now."""
        return None

    def external_code(self) -> str:
        """Return the name of external code that it runs and that `load` gives, or "". The code is not loaded
        before the document is trusted.
        """
        return ""

    def load(self) -> Any:
        """The code from outside; another one makes another program."""
        return None

    def validate_axes(self, ins: Mapping[str, Axes]) -> Iterator[str | tuple[str, str]]:
        """Check the parameters against the axes at the ports: yield what is wrong, or (what is wrong, what to
        type) where the remedy is not another connection.
        """
        return iter(())

    def warnings(self, ins: Mapping[str, Axes]) -> Iterator[tuple[str, str]]:
        """What is probably a mistake, although it runs: (what is wrong and why, what to type).

        Called only where nothing is a misfit.
        """
        return iter(())

    def bounds(
        self, ins: Mapping[str, Axes], inputs: Mapping[str, Interval], before: Mapping[str, Interval]
    ) -> Mapping[str, Interval]:
        """Between which values its ports lie, given the bounds of what arrives and what it returned `before`
        (empty at first).

        For checks: an output that is not named may have any value. A strength of 0 counts as one that is set
        later.
        """
        return {}

    def kernels(self) -> Sequence[Kernel]:
        """The kernels that `Setting.convolve` applies, summed."""
        return ()

    # -------------------------------------------------------------------------------------------- in pictures

    def polarity(self) -> Sign:
        """Sign with which the output acts on what reads it: pictures tell inhibition from excitation by
        it.
        """
        return "+"

    def recurrence(self) -> Mapping[str, Sign]:
        """Signs of the interactions of the element with itself, by name: pictures show them as loops."""
        return {}

    # -------------------------------------------------------------------------------- in the compiled program

    def init(self, at: Setting) -> Arrays:
        """The state at the start."""
        return {}

    def prepare(self, at: Setting) -> Any:
        """Constants that depend on axes and on parameters that rebuild."""
        return {}

    def hoist(self, at: Setting, constants: Any) -> Any:
        """Compute, once a chunk, what depends on live parameters but not on the state, from the constants of
        `prepare`.

        `output` and `advance` get what it returns in place of the constants.
        """
        return constants

    def output(
        self, at: Setting, state: Arrays, inputs: Arrays, constants: Any, time: Time, noise: Array | None
    ) -> Arrays:
        """Every output port at time t."""
        raise NotImplementedError

    def advance(
        self, at: Setting, state: Arrays, inputs: Arrays, constants: Any, time: Time, noise: Array | None
    ) -> Arrays:
        """The state at t + dt. `noise` holds standard normal deviates over `noise_axes`, or None."""
        return state

    def undefined(self) -> Sequence[str]:
        """Output ports that show NaN where they have no value yet. Only these may do so in a record."""
        return ()

    def inject(
        self, state: Mapping[str, np.ndarray], amount: np.ndarray | float, dt: float
    ) -> Mapping[str, np.ndarray] | None:
        """Return the state after a step as if its input had been larger by `amount` (over the axes); for
        external inputs to a running model.

        None where that is not a simple sum, or where there is no such input.
        """
        return None

    def learned_parameters(self, state: Mapping[str, Any]) -> Mapping[str, Any]:
        """Return the learned state as parameters with which `init` gives this state; empty where nothing is
        learned.
        """
        return {}

    @classmethod
    def example(cls) -> Self:
        """An instance that works on its own."""
        if "axes" in (f.name for f in dc.fields(cls)):
            return cls(name="example", axes=[Axis("x", 0, 20, samples=21)])  # type: ignore[call-arg]
        return cls(name="example")


@dc.dataclass(frozen=True)
class Coupling(Element):
    """An element between elements: its output follows its input in the same instant."""

    direct: ClassVar[Mapping[str, tuple[str, ...]]] = {"output": ("input",)}

    def input_axes(self, port: str, arriving: Axes | None) -> Axes | None:
        return arriving

    def outputs(self, ins: Mapping[str, Axes]) -> Mapping[str, Axes]:
        return {"output": ins["input"]}

    @classmethod
    def example(cls) -> Self:
        return cls(name="example")
