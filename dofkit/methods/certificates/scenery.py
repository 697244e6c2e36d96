"""The checker's reading of a scene, with choices for what it does not determine, and its trees as texts."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from contextlib import suppress
from fractions import Fraction
from functools import cached_property
from itertools import combinations
from typing import Any

from dofkit.checker.evidence import CheckedEvidence
from dofkit.checker.problem import CheckedProblem as Problem
from dofkit.checker.ring import CheckedRing, Quotient
from dofkit.checker.trees import (
    HALF,
    ZERO,
    CheckError,
    Effort,
    Tree,
    derivative,
    in_velocities,
    number,
    operands,
    power,
    put_in,
    refuse,
    substituted,
    symbol,
    times,
)
from dofkit.exact.ring.quotients import bounded
from dofkit.methods.certificates.numerics import Estimates, NoEstimateError


def number_text(value: Fraction | int) -> str:
    """A rational number."""
    return str(Fraction(value))


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


def exponentials(tree: Tree) -> list[str]:
    """The texts of all exponentials in a tree, in order."""
    below = set[str]().union(*map(exponentials, tree.below))
    return sorted(below | {text_of(tree)} if tree.head == "exp" else below)


def _factor(tree: Tree) -> str:
    text = text_of(tree)
    return f"({text})" if "/" in text or tree.head == "product" else text


def _applied(tree: Tree) -> str:
    """A declared function, or its derivative by its arguments; of several each is a symbol of its own then."""
    names, several = [*map(text_of, tree.below)], len(tree.orders) > 1
    if several and any(tree.orders) and len({part for part in tree.below if part.head == "symbol"}) < len(names):
        raise CheckError("a partial derivative of a declared function has no text")
    primes = "" if several else "'" * tree.orders[0]
    text = f"{tree.value}{primes}({', '.join(names)})"
    for name, order in zip(names, tree.orders, strict=True) if several else ():
        text = "diff(" * order + text + f", {name})" * order
    return text


# The checker's reading of a scene, with choices made for what it does not determine.

EVEN = range(2, 20, 2)
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
        self.steps: set[str] = set()
        #: Steps that rest on several constraints, and the relations that these are.
        self.shared: dict[str, tuple[str, ...]] = {}

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
        functions = self.problem.world.names.functions.items()
        return {name: _polynomial(len(arguments), i) for i, (name, arguments) in enumerate(functions)}

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

    @cached_property
    def finite(self) -> tuple[str, ...]:
        """The geometric equations, each after the roots of which it is a sum of squares, and what forms hide."""
        return (*self.owned(None, ("finite",)), *self.hidden)

    @cached_property
    def hidden(self) -> tuple[str, ...]:
        """The steps for what two forms leave that differ by a factor but in what stands with dt."""
        return tuple(hidden(self))

    @cached_property
    def moving(self) -> tuple[str, ...]:
        """The velocity relations in the same way."""
        return self.owned(None, ("velocity",))

    @property
    def equations(self) -> tuple[str, ...]:
        """All geometric equations, then those of velocities, the linear ones first."""
        return (*self.finite, *sorted(self.moving, key=lambda name: not self.linear(name)))

    def owned(self, owner: str | None, kinds: Collection[str] = ("finite", "velocity")) -> tuple[str, ...]:
        """The equations of a constraint, or of all, each after its roots."""
        names = self.evidence.owned(owner, kinds)
        return tuple(part for name in names for part in (*self.roots(name), name))

    def roots(self, name: str) -> tuple[str, ...]:
        """The steps for the roots of a sum of squares, which are 0 where it is; none of another relation."""
        return self.evidence.once(("roots", name), lambda: (*self._roots(name),) or (*branches(self, name),))

    def _roots(self, name: str) -> Iterator[str]:
        for sign, others, squares in squares_of(self.evidence.relation(name).tree, frozenset()):
            ids = {f"{self.label}root {i} of {name}": square for i, square in enumerate(squares) if not others}
            with suppress(CheckError):
                for step, (weight, root) in ids.items():
                    more = [square for other, square in ids.items() if other != step]
                    of_root = {"function": root, "h": weight, "sos": more, "c": {name: str(sign)}}
                    self.add_step({"id": step, "by": "implied", **of_root})
                    yield step
                back = {step: f"({sign})*({weight})*({root})" for step, (weight, root) in ids.items()}
                if back:
                    self.add_step({"id": f"{self.label}{name} from others", "by": "implied", "of": name, "c": back})

    def linear(self, name: str) -> bool:
        """Whether a relation is a linear form in the velocities; False where that is not known."""
        try:
            return self.evidence.is_linear(name)
        except CheckError:
            return False

    def form(self, name: str) -> dict[str, Tree]:
        """The components of a relation that is a linear form; nothing of another."""
        is_form = self.evidence.relation(name).kind == "velocity" and self.linear(name)
        return {v: self.evidence.slope(name, v) for v in self.evidence.variables} if is_form else {}

    def tree(self, name: str) -> Tree:
        """A relation's left side with the functions chosen."""
        return self.evidence.once(("chosen", name), lambda: self.chosen(self.evidence.relation(name).tree))

    def chosen(self, tree: Tree) -> Tree:
        """Return the tree with each unknown function replaced by the one chosen for the certificate."""
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


