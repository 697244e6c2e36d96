"""The verifier: a certificate is read with care, bounded in work, and every claim is put to its rule.

The format of certificates, with every step, bound and rule, is described in ``FORMAT.md`` beside this module.
"""

import json
from collections.abc import Callable, Mapping
from functools import partial
from typing import Any, NamedTuple

from dofkit.checker import dimension_rules as numbers
from dofkit.checker import label_rules as labels
from dofkit.checker.evidence import CheckedEvidence, take_cover
from dofkit.checker.motion import motion
from dofkit.checker.problem import CheckedProblem as Problem
from dofkit.checker.problem import canonical, problem_of_canonical, sha256_of
from dofkit.checker.relations import FAULTS, fault_text
from dofkit.checker.trees import CheckError, Effort, refuse
from dofkit.checker.whole_sets import everywhere

LARGEST_TEXT, MOST_ENTRIES = 20_000_000, 20_000
PARTS = ("relations", "points", "minors", "fields", "covers")
#: The fields of a certificate that are lists, and of what.
LISTS: dict[str, Any] = {**dict.fromkeys((*PARTS, "claims"), dict), "cayley": str, "uncovered": str}
Rule = Callable[[CheckedEvidence, dict[str, Any], dict[str, Any]], object]
#: The rules: paths of the report (fields of an entry, without ``/``), names of rules, and what looks at them.
TABLE: tuple[tuple[str, str, Rule], ...] = (
    ("/consistent, /feasible", "point, regular", labels.consistent),
    ("/consistent", "nullstellensatz", labels.refuted), ("/conflicting", "conflict", labels.conflict),
    ("/dof", "squeeze, regular", numbers.bounds), ("/velocity_dof", "regular", numbers.bounds),
    ("/velocity_dof, /redundant_equations, /redundancies", "count", numbers.counted),
    ("/holonomic, /scleronomic, /singular, /generalized_coordinates", "count", numbers.counted),
    ("/instantaneous_dof", "rank", numbers.instantaneous), ("/redundant", "cofactors", numbers.redundant),
    ("independent", "independent", numbers.independence), ("independent", "inequality", labels.by_kind),
    ("/integrable_part", "integrals", labels.integrable_part), ("/growth_vector", "span", numbers.growth),
    ("/generalized_coordinates", "minor, frobenius, isolated", numbers.generalized_coordinates),
    ("holonomic, holonomic_alone", "finite, inequality", labels.by_kind),
    ("holonomic, holonomic_alone", "integral, frobenius", labels.integrable),
    ("holonomic, holonomic_alone", "bracket, curved", labels.bracket), ("circuit", "cofactors", numbers.circuit),
    ("scleronomic, catastatic", "timeless", labels.timeless),
    ("scleronomic, catastatic", "time-dependent", labels.time_dependent),
    ("exact", "exact, not exact", labels.exact), ("integral", "integral", labels.integral),
    ("/dof, /velocity_dof", "everywhere", everywhere), ("/motion", "lagrange", motion),
)  # fmt: skip
RULES = {
    (path, rule): rule_of for paths, rules, rule_of in TABLE for path in paths.split(", ") for rule in rules.split(", ")
}
#: What may be false of poses near the configuration alone.
LOCAL = ("/singular", "/holonomic", "/scleronomic")


class Verification(NamedTuple):
    """What came of it: how many claims there are, how many were verified, which failed and why, what is uncovered.

    ``trusted``: texts of the scene that were rewritten before they were read here, each with what stands for it.
    """

    scene: str
    claims: int
    verified: int
    failed: list[dict[str, str]]
    uncovered: list[str]
    trusted: dict[str, str]


def verify(document: Any, certificate: Mapping[str, Any] | str | bytes) -> Verification:
    """Recheck every claim of a certificate about the scene of a document.

    Without one, the document in the certificate is taken. A certificate that cannot be read, or that is of another
    scene, raises `CheckError`; a claim that is not shown is in ``failed``.
    """
    content = certificate_of(certificate)
    return Verifier(content["scene"].get("document") if document is None else document, content).run()


