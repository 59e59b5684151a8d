"""What spiking networks compute of the rate models that they are made from: selection, detection, forgetting,
memory, rates, in deodar's simulator and in norse.

    python benchmarks/spikes.py run --norse PYTHON   measure all, and write evidence/neuromorphic, 20 min
    python benchmarks/spikes.py run selection        selection, events, thresholds, memory, rates, readers or
                                                     speed
    python benchmarks/spikes.py pages                write tables and figures of docs/neuromorphic.md
    python benchmarks/spikes.py print                print the tables

PYTHON is the interpreter of an environment with norse. Without it, measures of norse are kept where all other
values of their row are as they were.
"""

from __future__ import annotations

import argparse
import dataclasses
import datetime
import functools
import itertools
import json
import re
import subprocess
import sys
import time
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT))

from tests.deodar_spikes.scenes import (  # noqa: E402
    DETECTOR,
    GRADED,
    MEMORY,
    RADIUS,
    Pairs,
    Targets,
    bistable,
    chosen,
    pairs,
    targets,
    winner_take_all,
)

import deodar as dd  # noqa: E402
from deodar.analysis.statistics import wilson  # noqa: E402
from deodar.architectures.looking import retina  # noqa: E402
from deodar.recording.provenance import machine  # noqa: E402
from deodar_spikes.build import build  # noqa: E402
from deodar_spikes.chip_limits import chip_limits  # noqa: E402
from deodar_spikes.comparison import compare_spikes  # noqa: E402
from deodar_spikes.fitting import fit  # noqa: E402
from deodar_spikes.graph import NirGraph  # noqa: E402
from deodar_spikes.mismatch import chip, differing  # noqa: E402
from deodar_spikes.norse import norse_version, run_norse  # noqa: E402
from deodar_spikes.prepare import SpikingOptions  # noqa: E402
from deodar_spikes.running import NetworkInput, network_input, rates  # noqa: E402
from deodar_spikes.simulator import SpikingSimulator  # noqa: E402
from deodar_spikes.translate import translate  # noqa: E402

FOLDER = ROOT / "evidence" / "neuromorphic"
PAGE = ROOT / "docs" / "neuromorphic.md"
ABOUT, RESULTS = "about.json", "results.json"
MARK = re.compile(r"<!-- spikes ([\w-]+) -->(.*?)<!-- end -->", re.DOTALL)

TRIALS, CHIPS, NEURONS = 200, 10, 20
STEPS = 800
MISMATCH = (0.0, 0.1, 0.2)
NEAR = 2
"""Cells between winners that count as the same."""

Rows = list[dict[str, Any]]


def spread(share: float, more: Sequence[str] = ()) -> dict[str, float]:
    """Return the mismatch of thresholds and constant currents, and of more parameters."""
    return dict.fromkeys(("v_threshold", "bias", *more), share) if share else {}


def network(
    model: dd.Model, neurons: int = NEURONS, step: float | None = None, tonic: bool = False
) -> NirGraph:
    """Return the graph of a model."""
    return build(translate(model, neurons=neurons, step=step, tonic=tonic).network)


def spikes(
    graph: NirGraph,
    inputs: np.ndarray,
    share: float | Mapping[str, float],
    chips: int,
    every: int,
    seed: int = 1,
) -> np.ndarray:
    """Run a graph, trial k on chip k modulo `chips`; sums of spikes, windows x trials x neurons."""
    trials = inputs.shape[1]
    on = np.arange(trials) % chips
    mismatch = share if isinstance(share, Mapping) else spread(share)
    found = differing(graph, mismatch, chips, seed)
    each = {node: {field: v[on] for field, v in fields.items()} for node, fields in found.items()}
    simulator = SpikingSimulator(graph, copies=trials, differing=each)
    return simulator.run(simulator.start(), inputs, every)[0]


