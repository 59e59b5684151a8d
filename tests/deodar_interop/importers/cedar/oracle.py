"""How cedar runs an architecture file, step by step in plain NumPy (float64, noise off).

Written from a description of the semantics and from measurements; it uses nothing of deodar.

Arrays have the shape of cedar's matrices: (1, 1) for 0-D, (n, 1) for 1-D, else one axis for each dimension.
One function computes one type of step: `f(p, x, s, clock)` gets the parameters, the inputs by slot (a list
for a slot that takes any number of connections), the memory of the step and the clock, and returns the
outputs by slot. `Invalid` says that inputs or parameters do not fit: such a step never runs, nor does a step
that reads it.

Where cedar is known to be wrong (cyclic 2-D borders, one loop of a projection, trilinear resizing) the
correct result is computed; a matrix minus a single number, with which cedar fails, is `Invalid`.

Not covered: loops made only of steps whose sizes follow from their inputs (an integrator that reads itself
through a gain); such steps count as invalid.
"""

from __future__ import annotations

import copy
import json
import math
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np

DROPPED = 4294967295

OLD_TYPES = {
    "cedar.processing.source.BoxInput": "cedar.processing.sources.BoxInput",
    "cedar.processing.source.ConstMatrix": "cedar.processing.sources.ConstMatrix",
    "cedar.processing.source.GaussInput": "cedar.processing.sources.GaussInput",
    "cedar.processing.Sigmoid": "cedar.processing.TransferFunction",
    "cedar.processing.steps.CountLarger": "cedar.processing.steps.Count",
    "cedar.aux.math.LinearSigmoid": "cedar.aux.math.LinearTransferFunction",
    "cedar.aux.math.SemiLinearSigmoid": "cedar.aux.math.SemiLinearTransferFunction",
}


class Invalid(Exception):
    """Inputs or parameters do not fit: the step never runs."""


class Stopped(Exception):
    """The step fails when it computes: it stops, with its outputs as they are."""


@dataclass
class Clock:
    """The length of an iteration and the time, both in ms."""

    dt: float
    now: float = 0.0


# ---------------------------------------------------------------------------------- reading files


class Par:
    """Parameters of an element: pairs of a key and a text, a list of texts, or further pairs."""

    def __init__(self, pairs: Any):
        self.pairs = pairs if isinstance(pairs, list) else []

    def get(self, key, default=None):
        for k, value in self.pairs:
            if k == key:
                return value
        return default

    def word(self, key, default=""):
        return str(self.get(key, default))

    def flag(self, key, default):
        return str(self.get(key, default)).lower() in ("true", "1")

    def number(self, key, default):
        return float(self.get(key, default))

    def time(self, key, default):
        """Return a time in ms; a bare number is in ms."""
        parts = str(self.get(key, default)).split()
        unit = parts[1] if len(parts) > 1 else "ms"
        return float(parts[0]) * {"ms": 1.0, "s": 1000.0, "min": 60000.0, "h": 3600000.0}[unit]

    def numbers(self, key, default, n):
        """Return n numbers; the last one given is repeated when there are fewer."""
        given = self.get(key)
        values = [float(v) for v in given] if isinstance(given, list) else [float(given)] if given else []
        values = values or [float(default)]
        return (values + [values[-1]] * n)[:n]

    def flags(self, key, default, n):
        given = self.get(key)
        values = [str(v).lower() in ("true", "1") for v in given] if isinstance(given, list) else []
        return (values + [default] * n)[:n]

    def inner(self, key):
        return Par(self.get(key))

    def listed(self, key):
        """Return the objects of a list: (type id, parameters)."""
        return [(kind, Par(value)) for kind, value in Par(self.get(key)).pairs]


def parsed(path_or_dict_text):
    """Return the pairs of the top level of a file, which is given by its path or as its text."""
    text = str(path_or_dict_text)
    if not text.lstrip("\ufeff \t\r\n").startswith("{"):
        text = Path(text).read_text(encoding="utf-8", errors="replace")
    return json.loads(
        text.lstrip("\ufeff"),
        object_pairs_hook=list,
        strict=False,
        parse_int=str,
        parse_float=str,
        parse_constant=str,
    )


@dataclass
class Step:
    """A step with what it reads, what it has put out and whether it can run."""

    name: str
    type: str
    p: Par
    inputs: dict[str, list[tuple[str, str]]] = field(default_factory=dict)
    out: dict[str, np.ndarray] = field(default_factory=dict)
    state: dict[str, Any] = field(default_factory=dict)
    valid: bool = True

    @property
    def kind(self):
        return KINDS[self.type]

    def outputs(self):
        """Return the slots that can be connected."""
        hidden = set(self.kind.buffers)
        if self.p.flag("activation as output", "false"):
            hidden.discard("activation")
        return [slot for slot in self.out if slot not in hidden]

    def sources(self):
        return [name for wires in self.inputs.values() for name, _ in wires]


class Architecture:
    """The steps of a file, with groups flattened, and the order in which they run.

    `skipped` lists the connections whose ends do not exist; cedar reports and skips them too.
    """

    def __init__(self, path_or_dict_text):
        root = Par(parsed(path_or_dict_text))
        self.steps: dict[str, Step] = {}
        self.connectors: dict[str, str] = {}
        self.members: dict[str, list[str]] = {}
        self.wires: list[tuple[str, str, str, str]] = []
        self.skipped: list[str] = []
        self.read_group(root, "")
        self.connect()
        self.order = self.listeners(root)

    def read_group(self, group, prefix):
        """Collect steps, connectors and connections; the looped steps of a group in the order of the file."""
        looped = []
        for name, _ in Par(group.get("connectors")).pairs:
            self.connectors[prefix + name] = ""
        for type_id, pairs in Par(group.get("steps")).pairs:
            p, type_id = Par(pairs), OLD_TYPES.get(type_id, type_id)
            if type_id not in KINDS:
                raise ValueError(f"no reference for steps of type {type_id}")
            name = prefix + p.word("name")
            self.steps[name] = Step(name, type_id, p)
            if KINDS[type_id].looped:
                looped.append(name)
        inner = Par(group.get("groups") or group.get("networks"))
        for name, pairs in inner.pairs:
            path = f"{prefix}{name}."
            self.read_group(Par(pairs), path)
            looped += self.members[path]
        self.members[prefix] = looped
        for wire in group.get("connections") or []:
            ends = Par(wire)
            (a, a_slot), (b, b_slot) = (ends.word(key).split(".", 1) for key in ("source", "target"))
            self.wires.append((*self.end(prefix, a, a_slot), *self.end(prefix, b, b_slot)))

    def end(self, prefix, element, slot):
        """Return the step or connector that an end of a connection means, with the slot."""
        if f"{prefix}{element}." in self.members:
            return f"{prefix}{element}.{slot}", ""
        return prefix + element, slot

    def connect(self):
        """Resolve connectors, so that steps read steps."""
        feeds = {b: (a, slot) for a, slot, b, _ in self.wires if b in self.connectors}
        for a, a_slot, b, b_slot in self.wires:
            if b in self.connectors:
                continue
            source, slot = a, a_slot
            while source in self.connectors and source in feeds:
                source, slot = feeds[source]
            reader = self.steps.get(b)
            if source in self.connectors:
                continue  # a connector that nothing feeds
            if source not in self.steps or reader is None or not reader.kind.takes(b_slot):
                self.skipped.append(f"{a}.{a_slot} -> {b}.{b_slot}")
                continue
            wires = reader.inputs.setdefault(b_slot, [])
            if b_slot in reader.kind.many or not wires:
                wires.append((source, slot))
            else:
                self.skipped.append(f"{a}.{a_slot} -> {b}.{b_slot}")

    def listeners(self, root):
        """Return the looped steps in effective order.

        All are first attached to the default thread (steps, then groups, in the order of the file); each name
        in the list of a trigger is then moved to the end of that trigger. Triggers run in the order of the
        file, after the default thread if that is not in the file.
        """
        top = [name for name in self.members[""] if name in self.own_names(root)]
        top += [name for name, _ in Par(root.get("groups") or root.get("networks")).pairs]
        triggers: dict[str, list[str]] = {}
        given = [(p.word("name"), p.get("listeners") or []) for _, p in root.listed("triggers")]
        given = [("default thread" if n == "default trigger" else n, names) for n, names in given]
        if "default thread" not in dict(given):
            given.insert(0, ("default thread", []))
        for name, _ in given:
            triggers[name] = []
        triggers["default thread"] += top
        for name, names in given:
            for listener in names:
                if listener in top:
                    for listed in triggers.values():
                        if listener in listed:
                            listed.remove(listener)
                    triggers[name].append(listener)
        order = []
        for listed in triggers.values():
            for name in listed:
                order += self.members.get(f"{name}.", [name])
        return order

    def own_names(self, group):
        return {Par(pairs).word("name") for _, pairs in Par(group.get("steps")).pairs}


