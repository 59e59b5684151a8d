"""The contract of elements and couplings, the parts of a model.

The methods of an element describe one copy of it: the compiler adds batches, trials, groups, rates and the
working precision. Inside the compiled program its live and rebuild parameters are tracers, so formulas may
use `self.tau` directly.

An element may rely on these rules:

* a step reads every output at time t, then commits all new states together;
* all connections into one port are summed, in the port's axes;
* `prepare` may use parameters that rebuild (and arrays), not live ones; `hoist` reads its result as
  `at.constants`, may use all parameters, and is computed once per chunk; `output` and `advance` read the
  result of `hoist` as `at.constants`.
"""

from __future__ import annotations

import dataclasses as dc
import functools
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, ClassVar, NoReturn, Self

import jax.numpy as jnp
import numpy as np
from jax import Array, lax
from jax.typing import DTypeLike

from deodar.errors import ModelError
from deodar.numerics.axes import Axes, Axis, shape
from deodar.numerics.exact import Exact, exact, split, wide
from deodar.numerics.intervals import Interval
from deodar.numerics.kernels._base import Kernel
from deodar.numerics.native import Kernels
from deodar.numerics.positions import PositionCode, PositionUnits
from deodar.numerics.scalar import Scalar
from deodar.numerics.signs import Sign, product, sign_of
from deodar.parameters import ArrayLike, FrozenArray, Part

Arrays = dict[str, Array]

PortAxes = Mapping[str, Axes]
"""The axes of ports, by their names."""

PortBounds = Mapping[str, Interval]
"""The smallest and the largest value at ports, by their names."""

PortUnits = Mapping[str, PositionUnits]
"""The units of the numbers at ports that are positions, by the names of the ports."""


@dc.dataclass(frozen=True)
class Time:
    """Document time inside a step, exact in both precisions.

    It is `origin + passed * step`, computed in float64 from the number of steps, so that it does not depend
    on the division of a run into chunks.

    Attributes:
        origin: document time at an earlier tick, or at the present one.
        passed: number of steps since then, an integer.
        step: step of the model.
        ticks: step of the element as a multiple of the model's step.
    """

    origin: Exact
    passed: Array | np.uint32
    step: Exact
    ticks: int = 1

    @classmethod
    def at(cls, now: float, dt: float, dtype: DTypeLike) -> Time:
        """Create a time from numbers of the host."""
        return cls(Exact(*split(now, dtype)), np.uint32(0), Exact(*split(dt, dtype)))

    @property
    def dt(self) -> Scalar:
        """The step of the element (at its own rate), in the working precision."""
        return self.step.high * self.ticks

    @property
    def wide(self) -> Array:
        """The time in float64; use it inside `exact()`."""
        return wide(self.origin) + jnp.asarray(self.passed).astype(jnp.float64) * wide(self.step)

    @property
    def wide_dt(self) -> Array:
        """The step of the element in float64; use it inside `exact()`."""
        return wide(self.step) * self.ticks

    @property
    def moment(self) -> Exact:
        """The time as two numbers of the working precision, for a state that stores the time of an event.

        In single precision, a state that counts steps or sums `dt` would stop changing.
        """
        dtype = self.step.high.dtype
        with exact():
            now, digits = self.wide, jnp.finfo(dtype)
            # the compiler would remove a cast there and back as redundant
            high = lax.reduce_precision(now, digits.nexp, digits.nmant)
            return Exact(high.astype(dtype), (now - high).astype(dtype))

    def since(self, moment: Exact | Array | float) -> Array:
        """Return the time since `moment` (negative before it), in the working precision.

        Near the moment it is exact to the last digit.
        """
        now = self.moment
        m = moment if isinstance(moment, Exact) else Exact(moment, 0.0)
        return (now.high - m.high) + (now.low - m.low)

    @property
    def now(self) -> Array:
        """The time in the working precision: 24 bits in float32, so use `since` to compare it with
        moments.
        """
        return self.since(0.0)


BEFORE = Time(Exact(np.nan, np.nan), np.uint32(0), Exact(np.nan, np.nan))
"""The time outside of a step, not a number: `prepare` and `init` do not depend on the time."""


