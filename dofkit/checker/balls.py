"""Values in balls: every operation encloses the true one, and only where it is defined and smooth around."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import Any

from flint import arb, arb_mat, ctx, fmpq

from dofkit.checker.derivatives import derivative, symbols_in
from dofkit.checker.effort import Effort
from dofkit.checker.errors import CheckError
from dofkit.checker.trees import Tree

#: Bits of every ball.
PRECISION = 320
#: Balls of a larger radius are boxes.
WIDE = 1e-3
_SMOOTH = frozenset(("sin", "cos", "tan", "cot", "sec", "csc", "atan", "sinh", "cosh", "tanh", "exp"))


def ball_of(value: Fraction) -> Any:
    """A rational number."""
    return arb(fmpq(value.numerator, value.denominator))


def excludes_zero(ball: Any) -> bool:
    """Whether 0 is certainly not in a ball."""
    return bool(ball.is_finite() and (ball > 0 or ball < 0))


def evaluated(tree: Tree, values: Mapping[str, Any], effort: Effort) -> Any:
    """The ball of a tree, where every part has a value and is smooth around; else `CheckError`."""
    done: dict[int, Any] = {}

    def value(node: Tree) -> Any:
        if id(node) not in done:
            effort.spend(1)
            done[id(node)] = _value(node, values, [value(part) for part in node.below])
        return done[id(node)]

    with ctx.workprec(PRECISION):
        found = value(tree)
    if not found.is_finite():
        raise CheckError("a value is not finite at the point")
    return found


def _value(node: Tree, values: Mapping[str, Any], below: list[Any]) -> Any:
    if isinstance(node.value, Fraction):
        return ball_of(node.value)
    if node.head == "symbol":
        if node.value not in values:
            raise CheckError(f"`{node.value}` has no value at the point")
        return values[str(node.value)]
    if node.head == "pi":
        return arb.pi()
    if node.head in ("sum", "product"):
        found = arb(0 if node.head == "sum" else 1)
        for part in below:
            found = found + part if node.head == "sum" else found * part
        return found
    if node.head == "power":
        return _powered(node, below)
    if node.head in _SMOOTH:
        return getattr(below[0], node.head)()
    return _guarded(node, below)


def _powered(node: Tree, below: list[Any]) -> Any:
    base, exponent = below
    value = node.below[1].value
    if isinstance(value, Fraction) and value.denominator == 1:
        if value < 0 and not excludes_zero(base):
            raise CheckError("a denominator may be 0 at the point")
        return base ** int(value) if base.rad() < WIDE or value < 0 else _wide_power(base, int(value))
    if not base > 0:
        raise CheckError("the base of a power that is not whole may be 0 or negative at the point")
    return base**exponent


def _wide_power(base: Any, exponent: int) -> Any:
    """The power of a wide ball by its ends, as it is monotone on either side of 0."""
    ends = base.lower() ** exponent, base.upper() ** exponent
    found = ends[0].union(ends[1])
    return found.union(arb(0)) if exponent % 2 == 0 and base.contains(0) else found


def _guarded(node: Tree, below: list[Any]) -> Any:
    head, u = node.head, below[0]
    if head == "sqrt" and (u > 0 or (u == 0 and not symbols_in(node))):
        return u.sqrt()
    if head == "log" and u > 0:
        return u.log()
    if head in ("asin", "acos") and u > -1 and u < 1:
        return u.asin() if head == "asin" else u.acos()
    if head == "abs" and excludes_zero(u):
        return abs(u)
    if head == "atan2" and (below[1] > 0 or excludes_zero(u)):
        return arb.atan2(u, below[1])
    raise CheckError(f"`{head}` has no smooth value at the point")


def determinant(rows: Sequence[Sequence[Any]], effort: Effort) -> Any:
    """The ball of a determinant."""
    effort.spend(len(rows) ** 3 // 10 + 1)
    with ctx.workprec(PRECISION):
        return arb_mat([list(row) for row in rows]).det() if rows else arb(1)


def krawczyk(
    equations: Sequence[Tree],
    unknowns: Sequence[str],
    centre: Sequence[Any],
    radius: Any,
    inverse: Sequence[Sequence[Any]] | None,
    effort: Effort,
) -> dict[str, Any]:
    """Balls for the only zero of as many equations as unknowns within a box around ``centre``.

    Krawczyk 1969, Moore 1977: where K = y - C F(y) + (1 - C F'(X)) (X - y) lies inside X, F has exactly one zero in X,
    and it lies in K.
    """
    size = len(unknowns)
    effort.spend(size**3 // 3 + 1)
    with ctx.workprec(PRECISION):
        spread = arb(0, radius)
        middle = {name: ball.mid() for name, ball in zip(unknowns, centre, strict=True)}
        box = {name: ball + spread for name, ball in middle.items()}
        slopes = [[derivative(equation, name) for name in unknowns] for equation in equations]
        at_box = arb_mat([[evaluated(slope, box, effort) for slope in row] for row in slopes])
        if inverse is None:
            at_middle = [[evaluated(slope, middle, effort).mid() for slope in row] for row in slopes]
            inverse = _middle_of_inverse(at_middle)
        multiplier = arb_mat([list(row) for row in inverse])
        values = arb_mat([[evaluated(equation, middle, effort)] for equation in equations])
        rest = arb_mat([[arb(i == j) for j in range(size)] for i in range(size)]) - multiplier * at_box
        start = arb_mat([[middle[name]] for name in unknowns])
        image = start - multiplier * values + rest * arb_mat([[spread] for _ in unknowns])
        for i, name in enumerate(unknowns):
            if not box[name].contains_interior(image[i, 0]):
                raise CheckError(f"interval Newton does not certify a zero: `{name}` leaves its box")
        return {name: image[i, 0] for i, name in enumerate(unknowns)}


def _middle_of_inverse(rows: list[list[Any]]) -> list[list[Any]]:
    try:
        found = arb_mat(rows).inv()
    except ZeroDivisionError:
        raise CheckError("the matrix of interval Newton is singular") from None
    return [[found[i, j].mid() for j in range(len(rows))] for i in range(len(rows))]
