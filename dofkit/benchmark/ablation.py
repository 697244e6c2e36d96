"""What each reduction of `dofkit.relations.setting` saves: time and size of the model without one after another.

The scenes grow by what one reduction leaves out; those of the catalog stand beside them.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, NamedTuple

from dofkit.base.deadline import OutOfTimeError
from dofkit.benchmark.record import ReductionCost
from dofkit.classification.passes import Examined, examined
from dofkit.relations.setting import ALL, REDUCTIONS, ReductionName, Reductions
from dofkit.report import ConstraintEntry, Report
from dofkit.scene.catalog import catalog_names
from dofkit.scene.lowering import lower
from dofkit.scene.reading import load

Mapped = dict[str, Any]

#: Seconds after which no new part of an answer is begun; times below `BRIEF` are the least of `REPEATS`.
SECONDS, BRIEF, REPEATS = 10.0, 0.3, 3
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
    """Scenes of any size that one reduction is for, in sizes for a quick run and for a whole one."""

    scene: Callable[[int], Mapped]
    quick: int
    whole: tuple[int, ...]


class AblatedScene(NamedTuple):
    """A scene as `dofkit.load` takes it, with its family and size."""

    name: str
    family: str
    size: int
    source: Mapped | str


def ablation(quick: bool = False) -> Iterator[ReductionCost]:
    """Yield a row for every scene and every reduction that may matter: its own family's; all for the catalog."""
    for family, made in SCENES.items():
        for size in (made.quick,) if quick else made.whole:
            yield from costs(AblatedScene(f"{family}-{size}", family, size, made.scene(size)), (family,))
    for name in catalog_names()[:: 6 if quick else 1]:
        yield from costs(AblatedScene(name, "catalog", 1, name), tuple(REDUCTIONS), 2)


def costs(scene: AblatedScene, without: tuple[ReductionName, ...], repeats: int = REPEATS) -> Iterator[ReductionCost]:
    """Yield the costs with all reductions, then without each of some; a first run is not measured: a warm start."""
    timed_study(scene.source, ALL, 1)
    full, seconds = timed_study(scene.source, ALL, repeats)
    yield _cost(scene, "", full, seconds, [])
    for off in without:
        study, seconds = timed_study(scene.source, ALL - {off}, repeats)
        changed = [] if study is None or full is None else differences(full.report, study.report)
        yield _cost(scene, off, study, seconds, changed)


def timed_study(source: Mapped | str, reductions: Reductions, repeats: int = REPEATS) -> tuple[Examined | None, float]:
    """Return the answer and its processor time; None where it ran out of time."""
    best = float("inf")
    for _ in range(repeats):
        begin = time.thread_time()
        try:
            study = examined(lower(load(source)), SECONDS, reductions=reductions)
        except OutOfTimeError:
            return None, time.thread_time() - begin
        best = min(best, time.thread_time() - begin)
        if best > BRIEF:
            break
    return study, best


def _cost(scene: AblatedScene, off: str, study: Examined | None, seconds: float, changed: list[str]) -> ReductionCost:
    sizes = [] if study is None else [a.size for a in study.outcome.answers]
    return ReductionCost(
        scene=scene.name,
        family=scene.family,
        size=scene.size,
        off=off,
        seconds=seconds,
        coordinates=sum(s.coordinates for s in sizes),
        relations=sum(s.relations for s in sizes),
        forms=sum(s.forms for s in sizes),
        largest=max((s.coordinates for s in sizes), default=0),
        written=0 if study is None else len(study.system.coordinates),
        followed=0 if study is None else sum(a.looked.coordinates for a in study.outcome.answers),
        unchanged=not changed,
        undecided=study is None or (study.report.dof is None and study.report.consistent is not False),
        differs=changed,
    )


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


def _discs(n: int, radius: Callable[[int], str], free: int = 0) -> Mapped:
    """Return discs that roll upright on a plane: coordinates (x, y, theta, phi) each."""
    coordinates = [f"{q}{i}" for i in range(n) for q in ("x", "y", "theta", "phi")]
    rows = [
        f"d{q}{i} - {radius(i)} {f}(theta{i}) dphi{i} = 0" for i in range(n) for q, f in (("x", "cos"), ("y", "sin"))
    ]
    return {"coordinates": [*coordinates, *(f"free{i}" for i in range(free))], "constraints": rows}


def _untouched(n: int) -> Mapped:
    """Return one disc with n further coordinates that nothing touches."""
    return _discs(1, lambda _: "2", n)


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


def _welds(n: int) -> Mapped:
    """Return three equal parallel cranks under n bodies welded in a row."""
    row = [f"b{i}" for i in range(n)]
    joints: list[Any] = [{"type": "weld", "between": row[i : i + 2]} for i in range(n - 1)]
    for i in range(3):
        joints.append({"type": "revolute", "between": ["ground", f"crank{i}"], "at": [3 * i, 0]})
        joints.append({"type": "revolute", "between": [f"crank{i}", row[i * (n - 1) // 2]], "at": [3 * i + 1, 2]})
    return {"dimension": 2, "bodies": [*row, *(f"crank{i}" for i in range(3))], "constraints": joints}


def _clusters(n: int) -> Mapped:
    """Return three equal parallel cranks under a strip of triangles between n joints."""
    places = [[3 * i + 1, 2 + i % 2] for i in range(n)]
    cranks = [_link([places[i][0] - 1, places[i][1] - 2], f"p{i}") for i in (0, n // 2, n - 1)]
    return _links([{"name": f"p{i}", "at": at} for i, at in enumerate(places)], [*_strip_bars(n), *cranks])


def _eliminations(n: int) -> Mapped:
    """Return the same in space, every joint held to the plane z = 0."""
    flat = _clusters(n)
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


def _closed(n: int) -> Mapped:
    """Return n particles in space on quadrics that move with the next of them: configuration-level equations only."""
    surfaces = [f"x_p{i}^2 + y_p{i}^2 = {i + 2} + z_p{i} x_p{i + 1}" for i in range(n - 1)]
    return {"particles": [f"p{i}" for i in range(n)], "constraints": surfaces}


def _cheapest(n: int) -> Mapped:
    """Return a strip of n triangles in the plane, its bars in general position."""
    return _links([f"p{i}" for i in range(n + 2)], _strip_bars(n + 2))


SCENES: Mapping[ReductionName, SceneFamily] = {
    "untouched": SceneFamily(_untouched, 32, (8, 16, 32, 64)),
    "blocks": SceneFamily(_blocks, 8, (2, 4, 8, 16, 32)),
    "twins": SceneFamily(_twins, 32, (8, 16, 32, 64)),
    "copies": SceneFamily(_copies, 6, (3, 6, 12, 24)),
    "still": SceneFamily(_still, 6, (3, 6, 12, 24)),
    "welds": SceneFamily(_welds, 8, (4, 8, 16, 32)),
    "clusters": SceneFamily(_clusters, 12, (6, 12, 24, 48)),
    "eliminations": SceneFamily(_eliminations, 8, (4, 8, 16)),
    "bridges": SceneFamily(_bridges, 6, (4, 8, 16, 32)),
    "classes": SceneFamily(_classes, 8, (4, 8, 16, 32)),
    "closed": SceneFamily(_closed, 6, (4, 6, 8, 12)),
    "cheapest": SceneFamily(_cheapest, 16, (8, 16, 32, 64)),
}
