"""The canonical ring: a program's values as quotients of polynomials in its generators.

Polynomials are reduced modulo cos^2 + sin^2 = 1, root^d = radicand and sign^2 = 1; one that reduces to 0 is proved to
be 0 identically. Polynomials of more than `MAX_TERMS` terms raise `TooLargeError`.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from fractions import Fraction
from functools import cached_property
from typing import Any

from flint import Ordering, fmpq, fmpq_mpoly_ctx
from flint.utils.flint_exceptions import DomainError

from dofkit.base.deadline import check
from dofkit.base.errors import NoValueError, PoleError
from dofkit.exact.ring.program import ADD, MUL, NUM, POW, TooLargeError, raising_no_value, reachable
from dofkit.exact.ring.ring import Ring
from dofkit.expressions import tree as ex
from dofkit.expressions.tree import Expr

MAX_TERMS = 3000
MAX_POWER = 80
#: Polynomials are factored up to this product of the number of terms and the total degree,
FACTORED = 4000
#: and up to this product of the two highest degrees: x^30 + y^24 - x^15 y^12 = 1 takes minutes.
FACTORED_DEGREES = 400

Poly = Any
Quotient = tuple[Poly, Poly]
#: (generator index, exponent) of each factor.
Monomial = tuple[tuple[int, int], ...]


class Canon:
    """Canonical forms of the nodes of one ring."""

    def __init__(self, ring: Ring) -> None:
        self.ring = ring
        names = [f"v{i}" for i in reversed(range(len(ring.vars)))]
        self.ctx = fmpq_mpoly_ctx.get(tuple(names) or ("v",), Ordering.lex)
        gens = self.ctx.gens()
        self.gens: list[Poly] = list(reversed(gens)) if names else []
        self.unit = self.ctx.constant(1)
        self._memo: dict[int, Quotient] = {}
        self._relations: list[Poly] | None = None

    @raising_no_value
    def quotient(self, node: int) -> Quotient:
        """Return (numerator, denominator) of a node, both reduced."""
        for i in reversed(reachable(self.ring, [node], through_generators=False)):
            if i not in self._memo:
                self._memo[i] = self._compute(i)
        return self._memo[node]

    def _compute(self, node: int) -> Quotient:
        """Return the quotient of a node from those of its operands."""
        op, payload = self.ring.code[node]
        if op == NUM:
            return self.ctx.constant(fmpq(payload.numerator, payload.denominator)), self.unit
        if op == ADD:
            total = self._memo[payload[0]]
            for i in payload[1:]:
                total = self._sum(total, self._memo[i])
            return total
        if op == MUL:
            total = self._memo[payload[0]]
            for i in payload[1:]:
                other = self._memo[i]
                total = (self._times(total[0], other[0]), self._times(total[1], other[1]))
            return total
        if op == POW:
            return self._power(*payload)
        return self.gens[payload], self.unit

    def _sum(self, a: Quotient, b: Quotient) -> Quotient:
        if a[1] == b[1]:
            return a[0] + b[0], a[1]
        return self._times(a[0], b[1]) + self._times(b[0], a[1]), self._times(a[1], b[1])

    def _times(self, a: Poly, b: Poly) -> Poly:
        if len(a) * len(b) > 4 * MAX_TERMS:
            raise TooLargeError
        return self.reduce(a * b)

    def _power(self, base: int, exponent: int) -> Quotient:
        top, bottom = self._memo[base]
        if exponent < 0:
            if top == 0:
                raise PoleError
            top, bottom, exponent = bottom, top, -exponent
        if exponent > MAX_POWER:
            raise TooLargeError
        power = (self.unit, self.unit)
        for _ in range(exponent):
            power = (self._times(power[0], top), self._times(power[1], bottom))
        return power

    def reduce(self, poly: Poly) -> Poly:
        """Return the polynomial reduced modulo the generators' algebraic relations."""
        check()
        degrees = poly.degrees()
        for place, degree, relation in self._divisors:
            if len(poly) > MAX_TERMS:
                raise TooLargeError
            if degrees[place] >= degree:
                _, poly = divmod(poly, relation)
                degrees = poly.degrees()
        return poly

    @cached_property
    def _divisors(self) -> list[tuple[int, int, Poly]]:
        """The relations, as (position of the leading generator, its degree, relation)."""
        divisors = []
        for relation in self.relations:
            leading = relation.monomial(0)
            place = next(i for i, k in enumerate(leading) if k)
            divisors.append((place, int(leading[place]), relation))
        return divisors

    @property
    @raising_no_value
    def relations(self) -> list[Poly]:
        """cos^2 + sin^2 - 1, root^d - radicand, sign^2 - 1; those of later generators first."""
        if self._relations is None:
            self._relations = []
            relations = []
            for var in reversed(self.ring.vars):
                g = self.gens[var.index]
                if var.kind == "sin":
                    relations.append(g**2 + self.gens[var.partner] ** 2 - 1)
                elif var.kind == "sign":
                    relations.append(g**2 - 1)
                elif var.kind == "root":
                    top, bottom = self.quotient(var.args[0])
                    if not bottom.is_constant():
                        continue
                    relations.append(g**var.degree - top / bottom.leading_coefficient())
            self._relations = relations
        return self._relations

    def is_zero(self, node: int) -> bool:
        """Return whether the node is proved to be identically zero; False if its canonical form is not 0."""
        return bool(self.quotient(node)[0] == 0)

    def to_expr(self, poly: Poly) -> Expr:
        """Return a polynomial in the generators as an expression, the sign of u times a multiple of u by abs(u)."""
        for var in self.ring.vars:
            sign = self.ring.var_expr[var.index]
            if var.kind == "sign" and sign.op == "mul" and poly.degrees()[-1 - var.index] == 1:
                coefficients = self.collected(poly, {var.index})
                top, bottom = self.quotient(var.args[0])
                multiple, remainder = divmod(coefficients.pop(((var.index, 1),)), top)
                if remainder == 0:
                    others = self.to_expr(coefficients.get((), self.unit * 0))
                    return ex.add(self.to_expr(multiple * bottom) * sign.args[0], others)
        generators = [self.ring.var_expr[var.index] for var in reversed(self.ring.vars)]
        terms = []
        for exponents, coefficient in poly.to_dict().items():
            factors = [ex.power(generators[i], ex.num(int(k))) for i, k in enumerate(exponents) if k]
            number = Fraction(int(coefficient.p), int(coefficient.q))
            terms.append(ex.mul(ex.num(number), *factors))
        return ex.add(*terms) if terms else ex.ZERO

    def regular_expr(self, poly: Poly, multiple: Poly) -> Expr:
        """Return `to_expr`; raises NoValueError if it has a pole abs(u)/u, and ``multiple`` has no factor u."""
        e = self.to_expr(poly)
        signs = [v for v in self.ring.vars if v.kind == "sign" and self.ring.var_expr[v.index].args[-1] in ex.nodes(e)]
        if any(divmod(multiple, self.quotient(v.args[0])[0])[1] != 0 for v in signs):
            raise NoValueError("the sign of an expression that may be 0")
        return e

    @raising_no_value
    def factors(self, poly: Poly) -> list[tuple[Poly, int]]:
        """Return (irreducible factor over the rationals, multiplicity) pairs, without constant factors.

        Raises TooLargeError if the polynomial exceeds `FACTORED` or `FACTORED_DEGREES`.
        """
        if len(poly) * max(1, int(poly.total_degree())) > FACTORED or not soon_factored(poly):
            raise TooLargeError
        return [(f, int(k)) for f, k in poly.factor()[1] if not f.is_constant()]

    def collected(self, poly: Poly, moving: Collection[int]) -> dict[Monomial, Poly]:
        """Return a polynomial as {monomial in the ``moving`` generators: coefficient, a polynomial in the others}."""
        last = len(self.ring.vars) - 1
        groups: dict[Monomial, dict[tuple[int, ...], Any]] = {}
        for exponents, coefficient in poly.to_dict().items():
            powers = {last - i: int(k) for i, k in enumerate(exponents) if k}
            monomial = tuple((i, k) for i, k in powers.items() if i in moving)
            others = tuple(0 if last - i in moving else int(k) for i, k in enumerate(exponents))
            groups.setdefault(monomial, {})[others] = coefficient
        return {monomial: self.ctx.from_dict(part) for monomial, part in groups.items()}

    def generators_in(self, poly: Poly) -> list[int]:
        """Return the indices of the generators that occur."""
        n = len(self.ring.vars)
        return [n - 1 - i for i, k in enumerate(poly.degrees()) if k > 0] if n else []  # the degrees of 0 are -1


