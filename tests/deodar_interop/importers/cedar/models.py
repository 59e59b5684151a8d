"""Architecture files of cedar, written for tests: every scalar is a text, and keys occur many times."""

from __future__ import annotations

import json
import random
from dataclasses import dataclass, field
from typing import Any

DROP = 4294967295

TYPES = {
    name: f"{place}.{name}"
    for place, names in {
        "cedar.dynamics": (
            "NeuralField Preshape HebbianConnection SpaceToRateCode RateMatrixToSpaceCode "
            "RateToSpaceCode SpaceCodeToRateMatrix HarmonicOscillator SerialOrder"
        ),
        "cedar.processing": (
            "AbsoluteValue ComponentMultiply ConstVector ConvertToValueRange DivideElementwise Flip "
            "Mask MatrixMultiply MatrixPadding MatrixSlice Norm Nullspace Normalization Projection "
            "PseudoInverse RemoveMean Resize ScalarDivision ScalarsToVector StaticGain "
            "SubtractElementwise SynapticConnection TransferFunction Transpose VectorToScalars"
        ),
        "cedar.processing.steps": (
            "AddConstant Clamp ConcatVertically Convolution Count CrossProduct Delay "
            "ExponentialSmoothing HarmonicOscillatorRHS Histogram HopfOscillatorRHS InnerProduct "
            "LinearFunction Logarithm Maximum Minimum NumericalDifferentiation NumericalIntegration "
            "OuterProduct OverTime PositionOfMaximum Sinus Stack Sum Switch Timer VariableBox "
            "VariableGauss"
        ),
        "cedar.processing.sources": (
            "Boost BoxInput ConstMatrix GaussInput LinearSpatialTemplate SinusSignal SpatialTemplate "
            "StepSignal"
        ),
    }.items()
    for name in names.split()
}
LOOPED = {
    *("NeuralField", "Preshape", "HebbianConnection", "SpaceToRateCode", "HarmonicOscillator", "SerialOrder"),
    *("NumericalIntegration", "NumericalDifferentiation", "ExponentialSmoothing"),
    *("SinusSignal", "StepSignal"),
}
OUT = "sigmoided activation"


@dataclass
class Many:
    """An object whose keys may occur many times."""

    pairs: list[tuple[str, Any]] = field(default_factory=list)


def written(value: Any) -> str:
    """Return a value as cedar writes it; empty lists and objects are empty texts."""
    if isinstance(value, dict):
        value = Many(list(value.items()))
    if isinstance(value, Many):
        inner = ",\n".join(f"{json.dumps(str(key))}: {written(v)}" for key, v in value.pairs)
        return f"{{\n{inner}\n}}" if value.pairs else '""'
    if isinstance(value, list | tuple):
        return f"[{', '.join(written(v) for v in value)}]" if len(value) else '""'
    if isinstance(value, bool):
        return '"true"' if value else '"false"'
    return json.dumps(str(value)).replace("/", "\\/")


def sigmoid(kind: str = "ExpSigmoid", **options: Any) -> dict[str, Any]:
    """Return a transfer function."""
    return {"type": f"cedar.aux.math.{kind}", **options}


def gauss(amplitude: float, sigmas: list[float], **options: Any) -> tuple[str, dict[str, Any]]:
    """Return a kernel of a list."""
    d = len(sigmas)
    settings = {"dimensionality": d, "anchor": [0] * d, "amplitude": amplitude, "sigmas": sigmas}
    return "cedar.aux.kernel.Gauss", {**settings, "normalize": True, "shifts": [0] * d, "limit": 5, **options}


def box(amplitude: float, widths: list[int], **options: Any) -> tuple[str, dict[str, Any]]:
    """Return a kernel of a list."""
    settings = {"dimensionality": len(widths), "anchor": [0] * len(widths), "amplitude": amplitude}
    return "cedar.aux.kernel.Box", {**settings, "widths": widths, **options}


def border(kind: str = "Zero", engine: str = "OpenCV", **options: Any) -> dict[str, Any]:
    """Return how kernels are applied."""
    return {"borderType": kind, "mode": "Same", "engine": {"type": f"cedar.aux.conv.{engine}"}, **options}


@dataclass
class Model:
    """Steps with the group they are in, connections between steps, and triggers with their listeners.

    A connection is written "a.slot -> b.slot" with plain names of steps, which are unique in the model; one
    that crosses the border of a group gets the connectors it needs.
    """

    steps: list[tuple[str, str, dict[str, Any]]] = field(default_factory=list)
    wires: list[str] = field(default_factory=list)
    place: dict[str, tuple[str, ...]] = field(default_factory=dict)
    triggers: dict[str, list[str]] | None = None

    def add(
        self, kind: str, name: str, more: dict[str, Any] | None = None, group: tuple[str, ...] = ()
    ) -> str:
        """Add a step and return its name."""
        self.steps.append((kind, name, more or {}))
        self.place[name] = group
        return name

    def field(self, name: str, sizes: tuple[int, ...], **options: Any) -> str:
        """Add a field; underscores in the names of parameters stand for spaces."""
        given = {key.replace("_", " "): value for key, value in options.items()}
        defaults: dict[str, Any] = {
            "activation as output": False,
            "dimensionality": len(sizes),
            "sizes": list(sizes),
            "time scale": 80,
            "resting level": -1.5,
            "input noise gain": 0,
            "sigmoid": sigmoid(threshold=0, beta=2),
            "global inhibition": 0,
            "lateral kernels": "",
            "lateral kernel convolution": border(),
            "noise correlation kernel": gauss(0, [3.0] * max(1, len(sizes)))[1],
        }
        return self.add("NeuralField", name, {**defaults, **given})

    def wire(self, source: str, target: str) -> None:
        """Connect "a.slot" to "b.slot"."""
        self.wires.append(f"{source} -> {target}")

    def looped(self) -> list[str]:
        """Return what a trigger can list: looped steps of the top level, then groups that contain any."""
        names = [name for kind, name, _ in self.steps if kind in LOOPED]
        groups = {self.place[name][0] for name in names if self.place[name]}
        return [name for name in names if not self.place[name]] + sorted(groups)

    def text(self) -> str:
        """Return the text of the file."""
        wires, connectors = self._routed()
        paths = {()} | {place[:k] for place in self.place.values() for k in range(len(place) + 1)}
        return written(self._group((), paths, wires, connectors))

    def _routed(self) -> tuple[dict[Any, list[dict[str, str]]], dict[Any, dict[str, bool]]]:
        """Return the connections and connectors of each group."""
        wires: dict[Any, list[dict[str, str]]] = {}
        connectors: dict[Any, dict[str, bool]] = {}
        for k, wire in enumerate(self.wires):
            source, target = wire.split(" -> ")
            a, b = self.place[source.split(".")[0]], self.place[target.split(".")[0]]
            common = 0
            while common < min(len(a), len(b)) and a[common] == b[common]:
                common += 1
            for depth in range(len(a), common, -1):
                connectors.setdefault(a[:depth], {})[f"to {k}"] = False
                wires.setdefault(a[:depth], []).append({"source": source, "target": f"to {k}.input"})
                source = f"{a[depth - 1]}.to {k}"
            for depth in range(common, len(b)):
                inside = f"{b[depth]}.from {k}"
                wires.setdefault(b[:depth], []).append({"source": source, "target": inside})
                connectors.setdefault(b[: depth + 1], {})[f"from {k}"] = True
                source = f"from {k}.output"
            wires.setdefault(b, []).append({"source": source, "target": target})
        return wires, connectors

    def _group(self, path: Any, paths: Any, wires: Any, connectors: Any) -> Many:
        own = [
            (TYPES[kind], {"name": name, **more})
            for kind, name, more in self.steps
            if self.place[name] == path
        ]
        inner = sorted(p for p in paths if len(p) == len(path) + 1 and p[:-1] == path)
        pairs: list[tuple[str, Any]] = [("meta", {"format": 1}), ("steps", Many(own))]
        if not path and self.triggers is not None:
            pairs.append(("triggers", Many([_trigger(n, names) for n, names in self.triggers.items()])))
        groups = [(p[-1], self._group(p, paths, wires, connectors)) for p in inner]
        pairs += [
            ("groups", Many(groups)),
            ("connections", wires.get(path, [])),
            ("name", path[-1] if path else "root"),
            ("connectors", connectors.get(path, {})),
            ("is looped", bool(path)),
        ]
        return Many(pairs)


