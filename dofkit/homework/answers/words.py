"""Answers in words: names, as people write them."""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction

from pydantic_core import PydanticCustomError

from dofkit.base.errors import TextError
from dofkit.base.wording import nearest
from dofkit.expressions.text import spelled
from dofkit.homework.answers.denials import affirms, beside_none, says_none
from dofkit.homework.answers.notation import Script, script_of
from dofkit.homework.answers.prose import DOUBTS, FILLING, NEGATIONS, NUMBERS, REASONS, pattern, plain
from dofkit.homework.judgement import DoubtError, Given
from dofkit.scene.fields import as_written, exact

#: Fewer words than so many beside names say nothing of them.
_FEW_WORDS = 3
#: No answer is read beyond this.
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
_EITHER = re.compile(r"\A\s*(?:either|entweder|soit)\s+", re.IGNORECASE)
_LOWERED = {0x2080 + n: str(n) for n in range(10)}
_BRACES = re.compile(r"_\{(\w+)\}")

#: Characters of an answer that are shown; and what stands between the parts of a list.
MOST_SHOWN = 2000
_BETWEEN = "; "


def one_text(answer: object) -> str:
    """The text of an answer that should be one; raises TextError for lists and the like."""
    if isinstance(answer, bool) or not isinstance(answer, (str, int, float, Fraction)):
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
    """One of several words, and its column from 1."""

    text: str
    column: int


def split_words(answer: object) -> list[Word]:
    """The words of an answer: a list, or a text with commas, semicolons, spaces or "and" between them."""
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
    """Return whether the answer is that there is none. ``says``: whether a part of it names one all the same.

    ``names``: names that are no words; ``every``: that all are needed says so too. Raises DoubtError where it
    says both.
    """
    if isinstance(answer, Sequence) and not isinstance(answer, str):
        return not answer or (len(answer) == 1 and is_none(answer[0], says, names, every))
    if not isinstance(answer, str) or len(answer) > MOST_CHARACTERS:
        return False
    if any(says(part) or affirms(part) for part in beside_none(answer)):
        raise DoubtError("it says that there is none and then gives one.", 1, None)
    return says_none(answer, names, every)


def lists_only(part: str, names: Sequence[str]) -> bool:
    """Return whether a part of an answer consists of ``known`` names and words that say nothing."""
    table = ChoiceOfNames(names)
    listed = [word.text for word in split_words(part)]
    others = [w for w in listed if not table.meant(w)]
    return len(others) < min(len(listed), _FEW_WORDS) and all(plain(w) in FILLING for w in others)


def alternatives(answer: Given, names: Sequence[str], what: str) -> list[Given]:
    """Return the answers of `x or y`, `one of x and y`, or `any one` of the known names; else the answer itself."""
    if not isinstance(answer, str):
        return [answer]
    if (some := _ANY.match(plain(answer))) is not None:
        return list(names_of(some["which"], names, what)) if some["which"] else list(names)
    choices = _OR.split(_EITHER.sub("", answer))
    return [*choices] if all(part.strip() for part in choices) else [answer]


def names_of(answer: object, names: Sequence[str], what: str) -> list[str]:
    """The known names that an answer lists; remarks in parentheses and words around them are read over."""
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
    words = split_words(answer)
    table = ChoiceOfNames(names)
    if any(table.meant(word.text) for word in words):
        words = [w for w in words if table.meant(w.text) or plain(w.text.strip(".:'\"")) not in FILLING]
        words = _without_count(words, table)
    return chosen(words, names, what)


def _without_count(words: Sequence[Word], table: ChoiceOfNames) -> list[Word]:
    """Words without the number of the names among them: `the two angles`."""
    count = len({table.meant(w.text) for w in words} - {None})
    return [w for w in words if table.meant(w.text) or NUMBERS.get(plain(w.text)) != count]


class ChoiceOfNames:
    """Known names; Greek letters and their spelled names are the same, and case and `_` where they tell nothing."""

    def __init__(self, names: Sequence[str]) -> None:
        self._exact = {spelled(spelling): spelling for spelling in names}
        self._loose: dict[str, str | None] = {}
        for spelling, name in self._exact.items():
            for form in {spelling.lower(), spelling.lower().replace("_", "").replace(" ", "").replace("-", "")}:
                self._loose[form] = None if self._loose.get(form, name) != name else name

    def meant(self, text: str) -> str | None:
        """The one name that a text means."""
        text = spelled(text.strip("`'\".:").translate(_LOWERED))
        loose = self._loose.get(text.lower(), self._loose.get(text.lower().replace("_", "").replace("-", "")))
        return self._exact.get(text, loose)


def chosen(words: Iterable[Word], names: Sequence[str], what: str) -> list[str]:
    """The known names that the words are, each once.

    Raises TextError for a word that is none, with its column and the nearest name.
    """
    table = ChoiceOfNames(names)
    chosen_names: dict[str, None] = {}
    for word in words:
        meant = table.meant(word.text)
        if meant is None:
            near = nearest(word.text, names)
            hint = f"did you mean '{near}'?" if near else f"the {what}s are {', '.join(names[:12])}"
            raise TextError(f"there is no {what} '{word.text[:40]}'", word.column, hint)
        chosen_names[meant] = None
    if not chosen_names:
        raise TextError(f"no {what} is named", 1, f"the {what}s are {', '.join(names[:12])}; or write: none")
    return list(chosen_names)


def shown_text(answer: Given) -> str:
    """An answer as one text, of which a person sees at most so many characters; a list has semicolons in it.

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
