"""The sheet of one student: a pure function of the assignment with its seed, and of who the student is.

The structures of all problems are drawn together, so that every sheet asks for the same kinds of labels and holds the
same traps; then each problem gets numbers and names of its own. What is not proved, trivial or inconsistent is drawn
again; what cannot be changed so stays as it is.
"""

from __future__ import annotations

import hashlib
import json
from collections import Counter
from collections.abc import Generator, Hashable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple, TypeVar, cast

from dofkit.base.errors import DofkitError, SceneError
from dofkit.homework.assignment import Prepared
from dofkit.homework.key.key import Key
from dofkit.homework.problem import Problem, StudentSheet
from dofkit.homework.variants.difficulty import alike, difficulty_of, fit
from dofkit.homework.variants.geometry import new_stretch, stretched
from dofkit.homework.variants.renaming import new_names, renamed, words
from dofkit.homework.variants.stream import Stream
from dofkit.homework.variants.structure import Structure, aspects_of
from dofkit.scene.reading import load

#: Draws of the structures of a sheet, and of the numbers of a problem, before it stays as it is.
MOST_DRAWS, MOST_STRETCHES = 64, 6
#: Problems that are kept, proved, for the next student.
MOST_KEPT = 500
#: What stands between the structure of a variant and its mark.
_MARKED = " #"


class NobodysSheetError(DofkitError):
    """A student who has no sheet of their own."""


class Variant(NamedTuple):
    """One problem of one student: the problem with its key, and in words what differs from the assignment's."""

    problem: Problem
    key: Key
    changed: str = ""
    numbers: str = ""
    names: str = ""

    @property
    def mark(self) -> str:
        """What tells it from others: its structure, and a digest of the scene."""
        digest = hashlib.blake2b(json.dumps(self.problem.scene, sort_keys=True).encode(), digest_size=4).hexdigest()
        return f"{self.changed or 'as given'}{_MARKED}{digest}"


def structure_told(mark: str) -> str:
    """The structure that a mark names."""
    return mark.rpartition(_MARKED)[0]


def mark_told(mark: str) -> str:
    """What tells a variant from others of its structure."""
    return mark.rpartition(_MARKED)[2]


@dataclass(frozen=True)
class OwnSheet:
    """One student's sheet."""

    prepared: Prepared
    variants: tuple[Variant, ...]

    @property
    def digest(self) -> str:
        """What tells it from others."""
        return hashlib.blake2b("\0".join(v.mark for v in self.variants).encode(), digest_size=8).hexdigest()


def own(prepared: Prepared, student: str) -> Prepared:
    """The sheet of a student of a varied assignment; the assignment itself where it is none.

    Raises NobodysSheetError for who is not among its students, and where the sheet comes out another way than it did.
    """
    return SheetDrawer(prepared).own(student)


def own_of(prepared: Prepared, names: Iterable[str]) -> Prepared:
    """The sheet of whoever goes by one of ``names``, as a platform knows its user by several.

    Raises NobodysSheetError where that is nobody or more than one, as of a group whose sheets differ.
    """
    variants = prepared.assignment.variants
    if variants is None:
        return prepared
    known = {one.student for name in names if (one := variants.find(name)) is not None}
    if len(known) != 1:
        told = "several students of the assignment" if known else "none of the students of the assignment"
        raise NobodysSheetError(f"every student has a variant, and this was submitted by {told}")
    return own(prepared, known.pop())


_Made = TypeVar("_Made")


def _last(steps: Generator[str, None, _Made]) -> _Made:
    while True:
        try:
            next(steps)
        except StopIteration as stop:
            return cast(_Made, stop.value)


