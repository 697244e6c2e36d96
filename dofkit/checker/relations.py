"""The relations of a scene, those that steps make of them by identities in the ring, and what depends on what.

A step carries two kinds of consequence. *Entailed*: where the relations it was made from hold, it holds. *Accounted
for*: where it holds, the relation it was made from holds. Either may need expressions not to be 0, which is asked at a
point, and others to have a value there, so that it is true near the point.
"""

from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from itertools import chain
from typing import Any, NamedTuple, TypeVar, cast

from dofkit.checker.constraints import nowhere_zero
from dofkit.checker.grammar import KnownNames, parse
from dofkit.checker.point import CheckedPoint, evaluated, not_zero
from dofkit.checker.problem import CheckedProblem, CheckedRelation
from dofkit.checker.ring import CheckedRing
from dofkit.checker.trees import CheckError, Effort, Tree, add, along, keeps_values, put_in, refuse, substituted, symbol

#: What a certificate of another form, or a hostile one, may raise.
FAULTS = (CheckError, KeyError, TypeError, ValueError, AttributeError, IndexError, ArithmeticError, RecursionError)
LONGEST_TEXT, MOST_SYMBOLS = 40_000, 2000
Looked = TypeVar("Looked")


class Consequence(NamedTuple):
    """``target`` holds where all ``sources`` do, where the ``nonzero`` are not 0 and the ``defined`` have a value.

    Near the point ``at`` only, where one is named. A rate is 0 along motions, and not at every state of a point.
    """

    target: str
    sources: tuple[str, ...]
    nonzero: tuple[Tree, ...] = ()
    defined: tuple[Tree, ...] = ()
    at: str | None = None
    is_rate: bool = False


def total_derivative(tree: Tree, names: Sequence[str]) -> Tree:
    """The derivative by time along a motion."""
    return along({name: symbol(name + "dot") for name in names}, tree)


