"""Velocity fields: rigid motions, fields by Cramer's rule, words of brackets, orbits, growth."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from itertools import combinations

from dofkit.checker.constraints import Surroundings
from dofkit.checker.evidence import VelocityField, bracket, field_named, tangent
from dofkit.checker.trees import ZERO, CheckError
from dofkit.exact.matrices.sparse import components
from dofkit.methods.certificates.context import Context, Standing, Told
from dofkit.methods.certificates.numerics import Estimates, NoEstimateError, echelon
from dofkit.methods.certificates.points import FoundPoint
from dofkit.methods.certificates.scenery import Scenery, text_of
from dofkit.methods.certificates.steps import LARGEST_CRAMER, by_cramer, combined_integral, function_in


def motions(world: Surroundings) -> list[dict[str, str]]:
    """Translations and rotations as fields; none where a body of space occurs."""
    d, frames = world.dimension, [frame for frame in world.frames.values() if frame.reference]
    if d == 3 and frames:
        return []
    places = [[str(q.value) for q in moved] for moved in (*(p.over for p in world.particles.values()),
                                                          *(frame.position for frame in frames))]  # fmt: skip
    angles = [list(frame.reference)[2] for frame in frames if d == 2]
    fields = [{place[i]: "1" for place in places} for i in range(d)]
    for i, j in combinations(range(d), 2):
        turn = {place[i]: f"-{place[j]}" for place in places} | {place[j]: place[i] for place in places}
        fields.append(turn | dict.fromkeys(angles, "1"))
    return fields


def backing(context: Context, standing: Standing | None) -> Told | None:
    """What a claim says besides its minor so that all relations follow: nothing, or covers; None where they do not."""
    if standing is None:
        return None
    if standing.accounted:
        return {}
    if (blocks := covering(context, standing)) is None:
        return None
    return {"covers": [context.scenery.entry_id("covers", {"minor": context.minor(standing), "blocks": blocks})]}


def covering(context: Context, standing: Standing) -> list[Told] | None:
    """Blocks of relations whose rank is given by how many there are, or by rigid motions."""
    scenery, blocks = context.scenery, []
    accounted = {*standing.rows, *standing.dependent}
    for names in parts_of(scenery, [name for name in scenery.finite if name in accounted]):
        rank = sum(row in names for row in standing.rows)
        fields = kept_motions(context, names, standing.point) if rank < len(names) else {}
        variables = held_by(scenery, names).intersection(context.problem.coordinates)
        if rank < len(names) and len(variables) - rank != len(fields):
            return None
        blocks.append({"rows": names, "fields": list(fields), "columns": list(fields.values())})
    return blocks


def held_by(scenery: Scenery, names: Sequence[str]) -> frozenset[str]:
    """The symbols in relations."""
    return frozenset[str]().union(*(scenery.evidence.relation(name).tree.symbols for name in names))


def kept_motions(
    context: Context, names: Sequence[str], point: FoundPoint, fixed: Sequence[str] = ()
) -> dict[str, str]:
    """Rigid motions of what relations hold that keep these, each with a column, not ``fixed``: independent there."""
    scenery, held = context.scenery, held_by(context.scenery, names)
    fields = [{q: text for q, text in motion.items() if q in held} for motion in motions(context.problem.world)]
    ids = [scenery.entry_id("fields", {"components": field}) for field in fields]
    kept = []
    for motion in ids:
        with suppress(CheckError):
            tangent(scenery.evidence, [[motion]], names)
            kept.append(motion)
    moved = [field_named(scenery.evidence, motion) for motion in kept]
    rows = [{q: point.estimates.value(tree) for q, tree in field.items() if q not in fixed} for field in moved]
    return {kept[p.row]: p.column for p in echelon(rows)}


def parts_of(scenery: Scenery, names: Sequence[str]) -> list[list[str]]:
    """Return the relations in groups that share no coordinate."""
    trees = [scenery.evidence.relation(name).tree for name in names]
    held = [[q for q in scenery.problem.coordinates if {q, f"{q}dot"} & tree.symbols] for tree in trees]
    return [[names[k] for k in numbers] for numbers in components(held)]


# Evidence about what velocities allow: fields by Cramer's rule, words of brackets, orbits, growth.

#: The longest word, and the most words of a length.
LONGEST, MOST_WORDS = 7, 60


@dataclass
class Words:
    """Fields tangent to rows, and words of them by levels that are independent at the point, each with a column."""

    fields: list[str]
    rows: list[str]
    words: list[list[str]]
    columns: list[str]
    vectors: list[dict[str, float]]
    levels: list[int]


def tangent_fields(context: Context, standing: Standing) -> list[str] | None:
    """Fields that span the kernel of rows: one for every coordinate (and time) that is no column."""
    scenery, pairs = context.scenery, dict(zip(standing.rows, standing.columns, strict=True))
    if not all(map(scenery.linear, standing.rows)):
        return None
    evidence = scenery.evidence
    timed = any(not {"t", "tdot"}.isdisjoint(evidence.relation(row).tree.symbols) for row in standing.rows)
    free = [q for q in (*context.problem.coordinates, *(["t"] if timed else [])) if q not in pairs.values()]
    ids = []
    for coordinate in free:
        touched = _touched(context, standing, coordinate)
        if len(touched) > LARGEST_CRAMER:
            return None
        columns = [pairs[row] for row in touched]
        matrix = [[evidence.slope(row, column) for column in columns] for row in touched]
        h, numerators = by_cramer(matrix, [evidence.slope(row, coordinate) for row in touched])
        trees = {coordinate: h, **dict(zip(columns, (-tree for tree in numerators), strict=True))}
        texts = {name: text_of(tree) for name, tree in trees.items() if tree != ZERO}
        ids.append(scenery.entry_id("fields", {"components": texts}))
    return ids


def _touched(context: Context, standing: Standing, free: str) -> list[str]:
    """The rows that move together when one free coordinate moves."""
    evidence, groups = context.scenery.evidence, parts_of(context.scenery, standing.rows)
    names = {free, f"{free}dot"}
    moved = [part for part in groups if any(names & evidence.relation(row).tree.symbols for row in part)]
    return [row for row in standing.rows if any(row in part for part in moved)]


def words_of(context: Context, standing: Standing, most: int) -> Words | None:
    """Left-normed brackets of the tangent fields, level by level, until ``most`` are independent or nothing new comes.

    Independent at the point; None if there are no fields.
    """

    def grown() -> Words | None:
        with suppress(CheckError, NoEstimateError, RecursionError):
            fields = tangent_fields(context, standing)
            return _grown(context, standing, fields, most) if fields else None
        return None

    return context.scenery.evidence.once(("words", *standing.rows, "", *standing.columns, most), grown)


def reach(context: Context) -> int:
    """How many directions all words of the scene's fields span at most, as far as it is claimed."""
    whole = len(context.problem.coordinates) if context.report.dof is None else context.report.dof
    return whole + context.scenery.evidence.holds_time(context.scenery.equations)


