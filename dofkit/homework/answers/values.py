"""Values of notebooks as answers: numbers, arrays, sets, and the numbers, expressions and equations of SymPy.

Neither NumPy nor SymPy is imported: an object says itself where its class comes from.
"""

from __future__ import annotations

from typing import Any

#: What a relation of SymPy is written with.
_SIGNS = {"==": "=", "<": "<", "<=": "<=", ">": ">", ">=": ">="}
_LISTS = frozenset({"FiniteSet", "Tuple", "MatrixBase", "NDimArray"})
#: Larger arrays are no answer.
MOST_ENTRIES = 1000


def plain_value(answer: Any) -> Any:
    """An object of a notebook as a number, a text or a list, of Python's own classes; anything else as it is.

    >>> plain_value({2, 1})
    [1, 2]
    """
    if isinstance(answer, str):
        return str.__str__(answer)
    if isinstance(answer, set | frozenset):
        return sorted(answer, key=str) if len(answer) <= MOST_ENTRIES else answer
    homes = [((cls.__module__ or "").partition(".")[0], cls.__name__) for cls in type(answer).__mro__]
    if any(home == "numpy" for home, _ in homes) and getattr(answer, "size", MOST_ENTRIES + 1) <= MOST_ENTRIES:
        return answer.tolist()
    if homes[0][0] == "sympy":
        return _of_sympy(answer, {name for _, name in homes})
    if isinstance(answer, float):
        return float.__pos__(answer)
    if isinstance(answer, int) and not isinstance(answer, bool):
        return int.__pos__(answer)
    return answer


def _of_sympy(answer: Any, names: set[str]) -> Any:
    if "Integer" in names:
        return int(answer)
    if "Relational" in names:
        return f"{answer.lhs} {_SIGNS.get(answer.rel_op, answer.rel_op)} {answer.rhs}"
    if names & _LISTS:
        parts = list(answer) if "MatrixBase" in names or "NDimArray" in names else list(answer.args)
        return parts if len(parts) <= MOST_ENTRIES else str(type(answer))
    return str(answer)
