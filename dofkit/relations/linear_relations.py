"""Relations that are solved exactly: linear ones over the rationals, and others for a coordinate that occurs once."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from fractions import Fraction
from typing import NamedTuple

from dofkit.base.deadline import check
from dofkit.exact.analyticity import is_analytic
from dofkit.exact.ring.canonical import is_identically_zero
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import substitute
from dofkit.expressions.tree import Expr

#: A value of more than `SHORT` terms is substituted only into relations that stay below `MAX_NODES` nodes.
SHORT, MAX_NODES = 4, 200

Terms = dict[Expr, Fraction]


def linear(e: Expr) -> Terms | None:
    """Return {symbol: number} for a linear expression, `ONE` standing for the constant; None if it is not linear."""
    terms: Terms = {}
    for term in e.args if e.op == "add" else (e,):
        factor, remainder = ex.number_and_rest(term)
        if remainder.op != "sym" and remainder != ex.ONE:
            return None
        terms[remainder] = terms.get(remainder, Fraction(0)) + factor
    return terms


# Relations that are solved for a coordinate

#: A function that returns the coordinates for which a relation may be solved, with their coefficients.
Coefficients = Callable[[Expr], Mapping[Expr, Expr]]


class Explicit(NamedTuple):
    """Relations solved for one coordinate each, and the other relations after substitution (``implicit``).

    ``explicit``: {coordinate: the relation solved for it}, in the order of solving; ``values``: {coordinate: its
    value}, free of the coordinates solved for before; ``implied``: numbers of relations that the others imply.
    """

    explicit: dict[Expr, Expr]
    values: dict[Expr, Expr]
    implicit: tuple[Expr, ...]
    implied: tuple[int, ...]

    @property
    def contradictory(self) -> bool:
        """Whether ``implicit`` has a linear equation of parameters and numbers only: generic ones violate it."""
        of_parameters = (g for g in self.implicit if all(s.args[0] == "parameter" for s in g.symbols))
        return any(linear(g) is not None for g in of_parameters)

    @property
    def by_others(self) -> dict[Expr, Expr]:
        """{coordinate solved for: its value as a function of the coordinates not solved for}."""
        result: dict[Expr, Expr] = {}
        for s in reversed(self.values):
            result[s] = substitute(self.values[s], result)
        return result

    def implies(self, e: Expr) -> bool | None:
        """Return whether the solved relations imply a linear one; None if ``implicit`` ones might help to do so."""
        return substitute(e, self.by_others).is_zero or (None if self.implicit else False)


def constant_coefficients(g: Expr) -> dict[Expr, Expr]:
    """Return {coordinate: coefficient} for coordinates that occur once in a sum, in the first degree.

    Coefficients contain no coordinate and are generically not 0.
    """
    terms = g.args if g.op == "add" else (g,)
    times = Counter(s for t in terms for s in t.symbols)
    result = {}
    for t in terms:
        factors = t.args if t.op == "mul" else (t,)
        for s in (f for f in factors if f.op == "sym" and f.args[0] == "coordinate" and times[f] == 1):
            cofactors = [f for f in factors if f != s]
            if all(map(_is_generic, cofactors)):
                result[s] = ex.mul(*cofactors)
    return result


def number_coefficients(g: Expr) -> dict[Expr, Expr]:
    """Return the `constant_coefficients` that are numbers."""
    return {s: c for s, c in constant_coefficients(g).items() if c.op == "num"}


def _is_generic(e: Expr) -> bool:
    """Return whether ``e`` has no coordinate, and is 0 only at isolated times or for special parameters."""
    if any(s.args[0] == "coordinate" for s in e.symbols):
        return False
    return e.op in ("num", "sym") or (is_identically_zero(e) is False and is_analytic(e, e.symbols))


def explicit_relations(relations: Iterable[Expr], coefficients: Coefficients = constant_coefficients) -> Explicit:
    """Return the relations solved one after another, each for a coordinate, and the others after substitution.

    Relations whose coordinate occurs in no other come first; then coordinates that occur in few other relations.
    """
    remaining = dict(enumerate(relations))
    implied = [i for i, g in remaining.items() if g.is_zero]
    users: dict[Expr, set[int]] = {}
    for i, g in remaining.items():
        for s in g.symbols:
            users.setdefault(s, set()).add(i)
    explicit, values = dict[Expr, Expr](), dict[Expr, Expr]()
    private, shared = [*remaining][::-1], [*remaining][::-1]
    while private or shared:
        check()
        alone = bool(private)
        i = (private or shared).pop()
        slopes = coefficients(remaining[i]) if i in remaining else {}
        solutions = [
            (_value(remaining[i], s, slope), s) for s, slope in slopes.items() if len(users[s]) == 1 or not alone
        ]
        solutions = [(v, s) for v, s in solutions if alone or _fits(v, [remaining[k] for k in users[s] if k != i])]
        if not solutions:
            continue
        value, s = min(solutions, key=lambda pair: (len(users[pair[1]]), repr(pair[1])))
        values[s] = value
        before = {k: remaining[k] for k in users[s]}
        explicit[s] = remaining.pop(i)
        for k, g in before.items():
            if k != i:
                remaining[k] = substitute(g, {s: value})
            kept = remaining[k].symbols if k != i else frozenset[Expr]()
            for symbol in kept:
                users[symbol].add(k)
            for symbol in g.symbols - kept:
                users[symbol].discard(k)
                private += users[symbol] if len(users[symbol]) == 1 else ()
            if k != i and remaining[k].is_zero:
                implied.append(k)
        private, shared = [*private, *before], [*shared, *before]
    implicit = tuple(g for g in remaining.values() if not g.is_zero)
    return Explicit(explicit, values, implicit, tuple(implied))


def solve_linear(relations: Sequence[Expr]) -> Explicit:
    """Return the solution of the linear ones among ``relations``; ``implied`` are indices in ``relations``."""
    numbers = [i for i, g in enumerate(relations) if linear(g) is not None]
    solved = explicit_relations([relations[i] for i in numbers], number_coefficients)
    return solved._replace(implied=tuple(numbers[k] for k in solved.implied))


def _value(g: Expr, s: Expr, slope: Expr) -> Expr:
    """Return the value of a coordinate ``s`` by a relation in which it occurs in one term, ``slope`` s."""
    others = (t for t in (g.args if g.op == "add" else (g,)) if s not in t.symbols)
    return ex.add(*(ex.mul(ex.MINUS_ONE / slope, t) for t in others))


def _fits(value: Expr, others: Sequence[Expr]) -> bool:
    """Return whether a value may be substituted into ``others``: it is a short sum, or they stay linear or small."""
    terms = linear(value)
    if terms is not None and (len(terms) <= SHORT or all(linear(e) is not None for e in others)):
        return True
    size = ex.size(value)
    return all(ex.size(e) + size <= MAX_NODES for e in others)
