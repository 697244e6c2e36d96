"""Common real zeros of polynomials in the canonical ring, as conditions that a person can read.

The polynomials are split into factors, a factor into squares that vanish together, and what is linear is solved and
put into the rest (triangular decomposition). A `Leaf` is one conjunction of conditions; the leaves' union is the
zero set. What never vanishes for the values that the scene allows has no leaf.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import product as cartesian

from dofkit.base.deadline import check
from dofkit.exact.ring.canonical import Canon, Poly
from dofkit.exact.ring.program import TooLargeError
from dofkit.expressions import tree as ex
from dofkit.expressions.text import to_text
from dofkit.expressions.tree import Expr
from dofkit.relations.normal.semidefinite import Signs, sum_of_even
from dofkit.relations.normal.zero_set import zero_set
from dofkit.system import System

#: Polynomials with more terms, or of a higher degree, are not factored.
MAX_TERMS, MAX_DEGREE = 48, 12
#: Sums of even powers are looked for in polynomials of so many terms.
MAX_EVEN = 12
#: Conditions that a person can read have so many terms.
MAX_READ = 4
#: With a longer polynomial among them, no common zeros are looked for.
MAX_LONG = 160
#: Conditions that are followed before the search is given up, and leaves that are kept.
MAX_STEPS, MAX_LEAVES = 120, 12


@dataclass(frozen=True)
class Leaf:
    """Conditions that hold together: ``solved`` generators with their values, and ``others`` that vanish."""

    solved: tuple[tuple[int, Poly], ...] = ()
    others: tuple[Poly, ...] = ()

    def conditions(self, canon: Canon) -> list[Poly]:
        """Polynomials that vanish on the leaf."""
        return [canon.gens[i] - value for i, value in self.solved] + list(self.others)


class Reals:
    """What a canonical ring's generators may be: real, positive or nonzero as declared."""

    def __init__(self, canon: Canon, positive: frozenset[Expr], nonzero: frozenset[Expr]) -> None:
        self.canon, self.positive = canon, positive
        self.signs = Signs(canon, positive)
        ring = canon.ring
        self.never = self.signs.positive | {v.index for v in ring.vars if v.kind == "symbol" and v.key in nonzero}
        self.free = {v.index for v in ring.vars if v.kind == "symbol"} - self.never
        symbols = [e.symbols for e in ring.var_expr]
        self.moving = {i for i, s in enumerate(symbols) if any(x.args[0] in ("coordinate", "time") for x in s)}
        self.moving |= {v.index for v in ring.vars if v.kind == "call"}
        self.inside = frozenset().union(
            *(s for v, s in zip(ring.vars, symbols, strict=True) if v.kind != "symbol"), frozenset[Expr]()
        )

    def never_zero(self, poly: Poly) -> bool:
        """True where the polynomial is proved to vanish nowhere."""
        if poly.is_constant():
            return bool(poly != 0)
        present = self.canon.generators_in(poly)
        if len(poly) == 1:
            return self.never.issuperset(present)
        if poly.total_degree() == 1 and not self.free.isdisjoint(present):
            return False
        even = sum_of_even(poly, self.signs) if len(poly) <= MAX_EVEN else None
        return even is not None and any(not zeros for zeros in even)

    def of_parameters(self, poly: Poly) -> bool:
        """Return whether neither coordinates nor time occur."""
        return self.moving.isdisjoint(self.canon.generators_in(poly))

    def factors(self, poly: Poly) -> list[Poly]:
        """Irreducible factors that may vanish; (cos u - 1) (cos u + 1) is told as sin u.

        Raises TooLargeError.
        """
        if len(poly) > MAX_TERMS or poly.total_degree() > MAX_DEGREE:
            raise TooLargeError
        if len(poly) == 1:
            return [self.canon.gens[i] for i in self.canon.generators_in(poly) if i not in self.never]
        if poly.total_degree() == 1:
            return [] if self.never_zero(poly) else [poly]
        result = [f for f, _ in poly.factor()[1] if not self.never_zero(f)]
        for var in self.canon.ring.vars:
            if var.kind in ("cos", "sin"):
                ends = [self.canon.gens[var.index] - 1, self.canon.gens[var.index] + 1]
                if all(end in result for end in ends):
                    result = [f for f in result if f not in ends] + [self.canon.gens[var.partner]]
        return result

    def put(self, poly: Poly, values: Sequence[tuple[int, Poly]]) -> Poly:
        """A polynomial with generators replaced by their values."""
        present = set(self.canon.generators_in(poly))
        if present.isdisjoint(i for i, _ in values):
            return poly
        replaced = dict(values)
        gens = [replaced.get(i, g) for i, g in enumerate(self.canon.gens)]
        return self.canon.reduce(poly.compose(*reversed(gens), ctx=self.canon.ctx))

    def on(self, leaf: Leaf, poly: Poly) -> Poly:
        """A polynomial on a leaf, as far as that is solved."""
        for index, value in leaf.solved:
            poly = self.under(poly, index, value)
        return poly

    def vanishes_on(self, leaf: Leaf, poly: Poly) -> bool:
        """Return whether a polynomial is shown to vanish wherever the conditions of a leaf hold."""
        remaining = self.on(leaf, poly)
        return remaining == 0 or any(divmod(remaining, condition)[1] == 0 for condition in leaf.others)

    def largest(self, leaves: Sequence[Leaf]) -> list[Leaf]:
        """Return the leaves that lie in no other one; of equal leaves the first."""
        kept: list[Leaf] = []
        for leaf in leaves:
            if not any(self._within(leaf, other) for other in kept):
                kept = [*(other for other in kept if not self._within(other, leaf)), leaf]
        return kept

    def _within(self, leaf: Leaf, larger: Leaf) -> bool:
        return all(self.vanishes_on(leaf, c) for c in larger.conditions(self.canon))

    def under(self, poly: Poly, index: int, value: Poly) -> Poly:
        """A polynomial where a generator has a value, with what follows for its sine or cosine."""
        poly = self.put(poly, [(index, value), *(self.implied(index, value) or ())])
        var = self.canon.ring.vars[index]
        if var.kind in ("cos", "sin") and value == 0:
            poly = divmod(poly, self.canon.gens[var.partner] ** 2 - 1)[1]
        return poly

    def implied(self, index: int, value: Poly) -> list[tuple[int, Poly]] | None:
        """Values of other generators that follow from that of one; None where they cannot be told."""
        ring, zero = self.canon.ring, self.canon.unit * 0
        var = ring.vars[index]
        if var.kind in ("cos", "sin"):
            return [(var.partner, zero)] if value**2 == 1 else []
        if var.key not in self.inside:
            return []
        result = []
        for other in ring.vars:
            if other.kind != "symbol" and var.key in ring.var_expr[other.index].symbols:
                if value != 0 or other.kind not in ("cos", "sin") or other.key[0] != var.key:
                    return None
                result.append((other.index, self.canon.unit if other.kind == "cos" else zero))
        return result

    # -- one condition ------------------------------------------------------------------------

    def splits(self, factor: Poly) -> list[list[Poly]]:
        """The branches of an irreducible factor's real zeros: what vanishes together on each."""
        even = sum_of_even(factor, self.signs)
        if even is not None and (len(even) > 1 or len(factor) == 1):
            options = [[i for i in zeros if i not in self.never] for zeros in even]
            return [[self.canon.gens[i] for i in sorted(set(choice))] for choice in cartesian(*options)]
        if len(factor) > 2 and factor.total_degree() == 2 and not self._is_graph(factor):
            e = self.canon.to_expr(factor)
            branches, _ = zero_set(e, self.positive, e.symbols)
            if branches != ((e,),):
                ring = self.canon.ring
                nodes = [[ring.node(g) for g in branch] for branch in branches]
                if len(ring.vars) > len(self.canon.gens):
                    raise TooLargeError
                return [[self.canon.quotient(node)[0] for node in branch] for branch in nodes]
        return [[factor]]

    def _is_graph(self, factor: Poly) -> bool:
        """Return whether an irreducible factor is linear in a real generator, so that its zeros are a graph."""
        return any(k == 1 and len(self.canon.gens) - 1 - i in self.free for i, k in enumerate(factor.degrees()))

    def solved(self, poly: Poly) -> tuple[int, Poly] | None:
        """A condition as the value of a generator that can be put into the others; None where it cannot be solved."""
        ring = self.canon.ring
        present = self.canon.generators_in(poly)
        if len(present) == 1 and poly.total_degree() == 1 and ring.vars[present[0]].kind in ("cos", "sin"):
            return present[0], self._value(poly, present[0])
        moves = not self.moving.isdisjoint(present)
        order = sorted(present, key=lambda i: (i not in self.moving, ring.var_expr[i] == ex.TIME, i in self.never, -i))
        for i in order:
            if ring.vars[i].kind != "symbol" or (moves and i not in self.moving):
                continue
            if poly.derivative(self._place(i)).is_constant():
                value = self._value(poly, i)
                if self.implied(i, value) is not None:
                    return i, value
        return None

    def _place(self, index: int) -> int:
        """The place of a generator in the polynomial ring, which has them in reverse."""
        return len(self.canon.gens) - 1 - index

    def _value(self, poly: Poly, index: int) -> Poly:
        return self.canon.gens[index] - poly / poly.derivative(self._place(index)).leading_coefficient()


