"""Evidence for equations of motion: a point of the motions, rows, and what relations are multiples of."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from fractions import Fraction
from typing import Any

from dofkit.checker.motion import FIELDS
from dofkit.checker.problem import CheckedProblem as Problem
from dofkit.checker.trees import ONE, Tree, along, number, substituted, symbol
from dofkit.methods.certificates.certificate import HINDRANCES, Certifying, without_spare_parts
from dofkit.methods.certificates.context import Context, Told
from dofkit.methods.certificates.lowering import scene_for_checker
from dofkit.methods.certificates.numerics import Estimates
from dofkit.methods.certificates.points import FoundPoint
from dofkit.methods.certificates.scenery import exponentials, number_text, text_of
from dofkit.report import Report
from dofkit.scene.scene import Scene

PATH = "/motion"
#: The most points that are tried.
MOST_POINTS = 4


def certificate_of_motion(scene: Scene, motion: Mapping[str, Any], report: Report) -> dict[str, Any]:
    """Return the certificate of the equations of motion on a ``report``; "uncovered" if no evidence was found."""
    fields = {name: motion[name] for name in FIELDS}
    document, readings = scene_for_checker(scene)
    making = Certifying(document, report, readings)
    claim = making.confirmed(PATH, fields, lambda context: MotionEvidence(context, fields).claims(), True)
    making.certificate |= {"claims": [claim]} if claim else {"uncovered": [PATH]}
    return without_spare_parts(making.certificate)


class MotionEvidence:
    """The equations of ``motion``, with the scene as the checker reads it."""

    def __init__(self, context: Context, motion: dict[str, Any]) -> None:
        self.context, self.motion, self.evidence = context, motion, context.scenery.evidence
        self.problem: Problem = context.problem
        self.constants = self._constants()
        self.eliminated = {q: self.read(text) for q, text in motion["eliminated"].items()}
        constraints = map(self.read, motion["constraints"])
        self.constraint_of_multiplier = dict(zip(motion["multipliers"], constraints, strict=True))

    def _constants(self) -> dict[str, str]:
        """Return {name: "0"} for the constants of integration in the expressions of eliminated coordinates."""
        names = ["C", *(f"{letter}{k}" for letter in ("C", "C_") for k in range(1, 5))]
        declared = {*self.problem.world.signs, *self.problem.coordinates}
        texts = self.motion["eliminated"].values()
        return {name: "0" for name in names if name not in declared and any(name in text for text in texts)}

    def read(self, text: str) -> Tree:
        """Return a text of the motion report as the checker's expression tree."""
        kept = (f"{q}ddot" for q in self.motion["coordinates"])
        return self.evidence.text(text.removesuffix("= 0"), [*self.motion["multipliers"], *self.constants, *kept])

    def claims(self) -> Iterator[Told]:
        """Yield claims of the rule `lagrange`: for each point with a minor of full rank, and each choice of factors."""
        claim: Told = {"rule": "lagrange", "c": self.cofactors()}
        claim |= {"constants": self.constants} if self.constants else {}
        size = len(self.eliminated) + len(self.constraint_of_multiplier)
        # The multipliers and eliminated coordinates are unique where this many rows are independent.
        ranks = (self.context.standing_of(self.context.scenery.equations, point=point) for point in self.points())
        minors = ({"minor": self.context.minor(r)} for r in ranks if r is not None and len(r.rows) == size)
        for minor in minors if size else [{}]:
            for factors in self.factors():
                yield {**claim, **factors, **minor}

    def factors(self) -> Iterator[Told]:
        """Yield no factors, then for each exponential in the Lagrangian the claim that it divides every equation."""
        yield {}
        for power_of_e in exponentials(self.read(self.motion["lagrangian"])):
            yield {"factors": dict.fromkeys(self.motion["coordinates"], power_of_e)}

    def cofactors(self) -> dict[str, dict[str, str]]:
        """Return {relation: {multiplier: k}}: with ``eliminated`` put in, it is k times the multiplier's constraint."""
        rates = {**{q: symbol(f"{q}dot") for q in self.problem.coordinates}, "t": ONE}
        put: dict[str, Tree] = {"tdot": ONE, **self.eliminated}
        put |= {f"{q}dot": along(rates, tree) for q, tree in self.eliminated.items()}
        multiples, ring = {}, self.evidence.ring
        for name in self.evidence.equations:
            residue = substituted(self.evidence.relation(name).tree, put)
            for multiplier, tree in self.constraint_of_multiplier.items() if not ring.vanishes(residue) else ():
                ratio = ring.rational(residue / tree)
                if ratio is not None:
                    multiples[name] = {multiplier: number_text(Fraction(int(ratio.p), int(ratio.q)))}
        return multiples

    def points(self) -> Iterator[FoundPoint]:
        """Yield the main point; without reference and multipliers, points with given remaining coordinates."""
        if not self.problem.reference and not self.constraint_of_multiplier:
            yield from filter(None, map(self._put_in, range(MOST_POINTS)))
        elif self.context.point is not None:
            yield self.context.point

    def _put_in(self, attempt: int) -> FoundPoint | None:
        values = dict(self.context.scenery.parameters)
        values |= {q: Fraction(k + attempt + 2, 7 + 2 * attempt) for k, q in enumerate(self.motion["coordinates"])}
        values |= {"t": Fraction(attempt, 3)} if self.context.scenery.timed else {}
        values |= {name: Fraction(self.constants[name]) for name in self.constants}
        texts = {name: number_text(value) for name, value in values.items() if name not in self.constants}
        floats = {name: float(value) for name, value in values.items()}
        numbers = {name: number(value) for name, value in values.items()}
        try:
            for q, tree in self.eliminated.items():
                texts[q] = text_of(substituted(tree, numbers))
                floats[q] = Estimates(floats).value(self.context.scenery.chosen(tree))
        except HINDRANCES:
            return None
        return FoundPoint(texts, floats)
