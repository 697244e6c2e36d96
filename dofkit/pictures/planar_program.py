"""A planar scene as a program for the player: the poses as functions of the coordinates, and their relations."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

from dofkit.expressions.tree import TIME, ZERO, Expr, coordinate
from dofkit.pictures.arrangement import geometric_equations
from dofkit.pictures.evaluation import evaluated
from dofkit.pictures.stage import StagedScene
from dofkit.system import GROUND

#: The functions that the player implements.
_FUNCTIONS = ("sin", "cos", "tan", "exp", "log", "abs")


class UnknownStepError(ValueError):
    """An expression contains a function that the player does not implement."""


class PlanarProgram(NamedTuple):
    """Expressions over some columns: coordinates with their scales, then time if it occurs.

    ``poses``: {carrier: (shift x, shift y), and (cosine, sine) of its angle if it rotates}; ``relations``: (constraint,
    expression = 0); ``limits``: expressions >= 0. ``can_drag``: whether these are all relations, so that points can be
    dragged.
    """

    columns: tuple[Expr, ...]
    scales: tuple[float, ...]
    numbers: Mapping[Expr, float]
    poses: Mapping[str, tuple[Expr, ...]]
    relations: tuple[tuple[str, Expr], ...]
    limits: tuple[Expr, ...]
    can_drag: bool

    def data(self, carriers: Sequence[str]) -> dict[str, Any]:
        """Return the program as JSON: steps, each a number or an operation with the numbers of earlier steps."""
        steps = _Steps(self.columns, self.numbers)
        dragged = {
            "relations": [[name, steps.number_of(e)] for name, e in self.relations],
            "limits": [steps.number_of(e) for e in self.limits],
        }
        return {
            "moves": [any(e.symbols & set(self.columns) for e in self.poses.get(c, ())) for c in carriers],
            "poses": [[steps.number_of(e) for e in self.poses.get(c, (ZERO, ZERO))] for c in carriers],
            "scales": self.scales,
            "start": self.values(self.numbers),
            "drag": self.can_drag,
            **(dragged if self.can_drag else {"relations": [], "limits": []}),
            "steps": steps.steps,
        }

    def values(self, numbers: Mapping[Expr, float]) -> list[float]:
        """Return the values of the columns, rounded."""
        return [round(float(numbers.get(column, 0.0)), 9) for column in self.columns]


class _Steps:
    """Collects expressions as steps of a program, each node once."""

    def __init__(self, columns: Sequence[Expr], numbers: Mapping[Expr, float]) -> None:
        self.columns, self.numbers = {column: k for k, column in enumerate(columns)}, numbers
        self.steps: list[Any] = []
        self.written: dict[Expr, int] = {}

    def number_of(self, e: Expr) -> int:
        """Return the number of the step that computes an expression. Raises UnknownStepError."""
        if e not in self.written:
            step = self._step(e)
            self.written[e] = len(self.steps)
            self.steps.append(step)
        return self.written[e]

    def _step(self, e: Expr) -> Any:
        """Return a step: a number, ["q", column], or [operation, numbers of steps]. Raises UnknownStepError."""
        if e in self.columns:
            return ["q", self.columns[e]]
        if "call" in e.functions:
            raise UnknownStepError(str(e))
        if not e.symbols & self.columns.keys():
            return float(evaluated(e, self.numbers))
        if e.op in ("add", "mul"):
            return [e.op, *map(self.number_of, e.args)]
        if e.op == "pow" and not e.args[1].symbols:
            return ["pow", self.number_of(e.args[0]), float(evaluated(e.args[1], {}))]
        if e.op == "fn" and e.args[0] in _FUNCTIONS:
            return [e.args[0], self.number_of(e.args[1])]
        raise UnknownStepError(str(e))


def planar_program(stage: StagedScene, dimension: int) -> PlanarProgram | None:
    """Return the program of a planar picture; None in space, or if the player cannot run it."""
    if dimension > 2 or (stage.system.dimension > 2 and stage.system.bodies):
        return None
    system = stage.system
    finite = set(geometric_equations(system))
    equations = [(c.name, r.expr) for c in system.constraints for r in c.relations if r.sense == "="]
    columns = [*(coordinate(c.name) for c in system.coordinates), TIME]
    program = PlanarProgram(
        columns=tuple(columns),
        scales=(*(system.size if c.role in ("x", "y", "z") else 1.0 for c in system.coordinates), 0.0),
        numbers=stage.arrangement.numbers,
        poses={GROUND: (ZERO, ZERO), **{name: p.planar() for name, p in stage.arrangement.placements.items()}},
        relations=tuple((name, e) for name, e in equations if e in finite),
        limits=tuple(geometric_equations(system, (">=", ">"))),
        can_drag=bool(stage.motions) and all(e in finite for _, e in equations),
    )
    try:
        program.data(list(program.poses))
    except UnknownStepError:
        return None
    return program
