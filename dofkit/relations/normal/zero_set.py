"""The real zero set of one expression: powers, products, sums of squares and factors without zeros.

``zero_set`` returns branches (a union) of lists of expressions that vanish together, each regular where it can
be made so: g^2 = 0 becomes g = 0, a sum of squares becomes all of its terms, a factor that never vanishes
is dropped, a product becomes branches. No branch: no real zero.
"""

from __future__ import annotations

from fractions import Fraction
from itertools import product as cartesian
from typing import Any

from flint import fmpq, fmpq_mat

from dofkit.exact.errors import NoValueError
from dofkit.exact.ring.canonical import Canon
from dofkit.exact.ring.program import values
from dofkit.exact.ring.ring import Ring
from dofkit.exact.solving.triangular import TriangularSolver
from dofkit.exact.zero.identity import told_zero
from dofkit.expressions import tree as ex
from dofkit.expressions.tree import Expr
from dofkit.relations.normal.extremes import EXTREME_NOTE, apart

#: More branches than this are not told apart: the expression is then kept as it is.
MAX_BRANCHES = 16

Conjunction = tuple[Expr, ...]
Zeros = tuple[tuple[Conjunction, ...], tuple[str, ...]]

POWER_NOTE = "a power is zero where its base is: the base is used, because the power's gradient vanishes there"
SQUARES_NOTE = "a sum of squares is zero over the reals only where every term is: each term is one equation"
PRODUCT_NOTE = "a product is zero on several branches; each is looked at, and the largest one counts"
EMPTY_NOTE = "no real configuration satisfies it: every term has the same sign and one never vanishes"
POLE_NOTE = "where a denominator vanishes it says nothing: such zeros of the numerator are left out"
FACTOR_NOTE = "a factor that never vanishes was taken out"
EXPONENT_NOTE = "two exponentials are equal over the reals only where their exponents are: those are compared"


class TooManyBranchesError(Exception):
    """The zero set has more than `MAX_BRANCHES` branches."""


class HiddenZeroError(Exception):
    """A constant factor may be 0 by an identity that is not known."""


def zero_set(e: Expr, positive: frozenset[Expr], variables: frozenset[Expr]) -> Zeros:
    """The real zeros of ``e`` in ``variables`` (coordinates, velocities, time), and what was done.

    Symbols outside ``variables`` are generic constants; those of ``positive`` are > 0.
    """
    if _is_linear(e, variables):
        return ((e,),), ()
    try:
        return _Zeros(positive, variables).of(e)
    except (NoValueError, TooManyBranchesError, HiddenZeroError):
        return ((e,),), ()


def _is_linear(e: Expr, variables: frozenset[Expr]) -> bool:
    """A sum of numbers times different symbols, one of them a variable: regular as it is."""
    seen = False
    for term in e.args if e.op == "add" else (e,):
        rest = term.args[-1] if term.op == "mul" and len(term.args) == 2 and term.args[0].op == "num" else term
        if rest.op not in ("sym", "num"):
            return False
        seen = seen or rest in variables
    return seen


