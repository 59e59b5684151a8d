"""The field equation, stimuli, and attractor dynamics as loops over time."""

from __future__ import annotations

import math

import numpy as np

from tests.oracle.kernels import dense, each, grid


def sigmoid(g, u):
    match type(g).__name__:
        case "Logistic":
            return 1 / (1 + np.exp(-g.beta * (u - g.threshold)))
        case "Absolute":
            return 0.5 * (1 + g.beta * (u - g.threshold) / (1 + g.beta * abs(u - g.threshold)))
        case "Step":
            return np.where(u > g.threshold, 1.0, 0.0)
        case "Linear":
            return g.slope * (u - g.threshold)
        case "SemiLinear":
            return np.where(g.slope * (u - g.threshold) > 0, g.slope * (u - g.threshold), 0.0)
    raise NotImplementedError(type(g).__name__)


def antiderivative(g, u):
    v = u - g.threshold
    match type(g).__name__:
        case "Logistic":
            return math.log1p(math.exp(-abs(g.beta * v))) / g.beta + max(v, 0.0)
        case "Absolute":
            return 0.5 * (v + abs(v) - math.log1p(g.beta * abs(v)) / g.beta)
        case "Step":
            return max(v, 0.0)
        case "Linear":
            return 0.5 * g.slope * v * v
        case "SemiLinear":
            return 0.5 * g.slope * max(v, 0.0) ** 2
    raise NotImplementedError(type(g).__name__)


def mean(g, a, b):
    """Return the mean of g between a and b."""
    return (
        float(sigmoid(g, 0.5 * (a + b)))
        if abs(b - a) < 1e-7
        else (antiderivative(g, b) - antiderivative(g, a)) / (b - a)
    )


def beside(u, place, d, away, axis):
    """Return the value `away` samples from a position along axis d; beyond an end, extrapolate linearly
    from the last two.
    """
    i, n = place[d] + away, axis.samples

    def at(k):
        return float(u[tuple(k % n if e == d else p for e, p in enumerate(place))])

    if axis.periodic or 0 <= i < n:
        return at(i)
    return at(0) + i * (at(1) - at(0)) if i < 0 else at(n - 1) + (i - n + 1) * (at(n - 1) - at(n - 2))


CENTRAL = {1: 45 / 60, 2: -9 / 60, 3: 1 / 60}
"""The central difference of order 6: weights of u(i + k) - u(i - k)."""
DEBLUR = {0: 1247 / 960, 1: -79 / 480, -1: -79 / 480, 2: 29 / 1920, -2: 29 / 1920}


def cell_means(g, u, axes, last=None):
    """Return the mean of g over cells: along each axis, weighted by the fourth power of the slope."""
    out = np.zeros(u.shape)
    for place in np.ndindex(*u.shape):
        slopes = [beside(u, place, d, 1, a) - beside(u, place, d, -1, a) for d, a in enumerate(axes)]
        shares = [s**4 + 1e-9 for s in slopes]
        along = [line_mean(g, u, place, d, a, last or DEBLUR) for d, a in enumerate(axes)]
        out[place] = np.dot(shares, along) / sum(shares)
    return out


def bounded_cell_means(g, u, axes):
    """Return the same without the last line of the rule."""
    return cell_means(g, u, axes, {0: 1.0})


def line_mean(g, u, place, d, axis, last):
    """Return the output at a position along axis d; `last` are the weights of the blurred means.

    The values of activation at and between samples are sums of their differences, which are the weights of
    the output applied to the central difference of order 6. The first of them follows from C.
    """

    def at(k):
        return beside(u, place, d, k, axis)

    def difference(k):
        return sum(w * (at(k + j) - at(k - j)) for j, w in CENTRAL.items())

    def sharp(k):
        return sum(w * difference(k + j) for j, w in DEBLUR.items())

    def filtered(k):
        weights = (12047 / 5760, -37559 / 57600, 139 / 1200, -577 / 57600, 29 / 57600)
        return weights[0] * at(k) + sum(w * (at(k + j) + at(k - j)) for j, w in enumerate(weights) if j)

    v = {-3.0: (filtered(-4) + 2 * filtered(-3) + filtered(-2)) / 4}
    for k in range(-3, 3):
        v[k + 0.5] = v[k] + (3 * sharp(k) + sharp(k + 1)) / 8
        v[k + 1.0] = v[k + 0.5] + (sharp(k) + 3 * sharp(k + 1)) / 8

    def blurred(k):
        pieces = {-1.0: 1, -0.5: 3, 0.0: 3, 0.5: 1}
        return sum(w / 8 * mean(g, v[k + a], v[k + a + 0.5]) for a, w in pieces.items())

    return sum(w * blurred(k) for k, w in last.items())