def norse(
    graph: NirGraph, inputs: np.ndarray, share: float, chips: int, every: int, python: str, seed: int = 1
) -> np.ndarray:
    """Run a graph in norse, a file and a process for each chip."""
    trials = inputs.shape[1]
    out = np.empty((len(inputs) // every, trials, graph.nodes["output"].size), np.float32)
    for k in range(chips):
        part = np.arange(k, trials, chips)
        out[:, part] = run_norse(chip(graph, spread(share), seed, k), inputs[:, part], every, python)
    return out


def constant(inputs: np.ndarray, steps: int = STEPS) -> np.ndarray:
    """Return inputs that do not change: steps x trials x cells."""
    return np.broadcast_to(inputs.astype(np.float32), (steps, *inputs.shape)).copy()


# ------------------------------------------------------------------------------------------------- selection


def rate_winners(given: Pairs) -> np.ndarray:
    """Return the winner of the rate model in each trial."""
    out = []
    for s in given.inputs:
        data = dd.simulate(
            winner_take_all(s), 400, record=["pool.output"], every=400, on=dd.Resources(progress=False)
        )
        out.append(int(data["pool.output"].values[-1].argmax()))
    return np.array(out)


def winners(graph: NirGraph, sums: np.ndarray) -> np.ndarray:
    """Return the winner of each trial in the second half of the time."""
    return rates(graph, sums[len(sums) // 2 :], 1)["pool"].mean(0).argmax(-1)


CONDITIONS: dict[str, tuple[float, float, float, str]] = {
    "5 to 30 %, mismatch 0": (0.05, 0.3, 0.0, ""),
    "5 to 30 %, mismatch 10 %": (0.05, 0.3, 0.1, ""),
    "5 to 30 %, mismatch 20 %": (0.05, 0.3, 0.2, ""),
    "3 %, mismatch 10 %": (0.03, 0.03, 0.1, ""),
    "5 to 30 %, weights of 8 bits": (0.05, 0.3, 0.0, "digital-8-bit"),
    "5 %, mismatch 10 %": (0.05, 0.05, 0.1, ""),
    "5 %, mismatch 20 %": (0.05, 0.05, 0.2, ""),
    "5 %, mismatch 20 %, 40 neurons of a cell": (0.05, 0.05, 0.2, "40 neurons"),
    "5 %, mismatch 20 %, 80 neurons of a cell": (0.05, 0.05, 0.2, "80 neurons"),
    "control: mismatch 50 %": (0.05, 0.3, 0.5, ""),
    "control: no inhibition": (0.05, 0.3, 0.0, "no inhibition"),
}
"""Differences of the inputs, mismatch, and what else is changed."""


def selection(python: str) -> Rows:
    """Whether the winner is that of the rate model; norse on 10 chips, deodar on 10 and on 200."""
    rows: Rows = []
    for name, (least, most, share, change) in CONDITIONS.items():
        given = pairs(TRIALS, least, most)
        wanted = rate_winners(given)
        neurons = int(change.split()[0]) if change.endswith("neurons") else NEURONS
        graph = network(winner_take_all(given.inputs[0], 0.0 if change == "no inhibition" else 1.0), neurons)
        if change == "digital-8-bit":
            graph = fit(graph, chip_limits(change)).graph
        inputs = constant(given.inputs)
        chips = CHIPS if share else 1
        few = spikes(graph, inputs, share, chips, STEPS // 4)
        many = spikes(graph, inputs, share, TRIALS if share else 1, STEPS // 4)
        row = {
            "condition": name,
            "of": TRIALS,
            "deodar": _same(winners(graph, few), wanted),
            "deodar, a chip for each trial": _same(winners(graph, many), wanted),
        }
        if python:
            row["norse"] = _same(
                winners(graph, norse(graph, inputs, share, chips, STEPS // 4, python)), wanted
            )
        rows.append(row)
        print(row, flush=True)
    return rows


def _same(found: np.ndarray, wanted: np.ndarray) -> int:
    return int((np.abs(found - wanted) <= NEAR).sum())


# ------------------------------------------------------------------------------------ selection among events

TARGETS, CELL = 100, 10
"""Trials, half of them with the more salient target on either side, and neurons of a cell."""

SHARES = (0.8, 0.9, 0.95, 0.98, 1.0)
"""Contrast of the other target, as a share of that of the target."""


def events(python: str) -> Rows:
    """Which of two blinking targets the field in front of the event camera selects, as rates and as spikes.

    The parameters of the model were found with other places and other events (seeds 1 and 0).
    """
    del python
    rows: Rows = []
    cases = [(s, m, True, False) for s in SHARES for m in MISMATCH]
    cases += [(0.95, 0.2, True, True), (0.98, 0.2, True, True), (0.8, 0.0, False, False)]
    for share, mismatch, selects, tonic in cases:
        model = dd.architectures.event_selection(**({} if selects else {"inhibition": 0.0}))
        given = targets(TARGETS, share, seed=11)
        options = SpikingOptions(neurons=CELL, mismatch=mismatch, seed=5, tonic=tonic)
        found = compare_spikes(model, 1000, TARGETS, options, given.world, norse=False)
        same = found.estimates["perceptual"]["spikes"]["winner"]
        row: dict[str, Any] = {
            "share": share,
            "events": event_share(given, options.seed),
            "mismatch": mismatch,
            "inhibition": selects,
            "tonic": tonic,
            "of": TARGETS,
            "wanted": same.n,
            "same": round(same.value * same.n),
        }
        for run, outputs in found.runs.items():
            one, other = chosen(outputs["perceptual"][-20:].mean(0), given)
            row[run] = {
                "target": int((one & ~other).sum()),
                "other": int((other & ~one).sum()),
                "both": int((one & other).sum()),
            }
        rows.append(row)
        print(row, flush=True)
    return rows


def event_share(given: Targets, seed: int) -> float:
    """Return the number of events of the other target, as a share of those of the target."""
    model = dd.Model("counts", dt=10)
    plane = list(retina(128))
    model.add(dd.Sensor("events", plane, sensor="events"))
    data = dd.simulate(
        model,
        500,
        seed=seed,
        record="events.output",
        every=10,
        trials=10,
        world=given.world,
        on=dd.Resources(progress=False),
    )
    rates = data["events.output"].mean("time").values
    pixels = np.stack(np.meshgrid(plane[0].points, plane[1].points, indexing="ij"), -1)
    near = [
        np.linalg.norm(pixels - p[:10, None, None], axis=-1) <= RADIUS + 1
        for p in (given.places, given.others)
    ]
    return float(rates[near[1]].sum() / rates[near[0]].sum())


# ----------------------------------------------------------------------------------- detection and forgetting

ROUNDS = 9
DETECTOR_REST, LOWER = -5.0, 0.8
"""Resting level of the field, and by how much it is lower in the rows that try this as a remedy."""


def bisected(active: Callable[[np.ndarray], np.ndarray], low: float, high: float, copies: int) -> np.ndarray:
    """Return, for each copy, the strength from which on it is active."""
    a, b = np.full(copies, low), np.full(copies, high)
    for _ in range(ROUNDS):
        middle = (a + b) / 2
        on = active(middle)
        a, b = np.where(on, a, middle), np.where(on, middle, b)
    return (a + b) / 2


def profile(strength: np.ndarray, cells: int = 31) -> np.ndarray:
    """Return localised inputs of some strengths: copies x cells."""
    return strength[:, None] * np.exp(-((np.arange(cells) - cells // 2) ** 2) / 8)[None]


BEFORE, AFTER = 400, 2000
"""Steps of the first input, and of the one whose strength is varied."""


def first_input(what: str, strength: np.ndarray) -> np.ndarray:
    """Return the strength of the first input: one that makes a peak, for forgetting."""
    return np.full_like(strength, 10.0 if what == "forgetting" else 0.0)


def rate_active(what: str, strength: np.ndarray) -> np.ndarray:
    """Return whether the rate model has a peak at the end."""
    out = []
    for s in strength[:, None]:
        model = bistable(DETECTOR, np.concatenate([profile(first_input(what, s)), profile(s)]))
        duration = (BEFORE + AFTER) / 2
        data = dd.simulate(
            model, duration, record=["u.output"], every=duration, on=dd.Resources(progress=False)
        )
        out.append(data["u.output"].values[-1].max() > 0.5)
    return np.array(out)


def spikes_active(
    graph: NirGraph, mismatch: Mapping[str, float], what: str, strength: np.ndarray
) -> np.ndarray:
    """Return whether the neurons have a peak at the end, each strength on a chip of its own."""
    settling = round(graph.settling / graph.step)
    parts = (
        (np.zeros_like(strength), settling),
        (first_input(what, strength), BEFORE),
        (strength, AFTER),
    )
    inputs = np.concatenate([np.repeat(profile(s)[None], n, 0) for s, n in parts]).astype(np.float32)
    sums = spikes(graph, inputs, mismatch, len(strength), 20)
    return rates(graph, sums[-5:], 20)["u"].mean(0).max(-1) > 0.5


def thresholds(python: str) -> Rows:
    """Inputs of detection and of forgetting: of rates, and of spikes on 200 chips.

    Forgetting: an input of 10 makes a peak, then a weaker one follows; the threshold is the weakest that
    keeps the peak.
    """
    del python
    rows: Rows = []
    model, lower = (bistable(DETECTOR, np.zeros((1, 31))) for _ in range(2))
    lower.set("u.resting_level", DETECTOR_REST - LOWER)
    all_of_them = [*((m, ()) for m in MISMATCH), (0.2, ("w_in",))]
    cases = {
        "constant current": (network(model), all_of_them),
        f"constant current, {LOWER} lower": (network(lower), [(0.2, ())]),
        "constant current, 80 neurons of a cell": (network(model, 80), [(0.2, ())]),
        "tonic neurons": (network(model, tonic=True), all_of_them),
    }
    for what, resting in itertools.product(("detection", "forgetting"), cases):
        wanted = float(bisected(functools.partial(rate_active, what), 0.0, 10.0, 1)[0])
        graph, variants = cases[resting]
        for mismatch, more in variants:
            copies = TRIALS if mismatch else 1
            active = functools.partial(spikes_active, graph, spread(mismatch, more), what)
            found = bisected(active, 0.0, 10.0, copies)
            row = {
                "what": what,
                "resting": resting,
                "mismatch": mismatch,
                "more": list(more),
                "rates": wanted,
                "spikes": float(found.mean()),
                "sd": float(found.std(ddof=1)) if copies > 1 else 0.0,
                "chips": copies,
            }
            rows.append(row)
            print(row, flush=True)
    return rows


# ----------------------------------------------------------------------------------------------------- memory


def memory(python: str) -> Rows:
    """A peak 2 s after its input, which is at another place in each trial; norse on 10 chips."""
    graph = network(bistable(MEMORY, np.zeros((1, 31))))
    settling, on, after, every = round(graph.settling / graph.step), 400, 4000, 40
    places = np.random.default_rng(1).uniform(7, 23, TRIALS)
    cues = 8 * np.exp(-((np.arange(31) - places[:, None]) ** 2) / 8)
    inputs = np.zeros((settling + on + after, TRIALS, 31), np.float32)
    inputs[settling : settling + on] = cues
    at = (settling + on) // every
    rows: Rows = []
    for mismatch in MISMATCH:
        chips = TRIALS if mismatch else 1
        out = rates(graph, spikes(graph, inputs, mismatch, chips, every), every)["u"]
        row = _memory_row(out, at, mismatch, chips)
        if python:
            few = CHIPS if mismatch else 1
            other = rates(graph, norse(graph, inputs, mismatch, few, every, python), every)["u"]
            row["norse"] = _memory_row(other, at, mismatch, few)
        rows.append(row)
        print(row, flush=True)
    return rows


def _memory_row(out: np.ndarray, at: int, share: float, chips: int) -> dict[str, Any]:
    """Whether the peak stays, and how far it drifts, in cells."""
    points = np.arange(out.shape[-1])
    first, last = out[at - 3 : at].mean(0), out[-3:].mean(0)
    stays = last.max(-1) > 0.5
    place = [np.sum(v * points, -1) / np.maximum(v.sum(-1), 1e-9) for v in (first, last)]
    drift = (place[1] - place[0])[stays]
    return {
        "mismatch": share,
        "chips": chips,
        "of": len(stays),
        "stays": int(stays.sum()),
        "drift sd": float(drift.std()),
        "drift most": float(np.abs(drift).max(initial=0.0)),
    }


# ----------------------------------------------------------------------------------------------------- rates


def rates_of_neurons(python: str) -> Rows:
    """Difference between the rate model and spikes in windows of 5 ms, by the number of neurons of a cell."""
    del python
    rows: Rows = []
    given = pairs(20)
    cues = profile(np.full(20, 8.0))
    models: dict[str, tuple[Callable[[np.ndarray], dd.Model], np.ndarray, str]] = {
        "semi-linear": (winner_take_all, given.inputs, "pool"),
        "logistic": (lambda s: bistable(GRADED, s[None]), cues, "u"),
    }
    targets = {
        name: np.array([final(make(s), label) for s in inputs])
        for name, (make, inputs, label) in models.items()
    }
    for neurons in (2, 5, 10, 20, 40, 80):
        row: dict[str, Any] = {"neurons": neurons}
        for name, (make, inputs, label) in models.items():
            graph, target = network(make(inputs[0]), neurons), targets[name]
            for mismatch in (0.0, 0.1):
                sums = spikes(graph, constant(inputs), mismatch, len(inputs) if mismatch else 1, 10)
                out = rates(graph, sums[len(sums) // 2 :], 10)[label]
                error = float(np.sqrt(np.mean((out - target) ** 2)) / target.max())
                row[f"{name}, mismatch {mismatch:.0%}"] = error
        rows.append(row)
        print(row, flush=True)
    return rows


def final(model: dd.Model, label: str) -> np.ndarray:
    """Return the output of the rate model after 400 ms."""
    data = dd.simulate(model, 400, record=[f"{label}.output"], every=400, on=dd.Resources(progress=False))
    return data[f"{label}.output"].values[-1]


# ---------------------------------------------------------------------------------------------------- readers


def coupled() -> dd.Model:
    """Two fields with noise that excite each other, at different time constants."""
    model = dd.Model("coupled", dt=0.5)
    x = dd.Axis("x", 0, 20, samples=21)
    kernel = [dd.Gaussian(12, 2, normalized=True), dd.Gaussian(-6, 5, normalized=True)]
    for name, tau in (("u", 20.0), ("v", 8.0)):
        model.add(dd.Field(name, [x], tau, -4.0, kernel=kernel, global_inhibition=0.1, noise=0.5))
    model["u"] >> model.add(dd.Gain(4.0, name="up")) >> model["v"]
    model["v"] >> model.add(dd.Gain(1.0, name="down")) >> model["u"]
    cue = dd.GaussianStimulus("cue", [x], center=8, sigma=2, amplitude=6, windows=[(50, 300)])
    model.add(cue) >> model["u"]
    return model


def readers(python: str) -> Rows:
    """Spikes of deodar and of norse, neuron by neuron and step by step."""
    if not python:
        return []
    given = pairs(20)
    cases: dict[str, tuple[NirGraph, np.ndarray]] = {}
    graph = network(winner_take_all(given.inputs[0]))
    cases["winner-take-all"] = graph, constant(given.inputs)
    graph = network(bistable(DETECTOR, np.zeros((1, 31))))
    cases["detection"] = graph, constant(profile(np.linspace(1, 10, 20)))
    model = coupled()
    translated = translate(model)
    graph = build(translated.network)
    noise: NetworkInput = network_input(translated, graph, 400)
    [inputs] = noise.pieces(10, 0, len(noise.analog))
    cases["two fields with noise"] = graph, inputs
    rows: Rows = []
    for name, (graph, inputs) in cases.items():
        for mismatch in MISMATCH:
            ours = spikes(graph, inputs, mismatch, 1, 1)
            theirs = norse(graph, inputs, mismatch, 1, 1, python)
            differ = ours != theirs
            first = np.flatnonzero(differ.any((1, 2)))
            row = {
                "case": name,
                "mismatch": mismatch,
                "compared": int(differ.size),
                "differ": int(differ.sum()),
                "first step": int(first[0]) if len(first) else None,
                "copies": int(differ.any((0, 2)).sum()),
                "of": ours.shape[1],
            }
            if len(first):
                row["distance"] = distance(chip(graph, spread(mismatch), 1), inputs, first[0], differ)
            rows.append(row)
            print(row, flush=True)
    return rows


def distance(graph: NirGraph, inputs: np.ndarray, step: int, differ: np.ndarray) -> float:
    """Return how far potentials are from the threshold where spikes first differ, in double precision: the
    largest distance, as a share of the threshold.
    """
    simulator = SpikingSimulator(graph, copies=inputs.shape[1])
    _, state = simulator.run(simulator.start(), inputs[:step])
    nodes, before = graph.nodes, state.values["neurons"]
    drive, synapses, p = nodes["drive"], nodes["synapses"], nodes["neurons"]
    x = inputs[step].astype(float) @ drive.weight.T.astype(float) + drive.bias
    x += np.asarray(before["out"], float) @ synapses.weight.T.astype(float)
    current = np.asarray(before["current"], float)
    current += graph.step / p.tau_syn.astype(float) * (x - current)
    v = np.asarray(before["potential"], float)
    v += graph.step / p.tau_mem.astype(float) * (current - v)
    apart = np.abs(v - p.v_threshold) / p.v_threshold
    return float(apart[differ[step]].max())


# ------------------------------------------------------------------------------------------------------ speed


def speed(python: str) -> Rows:
    """Time of 100 trials of 400 ms, and what another step than the file's does."""
    given = pairs(100)
    graph = network(winner_take_all(given.inputs[0]))
    simulator = SpikingSimulator(graph, copies=100)
    inputs = constant(given.inputs)
    took = []
    for _ in range(6):  # the first one compiles
        began = time.perf_counter()
        simulator.run(simulator.start(), inputs, STEPS)
        took.append(time.perf_counter() - began)
    rows: Rows = [{"what": "100 trials of 400 ms", "first": took[0], "median": float(np.median(took[1:]))}]
    for step in (0.5e-3, 1e-3):
        steps = round(0.4 / step)
        coarse = SpikingSimulator(dataclasses.replace(graph, step=step), copies=20)
        sums, _ = coarse.run(coarse.start(), constant(given.inputs[:20], steps), steps // 2)
        cells = sums[1][:, :600].reshape(20, 30, 20).mean(-1).max(-1)
        rows.append({"what": f"peak rate at {step * 1e3:g} ms", "Hz": float(np.mean(cells / 0.2))})
    del python
    print(rows, flush=True)
    return rows


PARTS: dict[str, Callable[[str], Rows]] = {
    "selection": selection,
    "events": events,
    "thresholds": thresholds,
    "memory": memory,
    "rates": rates_of_neurons,
    "readers": readers,
    "speed": speed,
}


# --------------------------------------------------------------------------------------- tables and figures


def share(hits: int, n: int) -> str:
    """Return a share with its interval."""
    interval = wilson(hits, n)
    assert interval is not None
    return f"{hits} of {n} ({100 * interval[0]:.1f} to {100 * interval[1]:.1f} %)"


def table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """Return a table in Markdown."""
    lines = ["| " + " | ".join(cells) + " |" for cells in [head, ["---"] * len(head), *rows]]
    return "\n\n" + "\n".join(lines) + "\n\n"


def texts(found: Mapping[str, Rows], about: Mapping[str, Any]) -> dict[str, str]:
    """Return every table and number of the page."""
    out: dict[str, str] = {}
    rows = found["selection"]
    names = ("deodar", "deodar, a chip for each trial", "norse")
    out["selection"] = table(
        ["inputs and network", *(f"same winner, {n}" for n in names)],
        [[r["condition"], *(share(r[n], r["of"]) if n in r else "not run" for n in names)] for r in rows],
    )
    out["events"] = table(
        [
            "contrast of the other target",
            "its events",
            "mismatch",
            "rates select the target",
            "spikes select the target",
            "the same one",
        ],
        [_event_cells(r) for r in found["events"]],
    )
    out["thresholds"] = table(
        ["", "resting level", "mismatch", "rates", "spikes", "difference", "sd between chips"],
        [
            [
                r["what"],
                r["resting"],
                f"{r['mismatch']:.0%}{', of w_in too' if r['more'] else ''}",
                f"{r['rates']:.2f}",
                f"{r['spikes']:.2f}",
                f"{r['spikes'] / r['rates'] - 1:+.1%}",
                f"{r['sd']:.2f}",
            ]
            for r in found["thresholds"]
        ],
    )
    out["memory"] = table(
        ["mismatch", "the peak stays", "sd of the drift (cells)", "largest drift", "the peak stays, norse"],
        [
            [
                f"{r['mismatch']:.0%}",
                share(r["stays"], r["of"]),
                f"{r['drift sd']:.2f}",
                f"{r['drift most']:.2f}",
                share(r["norse"]["stays"], r["norse"]["of"]) if "norse" in r else "not run",
            ]
            for r in found["memory"]
        ],
    )
    kinds = [k for k in found["rates"][0] if k != "neurons"]
    out["rates"] = table(
        ["neurons of a cell", *kinds],
        [[str(r["neurons"]), *(f"{r[k]:.1%}" for k in kinds)] for r in found["rates"]],
    )
    out["readers"] = table(
        [
            "network",
            "mismatch",
            "compared (neuron, step)",
            "different",
            "trials with a difference",
            "distance",
        ],
        [
            [
                r["case"],
                f"{r['mismatch']:.0%}",
                f"{r['compared']:,}",
                f"{r['differ']:,} ({r['differ'] / r['compared']:.4%})",
                f"{r['copies']} of {r['of']}",
                f"{r['distance']:.0e}" if "distance" in r else "",
            ]
            for r in found["readers"]
        ],
    )
    timed, *peaks = found["speed"]
    out["speed"] = f"{timed['median']:.1f} s"
    out["step"] = " and ".join(f"{r['Hz']:.0f} Hz at {r['what'].rpartition(' at ')[2]}" for r in peaks)
    made = about["made_by"]
    out["made"] = ", ".join(f"{k} {v}" for k, v in made.items() if k != "commit")
    return out


def _event_cells(row: Mapping[str, Any]) -> list[str]:
    """Return the cells of a row of the table of events."""
    found = [share(row[run]["target"], row["of"]) for run in ("rates", "spikes")]
    if row["share"] == 1:  # neither is more salient
        found = [f"{row[run]['target']}, the other one {row[run]['other']}" for run in ("rates", "spikes")]
    if not row["inhibition"]:
        found = [f"{f}; both: {row[run]['both']}" for f, run in zip(found, ("rates", "spikes"), strict=True)]
    name = f"{row['share']:.0%}" if row["inhibition"] else f"control: no inhibition, {row['share']:.0%}"
    same = share(row["same"], row["wanted"]) if row["inhibition"] else "none"
    mismatch = f"{row['mismatch']:.0%}{', tonic neurons' if row['tonic'] else ''}"
    return [name, f"{row['events']:.0%}", mismatch, *found, same]


def figure(rows: Rows) -> None:
    """Draw the error over the number of neurons."""
    from matplotlib.figure import Figure

    with dd.figures._style.style():  # type: ignore[attr-defined]
        drawn = Figure(figsize=(3.5, 2.4), layout="constrained")
        ax = drawn.subplots()
        n = [r["neurons"] for r in rows]
        for k, name in enumerate(key for key in rows[0] if key != "neurons"):
            ax.plot(
                n, [100 * r[name] for r in rows], "o-", color=dd.figures.COLORS[k], label=name, markersize=3
            )
        ax.axhline(5, **dd.figures.THRESHOLD_LINE)
        ax.set_xscale("log")
        ax.set_xticks(n, labels=[str(v) for v in n])
        ax.minorticks_off()
        ax.set(xlabel="neurons of a cell", ylabel="rms difference (% of the peak)")
        ax.set_ylim(bottom=0)
        ax.legend()
    picture = ROOT / "docs" / "pictures" / "neuromorphic-error.png"
    dd.figures.save_figure(drawn, picture, force=True, dots=130)


def filled(text: str, known: Mapping[str, str]) -> str:
    """Return a page with every table and number as the results have it."""
    return MARK.sub(lambda m: f"<!-- spikes {m[1]} -->{known[m[1]]}<!-- end -->", text)


def read() -> tuple[dict[str, Rows], dict[str, Any]]:
    """Return the stored rows, and what made them."""
    if not (FOLDER / RESULTS).exists():
        return {}, {}
    return (
        json.loads((FOLDER / RESULTS).read_text(encoding="utf-8")),
        json.loads((FOLDER / ABOUT).read_text(encoding="utf-8")),
    )


def pages() -> None:
    """Write the page and its figure."""
    found, about = read()
    figure(found["rates"])
    PAGE.write_text(filled(PAGE.read_text(encoding="utf-8"), texts(found, about)), encoding="utf-8")


def kept(new: Rows, old: Rows) -> Rows:
    """Return new rows with the measures of norse of the old rows that are equal otherwise."""
    measured = [
        (row["norse"], {k: v for k, v in row.items() if k != "norse"}) for row in old if "norse" in row
    ]
    for row in new:
        same = [value for value, rest in measured if rest == row]
        if "norse" not in row and same:
            row["norse"] = same[0]
    return new


def main() -> int:
    """Measure, write, or print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("what", choices=("run", "pages", "print"))
    parser.add_argument("parts", nargs="*", metavar="PART", help=", ".join(PARTS))
    parser.add_argument("--norse", default="", metavar="PYTHON")
    args = parser.parse_args()
    if args.what == "pages":
        pages()
        return 0
    found, about = read()
    if args.what == "print":
        print("\n".join(f"{name}: {text}" for name, text in texts(found, about).items()))
        return 0
    version = norse_version(args.norse) if args.norse else ""
    for name in args.parts or PARTS:
        began = time.perf_counter()
        new = PARTS[name](args.norse if version else "")
        if new:
            found[name] = kept(new, found.get(name, []))
        print(f"{name}: {time.perf_counter() - began:.0f} s", flush=True)
    commit = subprocess.run(["git", "rev-parse", "HEAD"], capture_output=True, text=True, cwd=ROOT).stdout
    about = {
        "what": "spiking networks beside rate models; python benchmarks/spikes.py run --norse PYTHON",
        "made_by": {
            "deodar": dd.__version__,
            "norse": version or about.get("made_by", {}).get("norse", ""),
            "numpy": np.__version__,
            "commit": commit.strip()[:12],
            "date": str(datetime.date.today()),
            "machine": machine(),
        },
    }
    FOLDER.mkdir(parents=True, exist_ok=True)
    (FOLDER / RESULTS).write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")
    (FOLDER / ABOUT).write_text(json.dumps(about, indent=2) + "\n", encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
