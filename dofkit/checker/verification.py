"""A certificate's form, read with care: bounded, and every fault told.

A certificate is a JSON object: ``certificate`` (1), ``scene`` (``name``, ``sha256`` of the canonical JSON of the
scene's document, optionally the ``document``), ``cayley`` (bodies that are read with Cayley parameters where a claim
says ``"cayley": true``), ``relations`` (steps), ``points``, ``minors``, ``fields``, ``covers``, ``claims``,
``uncovered``. A TEXT is an expression in the grammar of scenes (numbers exact); an ID names a relation of the scene
(``c4``, ``c4.1``) or a step. Steps, points, minors and fields are looked at only where a claim uses them.

STEPS (``{"id", "by", "of", ...}``; ``of`` is an ID; every step only uses IDs of the scene and of steps before it).
"Needs" is asked at the point of the claim that uses the step.

=========== =============================================== ==================================================
by          fields                                          meaning (identities in the ring of `ring.py`)
=========== =============================================== ==================================================
implied     of (or function), c {ID: TEXT}, h, power (k),   h * of^k + squares = sum c[i] * i: ``of`` follows from the
            sos [[c, a]], put [[ID, coordinate]]            i; so does ``function``, as a relation of its own. Needs h
                                                            not 0, the c defined. The c of a velocity relation may hold
                                                            velocities. Squares c * a^2, all c > 0, of an a with a value
                                                            everywhere: k is even, and h a product that is positive by
                                                            itself. Where finite relations ``put`` give a coordinate
                                                            (with a factor not 0 by itself), the sides are compared
                                                            after it is put in, one after the other: ``of`` follows from
                                                            these as well
assumed     function                                        a relation that may hold or not: for ``family`` alone
rate        of (finite, or an integral)                     its time derivative, with qdot and tdot
integral    function (f), and the others                    h * (df/dt) = sum c[i] * i: f keeps its value. Needs
                                                            h not 0, the c defined. A finite relation of the leaf
=========== =============================================== ==================================================

``h`` and ``k`` are 1 where left out. Not 0 by itself is a product of powers of numbers and of parameters declared
nonzero or positive. All texts of a step need a value at the point, as they are written.

POINTS ``{"id", "values": {symbol: TEXT}, "functions": {h: {"arguments": [s], "text": TEXT}}}``: coordinates, ``t``,
parameters, generic lengths, velocities ``qdot`` (``tdot`` is 1), each a TEXT of numbers and of parameters given before
it; a choice for every unknown function that occurs. A BOX has besides ``rows`` [ID], ``columns`` [symbol] (as many),
``radius`` ("1e-30"): values of columns are centres. A relation holds at an exact point where the ring says 0 after
substitution, at a box where it is a row, or is 0 in the ring, or follows from such by steps; and its ball, worked out
as it is written, holds 0.

MINORS ``{"id", "at": POINT, "rows": [ID], "columns": [coordinate]}``: the determinant of d(row)/d(column) (of a finite
relation) and d(row)/d(column's velocity) (of a velocity relation) excludes 0. A claim's ``minor`` is an id or the
object. Every row must hold at the point (linear velocity relations as forms) and follow from the scene's relations.

FIELDS ``{"id", "components": {coordinate or t: TEXT}}``: a velocity field; what is left out is 0.
A WORD is a list of ids of fields: [A, B, C] is [[A, B], C].

COVERS ``{"id", "minor", "blocks": [{"rows": [ID], "fields": [id], "columns": [coordinate]}]}``: blocks of finite
relations of the scene (without t, and without parameters and functions but for an own generic symbol), with fields
that keep them (tangent identically; columns: a minor of the fields at the minor's point). Sum over blocks of
(coordinates that occur less fields, at most the rows) = rows of the minor. Then all rows of the blocks follow from
those of the minor near its point. Any claim may name them in ``covers`` [id].

BOUNDS of dof (``most`` and ``least`` of squeeze), and of velocity_dof:

=========== ============================================= ======================================================
rule        fields                                        bound
=========== ============================================= ======================================================
minor       minor                                         most n - rows: dof where all rows are finite or integrals,
                                                          velocity_dof in any case
frobenius   minor, fields [id], columns [coordinate       most n - rows of dof: the rows' kernel, spanned by the
            or t] (a minor of the fields)                 fields (all that are missing: n, or n + 1 where t or tdot
                                                          occurs in the rows, less rows), is involutive
regular     minor                                         least n - rows: all relations are rows or follow from rows
                                                          by steps
span        at, fields [id], rows [ID], words [WORD],     least the words (less 1 where a field moves t): fields
            columns [coordinate or t]                     tangent to rows identically, rows account for all
                                                          relations, all at the point; the words' columns are
                                                          independent. Where finite relations hold parameters: minor
                                                          (that of ``most`` does) whose rows account for them. Where
                                                          t or tdot occurs a field's t is not 0 at the point
isolated    minor, zero ID, speeds {coordinate: TEXT},    most n - rows - 1 (of dof): rows and zero are finite, without
            order (1 to 8)                                t, of the scene; while the rows stay 0 and coordinates that
                                                          are no columns have these speeds, and the others rest, the
                                                          derivative of zero of that order is not 0
family      minor                                         least n - rows: finite rows (assumed ones, without parameters,
                                                          may be among them) from which all relations follow by steps
=========== ============================================= ======================================================

CLAIMS ``{"path", "value", "rule", ..., "about", "cayley"}``. ``about`` (dof, velocity_dof): ``reference`` (the point
is the scene's configuration), ``component`` (only where none is given that meets the relations), ``everywhere``.
NAME is a constraint's name, with ``~1`` for ``/`` and ``~0`` for ``~``.

======================================= ============== ==========================================================
path                                    rule           fields
======================================= ============== ==========================================================
/consistent true                        point          at; all relations hold; at rest, for all t.
                                                       ``inequalities`` {NAME or ID: POINT}: each holds at a point by
                                                       itself. Where parameters or functions
                                                       occur in finite relations (but for a generic symbol of its
                                                       own): minor as well, whose rows account for these, and rest
                                                       is identical in the coordinates
/consistent true                        regular        minor, inequalities: a motion through the point
/consistent false                       nullstellensatz c {ID: TEXT}, number, sos [[c, a]], inequality {ID:
                                                       [[c, a]]}: number + sos + sum c i + sum (sos) ineq = 0 with
                                                       tdot = 1; the TEXTs have a value everywhere. An inequality
                                                       stands alone, without c
/conflicting                            conflict       refutation: an object with rule, as for /consistent false,
                                                       using just these constraints; minimal {NAME: an object with
                                                       rule, as for /consistent true, of the others}
/dof, /velocity_dof                     squeeze        most, least (above); about
/dof, /velocity_dof                     regular        minor; about (most and least in one, all rows of one kind)
/velocity_dof                           count          equals /dof: no velocity relations
/dof, /velocity_dof                     everywhere     order [[ID, coordinate]]: each gives its coordinate, or its
                                                       velocity, with a factor of numbers and parameters; those
                                                       before do not hold it. One may give t instead. blocks [ID]:
                                                       single analytic relations, or a single form; generic [[ID,
                                                       symbol]]: each with a symbol of its own; every relation, or
                                                       (dof) every finite one, in one place; blocks and generic
                                                       share no free coordinate. minor of these, which accounts for
                                                       all; as many rows as relations, or one cover of all in
                                                       ``covers``. dof beside forms: most, least as for squeeze
/instantaneous_dof                      rank           at: the reference. Rational rows: nothing more. Else minor,
                                                       of all relations
/singular                               count          (of verified /instantaneous_dof and /velocity_dof)
/holonomic, /scleronomic                count          (of the verified entries)
/redundant_equations                    count          (of verified /velocity_dof)
/redundancies                           count          (of verified /redundant_equations: 0, or all equations are of
                                                       one constraint, or 1 and one verified circuit, at the
                                                       point of a verified /redundant; or all are of one group
                                                       where that was verified by ``without``)
/feasible true                          point, regular at, or minor: equations as for /consistent; all inequalities
                                                       hold at that point (regular, and at its velocities, where they
                                                       hold velocities)
/feasible false                         nullstellensatz as for /consistent false, of all together; or number 0 and a
                                                       strict inequality whose squares are a positive number
/integrable_part                        integrals      minor (rows finite or integrals, n - dof many), steps [ID]: of
                                                       the texts of the basis, in order; /dof verified before at the
                                                       same point. Nothing more where the basis is null
/generalized_coordinates                minor,         as above, minor: rows finite or integrals; the columns are
                                        frobenius      all the other coordinates; /dof verified before, at the same
                                                       point
/growth_vector                          span           spans: for each entry {"words", "columns"}; at, fields, rows,
                                                       minor (regular: all rows). Upper bounds: their number, and /dof
                                                       verified before, at the same point. Where t occurs: a label
                                                       scleronomic or catastatic false, verified before
/redundant                              cofactors      minor: rows are relations of the scene, all others follow from
                                                       them with numbers (or one, with cofactors not 0 at the
                                                       point; or all are linear or have generic lengths, by covers).
                                                       []: without {NAME: minor}, of all rows but NAME's; /dof before
/constraints/NAME/holonomic             finite, inequality
/constraints/NAME/holonomic_alone       the same       of the constraint's own relations only (``alone`` is implied)
.../holonomic true                      integral       at; integrals [ID of integral steps]: NAME's relations follow
                                                       from their rates, finite relations and theirs
.../holonomic true                      frobenius      minor, fields, columns: NAME's relations are rows or follow
.../holonomic false                     bracket        at, fields, rows, word WORD, pairs ID: the
                                                       relation ID of NAME is not 0 there; minor as for ``span``
.../holonomic_alone true, false         wedge          true: omega ^ d(omega) = 0 (one form); false: at, triple [x, y,
                                                       z] (``t`` for time)
.../scleronomic, .../catastatic true    timeless       t, tdot do not occur; what is nonlinear in velocities is, as it
                                                       is written, homogeneous. steps [ID]: instead of NAME's own
                                                       relations, these, which follow from them and they from these.
                                                       scleronomic: or t does not occur in one relation that was
                                                       verified before not to be holonomic
.../scleronomic false                   turns          at, relation ID; pair [x, y] for a form, or a coefficient of
                                                       tdot that is not 0 and holonomic_alone true, or an integral
                                                       that t occurs in, verified before
.../catastatic false                    turns          at, relation ID: the coefficient of tdot is not 0, or sum v dF/dv
                                                       of a relation F not linear in velocities
.../exact true                          exact          closed
.../exact false                         not exact      at, pair [x, y]; relation ID where there are several forms
.../independent 0                       inequality     of nothing but inequalities
.../integrating_factor                  integral       at; the value mu makes mu * form closed and is not 0 there
.../integral                            integral       at (value is "function = C"); step ID of the integral;
                                                       NAME's relation follows from its rate. integrals [ID] that
                                                       it takes besides: minor of these, finite relations and one
                                                       of NAME's
.../circuit                             cofactors      at (a point of all); minimal {NAME: {"minor"} at that point:
                                                       rows of the other members that account for them, and one of
                                                       the constraint's own}
.../independent                         independent    minor: rows up to those of this constraint, finite
                                                       ones first; those before follow from rows before, and
                                                       its own from all rows; at most as many as it has
                                                       equations. last: of the last one, /dof before
======================================= ============== ==========================================================

Euler angles are read at a point only where the sine of the second is not 0: else they are no chart of the poses.
Local claims (holonomic, circuit, independent, ...) are made at the scene's configuration (with t = 0), where one is
given that meets the relations; else at any point. Claims are verified in their order.
"""

