"""The order in which terms and factors are read, and their signs: as a lecturer writes them on a board."""

from __future__ import annotations

import re
from fractions import Fraction
from math import gcd, lcm

from dofkit.expressions import tree as ex
from dofkit.expressions.text import to_text
from dofkit.expressions.tree import Expr

_KINDS = {"parameter": 0, "time": 1, "coordinate": 2, "velocity": 4, "acceleration": 5}
#: Letters of parameters in the order in which they are written: masses, inertias, stiffness and damping, gravity.
_LETTERS = ("mM", "IJ", "kc", "g")
#: Of sums with higher exponents no number is taken out.
_HIGHEST = 4
_LETTER = re.compile(r"([A-Za-z])_?(?:\d\w*|(?<=_)\w+)?")


def ordered(e: Expr) -> Expr:
    """The same expression with its terms and factors in a steady order that people expect, and few minus signs."""
    memo: dict[Expr, Expr] = {}
    for node in ex.nodes(e):
        parts = tuple(memo[child] for child in ex.children(node))
        if node.op == "add":
            memo[node] = _sum(parts)
        elif node.op == "mul":
            memo[node] = _product(parts)
        else:
            memo[node] = ex.rebuild(node, parts)
    return memo[e]


def _sum(terms: tuple[Expr, ...]) -> Expr:
    return Expr("add", tuple(sorted(terms, key=_term)))


def _product(factors: tuple[Expr, ...]) -> Expr:
    """With the signs and numbers of sums before it.

    ``-a*(-b - c)`` is ``a*(b + c)``, ``a*(cos(x) - 1)`` is ``-a*(1 - cos(x))``, ``(a/2 + b/2)*c`` is ``(a + b)*c/2``;
    a minus goes into a difference of constants.
    """
    number, parts = Fraction(1), []
    for factor in factors:
        base, exponent = factor.args if factor.op == "pow" else (factor, ex.ONE)
        if base.op == "num" and exponent == ex.ONE:
            number *= base.args[0]
            continue
        whole = exponent.op == "num" and exponent.args[0].denominator == 1
        content = _content(base) if base.op == "add" and whole else Fraction(1)
        if content != 1 and abs(exponent.args[0]) <= _HIGHEST:
            base = _sum(tuple(_times(term, 1 / content) for term in base.args))
            number *= content ** exponent.args[0].numerator
            factor = base if exponent == ex.ONE else Expr("pow", (base, exponent))
        parts.append(factor)
    turned = next((k for k, part in enumerate(parts) if _turns(part)), None) if number < 0 else None
    if turned is not None:
        parts[turned], number = _sum(tuple(_times(term, Fraction(-1)) for term in parts[turned].args)), -number
    return _times(Expr("mul", tuple(sorted(parts, key=_factor))) if len(parts) != 1 else parts[0], number)


def _turns(e: Expr) -> bool:
    """Is it a difference of constants, which may as well stand the other way round?"""
    constants = e.op == "add" and all(s.args[0] == "parameter" for s in e.symbols)
    return constants and 2 * sum(map(_is_negative, e.args)) == len(e.args)


def _content(e: Expr) -> Fraction:
    """The number that stands before a sum: what its terms have in common, negative where that spares minus signs."""
    numbers = [_number(term) for term in e.args]
    common = Fraction(gcd(*(n.numerator for n in numbers)), lcm(*(n.denominator for n in numbers)))
    return -common if _better_negated(e) else common


def _number(term: Expr) -> Fraction:
    first = term.args[0] if term.op == "mul" else term
    value: Fraction = first.args[0] if first.op == "num" else Fraction(1)
    return value


def _times(term: Expr, number: Fraction) -> Expr:
    """The term with a number before it, its factors in their order."""
    if term.op == "num":
        return ex.num(term.args[0] * number)
    first, rest = (term.args[0], term.args[1:]) if term.op == "mul" else (term, (term,))
    if term.op == "mul" and first.op == "num":
        number *= first.args[0]
    elif term.op == "mul":
        rest = term.args
    if number == 1:
        return rest[0] if len(rest) == 1 else Expr("mul", rest)
    return Expr("mul", (ex.num(number), *rest)) if rest else ex.num(number)


def _better_negated(e: Expr) -> bool:
    """Has a sum more minus than plus signs, or is it ``cos(x) - 1``?"""
    below = sum(map(_is_negative, e.args))
    if len(e.args) == 2 and below == 1:
        return any(t.op == "num" and t.args[0] < 0 for t in e.args) and any(t.op == "fn" for t in e.args)
    return 2 * below > len(e.args)


def _is_negative(term: Expr) -> bool:
    return _number(term) < 0


def _orders(e: Expr, kind: str) -> int:
    return sum(s.args[0] == kind for s in e.symbols)


def _term(e: Expr) -> tuple[bool, bool, bool, bool, tuple[object, ...]]:
    """Accelerations, then velocities, then the rest; positive before negative, and constants before what moves."""
    factors = e.args if e.op == "mul" else (e,)
    moving = any(s.args[0] != "parameter" for s in e.symbols)
    quick = not _orders(e, "acceleration"), not _orders(e, "velocity")
    return *quick, _is_negative(e), moving, tuple(map(_factor, factors))


def _factor(e: Expr) -> tuple[int, int, str]:
    """Numbers, parameters, coordinates, functions and sums, velocities, accelerations."""
    base = e.args[0] if e.op == "pow" else e
    if base.op == "num":
        return -1, 0, to_text(base)
    if base.op == "sym":
        kind, name = base.args
        return _KINDS.get(kind, 6), _standing(name) if kind == "parameter" else 0, name
    if all(s.args[0] == "parameter" for s in base.symbols):
        return 0, min((_standing(s.args[1]) for s in base.symbols), default=0), to_text(base)
    return 3, 0, to_text(base)


def _standing(parameter: str) -> int:
    """Where a parameter stands by its letter: ``m g l``, ``m l^2``, ``k x``."""
    match = _LETTER.fullmatch(parameter)
    letter = match[1] if match is not None else ""
    return next((place for place, letters in enumerate(_LETTERS) if letter and letter in letters), len(_LETTERS))