@dc.dataclass(frozen=True)
class Convolution:
    """The declaration of the port that an element convolves with its `kernels`, and of the port that uses it.

    A class that overrides `output` or `advance` must repeat the declaration. `Setting.convolve` also works
    without it, but the compiler then does not rearrange sums around the class.

    Attributes:
        of: port that is convolved: an input, or the output that the dynamics read.
        into: an output that is equal to the integral, or an input to which `advance` adds the integral and
            that it does not use otherwise.
    """

    of: str
    into: str


def _undeclared(y: Array) -> NoReturn:
    raise ModelError(
        "an element calls `at.convolve` and declares no convolution, or calls it outside of `output` and"
        " `advance`",
        fix='Declare it in the class: convolution: ClassVar = dd.Convolution("output", into="input")',
    )


@dc.dataclass(frozen=True)
class Setting:
    """The context of an element: the axes of its ports, the precision of the model, and what a step reads.

    `init` and `prepare` use the axes and the precision alone, `hoist` the constants too.

    Attributes:
        ins, outs: axes of the ports.
        dtype: working precision.
        state: the state at time t.
        inputs: sums at the input ports.
        constants: in `hoist` the result of `prepare`, then the result of `hoist`.
        time: the time t.
        noise: standard normal deviates over `Element.noise_axes`, or None.
        convolve: function of an array over the axes of the port that `Element.convolution` declares: the
            integral of the kernels times it, over the same axes. In `output` and `advance` only.
        native: compiled functions for parts of the step, in `output` and `advance`; None where JAX computes
            all.
    """

    ins: PortAxes
    outs: PortAxes
    dtype: DTypeLike
    state: Arrays = dc.field(default_factory=dict[str, Array])
    inputs: Arrays = dc.field(default_factory=dict[str, Array])
    constants: Any = None
    time: Time = BEFORE
    noise: Array | None = None
    convolve: Callable[[Array], Array] = _undeclared
    native: Kernels | None = None

    def full(self, axes: Axes, value: Scalar) -> Array:
        """Return an array over the axes, filled with one value."""
        return jnp.full(shape(axes), value, self.dtype)

    def array(self, values: ArrayLike | Array) -> Array:
        """Return the values as an array in the working precision."""
        return jnp.asarray(values.data if isinstance(values, FrozenArray) else values, self.dtype)

    def exact(self, values: ArrayLike | Exact | float) -> Exact:
        """Return the values with the digits of float64."""
        if isinstance(values, Exact):
            return values
        return Exact(*split(values.data if isinstance(values, FrozenArray) else values, self.dtype))

    def points(self, axis: Axis) -> Array:
        """Return the values at the samples of an axis, in the working precision."""
        return jnp.asarray(axis.points, self.dtype)


