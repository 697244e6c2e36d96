"""Claims that are false, with evidence that is true in its parts: the last one fails, for the reason that is told."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import pytest
from checker.certified import branch, faults, squares

#: A scene, its claims, the parts of the certificate, and what is told of the last claim.
False_ = tuple[Mapping[str, Any], list[dict[str, Any]], dict[str, Any], str]
ORIGIN = {"id": "P", "values": {"x": "0", "y": "0"}}


def plane(*constraints: str, **more: Any) -> dict[str, Any]:
    return {"coordinates": ["x", "y"], "constraints": list(constraints), **more}


def space(*constraints: str, **more: Any) -> dict[str, Any]:
    return {"coordinates": ["x", "y", "z"], "constraints": list(constraints), **more}


def minor(rows: str, columns: str, at: str = "P") -> dict[str, Any]:
    return {"at": at, "rows": rows.split(), "columns": columns.split()}


def claim(path: str, value: Any, rule: str, **more: Any) -> dict[str, Any]:
    return {"path": path, "value": value, "rule": rule, **more}


def implied(name: str, of: str, h: str = "1", **cofactors: str) -> dict[str, Any]:
    return {"id": name, "by": "implied", "of": of, "h": h, "c": cofactors}


DEPENDENCE: dict[str, False_] = {
    # c1 keeps x as it is, wherever that is
    "a relation follows at one velocity": (
        plane("x*xdot = 0", "x = 0"),
        [claim("/constraints/c2/circuit", ["c1"], "cofactors", at="P", minimal={"c1": {"minor": minor("c2", "x")}})],
        {"relations": [implied("k", "c2", c1="1/xdot")], "points": [{"id": "P", "values": {"x": "0", "xdot": "1"}}]},
        "not shown to follow from the circuit",
    ),
    # c1 and c2 can be dropped, both: c3 says as much
    "a relation depends with the factor 0": (
        plane("x = 0", "y = 0", "x^2 + y^2 = 0"),
        [claim("/redundant", ["c3"], "cofactors", minor=minor("c1 c2", "x y"))],
        {
            "relations": [implied("k", "c3", c1="x", c2="y"), implied("l", "c3", h="0", c1="0", c2="0")],
            "points": [ORIGIN],
        },
        "does not depend on the rows by numbers",
    ),
    # c2 follows from c1 in the same way
    "one circuit of two": (
        plane("x^2 + y^2 = 0", "x = 0", "y = 0"),
        [
            claim("/dof", 0, "regular", about="component", minor=minor("c2 c3", "x y")),
            claim("/velocity_dof", 0, "count"),
            claim("/redundant_equations", 1, "count"),
            claim("/constraints/c3/circuit", ["c1"], "cofactors", at="P", minimal={"c1": {"minor": minor("c3", "y")}}),
            claim("/redundancies", [{"nullity": 1, "members": ["c1", "c3"]}], "count"),
        ],
        {
            "relations": [
                *squares("s", "c1", [["1", "x"], ["1", "y"]]),
                implied("i", "c1", c2="x", c3="y"),
                implied("j", "c3", **{"s.2": "1"}),
            ],
            "points": [ORIGIN],
        },
        "none that is shown",
    ),
}
BALL = "(x - 5)^2 + (y - 5)^2 + (z - 5)^2"
PLACES: dict[str, False_] = {
    # the set is the plane z = 0 and a single point
    "coordinates of a smaller part": (
        space(f"z*({BALL}) = 0"),
        [
            claim("/dof", 2, "everywhere", about="everywhere", blocks=["c1"], minor=minor("c1", "z", "O")),
            claim("/generalized_coordinates", ["y", "z"], "minor", minor=minor("s.1", "x")),
        ],
        {
            "relations": [*branch("b", "c1", ["z", BALL], 1), *squares("s", "b", [["1", f"{q} - 5"] for q in "xyz"])],
            "points": [
                {"id": "O", "values": {"x": "0", "y": "0", "z": "0"}},
                {"id": "P", "values": {"x": "5", "y": "5", "z": "5"}},
            ],
        },
        "dof was verified at another point",
    )
}
#: The set is xdotdot = -1, and all of x.
RESTING = {"rule": "isolated", "minor": minor("c2", "xdotdot"), "zero": "c1", "speeds": {"x": "1"}, "order": 2}
NAMES: dict[str, False_] = {
    "a coordinate with the name of a second derivative": (
        {"coordinates": ["x", "xdotdot"], "constraints": ["x^2*(1 + xdotdot) = 0", "xdotdot = -1"]},
        [
            claim(
                "/dof",
                0,
                "squeeze",
                about="component",
                most=RESTING,
                least={"rule": "span", "at": "P", "fields": [], "rows": [], "words": [], "columns": []},
            )
        ],
        {"points": [{"id": "P", "values": {"x": "0", "xdotdot": "-1"}}]},
        "not shown to be isolated",
    )
}
INTEGRALS: dict[str, False_] = {
    "an integral of another constraint": (
        plane("x = 0", "xdot = 0", "ydot = 0"),
        [claim("/constraints/c2/integral", "y = C", "integral", at="P", step="f")],
        {
            "relations": [
                {"id": "f", "by": "integral", "function": "y", "c": {"c3": "1"}},
                {"id": "r", "by": "rate", "of": "c1"},
                implied("i", "c2", r="1"),
            ],
            "points": [ORIGIN],
        },
        "not shown to follow from the constraint",
    ),
    "an integral of a finite relation": (
        plane("x = 0", "y = 0"),
        [claim("/constraints/c1/integral", "x = C", "integral", at="P", step="f")],
        {
            "relations": [
                {"id": "r", "by": "rate", "of": "c1"},
                {"id": "f", "by": "integral", "function": "x", "c": {"r": "1"}},
            ],
            "points": [ORIGIN],
        },
        "has no integral",
    ),
}
WELDED = {"bodies": ["B"], "constraints": [{"type": "weld", "between": ["ground", "B"]}]}
HINGED = {
    "bodies": ["B"],
    "constraints": [{"type": "revolute", "between": ["ground", "B"], "at": [0, 0, 0], "axis": [0, 1, 0]}],
}
UPRIGHT: dict[str, Any] = {"id": "P", "values": {f"{q}_B": "0" for q in ("x", "y", "z", "phi", "theta", "psi")}}
#: Where theta is 0 the angles phi and psi turn about one axis: one pose has a line of angles.
ANGLES: dict[str, False_] = {
    "the first order of a welded body": (
        WELDED,
        [claim("/instantaneous_dof", 1, "rank", at="P")],
        {"points": [UPRIGHT]},
        "no chart of the poses around",
    ),
    "the freedom of a welded body": (
        WELDED,
        [
            claim(
                "/dof",
                1,
                "regular",
                about="reference",
                minor=minor("c1.1 c1.2 c1.4 c1.5 c1.6", "x_B y_B z_B theta_B phi_B"),
            )
        ],
        {
            "relations": [implied("k", "c1.3", **{"c1.2": "(sin(phi_B) - sin(psi_B))/(cos(phi_B) + cos(psi_B))"})],
            "points": [UPRIGHT],
        },
        "no chart of the poses around",
    ),
    # the turn about y by u has the angles pi/2, u, -pi/2
    "an angle that rests": (
        HINGED,
        [
            claim(
                "/dof",
                1,
                "regular",
                about="reference",
                cayley=True,
                minor=minor("c1.1 c1.2 c1.3 c1.4 c1.5", "x_B y_B z_B B_a B_c", "C"),
            ),
            claim(
                "/generalized_coordinates",
                ["phi_B"],
                "minor",
                minor=minor("c1.1 c1.2 c1.3 c1.4 c1.5", "x_B y_B z_B theta_B psi_B"),
            ),
        ],
        {
            "cayley": ["B"],
            "points": [UPRIGHT, {"id": "C", "values": dict.fromkeys(("x_B", "y_B", "z_B", "B_a", "B_b", "B_c"), "0")}],
        },
        "no chart of the poses around",
    ),
}
QUARTER = "1.5707963267948966192313216916397514420985846996875529104874722961539082"
#: A third of a turn about (1, 1, 1), which leaves no entry 12, 23 or 31 of the matrix, is no weld.
TURNED: dict[str, False_] = {
    "a welded body that is turned": (
        {**WELDED, "constraints": [*WELDED["constraints"], "cos(theta_B) <= 1/2"]},
        [claim("/feasible", True, "point", at="P")],
        {
            "points": [
                {
                    "id": "P",
                    "values": {**UPRIGHT["values"], "phi_B": QUARTER, "theta_B": QUARTER},
                    "rows": ["c1.1", "c1.2", "c1.3"],
                    "columns": ["phi_B", "theta_B", "psi_B"],
                    "radius": "1e-40",
                }
            ]
        },
        "leaves its box",
    )
}
FALSE = {**DEPENDENCE, **PLACES, **NAMES, **INTEGRALS, **ANGLES, **TURNED}


@pytest.mark.parametrize("name", FALSE)
def test_what_is_false_is_not_verified(name: str) -> None:
    document, claims, parts, why = FALSE[name]
    found = faults(document, claims, **parts)
    assert list(found) == [claims[-1]["path"]]
    assert why in found[claims[-1]["path"]]
