"""Parts of blocks are answered as by themselves, from what is known of the whole."""

from __future__ import annotations

import pytest

from dofkit.classification.freedom.block import answer
from dofkit.classification.freedom.branches import Outcome
from dofkit.classification.freedom.parts import AnsweredParts
from dofkit.classification.study import study
from dofkit.expressions import tree as ex
from dofkit.relations.answer import Answer
from dofkit.relations.blocks import Block, Row, split
from dofkit.relations.normal.pieces import Finite
from dofkit.scene.lowering import lower
from dofkit.scene.reading import load

TIMED = "sin(th) dx - cos(th) dy = t dt"


@pytest.mark.parametrize(
    ("names", "constraints"),
    [
        ("x y th", ["sin(th) dx = cos(th) dy", "sin(th) dx = cos(th) dy + dth"]),
        ("x y z w", ["dz = y dx + w dy", "dw = y dx"]),
        ("x y th", ["sin(th) dx = cos(th) dy", TIMED]),
        ("x y z", ["y dz + 2 y z dx + z dy = 0", "dz = y dx"]),
        ("x y z w", ["x^2 + y^2 = 1", "dz = y dx", "dw = z dx"]),
    ],
)
def test_every_part_is_answered_as_by_itself(names: str, constraints: list[str]) -> None:
    known = study(lower(load({"coordinates": names.split(), "constraints": constraints})))
    parts = AnsweredParts(known.setting)
    parts.know(zip(known.outcome.blocks, known.outcome.answers, strict=True))
    (block,) = known.outcome.blocks
    for kept in range(1, 1 << len(block.rows)):
        rows = [row for i, row in enumerate(block.rows) if kept >> i & 1]
        for part in split(block.coordinates, rows)[0]:
            found, by_itself = parts.of(part), answer(part, parts.plain)
            assert (found.dof, found.velocity_dof, found.consistent) == (
                by_itself.dof, by_itself.velocity_dof, by_itself.consistent,
            )  # fmt: skip
            assert {i: x.holonomic for i, x in found.labels.items()} == {
                i: x.holonomic for i, x in by_itself.labels.items()
            }
            assert found.verdict == by_itself.verdict or found.verdict == "proved"
            assert parts.of(part) is found


def test_what_was_not_seen_of_a_branch_is_bounded() -> None:
    """A relation leaves 4 of 5 coordinates on a part that was not seen, and 3 of 4 of which nothing is known.

    The freedom of the part that was seen, 1, is no bound. The last coordinate is in no relation.
    """
    relation = Row(0, Finite(ex.coordinate("a")))
    seen = Block(("a", "b", "c", "d", "e"), (relation,)), Answer(True, 1, 1, about="component")
    unknown = Block(("f", "g", "h", "i"), (relation,)), Answer(True)
    known = Block(("j", "k"), (relation,)), Answer(True, 1, 1)
    blocks, answers = zip(seen, unknown, known, strict=True)
    outcome = Outcome([relation], list(blocks), list(answers), ["l"])
    assert outcome.dof is None
    assert outcome.unseen == 1 + 4 + 3 + 1