class _Zeros:
    def __init__(self, positive: frozenset[Expr], variables: frozenset[Expr]) -> None:
        self.positive = positive
        self.variables = variables

    def of(self, e: Expr) -> Zeros:
        structural = self._structural(e)
        return self._polynomial(e) if structural is None else structural

    # -- as written ---------------------------------------------------------------------------

    def _structural(self, e: Expr) -> Zeros | None:
        if e.op == "num":
            return (((),), ()) if e.is_zero else ((), (EMPTY_NOTE,))
        if e.op == "mul":
            return self._product(e)
        if e.op == "fn" and e.args[0] == "exp":
            return (), (EMPTY_NOTE,)
        if e.op == "fn" and e.args[0] == "abs":
            return self.of(e.args[1])
        if e.op == "pow" and e.args[1].op == "num":
            if e.args[1].args[0] < 0:
                return (), (FACTOR_NOTE,)
            inner = self.of(e.args[0])
            return inner[0], (*inner[1], POWER_NOTE)
        if e.op == "add":
            return self._even_sum(e)
        return None

    def _product(self, e: Expr) -> Zeros | None:
        branches: list[Conjunction] = []
        notes: list[str] = []
        if any(_below(factor) and self._may_vanish(factor.args[0]) for factor in e.args):
            return None
        for factor in e.args:
            if factor.op == "num" or _below(factor):
                continue
            if self.variables.isdisjoint(factor.symbols):
                if self._is_zero(factor):
                    return ((),), ()
                continue
            found, said = self.of(factor)
            notes += [n for n in said if n not in (EMPTY_NOTE, FACTOR_NOTE)] if found else [FACTOR_NOTE]
            branches += [b for b in found if b not in branches]
        return self._union(branches, notes)

    def _is_zero(self, constant: Expr) -> bool:
        """Is a constant 0? Raises HiddenZeroError where neither that nor the contrary is certain."""
        if constant.op == "sym":
            return False
        zero, sure = told_zero(constant, self.positive)
        if zero and sure != "proved":
            raise HiddenZeroError
        return bool(zero)

    def _may_vanish(self, e: Expr) -> bool:
        return not self.variables.isdisjoint(e.symbols) and bool(self.of(e)[0])

    def _union(self, branches: list[Conjunction], notes: list[str]) -> Zeros:
        if len(branches) > MAX_BRANCHES:
            raise TooManyBranchesError
        if len(branches) > 1:
            notes.append(PRODUCT_NOTE)
        return tuple(branches), tuple(dict.fromkeys(notes))

    def _even_sum(self, e: Expr) -> Zeros | None:
        """A sum of even powers with coefficients of one sign, as written."""
        signs = {self._even_sign(term) for term in e.args}
        if len(signs) != 1 or None in signs:
            return None
        return self._together([self.of(term) for term in e.args])

    def _even_sign(self, term: Expr) -> int | None:
        """The sign of a term that cannot change it; None where it can, or where that is unknown."""
        sign = 1
        for factor in term.args if term.op == "mul" else (term,):
            if factor.op == "num":
                sign = sign if factor.args[0] > 0 else -sign
            elif not self._never_negative(factor):
                return None
        return sign

    def _never_negative(self, factor: Expr) -> bool:
        if factor in self.positive or (factor.op == "fn" and factor.args[0] in ("exp", "abs", "cosh")):
            return True
        if factor.op == "const":
            return True
        if factor.op == "pow" and factor.args[1].op == "num":
            exponent: Fraction = factor.args[1].args[0]
            even = exponent.denominator == 1 and exponent % 2 == 0
            return even or exponent.denominator % 2 == 0 or factor.args[0] in self.positive
        return False

    def _together(self, parts: list[Zeros]) -> Zeros:
        notes = [SQUARES_NOTE]
        for branches, _ in parts:
            if not branches:
                return (), (EMPTY_NOTE,)
        combined: list[Conjunction] = []
        for choice in cartesian(*(branches for branches, _ in parts)):
            together = tuple(dict.fromkeys(g for conjunction in choice for g in conjunction))
            if together not in combined:
                combined.append(together)
            if len(combined) > MAX_BRANCHES:
                raise TooManyBranchesError
        return tuple(combined), tuple(notes)

    # -- as a polynomial in the generators ------------------------------------------------------

    def _polynomial(self, e: Expr) -> Zeros:
        ring = Ring([e], self.positive)
        node = ring.node(e)
        canon = Canon(ring)
        numerator, bottom = canon.quotient(node)
        if numerator == 0:
            return ((),), ()
        signs = Signs(canon, self.positive)
        branches: list[Conjunction] = []
        notes: list[str] = []
        factors = canon.factors(numerator)
        kept = [(f, k) for f, k in factors if self._depends(canon, f)]
        if any(self._is_zero(canon.to_expr(f)) for f, _ in factors if not self._depends(canon, f)):
            return ((),), ()
        defined = [(f, k) for f, k in kept if not self._undefined(canon, f, bottom)]
        if len(defined) < len(kept):
            kept, notes = defined, [POLE_NOTE]
        extremes, rest = apart(canon, kept, self.variables)
        if extremes:
            branches, notes = extremes, [*notes, EXTREME_NOTE]
        for factor, multiplicity in rest:
            if multiplicity > 1:
                notes.append(POWER_NOTE)
            alone = len(kept) == 1 and multiplicity == 1 and len(factors) == 1
            found, said = self._factor(canon, signs, factor, e if alone else None)
            notes += said if found or len(kept) == 1 else [FACTOR_NOTE]
            branches += [b for b in found if b not in branches]
        if not kept:
            return (), (EMPTY_NOTE,)
        return self._union(branches, notes)

    def _undefined(self, canon: Canon, factor: Any, bottom: Any) -> bool:
        """Does a denominator vanish wherever the factor does?"""
        if bottom.is_constant():
            return False
        if not factor.gcd(bottom).is_constant():
            return True
        if all(canon.ring.vars[i].kind == "symbol" for i in canon.generators_in(factor)):
            return False
        zero, pole = canon.to_expr(factor), canon.to_expr(bottom)
        ring = Ring([zero, pole], self.positive)
        nodes = ring.node(zero), ring.node(pole)
        point = TriangularSolver(ring, nodes[:1]).draw(1)
        try:
            return point is not None and bool(values(ring, point)[nodes[1]] == 0)
        except NoValueError:
            return False

    def _depends(self, canon: Canon, factor: Any) -> bool:
        shown = (canon.ring.var_expr[i] for i in canon.generators_in(factor))
        return any(not self.variables.isdisjoint(s.symbols) for s in shown)

    def _factor(
        self, canon: Canon, signs: Signs, factor: Any, written: Expr | None
    ) -> tuple[list[Conjunction], list[str]]:
        exponent = self._exponent(canon, factor)
        if exponent is not None:
            found, said = self.of(exponent)
            return list(found), [EXPONENT_NOTE, *said]
        even = sum_of_even(factor, signs)
        if even is not None:
            if any(not zeros for zeros in even):
                return [], [EMPTY_NOTE]
            if len(even) > 1 or written is None:
                return self._monomials(canon, even)
        split = self._semidefinite(canon, signs, factor)
        if split is not None:
            if not split:
                return [], [EMPTY_NOTE]
            return [tuple(split)], [SQUARES_NOTE]
        return [(written if written is not None else canon.to_expr(factor),)], []

    def _exponent(self, canon: Canon, factor: Any) -> Expr | None:
        """u - v - log(c) of exp(u) - c exp(v), c > 0; None of anything else, and where velocities occur."""
        terms = list(factor.to_dict().items())
        present = canon.generators_in(factor)
        if len(terms) != 2 or any(canon.ring.vars[i].kind != "exp" for i in present):
            return None
        (first, a), (second, b) = terms
        shown = {i: canon.ring.var_expr[i] for i in present}
        moving = any(s.args[0] == "velocity" for e in shown.values() for s in e.symbols)
        if a * b > 0 or moving or any(e.op != "fn" for e in shown.values()):
            return None
        last = len(first) - 1
        powers = {i: int(first[last - i]) - int(second[last - i]) for i in present}
        scale = ex.fn("log", ex.num(_fraction(fmpq(-a) / fmpq(b))))
        return ex.add(scale, *(ex.mul(ex.num(k), shown[i].args[1]) for i, k in powers.items()))

    def _monomials(self, canon: Canon, even: list[list[int]]) -> tuple[list[Conjunction], list[str]]:
        """Every monomial vanishes: of each, one generator does."""
        options = [[self._generator_zero(canon, i) for i in self._varying(canon, zeros)] for zeros in even]
        found: list[Conjunction] = []
        for choice in cartesian(*options):
            together = tuple(dict.fromkeys(choice))
            if together not in found:
                found.append(together)
            if len(found) > MAX_BRANCHES:
                raise TooManyBranchesError
        return found, [SQUARES_NOTE] if len(even) > 1 else []

    def _varying(self, canon: Canon, zeros: list[int]) -> list[int]:
        """The generators that depend on the variables; generic constants do not vanish."""
        shown = canon.ring.var_expr
        return [i for i in zeros if not self.variables.isdisjoint(shown[i].symbols)] or zeros

    def _generator_zero(self, canon: Canon, index: int) -> Expr:
        var = canon.ring.vars[index]
        shown = canon.ring.var_expr[index]
        return shown.args[0] if var.kind == "root" else shown

    def _semidefinite(self, canon: Canon, signs: Signs, factor: Any) -> list[Expr] | None:
        """A semidefinite quadratic polynomial with rational coefficients as the linear forms that vanish with it.

        An empty list: it is definite, with no zero. None: indefinite, or no such polynomial.
        """
        if factor.total_degree() != 2:
            return None
        present = canon.generators_in(factor)
        if any(canon.ring.vars[i].kind not in ("symbol", "exp") for i in present):
            return None
        place = {index: i for i, index in enumerate(present)}
        form, one = _quadratic_form(canon, factor, place), len(present)
        rows = _semidefinite_rows(form)
        if rows is None:
            return None
        shown = [canon.ring.var_expr[i] for i in present] + [ex.ONE]
        reduced, rank = fmpq_mat(rows).rref() if rows else (fmpq_mat(0, one + 1), 0)
        linear = []
        for r in range(rank):
            entries = [reduced[r, c] for c in range(one + 1)]
            told = [i for i, v in zip(present, entries[:one], strict=True) if v != 0]
            if not told or (len(told) == 1 and told[0] in signs.positive and entries[one] == 0):
                return []
            linear.append(ex.add(*(ex.mul(ex.num(_fraction(v)), s) for v, s in zip(entries, shown, strict=True))))
        return linear


