"""Variants of problems, with values from the lecturer's lists, and the variant of each student.

A problem says ``vary: {n: [2, 3, 5], support: [{text: "at rest", x: "0"}, {text: "driven", x: "a sin(omega t)"}]}``.
Every combination is a variant: ``[[n]]``, ``[[support.text]]`` and ``[[support.x]]`` stand for its values in the scene,
the text and the title. All keys are proved when the assignment is read. A keyed hash of the student's name picks a
variant, so that with the same seed no variant changes if the roster changes.
"""

from __future__ import annotations

import hashlib
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace

from dofkit.base.errors import DofkitError
from dofkit.homework.answers.roster import Participant, Roster, plain_name
from dofkit.homework.assignment import Combination, Prepared
from dofkit.homework.key.key import Key
from dofkit.homework.problem import Pick, StudentVariant, Variants, pick_text
from dofkit.homework.questions import NumberQuestion, QuestionBase
from dofkit.homework.questions.labels import LabelQuestion
from dofkit.homework.sentences import say

#: The least share of points for which the right answers of two students should differ.
LEAST_DIFFERING = 0.5


class NobodysVariantError(DofkitError):
    """A student who has no variant."""


class VaryError(DofkitError):
    """An assignment that cannot be varied."""


def assigned(prepared: Prepared) -> Variants | None:
    """Return the variants of all students, or None if nothing varies. Raises NobodysVariantError if there are none."""
    variants = prepared.assignment.variants
    if variants is None and prepared.combinations:
        raise NobodysVariantError(
            "this assignment varies, and no student has a variant: use the assignment.yaml of `dofkit assignment vary`"
        )
    return variants


def sheet_of(prepared: Prepared, names: str | Iterable[str]) -> Prepared:
    """Return the assignment with the variants of the student who has one of ``names``.

    It is unchanged if nothing varies. Raises NobodysVariantError if the names belong to no student or to several.
    """
    variants = assigned(prepared)
    if variants is None:
        return prepared
    called = [names] if isinstance(names, str) else list(names)
    students = {variant.student: variant for name in called if (variant := variants.find(name)) is not None}
    if len(students) != 1:
        listing = ", ".join(called)[:200] or "nobody"
        whose = "several students of this assignment" if students else "none of the students of this assignment"
        raise NobodysVariantError(f"every student has a variant, and '{listing}' is {whose}")
    (student,) = students.values()
    return picked(prepared, student.picks)


def picked(prepared: Prepared, picks: Mapping[str, Pick]) -> Prepared:
    """Return the assignment with the values ``picks`` of each problem that varies. Raises NobodysVariantError."""
    problems, keys, marks = [], dict(prepared.keys), {}
    for problem in prepared.assignment.problems:
        combinations = prepared.combinations.get(problem.id)
        if combinations:
            chosen = next((c for c in combinations if c.pick == picks.get(problem.id)), None)
            if chosen is None:
                raise NobodysVariantError(f"the problem '{problem.id}' has no variant {picks.get(problem.id)} any more")
            vary = problem.vary or {}
            problem, keys[problem.id] = chosen.problem.model_copy(update={"vary": None}), chosen.key
            for question in problem.questions:
                deciding = [name for name in vary if _decides(name, question, combinations)]
                if deciding:
                    marks[problem.id, question.id] = pick_text({name: vary[name] for name in deciding}, chosen.pick)
        problems.append(problem)
    assignment = prepared.assignment.model_copy(update={"problems": tuple(problems), "variants": None})
    return replace(prepared, assignment=assignment, keys=keys, combinations={}, marks=marks, variant=repr(picks))


def _decides(name: str, question: QuestionBase, combinations: Sequence[Combination]) -> bool:
    """Return whether the right answer to a question may depend on the varying ``name``."""
    if not isinstance(question, NumberQuestion | LabelQuestion):
        return True
    alike: defaultdict[Sequence[tuple[str, int]], list[Key]] = defaultdict(list)
    for pick, _, key in combinations:
        alike[tuple((other, n) for other, n in pick.items() if other != name)].append(key)
    return any(len(_solutions(question, keys)) > 1 for keys in alike.values())


