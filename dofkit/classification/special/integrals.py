"""Values of the parameters for which an integral, as it is written, has no value: y - sin(k t)/k at k = 0."""

from __future__ import annotations

from collections.abc import Iterator

from dofkit.base.errors import TextError
from dofkit.classification.special.common_zeros import Reals, common_zeros
from dofkit.classification.special.parameters import ParameterCondition
from dofkit.exact.ring.canonical import Canon
from dofkit.exact.ring.ring import Ring
from dofkit.expressions import tree as ex
from dofkit.expressions.text import Names, parse_expression
from dofkit.expressions.tree import Expr
from dofkit.report import ConstraintEntry, Report
from dofkit.system import System


def undefined_integrals(system: System, report: Report) -> Iterator[ParameterCondition]:
    """The factors of integrals' denominators that vanish for special values of the parameters."""
    free = {name for name, sign in system.parameters.items() if sign != "nonzero"}
    entries = [e for e in report.constraints if e.integral and "/" in e.integral] if free else []
    if not entries:
        return
    names = Names(
        frozenset(c.name for c in system.coordinates),
        {name: ex.parameter(name) for name in system.parameters},
        dict(system.functions),
    )
    positive = frozenset(ex.parameter(p) for p, sign in system.parameters.items() if sign == "positive")
    nonzero = frozenset(ex.parameter(p) for p, sign in system.parameters.items() if sign == "nonzero")
    for entry in entries:
        for shown in _read(entry, names):
            ring = Ring([shown], positive)
            node = ring.node(shown)
            canon = Canon(ring)
            reals = Reals(canon, positive, nonzero)
            below = canon.quotient(node)[1]
            factors = [] if below.is_constant() else [f for f in reals.factors(below) if reals.of_parameters(f)]
            for factor in factors:
                yield from (ParameterCondition(leaf, reals, (entry.name,)) for leaf in common_zeros(reals, [factor]))


def _read(entry: ConstraintEntry, names: Names) -> list[Expr]:
    """The integrals' left sides."""
    try:
        return [parse_expression(part.rpartition(" = ")[0], names) for part in (entry.integral or "").split("; ")]
    except TextError:
        return []