# ------------------------------------------------------------------------------ the run of a file


def run(path_or_dict_text, steps, dt, at=None):
    """Return the values of each slot after the iterations 0..steps (or only after those in `at`).

    Args:
        path_or_dict_text: the path of an architecture file, or its text
        steps: the number of iterations
        dt: the length of an iteration, in ms
        at: the iterations to keep, in ascending order; all if None

    Returns:
        Arrays of shape (kept iterations, *shape of the matrix) by "step.slot", also for buffers of fields.
    """
    kept = list(range(steps + 1)) if at is None else list(at)
    a, clock = Architecture(path_or_dict_text), Clock(float(dt))
    rows: dict[str, list[np.ndarray]] = {}
    with np.errstate(all="ignore"):
        load(a, clock)
        for n in range(steps + 1):
            if n:
                clock.now = n * clock.dt
                iterate(a, clock)
            if n in kept:
                for step in a.steps.values():
                    for slot, value in step.out.items():
                        rows.setdefault(f"{step.name}.{slot}", []).append(value.copy())
    return {key: np.stack(values) for key, values in rows.items()}


def values_of(a, step):
    """Return the present inputs of a step by slot."""
    x = {}
    for slot, wires in step.inputs.items():
        values = [a.steps[name].out[source] for name, source in wires]
        x[slot] = values if slot in step.kind.many else values[0]
    return x


def compute(a, step, clock):
    """Compute a step; return False if it fails."""
    if step.state.get("stopped"):
        return False
    try:
        step.out.update(step.kind.f(step.p, values_of(a, step), step.state, clock))
    except Stopped:
        step.state["stopped"] = True
        return False
    return True


def load(a, clock):
    """Give all outputs their first values, and find out which steps can run."""
    settle(a, clock)
    spread_invalid(a)
    fed = set()
    for step in in_order_of_reading(a):
        if step.kind.looped or not step.valid:
            continue
        if not step.sources() or any(name in fed for name in step.sources()):
            compute(a, step, clock)
            fed.add(step.name)


def settle(a, clock):
    """Find the shapes of all outputs; a step is invalid if that is not possible."""
    settled = set()
    for step in a.steps.values():
        if step.kind.begin is not None:
            step.out = step.kind.begin(step.p, step.state)
            settled.add(step.name)
    more = True
    while more:
        more = False
        for step in a.steps.values():
            if step.name not in settled and all(name in settled for name in step.sources()):
                more = True
                settled.add(step.name)
                tried = attempt(a, step, clock)
                if tried is not None:
                    step.out = {slot: np.zeros_like(value) for slot, value in tried.items()}
    for step in a.steps.values():
        step.valid = step.valid and step.name in settled
    for step in a.steps.values():
        if step.kind.begin is not None:
            attempt(a, step, clock)


def attempt(a, step, clock):
    """Compute a step without consequences: return its outputs, or None (and mark it) if it is invalid."""
    for slot, wires in step.inputs.items():
        for wire in list(wires):
            source = a.steps[wire[0]]
            if source.valid and wire[1] not in source.outputs():
                a.skipped.append(f"{wire[0]}.{wire[1]} -> {step.name}.{slot}")
                wires.remove(wire)
    step.inputs = {slot: wires for slot, wires in step.inputs.items() if wires}
    try:
        if any(slot not in step.inputs for slot in step.kind.needs):
            raise Invalid
        if not all(a.steps[name].valid for name in step.sources()):
            raise Invalid
        return step.kind.f(step.p, values_of(a, step), copy.deepcopy(step.state), clock)
    except Invalid:
        step.valid = False
    except Stopped:  # this happens when it computes; the step has its sizes and can be read
        if step.kind.begin is not None:
            return None
        given = values_of(a, step)["matrix"]
        return {"result": np.zeros_like(given[0] if isinstance(given, list) else given)}
    return None


def spread_invalid(a):
    """Mark the readers of steps that cannot run, and their readers."""
    more = True
    while more:
        more = False
        for step in a.steps.values():
            if step.valid and not all(a.steps[name].valid for name in step.sources()):
                step.valid, more = False, True


def in_order_of_reading(a):
    """Return steps so that what a step reads is before it; looped steps are first."""
    done = {step.name for step in a.steps.values() if step.kind.looped}
    ordered = [step for step in a.steps.values() if step.kind.looped]
    more = True
    while more:
        more = False
        for step in a.steps.values():
            if step.name not in done and all(name in done for name in step.sources()):
                ordered.append(step)
                done.add(step.name)
                more = True
    return ordered


def iterate(a, clock):
    """Run every looped step and, right after it, the other steps that it feeds."""
    done: set[str] = set()
    for name in a.order:
        step = a.steps[name]
        if not step.valid or not compute(a, step, clock):
            continue
        for reader in chain(a, name):
            if reader not in done and a.steps[reader].valid:
                done.add(reader)
                compute(a, a.steps[reader], clock)


def chain(a, name):
    """Return the steps that are not looped and that a step feeds, sorted by the longest path from it."""
    longest: dict[str, int] = {}
    front = [name]
    for length in range(1, len(a.steps) + 1):
        front = [
            step.name
            for step in a.steps.values()
            if not step.kind.looped and any(source in front for source in step.sources())
        ]
        for reader in front:
            longest[reader] = length
    return sorted(longest, key=lambda reader: longest[reader])


# --------------------------------------------------------------------------------- types of steps


@dataclass
class Kind:
    """How a type of step computes, and the slots it reads."""

    f: Callable[..., dict[str, np.ndarray]]
    needs: tuple[str, ...] = ()
    may: tuple[str, ...] = ()
    many: tuple[str, ...] = ()
    looped: bool = False
    begin: Callable[..., dict[str, np.ndarray]] | None = None
    counted: str | None = None  # slots that are numbered, with this before the number
    buffers: tuple[str, ...] = ()

    def takes(self, slot):
        if self.counted is not None and slot.startswith(self.counted):
            return slot[len(self.counted) :].isdigit()
        return slot in self.needs or slot in self.may or slot in self.many


KINDS: dict[str, Kind] = {}


def steps_of(type_id, needs=(), may=(), many=(), looped=False, begin=None, counted=None, buffers=()):
    """Register the function of a type of step."""

    def register(f):
        KINDS[type_id] = Kind(
            f, tuple(needs), tuple(may), tuple(many), looped, begin, counted, tuple(buffers)
        )
        return f

    return register


def scalar(value):
    return np.full((1, 1), float(value))


def is_0d(x):
    return x.size == 1


def vector(values):
    return np.asarray(values, float).reshape(-1, 1)


def number_of_dimensions(x):
    return 0 if x.size == 1 else 1 if x.ndim == 2 and 1 in x.shape else x.ndim


def shape_of(sizes):
    """Return the shape of the matrix with the sizes of a field."""
    sizes = [int(n) for n in sizes]
    return (1, 1) if not sizes else (sizes[0], 1) if len(sizes) == 1 else tuple(sizes)


def by_dimension(x):
    """Return an array with one axis for each dimension."""
    d = number_of_dimensions(x)
    return x.reshape(()) if d == 0 else x.reshape(-1) if d == 1 else x


def as_matrix(y):
    """Return the matrix of an array with one axis for each dimension."""
    return y.reshape(1, 1) if y.ndim == 0 else y.reshape(-1, 1) if y.ndim == 1 else y


def sizes_of(p, key="sizes", dimensions=None, default=50):
    d = int(p.number("dimensionality", 2)) if dimensions is None else dimensions
    return [int(n) for n in p.numbers(key, default, d)]


def only_value(x):
    """Return the number in a 0-D input."""
    if not is_0d(x):
        raise Invalid("a single number is read here")
    return float(x.reshape(-1)[0])


def fitted(x, shape):
    """Return an input that has a shape, or one number for all cells; a row counts as a column."""
    if is_0d(x):
        return np.full(shape, x.reshape(-1)[0])
    if x.shape == shape:
        return x
    if x.size == np.prod(shape) and x.ndim == 2 and 1 in x.shape and 1 in shape:
        return x.reshape(shape)
    raise Invalid("sizes differ")


def same_sizes(terms):
    """Return inputs of equal sizes; those that are one number are widened."""
    large = [x for x in terms if not is_0d(x)]
    shape = large[0].shape if large else (1, 1)
    return [fitted(x, shape) for x in terms]


# ----------------------------------------------------------------- transfer functions and kernels