def quotients_of(expressions: Sequence[Expr], positive: frozenset[Expr]) -> tuple[Canon, list[Quotient]]:
    """Return a new canonical ring and the expressions as quotients in it; raises NoValueError."""
    ring = Ring(expressions, positive)
    nodes = [ring.node(e) for e in expressions]
    canon = Canon(ring)
    return canon, [canon.quotient(node) for node in nodes]


def square_root(e: Expr, positive: frozenset[Expr]) -> Expr | None:
    """Return f with ``e`` = f^2, a polynomial in the generators of a ring of ``e``; None if none is found."""
    try:
        canon, [(top, bottom)] = quotients_of([e], positive)
        return canon.to_expr((top / bottom).sqrt()) if bottom.is_constant() else None
    except (NoValueError, DomainError):
        return None


def soon_factored(poly: Poly) -> bool:
    """Return whether the degrees are low enough for FLINT's factorisation, which cannot be interrupted."""
    *_, second, first = 0, 0, *sorted(int(k) for k in poly.degrees())
    return first * second <= FACTORED_DEGREES


@raising_no_value
def divided(top: Any, bottom: Any) -> Any:
    """Return top / bottom for polynomials or numbers; raises NoValueError if the division is not exact."""
    return top / bottom


@raising_no_value
def remainder(poly: Poly, divisor: Poly) -> Poly:
    """Return the remainder of a division; raises PoleError if the divisor is 0."""
    return divmod(poly, divisor)[1]