class SheetDrawer:
    """Draws the sheets of one assignment; a problem that comes out the same for several is proved once."""

    def __init__(self, prepared: Prepared) -> None:
        self.prepared = prepared
        self._known: dict[tuple[str, int, str], Variant | None] = {}

    def sheet(self, seed: str, whose: StudentSheet) -> OwnSheet:
        """The sheet that a seed gives a student, with what is told of each problem."""
        return _last(self._steps(seed, whose))

    def own(self, student: str) -> Prepared:
        """The sheet of a student. Raises NobodysSheetError."""
        return _last(self.own_steps(student))

    def own_steps(self, student: str) -> Generator[str, None, Prepared]:
        """The sheet of a student, telling of every problem that takes work that it comes next.

        Raises NobodysSheetError for who is not among the students, and where it comes out another way than it did.
        """
        variants = self.prepared.assignment.variants
        if variants is None:
            return self.prepared
        found = variants.find(student)
        if found is None:
            raise NobodysSheetError(
                f"'{student[:200]}' is not among the students of this assignment, or is the name of two"
            )
        sheet = yield from self._steps(variants.seed, found)
        if found.sheet and found.sheet != sheet.digest:
            raise NobodysSheetError(
                f"the sheet of '{found.student}' comes out another way than dofkit {variants.version} made it: grade "
                "with that version, or give more time"
            )
        return sheet.prepared

    def _steps(self, seed: str, whose: StudentSheet) -> Generator[str, None, OwnSheet]:
        prepared = self.prepared
        chosen = _balanced(prepared, Stream(seed, whose.student, whose.draw))
        variants: list[Variant] = []
        for problem, structure in zip(prepared.assignment.problems, chosen, strict=True):
            yield f"the problem {problem.id} of the sheet of {whose.student}"
            variants.append(self._variant(problem, structure, Stream(seed, whose.student, whose.draw, problem.id)))
        update = {"problems": tuple(v.problem for v in variants), "variants": None}
        assignment = prepared.assignment.model_copy(update=update)
        keys = {v.problem.id: v.key for v in variants}
        marks = {v.problem.id: v.mark for v in variants}
        return OwnSheet(
            replace(prepared, assignment=assignment, keys=keys, structures={}, marks=marks), tuple(variants)
        )

    def _variant(self, problem: Problem, structure: Structure, stream: Stream) -> Variant:
        """The problem in a structure, with numbers and names of its own as far as the answers' kinds stay."""
        aspects = aspects_of(problem) if fit(structure.key, structure.key) is None else ()
        for attempt in range(MOST_STRETCHES + 1):
            written, numbers = structure.written, ""
            if "geometry" in aspects and attempt < MOST_STRETCHES:
                stretch = new_stretch(written, structure.key.scene.dimension, stream)
                written = stretched(structure.key.scene, structure.written, stretch)
                numbers = stretch.told(structure.key.scene, structure.written)
            names = new_names(structure.key.scene, problem, stream) if "names" in aspects else {}
            found = self._accepted(problem, structure, written, names)
            if found is not None:
                told = ", ".join(f"{new} for {old}" for old, new in names.items())
                return found._replace(changed=structure.changed, numbers=numbers, names=told)
        return Variant(_with_scene(problem, structure.written, {}), structure.key, structure.changed)

    def _accepted(
        self, problem: Problem, structure: Structure, written: Mapping[str, Any], names: Mapping[str, str]
    ) -> Variant | None:
        """What `_proved` finds, once for all students for whom the problem comes out the same."""
        which = next(n for n, one in enumerate(self.prepared.structures[problem.id]) if one is structure)
        place = (problem.id, which, json.dumps([written, names], sort_keys=True))
        if place in self._known:
            return self._known[place]
        found = _proved(problem, structure, written, names)
        if len(self._known) < MOST_KEPT:
            self._known[place] = found
        return found


def _balanced(prepared: Prepared, stream: Stream) -> list[Structure]:
    """A structure of each problem, such that the sheet is as hard as the assignment's."""
    problems = prepared.assignment.problems
    as_given = [prepared.structures[problem.id][0] for problem in problems]
    wanted = _counted(problems, as_given)
    for _ in range(MOST_DRAWS):
        chosen = [stream.choice(prepared.structures[problem.id]) for problem in problems]
        if _counted(problems, chosen) == wanted:
            return chosen
    return as_given


def _counted(problems: Sequence[Problem], chosen: Sequence[Structure]) -> Counter[Hashable]:
    """The labels and traps of a sheet; those of a problem that says itself what may vary are not counted."""
    found: Counter[Hashable] = Counter()
    for problem, structure in zip(problems, chosen, strict=True):
        if problem.vary is None:
            found += structure.difficulty.counted()
    return found


def _proved(
    problem: Problem, structure: Structure, written: Mapping[str, Any], names: Mapping[str, str]
) -> Variant | None:
    """The variant, where dofkit proves its key and finds the same kinds of answers; else None."""
    changes = words(structure.key.scene, names)
    changed = _with_scene(problem, renamed(written, changes), changes)
    try:
        scene = load(dict(changed.scene) if isinstance(changed.scene, dict) else changed.scene, name=problem.id)
        key = Key(scene, structure.key.convention, changed.also, changed.other_names)
        if any(any(question.faults(key)) for question in changed.questions):
            return None
        same = fit(key, structure.key) is None and alike(key, structure.key)
    except SceneError:
        return None
    return Variant(changed, key) if same and difficulty_of(changed, key) == structure.difficulty else None


def _with_scene(problem: Problem, written: Mapping[str, Any], changes: Mapping[str, str]) -> Problem:
    """The problem with a scene in place, and with its names in the questions and beside them."""
    questions = tuple(
        q.model_copy(update={"coordinate": changes.get(name, name)})
        if isinstance(name := getattr(q, "coordinate", None), str)
        else q
        for q in problem.questions
    )
    update = {
        "scene": dict(written),
        "questions": questions,
        "also": {name: renamed(text, changes) for name, text in problem.also.items()},
        "names": {changes.get(name, name): others for name, others in problem.names.items()},
        "vary": None,
    }
    return problem.model_copy(update=update)