def transfer(p, key, default_type="cedar.aux.math.AbsSigmoid", threshold=0.0, beta=100.0):
    """Return the function that an object with a type describes."""
    o = p.inner(key)
    type_id = o.word("type", default_type)
    type_id = OLD_TYPES.get(type_id, type_id).rsplit(".", 1)[-1]
    theta = o.number("threshold", threshold)
    if type_id == "AbsSigmoid":
        b = o.number("beta", beta)
        return lambda x: 0.5 * (1 + b * (x - theta) / (1 + b * np.abs(x - theta)))
    if type_id == "ExpSigmoid":
        b = o.number("beta", beta)
        return lambda x: 1 / (1 + np.exp(-b * (x - theta)))
    if type_id == "HeavisideSigmoid":
        return lambda x: np.where(x > theta, 1.0, 0.0)
    if type_id == "LinearTransferFunction":
        factor, offset = o.number("factor", 1), o.number("offset", 0)
        return lambda x: factor * x + offset
    if type_id == "SemiLinearTransferFunction":
        b = o.number("beta", 1)
        return lambda x: np.where(x >= theta, theta + b * x, theta)
    if type_id == "Logarithm":
        return np.log
    raise ValueError(f"no reference for {type_id}")


def gauss_part(sigma, limit, shift):
    """Return one dimension of a Gauss kernel, with its odd width cut at `limit` times sigma."""
    width = math.ceil(limit * sigma)
    width = width if width % 2 else width + 1
    centre = width // 2 + int(shift)
    return np.array([math.exp(-((i - centre) ** 2) / (2 * sigma**2)) for i in range(width)])


def kernel_parts(type_id, p, d):
    """Return a kernel as one profile for each dimension, with its anchor."""
    anchor = [int(v) for v in p.numbers("anchor", 0, d)]
    if type_id.endswith(".Gauss"):
        sigmas, shifts = p.numbers("sigmas", 3, d), p.numbers("shifts", 0, d)
        parts = [gauss_part(s, p.number("limit", 5), shift) for s, shift in zip(sigmas, shifts, strict=True)]
        if p.flag("normalize", "true"):
            parts = [part / part.sum() for part in parts]
    elif type_id.endswith(".Box"):
        parts = [np.ones(int(w)) for w in p.numbers("widths", 5, d)]
    else:
        raise ValueError(f"no reference for {type_id}")
    parts[0] = parts[0] * p.number("amplitude", 1)
    return parts, anchor


def beyond(y, axis, before, after, border):
    """Return an array extended beyond its ends, by a rule for the border."""
    n = y.shape[axis]
    i = np.arange(-before, n + after)
    if border == "Cyclic":
        return np.take(y, i % n, axis)
    if border == "Replicate":
        return np.take(y, np.clip(i, 0, n - 1), axis)
    if border == "Reflect":  # the last cell is repeated
        m = i % (2 * n)
        return np.take(y, np.where(m < n, m, 2 * n - 1 - m), axis)
    if border == "Zero":
        return np.pad(y, [(before, after) if k == axis else (0, 0) for k in range(y.ndim)])
    raise ValueError(f"no reference for the border {border}")


def filtered(y, profile, axis, centre, border):
    """Return y[i] = sum of profile[j] * y[i - (j - centre)] along one axis."""
    n, width = y.shape[axis], len(profile)
    before, after = max(0, width - 1 - centre), max(0, centre)
    long = beyond(y, axis, before, after, border)
    result = np.zeros_like(y)
    for j in range(width):
        start = before + centre - j
        result += profile[j] * long[(slice(None),) * axis + (slice(start, start + n),)]
    return result


def engine_of(convolution, d):
    """Return whether FFTW convolves, and the border that counts."""
    fftw = d >= 3 or convolution.inner("engine").word("type", "cedar.aux.conv.OpenCV").endswith("FFTW")
    return fftw, "Cyclic" if fftw else convolution.word("borderType", "Zero")


def centre_of(width, fftw, alternate=False):
    """Return the index in a kernel that lies on the cell; engines differ for even widths."""
    return width // 2 if width % 2 or fftw or alternate else width // 2 - 1


def convolved(x, kernels, convolution):
    """Return the sum of the convolutions of a matrix with each kernel of a list."""
    d = number_of_dimensions(x)
    y = by_dimension(x) if d else x.reshape(1)
    fftw, border = engine_of(convolution, d)
    result = np.zeros_like(y)
    for type_id, p in kernels:
        parts, anchor = kernel_parts(type_id, p, y.ndim)
        if fftw and any(anchor):
            raise ValueError("no reference for an anchor with FFTW")
        if fftw and d and any(len(part) > n for part, n in zip(parts, y.shape, strict=True)):
            raise Stopped("a kernel is larger than the field")
        term = y
        for axis, part in enumerate(parts):
            term = filtered(term, part, axis, centre_of(len(part), fftw) - anchor[axis], border)
        result = result + term
    return result.reshape(x.shape)


def convolved_with_matrix(x, kernel, convolution):
    """Return the convolution of a matrix with a kernel that is itself an input."""
    y, k = by_dimension(x), by_dimension(kernel)
    if is_0d(kernel):
        return x * kernel.reshape(-1)[0]
    if y.ndim != k.ndim:
        raise Invalid("kernel and matrix have different numbers of dimensions")
    fftw, border = engine_of(convolution, y.ndim)
    if fftw and any(m > n for m, n in zip(k.shape, y.shape, strict=True)):
        raise Stopped("the kernel is larger than the matrix")
    alternate = convolution.flag("alternate even kernel center", "false")
    centre = [centre_of(m, fftw, alternate) for m in k.shape]
    long = y
    for axis, (m, c) in enumerate(zip(k.shape, centre, strict=True)):
        long = beyond(long, axis, m - 1 - c, c, border)
    result = np.zeros_like(y)
    for index in product(*[range(m) for m in k.shape]):
        starts = [m - 1 - j for m, j in zip(k.shape, index, strict=True)]
        part = long[tuple(slice(i, i + n) for i, n in zip(starts, y.shape, strict=True))]
        result += k[index] * part
    return as_matrix(result)


# ------------------------------------------------------------------------------- fields, dynamics


def field_shape(p):
    d = int(p.number("dimensionality", 2))
    return shape_of(sizes_of(p, dimensions=d))


def begin_field(p, s):
    shape = field_shape(p)
    s["u"] = np.full(shape, p.number("resting level", -5))
    return {
        "sigmoided activation": np.zeros(shape),
        "activation": s["u"],
        "input sum": np.zeros(shape),
        "lateral interaction": np.zeros(shape),
    }


@steps_of(
    "cedar.dynamics.NeuralField",
    many=["input"],
    looped=True,
    begin=begin_field,
    buffers=["activation", "input sum", "lateral interaction"],  # the first may be an output
)
def neural_field(p, x, s, clock):
    u = s["u"]
    output = transfer(p, "sigmoid")(u)
    default = [("cedar.aux.kernel.Gauss", Par([]))]
    kernels = default if p.get("lateral kernels") is None else p.listed("lateral kernels")
    total = sum((fitted(term, u.shape) for term in x.get("input", [])), np.zeros(u.shape))
    lateral = convolved(output, kernels, p.inner("lateral kernel convolution"))
    change = -u + p.number("resting level", -5) + lateral + total
    change = change + p.number("global inhibition", -0.01) * output.sum()
    s["u"] = u + clock.dt / p.time("time scale", 100) * change
    return {
        "sigmoided activation": output,
        "activation": s["u"],
        "input sum": total,
        "lateral interaction": lateral,
    }


def begin_preshape(p, s):
    s["p"] = np.zeros(field_shape(p))
    return {"activation": s["p"]}


@steps_of(
    "cedar.dynamics.Preshape", needs=["input"], may=["peak detector"], looped=True, begin=begin_preshape
)
def preshape(p, x, s, clock):
    given, memory = fitted(x["input"], s["p"].shape), s["p"]
    gate = transfer(p, "sigmoid", threshold=0.5, beta=1000)(given)
    factor = only_value(x["peak detector"]) if "peak detector" in x else 1.0
    build = clock.dt / p.time("time scale build up", 100) * (given - memory) * gate
    decay = clock.dt / p.time("time scale decay", 1000) * memory * (1 - gate)
    s["p"] = memory + factor * (build - decay)
    return {"activation": s["p"]}


def weight_sizes(p):
    source = sizes_of(p, "source sizes", int(p.number("source dimension", 1)))
    target = sizes_of(p, "target sizes", int(p.number("target dimension", 2)))
    return source, target


