"""What is not modelled changes no answer: every reduction left out, on scenes that it is for and on the catalog."""

from __future__ import annotations

import json
import random
from collections.abc import Callable, Iterator, Mapping
from itertools import islice
from pathlib import Path
from typing import Any

import pytest
from shared.known_scenes import spread
from shared.reductions import REDUCTIONS, SCENES, differences, model_sizes, study_of

import dofkit
from dofkit.benchmark.trials import FAMILIES
from dofkit.benchmark.trials.construction import few
from dofkit.classification.dependence.circuits import OwnedRows, analyse
from dofkit.exact.matrices.sparse import rank_of_rows

#: A quarter of the catalog's scenes: the whole of it takes a minute.
CATALOG = sorted((Path(__file__).parents[2] / "catalog").glob("*/*.yaml"))[::4]
#: What is computed with less, by hand: (field, with the reduction, without it) at a family's quick size n.
LESS: Mapping[str, tuple[str, Callable[[int], int], Callable[[int], int]]] = {
    "blocks": ("largest", lambda n: 4, lambda n: 4 * n),
    "twins": ("coordinates", lambda n: 4, lambda n: 4 * n),
    "copies": ("relations", lambda n: n, lambda n: 2 * n),
    "still": ("followed", lambda n: 2, lambda n: n + 2),  # where the last is, and how all are turned
    "eliminations": ("followed", lambda n: 2 * n, lambda n: 3 * n),
    "bridges": ("relations", lambda n: 0, lambda n: 5 * n),
}
#: Degrees of freedom of the families' scenes, by hand.
FREEDOM: Mapping[str, Callable[[int], int]] = {
    "blocks": lambda n: 4 * n,  # a rolling disc is held by no finite relation
    "twins": lambda n: 4 * n,
    "copies": lambda n: n,  # a chain of n rods in the plane
    "still": lambda n: n - 1,  # each slides on the one before it, and the last along a circle
    "eliminations": lambda n: 1,  # a parallelogram
    "bridges": lambda n: n,  # a chain of hinges
    "classes": lambda n: n + 1,  # a parallelogram and n rods
    "cheapest": lambda n: 3,  # one lamina
}


@pytest.mark.parametrize("name", SCENES)
def test_what_a_reduction_leaves_out_changes_no_answer(name: str) -> None:
    scene, n, reduction = SCENES[name]
    full, without = (study_of(scene(n), left_out) for left_out in ((), (reduction,)))
    assert differences(full.report, without.report) == []
    assert full.report.dof == FREEDOM[name](n)
    if name in LESS:
        field, less, more = LESS[name]
        assert (model_sizes(full)[field], model_sizes(without)[field]) == (less(n), more(n))


@pytest.mark.parametrize("path", spread(CATALOG), ids=lambda path: path.stem)
def test_the_catalog_is_answered_alike_without_any_reduction(path: Path) -> None:
    scene = dofkit.load(path).model_dump(mode="json", exclude_unset=True)
    assert differences(study_of(scene).report, study_of(scene, REDUCTIONS).report) == []


def scenes_of_families() -> Iterator[Any]:
    """The small members of the families, every scene once."""
    seen = set()
    for name, family in FAMILIES.items():
        for trial in few(family()) if name != "catalog" else ():
            key = json.dumps(trial.scene, sort_keys=True, default=str)
            if key not in seen:
                seen.add(key)
                yield pytest.param(trial.scene, id=f"{trial.family}-{trial.name}")


@pytest.mark.parametrize("scene", spread(islice(scenes_of_families(), 0, None, 5), 2))
def test_the_families_are_answered_alike_without_any_reduction(scene: dict[str, Any]) -> None:
    assert differences(study_of(scene).report, study_of(scene, REDUCTIONS).report) == []


@pytest.mark.parametrize("seed", range(20))
def test_what_can_go_together_leaves_the_rank(seed: int) -> None:
    """Dropped constraints lower no rank, and one more would: against ranks of the rows that are left."""
    rng, p = random.Random(seed), 101
    basis = [{c: rng.randrange(1, p) for c in rng.sample(range(6), 2)} for _ in range(5)]
    matrix, owners = [], []
    for owner in range(9):
        for _ in range(rng.randrange(1, 3)):
            chosen = [(row, rng.randrange(p)) for row in rng.sample(basis, 2)]
            columns = {c for row, _ in chosen for c in row}
            total = {c: sum(factor * row.get(c, 0) for row, factor in chosen) % p for c in columns}
            matrix.append({c: v for c, v in total.items() if v})
            owners.append(owner)
    found = analyse([OwnedRows(matrix, owners, [True] * len(owners), p)])

    def rank_without(gone: set[int]) -> int:
        return rank_of_rows([row for row, owner in zip(matrix, owners, strict=True) if owner not in gone], p)

    whole = rank_of_rows(matrix, p)
    dropped = set(found.redundant)
    assert rank_without(dropped) == whole
    assert all(rank_without(dropped | {owner}) < whole for owner in set(owners) - dropped)
