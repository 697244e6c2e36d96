"""The report: what the analysis of a scene answers, with a verdict for every field.

`Report` has one `ConstraintEntry` for each constraint. Field names are fixed; the description of each field is what
`dofkit explain` and the glossary print.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any, ClassVar, Literal, Self

from pydantic import BaseModel, ConfigDict, Field, PrivateAttr, model_validator

from dofkit.base.display import Displayed, DisplayedFormulas, text_of
from dofkit.base.verdicts import About, ArgumentKey, Claim, Verdict

Form = Literal["finite", "pfaffian", "nonlinear", "inequality"]

#: Of several equations, the last of these that occurs names the constraint's form.
FORMS: tuple[Form, ...] = ("finite", "pfaffian", "nonlinear", "inequality")

#: Said of a constraint that is a product.
BRANCH_WARNING = (
    "'{name}' is satisfied on several branches; the degrees of freedom are those of the largest one (through the "
    "reference configuration, if there is one)"
)


class Companion:
    """What accompanies a value and is no part of it: equal to every other, and empty in another process.

    ``about``: of a report its scene, for the title and the picture; of a scene what was worked out of it.
    """

    def __init__(self, about: Any = None) -> None:
        self.about = about

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Companion)

    def __hash__(self) -> int:
        return 0

    def __reduce__(self) -> tuple[type[Self], tuple[()]]:
        return type(self), ()


class ReportModel(BaseModel):
    """The base of reports, results and their entries: frozen, with no keys beyond the fields."""

    model_config = ConfigDict(extra="forbid", frozen=True, defer_build=True)


def meaning(text: str, **settings: Any) -> Any:
    """Return a field with its meaning, and a default if ``settings`` has one."""
    return Field(description=text, **settings)


def decided(text: str) -> Any:
    """Return a field with its meaning that is None where it is undecided."""
    return Field(description=text, default=None)


class FieldVerdict(ReportModel):
    """How certain a field is: the ``argument`` (a row of `classification/arguments.yaml`), and what it is ``about``.

    ``bound``: for ``probable`` the chance of an error (``2^-40``), or None where a proof lacks evidence alone; for
    ``numeric`` the ratio that separates zero from non-zero. ``about``: ``reference``, the configurations near the
    reference configuration; ``component``, those near the report's ``witness``; or ``everywhere``. ``checked``: whether
    the checker accepted evidence for the field, where a certificate was asked for, else None. A verdict without an
    argument cannot be constructed: ValidationError.
    """

    verdict: Verdict
    argument: ArgumentKey | None = None
    bound: str | None = None
    about: About | None = None
    checked: bool | None = None

    @model_validator(mode="after")
    def _is_founded(self) -> Self:
        if self.verdict != "undecided" and self.argument is None:
            raise ValueError(f"{self.verdict!r} without an argument")
        if self.verdict in ("probable", "numeric") and self.bound is None and self.checked is not False:
            raise ValueError(f"{self.verdict!r} without a bound")
        return self

    @staticmethod
    @lru_cache(maxsize=1024)
    def of(claim: Claim) -> FieldVerdict:
        """Return the verdict of a claim: one object for all equal claims."""
        if claim.verdict == "undecided":
            return FieldVerdict(verdict="undecided")
        return FieldVerdict(verdict=claim.verdict, argument=claim.argument, bound=claim.bound, about=claim.about)


class Count(ReportModel):
    """The textbook count f = N d - k with every holonomic equation as written, as numbers and as a line of text.

    ``errs``: why the count is off, if it is.
    """

    particles: int
    bodies: int
    dimension: int
    coordinates: int
    constraints: int
    independent: int | None
    naive_dof: int
    formula: str
    errs: str | None


class ConstraintEntry(DisplayedFormulas, ReportModel):
    """The labels of one constraint. A label that is None is undecided, and ``reason`` says why."""

    _in_brief: ClassVar[tuple[str, ...]] = ("name", "text", "holonomic", "verdict")

    name: str = meaning("as written, or c1, c2, ... by position")
    type: str = meaning("the constraint type")
    text: str = meaning("as written")
    form: Form = meaning("finite, pfaffian (linear in the velocities), nonlinear (in the velocities) or inequality")
    holonomic: bool | None = decided(
        "whether it is, in this system, implied by equations between coordinates (and time)"
    )
    holonomic_alone: bool | None = decided("the same without all other constraints")
    scleronomic: bool | None = decided(
        "whether time does not occur explicitly, nor in the equation that it integrates to (Greenwood's definition); "
        "factors that never vanish, analytic functions of t alone and declared functions are taken out first"
    )
    catastatic: bool | None = decided(
        "whether a Pfaffian form has no term in dt, or a nonlinear constraint is homogeneous in the velocities; null "
        "for any other"
    )
    bilateral: bool = meaning("false for an inequality")
    exact: bool | None = decided("whether the form, as written, is the differential of a function")
    integrating_factor: str | None = decided("a factor that makes the form exact")
    integral: str | None = decided("the equation that it integrates to, such as x*y = C")
    circuit: list[str] | None = decided(
        "for a redundant constraint: a minimal set of earlier constraints that it is implied by"
    )
    equations: int = meaning("the number of its scalar equations")
    independent: int | None = decided("how many of them are independent of all before")
    redundant_equations: list[str] | None = decided("those that are not, in words")
    verdict: Verdict = meaning("how certain its labels are: the weakest of their verdicts")
    verdicts: dict[str, FieldVerdict] = meaning("how certain each label is", default={})
    reason: str = meaning("why, for a student")


class Redundancy(ReportModel):
    """Constraints whose minimal dependent sets overlap; ``nullity`` of their equations depend on the others."""

    nullity: int
    members: list[str]


class IntegrablePart(ReportModel):
    """The holonomic equations that the constraints imply: the largest integrable part I^(inf) of the codistribution.

    ``rank``: of I^(inf), coordinates less ``dof``. ``basis``: the equations beyond those that were written as
    holonomic: hidden ones (``g = 0``) and integrals (``f = C``); None if not all could be written.
    """

    rank: int
    basis: list[str] | None


class Generic(ReportModel):
    """The mobility of the same connections with their geometry in general position.

    ``dof`` and ``redundant_equations`` are those of the holonomic equations at random positions and directions (None
    if that could not be counted); ``differs`` says why the reference configuration is not generic: parallel,
    concurrent, collinear or coplanar axes, a loop of special proportions; None if it is generic.
    """

    dof: int | None
    redundant_equations: int | None
    differs: str | None
    verdict: Verdict


class Mobility(ReportModel):
    """The count of Gruebler and Kutzbach, M = D(N - 1 - j) + f_1 + ... + f_j, D = 3 in the plane and 6 in space.

    ``links``: N, bodies with the ground; ``joints``: j, constraints between two of them, of f_i freedoms each.
    ``formula`` holds the numbers, and what else is counted; ``freedom`` is the true mobility, and ``differs`` why the
    count differs from it. ``undriven``: the velocity freedom without the drives of joints, and its verdict; None if no
    joint is driven or if it is undecided.
    """

    links: int
    joints: int
    formula: str
    kutzbach: int
    freedom: int | None
    differs: str | None
    undriven: int | None = None
    undriven_verdict: Verdict | None = None


class ForceEntry(ReportModel):
    """A force, and why it is no constraint."""

    name: str
    reason: str


class SpecialCase(ReportModel):
    """Where the answer differs: a ``locus`` of configurations, or a branch of the configuration space.

    ``where`` are the conditions as text (``R = 0``, ``x = 0 and y = 0``), ``what`` says what changes there, and
    ``constraints`` for which.
    """

    where: str
    kind: Literal["locus", "branch"]
    what: str
    constraints: list[str]
    verdict: Verdict


class Report(Displayed, ReportModel):
    """How a system can move. `dofkit explain FIELD` and the glossary give the meaning of every field.

    A number or label that was not decided is None; ``verdict`` is then ``undecided`` and ``warnings`` says why.

    Examples
    --------
    >>> import dofkit
    >>> report = dofkit.classify("four-bar-linkage")
    >>> report.dof, report.count.naive_dof, report.to_dict()["holonomic"]
    (1, 1, True)
    """

    _in_brief: ClassVar[tuple[str, ...]] = ("scene", "dof", "velocity_dof", "verdict")

    scene: str = meaning("the scene's name")
    consistent: bool | None = decided(
        "true if a configuration satisfies all equations at one time; false if no configuration, or no motion, does; "
        "conflicting then names a minimal set; each inequality is considered on its own"
    )
    feasible: bool | None = meaning(
        "whether all inequalities can be satisfied together with the constraints; null if undecided, or if there are "
        "none",
        default=None,
    )
    infeasible: list[str] = meaning(
        "a minimal set of constraints with inequalities that cannot be satisfied together", default=[]
    )
    feasible_at: dict[str, str] | None = meaning(
        "a certified point at which all inequalities are satisfied", default=None
    )
    dof: int | None = decided(
        "degrees of freedom: the dimension of the configuration space, which is the number of coordinates less the "
        "number of independent holonomic equations, hidden ones included; non-holonomic constraints and inequalities "
        "do not reduce it"
    )
    velocity_dof: int | None = decided(
        "velocity freedom: the number of independent admissible velocities of finite motions; non-holonomic "
        "constraints reduce it too"
    )
    instantaneous_dof: int | None = decided(
        "instantaneous freedom: the number of independent velocities that the constraints allow at the reference "
        "configuration"
    )
    singular: bool | None = decided("true if the instantaneous freedom differs from the velocity freedom")
    holonomic: bool | None = decided(
        "true if every constraint is holonomic, that is, implied by equations between coordinates (and time)"
    )
    scleronomic: bool | None = decided(
        "true if time occurs explicitly in no constraint, nor in an equation that one integrates to"
    )
    count: Count = meaning(
        "the textbook count f = N d - k of all holonomic equations as written, and why the count is off"
    )
    redundant_equations: int | None = decided("the number of scalar equations that depend on the others")
    redundant: list[str] | None = decided(
        "a maximal redundant set: constraints that can be removed together without changing the motion"
    )
    redundancies: list[Redundancy] = meaning(
        "groups of constraints that depend on each other, and the number of dependent equations in each", default=[]
    )
    conflicting: list[str] = meaning("a minimal set of constraints that contradict each other", default=[])
    generalized_coordinates: list[str] | None = decided(
        "an independent choice among the scene's coordinates, one for each degree of freedom"
    )
    joint_coordinates: list[str] | None = meaning(
        "joint angles and displacements that describe a tree of bodies, one for each degree of freedom; null for any "
        "other scene",
        default=None,
    )
    growth_vector: list[int] | None = decided(
        "the dimensions of the distribution D of admissible directions, of D + [D, D], and so on"
    )
    integrable_part: IntegrablePart | None = meaning(
        "the holonomic equations that all differential constraints imply together", default=None
    )
    generic: Generic | None = meaning(
        "the mobility in general position, and why the reference configuration is not generic", default=None
    )
    mobility: Mobility | None = meaning(
        "the mobility by the formula of Gruebler and Kutzbach, and why it differs from the true one", default=None
    )
    constraints: list[ConstraintEntry] = meaning(
        "the constraints in order, each with its labels, its verdict and the reason"
    )
    forces: list[ForceEntry] = meaning("the forces, and why they are no constraints")
    special_cases: list[SpecialCase] = meaning(
        "configurations and branches where the answer is another one", default=[]
    )
    verdict: Verdict = meaning("how certain the report is: the weakest of all its verdicts")
    verdicts: dict[str, FieldVerdict] = meaning(
        "how certain each field is, with the argument, the bound, and the points that the claim is about", default={}
    )
    witness: dict[str, str] | None = decided("a certified configuration: coordinate -> value")
    certificate: dict[str, Any] | None = meaning(
        "the evidence for what is proved, which `dofkit verify` checks", default=None
    )
    method: str = meaning("the method that was used")
    modelled: str = meaning("what was kept in the model, what was left out, and why")
    warnings: list[str] = meaning("remarks, and why something is undecided")
    _companion: Companion = PrivateAttr(default_factory=Companion)

    def text(self, width: int | None = None, how: bool = False) -> str:
        """Return what the command line prints, for ``width`` columns (None: those of the terminal, or 80).

        ``how``: also how certain each answer is, and by which argument. `print` writes the same without it.
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

    def with_scene(self, scene: object) -> Self:
        """Return this report, and remember the scene that it is about, whose title and picture are then shown."""
        self._companion.about = scene
        return self


def _cell(value: Any) -> Any:
    return ", ".join(map(str, value)) if isinstance(value, list) else value