def begin_hebbian(p, s):
    """Start with the weights; random ones have no reference."""
    source, target = weight_sizes(p)
    sizes = source + target
    if p.flag("manual weights", "false"):
        centers, sigmas = (p.numbers(key, 3, len(sizes)) for key in ("weight centers", "weight sigmas"))
        w = bell(sizes, centers, sigmas, p.number("weight amplitude", 6), cyclic=True)
    else:
        level, noise = p.number("weight init value", 0), p.number("weight init noise", 0.001)
        if noise not in (0.0, level):
            raise ValueError("no reference for random weights")
        w = np.full(shape_of(sizes), level)
    s.update(w=w, elapsed=None, before=0.0)
    empty = shape_of(target)
    return {"learned output": np.zeros(empty), "weights": w}


def learning_factor(p, h, dt):
    """Return the factor of a change of weights that time scales give."""
    rise, fall = p.time("time scale", 0), p.time("time scale decay", 0)
    if rise > 0 and fall > 0:
        return dt / rise * h + dt / fall * (1 - h)
    return dt / rise if rise > 0 else 1.0


def rewarded(p, reward, s, dt):
    """Return the factor of the reward, 0 when nothing is learned.

    With a fixed duration an onset of the reward counts as `dt` of that duration.
    """
    if not p.flag("fixed reward duration", "false"):
        return reward
    if reward > 0.5 >= s["before"]:
        s["elapsed"] = 0.0
    s["before"] = reward
    if s["elapsed"] is None:
        return 0.0
    s["elapsed"] += dt
    return 1.0 if s["elapsed"] < p.time("reward duration", 200) else 0.0


@steps_of(
    "cedar.dynamics.HebbianConnection",
    may=["source node", "target field", "reward signal"],
    looped=True,
    begin=begin_hebbian,
    buffers=["weights"],
)
def hebbian(p, x, s, clock):
    """Learn by Oja's rule, then read the new weights."""
    if p.word("learning rule", "Oja's Rule") != "Oja's Rule":
        raise ValueError("no reference for this learning rule")
    sizes = weight_sizes(p)
    if len(sizes[0]) + len(sizes[1]) > 2:
        raise ValueError("no reference for these dimensions")
    source_shape, target_shape = (shape_of(n) for n in sizes)
    heaviside = "cedar.aux.math.HeavisideSigmoid"
    source = x["source node"] if "source node" in x else np.zeros(source_shape)
    if source.size != np.prod(source_shape):
        raise Invalid("sizes of the source differ")
    f = transfer(p, "f (source sigmoid)", heaviside, 0.5)(source)
    if all(slot in x for slot in ("source node", "target field", "reward signal")):
        if x["target field"].size != np.prod(target_shape):
            raise Invalid("sizes of the target differ")
        h = transfer(p, "h (target sigmoid)", "cedar.aux.math.LinearTransferFunction")(x["target field"])
        reward = transfer(p, "g (reward sigmoid)", heaviside, 0.5)(x["reward signal"])
        gain = p.number("learning rate", 0.01) * rewarded(p, only_value(reward), s, clock.dt)
        s["w"] = s["w"] + oja(p, sizes, s["w"], f, h, gain, clock.dt)
    w = s["w"]
    if not sizes[0]:
        read = w * only_value(f)
    elif not sizes[1]:
        read = scalar((w * f).sum())
    else:
        read = vector(w.T @ source.reshape(-1))
    return {"learned output": read, "weights": w}


def oja(p, sizes, w, f, h, gain, dt):
    """Return the change of the weights."""
    if not sizes[0]:
        return learning_factor(p, h, dt) * gain * only_value(f) * (h - w)
    if not sizes[1]:
        return learning_factor(p, h, dt) * gain * only_value(h) * (f - w)
    rows, columns = f.reshape(-1, 1), h.reshape(1, -1)
    open_gate = gain if gain > 0 else 0.0
    return learning_factor(p, columns, dt) * open_gate * (rows * columns - w)


@steps_of(
    "cedar.dynamics.SpaceToRateCode",
    needs=["input"],
    looped=True,
    begin=lambda p, s: {"output": s.setdefault("x", scalar(0))},
)
def space_to_rate_code(p, x, s, clock):
    """Relax to the mean position; the cyclic mean is reached at once."""
    if number_of_dimensions(x["input"]) > 1:
        raise Invalid("only 1-D is read")
    profile = x["input"].reshape(-1)
    n, low, high = len(profile), p.number("lowerLimit", 0), p.number("upperLimit", 1)
    total = profile.sum()
    rate = float(s["x"].reshape(-1)[0])
    if total <= 0:
        s["x"] = scalar(math.nan if p.flag("NaN if no peak", "false") else 0 if math.isnan(rate) else rate)
        return {"output": s["x"]}
    rate = 0.0 if math.isnan(rate) else rate
    ramp = np.array([low + (high - low) * i / max(1, n - 1) for i in range(n)])
    weighted = (profile * ramp).sum()
    if p.flag("use cyclic mean", "false"):
        rate = low + (high - low) * ring_mean(profile) / n
    elif p.flag("jump to fixed point", "false"):
        rate = weighted / total
    else:
        tau = p.time("tau", "100 ms")
        parts = max(1, math.ceil(clock.dt * total / tau))
        for _ in range(parts):
            rate += -(clock.dt / parts) / tau * (total * rate - weighted)
    s["x"] = scalar(rate)
    return {"output": s["x"]}


def ring_mean(profile):
    """Return the mean position on a ring of n cells, in [0, n)."""
    n = len(profile)
    angles = 2 * math.pi * np.arange(n) / n
    angle = math.atan2((profile * np.sin(angles)).sum(), (profile * np.cos(angles)).sum())
    return (angle % (2 * math.pi)) * n / (2 * math.pi)


def begin_oscillator(p, s):
    n = int(p.number("dimensionality", 2))
    s.update(p=vector(p.numbers("Initial Position", 4, n)), v=np.zeros((n, 1)))
    return {"p": np.zeros((n, 1)), "pDot": np.zeros((n, 1)), "pDotDot": np.zeros((n, 1))}


@steps_of(
    "cedar.dynamics.HarmonicOscillator",
    needs=["lambda"],
    may=["overwriteInput", "overwritePeakDetector"],
    looped=True,
    begin=begin_oscillator,
)
def harmonic_oscillator(p, x, s, clock):
    """Integrate with the new speed (times in s)."""
    if p.flag("cyclic restrictions", "false"):
        raise ValueError("no reference for cyclic restrictions")
    goal, k, d, dt = fitted(x["lambda"], s["p"].shape), p.number("K", 4), p.number("D", 1), clock.dt / 1000
    if (
        "overwriteInput" in x
        and "overwritePeakDetector" in x
        and only_value(x["overwritePeakDetector"]) > 0.5
    ):
        s.update(p=fitted(x["overwriteInput"], s["p"].shape), v=np.zeros_like(s["v"]))
    a = -k * (s["p"] - goal) - 2 * d * math.sqrt(k) * s["v"]
    s["v"] = s["v"] + dt * a
    s["p"] = s["p"] + dt * s["v"]
    return {"p": s["p"], "pDot": s["v"], "pDotDot": a}


def begin_serial_order(p, s):
    n = int(p.number("number of ordinal positions", 3))
    s["d"] = np.full(n, p.number("ordinal resting level", -5))
    s["m"] = np.full(n, p.number("memory resting level", -2))
    return {f"ordinal node {i} output": scalar(0) for i in range(n)} | {
        "ordinal node activation": vector(s["d"]),
        "memory node activation": vector(s["m"]),
    }


@steps_of(
    "cedar.dynamics.SerialOrder",
    may=["CoS signal input"],
    looped=True,
    begin=begin_serial_order,
    buffers=["ordinal node activation", "memory node activation"],
)
def serial_order(p, x, s, clock):
    """Update each pair of nodes in place, one pair after another; the sum of outputs is that of the start."""
    f, d, m = transfer(p, "sigmoid"), s["d"].copy(), s["m"].copy()
    n, rate, cyclic = len(d), clock.dt / p.time("tau", 100), p.flag("cyclic", "false")
    done = only_value(x["CoS signal input"]) if "CoS signal input" in x else 0.0
    total = f(d).sum()
    for i in range(n):
        nearer = f(m[i - 1]) if i or cyclic else 1.0
        change = -d[i] + p.number("ordinal resting level", -5) - done
        change += p.number("ordinal self excitation", 11) * f(d[i])
        change += p.number("ordinal global inhibition", -11) * (total - f(d[i]))
        change += p.number("memory to same ordinal", -5) * f(m[i])
        change += p.number("memory to next ordinal", 5) * nearer
        d[i] += rate * change
        change = -m[i] + p.number("memory resting level", -2)
        change += p.number("memory self excitation", 7) * f(m[i])
        change += p.number("memory global inhibition", -2) * (total - f(m[i]))
        change += p.number("ordinal to same memory", 7) * f(d[i])
        if cyclic:
            change += p.number("ordinal to prev memory", -7) * f(d[(i + 1) % n])
        m[i] += rate * change
    s.update(d=d, m=m)
    return {f"ordinal node {i} output": scalar(f(d[i])) for i in range(n)} | {
        "ordinal node activation": vector(d),
        "memory node activation": vector(m),
    }


