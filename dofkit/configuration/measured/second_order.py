"""The second order of a measured pose, with bounds of what the tolerance may change in it.

Let J be the Jacobian at the pose, of rank r within the tolerance, and J_0 a matrix of rank r near it, that of an exact
geometry within the tolerance. A stress l, with l J_0 = 0, and a motion v, with J_0 v = 0, give the number
Q_l(v) = sum l_i (d^2 f_i)(v, v), the second order of the dependent equation l f on the manifold of the others. The null
spaces of J and J_0 differ by |J - J_0| / s, s the least singular value that counts [Wedin1972], and the forms by that
times the second derivatives, for the stress and for both motions, and by what the second derivatives change
themselves: entries are balls of this radius, so that what they prove holds for all such geometries.
"""

from __future__ import annotations

from functools import cached_property

from flint import arb

from dofkit.base.libraries import np
from dofkit.configuration.local.quadratic_cone import MAX_CUTS, definite_combination, macaulay_matrix
from dofkit.configuration.measured.equations import SLACK, MeasuredPose

#: Second derivatives are differences over `DELTA`, and accurate to `ROUGH`.
DELTA, ROUGH = 1e-5, 1e-6
#: The perturbations of size |J - J_0| / s in a form: of its stress and of both its motions.
PERTURBATIONS = 3.0
#: Random subspaces on which forms without a common zero are sought.
SUBSPACES = 3


class StressForms:
    """``forms`` (k x w x w) of the stresses on a pose's w flexes; ``noise`` bounds their change by the tolerance."""

    def __init__(self, pose: MeasuredPose) -> None:
        equations, flexes = pose.equations, pose.flexes
        forms = np.zeros((len(pose.stresses), len(flexes), len(flexes)))
        slopes = []
        for a, v in enumerate(flexes):
            ahead = equations.system(equations.moved(pose.at, DELTA * v), pose.norms)[1]
            back = equations.system(equations.moved(pose.at, -DELTA * v), pose.norms)[1]
            slope = (ahead - back) / (2 * DELTA)
            slopes.append(slope)
            forms[:, a, :] = pose.stresses @ slope @ flexes.T
        self.forms = (forms + forms.transpose(0, 2, 1)) / 2
        bend = float(np.linalg.norm(np.hstack(slopes), 2))
        turned = SLACK * pose.tolerance / pose.least
        perturbation = PERTURBATIONS * turned * (1 + turned) * bend + SLACK * pose.tolerance
        self.noise = perturbation + ROUGH * (1 + bend)
        self.flexes = len(flexes)

    @cached_property
    def balls(self) -> list[list[list[arb]]]:
        """The forms with their noise."""
        return [[[arb(v, self.noise) for v in row] for row in form.tolist()] for form in self.forms]

    @cached_property
    def vanish(self) -> bool:
        """Whether all of them may be 0."""
        return all(v.contains(0) for form in self.balls for row in form for v in row)

    @property
    def change_sign(self) -> bool:
        """Whether there is one form, and it takes both signs; no eigenvalue changes by more than the noise."""
        if len(self.forms) != 1:
            return False
        values = np.linalg.eigvalsh(self.forms[0])
        return bool(values[0] < -self.noise and values[-1] > self.noise)

    @property
    def definite(self) -> bool:
        """Whether a combination of them is definite."""
        for values in np.linalg.eigvalsh(self.forms):
            if np.all(values > self.noise) or np.all(values < -self.noise):
                return True
        return definite_combination(self.balls, self.flexes)

    @property
    def cone_bound(self) -> int:
        """An upper bound of the dimension of their common zeros, over the complex numbers [Macaulay1902].

        See `quadratic_cone.bound`; the Macaulay matrices are of full rank for all forms within the noise.
        """
        w = self.flexes
        rng = np.random.default_rng(5)
        for cuts in range(min(w, len(self.forms), MAX_CUTS), 0, -1):
            for _ in range(SUBSPACES):
                basis = np.linalg.qr(rng.standard_normal((w, cuts)))[0]
                restricted = [(basis.T @ form @ basis).tolist() for form in self.forms]
                rows = np.array(macaulay_matrix(restricted, cuts), dtype=float)
                change = 2 * self.noise * w * float(np.sqrt(np.count_nonzero(rows)))
                singular = np.linalg.svd(rows, compute_uv=False)
                if len(singular) == rows.shape[1] and singular[-1] > change:
                    return w - cuts
        return w
