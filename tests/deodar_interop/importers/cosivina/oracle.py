"""A simulator with the semantics of cosivina, in plain NumPy: elements are computed in place, in the order of
a list, after the time has advanced.

Written from a description of the semantics; it uses nothing of deodar.
"""

from __future__ import annotations

import math

import numpy as np


def gauss(x, sigma, length=None):
    """Return a Gaussian, on a ring over the shorter distance; a width of 0 is one sample."""
    d = np.abs(x) if length is None else np.minimum(np.mod(x, length), length - np.mod(x, length))
    return (d == 0).astype(float) if sigma == 0 else np.exp(-0.5 * (d / sigma) ** 2)


def line(n, sigma, circular, normalized, reach):
    """Return the matrix of a kernel over one dimension, truncated at `reach` samples."""
    if n == 1:
        return np.ones((1, 1))
    if circular:
        left, right = min(reach, (n - 1) // 2), min(reach, math.ceil((n - 1) / 2))
    else:
        left = right = min(reach, n - 1)
    lags = np.arange(-left, right + 1)
    k = gauss(lags, sigma)
    k = k / k.sum() if normalized else k
    m = np.zeros((n, n))
    for lag, w in zip(lags, k, strict=True):
        for j in range(n):
            i = (j + lag) % n if circular else j + lag
            if 0 <= i < n:
                m[i, j] += w
    return m


def on(times, t):
    """Return whether t lies in a closed period."""
    return any(a <= t <= b for a, b in times)


class Sim:
    """A simulator of elements (label, class, parameters, inputs); inputs are (label, component)."""

    def __init__(self, elements, dt=1.0, t0=0.0):
        self.elements, self.dt, self.t = elements, dt, t0
        self.out = {}
        self.memory = {}
        self.sizes = {label: p.get("size", (1, 1)) for label, _, p, _ in elements}
        for label, kind, p, inputs in elements:
            self.out[label] = self.begin(label, kind, p, inputs)

    def begin(self, label, kind, p, inputs):
        size = p.get("size", (1, 1))
        match kind:
            case "NeuralField":
                u = np.full(size, float(p["h"]))
                return {
                    "activation": u,
                    "output": self.sigmoid(u, p["beta"]),
                    "h": np.full((1, 1), float(p["h"])),
                }
            case "SingleNodeDynamics":
                u = np.full((1, 1), float(p["h"]))
                g = self.sigmoid(u, p["beta"])
                return {
                    "activation": u,
                    "output": g,
                    "rateOfChange": (-u + p["h"] + p["selfExcitation"] * g) / p["tau"],
                }
            case "GaussStimulus1D" | "GaussStimulus2D" | "GaussStimulus3D":
                return {"output": self.bell(p)}
            case "BoostStimulus":
                return {"output": np.full((1, 1), float(p["amplitude"]))}
            case "CustomStimulus":
                return {"output": np.array(p["pattern"], float).reshape(size)}
            case "SumAllDimensions" | "LateralInteractions1D" | "LateralInteractions2D":
                rows, columns = size
                sums = {
                    "horizontalSum": np.zeros((1, rows)),
                    "verticalSum": np.zeros((1, columns)),
                    "fullSum": np.zeros((1, 1)),
                }
                return sums | {"output": np.zeros(size)}
            case "AdaptiveWeightMatrix":
                self.memory[label] = np.zeros(size)
                return {"output": np.zeros((1, size[1]))}
            case "WeightMatrix":
                return {"output": np.zeros((1, size[1]))}
            case "RunningHistory":
                return {"output": np.full((p["timeSlots"], size[1]), np.nan)}
            case "History":
                count = len(p["storingTimes"])
                return {"output": np.full((count, size[1]) if size[0] == 1 else (*size, count), np.nan)}
            case "DynamicVariable":
                return {"state": np.broadcast_to(np.array(p["initialState"], float), size)}
            case "CustomStimulusSequence":
                return {"output": np.zeros(p["stimulusSize"])}
            # cosivina leaves the position empty, so that nothing can be computed from it
            case "ScalarToGaussian":
                return {"output": np.zeros(size), "position": np.zeros((1, 1))}
            case "HebbianConnection":
                pre, post = (self.sizes[name] for name, _ in inputs[:2])
                self.memory[label] = np.zeros((np.prod(pre), np.prod(post)))
                return {"output": np.zeros(post)}
            case "MemoryTrace":
                return {"output": np.zeros(size), "activeRegions": np.zeros(size)}
            case "DiagonalSum":
                return {"output": np.zeros((1, 2 * p["inputSize"][0] - 1))}
            case "DiagonalExpansion":
                n = (p["inputSize"][1] + 1) // 2
                return {"output": np.zeros((n, n))}
            case "ShiftInput":
                return {"output": np.full(size, float(p["fillValue"]))}
        return {"output": np.zeros(size)}

    def sigmoid(self, u, beta, theta=0.0):
        return 1 / (1 + np.exp(-beta * (u - theta)))

    def bell(self, p):
        if "position" in p:
            n = p["size"][1]
            y = gauss(np.arange(1, n + 1) - p["position"], p["sigma"], n if p["circular"] else None)[None]
        else:
            y = np.ones(())
            for n, c in zip(p["size"], "YXZ", strict=False):
                y = y[..., None] * gauss(
                    np.arange(1, n + 1) - p[f"position{c}"], p[f"sigma{c}"], n if p[f"circular{c}"] else None
                )
        if p["normalized"] and y.sum() > 0:
            y = y / y.sum()
        return p["amplitude"] * y

    def step(self):
        self.t += self.dt
        for label, kind, p, inputs in self.elements:
            x = [self.out[name][component] for name, component in inputs]
            self.out[label].update(self.new(label, kind, p, x))

    def new(self, label, kind, p, x):
        o, t, dt = self.out[label], self.t, self.dt
        match kind:
            case "NeuralField":
                u = o["activation"]
                u = u + dt / p["tau"] * (-u + p["h"] + sum(x))
                return {"activation": u, "output": self.sigmoid(u, p["beta"])}
            case "SingleNodeDynamics":
                u = o["activation"] + dt * o["rateOfChange"]
                g = self.sigmoid(u, p["beta"])
                return {
                    "activation": u,
                    "output": g,
                    "rateOfChange": (-u + p["h"] + p["selfExcitation"] * g + sum(x)) / p["tau"],
                }
            case "MemoryTrace":
                active = x[0] > p["threshold"]
                if not active.any():
                    return {"activeRegions": active * 1.0}
                y = o["output"]
                return {
                    "activeRegions": active * 1.0,
                    "output": y + active * (x[0] - y) / p["tauBuild"] - ~active * y / p["tauDecay"],
                }
            case "GaussKernel1D" | "MexicanHatKernel1D" | "LateralInteractions1D":
                n = p["size"][1]
                up, wide = p.get("amplitudeExc", p.get("amplitude")), p.get("sigmaExc", p.get("sigma"))
                down, wider = p.get("amplitudeInh", 0), p.get("sigmaInh", 0)
                reach = math.ceil(
                    p["cutoffFactor"]
                    * (max((up != 0) * wide, (down != 0) * wider) if kind != "GaussKernel1D" else wide)
                )
                args = (p["circular"], p["normalized"], reach)
                y = (up * line(n, wide, *args) - down * line(n, wider, *args)) @ x[0][0]
                return {
                    "output": y[None] + p.get("amplitudeGlobal", 0) * x[0].sum(),
                    "fullSum": x[0].sum()[None, None],
                }
            case "GaussKernel2D" | "MexicanHatKernel2D" | "LateralInteractions2D":
                y = p.get("amplitudeGlobal", 0) * x[0].sum() * np.ones(p["size"])
                parts = (
                    [("", p["amplitude"])]
                    if "amplitude" in p
                    else [("Exc", p["amplitudeExc"]), ("Inh", -p["amplitudeInh"])]
                )
                for name, amplitude in parts:
                    m = [
                        line(
                            n,
                            p[f"sigma{name}{c}"],
                            p[f"circular{c}"],
                            p["normalized"],
                            math.ceil(p["cutoffFactor"] * p[f"sigma{name}{c}"]),
                        )
                        for n, c in zip(p["size"], "YX", strict=True)
                    ]
                    y = y + amplitude * m[0] @ x[0] @ m[1].T
                return {"output": y} | self.sums(x[0])
            case "KernelFFT":
                y = p["amplitudeGlobal"] * x[0].sum() * np.ones(p["size"])
                long = [d for d, n in enumerate(p["size"]) if n > 1]
                for amplitude, sigmas in (
                    (p["amplitudeExc"], p["sigmaExc"]),
                    (-p["amplitudeInh"], p["sigmaInh"]),
                ):
                    z = x[0]
                    for k, d in enumerate(long):
                        n, sigma = p["size"][d], np.ravel(sigmas)[k]
                        if np.ravel(p["circular"])[k]:
                            m = line(n, sigma, True, p["normalized"], n)
                        else:
                            pad = int(p["paddingFactor"] * sigma)
                            m = line(n + 2 * pad, sigma, True, p["normalized"], n + 2 * pad)[
                                pad : pad + n, pad : pad + n
                            ]
                        z = np.moveaxis(np.tensordot(m, z, axes=(1, d)), 0, d)
                    y = y + amplitude * z
                return {"output": y}
            case "SumAllDimensions":
                return self.sums(x[0])
            case "SumDimension":
                y = x[0].sum(axis=tuple(int(d) - 1 for d in np.ravel(p["sumDimensions"])))
                return {"output": p["amplitude"] * y.reshape(p["size"])}
            case "ExpandDimension2D":
                rows, columns = p["size"]
                y = np.ravel(x[0])
                return {
                    "output": np.tile(y, (rows, 1))
                    if p["expandDimension"] == 1
                    else np.tile(y[:, None], (1, columns))
                }
            case "Transpose":
                return {"output": x[0].T}
            case "SumInputs":
                return {"output": sum(x)}
            case "ScaleInput":
                return {"output": p["amplitude"] * x[0]}
            case "PointwiseProduct":
                return {"output": x[0] * x[1]}
            case "HalfWaveRectification":
                return {"output": np.maximum(x[0], 0)}
            case "Sigmoid":
                return {"output": self.sigmoid(x[0], p["beta"], p["threshold"])}
            case "WeightMatrix":
                return {"output": x[0] @ np.array(p["weights"], float).reshape(p["size"])}
            case "AdaptiveWeightMatrix":
                w = self.memory[label]
                gate = x[2].item() if len(x) > 2 else 1.0
                self.memory[label] = w + gate * p["learningRate"] * (x[1] - w) * x[0].T
                return {"output": x[0] @ w}
            case "RunningHistory":
                if t % p["interval"] == 0:
                    return {"output": np.vstack([x[0], o["output"][:-1]])}
            case "History":
                y = o["output"].copy()
                for k, moment in enumerate(p["storingTimes"]):
                    if moment == t:
                        y[(k, slice(None)) if p["size"][0] == 1 else (..., k)] = (
                            x[0][0] if p["size"][0] == 1 else x[0]
                        )
                return {"output": y}
            case "DynamicVariable":
                return {"state": o["state"] + dt / p["tau"] * sum(x)}
            case "CustomStimulusSequence":
                begun = [k for k, start in enumerate(p["startTimes"]) if start <= t]
                patterns = np.array(p["stimulusPatterns"], float)
                if not begun:
                    return {"output": np.zeros(p["stimulusSize"])}
                return {
                    "output": patterns[begun[-1]][None] if patterns.ndim == 2 else patterns[:, :, begun[-1]]
                }
            case "ScalarToGaussian":
                n, place = p["size"][1], p["inputScale"] * x[0].item() + p["inputOffset"]
                y = gauss(np.arange(1, n + 1) - place, p["sigma"], n if p["circular"] else None)[None]
                y = y / y.sum() if p["normalized"] and y.sum() > 0 else y
                return {"output": p["amplitude"] * y, "position": np.full((1, 1), place)}
            case "HebbianConnection":
                w, pre, post = self.memory[label], np.ravel(x[0]), np.ravel(x[1])
                rewarded = len(x) < 3 or x[2].item() > 0.9
                if rewarded:
                    # the default rule; cosivina does not call it instar
                    change = (pre[:, None] - w) * post[None, :]
                    self.memory[label] = w + dt * p["learningRate"] * change
                return {"output": (pre @ w).reshape(x[1].shape)}
            case "DiagonalSum":
                n = p["inputSize"][0]
                y = [sum(x[0][i, k - i] for i in range(n) if 0 <= k - i < n) for k in range(2 * n - 1)]
                return {"output": p["amplitude"] * np.array(y)[None]}
            case "DiagonalExpansion":
                n = (p["inputSize"][1] + 1) // 2
                return {"output": np.array([[x[0][0, i + j] for j in range(n)] for i in range(n)])}
            case "ShiftInput":
                s = int(np.ravel(p["shiftValue"])[-1])
                if p["circular"]:
                    return {"output": np.roll(x[0], s, axis=1)}
                y, n = o["output"].copy(), p["size"][1]
                for i in range(n):
                    if 0 <= i - s < n:
                        y[:, i] = x[0][:, i - s]
                return {"output": y}
            case "TimedGaussStimulus1D" | "TimedGaussStimulus2D":
                return {"output": on(p["onTimes"], t) * self.bell(p)}
            case "TimedCustomStimulus":
                return {
                    "output": on(p["onTimes"], t) * np.array(p["stimulusPattern"], float).reshape(p["size"])
                }
            case "TimedBoost":
                found = [k for k, (a, b) in enumerate(p["onTimes"]) if a <= t <= b]
                amplitudes = np.ravel(p["amplitude"])
                return {
                    "output": np.full(
                        (1, 1), float(amplitudes[min(found[0], len(amplitudes) - 1)]) if found else 0.0
                    )
                }
            case "TimedSwitch":
                return {"output": on(p["onTimes"], t) * x[0]}
        return {}

    def sums(self, x):
        return {
            "horizontalSum": x.sum(axis=1)[None],
            "verticalSum": x.sum(axis=0)[None],
            "fullSum": x.sum()[None, None],
        }