# ---------------------------------------------------------------------------------------- sources


def bell(sizes, centers, sigmas, amplitude, cyclic):
    """Return a Gauss profile over the cells; on a ring the shorter of both distances counts."""
    y = np.full((), float(amplitude))
    for n, c, sigma in zip(sizes, centers, sigmas, strict=True):
        distance = np.abs(np.arange(int(n)) - c)
        if cyclic:
            distance = np.minimum(distance, n - distance)
        y = y[..., None] * np.exp(-(distance**2) / (2 * sigma**2))
    return as_matrix(y)


def block(sizes, lefts, widths, inside, outside):
    """Return a box over the cells: those from the left bound on, fewer than the width away from it."""
    within = np.ones((), bool)
    for n, left, width in zip(sizes, lefts, widths, strict=True):
        i = np.arange(int(n))
        within = within[..., None] & ((i >= left) & (i < left + width))
    return as_matrix(np.where(within, float(inside), float(outside)))


@steps_of("cedar.processing.sources.GaussInput")
def gauss_input(p, x, s, clock):
    sizes = sizes_of(p)
    d = len(sizes)
    y = bell(
        sizes,
        p.numbers("centers", 24, d),
        p.numbers("sigma", 3, d),
        p.number("amplitude", 1),
        p.flag("cyclic", "false"),
    )
    return {"Gauss input": y}


@steps_of("cedar.processing.sources.BoxInput")
def box_input(p, x, s, clock):
    sizes = sizes_of(p)
    lefts, widths = p.numbers("left bounds", 0, len(sizes)), p.numbers("widths", 10, len(sizes))
    y = block(sizes, lefts, widths, p.number("amplitude", 1), p.number("reference level", 0))
    return {"box input": y}


@steps_of("cedar.processing.sources.Boost")
def boost(p, x, s, clock):
    return {"boost": scalar(p.number("strength", 1) if p.flag("active", "false") else 0)}


@steps_of("cedar.processing.sources.ConstMatrix")
def const_matrix(p, x, s, clock):
    sizes = p.get("sizes", ["50", "50"]) or []
    return {"matrix": np.full(shape_of([float(n) for n in sizes]), p.number("value", 1))}


@steps_of("cedar.processing.ConstVector")
def const_vector(p, x, s, clock):
    n = int(p.number("number of vector entries", 1))
    entries = [float(v) for v in p.get("entries") or []]
    return {"vector": vector((entries + [0.0] * n)[:n])}


@steps_of("cedar.processing.sources.LinearSpatialTemplate")
def linear_spatial_template(p, x, s, clock):
    rows, columns = int(p.number("size x", 50)), int(p.number("size y", 50))
    low, high = p.number("lowest", 0), p.number("upmost", 1)
    y = np.zeros((rows, columns))
    for i in range(rows):
        for j in range(columns):
            y[i, j] = low + (high - low) * (i + j) / (rows + columns - 2)
    return {"spatial pattern": y}


@steps_of("cedar.processing.sources.SpatialTemplate")
def spatial_template(p, x, s, clock):
    """Return a Gauss profile over angle and logarithm of the distance, seen from the centre."""
    rows, columns = int(p.number("size x", 50)), int(p.number("size y", 50))
    angle, angle_width = p.number("mu th", 0), p.number("sigma th hor", 0.25)
    far, far_width = p.number("mu r", 15), p.number("sigma r", 100)
    y = np.zeros((rows, columns))
    for i in range(rows):
        for j in range(columns):
            dx, dy = i - rows // 2, j - columns // 2
            if dx or dy:
                a = (math.atan2(dy, dx) - angle) / angle_width
                b = (math.log(math.hypot(dx, dy)) - far) / far_width
                y[i, j] = math.exp(-0.5 * a**2 - 0.5 * b**2)
    return {"spatial pattern": y}


def begin_signal(p, s):
    return {"signal": scalar(0)}


def phase(p, clock):
    """Return the present part of the period, as a number of periods."""
    turn = (clock.now / 1000 + p.number("phase shift", 0)) / p.number("period", 1)
    return turn + (0.25 if p.flag("make cos", "false") else 0)


@steps_of("cedar.processing.sources.SinusSignal", looped=True, begin=begin_signal)
def sinus_signal(p, x, s, clock):
    wave = math.sin(2 * math.pi * phase(p, clock))
    return {"signal": scalar(p.number("amplitude", 1) * wave + p.number("vertical offset", 0))}


@steps_of("cedar.processing.sources.StepSignal", looped=True, begin=begin_signal)
def step_signal(p, x, s, clock):
    """Return the amplitude in the first half of a period and its negative in the second."""
    wave = 1 if phase(p, clock) % 1 < 0.5 else -1
    return {"signal": scalar(p.number("amplitude", 1) * wave + p.number("vertical offset", 0))}


# ---------------------------------------------------------------------------------------- algebra


@steps_of("cedar.processing.StaticGain", needs=["input"])
def static_gain(p, x, s, clock):
    return {"output": p.number("gain factor", 1) * x["input"]}


@steps_of("cedar.processing.steps.AddConstant", needs=["input"])
def add_constant(p, x, s, clock):
    return {"output": x["input"] + p.number("constant", 0)}


@steps_of("cedar.processing.steps.Sum", needs=["terms"], many=["terms"])
def sum_of_terms(p, x, s, clock):
    return {"sum": sum(same_sizes(x["terms"]))}


@steps_of("cedar.processing.SubtractElementwise", needs=["minuend", "subtrahend"])
def subtract(p, x, s, clock):
    if is_0d(x["subtrahend"]) and not is_0d(x["minuend"]):
        raise Invalid("a single number cannot be subtracted")
    a, b = same_sizes([x["minuend"], x["subtrahend"]])
    return {"result": a - b}


@steps_of("cedar.processing.ComponentMultiply", needs=["operands"], many=["operands"])
def component_multiply(p, x, s, clock):
    y = 1.0
    for operand in same_sizes(x["operands"]):
        y = y * operand
    return {"product": y}


@steps_of("cedar.processing.ConvertToValueRange", needs=["input"])
def convert_to_value_range(p, x, s, clock):
    a, b = p.number("input lower bound", 0), p.number("input upper bound", 1)
    c, d = p.number("output lower bound", 0), p.number("output upper bound", 1)
    return {"converted output": c + (x["input"] - a) * (d - c) / (b - a)}


@steps_of("cedar.processing.AbsoluteValue", needs=["input"])
def absolute_value(p, x, s, clock):
    return {"absolute value": np.abs(x["input"])}


@steps_of("cedar.processing.DivideElementwise", needs=["dividend", "divisor"])
def divide_elementwise(p, x, s, clock):
    return {"result": x["dividend"] / equal(x["divisor"], x["dividend"])}


def equal(x, other):
    """Return an input whose sizes must be those of another one."""
    if x.size != other.size:
        raise Invalid("sizes differ")
    return fitted(x, other.shape)


@steps_of("cedar.processing.ScalarDivision", needs=["matrix", "divisor"])
def scalar_division(p, x, s, clock):
    divisor = only_value(x["divisor"])
    if divisor == 0 and p.flag("treat division by zero", "true"):
        divisor = p.number("zero divisor replacement", 1e-6)
    return {"result": x["matrix"] / np.float64(divisor)}


@steps_of("cedar.processing.steps.InnerProduct", needs=["input", "input 2"])
def inner_product(p, x, s, clock):
    return {"output": scalar((x["input"] * equal(x["input 2"], x["input"])).sum())}


@steps_of("cedar.processing.steps.OuterProduct", needs=["input", "input 2"])
def outer_product(p, x, s, clock):
    if any(number_of_dimensions(x[slot]) > 1 for slot in ("input", "input 2")):
        raise Invalid("vectors are read here")
    return {"output": x["input"].reshape(-1, 1) * x["input 2"].reshape(1, -1)}


@steps_of("cedar.processing.steps.CrossProduct", needs=["input", "input 2"])
def cross_product(p, x, s, clock):
    if x["input"].size != 3 or x["input 2"].size != 3:
        raise Invalid("vectors of 3 are read here")
    a, b = x["input"].reshape(-1), x["input 2"].reshape(-1)
    y = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    return {"output": vector(y)}


