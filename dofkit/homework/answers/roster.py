"""Rosters: the students of a course with their names, addresses and numbers; and who submitted a file.

The headers of Canvas's gradebook (``Student, ID, SIS User ID, SIS Login ID, Section``), of Moodle's lists of
participants and grades (``First name, Last name, ID number, Email address``), of Gradescope's (``Name, SID, Email``)
and their like are known, in the usual languages.

Platforms, file names and folder names are trusted more than the ``student`` that a file gives.
"""

from __future__ import annotations

import hashlib
import os
import re
import unicodedata
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import NamedTuple

from dofkit.base.errors import DofkitError
from dofkit.homework.answers.prose import word_list
from dofkit.homework.answers.spreadsheet import decoded, spreadsheet
from dofkit.homework.answers.submission import MOST_BYTES, clean, reason

#: {field: headers for it in lower case}.
_HEADERS: Mapping[str, frozenset[str]] = {
    **{
        name: word_list(f"roster: {name}")
        for name in ("name", "first", "last", "email", "number", "username", "moodle", "section")
    },
    "canvas": frozenset({"canvas id"}),
}
#: Fields that identify one person.
_UNIQUE = ("email", "number", "username", "canvas", "moodle", "other")
#: Names of folders and files when all submissions are downloaded from Moodle and from Canvas.
_MOODLE = re.compile(r"(?P<who>.+?)(?P<number>_\d+)_assignsubmission_\w+")
_CANVAS = re.compile(r"[^\W_]+_(?:LATE_)?(?P<who>\d+)_\d+_", re.IGNORECASE)
#: Cyrillic and Greek letters, and the Latin letters that look like them.
_LOOKALIKES = str.maketrans(
    "\u0430\u0435\u043e\u0440\u0441\u0443\u0445\u0456\u0458\u0455\u0501\u04bb\u03b1\u03bf\u03b9\u03bd",
    "aeopcyxijsdhaoiv",
)
#: Names of files from PrairieLearn: ``UID_..._QUESTION_..._SUBMISSION_NAME``.
_PRAIRIELEARN = re.compile(r"(?P<who>[^@\s/]+@[^@\s/_]+)_(?:.*_)?\d+_[^_]*")


class RosterError(DofkitError):
    """A roster that cannot be used, with the reason and the line."""


@dataclass(frozen=True)
class Participant:
    """A person in a course; unknown fields are empty.

    ``student``: the name in results, which is unique. ``canvas``, ``moodle``: the number that the platform itself gave
    them, Canvas's ``ID`` and Moodle's ``userid``; ``number``: that of the university. ``others``: whatever else they go
    by.
    """

    student: str
    name: str = ""
    email: str = ""
    number: str = ""
    username: str = ""
    canvas: str = ""
    moodle: str = ""
    other: str = ""
    section: str = ""
    line: int = 0
    others: tuple[str, ...] = ()

    def called(self) -> Iterator[str]:
        """Yield all names, addresses and numbers of the person, also `First Last` for `Last, First`."""
        yield from filter(None, (self.name, *(getattr(self, name) for name in _UNIQUE), *self.others))
        last, comma, first = self.name.partition(",")
        if comma:
            yield f"{first} {last}"

    def goes_by(self, text: str) -> bool:
        """Return whether a text is a name, address or number of the person, or whole words of a name."""
        whole_words = set(plain_name(text.replace(",", " ")).split())
        names = [set(plain_name(name.replace(",", " ")).split()) for name in (self.name, self.student, *self.others)]
        return plain_name(text) in map(plain_name, self.called()) or (
            bool(whole_words) and any(whole_words <= words for words in names)
        )


