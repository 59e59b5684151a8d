"""One field of a model in isolation: without noise, with inputs that a measurement varies."""

from __future__ import annotations

import dataclasses as dc
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal, TypedDict

import jax.numpy as jnp
import numpy as np

from deodar.analysis.peaks import Peaks, peaks
from deodar.analysis.settle import LIMIT, Settled, settle
from deodar.element import Element
from deodar.elements.field import Field
from deodar.elements.stimuli import Boost, GaussianStimulus, Stimulus
from deodar.elements.world_ports import Sensor
from deodar.errors import AnalysisError, ParameterError, did_you_mean
from deodar.model import find
from deodar.model.document import Document, Entry
from deodar.model.model import Handle, Model
from deodar.model.paths import display
from deodar.numerics import interaction
from deodar.numerics.axes import Axes, shape
from deodar.numerics.processor import on_cpu
from deodar.session.session import Session
from deodar.session.session_snapshot import SessionSnapshot
from deodar.summary import Summarised, Summary

InputKind = Literal["input", "boost"]
"""The input that is varied: the strength of the localised input, or a homogeneous boost (on a node the two
are the same).
"""


WHOLE = 0.75
"""Share of a field's volume above which a region is not a peak: excitation has spread to the borders."""


@dataclass(frozen=True, repr=False)
class Isolated(Summarised):
    """A copy of one field with its own inputs.

    Attributes:
        path: path of the field in the original model.
        field: the field, its noise set to 0.
        session: the running copy; it has the elements `field`, `input`, `second` and `boost`.
        center: position of the localised input, one number for each axis.
        sigma: width of the localised input along each axis.
        time_unit: time unit of the model.
        background: paths of the model's elements that are kept as constant inputs.
    """

    path: str
    field: Field
    session: Session
    center: tuple[float, ...]
    sigma: tuple[float, ...]
    time_unit: str
    background: tuple[str, ...] = ()

    @property
    def axes(self) -> Axes:
        """The field's axes."""
        return tuple(self.field.axes)

    @property
    def threshold(self) -> float:
        """The activation above which a peak exists: the threshold of the output function, or 0 without
        one.
        """
        return float(getattr(self.field.sigmoid, "threshold", 0.0))

    @property
    def scale(self) -> float:
        """The distance between resting level and threshold: the unit in which inputs are searched."""
        return abs(self.threshold - self.field.resting_level) or 1.0

    def put(self, **amplitudes: float) -> None:
        """Set the strength of `input`, `second` and `boost`."""
        for name, amplitude in amplitudes.items():
            self.session.set(f"{name}.amplitude", float(amplitude))

    def reset(self, **amplitudes: float) -> None:
        """Reset the field to its resting level, with the given inputs and no others."""
        self.session.reset()
        self.put(**({"input": 0.0, "second": 0.0, "boost": 0.0} | amplitudes))

    def settle(self, tolerance: float | None = None, limit: float = LIMIT) -> Settled:
        """Run until the field settles; the default tolerance is 2e-4 of the distance between resting level
        and threshold.
        """
        return settle(self.session, tolerance or 2e-4 * self.scale, limit)

    def activation(self) -> np.ndarray:
        """The present activation."""
        return self.session.read("field.activation")

    def peaks(self) -> Peaks:
        """The present peaks."""
        return peaks(self.activation(), self.axes, self.threshold)

    def covers(self, found: Peaks) -> bool:
        """Return whether a region fills the field: three quarters of it, as borders may be inactive.

        Such a region does not count as a peak.
        """
        whole = math.prod(a.range for a in self.axes)
        return bool(self.axes) and any(p.size >= WHOLE * whole for p in found)

    def snapshot(self) -> SessionSnapshot:
        """Return the whole state, including the inputs."""
        return self.session.snapshot()

    def restore(self, snapshot: SessionSnapshot) -> None:
        """Restore a snapshot."""
        self.session.restore(snapshot)

    def _summary(self) -> Summary:
        rows = [
            ("input at", ", ".join(f"{c:g}" for c in self.center) or "the node"),
            ("its width", ", ".join(f"{s:g}" for s in self.sigma)),
            ("constant inputs", ", ".join(self.background) or "none"),
        ]
        return Summary(f"Isolated field {self.path}", rows)


class Isolation(TypedDict, total=False):
    """Keyword arguments of `isolate`, which measurements pass to it."""

    sigma: float | Sequence[float] | None
    center: Sequence[float] | None
    precision: str
    dt: float | None
    inputs: Sequence[str]