class CommonZeros:
    """The search for the leaves; `common_zeros` runs it."""

    def __init__(self, reals: Reals, short: bool) -> None:
        self.reals, self.canon, self.short = reals, reals.canon, short
        self.steps = 0
        self.leaves: list[Leaf] = []

    def follow(self, polys: Iterable[Poly], leaf: Leaf) -> None:
        """Every leaf on which the polynomials vanish too."""
        check()
        self.steps += 1
        if self.steps > MAX_STEPS or len(self.leaves) > MAX_LEAVES:
            raise TooLargeError
        remaining: list[Poly] = []
        for poly in polys:
            if len(poly) > MAX_LONG:
                raise TooLargeError
            if poly == 0 or poly in remaining:
                continue
            if self.reals.never_zero(poly):
                return
            remaining.append(poly)
        if not remaining:
            self.leaves.append(leaf)
            return
        first = min(remaining, key=lambda p: (len(p), int(p.total_degree())))
        remainder = [p for p in remaining if p is not first]
        for factor in self.reals.factors(first):
            for together in self.reals.splits(factor):
                self._take(together, remainder, leaf)

    def _take(self, together: list[Poly], others_to_vanish: list[Poly], leaf: Leaf) -> None:
        if not together:
            self.follow(others_to_vanish, leaf)
            return
        condition, more = together[0], together[1:]
        result = self.reals.solved(condition)
        if self.short and (len(condition) > MAX_READ or (result is None and leaf.others)):
            return
        if result is None:
            kept = [p for p in others_to_vanish if divmod(p, condition)[1] != 0]
            self._take(more, kept, Leaf(leaf.solved, (*leaf.others, condition)))
            return
        index, value = result
        partner = self.canon.ring.vars[index].partner
        if any(i == partner and self.reals.never_zero(value**2 + v**2 - 1) for i, v in leaf.solved):
            return

        def put(poly: Poly) -> Poly:
            return self.reals.under(poly, index, value)

        after = [p for p in map(put, more) if p != 0]
        others = tuple(p for p in map(put, leaf.others) if p != 0)
        if any(self.reals.never_zero(p) for p in (*after, *others)):
            return
        solved = (*((i, put(v)) for i, v in leaf.solved), result)
        self._take(after, [put(p) for p in others_to_vanish], Leaf(solved, others))