def cell_means_0_1(g, u, axes):
    """Return the mean of g over cells as version 0.1: on a line with weights 1, 3, 3, 1 for the halves of
    both neighbouring intervals, whose ends follow from the differences D of the rule; over more axes the
    range of one sample along the steepest axis.
    """
    out = np.zeros(u.shape)
    for place in np.ndindex(*u.shape):
        if len(axes) == 1:
            at = {k: beside(u, place, 0, k, axes[0]) for k in range(-5, 6)}
            second = {k: at[k - 1] - 2 * at[k] + at[k + 1] for k in range(-4, 5)}
            fourth = {k: second[k - 1] - 2 * second[k] + second[k + 1] for k in range(-3, 4)}
            sharp = {k: at[k] - 3 / 8 * second[k] + 3 / 16 * fourth[k] for k in range(-3, 4)}
            d = {k: (sharp[k + 1] - sharp[k - 1]) / 2 for k in range(-2, 3)}
            v = {0: sharp[0] + (sharp[-1] - 2 * sharp[0] + sharp[1]) / 4}
            for k in (0, 1):
                v[k + 0.5] = v[k] + (3 * d[k] + d[k + 1]) / 8
                v[k + 1] = v[k + 0.5] + (d[k] + 3 * d[k + 1]) / 8
            for k in (0, -1):
                v[k - 0.5] = v[k] - (3 * d[k] + d[k - 1]) / 8
                v[k - 1] = v[k - 0.5] - (d[k] + 3 * d[k - 1]) / 8
            out[place] = sum(
                c / 8 * (mean(g, v[s * k], v[s * (k + 0.5)])) for s in (-1, 1) for k, c in ((0, 3), (0.5, 1))
            )
        else:
            slopes = [
                abs(beside(u, place, d, 1, a) - beside(u, place, d, -1, a)) / 2 for d, a in enumerate(axes)
            ]
            out[place] = mean(g, u[place] - max(slopes) / 2, u[place] + max(slopes) / 2)
    return out


def volume(axes):
    return math.prod(grid(a)[1] for a in axes)


class Field:
    """tau du/dt = -u + h + s + K g(u) - c integral g(u) dx, by Euler steps."""

    def __init__(self, field, many=12):
        self.p = field
        self.shape = tuple(a.samples for a in field.axes)
        self.weights = dense(field.kernel, field.axes, many)
        self.u = np.full(self.shape, field.resting_level, float)

    @property
    def output(self):
        if self.p.quadrature != "point" and self.p.axes:
            rule = cell_means if self.p.quadrature == "cell" else cell_means_0_1
            return rule(self.p.sigmoid, self.u, self.p.axes)
        return sigmoid(self.p.sigmoid, self.u)

    @property
    def interaction(self):
        g = self.output
        return (self.weights @ g.ravel()).reshape(self.shape) - self.p.global_inhibition * volume(
            self.p.axes
        ) * g.sum()

    def step(self, s, dt):
        self.u = self.u + dt / self.p.tau * (-self.u + self.p.resting_level + s + self.interaction)


def run(field, stimulus, steps, dt, many=12):
    """Return the activation at 0, dt, 2 dt, ...; `stimulus(k)` is the input during step k."""
    f = Field(field, many)
    seen = [f.u]
    for k in range(steps):
        f.step(stimulus(k), dt)
        seen.append(f.u)
    return np.array(seen)


def stimulus(s, time):
    """Return the values of a stimulus at a time."""
    shape = tuple(a.samples for a in s.axes)
    on = s.windows is None or any(w.start <= time + 1e-9 and time < w.stop - 1e-9 for w in s.windows)
    out = np.zeros(shape)
    for place in np.ndindex(*shape):
        value = s.amplitude if on else 0.0
        for d, (axis, i) in enumerate(zip(s.axes, place, strict=True)):
            x, step = grid(axis)
            away = x[i] - each(s.center, d) if hasattr(s, "center") else 0.0
            if axis.periodic:
                period = axis.upper - axis.lower
                away = min((away + m * period for m in range(-3, 4)), key=abs)
            if type(s).__name__ == "GaussianStimulus":
                value *= math.exp(-(away**2) / (2 * each(s.sigma, d) ** 2))
            elif type(s).__name__ == "BoxStimulus":
                half = each(s.width, d) / 2
                value *= max(0.0, min(away + step / 2, half) - max(away - step / 2, -half)) / step
        out[place] = value
    return out


def attractor(a, phi, f, dt):
    """Advance a motor variable by one step."""
    x, step = grid(a.axis)
    if a.axis.periodic:
        period = a.axis.upper - a.axis.lower
        rate = (
            sum(
                period / (2 * math.pi) * math.sin(2 * math.pi * (xi - phi) / period) * fi * step
                for xi, fi in zip(x, f, strict=True)
            )
            / a.tau
        )
    else:
        rate = sum((a.gain * xi + a.offset - phi) * fi * step for xi, fi in zip(x, f, strict=True)) / a.tau
    if a.fastest > 0:
        rate = min(a.fastest, max(-a.fastest, rate))
    phi = phi + dt * rate
    if a.axis.periodic:
        while phi >= a.axis.upper:
            phi -= period
        while phi < a.axis.lower:
            phi += period
    return phi
