"""Random graphs of fields and couplings against plain loops over time: any plan stays near the equations.

A failure shrinks to a small graph, whose document is printed. The ways to apply kernels share the examples
of a property: each has graphs of its own.
"""

from __future__ import annotations

import contextlib
import dataclasses as dc
from collections.abc import Iterator
from typing import Any

import jax
import numpy as np
import pytest
from hypothesis import assume, given, note, settings
from hypothesis import strategies as st

import deodar as dd
from deodar.compiler.build import Build
from deodar.compiler.plan import plan
from deodar.couplings.convolutions import Convolve
from deodar.model.document_files import dumps
from deodar.numerics import choice, interaction
from deodar.numerics.choice import Choice
from deodar.numerics.kernels.separable import Box, MexicanHat
from tests.deodar.compiler.programs import executable
from tests.oracle import fields
from tests.oracle.kernels import dense

BOUNDARIES = ("periodic", "zero", "reflect")
SLOPE = 0.5
"""Steepest slope of the outputs: a logistic function of steepness 2."""


@dc.dataclass
class Link:
    """A coupling from one field to another, with its strength; a gain if it has no kernels."""

    source: int
    target: int
    kernels: list[Any]
    gain: float | None


@dc.dataclass
class Graph:
    """Fields over the same axes, their rates and couplings."""

    axes: list[dd.Axis]
    fields: list[dd.Field]
    every: list[int]
    links: list[Link]

    def model(self) -> tuple[dd.Model, list[Any]]:
        """Return the graph as a model, and for each link the path of its first coupling."""
        model = dd.Model("random graph")
        handles = [model.add(f, ticks=k) for f, k in zip(self.fields, self.every, strict=True)]
        for k, h in enumerate(handles):
            center = [a.lower + (0.2 + 0.15 * k) * (a.upper - a.lower) for a in self.axes]
            (
                model.add(
                    dd.GaussianStimulus(
                        f"s{k}",
                        self.axes,
                        center=center,
                        sigma=[4 * a.step for a in self.axes],
                        amplitude=2.5 + 0.5 * k,
                    )
                )
                >> h
            )
        paths: list[str] = []
        for k, link in enumerate(self.links):
            at = handles[link.source]
            if link.kernels:
                at = at >> Convolve(link.kernels, name=f"c{k}")
            if link.gain:
                at = at >> dd.Gain(link.gain, name=f"g{k}")
            at >> handles[link.target]
            paths.append(f"c{k}" if link.kernels else "")
        note(dumps(model.document)[0])
        return model, paths

    def matrices(self) -> tuple[list[np.ndarray], list[np.ndarray]]:
        """Return the lateral weights of each field (with global inhibition), and the weights of each link."""
        cells, volume = int(np.prod([a.samples for a in self.axes])), fields.volume(self.axes)
        lateral = [
            weights(f.kernel, self.axes) - f.global_inhibition * volume * np.ones((cells, cells))
            for f in self.fields
        ]
        links = [
            (weights(k.kernels, self.axes) if k.kernels else np.eye(cells))
            * (1.0 if k.gain is None else k.gain)
            for k in self.links
        ]
        return lateral, links

    def contractive(self) -> Graph:
        """Return the graph with all strengths scaled so that the loop gain of each field is below 0.8."""
        lateral, links = self.matrices()
        total = [np.abs(m).sum(1).max() for m in lateral]
        for link, m in zip(self.links, links, strict=True):
            total[link.target] += np.abs(m).sum(1).max()
        by = [0.79 / (SLOPE * t) if t > 0 else 1.0 for t in total]
        scaled = [
            dc.replace(
                f,
                kernel=[dc.replace(k, **amplitudes(k, b)) for k in f.kernel],
                global_inhibition=f.global_inhibition * b,
            )
            for f, b in zip(self.fields, by, strict=True)
        ]
        weaker = [
            (
                dc.replace(
                    k, kernels=[dc.replace(w, **amplitudes(w, by[k.target])) for w in k.kernels], gain=k.gain
                )
                if k.kernels
                else dc.replace(k, gain=(k.gain or 1.0) * by[k.target])
            )
            for k in self.links
        ]
        return Graph(self.axes, scaled, self.every, weaker)

    def plainly(self, steps: int) -> np.ndarray:
        """Return the activations of all fields after a number of steps, computed from the equations."""
        lateral, links = self.matrices()
        u = np.array([np.full(lateral[0].shape[0], f.resting_level) for f in self.fields])
        s = [
            fields.stimulus(h.element, 0.0).ravel()
            for h in self.model()[0]
            if isinstance(h.element, dd.GaussianStimulus)
        ]
        waiting = u.copy()
        for tick in range(steps):
            g = 1 / (1 + np.exp(-2.0 * u))
            for k, f in enumerate(self.fields):
                if tick % self.every[k] == 0:
                    arriving = sum(
                        m @ g[c.source] for c, m in zip(self.links, links, strict=True) if c.target == k
                    )
                    drive = f.resting_level + s[k] + lateral[k] @ g[k] + arriving
                    waiting[k] = u[k] + self.every[k] / f.tau * (-u[k] + drive)
            for k in range(len(u)):
                if (tick + 1) % self.every[k] == 0:
                    u[k] = waiting[k]
        return u