def isolate(
    model: Model | Field,
    path: str = "",
    *,
    sigma: float | Sequence[float] | None = None,
    center: Sequence[float] | None = None,
    precision: str = "float32",
    dt: float | None = None,
    inputs: Sequence[str] = (),
) -> Isolated:
    """Copy one field out of a model, without noise and with inputs of its own.

    Args:
        model: the model, or a field without a model.
        path: path of the field in the model.
        sigma: width of the localised input, one value or one for each axis; none: that of the interaction
            kernel's excitation.
        center: position of the localised input, one number for each axis; none: the sample nearest to the
            middle of each axis.
        precision: float32 or float64.
        dt: Euler step; none: the document's step, limited to between a hundredth and a tenth of the time
            constant (the settled state does not depend on it).
        inputs: paths of sources (and of couplings between them and the field) to keep as constant input.

    Raises:
        UnknownName: if the model has no element at `path`.
        AnalysisError: if the element is not a field, or an input is not constant.
    """
    if isinstance(model, Field):
        home = Model("isolated")
        path = home.add(model if model.name else dc.replace(model, name="field")).path
        model = home
    doc = model.document
    entry = find.element(doc, path)
    if not isinstance(entry.element, Field):
        fields = [e.path for e in doc.entries if isinstance(e.element, Field)]
        suggestion = did_you_mean(entry.path, fields) or "The model has no field"
        raise AnalysisError(
            f"{type(entry.element).__name__} is not a Field; only fields and nodes can be measured",
            where=entry.path,
            fix=suggestion,
        )
    field = dc.replace(entry.element, name="field", noise=0.0, noise_length=0.0)
    axes = tuple(field.axes)
    center = _center(field, center)
    widths = _widths(field, sigma)
    small = Model(doc.name, time_unit=doc.time_unit, trusted=model.trusted)
    target = small.add(field)
    for name in ("input", "second"):
        stimulus = GaussianStimulus(name, axes, center=center or 0.0, sigma=widths or 1.0, amplitude=0.0)
        small.connect(small.add(stimulus), target)
    small.connect(small.add(Boost("boost", axes, amplitude=0.0)), target)
    background = _keep(small, doc, entry, [find.element(doc, p) for p in inputs])
    step = dt if dt is not None else min(max(doc.step, field.tau / 100), field.tau / 10)
    return Isolated(
        entry.path,
        field,
        Session(small, dt=step, precision=precision),
        center,
        widths,
        doc.time_unit,
        background,
    )


def _keep(small: Model, doc: Document, field: Entry, entries: Sequence[Entry]) -> tuple[str, ...]:
    """Copy constant inputs of the field, always on, under the group `background`."""
    new = {field.id: "field"}
    for e in entries:
        element: Element = (
            dc.replace(e.element, windows=None) if isinstance(e.element, Stimulus) else e.element
        )  # type: ignore[call-arg]
        if element.stateful or isinstance(element, Sensor) or not element.steady() or e.id == field.id:
            raise AnalysisError(
                f"{type(element).__name__} gives no constant input",
                where=e.path,
                fix="Keep stimuli and stateless couplings only",
            )
        new[e.id] = small.add(element, group=display(("background", *e.group))).path
    for c in doc.connections:
        if c.source in new and c.source != field.id and c.target in new:
            small.connect(
                _port(small, new[c.source], c.source_port),
                _port(small, new[c.target], c.target_port),
                c.reads,
            )
    ends = {c.source for c in doc.connections if c.target in new}
    for e in entries:
        if e.id not in ends:
            raise AnalysisError(
                f"does not reach {field.path}", where=e.path, fix="Name the couplings between the two as well"
            )
    return tuple(e.path for e in entries)


def _port(model: Model, path: str, port: str) -> Handle:
    return model[path][port]


def _center(field: Field, center: Sequence[float] | None) -> tuple[float, ...]:
    """Return the position of the input along each axis: `center`, or the middle."""
    axes = tuple(field.axes)
    if center is None:
        return tuple(float(a.points[a.samples // 2]) for a in axes)
    position = tuple(float(c) for c in center)
    if len(position) != len(axes):
        raise ParameterError(f"center is {center!r}; expected a position for each of the {len(axes)} axes")
    return position


def _widths(field: Field, sigma: Any) -> tuple[float, ...]:
    """Return the width of the input along each axis: `sigma`, or that of the Gaussian with the kernel's
    half-width, at least one step.
    """
    axes = tuple(field.axes)
    if sigma is not None:
        widths = tuple(float(s) for s in (sigma if np.ndim(sigma) else (sigma,) * len(axes)))
        if len(widths) != len(axes) or any(not s > 0 for s in widths):
            raise ParameterError(
                f"sigma is {sigma!r}; expected a number above 0, or one for each of the {len(axes)} axes"
            )
        return widths
    return tuple(max(a.step, _excitation(field, d) or a.range / 20) for d, a in enumerate(axes))


def _excitation(field: Field, d: int) -> float | None:
    """Return the width of the kernel's excitation along one axis, from its response to a single active
    sample; None without excitation.
    """
    axes = tuple(field.axes)
    middle = tuple(a.samples // 2 for a in axes)
    single = np.zeros(shape(axes), np.float32)
    single[middle] = 1.0
    with on_cpu():
        mixture = interaction.mix(field.kernel, axes, interaction.prepare(field.kernel, axes, np.float32))
        response = np.asarray(interaction.apply(mixture, axes, jnp.asarray(single)))
    line = response[tuple(slice(None) if k == d else i for k, i in enumerate(middle))]
    peak, right = float(line[middle[d]]), line[middle[d] :]
    if not peak > 0:
        return None
    below = np.flatnonzero(right < peak / 2)
    if not len(below):
        return None
    i = int(below[0])
    half = i - 1 + (right[i - 1] - peak / 2) / (right[i - 1] - right[i])
    return float(half) * axes[d].step / math.sqrt(2 * math.log(2))
