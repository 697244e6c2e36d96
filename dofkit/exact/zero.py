"""Is an expression identically zero, can non-zero be trusted, and which of the two one-sided engines may be asked?"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from typing import Literal

from flint import arb, ctx, fmpq_mat

from dofkit.base.errors import NoValueError
from dofkit.base.verdicts import Verdict
from dofkit.exact.points.balls import fixed_bits, random_ball_point
from dofkit.exact.points.field import MOST_REDUCED, field_point
from dofkit.exact.ring.canonical import Canon, divided
from dofkit.exact.ring.program import ADD, MUL, NUM, POW, VAR, Var, false_without_value, reachable, values
from dofkit.exact.ring.ring import Ring
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import diff
from dofkit.expressions.tree import Expr

#: ``field``: exact arithmetic at random points modulo random primes, where zero can be trusted. ``balls``: interval
#: arithmetic at real points, where non-zero is a proof.
Engine = Literal["field", "balls"]
Engines = frozenset[Engine]

FIELD: Engines = frozenset(("field",))
BALLS: Engines = frozenset(("balls",))
BOTH: Engines = FIELD | BALLS


#: Bits of the balls that must hold 0 before anything is taken for 0.
PRECISIONS = (256, 1024)
#: Random places at which balls are taken, and draws of points over GF(p).
STARTS, TRIES = 8, 60


def is_zero(e: Expr, positive: frozenset[Expr]) -> bool:
    """Return whether the expression is taken for zero identically; `zero_and_verdict` says how certain that is."""
    return bool(zero_and_verdict(e, positive)[0])


def is_proved_zero(e: Expr, positive: frozenset[Expr]) -> bool:
    """Return whether the expression is proved to be zero identically."""
    return zero_and_verdict(e, positive) == (True, "proved")


def zero_and_verdict(e: Expr, positive: frozenset[Expr], engines: Engines = BOTH) -> tuple[bool | None, Verdict]:
    """Return whether the expression is zero identically, and how certain that is.

    None where one engine alone cannot decide it, or where the expression has no value at any point that was tried.
    Zero in the canonical ring is a proof; so is a value that is not zero there, or at a point over GF(p) where the
    generators are independent, or a ball at some real point that excludes 0. What is 0 at random points over GF(p) is
    probably zero [SchwartzZippel]; what no ball distinguishes from 0 is zero numerically.
    """
    if e.op == "num":
        return e.is_zero, "proved"
    ring = Ring([e], positive)
    node = ring.node(e)
    if engines != BOTH:
        return _by_one_engine(ring, node, positive, engines)
    canon = Canon(ring)
    try:
        independent = independent_generators(ring)
        if independent and _zero_at_points(ring, node, 1) is False:
            return False, "proved"
        if canon.is_zero(node):
            return True, "proved"
    except NoValueError:
        pass
    if excludes_zero(ring, node, positive):
        return False, "proved"
    if _zero_at_points(ring, node):
        return True, "probable"
    return (True, "numeric") if _has_value(ring, node, positive) else (None, "undecided")


def _balls(ring: Ring, node: int, positive: frozenset[Expr], precisions: Sequence[int] = PRECISIONS) -> Iterator[arb]:
    """Yield the value of a node at random real points, at one precision after another."""
    bits = fixed_bits()
    for precision in precisions if bits is None else (bits,):
        for seed in range(STARTS):
            with ctx.workprec(precision), suppress(NoValueError):
                yield values(ring, random_ball_point(ring, positive, seed))[node]


def _has_value(ring: Ring, node: int, positive: frozenset[Expr]) -> bool:
    """Return whether the node has a value at one of the real points that are tried."""
    return any(ball.is_finite() for ball in _balls(ring, node, positive, PRECISIONS[:1]))


def _by_one_engine(ring: Ring, node: int, positive: frozenset[Expr], engines: Engines) -> tuple[bool | None, Verdict]:
    """Return what one engine alone decides: a ball proves only that a value is not zero."""
    if "balls" in engines:
        if excludes_zero(ring, node, positive):
            return False, "proved"
        return (True, "numeric") if _has_value(ring, node, positive) else (None, "undecided")
    zero = _zero_at_points(ring, node)
    if zero:
        return True, "probable"
    return (False, "probable") if zero is False and independent_generators(ring) else (None, "undecided")


def certainly_nonzero(e: Expr, positive: frozenset[Expr]) -> bool:
    """Return whether a ball at some real point excludes 0 as the value of an expression."""
    ring = Ring([e], positive)
    return excludes_zero(ring, ring.node(e), positive)


def excludes_zero(ring: Ring, node: int, positive: frozenset[Expr]) -> bool:
    """Return whether a ball at some real point excludes 0 as the value of a node."""
    return any(not ball.contains(0) for ball in _balls(ring, node, positive))


def _zero_at_points(ring: Ring, node: int, points: int = 3) -> bool | None:
    """Return whether the node is zero at so many random points over GF(p), or None where too few were found."""
    seen = 0
    for seed in range(TRIES):
        try:
            if values(ring, field_point([ring], seed))[node] != 0:
                return False
        except NoValueError:
            continue
        seen += 1
        if seen == points:
            return True
    return None


#: Entries of a matrix that tells whether arguments are independent.
MOST_TERMS = 20_000
INVERSE = ("asin", "atan", "atan2")


def odd_constants(ring: Ring, named: bool = False) -> bool:
    """Return whether constants occur that may be related: nested roots, inverse functions, logarithms, e and pi.

    ``named``: parameters are constants too, and several roots of them may be related, or one of a square.
    """
    constant = [v for v in ring.vars if all(named and s.args[0] == "parameter" for s in ring.var_expr[v.index].symbols)]
    radicands = [ring.var_expr[v.index].args[0] for v in constant if _root_of_more(v)]
    odd = any(v.kind in (*INVERSE, "log", "sign") for v in constant) or not _one_constant(ring)
    return odd or len(radicands) > 1 or not all(map(_linear_somewhere, radicands))


def independent_generators(ring: Ring) -> bool:
    """Return whether the generators are algebraically independent up to the relations that the ring knows.

    Symbols, sines, cosines and exponentials of different terms are [Ax1971], and so are unknown functions, square
    roots of different primes and one root of what is linear in a symbol, so no power itself, and one transcendental
    constant. False says that a relation may have been missed: other roots, inverse functions, logarithms, constants.
    """
    roots = 0
    for var in ring.vars:
        if var.kind in (*INVERSE, "log", "sign"):
            return False
        if _root_of_more(var):
            roots += 1
            if not _linear_somewhere(ring.var_expr[var.index].args[0]):
                return False
    independent = all(_independent_arguments(ring, kind) for kind in ("cos", "exp"))
    return roots < 2 and not ring.related and independent and _one_constant(ring)


def _one_constant(ring: Ring) -> bool:
    """Return whether there is at most one transcendental constant: pi, exp or an angle of one rational number.

    These are transcendental [Lindemann1882]; of two of them it is not known, or they are related as e and e^1000 are.
    """
    constants = [v for v in ring.vars if not ring.var_expr[v.index].symbols]
    kinds = {
        ("pi", ex.PI) if v.kind == "pi" else (v.kind.replace("sin", "cos"), v.key[0])
        for v in constants
        if v.kind in ("pi", "cos", "sin", "exp")
    }
    return len(kinds) < 2 and all(kind == "pi" or _is_rational(e) for kind, e in kinds)


def _is_rational(e: Expr) -> bool:
    """Return a product of numbers that are not 0, as written."""
    return all(part.op == "num" and not part.is_zero for part in (e.args if e.op == "mul" else (e,)))


def independent_on_set(ring: Ring, relations: Sequence[object]) -> bool:
    """Return the same where some relations hold.

    There arguments may be related that are not related as written: of few of them a point tells (`characters`); of
    more only what is equal, or a sum, so that no other argument may occur than a symbol.
    """
    return independent_generators(ring) and not (
        relations and any(_out_of_reach(ring, kind) for kind in ("cos", "exp"))
    )


def _out_of_reach(ring: Ring, kind: str) -> bool:
    moving = [v for v in ring.vars if v.kind == kind and ring.var_expr[v.index].symbols]
    return len(moving) > MOST_REDUCED and not all(_of_symbol(v) for v in moving)


def _of_symbol(var: Var) -> bool:
    return isinstance(var.key[0], Expr) and var.key[0].op == "sym"


@false_without_value
def _independent_arguments(ring: Ring, kind: str) -> bool:
    """Return whether the exponents, or the angles, are linearly independent over Q modulo constants [Ax1971].

    They are put over one denominator L: then so are their numerators together with L. False where they grow too large.
    """
    moving = [v for v in ring.vars if v.kind == kind and ring.var_expr[v.index].symbols]
    if len(moving) < 2 or all(_of_symbol(v) for v in moving):
        return True
    canon = Canon(ring)
    pairs = [canon.quotient(v.args[0]) for v in moving]
    below = canon.unit
    for _, bottom in pairs:
        below = below * divided(bottom, below.gcd(bottom))
    rows = [below, *(top * divided(below, bottom) for top, bottom in pairs)]
    terms = sorted({m for row in rows for m in row.to_dict()})
    if len(rows) * len(terms) > MOST_TERMS:
        return False
    matrix = fmpq_mat([[row.to_dict().get(m, 0) for m in terms] for row in rows])
    return bool(matrix.rref()[1] == len(rows))


def _root_of_more(var: Var) -> bool:
    """Return a root of something else than a prime number."""
    return var.kind == "root" and not isinstance(var.key[0], Expr)


def _linear_somewhere(e: Expr) -> bool:
    """Return whether ``e`` is of degree 1 in one of its symbols."""
    slopes = ((s, diff(e, s)) for s in e.symbols)
    return any(not slope.is_zero and s not in slope.symbols for s, slope in slopes)


# The chance of an error at random points

#: Bits of the primes, less one; of what is looked for among arguments of exponentials and angles (see `characters`).
PRIME, RELATIONS = 60, 30


#: The degrees of a numerator and of a denominator.
Degrees = tuple[int, int]


def degree_bound(ring: Ring, nodes: Sequence[int], degree_of: Callable[[int], int] | None = None) -> int:
    """Return a bound of the degrees of numerators and denominators, in symbols and independent values of functions.

    Sines and cosines are functions on a curve of the second degree, a root is the power of another root, unless
    ``degree_of`` gives the degrees of generators by their numbers.
    """
    most: dict[int, Degrees] = {}
    for i in reversed(reachable(ring, nodes, through_generators=False)):
        op, payload = ring.code[i]
        if op == NUM:
            most[i] = (0, 0)
        elif op == VAR:
            var = ring.vars[payload]
            degree = 2 if var.kind in ("cos", "sin") else max(1, var.degree)
            most[i] = (degree if degree_of is None else degree_of(payload), 0)
        elif op == ADD:
            most[i] = _of_sum([most[j] for j in payload])
        elif op == MUL:
            most[i] = (sum(most[j][0] for j in payload), sum(most[j][1] for j in payload))
        elif op == POW:
            top, bottom = most[payload[0]]
            k = abs(payload[1])
            most[i] = (top * k, bottom * k) if payload[1] > 0 else (bottom * k, top * k)
    return max((max(most[node]) for node in nodes), default=0)


def _of_sum(terms: Sequence[Degrees]) -> Degrees:
    """Over the product of all denominators."""
    below = sum(bottom for _, bottom in terms)
    return max(top + below - bottom for top, bottom in terms), below


def error_bits(ring: Ring, nodes: Sequence[int], size: int) -> int:
    """b with a chance below 2^-b that a minor, not 0, is 0 at a random point over GF(p) [SchwartzZippel].

    Of ``size`` rows of the nodes' derivatives it has at most so many times twice their degree. Where several
    exponentials or angles occur, relations among their arguments are found by chance with 2^-30.
    """
    bits = PRIME - (2 * max(1, size) * max(1, degree_bound(ring, nodes))).bit_length()
    several = sum(var.kind in ("exp", "cos") for var in ring.vars) > 1
    return max(1, min(bits, RELATIONS) if several else bits)
