"""The line of a Hopf point in the plane of two parameters, up to Bogdanov-Takens points."""

from __future__ import annotations

import numpy as np

from deodar.analysis.continuation.bifurcation import Bifurcation
from deodar.analysis.continuation.line import solved
from deodar.analysis.continuation.locus_plane import LocusEquations, LocusPlane, LocusPoint


class HopfPlane(LocusPlane):
    r"""The minimally augmented equations of a Hopf point; a point is z = (w x, k, p / l, q / l).

    The matrix A of growth rates, in units of the longest time constant, has the eigenvalues i omega and -i
    omega where A^2 + k has rank n - 2, with k = omega^2. At k = 0 the line ends in a Bogdanov-Takens point;
    beyond it two real growth rates have the sum 0, and nothing oscillates.

    Equation:
        \begin{pmatrix} A^2 + k & B \\ C^T & 0 \end{pmatrix}
        \begin{pmatrix} V \\ G \end{pmatrix} = \begin{pmatrix} 0 \\ 1 \end{pmatrix},\quad G = 0

    G has four numbers and two of them are independent on the line: the two combinations that change most.
    """

    def start(self, of: Bifurcation) -> np.ndarray:
        """Return the bifurcation as a point, and take its null vectors as borders."""
        values = np.array([of.value, self.first]) / self.lengths
        z = np.concatenate([self.weight * of.state, [(of.frequency * self._unit) ** 2], values])
        matrix = self._matrix(z)
        left, _, right = np.linalg.svd(matrix @ matrix + self._square(z) * np.eye(len(matrix)))
        self.borders = right[-2:].T, left[:, -2:]
        return z

    def linear(self, z: np.ndarray) -> LocusEquations:
        """Return the equations at a point; the borders span its null spaces, right and left."""
        equations, x, p, unit = self.right_hand_side, self.state(z), self.parameters(z), self._unit
        rates, jacobian, by = equations.linear(x, p)
        scale = unit / equations.time_constants
        a, n = jacobian * scale[:, None], x.size
        bordered = np.zeros((n + 2, n + 2))
        bordered[:n, :n] = a @ a + self._square(z) * np.eye(n)
        right, left = self.borders
        bordered[:n, n:], bordered[n:, :n] = left, right.T
        units = np.vstack([np.zeros((n, 2)), np.eye(2)])
        v, w = solved(bordered, units), solved(bordered.T, units)
        rows: list[np.ndarray] = []
        for i in (0, 1):
            for j in (0, 1):
                to, back = v[:n, j], w[:n, i]
                # w d(A^2) v = w dA (A v) + (w A) dA v
                pairs = ((a @ to, scale * back), (to, scale * (back @ a)))
                by_state, by_parameter = (
                    sum(parts)
                    for parts in zip(*(equations.curvature(x, p, *pair) for pair in pairs), strict=True)
                )
                parameters = np.asarray(by_parameter)[self.columns] * self.lengths
                rows.append(-np.concatenate([by_state / self.weight, [back @ to], parameters]))
        # two combinations of the four: those in which the line is steepest
        steepest = np.linalg.svd(np.array(rows))[0][:, :2]
        top = np.column_stack([jacobian / self.weight, np.zeros(n), by[:, self.columns] * self.lengths])
        residual = np.append(rates, steepest.T @ v[n:].ravel())
        borders = np.linalg.qr(v[:n])[0], np.linalg.qr(w[:n])[0]
        return LocusEquations(residual, np.vstack([top, steepest.T @ np.array(rows)]), borders)

    def left(self, z: np.ndarray) -> bool:
        """Return whether the line ends before this point: outside of the box, or where nothing oscillates."""
        return super().left(z) or self._square(z) < 0

    def ended(self, before: np.ndarray, after: np.ndarray) -> list[np.ndarray]:
        """Return the Bogdanov-Takens point in which a line ends, or its first point outside of the box."""
        if self._square(after) >= 0:
            return [after]
        place = self.between(before, after, self._square)
        if place is None:
            return []
        place[-3] = 0.0
        return [place]

    def points(self, walked: list[np.ndarray]) -> list[LocusPoint]:
        """Return the Bogdanov-Takens points at the ends."""
        ends = [walked[0], walked[-1]] if len(walked) > 1 else []
        values = [self.values(z) for z in ends if self._square(z) == 0]
        return [LocusPoint("Bogdanov-Takens", (float(first), float(second))) for first, second in values]

    def frequency(self, z: np.ndarray) -> float:
        """Return the angular frequency at a point, per document time."""
        return float(np.sqrt(max(self._square(z), 0.0))) / self._unit

    @property
    def _unit(self) -> float:
        return float(self.right_hand_side.time_constants.max())

    def _square(self, z: np.ndarray) -> float:
        """Return k."""
        return float(z[-3])

    def _matrix(self, z: np.ndarray) -> np.ndarray:
        """Return A."""
        equations = self.right_hand_side
        jacobian = equations.linear(self.state(z), self.parameters(z))[1]
        return jacobian * (self._unit / equations.time_constants)[:, None]
