"""Special values of parameters: put into the system, which is then answered again."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product as cartesian

from dofkit.classification.special.common_zeros import Leaf, Reals
from dofkit.exact.ring.canonical import Canon, Poly
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import substitute
from dofkit.expressions.tree import Expr
from dofkit.report import Report
from dofkit.system import Sign, System

Values = Mapping[Expr, Expr]
#: Labels whose change is reported.
_WORDS = (
    ("holonomic", "holonomic", "non-holonomic"),
    ("scleronomic", "scleronomic", "rheonomic"),
)
#: Values of one condition that are looked at, all of which must give one answer.
MAX_VALUES = 4


@dataclass(frozen=True)
class ParameterCondition:
    """Conditions on parameters alone."""

    leaf: Leaf
    reals: Reals


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


def differences(generic: Report, special: Report) -> list[str]:
    """Return what the answer becomes, in words, where both are decided and differ."""
    if generic.consistent is None or special.consistent is None:
        return []
    if not (generic.consistent and special.consistent):
        names = " and ".join(special.conflicting) or "the constraints together"
        return [] if special.consistent == generic.consistent else [f"{names} cannot be satisfied"]
    changes = [*_labels(generic, special)]
    numbers = [
        (subject, getattr(special, name), getattr(generic, name))
        for subject, name in (("the degrees of freedom are", "dof"), ("the velocity freedom is", "velocity_dof"))
    ]
    differ = [row for row in numbers if None not in row and row[1] != row[2]]
    if len(differ) == 2 and differ[0][1:] == differ[1][1:]:
        differ = [("the degrees of freedom and velocity freedom are", *differ[0][1:])]
    changes += [f"{subject} {after} instead of {before}" for subject, after, before in differ]
    before, after = generic.redundant, special.redundant
    more = [] if before is None or after is None else [name for name in after if name not in before]
    return changes + ([f"{', '.join(more)} {_is(more)} redundant"] if more else [])


def _labels(generic: Report, special: Report) -> Iterator[str]:
    """Yield the constraints whose labels change."""
    for field, yes, no in _WORDS:
        for value, word in ((True, yes), (False, no)):
            pairs = zip(generic.constraints, special.constraints, strict=True)
            names = [a.name for a, b in pairs if (getattr(a, field), getattr(b, field)) == (not value, value)]
            if names:
                yield f"{', '.join(names)} {_is(names)} {word}"


def _is(names: Sequence[str]) -> str:
    return "is" if len(names) == 1 else "are"


def changed(generic: Report, special: Report) -> list[str]:
    """Return the constraints whose labels or independence change."""
    fields = ("holonomic", "scleronomic", "exact", "independent", "form")
    pairs = zip(generic.constraints, special.constraints, strict=True)
    return [a.name for a, b in pairs if any(getattr(a, f) != getattr(b, f) for f in fields)]