@steps_of("cedar.processing.MatrixMultiply", needs=["operand1", "operand2"])
def matrix_multiply(p, x, s, clock):
    a, b = x["operand1"], x["operand2"]
    if a.ndim != 2 or b.ndim != 2:
        raise Invalid("matrices are read here")
    a = a.T if p.flag("transposeOperand1", "false") else a
    if a.shape[1] != b.shape[0]:
        raise Invalid("sizes differ")
    return {"matrixProduct": a @ b}


@steps_of("cedar.processing.PseudoInverse", needs=["matrix"])
def pseudo_inverse(p, x, s, clock):
    if x["matrix"].ndim != 2:
        raise Invalid("a matrix is read here")
    inverse = np.linalg.pinv(x["matrix"], rcond=1e-6)
    return {"inverted": inverse.reshape(-1, 1) if 1 in inverse.shape else inverse}


@steps_of("cedar.processing.Nullspace", needs=["jacobian"], may=["vector"])
def null_space(p, x, s, clock):
    """Return the projector on the null space, and both parts of a vector."""
    jacobian = x["jacobian"]
    columns = jacobian.shape[1]
    if "vector" in x and x["vector"].size != columns:
        raise Invalid("the vector has another size")
    found = np.eye(columns) - np.linalg.pinv(jacobian) @ jacobian
    if "vector" not in x:
        return {"nullspace": found}
    inside = found @ x["vector"].reshape(-1, 1)
    return {
        "nullspace": found,
        "projected vector": inside,
        "orthogonal vector": x["vector"].reshape(-1, 1) - inside,
    }


@steps_of("cedar.processing.steps.Histogram", needs=["input"], may=["mask"])
def histogram(p, x, s, clock):
    """Count the cells in bins of equal width, without the end of the range."""
    values = x["input"].reshape(-1)
    if "mask" in x:
        values = values[equal(x["mask"], x["input"]).reshape(-1) != 0]
    bins, low, high = int(p.number("bins", 10)), p.number("range lower", 0), p.number("range upper", 255)
    counts = np.zeros(bins)
    for value in values[(values >= low) & (values < high)]:
        counts[min(int((value - low) / (high - low) * bins), bins - 1)] += 1
    kind = p.word("normalization type", "None")
    if kind == "ImageSize":
        counts = counts / x["input"].size
    elif kind == "Maximum" and counts.max() > 0:
        counts = counts / counts.max()
    return {"histogram": vector(counts)}


@steps_of("cedar.processing.steps.Maximum", needs=["terms"], many=["terms"])
def maximum(p, x, s, clock):
    y = x["terms"][0]
    for term in x["terms"][1:]:
        y = np.maximum(y, equal(term, y))
    return {"maximum": y.copy()}


@steps_of("cedar.processing.steps.Minimum", needs=["terms"], many=["terms"])
def minimum(p, x, s, clock):
    y = x["terms"][0]
    for term in x["terms"][1:]:
        y = np.minimum(y, equal(term, y))
    return {"minimum": y.copy()}


@steps_of("cedar.processing.Norm", needs=["input"])
def norm(p, x, s, clock):
    return {"output": scalar(math.sqrt((x["input"] ** 2).sum()))}


@steps_of("cedar.processing.Normalization", needs=["input"])
def normalization(p, x, s, clock):
    """Divide by the norm over the flagged dimensions, over all of them if none is flagged."""
    y = by_dimension(x["input"])
    flags = p.flags("normalized dimensions", False, y.ndim)
    axes = tuple(k for k in range(y.ndim) if flags[k]) or tuple(range(y.ndim))
    kind = p.word("normalization type", "L2Norm")
    if kind == "L1Norm":
        size = np.abs(y).sum(axis=axes, keepdims=True)
    elif kind == "L2Norm":
        size = np.sqrt((y**2).sum(axis=axes, keepdims=True))
    elif kind == "InfinityNorm":
        size = np.abs(y).max(axis=axes, keepdims=True)
    else:
        size = np.ones(())
    return {"normalized input": as_matrix(np.where(size > 0, y / np.where(size > 0, size, 1), 0))}


@steps_of("cedar.processing.RemoveMean", needs=["matrix"])
def remove_mean(p, x, s, clock):
    return {"mean-free matrix": x["matrix"] - x["matrix"].mean()}


@steps_of("cedar.processing.steps.LinearFunction", needs=["input"], may=["horizontal shift (optional)"])
def linear_function(p, x, s, clock):
    """Compute what is meant: the slope times the shifted input."""
    shift = p.number("horizontal shift", 0)
    if "horizontal shift (optional)" in x:
        shift = fitted(x["horizontal shift (optional)"], x["input"].shape)
    return {"result": p.number("slope", 1) * (x["input"] + shift)}


@steps_of("cedar.processing.steps.Logarithm", needs=["input"], may=["base (optional)"])
def logarithm(p, x, s, clock):
    base = p.number("base", math.e)
    if "base (optional)" in x:
        base = only_value(x["base (optional)"])
    return {"result": np.log(x["input"]) / np.log(base)}


@steps_of("cedar.processing.steps.Sinus", needs=["input"], may=["phase shift (optional)"])
def sinus(p, x, s, clock):
    angle = only_value(x["input"]) + p.number("phase shift", 0)
    if "phase shift (optional)" in x:
        angle = only_value(x["input"]) + only_value(x["phase shift (optional)"])
    wave = math.cos(angle) if p.flag("make cos", "false") else math.sin(angle)
    return {"result": scalar(p.number("amplitude", 1) * wave)}


@steps_of("cedar.processing.TransferFunction", needs=["input"])
def transfer_function(p, x, s, clock):
    key = "sigmoid" if p.get("function") is None and p.get("sigmoid") is not None else "function"
    return {"sigmoided output": transfer(p, key)(x["input"])}


@steps_of("cedar.processing.Transpose", needs=["matrix"])
def transpose(p, x, s, clock):
    if x["matrix"].ndim != 2:
        raise Invalid("a matrix is read here")
    return {"transposed": x["matrix"].T.copy()}


@steps_of("cedar.processing.steps.Convolution", needs=["matrix"], may=["kernel"])
def convolution(p, x, s, clock):
    settings = p.inner("convolution")
    if settings.word("mode", "Same") != "Same":
        raise ValueError("no reference for this mode")
    if "kernel" in x:
        return {"result": convolved_with_matrix(x["matrix"], x["kernel"], settings)}
    kernels = p.listed("kernels")
    return {"result": convolved(x["matrix"], kernels, settings) if kernels else x["matrix"].copy()}


# ------------------------------------------------------------------------------------ projections


def mapping_of(p, d_in, d_out):
    """Return the output dimension of each input dimension, None if it is dropped."""
    given = {int(k): int(v) for k, v in Par(p.get("dimension mapping")).pairs}
    goals = [given.get(k, DROPPED) for k in range(d_in)]
    goals = [None if goal in (DROPPED, -1) else goal for goal in goals]
    kept = [goal for goal in goals if goal is not None]
    if len(set(kept)) < len(kept) or any(goal >= d_out for goal in kept):
        raise Invalid("an output dimension is used twice, or does not exist")
    if len(kept) < d_in <= d_out:
        raise Invalid("dimensions are dropped though the output has as many")
    if d_in and not kept and d_out:
        raise Invalid("all dimensions are dropped")
    return goals


@steps_of("cedar.processing.Projection", needs=["input"])
def projection(p, x, s, clock):
    y = by_dimension(x["input"])
    d_out = int(p.number("output dimensionality", 1))
    goals = mapping_of(p, y.ndim, d_out)
    sizes = [int(n) for n in p.numbers("output dimension sizes", 50, d_out)]
    reduce = {"SUM": np.sum, "AVERAGE": np.mean, "MAXIMUM": np.max, "MINIMUM": np.min}
    dropped = tuple(k for k in range(y.ndim) if goals[k] is None)
    kept = [goal for goal in goals if goal is not None]
    if dropped:
        y = reduce[p.word("compression type", "SUM")](y, axis=dropped)
    for k, goal in enumerate(kept):
        sizes[goal] = y.shape[k]
    y = np.transpose(y, np.argsort(kept)) if kept else y
    for new in [goal for goal in range(d_out) if goal not in kept]:
        y = np.expand_dims(y, new)
    return {"output": as_matrix(np.broadcast_to(y, sizes).astype(float))}


def point_wise_weights(shape, kernels):
    """Return kernels as weights of the cells of an array, with their centre on its middle cell."""
    result = np.zeros(shape)
    for type_id, p in kernels:
        parts, anchor = kernel_parts(type_id, p, len(shape))
        factors = []
        for n, part, shift in zip(shape, parts, anchor, strict=True):
            zeros = np.zeros(n)
            for j, value in enumerate(part):
                i = n // 2 + j - centre_of(len(part), False) + shift
                if 0 <= i < n:
                    zeros[i] = value
            factors.append(zeros)
        result += math.prod(np.ix_(*factors))
    return result


