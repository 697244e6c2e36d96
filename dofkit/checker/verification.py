"""The driver: every claim of a certificate is looked at once, by the rule it names, in the checker's own reading."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass
from typing import Any

from dofkit.checker import dimension_rules as numbers
from dofkit.checker import label_rules as labels
from dofkit.checker import whole_rules as whole
from dofkit.checker.evidence import CheckedEvidence
from dofkit.checker.fields import take_cover
from dofkit.checker.format import PARTS, certificate_of
from dofkit.checker.problem import Problem, canonical, document_of, read_problem, sha256_of
from dofkit.checker.relations import FAULTS, told
from dofkit.checker.trees import CheckError, Effort, refuse

Rule = Callable[[CheckedEvidence, dict[str, Any], dict[str, Any]], object]
#: The rules: paths of the report (fields of an entry, without ``/``), names of rules, and what looks at them.
TABLE: tuple[tuple[str, str, Rule], ...] = (
    ("/consistent, /feasible", "point, regular", whole.consistent),
    ("/consistent", "nullstellensatz", whole.inconsistent),
    ("/conflicting", "conflict", whole.conflict),
    ("/dof, /velocity_dof", "squeeze, regular", numbers.bounds),
    ("/dof, /velocity_dof", "everywhere", whole.everywhere),
    (
        "/velocity_dof, /holonomic, /scleronomic, /redundant_equations, /redundancies, /singular",
        "count",
        numbers.counted,
    ),
    ("/instantaneous_dof", "rank", numbers.instantaneous),
    ("/redundant", "cofactors", numbers.redundant),
    ("independent", "independent", numbers.independence),
    ("/integrable_part", "integrals", numbers.integrable_part),
    ("/generalized_coordinates", "minor, frobenius, isolated", numbers.generalized_coordinates),
    ("/growth_vector", "span", numbers.growth),
    ("circuit", "cofactors", numbers.circuit),
    ("holonomic, holonomic_alone", "finite", labels.finite),
    ("holonomic, holonomic_alone, independent", "inequality", labels.inequality),
    ("holonomic, holonomic_alone", "integral, frobenius", labels.integrable),
    ("holonomic, holonomic_alone", "bracket", labels.bracket),
    ("holonomic_alone", "wedge", labels.wedge),
    ("scleronomic, catastatic", "timeless", labels.timeless),
    ("scleronomic, catastatic", "turns", labels.turns),
    ("exact", "exact, not exact", labels.exact),
    ("integrating_factor", "integral", labels.factor),
    ("integral", "integral", labels.integral),
)
RULES = {(path, rule): look for paths, rules, look in TABLE for path in paths.split(", ") for rule in rules.split(", ")}
#: What may be false of poses near the configuration alone.
LOCAL = ("/singular", "/holonomic", "/scleronomic")


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
    scene = given["scene"].get("document") if scene is None else scene
    if scene is None:
        raise CheckError("no scene is given, and none is in the certificate")
    return Verifier(document_of(scene) if isinstance(scene, str) else scene, given).run()


class Verifier:
    """One certificate while it is verified."""

    def __init__(self, document: Mapping[str, Any], given: dict[str, Any], problem: Problem | None = None) -> None:
        self.document, self.given, self.effort = document, given, Effort()
        other = given["scene"].get("sha256") != sha256_of(document)
        refuse(other, "the certificate is of another scene, or of this one before it was edited")
        self.problem = problem or read_problem(document)
        refuse("tolerance" in canonical(document), "what is measured up to a tolerance is not proved")
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
        failed, seen = list[dict[str, str]](), set(self.given["uncovered"])
        for claim in self.given["claims"]:
            path, rule = str(claim.get("path"))[:200], str(claim.get("rule"))[:60]
            try:
                refuse(path in seen, "the path is claimed twice, or claimed and uncovered")
                self.check(claim)
            except FAULTS as error:
                failed.append({"path": path, "rule": rule, "why": told(error)})
            seen.add(path)
        name, count = str(self.given["scene"].get("name", self.document.get("name")))[:200], len(self.given["claims"])
        return Verification(name, count, count - len(failed), failed, list(self.given["uncovered"]))

    def check(self, claim: dict[str, Any]) -> None:
        """`CheckError` unless the claim is shown; what was verified before may be used."""
        path, rule, value, cayley = claim["path"], claim["rule"], claim["value"], claim.get("cayley") is True
        whole = claim.get("about") == "everywhere" or path == "/conflicting" or value is False
        refuse(
            cayley and whole and path.startswith("/") and path.count("/") == 1 and path not in LOCAL,
            "a chart is no whole",
        )
        evidence, parts = self.evidence(cayley), path.split("/")
        refuse("about" in claim and path not in ("/dof", "/velocity_dof"), "only numbers of freedoms have an `about`")
        for name in claim.get("covers", []):
            take_cover(evidence, name)
        field = parts[3] if len(parts) == 4 and parts[:2] == ["", "constraints"] else ""
        look = RULES.get((field or path, rule)) if field or path.startswith("/") else None
        if look is None:
            raise CheckError(f"no rule `{str(rule)[:40]}` for `{path[:60]}`")
        owner = {"owner": parts[2].replace("~1", "/").replace("~0", "~"), "field": field} if field else {}
        found = look(evidence, {**claim, **owner}, self.verified)
        same = json.dumps(found, sort_keys=True) == json.dumps(value, sort_keys=True)
        refuse(not same, f"the evidence gives {found!r}, not {str(value)[:80]!r}")
        self.verified |= {path: value, f"{path} about": claim.get("about")}