def common_zeros(reals: Reals, polys: Iterable[Poly], short: bool = False) -> list[Leaf]:
    """The smallest sets of conditions under which all of some polynomials vanish. Raises TooLargeError.

    A leaf whose conditions include those of another is a part of it, and left out; ``short``: so are conditions that
    nobody could read, and more than one that cannot be solved.
    """
    search = CommonZeros(reals, short)
    search.follow(polys, Leaf())
    keys = [frozenset(map(str, leaf.conditions(reals.canon))) for leaf in search.leaves]
    kept: dict[frozenset[str], Leaf] = {}
    for key, leaf in zip(keys, search.leaves, strict=True):
        if not any(other < key for other in keys):
            kept.setdefault(key, leaf)
    return list(kept.values())


def where(canon: Canon, leaf: Leaf, order: Mapping[Expr, int]) -> str:
    """``x = 0 and y = 0``, by the symbols' ``order``."""
    last = len(order)
    solved = []
    for i, value in leaf.solved:
        remaining, right = canon.ring.var_expr[i], canon.to_expr(value)
        if right.op == "sym" and order.get(right, last) < order.get(remaining, last):
            remaining, right = right, remaining
        solved.append((_first(remaining, order), f"{to_text(remaining)} = {to_text(right)}"))
    return " and ".join([text for _, text in sorted(solved)] + [_equation(canon, poly, order) for poly in leaf.others])


