"""Is an expression identically zero, and are the generators of its ring independent?"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from typing import Literal

from flint import arb, ctx, fmpq_mat, fmpz

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

#: ``field``: arithmetic at random points modulo random primes; a zero is probably right. ``balls``: interval arithmetic
#: at real points; a value that is not zero is a proof.
Engine = Literal["field", "balls"]
Engines = frozenset[Engine]

FIELD: Engines = frozenset(("field",))
BALLS: Engines = frozenset(("balls",))
BOTH: Engines = FIELD | BALLS


#: An expression is taken for 0 only if balls of all these bits contain 0.
PRECISIONS = (256, 1024)
#: Number of random real points for balls, and of attempts at random points over GF(p).
STARTS, TRIES = 8, 60


def is_zero(e: Expr, positive: frozenset[Expr]) -> bool:
    """Return whether the expression is taken for zero identically; `zero_and_verdict` says how certain that is."""
    return bool(zero_and_verdict(e, positive)[0])


def is_proved_zero(e: Expr, positive: frozenset[Expr]) -> bool:
    """Return whether the expression is proved to be zero identically."""
    return zero_and_verdict(e, positive) == (True, "proved")


def zero_and_verdict(e: Expr, positive: frozenset[Expr], engines: Engines = BOTH) -> tuple[bool | None, Verdict]:
    """Return whether the expression is zero identically, and how certain that is.

    None if one engine on its own cannot decide it, or if the expression has no value at any point that was tried.
    Proofs are: the canonical form is 0; the value at a point over GF(p) is not 0 and the generators are independent; a
    ball at a real point excludes 0. An expression that is 0 at random points over GF(p) is probably zero
    [SchwartzZippel]; one whose balls all contain 0 is zero numerically.
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
    """Yield the balls of a node at random real points, for each of the ``precisions`` in bits."""
    bits = fixed_bits()
    for precision in precisions if bits is None else (bits,):
        for seed in range(STARTS):
            with ctx.workprec(precision), suppress(NoValueError):
                yield values(ring, random_ball_point(ring, positive, seed))[node]


def _has_value(ring: Ring, node: int, positive: frozenset[Expr]) -> bool:
    """Return whether the node has a value at one of the random real points."""
    return any(ball.is_finite() for ball in _balls(ring, node, positive, PRECISIONS[:1]))


def _by_one_engine(ring: Ring, node: int, positive: frozenset[Expr], engines: Engines) -> tuple[bool | None, Verdict]:
    """Return the value of `zero_and_verdict` if one engine is used on its own."""
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
    """Return whether the node is zero at ``points`` random points over GF(p); None if it has values at fewer."""
    for seed in range(TRIES):
        try:
            if values(ring, field_point([ring], seed))[node] != 0:
                return False
        except NoValueError:
            continue
        points -= 1
        if not points:
            return True
    return None


#: Bound on the entries of the matrix in `_independent_arguments`.
MOST_TERMS = 20_000
INVERSE = ("asin", "atan", "atan2")


def odd_constants(ring: Ring, named: bool = False) -> bool:
    """Return whether constants occur that may be related: nested roots, inverse functions, logarithms, e and pi.

    With ``named``, parameters are constants too; several roots of them may be related, or one root of a square.
    """
    constant = [v for v in ring.vars if all(named and s.args[0] == "parameter" for s in ring.var_expr[v.index].symbols)]
    radicands = [ring.var_expr[v.index].args[0] for v in constant if _root_of_more(v)]
    odd = any(v.kind in (*INVERSE, "log", "sign") for v in constant) or not _one_constant(ring)
    return odd or len(radicands) > 1 or not all(map(_linear_somewhere, radicands))


