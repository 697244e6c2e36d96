"""What can be met all at once: inequalities beside equations, of places and of velocities."""

from __future__ import annotations

from typing import Any

from checker.certified import accepted, faults

AT = {"id": "P", "values": {"x": "1", "y": "0", "xdot": "0", "ydot": "1"}}
ROW = {"id": "m", "at": "P", "rows": ["c1"], "columns": ["x"]}


def scene(*constraints: str, **more: Any) -> dict[str, Any]:
    return {"coordinates": ["x", "y"], "constraints": list(constraints), **more}


def test_a_velocity_that_is_not_forbidden() -> None:
    # on the circle (0, 1) is a velocity at (1, 0), and ydot^2 > 0
    ring = scene("x^2 + y^2 = 1", "dy^2 > 0")
    claim = {"path": "/feasible", "value": True, "rule": "regular", "minor": "m"}
    assert faults(ring, [claim], points=[AT], minors=[ROW]) == {}
    for values in ({"xdot": "1"}, {"ydot": "0"}, {"x": "2"}):
        point = {**AT, "values": {**AT["values"], **values}}
        assert not accepted(ring, [claim], points=[point], minors=[ROW]), values
    bare = {**AT, "values": {"x": "1", "y": "0"}}
    assert not accepted(ring, [claim], points=[bare], minors=[ROW])
    assert not accepted(ring, [{**claim, "rule": "point", "at": "P"}], points=[AT], minors=[ROW])
    assert not accepted(scene("x^2 + y^2 = 1", "dx^2 > 0"), [claim], points=[AT], minors=[ROW])
    # the skate forbids the velocity
    skate = scene("x^2 + y^2 = 1", "dy^2 > 0", "x dy = y dx")
    rows = {**ROW, "rows": ["c1", "c3"], "columns": ["x", "y"]}
    assert not accepted(skate, [claim], points=[AT], minors=[rows])
    assert not accepted(skate, [claim], points=[AT], minors=[ROW])
