"""Reads answers that list names, as people write them."""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction

from pydantic_core import PydanticCustomError

from dofkit.base.errors import TextError
from dofkit.expressions.text import spelled
from dofkit.homework.answers.denials import affirms, beside_none, says_none
from dofkit.homework.answers.notation import Script, script_of
from dofkit.homework.answers.prose import DOUBTS, FILLING, NEGATIONS, NUMBERS, REASONS, pattern, plain
from dofkit.homework.judgement import DoubtError, Given
from dofkit.scene.fields import as_written, exact, suggestion

#: Fewer additional words than this between names do not make a list doubtful.
_FEW_WORDS = 3
#: The most characters of an answer that is read.
MOST_CHARACTERS = 2000
_SEPARATORS = re.compile(r"[,;\s]+(?:and|und|et|&)[,;\s]+|[,;\s]+|\s*&\s*")
_REMARK = re.compile(r"(?<=\w)\s*\((?:\s*=[^()]*|[^()]*[^\W\d_]{3}[^()]*)\)")
_TRANSPOSED = re.compile(r"(?<=\))\s*\^\s*\{?\s*(?:\\top|\\?(?:mathrm|text)?\s*\{?\s*T)\s*\}{0,2}(?!\w)")
_OF_TIME = re.compile(r"(?<=\w)\s?\(t\)")
_LEAD = re.compile(r"\A[^:=\d]*:(?!=)")
_TITLE = re.compile(r"\bq(?:_?\{?\w?\}?)?\s*=")
_COMMAND = re.compile(r"\\(?:var(?=phi|theta|epsilon|rho|sigma))?(?=[A-Za-z])")
_OR = re.compile(r",?\s+(?:or|oder|ou|oppure)\s+", re.IGNORECASE)
#: `one of bar and again`, `any one of them`.
_ANY = pattern("words: any")
_ONE_OF = pattern("words: one of")
_EITHER = re.compile(r"\A\s*(?:either|entweder|soit)\s+", re.IGNORECASE)
_LOWERED = {0x2080 + n: str(n) for n in range(10)}
_BRACES = re.compile(r"_\{(\w+)\}")

#: Replaces values that cannot be an answer, such as a mapping; no question can read it.
NO_ANSWER = "{…}"
#: The most characters of an answer that are shown; the separator of a list.
MOST_SHOWN = 2000
_BETWEEN = "; "


def one_text(answer: object) -> str:
    """Return an answer as one text. Raises TextError for lists, mappings, booleans and long texts."""
    if isinstance(answer, bool) or not isinstance(answer, (str, int, float, Fraction)) or answer == NO_ANSWER:
        raise TextError("one number or text is needed here", 1, "write a single answer")
    text = answer if isinstance(answer, str) else _number_text(answer)
    if len(text) > MOST_CHARACTERS:
        raise TextError(f"the answer has {len(text)} characters", MOST_CHARACTERS + 1, f"at most {MOST_CHARACTERS}")
    return text


def _number_text(answer: float | Fraction) -> str:
    try:
        return as_written(exact(answer))
    except (PydanticCustomError, ArithmeticError, ValueError):
        raise TextError(f"'{str(answer)[:40]}' is not a number", 1, "write a number such as 3") from None


@dataclass(frozen=True)
class Word:
    """A word of an answer, and its column counted from 1."""

    text: str
    column: int


def split_words(answer: object) -> list[Word]:
    """Return the words of an answer: the entries of a list, or a text split at commas, semicolons, spaces and "and"."""
    if isinstance(answer, Sequence) and not isinstance(answer, str):
        return [Word(one_text(part).strip(), 1) for part in answer]
    script = script_of(one_text(answer)).replaced(_TRANSPOSED, "")
    return list(_words(script.replaced(_COMMAND, "").replaced(_BRACES, r"_\1")))


def _words(script: Script) -> Iterator[Word]:
    stripped = script.text.strip()
    for opening, closing in ("{}", "[]", "()"):
        if stripped.startswith(opening) and stripped.endswith(closing):
            stripped = stripped[1:-1].strip()
    start = script.text.index(stripped) if stripped else 0
    body = stripped
    place = 0
    for cut in _SEPARATORS.finditer(body):
        if cut.start() > place:
            yield Word(body[place : cut.start()], script.columns[start + place])
        place = cut.end()
    if place < len(body):
        yield Word(body[place:].rstrip("."), script.columns[start + place])


def is_none(answer: object, says: Callable[[str], bool], names: Collection[str] = (), every: bool = False) -> bool:
    """Return whether an answer says that nothing of the kind exists, or is an empty list.

    ``says``: whether a part of an answer names something; ``names``: declared names, which are not words; ``every``:
    whether "all are needed" says none as well. Raises DoubtError if the answer says both.
    """
    if isinstance(answer, Sequence) and not isinstance(answer, str):
        return not answer or (len(answer) == 1 and is_none(answer[0], says, names, every))
    if not isinstance(answer, str) or len(answer) > MOST_CHARACTERS:
        return False
    if any(says(part) or affirms(part) for part in beside_none(answer)):
        raise DoubtError("it says that there is none and then gives one.", 1, None)
    return says_none(answer, names, every)


