"""Kinds that break a rule of their contract, each with what an error has to say of it."""

from __future__ import annotations

import dataclasses as dc
import math
import random
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, Any

import jax.numpy as jnp
import numpy as np

import deodar as dd

X = dd.Axis("x", 0, 20, samples=21)
DIRECT: Mapping[str, tuple[str, ...]] = {"output": ("input",)}


@dataclass(frozen=True)
class Asking(dd.Coupling):
    def output(self, at: dd.Setting) -> dd.Arrays:
        y = at.inputs["input"]
        if y.max() > 0:
            y = y + 1
        return {"output": y}


@dataclass(frozen=True)
class Numeric(dd.Coupling):
    def output(self, at: dd.Setting) -> dd.Arrays:
        return {"output": np.tanh(at.inputs["input"])}  # type: ignore[dict-item]


@dataclass(frozen=True)
class Mathematical(dd.Coupling):
    gain: Annotated[float, dd.Live()] = 2.0

    def output(self, at: dd.Setting) -> dd.Arrays:
        return {"output": math.exp(self.gain) * at.inputs["input"]}


@dataclass(frozen=True)
class InPlace(dd.Coupling):
    def output(self, at: dd.Setting) -> dd.Arrays:
        y = at.inputs["input"]
        y[0] = 0.0
        return {"output": y}


@dataclass(frozen=True)
class Narrow(dd.Coupling):
    def output(self, at: dd.Setting) -> dd.Arrays:
        return {"output": at.inputs["input"][:3]}


@dataclass(frozen=True)
class Imaginary(dd.Coupling):
    def output(self, at: dd.Setting) -> dd.Arrays:
        return {"output": at.inputs["input"] * 1j}


@dataclass(frozen=True)
class Misnamed(dd.Coupling):
    def output(self, at: dd.Setting) -> dd.Arrays:
        return {"out": at.inputs["input"]}


@dataclass(frozen=True)
class Bare(dd.Coupling):
    def output(self, at: dd.Setting) -> dd.Arrays:
        return at.inputs["input"]  # type: ignore[return-value]


@dataclass(frozen=True)
class Methodless(dd.Coupling):
    """A coupling without `output`."""


@dataclass(frozen=True)
class Misreading(dd.Coupling):
    def output(self, at: dd.Setting) -> dd.Arrays:
        return {"output": at.inputs["drive"]}


@dataclass(frozen=True)
class Raising(dd.Coupling):
    def output(self, at: dd.Setting) -> dd.Arrays:
        raise RuntimeError("no luck today\nand a second line")


TABLE = {"slow": 1.0}


@dataclass(frozen=True)
class Unlisted(dd.Coupling):
    def output(self, at: dd.Setting) -> dd.Arrays:
        return {"output": TABLE["fast"] * at.inputs["input"]}


@dataclass(frozen=True)
class OfTuple(dd.Coupling):
    def output(self, at: dd.Setting) -> dd.Arrays:
        shape = at.inputs["input"].shape
        shape[0] = 3  # type: ignore[index]
        return {"output": at.inputs["input"]}


@dataclass(frozen=True)
class Mentioning(dd.Coupling):
    def output(self, at: dd.Setting) -> dd.Arrays:
        raise ValueError("'NotHere' of mine")


@dataclass(frozen=True)
class Frozen(dd.Coupling):
    def output(self, at: dd.Setting) -> dd.Arrays:
        self.last = at.inputs["input"]  # type: ignore[misc]
        return {"output": at.inputs["input"]}


STORED: list[Any] = []


@dataclass(frozen=True)
class Leaking(dd.Coupling):
    def prepare(self, at: dd.Setting) -> Any:
        STORED.append(jnp.zeros(3) + 1)
        return {}

    def output(self, at: dd.Setting) -> dd.Arrays:
        return {"output": at.inputs["input"] + STORED[-1].sum()}


@dataclass(frozen=True)
class Early(dd.Coupling):
    gain: Annotated[float, dd.Live()] = 2.0

    def prepare(self, at: dd.Setting) -> Any:
        return jnp.exp(self.gain)

    def output(self, at: dd.Setting) -> dd.Arrays:
        return {"output": at.constants * at.inputs["input"]}


