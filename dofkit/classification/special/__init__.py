"""Where the answers change: loci on which a rank drops or the curvature vanishes, and special parameter values.

Every answer elsewhere is the generic one. Candidates are the common real zeros of the largest minors of the rows, of
the curvature d(omega) on their kernel, and of coefficients' denominators; those between parameters alone are put into
the scene, which is answered again. Only what is confirmed to differ from the generic answer is listed, and it is not
claimed that the list is complete: large blocks are not searched.
"""

from __future__ import annotations

from dofkit.classification.special.cases import SEARCHED, special_cases

__all__ = ["SEARCHED", "special_cases"]