import json
from collections.abc import Callable, Mapping
from functools import partial
from typing import Any, NamedTuple

from dofkit.checker import dimension_rules as numbers
from dofkit.checker import label_rules as labels
from dofkit.checker.evidence import CheckedEvidence, take_cover
from dofkit.checker.problem import CheckedProblem as Problem
from dofkit.checker.problem import canonical, document_of, read_problem, sha256_of
from dofkit.checker.relations import FAULTS, told
from dofkit.checker.trees import CheckError, Effort, refuse

LARGEST_TEXT, MOST_ENTRIES = 20_000_000, 20_000
PARTS = ("relations", "points", "minors", "fields", "covers")
#: The fields of a certificate that are lists, and of what.
LISTS: dict[str, Any] = {**dict.fromkeys((*PARTS, "claims"), dict), "cayley": str, "uncovered": str}
Rule = Callable[[CheckedEvidence, dict[str, Any], dict[str, Any]], object]
#: The rules: paths of the report (fields of an entry, without ``/``), names of rules, and what looks at them.
TABLE: tuple[tuple[str, str, Rule], ...] = (
    ("/consistent, /feasible", "point, regular", labels.consistent),
    ("/consistent, /feasible", "nullstellensatz", labels.refuted), ("/conflicting", "conflict", labels.conflict),
    ("/dof, /velocity_dof", "squeeze, regular", numbers.bounds), ("circuit", "cofactors", numbers.circuit),
    ("/velocity_dof, /redundant_equations, /redundancies", "count", numbers.counted),
    ("/holonomic, /scleronomic, /singular", "count", numbers.counted),
    ("/instantaneous_dof", "rank", numbers.instantaneous), ("/redundant", "cofactors", numbers.redundant),
    ("independent", "independent", numbers.independence), ("independent", "inequality", labels.by_kind),
    ("/integrable_part", "integrals", labels.integrable_part), ("/growth_vector", "span", numbers.growth),
    ("/generalized_coordinates", "minor, frobenius", numbers.generalized_coordinates),
    ("holonomic, holonomic_alone", "finite, inequality", labels.by_kind),
    ("holonomic, holonomic_alone", "integral, frobenius", labels.integrable),
    ("holonomic, holonomic_alone", "bracket", labels.bracket), ("holonomic_alone", "wedge", labels.wedge),
    ("scleronomic, catastatic", "timeless", labels.timeless), ("scleronomic, catastatic", "turns", labels.turns),
    ("exact", "exact, not exact", labels.exact), ("integrating_factor", "integral", labels.factor),
    ("integral", "integral", labels.integral), ("/dof, /velocity_dof", "everywhere", numbers.everywhere),
)  # fmt: skip
RULES = {(path, rule): look for paths, rules, look in TABLE for path in paths.split(", ") for rule in rules.split(", ")}
#: What may be false of poses near the configuration alone.
LOCAL = ("/singular", "/holonomic", "/scleronomic")