@dataclass(frozen=True)
class Undeclared(dd.Element):
    axes: Sequence[dd.Axis] = (X,)

    def output(self, at: dd.Setting) -> dd.Arrays:
        return {"output": at.inputs["input"]}


@dataclass(frozen=True)
class Growing(dd.Element):
    axes: Sequence[dd.Axis] = (X,)

    def init(self, at: dd.Setting) -> dd.Arrays:
        return {"z": at.full(tuple(self.axes), 0.0)}

    def output(self, at: dd.Setting) -> dd.Arrays:
        return {"output": at.state["z"]}

    def advance(self, at: dd.Setting) -> dd.Arrays:
        return {"z": at.state["z"].sum()}


@dataclass(frozen=True)
class Splitting(Growing):
    def advance(self, at: dd.Setting) -> dd.Arrays:
        return {"z": (at.state["z"], at.state["z"])}  # type: ignore[dict-item]


@dataclass(frozen=True)
class Worded(Growing):
    def init(self, at: dd.Setting) -> dd.Arrays:
        return {"z": [at.full(tuple(self.axes), 0.0), "fast"]}  # type: ignore[dict-item]


@dataclass(frozen=True)
class Forgetful(dd.Element):
    axes: Sequence[dd.Axis] = (X,)

    def output(self, at: dd.Setting) -> dd.Arrays:
        return {"output": at.state["z"]}

    def advance(self, at: dd.Setting) -> dd.Arrays:
        return {"z": at.state["z"]}


@dataclass(frozen=True)
class Throwing(dd.Coupling):
    def output(self, at: dd.Setting) -> dd.Arrays:
        return {"output": at.inputs["input"] * random.random()}


@dataclass(frozen=True)
class Ramp(dd.Kernel):
    amplitude: Annotated[float, dd.Live("activation")] = 1.0
    width: Annotated[float, dd.Rebuild("axis", lower=1e-6)] = 3.0

    def terms(self) -> Sequence[dd.Term]:
        def along(d: int, lag: Any, period: float | None, step: float) -> Any:
            if abs(lag).max() > self.width:
                return jnp.zeros_like(lag)
            return lag

        return (dd.Term(self.amplitude, along),)


@dataclass(frozen=True)
class LiveWidth(dd.Kernel):
    amplitude: Annotated[float, dd.Live("activation")] = 1.0
    width: Annotated[float, dd.Live("axis", lower=1e-6)] = 3.0

    def terms(self) -> Sequence[dd.Term]:
        def along(d: int, lag: Any, period: float | None, step: float) -> Any:
            return jnp.exp(-abs(lag) / self.width)

        return (dd.Term(2 * self.amplitude, along),)


@dataclass(frozen=True)
class Short(dd.Kernel):
    amplitude: Annotated[float, dd.Live("activation")] = 1.0

    def terms(self) -> Sequence[dd.Term]:
        return (dd.Term(self.amplitude, lambda d, lag, period, step: lag[:2]),)


@dataclass(frozen=True)
class Termless(dd.Kernel):
    """A kernel without `terms`."""


@dataclass(frozen=True)
class Uncentred(dd.Kernel):
    """A kernel whose array has no middle sample."""

    def samples(self, axes: dd.Axes, dtype: Any) -> Any:
        return jnp.ones([4] * len(axes), dtype)


@dataclass(frozen=True)
class Flat(dd.Kernel):
    """A kernel whose array has too few axes."""

    def samples(self, axes: dd.Axes, dtype: Any) -> Any:
        return jnp.ones((), dtype)


@dataclass(frozen=True)
class Undecided(dd.Kernel):
    """A kernel that has neither an array nor terms."""

    def samples(self, axes: dd.Axes, dtype: Any) -> Any:
        return None


@dataclass(frozen=True)
class Cutting(dd.SigmoidFunction):
    def __call__(self, u: Any) -> Any:
        return u[:3]


@dataclass(frozen=True)
class Branching(dd.SigmoidFunction):
    threshold: Annotated[float, dd.Live("activation")] = 0.0

    def __call__(self, u: Any) -> Any:
        return u if u.mean() > self.threshold else 0 * u


@dataclass(frozen=True)
class Uncallable(dd.SigmoidFunction):
    """A sigmoid without `__call__`."""


ASKS = "asks whether a value is true or greater; values are traced there. Use jnp.where"