@dataclass(frozen=True)
class Roster:
    """The persons of a course. ``columns``: the header of the table; ``digest``: a hash of its file."""

    members: tuple[Participant, ...]
    columns: tuple[str, ...] = ()
    digest: str = field(default="", compare=False)

    @cached_property
    def _by_name(self) -> dict[str, Participant | None]:
        """{name, address or number: person}; None if several persons have it."""
        by_name: dict[str, Participant | None] = {}
        for member in self.members:
            for text in {*map(plain_name, member.called()), plain_name(member.student)}:
                by_name[text] = member if by_name.get(text, member) is member else None
        return by_name

    def find(self, text: str) -> Participant | None:
        """Return the person with a name, an address or a number; None if there is none or more than one."""
        return self._by_name.get(plain_name(text))

    def owners(self, claims: Sequence[str]) -> list[Participant]:
        """Return the persons whom names of a file and its folders identify, in their order; usually one or none."""
        return list(dict.fromkeys(owner for owner in map(self._owner, claims) if owner is not None))

    def _owner(self, claim: str) -> Participant | None:
        """Return the person whom the name of a file or folder identifies, also as written by a platform, or None."""
        if platform := _MOODLE.match(claim):
            return self.find(platform["who"])
        if platform := _CANVAS.match(claim):
            by_canvas = next((member for member in self.members if member.canvas == platform["who"]), None)
            return by_canvas or self.find(claim)
        if platform := _PRAIRIELEARN.fullmatch(claim):
            return self.find(platform["who"]) or self.find(claim)
        return self.find(claim)


def own_name(claim: str) -> str:
    """Return the student named by a file or folder of Moodle or PrairieLearn; any other name unchanged.

    >>> own_name("Ada Lovelace_123_assignsubmission_file_"), own_name("sheet_1_2_ada")
    ('Ada Lovelace_123', 'sheet_1_2_ada')
    >>> own_name("ada@uni.example_7_rods_4711_answers")
    'ada@uni.example'
    """
    if at_prairielearn := _PRAIRIELEARN.fullmatch(claim):
        return at_prairielearn["who"]
    moodle = _MOODLE.match(claim)
    return claim if moodle is None else moodle["who"] + moodle["number"]


def plain_name(text: str) -> str:
    """Return a name for comparisons: in lower case, with single spaces."""
    return " ".join(unicodedata.normalize("NFC", text).casefold().split())


def lookalike(name: str) -> str:
    """Return a key that is equal for two names that look the same.

    >>> lookalike("Ad\u0430 ") == lookalike("\uff21da\u200b")  # a Cyrillic letter; a wide letter and a zero-width space
    True
    """
    letters = unicodedata.normalize("NFKC", name).casefold().translate(_LOOKALIKES)
    return " ".join("".join(c for c in letters if unicodedata.category(c) != "Cf").split())


def load_roster(path: str | os.PathLike[str]) -> Roster:
    """Return the roster of a table separated by commas, semicolons, tabs or bars. Raises RosterError.

    The table needs a column of names, addresses or numbers; rows such as Canvas's ``Points Possible`` are ignored.
    """
    file = clean(os.fspath(path))
    try:
        data = Path(path).read_bytes()
    except OSError as error:
        raise RosterError(f"{file} cannot be read: {reason(error)}") from None
    if len(data) > MOST_BYTES:
        raise RosterError(f"{file} is longer than {MOST_BYTES // 10**6} MB")
    text = decoded(data)
    if clean(text) != text:
        raise RosterError(f"{file} is no table in UTF-8: save it as UTF-8")
    table = list(spreadsheet(text, lambda cells: identity_column(cells) >= 0).rows)
    if not table:
        raise RosterError(f"{file} is empty: a roster has a header such as name,email,id and a row for everyone")
    if broken := next((row for row in table if row.error is not None), None):
        raise RosterError(f"{file}, line {broken.line}: {broken.error}")
    header, *rows = [(row.line, [cell.strip() for cell in row.cells]) for row in table]
    members = _members(_fields(header[1], file), rows, file)
    return Roster(tuple(members), tuple(header[1]), hashlib.blake2b(data, digest_size=16).hexdigest())


def _fields(header: list[str], file: str) -> dict[str, int]:
    """Return {field: number of its column}. Raises RosterError if no column identifies a person."""
    words = [" ".join(name.lower().split()) for name in header]
    columns: dict[str, int] = {}
    for i, word in enumerate(words):
        for name, called in _HEADERS.items():
            if word in called:
                columns.setdefault(name, i)
    if "id" in words:
        canvas = {"sis user id", "sis login id"} & set(words)
        columns.setdefault("canvas" if canvas else "other" if "number" in columns else "number", words.index("id"))
    if not {"name", "last", *_UNIQUE} & set(columns):
        raise RosterError(
            f"{file} does not identify anyone: its header is {clean(', '.join(header))[:120]}; "
            "a roster has a column 'name', 'email' or 'id'"
        )
    return columns