def _trigger(name: str, listeners: list[str]) -> tuple[str, dict[str, Any]]:
    return "cedar.processing.LoopedTrigger", {
        "name": name,
        "step size": "0.02 s",
        "fake Euler step size": "0.01 s",
        "loop mode": "fake deltaT",
        "use default CPU step": True,
        "start with all": True,
        "listeners": listeners,
    }


# ---------------------------------------------------------------------------------- random models


def random_models(seed: int) -> str:
    """Return the text of a random architecture of 5-20 steps, with fields of 0-3 dimensions."""
    rng = random.Random(seed)
    while True:
        m = _random_model(rng)
        if 5 <= len(m.steps) <= 20:
            return m.text()


def _random_model(rng: random.Random) -> Model:
    m, lengths = Model(), (rng.randint(11, 18), rng.randint(8, 11), rng.randint(6, 7))
    fields = {}
    for k in range(rng.randint(2, 5)):
        sizes = lengths[: rng.choice((0, 0, 1, 1, 1, 1, 2, 2, 3))]
        fields[_random_field(rng, m, f"field {k}", sizes)] = sizes
    for name, sizes in fields.items():
        if rng.random() < 0.7:
            m.wire(_stimulus(rng, m, name, sizes), f"{name}.input")
    for k in range(rng.randint(2, 4)):
        a, b = rng.choice(list(fields)), rng.choice(list(fields))
        _coupling(rng, m, f"c{k}", (a, fields[a]), (b, fields[b]))
    alike = [(a, b) for a in fields for b in fields if a < b and fields[a] == fields[b]]
    if alike and rng.random() < 0.7:
        _sum_of_two(rng, m, rng.choice(alike), rng.choice(alike)[0])
    _groups(rng, m)
    rng.shuffle(m.steps)
    rng.shuffle(m.wires)
    m.triggers = _triggers(rng, m.looped())
    return m


def _random_field(rng: random.Random, m: Model, name: str, sizes: tuple[int, ...]) -> str:
    """Add a field with up to two kernels that fit into it."""
    d = max(1, len(sizes))
    kernels = []
    engine = rng.choice(("OpenCV", "OpenCV", "FFTW"))
    for _ in range(rng.randint(0, 2)):
        if rng.random() < 0.7:
            sigmas = [round(rng.uniform(0.45, 0.95), 2) for _ in range(d)]
            more = {
                "shifts": [rng.choice((0, 0, 1, -1)) for _ in range(d)],
                "normalize": rng.random() < 0.8,
                "limit": rng.choice((4, 5)),
            }
            scale = 1 if more["normalize"] else 2**d
            kernels.append(gauss(round(rng.uniform(-1.5, 2) / scale, 3), sigmas, **more))
        else:
            widths = [rng.choice((2, 3, 4, 5)) if sizes else 1 for _ in range(d)]
            kernels.append(box(round(rng.uniform(-1.5, 1.5) / 4**d, 3), widths))
    functions = [sigmoid(threshold=round(rng.uniform(-0.3, 0.3), 2), beta=round(rng.uniform(1, 4), 1))] * 3
    functions.append(sigmoid("AbsSigmoid", threshold=0, beta=round(rng.uniform(2, 6), 1)))
    return m.field(
        name,
        sizes,
        time_scale=rng.randint(50, 150),
        resting_level=round(rng.uniform(-2, -0.2), 2),
        global_inhibition=round(rng.choice((0, -0.5)) * rng.random() / (10 ** (d - 1)), 4),
        sigmoid=rng.choice(functions),
        activation_as_output=rng.random() < 0.3,
        lateral_kernels=Many(kernels),
        lateral_kernel_convolution=border(rng.choice(("Zero", "Cyclic", "Replicate", "Reflect")), engine),
    )


def _stimulus(rng: random.Random, m: Model, name: str, sizes: tuple[int, ...]) -> str:
    """Add a source that fits a field and return its output."""
    own, strength = f"input of {name}", round(rng.uniform(0.5, 4), 2)
    if not sizes or rng.random() < 0.15:
        m.add("Boost", own, {"strength": strength, "active": True, "deactivate on reset": False})
        return f"{own}.boost"
    shape = {"dimensionality": len(sizes), "sizes": list(sizes), "amplitude": strength}
    if rng.random() < 0.25:
        widths = [rng.randint(2, 5) for _ in sizes]
        lefts = [rng.randint(0, n - 2) for n in sizes]
        m.add("BoxInput", own, {**shape, "widths": widths, "left bounds": lefts, "reference level": 0})
        return f"{own}.box input"
    centers = [round(rng.uniform(0, n - 1), 1) for n in sizes]
    sigmas = [round(rng.uniform(1, 3), 1) for _ in sizes]
    settings = {"centers": centers, "sigma": sigmas, "cyclic": rng.random() < 0.5}
    m.add("GaussInput", own, {**shape, **settings})
    return f"{own}.Gauss input"