def lists_only(part: str, names: Sequence[str]) -> bool:
    """Return whether a part of an answer consists of the given names and a few filling words."""
    table = ChoiceOfNames(names)
    listed = [word.text for word in split_words(part)]
    others = [w for w in listed if not table.meant(w)]
    return len(others) < min(len(listed), _FEW_WORDS) and all(plain(w) in FILLING for w in others)


def alternatives(answer: Given, names: Sequence[str], what: str) -> list[Given]:
    """Return the choices of `x or y`, `one of x and y`, or `any one` (all names); else a list of the answer alone."""
    if not isinstance(answer, str):
        return [answer]
    if (some := _ANY.match(plain(answer))) is not None:
        return list(names_of(some["which"], names, what)) if some["which"] else list(names)
    choices = _OR.split(_EITHER.sub("", answer))
    return [*choices] if all(part.strip() for part in choices) else [answer]


def names_of(answer: object, names: Sequence[str], what: str) -> list[str]:
    """Return the known names that an answer lists, without remarks and filling words. Raises TextError, DoubtError."""
    if isinstance(answer, str):
        reason = REASONS.search(answer)
        answer = answer if reason is None else answer[: reason.start()]
        answer = _OF_TIME.sub("", answer)
        answer = _TITLE.sub(lambda m: " " * len(m[0]), answer) if "q" not in names else answer
        lead = _LEAD.match(answer)
        if lead is not None and not any(ChoiceOfNames(names).meant(w) for w in re.findall(r"\w+", lead[0])):
            denied = (NEGATIONS | DOUBTS) & {plain(w) for w in re.findall(r"[^\W\d_]+", lead[0])}
            answer = answer if denied else " " * lead.end() + answer[lead.end() :]
        answer = _REMARK.sub(lambda m: " " * len(m[0]), answer)
        if _ONE_OF.search(answer):
            raise DoubtError("it can be read in more than one way.", 1, None)
    words = split_words(answer)
    table = ChoiceOfNames(names)
    if any(table.meant(word.text) for word in words):
        words = [w for w in words if table.meant(w.text) or plain(w.text.strip(".:'\"")) not in FILLING]
        words = _without_count(words, table)
    return chosen(words, names, what)


def _without_count(words: Sequence[Word], table: ChoiceOfNames) -> list[Word]:
    """Return the words without the number of names that are listed: `the two angles`."""
    count = len({table.meant(w.text) for w in words} - {None})
    return [w for w in words if table.meant(w.text) or NUMBERS.get(plain(w.text)) != count]


class ChoiceOfNames:
    """Known names, found regardless of the spelling of Greek letters, and of case and `_` if that is unambiguous."""

    def __init__(self, names: Sequence[str]) -> None:
        self._exact = {spelled(spelling): spelling for spelling in names}
        self._loose: dict[str, str | None] = {}
        for spelling, name in self._exact.items():
            for form in {spelling.lower(), spelling.lower().replace("_", "").replace(" ", "").replace("-", "")}:
                self._loose[form] = None if self._loose.get(form, name) != name else name

    def meant(self, text: str) -> str | None:
        """Return the only known name that a text means, or None."""
        text = spelled(text.strip("`'\".:").translate(_LOWERED))
        loose = self._loose.get(text.lower(), self._loose.get(text.lower().replace("_", "").replace("-", "")))
        return self._exact.get(text, loose)


def chosen(words: Iterable[Word], names: Sequence[str], what: str) -> list[str]:
    """Return the known names that the words mean, each once; ``what``: the kind of name, for messages.

    Raises TextError for any other word, with its column and the nearest name, and if there are no words.
    """
    table = ChoiceOfNames(names)
    chosen_names: dict[str, None] = {}
    for word in words:
        meant = table.meant(word.text)
        if meant is None:
            hint = suggestion(word.text, names, f"{what}s")
            raise TextError(f"there is no {what} '{word.text[:40]}'", word.column, hint)
        chosen_names[meant] = None
    if not chosen_names:
        raise TextError(f"no {what} is named", 1, f"the {what}s are {', '.join(names[:12])}; or write: none")
    return list(chosen_names)


def shown_text(answer: Given) -> str:
    """Return an answer as one text of at most `MOST_SHOWN` characters; parts of a list are separated by semicolons.

    >>> shown_text("f = 2 "), shown_text(Fraction(1, 2)), shown_text(("x", ("y", 3)))
    ('f = 2 ', '0.5', 'x; y; 3')
    """
    if isinstance(answer, str):
        text = answer
    elif isinstance(answer, bool | int | float | Fraction):
        text = as_written(answer) if isinstance(answer, Fraction) else str(answer)
    else:
        text = _BETWEEN.join(map(shown_text, answer))
    return text if len(text) <= MOST_SHOWN else text[: MOST_SHOWN - 3] + "..."
