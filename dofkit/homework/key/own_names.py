"""Eliminates undeclared names of an answer: angles, parameters of curves, and other names for constants.

`x = l sin(theta), y = -l cos(theta)` implies x^2 + y^2 = l^2 for x and y, and nothing else: every point of the circle
has a theta. A relation that is linear in an undeclared name is solved for it.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import permutations
from typing import TypeAlias

from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import diff, replace_nodes, substitute
from dofkit.expressions.text import Comparison
from dofkit.expressions.tree import ONE, ZERO, Expr
from dofkit.homework.answers.relations import AnswerReading, is_constant_name
from dofkit.scene.scene import Scene

#: The most undeclared names that are tried as declared constants.
MOST_RENAMED = 2
_TWO = 2
_SINE, _COSINE = ex.parameter("own sine"), ex.parameter("own cosine")
#: The coefficients of sine and cosine in a relation, and the remainder.
_Row: TypeAlias = tuple[Expr, Expr, Expr]


def restrictions(relations: Sequence[Comparison], names: Sequence[str], scene: Scene) -> list[Expr] | None:
    """Return what relations that define ``names`` imply for the coordinates (each is 0), or None if undecided."""
    still = {ex.coordinate(name): ex.parameter(name) for name in names}
    return _without([substitute(c.left - c.right, still) for c in relations], [*still.values()], scene)


def _without(sums: list[Expr], symbols: Sequence[Expr], scene: Scene) -> list[Expr] | None:
    """Return expressions (each is 0) with all ``symbols`` eliminated, or None if that is not possible."""
    for symbol in symbols:
        remaining = _eliminated(sums, symbol, scene)
        if remaining is None:
            return None
        sums = remaining
    return sums


def without_own(reading: AnswerReading, scene: Scene) -> AnswerReading | None:
    """Return an equivalent reading without undeclared names, or None if they cannot be eliminated."""
    if any(c.relation != "=" for c in reading.relations):
        return None
    sums = [c.left - c.right for c in reading.relations]
    if any(sum(_mentions(e, name) for e in sums) < 2 for name in reading.undeclared):
        return None
    unknowns = [ex.coordinate(n) if n in reading.moving else ex.parameter(n) for n in reading.undeclared]
    remaining = _without(sums, unknowns, scene)
    if not remaining or any(_mentions(e, name) for e in remaining for name in reading.undeclared):
        return None
    relations = tuple(Comparison(e, "=", ZERO, 1) for e in remaining)
    return AnswerReading(relations, (False,) * len(relations))


def with_constants(relations: Sequence[Comparison], names: Sequence[str], scene: Scene) -> list[Comparison]:
    """Return relations without undeclared constants that one of them defines by declared ones: `omega^2 = g/l`."""
    kept = list(relations)
    for name in names:
        symbol = ex.parameter(name)
        for c in kept:
            value = _defined(c, symbol, names, scene)
            if value is not None:
                kept = [o.substituted({symbol: value}) for o in kept if o is not c]
                break
    return kept


def _defined(c: Comparison, symbol: Expr, names: Sequence[str], scene: Scene) -> Expr | None:
    """Return the value of a constant if a relation states it or its square by declared constants, else None."""
    e = c.left - c.right
    others = e.symbols - {symbol}
    if c.relation != "=" or symbol not in e.symbols or any(s.args[0] != "parameter" for s in others):
        return None
    if any(s.args[1] in names for s in others):
        return None
    squared = ex.parameter("square of a name")
    for named, root in ((e, False), (replace_nodes(e, {symbol**2: squared}), True)):
        unknown = squared if root else symbol
        slope = diff(named, unknown)
        occurrences = {symbol} & named.symbols if root else {symbol} & slope.symbols
        if not occurrences and unknown not in slope.symbols and never_zero(slope, scene):
            value = -substitute(named, {unknown: ZERO}) / slope
            return ex.sqrt(value) if root else value
    return None


def _mentions(e: Expr, name: str) -> bool:
    return any(len(s.args) > 1 and s.args[1] == name for s in e.symbols)


def _eliminated(sums: Sequence[Expr], symbol: Expr, scene: Scene) -> list[Expr] | None:
    """Return expressions (each is 0) without ``symbol``, equivalent for the other symbols, or None."""
    holding = [e for e in sums if symbol in e.symbols]
    untouched = [e for e in sums if symbol not in e.symbols]
    for e in holding:
        slope = diff(e, symbol)
        if symbol not in slope.symbols and never_zero(slope, scene):
            value = -substitute(e, {symbol: ZERO}) / slope
            return untouched + [substitute(other, {symbol: value}) for other in holding if other is not e]
    along = _without_length(holding, symbol, scene)
    if along is not None:
        return [*untouched, along]
    return _without_angle(holding, untouched, symbol, scene)


def _without_length(holding: Sequence[Expr], symbol: Expr, scene: Scene) -> Expr | None:
    """Return a sin(A) - b cos(A) for two relations a = r cos(A), b = r sin(A) with the symbol r; None for others."""
    if len(holding) != 2:
        return None
    slopes = [diff(e, symbol) for e in holding]
    offsets = [substitute(e, {symbol: ZERO}) for e in holding]
    factors = [_turn(slope, scene) for slope in slopes]
    if None in factors or {t[0] for t in factors if t} != {"sin", "cos"} or len({t[1] for t in factors if t}) != 1:
        return None
    if any(symbol in e.symbols for e in slopes):
        return None
    return offsets[0] * slopes[1] - offsets[1] * slopes[0]


def _turn(e: Expr, scene: Scene) -> tuple[str, Expr] | None:
    """Return ("sin" or "cos", its argument) for a sine or cosine with factors that are never 0, else None."""
    factors = e.args if e.op == "mul" else (e,)
    turning = [f for f in factors if f.op == "fn" and f.args[0] in ("sin", "cos")]
    others = [f for f in factors if f not in turning]
    if len(turning) != 1 or not all(never_zero(f, scene) for f in others):
        return None
    return turning[0].args[0], turning[0].args[1]


def _without_angle(holding: Sequence[Expr], untouched: list[Expr], symbol: Expr, scene: Scene) -> list[Expr] | None:
    """Return relations without an angle, if they are linear in its sine and cosine; their squares add up to 1.

    a sin(A) = b cos(A) is satisfied by some A for any a, b; a = r cos(A), b = r sin(A) if a^2 + b^2 = r^2.
    """
    angles = {n.args[1] for e in holding for n in ex.nodes(e) if n.op == "fn" and symbol in n.symbols}
    if len(angles) != 1:
        return None
    (angle,) = angles
    slope = diff(angle, symbol)
    if slope.op != "num" or slope.is_zero:
        return None
    named = {ex.fn("sin", angle): _SINE, ex.fn("cos", angle): _COSINE}
    sums = [replace_nodes(e, named) for e in holding]
    if any(symbol in e.symbols for e in sums):
        return None
    rows = {e: row for e in sums if (row := _linear(e)) is not None}
    if len(sums) < _TWO:
        return untouched if rows and rows[sums[0]][2].is_zero else None
    if len(sums) == _TWO == len(rows) and (circle := _circle(*rows.values())) is not None:
        return [*untouched, circle]
    for first, second in permutations(rows, 2):
        solved = _solved(rows[first], rows[second], scene)
        if solved is not None:
            others = [substitute(e, solved) for e in sums if e is not first and e is not second]
            return [*untouched, *others, solved[_SINE] ** 2 + solved[_COSINE] ** 2 - ONE]
    return None


def _linear(e: Expr) -> _Row | None:
    """Return the row of a relation; None if ``e`` is not linear in sine and cosine."""
    row = diff(e, _SINE), diff(e, _COSINE), substitute(e, {_SINE: ZERO, _COSINE: ZERO})
    return None if any({_SINE, _COSINE} & c.symbols for c in row) else row


def _circle(first: _Row, second: _Row) -> Expr | None:
    """Return e^2 + f^2 - r^2 for e = r sin(A), f = r cos(A), with any signs; None for other relations."""
    (a, b, e), (c, d, f) = (first, second) if first[1].is_zero else (second, first)
    if not b.is_zero or not c.is_zero or not (a * a - d * d).is_zero:
        return None
    return e * e + f * f - a * a


def _solved(first: _Row, second: _Row, scene: Scene) -> dict[Expr, Expr] | None:
    """Return the sine and cosine by Cramer's rule, or None if the determinant may be 0."""
    (a, b, e), (c, d, f) = first, second
    whole = a * d - b * c
    if not never_zero(whole, scene):
        return None
    return {_SINE: (b * f - d * e) / whole, _COSINE: (c * e - a * f) / whole}