def hidden(scenery: Scenery) -> Iterator[str]:
    """Steps for what two forms leave that differ by a factor but in what stands with dt."""
    ring = scenery.evidence.ring
    for first, other in combinations(filter(scenery.linear, scenery.evidence.moving), 2):
        form, second = scenery.form(first), scenery.form(other)
        ratios = (ring.rational(form[q] / second[q]) for q in second if q != "t" and second[q] != ZERO)
        ratio = next((ratio for ratio in ratios if ratio), None)
        difference = {q: form[q] - number(Fraction(str(ratio or 0))) * second[q] for q in form}
        if ratio is not None and all(ring.vanishes(tree) == (q != "t") for q, tree in difference.items()):
            step, c = f"{scenery.label}hidden by {first} and {other}", {first: "1", other: f"{-ratio}"}
            scenery.add_step({"id": step, "by": "implied", "function": text_of(difference["t"]), "c": c})
            back = {"id": f"{scenery.label}{other} from others", "by": "implied", "of": other, "h": f"{ratio}"}
            scenery.add_step({**back, "c": {first: "1", step: "-1"}})
            scenery.shared[step] = first, other
            yield step


def branches(scenery: Scenery, name: str) -> Iterator[str]:
    """Steps for a relation that is not linear in velocities: it is implied by forms, or is a factor near a state.

    The factor is the longest of what is left where forms are put in.
    """
    if scenery.linear(name) or scenery.evidence.relation(name).kind != "velocity":
        return
    with suppress(CheckError):
        tree, c = with_forms(scenery, name)
        ring, back = scenery.evidence.ring, {"id": f"{scenery.label}{name} from others", "by": "implied", "of": name}
        above, below = ring.read(tree)
        if above == 0:
            scenery.add_step({**back, "c": {source: text_of(factor) for source, factor in c.items()}})
            return
        refuse(not bounded(above), "a polynomial too large to be factored")
        constant, factors = above.factor()
        texts = [polynomial_text(ring, factor) for factor, often in factors for _ in range(often)]
        branch, step = max(texts, key=len), f"{scenery.label}branch of {name}"
        texts.remove(branch)
        if scenery.evidence.met_by(scenery.evidence.text("*".join(f"({text})" for text in ("1", *texts)))):
            others = "*".join(f"({text})" for text in (f"{constant}", *texts))
            others += f"/({polynomial_text(ring, below)})"
            less = {source: f"-({text_of(factor)})" for source, factor in c.items()}
            form = text_of(in_velocities(scenery.evidence.text(branch), scenery.problem.coordinates))
            scenery.add_step({"id": step, "by": "implied", "function": form, "h": others, "c": {name: "1", **less}})
            scenery.add_step({**back, "c": {step: others, **{source: text_of(f) for source, f in c.items()}}})
            of_rates = f"{scenery.label}rate of "
            scenery.shared |= {step: (name, *(source.removeprefix(of_rates) for source in c))} if c else {}
            yield step


