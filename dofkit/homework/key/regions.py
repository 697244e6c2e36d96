"""Compares the regions that the inequalities of an answer and those asked for describe.

Two regions are equal if neither contains a point outside the other. Each difference is a system of inequalities, which
classification proves to be empty or for which it finds a certified point; undecided differences are not judged.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product
from typing import NamedTuple

from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import diff, replace_nodes, substitute
from dofkit.expressions.text import Comparison, to_text
from dofkit.expressions.tree import ZERO, Expr
from dofkit.homework.key.counterexamples import counterexample
from dofkit.methods.classify import classify
from dofkit.scene.constraints.base import Equation
from dofkit.scene.scene import Scene

#: The most systems of inequalities for one difference.
MOST_CASES = 24
_ROOT = ex.parameter("a root")


class Condition(NamedTuple):
    """The inequality ``e > 0`` if ``strict``, else ``e >= 0``."""

    e: Expr
    strict: bool


class RegionComparison(NamedTuple):
    """Whether the answer's region has points outside the region asked for (``beyond``), and lacks some (``lacking``).

    None: undecided. ``point``: a point of one of the differences as text; empty if none is known.
    """

    beyond: bool | None
    lacking: bool | None
    point: str


def conditions(relations: Sequence[Comparison]) -> list[Condition] | None:
    """Return inequalities as conditions, or None if a relation is an equation."""
    inequalities = []
    for c in relations:
        if c.relation not in ("<", "<=", ">", ">="):
            return None
        difference = c.right - c.left if c.relation[0] == "<" else c.left - c.right
        inequalities.append(Condition(difference, len(c.relation) == 1))
    return inequalities


def compared_regions(scene: Scene, asked: Sequence[Condition], answer: Sequence[Condition]) -> RegionComparison:
    """Return the comparison of two regions; ``scene`` contains the other constraints, which apply to both."""
    beyond, point = _difference(scene, answer, asked)
    lacking, other = _difference(scene, asked, answer)
    sure = lacking is not False or all(_has_values(c.e) for c in answer)
    return RegionComparison(beyond, lacking if sure else None, point if beyond else other)


def _has_values(e: Expr) -> bool:
    """Return whether an expression is certain to have a value wherever its square roots have one."""
    total = {"abs", "sin", "cos", "exp", "atan", "tanh", "sinh", "cosh"}
    whole = (n.op != "pow" or (n.args[1].op == "num" and n.args[1].args[0] > 0) for n in ex.nodes(e))
    return all(whole) and all(n.args[0] in total for n in ex.nodes(e) if n.op == "fn")


def _difference(scene: Scene, region: Sequence[Condition], other: Sequence[Condition]) -> tuple[bool | None, str]:
    """Return (whether ``region`` has a point outside ``other``, or None if undecided; this point as text)."""
    failing = [system for condition in other for system in _failing(condition)]
    within = [[c for case in chosen for c in case] for chosen in product(*map(_cases, region))]
    systems = [[*case, *outside] for case in within for outside in failing]
    undecided = len(systems) > MOST_CASES
    for system in systems[:MOST_CASES]:
        texts = [f"{to_text(c.e)} {'>' if c.strict else '>='} 0" for c in system]
        more = tuple(Equation(name=f"region {n}", text=text) for n, text in enumerate(texts))
        whole = scene.model_copy(update={"constraints": (*scene.constraints, *more), "expect": {}})
        report = classify(whole)
        if report.consistent is False:
            continue
        if report.feasible:
            return True, counterexample(scene, (), (), [c.e for c in system])
        undecided = undecided or report.feasible is None
    return None if undecided else False, ""


def _failing(condition: Condition) -> list[list[Condition]]:
    """Return systems of which one is satisfied where the condition is false or undefined, and none elsewhere."""
    outside = [[Condition(-root.args[0], True)] for root in _roots(condition.e)]
    return [*outside, *_cases(Condition(-condition.e, not condition.strict))]


def _cases(condition: Condition) -> list[list[Condition]]:
    """Return systems without absolute values and square roots that are together equivalent to a condition."""
    e, strict = condition
    for node in ex.nodes(e):
        if node.op == "fn" and node.args[0] == "abs":
            inside = node.args[1]
            sides = ((inside, Condition(inside, False)), (-inside, Condition(-inside, True)))
            return [
                [side, *case]
                for value, side in sides
                for case in _cases(Condition(replace_nodes(e, {node: value}), strict))
            ]
    for root in _roots(e):
        named = replace_nodes(e, {root: _ROOT})
        slope, remainder = diff(named, _ROOT), substitute(named, {_ROOT: ZERO})
        if slope.op != "num" or any(_roots(remainder)):
            break
        square, domain = root.args[0] * slope * slope, Condition(root.args[0], False)
        if slope.args[0] < 0:
            return [[domain, Condition(remainder, False), Condition(remainder * remainder - square, strict)]]
        above = [domain, Condition(-remainder, False), Condition(square - remainder * remainder, strict)]
        return [[domain, Condition(remainder, strict)], above]
    return [[condition]]


def _roots(e: Expr) -> list[Expr]:
    return [n for n in ex.nodes(e) if n.op == "pow" and n.args[1] == ex.HALF]
