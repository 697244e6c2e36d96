"""The checker: does the evidence of a certificate prove the claims that it names?

A second, small program that rechecks every claim of a certificate from the scene's document alone. It shares nothing
with the engines that made the claims, and imports nothing of dofkit outside this room; every constraint type is defined
a second time here, on purpose.

Types
    `Verification` is the result: claims that hold, claims that fail, and what is not covered. A `Told` is a mapping as
    the certificate has it. `refuse(wrong, why)` raises `CheckError` if ``wrong``.

Mechanisms, in the order of checking
    1. `problem` reads the scene's document: coordinates, scalar relations with their owners, and the reference.
       `grammar` reads its texts into `trees`, which are differentiated and substituted in; `constraints` and
       `geometry` write the equations of every constraint type.
    2. `relations` are those of the scene and those that steps of the certificate derive from them by identities in
       the `ring` of normal forms.
    3. `evidence` has what a certificate puts forward: points (`point`, with values in balls), minors of rows that hold
       there, velocity fields; `curves` what is isolated, crosses or is curved at a point.
    4. `dimension_rules`, `whole_sets`, `label_rules` and `motion` are the rules: one function for each kind of claim,
       which returns the value that it proves, and raises `CheckError` where a hypothesis fails.
    5. `verification` reads the certificate with care, bounded in work, and asks the rules. The format is described in
       ``FORMAT.md``.
"""

from dofkit.checker.trees import CheckError
from dofkit.checker.verification import Verification, verify

__all__ = ["CheckError", "Verification", "verify"]
