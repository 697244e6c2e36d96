"""Relations made simpler before rows are looked at: powers, sums of squares, products of factors."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction

from dofkit.checker.trees import CheckError, Tree, add, number, power, times
from dofkit.checker.values import symbols_in
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
    for step, made in _steps(name, left):
        ids = [f"{scenery.label}{one}" for one in made]
        try:
            scenery.add_step({**step, "id": f"{scenery.label}{step['id']}"})
        except CheckError:
            continue
        scenery.reduced_from |= dict.fromkeys(ids, name)
        return ids
    return [name]


def _steps(name: str, left: Tree) -> Iterator[tuple[Step, list[str]]]:
    """Steps that might do, with the relations that they make."""
    squares = [_square(term) for term in (left.below if left.head == "sum" else (left,))]
    if not all(squares):
        return
    pairs = [pair for pair in squares if pair is not None]
    if len(pairs) == 1:
        coefficient, base, exponent = pairs[0]
        root = {"factors": [text_of(base), number_text(coefficient)], "chosen": 0, "power": exponent}
        yield {"id": f"root of {name}", "by": "branch", "of": name, **root}, [f"root of {name}"]
    elif all(exponent == 2 for _, _, exponent in pairs):
        terms = [[number_text(c), text_of(base)] for c, base, _ in pairs]
        made = [f"terms of {name}.{i}" for i in range(1, len(pairs) + 1)]
        yield {"id": f"terms of {name}", "by": "sos", "of": name, "terms": terms}, made


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
    return None if base is None or not symbols_in(base) else (coefficient, base, exponent)


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
        given = {"factors": [text_of(factor), text_of(rest)], "chosen": 1, "positive": [positive]}
        try:
            scenery.add_step({"id": step, "by": "branch", "of": name, **given})
        except CheckError:
            continue
        return step
    return name


def _factors(term: Tree) -> list[Tree]:
    return [one for part in term.below for one in _factors(part)] if term.head == "product" else [term]


def _positive(tree: Tree) -> Step | None:
    """A sum as a positive number and squares with positive coefficients."""
    numbers = [part.value for part in tree.below if isinstance(part.value, Fraction)]
    squares = [_square(part) for part in tree.below if not isinstance(part.value, Fraction)]
    terms = [
        [number_text(one[0]), text_of(power(one[1], number(one[2] // 2)))]
        for one in squares
        if one is not None and one[0] > 0
    ]
    if tree.head != "sum" or len(terms) < len(squares) or not numbers or numbers[0] <= 0:
        return None
    return {"plus": number_text(numbers[0]), "sos": terms}
