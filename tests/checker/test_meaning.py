"""The checker's reading of every known scene against the engines' own: the same coordinates, counts and sets."""

from __future__ import annotations

import random
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from checker.certified import document_of
from checker.values import of_engine, of_tree, rows_of_engine, rows_of_trees
from shared.known_scenes import SCENES, few, scene_of, stem

from dofkit.checker.problem import CheckedProblem as Problem
from dofkit.checker.problem import canonical, problem_of_canonical
from dofkit.expressions.calculus import in_velocities
from dofkit.expressions.tree import Expr, coordinate, parameter, sym, velocity
from dofkit.scene.lowering import lower
from dofkit.system import Constraint, System

#: Scenes that the checker does not read, and why.
UNREAD: dict[str, str] = {}
#: Types whose relations are a person's own texts: their values are the same, not only their sets.
WRITTEN = ("equation", "on", "cam")


@cache
def system_of(path: Path) -> System:
    return lower(scene_of(path))


@cache
def problem_of(path: Path) -> Problem:
    turning = {rotation.body for rotation in system_of(path).rotations if rotation.chart == "gibbs"}
    return problem_of_canonical(canonical(document_of(path.read_text(encoding="utf-8"))), frozenset(turning))


KNOWN = [path for path in SCENES if path.stem not in UNREAD]
every_scene = pytest.mark.parametrize("path", few("meanings", KNOWN, 12), ids=stem)


def names_by_symbol(system: System, problem: Problem) -> dict[Expr, str]:
    """The checker's name of each symbol of the engines; generic ones are paired in the order of their making."""
    own = dict(zip((q.name for q in system.coordinates), problem.coordinates, strict=True))
    found = {coordinate(q): name for q, name in own.items()}
    found |= {velocity(q): f"{name}dot" for q, name in own.items()}
    found |= {parameter(name): name for name in problem.world.signs}
    found |= {parameter(a): b for a, b in zip(system.generic, problem.world.generic, strict=True)}
    return found | {sym("time", "t"): "t", sym("dt", "dt"): "tdot"}


@every_scene
def test_it_has_the_coordinates_and_the_equations_of_the_scene(path: Path) -> None:
    system, problem = system_of(path), problem_of(path)
    turned = {q for rotation in system.rotations if rotation.chart == "gibbs" for q in rotation.names}
    assert [q.name for q in system.coordinates if q.name not in turned] == [
        q for q in problem.coordinates if q in {one.name for one in system.coordinates}
    ]
    assert len(problem.coordinates) == len(system.coordinates)
    assert dict(problem.world.signs) == dict(system.parameters)
    told = [(c.name, len(c.relations)) for c in system.constraints]
    assert told == [(c.name, sum(r.owner == c.name for r in problem.relations)) for c in system.constraints]
    assert len(problem.world.generic) == len(system.generic)


@every_scene
def test_the_drawing_is_the_reference_and_meets_every_finite_relation(path: Path) -> None:
    system, problem = system_of(path), problem_of(path)
    if system.reference is None:
        special = any("special values" in warning for warning in system.warnings)
        assert special or not problem.reference
        return
    names = names_by_symbol(system, problem)
    fixed = parameters_of(problem, random.Random(path.stem))
    theirs = {
        names[q]: of_engine(value, {("parameter", n): v for n, v in fixed.items()})
        for q, value in system.reference.items()
    }
    ours = {q: of_tree(value, fixed) for q, value in problem.reference.items()}
    assert ours == pytest.approx(theirs)
    drawn = {c.name for c in system.constraints if c.type not in ("equation", "on")}
    for relation in problem.relations:
        if relation.kind == "finite" and relation.owner in drawn and not system.tolerance:
            assert of_tree(relation.tree, {**fixed, **ours, "t": 0.0}) == pytest.approx(0, abs=1e-9), relation.name


def parameters_of(problem: Problem, rng: random.Random) -> dict[str, float]:
    return {name: rng.uniform(0.5, 1.5) for name in problem.world.signs}


