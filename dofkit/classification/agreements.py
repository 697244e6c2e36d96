"""Counts that two routes determine and that must agree before a report leaves.

A freedom is found at points, the independence of an equation from what it is implied by. Where a law of the table is
broken one of its fields is wrong, and nobody knows which: all of them are withheld, and the defect is logged.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

from dofkit.base.verdicts import OPEN
from dofkit.relations.answer import DEFECTS
from dofkit.report import ConstraintEntry, FieldVerdict

#: Fields that are an empty list where they have no value.
LISTS = ("redundancies",)
#: Fields of the entries that are withheld together with the redundancy of the report.
OF_ENTRIES = ("independent", "circuit", "redundant_equations")
UNDECIDED = FieldVerdict.of(OPEN)
CONTRADICTION = "These fields are withheld because they contradict each other ({law}): {fields}."

Values = Mapping[str, Any]


def _freedoms_agree(values: Values) -> bool:
    """Return whether 0 <= velocity freedom <= freedom <= coordinates, with equality in a holonomic system."""
    dof, velocities, at_reference = (values[k] for k in ("dof", "velocity_dof", "instantaneous_dof"))
    if dof is None or velocities is None:
        return True
    if not 0 <= velocities <= dof <= values["count"].coordinates or (values["holonomic"] and velocities < dof):
        return False
    return at_reference is None or bool(velocities <= at_reference)


def _dependences_agree(values: Values) -> bool:
    """Return whether as many equations are redundant by rank, by implication and in the groups.

    An equation that states several things removes more freedom than one: then more equations are implied. At a singular
    configuration the groups may hold fewer.
    """
    redundant, surplus = values["redundant"], values["redundant_equations"]
    if redundant is None or surplus is None or values["consistent"] is not True:
        return True
    entries: list[ConstraintEntry] = values["constraints"]
    nullity = sum(group.nullity for group in values["redundancies"])
    members = {name for group in values["redundancies"] for name in group.members}
    removed = sum(e.equations for e in entries if e.name in redundant)
    if not members.issuperset(redundant) or removed > nullity:
        return False
    bilateral = [e for e in entries if e.bilateral]
    if any(e.independent is None for e in bilateral):
        return True
    implied = sum(e.equations - (e.independent or 0) for e in bilateral)
    return implied >= surplus and nullity >= surplus and (bool(values["singular"]) or nullity >= implied)


def _circuits_agree(values: Values) -> bool:
    """Return whether circuits belong to redundant constraints and hold only constraints written before them."""
    before = set[str]()
    for e in values["constraints"]:
        if e.circuit is not None and (e.name not in (values["redundant"] or ()) or not before.issuperset(e.circuit)):
            return values["redundant"] is None
        before.add(e.name)
    return True


def _growth_agrees(values: Values) -> bool:
    """Return whether the growth vector begins with the velocity freedom and ends with the freedom, time apart."""
    growth, dof, velocities = (values[k] for k in ("growth_vector", "dof", "velocity_dof"))
    if None in (growth, dof, velocities):
        return True
    time = growth[0] - velocities
    return growth == sorted(growth) and time == growth[-1] - dof and time in (0, 1)


def _choice_agrees(values: Values) -> bool:
    chosen, dof = values["generalized_coordinates"], values["dof"]
    return chosen is None or dof is None or len(chosen) == dof


class Agreement(NamedTuple):
    """A law in words, the fields that are withheld where it is broken, and the function that checks it."""

    law: str
    fields: tuple[str, ...]
    holds: Callable[[Values], bool]


_REDUNDANCY = ("redundant", "redundancies", "redundant_equations")
AGREEMENTS: tuple[Agreement, ...] = (
    Agreement(
        "the velocity freedom exceeds neither the degrees of freedom nor the instantaneous freedom",
        ("dof", "velocity_dof", "instantaneous_dof", "singular"),
        _freedoms_agree,
    ),
    Agreement(
        "as many equations are redundant by rank, by implication and in the groups", _REDUNDANCY, _dependences_agree
    ),
    Agreement("a circuit belongs to a redundant constraint and was written before it", _REDUNDANCY, _circuits_agree),
    Agreement(
        "the growth vector begins with the velocity freedom and ends with the degrees of freedom",
        ("growth_vector",),
        _growth_agrees,
    ),
    Agreement("there are as many generalized coordinates as freedoms", ("generalized_coordinates",), _choice_agrees),
)


def agreed(values: Values) -> dict[str, Any]:
    """Return the fields of a report without those that contradict each other."""
    kept = dict(values)
    for row in AGREEMENTS:
        if not row.holds(values):
            DEFECTS.error("defect in the report of %r: %s is not so", values["scene"], row.law)
            kept = _without(kept, row)
    return kept


def _without(values: dict[str, Any], row: Agreement) -> dict[str, Any]:
    withheld: dict[str, Any] = {name: [] if name in LISTS else None for name in row.fields}
    verdicts = values["verdicts"] | {name: UNDECIDED for name in row.fields if name in values["verdicts"]}
    warnings = [*values["warnings"], CONTRADICTION.format(law=row.law, fields=", ".join(row.fields))]
    entries = values["constraints"]
    if row.fields == _REDUNDANCY:
        entries = [_undecided_entry(e) for e in entries]
    changed = {"constraints": entries, "warnings": warnings, "verdict": "undecided", "verdicts": verdicts}
    return {**values, **withheld, **changed}


def _undecided_entry(e: ConstraintEntry) -> ConstraintEntry:
    verdicts = e.verdicts | {name: UNDECIDED for name in OF_ENTRIES if name in e.verdicts}
    return e.model_copy(update={**dict.fromkeys(OF_ENTRIES), "verdict": "undecided", "verdicts": verdicts})