def _output(rng: random.Random, m: Model, name: str) -> str:
    """Return an output of a field; its activation goes through a transfer function and so stays small."""
    more = next(more for _, own, more in m.steps if own == name)
    own = f"limit of {name}"
    if own in m.place:
        return f"{own}.sigmoided output"
    if not more["activation as output"] or rng.random() < 0.5:
        return f"{name}.{OUT}"
    m.add("TransferFunction", own, {"function": sigmoid(threshold=-0.5, beta=1.5)})
    m.wire(f"{name}.activation", f"{own}.input")
    return f"{own}.sigmoided output"


def _coupling(rng: random.Random, m: Model, name: str, a: Any, b: Any) -> None:
    """Add the steps of a coupling between two fields, ended by a gain."""
    (source, from_sizes), (target, to_sizes) = a, b
    end, cells = _output(rng, m, source), 1
    convolved = from_sizes and len(from_sizes) < 3 and rng.random() < 0.4
    if convolved:
        sigmas = [round(rng.uniform(0.6, 1.6), 2) for _ in from_sizes]
        settings = {"kernels": Many([gauss(1.5, sigmas)])}
        settings["convolution"] = border(rng.choice(("Zero", "Cyclic", "Replicate", "Reflect")))
        m.wire(end, f"{m.add('Convolution', f'{name} convolution', settings)}.matrix")
        end = f"{name} convolution.result"
    if len(from_sizes) != len(to_sizes):
        end, cells = _projection(rng, m, name, end, from_sizes, to_sizes)
    elif rng.random() < 0.2:
        m.wire(end, f"{m.add('Preshape', f'{name} trace', _trace(from_sizes))}.input")
        end = f"{name} trace.activation"
    factor = round(rng.choice((-1, 1)) * rng.uniform(0.3, 2.5) / cells, 3)
    m.wire(end, f"{m.add('StaticGain', f'{name} gain', {'gain factor': factor})}.input")
    m.wire(f"{name} gain.output", f"{target}.input")


def _trace(sizes: tuple[int, ...]) -> dict[str, Any]:
    times = {"time scale build up": 120, "time scale decay": 400}
    gate = sigmoid(threshold=0.4, beta=5)
    return {"dimensionality": len(sizes), "sizes": list(sizes), **times, "sigmoid": gate}


def _projection(rng: random.Random, m: Model, name: str, end: str, a: Any, b: Any) -> tuple[str, int]:
    """Add a projection between the dimensions of two fields; also return how many cells a sum takes.

    A line between 1-D and 2-D may lie along the second dimension of the plane; it is then resized.
    """
    reduction, cells = rng.choice(("SUM", "AVERAGE", "MAXIMUM", "MINIMUM")), 1
    mapping = {k: k if k < len(b) else DROP for k in range(len(a))}
    across = {len(a), len(b)} == {1, 2} and rng.random() < 0.5
    if across:
        mapping = {0: 1} if len(a) == 1 else {0: DROP, 1: 0}
    if reduction == "SUM":
        for k, n in enumerate(a):
            cells *= n if mapping[k] == DROP else 1
    resized = {"interpolation": rng.choice(("LINEAR", "LINEAR", "NEAREST"))}
    if across and len(a) == 1:
        m.wire(end, f"{m.add('Resize', f'{name} resize', {'output size': [b[1]], **resized})}.input")
        end = f"{name} resize.output"
    settings = {
        "dimension mapping": mapping,
        "output dimensionality": len(b),
        "output dimension sizes": list(b),
    }
    m.add("Projection", f"{name} projection", {**settings, "compression type": reduction})
    m.wire(end, f"{name} projection.input")
    end = f"{name} projection.output"
    if across and len(a) == 2:
        m.wire(end, f"{m.add('Resize', f'{name} resize', {'output size': list(b), **resized})}.input")
        end = f"{name} resize.output"
    return end, cells


def _sum_of_two(rng: random.Random, m: Model, pair: tuple[str, str], target: str) -> None:
    """Add a sum of two fields that a third reads, over all cells if the sizes differ."""
    m.add("Sum", "sum of two")
    for name in pair:
        m.wire(_output(rng, m, name), "sum of two.terms")
    sizes = {name: settings["sizes"] for kind, name, settings in m.steps if kind == "NeuralField"}
    end = "sum of two.sum"
    if sizes[pair[0]] != sizes[target]:
        mapping = dict.fromkeys(range(len(sizes[pair[0]])), DROP)
        settings = {"dimension mapping": mapping, "output dimensionality": 0, "output dimension sizes": []}
        m.wire(
            end, f"{m.add('Projection', 'mean of two', {**settings, 'compression type': 'AVERAGE'})}.input"
        )
        end = "mean of two.output"
    m.wire(end, f"{m.add('StaticGain', 'gain of two', {'gain factor': 0.8})}.input")
    m.wire("gain of two.output", f"{target}.input")


def _groups(rng: random.Random, m: Model) -> None:
    """Put some of the steps into groups, of which one may be inside of another."""
    paths = rng.choice(([], [("group",)], [("group",), ("second",)], [("group",), ("group", "inner")]))
    for name in m.place:
        if paths and rng.random() < 0.5:
            m.place[name] = rng.choice(paths)


def _triggers(rng: random.Random, names: list[str]) -> dict[str, list[str]] | None:
    """Return triggers that list some of the names in any order."""
    names = [name for name in names if rng.random() < 0.85]
    rng.shuffle(names)
    cut = rng.randint(0, len(names))
    return rng.choice((None, {"default thread": names}, {"default thread": names[:cut], "fast": names[cut:]}))


# ----------------------------------------------------------------------------- every type of step


def between(kind: str, settings: dict[str, Any], reads: dict[str, Any], puts: str, sizes: Any) -> str:
    """Return the text of a model in which a step stands between fields.

    Args:
        kind: the last part of the type of the step
        settings: its parameters
        reads: sizes of a field by the slot that reads it; a list for several fields
        puts: the slot of the output that the last field reads
        sizes: sizes of the last field
    """
    m = Model()
    k = 0
    m.add(kind, "step", settings)
    for slot, given in reads.items():
        for own in given if isinstance(given, list) else [given]:
            end = f"{_driven(m, f'source {k}', own, k)}.{OUT}"
            if kind == "SpaceToRateCode" or settings.get("position type", "Maximum") != "Maximum":
                end = _peaked(m, end)
            m.wire(end, f"step.{slot}")
            k += 1
    m.field("target", sizes, lateral_kernels=Many([gauss(0.8, [0.55] * max(1, len(sizes)))]))
    m.wire(f"step.{puts}", "target.input")
    if any(kind in LOOPED for kind, *_ in m.steps):
        m.triggers = {"default thread": m.looped()[::-1] if k % 2 else m.looped()}
    return m.text()