class Verification(NamedTuple):
    """What came of it: how many claims there are, how many were verified, which failed and why, what is uncovered."""

    scene: str
    claims: int
    verified: int
    failed: list[dict[str, str]]
    uncovered: list[str]


def verify(scene: Any, certificate: Mapping[str, Any] | str | bytes, rules: Mapping[Any, Rule] = RULES) -> Verification:
    """Recheck every claim of a certificate about a scene (its document, or its text), by ``rules``.

    Without a scene, the document in the certificate is taken. A certificate that cannot be read, or that is of another
    scene, raises `CheckError`; a claim that is not shown is told in ``failed``.
    """
    given = certificate_of(certificate)
    scene = given["scene"].get("document") if scene is None else scene
    return Verifier(document_of(scene) if isinstance(scene, str) else scene, given, rules=rules).run()


def certificate_of(given: Any) -> dict[str, Any]:
    """A certificate from its text or mapping: of the right form, and not too large."""
    told_in_text = isinstance(given, (str, bytes))
    refuse(told_in_text and len(given) > LARGEST_TEXT, "the certificate is too long")
    try:
        given = json.loads(given if told_in_text else json.dumps(given))
    except (TypeError, ValueError, RecursionError) as error:
        raise CheckError(f"the certificate is no JSON: {str(error)[:100]}") from None
    form = isinstance(given, Mapping) and isinstance(given.get("scene"), Mapping) and given.get("certificate")
    refuse(type(form) is not int or form != 1, "a certificate is an object of version 1, with a scene")
    found: dict[str, Any] = {**{name: [] for name in LISTS}, **given}
    for name in found.keys() - {"certificate", "scene"}:
        entries, kind = found[name], LISTS.get(name, ())
        fine = kind and isinstance(entries, list) and len(entries) <= MOST_ENTRIES
        refuse(not fine or not all(isinstance(one, kind) for one in entries), f"`{str(name)[:40]}` cannot be read")
    return found