@steps_of("cedar.processing.SynapticConnection", many=["matrix"], needs=["matrix"])
def synaptic_connection(p, x, s, clock):
    """Add up the inputs, convolve, multiply by weights of the cells and by one weight, and project."""
    y = sum(same_sizes(x["matrix"]))
    settings = p.inner("convolution")
    kernels, weights = settings.listed("kernels"), p.inner("PointWiseWeight").listed("kernels")
    y = convolved(y, kernels, settings) if kernels else y
    if weights:
        cells = by_dimension(y).shape or (1,)
        y = y * point_wise_weights(cells, weights).reshape(y.shape)
    y = y * p.inner("static gain").number("Synapse Weight", 1)
    inner = p.inner("projection")
    if not inner.flag("enabled", "false"):
        return {"result": y}
    return {"result": projection(inner, {"input": y}, s, clock)["output"]}


def resized_linear(y, axis, m):
    """Return m samples between the centres of the cells; beyond the outer centres the value stays."""
    n = y.shape[axis]
    parts = []
    for i in range(m):
        position = min(max((i + 0.5) * n / m - 0.5, 0), n - 1)
        low = min(int(position), max(0, n - 2))
        high, weight = min(low + 1, n - 1), position - low
        parts.append((1 - weight) * np.take(y, low, axis) + weight * np.take(y, high, axis))
    return np.stack(parts, axis)