def with_forms(scenery: Scenery, name: str) -> tuple[Tree, dict[str, Tree]]:
    """What is left of a relation where others give velocities that no further one holds, and their cofactors."""
    tree, c = scenery.evidence.relation(name).tree, dict[str, Tree]()
    rates = [f"{scenery.label}rate of {finite}" for finite in scenery.evidence.finite]
    for step, finite in zip(rates, scenery.evidence.finite, strict=True):
        if step not in scenery.steps:
            scenery.add_step({"id": step, "by": "rate", "of": finite})
    forms = {source: scenery.evidence.relation(source).tree for source in (*rates, *scenery.evidence.moving)}
    for source in filter(scenery.linear, forms):
        others = frozenset().union(*(form.symbols for other, form in forms.items() if other not in (source, name)))
        velocity = max(scenery.evidence.velocities & forms[source].symbols - others - {"tdot"}, default="")
        first = derivative(tree, velocity)
        if velocity and velocity not in derivative(derivative(first, velocity), velocity).symbols:
            slope, value = put_in(symbol(velocity), velocity, forms[source])
            curve = HALF * derivative(first, velocity) * forms[source] / slope
            c[source] = (substituted(first, {velocity: value}) + curve) / slope
            tree = substituted(tree, {velocity: value})
    return tree, c


def squares_of(tree: Tree, plain: frozenset[str]) -> Iterator[tuple[int, list[Tree], list[list[str]]]]:
    """Yield a sign by which a tree is a sum of terms in ``plain`` symbols and of squares: a coefficient and a root."""
    *factors, whole = operands(tree, "product")
    for sign in (1, -1):
        terms = [times(number(sign), *factors, term) for term in operands(whole, "sum")]
        others = [term for term in terms if term.symbols <= plain]
        squares = [square for term in terms if term not in others and (square := _square(term))]
        if len(others) + len(squares) == len(terms):
            yield sign, others, squares


def polynomial_text(ring: CheckedRing, polynomial: Any) -> str:
    """Return a polynomial in symbols, sines and cosines as a text; `CheckError` where it contains anything else."""
    return _terms_text(ring, ring.key(Quotient(polynomial, ring.unit))[0])


def _terms_text(ring: CheckedRing, terms: Any) -> str:
    keys, last = {place: key for key, place in ring.places.items()}, len(ring.generators) - 1
    written = []
    for powers, p, q in terms:
        factors = [f"({p})/({q})"]
        for index, often in powers:
            head, what, *orders = keys[last - index]
            refuse(head not in ("symbol", "pi", "sin", "cos"), "a function has no text")
            if head in ("sin", "cos"):
                above, below = (_terms_text(ring, part) for part in what)
                what = f"{head}(({above})/(({below})*{orders[0]}))"
            factors.append(f"({what or 'pi'})^{often}")
        written.append("*".join(factors))
    return " + ".join(written) or "0"


def _square(term: Tree) -> list[str] | None:
    """A coefficient, and the root of what it is multiplied with; None where that is no product of even powers."""
    factors = operands(term, "product")
    powers = [factor for factor in factors if factor.symbols]
    if any(factor.head != "power" or factor.below[1].value not in EVEN for factor in powers):
        return None
    roots = [power(factor.below[0], factor.below[1] * HALF) for factor in powers]
    return [text_of(times(*(factor for factor in factors if not factor.symbols))), text_of(times(*roots))]


def _polynomial(count: int, place: int) -> dict[str, Any]:
    names = [f"a{i}" for i in range(count)]
    terms = [f"{i + 2 + place}*{name}" for i, name in enumerate(names)]
    terms += [f"{name}^2/{7 + i}" for i, name in enumerate(names)]
    terms += [f"{a}*{b}/{3 + i + j}" for i, a in enumerate(names) for j, b in enumerate(names) if i < j]
    return {"arguments": names, "text": " + ".join(terms)}


def floats_of(values: Mapping[str, Fraction]) -> dict[str, float]:
    """Values in floats."""
    return {name: float(value) for name, value in values.items()}
