"""Claims are tried by the checker's own rules while they are made: evidence that does not do is not written down."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Literal

from dofkit.checker.problem import CheckedProblem as Problem
from dofkit.checker.relations import FAULTS, told
from dofkit.checker.verification import Verifier
from dofkit.methods.certificates.scenery import Scenery

Outcome = Literal["shown", "contradicted", "open"]


class ClaimTrial:
    """The checker at work on a certificate that grows."""

    def __init__(self, document: Mapping[str, Any], certificate: dict[str, Any], problem: Problem) -> None:
        self.verifier = Verifier(document, certificate, problem)
        self.reasons: dict[str, str] = {}

    def admit(self, scenery: Scenery) -> None:
        """Use a reading with what is known of it."""
        self.verifier.evidences[scenery.cayley] = scenery.evidence

    def outcome(self, claim: dict[str, Any]) -> Outcome:
        """Whether a claim is shown; ``contradicted`` where the evidence gives another value."""
        known = {cayley: len(one.consequences) for cayley, one in self.verifier.evidences.items()}
        try:
            self.verifier.check(claim)
        except FAULTS as error:
            self.reasons[claim["path"]] = told(error)
            self._forget(known)
            return "contradicted" if told(error).startswith("the evidence gives") else "open"
        return "shown"

    def _forget(self, known: Mapping[bool, int]) -> None:
        """Leave out what follows by covers of a claim that is not written down: who reads the others has it not."""
        for cayley, one in self.verifier.evidences.items():
            number = known.get(cayley, len(one.consequences))
            if number < len(one.consequences):
                del one.consequences[number:]
                gone = [key for key in one.seen if key[0] == "covers" or (key[0] == "met" and key[1] >= number)]
                for key in gone:
                    del one.seen[key]