@dc.dataclass(frozen=True)
class Element(Part):
    """The base class of the elements of a model.

    Class attributes:
        inputs: names of the input ports.
        optional: for an input port that exists only if a parameter is true, the name of the parameter.
        direct: for each output port that depends on inputs of the same step, the names of these inputs; other
            output ports depend on the state only.
        follows: for an input port that has the axes of another input port, the name of that port.
        bounded_inputs: input ports that use an output of a field as a number between 0 and 1, for example as
            a rate; they read the `bounded_port` of the source in place of the connected port.
        external: input without connections, with the axes of `output`; its value comes from outside the
            model: from the world for a `Sensor` and classes derived from it, else it is 0. "": none.
        stateful: whether the element has a state, as it has if it defines `advance`; if not, all outputs
            follow from inputs, time and noise.
        reads_own_output: output ports that `advance` receives among its inputs, with their values of the same
            step.
        linear: whether the default output is linear in the one input.
        jumps: whether the output changes in jumps while the input changes gradually; the studio then offers
            other couplings first.
        convolution: the port that it convolves with its `kernels`, and the port that uses the integral; None:
            no convolution.
        signed_by: parameters whose signs, multiplied, are the sign of the output's effect.
        scaled_by: the parameter that is the factor from `input` to `output`; "" if `output` is not a multiple
            of `input`.
        levels: for a port, the parameters that are levels on its scale, by their names in plots, which draw
            them as lines.
        maps: for an array parameter that is a map from a source to a target, the ports whose axes its
            dimensions have, in their order; plots draw it over these axes.
    """

    name: str = dc.field(default="", kw_only=True)

    inputs: ClassVar[tuple[str, ...]] = ("input",)
    optional: ClassVar[Mapping[str, str]] = {}
    direct: ClassVar[Mapping[str, tuple[str, ...]]] = {}
    follows: ClassVar[Mapping[str, str]] = {}
    bounded_inputs: ClassVar[tuple[str, ...]] = ()
    external: ClassVar[str] = ""
    stateful: ClassVar[bool] = False
    reads_own_output: ClassVar[tuple[str, ...]] = ()
    linear: ClassVar[bool] = False
    jumps: ClassVar[bool] = False
    convolution: ClassVar[Convolution | None] = None
    signed_by: ClassVar[tuple[str, ...]] = ()
    scaled_by: ClassVar[str] = ""
    levels: ClassVar[Mapping[str, Mapping[str, str]]] = {}
    maps: ClassVar[Mapping[str, tuple[str, ...]]] = {}

    def __init_subclass__(cls) -> None:
        super().__init_subclass__()
        if "advance" in vars(cls):
            cls.stateful = True

    def __rshift__(self, other: object) -> Any:
        raise ModelError(
            f"{self.name or type(self).__name__} has not been added to a model, so it cannot be connected",
            fix="Add it first: model.add(...); a chain begins with an added element: u >> dd.Gain(2) >> v",
        )

    # ------------------------------------------------------------------------------- on paper: axes and ports

    def ports(self) -> tuple[str, ...]:
        """Return the names of the input ports."""
        needs = self.optional
        return tuple(port for port in self.inputs if port not in needs or getattr(self, needs[port]))

    def input_axes(self, port: str, arriving: Axes | None) -> Axes | None:
        """Return the axes of an input port; None if those of the connection with the most axes are used."""
        axes: Axes | None = getattr(self, "axes", None)
        return axes

    def outputs(self, ins: PortAxes) -> PortAxes:
        """Return the axes of every output port; the first is the default port.

        By default the port is `output`, over the parameter `axes`, or else over the axes of `input`. Elements
        whose outputs are states ignore `ins`.
        """
        axes: Axes | None = getattr(self, "axes", None)
        return {"output": ins.get("input", ()) if axes is None else tuple(axes)}

    def steady(self) -> bool:
        """Return whether outputs of a stateless element are constant while its inputs and parameters are."""
        return True

    def noise_axes(self) -> Axes | None:
        """Return the axes of the element's noise, or None without noise."""
        return None

    def external_code(self) -> str:
        """Return the name of the external code that `load` imports, or "".

        The code is not loaded before the document is trusted.
        """
        return ""

    def load(self) -> Any:
        """Return the external code; different code compiles a different program."""
        return None

    def validate_axes(self, ins: PortAxes) -> Iterator[str | tuple[str, str]]:
        """Check the parameters against the axes of the ports.

        Yield the problem, or (problem, fix) if the fix is not another connection.
        """
        return iter(())

    def warnings(self, ins: PortAxes) -> Iterator[tuple[str, str]]:
        """Yield probable mistakes that do not prevent a run: (problem and reason, fix).

        Called only if `validate_axes` yields nothing.
        """
        return iter(())

    def bounds(self, ins: PortAxes, inputs: PortBounds, before: PortBounds) -> PortBounds:
        """Return the smallest and largest value of output ports, for checks.

        `inputs` are the bounds of the inputs, `before` is the previous result (empty at first). An output
        that is not in the result may have any value. A strength of 0 counts as not set yet.
        """
        return {}

    def jumps_at(self) -> Sequence[str]:
        """Return the names of the inputs, states and parameters at whose values an output or the new state
        jumps, so that it has no derivative in them; gradients through them are refused.

        Parameters that are moments or durations need no mention, nor do output functions that jump.
        """
        return ()

    def bounded_port(self, port: str) -> str:
        """Return the output port that `bounded_inputs` read in place of `port`.

        For a port whose values may leave the range of the element's sigmoid it is one whose values do not.
        """
        return port

    def kernels(self) -> Sequence[Kernel]:
        """Return the kernels that `Setting.convolve` applies, summed."""
        return ()

    # --------------------------------------------------------------------------------------------- in a world

    def sensor_name(self) -> str:
        """Return the name of the world's sensor that the element reads, or ""."""
        return ""

    def motor_name(self) -> str:
        """Return the name of the world's motor that the element's input drives, or ""."""
        return ""

    def position_units(self, ins: PortAxes, inputs: PortUnits) -> PortUnits:
        """Return the units of the numbers at output ports that are positions, for checks against a world.

        `inputs` holds the units at each input port, and under `external` those of the reading of a sensor:
        one for each sample, () if none is known. An output that is not in the result holds no positions.
        """
        return {}

    def position_codes(self, ins: PortAxes) -> Mapping[str, PositionCode]:
        """Return the input ports whose numbers are used as positions on axes, for checks against a world."""
        return {}

    # -------------------------------------------------------------------------------------------- in pictures

    def polarity(self) -> Sign:
        """Return the sign of the output's effect on its targets; pictures show inhibition and excitation
        by it.
        """
        signs: list[Sign] = [sign_of(getattr(self, name)) for name in self.signed_by]
        return functools.reduce(product, signs, "+")

    def recurrence(self) -> Mapping[str, Sign]:
        """Return the signs of the element's interactions with itself, by name; pictures show them as
        loops.
        """
        return {}

    # -------------------------------------------------------------------------------- in the compiled program

    def init(self, at: Setting) -> Arrays:
        """Return the state at the start."""
        return {}

    def prepare(self, at: Setting) -> Any:
        """Return constants that depend on axes and on parameters that rebuild."""
        return {}

    def hoist(self, at: Setting) -> Any:
        """Compute, once per chunk, values that depend on live parameters but not on the state.

        `at.constants` is the result of `prepare`; in `output` and `advance` it is the result of `hoist`.
        """
        return at.constants

    def state_axes(self, ins: PortAxes) -> Mapping[str, Sequence[Axis | int]]:
        """Return the dimensions of the states that do not have the axes of the first output.

        A running state is carried along them to other axes. A number `n` stands for `n` rows, which have
        no positions.
        """
        return {}

    def output(self, at: Setting) -> Arrays:
        """Return the value of every output port at time t."""
        raise NotImplementedError

    def advance(self, at: Setting) -> Arrays:
        """Return the state at t + dt."""
        return at.state

    def undefined(self) -> Sequence[str]:
        """Return the output ports that are NaN where they have no value yet; only these may be NaN in a
        record.
        """
        return ()

    def inject(
        self, state: Mapping[str, np.ndarray], amount: np.ndarray | float, dt: float
    ) -> Mapping[str, np.ndarray] | None:
        """Return the state after a step as if its input had been larger by `amount` (over the axes).

        Running models use it for external inputs. None if the effect is not a sum, or without such an input.
        """
        return None

    def learned_parameters(self, state: Mapping[str, np.ndarray]) -> Mapping[str, np.ndarray]:
        """Return the learned state as parameters from which `init` restores it; empty if nothing is
        learned.
        """
        return {}

    @classmethod
    def starting_values(cls, axes: Axes, arriving: Axes | None = None) -> Mapping[str, Any]:
        """Return the values, other than the defaults, with which an editor makes a new element.

        Args:
            axes: the axes of the new element.
            arriving: the axes of its input; None: unknown.
        """
        return {}

    @classmethod
    def example(cls) -> Self:
        """Return an instance that works without other elements."""
        if "axes" in (f.name for f in dc.fields(cls)):
            return cls(name="example", axes=[Axis("x", 0, 20, samples=21)])  # type: ignore[call-arg]
        return cls(name="example")


@dc.dataclass(frozen=True)
class Coupling(Element):
    """The base class of elements between elements, whose output depends on the input of the same step.

    The output of a coupling without a state depends on all inputs, unless it declares others.
    """

    direct: ClassVar[Mapping[str, tuple[str, ...]]] = {"output": ("input",)}

    def __init_subclass__(cls) -> None:
        super().__init_subclass__()
        if "inputs" in vars(cls) and "direct" not in vars(cls) and not cls.stateful:
            cls.direct = {"output": cls.inputs}

    def input_axes(self, port: str, arriving: Axes | None) -> Axes | None:
        return arriving

    @classmethod
    def example(cls) -> Self:
        return cls(name="example")