def order_of(system: System) -> dict[Expr, int]:
    """Parameters and coordinates as they were declared."""
    declared = [*map(ex.parameter, system.parameters), *(ex.coordinate(c.name) for c in system.coordinates)]
    return {s: i for i, s in enumerate(declared)}


def _equation(canon: Canon, poly: Poly, order: Mapping[Expr, int]) -> str:
    """``x*y = 1``, with the number on the right, or ``a = b`` for two terms of opposite signs."""
    e = canon.to_expr(poly / poly.leading_coefficient())
    terms: Sequence[Expr] = e.args if e.op == "add" else (e,)
    number = next((term for term in terms if term.op == "num"), ex.ZERO)
    if len(terms) == 2 and sorted(poly.coeffs()) == [-1, 1] and number.is_zero:
        remaining, right = sorted((t if _positive(t) else -t for t in terms), key=lambda t: _first(t, order))
        return f"{to_text(remaining)} = {to_text(right)}"
    return f"{to_text(e - number)} = {to_text(-number)}"


def in_order(e: Expr, order: Mapping[Expr, int]) -> Expr:
    """Return a sum with its terms in the order in which their symbols are declared."""
    return ex.add(*sorted(e.args, key=lambda term: _first(term, order))) if e.op == "add" else e


def _positive(term: Expr) -> bool:
    return not (term.op == "mul" and term.args[0].op == "num" and term.args[0].args[0] < 0)


def _first(term: Expr, order: Mapping[Expr, int]) -> int:
    return min((order.get(s, len(order)) for s in term.symbols), default=len(order))


def drop(rank: int, by: int, velocities: int, moves: bool) -> str:
    """What it means that ``by`` rows of ``rank`` depend on the others."""
    if not moves:
        return "no velocity satisfies the constraints there"
    return (
        f"the rank of the constraints drops from {rank} to {rank - by} there, and the instantaneous freedom is "
        f"{velocities + by} instead of {velocities}"
    )


def flag(
    scene: Sequence[int] | None, elsewhere: Sequence[int] | None, there: Sequence[int], vanishes: bool
) -> tuple[str, bool]:
    """(what it means that the curvature vanishes or shrinks, whether the growth vector is told).

    ``elsewhere`` and ``there`` are the block's dimensions; the scene's have as many more as it has other coordinates.
    """
    answer = f"the first Lie brackets add {'no direction' if vanishes else 'fewer directions'} there"
    if (
        not scene
        or not elsewhere
        or there[-1] != elsewhere[-1]
        or [g + scene[0] - elsewhere[0] for g in elsewhere] != list(scene)
    ):
        return answer, False
    special = [g + scene[0] - elsewhere[0] for g in there]
    return f"{answer}: the growth vector is {tuple_of(special)} instead of {tuple_of(scene)}", True


def tuple_of(numbers: Sequence[int]) -> str:
    """``(2, 3, 4)``."""
    return f"({', '.join(map(str, numbers))})"
