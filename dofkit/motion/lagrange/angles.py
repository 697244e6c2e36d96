"""Products of sines and cosines written as one of a sum: cos a cos b + sin a sin b = cos(a - b), and the like."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from dofkit.expressions import tree as ex
from dofkit.expressions.tree import Expr


def compound(e: Expr) -> Expr:
    """The same with the addition theorems used from right to left, wherever two terms of a sum allow it.

    >>> from dofkit.expressions.text import to_text
    >>> a, b = ex.coordinate("a"), ex.coordinate("b")
    >>> cos, sin = (lambda u: ex.fn("cos", u)), (lambda u: ex.fn("sin", u))
    >>> to_text(compound(cos(a) * cos(b) + sin(a) * sin(b)))
    'cos(a - b)'
    >>> to_text(compound(ex.ONE - cos(a) ** 2))
    'sin(a)^2'
    """
    memo: dict[Expr, Expr] = {}
    for node in ex.nodes(e):
        made = ex.rebuild(node, tuple(memo[child] for child in ex.children(node)))
        while made.op == "add":
            joined = _joined(made.args)
            if joined is None:
                break
            made = joined
        memo[node] = _squared(made) if made.op == "mul" else made
    return memo[e]


def _squared(e: Expr) -> Expr:
    """A product with (cos u - 1)(cos u + 1) = -sin(u)^2 in it, and the like for sines."""
    for first in e.args:
        for second in e.args:
            if first.op == second.op == "add" and len(first.args) == len(second.args) == 2:
                one, two = set(first.args), set(second.args)
                turn = one & two
                if {ex.ONE, ex.MINUS_ONE} == one ^ two and all(_turning(t) for t in turn):
                    (u,) = (t.args[1] for t in turn)
                    other = "sin" if next(iter(turn)).args[0] == "cos" else "cos"
                    rest = list(e.args)
                    rest.remove(first)
                    rest.remove(second)
                    return ex.mul(ex.MINUS_ONE, *rest, ex.fn(other, u) ** 2)
    return e


def _joined(terms: Sequence[Expr]) -> Expr | None:
    """The sum with two of its terms made one; None where no two fit."""
    for i, first in enumerate(terms):
        for j in range(i + 1, len(terms)):
            found = _pair(first, terms[j])
            if found is not None:
                return ex.add(*terms[:i], found, *terms[i + 1 : j], *terms[j + 1 :])
    return None


def _pair(first: Expr, second: Expr) -> Expr | None:
    """Two terms that differ in two factors only: cos a cos b and sin a sin b, or sin a cos b and cos a sin b."""
    sign, one = _split(first)
    other_sign, two = _split(second)
    if abs(sign.args[0]) != abs(other_sign.args[0]):
        return None
    own, others = list((one - two).elements()), list((two - one).elements())
    if not own or not others:
        plain, squared = (other_sign, sign) if own else (sign, other_sign)
        return _by_pythagoras(plain, squared, own or others, one & two)
    if len(own) != 2 or len(others) != 2 or not all(_turning(f) for f in (*own, *others)):
        return None
    a, b = own[0].args[1], own[1].args[1]
    if a == b or {f.args[1] for f in others} != {a, b}:
        return None
    swapped = {f.args[1]: f.args[0] for f in others}
    if swapped[a] == own[0].args[0] or swapped[b] == own[1].args[0]:
        return None
    rest = (sign, *(one & two).elements())
    same = sign == other_sign
    if own[0].args[0] == own[1].args[0]:
        whole = ex.fn("cos", a - b if same else a + b)
        return ex.mul(*rest, whole if own[0].args[0] == "cos" or same else -whole)
    if own[0].args[0] == "cos":
        a, b = b, a
    return ex.mul(*rest, ex.fn("sin", a + b if same else a - b))


def _by_pythagoras(sign: Expr, other: Expr, square: Sequence[Expr], rest: Counter[Expr]) -> Expr | None:
    """A - A cos(u)^2 = A sin(u)^2, and the like for sines; ``sign`` is that of A, ``other`` that of the square."""
    if len(square) != 1 or sign == other or square[0].op != "pow" or square[0].args[1] != ex.TWO:
        return None
    base = square[0].args[0]
    if not _turning(base):
        return None
    opposite = ex.fn("sin" if base.args[0] == "cos" else "cos", base.args[1])
    return ex.mul(sign, *rest.elements(), opposite**2)


def _split(term: Expr) -> tuple[Expr, Counter[Expr]]:
    """The number in front, and the other factors."""
    parts = term.args if term.op == "mul" else (term,)
    number = ex.mul(*(p for p in parts if p.op == "num"))
    return number, Counter(p for p in parts if p.op != "num")


def _turning(e: Expr) -> bool:
    return e.op == "fn" and e.args[0] in ("sin", "cos")
