"""Numbers that are nearly 0, and points that make a zero probable."""

from __future__ import annotations

from typing import Any

import pytest

import dofkit
from dofkit.exact.ring.ring import Ring
from dofkit.exact.zero import identity
from dofkit.expressions.tree import coordinate

#: Sums of arcs that are 0.
ARCS = ["asin(3/5 + {e}) + asin(4/5) - pi/2", "2*asin(3/5 + {e}) - asin(24/25)", "atan(1/2 + {e}) + atan(1/3) - pi/4"]


@pytest.mark.parametrize("arcs", ARCS)
def test_arcs_that_nearly_close_do_not(arcs: str) -> None:
    """10^-120 is less than the bits that are looked at first tell from 0."""
    for e, consistent in (("0", True), ("1/(10^60*10^60)", False), ("-1/(10^60*10^60)", False)):
        report = dofkit.classify({"coordinates": ["x"], "constraints": ["x = 0", f"x + {arcs.format(e=e)} = 0"]})
        assert report.consistent in (consistent, None), e


def test_three_points_make_a_zero_probable(monkeypatch: pytest.MonkeyPatch) -> None:
    drawn: list[Any] = []
    point = identity.field_point
    monkeypatch.setattr(identity, "field_point", lambda rings, seed: drawn.append(seed) or point(rings, seed))
    x = coordinate("x")
    ring = Ring([x])
    assert identity._zero_at_points(ring, ring.node(x - x)) is True
    assert len(drawn) == 3