def weights(given_kernels: list[Any], axes: list[dd.Axis]) -> np.ndarray:
    """Return all weights between pairs of positions: products of the oracle's weights along each axis."""
    total = np.zeros((int(np.prod([a.samples for a in axes])),) * 2)
    for kernel in given_kernels:
        ends = kernel.boundary or [None] * len(axes)
        for strength, form in parts(kernel):
            along = [form(d, None if b is None else [b]) for d, b in enumerate(ends)]
            along_first = dense([along[0]], axes[:1])
            total += strength * (
                along_first if len(axes) == 1 else np.kron(along_first, dense([along[1]], axes[1:]))
            )
    return total


def parts(kernel: Any) -> list[tuple[float, Any]]:
    """Return the amplitudes of a kernel's parts, and for each its form along one axis."""
    if isinstance(kernel, Box):
        return [(kernel.amplitude, lambda d, b: Box(1.0, kernel.width[d], boundary=b))]
    if isinstance(kernel, MexicanHat):
        return [
            (
                kernel.excitation,
                lambda d, b: dd.Gaussian(1.0, kernel.sigma_excitation[d], normalized=True, boundary=b),
            ),
            (
                -kernel.inhibition,
                lambda d, b: dd.Gaussian(1.0, kernel.sigma_inhibition[d], normalized=True, boundary=b),
            ),
        ]
    return [
        (
            kernel.amplitude,
            lambda d, b: dd.Gaussian(1.0, kernel.sigma[d], normalized=kernel.normalized, boundary=b),
        )
    ]


def amplitudes(kernel: Any, by: float) -> dict[str, float]:
    return {
        name: getattr(kernel, name) * by
        for name in ("amplitude", "excitation", "inhibition")
        if hasattr(kernel, name)
    }


@st.composite
def kernels(draw: Any, axes: list[dd.Axis], most: int) -> list[Any]:
    mixture: list[Any] = []
    for _ in range(draw(st.integers(0 if most > 1 else 1, most))):
        ends = [draw(st.sampled_from(BOUNDARIES)) for _ in axes] if draw(st.booleans()) else None
        width = [draw(st.floats(1.0, 6.0)) * a.step for a in axes]
        strength = draw(st.floats(-2.0, 4.0).filter(lambda v: abs(v) > 0.1))
        form = draw(st.sampled_from(["gaussian", "gaussian", "normalized", "hat", "box"]))
        if form == "hat":
            wide = [2 * w for w in width]
            mixture.append(
                MexicanHat(abs(strength), width, 0.5 * abs(strength), wide, normalized=True, boundary=ends)
            )
        elif form == "box":
            mixture.append(Box(strength / fields.volume(axes) / 20, [4 * w for w in width], boundary=ends))
        else:
            scale = 1.0 if form == "normalized" else 1 / fields.volume(axes) / 20
            mixture.append(
                dd.Gaussian(strength * scale, width, normalized=form == "normalized", boundary=ends)
            )
    return mixture


@st.composite
def graphs(draw: Any) -> Graph:
    shape = draw(st.sampled_from([(40,), (130,), (64,), (24, 20), (33, 16)]))
    sizes = zip("xy", shape, strict=False)
    axes = [
        dd.Axis(n, -1.0, draw(st.sampled_from([10.0, float(k)])), samples=k, periodic=draw(st.booleans()))
        for n, k in sizes
    ]
    count = draw(st.integers(1, 4))
    rates = draw(st.sampled_from([[1, 1, 1, 1], [1, 2, 1, 2], [3, 1, 1, 2]]))[:count]
    drawn = [
        dd.Field(
            f"u{k}",
            axes,
            tau=draw(st.sampled_from([10.0, 25.0])),
            resting_level=-1.0,
            sigmoid=dd.Logistic(2.0),
            kernel=draw(kernels(axes, 2)),
            global_inhibition=draw(st.sampled_from([0.0, 0.002])),
        )
        for k in range(count)
    ]
    links: list[Link] = []
    for _ in range(draw(st.integers(0, 5))):
        mixture = draw(kernels(axes, 1)) if draw(st.integers(0, 3)) else []
        gain = draw(st.sampled_from([None, 0.7, -0.5])) if mixture else draw(st.sampled_from([0.4, -0.6]))
        links.append(Link(draw(st.integers(0, count - 1)), draw(st.integers(0, count - 1)), mixture, gain))
    return Graph(axes, drawn, rates, links)


@contextlib.contextmanager
def dear(strategy: str) -> Iterator[None]:
    """Set costs with which all strategies but the given one are hardly ever chosen."""
    with pytest.MonkeyPatch.context() as patch:
        if strategy:
            patch.setattr(choice, "SMALLEST", 1)
            patch.setattr(choice, "CALL_NS", 0.0)
            patch.setattr(choice, "by_matrices", lambda *arguments: Choice("matrices", (), (), 1e12))
            if strategy != "taps":
                patch.setattr(choice, "_by_taps", lambda *arguments: [])
        if strategy == "taps":
            patch.setattr(choice, "_fourier", lambda *arguments: 1e11)
        if strategy in ("fourier", "taps"):
            patch.setattr(choice, "_transforms", lambda *arguments: 1e11)
            patch.setattr(choice, "LINE_NS", {False: 1e5, True: 1e5})
        choice.choose.cache_clear()
        try:
            yield
        finally:
            choice.choose.cache_clear()


