"""What is told: the report, its entries and its verdicts. Field names are fixed; see each docstring."""

from __future__ import annotations

from functools import lru_cache
from typing import Any, ClassVar, Literal, Self

from pydantic import BaseModel, ConfigDict, PrivateAttr, model_validator

from dofkit.base.display import Companion, Displayed, DisplayedFormulas, text_of
from dofkit.base.verdicts import About, ArgumentKey, Claim, Verdict

Form = Literal["finite", "pfaffian", "nonlinear", "inequality"]

#: Of several equations, the last of these that occurs names the constraint's form.
FORMS: tuple[Form, ...] = ("finite", "pfaffian", "nonlinear", "inequality")

#: Said of a constraint that is a product.
BRANCH_WARNING = "'{name}' is satisfied on several branches; the degrees of freedom are those of the largest"


class ToldModel(BaseModel):
    """The base of what is told: frozen, with no keys beyond the fields."""

    model_config = ConfigDict(extra="forbid", frozen=True, defer_build=True)


class FieldVerdict(ToldModel):
    """How sure a field is: the ``argument`` (a row of `classification/arguments.py`), and of which points it speaks.

    ``bound``: of what is ``probable`` the chance of an error (``2^-40``), of what is ``numeric`` the ratio that told 0
    from not 0. ``about``: ``reference``, the part of the configuration space near it; ``component``, that near the
    report's ``witness``; or ``everywhere``. A proof without an argument cannot be written down: ValidationError.
    """

    verdict: Verdict
    argument: ArgumentKey | None = None
    bound: str | None = None
    about: About | None = None

    @model_validator(mode="after")
    def _is_founded(self) -> Self:
        if self.verdict != "undecided" and self.argument is None:
            raise ValueError(f"{self.verdict!r} without an argument")
        if self.verdict in ("probable", "numeric") and self.bound is None:
            raise ValueError(f"{self.verdict!r} without a bound")
        return self

    @staticmethod
    @lru_cache(maxsize=1024)
    def of(claim: Claim) -> FieldVerdict:
        """What is told of a claim: one object for all that claim the same."""
        if claim.verdict == "undecided":
            return FieldVerdict(verdict="undecided")
        return FieldVerdict(verdict=claim.verdict, argument=claim.argument, bound=claim.bound, about=claim.about)


class Count(ToldModel):
    """The lecture's f = Nd - k: every finite equation that was written, as numbers and as a line of text."""

    particles: int
    bodies: int
    dimension: int
    coordinates: int
    constraints: int
    independent: int | None
    naive_dof: int
    formula: str
    errs: str | None
    """Why the count is wrong, where it is; else None."""


class ConstraintEntry(DisplayedFormulas, ToldModel):
    """The labels of one constraint. A label that is None is undecided, and ``reason`` says why.

    Attributes
    ----------
    form
        ``finite``, ``pfaffian``, ``nonlinear`` or ``inequality``, after reduction over the reals.
    holonomic, holonomic_alone
        Whether it is holonomic in the system; on its own.
    scleronomic, catastatic
        Whether t does not occur explicitly, in the constraint or in what it integrates to; whether it is homogeneous in
        the velocities (None for finite constraints and inequalities).
    exact, integrating_factor, integral
        Of a Pfaffian form: whether it is closed as written, a factor that makes it so, and what it integrates to.
    circuit
        Of a redundant constraint: the minimal set of constraints that it depends on.
    equations, independent, redundant_equations
        The number of its scalar equations, how many are independent of all before, and the others in words.
    verdict, verdicts, reason
        How certain the labels are, and why.
    """

    _in_brief: ClassVar[tuple[str, ...]] = ("name", "text", "holonomic", "verdict")

    name: str
    type: str
    text: str
    form: Form
    holonomic: bool | None
    holonomic_alone: bool | None
    scleronomic: bool | None
    catastatic: bool | None
    bilateral: bool
    exact: bool | None
    integrating_factor: str | None
    integral: str | None
    circuit: list[str] | None
    equations: int
    independent: int | None
    redundant_equations: list[str] | None = None
    verdict: Verdict
    verdicts: dict[str, FieldVerdict] = {}
    reason: str


class Redundancy(ToldModel):
    """Constraints of which some minimal dependent sets overlap; ``nullity`` equations too many."""

    nullity: int
    members: list[str]


class IntegrablePart(ToldModel):
    """What the constraints say in finite relations: the codistribution's largest integrable part I^(inf).

    ``rank``: of I^(inf), coordinates less ``dof``. ``basis``: the relations beyond those that were written finite:
    hidden ones (``g = 0``) and integrals (``f = C``); None where not all could be written.
    """

    rank: int
    basis: list[str] | None


class Generic(ToldModel):
    """The same connections with their geometry in general position: what is special about the drawing.

    ``dof`` and ``redundant_equations`` are those of the finite relations at random places and directions (None where
    that could not be counted); ``differs`` says why the drawing allows more: parallel, concurrent, collinear,
    coplanar, a loop of special proportions; None where it does not.
    """

    dof: int | None
    redundant_equations: int | None
    differs: str | None
    verdict: Verdict