def _grown(context: Context, standing: Standing, fields: list[str], most: int) -> Words:
    estimates = standing.point.estimates
    chosen = context.scenery.chosen
    bases: dict[str, VelocityField] = {
        name: {q: chosen(tree) for q, tree in field_named(context.scenery.evidence, name).items()} for name in fields
    }
    level = [([name], bases[name]) for name in fields]
    words: list[list[str]] = []
    vectors: list[dict[str, float]] = []
    columns: list[str] = []
    levels: list[int] = []
    for _ in range(LONGEST):
        fresh = []
        for word, value in level:
            vector = {q: estimates.value(tree) for q, tree in value.items()}
            pivots = echelon([*vectors, vector])
            if len(pivots) > len(vectors):
                words.append(word)
                vectors.append(vector)
                columns = [p.column for p in pivots]
                fresh.append((word, value))
        levels.append(len(words))
        # where the point is singular, longer words of what brings nothing may bring something
        fresh = fresh or [(word, value) for word, value in level if any(tree != ZERO for tree in value.values())]
        if len(words) >= most or not fresh:
            break
        longer = [(word, name, value) for word, value in fresh for name in fields if word != [name]][:MOST_WORDS]
        try:
            level = [([*w, name], bracket(context.scenery.evidence, value, bases[name])) for w, name, value in longer]
        except CheckError:
            break
    return Words(fields, list(standing.rows), words, columns, vectors, levels)


