"""Many small parts that have nothing to do with each other, or share one coordinate."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from dofkit.benchmark.trials.construction import KnownScene, known_scene, scene_of


@dataclass(frozen=True)
class TrialPart:
    """Rows with {k} for the number of the part; ``holonomic`` by row."""

    name: str
    coordinates: tuple[str, ...]
    rows: tuple[str, ...]
    dof: int
    holonomic: tuple[bool, ...]
    redundant: tuple[int, ...] = ()
    because: str = ""
    traits: tuple[str, ...] = ()
    most: int = 16


PARTS = (
    TrialPart("rolling discs", ("x", "y", "th", "ph"),
         ("dx{k} = R cos(th{k}) dph{k}", "dy{k} = R sin(th{k}) dph{k}"), 4,
         (False, False), (), "a disc reaches every place and both angles", ("non-holonomic",), 64),
    TrialPart("discs on straight lines", ("x", "y", "th", "ph"),
         ("th{k} = 1", "dx{k} = R cos(th{k}) dph{k}", "dy{k} = R sin(th{k}) dph{k}"), 1, (True,) * 3, (),
         "with the heading held x and y follow the angle", ("together",), 4),
    TrialPart("two edges on a lamina", ("x", "y", "th"),
         ("sin(th{k}) dx{k} = cos(th{k}) dy{k}", "sin(th{k}) dx{k} = cos(th{k}) dy{k} + R dth{k}"), 1, (True, True), (),
         "their difference is dth = 0: a straight track", ("together",), 8),
    TrialPart("pendulums", ("x", "y"), ("x{k}^2 + y{k}^2 = R^2",), 1, (True,), (), "a circle each", ("plain",), 64),
    TrialPart("squared pendulums", ("x", "y"), ("(x{k}^2 + y{k}^2 - R^2)^2 = 0",), 1, (True,), (),
         "the zeros of a square", ("squared",)),
    TrialPart("planes written twice", ("x", "y", "z"), ("x{k} + y{k} = z{k}", "3 x{k} + 3 y{k} - 3 z{k} = 0"), 2,
         (True, True), (1,), "the second is three times the first", ("redundant",), 64),
    TrialPart("points as sums of squares", ("x", "y"), ("x{k}^2 + (y{k} - 1)^2 = 0",), 0, (True,), (),
         "both squares vanish", ("sum-of-squares",)),
    TrialPart("exact forms", ("x", "y", "z"),
         ("y{k} z{k} dx{k} + x{k} z{k} dy{k} + x{k} y{k} dz{k} = 0",), 2, (True,), (), "d(x y z)", ("integrable",)),
    TrialPart("driven beads", ("x", "y"), ("y{k} cos(t) = x{k} sin(t)",), 1, (True,), (), "a line that turns",
         ("rheonomic",)),
)  # fmt: skip


def many_blocks(quick: bool) -> Iterator[KnownScene]:
    """Copies of one part, each in its own coordinates: what is true of one holds of each."""
    for part in PARTS:
        for n in (1, 2) if quick else (1, 4, 8, 16, 64):
            if n > part.most:
                break
            yield from _trial(f"{n} times {part.name}", [part] * n, part.because, (*part.traits, "many-blocks"))
    for n in (1,) if quick else (1, 2, 4):
        yield from _trial(f"{n} of each", list(PARTS) * n, "freedoms of separate parts add up", ("many-blocks",))


def _trial(name: str, parts: list[TrialPart], because: str, traits: tuple[str, ...]) -> Iterator[KnownScene]:
    names, rows = [], []
    labels: dict[str, bool] = {}
    over = []
    for k, part in enumerate(parts):
        names += [f"{q}{k}" for q in part.coordinates]
        for i, row in enumerate(part.rows):
            rows.append({"name": f"part{k}_{i}", "type": "equation", "text": row.replace("{k}", str(k))})
            labels[f"part{k}_{i}"] = part.holonomic[i]
        over += [f"part{k}_{i}" for i in part.redundant]
    yield known_scene(
        name,
        scene_of(names, *rows, parameters={"R": "positive"}),
        because,
        traits,
        size=len(parts),
        dof=sum(part.dof for part in parts),
        integrability=labels,
        redundancy=over,
    )


def shared_heading(quick: bool) -> Iterator[KnownScene]:
    """Discs that share their heading: each row has columns of its own, and theta sits in the coefficients of all."""
    for n in (1, 2) if quick else (1, 2, 4, 8):
        names = ["th", *(f"{q}{k}" for k in range(n) for q in ("x", "y", "ph"))]
        rows = [f"d{q}{k} = {f}(th) dph{k}" for k in range(n) for q, f in (("x", "cos"), ("y", "sin"))]
        # what is held; the dof; how many of the constraints integrate
        for held, dof, holonomic, trait in (
            ([], 3 * n + 1, 0, "non-holonomic"),
            (["th = 1"], n, 2 * n + 1, "together"),
            (["dth = 0"], n, 2 * n + 1, "together"),
            (["th = ph0"], 3 * n - 2, 3, "together"),
        ):
            yield known_scene(
                f"{n} discs, {held[0] if held else 'free to turn'}",
                scene_of(names, *held, *rows),
                "turning takes each anywhere; held, all follow their angles; turned by the first's roll, it does",
                (trait,),
                size=n,
                dof=dof,
                integrability={f"c{i + 1}": i < holonomic for i in range(len(held) + 2 * n)},
            )


FAMILIES = {"many blocks": many_blocks, "discs with one heading": shared_heading}
