"""Special cases: loci on which a rank drops or the curvature vanishes, and branches of other dimensions.

Other parts of the report are about generic configurations. `minors` writes the rows of a small block as polynomials,
and computes the real zeros of their largest minors, and of the curvature d(omega) on their kernel, as short equations;
`cases` confirms each at a point over GF(p) and at a certified real point, and states what changes there.
If the answer is about one of several branches, the set outside it is analysed again [Rabinowitsch1929].
Only confirmed cases are listed, and the list need not be complete: large blocks are not searched.
"""

from __future__ import annotations

from dofkit.classification.special.cases import SEARCHED, special_cases

__all__ = ["SEARCHED", "special_cases"]