WRONG: dict[type[Any], tuple[str, ...]] = {
    Asking: ("Asking.output in wrong_kinds.py, line", ASKS),
    Numeric: ("Numeric.output in wrong_kinds.py, line", "gives a value to NumPy", "jax.numpy"),
    Mathematical: ("Mathematical.output in wrong_kinds.py", "asks for the number of a value", "jax.numpy"),
    InPlace: ("InPlace.output in wrong_kinds.py", "assigns to samples of an array", ".at[index].set("),
    Narrow: ("Narrow.output in wrong_kinds.py", "[3] in place of [21]", "output port 'output'"),
    Imaginary: ("Imaginary.output in wrong_kinds.py", "complex64 numbers in place of real ones"),
    Misnamed: ("Misnamed.output in wrong_kinds.py", "returns 'out', which is no output port", "'output'"),
    Bare: ("Bare.output in wrong_kinds.py", "returns an array, not a dict of arrays"),
    Methodless: ("Methodless in wrong_kinds.py, line", "has no method output", "def output(self, ...)"),
    Misreading: ("Misreading.output in wrong_kinds.py", "reads 'drive', which does not exist", "input; its"),
    Raising: ("Raising.output in wrong_kinds.py", "raised RuntimeError: no luck today"),
    Unlisted: ("Unlisted.output in wrong_kinds.py", "raised KeyError: 'fast'"),
    OfTuple: ("OfTuple.output in wrong_kinds.py", "raised TypeError: 'tuple' object does not support"),
    Mentioning: ("Mentioning.output in wrong_kinds.py", "raised ValueError: 'NotHere' of mine"),
    Frozen: ("Frozen.output in wrong_kinds.py", "assigns to an attribute", "Keep what changes in the state"),
    Leaking: ("Leaking in wrong_kinds.py", "that an earlier call has stored", "`init`"),
    Early: ("Early.prepare in wrong_kinds.py", "uses the live parameter gain", "`hoist`"),
    Undeclared: ("Undeclared.output in wrong_kinds.py", "does not declare for `output`", "direct: ClassVar"),
    Growing: ("Growing.advance in wrong_kinds.py", "[] in place of [21]", "state 'z'"),
    Splitting: ("Splitting.advance in wrong_kinds.py", "PyTreeDef((*, *)) in place of PyTreeDef(*)", "'z'"),
    Worded: ("Worded.init in wrong_kinds.py", "'fast' in place of an array for the state 'z'"),
    Forgetful: ("Forgetful.output in wrong_kinds.py", "reads 'z', which does not exist", "its state: none"),
    Ramp: ("Ramp.terms.along in wrong_kinds.py", ASKS),
    LiveWidth: ("LiveWidth.terms.along in wrong_kinds.py", "live parameter kernel.0.width", "dd.Rebuild"),
    Short: ("Short.terms in wrong_kinds.py", "an array of shape [2"),
    Termless: ("Termless in wrong_kinds.py, line", "has no method terms"),
    Uncentred: ("Uncentred.samples in wrong_kinds.py", "shape [4] for 1 axis", "an odd number of samples"),
    Flat: ("Flat.samples in wrong_kinds.py", "shape [] for 1 axis", "an odd number of samples"),
    Undecided: ("Undecided.samples in wrong_kinds.py", "returns None in place of an array", "an odd number"),
    Cutting: ("Cutting.__call__ in wrong_kinds.py", "[3] in place of [21]"),
    Branching: ("Branching.__call__ in wrong_kinds.py", ASKS),
    Uncallable: ("Uncallable in wrong_kinds.py, line", "has no method __call__"),
}
"""For each class what the message of a run and of `check` says."""


def model_of(kind: type[Any]) -> dd.Model:
    """Return a model with an element `wrong` of a kind, or with a field of it."""
    model = dd.Model("wrong")
    part: Any = kind()
    if isinstance(part, dd.Kernel):
        part = dd.Field("wrong", [X], kernel=[part])
    elif isinstance(part, dd.SigmoidFunction):
        part = dd.Field("wrong", [X], sigmoid=part)
    model.add(dd.GaussianStimulus("s", [X], center=10, amplitude=2)) >> model.add(
        dc.replace(part, name="wrong")
    )
    return model
