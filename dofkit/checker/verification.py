"""The driver: every claim of a certificate is looked at once, by the rule it names, in the checker's own reading."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass
from typing import Any

from dofkit.checker import dependence_rules, dimension_rules, emptiness_rules, everywhere_rules, label_rules
from dofkit.checker.document import document_of, sha256_of
from dofkit.checker.effort import Effort
from dofkit.checker.errors import CheckError, refuse
from dofkit.checker.evidence import CheckedEvidence
from dofkit.checker.format import PARTS, certificate_of
from dofkit.checker.problem import Problem, read_problem
from dofkit.checker.relations import FAULTS, told

Rule = Callable[[CheckedEvidence, dict[str, Any]], object]
Counting = Callable[[CheckedEvidence, dict[str, Any], dict[str, Any]], None]
#: The rules of the whole: path and name of the rule.
WHOLE: dict[tuple[str, str], Rule] = {
    **{("/consistent", rule): emptiness_rules.consistent for rule in ("point", "regular", "motion")},
    **{("/consistent", rule): emptiness_rules.inconsistent for rule in ("nullstellensatz", "polygon", "boxes")},
    ("/conflicting", "conflict"): emptiness_rules.conflict,
    **{(path, rule): dimension_rules.freedom for path in ("/dof", "/velocity_dof") for rule in ("squeeze", "regular")},
    **{(path, "nothing"): everywhere_rules.nothing for path in ("/dof", "/velocity_dof")},
    **{("/dof", rule): everywhere_rules.everywhere for rule in ("everywhere", "graph", "one relation")},
    ("/dof", "generic rank"): everywhere_rules.generic_rank,
    **{("/feasible", rule): emptiness_rules.feasible for rule in ("point", "regular")},
    ("/instantaneous_dof", "rank"): dimension_rules.instantaneous,
    ("/count/independent", "independent"): dependence_rules.independent_in_all,
    ("/redundant", "cofactors"): dependence_rules.redundant,
}
COUNTING: dict[tuple[str, str], Counting] = {
    **{(path, "count"): dependence_rules.counted for path in ("/velocity_dof", "/holonomic", "/scleronomic")},
    ("/redundant_equations", "count"): dependence_rules.counted,
    ("/redundancies", "count"): dependence_rules.counted,
    ("/integrable_part", "integrals"): dependence_rules.integrable_part,
    ("/singular", "compare"): dependence_rules.counted,
    ("/generalized_coordinates", "minor"): dependence_rules.generalized_coordinates,
    ("/growth_vector", "span"): dependence_rules.growth,
}
#: What may be false of poses near the configuration alone.
LOCAL = ("/singular", "/holonomic", "/scleronomic")
#: The rules of an entry: field and name of the rule.
ENTRY: dict[tuple[str, str], Rule] = {
    **{
        (field, rule): check
        for field in ("holonomic", "holonomic_alone")
        for rule, check in (
            ("finite", label_rules.finite),
            ("inequality", label_rules.inequality),
            ("integral", label_rules.integrable),
            ("frobenius", label_rules.frobenius),
            ("bracket", label_rules.bracket),
            ("wedge", label_rules.wedge),
        )
    },
    **{(field, "timeless"): label_rules.timeless for field in ("scleronomic", "catastatic")},
    **{(field, "turns"): label_rules.turns for field in ("scleronomic", "catastatic")},
    ("exact", "exact"): label_rules.closed,
    ("exact", "not exact"): label_rules.not_closed,
    ("integrating_factor", "integral"): label_rules.factor,
    ("integral", "integral"): label_rules.integral,
    ("circuit", "cofactors"): dependence_rules.circuit,
    ("independent", "inequality"): label_rules.inequality,
    ("independent", "independent"): dependence_rules.independent_of_those_before,
}


@dataclass(frozen=True)
class Verification:
    """What came of it: how many claims there are, how many were verified, which failed and why, what is uncovered."""

    scene: str
    claims: int
    verified: int
    failed: list[dict[str, str]]
    uncovered: list[str]

    def as_json(self) -> dict[str, Any]:
        """The fields as JSON has them."""
        return asdict(self)


def verify(scene: Mapping[str, Any] | str | None, certificate: Mapping[str, Any] | str | bytes) -> Verification:
    """Recheck every claim of a certificate about a scene (its document, or its text).

    Without a scene, the document in the certificate is taken. A certificate that cannot be read, or that is of another
    scene, raises `CheckError`; a claim that is not shown is told in ``failed``.
    """
    given = certificate_of(certificate)
    if scene is None:
        scene = given["scene"].get("document")
    if scene is None:
        raise CheckError("no scene is given, and none is in the certificate")
    document = document_of(scene) if isinstance(scene, str) else scene
    return Verifier(document, given).run()


class Verifier:
    """One certificate while it is verified."""

    def __init__(self, document: Mapping[str, Any], given: dict[str, Any], problem: Problem | None = None) -> None:
        self.document, self.given, self.effort = document, given, Effort()
        if given.get("scene", {}).get("sha256") != sha256_of(document):
            raise CheckError("the certificate is of another scene, or of this one before it was edited")
        self.problem = problem or read_problem(document)
        refuse(self.problem.tolerance is not None, "what is measured up to a tolerance is not proved")
        self.evidences: dict[bool, CheckedEvidence] = {}
        self.verified: dict[str, Any] = {}

    def evidence(self, cayley: bool) -> CheckedEvidence:
        """The evidence in the plain reading, or with Cayley parameters."""
        if cayley not in self.evidences:
            bodies = frozenset(self.given["cayley"])
            refuse(cayley and not bodies, "no body is read with Cayley parameters")
            problem = read_problem(self.document, bodies) if cayley else self.problem
            parts = {part: self.given[part] for part in PARTS}
            self.evidences[cayley] = CheckedEvidence(problem, parts, self.effort)
        return self.evidences[cayley]

    def run(self) -> Verification:
        """Every claim in its order."""
        failed: list[dict[str, str]] = []
        seen: set[str] = set()
        for claim in self.given["claims"]:
            path, rule = str(claim.get("path"))[:200], str(claim.get("rule"))[:60]
            try:
                refuse(path in seen, "the path is claimed twice")
                refuse(path in self.given["uncovered"], "the path is claimed and uncovered")
                self.check(claim)
            except FAULTS as error:
                failed.append({"path": path, "rule": rule, "why": told(error)})
            seen.add(path)
        count = len(self.given["claims"])
        name = str(self.given["scene"].get("name", self.problem.name))[:200]
        return Verification(name, count, count - len(failed), failed, list(self.given["uncovered"]))

    def check(self, claim: dict[str, Any]) -> None:
        """`CheckError` unless the claim is shown; what was verified before may be used."""
        path, rule = claim["path"], claim["rule"]
        evidence = self.evidence(claim.get("cayley") is True)
        whole = claim.get("about") == "everywhere" or path == "/conflicting" or claim["value"] is False
        refuse(
            claim.get("cayley") is True and whole and path.count("/") == 1 and path not in LOCAL, "a chart is no whole"
        )
        for name in claim.get("covers", []):
            dimension_rules.take_cover(evidence, name)
        parts = path.split("/")
        if (path, rule) in WHOLE:
            place = WHOLE[path, rule](evidence, claim)
            self.verified[f"{path} at"] = place if isinstance(place, str) else None
            self.verified[f"{path} about"] = claim.get("about")
        elif (path, rule) in COUNTING:
            COUNTING[path, rule](evidence, claim, self.verified)
        elif len(parts) == 4 and parts[:2] == ["", "constraints"] and (parts[3], rule) in ENTRY:
            owner = parts[2].replace("~1", "/").replace("~0", "~")
            ENTRY[parts[3], rule](evidence, {**claim, "owner": owner, "field": parts[3]})
        else:
            raise CheckError(f"no rule `{str(rule)[:40]}` for `{path[:60]}`")
        self.verified[path] = claim["value"]