def independent_generators(ring: Ring) -> bool:
    """Return whether the generators are algebraically independent up to the relations of the ring; False if unknown.

    Symbols and the sines, cosines and exponentials of independent arguments are independent [Ax1971]; so are, together
    with them, unknown functions, roots of primes, one root of an expression of degree 1 in a symbol (which is
    no power), and one transcendental constant. Other roots, inverse functions and logarithms may be related.
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
    """Return whether there is at most one constant other than a root: pi, or functions of one rational number.

    These are transcendental [Lindemann1882]; two of them may be related (e and e^1000), or it is not known. Roots are
    those of different primes: sqrt(2) is a power of 2^(1/4), and a long number may be no prime.
    """
    radicands = [v.key[0].args[0] for v in ring.vars if v.kind == "root" and not _root_of_more(v)]
    if len({*radicands}) < len(radicands) or not all(fmpz(int(n)).is_probable_prime() for n in radicands):
        return False
    constants = [v for v in ring.vars if not ring.var_expr[v.index].symbols]
    kinds = {
        ("pi", ex.PI) if v.kind == "pi" else (v.kind.replace("sin", "cos"), v.key[0])
        for v in constants
        if v.kind in ("pi", "cos", "sin", "exp")
    }
    return len(kinds) < 2 and all(kind == "pi" or _is_rational(e) for kind, e in kinds)


def _is_rational(e: Expr) -> bool:
    """Return whether ``e`` is written as a product of nonzero numbers."""
    return all(part.op == "num" and not part.is_zero for part in (e.args if e.op == "mul" else (e,)))


def independent_on_set(ring: Ring, relations: Sequence[object]) -> bool:
    """Return `independent_generators` on the set where some relations are satisfied.

    There, arguments may be related that are independent as expressions. A `Character` finds relations of up to
    `MOST_REDUCED` arguments; if there are more, False unless all arguments are symbols.
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
    """Return whether the arguments of one kind (exp, cos) are linearly independent over Q modulo constants [Ax1971].

    That is, L, pi L if pi occurs, and the numerators over a common denominator L are linearly independent. False if
    they are too large, or if a root of a quotient, which is not reduced, hides their relations.
    """
    moving = [v for v in ring.vars if v.kind == kind and ring.var_expr[v.index].symbols]
    if len(moving) < 2 or all(_of_symbol(v) for v in moving):
        return True
    canon = Canon(ring)
    if len(canon.relations) < sum(v.kind in ("sin", "root") for v in ring.vars):
        return False
    pairs = [canon.quotient(v.args[0]) for v in moving]
    below = canon.unit
    for _, bottom in pairs:
        below = below * divided(bottom, below.gcd(bottom))
    constants = [canon.unit, *(canon.gens[v.index] for v in ring.vars if v.kind == "pi")]
    rows = [*(below * c for c in constants), *(top * divided(below, bottom) for top, bottom in pairs)]
    terms = sorted({m for row in rows for m in row.to_dict()})
    if len(rows) * len(terms) > MOST_TERMS:
        return False
    return bool(fmpq_mat([[row.to_dict().get(m, 0) for m in terms] for row in rows]).rank() == len(rows))


def _root_of_more(var: Var) -> bool:
    """Return whether a generator is a root of anything but a number."""
    return var.kind == "root" and not isinstance(var.key[0], Expr)


def _linear_somewhere(e: Expr) -> bool:
    """Return whether ``e`` is of degree 1 in one of its symbols."""
    slopes = ((s, diff(e, s)) for s in e.symbols)
    return any(not slope.is_zero and s not in slope.symbols for s, slope in slopes)


# The probability of an error at random points

#: Bits of the smallest prime, minus one, and one more, because the denominator of a sine may double a degree; bits b of
#: the probability 2^-b that a `Character` finds an accidental relation.
PRIME, RELATIONS = 58, 30


#: The degrees of a numerator and of a denominator.
Degrees = tuple[int, int]


def degree_bound(ring: Ring, nodes: Sequence[int], degree_of: Callable[[int], int] | None = None) -> int:
    """Return a bound on the degrees of the nodes' numerators and denominators in the generators' random numbers.

    Sines and cosines have the degree 2, and d-th roots the degree d, unless ``degree_of`` gives the degree of a
    generator by its index.
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
    """Return the degrees of a sum over the product of all denominators."""
    below = sum(bottom for _, bottom in terms)
    return max(top + below - bottom for top, bottom in terms), below


def error_bits(ring: Ring, nodes: Sequence[int], size: int) -> int:
    """Return b such that a nonzero minor is 0 at a random point over GF(p) with probability < 2^-b [SchwartzZippel].

    The minor has ``size`` rows of the nodes' derivatives, so its degree is at most 2 ``size`` times theirs. With
    several exponentials, angles or pi, accidental relations of their arguments have the probability 2^-`RELATIONS`.
    """
    bits = PRIME - (2 * max(1, size) * max(1, degree_bound(ring, nodes))).bit_length()
    several = sum(var.kind in ("exp", "cos", "pi") for var in ring.vars) > 1
    return max(1, min(bits, RELATIONS) if several else bits)