def _below(factor: Expr) -> bool:
    """A factor that stands below the line."""
    return factor.op == "pow" and factor.args[1].op == "num" and bool(factor.args[1].args[0] < 0)


class Signs:
    """What is known of the signs of a ring's generators."""

    def __init__(self, canon: Canon, positive: frozenset[Expr]) -> None:
        self.positive = {
            var.index
            for var in canon.ring.vars
            if var.kind in ("exp", "pi")
            or (var.kind == "symbol" and var.key in positive)
            or (var.kind == "root" and isinstance(var.key[0], Expr))
        }
        self.nonnegative = {v.index for v in canon.ring.vars if v.kind == "root" and v.degree % 2 == 0}
        self.circular = {v.index for v in canon.ring.vars if v.kind in ("cos", "sin")}
        self.n = len(canon.ring.vars)

    def bounded_away(self, poly: Any) -> bool:
        """True for a polynomial in sines and cosines whose constant outweighs the rest."""
        constant = rest = Fraction(0)
        for exponents, coefficient in poly.to_dict().items():
            present = {self.n - 1 - i for i, k in enumerate(exponents) if k}
            if not present <= self.circular:
                return False
            if present:
                rest += abs(_fraction(coefficient))
            else:
                constant += abs(_fraction(coefficient))
        return constant > rest

    def monomial(self, exponents: tuple[int, ...]) -> tuple[bool, list[int]]:
        """(is it >= 0 everywhere, the generators of which one must vanish where it is 0)."""
        zeros = []
        for place, exponent in enumerate(exponents):
            index = self.n - 1 - place
            if not exponent or index in self.positive:
                continue
            if exponent % 2 and index not in self.nonnegative:
                return False, []
            zeros.append(index)
        return True, zeros