@steps_of("cedar.processing.Resize", needs=["input"])
def resize(p, x, s, clock):
    y = by_dimension(x["input"])
    if y.ndim == 0:
        raise Invalid("0-D cannot be resized")
    method = p.word("interpolation", "LINEAR")
    for axis, m in enumerate(int(n) for n in p.numbers("output size", 50, y.ndim)):
        if method == "NEAREST" and y.ndim < 3:
            y = np.take(y, [i * y.shape[axis] // m for i in range(m)], axis)
        elif method == "LINEAR" or y.ndim >= 3:
            y = resized_linear(y, axis, m)
        else:
            raise ValueError(f"no reference for {method}")
    return {"output": as_matrix(y)}


# ----------------------------------------------------------------------------------------- arrays


@steps_of("cedar.processing.steps.Clamp", needs=["input"])
def clamp(p, x, s, clock):
    y = x["input"]
    low, high = p.number("lower limit", 0), p.number("upper limit", 1)
    below = p.number("lower replacement", 0) if p.flag("replace lower limit", "false") else low
    above = p.number("upper replacement", 1) if p.flag("replace upper limit", "false") else high
    result = y.copy()
    if p.flag("apply lower limit", "true"):
        result[y < low] = below
    if p.flag("apply upper limit", "true"):
        result[y > high] = above
    return {"thresholded input": result}


@steps_of("cedar.processing.Flip", needs=["input"])
def flip(p, x, s, clock):
    y = by_dimension(x["input"])
    flags = p.flags("flipped dimensions", True, y.ndim)
    return {"output": as_matrix(np.flip(y, [k for k in range(y.ndim) if flags[k]]).copy())}


@steps_of("cedar.processing.Mask", needs=["input", "mask"])
def mask(p, x, s, clock):
    return {"masked": np.where(equal(x["mask"], x["input"]) != 0, x["input"], 0)}


@steps_of("cedar.processing.MatrixPadding", needs=["input"])
def matrix_padding(p, x, s, clock):
    y = by_dimension(x["input"])
    for axis, size in enumerate(int(n) for n in p.numbers("border size", 0, y.ndim)):
        before = after = size
        if p.word("padding mode", "PadByBorder") == "PadToSize":
            more = size - y.shape[axis]
            if more < 0:
                raise Invalid("the input is larger than the padded size")
            before, after = more // 2, more - more // 2
        y = beyond(y, axis, before, after, p.word("border type", "Zero"))
    return {"padded": as_matrix(y)}


@steps_of("cedar.processing.MatrixSlice", needs=["matrix"])
def matrix_slice(p, x, s, clock):
    y = by_dimension(x["matrix"])
    lows, highs = p.numbers("range lower", 0, y.ndim), p.numbers("range upper", 1, y.ndim)
    parts = []
    for n, low, high in zip(y.shape, lows, highs, strict=True):
        start = n // 2 if p.word("anchor type", "Absolute") == "Center" else 0
        parts.append(slice(start + int(low), start + int(high)))
        if not 0 <= parts[-1].start < parts[-1].stop <= n:
            raise Invalid("the range is outside of the matrix")
    return {"slice": as_matrix(y[tuple(parts)].copy())}


@steps_of("cedar.processing.steps.ConcatVertically", needs=["input above", "input below"])
def concat_vertically(p, x, s, clock):
    a, b = x["input above"], x["input below"]
    if a.ndim != 2 or b.ndim != 2 or a.shape[1] != b.shape[1]:
        raise Invalid("sizes differ")
    return {"output": np.concatenate([a, b], axis=0)}


@steps_of("cedar.processing.steps.Stack", counted="")
def stack(p, x, s, clock):
    """Put 2-D matrices behind each other, along the third dimension; a missing one is 0."""
    if not x:
        raise Invalid("nothing to stack")
    shape = next(iter(x.values())).shape
    layers = [x.get(str(i), np.zeros(shape)) for i in range(int(p.number("dimensionality", 1)))]
    if len(shape) != 2 or any(layer.shape != shape for layer in layers):
        raise Invalid("sizes differ")
    return {"stack": np.stack(layers, axis=2)}


def positions(p, x, sizes):
    """Return the position in an input, one number for each dimension."""
    if x.size != len(sizes):
        raise Invalid("a position has one entry for each dimension")
    return [float(v) for v in x.reshape(-1)]


@steps_of("cedar.processing.steps.VariableGauss", needs=["centers"])
def variable_gauss(p, x, s, clock):
    sizes = sizes_of(p)
    centers = positions(p, x["centers"], sizes)
    if any(math.isnan(c) for c in centers) and p.flag("no peak if NaN", "false"):
        return {"box": np.zeros(shape_of(sizes))}
    return {"box": bell(sizes, centers, p.numbers("sigma", 3, len(sizes)), p.number("amplitude", 1), False)}


@steps_of("cedar.processing.steps.VariableBox", needs=["left bounds"])
def variable_box(p, x, s, clock):
    sizes = sizes_of(p)
    lefts, widths = positions(p, x["left bounds"], sizes), p.numbers("widths", 10, len(sizes))
    outside = p.number("reference level", 0)
    if any(math.isnan(c) for c in lefts) and p.flag("no peak if NaN", "false"):
        return {"box": np.full(shape_of(sizes), outside)}
    if p.flag("center at input", "false"):
        lefts = [c - w / 2 for c, w in zip(lefts, widths, strict=True)]
    return {"box": block(sizes, lefts, widths, p.number("amplitude", 1), outside)}


@steps_of("cedar.dynamics.RateToSpaceCode", needs=["input"])
def rate_to_space_code(p, x, s, clock):
    given = p.get("output sizes", ["50", "50"])
    sizes = [int(n) for n in given] if isinstance(given, list) else [int(given)]
    d, values = len(sizes), positions(p, x["input"], sizes)
    lows, highs = p.numbers("lower limits", 0, d), p.numbers("upper limits", 1, d)
    ranges = zip(sizes, values, lows, highs, strict=True)
    centers = [n * (v - low) / (high - low) for n, v, low, high in ranges]
    sigmas = p.numbers("sigma", 3, d)
    return {"output": bell(sizes, centers, sigmas, p.number("amplitude", 1), p.flag("cyclic", "false"))}


@steps_of("cedar.dynamics.RateMatrixToSpaceCode", needs=["bin map"], may=["values"])
def rate_matrix_to_space_code(p, x, s, clock):
    """Mark the bin of each rate; a half counts as the upper bin, and bins that do not exist are left out."""
    rates = x["bin map"]
    if number_of_dimensions(rates) != 2:
        raise Invalid("a matrix of rates is read here")
    values = equal(x["values"], rates) if "values" in x else np.ones(rates.shape)
    bins = int(p.number("number of bins", 10))
    low, high = p.number("lower limit", 0), p.number("upper limit", 1)
    code = np.zeros((*rates.shape, bins))
    for (i, j), rate in np.ndenumerate(rates):
        k = math.floor((rate - low) / (high - low) * (bins - 1) + 0.5)
        if 0 <= k < bins:
            code[i, j, k] = values[i, j]
    return {"output": code}


@steps_of("cedar.dynamics.SpaceCodeToRateMatrix", needs=["input"])
def space_code_to_rate_matrix(p, x, s, clock):
    """Return the rate of the largest bin; of equal ones that of the first."""
    code = x["input"]
    if code.ndim != 3:
        raise Invalid("three dimensions are read here")
    low, high = p.number("lower limit", 0), p.number("upper limit", 1)
    rates = np.linspace(low, high, code.shape[2])
    return {"output": rates[code.argmax(axis=2)]}


# -------------------------------------------------------------------------- numerics, programming


@steps_of("cedar.processing.steps.Switch", needs=["input 1", "input 2", "factor"])
def switch(p, x, s, clock):
    factor = only_value(x["factor"])
    if p.flag("make binary", "false"):
        factor = 1.0 if factor > 0.5 else 0.0
    return {"mixture": factor * x["input 1"] + (1 - factor) * equal(x["input 2"], x["input 1"])}


@steps_of("cedar.processing.steps.Count", needs=["input"])
def count(p, x, s, clock):
    return {"output": scalar((x["input"] > p.number("threshold", 0)).sum())}


@steps_of("cedar.processing.steps.PositionOfMaximum", needs=["input"])
def position_of_maximum(p, x, s, clock):
    y = by_dimension(x["input"])
    if y.ndim == 0:
        raise Invalid("0-D has no position")
    if p.flag("NaN if no peak", "false") and y.max() < p.number("Peak detection threshold", 0.1):
        return {"output": np.full((y.ndim, 1), math.nan)}
    kind = p.word("position type", "Maximum")
    if kind == "Maximum":
        return {"output": vector(np.unravel_index(int(np.argmax(y)), y.shape))}
    marginals = []
    above = np.where(y > p.number("Centroid detection threshold", 0.1), y, 0)
    for axis in range(y.ndim):
        others = tuple(k for k in range(y.ndim) if k != axis)
        marginals.append((y if kind == "Cyclic Mean" else above).sum(axis=others))
    if kind == "Cyclic Mean":
        return {"output": vector([ring_mean(m) for m in marginals])}
    total = above.sum()
    return {"output": vector([(m * np.arange(len(m))).sum() / total if total else 0 for m in marginals])}


@steps_of("cedar.processing.ScalarsToVector", counted="scalar ")
def scalars_to_vector(p, x, s, clock):
    n = int(p.number("number of vector entries", 1))
    if any(f"scalar {i}" not in x for i in range(n)):
        raise Invalid("an entry is not connected")
    return {"vector": vector([only_value(x[f"scalar {i}"]) for i in range(n)])}


@steps_of("cedar.processing.VectorToScalars", needs=["input vector"])
def vector_to_scalars(p, x, s, clock):
    values = x["input vector"].reshape(-1)
    n = int(p.number("number of vector entries", 3))
    if number_of_dimensions(x["input vector"]) > 1 or len(values) < n:
        raise Invalid("the vector has fewer entries")
    return {f"scalar {i}": scalar(values[i]) for i in range(n)}


@steps_of("cedar.processing.steps.Delay", needs=["input"])
def delay(p, x, s, clock):
    """Put out the input of some computations before; 0 until there is one."""
    n = int(p.number("number of time steps", 1))
    queue = s.setdefault("queue", deque([np.zeros_like(x["input"])] * n))
    queue.append(x["input"].copy())
    return {"output": queue.popleft()}


@steps_of("cedar.processing.steps.OverTime", needs=["input"])
def over_time(p, x, s, clock):
    """Put out the largest input so far."""
    s["largest"] = np.maximum(x["input"], s.get("largest", x["input"]))
    return {"output": s["largest"].copy()}


@steps_of("cedar.processing.steps.Timer", may=["run signal (optional)", "reset signal (optional)"])
def timer(p, x, s, clock):
    """Count the seconds in which the run signal is on; like any step it is computed when its inputs are."""
    passed, s["last"] = clock.now - s.get("last", 0.0), clock.now
    if "reset signal (optional)" in x and only_value(x["reset signal (optional)"]) > 0.5:
        s["time"] = 0.0
    elif "run signal (optional)" not in x or only_value(x["run signal (optional)"]) > 0.5:
        s["time"] = s.get("time", 0.0) + passed
    return {"time": scalar(s.get("time", 0.0) / 1000)}


@steps_of(
    "cedar.processing.steps.NumericalIntegration",
    needs=["input"],
    may=["initial state (optional)", "delay (optional)", "reset signal (optional)"],
    looped=True,
)
def numerical_integration(p, x, s, clock):
    """Add the input times the time step (s) to the initial state."""
    if p.flag("use BDF5", "false"):
        raise ValueError("no reference for BDF5")
    given, zero = x["input"], np.zeros_like(x["input"])
    first = fitted(x["initial state (optional)"], given.shape) if "initial state (optional)" in x else zero
    dt = only_value(x["delay (optional)"]) if "delay (optional)" in x else clock.dt / 1000
    if "reset signal (optional)" in x and only_value(x["reset signal (optional)"]) > 0.5:
        s["y"] = first
    else:
        s["y"] = s.get("y", first) + dt * given
    return {"integration result": s["y"].copy()}


def begin_bank(p, s):
    return {"state change": np.zeros(bank_shape(p))}


def bank_shape(p):
    return (2, int(p.number("bank size", 1)))


def bank(p, x, key, slot):
    """Return a parameter of all oscillators: a number, or one for each at an input."""
    slot = f"{slot} (optional)"
    return x[slot].reshape(-1) if slot in x else p.number(f"bank {key}", 1)


@steps_of(
    "cedar.processing.steps.HopfOscillatorRHS",
    needs=["state"],
    may=["omegas (bank) (optional)", "alphas (bank) (optional)", "gammas (bank) (optional)"],
    begin=begin_bank,
)
def hopf_oscillators(p, x, s, clock):
    if p.number("shift u by radius fraction", 0):
        raise ValueError("no reference for a shifted limit cycle")
    u, v = x["state"].reshape(bank_shape(p))
    alpha, omega, gamma = (bank(p, x, key, f"{key}s (bank)") for key in ("alpha", "omega", "gamma"))
    r = u**2 + v**2
    rows = alpha * u - omega * v - gamma * r * u, alpha * v + omega * u - gamma * r * v
    return {"state change": np.array(rows)}


@steps_of(
    "cedar.processing.steps.HarmonicOscillatorRHS",
    needs=["state"],
    may=["shift (optional)", "stiffnesss (bank) (optional)", "damping (bank) (optional)"],
    begin=begin_bank,
)
def harmonic_oscillators(p, x, s, clock):
    """Return the change of place and speed of masses of 1 on damped springs."""
    place, speed = x["state"].reshape(bank_shape(p))
    stiffness = bank(p, x, "stiffness", "stiffnesss (bank)")
    damping = bank(p, x, "damping", "damping (bank)")
    if p.flag("force critically damped", "false"):
        damping = 2 * np.sqrt(stiffness)
    shift = x["shift (optional)"].reshape(-1) if "shift (optional)" in x else 0
    return {
        "state change": np.array(
            (speed * np.ones_like(place), -stiffness * (place - shift) - damping * speed)
        )
    }


@steps_of(
    "cedar.processing.steps.NumericalDifferentiation", needs=["input"], may=["delay (optional)"], looped=True
)
def numerical_differentiation(p, x, s, clock):
    """Divide the last difference by the time step (s); 0 at the first input."""
    if p.flag("use five points", "false"):
        raise ValueError("no reference for five points")
    dt = only_value(x["delay (optional)"]) if "delay (optional)" in x else clock.dt / 1000
    low, high = (
        p.number("ignore time steps smaller than", 0.002),
        p.number("ignore time steps larger than", 1),
    )
    result = s.setdefault("result", np.zeros_like(x["input"]))
    if low <= dt <= high:
        if "last" in s:
            result = (x["input"] - s["last"]) / dt
        s.update(last=x["input"].copy(), result=result)
    return {"differentiated result": result}


@steps_of("cedar.processing.steps.ExponentialSmoothing", needs=["input"], looped=True)
def exponential_smoothing(p, x, s, clock):
    """Smooth level and trend, and put out their sum; the first level is the first input."""
    a, b = p.number("data smoothing factor", 0.1), p.number("trend smoothing factor", 0.1)
    if "level" not in s:
        s.update(level=x["input"].copy(), trend=np.zeros_like(x["input"]))
    else:
        level = a * x["input"] + (1 - a) * (s["level"] + s["trend"])
        s["trend"] = b * (level - s["level"]) + (1 - b) * s["trend"]
        s["level"] = level
    return {"forecast": s["level"] + s["trend"]}