class CheckedRelations:
    """The relations of the scene and of the steps, each step looked at once, and the texts that speak of them."""

    def __init__(self, problem: CheckedProblem, entries: Mapping[str, list[dict[str, Any]]], effort: Effort) -> None:
        self.problem, self.entries, self.effort = problem, entries, effort
        count = 2 * len(problem.coordinates) + len(problem.world.signs) + len(problem.world.generic)
        self.ring = CheckedRing(effort, min(count, MOST_SYMBOLS))
        self.seen, self.variables = dict[Any, Any](), (*problem.coordinates, "t")
        self.velocities = frozenset(name + "dot" for name in self.variables)
        self.chosen = frozenset((*problem.world.signs, *problem.world.generic))
        self.names = self._known_names()
        self.by_name = {relation.name: relation for relation in problem.relations}
        self.finite, self.moving = self.owned(None, ("finite",)), self.owned(None, ("velocity",))
        self.equations = (*self.finite, *self.moving)
        self.timed = self.holds_time(self.equations)
        self.consequences: list[Consequence] = []
        self.faults: dict[str, str] = {}
        self._take_steps()

    def once(self, key: Any, evaluate: Callable[[], Looked]) -> Looked:
        """What was looked at under a key before, or is now."""
        if key not in self.seen:
            self.seen[key] = evaluate()
        return cast(Looked, self.seen[key])

    def text(self, text: Any, extra: Iterable[str] = ()) -> Tree:
        """The tree of a text; ``extra`` are further names it may mention."""
        refuse(not isinstance(text, str) or len(text) > LONGEST_TEXT, "an expression is a text of moderate length")

        def read() -> Tree:
            self.effort.spend(10 * len(text) + 1)
            tree = parse(text, self._known_names(extra) if extra else self.names)
            refuse("dt" in tree.symbols, "an expression holds velocities, and no differentials")
            return tree

        return self.once(("text", text, *extra), read)

    def _known_names(self, extra: Iterable[str] = ()) -> KnownNames:
        values = {name: symbol(name) for name in (*sorted(self.chosen), "tdot", *extra)}
        return KnownNames(frozenset(self.problem.coordinates), values, self.problem.world.names.functions)

    def is_taken(self, name: str) -> bool:
        """Whether a name means something in texts of the scene or of a certificate."""
        return any(names.meaning(name).kind for names in (self.names, self.problem.world.names))

    def identity(self, first: Tree, second: Tree, what: str) -> None:
        """`CheckError` unless two trees are the same in the ring."""
        refuse(not self.ring.vanishes(add(first, -second)), f"{what}: the two sides are not the same")

    def is_open(self, tree: Tree) -> bool:
        """Whether parameters, generic lengths or unknown functions occur, for which a point chooses values.

        A claim is about almost all of them: what holds for the chosen ones has to hold for those near them.
        """
        return not self.chosen.isdisjoint(tree.symbols) or tree.applied

    def met_by(self, tree: Tree) -> list[str]:
        """The velocities that occur."""
        return sorted(self.velocities & tree.symbols)

    def is_nowhere_zero(self, tree: Tree, positive: bool = False) -> bool:
        """Whether a tree is a product of powers of numbers and parameters that are not 0, or are positive."""
        return nowhere_zero(tree, self.problem.world.signs, self.effort, positive)

    def has_value_everywhere(self, tree: Tree, poles: bool = False, point: CheckedPoint | None = None) -> bool:
        """Whether a tree is smooth (analytic, but for declared functions) at all real values of its symbols.

        With ``poles``: whether it is a quotient of such trees. At a ``point``: at all velocities there.
        """
        if tree.symbols.isdisjoint(self.velocities if point else tree.symbols):
            return (point.value(tree) if point else evaluated(tree, {}, self.effort)) is not None
        plain = keeps_values(tree, poles) or (tree.head == "atan2" and self.is_nowhere_zero(tree.below[1], True))
        poles &= tree.head in ("sum", "product", "power")
        return plain and all(self.has_value_everywhere(part, poles, point) for part in tree.below)

    def _take_steps(self) -> None:
        makers = {"rate": self._rate, "implied": self._implied, "integral": self._implied}
        for step in self.entries["relations"]:
            name, by = step["id"], step.get("by")
            try:
                of = self.relation(step["of"]) if "of" in step else None
                wrong = of and (of.kind == "inequality" or (of.leaf and by != "rate"))
                refuse(wrong, "a step is made from an equation, and of an integral there is a rate and no more")
                refuse(name in self.by_name, "a name of this step is taken")
                tree, consequence = makers[step["by"]](step)
                if tree is not None:
                    kind = "velocity" if self.met_by(tree) else "finite"
                    self.by_name[name] = CheckedRelation(name, "", kind, tree, leaf=by == "integral")
                self.consequences += [consequence] if consequence else []
            except FAULTS as error:
                self.faults[name] = f"step `{name[:60]}`: {fault_text(error)}"

    def _implied(self, step: dict[str, Any]) -> tuple[Tree | None, Consequence | None]:
        """h g = sum c_i r_i: g is 0 where all r_i are and h is not; what has the rate g keeps its value.

        ``g`` is a relation, or a new function. Where geometric equations give coordinates, and these are put in, the
        two sides need to be the same only then. Integrals: along every motion near a point where h is not 0. If ``h``
        holds velocities, a velocity relation follows near a state where h is not 0. The rate of time is 1. With
        ``sos``: h g^2 + sum w_j a_j^2 = sum c_i r_i, where h and w are positive, as -c_i are for inequalities r_i >= 0:
        then all terms are 0 (Krivine 1964, Stengle 1974).
        """
        leaf, real = step["by"] == "integral", "sos" in step
        new = leaf or "function" in step
        tree = self.text(step["function"]) if new else self.relation(step["of"]).tree
        sources, substitutions = [self.relation(name) for name in step["c"]], step.get("put", [])
        cofactors, h = [self.text(text) for text in step["c"].values()], self.text(step.get("h", "1"))
        squares = [(self.text(weight), self.text(root)) for weight, root in step.get("sos", [])]
        pairs = list(zip(cofactors, sources, strict=True))
        signs = [-c for c, source in pairs if source.kind == "inequality"] + [weight for weight, _ in squares]
        unfit = any(source.leaf for source in sources) or (signs and not real) or (real and leaf)
        refuse(unfit, "an inequality or integral to start from")
        plus = all(self.is_nowhere_zero(tree, True) for tree in (*signs, *([h] if real else [])))
        refuse(not plus, "no sum of squares, or times what is not positive")
        still = real or not self.met_by(tree)
        refuse((leaf and not still) or (still and self.met_by(h)), "the factor or integral holds velocities")
        change = total_derivative(tree, self.variables) if leaf else tree**2 if real else tree
        total = add(h * change, *(weight * root**2 for weight, root in squares), *(-c * of.tree for c, of in pairs))
        for name, q in substitutions:
            source, (slope, total) = self.relation(name), put_in(total, q, self.relation(name).tree)
            gives = source.kind == "finite" and not source.leaf and self.is_nowhere_zero(slope)
            refuse(not gives, f"`{name}` does not give `{q}`")
        total = substituted(total, {"tdot": self.text("1")})
        refuse(not self.ring.vanishes(total), "the cofactors: the two sides are not the same")
        needs = () if self.is_nowhere_zero(h) else (h,)
        defined = (h, *cofactors, *chain(*squares), *([tree] if new or substitutions or real else []))
        used = *step["c"], *(name for name, _ in substitutions)
        return tree if new else None, Consequence(step["id" if new else "of"], used, needs, defined)

    def _rate(self, step: dict[str, Any]) -> tuple[Tree | None, Consequence | None]:
        """What is constantly 0, or keeps its value, has the derivative 0."""
        of = self.relation(step["of"])
        refuse(of.kind != "finite", "only a holonomic equation has a rate")
        consequence = Consequence(step["id"], (of.name,), defined=(of.tree,), is_rate=True)
        return total_derivative(of.tree, self.variables), consequence

    def owned(self, owner: str | None, kinds: Collection[str] = ("finite", "velocity")) -> tuple[str, ...]:
        """The relations of a constraint, or of all."""
        chosen = (relation for relation in self.problem.relations if relation.kind in kinds)
        return tuple(relation.name for relation in chosen if owner is None or relation.owner == owner)

    def holds_time(self, names: Iterable[str]) -> bool:
        """Whether time or dt occurs in a relation."""
        return any(not {"t", "tdot"}.isdisjoint(self.relation(name).tree.symbols) for name in names)

    def relation(self, name: Any) -> CheckedRelation:
        """A relation by its id."""
        if name not in self.by_name:
            raise CheckError(self.faults.get(str(name).partition(".")[0], f"no relation `{str(name)[:60]}`"))
        return self.by_name[name]

    def closure(self, start: Iterable[str], point: CheckedPoint | None, rates: bool = True) -> set[str]:
        """All that holds near a point (or everywhere) where ``start`` does, by steps; without ``rates``: at a state."""
        implied, size = set(start), -1
        while len(implied) > size:
            size = len(implied)
            for i, consequence in enumerate(self.consequences):
                leads_on = consequence.target not in implied and implied.issuperset(consequence.sources)
                leads_on &= rates or not consequence.is_rate
                if leads_on and self.applies(i, point):
                    implied.add(consequence.target)
            self.effort.spend(len(self.consequences) + 1)
        return implied

    def follow(self, wanted: Iterable[str], start: Iterable[str], point: CheckedPoint | None, what: str) -> None:
        """`CheckError` unless all that is wanted holds near a point where ``start`` does."""
        missing = set(wanted) - set(start)
        missing = missing and missing - self.closure(start, point)
        refuse(missing, f"`{min(missing, default='')}` is not shown to follow from {what}")

    def applies(self, number: int, point: CheckedPoint | None) -> bool:
        """Whether the conditions of a consequence hold near a point, at all velocities; without a point, everywhere."""
        consequence = self.consequences[number]
        if point is None:
            bare = consequence.at is None and not consequence.nonzero
            return bare and all(map(self.has_value_everywhere, consequence.defined))

        def evaluate() -> bool:
            try:
                values = [point.value(tree) for tree in consequence.nonzero]
                smooth = all(self.has_value_everywhere(tree, point=point) for tree in consequence.defined)
            except CheckError:
                return False
            return smooth and consequence.at in (None, point.name) and all(map(not_zero, values))

        return self.once(("met", number, point.name), evaluate)


def fault_text(error: Exception) -> str:
    """A fault in one line."""
    expected = isinstance(error, CheckError)
    return str(error)[:200] if expected else f"a field is missing or of another kind ({error!s:.80})"