def sum_of_even(poly: Any, signs: Signs) -> list[list[int]] | None:
    """For a polynomial all of whose terms are >= 0 (or all <= 0): per term, the generators that may vanish.

    The zero set is then that of every term. An empty list among them: the polynomial never vanishes.
    None: some term changes sign.
    """
    if signs.bounded_away(poly):
        return [[]]
    found, overall = [], 0
    for exponents, coefficient in poly.to_dict().items():
        even, zeros = signs.monomial(tuple(int(k) for k in exponents))
        sign = 1 if coefficient > 0 else -1
        if not even or (overall and sign != overall):
            return None
        overall = sign
        found.append(zeros)
    return found


def never_vanishes(e: Expr, positive: frozenset[Expr]) -> bool:
    """True where ``e`` is proved to be zero at no real point; False says nothing."""
    branches, _ = zero_set(e, positive, e.symbols)
    return not branches


def never_holds(e: Expr, strict: bool, positive: frozenset[Expr]) -> bool:
    """True where ``e >= 0`` (or > 0) is proved to hold nowhere: -e is a sum of terms that are >= 0, one of them > 0."""
    try:
        ring = Ring([e], positive)
        node = ring.node(e)
        canon = Canon(ring)
        top, bottom = canon.quotient(node)
    except NoValueError:
        return False
    if top == 0:
        return strict
    if not bottom.is_constant():
        return False
    if bottom.leading_coefficient() < 0:
        top = -top
    even = sum_of_even(top, Signs(canon, positive))
    if even is None or _some_positive(top):
        return False
    return strict or any(not zeros for zeros in even)


def _some_positive(poly: Any) -> bool:
    """With terms of one sign: is that sign +?"""
    return any(c > 0 for c in poly.to_dict().values())


def _quadratic_form(canon: Canon, factor: Any, place: dict[int, int]) -> list[list[Fraction]]:
    """The symmetric matrix of the homogenised quadratic polynomial; the last row and column are for 1."""
    n, total = len(place), len(canon.ring.vars)
    form = [[Fraction(0)] * (n + 1) for _ in range(n + 1)]
    for exponents, coefficient in factor.to_dict().items():
        slots = [place[total - 1 - i] for i, k in enumerate(exponents) for _ in range(int(k))]
        a, b = [*slots, n, n][:2]
        value = _fraction(coefficient)
        if a == b:
            form[a][a] += value
        else:
            form[a][b] += value / 2
            form[b][a] += value / 2
    return form


def _fraction(value: fmpq) -> Fraction:
    return Fraction(int(value.p), int(value.q))


def _semidefinite_rows(form: list[list[Fraction]]) -> list[list[fmpq]] | None:
    """Rows that span a semidefinite form's range (Lagrange's reduction [Sylvester1852]); None for an indefinite one."""
    n = len(form)
    work = [row[:] for row in form]
    rows, sign = [], 0
    for i in range(n):
        pivot = work[i][i]
        if pivot == 0:
            if any(work[i]):
                return None
            continue
        if sign and (pivot > 0) != (sign > 0):
            return None
        sign = 1 if pivot > 0 else -1
        row = work[i][:]
        rows.append([fmpq(v.numerator, v.denominator) for v in row])
        for j in range(n):
            for k in range(n):
                work[j][k] -= row[j] * row[k] / pivot
    return rows