def first_variant(prepared: Prepared) -> Prepared:
    """Return the assignment with the first combination of each problem that varies."""
    return picked(prepared, {problem: several[0].pick for problem, several in prepared.combinations.items()})


def _solutions(question: QuestionBase, keys: Iterable[Key]) -> set[str]:
    """Return the different solutions of a question for several keys."""
    return {say(s).translated() if isinstance(s := question.solution(key), str) else s.translated() for key in keys}


def new_variants(prepared: Prepared, roster: Roster, seed: str) -> Variants:
    """Return the variant of each student of a roster, picked by a keyed hash of the name.

    Raises VaryError if nothing varies in the assignment, if it already has variants, and for an empty roster.
    """
    if prepared.assignment.variants is not None:
        raise VaryError("this assignment was already made by `dofkit assignment vary`: use the original")
    if not prepared.combinations:
        raise VaryError("nothing varies in this assignment: write `vary: {n: [2, 3, 5]}` in a problem")
    if not roster.members:
        raise VaryError("the roster is empty: a row for each student is needed")
    students = []
    for member in roster.members:
        picks = {
            problem: _hashed([c.pick for c in combinations], seed, member.student, problem)
            for problem, combinations in prepared.combinations.items()
        }
        others = (name for name in member.called() if plain_name(name) != plain_name(member.student))
        students.append(StudentVariant(student=member.student, known_as=tuple(dict.fromkeys(others)), picks=picks))
    return Variants(students=tuple(students))


def _hashed(picks: Sequence[Pick], seed: str, student: str, problem: str) -> Pick:
    data = f"{plain_name(student)}\0{problem}".encode("utf-8", "surrogatepass")
    key = hashlib.blake2b(seed.encode("utf-8", "surrogatepass"), digest_size=32).digest()
    return picks[int.from_bytes(hashlib.blake2b(data, key=key, digest_size=8).digest(), "big") % len(picks)]


def differing_share(prepared: Prepared) -> float:
    """Return the share of points for which the right answers of two students differ on average (0 to 1)."""
    total = sum(prepared.most_points().values())
    differing = 0.0
    for problem in prepared.assignment.problems:
        combinations = prepared.combinations.get(problem.id, ())
        for question in problem.questions if combinations else ():
            texts = [next(iter(_solutions(question, [c.key]))) for c in combinations]
            equal = sum(texts.count(text) for text in texts) / len(texts) ** 2
            differing += float(question.points) * (1 - equal)
    return differing / float(total) if total else 0.0


def with_roster(prepared: Prepared, roster: Roster | None) -> tuple[Prepared, Roster | None]:
    """Return (assignment, roster) in which students with variants have the names from both.

    Without a roster, it consists of the students with variants. Raises NobodysVariantError if none are assigned.
    """
    variants = assigned(prepared)
    if variants is None:
        return prepared, roster
    if roster is None:
        people = (Participant(variant.student, others=variant.known_as) for variant in variants.students)
        return prepared, Roster(tuple(people))
    students = {variant.student: variant for variant in variants.students}
    members = []
    for member in roster.members:
        names = tuple(dict.fromkeys((member.student, *member.called())))
        owners = {variant.student for name in names if (variant := variants.find(name)) is not None}
        if len(owners) == 1:
            variant = students[owners.pop()]
            new_names = tuple(name for name in names if name != variant.student and name not in variant.known_as)
            students[variant.student] = variant.model_copy(update={"known_as": (*variant.known_as, *new_names)})
            member = replace(member, others=(variant.student, *variant.known_as))
        members.append(member)
    update = {"variants": Variants(students=tuple(students.values()))}
    changed = replace(prepared, assignment=prepared.assignment.model_copy(update=update))
    return changed, replace(roster, members=tuple(members))


def rows_of(prepared: Prepared, variants: Variants) -> Iterator[tuple[str, str, str, str]]:
    """Yield (student, problem, variant, right answers) for every student and every problem that varies."""
    for student in variants.students:
        sheet = picked(prepared, student.picks)
        for problem in prepared.assignment.problems:
            if problem.id in student.picks:
                key = sheet.keys[problem.id]
                right = " ".join(text for q in problem.questions for text in _solutions(q, [key]) if text)
                yield student.student, problem.id, pick_text(problem.vary or {}, student.picks[problem.id]), right