def _driven(m: Model, name: str, sizes: tuple[int, ...], k: int) -> str:
    """Add a field with an input whose peak is at another place for each k."""
    m.field(name, sizes, time_scale=60 + 10 * k, resting_level=-0.7)
    own = f"input of {name}"
    if not sizes:
        m.add("Boost", own, {"strength": 1.4 + 0.5 * k, "active": True})
        m.wire(f"{own}.boost", f"{name}.input")
        return name
    centers = [n / 3 + 0.3 + k for n in sizes]
    shape = {"dimensionality": len(sizes), "sizes": list(sizes), "centers": centers}
    m.add("GaussInput", own, {**shape, "amplitude": 3, "sigma": [1.7] * len(sizes), "cyclic": False})
    m.wire(f"{own}.Gauss input", f"{name}.input")
    return name


def _peaked(m: Model, end: str) -> str:
    """Add the input of a field to its output: the output alone is uniform at first and has no position."""
    name = end.split(".", 1)[0]
    m.add("Sum", "peaked")
    m.wire(end, "peaked.terms")
    m.wire(f"input of {name}.Gauss input", "peaked.terms")
    return "peaked.sum"


def every_type() -> dict[str, str]:
    """Return a tiny model for each supported type of step, by "type" or "type, variant"."""
    line, plane, cube, node = (12,), (8, 7), (6, 5, 7), ()
    models: dict[str, str] = {}

    def put(kind: str, variant: str, more: Any, reads: Any, puts: str, sizes: Any) -> None:
        models[TYPES[kind] + (f", {variant}" if variant else "")] = between(kind, more, reads, puts, sizes)

    _dynamics(put, line, plane, node)
    _sources(put, line, plane, node)
    _algebra(put, line, plane, node)
    _arrays(put, line, plane, cube, node)
    _programs(put, line, plane, node)
    _synapses(put, line, plane, cube, node)
    _rate_matrices(put, plane)
    models[TYPES["VariableBox"]] = _moved_box({"center at input": False})
    models[TYPES["VariableBox"] + ", centred"] = _moved_box({"center at input": True})
    for kind in ("HopfOscillatorRHS", "HarmonicOscillatorRHS"):
        for count in (1, 3):
            for given in (False, True):
                variant = f", {count} of {'inputs' if given else 'numbers'}"
                models[TYPES[kind] + (variant if variant != ", 1 of numbers" else "")] = _bank(
                    kind, count, given
                )
    for shape in ("Zero", "Cyclic", "Replicate", "Reflect"):
        for engine in ("OpenCV", "FFTW"):
            models[f"{TYPES['NeuralField']}, {shape} {engine}"] = _bordered(shape, engine)
    return models


def _synapses(put: Any, line: Any, plane: Any, cube: Any, node: Any) -> None:
    """Add connections with all of their parts, each alone, and with point-wise weights."""
    inside = Many([gauss(1.3, [0.9], shifts=[1]), box(0.2, [4])])
    flat = Many([gauss(1, [1.4, 0.9]), box(-0.1, [3, 2])])
    ring = {**border("Cyclic"), "kernels": inside}
    moved = Many([gauss(2, [4.0], anchor=[-3])])
    gain = {"static gain": {"Synapse Weight": -0.8}}
    summed = {"enabled": True, "dimension mapping": {0: DROP, 1: 0}, "output dimensionality": 1}
    summed |= {"output dimension sizes": [7], "compression type": "SUM"}
    wide = {"enabled": True, "dimension mapping": {0: 1}, "output dimensionality": 2}
    wide |= {"output dimension sizes": [5, 50], "compression type": "MAXIMUM"}
    off = {"projection": {**wide, "enabled": False}}
    for variant, more, source, target in (
        ("", {"convolution": {"kernels": inside}, **gain, **off}, line, line),
        ("several", {"convolution": ring, **gain}, [node, line, line], line),
        ("plane", {"convolution": {**border("Reflect"), "kernels": flat}, **gain}, plane, plane),
        ("FFTW", {"convolution": {**border("Zero", "FFTW"), "kernels": flat}, **gain}, plane, plane),
        ("summed", {"convolution": {"kernels": flat}, "projection": summed}, plane, (7,)),
        ("largest", {"projection": {**summed, "compression type": "MAXIMUM"}}, [plane, plane], (7,)),
        ("expanded", {**gain, "projection": wide}, line, (5, 12)),
        ("of numbers", {"convolution": {"kernels": Many([gauss(1.5, [3.0])])}, **gain}, [node, node], node),
        ("of defaults", {}, line, line),
        ("weights", {"PointWiseWeight": {"kernels": inside}, **gain}, line, line),
        ("weights, moved", {"PointWiseWeight": {"kernels": moved}}, line, line),
        ("weights, plane", {"PointWiseWeight": {"kernels": flat}, "projection": summed}, plane, (7,)),
        ("weights, cube", {"PointWiseWeight": {"kernels": Many([gauss(2, [1.2, 2.5, 0.6])])}}, cube, cube),
        ("weights, one", {"PointWiseWeight": {"kernels": Many([gauss(3, [1.0])])}, **gain}, node, node),
        (
            "weights, all",
            {
                "convolution": ring,
                "PointWiseWeight": {"kernels": Many([gauss(1.5, [3.2], normalize=False)])},
                **gain,
                "projection": wide,
            },
            [line, node],
            (5, 12),
        ),
    ):
        put("SynapticConnection", variant, more, {"matrix": source}, "result", target)


def _rate_matrices(put: Any, plane: Any) -> None:
    """Add codes of rates inside and beyond the limits, and of the largest of several bins."""
    for variant, low, high, bins in (("", 0.1, 0.9, 6), ("narrow", 0.3, 0.45, 4), ("falling", 0.8, 0.1, 3)):
        settings = {"number of bins": bins, "lower limit": low, "upper limit": high}
        reads = {"bin map": plane, "values": plane} if variant == "narrow" else {"bin map": plane}
        put("RateMatrixToSpaceCode", variant, settings, reads, "output", (*plane, bins))
    limits = {"lower limit": -1, "upper limit": 2}
    put("SpaceCodeToRateMatrix", "", limits, {"input": (6, 5, 7)}, "output", (6, 5))
    put("SpaceCodeToRateMatrix", "falling", {"lower limit": 1}, {"input": (6, 1, 7)}, "output", (6,))