class Verifier:
    """One certificate while it is verified."""

    def __init__(self, document: Any, given: Any, problem: Any = None, rules: Mapping[Any, Rule] = RULES) -> None:
        self.document, self.given, self.rules, self.effort = document, given, rules, Effort()
        other = given["scene"].get("sha256") != sha256_of(document)
        refuse(other, "the certificate is of another scene, or of this one before it was edited")
        self.problem: Problem = problem or read_problem(document)
        refuse("tolerance" in canonical(document), "what is measured up to a tolerance is not proved")
        self.evidences: dict[bool, CheckedEvidence] = {}
        self.verified: dict[str, Any] = {}

    def evidence(self, cayley: bool) -> CheckedEvidence:
        """The evidence in the plain reading, or with Cayley parameters."""
        if cayley not in self.evidences:
            bodies = frozenset(self.given["cayley"])
            problem = read_problem(self.document, bodies) if cayley else self.problem
            self.evidences[cayley] = CheckedEvidence(problem, self.given, self.effort)
        return self.evidences[cayley]

    def run(self) -> Verification:
        """Every claim in its order; where the type of a constraint is not known, all are uncovered."""
        unread, whole, left = self.problem.world.unread, self.given["claims"], self.given["uncovered"]
        failed, seen, claims = list[dict[str, str]](), set(left), [] if unread else whole
        for claim in claims:
            path, rule = str(claim.get("path"))[:200], str(claim.get("rule"))[:60]
            try:
                refuse(path in seen, "the path is claimed twice, or claimed and uncovered")
                self.check(claim)
            except FAULTS as error:
                failed.append({"path": path, "rule": rule, "why": told(error)})
            seen.add(path)
        name = str(self.given["scene"].get("name", self.document.get("name")))[:200]
        left = left + [str(claim.get("path"))[:200] for claim in whole if unread]
        return Verification(name, len(whole), len(claims) - len(failed), failed, left)

    def check(self, claim: dict[str, Any]) -> None:
        """`CheckError` unless the claim is shown; what was verified before may be used."""
        path, rule, value, cayley = claim["path"], claim["rule"], claim["value"], claim.get("cayley") is True
        parts, about = path.split("/"), claim.get("about")
        field = parts[3] if len(parts) == 4 and parts[1] == "constraints" else ""
        whole = about == "everywhere" or path == "/conflicting" or value is False
        refuse(cayley and whole and not field and path not in LOCAL, "a chart is no whole")
        refuse(parts[0] or ("about" in claim and path not in ("/dof", "/velocity_dof")), "no path, or a spare `about`")
        evidence = self.evidence(cayley)
        for name in claim.get("covers", []):
            evidence.once(("covers", name), partial(take_cover, evidence, name))
        owner = parts[-2].replace("~1", "/").replace("~0", "~")
        found = self.rules[field or path, rule](evidence, {**claim, "owner": owner, "field": field}, self.verified)
        same = json.dumps(found, sort_keys=True) == json.dumps(value, sort_keys=True)
        refuse(not same, f"the evidence gives {found!r}, not {str(value)[:80]!r}")
        self.verified |= {f"{field} {owner}" if field else path: value, f"{path} about": about}
