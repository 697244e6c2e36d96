"""Branches of hidden relations: all of them, or it is said that they are too many."""

from __future__ import annotations

import pytest

import dofkit
from dofkit.classification.freedom import block
from dofkit.classification.freedom.preparation import prepared
from dofkit.expressions import tree as ex
from dofkit.expressions.tree import Expr
from dofkit.integrability.pfaffian_system import MAX_TOGETHER, prolong
from dofkit.relations.setting import Setting
from dofkit.scene.lowering import lower


def setting() -> Setting:
    return prepared(lower(dofkit.load({"coordinates": ["x", "y"], "constraints": ["x = y"]})))[1]


def places(name: str, many: int) -> Expr:
    """(q - 1) (q - 2) ..., 0 at so many places."""
    return ex.mul(*(ex.coordinate(name) - ex.num(k + 1) for k in range(many)))


def test_relations_that_hold_together_hold_on_every_pair_of_branches() -> None:
    found = prolong([(places("x", 2), places("y", 3))], setting())
    assert found is not None
    assert len(found) == 6


def test_too_many_pairs_are_said_to_be_too_many() -> None:
    """4 x 4 branches are more than are looked at; none of them is left out without a word."""
    assert MAX_TOGETHER < 16
    assert prolong([(places("x", 4), places("y", 4))], setting()) is None
    assert prolong([(places("x", 1),), (places("x", 4), places("y", 4))], setting()) is None


def test_the_report_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(block, "prolong", lambda *_: None)
    report = dofkit.classify({"coordinates": ["x", "y"], "constraints": ["x = 0", "xdot = y^2 - 1"]})
    assert (report.dof, report.verdict) == (None, "undecided")
    assert any(line == block.MANY_BRANCHES for line in report.warnings)
