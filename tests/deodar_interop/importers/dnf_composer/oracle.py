"""dnf-composer as plain loops: one element after another, in place, each sum written out.

It follows the equations of the format and shares no code with the importer.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np


def count(e: dict[str, Any], extent: str = "x_max", step: str = "d_x") -> int:
    """Return round(extent / step), half away from zero."""
    return math.floor(e.get(extent, 1) / e.get(step, 1.0) + 0.5)


def squash(function: dict[str, Any], u: np.ndarray) -> np.ndarray:
    """Return the activation function of each sample."""
    d = u - function["x_shift"]
    if function["type"] == "sigmoid":
        return 1 / (1 + np.exp(np.clip(-function["steepness"] * d, -88, 88)))
    if function["type"] == "heaviside":
        return np.where(d > 0, 1.0, 0.0)
    v = function["beta"] * d
    return (1 + v / (1 + np.abs(v))) / 2


def offsets(width: float, n: int, circular: bool) -> list[int]:
    """Return the offsets of a kernel."""
    c = math.ceil(5 * width)
    left, right = (min(c, (n - 1) // 2), min(c, math.ceil((n - 1) / 2))) if circular else (min(c, n - 1),) * 2
    return list(range(-left, right + 1))


def bell(o: list[int], width: float, normalized: bool) -> list[float]:
    """Return a Gaussian at the offsets."""
    g = [math.exp(-(k**2) / (2 * width**2)) for k in o]
    return [v / sum(g) for v in g] if normalized else g


def factor(e: dict[str, Any], kind: str, n: int, part: str = "") -> tuple[list[int], list[float]]:
    """Return offsets and weights of one dimension of a kernel over a plane, of amplitude 1."""
    circular, normalized = e["circular"], e["normalized"]
    if kind.startswith("oscillatory"):
        d, z = e["decay"], e["zeroCrossings"]
        d = 0.01 if d <= 0 else d
        o = offsets(max(1 / d, 5 * z), n, circular)
        k = [math.exp(-d * abs(v)) * (math.sin(d * abs(z * v)) + math.cos(z * v)) for v in o]
        return o, [v / sum(k) for v in k] if normalized else k
    o = offsets(e["width"], n, circular)
    g = bell(o, e["width"], normalized)
    if kind.startswith("asymmetric"):
        slope = [-(v / e["width"] ** 2) * math.exp(-(v**2) / (2 * e["width"] ** 2)) for v in o]
        total = sum(abs(v) for v in slope) if normalized else 1.0
        g = [a + (e[f"timeShift{part}"] * s / total if total else 0.0) for a, s in zip(g, slope, strict=True)]
    return o, g


def line_kernel(e: dict[str, Any], n: int) -> tuple[list[int], list[float]]:
    """Return offsets and weights of a kernel over a line."""
    kind = e["label"][1]
    if kind == "mexican hat kernel":
        pairs = [(e["amplitudeExc"], e["widthExc"]), (-e["amplitudeInh"], e["widthInh"])]
        o = offsets(max((w for a, w in pairs if a), default=0.1), n, e["circular"])
        both = [[a * v for v in bell(o, w, e["normalized"])] for a, w in pairs]
        return o, [a + b for a, b in zip(*both, strict=True)]
    a = e["amplitude"]
    if kind == "asymmetric gauss kernel" and e["normalized"]:
        o, moved = factor({**e, "timeShift": e["timeShift"] / abs(a)}, kind, n)
        return o, [a * v for v in moved]
    o, k = factor(e, kind, n)
    return o, k if kind == "oscillatory kernel" and e["normalized"] else [a * v for v in k]


def convolved(x: np.ndarray, o: list[int], k: list[float], circular: bool) -> np.ndarray:
    """Convolve a line where it is circular, else correlate."""
    n = len(x)
    out = np.zeros(n)
    for i in range(n):
        for at, weight in zip(o, k, strict=True):
            if circular:
                out[i] += weight * x[(i - at) % n]
            elif 0 <= i + at < n:
                out[i] += weight * x[i + at]
    return out


def resized(x: np.ndarray, m: int, method: int) -> np.ndarray:
    """Return a line at m samples."""
    n = len(x)
    if n == m:
        return x.copy()
    if m == 1:
        return x[[n // 2]]
    out = np.zeros(m)
    for i in range(m):
        p = i * (n - 1) / (m - 1)
        low = math.floor(p)
        t = p - low
        a, b, c, d = (x[min(max(low + k, 0), n - 1)] for k in (-1, 0, 1, 2))
        if method == 1:
            out[i] = x[math.floor(p + 0.5)]
        elif method == 2:
            out[i] = b + 0.5 * t * (c - a + t * (2 * a - 5 * b + 4 * c - d + t * (3 * (b - c) + d - a)))
        else:
            out[i] = b + t * (c - b)
    return out


class Simulation:
    """A simulation; `out` has the components of each element, flat, rows of x one after another."""

    def __init__(
        self, elements: list[dict[str, Any]], dt: float = 1.0, weights: dict[str, Any] | None = None
    ) -> None:
        self.elements = {e["uniqueName"]: e for e in elements}
        self.dt, self.t, self.weights = dt, 0.0, weights or {}
        self.out: dict[str, dict[str, np.ndarray]] = {}
        for wired in (False, True):
            for name, e in self.elements.items():
                self.init(name, e, wired)

    def shape(self, name: str) -> tuple[int, int]:
        """Return rows and columns."""
        e = self.elements[name]
        flat = not (e["label"][1].endswith("2d") or e["label"][1] == "expand")
        return 1 if flat else count(e, "y_max", "d_y"), count(e)

    def input(self, e: dict[str, Any], size: int) -> np.ndarray:
        """Return the sum of the inputs."""
        total = np.zeros(size)
        for source, component in e["inputs"] or []:
            total = total + self.out[source][component]
        return total

    def init(self, name: str, e: dict[str, Any], wired: bool) -> None:
        """Set the values at the start."""
        kind, (rows, columns) = e["label"][1], self.shape(name)
        n = rows * columns
        outputs = {"output": np.zeros(n)}
        if kind.startswith("neural field"):
            u = np.full(n, e["restingLevel"])
            outputs = {"activation": u, "output": squash(e["activationFunction"], u)}
        elif kind.startswith("boost"):
            outputs = {"output": np.full(n, e["amplitude"] if e["isActive"] else 0.0)}
        elif kind.startswith("gauss stimulus"):
            outputs = {"output": self.stimulus(e, rows, columns)}
        if "stimulus" in kind and "timed" not in kind and wired:
            outputs["output"] = outputs["output"] + self.input(e, n)
        self.out[name] = outputs

    def stimulus(self, e: dict[str, Any], rows: int, columns: int) -> np.ndarray:
        """Return a Gaussian pattern: widths are samples on a line, and units on a plane."""
        out = np.zeros((rows, columns))
        flat = "2d" not in e["label"][1]
        for y in range(rows):
            for x in range(columns):
                if flat:
                    p = e["position"] / e["d_x"]
                    q = math.fmod(p - 1, columns) + 1
                    d = abs(x + 1 - (q if e["circular"] else p))
                    square = (min(d, columns - d) if e["circular"] else d) ** 2
                else:
                    square = 0.0
                    for at, letter in ((x, "x"), (y, "y")):
                        d = abs((at + 1) * e[f"d_{letter}"] - e[f"position_{letter}"])
                        square += (min(d, e[f"{letter}_max"] - d) if e["circular"] else d) ** 2
                out[y, x] = math.exp(-square / (2 * e["width"] ** 2))
        return (e["amplitude"] * (out / out.sum() if e["normalized"] else out)).reshape(-1)

    def step(self) -> None:
        """Advance the time, then each element."""
        self.t += self.dt
        for name, e in self.elements.items():
            kind, shape, outputs = e["label"][1], self.shape(name), self.out[name]
            if kind.startswith("neural field"):
                u = outputs["activation"]
                u = u + self.dt / e["tau"] * (-u + e["restingLevel"] + self.input(e, u.size))
                self.out[name] = {"activation": u, "output": squash(e["activationFunction"], u)}
            elif kind.startswith("timed"):
                on = any(a <= self.t <= b for a, b in e["onTimes"])
                outputs["output"] = self.stimulus(e, *shape) * on
            elif "stimulus" not in kind and "noise" not in kind:
                outputs["output"] = self.computed(name, e, kind, shape)

    def computed(self, name: str, e: dict[str, Any], kind: str, shape: tuple[int, int]) -> np.ndarray:
        """Return the output of all other elements."""
        n = shape[0] * shape[1]
        if kind.startswith("memory"):
            m, x = self.out[name]["output"], self.input(e, n)
            built = m + self.dt / e["tauBuild"] * (x - m)
            return np.where(x > e["threshold"], built, m - self.dt / e["tauDecay"] * m)
        if "kernel" in kind:
            x = self.input(e, n)
            return self.kernel(e, kind, x, shape) + e["amplitudeGlobal"] * x.sum()
        if "coupling" in kind:
            w = self.weights[name] if kind == "field coupling" else self.peaks(e)
            return e.get("scalar", 1.0) * (w.T @ self.input(e, len(w)))
        source = (e["inputs"] or [[None]])[0][0]
        came = self.shape(source)
        x = self.input(e, came[0] * came[1])
        if kind == "resize":
            return resized(x, n, e.get("method", 0))
        plane = x.reshape(came)
        if kind == "resize 2d":
            wide = np.array([resized(row, shape[1], e.get("method", 0)) for row in plane])
            return np.array([resized(c, shape[0], e.get("method", 0)) for c in wide.T]).T.reshape(-1)
        if kind == "collapse":
            how = (np.sum, np.mean, np.max, np.min)[e.get("compression", 0)]
            return how(plane, axis=0 if e.get("keepAxis", 0) == 0 else 1)
        along_x = e.get("broadcastProfileAxis", 0) == 0
        return np.array([[x[b if along_x else a] for b in range(shape[1])] for a in range(shape[0])]).reshape(
            -1
        )

    def kernel(self, e: dict[str, Any], kind: str, x: np.ndarray, shape: tuple[int, int]) -> np.ndarray:
        """Return the convolution."""
        if shape[0] == 1 and "2d" not in kind:
            return convolved(x, *line_kernel(e, shape[1]), e["circular"])
        if kind.startswith("mexican"):
            parts = [
                ("gauss", e["amplitudeExc"], e["widthExc"]),
                ("gauss", -e["amplitudeInh"], e["widthInh"]),
            ]
        else:
            parts = [(kind, e["amplitude"], e.get("width"))]
        total = np.zeros(shape)
        for label, amplitude, width in parts:
            settings = {**e, "width": width}
            plane = x.reshape(shape)
            across = factor(settings, label, shape[1], "_x")
            down = factor(settings, label, shape[0], "_y")
            plane = np.array([convolved(row, *across, e["circular"]) for row in plane])
            plane = np.array([convolved(column, *down, e["circular"]) for column in plane.T]).T
            total += amplitude * plane
        return total.reshape(-1)

    def peaks(self, e: dict[str, Any]) -> np.ndarray:
        """Return the weights of a coupling by Gaussian peaks, with samples counted from 0."""
        n, m = count(e, "input_x_max", "input_d_x"), count(e)
        out = np.zeros((n, m))
        for x, y, amplitude, width in e["couplings"]:
            for a in range(n):
                for b in range(m):
                    d, f = abs(a - x / e["input_d_x"]), abs(b - y / e["d_x"])
                    if e["circular"]:
                        d, f = min(d, n - d), min(f, m - f)
                    height = amplitude / (math.sqrt(2 * math.pi) * width) if e["normalized"] else amplitude
                    out[a, b] += height * math.exp(-(d**2 + f**2) / (2 * width**2))
        return out