WAYS = ("", "waves", "fourier")
SHARE = settings(max_examples=max(2, settings().max_examples // 4))
"""A quarter of the examples of a property, for each way."""


@pytest.mark.parametrize("strategy", [*WAYS, "taps"])
@SHARE
@given(graph=graphs(), seed=st.integers(0, 9))
def test_every_convolution_strategy_agrees_with_its_matrix(strategy: str, graph: Graph, seed: int) -> None:
    """One application, to 1e-5 of the sum of absolute weights."""
    y = np.random.default_rng(seed).random([a.samples for a in graph.axes]).astype(np.float32)
    convolving = [field.kernel for field in graph.fields] + [link.kernels for link in graph.links]
    assume(any(convolving))
    errors: list[float] = []
    with dear(strategy):
        for given_kernels in filter(None, convolving):
            axes, many = tuple(graph.axes), 1 + 9 * (seed % 2)
            chosen = interaction.choices(given_kernels, axes, many)

            def convolve(y: Any, mixed: Any = given_kernels, axes: Any = axes, chosen: Any = chosen) -> Any:
                mixture = interaction.mix(
                    mixed, axes, interaction.prepare(mixed, axes, np.dtype("float32"), chosen)
                )
                return interaction.apply(mixture, axes, y, chosen)

            output = np.asarray(jax.jit(convolve)(y), float)
            matrices = [weights([k], graph.axes) for k in given_kernels]
            total = sum(np.abs(m).sum(1).max() for m in matrices)
            error = np.abs(output.ravel() - sum(m @ y.ravel().astype(float) for m in matrices)).max()
            errors.append(error / (1e-5 * total + 1e-6))
    assert max(errors) < 1


@pytest.mark.parametrize("strategy", WAYS)
@SHARE
@given(graph=graphs())
def test_contractive_graphs_stay_near_the_equations(strategy: str, graph: Graph) -> None:
    """200 steps without noise, to 1e-4 in activation, as they are run by default."""
    graph = graph.contractive()
    with dear(strategy):
        model, _ = graph.model()
        record = dd.simulate(model, 200)
    expected = graph.plainly(200)
    for k, u in enumerate(expected):
        assert np.abs(record[f"u{k}.activation"].values.ravel() - u).max() < 1e-4


@given(graph=graphs())
def test_random_graphs_in_double_precision_agree_with_numpy_to_1e_9(graph: Graph) -> None:
    """Any graph, 20 steps, to 1e-9 of its largest activation."""
    model, _ = graph.model()
    record, expected = dd.simulate(model, 20, precision="float64"), graph.plainly(20)
    for k, u in enumerate(expected):
        assert np.abs(record[f"u{k}.activation"].values.ravel() - u).max() < 1e-9 * max(
            1.0, np.abs(expected).max()
        )


@settings(max_examples=max(3, settings().max_examples // 2))
@given(graph=graphs())
def test_the_output_of_a_coupling_does_not_depend_on_the_strategy(graph: Graph) -> None:
    """Inputs and outputs of couplings can be read although they are passed as spectral modes."""
    graph = graph.contractive()
    model, paths = graph.model()
    record = [f"{p}.{port}" for p in paths if p for port in ("input", "output")] + [
        f"u{k}.input" for k in range(len(graph.fields))
    ]
    exact = dd.simulate(model, 30, record=record, every=30, precision="float64")
    with dear("waves"):
        model, _ = graph.model()
        recorded = dd.simulate(model, 30, record=record, every=30)
    for path in record:
        assert np.abs(recorded[path].values - exact[path].values).max() < 1e-4


def test_spectral_transforms_are_shared_between_coupled_fields() -> None:
    """The ring of planes: one transform and its inverse for each field, with all couplings in between;
    with a border, and through a gain.
    """
    for periodic in (True, False):
        axes = [dd.Axis(n, 0, 50, samples=50, periodic=periodic) for n in "xy"]
        model = dd.Model("ring")
        ring = [
            model.add(dd.Field(f"u{k}", axes, kernel=[dd.Gaussian(5, 3, normalized=True)])) for k in range(4)
        ]
        for k in range(4):
            ring[k] >> Convolve([dd.Gaussian(1, 3, normalized=True)]) >> dd.Gain(0.5) >> ring[(k + 1) % 4]
        compiled = plan(Build(model.document))
        shares = {type(g.like.element).__name__ for g in compiled.groups if g.strategy.shared}
        assert shares == {"Field", "Convolve", "Gain"} and "waves shared" in compiled.describe()
        assert executable(model, precision="float64").plan.describe().count("waves") == 0, (
            "double precision is exact"
        )
