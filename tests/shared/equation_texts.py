"""Scenes of coordinates whose equations are any texts of the grammar: functions within functions, without a meaning."""

from __future__ import annotations

from typing import Any

from hypothesis import strategies as st

FUNCTIONS = (
    "sin", "cos", "tan", "cot", "sec", "csc", "asin", "acos", "atan", "sinh", "cosh", "tanh", "exp", "log",
    "sqrt", "abs",
)  # fmt: skip
COORDINATES = ("s", "x", "y")
RELATIONS = (" = ", " = ", " = ", " = ", " <= ", " < ", " >= ")
LEAVES = (*COORDINATES, *COORDINATES, "t", "a", "m", "0", "1", "2", "-1", "1/2", "0.3", "pi", "E")
#: Each is filled with the texts of two expressions.
APPLICATIONS = (
    "g({0})", "h({0}, {1})", "diff(g({0}), s)", "g'(s)", "atan2({0}, {1})", "({0})^2", "({0})^3",
    "({0})^(1/3)", "({0})^({1})",
    *(f"{name}({{0}})" for name in FUNCTIONS),
)  # fmt: skip
COMBINATIONS = ("({0} + {1})", "({0} - {1})", "({0})*({1})", "({0})/({1})")


def _composed(parts: st.SearchStrategy[str]) -> st.SearchStrategy[str]:
    forms = st.one_of(st.sampled_from(APPLICATIONS), st.sampled_from(COMBINATIONS))
    return st.builds(lambda form, one, other: form.format(one, other), forms, parts, parts)


EXPRESSIONS = st.recursive(st.sampled_from(LEAVES), _composed, max_leaves=5)


@st.composite
def equations(draw: st.DrawFn) -> str:
    """Return the text of a finite equation, a form, an equation of velocities, or an inequality."""
    kind = draw(st.sampled_from(("finite", "finite", "finite", "form", "velocity", "any velocity")))
    if kind == "finite":
        return draw(EXPRESSIONS) + draw(st.sampled_from(RELATIONS)) + draw(EXPRESSIONS)
    names = draw(st.lists(st.sampled_from((*COORDINATES, "t")), min_size=1, max_size=3, unique=True))
    if kind == "form":
        return " + ".join(f"({draw(EXPRESSIONS)}) d{name}" for name in names) + " = 0"
    moving = [f"{name}dot" for name in names if name != "t"]
    right = draw(EXPRESSIONS)
    if kind == "velocity":
        return " + ".join(f"({draw(EXPRESSIONS)})*{velocity}" for velocity in moving or ["xdot"]) + f" = {right}"
    form = draw(st.sampled_from((*APPLICATIONS, *COMBINATIONS)))
    return form.format((moving or ["xdot"])[0], draw(EXPRESSIONS)) + f" = {right}"


@st.composite
def scenes(draw: st.DrawFn) -> dict[str, Any]:
    """Return a scene with up to three equations, and a reference configuration or none."""
    texts = draw(st.lists(equations(), min_size=1, max_size=3))
    scene = {
        "coordinates": [*COORDINATES],
        "parameters": {"a": "positive", "m": "real"},
        "functions": {"g": ["s"], "h": ["s", "t"]},
        "constraints": texts,
    }
    values = st.sampled_from(["0", "1", "pi/2", "-1/2"])
    if draw(st.integers(0, 4)) == 0:
        scene["configuration"] = {name: draw(values) for name in COORDINATES}
    return scene
