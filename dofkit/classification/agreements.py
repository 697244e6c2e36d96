"""What fields of one report must agree: a table of laws, each held against the report before it leaves.

Two fields are worked out on different ways: a freedom by points, an equation's independence by what it follows from.
Where a law does not hold, one of them is wrong and nobody knows which: none of them is told, a warning says so, and the
defect is logged.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from dofkit.base.verdicts import OPEN
from dofkit.relations.answer import DEFECTS
from dofkit.report import ConstraintEntry, FieldVerdict, Redundancy

#: The names under which the laws speak of a field of every entry.
ENTRY = "constraints."
INDEPENDENT, CIRCUIT, NAMED = f"{ENTRY}independent", f"{ENTRY}circuit", f"{ENTRY}redundant_equations"
#: Fields that are empty where they are not told.
LISTS = ("redundancies", "conflicting")
UNDECIDED = FieldVerdict.of(OPEN)
CONTRADICTION = "These fields are withheld because they contradict each other ({law}): {fields}."

Values = Mapping[str, Any]


@dataclass(frozen=True)
class Agreement:
    """A law in words, the fields of which it speaks, and whether it holds; None where it does not apply."""

    law: str
    fields: tuple[str, ...]
    holds: Callable[[Values], bool | None]


def _numbers(told: Values, *fields: str) -> list[Any] | None:
    """The values of some fields; None where one is not known."""
    found = [told.get(f) for f in fields]
    return None if any(v is None for v in found) else found


def _compared(*fields: str, by: Callable[..., bool]) -> Callable[[Values], bool | None]:
    """A law between fields that are known."""

    def holds(told: Values) -> bool | None:
        found = _numbers(told, *fields)
        return None if found is None else by(*found)

    return holds


def _bilateral(told: Values) -> Sequence[ConstraintEntry]:
    return [e for e in told["constraints"] if e.bilateral]


def _dependent_equations(told: Values) -> int | None:
    """Equations less those that are independent, of what is consistent; None where one of the numbers is not known."""
    if told.get("consistent") is not True or told.get("redundant") is None:
        return None
    found = [None if e.independent is None else e.equations - e.independent for e in _bilateral(told)]
    return None if None in found else sum(k or 0 for k in found)


def _nullity(groups: Sequence[Redundancy]) -> int:
    return sum(g.nullity for g in groups)


def _too_many(told: Values) -> bool | None:
    """By the freedom."""
    numbers = _numbers(told, "redundant_equations", "velocity_dof")
    if numbers is None:
        return None
    equations = sum(e.equations for e in told["constraints"])
    return bool(numbers[0] == max(0, equations - (told["count"].coordinates - numbers[1])))


def _as_many_dependent(told: Values) -> bool | None:
    """An equation that says several things takes more freedom away than one: then more equations follow."""
    dependent, many = _dependent_equations(told), told.get("redundant_equations")
    return None if dependent is None or many is None else dependent >= many


def _in_groups(told: Values) -> bool | None:
    """Where the drawing is not singular; they may hold more, as finite relations are counted before forms."""
    dependent = _dependent_equations(told)
    return None if dependent is None or told.get("singular") else _nullity(told["redundancies"]) >= dependent


def _groups_for_all(told: Values) -> bool | None:
    many = told.get("redundant_equations")
    return None if many is None or _dependent_equations(told) is None else _nullity(told["redundancies"]) >= many


def _within_groups(told: Values) -> bool | None:
    members = {name for g in told["redundancies"] for name in g.members}
    redundant = told.get("redundant")
    if redundant is None:
        return None
    known = {*redundant}
    gone = sum(e.equations for e in told["constraints"] if e.name in known)
    return members >= known and gone <= _nullity(told["redundancies"])


def _circuits(told: Values) -> bool | None:
    redundant = told.get("redundant")
    if redundant is None:
        return None
    seen, known = set[str](), {*redundant}
    for e in told["constraints"]:
        if e.circuit is not None and (e.name not in known or not seen >= {*e.circuit}):
            return False
        seen.add(e.name)
    return True


def _named_equations(told: Values) -> bool:
    pairs = [(e.redundant_equations, e.independent, e.equations) for e in told["constraints"]]
    return all(a is None or b is None or len(a) == n - b for a, b, n in pairs)


def _growth(told: Values) -> bool | None:
    """The first number counts velocities, the last one the freedom; both count time where it enters."""
    found = _numbers(told, "growth_vector", "dof", "velocity_dof")
    if found is None:
        return None
    growth, dof, velocities = found
    return growth == sorted(growth) and growth[0] - velocities == growth[-1] - dof and growth[0] - velocities in (0, 1)


def _of_all(field: str) -> Callable[[Values], bool | None]:
    """A label of the whole is true where every entry's is, and false where one is not."""

    def holds(told: Values) -> bool:
        labels = [getattr(e, field) for e in told["constraints"]]
        return bool(told.get(field) is (False if False in labels else None if None in labels else True))

    return holds


def _nothing_moves(told: Values) -> bool | None:
    return told.get("dof") is None and told.get("velocity_dof") is None if told.get("consistent") is False else None


