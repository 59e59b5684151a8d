"""The rate model and its network of neurons side by side, in the same measures of each trial.

All measures read outputs alone, so that rates and spikes are measured alike. A cell is active while its
output is above half of `level`, the largest output of the rate model.
"""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from deodar.analysis.peaks import peaks
from deodar.analysis.statistics import mean_interval, wilson
from deodar.batch.simulate import simulate
from deodar.codec import Json
from deodar.errors import ParameterError, instance_of, option
from deodar.model.model import Model
from deodar.numerics.axes import Axes, shape
from deodar.resources import Resources
from deodar.summary import Summarised, Summary
from deodar.worlds._base import World
from deodar_spikes.norse import norse_version
from deodar_spikes.prepare import Prepared, SpikingOptions, prepare
from deodar_spikes.running import NetworkInput, Rates, SpikingTrials, in_norse, network_input, simulated

Each = NDArray[np.float64]


@dc.dataclass(frozen=True)
class FieldOutcomes:
    """Measures of a field, one value for each trial; NaN where there is none.

    Attributes:
        winner: index of the cell with the largest output in the last quarter of the time with input.
        peaks: number of peaks then.
        detection: time from the start of the input until a cell is active.
        forgetting: time from the end of the input until no cell is active.
        memory: whether a cell is active at the end of the run, without input (1 or 0).
        drift: distance from the peak at the end of the input to that at the end of the run, in axis units, on
            the first axis.
    """

    winner: Each
    peaks: Each
    detection: Each
    forgetting: Each
    memory: Each
    drift: Each