def _moved_box(settings: dict[str, Any]) -> str:
    """Return a model of a box at a place that is a whole number, the count of active cells of a field."""
    m = Model()
    m.wire(f"{_driven(m, 'source', (12,), 0)}.{OUT}", f"{m.add('Count', 'count', {'threshold': 0.41})}.input")
    shape = {"dimensionality": 1, "sizes": [12], "amplitude": 2, "widths": [4], "reference level": 0.2}
    m.wire("count.output", f"{m.add('VariableBox', 'step', {**shape, **settings})}.left bounds")
    m.field("target", (12,))
    m.wire("step.box", "target.input")
    return m.text()


def _bank(kind: str, count: int, given: bool) -> str:
    """Return a model of oscillators whose state is integrated, from a state at the start."""
    m = Model()
    settings = {"bank size": count, "bank omega": 3, "bank alpha": 2, "bank gamma": 0.5}
    settings |= {"bank stiffness": 9, "bank damping": 0.6, "force critically damped": given and count == 1}
    start = ("ConstVector", {"number of vector entries": 2, "entries": [1, 0.5]}, "vector")
    if count > 1:
        start = ("ConstMatrix", {"sizes": [2, count], "value": 0.7}, "matrix")
    m.add(kind, "step", settings)
    m.add("NumericalIntegration", "state", {})
    m.wire(f"{m.add(start[0], 'start', start[1])}.{start[2]}", "state.initial state (optional)")
    m.wire("step.state change", "state.input")
    m.wire("state.integration result", "step.state")
    sizes = (2, count) if count > 1 else (2,)
    own = (count,) if count > 1 else ()
    slots = {"HopfOscillatorRHS": ("omegas (bank)", "gammas (bank)"), "HarmonicOscillatorRHS": ("shift",)}[
        kind
    ]
    for k, slot in enumerate(slots if given else ()):
        m.wire(f"{_driven(m, f'source {k}', own, k)}.{OUT}", f"step.{slot} (optional)")
    m.field("target", sizes)
    m.wire("state.integration result", "target.input")
    m.triggers = {"default thread": m.looped()}
    return m.text()


def _bordered(shape: str, engine: str) -> str:
    """Return a model of fields of 0-3 dimensions with the same border and engine, one into the next."""
    m, before = Model(), ""
    for sizes in ((), (12,), (8, 9), (6, 5, 7)):
        name = f"field {len(sizes)}"
        d = max(1, len(sizes))
        kernels = [gauss(1.2, [0.9] * d, shifts=[1] + [0] * (d - 1)), box(-0.3 / 4**d, [4] * d)]
        kernels = kernels if sizes else [gauss(2, [3.0])]
        convolution = border(shape, engine)
        m.field(name, sizes, lateral_kernels=Many(kernels), lateral_kernel_convolution=convolution)
        source = {"dimensionality": d, "sizes": list(sizes) or [1], "centers": [1.2] * d}
        m.add("GaussInput", f"input {d} {name}", {**source, "amplitude": 3, "sigma": [1.5] * d})
        m.wire(f"input {d} {name}.Gauss input", f"{name}.input")
        if before == "field 0":
            m.wire(f"{before}.{OUT}", f"{name}.input")
        before = name
    return m.text()


def _dynamics(put: Any, line: Any, plane: Any, node: Any) -> None:
    shape = {"dimensionality": 1, "sizes": list(line)}
    plain = {"time scale": 90, "resting level": -1, "sigmoid": sigmoid(beta=3), "lateral kernels": ""}
    put("NeuralField", "", {**shape, **plain}, {"input": [line, node]}, OUT, line)
    shown = {**shape, **plain, "activation as output": True, "global inhibition": -0.02}
    put("NeuralField", "activation", shown, {"input": line}, "activation", line)
    for kind, more in (
        ("AbsSigmoid", {"beta": 4}),
        ("LinearTransferFunction", {"factor": 0.5, "offset": 0.2}),
        ("SemiLinearTransferFunction", {"threshold": -0.8, "beta": 0.7}),
        ("HeavisideSigmoid", {"threshold": -0.633}),
    ):
        put(
            "NeuralField",
            kind,
            {**shape, **plain, "sigmoid": sigmoid(kind, **more)},
            {"input": line},
            OUT,
            line,
        )
    bent = {**shape, **plain, "resting level": -1, "global inhibition": -0.02}
    bent["sigmoid"] = sigmoid("SemiLinearTransferFunction", threshold=-0.6, beta=0.7)
    for sizes in (line, plane, node):
        kernels = Many([gauss(0.6, [0.9] * max(len(sizes), 1)), box(-0.1, [3] * max(len(sizes), 1))])
        fields = {"dimensionality": len(sizes), "sizes": list(sizes), "lateral kernels": kernels}
        variant = f"SemiLinearTransferFunction {len(sizes)}-D"
        put("NeuralField", variant, {**bent, **fields}, {"input": sizes}, OUT, sizes)
    constant = {"sigmoid": sigmoid("LinearTransferFunction", factor=0, offset=0.4)}
    put("NeuralField", "constant output", {**bent, **constant}, {"input": line}, OUT, line)
    trace = {
        **shape,
        "time scale build up": 80,
        "time scale decay": 300,
        "sigmoid": sigmoid(threshold=0.4, beta=6),
    }
    put("Preshape", "", trace, {"input": line}, "activation", line)
    put("Preshape", "detector", trace, {"input": line, "peak detector": node}, "activation", line)
    for variant, more in (
        ("", {}),
        ("jump", {"jump to fixed point": True}),
        ("cyclic", {"use cyclic mean": True}),
    ):
        settings = {"tau": "400 ms", "lowerLimit": -1, "upperLimit": 2, **more}
        put("SpaceToRateCode", variant, settings, {"input": line}, "output", node)
    blob = {
        "output sizes": list(line),
        "amplitude": 2,
        "lower limits": [0],
        "upper limits": [1],
        "sigma": [2],
    }
    put("RateToSpaceCode", "", {**blob, "cyclic": False}, {"input": node}, "output", line)
    put("RateToSpaceCode", "cyclic", {**blob, "cyclic": True}, {"input": node}, "output", line)
    put(
        "HarmonicOscillator",
        "",
        {"dimensionality": 2, "Initial Position": [1, 2]},
        {"lambda": (2,)},
        "p",
        (2,),
    )
    order = {"number of ordinal positions": 3, "tau": 100, "sigmoid": sigmoid(beta=2)}
    put("SerialOrder", "", order, {"CoS signal input": node}, "ordinal node 1 output", node)
    put(
        "SerialOrder",
        "cyclic",
        {**order, "cyclic": True},
        {"CoS signal input": node},
        "ordinal node 2 output",
        node,
    )
    soft = {"ordinal resting level": -1, "ordinal self excitation": 3, "ordinal global inhibition": -2}
    soft |= {"memory resting level": -0.5, "memory to next ordinal": 2, "memory to same ordinal": -1}
    soft |= {"ordinal to prev memory": -1, "ordinal to same memory": 2, "memory self excitation": 2}
    for cyclic in (False, True):
        settings = {**order, **soft, "number of ordinal positions": 4, "cyclic": cyclic}
        puts = "ordinal node 2 output"
        put("SerialOrder", f"soft {cyclic}", settings, {"CoS signal input": node}, puts, node)
    put("SerialOrder", "no signal", {**order, **soft}, {}, "ordinal node 0 output", node)
    _learning(put, line, plane, node)


