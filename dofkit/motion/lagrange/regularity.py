"""Do the equations of motion fix the accelerations? The matrix of accelerations and multipliers tells."""

from __future__ import annotations

from dofkit.exact.errors import NoValueError
from dofkit.exact.matrices.sparse import rank_of_rows, sparse
from dofkit.exact.points.field import field_point
from dofkit.exact.ring.program import values
from dofkit.exact.ring.ring import Ring
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import diff
from dofkit.expressions.text import to_text
from dofkit.expressions.tree import ZERO, Expr
from dofkit.motion.lagrange.derivation import Derived
from dofkit.motion.lagrange.model import NoEquationsError

#: Points of GF(p) at which the rank is looked at, and how many are tried for them.
POINTS, ATTEMPTS = 3, 20
SINGULAR = "The kinetic energy is degenerate: these equations do not determine all accelerations."


def degenerate(derived: Derived) -> bool:
    """Is the matrix [[M, A^T], [A, 0]] singular, as far as points show it?

    Raises NoEquationsError where an equation says that a number is 0, or nothing in the energies moves.
    """
    model = derived.model
    for name, e in derived.equations.items():
        if (
            not e.is_zero
            and all(s.args[0] == "parameter" for s in e.symbols)
            and not (e.symbols & {ex.parameter(n) for n in derived.multipliers})
        ):
            raise NoEquationsError(f"there is no motion: Lagrange's equation for {name} reads {to_text(e)} = 0")
    if model.names and not any(s.args[0] == "velocity" for s in derived.lagrangian.symbols):
        raise NoEquationsError("the kinetic energy holds no velocity, so no equations of motion can be derived")
    rows = _rows(derived)
    if not rows:
        return False
    ring = Ring([e for row in rows for e in row], model.positive)
    nodes = [[ring.node(e) for e in row] for row in rows]
    seen = 0
    for seed in range(ATTEMPTS):
        point = field_point([ring], 300 + seed)
        try:
            found = values(ring, point)
        except NoValueError:
            continue
        if rank_of_rows(list(sparse([found[i] for i in row] for row in nodes)), point.p) == len(rows):
            return False
        seen += 1
        if seen == POINTS:
            return True
    return False


def _rows(derived: Derived) -> list[list[Expr]]:
    """M and the forces of multipliers, then what the constraints say of accelerations."""
    model = derived.model
    moving = [ex.sym("acceleration", n) for n in model.names]
    own = [ex.parameter(n) for n in derived.multipliers]
    rows = [[diff(e, s) for s in (*moving, *own)] for e in derived.equations.values()]
    nothing = [ZERO for _ in own]
    rows += [[*(diff(g, ex.coordinate(n)) for n in model.names), *nothing] for g in model.holonomic]
    rows += [[*(diff(r, ex.velocity(n)) for n in model.names), *nothing] for r in model.nonholonomic]
    return rows