@raising_no_value
def lowest_terms(top: Poly, bottom: Poly) -> Quotient:
    """Return (top, bottom) divided by their greatest common divisor; raises PoleError for 0/0."""
    common = top.gcd(bottom)
    return top / common, bottom / common


def is_identically_zero(expression: Expr, positive: frozenset[Expr] = frozenset()) -> bool | None:
    """Return whether the canonical form is 0 (True is a proof); None if it is too large. Raises PoleError."""
    ring = Ring([expression], positive)
    try:
        node = ring.node(expression)
        return Canon(ring).is_zero(node)
    except PoleError:
        raise
    except NoValueError:
        return None


@raising_no_value
def cleared(canon: Canon, row: Sequence[Quotient]) -> tuple[list[Poly], Poly]:
    """Return (a row's entries times their common denominator, as polynomials; that denominator)."""
    common = canon.unit
    for _, bottom in row:
        common = common * (bottom / bottom.gcd(common))
    return [canon.reduce(top * (common / bottom)) for top, bottom in row], common


def polynomials(canon: Canon, row: Mapping[int, int], n: int) -> list[Poly]:
    """Return the n entries of a sparse row, {column: node}, times their common denominator, as polynomials."""
    zero = (canon.unit * 0, canon.unit)
    return cleared(canon, [canon.quotient(row[c]) if c in row else zero for c in range(n)])[0]


def determinant(canon: Canon, matrix: Sequence[Sequence[Poly]]) -> Poly:
    """Return the determinant in the canonical ring, expanded along the first row."""
    if len(matrix) == 1:
        return matrix[0][0]
    total = canon.unit * 0
    for c, entry in enumerate(matrix[0]):
        if entry != 0:
            below = determinant(canon, [[*row[:c], *row[c + 1 :]] for row in matrix[1:]])
            term = canon.reduce(entry * below)
            total = total + term if c % 2 == 0 else total - term
    return canon.reduce(total)