def _learning(put: Any, line: Any, plane: Any, node: Any) -> None:
    soft = {
        "f (source sigmoid)": sigmoid(threshold=0.4, beta=3),
        "g (reward sigmoid)": sigmoid(threshold=0.4, beta=3),
        "h (target sigmoid)": sigmoid("LinearTransferFunction", factor=1, offset=0),
    }
    rule = {
        "learning rule": "Oja's Rule",
        "learning rate": 0.2,
        "weight init value": 0,
        "weight init noise": 0,
    }
    times = {"time scale": 50, "time scale decay": 200}
    bent = sigmoid("SemiLinearTransferFunction", threshold=0.5, beta=0.3)
    sharp = {"g (reward sigmoid)": sigmoid("HeavisideSigmoid", threshold=0.5)}
    short = {"fixed reward duration": True, "reward duration": 50, **sharp}
    for variant, source, target, more in (
        ("", node, line, {}),
        ("0-D target", line, node, {}),
        ("0-D target one time scale", plane, node, {"time scale": 50}),
        ("lines", line, (9,), sharp),
        ("lines one time scale", line, (9,), {**sharp, "time scale": 30}),
        ("lines two time scales", (9,), line, {**sharp, **times}),
        ("lines of one length", line, line, {**short, "weight init value": 0.1, "weight init noise": 0.1}),
        ("0-D to 2-D", node, plane, {}),
        ("one time scale", node, line, {"time scale": 50}),
        ("two time scales", node, line, times),
        (
            "manual weights",
            node,
            (24,),
            {"weight centers": [12], "weight sigmas": [2], "weight amplitude": 2},
        ),
        ("a jump of the source", node, line, {"f (source sigmoid)": bent}),
        ("reward duration", node, line, short),
        ("short reward duration", node, line, {**short, "reward duration": 8}),
        ("uneven reward duration", node, line, {**short, "reward duration": 55}),
    ):
        given = {
            **rule,
            **soft,
            "source dimension": len(source),
            "source sizes": list(source),
            "target dimension": len(target),
            "target sizes": list(target),
            "manual weights": variant == "manual weights",
            **more,
        }
        reads = {"source node": source, "target field": target, "reward signal": node}
        put("HebbianConnection", variant, given, reads, "learned output", target)
        if variant == "lines":
            given |= {"weight init value": 0.2, "weight init noise": 0.2}
            del reads["reward signal"]
            put("HebbianConnection", "no reward", given, reads, "learned output", target)


def _sources(put: Any, line: Any, plane: Any, node: Any) -> None:
    flat = {"dimensionality": 2, "sizes": list(plane), "amplitude": 2}
    put("GaussInput", "", {**flat, "centers": [2.4, 3], "sigma": [2, 1.5]}, {}, "Gauss input", plane)
    ring = {"dimensionality": 1, "sizes": list(line), "amplitude": 2, "centers": [1.2], "sigma": [2]}
    put("GaussInput", "cyclic", {**ring, "cyclic": True}, {}, "Gauss input", line)
    block = {"widths": [3, 4], "left bounds": [2, 5], "reference level": 0.2}
    put("BoxInput", "", {**flat, **block}, {}, "box input", plane)
    put("Boost", "", {"strength": 2, "active": True}, {}, "boost", line)
    put("ConstMatrix", "", {"sizes": list(plane), "value": 0.7}, {}, "matrix", plane)
    put("ConstVector", "", {"number of vector entries": 3, "entries": [0.5, 1, 2]}, {}, "vector", (3,))
    ramp = {"size x": 8, "size y": 7, "lowest": -1, "upmost": 2}
    put("LinearSpatialTemplate", "", ramp, {}, "spatial pattern", plane)
    ray = {"size x": 8, "size y": 7, "mu th": 0.3, "sigma th hor": 0.5, "mu r": 1, "sigma r": 0.6}
    put("SpatialTemplate", "", ray, {}, "spatial pattern", plane)
    wave = {"period": 0.23, "amplitude": 2, "phase shift": 0.003, "vertical offset": 0.5}
    put("SinusSignal", "", wave, {}, "signal", node)
    put("SinusSignal", "cosine", {**wave, "make cos": True}, {}, "signal", node)
    put("StepSignal", "", wave, {}, "signal", node)