def never_zero(e: Expr, scene: Scene) -> bool:
    """Return whether an expression is a product of numbers that are not 0 and positive or nonzero parameters."""
    if e.op == "num":
        return not e.is_zero
    if e.op == "mul":
        return all(never_zero(factor, scene) for factor in e.args)
    if e.op == "pow":
        return never_zero(e.args[0], scene)
    is_parameter = e.op == "sym" and e.args[0] == "parameter"
    return is_parameter and scene.parameters.get(str(e.args[1])) in ("positive", "nonzero")


def renamed(
    reading: AnswerReading, scene: Scene, constants: Sequence[str]
) -> Iterator[tuple[AnswerReading, dict[str, str]]]:
    """Yield (reading, {undeclared name: constant}) for every choice of unmentioned declared ``constants``."""
    if any(map(is_constant_name, reading.undeclared)):
        return
    if not reading.undeclared or reading.moving or len(reading.undeclared) > MOST_RENAMED:
        return
    used = {str(s.args[-1]) for s in reading.symbols}
    free = [name for name in constants if name not in used]
    for chosen in permutations(free, len(reading.undeclared)):
        names = dict(zip(reading.undeclared, chosen, strict=True))
        table = {ex.parameter(undeclared): ex.parameter(name) for undeclared, name in names.items()}
        relations = tuple(c.substituted(table) for c in reading.relations)
        yield reading._replace(relations=relations, undeclared=()), names
