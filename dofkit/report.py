"""What is told: the report, its entries and its verdicts. Field names are fixed; see each docstring."""

from __future__ import annotations

from typing import Any, Literal, Self

from pydantic import BaseModel, ConfigDict, Field, PrivateAttr, model_validator

from dofkit.base.display import Companion, Displayed, DisplayedFormulas, text_of
from dofkit.base.verdicts import About, ArgumentKey, Claim, Verdict

Form = Literal["finite", "pfaffian", "nonlinear", "inequality"]

#: Of several equations, the last of these that occurs names the constraint's form.
FORMS: tuple[Form, ...] = ("finite", "pfaffian", "nonlinear", "inequality")

#: Said of a constraint that is a product.
BRANCH_WARNING = "'{name}' holds on several branches; the numbers are those of the largest"


class ToldModel(BaseModel):
    """The base of what is told: frozen, with no keys beyond the fields."""

    model_config = ConfigDict(extra="forbid", frozen=True)


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

    @classmethod
    def of(cls, claim: Claim) -> Self:
        """What is told of a claim."""
        if claim.verdict == "undecided":
            return cls(verdict="undecided")
        return cls(verdict=claim.verdict, argument=claim.argument, bound=claim.bound, about=claim.about)


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
    """One constraint's labels.

    ``form`` of the reduced equations; ``holonomic`` in the system and ``holonomic_alone`` without
    the others; ``scleronomic``: time does not enter, up to factors that never vanish; ``catastatic``:
    no dt term (None unless ``pfaffian``); ``exact``, ``integrating_factor``, ``integral`` of a
    Pfaffian form; ``circuit``: what a redundant constraint depends on; ``equations`` and how many are
    ``independent`` of all before; ``redundant_equations``: the others by name (None where it is not known which).
    A None label means undecided, and ``reason`` says why; ``verdicts`` says of every label how sure it is.
    """

    name: str = Field(description="as written, or c1, c2, ... by position")
    type: str = Field(description="the type of constraint")
    text: str = Field(description="as written")
    form: Form = Field(description="finite, pfaffian (linear in velocities), nonlinear (in velocities) or inequality")
    holonomic: bool | None = Field(
        description="is it, in this system, a consequence of relations between coordinates (and time)?",
    )
    holonomic_alone: bool | None = Field(description="the same with all other constraints forgotten")
    scleronomic: bool | None = Field(description="does time not enter?")
    catastatic: bool | None = Field(description="has a form linear in velocities no term with dt? null for any other")
    bilateral: bool = Field(description="false for an inequality")
    exact: bool | None = Field(description="is the form, as written, the differential of a function?")
    integrating_factor: str | None = Field(description="what makes the form exact")
    integral: str | None = Field(description="the finite relation that it integrates to, such as x*y = C")
    circuit: list[str] | None = Field(
        description="of a redundant one: a minimal set of constraints before it that it follows from",
    )
    equations: int = Field(description="its scalar equations")
    independent: int | None = Field(description="how many of them do not follow from those before")
    redundant_equations: list[str] | None = Field(default=None, description="those that do, in words")
    verdict: Verdict = Field(description="how sure its labels are: the weakest of them")
    verdicts: dict[str, FieldVerdict] = Field(default={}, description="how sure each label is")
    reason: str = Field(description="why, for a student")


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
    """

    links: int
    joints: int
    formula: str
    kutzbach: int
    freedom: int | None
    differs: str | None


class ForceEntry(ToldModel):
    """A force: no constraint, and why."""

    name: str
    reason: str


class SpecialCase(ToldModel):
    """Where the answer is another one: values of ``parameters``, or a ``locus`` of configurations.

    ``where`` are the conditions as text (``R = 0``, ``x = 0 and y = 0``), ``what`` says what changes there, and
    ``constraints`` for which.
    """

    where: str
    kind: Literal["parameters", "locus"]
    what: str
    constraints: list[str]
    verdict: Verdict


class Report(Displayed, ToldModel):
    """How a system can move; the fields and their meanings are those of the contract.

    ``dof`` is the dimension of the configuration space (hidden finite relations included),
    ``velocity_dof`` the number of independent velocities of finite motions,
    ``instantaneous_dof`` what the constraints allow to first order at the reference configuration.
    ``redundant`` is None, never empty, where it was not decided.
    ``special_cases`` are apart: all other fields are the generic answer.
    ``generic`` is the count in general position beside that at the drawing (None without a drawing), ``mobility``
    Gruebler's and Kutzbach's beside the truth (None without bodies and joints).
    ``verdicts`` says of every field that can be wrong how sure it is, and ``verdict`` is the weakest of these, those of
    the entries included; ``witness`` is a certified configuration (coordinate -> text, and parameters and ``t`` where
    they occur), None where none was found.
    ``certificate``: the evidence of what is proved, for `dofkit.verify`, where it was asked for.
    A number that could not be decided is None, ``verdict`` is then ``undecided`` and ``warnings`` says why.
    ``certificate``: evidence for what is proved, which `dofkit.verify` rechecks (None unless it was asked for).
    ``feasible``: whether the inequalities can all be met together with the constraints (None where that is not known,
    or where there are none); ``feasible_at`` is then a point at which they are: what is coupled to them, parameters
    and time (``t``) and velocities (``xdot``) included; ``infeasible`` a minimal set that cannot be met.

    >>> import dofkit
    >>> report = dofkit.classify("four-bar-linkage")
    >>> report.dof, report.count.naive_dof, report.model_dump(mode="json")["holonomic"]
    (1, 1, True)
    """

    scene: str = Field(description="the scene's name")
    consistent: bool | None = Field(
        description="false where no configuration, or no motion, satisfies all equations; conflicting then names a "
        "minimal set",
    )
    feasible: bool | None = Field(
        default=None,
        description="whether the inequalities can all be met together with the constraints; null where undecided, or "
        "without any",
    )
    infeasible: list[str] = Field(
        default=[],
        description="a minimal set of constraints with inequalities that cannot be met together",
    )
    feasible_at: dict[str, str] | None = Field(
        default=None, description="a certified point where all inequalities hold"
    )
    dof: int | None = Field(
        description="degrees of freedom: the dimension of the configuration space, coordinates less independent finite "
        "relations, hidden ones included; non-holonomic constraints and inequalities do not reduce it",
    )
    velocity_dof: int | None = Field(
        description="independent velocities of finite motions; non-holonomic constraints reduce it too",
    )
    instantaneous_dof: int | None = Field(
        description="velocities that the constraints allow to first order at the reference configuration",
    )
    singular: bool | None = Field(
        description="true where more velocities are allowed to first order than belong to motions",
    )
    holonomic: bool | None = Field(
        description="true where every constraint is: it follows from relations between coordinates (and time)",
    )
    scleronomic: bool | None = Field(description="true where time enters no constraint")
    count: Count = Field(
        description="the lecture's count f = N d - k of all finite equations as written, and why it errs",
    )
    redundant_equations: int | None = Field(description="how many scalar equations are too many")
    redundant: list[str] | None = Field(
        description="constraints that can be dropped together without changing any motion, as many as possible",
    )
    redundancies: list[Redundancy] = Field(
        description="groups of constraints that depend on each other, and how many equations each has too many",
    )
    conflicting: list[str] = Field(description="a minimal set of constraints that contradict each other")
    generalized_coordinates: list[str] | None = Field(
        description="an independent choice among the scene's coordinates, as many as there are degrees of freedom",
    )
    growth_vector: list[int] | None = Field(
        description="dimensions of the directions that differential constraints allow, then with their brackets, "
        "and so on",
    )
    integrable_part: IntegrablePart | None = Field(
        default=None,
        description="the finite relations that all differential constraints together amount to",
    )
    generic: Generic | None = Field(
        default=None,
        description="the freedom of the same joints in general position, and what is special about the drawing",
    )
    mobility: Mobility | None = Field(
        default=None,
        description="the count of Gruebler and Kutzbach beside the truth, and why they differ",
    )
    constraints: list[ConstraintEntry] = Field(
        description="the constraints in order, each with its labels, its verdict and the reason",
    )
    forces: list[ForceEntry] = Field(description="forces, and why they are no constraints")
    special_cases: list[SpecialCase] = Field(
        description="places and values of parameters where the answer is another one",
    )
    verdict: Verdict = Field(description="how sure the report is: the weakest of all verdicts in it")
    verdicts: dict[str, FieldVerdict] = Field(
        default={},
        description="how sure each field is, by which argument, with which bound, and of which points it speaks",
    )
    witness: dict[str, str] | None = Field(default=None, description="a certified configuration: coordinate -> value")
    certificate: dict[str, Any] | None = Field(
        default=None, description="evidence of what is proved, for `dofkit verify`"
    )
    method: str = Field(description="what ran")
    modelled: str = Field(description="what was computed with and what was left out, and why")
    warnings: list[str] = Field(description="what was noticed, and why something is open")
    _companion: Companion = PrivateAttr(default_factory=Companion)

    def text(self, width: int | None = None, how: bool = False) -> str:
        """What the command line prints, for ``width`` columns (None: those of the terminal, or 80).

        ``how``: also how sure each answer is, and by which argument. `print` writes the same without it.
        """
        return text_of(self, width, how)

    def beside(self, scene: object) -> Self:
        """The same report with what it is about beside it, whose title and picture are then shown."""
        self._companion.scene = scene
        return self