def _algebra(put: Any, line: Any, plane: Any, node: Any) -> None:
    put("StaticGain", "", {"gain factor": -1.5}, {"input": line}, "output", line)
    put("AddConstant", "", {"constant": 0.6}, {"input": plane}, "output", plane)
    put("Sum", "", {}, {"terms": [line, node, line]}, "sum", line)
    put("SubtractElementwise", "", {}, {"minuend": line, "subtrahend": line}, "result", line)
    put("ComponentMultiply", "", {}, {"operands": [plane, plane, node]}, "product", plane)
    ends = {
        "input lower bound": -1,
        "input upper bound": 1,
        "output lower bound": 0.5,
        "output upper bound": 3,
    }
    put("ConvertToValueRange", "", ends, {"input": line}, "converted output", line)
    put("AbsoluteValue", "", {}, {"input": line}, "absolute value", line)
    put("DivideElementwise", "", {}, {"divisor": line, "dividend": line}, "result", line)
    put("ScalarDivision", "", {}, {"divisor": node, "matrix": line}, "result", line)
    put("InnerProduct", "", {}, {"input": line, "input 2": line}, "output", node)
    put("OuterProduct", "", {}, {"input": (8,), "input 2": (7,)}, "output", plane)
    put("CrossProduct", "", {}, {"input": (3,), "input 2": (3,)}, "output", (3,))
    pair = {"operand1": (4, 6), "operand2": (6, 5)}
    put("MatrixMultiply", "", {"transposeOperand1": False}, pair, "matrixProduct", (4, 5))
    pair = {"operand1": (6, 4), "operand2": (6, 5)}
    put("MatrixMultiply", "transposed", {"transposeOperand1": True}, pair, "matrixProduct", (4, 5))
    for variant, first, second, target in (
        ("by a vector", (4, 6), (6,), (4,)),
        ("of a vector", (6,), (6, 5), (5,)),
        ("of two vectors", (6,), (6,), node),
        ("a column by a number", (6,), node, (6,)),
        ("of equal sizes", (5, 5), (5, 5), (5, 5)),
    ):
        turned = {"transposeOperand1": variant.startswith("of")}
        pair = {"operand1": first, "operand2": second}
        put("MatrixMultiply", variant, turned, pair, "matrixProduct", target)
    for variant, source, target in (
        ("", (3, 4), (4, 3)),
        ("wide", (5, 2), (2, 5)),
        ("of a vector", (5,), (5,)),
    ):
        put("PseudoInverse", variant, {}, {"matrix": source}, "inverted", target)
    put("PseudoInverse", "of a number", {}, {"matrix": node}, "inverted", node)
    put("Nullspace", "", {}, {"jacobian": (3, 5)}, "nullspace", (5, 5))
    for variant, shown in (("of a vector", "projected vector"), ("without it", "orthogonal vector")):
        put("Nullspace", variant, {}, {"jacobian": (2, 4), "vector": (4,)}, shown, (4,))
    put("Maximum", "", {}, {"terms": [line, line, line]}, "maximum", line)
    put("Minimum", "", {}, {"terms": [line, line]}, "minimum", line)
    put("Norm", "", {}, {"input": plane}, "output", node)
    for kind in ("None", "InfinityNorm", "L1Norm", "L2Norm"):
        variant = "" if kind == "L2Norm" else kind
        settings = {"normalization type": kind, "normalized dimensions": [True]}
        put("Normalization", variant, settings, {"input": line}, "normalized input", line)
    put("RemoveMean", "", {}, {"matrix": plane}, "mean-free matrix", plane)
    put("LinearFunction", "", {"slope": 2, "horizontal shift": 0.3}, {"input": line}, "result", line)
    put("Logarithm", "", {"base": 2}, {"input": line}, "result", line)
    put("Logarithm", "base", {}, {"input": line, "base (optional)": node}, "result", line)
    put("Sinus", "", {"amplitude": 2, "phase shift": 0.4}, {"input": node}, "result", node)
    shifted = {"input": node, "phase shift (optional)": node}
    put("Sinus", "cosine", {"amplitude": 2, "make cos": True}, shifted, "result", node)
    function = {"function": sigmoid(threshold=0.3, beta=4)}
    put("TransferFunction", "", function, {"input": line}, "sigmoided output", line)
    for variant, more in (
        ("SemiLinearTransferFunction", {"threshold": 0.45, "beta": -1.5}),
        ("Logarithm", {}),
        ("LinearTransferFunction", {"factor": 0, "offset": 0.3}),
    ):
        settings = {"function": sigmoid(variant, **more)}
        put("TransferFunction", variant, settings, {"input": line}, "sigmoided output", line)
    put("Transpose", "", {}, {"matrix": (7, 8)}, "transposed", plane)
    _convolutions(put, line, plane)
    _projections(put, node)


def _convolutions(put: Any, line: Any, plane: Any) -> None:
    both = Many([gauss(1, [1.5], shifts=[2]), box(0.4, [4])])
    for shape in ("Zero", "Cyclic", "Replicate", "Reflect"):
        variant = "" if shape == "Zero" else shape
        settings = {"kernels": both, "convolution": border(shape)}
        put("Convolution", variant, settings, {"matrix": line}, "result", line)
        flat = {"kernels": Many([gauss(1, [0.9, 1.3])]), "convolution": border(shape)}
        put("Convolution", f"2-D {shape}", flat, {"matrix": plane}, "result", plane)
    put(
        "Convolution",
        "FFTW",
        {"kernels": both, "convolution": border("Zero", "FFTW")},
        {"matrix": line},
        "result",
        line,
    )
    put("Convolution", "copy", {"kernels": "", "convolution": border()}, {"matrix": line}, "result", line)
    for alternate in (False, True):
        settings = {"kernels": "", "convolution": border(**{"alternate even kernel center": alternate})}
        variant = f"kernel input {alternate}"
        put("Convolution", variant, settings, {"matrix": line, "kernel": (6,)}, "result", line)
    for shape in ("Zero", "Cyclic", "Replicate", "Reflect"):
        settings = {"kernels": both, "convolution": border(shape)}
        put(
            "Convolution", f"kernel input {shape}", settings, {"matrix": line, "kernel": (5,)}, "result", line
        )
        flat = {"matrix": plane, "kernel": (3, 4)}
        put("Convolution", f"kernel input 2-D {shape}", settings, flat, "result", plane)
    settings = {"kernels": "", "convolution": border("Zero", "FFTW")}
    put("Convolution", "kernel input FFTW", settings, {"matrix": line, "kernel": (4,)}, "result", line)
    put("Convolution", "kernel input 0-D", settings, {"matrix": line, "kernel": ()}, "result", line)


def _projections(put: Any, node: Any) -> None:
    for source, target, mapping in (
        ((9,), (9, 5), {0: 0}),
        ((9,), (5, 9), {0: 1}),
        ((9,), (4, 5, 9), {0: 2}),
        ((8, 10), (10, 8), {0: 1, 1: 0}),
        ((8, 10), (10, 12, 8), {0: 2, 1: 0}),
        ((8, 10), (5, 8, 10), {0: 1, 1: 2}),
        ((6, 7, 8), (8, 6, 7), {0: 1, 1: 2, 2: 0}),
        (node, (4, 5), {}),
    ):
        settings = {"dimension mapping": mapping, "output dimensionality": len(target)}
        settings |= {"output dimension sizes": list(target), "compression type": "SUM"}
        put("Projection", f"{source} to {target}", settings, {"input": source}, "output", target)
    for way in ("SUM", "AVERAGE", "MAXIMUM", "MINIMUM"):
        for source, target, mapping in (
            ((9,), node, {0: DROP}),
            ((8, 10), (10,), {0: DROP, 1: 0}),
            ((6, 7, 8), (8, 6), {0: 1, 1: DROP, 2: 0}),
            ((6, 7, 8), (7,), {0: DROP, 1: 0, 2: DROP}),
            ((6, 7, 8), node, {0: DROP, 1: DROP, 2: DROP}),
        ):
            settings = {"dimension mapping": mapping, "output dimensionality": len(target)}
            settings |= {"output dimension sizes": list(target), "compression type": way}
            variant = "" if (way, target) == ("SUM", (10,)) else f"{way} {source} to {target}"
            put("Projection", variant, settings, {"input": source}, "output", target)