def certificate_of(content: Any) -> dict[str, Any]:
    """A certificate from its text or mapping: of the right form, and not too large."""
    is_text = isinstance(content, (str, bytes))
    refuse(is_text and len(content) > LARGEST_TEXT, "the certificate is too long")
    try:
        content = json.loads(content if is_text else json.dumps(content))
    except (TypeError, ValueError, RecursionError) as error:
        raise CheckError(f"the certificate is no JSON: {str(error)[:100]}") from None
    form = isinstance(content, Mapping) and isinstance(content.get("scene"), Mapping) and content.get("certificate")
    refuse(type(form) is not int or form != 1, "a certificate is an object of version 1, with a scene")
    filled: dict[str, Any] = {**{name: [] for name in LISTS}, **content}
    readings = filled["scene"].get("readings", {})
    are_texts = isinstance(readings, dict) and {*map(type, readings.values())} <= {str}
    refuse(not are_texts, "`readings` are texts, each with the text that stands for it")
    for name in filled.keys() - {"certificate", "scene"}:
        entries, kind = filled[name], LISTS.get(name, ())
        fine = kind and isinstance(entries, list) and len(entries) <= MOST_ENTRIES
        refuse(not fine or not all(isinstance(entry, kind) for entry in entries), f"`{str(name)[:40]}` cannot be read")
    return filled


class Verifier:
    """One certificate while it is verified."""

    def __init__(self, document: Any, certificate: Any, problem: Any = None) -> None:
        self.document, self.certificate, self.effort = canonical(document), certificate, Effort()
        self.name = str(certificate["scene"].get("name", document.get("name")))[:200]
        other = certificate["scene"].get("sha256") != sha256_of(self.document)
        refuse(other, "the certificate is of another scene, or of this one before it was edited")
        self.problem: Problem = problem or problem_of_canonical(self.document)
        self.evidences: dict[bool, CheckedEvidence] = {}
        self.verified: dict[str, Any] = {}

    def evidence(self, cayley: bool) -> CheckedEvidence:
        """The evidence in the plain reading, or with Cayley parameters."""
        if cayley not in self.evidences:
            bodies = frozenset(self.certificate["cayley"])
            problem = problem_of_canonical(self.document, bodies) if cayley else self.problem
            self.evidences[cayley] = CheckedEvidence(problem, self.certificate, self.effort)
        return self.evidences[cayley]

    def run(self) -> Verification:
        """Every claim in its order."""
        claims, uncovered = self.certificate["claims"], self.certificate["uncovered"]
        failed, seen = list[dict[str, str]](), set(uncovered)
        for claim in claims:
            path, rule = str(claim.get("path"))[:200], str(claim.get("rule"))[:60]
            try:
                refuse(path in seen, "the path is claimed twice, or claimed and uncovered")
                self.check(claim)
            except FAULTS as error:
                failed.append({"path": path, "rule": rule, "why": fault_text(error)})
            seen.add(path)
        trusted = self.certificate["scene"].get("readings", {})
        return Verification(self.name, len(claims), len(claims) - len(failed), failed, uncovered, trusted)

    def check(self, claim: dict[str, Any]) -> None:
        """`CheckError` unless the claim is shown; what was verified before may be used."""
        path, rule, value, cayley = claim["path"], claim["rule"], claim["value"], claim.get("cayley") is True
        keys, about = path.split("/"), claim.get("about")
        field = keys[3] if len(keys) == 4 and keys[1] == "constraints" else ""
        whole = about == "everywhere" or path == "/conflicting" or value is False
        refuse(cayley and whole and not field and path not in LOCAL, "a chart is no whole")
        refuse(keys[0] or ("about" in claim and path not in ("/dof", "/velocity_dof")), "no path, or a spare `about`")
        written = ("finite", "inequality", "timeless", "count")
        refuse("tolerance" in self.document and rule not in written, "what is measured up to a tolerance is not proved")
        evidence = self.evidence(cayley)
        for name in claim.get("covers", []):
            evidence.once(("covers", name), partial(take_cover, evidence, name))
        owner = keys[-2].replace("~1", "/").replace("~0", "~")
        shown_value = RULES[field or path, rule](evidence, {**claim, "owner": owner, "field": field}, self.verified)
        same = shown_value is value or json.dumps(shown_value, sort_keys=True) == json.dumps(value, sort_keys=True)
        refuse(not same, f"the evidence gives {shown_value!r}, not {str(value)[:80]!r}")
        self.verified |= {f"{field} {owner}" if field else path: value, f"{path} about": about}