def outcomes(
    outputs: NDArray[np.float32], axes: Axes, on: NDArray[np.bool_], window: float, level: float
) -> FieldOutcomes:
    """Measure the outputs of a field.

    Args:
        outputs: windows x trials x cells.
        axes: axes of the cells.
        on: whether an input is on, for each window.
        window: length of a window, document time.
        level: largest output of the rate model.
    """
    trials = outputs.shape[1]
    none = np.full(trials, np.nan)
    active = outputs.max(-1) > level / 2
    found = FieldOutcomes(none, none, none, none, none, none)
    if not on.any():
        return found
    first, last = int(np.argmax(on)), int(len(on) - np.argmax(on[::-1]))
    with_input = outputs[last - max(1, (last - first) // 4) : last].mean(0)
    seen = with_input.max(-1) > level / 2
    winner = np.where(seen, with_input.argmax(-1), np.nan)
    number = np.array([_count(v, axes, level) for v in with_input], float)
    detection = np.where(active[first:].any(0), (active[first:].argmax(0) + 0.5) * window, np.nan)
    found = dc.replace(found, winner=winner, peaks=number, detection=detection)
    if last == len(on):
        return found
    after = active[last:]
    gone = np.where(seen & ~after.all(0), ((~after).argmax(0) + 0.5) * window, np.nan)
    stays = after[-max(1, len(after) // 20) :].all(0)
    gone = np.where(stays, np.nan, gone)
    memory = np.where(seen, stays.astype(float), np.nan)
    end = outputs[-max(1, len(after) // 20) :].mean(0)
    drift = np.array(
        [
            _place(b, axes, level) - _place(a, axes, level) if s else np.nan
            for a, b, s in zip(with_input, end, stays & seen, strict=True)
        ]
    )
    if axes and axes[0].periodic:
        drift = (drift + axes[0].range / 2) % axes[0].range - axes[0].range / 2
    return dc.replace(found, forgetting=gone, memory=memory, drift=drift)


def _count(values: NDArray[np.float32], axes: Axes, level: float) -> int:
    return len(peaks(values.reshape(shape(axes)), axes, level / 2))


def _place(values: NDArray[np.float32], axes: Axes, level: float) -> float:
    """Return the position of the highest peak on the first axis."""
    found = peaks(values.reshape(shape(axes)), axes, level / 2)
    return found[0].position[0] if len(found) and found[0].position else np.nan


WINDOW = 5e-3
"""Length of a window in which spikes are counted, in s, about."""

NEAR = 0.05
"""Distance of a winner from that of the rate model, as a share of the cells, up to which it is the same."""

CHIPS = 10


@dc.dataclass(frozen=True)
class Estimate:
    """A mean or a share with its 95 % interval, and the number of trials that have a value."""

    value: float
    interval: tuple[float, float] | None
    n: int


@dc.dataclass(frozen=True, repr=False)
class SpikingComparison(Summarised):
    """The result of a comparison.

    Attributes:
        prepared: the network, the chip and the report.
        given: the input of the network.
        every: steps of a window.
        runs: outputs by the name of what computed them: `rates`, `spikes`, `norse`; windows x trials x cells
            for each element.
        estimates: by element and by name of what computed it, each measure.
        norse: version of norse; "" if it is not installed.
    """

    prepared: Prepared
    given: NetworkInput
    every: int
    runs: Mapping[str, Rates]
    estimates: Mapping[str, Mapping[str, Mapping[str, Estimate]]]
    norse: str

    @property
    def times(self) -> NDArray[np.float64]:
        """Middle of each window, document time from the start of the run."""
        network = self.prepared.translated.network
        window = self.every * network.step / network.unit
        count = len(next(iter(self.runs["rates"].values())))
        return np.asarray((np.arange(count) + 0.5) * window, np.float64)

    def data(self) -> dict[str, Json]:
        """Return plain data, for JSON."""
        return {
            "neurons": self.prepared.translated.network.neurons,
            "synapses": self.prepared.translated.network.synapses,
            "norse": self.norse,
            "elements": {
                label: {
                    run: {
                        name: {
                            "value": None if np.isnan(e.value) else e.value,
                            "interval": None if e.interval is None else list(e.interval),
                            "n": e.n,
                        }
                        for name, e in measures.items()
                    }
                    for run, measures in estimates.items()
                }
                for label, estimates in self.estimates.items()
            },
        }

    def _summary(self) -> Summary:
        network = self.prepared.translated.network
        rows = [
            (label, run, name, e.value)
            for label, runs in self.estimates.items()
            for run, measures in runs.items()
            for name, e in measures.items()
        ]
        return Summary(f"Spikes beside rates: {network.neurons} neurons, {network.synapses} synapses", rows)


def compare_spikes(
    model: Model,
    duration: float,
    trials: int = 100,
    options: SpikingOptions | None = None,
    world: World | None = None,
    norse: str | Path | bool = True,
) -> SpikingComparison:
    """Run a model as rates and as spikes, and measure both.

    With a world, each trial has events, pictures and rows of the world of its own, and rates and spikes of a
    trial have the same ones. The winner of each trial is then compared with that of the same trial of the
    rate model, else with the most frequent one.

    Args:
        model: the model.
        duration: document time.
        trials: number of trials; trial k runs on chip k modulo 10, if neurons differ.
        options: neurons, step, chip, mismatch, tonic neurons and seed.
        world: the world that its sensors read.
        norse: whether norse runs it too, where it is installed; or the Python of an environment that has it.

    Raises:
        ParameterError: there are no trials.
    """
    if trials < 1:
        raise ParameterError(f"{trials} trials", fix=option("Give 1 or more:", "trials", "100"))
    settings = SpikingOptions() if options is None else instance_of(SpikingOptions, options, "options")
    prepared = prepare(model, model.document.name, settings)
    network, graph = prepared.translated.network, prepared.fitted.graph
    every = max(1, round(WINDOW / network.step))
    many = None if world is None else trials
    inputs = network_input(prepared.translated, graph, duration, world, many, settings.seed)
    chips = min(trials, CHIPS) if any(prepared.spread.values()) else 1
    sampling = SpikingTrials(trials, every, prepared.spread, chips, settings.seed)
    step = network.step / network.unit
    windows = (len(inputs.analog) - inputs.settling) // every
    runs = {
        "rates": _rate_model(model, prepared, windows, every * step, trials, settings.seed, world),
        "spikes": simulated(graph, inputs, sampling),
    }
    python = None if isinstance(norse, bool) else norse
    version = norse_version(python) if norse else ""
    if version:
        runs["norse"] = in_norse(graph, inputs, sampling, python)
    axes = {p.label: p.axes for p in network.populations if p.probed}
    on = np.asarray(inputs.on[: windows * every].reshape(windows, every).any(1))
    estimates = {
        label: _estimates(
            {run: r[label] for run, r in runs.items()}, axes[label], on, every * step, world is not None
        )
        for label in runs["spikes"]
    }
    return SpikingComparison(prepared, inputs, every, runs, estimates, version)


def _rate_model(
    model: Model,
    prepared: Prepared,
    windows: int,
    window: float,
    trials: int,
    seed: int,
    world: World | None,
) -> Rates:
    """Run the model itself; its outputs in the middle of each window."""
    labels = [p.label for p in prepared.translated.network.populations if p.probed]
    many = world is not None or any(e.element.noise_axes() is not None for e in model.document.entries)
    dt = model.document.step
    record = simulate(
        model,
        -(-windows * window // dt) * dt,
        seed=seed,
        record=[f"{label}.output" for label in labels],
        every=dt,
        trials=trials if many else None,
        world=world,
        on=Resources(progress=False),
    )
    at = np.round((np.arange(windows) + 0.5) * window / dt).astype(int)
    out: dict[str, NDArray[np.float32]] = {}
    for label in labels:
        values = record[f"{label}.output"].values
        values = values if many else values[None]
        values = values[:, np.minimum(at, values.shape[1] - 1)]
        each = np.broadcast_to(values, (trials, *values.shape[1:]))
        out[label] = np.moveaxis(each.reshape(trials, windows, -1), 0, 1).astype(np.float32)
    return out


def _estimates(
    runs: Mapping[str, NDArray[np.float32]], axes: Axes, on: NDArray[np.bool_], window: float, paired: bool
) -> dict[str, dict[str, Estimate]]:
    """Return each measure of an element, for each of the runs.

    With `paired` each trial is compared with that of the rate model, else with all of its trials.
    """
    level = max(float(runs["rates"].max()), 1e-6)
    found = {run: outcomes(values, axes, on, window, level) for run, values in runs.items()}
    winner = found["rates"].winner
    expected = winner if paired else np.full_like(winner, _most(winner))
    mean = runs["rates"] if paired else runs["rates"].mean(1, keepdims=True)
    return {
        run: {
            "winner": _winner(f, expected, axes),
            "peaks": _mean(f.peaks),
            "detection": _mean(f.detection),
            "forgetting": _mean(f.forgetting),
            "memory": _share(f.memory),
            "drift": _mean(np.abs(f.drift)),
            "difference": _mean(np.sqrt(np.mean((runs[run] - mean) ** 2, axis=(0, 2))) / level),
        }
        for run, f in found.items()
    }


def _most(winners: NDArray[np.float64]) -> float:
    """Return the most frequent winner; NaN without one."""
    known = winners[~np.isnan(winners)]
    if not len(known):
        return np.nan
    values, counts = np.unique(known, return_counts=True)
    return float(values[counts.argmax()])


def _winner(outcomes: FieldOutcomes, expected: NDArray[np.float64], axes: Axes) -> Estimate:
    """Return the share of trials with the wanted winner, of those in which one is wanted."""
    known = ~np.isnan(expected)
    sizes = [a.samples for a in axes] or [1]
    places, targets = (
        np.stack(np.unravel_index(np.nan_to_num(v[known]).astype(int), sizes))
        for v in (outcomes.winner, expected)
    )
    apart = np.abs(places - targets)
    for k, axis in enumerate(axes):
        if axis.periodic:
            apart[k] = np.minimum(apart[k], axis.samples - apart[k])
    near = (apart <= np.maximum(1, NEAR * np.array(sizes))[:, None]).all(0) & ~np.isnan(
        outcomes.winner[known]
    )
    return _share(near.astype(float))


def _mean(values: NDArray[np.float64] | Sequence[float]) -> Estimate:
    samples = np.asarray(values, float)
    samples = samples[~np.isnan(samples)]
    if not len(samples):
        return Estimate(np.nan, None, 0)
    return Estimate(float(samples.mean()), mean_interval(samples), len(samples))


def _share(values: NDArray[np.float64]) -> Estimate:
    known = values[~np.isnan(values)]
    if not len(known):
        return Estimate(np.nan, None, 0)
    return Estimate(float(known.mean()), wilson(float(known.sum()), len(known)), len(known))