class Compared:
    """One constraint in both readings, at points with random values."""

    def __init__(self, path: Path, constraint: Constraint) -> None:
        system, problem = system_of(path), problem_of(path)
        self.names = names_by_symbol(system, problem)
        self.theirs = [(in_velocities(relation.expr)[0], relation.sense) for relation in constraint.relations]
        self.ours = [relation for relation in problem.relations if relation.owner == constraint.name]
        self.rng = random.Random(f"{path.stem} {constraint.name}")
        mentioned = frozenset().union(*(relation.tree.symbols for relation in self.ours))
        used = {s for e, _ in self.theirs for s in e.symbols} | {s for s, n in self.names.items() if n in mentioned}
        used -= {sym("dt", "dt")}
        self.columns = sorted(used, key=lambda s: s.args)
        start = {**system.pose, **(system.reference or {})}
        self.start = {q: value for q, value in start.items() if q in used}

    def drawn(self, spread: float) -> dict[Expr, float]:
        """Random values near the drawing, where one is known."""
        found = {}
        for symbol in self.columns:
            near = self.start.get(symbol)
            centre = 0.8 if near is None or near.symbols else of_engine(near, {})
            found[symbol] = centre + spread * self.rng.uniform(-1, 1)
        return found

    def of_theirs(self, values: Mapping[Expr, float]) -> list[float]:
        return [of_engine(e, by_args(values)) for e, _ in self.theirs]

    def of_ours(self, values: Mapping[Expr, float]) -> list[float]:
        return [of_tree(relation.tree, self.by_name(values)) for relation in self.ours]

    def by_name(self, values: Mapping[Expr, float]) -> dict[str, float]:
        return {**{self.names[s]: v for s, v in values.items()}, "tdot": 1.0}

    def rows(self, values: Mapping[Expr, float]) -> tuple[np.ndarray[Any, Any], np.ndarray[Any, Any]]:
        theirs = rows_of_engine([e for e, _ in self.theirs], self.columns, by_args(values))
        columns = [self.names[s] for s in self.columns]
        return theirs, rows_of_trees([r.tree for r in self.ours], columns, self.by_name(values))

    def solved(self, values: dict[Expr, float]) -> dict[Expr, float] | None:
        """A point of the engines' set near a point, by Newton's method."""
        for _ in range(40):
            found = np.array(self.of_theirs(values))
            if np.abs(found).max() < 1e-12:
                return values
            rows = rows_of_engine([e for e, _ in self.theirs], self.columns, by_args(values))
            step = np.linalg.lstsq(rows, -found, rcond=1e-10)[0]
            values = {s: v + float(d) for (s, v), d in zip(values.items(), step, strict=True)}
        return None


def by_args(values: Mapping[Expr, float]) -> dict[Any, float]:
    return {symbol.args: value for symbol, value in values.items()}


def same_values(case: Compared) -> bool:
    """Relations that are texts are the same functions, at three points where they have values."""
    met = 0
    for attempt in range(60):
        values = case.drawn(0.3 if attempt < 40 else 2.0)
        try:
            theirs = case.of_theirs(values)
        except (ValueError, ZeroDivisionError, OverflowError):
            continue
        assert case.of_ours(values) == pytest.approx(theirs, rel=1e-7, abs=1e-9)
        met += 1
        if met == 3:
            return True
    return False


def same_sets(case: Compared) -> bool:
    """Relations of geometry have the same zeros near the drawing, and there the same tangents."""
    for attempt in range(8):
        values = case.solved(case.drawn(0.2 / (1 + attempt)))
        if values is None:
            continue
        assert case.of_ours(values) == pytest.approx([0.0] * len(case.ours), abs=1e-8)
        theirs, ours = case.rows(values)
        ranks = [np.linalg.matrix_rank(rows, tol=1e-7) for rows in (theirs, ours, np.vstack([theirs, ours]))]
        assert len(set(ranks)) == 1, ranks
        return True
    return False


@every_scene
def test_every_constraint_says_the_same_as_the_engines_think(path: Path) -> None:
    """But for couplings: what they count is an angle of a joint only where that joint holds (test_couplings.py)."""
    missed = []
    for constraint in system_of(path).constraints:
        if constraint.type == "coupling":
            continue
        case = Compared(path, constraint)
        senses = [("=" if r.kind != "inequality" else ">" if r.strict else ">=") for r in case.ours]
        assert senses == [sense for _, sense in case.theirs]
        if not (same_values(case) if constraint.type in WRITTEN else same_sets(case)):
            missed.append(constraint.name)
    assert missed == NOT_MET.get(path.stem, [])


#: Constraints of which no point was found, by scene.
NOT_MET: dict[str, list[str]] = {}