def orbit(context: Context) -> Iterator[Told]:
    """dof of a scene with forms: from below what brackets reach, from above finite rows and what integrates."""
    standing, freedom = context.standing, context.report.dof
    if standing is None or not standing.accounted or freedom is None:
        return
    for least in _least(context, standing, freedom):
        for most in rows_above(context):
            yield {"rule": "squeeze", "most": most, "least": least, "about": context.about}


def _least(context: Context, standing: Standing, dof: int) -> Iterator[Told]:
    if dof == len(context.problem.coordinates) - len(standing.rows):
        yield {"rule": "regular", "minor": context.minor(standing)}
    yield from curvatures(context, standing)
    if (words := words_of(context, standing, reach(context))) is not None:
        size = dof + any("t" in vector for vector in words.vectors)
        spanned = {"words": words.words[:size], "columns": words.columns[:size]}
        yield {"rule": "span", "at": standing.point.name, "fields": words.fields, "rows": words.rows, **spanned}


def curvatures(context: Context, standing: Standing) -> Iterator[Told]:
    """Yield the rule `curved`: a row that is not linear, with velocities along which it may be curved."""
    free = [q for q in context.problem.coordinates if q not in standing.columns]
    for name in standing.rows:
        for moved in (*zip(free), *combinations(free, 2)) if not context.scenery.linear(name) else ():
            minor = {"minor": context.minor(standing)}
            yield {"rule": "curved", **minor, "pairs": name, "speeds": dict.fromkeys(moved, "1")}


def rows_above(context: Context, columns: Sequence[str] | None = None) -> Iterator[Told]:
    """Yield rows that bound dof, in ``columns`` if given: geometric equations, integrals, forms that are involutive."""
    finite, part = context.finite_standing, context.report.integrable_part
    steps = integral_steps(context, (part and part.basis) or ())
    for names in ([], steps) if steps else ([],):
        standing = finite and context.standing_of([*finite.rows, *names], columns)
        if standing is not None:
            yield {"rule": "minor", "minor": context.minor(standing)}
    if context.scenery.moving:
        yield from involutive_rows(context, integrable_names(context), columns)


def integral_steps(context: Context, texts: Iterable[str | None]) -> list[str]:
    """The steps by which the functions in texts keep their values, of those for which there is one."""
    functions = filter(None, dict.fromkeys(map(function_in, texts)))
    return [step for function in functions if (step := combined_integral(context.scenery, context.point, function))]


def integrable_names(context: Context) -> list[str]:
    """The geometric equations, and the forms that are said to be holonomic."""
    owners = [entry.name for entry in context.report.constraints if entry.holonomic]
    names = [*context.scenery.hidden, *(name for owner in owners for name in context.scenery.owned(owner))]
    return sorted(names, key=context.scenery.equations.index)


def involutive_rows(context: Context, names: Sequence[str], columns: Sequence[str] | None = None) -> Iterator[Told]:
    """Rows whose kernel is closed under brackets, for the rule `frobenius`; ``columns`` those of the minor."""
    standing = context.standing_of(names, columns)
    if standing is None or not standing.rows or (columns is not None and len(columns) != len(standing.rows)):
        return
    fields = tangent_fields(context, standing)
    if fields is not None:
        free = [q for q in (*context.problem.coordinates, "t") if q not in standing.columns][: len(fields)]
        yield {"rule": "frobenius", "minor": context.minor(standing), "fields": fields, "columns": free}


def growth_vector(context: Context) -> Iterator[Told]:
    """Words for every entry, of as many entries as are claimed, and until nothing new comes."""
    standing, vector = context.standing, context.report.growth_vector
    if standing is None or not standing.accounted or not vector:
        return
    words = words_of(context, standing, reach(context))
    if words is None:
        return
    claim = {"rule": "span", "at": standing.point.name, "fields": words.fields, "rows": words.rows}
    claim["minor"] = context.minor(standing)
    for steps in sorted({len(vector), len(words.levels)}, reverse=True):
        levels = [*words.levels, *words.levels[-1:] * steps][:steps]
        yield {**claim, "spans": [{"words": words.words[:k], "columns": words.columns[:k]} for k in levels]}


def pairing(context: Context, name: str, point: FoundPoint, vector: dict[str, float]) -> float:
    """The value of a form in a direction."""
    rates = {f"{q}dot": vector.get(q, 0.0) for q in (*context.problem.coordinates, "t")}
    return Estimates({**point.floats, **rates}).value(context.scenery.tree(name))
