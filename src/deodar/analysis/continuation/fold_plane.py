"""The line of a fold or branch point in the plane of two parameters, with its cusps."""

from __future__ import annotations

import numpy as np

from deodar.analysis.continuation.bifurcation import Bifurcation
from deodar.analysis.continuation.line import solved
from deodar.analysis.continuation.locus_plane import LocusEquations, LocusPlane, LocusPoint


class FoldPlane(LocusPlane):
    """The minimally augmented equations of a fold or branch point; a point is z = (w x, p / l, q / l)."""

    _symmetric = False
    _seen: tuple[np.ndarray, np.ndarray] = np.zeros(0), np.zeros(0)

    def start(self, of: Bifurcation) -> np.ndarray:
        """Return the bifurcation as a point, and take its null vectors as borders."""
        self._symmetric = of.kind == "branch point"
        z = np.concatenate([self.weight * of.state, np.array([of.value, self.first]) / self.lengths])
        self.borders = self._null(z)
        return z

    def linear(self, z: np.ndarray) -> LocusEquations:
        """Return the equations at a point; the borders are its null vectors, right and left."""
        equations, x, p = self.right_hand_side, self.state(z), self.parameters(z)
        rates, jacobian, by = equations.linear(x, p)
        n = x.size
        bordered = np.zeros((n + 1, n + 1))
        right, left = self.borders
        bordered[:n, :n], bordered[:n, n], bordered[n, :n] = jacobian, left, right
        unit = np.append(np.zeros(n), 1.0)
        v, w = solved(bordered, unit), solved(bordered.T, unit)
        by_state, by_parameter = equations.curvature(x, p, v[:n], w[:n])
        top = np.column_stack([jacobian / self.weight, by[:, self.columns] * self.lengths])
        bottom = np.append(-by_state / self.weight, -by_parameter[self.columns] * self.lengths)
        borders = v[:n] / np.linalg.norm(v[:n]), w[:n] / np.linalg.norm(w[:n])
        return LocusEquations(np.append(rates, v[n]), np.vstack([top, bottom]), borders)

    def points(self, walked: list[np.ndarray]) -> list[LocusPoint]:
        """Return the cusps and Bogdanov-Takens points."""
        if self._symmetric:
            return []  # both tests are 0 by symmetry
        out: list[tuple[int, LocusPoint]] = []
        for kind, test in {"cusp": self._bend, "Bogdanov-Takens": self._double}.items():
            before: float | None = None
            self._seen = self._null(walked[0])
            for k, z in enumerate(walked):
                after = test(z)
                if before is not None and before * after < 0:
                    place = self.between(walked[k - 1], z, test)
                    if place is not None:
                        first, second = self.values(place)
                        out.append((k, LocusPoint(kind, (float(first), float(second)))))
                before = after
        return [point for _, point in sorted(out, key=lambda pair: pair[0])]

    def beyond(self, z: np.ndarray) -> np.ndarray:
        """Return the direction in the plane in which both states of a fold vanish, in lengths."""
        equations, x, p = self.right_hand_side, self.state(z), self.parameters(z)
        v, w = self._null(z)
        bend = float(equations.curvature(x, p, v, w)[0] @ v)
        slopes = equations.gradient(x, p, w)[self.columns] * self.lengths
        return slopes * _sign(bend) / (np.linalg.norm(slopes) or 1.0)

    def _vectors(self, z: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the null vectors, right and left; their signs follow the line."""
        v, w = self._null(z)
        return v * _sign(float(v @ self._seen[0])), w * _sign(float(w @ self._seen[1]))

    def _null(self, z: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        left, _, right = np.linalg.svd(self.right_hand_side.linear(self.state(z), self.parameters(z))[1])
        return right[-1], left[:, -1]

    def _bend(self, z: np.ndarray) -> float:
        """Return w F_xx v v, which is 0 at a cusp."""
        v, w = self._seen = self._vectors(z)
        by_state, _ = self.right_hand_side.curvature(self.state(z), self.parameters(z), v, w)
        # the sign of v does not matter, that of w follows the line
        return float(by_state @ v)

    def _double(self, z: np.ndarray) -> float:
        """Return w T v, which is 0 where 0 is a double growth rate."""
        v, w = self._seen = self._vectors(z)
        return float(w @ (self.right_hand_side.time_constants * v))


def _sign(number: float) -> float:
    return -1.0 if number < 0 else 1.0
