"""A system's equations as they are written: nothing is reduced, squared away or put into canonical form."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from dofkit.base.errors import TextError
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import accelerations_of, cleared, in_velocities
from dofkit.expressions.tree import Expr
from dofkit.relations.normal.normal_form import linear_form, velocities_of
from dofkit.relations.normal.pieces import Pfaffian
from dofkit.scene.constraints.equations import Equation
from dofkit.scene.lowering import lower
from dofkit.scene.scene import Scene
from dofkit.system import System

#: What an answer is called among the constraints of its scene.
ANSWER = "the answer"


@dataclass(frozen=True)
class Written:
    """The scalar equations of some constraints, each with the number of the constraint that it is of.

    ``others``: constraints that hold an inequality, an equation nonlinear in the velocities or a second derivative.
    """

    system: System
    finite: tuple[tuple[int, Expr], ...]
    forms: tuple[tuple[int, Pfaffian], ...]
    others: Mapping[int, str] = field(default_factory=dict)

    @property
    def coordinates(self) -> list[Expr]:
        """q, in order."""
        return [ex.coordinate(c.name) for c in self.system.coordinates]

    @property
    def timed(self) -> bool:
        """Does t or dt occur?"""
        return any(not f.dt.is_zero for _, f in self.forms) or any(ex.TIME in e.symbols for e in self.expressions)

    @property
    def expressions(self) -> list[Expr]:
        """Everything that is evaluated."""
        return [g for _, g in self.finite] + [a for _, f in self.forms for _, a in f.items()]

    @property
    def positive(self) -> frozenset[Expr]:
        """Parameters that are positive, squared lengths that were left out among them."""
        found = {ex.parameter(p) for p, sign in self.system.parameters.items() if sign == "positive"}
        return frozenset(found | {ex.parameter(p) for p in self.system.generic if p.startswith("_L")})

    def only(self, constraints: Sequence[int]) -> Written:
        """The equations of some constraints."""
        kept = frozenset(constraints)
        return Written(
            self.system,
            tuple((i, g) for i, g in self.finite if i in kept),
            tuple((i, f) for i, f in self.forms if i in kept),
            {i: why for i, why in self.others.items() if i in kept},
        )


def as_written(scene: Scene | System) -> Written:
    """The equations of a scene."""
    system = scene if isinstance(scene, System) else lower(scene)
    finite: list[tuple[int, Expr]] = []
    forms: list[tuple[int, Pfaffian]] = []
    others: dict[int, str] = {}
    for i, constraint in enumerate(system.constraints):
        for relation in constraint.relations:
            if relation.sense != "=":
                others[i] = "inequality"
                continue
            found = _read(relation.expr)
            if isinstance(found, str):
                others[i] = found
            elif isinstance(found, Pfaffian):
                forms.append((i, found))
            else:
                finite.append((i, found))
    return Written(system, tuple(finite), tuple(forms), others)


def _read(e: Expr) -> Expr | Pfaffian | str:
    """A finite relation, a form, or why it is neither."""
    if accelerations_of(e):
        return "acceleration"
    try:
        moving, divided = in_velocities(e)
    except TextError:
        return "nonlinear"
    if not velocities_of(moving):
        return Pfaffian({}, moving) if divided else moving
    form = linear_form(cleared(moving))
    return "nonlinear" if form is None else form


@dataclass(frozen=True)
class WrittenAnswer:
    """An answer, the constraint that it should be, and the others, as written."""

    answer: Written
    asked: Written
    rest: Written


def posed(scene: Scene, answer: Mapping[str, str]) -> WrittenAnswer:
    """What is compared where an answer is; raises SceneError where it cannot be read."""
    texts = [part for part in answer["text"].replace("\n", ";").split(";") if part.strip()]
    more = [Equation(name=f"{ANSWER} {k}", text=text) for k, text in enumerate(texts)]
    whole = as_written(scene.model_copy(update={"constraints": (*scene.constraints, *more), "expect": {}}))
    names = [c.name for c in whole.system.constraints]
    asked = [i for i, name in enumerate(names) if name == answer["constraint"]]
    given = [i for i, name in enumerate(names) if name.startswith(ANSWER)]
    rest = [i for i in range(len(names)) if i not in asked and i not in given]
    return WrittenAnswer(whole.only(given), whole.only(asked), whole.only(rest))


def labelled(written: Written, holonomic: Mapping[int, bool]) -> dict[str, bool]:
    """By name: what is finite is holonomic, inequalities and what is nonlinear in velocities are taken not to be.

    ``holonomic``: of the constraints that hold forms.
    """
    names = [c.name for c in written.system.constraints]
    return {name: holonomic.get(i, True) and i not in written.others for i, name in enumerate(names)}
