"""Relations made simpler before rows are looked at: powers, sums of squares, products of factors."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

from dofkit.checker.trees import CheckError, Tree, add, number, power, times
from dofkit.methods.certificates.scenery import Scenery
from dofkit.methods.certificates.texts import number_text, text_of

Step = dict[str, object]


def reduced(scenery: Scenery, names: Sequence[str]) -> list[str]:
    """Relations, each one that is a power or a sum of squares replaced by its bases."""
    return [one for name in names for one in _reduced(scenery, name)]


def _reduced(scenery: Scenery, name: str) -> list[str]:
    known = [one for one, source in scenery.reduced_from.items() if source == name]
    if known:
        return known
    left = scenery.evidence.relation(name).left
    steps = _steps(scenery.label, name, left)
    if not steps or not _stand(scenery, steps):
        return [name]
    ids = [str(step["id"]) for step in steps if "function" in step]
    scenery.reduced_from |= dict.fromkeys(ids, name)
    return ids


def _stand(scenery: Scenery, steps: Sequence[Step]) -> bool:
    """Whether steps stand up, one after the other."""
    try:
        for step in steps:
            scenery.add_step(step)
    except CheckError:
        return False
    return True


def _steps(label: str, name: str, left: Tree) -> list[Step]:
    """Steps to the bases of a power or a sum of squares, and back; none where it is no such thing."""
    squares = [_square(term) for term in (left.below if left.head == "sum" else (left,))]
    pairs = [pair for pair in squares if pair is not None]
    signs = {coefficient > 0 for coefficient, *_ in pairs}
    if len(pairs) < len(squares) or len(signs) > 1 or (len(pairs) > 1 and any(k != 2 for *_, k in pairs)):
        return []
    sign, found = "1" if signs == {True} else "-1", list[Step]()
    ids = [f"{label}root {i} of {name}" for i in range(1, len(pairs) + 1)]
    for i, (coefficient, base, exponent) in enumerate(pairs):
        others = [[number_text(abs(c)), text_of(a)] for j, (c, a, _) in enumerate(pairs) if j != i]
        told = {"function": text_of(base), "power": exponent, "h": number_text(abs(coefficient)), "c": {name: sign}}
        found.append({"id": ids[i], "by": "implied", **told, **({"sos": others} if others else {})})
    cofactors = {
        one: text_of(times(number(c), power(a, number(k - 1)))) for one, (c, a, k) in zip(ids, pairs, strict=True)
    }
    return [*found, {"id": f"{label}{name} from its roots", "by": "implied", "of": name, "c": cofactors}]


def _square(term: Tree) -> tuple[Fraction, Tree, int] | None:
    """A term as a number times an even power of what is no number."""
    factors = term.below if term.head == "product" else (term,)
    coefficient, base, exponent = Fraction(1), None, 0
    for factor in factors:
        if isinstance(factor.value, Fraction):
            coefficient *= factor.value
        elif base is None and factor.head == "power" and isinstance(factor.below[1].value, Fraction):
            base, exponent = factor.below[0], int(factor.below[1].value)
            if factor.below[1] != number(exponent) or exponent < 2 or exponent % 2:
                return None
        else:
            return None
    return None if base is None or not base.symbols else (coefficient, base, exponent)


def without_factor(scenery: Scenery, name: str) -> str:
    """The id of a step that drops a factor that is a positive number plus squares; the relation's own without one."""
    step, left = f"{scenery.label}{name} without its factor", scenery.evidence.relation(name).left
    if scenery.has_step(step):
        return step
    terms = [_factors(term) for term in (left.below if left.head == "sum" else (left,))]
    for factor in terms[0]:
        positive = _positive(factor)
        if positive is None or not all(factor in term for term in terms):
            continue
        places = [term.index(factor) for term in terms]
        rest = add(*(times(*term[:i], *term[i + 1 :]) for term, i in zip(terms, places, strict=True)))
        made = {"id": step, "by": "implied", "function": text_of(rest), "c": {name: text_of(rest)}, "power": 2}
        sos = [[c, text_of(times(base, rest))] for c, base in positive[1]]
        back: dict[str, object] = {"id": f"{step}, and back", "by": "implied", "of": name, "c": {step: text_of(factor)}}
        if _stand(scenery, [{**made, "h": positive[0], "sos": sos}, back]):
            return step
    return name


def _factors(term: Tree) -> list[Tree]:
    return [one for part in term.below for one in _factors(part)] if term.head == "product" else [term]


def _positive(tree: Tree) -> tuple[str, list[tuple[str, Tree]]] | None:
    """A sum as a positive number and squares of bases with positive coefficients."""
    numbers = [part.value for part in tree.below if isinstance(part.value, Fraction)]
    squares = [_square(part) for part in tree.below if not isinstance(part.value, Fraction)]
    terms = [
        (number_text(one[0]), power(one[1], number(one[2] // 2))) for one in squares if one is not None and one[0] > 0
    ]
    if tree.head != "sum" or len(terms) < len(squares) or not numbers or numbers[0] <= 0:
        return None
    return number_text(numbers[0]), terms
