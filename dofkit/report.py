"""What is told: the report, its entries and its verdicts. Field names are fixed; see each docstring."""

from __future__ import annotations

from copy import copy
from functools import lru_cache
from typing import Any, Literal, Self, TypeVar

from pydantic import BaseModel, ConfigDict, PrivateAttr, model_validator

from dofkit.base.display import Companion, Displayed, DisplayedFormulas, text_of
from dofkit.base.verdicts import About, ArgumentKey, Claim, Verdict

Form = Literal["finite", "pfaffian", "nonlinear", "inequality"]

#: Of several equations, the last of these that occurs names the constraint's form.
FORMS: tuple[Form, ...] = ("finite", "pfaffian", "nonlinear", "inequality")

#: Said of a constraint that is a product.
BRANCH_WARNING = "'{name}' holds on several branches; the numbers are those of the largest"


class ToldModel(BaseModel):
    """The base of what is told: frozen, with no keys beyond the fields."""

    model_config = ConfigDict(extra="forbid", frozen=True, defer_build=True)


Told = TypeVar("Told", bound=ToldModel)


def with_values(told: Told, **values: Any) -> Told:
    """As ``told.model_copy(update=values)``, for values of fields that were given: which these are the copy shares.

    >>> with_values(Redundancy(nullity=1, members=["A"]), nullity=2)
    Redundancy(nullity=2, members=['A'])
    """
    made = type(told).__new__(type(told))
    object.__setattr__(made, "__dict__", {**told.__dict__, **values})
    object.__setattr__(made, "__pydantic_fields_set__", told.__pydantic_fields_set__)
    object.__setattr__(made, "__pydantic_extra__", told.__pydantic_extra__)
    object.__setattr__(made, "__pydantic_private__", copy(told.__pydantic_private__))
    return made


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
    """One constraint's labels.

    ``form`` of the reduced equations; ``holonomic`` in the system and ``holonomic_alone`` without
    the others; ``scleronomic``: time does not enter, up to factors that never vanish; ``catastatic``:
    no dt term (None unless ``pfaffian``); ``exact``, ``integrating_factor``, ``integral`` of a
    Pfaffian form; ``circuit``: what a redundant constraint depends on; ``equations`` and how many are
    ``independent`` of all before; ``redundant_equations``: the others by name (None where it is not known which).
    A None label means undecided, and ``reason`` says why; ``verdicts`` says of every label how sure it is.
    """

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
    ``joint_coordinates``: of a tree of bodies the angles and displacements that describe it (None for any other).
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

    def beside(self, scene: object) -> Self:
        """The same report with what it is about beside it, whose title and picture are then shown."""
        self._companion.scene = scene
        return self