def _conflicting(told: Values) -> bool | None:
    return told.get("consistent") is False if told.get("conflicting") else None


def _open(told: Values) -> bool | None:
    """What is not known makes the whole undecided."""
    left = any(told.get(f) is None for f in ("dof", "velocity_dof", "redundant"))
    return told["verdict"] == "undecided" if left and told.get("consistent") is not False else None


AGREEMENTS: tuple[Agreement, ...] = (
    Agreement(
        "the velocity freedom does not exceed the degrees of freedom",
        ("dof", "velocity_dof"),
        _compared("dof", "velocity_dof", by=lambda f, v: v <= f),
    ),
    Agreement(
        "the degrees of freedom do not exceed the number of coordinates",
        ("dof",),
        _compared("dof", "count", by=lambda f, c: 0 <= f <= c.coordinates),
    ),
    Agreement(
        "the velocity freedom does not exceed the instantaneous freedom",
        ("velocity_dof", "instantaneous_dof"),
        _compared("velocity_dof", "instantaneous_dof", by=lambda v, i: v <= i),
    ),
    Agreement(
        "a configuration is singular where the instantaneous freedom differs from the velocity freedom",
        ("singular", "instantaneous_dof"),
        _compared("singular", "velocity_dof", "instantaneous_dof", by=lambda s, v, i: s is (v != i)),
    ),
    Agreement(
        "the redundant equations are the equations minus (coordinates minus velocity freedom)",
        ("redundant_equations", "velocity_dof"),
        _too_many,
    ),
    Agreement(
        "the number of implied equations is the number of redundant equations",
        ("redundant_equations", INDEPENDENT, "redundant"),
        _as_many_dependent,
    ),
    Agreement(
        "the nullities of the groups add up to the number of redundant equations",
        ("redundant_equations", "redundancies", "redundant"),
        _groups_for_all,
    ),
    Agreement("the groups contain the implied equations", ("redundancies", INDEPENDENT, "redundant"), _in_groups),
    Agreement("a redundant constraint belongs to a group", ("redundant", "redundancies"), _within_groups),
    Agreement(
        "a circuit belongs to a redundant constraint and consists of constraints written before it",
        ("redundant", CIRCUIT),
        _circuits,
    ),
    Agreement(
        "the number of named equations is the number of implied equations", (INDEPENDENT, NAMED), _named_equations
    ),
    Agreement(
        "the number of generalized coordinates is the number of degrees of freedom",
        ("generalized_coordinates", "dof"),
        _compared("generalized_coordinates", "dof", by=lambda q, f: len(q) == f),
    ),
    Agreement(
        "the growth vector begins with the velocity freedom and ends with the degrees of freedom",
        ("growth_vector",),
        _growth,
    ),
    Agreement("the system is holonomic if and only if all constraints are", ("holonomic",), _of_all("holonomic")),
    Agreement("the system is scleronomic if and only if all constraints are", ("scleronomic",), _of_all("scleronomic")),
    Agreement(
        "a holonomic system has as many independent velocities as degrees of freedom",
        ("holonomic", "velocity_dof", "dof"),
        _compared("holonomic", "velocity_dof", "dof", by=lambda h, v, f: not h or v == f),
    ),
    Agreement(
        "an inconsistent system has no degrees of freedom", ("dof", "velocity_dof", "consistent"), _nothing_moves
    ),
    Agreement("a system with conflicting constraints is inconsistent", ("consistent", "conflicting"), _conflicting),
    Agreement("an undecided field makes the report undecided", (), _open),
)


def agreed(told: Values) -> dict[str, Any]:
    """The fields of a report, without those that contradict each other."""
    broken = [row for row in AGREEMENTS if row.holds(told) is False]
    found = dict(told)
    for row in broken:
        names = ", ".join(row.fields) or "verdict"
        DEFECTS.error("defect in the report of %r: not true that %s (%s)", told.get("scene"), row.law, names)
        found = _without(found, row)
    return found


def _without(told: dict[str, Any], row: Agreement) -> dict[str, Any]:
    """What is told without the fields of a law that does not hold."""
    names = {f.removeprefix(ENTRY) for f in row.fields if f.startswith(ENTRY)}
    open_: dict[str, Any] = {f: [] if f in LISTS else None for f in row.fields if not f.startswith(ENTRY)}
    warnings = [*told["warnings"], CONTRADICTION.format(law=row.law, fields=", ".join(row.fields))]
    entries = told["constraints"]
    if names:
        entries = [_open_entry(e, names) for e in entries]
    sure = {f: UNDECIDED for f in open_ if f in told["verdicts"]}
    verdicts = {**told["verdicts"], **(sure or {"consistent": UNDECIDED})}
    changed = {"constraints": entries, "warnings": warnings, "verdict": "undecided", "verdicts": verdicts}
    return {**told, **open_, **changed}


def _open_entry(e: ConstraintEntry, names: Collection[str]) -> ConstraintEntry:
    """An entry without some labels."""
    verdicts = {**e.verdicts, **{name: UNDECIDED for name in names if name in e.verdicts}}
    return e.model_copy(update={**dict.fromkeys(names), "verdict": "undecided", "verdicts": verdicts})
