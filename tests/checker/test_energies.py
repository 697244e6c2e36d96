"""Energies that masses, springs, dampers, gravity and forces have, worked out by hand."""

from __future__ import annotations

import random
from typing import Any

from checker.values import of_tree

from dofkit.checker.grammar import KnownNames, parse
from dofkit.checker.motion import CheckedEnergies
from dofkit.checker.problem import canonical, problem_of_canonical
from dofkit.checker.trees import Tree, symbol


def read(**scene: Any) -> CheckedEnergies:
    return CheckedEnergies(problem_of_canonical(canonical(scene)))


def agrees(energies: CheckedEnergies, tree: Tree, text: str) -> None:
    """A tree is a text, at random places."""
    names = tree.symbols.union(energies.rates) - {"t"}
    known = KnownNames(values={name: symbol(name) for name in [*names, "lam"]})
    other = parse(text, known)
    values = {name: random.Random(name).uniform(0.3, 1.2) for name in names | other.symbols}
    assert abs(of_tree(tree, values) - of_tree(other, values)) < 1e-9, text


def test_a_spring_a_damper_and_gravity_in_the_plane() -> None:
    found = read(
        dimension=2,
        particles=[{"name": "A", "mass": 3}, {"name": "B", "mass": "1/2"}],
        forces=[
            {"type": "spring", "between": ["A", "B"], "stiffness": 5, "rest_length": 2},
            {"type": "damper", "between": ["A", [0, 0]], "damping": 7},
            {"type": "gravity", "acceleration": 10},
            {"type": "force", "point": "B", "value": 4, "direction": [3, 4]},
        ],
    )
    kinetic = "3 (x_Adot^2 + y_Adot^2)/2 + (x_Bdot^2 + y_Bdot^2)/4"
    spring = "5 (sqrt((x_B - x_A)^2 + (y_B - y_A)^2) - 2)^2/2"
    agrees(found, found.lagrangian, f"{kinetic} - {spring} - 30 y_A - 5 y_B")
    agrees(found, found.dissipation, "7 (x_A x_Adot + y_A y_Adot)^2/(2 (x_A^2 + y_A^2))")
    pushes = [(f.value, str(place.value)) for f, place in found.pushes]
    assert [place for _, place in pushes] == ["x_B", "y_B"]
    agrees(found, found.pushes[0][0], "12/5")
    agrees(found, found.pushes[1][0], "16/5")


def test_a_spring_as_it_is_drawn_and_one_that_turns() -> None:
    found = read(
        dimension=2,
        bodies=[{"name": "B", "mass": 2, "inertia": 3}],
        constraints=[{"type": "revolute", "between": ["ground", "B"], "at": [0, 0]}],
        forces=[
            {"type": "spring", "between": ["ground", "B"], "stiffness": 8, "rest_length": 1},
            {"type": "spring", "between": [[0, 3], {"on": "B", "at": [4, 0]}], "stiffness": 2},
        ],
    )
    place = "sqrt((x_B + 4 cos(theta_B))^2 + (y_B + 4 sin(theta_B) - 3)^2)"
    stored = f"4 (theta_B - 1)^2 + ({place} - 5)^2"
    agrees(found, found.lagrangian, f"x_Bdot^2 + y_Bdot^2 + 3 theta_Bdot^2/2 - ({stored})")


def test_the_turning_of_a_body_of_space() -> None:
    """A top with the moments A, A, C: A (thetadot^2 + phidot^2 sin^2 theta)/2 + C (psidot + phidot cos theta)^2/2."""
    top = "5 (theta_Bdot^2 + phi_Bdot^2 sin(theta_B)^2)/2 + 3 (psi_Bdot + phi_Bdot cos(theta_B))^2/2"
    moved = "2 (x_Bdot^2 + y_Bdot^2 + z_Bdot^2)/2"
    for inertia in ([5, 5, 3], [[5, 0, 0], [0, 5, 0], [0, 0, 3]]):
        found = read(bodies=[{"name": "B", "mass": 2, "inertia": inertia}])
        agrees(found, found.lagrangian, f"{moved} + {top}")


def test_texts_go_before_entries() -> None:
    found = read(
        dimension=2,
        coordinates=["q"],
        parameters={"k": "positive"},
        energies={"kinetic": "qdot^2/2", "potential": "k q^4", "dissipation": "k qdot^2", "forces": {"q": "sin(t)"}},
        forces=[{"type": "gravity", "acceleration": 10}],
    )
    agrees(found, found.lagrangian, "qdot^2/2 - k q^4")
    agrees(found, found.dissipation, "k qdot^2")
    ((force, place),) = found.pushes
    assert (force, place) == (parse("sin(t)", KnownNames()), symbol("q"))
