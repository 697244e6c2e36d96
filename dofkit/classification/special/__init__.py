"""Where the answers change: loci on which a rank drops or the curvature vanishes, and branches of other dimensions.

Every answer elsewhere is the generic one. `minors` writes the rows of a small block as polynomials, and finds the real
zeros of their largest minors, and of the curvature d(omega) on their kernel, as equations that a person can read;
`cases` confirms each at a point over GF(p) and at a certified real one, and states what changes there.
Where the answer belongs to one of several branches, the set outside it is answered again [Rabinowitsch1929].
Only what is confirmed to differ is listed, and it is not claimed that the list is complete: large blocks are not
searched.
"""

from __future__ import annotations

from dofkit.classification.special.cases import SEARCHED, special_cases

__all__ = ["SEARCHED", "special_cases"]
