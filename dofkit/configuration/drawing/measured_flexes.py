"""The second order of measured drawings: stress forms on the first-order motions, with how far noise may change them.

Let J be the Jacobian at the drawing, of rank r within the tolerance, and J_0 a matrix of rank r near it, that of an
exact geometry within the tolerance. A stress l, with l J_0 = 0, and a motion v, with J_0 v = 0, have the number
Q_l(v) = sum l_i (d^2 f_i)(v, v): the second order of the dependent relation l f on the manifold of the others. The
spaces of J and of J_0 differ by |J - J_0| / s, s the least singular value that counts [Wedin1972], and the forms by
that times the second derivatives, for the stress and for both motions, and by what the second derivatives change
themselves, |J - J_0| again: their entries are balls, so that what they prove holds for all such geometries.
"""

from __future__ import annotations

from functools import cached_property
from typing import Any

from flint import arb

from dofkit.base.libraries import np
from dofkit.configuration.drawing.measured_relations import SLACK, MeasuredDrawing
from dofkit.configuration.local.quadratic_cone import (
    MAX_CUTS,
    definite_combination,
    macaulay_matrix,
)

#: Second derivatives are differences over so short a way, and right to within this part.
WAY, ROUGH = 1e-5, 1e-6
#: The changes of the size |J - J_0| / s that a form takes: of its stress and of both its motions.
CHANGES = 3.0
#: What is by so much less than the rest of a form is taken for 0: it would hardly be so small by chance.
SLIGHT = 1e-2
#: Random subspaces on which forms without a common zero are looked for.
TRIES = 3


class StressForms:
    """``forms`` (k x w x w) on a drawing's w motions across those of the whole; ``noise`` bounds their change."""

    def __init__(self, drawing: MeasuredDrawing) -> None:
        relations, ways = drawing.relations, drawing.ways
        forms = np.zeros((len(drawing.stresses), len(ways), len(ways)))
        slopes = []
        for a, v in enumerate(ways):
            ahead = relations.system(relations.moved(drawing.at, WAY * v), drawing.norms)[1]
            back = relations.system(relations.moved(drawing.at, -WAY * v), drawing.norms)[1]
            slope = (ahead - back) / (2 * WAY)
            slopes.append(slope)
            forms[:, a, :] = drawing.stresses @ slope @ ways.T
        self.forms = (forms + forms.transpose(0, 2, 1)) / 2
        bend = float(np.linalg.norm(np.hstack(slopes), 2))
        turned = SLACK * drawing.tolerance / drawing.least
        changed = CHANGES * turned * (1 + turned) * bend + SLACK * drawing.tolerance
        self.noise = changed + ROUGH * (1 + bend)
        self.drawing = drawing

    @property
    def ways(self) -> int:
        """w."""
        return int(self.forms.shape[1])

    @cached_property
    def balls(self) -> list[list[list[arb]]]:
        """The forms with their noise."""
        return [[[arb(v, self.noise) for v in row] for row in form.tolist()] for form in self.forms]

    @cached_property
    def vanish(self) -> bool:
        """Is none of them seen not to be 0?"""
        return all(v.contains(0) for form in self.balls for row in form for v in row)

    @property
    def change_sign(self) -> bool:
        """Is it one form, with squares of both signs? No eigenvalue changes by more than the noise."""
        if len(self.forms) != 1:
            return False
        values = np.linalg.eigvalsh(self.forms[0])
        return bool(values[0] < -self.noise and values[-1] > self.noise)

    @property
    def definite(self) -> bool:
        """Is a combination of them definite?"""
        if any(
            np.all(values > self.noise) or np.all(values < -self.noise) for values in np.linalg.eigvalsh(self.forms)
        ):
            return True
        return definite_combination(self.balls, self.ways)

    @cached_property
    def cone(self) -> int:
        """An upper bound of the dimension of their common zeros, across the motions of the whole."""
        kernel, noise = self._kernel
        return _complex_bound(self._on(kernel), noise)

    @property
    def kernel(self) -> Any:
        """A subspace, by its basis as columns, near all real common zeros."""
        return self._kernel[0]

    @cached_property
    def _kernel(self) -> tuple[Any, float]:
        """The kernels of forms of one sign, one within another, and the noise of all forms on the last.

        A form with values above s > 0 across a subspace, and between -e and e on it, is 0 within the angle
        (2 e / s)^1/2 of the subspace only; there other forms differ by twice as much of their size.
        """
        kernel, noise = np.eye(self.ways), self.noise
        while True:
            smaller = self._smaller(kernel, noise)
            if smaller is None:
                return kernel, noise
            kernel, angle = smaller
            noise += 2 * angle * float(np.max(np.linalg.norm(self.forms, 2, axis=(1, 2))))

    def _smaller(self, kernel: Any, noise: float) -> tuple[Any, float] | None:
        """The kernel of a combination that is of one sign on a subspace, and the angle; None where none is found."""
        inside = self._on(kernel)
        flat = inside.reshape(len(inside), -1)
        for weights in (*np.eye(len(inside)), *np.linalg.svd(flat)[0].T):
            values, vectors = np.linalg.eigh(np.einsum("k,kab->ab", weights, inside))
            hidden = noise * float(np.sum(np.abs(weights)))
            small = np.abs(values) <= hidden
            least = float(np.min(np.abs(values[~small]), initial=np.inf))
            one_sign = np.all(values > -hidden) or np.all(values < hidden)
            if not np.all(small) and one_sign and hidden < SLIGHT * least:
                return kernel @ vectors[:, small], float(np.sqrt(2 * hidden / least))
        return None

    def _on(self, subspace: Any) -> Any:
        return np.einsum("ia,kij,jb->kab", subspace, self.forms, subspace)


def _complex_bound(forms: Any, noise: float) -> int:
    """The dimension of the forms' common complex zeros at the most, by matrices that are of full rank for all noise.

    See `quadratic_cone.bound`.
    """
    w = int(forms.shape[1])
    rng = np.random.default_rng(5)
    for cuts in range(min(w, len(forms), MAX_CUTS), 0, -1):
        for _ in range(TRIES):
            basis = np.linalg.qr(rng.standard_normal((w, cuts)))[0]
            rows = np.array(macaulay_matrix([(basis.T @ form @ basis).tolist() for form in forms], cuts), dtype=float)
            change = 2 * noise * w * float(np.sqrt(np.count_nonzero(rows)))
            singular = np.linalg.svd(rows, compute_uv=False)
            if len(singular) == rows.shape[1] and singular[-1] > change:
                return w - cuts
    return w
