"""The printed scene, and the printed graph of links."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from dofkit.base.wording import many
from dofkit.interface.show.report import MOST_ROWS, names_of, number
from dofkit.interface.show.sheet import TONES, Column, Content, Fact, Formula, Grid, Remark, Sheet, SheetSection
from dofkit.mobility.graph.linkage import Linkage
from dofkit.mobility.graph.links import Link
from dofkit.scene.constraints.base import Equation
from dofkit.scene.names import coordinate_table
from dofkit.scene.scene import Scene

_COLUMNS = (Column("name"), Column("text", 1), Column("type"))


def sheet_of_scene(scene: Scene) -> Sheet:
    """Return the sheet of a scene: its contents and constraints, as written."""
    sections = []
    if scene.constraints:
        names = [c.name or f"c{i}" for i, c in enumerate(scene.constraints, 1)]
        rows = [(n, _words(c), c.kind()) for n, c in zip(names, scene.constraints, strict=True)]
        sections.append(SheetSection("Constraints", [Grid(_COLUMNS, rows[:MOST_ROWS])], _more(len(rows))))
    if scene.forces:
        named = [(f.name or f"f{i}", f.type) for i, f in enumerate(scene.forces, 1)]
        sections.append(SheetSection("Forces", [Remark(name, kind) for name, kind in named]))
    if scene.energies is not None:
        sections.append(SheetSection("Energies", list(_energies(scene))))
    return Sheet(scene.name, scene.title or "", facts=tuple(_facts(scene)), sections=sections)


def _words(constraint: object) -> Content:
    words: str = getattr(constraint, "in_words", "")
    return Formula(words) if isinstance(constraint, Equation) else words


def _more(rows: int) -> str:
    return f"... and {rows - MOST_ROWS} more" if rows > MOST_ROWS else ""


def _facts(scene: Scene) -> Iterator[Fact]:
    yield Fact("world", many(scene.dimension, "dimension"))
    if scene.particles:
        yield Fact("particles", names_of([p.name for p in scene.particles]))
    if scene.bodies:
        yield Fact("bodies", names_of([b.name for b in scene.bodies]))
    coordinates = [c.name for c in coordinate_table(scene).coordinates]
    if coordinates:
        yield Fact("coordinates", names_of(coordinates), f"({len(coordinates)})")
    if scene.parameters:
        yield Fact("parameters", names_of([_parameter(n, str(v)) for n, v in scene.parameters.items()]))
    if scene.functions:
        yield Fact("functions", names_of([f"{n}({', '.join(a)})" for n, a in scene.functions.items()]))
    if scene.tolerance is not None:
        yield Fact("measured", f"to within {float(scene.tolerance):g} of the scene's size")
    if scene.source:
        yield Fact("source", scene.source)
    if scene.notes:
        yield Fact("notes", " ".join(scene.notes.split()))


def _parameter(name: str, value: str) -> str:
    return f"{name} ({value})" if value in ("real", "positive", "nonzero") else f"{name} = {value}"


def _energies(scene: Scene) -> Iterator[Remark]:
    energies = scene.energies
    if energies is None:
        return
    for label, text in (("T", energies.kinetic), ("V", energies.potential), ("D", energies.dissipation)):
        if text is not None:
            yield Remark("", Formula(f"{label} = {text}"))
    for name, text in energies.forces.items():
        yield Remark("", Formula(f"Q_{name} = {text}"))


def sheet_of_linkage(linkage: Linkage) -> Sheet:
    """Return the sheet of a graph of links: its count, and what is redundant."""
    facts = [
        Fact("joints", str(len(linkage.joints)), f"in {many(linkage.dimension, 'dimension')}, in general position"),
        Fact("links", str(len(linkage.links)), f"of which {linkage.rank} are independent"),
        Fact("freedom", number(linkage.freedom), _inner(linkage)),
        Fact("verdict", linkage.verdict, tone=TONES[linkage.verdict]),
    ]
    redundant = linkage.redundant
    remarks = [Remark("redundant", _links(redundant))] if redundant else []
    return Sheet("linkage", facts=facts, sections=[SheetSection("Redundancy", remarks)] if remarks else [])


def _inner(linkage: Linkage) -> str:
    if linkage.rigid:
        return "one rigid body"
    return f"{linkage.inner_freedom} internal, beyond the motions as one rigid body"


def _links(links: Iterable[Link]) -> str:
    return names_of([f"{a}-{b}" for a, b in links])
