"""Special values of parameters: put into the system, which is then answered again."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product as cartesian

from dofkit.base.wording import many, verb
from dofkit.classification.special.common_zeros import Leaf, Reals
from dofkit.classification.special.wording import tuple_of
from dofkit.exact.ring.canonical import Canon, Poly
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import substitute
from dofkit.expressions.tree import Expr
from dofkit.report import BRANCH_WARNING, ConstraintEntry, Report
from dofkit.system import Sign, System

Values = Mapping[Expr, Expr]
#: Labels whose change is told, after the change to holonomic.
_WORDS = (
    ("holonomic", "holonomic", "non-holonomic"),
    ("scleronomic", "scleronomic", "rheonomic"),
    ("exact", "exact as written", "not exact as written"),
)
#: Values of one condition that are looked at, all of which must give one answer.
MAX_VALUES = 4


@dataclass(frozen=True)
class ParameterCondition:
    """Conditions on parameters alone; ``integrals``: the constraints whose integrals are not defined under them."""

    leaf: Leaf
    reals: Reals
    integrals: tuple[str, ...] = ()


def assignments(condition: ParameterCondition, signs: Mapping[str, Sign]) -> list[dict[Expr, Expr]]:
    """Values of the parameters for which the conditions hold, the declared signs kept; none where that is not sure."""
    leaf, reals = condition.leaf, condition.reals
    found: list[dict[Expr, Expr]] = [{}]
    conditions = [_options(reals, poly, signs) for poly in leaf.conditions(reals.canon)]
    for options in conditions:
        found = [{**old, **new} for old, new in cartesian(found, options)]
    if len(found) > MAX_VALUES or any(len(v) < len(conditions) or _cyclic(v) for v in found):
        return []
    return found


def _cyclic(values: Values) -> bool:
    """Does a parameter that gets a value occur in a value?"""
    return any(not e.symbols.isdisjoint(values) for e in values.values())


def _options(reals: Reals, poly: Poly, signs: Mapping[str, Sign]) -> list[dict[Expr, Expr]]:
    """The ways to satisfy one condition: an angle, a root, or a parameter in terms of others."""
    canon = reals.canon
    present = canon.generators_in(poly)
    if len(present) == 1:
        return _alone(reals, poly, present[0], signs)
    for i in present:
        var, place = canon.ring.vars[i], len(canon.gens) - 1 - i
        if var.kind != "symbol" or poly.degrees()[place] != 1 or not poly.derivative(place).is_constant():
            continue
        value = canon.gens[i] - poly / poly.derivative(place).leading_coefficient()
        sign = signs.get(str(var.key.args[1]), "real")
        if sign == "real" or (reals.never_zero(value) and (sign == "nonzero" or _sums_of_positive(reals, value))):
            return [{var.key: canon.to_expr(value)}]
    return []


def _sums_of_positive(reals: Reals, poly: Poly) -> bool:
    """Positive numbers times products of positive generators."""
    return reals.signs.positive.issuperset(reals.canon.generators_in(poly)) and all(
        c > 0 for c in poly.to_dict().values()
    )


def _alone(reals: Reals, poly: Poly, index: int, signs: Mapping[str, Sign]) -> list[dict[Expr, Expr]]:
    """A condition on one generator: a parameter (linear or a square), or the sine or cosine of one."""
    canon, var = reals.canon, reals.canon.ring.vars[index]
    slope = poly.derivative(len(canon.gens) - 1 - index)
    if slope.is_constant():
        value = canon.to_expr(canon.gens[index] - poly / slope.leading_coefficient())
        return [{var.key: value}] if var.kind == "symbol" else _angles(canon, index, value)
    at_zero = reals.put(poly, [(index, canon.one * 0)])
    if var.kind != "symbol" or poly.total_degree() != 2 or slope - slope.leading_coefficient() * canon.gens[index] != 0:
        return []
    root = ex.sqrt(canon.to_expr(-at_zero / poly.leading_coefficient()))
    positive = signs.get(str(var.key.args[1])) == "positive"
    return [{var.key: value} for value in ((root,) if positive else (root, -root))]


def _angles(canon: Canon, index: int, value: Expr) -> list[dict[Expr, Expr]]:
    """A parameter in whose sine or cosine the condition is, at a quarter turn."""
    var = canon.ring.vars[index]
    if var.kind not in ("cos", "sin"):
        return []
    rest, denominator = var.key
    if rest.op != "sym" or value not in (ex.ZERO, ex.ONE, ex.MINUS_ONE):
        return []
    quarters = {"sin": {0: (0, 2), 1: (1,), -1: (3,)}, "cos": {0: (1, 3), 1: (0,), -1: (2,)}}
    turn = ex.HALF * ex.PI * denominator
    return [{rest: turn * k} for k in quarters[var.kind][int(value.args[0])]]


def at_values(system: System, values: Values) -> System:
    """The system with parameters replaced. Raises PoleError where it has no meaning for them."""

    def put(e: Expr) -> Expr:
        return substitute(e, values)

    constraints = tuple(
        c._replace(relations=tuple(r._replace(expr=put(r.expr)) for r in c.relations)) for c in system.constraints
    )
    gone = {str(s.args[1]) for s in values}
    return replace(
        system,
        constraints=constraints,
        parameters={name: sign for name, sign in system.parameters.items() if name not in gone},
        reference=None if system.reference is None else {s: put(v) for s, v in system.reference.items()},
        pose={s: put(v) for s, v in system.pose.items()},
    )


def differences(generic: Report, special: Report, integrals: Sequence[str] = ()) -> list[str]:
    """What the answer becomes, in words: only where both are decided and differ.

    ``integrals``: constraints whose integrals are not defined as they are written.
    """
    if generic.consistent is None or special.consistent is None:
        return []
    if generic.consistent != special.consistent:
        if special.consistent:
            return [f"{_all(generic.conflicting)} can be satisfied, with {_degrees(special.dof)}"]
        return [f"{_all(special.conflicting)} cannot be satisfied"]
    said = [*_branches(generic, special), *_labels(generic, special), *_integrals(special, integrals)]
    fields = (("the degrees of freedom are", "dof"), ("the velocity freedom is", "velocity_dof"))
    numbers = {subject: (getattr(generic, f), getattr(special, f)) for subject, f in fields}
    differ = {subject: pair for subject, pair in numbers.items() if None not in pair and pair[0] != pair[1]}
    if len(differ) == 2 and len(set(differ.values())) == 1:
        differ = {"the degrees of freedom and velocity freedom are": next(iter(differ.values()))}
    said += [f"{subject} {new} instead of {old}" for subject, (old, new) in differ.items()]
    old, new = generic.growth_vector, special.growth_vector
    if old and new and old != new and not said:
        said.append(f"the growth vector is {tuple_of(new)} instead of {tuple_of(old)}")
    before, now = generic.redundant, special.redundant
    idle = _idle(generic, special)
    more = [] if before is None or now is None else [name for name in now if name not in before and name not in idle]
    if more and generic.dof is not None and special.dof is not None:
        said.append(f"{', '.join(more)} {_is(more)} redundant")
    return said


def _branches(generic: Report, special: Report) -> list[str]:
    """Constraints that fall into branches."""
    told = [(e.name, BRANCH_WARNING.format(name=e.name)) for e in special.constraints]
    return [f"{name} has several branches" for name, w in told if w in special.warnings and w not in generic.warnings]


def _integrals(special: Report, names: Sequence[str]) -> list[str]:
    """The integrals instead of those that are not defined."""
    said = []
    for entry in special.constraints:
        if entry.name in names and entry.holonomic:
            instead = entry.integral or "not found in closed form"
            said.append(f"the integral of {entry.name} is {instead}")
    return said


def _all(names: Sequence[str]) -> str:
    if len(names) == 1:
        return names[0]
    return f"{', '.join(names[:-1])} and {names[-1]} together" if names else "the constraints together"


def _degrees(number: int | None) -> str:
    return "an undecided number of degrees of freedom" if number is None else f"{many(number, 'degree')} of freedom"


def _idle(generic: Report, special: Report) -> list[str]:
    """Constraints that say nothing any more."""
    pairs = zip(generic.constraints, special.constraints, strict=True)
    return [old.name for old, new in pairs if old.independent and new.independent == 0 and new.circuit == []]


def _labels(generic: Report, special: Report) -> list[str]:
    idle = _idle(generic, special)
    said = [f"{', '.join(idle)} {verb(len(idle))} always satisfied"] if idle else []
    pairs = [p for p in zip(generic.constraints, special.constraints, strict=True) if p[0].name not in idle]
    becoming = [old.name for old, new in pairs if _flips(old, new, "holonomic", True)]
    if becoming and all(new.holonomic for old, new in pairs if old.form == "pfaffian"):
        said.append("every form is integrable")
    elif becoming:
        said.append(f"{', '.join(becoming)} {_is(becoming)} holonomic")
    pairs = [p for p in pairs if p[0].name not in becoming]
    for field, yes, no in _WORDS:
        for value, word in ((True, yes), (False, no)):
            names = [old.name for old, new in pairs if _flips(old, new, field, value)]
            if names:
                said.append(f"{', '.join(names)} {_is(names)} {word}")
    return said


def _flips(old: ConstraintEntry, new: ConstraintEntry, field: str, to: bool) -> bool:
    return getattr(old, field) is (not to) and getattr(new, field) is to


def _is(names: Sequence[str]) -> str:
    return "is" if len(names) == 1 else "are"


def changed(generic: Report, special: Report) -> list[str]:
    """The constraints whose labels or independence change."""
    fields = ("holonomic", "scleronomic", "exact", "independent", "form")
    return [
        old.name
        for old, new in zip(generic.constraints, special.constraints, strict=True)
        if any(getattr(old, f) != getattr(new, f) for f in fields)
    ]