def _arrays(put: Any, line: Any, plane: Any, cube: Any, node: Any) -> None:
    put("Resize", "", {"output size": [17], "interpolation": "LINEAR"}, {"input": line}, "output", (17,))
    put(
        "Resize", "NEAREST", {"output size": [7], "interpolation": "NEAREST"}, {"input": line}, "output", (7,)
    )
    flat = {"output size": [5, 10], "interpolation": "LINEAR"}
    put("Resize", "2-D", flat, {"input": plane}, "output", (5, 10))
    put("Resize", "2-D NEAREST", {**flat, "interpolation": "NEAREST"}, {"input": plane}, "output", (5, 10))
    put(
        "Resize",
        "3-D",
        {"output size": [9, 4, 7], "interpolation": "LINEAR"},
        {"input": cube},
        "output",
        (9, 4, 7),
    )
    limits = {"lower limit": 0.3, "upper limit": 0.5}
    put("Clamp", "", limits, {"input": line}, "thresholded input", line)
    other = {"replace lower limit": True, "replace upper limit": True, "lower replacement": 0.29}
    put(
        "Clamp",
        "replaced",
        {**limits, **other, "upper replacement": 0.51},
        {"input": line},
        "thresholded input",
        line,
    )
    for variant, more in (
        ("lower replaced", {"replace lower limit": True, "lower replacement": -2}),
        ("upper replaced", {"replace upper limit": True, "apply lower limit": False}),
        ("no limits", {"apply upper limit": False, "apply lower limit": False}),
        ("replaced on a plane", {"replace upper limit": True, "upper replacement": 3, "lower limit": 0.4}),
    ):
        sizes = plane if "plane" in variant else line
        put("Clamp", variant, {**limits, **more}, {"input": sizes}, "thresholded input", sizes)
    put("Flip", "", {"flipped dimensions": [True, False]}, {"input": plane}, "output", plane)
    put("Mask", "", {}, {"input": line, "mask": line}, "masked", line)
    counted = {"bins": 6, "range lower": 0.1, "range upper": 0.9}
    for kind in ("None", "ImageSize", "Maximum"):
        settings = {**counted, "normalization type": kind}
        put("Histogram", "" if kind == "None" else kind, settings, {"input": plane}, "histogram", (6,))
    put("Histogram", "mask", counted, {"input": line, "mask": line}, "histogram", (6,))
    put("Histogram", "one bin", {**counted, "bins": 1}, {"input": cube}, "histogram", node)
    for shape in ("Zero", "Cyclic", "Replicate", "Reflect"):
        settings = {"padding mode": "PadByBorder", "border size": [2, 3], "border type": shape}
        variant = "" if shape == "Zero" else shape
        put("MatrixPadding", variant, settings, {"input": plane}, "padded", (12, 13))
    settings = {"anchor type": "Absolute", "range lower": [1, 2], "range upper": [5, 7]}
    put("MatrixSlice", "", settings, {"matrix": plane}, "slice", (4, 5))
    put("ConcatVertically", "", {}, {"input above": line, "input below": (5,)}, "output", (17,))
    put("Stack", "", {"dimensionality": 3}, {"0": plane, "1": plane, "2": plane}, "stack", (8, 7, 3))
    shape = {"dimensionality": 1, "sizes": list(line), "amplitude": 2}
    put("VariableGauss", "", {**shape, "sigma": [2]}, {"centers": node}, "box", line)
    flat = {"dimensionality": 2, "sizes": list(plane), "amplitude": 2}
    put("VariableGauss", "2-D", {**flat, "sigma": [2, 1]}, {"centers": (2,)}, "box", plane)


def _programs(put: Any, line: Any, plane: Any, node: Any) -> None:
    put(
        "Switch",
        "",
        {"make binary": False},
        {"input 1": line, "input 2": line, "factor": node},
        "mixture",
        line,
    )
    put(
        "Switch",
        "binary",
        {"make binary": True},
        {"input 1": line, "input 2": line, "factor": node},
        "mixture",
        line,
    )
    put("Count", "", {"threshold": 0.41}, {"input": line}, "output", node)
    for kind in ("Maximum", "Centroid", "Cyclic Mean"):
        variant = "" if kind == "Maximum" else kind
        settings = {"position type": kind, "Centroid detection threshold": 0.41}
        put("PositionOfMaximum", variant, settings, {"input": line}, "output", node)
        put("PositionOfMaximum", f"2-D {kind}", settings, {"input": plane}, "output", (2,))
    three = {"number of vector entries": 3}
    put("ScalarsToVector", "", three, {f"scalar {i}": node for i in range(3)}, "vector", (3,))
    put("VectorToScalars", "", three, {"input vector": (3,)}, "scalar 1", node)
    put("Delay", "", {"number of time steps": 3}, {"input": line}, "output", line)
    put("OverTime", "", {}, {"input": line}, "output", line)
    put("OverTime", "of a number", {}, {"input": node}, "output", node)
    put("Timer", "", {}, {"run signal (optional)": node}, "time", node)
    put("NumericalIntegration", "", {}, {"input": line}, "integration result", line)
    start, delay, reset = (f"{w} (optional)" for w in ("initial state", "delay", "reset signal"))
    out = "integration result"
    first = {"input": line, start: line}
    put("NumericalIntegration", "initial state", {}, first, out, line)
    put("NumericalIntegration", "initial number", {}, {"input": plane, start: node}, out, plane)
    put("NumericalIntegration", "delay", {}, {"input": line, delay: node}, out, line)
    put("NumericalIntegration", "reset", {}, {"input": line, reset: node}, out, line)
    put("NumericalIntegration", "all", {}, {"input": node, start: node, delay: node, reset: node}, out, node)
    put("Timer", "reset", {}, {"run signal (optional)": node, reset: node}, "time", node)
    put("Timer", "only reset", {}, {reset: node}, "time", node)
    out = "differentiated result"
    put("NumericalDifferentiation", "", {}, {"input": line}, out, line)
    long = {"ignore time steps smaller than": 0.02}
    put("NumericalDifferentiation", "short steps", long, {"input": line}, out, line)
    some = {"ignore time steps smaller than": 0.3, "ignore time steps larger than": 0.8}
    put("NumericalDifferentiation", "delay", some, {"input": plane, delay: node}, out, plane)
    put("ExponentialSmoothing", "", {"data smoothing factor": 0.3}, {"input": line}, "forecast", line)
    put(
        "ExponentialSmoothing",
        "of a number",
        {"trend smoothing factor": 0.4},
        {"input": node},
        "forecast",
        node,
    )
