"""The checker's reading of a scene, with choices for what it does not determine, and its trees as texts."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from functools import cached_property
from typing import Any

from dofkit.checker.evidence import CheckedEvidence
from dofkit.checker.problem import CheckedProblem as Problem
from dofkit.checker.trees import CheckError, Effort, Tree, substituted
from dofkit.methods.certificates.numerics import Estimates, NoEstimateError


def number_text(value: Fraction | int) -> str:
    """A rational number."""
    value = Fraction(value)
    return str(value.numerator) if value.denominator == 1 else f"{value.numerator}/{value.denominator}"


def text_of(tree: Tree) -> str:
    """A tree as a text that is read as the same tree, up to the order of what commutes."""
    head = tree.head
    if isinstance(tree.value, Fraction):
        return number_text(tree.value) if tree.value >= 0 else f"({number_text(tree.value)})"
    if head == "symbol":
        return str(tree.value)
    if head == "pi":
        return "pi"
    if head == "sum":
        return "(" + " + ".join(text_of(part) for part in tree.below) + ")"
    if head == "product":
        return "*".join(_factor(part) for part in tree.below)
    if head == "power":
        return f"({text_of(tree.below[0])})^({text_of(tree.below[1])})"
    if head == "apply":
        return _applied(tree)
    return f"{head}({', '.join(text_of(part) for part in tree.below)})"


def _factor(tree: Tree) -> str:
    text = text_of(tree)
    return f"({text})" if "/" in text or tree.head == "product" else text


def _applied(tree: Tree) -> str:
    """A declared function, or its derivative by its arguments."""
    if len(tree.orders) > 1 and any(tree.orders):
        raise CheckError("a partial derivative of a declared function has no text")
    primes = "'" * tree.orders[0]
    return f"{tree.value}{primes}({', '.join(text_of(part) for part in tree.below)})"


# The checker's reading of a scene, with choices made for what it does not determine.

#: What is farther from 0 than this, in floats, is not 0.
FAR = 1e-7
#: Units of the checker's work that looking for the evidence of one scene may cost.
WORK = 12_000_000
#: Scenes with more relations or coordinates than this are left to what needs no numbers.
MOST_ROWS = 160
_CHOICES = tuple(map(Fraction, ("2", "3", "3/2", "5/2", "4/3", "7/4", "5/3", "9/4", "7/3", "11/4")))


class Scenery:
    """A problem with its evidence so far, and values for parameters, unknown functions and time."""

    def __init__(self, problem: Problem, cayley: bool, lists: dict[str, list[dict[str, Any]]]) -> None:
        self.problem, self.cayley, self.entries = problem, cayley, lists
        self.effort = Effort(WORK)
        self._view = dict(lists)
        self.evidence = CheckedEvidence(problem, self._view, self.effort)
        self._prepared: dict[str, Tree] = {}
        self.steps: set[str] = set()

    def entry_id(self, part: str, entry: dict[str, Any]) -> str:
        """The id of a minor, field or cover, written into the certificate where it is new."""
        entries = self.entries[part]
        names = (str(other["id"]) for other in entries if {**other, **entry} == other)
        if (name := next(names, "")) == "":
            name = f"{part[0].upper()}{len(entries)}"
            entries.append({"id": name, **entry})
        return name

    @property
    def label(self) -> str:
        """What ids of this reading begin with."""
        return "C" if self.cayley else ""

    @cached_property
    def functions(self) -> dict[str, dict[str, Any]]:
        """A polynomial for every unknown function."""
        return {
            name: _polynomial(len(arguments), i)
            for i, (name, arguments) in enumerate(self.problem.world.names.functions.items())
        }

    @cached_property
    def parameters(self) -> dict[str, Fraction]:
        """A value for every parameter that occurs."""
        used = {name for relation in self.problem.relations for name in relation.tree.symbols}
        used |= {name for tree in self.problem.reference.values() for name in tree.symbols}
        names = [name for name in self.problem.world.signs if name in used]
        return {name: _CHOICES[i % len(_CHOICES)] for i, name in enumerate(names)}

    @cached_property
    def timed(self) -> bool:
        """Whether time occurs in any relation, inequalities included."""
        return any(not {"t", "tdot"}.isdisjoint(relation.tree.symbols) for relation in self.problem.relations)

    def linear(self, name: str) -> bool:
        """Whether a relation is a linear form in the velocities; False where that is not known."""
        try:
            return self.evidence.is_linear(name)
        except CheckError:
            return False

    def tree(self, name: str) -> Tree:
        """A relation's left side with the functions chosen."""
        if name not in self._prepared:
            tree = self.evidence.relation(name).tree
            self._prepared[name] = self.chosen(tree)
        return self._prepared[name]

    def chosen(self, tree: Tree) -> Tree:
        """A tree with the functions chosen."""
        if not self.functions:
            return tree
        bodies_of_functions = {
            name: (tuple(f["arguments"]), self.evidence.text(f["text"], f["arguments"]))
            for name, f in self.functions.items()
        }
        return substituted(tree, {}, bodies_of_functions)

    def estimated(self, tree: Tree, estimates: Estimates) -> float:
        """The value of a tree at a point in floats; 0 where it has none."""
        try:
            return estimates.value(self.chosen(tree))
        except NoEstimateError:
            return 0.0

    def differs(self, tree: Tree, estimates: Estimates) -> bool:
        """Return whether a tree is not 0 at a point, by far."""
        return abs(self.estimated(tree, estimates)) > FAR

    def add_step(self, step: dict[str, Any]) -> None:
        """A further step, if it stands up; `CheckError` where it does not."""
        before = dict(self.evidence.by_name), list(self.evidence.consequences)
        self._view["relations"] = [step]
        self.evidence.faults.pop(step["id"], None)
        try:
            self.evidence._take_steps()
        finally:
            self._view["relations"] = self.entries["relations"]
        if step["id"] in self.evidence.faults:
            self.evidence.by_name, self.evidence.consequences = before
            raise CheckError(self.evidence.faults[step["id"]])
        self.entries["relations"].append(step)
        self.steps.add(step["id"])


def _polynomial(count: int, place: int) -> dict[str, Any]:
    names = [f"a{i}" for i in range(count)]
    terms = [f"{i + 2 + place}*{name}" for i, name in enumerate(names)]
    terms += [f"{name}^2/{7 + i}" for i, name in enumerate(names)]
    terms += [f"{a}*{b}/{3 + i + j}" for i, a in enumerate(names) for j, b in enumerate(names) if i < j]
    return {"arguments": names, "text": " + ".join(terms)}


def floats_of(values: Mapping[str, Fraction]) -> dict[str, float]:
    """Values in floats."""
    return {name: float(value) for name, value in values.items()}