def _members(fields: Mapping[str, int], rows: Iterable[tuple[int, list[str]]], file: str) -> Iterator[Participant]:
    """Yield all persons; ``student`` is the first identifier or name that nobody else has. Raises RosterError."""
    members: list[Participant] = []
    for line, cells in rows:
        values = {name: clean(cells[i]) if i < len(cells) else "" for name, i in fields.items()}
        first, last = values.pop("first", ""), values.pop("last", "")
        values["name"] = values.get("name") or f"{first} {last}".strip()
        if _is_nobody(values):
            continue
        members.append(Participant("", line=line, others=(), **values))
    _told_apart(members, file)
    shared = Counter(key for member in members for key in set(map(plain_name, member.called())))
    for member in members:
        identifiers = (getattr(member, name) for name in (*_UNIQUE, "name"))
        student = next((text for text in identifiers if shared[plain_name(text)] == 1), None)
        if student is None:
            place = f"{file}, line {member.line}"
            raise RosterError(f"{place}: '{member.name}' shares every name, address and number with others")
        yield replace(member, student=student)


def _is_nobody(values: Mapping[str, str]) -> bool:
    """Return whether a row is no person, such as Canvas's rows of points below the header."""
    alone = not any(values.get(name) for name in _UNIQUE)
    return alone and ("Points Possible" in values["name"] or not values["name"])


def _told_apart(members: Iterable[Participant], file: str) -> None:
    """Raise RosterError if two persons have the same address or number, or the same name and nothing else."""
    seen: dict[tuple[str, str], Participant] = {}
    for member in members:
        marks = [(name, plain_name(getattr(member, name))) for name in _UNIQUE if getattr(member, name)]
        for mark in marks or [("name", plain_name(member.name))]:
            other = seen.setdefault(mark, member)
            if other is not member:
                raise RosterError(
                    f"{file}, line {member.line}: '{getattr(member, mark[0])}' also occurs in line {other.line}: "
                    "the two cannot be told apart"
                )


def identity_column(header: Sequence[str]) -> int:
    """Return the column of a table of answers that identifies the student, or -1: its address before its name.

    >>> identity_column(["Timestamp", "Email Address", "pendulum.f"]), identity_column(["p.f"])
    (1, -1)
    """
    words = [" ".join(name.casefold().split()) for name in header]
    for called in (frozenset({"student"}), *(_HEADERS[kind] for kind in ("email", "number", "username", "name"))):
        if (place := next((i for i, word in enumerate(words) if word in called), None)) is not None:
            return place
    return -1


class Attribution(NamedTuple):
    """``student``: the name in the result. ``confirmed``: whether a platform or a file name confirms it.

    ``doubt``: why a person must decide who submitted it, or None.
    """

    student: str
    confirmed: bool
    doubt: str | None = None


def attributed(roster: Roster | None, claims: Sequence[str], student: str, by_default: bool) -> Attribution:
    """Return to whom a submission that names ``student`` belongs.

    ``claims``: the names of its file and folders, the innermost first; ``by_default``: whether the submission itself
    names nobody. Of several owners the outermost is taken, because platforms name the folders.
    """
    if roster is None:
        return Attribution(student, by_default or plain_name(student) in map(plain_name, claims))
    member, owners = roster.find(student), roster.owners(claims)
    if not owners:
        return Attribution(student if member is None else member.student, by_default)
    owner = owners[-1]
    if len(owners) > 1:
        return Attribution(owner.student, False, doubt_of(owner.student, owners[0].student))
    by_default = by_default or student in claims
    if member is owner or (member is None and (by_default or owner.goes_by(student))):
        return Attribution(owner.student, True)
    return Attribution(owner.student, True, doubt_of(owner.student, student))


def doubt_of_platform(users: Sequence[Participant], student: str) -> str | None:
    """Return why a person must review a submission of ``users`` that names ``student``; None if it need not be."""
    if not users or not student or any(user.goes_by(student) for user in users):
        return None
    return doubt_of(", ".join(user.student for user in users), student)


def doubt_of(owner: str, student: str) -> str:
    """Return the message about a submission of ``owner`` that names another student."""
    return f"it was submitted as {owner}'s, but names '{student}' as its student: a person has to decide whose it is"
