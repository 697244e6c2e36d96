"""Scenes for each reduction of the model, and the comparison of reports with and without one.

The scenes grow by what one reduction leaves out.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, NamedTuple

import pytest

from dofkit.classification.freedom import branches
from dofkit.classification.passes import PASSES, Examined, Fill, examined
from dofkit.configuration import at_reference
from dofkit.configuration.linear_blocks import eliminated
from dofkit.configuration.variety import smaller
from dofkit.mobility.general_position import framework_answer, linked_particles
from dofkit.mobility.joint_tree import Bridges, bridges
from dofkit.relations.blocks import joined, split
from dofkit.report import ConstraintEntry, Report
from dofkit.scene.lowering import lower
from dofkit.scene.reading import load

Mapped = dict[str, Any]

#: Fields that state how an answer was derived and how certain it is; of coordinates, one choice of many.
NOT_COMPARED = (
    "verdict",
    "verdicts",
    "witness",
    "feasible_at",
    "method",
    "modelled",
    "warnings",
    "reason",
    "generalized_coordinates",
)
#: Sentences about numbers: others where one of these is undecided.
SENTENCES = ("differs", "errs")
#: Lists of no more than was decided.
LISTS = ("redundant", "redundancies", "special_cases", "conflicting")


class SceneFamily(NamedTuple):
    """Scenes of any size that one reduction is for, and the size at which they are compared."""

    scene: Callable[[int], Mapped]
    size: int
    reduction: str


def _in_one(names: Sequence[str], rows: Any) -> Any:
    blocks, untouched = split(names, rows)
    return [joined(sorted(set(names) - {*untouched}, key=names.index), blocks)] if blocks else [], untouched


#: The functions that make each reduction, and what stands in their place where it is not made.
REDUCTIONS: Mapping[str, Mapping[Callable[..., Any], Callable[..., Any]]] = {
    "blocks": {split: _in_one},
    "twins": {branches._shape: id},
    "copies": {branches.copies: lambda reduced: {}},
    "eliminations": {smaller: lambda chart: (chart, 0), eliminated: lambda *_: None},
    "bridges": {bridges: lambda system: Bridges()},
    "classes": {at_reference._by_classes: lambda *_: None},
    "cheapest": {framework_answer: lambda *_: None, linked_particles: lambda system: None},
}


def study_of(source: Mapped | str, without: Iterable[str] = (), passes: Sequence[Fill] = PASSES) -> Examined:
    """Return the answer without some reductions: their functions are replaced in all modules that use them."""
    system = lower(load(source))
    with pytest.MonkeyPatch.context() as patch:
        for function, replacement in (pair for name in without for pair in REDUCTIONS[name].items()):
            for module in [m for name, m in sys.modules.items() if name.startswith("dofkit.")]:
                if vars(module).get(function.__name__) is function:
                    patch.setattr(module, function.__name__, replacement)
        return examined(system, 60.0, passes=passes)


def model_sizes(study: Examined) -> dict[str, int]:
    """Return the size of the model that was computed with: coordinates, equations, forms, the largest block, ..."""
    sizes = [a.size for a in study.outcome.answers]
    return {
        "coordinates": sum(s.coordinates for s in sizes),
        "relations": sum(s.relations for s in sizes),
        "forms": sum(s.forms for s in sizes),
        "largest": max((s.coordinates for s in sizes), default=0),
        "followed": sum(a.looked.coordinates for a in study.outcome.answers),
    }


def differences(full: Report, other: Report) -> list[str]:
    """Return the fields in which another report of a scene differs; what is undecided there is no difference."""
    fields = [
        field
        for field in Report.model_fields
        if field not in (*NOT_COMPARED, "constraints")
        and _differ(getattr(full, field), getattr(other, field))
        and not (field in LISTS and other.verdict == "undecided")
    ]
    entries = zip(full.constraints, other.constraints, strict=True)
    return fields + [f"{a.name}.{field}" for a, b in entries for field in _of_entry(a, b)]


def _of_entry(full: ConstraintEntry, other: ConstraintEntry) -> list[str]:
    return [
        field
        for field in ConstraintEntry.model_fields
        if field not in NOT_COMPARED and _differ(getattr(full, field), getattr(other, field))
    ]


def _differ(a: Any, b: Any) -> bool:
    """Return whether two values differ, apart from what is undecided in the second and from verdicts."""
    if hasattr(a, "model_dump") and hasattr(b, "model_dump"):
        pairs = {k: (getattr(a, k), getattr(b, k)) for k in type(a).model_fields if k not in NOT_COMPARED}
        undecided = any(x is not None and y is None for x, y in pairs.values())
        return any(_differ(x, y) for k, (x, y) in pairs.items() if not (undecided and k in SENTENCES))
    return b is not None and a != b


# Scenes


def _link(a: Any, b: Any, **more: Any) -> Mapped:
    return {"type": "link", "between": [a, b], **more}


def _links(particles: Sequence[Any], links: Sequence[Mapped]) -> Mapped:
    return {"dimension": 2, "particles": list(particles), "constraints": list(links)}


def _strip_bars(joints: int) -> list[Mapped]:
    """Return the bars of a strip of triangles between so many joints p0, p1, ..."""
    pairs = [(i, i + 1) for i in range(joints - 1)] + [(i, i + 2) for i in range(joints - 2)]
    return [_link(f"p{a}", f"p{b}") for a, b in pairs]


def _discs(n: int, radius: Callable[[int], str]) -> Mapped:
    """Return discs that roll upright on a plane: coordinates (x, y, theta, phi) each."""
    coordinates = [f"{q}{i}" for i in range(n) for q in ("x", "y", "theta", "phi")]
    rows = [
        f"d{q}{i} - {radius(i)} {f}(theta{i}) dphi{i} = 0" for i in range(n) for q, f in (("x", "cos"), ("y", "sin"))
    ]
    return {"coordinates": coordinates, "constraints": rows}


def _blocks(n: int) -> Mapped:
    """Return n discs of different radii."""
    return _discs(n, lambda i: str(i + 1))


def _twins(n: int) -> Mapped:
    """Return n equal discs."""
    return _discs(n, lambda _: "2")


def _copies(n: int) -> Mapped:
    """Return a chain of n rods in the plane from the ground, every rod written twice."""
    ends: list[Any] = [[0, 0], *(f"p{i}" for i in range(n))]
    rods = [_link(ends[i], ends[i + 1], length=i + 1) for i in range(n)]
    return _links(ends[1:], rods + rods)


def _still(n: int) -> Mapped:
    """Return bodies that slide on one another along x and y in turn; two equal parallel cranks hold the last."""
    below = ["ground", *(f"b{i}" for i in range(n))]
    axes = ([1, 0], [0, 1])
    joints: list[Any] = [{"type": "prismatic", "between": below[i : i + 2], "axis": axes[i % 2]} for i in range(n)]
    joints += [_link([x, 0], {"on": below[-1], "at": [x + 1, 2]}) for x in (0, 3)]
    return {"dimension": 2, "bodies": below[1:], "constraints": joints}


def _cranked_strip(n: int) -> Mapped:
    """Return three equal parallel cranks under a strip of triangles between n joints."""
    places = [[3 * i + 1, 2 + i % 2] for i in range(n)]
    cranks = [_link([places[i][0] - 1, places[i][1] - 2], f"p{i}") for i in (0, n // 2, n - 1)]
    return _links([{"name": f"p{i}", "at": at} for i, at in enumerate(places)], [*_strip_bars(n), *cranks])


def _eliminations(n: int) -> Mapped:
    """Return the same in space, every joint held to the plane z = 0."""
    flat = _cranked_strip(n)
    links = [
        {**c, "between": [e if isinstance(e, str) else [*e, 0] for e in c["between"]]} for c in flat["constraints"]
    ]
    joints = [{**p, "at": [*p["at"], 0]} for p in flat["particles"]]
    return {"particles": joints, "constraints": [*(f"z_p{i} = 0" for i in range(n)), *links]}


def _bridges(n: int) -> Mapped:
    """Return a chain of n bodies in space, hinged one to the next, every other hinge turned by a right angle."""
    names, axes = ["ground", *(f"b{i}" for i in range(n))], [[0, 0, 1], [0, 1, 0]]
    hinges = [{"type": "revolute", "between": names[i : i + 2], "at": [i, 1, 0], "axis": axes[i % 2]} for i in range(n)]
    return {"bodies": names[1:], "constraints": hinges}


def _classes(n: int) -> Mapped:
    """Return a parallelogram with a crank too many, and a chain of n rods hanging from it."""
    links = [_link([4 * i, 0], f"c{i}") for i in range(3)]
    links += [_link("c0", "c1"), _link("c1", "c2"), _link("c0", "c2")]
    links += [_link(f"h{i - 1}" if i else "c2", f"h{i}") for i in range(n)]
    joints = [{"name": f"c{i}", "at": [4 * i + 1, 2]} for i in range(3)]
    return _links([*joints, *({"name": f"h{i}", "at": [10 + i, 2 + i % 2]} for i in range(n))], links)


def _cheapest(n: int) -> Mapped:
    """Return a strip of n triangles in the plane, its bars in general position."""
    return _links([f"p{i}" for i in range(n + 2)], _strip_bars(n + 2))


SCENES: Mapping[str, SceneFamily] = {
    "blocks": SceneFamily(_blocks, 8, "blocks"),
    "twins": SceneFamily(_twins, 32, "twins"),
    "copies": SceneFamily(_copies, 6, "copies"),
    "still": SceneFamily(_still, 6, "eliminations"),
    "eliminations": SceneFamily(_eliminations, 8, "eliminations"),
    "bridges": SceneFamily(_bridges, 6, "bridges"),
    "classes": SceneFamily(_classes, 8, "classes"),
    "cheapest": SceneFamily(_cheapest, 16, "cheapest"),
}
