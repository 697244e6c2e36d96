"""Energies that masses, springs, dampers, gravity and forces have, worked out by hand."""

from __future__ import annotations

import random
from pathlib import Path
from typing import Any

import pytest
from checker.values import of_tree

from dofkit.base.documents import read_document
from dofkit.checker.grammar import KnownNames, parse
from dofkit.checker.motion import CheckedEnergies
from dofkit.checker.problem import canonical, problem_of_canonical
from dofkit.checker.trees import Tree, symbol

CASES: Any = read_document(Path(__file__).with_name("energies.yaml").read_bytes(), "energies").value


@pytest.mark.parametrize("row", CASES, ids=lambda row: row["case"])
def test_energies_are_those_by_hand(row: dict[str, Any]) -> None:
    energies = CheckedEnergies(problem_of_canonical(canonical(row["scene"])))

    def agree(tree: Tree, text: str) -> None:
        """A tree is a text, at random places."""
        names = tree.symbols.union(energies.rates)
        other = parse(text, KnownNames(values={name: symbol(name) for name in names - {"t"}}))
        values = {name: random.Random(name).uniform(0.3, 1.2) for name in names | other.symbols}
        assert abs(of_tree(tree, values) - of_tree(other, values)) < 1e-9, text

    agree(energies.lagrangian, row["lagrangian"])
    agree(energies.dissipation, row.get("dissipation", "0"))
    pushes = {str(place.value): push for push, place in energies.pushes}
    assert pushes.keys() == row.get("pushes", {}).keys()
    for coordinate, push in pushes.items():
        agree(push, row["pushes"][coordinate])