class Mobility(ToldModel):
    """The count of Gruebler and Kutzbach, M = D(N - 1 - j) + f_1 + ... + f_j, D = 3 in the plane and 6 in space.

    ``links``: N, bodies with the ground; ``joints``: j, constraints between two of them, of f_i freedoms each.
    ``formula`` holds the numbers, and what else is counted; ``freedom`` is the truth, and ``differs`` why it differs.
    ``undriven``: the velocity freedom without the drives of joints, and its verdict; None where no joint is driven or
    where it is undecided.
    """

    links: int
    joints: int
    formula: str
    kutzbach: int
    freedom: int | None
    differs: str | None
    undriven: int | None = None
    undriven_verdict: Verdict | None = None


class ForceEntry(ToldModel):
    """A force: no constraint, and why."""

    name: str
    reason: str


class SpecialCase(ToldModel):
    """Where the answer is another one: values of ``parameters``, a ``locus`` of configurations, or other branches.

    ``where`` are the conditions as text (``R = 0``, ``x = 0 and y = 0``), ``what`` says what changes there, and
    ``constraints`` for which.
    """

    where: str
    kind: Literal["parameters", "locus", "branch"]
    what: str
    constraints: list[str]
    verdict: Verdict


class Report(Displayed, ToldModel):
    """How a system can move. `dofkit explain FIELD` and the glossary give the meaning of every field.

    A number or label that was not decided is None; ``verdict`` is then ``undecided`` and ``warnings`` says why.

    Attributes
    ----------
    dof, velocity_dof, instantaneous_dof
        The dimension of the configuration space; the number of independent admissible velocities of finite motions; and
        that of the velocities that the constraints allow at the reference configuration.
    holonomic, scleronomic
        Whether every constraint is.
    redundant, redundancies, conflicting
        A maximal redundant set; the groups of dependent constraints; a minimal contradictory set.
    constraints
        One `ConstraintEntry` for each constraint, in order.
    generic, mobility
        The mobility in general position, and that by Gruebler and Kutzbach, M = D(N - 1 - j) + f_1 + ... + f_j.
    special_cases
        Where the answer differs from the generic one that all other fields give.
    verdict, verdicts
        How certain the report is, and each field.
    witness, certificate
        A certified configuration; the evidence for `dofkit.verify`.

    Examples
    --------
    >>> import dofkit
    >>> report = dofkit.classify("four-bar-linkage")
    >>> report.dof, report.count.naive_dof, report.to_dict()["holonomic"]
    (1, 1, True)
    """

    _in_brief: ClassVar[tuple[str, ...]] = ("scene", "dof", "velocity_dof", "verdict")

    scene: str
    consistent: bool | None
    feasible: bool | None = None
    infeasible: list[str] = []
    feasible_at: dict[str, str] | None = None
    dof: int | None
    velocity_dof: int | None
    instantaneous_dof: int | None
    singular: bool | None
    holonomic: bool | None
    scleronomic: bool | None
    count: Count
    redundant_equations: int | None
    redundant: list[str] | None
    redundancies: list[Redundancy]
    conflicting: list[str]
    generalized_coordinates: list[str] | None
    joint_coordinates: list[str] | None = None
    growth_vector: list[int] | None
    integrable_part: IntegrablePart | None = None
    generic: Generic | None = None
    mobility: Mobility | None = None
    constraints: list[ConstraintEntry]
    forces: list[ForceEntry]
    special_cases: list[SpecialCase]
    verdict: Verdict
    verdicts: dict[str, FieldVerdict] = {}
    witness: dict[str, str] | None = None
    certificate: dict[str, Any] | None = None
    method: str
    modelled: str
    warnings: list[str]
    _companion: Companion = PrivateAttr(default_factory=Companion)

    def text(self, width: int | None = None, how: bool = False) -> str:
        """What the command line prints, for ``width`` columns (None: those of the terminal, or 80).

        ``how``: also how sure each answer is, and by which argument. `print` writes the same without it.
        """
        return text_of(self, width, how)

    def to_dict(self) -> dict[str, Any]:
        """Return the report as a mapping of JSON values; `Report.model_validate` reads it back.

        >>> import dofkit
        >>> dofkit.classify("four-bar-linkage").to_dict()["dof"]
        1
        """
        return self.model_dump(mode="json")

    def table(self) -> list[dict[str, Any]]:
        """Return one flat mapping for each constraint, as ``pandas.DataFrame`` takes them.

        Each has the scene's name and the fields of a `ConstraintEntry` except ``verdicts``; lists of names are joined
        by commas.

        >>> import dofkit
        >>> [(row["name"], row["independent"]) for row in dofkit.classify("simple-pendulum-link").table()]
        [('rod', 1)]
        """
        rows = [entry.model_dump(mode="json", exclude={"verdicts"}) for entry in self.constraints]
        return [{"scene": self.scene, **{key: _cell(value) for key, value in row.items()}} for row in rows]

    def beside(self, scene: object) -> Self:
        """The same report with what it is about beside it, whose title and picture are then shown."""
        self._companion.about = scene
        return self


def _cell(value: Any) -> Any:
    return ", ".join(map(str, value)) if isinstance(value, list) else value
